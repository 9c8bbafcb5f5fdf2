#!/usr/bin/env python3
"""Tables of docs/warp-methods.md from reports of `latewarp replay`.

warp_methods_tables.py [--ratios] REPORT.json ... DOC.md: one report per scene and trace; replaces what stands between
the markers <!-- table begin --> and <!-- table end -->, or prints the tables where there are none. The reports all have
the same methods. With --ratios, reports of several source and truth samples, and the markers <!-- ratios begin --> and
<!-- ratios end -->.
"""

import json
import pathlib
import sys

CAUSES = ("resampled", "disoccluded", "out_of_frame", "stale_shading")


def errors_of(report):
    errors = {report["method"]: report["error"]}
    errors.update({label: entry["error"] for label, entry in report["baselines"].items()})
    return errors


def costs_of(report):
    costs = {report["method"]: report["cost_ms"]["warp"]}
    costs.update({label: entry["warp"] for label, entry in report["cost_ms"].get("baselines", {}).items()})
    return costs


def mean(values):
    values = [value for value in values if value is not None]
    return sum(values) / len(values) if values else None


def text(value, digits):
    return "-" if value is None else f"{value:.{digits}f}"


def figure(reports, method, *path):
    found = []
    for report in reports:
        value = errors_of(report)[method]
        for key in path:
            value = value[key] if value is not None else None
        found.append(value)
    return mean(found)


def methods_by_error(reports):
    return sorted(errors_of(reports[0]), key=lambda method: figure(reports, method, "flip", "mean"))


def summary_table(reports):
    lines = ["| method | FLIP | of `rotation`'s | p95 of FLIP | PSNR, dB | SSIM | flicker | FLIP above `fresh-same` |"]
    lines.append("|---|---|---|---|---|---|---|---|")
    rotation = figure(reports, "rotation", "flip", "mean")
    floor = figure(reports, "fresh-same", "flip", "mean")
    for method in methods_by_error(reports):
        flip = figure(reports, method, "flip", "mean")
        lines.append(
            f"| `{method}` | {text(flip, 4)} | {text(flip / rotation, 2)} "
            f"| {text(figure(reports, method, 'flip', 'p95'), 4)} | {text(figure(reports, method, 'psnr_db', 'mean'), 2)} "
            f"| {text(figure(reports, method, 'ssim', 'mean'), 4)} | {text(figure(reports, method, 'flicker', 'mean'), 4)} "
            f"| {text(flip - floor, 4)} |"
        )
    return lines


def scene_name(report):
    return pathlib.Path(report["settings"]["scene"]).stem


def trace_name(report):
    return pathlib.Path(report["settings"]["trace"]).stem


def table_by_run(reports):
    methods = methods_by_error(reports)
    lines = ["| scene, trace | " + " | ".join(f"`{method}`" for method in methods) + " |"]
    lines.append("|---" * (len(methods) + 1) + "|")
    for report in reports:
        errors = errors_of(report)
        cells = " | ".join(text(errors[method]["flip"]["mean"], 4) for method in methods)
        lines.append(f"| {scene_name(report)}, {trace_name(report)} | {cells} |")
    return lines


def attribution_table(reports):
    lines = ["| method | FLIP | " + " | ".join(cause.replace("_", " ") for cause in CAUSES) + " |"]
    lines.append("|---" * (len(CAUSES) + 2) + "|")
    for method in methods_by_error(reports):
        parts = " | ".join(text(figure(reports, method, "attribution", cause, "mean"), 4) for cause in CAUSES)
        lines.append(f"| `{method}` | {text(figure(reports, method, 'flip', 'mean'), 4)} | {parts} |")
    shares = " | ".join(text(mean([report["cause_shares"][cause]["mean"] for report in reports]), 4) for cause in CAUSES)
    lines.append(f"| (share of the pixels) | 1 | {shares} |")
    return lines


def description(reports):
    report = reports[0]
    settings, machine = report["settings"], report["machine"]
    width, height = report["size_px"]
    return (
        f"{len(reports)} runs, {sum(entry['frames'] for entry in reports)} display frames of {width}x{height} at "
        f"{settings['display_hz']:g} Hz, client at {settings['app_hz']:g} Hz with {settings['source_samples']}x"
        f"{settings['source_samples']} source samples and the guard band that the head's speed asks for, `--predict oracle`, fill "
        f"`{settings['fill']}`, truth with {settings['truth_samples']}x{settings['truth_samples']} samples; "
        f"{machine['gl_renderer']}. Means over all runs."
    )


def ratios_table(reports):
    lines = ["| source, truth | `fresh-same` | `fresh` | `rotation` | `surface` | of `rotation`'s | of `fresh`'s "
             "| latency's, of `rotation`'s | PSNR above `rotation`, dB |"]
    lines.append("|---" * 9 + "|")
    samples = sorted({(r["settings"]["source_samples"], r["settings"]["truth_samples"]) for r in reports})
    for source, truth in samples:
        group = [
            report for report in reports
            if (report["settings"]["source_samples"], report["settings"]["truth_samples"]) == (source, truth)
        ]
        flip = {m: figure(group, m, "flip", "mean") for m in ("fresh-same", "fresh", "rotation", "surface")}
        latency = {m: flip[m] - flip["fresh-same"] for m in ("rotation", "surface")}
        psnr = figure(group, "surface", "psnr_db", "mean") - figure(group, "rotation", "psnr_db", "mean")
        lines.append(
            f"| {source}x{source}, {truth}x{truth} | " + " | ".join(text(value, 4) for value in flip.values())
            + f" | {text(flip['surface'] / flip['rotation'], 2)} | {text(flip['surface'] / flip['fresh'], 2)} "
            f"| {text(latency['surface'] / latency['rotation'], 2)} | {text(psnr, 1)} |"
        )
    return lines


def tables(reports):
    parts = [
        [description(reports)],
        summary_table(reports),
        ["Where the error comes from, as parts of the mean FLIP:"],
        attribution_table(reports),
        ["Mean FLIP of each run:"],
        table_by_run(reports),
    ]
    return "\n\n".join("\n".join(part) for part in parts) + "\n"


def main():
    wants_ratios = sys.argv[1] == "--ratios"
    paths = sys.argv[2 if wants_ratios else 1 : -1]
    reports = [json.loads(pathlib.Path(path).read_text()) for path in paths]
    result = "\n".join(ratios_table(reports)) + "\n" if wants_ratios else tables(reports)
    name = "ratios" if wants_ratios else "table"
    first, last = f"<!-- {name} begin -->", f"<!-- {name} end -->"
    document = pathlib.Path(sys.argv[-1])
    before, begin, rest = (document.read_text() if document.exists() else "").partition(first)
    _, end, after = rest.partition(last)
    if begin and end:
        document.write_text(f"{before}{first}\n{result}{last}{after}")
    else:
        print(result, end="")


if __name__ == "__main__":
    main()
