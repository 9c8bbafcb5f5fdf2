#!/usr/bin/env python3
"""Tables of the reports that scripts/shells wrote: usage shells_table.py FOLDER"""

import csv
import json
import pathlib
import sys

folder = pathlib.Path(sys.argv[1])


def load(name):
    path = folder / f"{name}.json"
    return json.loads(path.read_text()) if path.exists() else None


def row(label, report):
    error, cost = report["error"], report["cost_ms"]
    mean = lambda key: error[key]["mean"]
    return (f"| {label} | {100 * mean('hole_fraction'):.2f} | {100 * mean('behind_fraction'):.2f} | "
            f"{mean('flip'):.4f} | {error['flip']['p95']:.4f} | {report['app_model_ms']['mean']:.1f} | "
            f"{cost['app']['mean']:.0f} | {cost['warp_cpu']['mean']:.1f} |")


print("| run | holes, % | shown behind, % | FLIP | p95 | app, modelled ms | app, ms | warp, processor ms |")
print("|---|---|---|---|---|---|---|---|")
for path in sorted(folder.glob("*.json")):
    print(row(path.stem, load(path.stem)))

print()
print("| shells against one layer | holes | FLIP | p95 FLIP | app (modelled) | app (wall) | warp |")
print("|---|---|---|---|---|---|---|")
for path in sorted(folder.glob("*-one.json")):
    name = path.stem[:-4]
    one, shells = load(f"{name}-one"), load(f"{name}-shells")
    if shells is None:
        continue
    part = lambda get: f"{get(shells) / get(one):.2f}" if get(one) else "-"
    print(f"| {name} | {part(lambda r: r['error']['hole_fraction']['mean'])} | "
          f"{part(lambda r: r['error']['flip']['mean'])} | {part(lambda r: r['error']['flip']['p95'])} | "
          f"{part(lambda r: r['app_model_ms']['mean'])} | {part(lambda r: r['cost_ms']['app']['mean'])} | "
          f"{part(lambda r: r['cost_ms']['warp_cpu']['mean'])} |")


def frames_flip(name):
    with open(folder / name / "frames.csv", newline="") as file:
        return [float(row["surface.flip"]) for row in csv.DictReader(file)]


def p95(values):
    return sorted(values)[-(-95 * len(values) // 100) - 1]


# The recorded heads as one run: means over the traces, p95 over the display frames of all.
heads = [path.stem[:-4] for path in sorted(folder.glob("city-user*-one.json")) if load(path.stem[:-4] + "-shells")]
if heads:
    def pooled(get):
        ones = sum(get(load(f"{head}-one")) for head in heads)
        return f"{sum(get(load(f'{head}-shells')) for head in heads) / ones:.2f}"

    tails = {way: p95([flip for head in heads for flip in frames_flip(f"{head}-{way}")]) for way in ("one", "shells")}
    print(f"| all {len(heads)} heads | {pooled(lambda r: r['error']['hole_fraction']['mean'])} | "
          f"{pooled(lambda r: r['error']['flip']['mean'])} | {tails['shells'] / tails['one']:.2f} | "
          f"{pooled(lambda r: r['app_model_ms']['mean'])} | {pooled(lambda r: r['cost_ms']['app']['mean'])} | "
          f"{pooled(lambda r: r['cost_ms']['warp_cpu']['mean'])} |")

print()
for path in sorted(folder.glob("*-shells.json")):
    report = load(path.stem)
    shells = report["shells"]
    print(f"{path.stem}: {shells['items_drawn']['mean']:.1f} items a frame, redrawn "
          f"{100 * shells['redraw_fraction']['mean']:.1f} % of everything, over budget in "
          f"{100 * shells['frames_over_budget']:.0f} % of the frames, nothing drawn in "
          f"{100 * shells['frames_without_redraw']:.0f} %, SSIM {report['error']['ssim']['mean']:.4f}")
