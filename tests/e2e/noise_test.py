# SPDX-License-Identifier: Apache-2.0
"""`welkin noise` and `welkin cloud`: what they write, and bad input."""
import json
import math
import os
import signal
import struct
import subprocess
import time
import zlib

from welkin_program import PROGRAM, ProgramTest, main


def read_png(path):
    """Width, height, channels and bytes of an 8-bit PNG whose rows use any filter."""
    data = path.read_bytes()
    width, height, bits, colour = struct.unpack(">IIBB", data[16:26])
    assert bits == 8
    channels = {0: 1, 2: 3, 4: 2, 6: 4}[colour]
    at, packed = 8, b""
    while at < len(data):
        size, kind = struct.unpack(">I4s", data[at:at + 8])
        if kind == b"IDAT":
            packed += data[at + 8:at + 8 + size]
        at += size + 12
    raw, stride, rows = zlib.decompress(packed), width * channels, []
    before = bytearray(stride)
    for y in range(height):
        kind, row = raw[y * (stride + 1)], bytearray(raw[y * (stride + 1) + 1:(y + 1) * (stride + 1)])
        for i in range(stride):
            a = row[i - channels] if i >= channels else 0
            b, c = before[i], before[i - channels] if i >= channels else 0
            p = a + b - c
            paeth = min((a, b, c), key=lambda v: (abs(p - v), (a, b, c).index(v)))
            row[i] = (row[i] + (0, a, b, (a + b) // 2, paeth)[kind]) & 255
        rows.append(bytes(row))
        before = row
    return width, height, channels, b"".join(rows)


class Noise(ProgramTest):
    def report(self, *args):
        self.succeed("noise", *args, "--report", "r.json")
        return json.loads((self.folder / "r.json").read_text())

    def test_thesis_texture_is_the_formula_over_its_noise(self):
        noise = ("--size", "64x64", "--octaves", "6", "--frequency", "6", "--amplitude", "0.7", "--persistence", "0.5",
                 "--normalise", "thesis")
        self.succeed("noise", *noise, "-o", "noise.raw", "--format", "r32f")
        self.succeed("noise", *noise, "--cutoff", "0.7", "--density", "0.96", "-o", "cloud.dds")
        values = struct.unpack("<4096f", (self.folder / "noise.raw").read_bytes())
        texels = (self.folder / "cloud.dds").read_bytes()[128:]
        self.assertEqual(len(texels), 4096)
        for value, texel in zip(values, texels):
            above = 255 * value - 255 * 0.7
            opacity = 1 - 0.96 ** above if above > 0 else 0
            self.assertAlmostEqual(texel, 255 * opacity, delta=0.51)

    def test_presets(self):
        covers = []
        for name in ("overcast", "broken", "few"):
            r = self.report("--preset", "thesis-" + name, "--size", "128x128", "-o", "x.dds")
            self.assertEqual((r["format"], r["size"], sum(r["histogram"])), ("a8", [128, 128, 1], 128 * 128))
            self.assertEqual(r["noise"]["normalisation"], "thesis")
            covers.append(r["cover"]["delivered"])
        self.assertEqual(covers, sorted(covers, reverse=True))
        self.assertEqual(self.report("--preset", "thesis-dome", "-o", "d.dds")["size"], [128, 128, 128])
        self.assertEqual((self.folder / "d.dds").stat().st_size, 128 + 128**3)
        # Flags go over the preset.
        r = self.report("--preset", "thesis-few", "--size", "64x64", "--cutoff", "0.4", "--exponent", "0.01", "-o", "x.dds")
        self.assertEqual((r["noise"]["cloud"]["cutoff"], r["noise"]["cloud"]["density"]), (0.4, None))

    def test_cover_is_met_to_the_texel(self):
        for oktas in (1, 3, 5, 8):
            r = self.report("--size", "200x100", "--cover", str(oktas / 8), "-o", "x.png")
            _, _, _, texels = read_png(self.folder / "x.png")
            covered = sum(t > 0 for t in texels)
            self.assertLessEqual(abs(covered - 20000 * oktas / 8), 1)
            self.assertAlmostEqual(r["cover"]["delivered"], covered / 20000, places=6)

    def test_threads_and_runs_give_the_same_bytes(self):
        for kind in ("perlin", "cellular", "perlin-worley", "curl", "distorted"):
            args = ("--kind", kind, "--size", "24x20x12", "--format", "rgba8", "-o")
            self.succeed("noise", *args, "a.dds", "--threads", "1")
            self.succeed("noise", *args, "b.dds", "--threads", "3")
            self.assertEqual((self.folder / "a.dds").read_bytes(), (self.folder / "b.dds").read_bytes(), kind)

    def test_large_volumes_are_written_as_they_are_made(self):
        r = self.report("-o", "x.dds", "--size", "512x512x512", "--octaves", "1")
        self.assertEqual((self.folder / "x.dds").stat().st_size, 128 + 512 ** 3)
        self.assertLess(r["peak_rss_mib"], 100)  # of 128 MiB

    def test_preview_tiles_and_shows_slices(self):
        self.succeed("noise", "--size", "20x10", "-o", "x.png", "--preview", "p.png", "--tile", "3x2")
        width, height, _, one = read_png(self.folder / "x.png")
        w, h, _, many = read_png(self.folder / "p.png")
        self.assertEqual((w, h), (60, 20))
        for y in range(h):
            self.assertEqual(many[y * w:(y + 1) * w], one[y % height * width:(y % height + 1) * width] * 3)
        self.succeed("noise", "--size", "16x16x40", "-o", "x.dds", "--preview", "p.png")
        self.assertEqual(read_png(self.folder / "p.png")[:2], (4 * 18 - 2, 4 * 18 - 2))

    def test_offset_in_the_plane(self):
        for offset, out in (("1e9,0.25", "x.dds"), ("1e9,0.25,0", "y.dds"), ("0,0.25", "z.dds")):
            self.succeed("noise", "--size", "32x16", "--kind", "distorted", "--offset", offset, "-o", out, "--format", "r32f")
        x, y, z = ((self.folder / name).read_bytes() for name in ("x.dds", "y.dds", "z.dds"))
        self.assertEqual(x, y)
        self.assertEqual(x, z)  # whole tiles

    def test_every_kind_evolves(self):
        for kind in ("perlin", "value", "cellular", "perlin-worley", "curl", "distorted"):
            def frame(time):
                self.succeed("noise", "--size", "24x16", "--kind", kind, "--time", time, "--time-period", "3", "-o", "x.dds",
                             "--format", "rgba32f" if kind == "perlin-worley" else "rgb32f" if kind == "curl" else "r32f")
                return (self.folder / "x.dds").read_bytes()
            self.assertEqual(frame("0.5"), frame("3.5"), kind)
            self.assertNotEqual(frame("0.5"), frame("0.75"), kind)
        self.succeed("noise", "--size", "12x8x6", "--kind", "value", "--time", "0.5", "-o", "x.vdb")
        self.fail_with(2, "in space none is left for time", "noise", "--size", "12x8x6", "--kind", "value", "--table", "published",
                       "--time", "0.5", "-o", "x.dds")

    def test_extensions_in_any_case(self):
        for name, same in (("x.DDS", "y.dds"), ("x.PNG", "y.png")):
            for out in (name, same):
                self.succeed("noise", "--size", "16x16", "-o", out, "--preview", "p.PNG")
            self.assertEqual((self.folder / name).read_bytes(), (self.folder / same).read_bytes())
        for out in ("x.Dds", "y.dds"):
            self.succeed("cloud", "-o", out)
        self.assertEqual((self.folder / "x.Dds").read_bytes(), (self.folder / "y.dds").read_bytes())

    def test_the_side_file_names_both(self):
        self.succeed("noise", "--size", "16x8", "-o", "x.raw")
        texels, side = ((self.folder / name).read_bytes() for name in ("x.raw", "x.raw.json"))
        before = self.files()
        self.succeed("noise", "--size", "16x8", "-o", "x.raw.json")
        self.assertEqual(self.files(), before)
        self.assertEqual((self.folder / "x.raw").read_bytes(), texels)
        self.assertEqual((self.folder / "x.raw.json").read_bytes(), side)

    def test_files(self):
        for name, args in {"a.raw": (), "a.exr": (), "b.png": ("--format", "l16"), "c.dds": ("--format", "r8"),
                           "d.dds": ("--format", "r32f"), "e.dds": ("--mipmaps", "kaiser")}.items():
            self.succeed("noise", "--size", "16x16", *args, "-o", name)
        self.assertEqual((self.folder / "e.dds").stat().st_size, 128 + 256 + 64 + 16 + 4 + 1)
        self.assertEqual((self.folder / "d.dds").stat().st_size, 128 + 1024)
        self.assertEqual(json.loads((self.folder / "a.raw.json").read_text())["size"], [16, 16])

    def test_every_parameter_has_a_flag(self):
        text = self.succeed("noise", "--help")
        keys = [k for k in self.report("--size", "8x8", "-o", "x.png")["noise"] if k not in ("dimensions", "cloud", "curve")]
        renamed = {"normalisation": "normalise", "tile": "seamless"}
        for key in keys + ["cutoff", "cover", "density", "exponent", "sharpness", "scale", "bias", "gamma", "in_low", "out_high"]:
            self.assertIn("--" + renamed.get(key, key).replace("_", "-") + " ", text)
        self.assertLessEqual(max(map(len, text.splitlines())), 125)


class BadNoise(ProgramTest):
    def refuse(self, message, *args, out="x.png"):
        self.fail_with(2, message, "noise", "-o", out, *args)

    def test_sizes(self):
        self.refuse('"0x4" has 0 texels on an axis; expected 1 to 65536', "--size", "0x4")
        self.refuse("2147483648 texels on an axis", "--size", "2147483648x2")
        self.refuse("99999999999999999999 texels on an axis", "--size", "99999999999999999999x4")
        self.refuse("expected at most 68719476736", "--size", "65536x65536x65536", out="x.dds")
        for text in ("", "8", "8x", "x8", "8x8x8x8", "8 x8", "-8x8", "8x8.5", "axb"):
            self.fail_with(2, "--size", "noise", "-o", "x.dds", "--size=" + text)
        self.fail_with(2, "expected --size WxH or WxHxD, or a --preset", "noise", "-o", "x.png")

    def test_values(self):
        size = ("--size", "8x8")
        self.refuse("gamma is nan; expected 0.01 to 100", *size, "--gamma", "nan")
        self.refuse("octaves: expected a whole number", *size, "--octaves", "3.5")
        self.refuse("cover is 1.5; expected 0 to 1", *size, "--cover", "1.5")
        self.refuse("--octavs; did you mean --octaves?", *size, "--octavs", "3")
        self.refuse("did you mean perlin?", *size, "--kind", "perln")
        self.refuse("did you mean thesis-few?", "--preset", "thesis-fwe")
        self.refuse("--seamless false", *size, "--frequency", "2.5")
        self.refuse("cutoff and cover both say", *size, "--cutoff", "0.5", "--cover", "0.5")
        self.refuse("density belongs to noise that condenses", *size, "--density", "0.9")
        self.refuse("never gets as opaque", *size, "--cover", "0.5", "--density", "1")
        self.refuse("--threads: expected a whole number from 1 to 1024", *size, "--threads", "0")

    def test_files(self):
        size = ("--size", "8x8")
        self.refuse("unknown extension .gif", *size, out="x.gif")
        self.refuse('no texel format "zz8"', *size, "--format", "zz8")
        self.refuse("cannot hold a picture of r32f", *size, "--format", "r32f")
        self.refuse("x.png cannot hold a volume of l8; expected .dds, .raw or .vdb", "--size", "8x8x8")
        curl = ("--kind", "curl", "--size", "8x8x8")
        self.refuse("x.png cannot hold a volume of rgb8; expected .dds or .raw", *curl)
        self.refuse("x.dds cannot hold a volume of rgb8; expected --format rgba8", *curl, "--format", "rgb8", out="x.dds")
        self.refuse("x.vdb cannot hold a volume of rgb32f; expected another --format or kind of file", *curl, out="x.vdb")
        self.refuse("expected a size of three numbers", *size, out="x.vdb")
        self.refuse("a8 has 1 channel a texel; expected rgba8 or the like", *size, "--kind", "perlin-worley", "--format", "a8")
        self.refuse("--mipmaps, --edges and --header are for .dds", *size, "--mipmaps", "box")
        self.refuse("--tile goes with --preview", *size, "--tile", "2x2")
        for tile in ("2", "0x1", "17x1", "2x2x2", "2xb"):
            self.refuse("--tile: expected COLUMNSxROWS", *size, "--preview", "p.png", "--tile", tile)
        self.refuse("is no .png", *size, "--preview", "p.jpg")
        self.refuse("is written already", *size, "--preview", "x.png")
        self.refuse("is written already", *size, "--preview", "./x.png")
        self.refuse("is written already", *size, "--report", "x.png")
        self.refuse("is written already", *size, "--report", "../" + self.folder.name + "/x.png")
        self.refuse("is written already", *size, "--report", "x.raw.json", out="x.raw")
        self.refuse("is written already", *size, "--report", "./x.raw", out="x.raw.json")
        self.refuse("is written already", *size, "--report", "./p.png", "--preview", "p.png")
        self.fail_with(2, "expected -o OUT", "noise", *size)
        for flag in ("--time-period", "--time-lacunarity"):
            self.refuse("go with --time", *size, flag, "4")
        self.succeed("noise", *size, "--time", "0.5", "--time-period", "4", "-o", "t.png")
        for out in ("none/x.png", "/proc/x.png"):
            self.fail_with(1, "cannot write " + out, "noise", *size, "-o", out)
        self.fail_with(1, "cannot write none/", "noise", *size, "-o", "x.png", "--report", "none/r.json")
        self.fail_with(1, "cannot write none/", "noise", *size, "-o", "x.png", "--preview", "none/p.png")

    def test_what_the_file_cannot_hold(self):
        loud = ("--size", "8x8", "--amplitude", "1e6", "--frequency", "3", "--format")
        message = self.fail_with(1, "which r16f cannot hold; expected --format r32f", "noise", *loud, "r16f", "-o", "x.dds")
        self.assertIn("cannot write x.dds: texel (", message)
        self.succeed("noise", *loud, "r32f", "-o", "x.dds")
        self.succeed("noise", *loud, "a8", "-o", "x.dds")  # saturates, as the thesis does
        dense = ("cloud", "--dynamics", "1e6", "-o", "c.dds", "--format")
        self.fail_with(1, "which r16f cannot hold; expected --format r32f", *dense, "r16f")
        self.fail_with(1, "which l8 cannot hold; expected --format r32f", *dense, "l8")
        self.succeed(*dense, "r32f")

    def test_seeds_are_taken_to_the_last_digit(self):
        most = 2**53 - 1
        for flag in ("--seed", "--tower-seed"):
            for seed in (most + 1, most + 2, 2**60 + 1):
                message = self.fail_with(2, f"seed is {seed}; expected 0 to {most}", "cloud", "--cumulus", flag, str(seed), "-o", "c.dds")
                self.assertIn(flag, message)
        cloud = ("cloud", "--size", "12x12x12", "--report", "r.json", "-o", "c.vdb", "--seed")
        for seed in (most, most - 2):
            self.succeed(*cloud, str(seed))
            self.assertEqual(json.loads((self.folder / "r.json").read_text())["cloud"]["noise"]["seed"], seed)
        # Noise takes every whole number of 64 bits.
        for seed in (2**53 + 1, 2**63 - 1, -2**63):
            self.succeed("noise", "--size", "8x8", "--seed", str(seed), "-o", "x.png", "--report", "r.json")
            self.assertEqual(json.loads((self.folder / "r.json").read_text())["noise"]["seed"], seed)
        self.fail_with(2, "seed: expected a smaller number", "noise", "--size", "8x8", "--seed", str(2**63), "-o", "x.png")
        self.write("s.toml", f"seed = {most + 2}\n")
        self.fail_with(1, f"seed is {most + 2}; expected 0 to {most}", "info", "s.toml")

    def test_a_limit_of_file_sizes(self):
        for out in ("x.dds", "x.png", "x.raw"):
            done = subprocess.run(["bash", "-c", f'ulimit -f 4; exec "{PROGRAM}" noise --size 256x256 -o {out}'], cwd=self.folder,
                                  stderr=subprocess.PIPE)
            self.assertEqual((done.returncode, done.stderr), (1, f"welkin: cannot write {out}: File too large\n".encode()))
            self.assertEqual(self.files(), [])

    def test_folder_without_permission(self):
        if os.geteuid() == 0:
            self.skipTest("permissions do not hold the superuser back")
        os.mkdir(self.folder / "locked", 0o555)
        self.fail_with(1, "cannot write locked/x.png: Permission denied", "noise", "--size", "8x8", "-o", "locked/x.png")

    def test_interruption_leaves_nothing(self):
        for out in ("x.dds", "x.raw"):
            process = subprocess.Popen([PROGRAM, "noise", "--kind", "distorted", "--size", "1024x1024x1024", "-o", out, "--preview",
                                        "p.png"], cwd=self.folder, stderr=subprocess.PIPE)
            deadline = time.time() + 60
            while not self.files() and time.time() < deadline:
                time.sleep(0.01)
            self.assertTrue(self.files(), "nothing was begun")
            process.send_signal(signal.SIGHUP if out == "x.raw" else signal.SIGINT)
            self.assertEqual(process.communicate(timeout=60)[1], b"welkin: interrupted\n")
            self.assertEqual(process.returncode, 130)
            self.assertEqual(self.files(), [])


class Cloud(ProgramTest):
    def report(self, *args):
        self.succeed("cloud", *args, "--report", "r.json")
        return json.loads((self.folder / "r.json").read_text())

    def test_the_papers_example(self):
        r = self.report("-o", "x.raw")
        self.assertEqual((r["size"], r["ellipsoids"]), ([48, 36, 24], 1))
        self.assertAlmostEqual(r["cloud_voxels"], 11800, delta=100)
        values = struct.unpack("<41472f", (self.folder / "x.raw").read_bytes())
        self.assertEqual(sum(v > 0 for v in values), r["cloud_voxels"])
        side = json.loads((self.folder / "x.raw.json").read_text())
        self.assertEqual((side["size"], side["voxel_size_m"], side["name"]), ([48, 36, 24], [20, 20, 20], "density"))
        self.assertEqual(side["first_voxel_m"], [-470, -350, 10])
        self.assertEqual(r["cloud"]["ellipsoid"], {"centre_m": [0, 0, 240], "radii_m": [456, 342, 228], "rotation_deg": [0, 0, 0]})
        self.assertEqual(json.loads(side["metadata"]["welkin_cloud"]), r["cloud"])

    def test_one_ellipsoid_by_flags(self):
        r = self.report("-o", "x.dds", "--size", "40x40x40", "--voxel", "10", "--centre", "0,0,200", "--radii", "150,100,50",
                        "--rotation", "0,90,0", "--octaves", "0", "--threshold", "0")
        self.assertAlmostEqual(r["cloud_voxels"], 4 / 3 * math.pi * 15 * 10 * 5, delta=60)
        # Turned about y by a right angle: what was long along x stands upright.
        texels = (self.folder / "x.dds").read_bytes()[128:]
        self.assertGreater(texels[(31 * 40 + 20) * 40 + 20], 0)
        self.assertEqual(texels[(20 * 40 + 20) * 40 + 27], 0)

    def test_help_knows_that_the_ellipsoid_fills_the_box(self):
        text = " ".join(self.succeed("cloud", "--help").split())
        self.assertIn("default the middle of the box)", text)
        self.assertIn("default 95 % of the box's)", text)
        self.assertNotIn("[100, 100, 100]", text)

    def test_many_from_a_file(self):
        self.write("e.toml", "".join(f"[[ellipsoid]]\ncentre_m = [{x}, 0, 100]\nradii_m = [90, 90, 90]\n" for x in (-200, 200)))
        r = self.report("--ellipsoids", "e.toml", "--octaves", "0", "-o", "x.raw", "--voxel", "10")
        self.assertEqual((r["ellipsoids"], r["size"]), (2, [61, 19, 20]))
        self.assertEqual(r["cloud"]["ellipsoids"], "e.toml")

    def test_cumulus(self):
        r = self.report("--cumulus", "--width", "1000", "--height", "800", "--voxel", "40", "-o", "x.raw", "--preview", "p.png")
        self.assertEqual(r["size"], [27, 27, 21])
        self.assertGreater(r["ellipsoids"], 50)
        self.assertGreater(r["cloud_voxels"], 1500)
        self.assertEqual((r["cloud"]["tower"]["width_m"], r["cloud"]["tower"]["height_m"]), (1000, 800))
        self.succeed("cloud", "--cumulus", "--width", "1000", "--height", "800", "--voxel", "40", "-o", "y.raw", "--threads", "1")
        self.assertEqual((self.folder / "x.raw").read_bytes(), (self.folder / "y.raw").read_bytes())
        other = self.report("--cumulus", "--width", "1000", "--height", "800", "--voxel", "40", "-o", "z.raw", "--tower-seed", "1")
        self.assertNotEqual(other["cloud_voxels"], r["cloud_voxels"])

    def test_mistakes(self):
        self.fail_with(1, "the cloud is empty: its greatest density is 0.5", "cloud", "-o", "x.raw", "--threshold", "2")
        self.fail_with(1, "the cloud is empty: no ellipsoid", "cloud", "-o", "x.raw", "--centre", "0,0,90000")
        self.fail_with(2, "radii_m is 0; expected 0.01 to 1000000 m", "cloud", "-o", "x.raw", "--radii", "10,0,10")
        self.fail_with(2, "radii_m: expected three numbers", "cloud", "-o", "x.raw", "--radii", "10")
        self.fail_with(2, "expected WIDTHxHEIGHTxDEPTH", "cloud", "-o", "x.raw", "--size", "8x8")
        self.fail_with(2, "more than 2147483648 voxels", "cloud", "-o", "x.raw", "--size", "4000x4000x4000")
        self.fail_with(2, "--cumulus and --ellipsoids", "cloud", "-o", "x.raw", "--cumulus", "--ellipsoids", "e.toml")
        self.fail_with(2, "go with --cumulus", "cloud", "-o", "x.raw", "--width", "100")
        self.fail_with(2, "not with --cumulus", "cloud", "-o", "x.raw", "--cumulus", "--radii", "1,1,1")
        self.fail_with(2, "x.png cannot hold a volume", "cloud", "-o", "x.png")
        self.fail_with(2, "x.vdb cannot hold r8; expected --format r16f or r32f", "cloud", "-o", "x.vdb", "--format", "r8")
        self.fail_with(2, "did you mean --cumulus?", "cloud", "-o", "x.raw", "--cumulis")
        self.write("one.toml", "[[ellipsoid]]\nradii_m = [100, 100, 100]\n")
        self.fail_with(2, "--report: ./one.toml is read", "cloud", "-o", "x.raw", "--ellipsoids", "one.toml", "--report", "./one.toml")
        self.fail_with(1, "none.toml: cannot be opened", "cloud", "-o", "x.raw", "--ellipsoids", "none.toml")
        self.write("bad.toml", "[[ellipsoid]]\nradii_m = [1, -1, 1]\n")
        self.fail_with(1, "bad.toml:2:15: radii_m is -1", "cloud", "-o", "x.raw", "--ellipsoids", "bad.toml")
        self.fail_with(1, "more than 10000 bubbles", "cloud", "-o", "x.raw", "--cumulus", "--generations", "6", "--children", "64")


if __name__ == "__main__":
    main()
