#!/usr/bin/env python3
"""includes.py ROOT: every include is one that the tables of docs/architecture.md allow."""

import pathlib
import re
import sys

from source_files import cpp_files, finish

INCLUDE = re.compile(r'^\s*#\s*include\s*([<"])([^>"]+)[>"]', re.MULTILINE)
FREE_FOLDERS = {"tests", "bench"}  # may include everything, and nobody includes them


def table_rows(text, heading):
    """Cells of the table whose header row begins with the given cells, without backticks."""
    rows = []
    inside = False
    for line in text.splitlines():
        cells = [cell.strip().replace("`", "") for cell in line.strip().strip("|").split("|")]
        if not line.startswith("|"):
            inside = False
        elif cells[: len(heading)] == heading:
            inside = True
        elif inside and not all(set(cell) <= set("-: ") for cell in cells):
            rows.append(cells)
    return rows


def read_rules(text):
    allowed = {}
    for _, folder, _, includes in table_rows(text, ["level", "folder", "holds", "may include"]):
        names = set() if includes == "-" else {name.strip() for name in includes.split(",")}
        allowed[folder.strip("/")] = names
    homes = {header: home for header, home in table_rows(text, ["header", "only in"])}
    return allowed, homes


def problem_of(path, header, quoted, allowed, homes):
    """What is wrong with one include; `path` relative to the root. None when it is allowed."""
    folder = path.split("/")[0]
    for library, home in homes.items():
        if header == library or (library.endswith("/") and header.startswith(library)):
            at_home = path == home or (home.endswith("/") and path.startswith(home))
            return None if at_home else f"only {home} includes <{library}>"
    if not quoted:
        return None
    target = header.split("/")[0]
    if target not in allowed:
        return "not written from the project's root"
    if folder in FREE_FOLDERS or target == folder:
        return None
    if target in FREE_FOLDERS:
        return f"nobody includes {target}/"
    if folder == "examples":
        return None  # built against the installed package, which holds only what it may include
    return None if target in allowed[folder] else f"{folder}/ may not include {target}/"


def check_the_checker(allowed, homes):
    """A rule that finds nothing must be able to find something."""
    folders = {"core", "shaders", "gl", "scene", "frame_link", "billboard_lod", "client_renderer", "warp_server",
               "apps", "tests", "bench"}
    assert set(allowed) == folders, f"folders in docs/architecture.md: {sorted(allowed)}"
    assert len(homes) >= 5, f"libraries in docs/architecture.md: {sorted(homes)}"
    forbidden = [("warp_server/a.cpp", "scene/scene.h"), ("core/a.h", "gl/api.h"), ("gl/a.h", "tests/support/gl_test.h"),
                 ("apps/a.cpp", "epoxy/gl.h"), ("scene/a.cpp", "GLFW/glfw3.h"), ("core/a.cpp", "pose.h"),
                 ("frame_link/a.cpp", "warp_server/fill.h")]
    for path, header in forbidden:
        assert problem_of(path, header, True, allowed, homes), f"{path} -> {header} would pass"
    for path, header in [("gl/api.h", "epoxy/gl.h"), ("gl/context.cpp", "epoxy/egl.h"), ("apps/a.cpp", "scene/scene.h"),
                         ("client_renderer/a.h", "frame_link/feeds.h"), ("tests/core/a.cpp", "tests/support/gl_test.h")]:
        assert not problem_of(path, header, True, allowed, homes), f"{path} -> {header} would fail"


def main():
    root = pathlib.Path(sys.argv[1])
    allowed, homes = read_rules((root / "docs/architecture.md").read_text())
    check_the_checker(allowed, homes)
    problems = []
    for path in cpp_files(root):
        name = path.relative_to(root).as_posix()
        for quote, header in INCLUDE.findall(path.read_text()):
            problem = problem_of(name, header, quote == '"', allowed, homes)
            if problem:
                problems.append(f"{name}: #include {header}: {problem}")
    finish("includes", problems)


if __name__ == "__main__":
    main()
