# SPDX-License-Identifier: Apache-2.0
"""`welkin render --renderer reference` of slabs: the report, its determinism, stopping, and bad input."""
import json
import signal
import subprocess
import time

from welkin_program import CUMULUS, PROGRAM, ProgramTest, main

STEPS = """[slab]
sun_zenith_deg = 60
[[slab_column]]
optical_depth = 2
count = 16
[[slab_column]]
optical_depth = 18
count = 16
"""


class Slab(ProgramTest):
    def trace(self, *flags):
        self.succeed("render", "slab.toml", "--renderer", "reference", "--report", "r.json", *flags)
        return json.loads((self.folder / "r.json").read_text())

    def test_a_slab_reflects_what_the_literature_says(self):
        self.write("slab.toml", "[slab]\noptical_depth = 4\nasymmetry = 0\n")
        report = self.trace("--noise", "0.002")
        r = report["slab"]["reflectance"]
        self.assertAlmostEqual(r["value"], 0.6909262, delta=3 * r["standard_error"])
        self.assertLessEqual(r["standard_error"], 0.002 * r["value"])
        self.assertEqual((report["renderer"], report["complete"], len(report["columns"])), ("reference", True, 1))
        self.assertEqual(report["scene"]["slab"]["optical_depth"], 4)

    def test_columns_and_threads(self):
        self.write("slab.toml", STEPS)
        one = self.trace("--spp", "1100", "--threads", "1")
        two = self.trace("--spp", "1100", "--threads", "2")
        self.assertEqual(one["columns"], two["columns"])
        self.assertEqual(len(one["columns"]), 32)
        self.assertEqual(one["paths"], 9 * 4093)
        thin, thick = (sum(c["reflectance"]["value"] for c in one["columns"][a : a + 16]) for a in (0, 16))
        self.assertGreater(thick, 1.2 * thin)

    def test_interrupted_it_keeps_the_best(self):
        self.write("slab.toml", STEPS)
        command = [PROGRAM, "render", "slab.toml", "--renderer", "reference", "--report", "r.json", "--noise", "0.00001"]
        with subprocess.Popen(command, cwd=self.folder, stderr=subprocess.PIPE) as process:
            time.sleep(2)
            process.send_signal(signal.SIGINT)
            process.communicate(timeout=120)
            self.assertEqual(process.returncode, 130)
        report = json.loads((self.folder / "r.json").read_text())
        self.assertFalse(report["complete"])
        self.assertGreater(report["paths"], 0)

    def test_bad_input(self):
        self.write("slab.toml", "[slab]\noptical_depth = 1\n")
        slab = ("render", "slab.toml")
        self.fail_with(2, "expected --renderer reference", *slab, "-o", "x.png")
        self.fail_with(2, "a slab has no picture", *slab, "--renderer", "reference", "-o", "x.png")
        self.fail_with(2, "expected --report FILE.json", *slab, "--renderer", "reference")
        for flag, value in (("--metar", CUMULUS[1]), ("--at", "60"), ("--theme", "thesis-few"), ("--look", "0,10"), ("--size", "64x36"),
                            ("--projection", "fisheye"), ("--quality", "low"), ("--exposure", "15"), ("--droplets", "mie")):
            self.fail_with(2, flag + " is for pictures of skies", *slab, "--renderer", "reference", "--report", "r.json", flag, value)
        self.write("dark.toml", "[slab]\noptical_depth = 1\n[ground]\nalbedo = [0.3, 0.3, 0.3]\n")
        self.fail_with(1, "dark.toml:4:10: albedo in [ground] has no effect beside a slab; did you mean ground_albedo in [slab]?",
                       "render", "dark.toml", "--renderer", "reference", "--report", "r.json")
        self.fail_with(2, "--noise: expected a number", *slab, "--renderer", "reference", "--noise", "0")
        self.write("slab.toml", STEPS.replace("[slab]", "[slab]\noptical_depth = 1"))
        self.fail_with(1, "slab has an optical_depth and columns", *slab, "--renderer", "reference", "--report", "r.json")


if __name__ == "__main__":
    main()
