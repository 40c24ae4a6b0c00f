# SPDX-License-Identifier: Apache-2.0
"""`welkin convert`, and `welkin info` of what it writes."""
import json
import pathlib
import struct

from welkin_program import ProgramTest, main

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
        self.assertAlmostEqual(info["mean"], sum(values) / len(values), places=3)
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
        self.fail_with(1, "the picture of r32f does not fit", "convert", "a.raw", "b.png")
        self.fail_with(1, "the picture of r32f does not fit", "convert", "a.raw", "b.vdb")
        colour = str(DATA / "gimp_mips.dds")
        self.fail_with(1, "is not grey, which l8 cannot hold", "convert", colour, "b.dds", "--format", "l8")
        self.fail_with(1, "the volume of l8 does not fit", "convert", str(DATA / "gimp_volume_L8.dds"), "b.png")
        self.write_raw("n.raw", [2, 1], "r", "float32", [0.5, float("nan")])
        self.fail_with(1, "no finite number at texel (1, 0) (byte 4)", "convert", "n.raw", "b.exr")

    def test_called_wrongly(self):
        colour = str(DATA / "gimp_mips.dds")
        self.fail_with(2, "convert: expected two files, IN and OUT", "convert", colour)
        self.fail_with(2, "unknown extension .tga; expected .png", "convert", colour, "b.tga")
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
