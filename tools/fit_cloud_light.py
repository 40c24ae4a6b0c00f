#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Fits the network of shaders/lib/cloud_light_fit.glsl to examples written by bench/light_samples.

    light_samples EXAMPLES.f32 200 700 8 1
    light_samples LIKE.f32 60 700 8 101 SCENE.toml
    tools/fit_cloud_light.py EXAMPLES.f32... LIKE.f32 LIKE.f32 [--write shaders/lib/cloud_light_fit.glsl] [--steps 6000]

Examples of a file that is named several times count as often.

Needs JAX and Optax (PyPI). A sixth of the skies is held back, and what the fit makes of them is printed; with --write all are
used. The network: twenty-four numbers, two layers of twenty-four x / (1 + |x|), two numbers: the logarithm of a factor of
the light scattered more than once, and of the odds of light from above. Least squares of relative errors, by Adam
(D. P. Kingma and J. Ba 2015, "Adam: A Method for Stochastic Optimization"). The examples are noisy means over a
few paths; their noise has no bias, and evens out.
"""
import argparse

import jax
import jax.numpy as jnp
import numpy as np
import optax

COLUMNS = ("to_sun from_sun up down to_eye cos_sun view_height sun_height ice cover direct phase sun above below "
           "paths genus sky distance behind_to_sun behind_from_sun behind_up behind_down surface height depth layer_extinction "
           "peak_share peak_g fluence fluence_ahead").split()
SIMILARITY = 1 - 0.86  # the constants of shaders/lib/cloud_light.glsl
WIDTH = 24
LEAST = 0.005          # 1/sr: what errors are relative to where clouds are dark
OUTLIER = 40.0         # times the expected light: where a mean of a few paths is cut
LOWEST_SUN = 0.02      # sine of its elevation; lower ones light little


def read(files):
    rows = np.concatenate([np.fromfile(f, np.float32).reshape(-1, len(COLUMNS)) for f in files])
    rows = rows[rows[:, COLUMNS.index("sun_height")] > LOWEST_SUN]
    return {name: rows[:, i].astype(np.float64) for i, name in enumerate(COLUMNS)}


def henyey_greenstein(c, g):
    return (1 - g * g) / (4 * np.pi * np.maximum(1 + g * g - 2 * g * c, 1e-7) ** 1.5)


def closed_form(d):
    """cloudSunSource() without the first scattering, and cloudSkyShares().x."""
    to_sun, from_sun = d["to_sun"], d["from_sun"]
    direct = np.exp(-to_sun)
    as_layer = np.clip(d["sun_height"], 0.1, 1)
    mu = np.clip(d["up"] / np.maximum(to_sun, 1e-3), as_layer, 1)
    facing = d["view_height"] + (d["cos_sun"] - d["view_height"]) * (mu - as_layer) / np.maximum(1 - as_layer, 1e-3)
    depth = SIMILARITY * mu * to_sun
    total = depth + SIMILARITY * mu * from_sun
    here, through = np.exp(-depth / mu), np.exp(-total / mu)
    transmitted = (2 / 3 + mu + (2 / 3 - mu) * through) / (4 / 3 + total)
    fluence = 3 * mu * transmitted * (total - depth + 2 / 3) - 2 * mu * through + 3 * mu * mu * (through - here)
    flux = mu * (transmitted - here)
    diffuse = 1.06 * np.maximum(fluence + 3 * 0.594 * flux * facing, 0) / (4 * np.pi)
    diffuse *= 1 - np.exp(-0.32 * mu * (to_sun + from_sun))
    forward = 1.62 * henyey_greenstein(d["cos_sun"], 0.593) * np.maximum(here - direct, 0)
    up, down = SIMILARITY * d["up"], SIMILARITY * d["down"]
    return np.maximum(forward + diffuse, 0) + 1e-5, (down + 2 / 3) / (4 / 3 + up + down)


def peaks(d):
    """cloudPeakSource()."""
    turned = d["peak_share"] * d["to_sun"]
    lobe = henyey_greenstein(d["cos_sun"], d["peak_g"] ** (2 + 0.6 * turned))
    return d["peak_share"] * lobe * (np.exp(turned - d["to_sun"]) - np.exp(-d["to_sun"]))


def inputs(d):
    """As cloudScattering() of shaders/lib/cloud_scattering.glsl has them."""
    def log(x):
        return np.log1p(np.maximum(x, 0)) / 3

    def radiance(fluence):
        return np.log(fluence / (4 * np.pi) + 1e-3)
    return np.stack([log(d["to_sun"]), log(d["from_sun"]), log(d["up"]), log(d["down"]), log(d["to_eye"]), d["cos_sun"],
                     d["view_height"], d["sun_height"], np.sqrt(np.maximum(0.5 - 0.5 * d["cos_sun"], 0)), d["ice"],
                     log(d["distance"] / 1000), d["cover"], log(d["behind_to_sun"]), log(d["behind_from_sun"]),
                     log(d["behind_up"]), log(d["behind_down"]), 0.5 * np.clip(d["surface"], -2, 4), d["height"],
                     0.75 * log(0.01 * d["depth"]), 1.5 * log(300 * d["layer_extinction"]), 1.5 + 0.5 * radiance(d["fluence"]),
                     1.5 + 0.5 * radiance(d["fluence_ahead"]), 2 + radiance(d["fluence"] + np.exp(-SIMILARITY * d["to_sun"])),
                     4 * (d["fluence_ahead"] - d["fluence"]) / (d["fluence_ahead"] + d["fluence"] + 0.01)], 1).astype(np.float32)


def network(parameters, x):
    for i, (weights, biases) in enumerate(parameters):
        x = x @ weights + biases
        if i < 2:
            x = x / (1 + jnp.abs(x))
    return x


def corrected(out, sun, above):
    """Light scattered more than once, and the share from above."""
    return sun * jnp.exp(jnp.clip(out[:, 0], -3, 3)), 1 / (1 + (1 / above - 1) * jnp.exp(-jnp.clip(out[:, 1], -3, 3)))


def loss(parameters, x, sun, above, first, true_sun, true_above):
    s, a = corrected(network(parameters, x), sun, above)
    # Weights of the last step's prediction: a noisy example that happens to be dark counts no more for it.
    expected = jax.lax.stop_gradient(s) + LEAST
    errors = (s - jnp.minimum(true_sun, OUTLIER * expected)) / (expected + 0.3 * first)
    return jnp.mean(errors ** 2) + jnp.mean((a - true_above) ** 2)


def fit(d, rows, steps, seed=0, batch=4096, rate=8e-3):
    first = np.minimum(d["direct"] * d["phase"], 2) + np.minimum(peaks(d), 2)
    data = [np.asarray(v, np.float32) for v in (inputs(d), *closed_form(d), first, d["sun"] - peaks(d), d["above"])]
    rng = np.random.default_rng(seed)
    sizes = [data[0].shape[1], WIDTH, WIDTH, 2]
    parameters = [(jnp.asarray(rng.normal(0, (1 if b > 2 else 0.1) * a ** -0.5, (a, b)), jnp.float32), jnp.zeros(b))
                  for a, b in zip(sizes, sizes[1:])]
    optimizer = optax.adam(optax.cosine_decay_schedule(rate, steps, 1e-3))
    state = optimizer.init(parameters)

    @jax.jit
    def step(parameters, state, *examples):
        updates, state = optimizer.update(jax.grad(loss)(parameters, *examples), state)
        return optax.apply_updates(parameters, updates), state

    for _ in range(steps):
        i = rows[rng.integers(0, len(rows), batch)]
        parameters, state = step(parameters, state, *(v[i] for v in data))
    return [(np.asarray(w, np.float64), np.asarray(b, np.float64)) for w, b in parameters]


def predicted(parameters, d):
    sun, above = closed_form(d)
    s, a = corrected(np.asarray(network(parameters, inputs(d))), sun, above)
    return np.asarray(s) + peaks(d), np.asarray(a)


def report(name, d, rows, parameters):
    """Bias of each sky's mean: of the light of the sun, and of the share from above."""
    sun = closed_form(d)[0]
    s, a = predicted(parameters, d)
    sky = d["sky"].astype(int)
    rows = rows[d["cos_sun"][rows] < 0.93]  # nearer to the sun the noise is larger than the errors
    before, after, shares, noise = [], [], [], []
    for k in np.unique(sky[rows]):
        i = rows[sky[rows] == k]
        if len(i) < 60:
            continue
        true = d["sun"][i]
        before.append(sun[i].mean() / true.mean() - 1)
        after.append(s[i].mean() / true.mean() - 1)
        noise.append(true.std() / len(i) ** 0.5 / true.mean())
        shares.append(a[i].mean() - d["above"][i].mean())
    print(f"{name}: {len(after)} skies, {len(rows)} points; light of the sun, mean |bias| of a sky: closed form "
          f"{np.mean(np.abs(before)):.3f}, fit {np.mean(np.abs(after)):.3f} (noise {np.mean(noise):.3f}); mean bias "
          f"{np.mean(before):+.3f}, {np.mean(after):+.3f}; share from above, rms {np.sqrt(np.mean(np.square(shares))):.3f}")


def glsl(parameters, note):
    def number(v):
        text = f"{v:.4g}"
        return text + ("f" if "." in text or "e" in text else ".0f")

    def matrix(w):  # 4 inputs by 4 outputs: GLSL's columns are inputs
        return "mat4(" + ", ".join(number(v) for v in w.ravel()) + ")"

    def vector(b):
        return "vec4(" + ", ".join(number(v) for v in b) + ")"

    lines = []
    for name, source, w, b in (("a", "x", *parameters[0]), ("b", "a", *parameters[1])):
        for k in range(WIDTH // 4):
            columns = slice(4 * k, 4 * k + 4)
            terms = [f"{matrix(w[4 * j:4 * j + 4, columns])} * {source}{j}" for j in range(len(w) // 4)]
            lines.append(f"  vec4 {name}{k} = " + " +\n            ".join(terms + [vector(b[columns])]) + ";")
        lines += [f"  {name}{k} /= 1.0f + abs({name}{k});" for k in range(WIDTH // 4)]
    out = [" + ".join([f"dot({vector(parameters[2][0][4 * j:4 * j + 4, c])}, b{j})" for j in range(WIDTH // 4)] +
                      [number(parameters[2][1][c])]) for c in (0, 1)]
    lines.append(f"  return vec2({out[0]},\n              {out[1]});")
    body = "\n".join(lines)
    return f"""// SPDX-License-Identifier: Apache-2.0
// Written by tools/fit_cloud_light.py, which says what it is; {note}.
WELKIN_FN vec2 cloudLightFit(vec4 x0, vec4 x1, vec4 x2, vec4 x3, vec4 x4, vec4 x5) {{
{body}
}}
"""


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("examples", nargs="+")
    parser.add_argument("--write", help="the shader to write, from all examples")
    parser.add_argument("--steps", type=int, default=6000)
    parser.add_argument("--seed", type=int, default=0, help="of the network and the order of examples: take what does best held back")
    args = parser.parse_args()
    d = read(args.examples)
    every = np.arange(len(d["sun"]))
    held_back = d["sky"].astype(int) % 6 == 0
    skies = len(np.unique(d["sky"]))
    parameters = fit(d, every[~held_back], args.steps, args.seed)
    report("seen", d, every[~held_back], parameters)
    report("held back", d, every[held_back], parameters)
    if args.write:
        parameters = fit(d, every, args.steps, args.seed)
        with open(args.write, "w", encoding="utf-8") as out:
            out.write(glsl(parameters, f"from {len(every)} points in {skies} skies"))


if __name__ == "__main__":
    main()
