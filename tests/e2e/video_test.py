# SPDX-License-Identifier: Apache-2.0
"""Video through ffmpeg."""
import json
import shutil
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


if __name__ == "__main__":
    main()
