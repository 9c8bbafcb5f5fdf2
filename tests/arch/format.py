#!/usr/bin/env python3
"""format.py ROOT: clang-format would change nothing."""

import pathlib
import shutil
import subprocess
import sys

from source_files import cpp_files, finish


def main():
    root = pathlib.Path(sys.argv[1])
    program = shutil.which("clang-format-14")
    if program is None:
        finish("format", ["clang-format-14 is not installed (scripts/packages.txt lists it)"])
    files = cpp_files(root)
    result = subprocess.run([program, "--dry-run", "-Werror", *files], capture_output=True, text=True)
    changed = sorted({line.split(":")[0] for line in result.stderr.splitlines() if "clang-format-violations" in line})
    problems = [f"{path}: run clang-format-14 -i on it" for path in changed]
    if result.returncode != 0 and not problems:
        problems = [result.stderr.strip()]
    finish("format", problems)


if __name__ == "__main__":
    main()
