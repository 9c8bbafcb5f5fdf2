#!/usr/bin/env python3
"""Tables of the report of `latewarp bench --suite skip`: usage skipping_tables.py report.json"""

import json
import sys

report = json.load(open(sys.argv[1], encoding="utf-8"))


def frames(title, rows):
    print(f"\n| {title} | objects | triangles | draw calls | frame, ms | culling, ms (p99) |\n|---|---|---|---|---|---|")
    for row in rows:
        print(f"| {row['label']} | {row['objects_drawn']:,.0f} | {row['triangles_drawn']:,.0f} | "
              f"{row['draw_calls']:.0f} | {row['frame_ms']:,.0f} | {row['culling_ms']:.2f} ({row['culling_p99_ms']:.2f}) |")


for key, value in report["skip"].items():
    print(key, value)
frames("town of 20,000 buildings", report["town"])
frames("default town", report["default_town"])
frames("default town, order of draws", report["draw_orders"])
frames("rooms", report["rooms"])

print("\n| objects | in view, % | list, ns | hierarchy, ns | reading, ns | six frusta at once | one by one |")
print("|---|---|---|---|---|---|---|")
for row in report["frustum"]:
    if row["objects"] in (64, 512, 1024, 4096, 32768, 524288):
        print(f"| {row['objects']:,.0f} | {100 * row['seen_fraction']:.1f} | {row['linear_ns']:.2f} | "
              f"{row['hierarchical_ns']:.3f} | {row['read_only_ns']:.2f} | {row['six_at_once_ns']:.3f} | "
              f"{row['six_one_by_one_ns']:.3f} |")

print("\n| scene, trace | margin, m | in view | hidden | skipped, % | wrongly |\n|---|---|---|---|---|---|")
for row in report["reveal_checks"]:
    print(f"| {row['scene']}, {row['trace'].split('/')[-1]} | {row['margin_m']:.3f} | {row['objects_in_view']:.0f} | "
          f"{row['hidden']:.0f} | {100 * row['skipped'] / max(row['hidden'], 1):.1f} | {row['wrongly_skipped']:.0f} |")

names = list(report["sorting_buffer"][0]["changes"])
print("\n| draws in the buffer | " + " | ".join(names) + " |\n|---" * 1 + "|---" * len(names) + "|")
for row in report["sorting_buffer"]:
    print(f"| {row['capacity']:.0f} | " + " | ".join(f"{row['changes'][n]:.0f}" for n in names) + " |")
print("\n| pieces of 40 draws, buffer of | " + " | ".join(names) + " | fewest |\n|---" + "|---" * (len(names) + 1) + "|")
for row in report["sorting_buffer"]:
    if "fewest" in row["piece_changes"]:
        print(f"| {row['capacity']:.0f} | " + " | ".join(f"{row['piece_changes'][n]:.0f}" for n in names) +
              f" | {row['piece_changes']['fewest']:.0f} |")
