#!/usr/bin/env python3
"""The tables of costs and of views in docs/stereo.md from runs of lw_bench_stereo --benchmark_format=json.

stereo_costs.py RUN.json ... PAGE.md: medians of the runs, and of ratios what they lie between, go between the markers
<!-- costs begin --> and <!-- costs end -->; what the views show, which is the same in all, between <!-- views begin -->
and <!-- views end -->.
"""

import json
import pathlib
import statistics
import sys

from page_tables import replaced

COLUMNS = {
    "`splat`": "stereo/splat/layers:1",
    "`splat`, `--layers 2`": "stereo/splat/layers:2",
    "`surface`": "stereo/surface/layers:1",
    "`surface`, `--layers 2`": "stereo/surface/layers:2",
}
# Title, counters, digits. Several counters make a sum that is shown as such.
ROWS = [
    ("two renders, ms", ["cpu_two_renders_ms"], 0),
    ("one render, and its `prepare`, ms", ["cpu_render_ms", "cpu_prepare_ms"], 0),
    ("warp, one eye, ms", ["cpu_one_eye_ms"], 1),
    ("warp, both eyes, ms", ["cpu_both_ms"], 1),
    ("both eyes over one eye, one thread", ["cpu_eyes_over_one"], 2),
    ("both eyes over one eye, two threads, by the clock", ["threads_over_threads"], 2),
    ("client at 10 Hz, display at 90 Hz: one render and its `prepare` / 9 and both warps, over two renders per display "
     "frame", ["cpu_display_ratio"], 3),
    ("the same by the clock, warps on two threads", ["two_threads_display_ratio"], 3),
    ("the same rate for both: one render, its `prepare` and both warps, over two renders, theirs and two warps",
     ["cpu_app_ratio"], 3),
    ("the same over two renders and two warps alone", ["cpu_app_ratio_unprepared"], 3),
]
VIEWS = {
    "midway, the eyes' field of view": "centre/midway_without_margin",
    "midway with margin": "centre/midway",
    "3.2 cm back": "centre/back",
}


def cell(runs, name, counters, digits):
    def text(value):
        return f"{value:.{digits}f}"

    values = [[run[name][counter] for run in runs] for counter in counters]
    medians = " + ".join(text(statistics.median(of_runs)) for of_runs in values)
    if "ms" in counters[0].split("_") or len(runs) == 1:
        return medians
    return f"{medians} ({text(min(values[0]))} to {text(max(values[0]))})"


def cost_lines(runs):
    lines = ["| | " + " | ".join(COLUMNS) + " |", "|---" * (len(COLUMNS) + 1) + "|"]
    for title, counters, digits in ROWS:
        cells = [cell(runs, name, counters, digits) for name in COLUMNS.values()]
        lines.append(f"| {title} | " + " | ".join(cells) + " |")
    return lines


def view_lines(run):
    lines = ["| the view | pixels of an eye's | holes before fill | SSIM to the eye's own render |", "|---|---|---|---|"]
    for title, name in VIEWS.items():
        seen = run[name]
        lines.append(f"| {title} | {seen['pixels_ratio']:.2f} | {100 * seen['holes']:.2f} % | {seen['ssim']:.3f} |")
    return lines


def main():
    *reports, page = map(pathlib.Path, sys.argv[1:])
    runs = []
    for report in reports:
        benchmarks = json.loads(report.read_text())["benchmarks"]
        runs.append({benchmark["name"].split("/iterations")[0]: benchmark for benchmark in benchmarks})
    text = replaced(page.read_text(), "costs", cost_lines(runs))
    page.write_text(replaced(text, "views", view_lines(runs[0])))


if __name__ == "__main__":
    main()
