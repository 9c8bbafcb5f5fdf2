#!/usr/bin/env python3
"""doc_links.py ROOT: every link in the Markdown files that stays inside the project leads somewhere."""

import pathlib
import re
import sys

from source_files import finish, project_files

LINK = re.compile(r"!?\[[^\]]*\]\(([^)\s]+)(?:\s+\"[^\"]*\")?\)")
CODE = re.compile(r"```.*?```|`[^`\n]*`", re.DOTALL)


def anchors_of(text):
    """The anchors that a heading gets where Markdown is shown."""
    headings = re.findall(r"^#+\s+(.*)$", re.sub(r"```.*?```", "", text, flags=re.DOTALL), re.MULTILINE)
    return {re.sub(r"[^\w\- ]", "", heading.lower()).replace(" ", "-") for heading in headings}


def main():
    root = pathlib.Path(sys.argv[1])
    problems = []
    count = 0
    for path in project_files(root):
        if path.suffix != ".md":
            continue
        text = path.read_text()
        for target in LINK.findall(CODE.sub("", text)):
            if re.match(r"[a-z]+:", target):
                continue
            count += 1
            name, _, anchor = target.partition("#")
            file = (path.parent / name) if name else path
            where = path.relative_to(root)
            if not file.exists():
                problems.append(f"{where}: {target}: no such file")
            elif anchor and file.suffix == ".md" and anchor not in anchors_of(file.read_text()):
                problems.append(f"{where}: {target}: no such heading")
    if count == 0:
        problems.append("no links found: the rule itself is broken")
    finish("doc_links", problems)


if __name__ == "__main__":
    main()
