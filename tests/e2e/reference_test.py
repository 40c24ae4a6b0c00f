# SPDX-License-Identifier: Apache-2.0
"""`welkin render --renderer reference` of skies: pictures, what EXRs say of them, determinism, going on, and bad input."""
import json
import resource
import signal
import subprocess
import time

from welkin_program import CUMULUS, PROGRAM, ProgramTest, main

SMALL = ["--size", "16x9", "--renderer", "reference"]


class Reference(ProgramTest):
    def trace(self, out, *flags):
        self.succeed("render", *CUMULUS, *SMALL, "-o", out, "--report", "r.json", *flags)
        return json.loads((self.folder / "r.json").read_text())

    def read(self, name):
        return (self.folder / name).read_bytes()

    def test_threads_change_nothing_and_seeds_do(self):
        self.trace("one.exr", "--spp", "4", "--threads", "1")
        report = self.trace("two.exr", "--spp", "4", "--threads", "2")
        self.assertEqual(self.read("one.exr"), self.read("two.exr"))
        self.assertEqual((report["renderer"], report["samples"], report["complete"]), ("reference", 4, True))
        self.assertGreater(report["scattering_events"], 0)
        self.trace("other.exr", "--spp", "4", "--seed", "2")
        self.assertNotEqual(self.read("one.exr"), self.read("other.exr"))

    def test_an_exr_says_how_well_it_is_known(self):
        self.trace("sky.exr", "--spp", "4")
        header = self.read("sky.exr")[:2000]
        for name in (b"opacity\0", b"error\0", b"welkin_samples\0"):
            self.assertIn(name, header)
        self.succeed("compare", "sky.exr", "sky.exr")  # and is a picture like any other

    def test_goes_on_as_if_nothing_had_happened(self):
        self.trace("whole.exr", "--spp", "6")
        self.trace("part.exr", "--spp", "2", "--resume", "state.exr")
        report = self.trace("resumed.exr", "--spp", "6", "--resume", "state.exr")
        self.assertEqual(report["samples"], 6)
        self.assertEqual(self.read("whole.exr"), self.read("resumed.exr"))
        self.fail_with(1, "of another scene", "render", *CUMULUS, *SMALL, "-o", "x.exr", "--spp", "8", "--seed", "5",
                       "--resume", "state.exr")
        self.fail_with(1, "of another scene", "render", *CUMULUS, *SMALL, "-o", "x.exr", "--spp", "8", "--droplets", "mie",
                       "--resume", "state.exr")
        self.fail_with(1, "--resume whole.exr", "render", *CUMULUS, *SMALL, "-o", "x.exr", "--spp", "8",
                       "--resume", "whole.exr")
        (self.folder / "broken.exr").write_bytes(self.read("state.exr")[:400])
        self.fail_with(1, "broken.exr", "render", *CUMULUS, *SMALL, "-o", "x.exr", "--spp", "8", "--resume", "broken.exr")

    def test_goes_on_for_the_same_light_alone(self):
        def ball(radius):
            self.write("b.json", json.dumps({"welkin": "metaballs", "balls": [{"center_m": [0, 0, 0], "radius_m": radius, "density": 1}]}))
        ball(400)
        self.write("s.toml", '[[metaballs]]\nfile = "b.json"\n[output]\nquality = "high"\n')
        sky = ("render", "s.toml", *SMALL, "-o", "x.exr", "--resume", "state.exr", "--spp")
        self.succeed(*sky, "1")
        # What is done with the light afterwards, and how files are spelt, changes no path.
        for flags in (("--exposure", "14"), ("--quality", "low")):
            self.succeed(*sky, "1", *flags)
        self.write("s.toml", '[[metaballs]]\nfile = "./b.json"\n[output]\nflare = 0.01\nfps = 30\nspeed = 2\n')
        self.succeed(*sky, "2")
        ball(401)
        self.fail_with(1, "of another scene", *sky, "3")

    def test_refuses_to_write_over_what_is_traced_so_far(self):
        self.trace("part.exr", "--spp", "2", "--resume", "state.exr")
        state = self.read("state.exr")
        for out, more in (("state.exr", ()), ("./state.exr", ()), ("x.exr", ("--report", "state.exr"))):
            self.fail_with(2, "state.exr is written already, by ", "render", *CUMULUS, *SMALL, "-o", out, "--spp", "4",
                           "--resume", "state.exr", *more)
        self.fail_with(2, "--resume: new.exr is written already, by -o", "render", *CUMULUS, *SMALL, "-o", "new.exr", "--spp", "4",
                       "--resume", "new.exr")
        self.assertEqual(self.read("state.exr"), state)

    def test_a_state_that_cannot_be_written(self):
        sky = ("render", *CUMULUS, *SMALL, "--spp", "2")
        # Before anything is traced.
        self.fail_with(1, "cannot write none/state.exr: No such file or directory", *sky, "-o", "x.exr", "--resume", "none/state.exr")
        self.fail_with(1, "cannot write /proc/state.exr: ", *sky, "-o", "x.exr", "--resume", "/proc/state.exr")
        # At the end: the picture and the report are not lost with it.
        limit = 4000  # bytes of a file, above those of a small PNG
        command = [PROGRAM, *sky, "-o", "x.png", "--resume", "state.exr"]
        done = subprocess.run(command, cwd=self.folder, capture_output=True, timeout=300,
                              preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (limit, limit)))
        self.assertEqual(done.returncode, 1)
        self.assertEqual(done.stderr.count(b"\n"), 1)
        self.assertIn(b"welkin: cannot write state.exr: File too large; the picture is written", done.stderr)
        self.assertEqual(self.files(), ["x.png"])
        self.succeed("info", "x.png")

    def test_stops_at_the_noise(self):
        report = self.trace("sky.png", "--noise", "0.3")
        self.assertLessEqual(report["noise"], 0.3)
        self.assertGreaterEqual(report["samples"], 16)
        report = self.trace("sky.png", "--noise", "0.01", "--spp", "3")
        self.assertEqual(report["samples"], 3)

    def test_interrupted_it_keeps_what_there_is(self):
        command = [PROGRAM, "render", *CUMULUS, *SMALL, "-o", "sky.exr", "--noise", "0.0001"]
        with subprocess.Popen(command, cwd=self.folder, stderr=subprocess.PIPE) as process:
            deadline = time.monotonic() + 60
            time.sleep(4)
            while not self.interrupted(process) and time.monotonic() < deadline:
                time.sleep(1)
            self.assertEqual(process.returncode, 130)
        self.assertTrue((self.folder / "sky.exr").exists())
        self.assertTrue((self.folder / "sky.exr.resume.exr").exists())
        self.trace("sky.exr", "--spp", "1", "--resume", "sky.exr.resume.exr")  # no more paths are needed

    def interrupted(self, process):
        process.send_signal(signal.SIGINT)
        try:
            process.communicate(timeout=30)
        except subprocess.TimeoutExpired:
            return False
        return True

    def test_every_projection(self):
        for projection, size in (("fisheye", "12x12"), ("equirect", "16x8"), ("cubemap", "24x4")):
            self.succeed("render", *CUMULUS, "--renderer", "reference", "--projection", projection, "--size", size,
                         "--spp", "1", "-o", f"{projection}.png")

    def test_bad_input(self):
        sky = ("render", *CUMULUS, "-o", "x.png")
        self.fail_with(2, "belongs to the reference renderer", *sky, "--spp", "4")
        self.fail_with(2, "expected gpu or reference", *sky, "--renderer", "cpu")
        self.fail_with(2, "--spp: expected a whole number", *sky, "--renderer", "reference", "--spp", "0")
        self.fail_with(2, "--droplets", *sky, "--droplets", "ice")
        self.fail_with(2, "draws one picture", "render", *CUMULUS, "--renderer", "reference", "-o", "x.mp4")
        self.fail_with(1, "does not trace", *sky, "--renderer", "reference", "--technique", "plane", "--spp", "1")


if __name__ == "__main__":
    main()
