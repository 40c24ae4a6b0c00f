# SPDX-License-Identifier: Apache-2.0
"""`welkin convert`, and `welkin info` of what it writes."""
import json
import os
import pathlib
import struct
import subprocess

from welkin_program import CUMULUS, PROGRAM, TINY, ProgramTest, main

DATA = pathlib.Path(__file__).resolve().parent.parent / "data" / "io"


class Convert(ProgramTest):
    def info(self, name):
        return json.loads(self.succeed("info", str(name), "--json"))

    def bytes_of(self, name):
        return (self.folder / name).read_bytes()

    def write_raw(self, path, size, channels, kind, values, **more):
        code = {"uint8": "B", "uint16": "H", "float32": "f"}[kind]
        (self.folder / path).write_bytes(struct.pack(f"<{len(values)}{code}", *values))
        side = {"version": 1, "size": size, "channels": channels, "type": kind, "byte_order": "little", **more}
        self.write(path + ".json", json.dumps(side))

    def test_no_meaning_that_the_file_does_not_say(self):
        self.write_raw("a.raw", [2, 1], "rgb", "float32", [0, 0.25, 0.5, 1, 0, 1])
        for name, how in (("a.exr", []), ("a.hdr", []), ("a.png", ["--format", "rgb8"])):
            self.succeed("convert", "a.raw", name, *how)
            self.assertNotIn("meaning", self.info(name))
        self.assertNotIn(b"sRGB", self.bytes_of("a.png"))
        self.assertNotIn(b"cd/m2", self.bytes_of("a.hdr"))

    def test_meaning_goes_along(self):
        self.succeed("render", "-o", "a.png", *TINY, *CUMULUS)
        self.succeed("render", "-o", "a.hdr", *TINY, *CUMULUS)
        self.succeed("convert", "a.png", "b.png")
        self.assertIn(b"sRGB\0", self.bytes_of("b.png"))
        self.succeed("convert", "a.hdr", "b.exr")
        self.succeed("convert", "b.exr", "c.hdr")
        self.assertEqual([self.info(name)["meaning"] for name in ("b.png", "a.hdr", "b.exr", "c.hdr")],
                         ["sRGB"] + 3 * ["linear Rec. 709, cd/m2"])

    def test_text_of_files_does_not_drive_the_terminal(self):
        hostile = "\x1b]0;title\x07 \x9b31m \x7f \r\n\tWolke über Zürich \u96f2"
        shown = "\\x1b]0;title\\x07 \\x9b31m \\x7f \\x0d\\n\\tWolke über Zürich \u96f2"
        self.write_raw("a.raw", [2, 1, 1], "r", "float32", [1, 2], name=hostile, metadata={"key\x1bc": hostile})
        plain = self.run_program("info", "a.raw").stdout.decode()
        self.assertIn("name " + shown, plain)
        self.assertIn("key\\x1bc " + shown, plain)
        text = self.run_program("info", "a.raw", "--json").stdout.decode()
        self.assertEqual(json.loads(text)["metadata"], {"key\x1bc": hostile})
        for output in (plain, text):
            self.assertFalse([c for c in output if c != "\n" and (ord(c) < 32 or 127 <= ord(c) < 160)], output)
        error = self.fail_with(1, "cannot read \\x1b[31mé.png: ", "info", "\x1b[31mé.png")
        self.assertNotIn("\x1b", error)
        bytes_alone = self.run_program("info", b"\x9b31m.png").stderr
        self.assertTrue(bytes_alone.startswith(b"welkin: cannot read \\x9b31m.png"), bytes_alone)

    def test_volume_goes_round_every_kind(self):
        values = [(37 * i) % 251 for i in range(6 * 5 * 4)]
        self.write_raw("a.raw", [6, 5, 4], "l", "uint8", values, voxel_size_m=[20, 20, 10], first_voxel_m=[1, 2, 3],
                       name="extinction", metadata={"seed": "7"})
        self.succeed("convert", "a.raw", "b.vdb")
        info = self.info("b.vdb")
        self.assertEqual((info["width"], info["height"], info["depth"]), (6, 5, 4))
        self.assertEqual(info["voxel_size_m"], [20, 20, 10])
        self.assertEqual(info["first_voxel_m"], [1, 2, 3])
        self.assertEqual(info["name"], "extinction")
        self.assertEqual(info["metadata"], {"seed": "7"})
        self.assertEqual(info["grids"], [{"name": "extinction", "type": "Tree_float_5_4_3", "half": True}])
        self.succeed("convert", "b.vdb", "c.dds", "--format", "l8")
        self.assertEqual(self.bytes_of("c.dds")[128:], bytes(values))
        info = self.info("c.dds")
        self.assertEqual((info["layout"], info["header"], info["levels"]), ("L8", "legacy", 1))
        self.assertEqual((info["min"], info["max"]), (min(values), max(values)))
        self.assertEqual(info["mean"], sum(values) / len(values))
        self.succeed("convert", "c.dds", "d.raw")
        self.assertEqual(self.bytes_of("d.raw"), bytes(values))

    def test_picture_goes_round_every_kind(self):
        self.succeed("convert", str(DATA / "gimp_mips.dds"), "a.png")
        self.succeed("convert", "a.png", "b.exr")
        self.succeed("convert", "b.exr", "c.raw", "--format", "rgb8")
        self.succeed("convert", "c.raw.json", "d.dds")
        self.assertEqual(self.info("d.dds")["layout"], "BGRA8")
        self.succeed("convert", "d.dds", "e.png", "--format", "rgb8")
        self.assertEqual(self.bytes_of("e.png"), self.bytes_of("a.png"))
        self.succeed("convert", "a.png", "f.hdr")
        self.assertEqual(self.info("f.hdr")["values"], "rgbe")

    def test_a_picture_takes_the_memory_of_what_is_read_and_what_is_written(self):
        side = 4096
        (self.folder / "a.raw").write_bytes(bytes(side * side))
        self.write("a.raw.json", json.dumps({"version": 1, "size": [side, side], "channels": "l", "type": "uint8",
                                             "byte_order": "little"}))
        program = subprocess.Popen([PROGRAM, "convert", "a.raw", "b.png", "--format", "l16"], cwd=self.folder)
        _, status, usage = os.wait4(program.pid, 0)
        program.returncode = os.waitstatus_to_exitcode(status)
        self.assertEqual(program.returncode, 0)
        both, program_itself = 3 * side * side, 48 << 20
        self.assertLess(usage.ru_maxrss * 1024, 1.1 * both + program_itself)

    def test_same_input_same_bytes(self):
        for name in ("a.dds", "a.raw", "a.vdb"):
            self.succeed("convert", str(DATA / "gimp_volume_L8.dds"), name)
            first = self.bytes_of(name)
            self.succeed("convert", str(DATA / "gimp_volume_L8.dds"), name)
            self.assertEqual(self.bytes_of(name), first)

    def test_mipmaps_and_header(self):
        volume = str(DATA / "gimp_volume_L8.dds")
        self.succeed("convert", volume, "a.dds", "--mipmaps", "box")
        self.assertEqual(self.info("a.dds")["levels"], 5)
        self.succeed("convert", volume, "b.dds", "--mipmaps", "kaiser", "--edges", "repeat")
        self.assertNotEqual(self.bytes_of("a.dds"), self.bytes_of("b.dds"))
        self.succeed("convert", volume, "c.dds", "--header", "dx10")
        self.assertEqual((self.info("c.dds")["layout"], self.info("c.dds")["header"]), ("R8", "DX10"))

    def test_what_cannot_be_kept(self):
        self.write_raw("a.raw", [2, 1], "r", "float32", [0.5, 1.5])
        self.fail_with(1, "texel (1, 0) is 1.5, which l8 cannot hold", "convert", "a.raw", "b.png", "--format", "l8")
        self.fail_with(1, "the picture of r32f does not fit into that kind of file; expected --format l16", "convert", "a.raw",
                       "b.png")
        self.fail_with(1, "the picture of r32f does not fit into that kind of file, which holds volumes", "convert", "a.raw",
                       "b.vdb")
        colour = str(DATA / "gimp_mips.dds")
        self.fail_with(1, "is not grey, which l8 cannot hold", "convert", colour, "b.dds", "--format", "l8")
        self.fail_with(1, "the volume of l8 does not fit into that kind of file, which holds pictures", "convert",
                       str(DATA / "gimp_volume_L8.dds"), "b.png")
        self.write_raw("c.raw", [1, 1, 1], "rgb", "uint8", [1, 2, 3])
        self.fail_with(1, "which holds one value a voxel", "convert", "c.raw", "b.vdb")
        self.write_raw("n.raw", [2, 1], "r", "float32", [0.5, float("nan")])
        self.fail_with(1, "no finite number at texel (1, 0) (byte 4)", "convert", "n.raw", "b.exr")

    def write_exr(self, path, names):
        """One pixel of floats, channel i is i, not compressed."""
        def attribute(name, kind, value):
            return name.encode() + b"\0" + kind.encode() + b"\0" + struct.pack("<i", len(value)) + value
        box, channels = struct.pack("<4i", 0, 0, 0, 0), b"".join(
            n.encode() + b"\0" + struct.pack("<4i", 2, 0, 1, 1) for n in sorted(names))
        header = struct.pack("<2i", 20000630, 2) + attribute("channels", "chlist", channels + b"\0") + attribute(
            "compression", "compression", b"\0") + attribute("dataWindow", "box2i", box) + attribute(
            "displayWindow", "box2i", box) + attribute("lineOrder", "lineOrder", b"\0") + attribute(
            "pixelAspectRatio", "float", struct.pack("<f", 1)) + attribute("screenWindowCenter", "v2f", bytes(8)) + attribute(
            "screenWindowWidth", "float", struct.pack("<f", 1)) + b"\0"
        row = struct.pack(f"<2i{len(names)}f", 0, 4 * len(names), *range(len(names)))
        (self.folder / path).write_bytes(header + struct.pack("<Q", len(header) + 8) + row)

    def test_what_is_left_out_is_said(self):
        self.write_exr("a.exr", "BGRZ")
        done = self.run_program("convert", "a.exr", "b.raw")
        self.assertEqual((done.returncode, done.stderr), (0, b"welkin: warning: a.exr: channel Z is left out\n"))
        self.assertEqual(struct.unpack("<3f", self.bytes_of("b.raw")), (2, 1, 0))
        self.assertEqual(self.info("a.exr")["left_out"], ["channel Z"])

    def test_a_grid_by_its_name(self):
        self.write_raw("a.raw", [1, 1, 1], "r", "float32", [0.5], name="smoke")
        self.succeed("convert", "a.raw", "a.vdb")
        self.succeed("convert", "a.vdb", "b.raw", "--grid", "smoke")
        self.assertEqual(self.bytes_of("b.raw"), self.bytes_of("a.raw"))
        self.fail_with(1, 'there is no grid "fire"', "convert", "a.vdb", "c.raw", "--grid", "fire")
        self.fail_with(2, "--grid is for .vdb", "convert", "a.raw", "c.raw", "--grid", "smoke")

    def test_called_wrongly(self):
        colour = str(DATA / "gimp_mips.dds")
        self.fail_with(2, "convert: expected two files, IN and OUT", "convert", colour)
        self.fail_with(2, "unknown extension .tga; expected .png", "convert", colour, "b.tga")
        self.fail_with(2, f"convert: {colour} is read; expected another name", "convert", colour, colour, "--format", "rgb8")
        self.fail_with(2, "is read; expected another name", "convert", "a.raw", "a.raw.json")
        self.fail_with(2, "there is no texel format \"bgra8\"", "convert", colour, "b.dds", "--format", "bgra8")
        self.fail_with(2, "b.png cannot hold a picture of rgb32f", "convert", colour, "b.png", "--format", "rgb32f")
        self.fail_with(2, '--mipmaps is "cubic"; expected none, box or kaiser', "convert", colour, "b.dds", "--mipmaps", "cubic")
        self.fail_with(2, "--mipmaps, --edges and --header are for .dds", "convert", colour, "b.png", "--mipmaps", "box")
        self.fail_with(2, "--edges goes with --mipmaps", "convert", colour, "b.dds", "--edges", "repeat")
        self.fail_with(2, "did you mean --mipmaps?", "convert", colour, "b.dds", "--mipmap", "box")

    def test_damaged_files(self):
        good = (DATA / "gimp_volume_L8.dds").read_bytes()
        (self.folder / "short.dds").write_bytes(good[:200])
        self.fail_with(1, "16x8x4 texels do not fit in its 200 bytes (byte 128)", "convert", "short.dds", "b.raw")
        self.fail_with(1, "16x8x4 texels do not fit", "info", "short.dds")
        self.fail_with(1, "No such file", "convert", "none.dds", "b.raw")
        self.write("x.vdb", "no grid at all")
        self.fail_with(1, "this is no OpenVDB file", "info", "x.vdb")


if __name__ == "__main__":
    main()
