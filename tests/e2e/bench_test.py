# SPDX-License-Identifier: Apache-2.0
"""`welkin bench truth` and `tracer`: tables, pictures, and bad input. Times are nobody's test."""
import json
import pathlib
import shutil

from welkin_program import ProgramTest, main

TRUTH = pathlib.Path(__file__).resolve().parents[2] / "bench" / "truth"


class Truth(ProgramTest):
    def setUp(self):
        super().setUp()
        (self.folder / "truth").mkdir()
        for name in ("stratus_overcast.toml", "stratus_overcast.exr"):
            shutil.copy(TRUTH / name, self.folder / "truth")

    def test_the_table(self):
        text = self.succeed("bench", "truth", "--truth", "truth", "--json", "--pictures", "strips")
        truth = json.loads(text)["truth"]
        (scene,) = truth["scenes"]
        self.assertEqual(scene["scene"], "stratus_overcast")
        self.assertLess(scene["noise"], 0.1)
        self.assertLess(scene["welkin"]["relative"], 0.10)
        # Nearly all light under an overcast has been scattered many times.
        self.assertLess(scene["single"]["bias"], -0.4)
        self.assertGreater(scene["octaves"]["relative"], scene["welkin"]["relative"])
        for name in ("single", "octaves", "welkin"):
            self.assertAlmostEqual(truth["summary"][name]["relative"], scene[name]["relative"])
        self.assertTrue((self.folder / "strips" / "stratus_overcast.png").read_bytes().startswith(b"\x89PNG"))

    def test_the_tracer(self):
        tracer = json.loads(self.succeed("bench", "tracer", "--truth", "truth", "--json"))["tracer"]
        (scene,) = tracer["scenes"]
        self.assertEqual(scene["scene"], "stratus_overcast")
        # Light is scattered many times under an overcast, and paths differ.
        self.assertGreater(scene["scatterings_per_s"], 10 * scene["paths_per_s"])
        self.assertGreater(scene["scatterings_with_chains_per_s"], scene["scatterings_per_s"])
        self.assertGreater(scene["deviation"], 0.5)
        hours = 320 * 180 * (scene["deviation"] / 0.02) ** 2 / scene["paths_per_s"] / 3600
        self.assertAlmostEqual(scene["hours_to_2_percent"] / hours, 1.0, places=3)
        # The truth's mean luminance is 14224 cd/m2 (welkin compare of the picture with itself).
        self.assertLess(abs(scene["mean_cd_m2"] - 14224), 3.5 * scene["error_cd_m2"])
        self.assertLess(scene["error_cd_m2"], 0.08 * 14224)

    def test_every_scene_has_its_truth(self):
        scenes = sorted(p.stem for p in TRUTH.glob("*.toml"))
        self.assertGreaterEqual(len(scenes), 12)
        self.assertEqual(scenes, sorted(p.stem for p in TRUTH.glob("*.exr")))
        for path in TRUTH.glob("*.exr"):
            self.assertLessEqual(path.stat().st_size, 60 * 1024, path)

    def test_bad_input(self):
        self.fail_with(2, "expected welkin bench truth", "bench", "noise", "--truth", "truth")
        self.fail_with(2, "--pictures is for truth", "bench", "tracer", "--pictures", "strips")
        for name in ("truth", "tracer"):
            self.fail_with(1, "none: no scenes", "bench", name, "--truth", "none")
        (self.folder / "truth" / "stratus_overcast.exr").unlink()
        self.fail_with(1, "stratus_overcast.exr", "bench", "truth", "--truth", "truth")
        shutil.copy(TRUTH / "cirrus_towards.exr", self.folder / "truth" / "stratus_overcast.exr")
        self.fail_with(1, "another size", "bench", "truth", "--truth", "truth")


if __name__ == "__main__":
    main()
