# SPDX-License-Identifier: Apache-2.0
"""Pictures: that they are there, say what they should, do not depend on threads, and that Ctrl-C leaves nothing."""
import json
import os
import select
import signal
import struct
import subprocess
import time
import zlib

from welkin_program import CUMULUS, PROGRAM, TINY, ProgramTest, main


def read_png(path):
    """Width, height, bits a channel and the pixels' raw, filtered rows."""
    data = path.read_bytes()
    assert data[:8] == b"\x89PNG\r\n\x1a\n"
    at, chunks = 8, {}
    while at < len(data):
        length, kind = struct.unpack(">I4s", data[at:at + 8])
        chunks[kind] = chunks.get(kind, b"") + data[at + 8:at + 8 + length]
        at += 12 + length
    width, height, bits = struct.unpack(">IIB", chunks[b"IHDR"][:9])
    return width, height, bits, zlib.decompress(chunks[b"IDAT"])


class Stills(ProgramTest):
    def test_png_of_8_and_16_bits(self):
        self.succeed("render", *CUMULUS, *TINY, "-o", "a.png")
        width, height, bits, rows = read_png(self.folder / "a.png")
        self.assertEqual((width, height, bits), (96, 54, 8))
        self.assertGreater(len(set(rows)), 40, "the picture has next to no content")
        self.succeed("render", *CUMULUS, *TINY, "-o", "b.png", "--bits", "16")
        self.assertEqual(read_png(self.folder / "b.png")[:3], (96, 54, 16))
        self.assertEqual(self.files(), ["a.png", "b.png"])

    def test_report(self):
        self.succeed("render", *CUMULUS, *TINY, "-o", "a.exr", "--report", "r.json", "--seed", "5", "--at", "600")
        r = json.loads((self.folder / "r.json").read_text())
        self.assertEqual(r["seed"], 5)
        self.assertEqual(r["renderer"], "gpu")
        self.assertEqual(r["time"], "2026-06-21T12:30:00Z")
        self.assertAlmostEqual(r["sun"]["elevation_deg"], 62.5, delta=3)
        self.assertEqual(len(r["layers"]), 1)
        layer = r["layers"][0]
        self.assertEqual(layer["genus"], "cumulus")
        self.assertAlmostEqual(layer["base_m"], 4000 * 0.3048, delta=1)
        self.assertGreater(layer["top_m"], layer["base_m"])
        for cover in (layer, r["sky_cover"]):
            self.assertTrue(3 <= cover["requested_oktas"] <= 4, cover)  # SCT
            self.assertAlmostEqual(cover["delivered_oktas"], cover["requested_oktas"], delta=0.5)
        self.assertTrue(r["passes"])
        for p in r["passes"]:
            self.assertGreaterEqual(p["ms"], 0)
        self.assertGreater(r["total_ms"], 0)
        self.assertGreater(r["peak_rss_mib"], 10)
        self.assertLess(r["peak_rss_mib"], 1536)
        self.assertEqual(r["scene"]["at_s"], 600)
        for key in ("moon", "planets", "notes", "device", "metar", "heading_deg", "exposure_ev", "place"):
            self.assertIn(key, r)
        self.assertNotIn("frames", r)
        info = json.loads(self.succeed("info", "a.exr", "--json"))
        self.assertEqual((info["width"], info["height"], info["channels"]), (96, 54, 3))
        self.assertGreater(info["mean"], 500)  # cd/m2 at noon
        self.assertGreaterEqual(info["min"], 0)
        self.assertEqual(info["meaning"], "linear Rec. 709, cd/m2")
        self.assertEqual(info["metadata"]["welkin_time"], r["time"])
        self.assertEqual(info["metadata"]["welkin_metar"], r["metar"])

    def test_an_overcast_of_metaballs(self):
        self.succeed("render", "--metar", "LSZH 211150Z 28010KT 9999 OVC015 10/05 Q1000", "--technique", "metaballs", *TINY, "-o", "a.png",
                     "--report", "r.json")
        r = json.loads((self.folder / "r.json").read_text())
        self.assertGreater(r["layers"][0]["delivered_oktas"], 7.6)
        self.assertEqual(r["notes"], [])
        self.assertEqual(r["time"], "2026-06-21T11:50:00Z", "the report's own")

    def test_time_far_from_the_reports(self):
        self.write("s.toml", 'metar = "LSZH 031150Z 28010KT CAVOK 10/05 Q1000"\n')
        self.succeed("render", "s.toml", "--technique", "plane", *TINY, "-o", "a.png", "--report", "r.json")
        self.assertEqual(json.loads((self.folder / "r.json").read_text())["time"], "2026-06-03T11:50:00Z")
        self.succeed("render", "s.toml", "--time", "2026-06-04T11:50Z", "--technique", "plane", *TINY, "-o", "a.png", "--report",
                     "r.json")
        r = json.loads((self.folder / "r.json").read_text())
        self.assertEqual(r["time"], "2026-06-04T11:50:00Z")
        self.assertIn("The report is of day 3 at 11:50 UTC; its weather is drawn for 2026-06-04T11:50:00Z.", r["notes"])

    def test_sheets_among_volumes(self):
        (self.folder / "s.toml").write_text(
            '[[layer]]\ngenus = "cumulus"\n[[layer]]\ngenus = "cirrus"\ntechnique = "skyplane"\n'
            "[[sheet]]\nheight_m = 700\ntexels = 64\noktas = 2\n")
        self.succeed("render", "s.toml", "--projection", "fisheye", "--size", "32x32", "--quality", "low", "-o", "a.exr",
                     "--report", "r.json")
        r = json.loads((self.folder / "r.json").read_text())
        self.assertEqual([layer["technique"] for layer in r["layers"]], ["volume", "skyplane"])
        self.assertEqual(len(r["sheets"]), 1)
        self.assertAlmostEqual(r["sheets"][0]["delivered_oktas"], 2, delta=0.1)
        self.assertGreater(r["sky_cover"]["delivered_oktas"], r["layers"][0]["delivered_oktas"] + 1)

    def test_projections_have_their_sizes(self):
        for projection, size in (("fisheye", "64x64"), ("equirect", "96x48"), ("cubemap", "96x16")):
            self.succeed("render", *CUMULUS, "--quality", "low", "--size", size, "--projection", projection, "-o", "p.png")
            self.assertEqual(read_png(self.folder / "p.png")[:2], tuple(map(int, size.split("x"))))

    def test_scene_file_equals_flags(self):
        self.write("s.toml", 'time = 2026-06-21T12:20:00Z\nseed = 3\nmetar = "%s"\n[place]\nlatitude_deg = 47.46\n'
                   "longitude_deg = 8.55\naltitude_m = 430\n[output]\nwidth = 96\nheight = 54\nquality = \"low\"\n" % CUMULUS[1])
        self.succeed("render", "s.toml", "-o", "file.exr")
        self.succeed("render", *CUMULUS, *TINY, "--seed", "3", "-o", "flags.exr")
        self.assertEqual((self.folder / "file.exr").read_bytes(), (self.folder / "flags.exr").read_bytes())


class Determinism(ProgramTest):
    def test_same_bytes_with_one_and_two_threads(self):
        for name, runs in (("x.exr", ("1", "2", "2")), ("x.png", ("1", "2"))):
            pictures = []
            for threads in runs:
                self.succeed("render", *CUMULUS, *TINY, "-o", name, "--threads", threads)
                pictures.append((self.folder / name).read_bytes())
            self.assertEqual(pictures[0], pictures[1], name + ": one and two threads differ")
            self.assertEqual(pictures[1], pictures[-1], name + ": two runs differ")

    def test_seeds_differ(self):
        for seed in ("1", "2"):
            self.succeed("render", *CUMULUS, *TINY, "-o", seed + ".png", "--seed", seed)
        self.assertNotEqual((self.folder / "1.png").read_bytes(), (self.folder / "2.png").read_bytes())


class Frames(ProgramTest):
    def test_heading_is_the_same_at_all_instants(self):
        self.succeed("render", *CUMULUS, *TINY, "-o", "f_%d.png", "--frames", "2", "--fps", "1", "--speed", "7200", "--report", "f.json")
        self.succeed("render", *CUMULUS, *TINY, "-o", "still.png", "--at", "7200", "--report", "s.json")
        headings = [json.loads((self.folder / name).read_text())["heading_deg"] for name in ("f.json", "s.json")]
        self.assertEqual(*headings)
        self.assertEqual((self.folder / "f_1.png").read_bytes(), (self.folder / "still.png").read_bytes())

    def test_each_frame_is_the_still_of_its_instant(self):
        look = ["--look", "180,15"]
        self.succeed("render", *CUMULUS, *TINY, *look, "-o", "f_%03d.png", "--frames", "3", "--fps", "2", "--speed", "120",
                     "--report", "r.json")
        self.assertEqual(self.files(), ["f_000.png", "f_001.png", "f_002.png", "r.json"])
        self.succeed("render", *CUMULUS, *TINY, *look, "-o", "still.png", "--at", "120")
        self.assertEqual((self.folder / "f_002.png").read_bytes(), (self.folder / "still.png").read_bytes())
        frames = json.loads((self.folder / "r.json").read_text())["frames"]
        self.assertEqual([f["time"] for f in frames],
                         ["2026-06-21T12:20:00Z", "2026-06-21T12:21:00Z", "2026-06-21T12:22:00Z"])
        self.assertEqual([f["path"] for f in frames], ["f_000.png", "f_001.png", "f_002.png"])


class LivingOctaves(ProgramTest):
    LIVING = [*CUMULUS, *TINY, "--technique", "octaves", "--look", "180,30"]

    def test_each_frame_is_the_still_of_its_instant(self):
        self.succeed("render", *self.LIVING, "-o", "f_%d.png", "--frames", "3", "--fps", "2", "--speed", "120", "--report",
                     "r.json")
        self.succeed("render", *self.LIVING, "-o", "still.png", "--at", "120")
        self.assertEqual((self.folder / "f_2.png").read_bytes(), (self.folder / "still.png").read_bytes())
        self.assertNotEqual((self.folder / "f_0.png").read_bytes(), (self.folder / "f_2.png").read_bytes())
        r = json.loads((self.folder / "r.json").read_text())
        self.assertEqual(r["scene"]["technique"], "octaves")
        cover = r["layers"][0]
        self.assertAlmostEqual(cover["delivered_oktas"], cover["requested_oktas"], delta=0.5)

    def test_scene_files_choose_kernels_and_blends(self):
        pictures = set()
        for kernel in ("gradient", "pallister", "course"):
            for blend in ("variance-preserving", "linear"):
                self.write("s.toml", 'technique = "octaves"\n[octaves]\nresolution = 128\ncount = 4\nkernel = "%s"\nblend = "%s"\n'
                           % (kernel, blend))
                self.succeed("render", "s.toml", *self.LIVING, "--at", "100", "-o", "x.png")
                pictures.add((self.folder / "x.png").read_bytes())
        self.assertEqual(len(pictures), 6)

    def test_what_cannot_live_is_said(self):
        self.write("s.toml", 'technique = "dome"\n[[sheet]]\nsurface = "dome"\ntexels = 64\npattern = "octaves"\n')
        message = self.fail_with(1, "living octaves", "render", "s.toml", "-o", "x.png")
        self.assertIn("expected surface plane, skyplane or hemisphere", message)


class Interruption(ProgramTest):
    """The signal is sent once the program has shown that it is at work, on its terminal or by its files, and never after a time that
    another machine may need for starting."""
    DEADLINE_S = 240
    LARGE = [*CUMULUS, "--size", "1920x1080", "--quality", "ultra"]

    def start(self, *args, stderr):
        process = subprocess.Popen([PROGRAM, "render", *args], cwd=self.folder, stderr=stderr, start_new_session=True)
        self.addCleanup(process.wait)
        self.addCleanup(process.kill)
        return process

    def interrupt_on_terminal(self, *args, updates=1, number=signal.SIGINT):
        """Interrupts after the progress line has said `updates` times that it is drawing."""
        ours, its = os.openpty()
        self.addCleanup(os.close, ours)
        process = self.start(*args, stderr=its)
        os.close(its)
        said, sent, deadline = b"", False, time.monotonic() + self.DEADLINE_S
        while select.select([ours], [], [], max(0, deadline - time.monotonic()))[0]:
            try:
                said += os.read(ours, 4096)
            except OSError:  # the program has closed its end, which is how terminals say so
                break
            if not sent and said.count(b"\rdrawing") >= updates:
                os.killpg(process.pid, number)  # as a terminal does
                sent = True
        self.assertTrue(sent, said)
        self.assertEqual(process.wait(self.DEADLINE_S), 130, said)
        self.assertTrue(said.endswith(b"\r\x1b[Kwelkin: interrupted\r\n"), said)

    def test_still(self):
        self.interrupt_on_terminal(*self.LARGE, "-o", "x.png", "--report", "r.json")
        self.assertEqual(self.files(), [])

    def test_an_older_picture_stays(self):
        self.write("x.exr", "old")
        self.interrupt_on_terminal(*self.LARGE, "-o", "x.exr", number=signal.SIGTERM)
        self.assertEqual(self.files(), ["x.exr"])
        self.assertEqual((self.folder / "x.exr").read_text(), "old")

    def test_video(self):
        self.interrupt_on_terminal(*CUMULUS, *TINY, "-o", "x.mp4", "--frames", "100000", updates=5)
        self.assertEqual(self.files(), [])

    def test_frames_are_whole(self):
        process = self.start(*CUMULUS, *TINY, "-o", "f_%06d.png", "--frames", "100000", stderr=subprocess.PIPE)
        deadline = time.monotonic() + self.DEADLINE_S
        while len(list(self.folder.glob("f_*.png"))) < 2:
            self.assertIsNone(process.poll(), "ended by itself")
            self.assertLess(time.monotonic(), deadline)
            time.sleep(0.02)
        os.killpg(process.pid, signal.SIGINT)
        _, stderr = process.communicate(timeout=self.DEADLINE_S)
        self.assertEqual(process.returncode, 130)
        self.assertEqual(stderr, b"welkin: interrupted\n")
        for name in self.files():
            self.assertEqual(read_png(self.folder / name)[:2], (96, 54))


if __name__ == "__main__":
    main()
