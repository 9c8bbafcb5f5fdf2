#!/usr/bin/env python3
"""Tables of docs/benchmarks.md from the report of `latewarp bench`.

bench_tables.py REPORT.json BENCHMARKS.md: replaces what stands between the markers
<!-- numbers begin --> and <!-- numbers end -->; prints the tables where there are none.
"""

import json
import pathlib
import sys

BEGIN = "<!-- numbers begin -->"
END = "<!-- numbers end -->"
BASE_FILL = "nearest-background"


def conditions(point):
    settings = point["settings"]
    return (point["size_px"][0], settings["frame_age_ms"], settings["source_samples"], settings["source_density"])


def number(value, form):
    return "-" if value is None else format(value, form)


def front_table(points, wanted):
    lines = [
        "| method | fill | warp and fill, ms (p99) | over memcpy | prepare, ms | FLIP | SSIM | PSNR, dB | holes | front |",
        "|---|---|---|---|---|---|---|---|---|---|",
    ]
    chosen = [point for point in points if conditions(point) == wanted and point["warp_ms"]]
    for point in sorted(chosen, key=lambda point: point["warp_ms"]["p50"]):
        lines.append(
            f"| `{point['method']}` | {point['settings']['fill']} "
            f"| {point['warp_ms']['p50']:.2f} ({point['warp_ms']['p99']:.2f}) | {number(point['memcpy_ratio'], '.1f')} "
            f"| {number(point['prepare_ms'], '.1f')} | {number(point['flip'], '.4f')} | {number(point['ssim'], '.4f')} "
            f"| {number(point['psnr_db'], '.1f')} | {100 * (point['hole_fraction'] or 0):.1f} % "
            f"| {'yes' if point['on_front'] else ''} |"
        )
    return lines


def core_mean(point, count=3):
    """Over the pairs that every cell of the plan has."""
    pairs = point.get("pairs", [])[:count]
    return sum(pair["flip"] for pair in pairs) / len(pairs) if pairs else None


def curve_table(points, first_title, keys, select):
    """FLIP of each method (rows) at each of `keys` (columns)."""
    methods = {}
    for point in points:
        key = select(point)
        if key in keys and point["settings"]["fill"] == BASE_FILL and "threads" not in point["method"]:
            methods.setdefault(point["method"], {})[key] = core_mean(point)
    rows = [f"| {first_title} | " + " | ".join(str(key) for key in keys) + " |", "|---" * (len(keys) + 1) + "|"]
    complete = {method: row for method, row in methods.items() if len(row) == len(keys)}
    for method, row in sorted(complete.items(), key=lambda item: item[1][keys[-1]] or 0.0):
        rows.append(f"| `{method}` | " + " | ".join(number(row[key], ".4f") for key in keys) + " |")
    return rows


def quality_key(point):
    size, age, samples, density = conditions(point)
    return f"{samples}x{samples}, density {density:g}" if size == 512 and age == 100 else None


def age_key(point):
    size, age, samples, density = conditions(point)
    return f"{age:g} ms" if size == 512 and samples == 2 and density == 1 else None


def size_table(points, sizes=(512, 1024, 2048)):
    methods = {}
    for point in points:
        size, age, samples, density = conditions(point)
        if age == 100 and samples == 2 and density == 1 and point["settings"]["fill"] == BASE_FILL and point["warp_ms"]:
            methods.setdefault(point["method"], {})[size] = point
    lines = ["| method | " + " | ".join(f"{size}x{size}" for size in sizes) + " |", "|---" * (len(sizes) + 1) + "|"]
    for method, row in sorted(methods.items(), key=lambda item: item[1].get(512, {"warp_ms": {"p50": 0}})["warp_ms"]["p50"]):
        if len(row) < 2:
            continue
        cells = [
            f"{row[size]['warp_ms']['p50']:.2f} ({row[size]['memcpy_ratio']:.1f}x)" if size in row else "-" for size in sizes
        ]
        lines.append(f"| `{method}` | " + " | ".join(cells) + " |")
    return lines


def fresh_table(points, entries):
    """`surface` beside pictures drawn with no latency at all."""
    fresh = {entry["samples"]: core_mean(entry) for entry in entries if entry["size_px"][0] == 512}
    if 1 not in fresh:
        return []
    flips = {}
    for point in points:
        size, age, samples, density = conditions(point)
        if (size, age, density) == (512, 100, 1) and point["settings"]["fill"] == BASE_FILL:
            flips[point["method"], samples] = core_mean(point)
    lines = ["", "`surface`, frames 100 ms old, beside a picture drawn with no latency at all (the same three pairs):", ""]
    lines += ["| source | no latency | `surface` | of one sample with no latency | latency's, of `rotation`'s |", "|---" * 5 + "|"]
    for samples, zero in sorted(fresh.items()):
        surface, rotation = flips.get(("surface", samples)), flips.get(("rotation", samples))
        if surface is None or rotation is None:
            continue
        share = (surface - zero) / (rotation - zero)
        lines.append(f"| {samples}x{samples} | {zero:.4f} | {surface:.4f} | {surface / fresh[1]:.2f} | {share:.2f} |")
    return lines


def text_of(report):
    machine, points = report["machine"], report["points"]
    measured = sum(1 for point in points if point["warp_ms"])
    lines = [f"{machine['cpu']}, {machine['cores']} cores, {machine['gl_renderer']}; {len(points)} points, {measured} of them timed."]
    if report.get("suspect"):
        lines[0] += f" **Times are suspect: {report['suspect']}.**"
    lines += ["", "512x512, frames 100 ms old, 2x2 source samples, all nine pairs of scene and trace:", ""]
    lines += front_table(points, (512, 100, 2, 1))
    lines += ["", "Mean FLIP at 512x512 against the frame's age, 2x2 source samples (three pairs):", ""]
    lines += curve_table(points, "method", ["20 ms", "50 ms", "100 ms", "200 ms"], age_key)
    qualities = ["1x1, density 1", "1x1, density 2", "2x2, density 1", "2x2, density 2", "4x4, density 1"]
    lines += ["", "Mean FLIP at 512x512 against the source, frames 100 ms old (three pairs):", ""]
    lines += curve_table(points, "method", qualities, quality_key)
    lines += fresh_table(points, report.get("fresh", []))
    lines += ["", "Run time in ms (and over a memcpy of the source) against size, frames 100 ms old:", ""]
    lines += size_table(points)
    return "\n".join(lines) + "\n"


def main():
    text = text_of(json.loads(pathlib.Path(sys.argv[1]).read_text()))
    page = pathlib.Path(sys.argv[2])
    before, begin, rest = (page.read_text() if page.exists() else "").partition(BEGIN)
    _, end, after = rest.partition(END)
    if begin and end:
        page.write_text(f"{before}{BEGIN}\n{text}{END}{after}")
    else:
        print(text, end="")


if __name__ == "__main__":
    main()
