#!/usr/bin/env python3
"""Tables of the README from the reports of `latewarp replay` and `latewarp measure`.

readme_tables.py REPLAY.json MEASURE.json README.md: replaces what stands between the markers
<!-- numbers begin --> and <!-- numbers end -->; prints the tables where there are none.
"""

import json
import pathlib
import sys

BEGIN = "<!-- numbers begin -->"
END = "<!-- numbers end -->"


def live_table(report):
    display = report["display"]
    missed_percent = 100.0 * display["missed"] / max(1, display["refreshes"])
    latency = report["latency_ms"]
    rows = [
        ("display", f"{display['hz']:g} Hz, {missed_percent:.2f} % of {display['refreshes']} refreshes missed"),
        ("client", f"{report['app']['hz']:.1f} Hz for {report['scene']['triangles']:,} triangles"),
        ("motion-to-photon", f"{latency['motion_to_photon']['p50']:.1f} ms, p99 {latency['motion_to_photon']['p99']:.1f} ms"),
        ("frame age", f"{latency['frame_age']['p50']:.0f} ms, p99 {latency['frame_age']['p99']:.0f} ms"),
        ("warp", f"{report['warp_ms']['p50']:.1f} ms, p99 {report['warp_ms']['p99']:.1f} ms"),
    ]
    machine = report["machine"]
    width, height = report["size_px"]
    title = f"Live, {width}x{height}, `{report['method']}`, {machine['cpu']}, {machine['cores']} cores, {machine['gl_renderer']}:"
    return [title, "", "| what | measured |", "|---|---|"] + [f"| {name} | {value} |" for name, value in rows]


def replay_table(report):
    errors = {label: entry["error"] for label, entry in report["baselines"].items()}
    errors[report["method"]] = report["error"]
    width, height = report["size_px"]
    settings = report["settings"]
    title = (
        f"Replay of `{settings['trace']}` through `{settings['scene']}`, {report['frames']} display frames of {width}x{height}, "
        f"client at {settings['app_hz']:g} Hz, mean against the antialiased truth (FLIP's p95, PSNR's p5):"
    )
    lines = [title, "", "| method | FLIP | PSNR, dB | SSIM | holes before fill |", "|---|---|---|---|---|"]
    for label, error in errors.items():
        flip, psnr = error["flip"], error["psnr_db"]
        psnr_text = "equal" if psnr is None else f"{psnr['mean']:.1f} ({psnr['p5']:.1f})"
        lines.append(
            f"| `{label}` | {flip['mean']:.3f} ({flip['p95']:.3f}) | {psnr_text} "
            f"| {error['ssim']['mean']:.3f} | {100 * error['hole_fraction']['mean']:.1f} % |"
        )
    return lines


def main():
    replay, measure = (json.loads(pathlib.Path(path).read_text()) for path in sys.argv[1:3])
    text = "\n".join(live_table(measure) + [""] + replay_table(replay)) + "\n"
    readme = pathlib.Path(sys.argv[3])
    before, begin, rest = (readme.read_text() if readme.exists() else "").partition(BEGIN)
    _, end, after = rest.partition(END)
    if begin and end:
        readme.write_text(f"{before}{BEGIN}\n{text}{END}{after}")
    else:
        print(text, end="")


if __name__ == "__main__":
    main()
