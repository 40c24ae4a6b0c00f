#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""check_house.py on small trees: one that is in order, and one for each rule, broken."""
import contextlib
import io
import pathlib
import sys
import tempfile
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "tools"))
import check_house  # noqa: E402

SPDX = "// SPDX-License-Identifier: Apache-2.0\n"
HASH_SPDX = "# SPDX-License-Identifier: Apache-2.0\n"

# core at the bottom, sky and weather beside each other, gpu apart, scene on top of sky and weather.
TREE = {
    "CMakeLists.txt": HASH_SPDX + "set(WELKIN_FOLDERS core sky weather gpu scene)\n",
    "welkin/core/CMakeLists.txt": HASH_SPDX + "welkin_module(core SOURCES a.cpp)\n",
    "welkin/core/a.h": SPDX,
    "welkin/sky/CMakeLists.txt": HASH_SPDX + "welkin_module(sky\n  SOURCES a.cpp b.cpp\n  DEPENDS core  # not weather\n  PRIVATE_LIBS X::x)\n",
    "welkin/sky/a.h": SPDX + '#include <vector>\n#include "welkin/core/a.h"\n',
    "welkin/sky/a.cpp": SPDX + '#include "welkin/sky/a.h"\n#include "shaders/lib/air.glsl"\n',
    "welkin/weather/CMakeLists.txt": HASH_SPDX + "welkin_module(weather SOURCES a.cpp DEPENDS core)\n",
    "welkin/weather/a.h": SPDX,
    "welkin/gpu/CMakeLists.txt": HASH_SPDX + "welkin_module(gpu SOURCES a.cpp DEPENDS core)\n",
    "welkin/gpu/a.cpp": SPDX + "#include <epoxy/gl.h>\n",
    "welkin/scene/CMakeLists.txt": HASH_SPDX + "welkin_module(scene SOURCES a.cpp DEPENDS sky weather)\n",
    "welkin/scene/a.h": SPDX + '#include "welkin/core/a.h"\n#include "welkin/sky/a.h"\n#include "welkin/weather/a.h"\n',
    "shaders/lib/air.glsl": SPDX,
    "shaders/pass/sky.frag": SPDX + '#include "lib/air.glsl"\n',
    "apps/welkin/main.cpp": SPDX + '#include "local.h"\n#include "welkin/scene/a.h"\n',
    "docs/architecture.md": "# A\n" + check_house.TABLE_BEGIN + "\n"
                            + "".join(f"| `{f}` | about {f} | |\n" for f in ("core", "sky", "weather", "gpu", "scene"))
                            + check_house.TABLE_END + "\nend\n",
}


class CheckHouseTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.root = pathlib.Path(folder.name)
        for name, text in TREE.items():
            self.put(name, text)
        code, out = self.check("--write")
        self.assertEqual(code, 0, out)

    def put(self, name, text):
        path = self.root / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)

    def check(self, *flags):
        out = io.StringIO()
        with contextlib.redirect_stdout(out):
            code = check_house.main([*flags, str(self.root)])
        return code, out.getvalue()

    def assert_broken(self, *texts):
        code, out = self.check()
        self.assertEqual(code, 1, out)
        for text in texts:
            self.assertIn(text, out)
        self.assertEqual(out.count("\n"), 1, out)

    def test_tree_in_order(self):
        code, out = self.check()
        self.assertEqual(code, 0, out)

    def test_upward_include(self):
        self.put("welkin/core/a.h", SPDX + '#include "welkin/scene/a.h"\n')
        self.assert_broken("welkin/core/a.h:2: core/ includes upwards: welkin/scene/a.h")

    def test_sideways_include(self):
        self.put("welkin/weather/a.h", SPDX + '\n  # include <welkin/sky/a.h>\n')
        self.assert_broken("welkin/weather/a.h:3: weather/ includes sideways: welkin/sky/a.h (it may include core, weather)")

    def test_include_of_a_program_from_the_library(self):
        self.put("welkin/sky/a.cpp", SPDX + '#include "apps/welkin/local.h"\n')
        self.assert_broken("welkin/sky/a.cpp:2:", "apps/welkin/local.h")

    def test_relative_include_in_the_library(self):
        self.put("welkin/sky/a.cpp", SPDX + '#include "../scene/a.h"\n')
        self.assert_broken("welkin/sky/a.cpp:2:")

    def test_missing_header(self):
        self.put("apps/welkin/main.cpp", SPDX + '#include "welkin/sky/nothing.h"\n')
        self.assert_broken("apps/welkin/main.cpp:2: welkin/sky/nothing.h does not exist")

    def test_graphics_header_outside_gpu(self):
        self.put("welkin/sky/a.cpp", SPDX + "#include <EGL/egl.h>\n")
        self.assert_broken("welkin/sky/a.cpp:2: <EGL/egl.h>")

    def test_graphics_header_in_a_program(self):
        self.put("apps/welkin/main.cpp", SPDX + "#include <epoxy/gl.h>\n")
        self.assert_broken("apps/welkin/main.cpp:2: <epoxy/gl.h>")

    def test_dependency_that_stands_above(self):
        self.put("welkin/core/CMakeLists.txt", HASH_SPDX + "welkin_module(core SOURCES a.cpp DEPENDS scene)\n")
        self.assert_broken("core DEPENDS scene, which does not stand before it")

    def test_folder_outside_the_list(self):
        self.put("welkin/attic/CMakeLists.txt", HASH_SPDX + "welkin_module(attic SOURCES a.cpp)\n")
        self.assert_broken("welkin/attic:1:")

    def test_shader_that_includes_a_pass(self):
        self.put("shaders/lib/air.glsl", SPDX + '#include "pass/sky.frag"\n')
        self.assert_broken("shaders/lib/air.glsl:2:")

    def test_shader_with_a_version(self):
        self.put("shaders/pass/sky.frag", SPDX + "#version 330 core\n")
        self.assert_broken("shaders/pass/sky.frag:2: #version")

    def test_long_file(self):
        self.put("tests/long.cpp", SPDX + "//\n" * 600)
        self.assert_broken("tests/long.cpp:601: 601 lines")

    def test_file_without_licence(self):
        self.put("tests/free.cpp", "// mine\n")
        self.assert_broken("tests/free.cpp:1: no SPDX")

    def test_link_that_leads_nowhere(self):
        self.put("README.md", "[a](docs/architecture.md#part) [b](https://example.org/x)\n![c](docs/none.png)\n")
        self.assert_broken("README.md:2: the link to docs/none.png leads nowhere")

    def test_new_edge_makes_the_document_untrue(self):
        self.put("welkin/gpu/CMakeLists.txt", HASH_SPDX + "welkin_module(gpu SOURCES a.cpp DEPENDS core sky)\n")
        code, out = self.check()
        self.assertEqual(code, 1)
        self.assertIn("docs/architecture.md:2: the table is not what CMake says", out)
        self.assertIn("docs/architecture.svg:1: the picture is not what CMake says", out)
        self.assertEqual(self.check("--write")[0], 0)
        self.assertEqual(self.check()[0], 0)

    def test_document_keeps_what_people_wrote(self):
        text = (self.root / "docs/architecture.md").read_text()
        self.assertIn("| `scene` | about scene | `sky`, `weather` |", text)
        self.assertTrue(text.endswith("\nend\n"))

    def test_picture_leaves_out_what_follows(self):
        self.put("welkin/scene/CMakeLists.txt", HASH_SPDX + "welkin_module(scene SOURCES a.cpp DEPENDS core sky weather)\n")
        self.check("--write")
        drawing = (self.root / "docs/architecture.svg").read_text()
        self.assertIn('data-edge="scene sky"', drawing)
        self.assertNotIn('data-edge="scene core"', drawing)


if __name__ == "__main__":
    unittest.main()
