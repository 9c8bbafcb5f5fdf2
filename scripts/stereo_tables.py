#!/usr/bin/env python3
"""The tables of docs/stereo.md, as Markdown, from reports of `latewarp replay --eyes stereo`.

stereo_tables.py REPORT.json ...   (each with the baselines scanline, two-renders and fresh-same; REPORT.shells.json
beside it is the same run with shells)
"""

import json
import pathlib
import sys

COLUMNS = ("scene, trace", "mode", "SSIM to `fresh-same`, left / right", "SSIM to truth, left / right",
           "unreached, left / right", "rivalry", "vertical, px (floor)", "colour excess", "stale shading, of FLIP")


def mean(distribution, digits):
    return "-" if distribution is None else f"{distribution['mean']:.{digits}f}"


def both(eyes, figure, digits, factor=1.0):
    values = [eyes[eye]["error"][figure]["mean"] * factor for eye in ("left", "right")]
    return " / ".join(f"{value:.{digits}f}" for value in values)


def stale_share(eyes):
    errors = [eyes[eye]["error"] for eye in ("left", "right")]
    stale = sum(error["attribution"]["stale_shading"]["mean"] for error in errors)
    return f"{100.0 * stale / sum(error['flip']['mean'] for error in errors):.1f} %"


def row(name, mode, eyes, floor):
    cells = (name, mode, both(eyes, "ssim_to_fresh_same", 4), both(eyes, "ssim", 4),
             both(eyes, "hole_fraction", 2, 100.0) + " %", mean({"mean": 100.0 * eyes["rivalry_fraction"]["mean"]}, 2) + " %",
             f"{mean(eyes['vertical_disparity_px'], 3)} ({mean(floor, 3)})", mean(eyes["colour_excess"], 4), stale_share(eyes))
    return "| " + " | ".join(cells) + " |"


def main():
    print("| " + " | ".join(COLUMNS) + " |")
    print("|" + "---|" * len(COLUMNS))
    for path in map(pathlib.Path, sys.argv[1:]):
        report = json.loads(path.read_text())
        name = path.stem.replace(".", ", ", 1)
        floor = report["baselines"]["fresh-same"]["stereo"]["vertical_disparity_px"]
        print(row(name, "`one-render`", report["stereo"], floor))
        shells = path.with_suffix(".shells.json")
        if shells.exists():
            print(row("", "`one-render`, shells", json.loads(shells.read_text())["stereo"], floor))
        for mode in ("scanline", "two-renders"):
            print(row("", f"`{mode}`", report["baselines"][mode]["stereo"], floor))


if __name__ == "__main__":
    main()
