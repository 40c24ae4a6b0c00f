# SPDX-License-Identifier: Apache-2.0
"""Video through ffmpeg."""
import json
import shutil
import signal
import subprocess
import unittest

from welkin_program import CUMULUS, TINY, ProgramTest, main


@unittest.skipUnless(shutil.which("ffprobe"), "ffmpeg is not installed")
class Video(ProgramTest):
    def probe(self, name):
        done = subprocess.run(["ffprobe", "-v", "error", "-count_frames", "-show_streams", "-of", "json", name],
                              cwd=self.folder, capture_output=True, check=True)
        (stream,) = json.loads(done.stdout)["streams"]
        return stream

    def test_mp4_and_webm(self):
        for name, codecs in (("x.mp4", {"h264"}), ("x.webm", {"vp8", "vp9", "av1"})):
            self.succeed("render", *CUMULUS, *TINY, "-o", name, "--frames", "5", "--fps", "10", "--speed", "60",
                         "--report", "r.json")
            stream = self.probe(name)
            self.assertIn(stream["codec_name"], codecs)
            self.assertEqual((stream["width"], stream["height"], stream["nb_read_frames"]), (96, 54, "5"))
            self.assertEqual(stream["r_frame_rate"], "10/1")
            frames = json.loads((self.folder / "r.json").read_text())["frames"]
            self.assertEqual(len(frames), 5)
            self.assertEqual(frames[1]["time"], "2026-06-21T12:20:06Z")
        self.assertEqual(self.files(), ["r.json", "x.mp4", "x.webm"])

    def test_started_by_one_who_ignores_children(self):
        before = signal.signal(signal.SIGCHLD, signal.SIG_IGN)  # children inherit it
        try:
            self.run_program("render", *CUMULUS, *TINY, "-o", "x.mp4", "--frames", "2", "--fps", "10")
        finally:
            signal.signal(signal.SIGCHLD, before)
        self.assertEqual(self.probe("x.mp4")["nb_read_frames"], "2")


if __name__ == "__main__":
    main()
