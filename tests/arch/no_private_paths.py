#!/usr/bin/env python3
"""no_private_paths.py ROOT: no file names a folder or a host that exists only where it was written."""

import pathlib
import re
import sys

from source_files import finish, project_files

# Absolute paths below the usual places of people's files, and hosts that only a private network knows.
PRIVATE = re.compile(
    r"""(?<![\w./-])/(?:work|home|root|Users|mnt|media)/[\w.-]+
      | \bhttps?://(?:\d+\.\d+\.\d+\.\d+|localhost|[\w.-]+\.(?:internal|intranet|corp|lan|local))\b""",
    re.VERBOSE,
)
TEXT = {".cpp", ".h", ".py", ".md", ".txt", ".cmake", ".json", ".sh", ".in", ".glsl", ".vert", ".frag", ".comp", ".geom",
        ".html", ".csv", ""}


def main():
    root = pathlib.Path(sys.argv[1])
    assert PRIVATE.search('path = "/home/someone/data"') and PRIVATE.search("http://packages.corp/simple")
    assert not PRIVATE.search("see docs/home/page.md and https://example.org/work/of-art")
    problems = []
    for path in project_files(root):
        if path.suffix not in TEXT or path.resolve() == pathlib.Path(__file__).resolve():
            continue
        for number, line in enumerate(path.read_text(errors="replace").splitlines(), 1):
            match = PRIVATE.search(line)
            if match:
                problems.append(f"{path.relative_to(root)}:{number}: {match.group(0)}")
    finish("no_private_paths", problems)


if __name__ == "__main__":
    main()
