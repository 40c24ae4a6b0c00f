# SPDX-License-Identifier: Apache-2.0
"""`welkin fit`: the balls, the errors that it reports, resuming, and bad input."""
import json
import math
import signal
import struct
import subprocess
import time

from welkin_program import PROGRAM, ProgramTest, main

SMALL = ("--size", "24x18x12", "--voxel", "40", "--cell", "6")


def field_at(balls, p):
    """The field as its file format defines it, from the formula alone."""
    total = 0.0
    for ball in balls:
        s = sum((a - c) ** 2 for a, c in zip(p, ball["center_m"])) / ball["radius_m"] ** 2
        if s < 1:
            total += ball["density"] * (1 - 22 / 9 * s + 17 / 9 * s * s - 4 / 9 * s**3)
    return total


class Fit(ProgramTest):
    def setUp(self):
        super().setUp()
        self.succeed("cloud", *SMALL, "-o", "m.raw")

    def fit(self, *args, map_name="m.raw"):
        self.succeed("fit", map_name, *args, "--report", "r.json")
        return json.loads((self.folder / "r.json").read_text())

    def read(self, name):
        return json.loads((self.folder / name).read_text())

    def error_of(self, balls):
        values = struct.unpack("<5184f", (self.folder / "m.raw").read_bytes())
        first = self.read("m.raw.json")["first_voxel_m"]
        difference = norm = 0.0
        for i, value in enumerate(values):
            at = (i % 24, i // 24 % 18, i // (24 * 18))
            e = field_at(balls, [f + 40 * n for f, n in zip(first, at)]) - value
            difference += e * e
            norm += value * value
        return math.sqrt(difference / norm), math.sqrt(difference / len(values))

    def test_levels_and_their_errors(self):
        r = self.fit("--balls", "40,5,15", "-o", "x.json")
        self.assertEqual([level["k"] for level in r["levels"]], [5, 15, 40])
        file = self.read("x.json")
        self.assertEqual(file["welkin"], "metaballs")
        self.assertEqual([len(level["balls"]) for level in file["levels"]], [5, 15])
        self.assertEqual(len(file["balls"]), 40)
        errors = []
        for level, balls in zip(r["levels"], [level["balls"] for level in file["levels"]] + [file["balls"]]):
            relative, rmse = self.error_of(balls)
            self.assertAlmostEqual(level["relative_l2"], relative, places=4)
            self.assertAlmostEqual(level["rmse"], rmse, places=5)
            self.assertGreater(level["seconds"], 0)
            self.assertTrue(all(b["density"] >= 0 and b["radius_m"] > 0 for b in balls))
            errors.append(relative)
        self.assertEqual(errors, sorted(errors, reverse=True))
        info = json.loads(self.succeed("info", "x.json", "--json"))
        self.assertEqual((info["balls"], [level["balls"] for level in info["levels"]]), (40, [5, 15, 40]))
        self.assertIn("holds metaballs", self.succeed("info", "x.json"))

    def test_methods(self):
        errors = [self.fit("--balls", "25", "-o", "x.json", "--method", m)["levels"][0]["relative_l2"]
                  for m in ("man", "weights", "refined")]
        self.assertEqual(errors, sorted(errors, reverse=True))
        self.fit("--balls", "25", "-o", "s.json", "--signed", "--effort", "0.5")
        self.assertEqual(len(self.read("s.json")["balls"]), 25)

    def test_any_volume_and_any_number_of_threads(self):
        for name in ("m.vdb", "m.dds"):
            self.succeed("convert", "m.raw", name)
        for name, map_name, threads in (("a", "m.raw", "1"), ("b", "m.vdb", "3")):
            self.fit("--balls", "12", "--effort", "0.3", "-o", name + ".json", "--threads", threads, map_name=map_name)
        self.assertEqual((self.folder / "a.json").read_bytes(), (self.folder / "b.json").read_bytes())
        # A DDS says nothing of metres: voxels of one, the first at 0.
        r = self.fit("--balls", "12", "--effort", "0.3", "-o", "c.json", map_name="m.dds")
        self.assertEqual((r["voxel_size_m"], r["first_voxel_m"]), ([1, 1, 1], [0, 0, 0]))

    def test_resume_with_densities_alone(self):
        first = self.fit("--balls", "10", "--method", "man", "-o", "x.json")["levels"][0]["relative_l2"]
        better = self.fit("--resume", "x.json", "--method", "weights", "-o", "y.json")["levels"][0]["relative_l2"]
        self.assertLess(better, 0.99 * first)

    def test_resume_goes_on_from_the_same_error(self):
        first = self.fit("--balls", "30", "--method", "weights", "-o", "x.json")["levels"][0]["relative_l2"]
        same = self.fit("--resume", "x.json", "--time-limit", "0", "-o", "y.json")["levels"][0]["relative_l2"]
        self.assertAlmostEqual(first, same, places=5)
        better = self.fit("--resume", "y.json", "--balls", "10,30", "-o", "y.json")["levels"]
        self.assertEqual([level["k"] for level in better], [10, 30])
        self.assertLess(better[1]["relative_l2"], 0.95 * first)

    def test_interruption_keeps_the_best_so_far(self):
        process = subprocess.Popen([PROGRAM, "fit", "m.raw", "--balls", "4,300", "--effort", "100", "-o", "x.json"],
                                   cwd=self.folder, stderr=subprocess.PIPE)
        time.sleep(3.0)
        process.send_signal(signal.SIGINT)
        self.assertEqual(process.communicate(timeout=60)[1], b"welkin: interrupted\n")
        self.assertEqual(process.returncode, 130)
        balls = self.read("x.json")["balls"]
        self.assertIn(len(balls), (4, 300))
        self.assertLess(self.error_of(balls)[0], 0.8)
        self.succeed("fit", "m.raw", "--resume", "x.json", "--time-limit", "0.5", "-o", "y.json")

    def test_metaballs_without_a_map(self):
        self.succeed("cloud", "--cumulus", "--width", "900", "--height", "700", "--dynamics", "0.5", "-o", "x.json", "--report",
                     "r.json")
        balls = self.read("x.json")["balls"]
        self.assertEqual(len(balls), self.read("r.json")["balls"])
        self.assertGreater(len(balls), 50)
        self.assertAlmostEqual(field_at(balls, (0, 0, 300)), 0.5, delta=0.25)
        self.assertLess(field_at(balls, (0, 0, -80)), 0.02)
        for how in ("splats", "volume"):
            self.succeed("render", "x.json", "--size", "32x18", "--quality", "low", "--metaballs-as", how, "-o", how + ".png")
        self.fail_with(2, "--metaballs-as", "render", "x.json", "--metaballs-as", "balls", "-o", "y.png")
        self.fail_with(2, "metaballs are grown by --cumulus", "cloud", "-o", "y.json")
        self.fail_with(2, "neither voxels nor noise", "cloud", "--cumulus", "--octaves", "3", "-o", "y.json")
        self.fail_with(2, "are for volumes", "cloud", "--cumulus", "--preview", "p.png", "-o", "y.json")

    def test_metaballs_as_a_volume(self):
        self.fit("--balls", "20", "--effort", "0", "-o", "x.json")
        self.succeed("cloud", "--metaballs", "x.json", "--size", "24x18x12", "--voxel", "40", "--dynamics", "2", "-o", "v.raw")
        side, balls = self.read("v.raw.json"), self.read("x.json")["balls"]
        self.assertEqual(side["first_voxel_m"], self.read("m.raw.json")["first_voxel_m"])
        values = struct.unpack("<5184f", (self.folder / "v.raw").read_bytes())
        for i in range(0, 5184, 97):
            at = (i % 24, i // 24 % 18, i // (24 * 18))
            expected = 2 * field_at(balls, [f + 40 * n for f, n in zip(side["first_voxel_m"], at)])
            self.assertAlmostEqual(values[i], expected, places=5)
        self.succeed("cloud", "--metaballs", "x.json", "--voxel", "60", "-o", "v.vdb")
        ball = {"center_m": [0, 0, -100], "radius_m": 200, "density": 1}
        self.write("low.json", json.dumps({"welkin": "metaballs", "balls": [ball]}))
        self.succeed("cloud", "--metaballs", "low.json", "--voxel", "40", "-o", "low.raw")
        side = self.read("low.raw.json")
        self.assertEqual(side["first_voxel_m"][2], -300)
        self.assertGreaterEqual(side["first_voxel_m"][2] + 40 * side["size"][2], 100)
        self.write("none_above_0.json", json.dumps({"welkin": "metaballs", "balls": [{**ball, "density": -1}]}))
        self.fail_with(1, "none_above_0.json: the cloud is empty", "cloud", "--metaballs", "none_above_0.json", "-o", "w.raw")
        self.fail_with(2, "go with --metaballs", "cloud", "--metaballs", "x.json", "--octaves", "2", "-o", "v.raw")
        self.fail_with(2, "expected one of them", "cloud", "--metaballs", "x.json", "--cumulus", "-o", "w.raw")
        self.fail_with(1, "none.json: cannot be opened", "cloud", "--metaballs", "none.json", "-o", "w.raw")

    def test_kinds_of_files(self):
        self.fail_with(2, "x.foo: unknown extension .foo; expected .vdb, .raw, .dds, or .json with --cumulus", "cloud", "-o", "x.foo")
        self.fail_with(2, "fit: m.foo: unknown extension .foo; expected .dds, .raw or .vdb", "fit", "m.foo", "--balls", "3", "-o", "x.json")

    def test_wrong_calls(self):
        for args, message in (((), "expected -o OUT.json"), (("-o", "x.json"), "expected --balls K"),
                              (("-o", "x.vdb", "--balls", "3"), "x.vdb is no .json"),
                              (("-o", "x.json", "--balls", "3", "--method", "best"), "method"),
                              (("-o", "x.json", "--balls", "3", "--method", "man", "--signed"), "--signed goes with"),
                              (("-o", "x.json", "--balls", "3", "--ball", "4"), "did you mean --balls?"),
                              (("-o", "x.json", "--balls", "3", "--time-limit", "-1"), "--time-limit"),
                              (("-o", "x.json", "--balls", "3", "--report", "./x.json"), "is written already"),
                              (("-o", "x.json", "--balls", "3", "--report", "m.raw"), "--report: m.raw is read"),
                              (("-o", "m.raw.json", "--balls", "3"), "-o: m.raw.json is read"),
                              (("-o", "x.json", "--resume", "r.json", "--report", "r.json"), "--report: r.json is read")):
            self.fail_with(2, message, "fit", "m.raw", *args)
        for balls in ("0", "3,", ",3", "3.5", "-1", "many", "3 4", "99999999999999999999"):
            self.fail_with(2, "--balls: expected whole numbers", "fit", "m.raw", "-o", "x.json", "--balls=" + balls)
        self.fail_with(2, "expected a MAP", "fit", "-o", "x.json", "--balls", "3")
        self.fail_with(2, "unknown extension .gif", "fit", "m.gif", "-o", "x.json", "--balls", "3")

    def test_bad_maps(self):
        def refuse(message, name, balls="3"):
            self.fail_with(1, message, "fit", name, "-o", "x.json", "--balls", balls)

        def volume(name, size, values):
            (self.folder / name).write_bytes(struct.pack(f"<{len(values)}f", *values))
            side = {"version": 1, "size": size, "channels": "r", "type": "float32", "byte_order": "little"}
            self.write(name + ".json", json.dumps(side))

        refuse("none.vdb", "none.vdb")
        volume("zero.raw", [3, 3, 3], [0] * 27)
        refuse("cannot fit zero.raw: the map is empty: its density is 0 everywhere", "zero.raw")
        volume("holes.raw", [3, 3, 3], [-1] * 27)
        refuse("cannot fit holes.raw: the map's density is nowhere above 0; expected some, or a signed fit", "holes.raw")
        volume("much.raw", [3, 3, 3], [3e38] * 27)
        refuse("cannot fit much.raw: the largest density of the map is 3e+38; expected 1e-27 to 1e+27", "much.raw")
        volume("nan.raw", [2, 1, 1], [1, math.nan])
        refuse("nan.raw", "nan.raw")
        volume("one.raw", [1, 1, 1], [0.5])
        refuse("3 balls are more than the map has voxels of cloud; expected at most 1", "one.raw")
        r = self.fit("--balls", "1", "-o", "x.json", map_name="one.raw")
        self.assertLess(r["levels"][0]["relative_l2"], 1e-3)
        volume("flat.raw", [4, 4, 4], [0.25] * 64)
        self.fit("--balls", "8", "-o", "x.json", map_name="flat.raw")
        (self.folder / "x.json").unlink()
        volume("short.raw", [4, 4, 4], [0.25] * 63)
        refuse("short.raw", "short.raw")
        self.succeed("noise", "--size", "8x8", "-o", "p.png")
        refuse("p.png is a picture; expected a volume", "p.png")
        self.succeed("noise", "--size", "8x8x8", "--kind", "perlin-worley", "-o", "c.dds")
        refuse("c.dds has 4 channels", "c.dds")

    def test_bad_files_to_resume_from(self):
        self.write("bad.json", '{"welkin": "metaballs", "balls": [{"center_m": [0, 0, 0], "radius_m": -1, "density": 1}]}')
        args = ("fit", "m.raw", "-o", "x.json", "--resume")
        self.fail_with(1, "none.json: cannot be opened", *args, "none.json")
        self.fail_with(1, "bad.json: ball 0: the radius is -1", *args, "bad.json")
        self.fail_with(1, "m.raw.json: holds no metaballs", *args, "m.raw.json")
        self.write("two.json", json.dumps({"welkin": "metaballs", "balls": [{"center_m": [0, 0, 200], "radius_m": 90, "density": d}
                                                                             for d in (1, -1)]}))
        self.fail_with(2, "two.json has levels of 2 balls; expected one of them in --balls", *args, "two.json", "--balls", "3")
        self.fail_with(1, "negative densities; expected a signed fit", *args, "two.json")
        self.write("away.json", json.dumps({"welkin": "metaballs", "balls": [{"center_m": [1e6, 0, 0], "radius_m": 90, "density": 1}]}))
        self.fail_with(1, "cannot fit m.raw: none of the balls to go on from is within the map", *args, "away.json")
        self.write("cut.json", (self.folder / "two.json").read_text()[:-9])
        self.fail_with(1, "cut.json:1:", *args, "cut.json")
        self.write("twice.json", (self.folder / "two.json").read_text().replace('"density": -1', '"density": 2, "density": 1'))
        self.fail_with(1, "twice.json: ball 1: density is there twice; expected it once", *args, "twice.json")
        self.fail_with(1, "bad.json: ball 0: the radius is -1", "info", "bad.json")

    def test_what_cannot_be_written(self):
        args = ("fit", "m.raw", "--balls", "3", "--effort", "0")
        self.fail_with(1, "cannot write none/x.json: No such file or directory", *args, "-o", "none/x.json")
        (self.folder / "full.json").symlink_to("/dev/full")
        self.fail_with(1, "cannot write full.json: No space left on device", *args, "-o", "full.json")


if __name__ == "__main__":
    main()
