# SPDX-License-Identifier: Apache-2.0
"""Commands that draw nothing: version, help, metar, sun, info."""
import json
import subprocess

from welkin_program import PROGRAM, ProgramTest, main


class Help(ProgramTest):
    def test_version(self):
        self.assertRegex(self.succeed("--version"), r"^welkin \d+\.\d+\.\d+\n$")

    def test_help_lists_every_flag_of_render(self):
        text = self.succeed("render", "--help")
        for flag in ("--output", "--metar", "--place", "--time", "--at", "--seed", "--eye", "--look", "--projection", "--size",
                     "--renderer", "--quality", "--spp", "--exposure", "--frames", "--fps", "--speed", "--report",
                     "--threads", "--no-sun-disc", "--bits"):
            self.assertIn(flag, text)
        self.assertEqual(text, self.succeed("help", "render"))
        self.assertIn("-90 to 90 deg", text)  # the range comes from the description of the parameter
        self.assertLessEqual(max(map(len, text.splitlines())), 125)

    def test_help_scene_names_every_key(self):
        text = self.succeed("help", "scene")
        for key in ("latitude_deg", "albedo", "genus", "oktas", "fov_deg", "exposure_ev", "[[layer]]", "[place]"):
            self.assertIn(key, text)
        self.assertIn("| `latitude_deg` | number | -90 to 90 | deg |", self.succeed("help", "scene", "--markdown"))

    def test_mistakes_name_the_nearest(self):
        self.fail_with(2, 'unknown command "rendr"; did you mean render?', "rendr")
        self.fail_with(2, "unknown flag --exposre; did you mean --exposure?", "render", "-o", "x.png", "--exposre", "auto")
        self.fail_with(2, "did you mean --version?", "--verison")
        self.fail_with(2, 'there is no topic "scnee"; did you mean scene?', "help", "scnee")
        message = self.fail_with(2, "expected a command")
        for command in ("render", "metar", "sun", "info", "noise", "cloud", "fit", "convert", "compare", "bench", "help"):
            self.assertRegex(message, rf"[ ,]{command}[,;]")
        self.fail_with(2, "--seed: expected N behind it\n", "render", "-o", "x.png", "--seed")
        self.fail_with(2, "--size: expected WxH behind it\n", "render", "--size")
        self.fail_with(2, "--seed is given twice; expected it once\n", "render", "-o", "x.png", "--seed", "1", "--seed", "2")


    def test_a_full_disc(self):
        for topic in ("scene", "metar"):  # more than a buffer holds, and less
            with open("/dev/full", "wb") as full:
                done = subprocess.run([PROGRAM, "help", topic], stdout=full, stderr=subprocess.PIPE, timeout=60)
            self.assertEqual((done.returncode, done.stderr), (1, b"welkin: standard output cannot be written\n"))


class Bench(ProgramTest):
    # What it measures is no test's business, and takes a minute.
    def test_mistakes_are_named(self):
        self.fail_with(2, 'bench: there is no benchmark "nosie"; did you mean noise?', "bench", "nosie")


class Sun(ProgramTest):
    def test_json(self):
        j = json.loads(self.succeed("sun", "--place", "51.4779,0,46", "--time", "2026-06-21T12:00:00Z", "--json"))
        # Greenwich at noon of the solstice: 90 - latitude + obliquity, near south (the equation of time is -1.9 minutes).
        self.assertAlmostEqual(j["sun"]["elevation_deg"], 90 - 51.4779 + 23.436, delta=0.05)
        self.assertAlmostEqual(j["sun"]["azimuth_deg"], 179, delta=1.0)
        self.assertEqual(set(j["moon"]) >= {"azimuth_deg", "elevation_deg", "illuminated_fraction"}, True)
        self.assertTrue(0 <= j["moon"]["illuminated_fraction"] <= 1)

    def test_planets_above_the_horizon(self):
        # Jupiter two days before its opposition of 2026-01-10, at midnight near the meridian.
        where = ("sun", "--place", "47,8", "--time", "2026-01-08T23:30:00Z")
        planets = {p["name"]: p for p in json.loads(self.succeed(*where, "--json"))["planets"]}
        self.assertEqual(list(planets), ["jupiter", "uranus"])
        self.assertAlmostEqual(planets["jupiter"]["elevation_deg"], 90 - 47 + 22, delta=1)
        self.assertAlmostEqual(planets["jupiter"]["magnitude"], -2.7, delta=0.1)
        self.assertIn("jupiter azimuth", self.succeed(*where))

    def test_eclipses(self):
        total = ("sun", "--place", "42.5987,-5.5671,840", "--time", "2026-08-12T18:29:04Z")
        self.assertEqual(json.loads(self.succeed(*total, "--json"))["sun"]["obscuration"], 1)
        self.assertIn("100.00 % hidden by the moon", self.succeed(*total))
        lunar = ("sun", "--place", "40,-100", "--time", "2025-03-14T06:59:00Z")
        self.assertAlmostEqual(json.loads(self.succeed(*lunar, "--json"))["moon"]["umbral_magnitude"], 1.178, delta=0.01)
        self.assertIn("eclipsed by the earth, magnitude 1.17", self.succeed(*lunar))
        neither = self.succeed("sun", "--place", "40,-100", "--time", "2025-03-20T06:59:00Z")
        self.assertNotIn("eclipsed", neither)
        self.assertNotIn("hidden", neither)

    def test_negative_places_and_offsets(self):
        here = self.succeed("sun", "--place", "-33.9,151.2", "--time", "2026-06-21T12:00:00+10:00", "--json")
        self.assertEqual(here, self.succeed("sun", "--place", "-33.9,151.2", "--time", "2026-06-21T02:00:00Z", "--json"))

    def test_mistakes(self):
        self.fail_with(2, "--place: latitude_deg is 95; expected -90 to 90 deg", "sun", "--place", "95,0", "--time",
                       "2026-06-21T12:00:00Z")
        self.fail_with(2, "--time", "sun", "--place", "1,2", "--time", "yesterday")
        self.fail_with(2, "expected --place", "sun", "--time", "2026-06-21T12:00:00Z")


class Metar(ProgramTest):
    REPORT = "KMRY 211753Z 28010G20KT 10SM FEW012 BKN250 18/12 A2992"

    def test_json(self):
        j = json.loads(self.succeed("metar", "--json", self.REPORT))
        self.assertEqual((j["station"], j["day"], j["hour"], j["minute"], j["auto"]), ("KMRY", 21, 17, 53, False))
        self.assertEqual(j["wind"]["direction_deg"], 280)
        self.assertAlmostEqual(j["wind"]["speed_mps"], 10 * 1852 / 3600, places=3)
        self.assertAlmostEqual(j["wind"]["gust_mps"], 20 * 1852 / 3600, places=3)
        self.assertEqual(j["layers"], [{"cover": "FEW", "base_ft": 1200, "type": None},
                                       {"cover": "BKN", "base_ft": 25000, "type": None}])
        self.assertAlmostEqual(j["pressure_hpa"], 29.92 * 33.8639, delta=0.1)
        for key in ("visibility_m", "cavok", "clear", "vertical_visibility_ft", "weather", "temperature_c", "dewpoint_c"):
            self.assertIn(key, j)

    def test_all_that_was_decoded(self):
        report = "SPECI KMRY 211753Z AUTO CCA 28010KT 250V310 M1/4SM BKN002 12/11 A2992"
        j = json.loads(self.succeed("metar", "--json", report))
        self.assertEqual((j["special"], j["corrected"], j["delayed"], j["visibility_bound"]), (True, True, False, "<"))
        self.assertEqual((j["wind"]["varies_from_deg"], j["wind"]["varies_to_deg"]), (250, 310))
        self.assertEqual((j["aerosol"], j["snow_on_ground"]), ("haze", False))
        dusty = "OEJN 211200Z 33018KT 2000 SS NSC M01/M05 Q1006 R16/450050"
        j = json.loads(self.succeed("metar", "--json", dusty))
        self.assertEqual((j["aerosol"], j["snow_on_ground"]), ("dust", True))
        self.assertIn("  air           dust\n  ground        snow\n", self.succeed("metar", dusty))
        j = json.loads(self.succeed("metar", "--json", "CYOW 211200Z 28010KT 15SM SCT030 12/11 A2992 RMK SC4 8/5//"))
        self.assertEqual(j["cloud_remarks"], [{"genus": "stratocumulus", "type": None, "oktas": 4, "base_ft": None}])
        self.assertEqual(j["cloud_codes"], {"low": 5, "middle": None, "high": None})
        text = self.succeed("metar", report)
        self.assertIn("special, automatic, corrected\n", text)
        self.assertIn(", between 250 and 310 degrees\n", text)
        self.assertIn("missing, dew point 11.0 C\n", self.succeed("metar", "LSZH 211220Z 24008KT 9999 FEW020 ///11 Q1018"))

    def test_several_and_from_a_file(self):
        self.write("reports.txt", self.REPORT + "\n\n" + "LSZH 211220Z 24008KT CAVOK 22/12 Q1018\n")
        lines = self.succeed("metar", "--json", "--file", "reports.txt").splitlines()
        self.assertEqual([json.loads(line)["station"] for line in lines], ["KMRY", "LSZH"])
        (self.folder / "marked.txt").write_bytes(b"\xef\xbb\xbf" + (self.folder / "reports.txt").read_bytes())
        self.assertEqual(self.succeed("metar", "--json", "--file", "marked.txt").splitlines(), lines)

    def test_empty_report(self):
        done = self.run_program("metar", "--json", "")
        self.assertEqual(done.returncode, 1)
        j = json.loads(done.stdout)
        self.assertTrue(j["error"])
        self.assertEqual(j["report"], "")

    def test_random_bytes(self):
        import random
        rng = random.Random(1)
        for _ in range(20):
            noise = bytes(rng.choice([b for b in range(1, 256) if b != 10]) for _ in range(rng.randrange(1, 80)))
            done = self.run_program("metar", "--json", "--file", "-", stdin=b"X" + noise + b"\n")
            self.assertEqual(done.returncode, 1, noise)
            self.assertIn("error", json.loads(done.stdout), noise)

    def test_errors(self):
        self.fail_with(1, "welkin: report 1, column 5: expected a day and time such as 211753Z\n", "metar", "KABC")
        self.fail_with(1, "welkin: report 2, column 14: 'Q10' is not", "metar", self.REPORT, "KMRY 211753Z Q10", "KABC")
        self.fail_with(1, "; 2 of 3 reports have errors\n", "metar", "--json", self.REPORT, "KMRY 211753Z Q10", "KABC")
        self.write("reports.txt", "# two\n" + self.REPORT + "\n\nKABC\n")
        self.fail_with(1, "welkin: reports.txt:4:5: expected a day and time such as 211753Z; 1 of 2", "metar", "--file",
                       "reports.txt")
        done = self.run_program("metar", self.REPORT, "KMRY 211753Z Q10")
        self.assertIn(b"KMRY, day 21 at 17:53 UTC\n  wind", done.stdout)
        self.assertIn(b"  error         column 14: ", done.stdout)

    def test_mistakes(self):
        self.fail_with(2, "metar: expected a report", "metar")
        self.fail_with(1, "missing.txt", "metar", "--file", "missing.txt")


class Info(ProgramTest):
    def test_fills_in_what_is_left_out(self):
        self.write("s.toml", '[[layer]]\ngenus = "cirrus"\n')
        j = json.loads(self.succeed("info", "s.toml", "--json"))
        self.assertEqual(j["layer"][0]["genus"], "cirrus")
        self.assertGreater(j["layer"][0]["base_m"], 5000)
        toml = self.succeed("info", "s.toml")
        self.write("again.toml", toml)
        self.assertEqual(self.succeed("info", "again.toml"), toml)

    def test_mistakes(self):
        self.fail_with(1, "missing.toml", "info", "missing.toml")
        self.fail_with(1, "missing.png", "info", "missing.png")
        self.fail_with(2, "unknown kind of file; expected .toml, .png, .exr, .hdr, .dds, .raw, .vdb or .json", "info", "x.gif")


if __name__ == "__main__":
    main()
