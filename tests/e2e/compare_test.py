# SPDX-License-Identifier: Apache-2.0
"""`welkin compare`."""
import json
import struct

from welkin_program import ProgramTest, main


class Compare(ProgramTest):
    def picture(self, name, values, width):
        """An EXR of these values, one a pixel."""
        (self.folder / "p.raw").write_bytes(struct.pack(f"<{len(values)}f", *values))
        self.write("p.raw.json", json.dumps({"version": 1, "size": [width, len(values) // width], "channels": "l", "type": "float32",
                                             "byte_order": "little"}))
        self.succeed("convert", "p.raw", name)

    def test_numbers_and_maps(self):
        self.picture("truth.exr", [100.0] * 12, 4)
        self.picture("bright.exr", [110.0] * 6 + [100.0] * 6, 4)
        result = json.loads(self.succeed("compare", "bright.exr", "truth.exr", "--bias", "bias.png", "--flip", "flip.png", "--json"))
        self.assertEqual((result["width"], result["height"]), (4, 3))
        self.assertAlmostEqual(result["bias"], 0.05, places=4)
        self.assertAlmostEqual(result["relative_error"], 0.05, places=4)
        self.assertAlmostEqual(result["largest_relative_error"], 0.1, places=4)
        self.assertGreater(result["flip"], 0.0)
        self.assertIn("exposure_ev", result)
        for name in ("bias.png", "flip.png"):
            self.assertEqual(json.loads(self.succeed("info", name, "--json"))["width"], 4)
        self.assertIn("bias             +5.000 %", self.succeed("compare", "bright.exr", "truth.exr"))

    def test_a_picture_and_itself(self):
        self.picture("a.exr", [float(i) for i in range(12)], 4)
        self.succeed("convert", "a.exr", "b.hdr")
        for other in ("a.exr", "b.hdr"):
            result = json.loads(self.succeed("compare", "a.exr", other, "--json"))
            self.assertEqual((result["bias"], result["relative_error"], result["flip"]), (0, 0, 0))

    def test_screens(self):
        self.picture("a.exr", [0.0, 0.25, 0.5, 1.0], 2)
        self.succeed("convert", "a.exr", "a.png", "--format", "l8")
        result = json.loads(self.succeed("compare", "a.png", "a.png", "--json"))
        self.assertEqual(result["flip"], 0)
        self.assertNotIn("exposure_ev", result)

    def test_what_has_no_answer(self):
        self.picture("a.exr", [1.0] * 4, 2)
        self.picture("wide.exr", [1.0] * 4, 4)
        self.picture("black.exr", [0.0] * 4, 2)
        self.succeed("convert", "a.exr", "a.png", "--format", "l8")
        self.fail_with(2, "expected two pictures", "compare", "a.exr")
        self.fail_with(1, "a.exr is 2x2 and wide.exr is 4x1; expected pictures of one size", "compare", "a.exr", "wide.exr")
        self.fail_with(1, "black", "compare", "a.exr", "black.exr")
        self.fail_with(2, "expected two .png or two of .exr and .hdr", "compare", "a.exr", "a.png")
        self.fail_with(2, "--exposure is for pictures of luminance", "compare", "a.png", "a.png", "--exposure", "12")
        self.fail_with(2, "--range: expected a number", "compare", "a.exr", "a.exr", "--range", "wide")
        self.fail_with(2, "ends in .png", "compare", "a.exr", "a.exr", "--flip", "map.exr")
        self.fail_with(2, "--bias: ./a.png is read", "compare", "a.png", "a.png", "--bias", "./a.png")
        self.fail_with(2, "--flip: ./b.png is written already, by --bias", "compare", "a.png", "a.png", "--bias", "b.png",
                       "--flip", "./b.png")
        self.fail_with(1, "missing.exr", "compare", "a.exr", "missing.exr")
        self.write("torn.exr", "v/1\x01")
        self.fail_with(1, "torn.exr", "compare", "torn.exr", "a.exr")


if __name__ == "__main__":
    main()
