#!/usr/bin/env python3
"""Puts together the pictures of docs/stereo.md from the frames that scripts/stereo let the program write.

stereo_pictures.py WORK OUT_FOLDER
"""

import pathlib
import sys

import png_crops

GAP = [png_crops.WHITE] * png_crops.GAP_PX
AMPLIFIED = 8
# Parts of the street's left eye: the lamp post before the house fronts, the railing.
DETAILS = ((150, 40, 72, 72), (20, 200, 72, 72), (250, 120, 72, 72))
HELMET = (170, 70, 250, 440)


def frame_of(folder, ending):
    """The first frame with this label."""
    return png_crops.read(sorted(folder.glob(f"frames/*.{ending}.png"))[0])


def beside(pictures):
    joined = []
    for lines in zip(*pictures):
        row = []
        for i, line in enumerate(lines):
            row += (GAP if i else []) + line
        joined.append(row)
    return joined


def below(pictures):
    joined = []
    for i, picture in enumerate(pictures):
        joined += ([[png_crops.WHITE] * len(picture[0])] * png_crops.GAP_PX if i else []) + picture
    return joined


def difference(a, b):
    """White where equal, darker the more two pictures differ."""

    def pixel(p, q):
        return bytes(max(0, 255 - AMPLIFIED * abs(x - y)) for x, y in zip(p, q))

    return [[pixel(p, q) for p, q in zip(left, right)] for left, right in zip(a, b)]


def main():
    work, out = pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2])
    out.mkdir(parents=True, exist_ok=True)
    labels = ("scanline", "two-renders", "surface", "truth")
    rows = [frame_of(work / "side-by-side", label) for label in labels]
    png_crops.write(out / "side_by_side.png", below(rows))
    glasses = [frame_of(work / "anaglyph", label) for label in ("scanline", "surface", "truth")]
    png_crops.write(out / "anaglyph.png", beside(glasses))
    details = []
    for label in labels:
        left = frame_of(work / "files", f"{label}.left")
        details.append(beside([png_crops.crop(left, *part, 3) for part in DETAILS]))
    png_crops.write(out / "left_eye.png", below(details))
    turned = [frame_of(work / "shells", label) for label in ("two-renders", "surface", "truth")]
    png_crops.write(out / "shells.png", below(turned))
    helmet = work / "helmet"
    shown, same = (png_crops.crop(frame_of(helmet, f"{label}.left"), *HELMET, 1) for label in ("surface", "fresh-same"))
    png_crops.write(out / "highlight.png", beside([same, shown, difference(same, shown)]))


if __name__ == "__main__":
    main()
