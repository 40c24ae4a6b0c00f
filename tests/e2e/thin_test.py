#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Thin clouds from files: patterns, themes, sky boxes."""
import json
import unittest

from welkin_program import ProgramTest, main

TINY = ["--size", "64x36", "--quality", "low"]
SCENE = 'technique = "skyplane"\ntime = 2026-06-21T10:00:00Z\n'


class ThinTest(ProgramTest):
    def test_pattern_from_a_file(self):
        self.succeed("noise", "--preset", "thesis-few", "--size", "64x64", "-o", "clouds.dds")
        self.write("s.toml", SCENE + '[[sheet]]\ntexture = "clouds.dds"\noktas = 4\n')
        self.succeed("render", "s.toml", "-o", "s.png", "--report", "s.json", *TINY)
        self.assertEqual(json.loads((self.folder / "s.json").read_text())["notes"], [])

    def test_broken_pattern_is_a_warning(self):
        self.write("bad.dds", "DDS no more")
        self.write("s.toml", SCENE + '[[sheet]]\ntexture = "bad.dds"\n[[sheet]]\ntexture = "gone.dds"\n')
        done = self.run_program("render", "s.toml", "-o", "s.png", "--report", "s.json", *TINY)
        lines = done.stderr.decode().splitlines()
        self.assertEqual(done.returncode, 0, lines)
        self.assertEqual(len(lines), 2, lines)
        for line, name in zip(lines, ["bad.dds", "gone.dds"]):
            self.assertTrue(line.startswith("welkin: warning: "), line)
            self.assertIn(name, line)
            self.assertIn("a generated texture stands in for it", line)
        notes = json.loads((self.folder / "s.json").read_text())["notes"]
        self.assertEqual(["welkin: warning: " + note for note in notes], lines)
        self.assertTrue((self.folder / "s.png").exists())

    def test_theme_saved_and_drawn(self):
        text = self.succeed("info", "--theme", "thesis-combined")
        self.assertEqual(text.count("[[sheet]]"), 3)
        self.write("mine.toml", text)
        self.succeed("render", "--theme", "thesis-combined", "-o", "a.png", *TINY)
        self.succeed("render", "--theme", "mine.toml", "-o", "b.png", *TINY)
        self.write("s.toml", 'theme = "mine.toml"\n')
        self.succeed("render", "s.toml", "-o", "c.png", *TINY)
        a, b, c = ((self.folder / name).read_bytes() for name in ("a.png", "b.png", "c.png"))
        self.assertEqual(a, b)
        self.assertEqual(a, c)
        # The theme of a scene is what a scene file holds of it.
        self.assertEqual(self.succeed("info", "--theme", "s.toml"), text)
        sheets = json.loads(self.succeed("info", "--theme", "--json", "mine.toml"))["sheet"]
        self.assertEqual([sheet["height_m"] for sheet in sheets], [1400, 1200, 900])

    def test_wrong_themes(self):
        self.fail_with(2, 'did you mean "thesis-dome"?', "render", "--theme", "thesis-dom", "-o", "a.png")
        self.fail_with(2, 'did you mean "thesis-few"?', "info", "--theme", "thesis-fwe")
        self.write("t.toml", "[[sheet]]\nheigth_m = 3\n")
        self.fail_with(1, 't.toml:2:1: unknown key "heigth_m" in [[sheet]]; did you mean "height_m"?',
                       "render", "--theme", "t.toml", "-o", "a.png")
        self.write("s.toml", SCENE + "[[sheet]]\ndensity = 0.9\nexponent = 0.001\n")
        self.fail_with(1, "density and exponent both say", "render", "s.toml", "-o", "a.png")

    def test_clouds_over_a_sky_box(self):
        self.succeed("render", "--projection", "cubemap", "--size", "96x16", "--no-sun-disc", "--time",
                     "2026-06-21T19:00:00Z", "--quality", "low", "-o", "box.exr")
        box = '[sky_box]\nstrip = "box.exr"\n'
        self.write("s.toml", SCENE + box)
        self.succeed("render", "s.toml", "-o", "a.exr", *TINY)
        self.write("c.toml", SCENE + box + "[[sheet]]\noktas = 4\n")
        self.succeed("render", "c.toml", "-o", "c.exr", *TINY)
        boxed, cloudy = (json.loads(self.succeed("info", "--json", name)) for name in ("a.exr", "c.exr"))
        strip = json.loads(self.succeed("info", "--json", "box.exr"))
        self.assertLessEqual(boxed["max"], 1.01 * strip["max"])
        self.assertGreater(cloudy["max"], boxed["max"])  # a noon sun on clouds before an evening's sky
        self.write("d.toml", SCENE + '[sky_box]\nstrip = "none.exr"\n')
        self.fail_with(1, "none.exr", "render", "d.toml", "-o", "d.png", *TINY)
        # Behind volumes just as behind sheets.
        self.write("e.toml", SCENE.replace("skyplane", "volume") + box)
        self.succeed("render", "e.toml", "-o", "e.exr", *TINY)
        volumes = json.loads(self.succeed("info", "--json", "e.exr"))
        self.assertLessEqual(volumes["min"], 1.01 * strip["max"])


if __name__ == "__main__":
    main()
