# SPDX-License-Identifier: Apache-2.0
"""Bad input to `welkin render`: a clear message, the right exit code, nothing left behind, and nothing heavy computed first."""
import os
import random

from welkin_program import CUMULUS, TINY, ProgramTest, main

NO_GRAPHICS = {"__EGL_VENDOR_LIBRARY_FILENAMES": "/nonexistent.json", "LIBGL_DRIVERS_PATH": "/nonexistent"}


class SceneFiles(ProgramTest):
    def refuse(self, text, message):
        self.write("s.toml", text)
        self.fail_with(1, "s.toml:" + message, "render", "s.toml", "-o", "x.png")

    def test_unknown_key(self):
        self.refuse("[place]\nlatitude = 4\n", '2:1: unknown key "latitude" in [place]; did you mean "latitude_deg"?')
        self.refuse('[[layer]]\ngenus = "cirrus"\nokats = 2\n', '3:1: unknown key "okats" in [[layer]]; did you mean "oktas"?')

    def test_wrong_type(self):
        self.refuse('[place]\nlatitude_deg = "north"\n', "2:16: latitude_deg: expected a number, found text")
        self.refuse("seed = 1.5\n", "1:8: seed: expected a whole number, found a number")

    def test_latitude_95(self):
        self.refuse("[place]\nlatitude_deg = 95\n", "2:16: latitude_deg is 95; expected -90 to 90 deg")

    def test_not_a_number(self):
        self.refuse("[camera]\nfov_deg = nan\n", "2:11: fov_deg is nan; expected 0.1 to 170 deg")

    def test_syntax(self):
        self.refuse("seed = 1\nplace = {\n", "2:")

    def test_sizes(self):
        self.refuse("[output]\nwidth = 0\n", "2:9: width is 0; expected 1 to 16384 pixels")

    def test_layer_upside_down(self):
        self.refuse('[[layer]]\ngenus = "cirrus"\n[[layer]]\ngenus = "cumulus"\nbase_m = 2000\ntop_m = 1000\n',
                    "6:9: layer of cumulus: top_m must be above base_m")

    def test_reports(self):
        self.refuse('seed = 2\nmetar = "LSZH 211220Z Q10"\n', "2:9: metar: column 14 of the report: 'Q10' is not")

    def test_ice_has_no_radius(self):
        self.refuse('[[layer]]\ngenus = "cirrus"\neffective_radius_um = 40\n', "3:23: effective_radius_um is of droplets, and cirrus is of ice")

    def test_what_does_not_fit_together(self):
        layers = "[[layer]]\n" * 9
        self.refuse(layers, "9:1: there are 9 layers; expected at most 8")
        self.fail_with(1, "s.toml:9:1: there are 9 layers", "info", "s.toml")
        # Not the fault of flags that have nothing to do with it.
        self.fail_with(1, "s.toml:9:1: there are 9 layers", "render", "s.toml", "-o", "x.png", "--time", "2026-06-21T12:00Z")
        self.refuse('[camera]\nprojection = "equirect"\n[output]\nwidth = 64\nheight = 64\n',
                    "4:9: size 64x64 does not fit an equirect; expected a picture twice as wide as high, 128x64 for instance")

    def test_flags_mend_what_does_not_fit(self):
        self.write("s.toml", '[camera]\nprojection = "cubemap"\n[output]\nwidth = 64\nheight = 64\nquality = "low"\n')
        self.fail_with(1, "s.toml:4:9: size 64x64 does not fit a cubemap", "render", "s.toml", "-o", "x.png")
        self.fail_with(1, "s.toml:4:9: size 64x64 does not fit a cubemap", "render", "s.toml", "-o", "x.png", "--seed", "3")
        self.succeed("render", "s.toml", "-o", "x.png", "--size", "48x8")
        self.succeed("render", "s.toml", "-o", "x.png", "--projection", "fisheye")

    def test_files_that_it_names(self):
        self.refuse('theme = "none.toml"\n', "1:9: theme: none.toml: cannot be opened: No such file")
        self.refuse('[sky_box]\nstrip = "none.png"\n', "2:9: strip: there is no file none.png")
        self.refuse('[sky_box]\nstrip = ""\n', "2:9: strip is empty; expected the name of a file")
        faces = "".join(f'{face} = "{face}.png"\n' for face in ("px", "nx", "py", "ny", "pz", "nz"))
        self.refuse("[sky_box]\n" + faces, "2:6: px: there is no file px.png")
        self.refuse('[[metaballs]]\nscale = 2\nfile = "none.json"\n', "3:8: file: there is no file none.json")

    def test_what_is_no_scene(self):
        (self.folder / "map.vdb").write_bytes(b" BDV\xe0\xff")
        self.fail_with(2, "map.vdb is no scene; expected a scene file .toml, or metaballs .json", "render", "map.vdb", "-o", "x.png")

    def test_missing_and_folder(self):
        self.fail_with(1, "none.toml: cannot be opened: No such file", "render", "none.toml", "-o", "x.png")
        os.mkdir(self.folder / "dir.toml")
        self.fail_with(1, "dir.toml: is a folder", "render", "dir.toml", "-o", "x.png")


class Flags(ProgramTest):
    def refuse(self, message, *args):
        self.fail_with(2, message, "render", "-o", "x.png", *args)

    def test_latitude_95(self):
        self.refuse("--place: latitude_deg is 95; expected -90 to 90 deg", "--place", "95,0")

    def test_wrong_type(self):
        self.refuse('--place: latitude_deg: expected a number, found "north"', "--place", "north,0")
        self.refuse('--place: expected LAT,LON or LAT,LON,ALT_M, found "47"', "--place", "47")
        self.refuse("--seed: seed: expected a whole number", "--seed", "many")
        self.refuse("--time: time: ", "--time", "noon")
        self.refuse("did you mean fisheye?", "--projection", "fisheey")

    def test_sizes(self):
        self.refuse("--size: width is 0; expected 1 to 16384 pixels", "--size", "0x0")
        self.refuse("--size: width is 100000; expected 1 to 16384 pixels", "--size", "100000x100000")
        self.refuse("size 16384x16384 has 268435456 pixels; expected at most 134217728", "--size", "16384x16384")
        self.refuse("--size: expected WIDTHxHEIGHT", "--size", "big")
        self.refuse("does not fit a cubemap; expected six square faces", "--size", "96x54", "--projection", "cubemap")
        self.refuse("does not fit an equirect; expected a picture twice as wide as high, 640x320 for instance", "--size", "320x320",
                    "--projection", "equirect")

    def test_auto_is_no_report(self):
        self.fail_with(1, "METAR", "render", "-o", "x.png", "--metar", "auto")

    def test_renderers(self):
        self.refuse("expected gpu or reference", "--renderer", "cpu")
        self.refuse("--resume: state.png is no .exr; expected a name such as state.exr", "--renderer", "reference", "--resume", "state.png")
        self.refuse("--spp belongs to the reference renderer", "--spp", "16")

    def test_flags_of_sequences(self):
        self.refuse("--fps is for sequences and videos; expected --frames as well", "--fps", "10")
        self.refuse("--speed is for sequences and videos", "--speed", "10")

    def test_years(self):
        last = ("--time", "2100-12-31T23:59:59Z")
        self.refuse("the picture is of 2101-12-31T23:59:59Z; expected the years 1900 to 2100", *last, "--at", "31536000")
        self.refuse("the picture is of 1899-12-31T", "--time", "1900-01-01T00:00:00Z", "--at=-5")
        self.fail_with(2, "the last picture is of 2101-01-01T00:00:0", "render", *last, "-o", "x_%d.png", "--frames", "30",
                       "--fps", "24", "--speed", "1")
        self.write("s.toml", 'time = "2100-12-31T23:59:59Z"\nat_s = 60\n')
        self.fail_with(1, "s.toml:2:8: the picture is of 2101-01-01T00:00:59Z", "render", "s.toml", "-o", "x.png")

    def test_frames_need_a_number(self):
        self.refuse("x.png: 10 frames need a place for their number", "--frames", "10")

    def test_no_output(self):
        self.fail_with(2, "expected -o OUT", "render")


class Outputs(ProgramTest):
    def test_unknown_extension(self):
        self.fail_with(2, "x.gif: unknown extension .gif; expected .png, .exr, .hdr, .mp4 or .webm", "render", "-o", "x.gif")
        self.fail_with(2, "picture: no extension", "render", "-o", "picture")

    def test_missing_folder(self):
        self.fail_with(1, "cannot write none/x.png: No such file or directory", "render", *CUMULUS, *TINY, "-o", "none/x.png")
        self.fail_with(1, "cannot write none/r.json: No such file or directory", "render", *CUMULUS, *TINY, "-o", "x.png", "--report",
                       "none/r.json")

    def test_unwritable_folder(self):
        # Even the superuser cannot create files here.
        self.fail_with(1, "cannot write /proc/x.png: ", "render", *CUMULUS, *TINY, "-o", "/proc/x.png")

    def test_folder_without_permission(self):
        if os.geteuid() == 0:
            self.skipTest("permissions do not hold the superuser back")
        os.mkdir(self.folder / "locked", 0o555)
        self.fail_with(1, "cannot write locked/x.png: Permission denied", "render", *CUMULUS, *TINY, "-o", "locked/x.png")

    def test_output_is_a_folder(self):
        os.mkdir(self.folder / "x.png")
        self.fail_with(1, "cannot write x.png: Is a directory", "render", *CUMULUS, *TINY, "-o", "x.png")

    def test_odd_sized_video(self):
        self.fail_with(2, "expected even width and height", "render", *CUMULUS, "--size", "97x55", "-o", "x.mp4")

    def test_report_over_the_picture(self):
        for report in ("x.png", "./x.png", "../" + self.folder.name + "/x.png"):
            self.fail_with(2, f"--report: {report} is written already, by -o; expected another name", "render", "-o", "x.png",
                           "--report", report)
        self.fail_with(2, "-o: x_0002.png is written already, by --report", "render", *TINY, "-o", "x_%04d.png", "--frames", "3",
                       "--report", "x_0002.png")

    def test_outputs_over_what_the_picture_is_made_of(self):
        sheet = '[[sheet]]\ntexture = "t.png"\n'
        cloud = '[[metaballs]]\nfile = "cloud.json"\n'
        self.write("own.toml", 'theme = "theme.toml"\n' + sheet + cloud)
        self.write("slab.toml", "[slab]\noptical_depth = 1\n")
        self.write("theme.toml", '[[sheet]]\ntexture = "u.png"\n')
        self.write("cloud.json", '{"welkin": "metaballs", "balls": [{"center_m": [0, 0, 0], "radius_m": 90, "density": 1}]}')
        self.write("t.png", "")
        self.write("u.png", "")
        os.symlink("own.toml", self.folder / "link.toml")
        before = {name: (self.folder / name).read_bytes() for name in self.files()}
        for report in ("own.toml", "link.toml", "theme.toml", "cloud.json", "t.png", "./u.png"):
            self.fail_with(2, f"--report: {report} is read; expected another name", "render", "own.toml", "-o", "x.png",
                           "--report", report)
        self.fail_with(2, "-o: t.png is read", "render", "own.toml", "-o", "t.png")
        self.fail_with(2, "--report: theme.toml is read", "render", "--theme", "theme.toml", "-o", "x.png", "--report", "theme.toml")
        self.fail_with(2, "--report: cloud.json is read", "render", "cloud.json", "-o", "x.png", "--report", "cloud.json")
        self.fail_with(2, "--report: slab.toml is read", "render", "slab.toml", "--renderer", "reference", "--report", "slab.toml")
        self.fail_with(2, "--resume: own.toml is read", "render", "own.toml", "--renderer", "reference", "-o", "x.exr",
                       "--resume", "own.toml")
        self.assertEqual({name: (self.folder / name).read_bytes() for name in self.files()}, before)

    def test_bad_patterns(self):
        for pattern in ("x_%s.png", "x_%d_%d.png", "x_%n.png", "x_%.png", "x_%99999d.png"):
            self.fail_with(2, pattern, "render", *CUMULUS, *TINY, "-o", pattern, "--frames", "2")


class Weather(ProgramTest):
    def test_empty_metar(self):
        self.fail_with(1, "", "render", "--metar", "", *TINY, "-o", "x.png")

    def test_random_bytes(self):
        rng = random.Random(7)
        for _ in range(10):
            noise = bytes(rng.choice([b for b in range(1, 256) if b != 10]) for _ in range(rng.randrange(1, 60)))
            self.fail_with(1, "", b"render", b"--metar=" + noise, *[a.encode() for a in TINY], b"-o", b"x.png")


class Machine(ProgramTest):
    def test_no_graphics(self):
        self.fail_with(1, "expected EGL from a graphics driver", "render", *CUMULUS, *TINY, "-o", "x.png", **NO_GRAPHICS)

    def test_no_ffmpeg(self):
        empty = self.folder / "bin"
        empty.mkdir()
        self.fail_with(1, "ffmpeg", "render", *CUMULUS, *TINY, "-o", "x.mp4", "--frames", "2", PATH=str(empty))


if __name__ == "__main__":
    main()
