#!/usr/bin/env python3
"""Tables of the reports that scripts/shells wrote.

usage: shells_table.py FOLDER [PAGE]

Prints all of them; with a page puts those of the recorded heads, and what shells are worth, between its marks instead.
"""

import csv
import json
import pathlib
import sys

MARKS = {
    "heads": ("<!-- recorded heads: scripts/shells --write -->", "<!-- end of the recorded heads -->"),
    "worth": ("<!-- shells against one layer: scripts/shells --write -->", "<!-- end of shells against one layer -->"),
}
WAYS = [("one", "one layer"), ("hidden", "`--layers 2`"), ("shells", "`--shells auto`")]
WALKS = {f"{scene}-walk": f"`{scene} --trace walk --trace-start 2`" for scene in ("city", "rooms")}


def load(folder, name):
    path = folder / f"{name}.json"
    return json.loads(path.read_text()) if path.exists() else None


def mean(report, *keys):
    for key in keys:
        report = report[key]
    return report["mean"]


def cells(*values):
    return "| " + " | ".join(values) + " |"


def table(header, rows):
    return [cells(*header), "|" + "---|" * len(header), *rows]


def error_cells(report):
    return [f"{100 * mean(report, 'error', 'hole_fraction'):.2f}",
            f"{100 * mean(report, 'error', 'behind_fraction'):.2f}",
            f"{mean(report, 'error', 'flip'):.4f}", f"{report['error']['flip']['p95']:.4f}",
            f"{mean(report, 'app_model_ms'):.1f}"]


def all_runs(folder):
    rows = []
    for path in sorted(folder.glob("*.json")):
        report = load(folder, path.stem)
        rows.append(cells(path.stem, *error_cells(report), f"{mean(report, 'cost_ms', 'app'):.0f}",
                          f"{mean(report, 'cost_ms', 'warp_cpu'):.1f}"))
    return table(["run", "holes, %", "shown behind, %", "FLIP", "p95", "app, modelled ms", "app, ms",
                  "warp, processor ms"], rows)


def compared(folder, pattern="*"):
    """Names of the runs that have one layer and shells."""
    names = [path.stem[:-len("-one")] for path in sorted(folder.glob(f"{pattern}-one.json"))]
    return [name for name in names if load(folder, f"{name}-shells")]


def heads_of(folder):
    return compared(folder, "city-user*")


def label_of(name):
    return WALKS.get(name, name.removeprefix("city-"))


def recorded_heads(folder):
    rows = []
    for head in heads_of(folder):
        for way, label in WAYS:
            if report := load(folder, f"{head}-{way}"):
                rows.append(cells(f"{label_of(head)}, {label}", *error_cells(report)))
    return table(["run", "holes, %", "shown behind, %", "FLIP", "p95", "app, ms"], rows)


def frames_flip(folder, name):
    with open(folder / name / "frames.csv", newline="") as file:
        return [float(row["surface.flip"]) for row in csv.DictReader(file)]


def p95(values):
    return sorted(values)[-(-95 * len(values) // 100) - 1]


def ratio(over, under):
    return f"{over / under:.2f}" if under else "-"


def worth_row(folder, label, names, tail):
    """Means over the runs of each quantity, shells over one layer; tail(way): their p95."""
    def part(*keys):
        return ratio(*(sum(mean(load(folder, f"{name}-{way}"), *keys) for name in names) for way in ("shells", "one")))

    return cells(label, part("error", "hole_fraction"), part("error", "flip"), ratio(tail("shells"), tail("one")),
                 part("app_model_ms"), part("cost_ms", "app"), part("cost_ms", "warp_cpu"))


def worth(folder, others):
    """The heads, all of them as one run (p95 over the display frames of all), and the others."""
    heads = heads_of(folder)

    def row(name):
        return worth_row(folder, label_of(name), [name],
                         lambda way: load(folder, f"{name}-{way}")["error"]["flip"]["p95"])

    rows = [row(head) for head in heads]
    if heads:
        rows.append(worth_row(folder, f"all {len(heads)} heads", heads, lambda way: p95(
            [flip for head in heads for flip in frames_flip(folder, f"{head}-{way}")])))
    rows += [row(name) for name in others if name not in heads]
    return table(["shells against one layer", "holes", "FLIP", "p95 FLIP", "app, modelled", "app, wall", "warp"], rows)


def notes(folder):
    lines = []
    for path in sorted(folder.glob("*-shells.json")):
        report = load(folder, path.stem)
        shells = report["shells"]
        lines.append(f"{path.stem}: {shells['items_drawn']['mean']:.1f} items a frame, redrawn "
                     f"{100 * shells['redraw_fraction']['mean']:.1f} % of everything, over budget in "
                     f"{100 * shells['frames_over_budget']:.0f} % of the frames, nothing drawn in "
                     f"{100 * shells['frames_without_redraw']:.0f} %, SSIM {mean(report, 'error', 'ssim'):.4f}")
    return lines


def put(text, marks, lines, page):
    before, begin, rest = text.partition(marks[0])
    _, end, after = rest.partition(marks[1])
    if not (begin and end):
        sys.exit(f"shells_table.py: error: {page}: no lines {marks[0]} and {marks[1]}: put them around the table")
    return "\n".join([before + begin, "", *lines, "", end + after])


def main():
    folder = pathlib.Path(sys.argv[1])
    if len(sys.argv) < 3:
        print("\n".join([*all_runs(folder), "", *worth(folder, compared(folder)), "", *notes(folder)]))
        return
    if not heads_of(folder):
        sys.exit(f"shells_table.py: error: no run of a recorded head with one layer and with shells: {folder}: "
                 "run scripts/shells with the recordings beside the project")
    page = pathlib.Path(sys.argv[2])
    text = put(page.read_text(), MARKS["heads"], recorded_heads(folder), page)
    page.write_text(put(text, MARKS["worth"], worth(folder, [name for name in compared(folder) if name in WALKS]), page))


if __name__ == "__main__":
    main()
