#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Slabs by the reference renderer against converged discrete ordinates, as a Markdown table. Takes minutes.

    bench/slabs.py build/checked/bin/welkin [--noise X] [--seed N]
"""
import argparse
import json
import pathlib
import subprocess
import tempfile

CONSERVATIVE = {  # g = 0.85, albedo 1: R overhead, R at mu0 = 0.5, R in diffuse light, radiance overhead, radiance at 0.5
    1: (0.0423162, 0.1648776, 0.1343749, 0.0176279, 0.0548350),
    4: (0.1909149, 0.4160225, 0.3404020, 0.1316950, 0.2300100),
    16: (0.5572094, 0.6974049, 0.6516871, 0.5654561, 0.5599460),
    64: (0.8462810, 0.8949697, 0.8790956, 0.9329113, 0.8110817),
}
OTHER_G = {0: (0.3413288, 0.6909262, 0.9036315, 0.9743381), 0.75: (0.0787398, 0.3116391, 0.6880459, 0.9028564)}
ABSORBING = {4: (0.1728356, 0.7661701), 16: (0.4177221, 0.3061035)}


def cases():
    """Title, keys of the slab, and what is known."""
    for depth, (overhead, slanting, diffuse, nadir1, nadir2) in CONSERVATIVE.items():
        keys = {"optical_depth": depth}
        yield f"depth {depth}, overhead", keys, {"reflectance": overhead, "transmittance": 1 - overhead, "nadir_radiance": nadir1}
        yield (f"depth {depth}, 60 degrees", {**keys, "sun_zenith_deg": 60},
               {"reflectance": slanting, "transmittance": 1 - slanting, "nadir_radiance": nadir2})
        yield f"depth {depth}, diffuse", {**keys, "light": "diffuse"}, {"reflectance": diffuse, "transmittance": 1 - diffuse}
    for g, row in OTHER_G.items():
        for depth, r in zip(CONSERVATIVE, row):
            yield f"depth {depth}, g {g}", {"optical_depth": depth, "asymmetry": g}, {"reflectance": r, "transmittance": 1 - r}
    for depth, (r, t) in ABSORBING.items():
        yield (f"depth {depth}, albedo 0.99", {"optical_depth": depth, "albedo": 0.99},
               {"reflectance": r, "transmittance": t, "absorptance": 1 - r - t})


def trace(program, folder, keys, flags):
    lines = [f"{k} = {json.dumps(v)}" for k, v in keys.items()]
    (folder / "slab.toml").write_text("\n".join([*flags["top"], "[slab]", *lines]) + "\n")
    subprocess.run([program, "render", "slab.toml", "--renderer", "reference", "--report", "r.json", "--noise", flags["noise"]],
                   cwd=folder, check=True)
    return json.loads((folder / "r.json").read_text())


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program", type=lambda p: str(pathlib.Path(p).resolve()))
    parser.add_argument("--noise", default="0.001")
    parser.add_argument("--seed", default="1")
    args = parser.parse_args()
    flags = {"noise": args.noise, "top": [f"seed = {args.seed}"]}
    print("| Slab | Quantity | Known | Traced | Error | In standard errors | Events | Seconds |\n|---|---|---|---|---|---|---|---|")
    with tempfile.TemporaryDirectory() as folder:
        for title, keys, known in cases():
            report = trace(args.program, pathlib.Path(folder), keys, flags)
            for name, truth in known.items():
                e = report["slab"][name]
                off = e["value"] - truth
                print(f"| {title} | {name} | {truth:.6f} | {e['value']:.6f} | {100 * off / truth:+.3f} % | {off / e['standard_error']:+.1f} | "
                      f"{report['scattering_events'] / 1e6:.0f} M | {report['total_ms'] / 1e3:.1f} |", flush=True)


if __name__ == "__main__":
    main()
