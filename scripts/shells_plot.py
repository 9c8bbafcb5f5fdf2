#!/usr/bin/env python3
"""Plots one layer, --layers 2 and --shells auto against each other, from the reports of scripts/shells.

usage: shells_plot.py FOLDER > FILE.svg

Left the holes before fill, right the mean FLIP, both over the modelled app time per frame; a line joins the three ways
of drawing one run.
"""

import json
import pathlib
import sys

WAYS = [("one", "one layer", "#666666"), ("hidden", "--layers 2", "#c07020"), ("shells", "--shells auto", "#2060c0")]
WIDTH, HEIGHT, LEFT, TOP = 330, 250, 55, 40


def points(folder):
    runs = {}
    for path in sorted(folder.glob("*-*.json")):
        run, way = path.stem.rsplit("-", 1)
        if way not in dict((w[0], 0) for w in WAYS):
            continue
        report = json.loads(path.read_text())
        error = report["error"]
        runs.setdefault(run, {})[way] = (report["app_model_ms"]["mean"], 100 * error["hole_fraction"]["mean"],
                                         error["flip"]["mean"])
    return {run: ways for run, ways in runs.items() if len(ways) == len(WAYS)}


def panel(runs, index, title, x0):
    most_x = 1.1 * max(point[0] for ways in runs.values() for point in ways.values())
    most_y = 1.1 * max(point[index] for ways in runs.values() for point in ways.values())
    x = lambda value: x0 + LEFT + WIDTH * value / most_x
    y = lambda value: TOP + HEIGHT * (1 - value / most_y)
    out = [f'<text x="{x0 + LEFT + WIDTH / 2:.0f}" y="22" text-anchor="middle" font-size="14">{title}</text>',
           f'<rect x="{x0 + LEFT}" y="{TOP}" width="{WIDTH}" height="{HEIGHT}" fill="none" stroke="#bbb"/>']
    for i in range(5):
        value_x, value_y = most_x * i / 4, most_y * i / 4
        out.append(f'<text x="{x(value_x):.1f}" y="{TOP + HEIGHT + 16}" text-anchor="middle">{value_x:.0f}</text>')
        out.append(f'<text x="{x0 + LEFT - 6}" y="{y(value_y) + 4:.1f}" text-anchor="end">{value_y:.3g}</text>')
    out.append(f'<text x="{x0 + LEFT + WIDTH / 2:.0f}" y="{TOP + HEIGHT + 34}" text-anchor="middle">'
               'app time per frame, modelled ms</text>')
    for run, ways in runs.items():
        places = [(x(ways[way][0]), y(ways[way][index])) for way, _, _ in WAYS]
        out.append('<polyline fill="none" stroke="#ccc" points="'
                   + " ".join(f"{px:.1f},{py:.1f}" for px, py in places) + '"/>')
        out.append(f'<text x="{places[1][0] + 7:.1f}" y="{places[1][1] - 5:.1f}" fill="#888">{run}</text>')
        for (px, py), (_, _, colour) in zip(places, WAYS):
            out.append(f'<circle cx="{px:.1f}" cy="{py:.1f}" r="4.5" fill="{colour}"/>')
    return out


runs = points(pathlib.Path(sys.argv[1]))
if not runs:
    sys.exit("shells_plot.py: error: no run with all three ways: " + sys.argv[1] + ": run scripts/shells first")
full_width = 2 * (LEFT + WIDTH) + 110
print(f'<svg xmlns="http://www.w3.org/2000/svg" width="{full_width}" height="{TOP + HEIGHT + 70}" '
      'font-family="sans-serif" font-size="11"><rect width="100%" height="100%" fill="white"/>')
print("\n".join(panel(runs, 1, "holes before fill, %", 0) + panel(runs, 2, "mean FLIP", LEFT + WIDTH + 20)))
for i, (_, label, colour) in enumerate(WAYS):
    print(f'<circle cx="{220 + 170 * i}" cy="{TOP + HEIGHT + 55}" r="4.5" fill="{colour}"/>'
          f'<text x="{230 + 170 * i}" y="{TOP + HEIGHT + 59}">{label}</text>')
print("</svg>")
