#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Checks the rules of the house; exits 1 and prints `path:line: what is wrong` where one is broken.

    tools/check_house.py [ROOT]           check the tree at ROOT (this one unless told)
    tools/check_house.py --write [ROOT]   first redraw docs/architecture.svg and the table in docs/architecture.md

The rules:
  * Includes run downwards. The allowed edges are the DEPENDS of welkin/<folder>/CMakeLists.txt, taken transitively, and nothing
    else: they are also what is linked. A folder's DEPENDS come before it in WELKIN_FOLDERS, so that there is no circle.
  * Files of the library include "welkin/<folder>/..." and "shaders/lib/..." and nothing else of this repository.
  * Shaders include "lib/..." and nothing else, and hold no #version.
  * OpenGL and EGL headers are included by welkin/gpu alone; by bindings and by tests/testing where they stand for an engine.
  * A source file has at most 600 lines and says its licence in its first lines.
  * docs/architecture.md and docs/architecture.svg show the edges that are there.
  * Links in Markdown files that lead into the repository lead somewhere.

Python's standard library only.
"""
import pathlib
import re
import sys

MAX_LINES = 600
SOURCE_SUFFIXES = {".h", ".cpp", ".glsl", ".vert", ".frag", ".comp", ".py", ".cmake", ".sh", ".toml"}
SOURCE_NAMES = {"CMakeLists.txt", "dev"}
SOURCE_FOLDERS = ["apps", "bench", "bindings", "cmake", "demo", "examples", "shaders", "tests", "tools", "welkin"]
CPP_SUFFIXES = {".h", ".cpp"}
INCLUDE = re.compile(r'^\s*#\s*include\s*([<"])([^>"]+)[>"]')
GRAPHICS_HEADER = re.compile(r"^(epoxy|GL|GLES[23]?|EGL|KHR)/")
LINK = re.compile(r"\]\(([^)#\s:]+)(?:#[^)]*)?\)")
TABLE_BEGIN, TABLE_END = "<!-- edges: begin (tools/check_house.py --write) -->", "<!-- edges: end -->"


class House:
    """The folders of welkin/ from the ground up, and for each the folders that it names in its DEPENDS."""

    def __init__(self, root):
        self.root = root
        self.problems = []
        self.folders = []
        self.depends = {}
        self._read()
        self.reach = {}  # what may be included: the folder itself and everything below
        for folder in self.folders:
            self.reach[folder] = {folder}.union(*(self.reach.get(d, set()) for d in self.depends[folder]))

    def problem(self, path, line, message):
        self.problems.append(f"{path.relative_to(self.root)}:{line}: {message}")

    def _read(self):
        top = self.root / "CMakeLists.txt"
        match = re.search(r"set\(WELKIN_FOLDERS\s+([^)]*)\)", without_comments(top.read_text()))
        names = match.group(1).split() if match else []
        if not names:
            self.problem(top, 1, "no set(WELKIN_FOLDERS ...)")
        for name in names:
            cmake = self.root / "welkin" / name / "CMakeLists.txt"
            if not cmake.exists():
                continue
            text = without_comments(cmake.read_text())
            match = re.search(r"welkin_module\(\s*(\w+)([^)]*)\)", text)
            if not match or match.group(1) != name:
                self.problem(cmake, 1, f"expected welkin_module({name} ...)")
                continue
            depends = re.search(r"\bDEPENDS\b((?:\s+[a-z0-9_]+)+)", match.group(2))
            self.depends[name] = depends.group(1).split() if depends else []
            for dependency in self.depends[name]:
                if dependency not in self.folders:
                    self.problem(cmake, 1, f"{name} DEPENDS {dependency}, which does not stand before it in WELKIN_FOLDERS")
            self.folders.append(name)
        for path in sorted((self.root / "welkin").iterdir()):
            if path.is_dir() and path.name not in self.folders:
                self.problem(path, 1, "a folder without welkin_module() or not in WELKIN_FOLDERS")

    def edges(self):
        """The edges that say something: without those that follow from others."""
        return {folder: [d for d in self.depends[folder]
                         if not any(d in self.reach[e] for e in self.depends[folder] if e != d)]
                for folder in self.folders}


def without_comments(cmake):
    return re.sub(r"#[^\n]*", "", cmake)


def source_files(root):
    for folder in SOURCE_FOLDERS:
        for path in sorted((root / folder).rglob("*")):
            hidden = any(part.startswith(".") or part == "__pycache__" for part in path.relative_to(root).parts)
            if path.is_file() and not hidden and (path.suffix in SOURCE_SUFFIXES or path.name in SOURCE_NAMES):
                if "data" not in path.relative_to(root).parts:
                    yield path
    for name in ("CMakeLists.txt", "dev"):
        if (root / name).exists():
            yield root / name


def check_file(house, path):
    relative = path.relative_to(house.root)
    text = path.read_text(encoding="utf-8", errors="replace")
    lines = text.splitlines()
    if len(lines) > MAX_LINES:
        house.problem(path, len(lines), f"{len(lines)} lines; at most {MAX_LINES}: split it")
    if not any("SPDX-License-Identifier: Apache-2.0" in line for line in lines[:3]):
        house.problem(path, 1, "no SPDX-License-Identifier in the first lines")
    if relative.parts[0] == "shaders":
        check_shader(house, path, lines)
    elif path.suffix in CPP_SUFFIXES:
        check_cpp(house, path, lines)


def check_shader(house, path, lines):
    for number, line in enumerate(lines, 1):
        if re.match(r"\s*#\s*version\b", line):
            house.problem(path, number, "#version belongs to whoever puts shaders together")
        match = INCLUDE.match(line)
        if not match:
            continue
        target = match.group(2)
        if not target.startswith("lib/"):
            house.problem(path, number, f'shaders include "lib/..." only, not "{target}"')
        elif not (house.root / "shaders" / target).exists():
            house.problem(path, number, f"shaders/{target} does not exist")


def check_cpp(house, path, lines):
    parts = path.relative_to(house.root).parts
    folder = parts[1] if parts[0] == "welkin" and len(parts) > 2 else None
    for number, line in enumerate(lines, 1):
        match = INCLUDE.match(line)
        if not match:
            continue
        quote, target = match.groups()
        foreign = parts[0] == "bindings" or parts[:2] == ("tests", "testing")
        if GRAPHICS_HEADER.match(target) and folder != "gpu" and not foreign:
            house.problem(path, number, f"<{target}>: OpenGL and EGL headers are for welkin/gpu alone")
        if target.startswith(("welkin/", "shaders/")):
            if not (house.root / target).exists():
                house.problem(path, number, f"{target} does not exist")
        if folder is None:
            continue
        if target.startswith("welkin/"):
            below = target.split("/")[1]
            if folder in house.reach and below not in house.reach[folder]:
                direction = "upwards" if folder in house.reach.get(below, ()) else "sideways"
                house.problem(path, number, f"{folder}/ includes {direction}: {target} (it may include "
                              f"{', '.join(f for f in house.folders if f in house.reach[folder])})")
        elif target.startswith("shaders/lib/"):
            pass
        elif quote == '"' or target.split("/")[0] in SOURCE_FOLDERS:
            house.problem(path, number, f'"{target}": the library includes "welkin/..." and "shaders/lib/..." only')


def check_links(house):
    pages = [*house.root.glob("*.md"), *(p for f in [*SOURCE_FOLDERS, "docs"] for p in (house.root / f).rglob("*.md"))]
    for page in sorted(pages):
        for number, line in enumerate(page.read_text().splitlines(), 1):
            for target in LINK.findall(line):
                if not (page.parent / target).exists():
                    house.problem(page, number, f"the link to {target} leads nowhere")


# --- docs/architecture ---------------------------------------------------------------------------------------------------------

def edge_table(house):
    meanings = {folder: folder_meaning(house, folder) for folder in house.folders}
    edges = house.edges()
    rows = ["| Folder | What is in it | Stands on |", "|---|---|---|"]
    for folder in reversed(house.folders):
        below = ", ".join(f"`{d}`" for d in edges[folder]) or "the standard library and glm"
        rows.append(f"| `{folder}` | {meanings[folder]} | {below} |")
    return "\n".join(rows)


def folder_meaning(house, folder):
    """What docs/architecture.md already says of the folder; people write that column, and only the others are made."""
    doc = house.root / "docs" / "architecture.md"
    text = doc.read_text() if doc.exists() else ""
    match = re.search(rf"^\| `{folder}` \| ([^|]*) \|", text, re.MULTILINE)
    return match.group(1) if match else ""


def levels(house):
    """The storey of each folder: above all that it stands on, and as near below its users as that allows."""
    storey = {}
    for folder in house.folders:
        storey[folder] = 1 + max((storey[d] for d in house.depends[folder]), default=-1)
    for folder in reversed(house.folders):
        users = [storey[user] for user in house.folders if folder in house.depends[user]]
        storey[folder] = min(users, default=storey[folder] + 1) - 1
    return storey


BOX_W, BOX_H, GAP_X, GAP_Y, MARGIN = 124, 40, 56, 58, 24


def picture(house):
    """The house as SVG: a box for each folder, a storey for each level, a line for each edge of the reduced graph."""
    storey, edges = levels(house), house.edges()
    top = max(storey.values(), default=0)
    rows = [[f for f in house.folders if storey[f] == level] for level in range(top + 1)]
    width = 2 * MARGIN + max(map(len, rows)) * (BOX_W + GAP_X) - GAP_X
    height = 2 * MARGIN + (top + 1) * BOX_H + top * GAP_Y
    x, y = {}, {}
    for level, row in enumerate(rows):
        left = (width - (len(row) * (BOX_W + GAP_X) - GAP_X)) / 2
        # Over what it stands on as far as that goes: fewer lines cross.
        row.sort(key=lambda f: (sum(x[d] for d in edges[f]) / max(len(edges[f]), 1), house.folders.index(f)))
        for i, folder in enumerate(row):
            x[folder] = left + i * (BOX_W + GAP_X) + BOX_W / 2
            y[folder] = height - MARGIN - BOX_H - level * (BOX_H + GAP_Y)
    out = [f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width} {height}" width="{width}" height="{height}" '
           'font-family="sans-serif" font-size="16">',
           "<!-- SPDX-License-Identifier: Apache-2.0 -->",
           "<!-- Drawn by tools/check_house.py from the CMake files. Do not edit. -->",
           f'<rect width="{width}" height="{height}" fill="#ffffff"/>']
    for folder in house.folders:
        for below in edges[folder]:
            x1, y1, x2, y2 = x[folder], y[folder] + BOX_H, x[below], y[below]
            # Down a free column past the storeys between, if there are any.
            between = [x[f] for f in house.folders if storey[below] < storey[f] < storey[folder]]
            column = x1
            for shift in (0, 1, -1, 2, -2):
                column = x1 + shift * (BOX_W + GAP_X) / 2
                if all(abs(column - centre) > BOX_W / 2 for centre in between):
                    break
            bend = GAP_Y * 0.6
            path = f"M{x1:g} {y1:g}"
            if between:
                path += f" C{x1:g} {y1 + bend:g} {column:g} {y1 + GAP_Y - bend:g} {column:g} {y1 + GAP_Y:g} V{y2 - GAP_Y:g}"
                x1, y1 = column, y2 - GAP_Y
            path += f" C{x1:g} {y1 + bend:g} {x2:g} {y2 - bend:g} {x2:g} {y2:g}"
            out.append(f'<path data-edge="{folder} {below}" d="{path}" fill="none" stroke="#8aa0b8" stroke-width="2"/>')
    for folder in house.folders:
        left, upper = x[folder] - BOX_W / 2, y[folder]
        out.append(f'<rect x="{left:g}" y="{upper:g}" width="{BOX_W}" height="{BOX_H}" rx="6" fill="#e4eef8" '
                   'stroke="#3b5f86" stroke-width="1.5"/>')
        out.append(f'<text x="{x[folder]:g}" y="{upper + BOX_H / 2 + 5.5:g}" text-anchor="middle" fill="#16324f">{folder}</text>')
    return "\n".join(out + ["</svg>", ""])


def document(house, write):
    doc, drawing = house.root / "docs" / "architecture.md", house.root / "docs" / "architecture.svg"
    if not doc.exists():
        house.problem(house.root / "docs", 1, "no architecture.md")
        return
    text = doc.read_text()
    if TABLE_BEGIN not in text or TABLE_END not in text:
        house.problem(doc, 1, f"expected a table between '{TABLE_BEGIN}' and '{TABLE_END}'")
        return
    before, rest = text.split(TABLE_BEGIN, 1)
    after = rest.split(TABLE_END, 1)[1]
    true_text = f"{before}{TABLE_BEGIN}\n{edge_table(house)}\n{TABLE_END}{after}"
    true_drawing = picture(house)
    if write:
        doc.write_text(true_text)
        drawing.write_text(true_drawing)
        return
    again = "run tools/check_house.py --write"
    if text != true_text:
        house.problem(doc, before.count("\n") + 1, f"the table is not what CMake says; {again}")
    if not drawing.exists() or drawing.read_text() != true_drawing:
        house.problem(drawing, 1, f"the picture is not what CMake says; {again}")
    for folder in house.folders:
        if not folder_meaning(house, folder):
            house.problem(doc, before.count("\n") + 1, f"nothing is said about {folder}/")


def main(arguments):
    write = "--write" in arguments
    paths = [a for a in arguments if not a.startswith("--")]
    root = pathlib.Path(paths[0]) if paths else pathlib.Path(__file__).resolve().parent.parent
    house = House(root.resolve())
    if not house.problems:  # a house with a circle cannot be drawn
        document(house, write)
    for path in source_files(house.root):
        check_file(house, path)
    check_links(house)
    for problem in house.problems:
        print(problem)
    if not house.problems:
        print(f"{len(house.folders)} folders, {sum(map(len, house.depends.values()))} edges: in order")
    return 1 if house.problems else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
