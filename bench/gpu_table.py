#!/usr/bin/env python3
"""The table of docs/performance.md from what bench/run_on_gpu measured.

    bench/gpu_table.py FOLDER
"""

import json
import pathlib
import sys

SAMPLES_PER_S = 510e9  # trilinear texture samples of an H100, measured: one kernel that does nothing else
BYTES_PER_S = 2994e9   # of its memory, read and written, measured: a copy


def row(what, measured, floor, bound=""):
    print(f"| {what} | {measured} | {floor} | {bound} |")


def ms(value):
    return f"{value:.2f} ms" if value < 10 else f"{value:.0f} ms"


def render_rows(results):
    for name in sorted(n for n in results if n.startswith(("render-", "skipping-"))):
        result = results[name]
        bound = {"render-dvr": "at least 250 G/s", "render-mida": "at least 0.8 of DVR's"}.get(name, "")
        row(f"{name}: {result['ms']['median']:.3f} ms, {result['volume']['device_bytes'] / 2**20:.1f} MiB",
            f"{result['gsamples_per_s']:.0f} G samples/s", ms(result["samples"] / SAMPLES_PER_S * 1e3), bound)


def pattern_rows(results):
    bounds = {"quarter": "at most 0.30", "columns": "at most 0.55", "adaptive": "at most 0.35"}
    for mode in ("dvr", "mida"):
        for pattern in results.get(f"patterns-{mode}", {}).get("patterns", []):
            row(f"{mode}, {pattern['name']} ({pattern['interpolate']}): {pattern['busy_ms']['median']:.3f} ms, restored "
                f"{'equal' if pattern['restored_equals_full'] else 'NOT EQUAL'}",
                f"{pattern['ratio_to_full']:.2f} of full", f"{pattern['rays_fraction_of_hits']:.2f} of the rays",
                bounds.get(pattern["name"], ""))


def field_rows(results):
    for name in sorted(n for n in results if n.startswith("field-")):
        result = results[name]
        voxels = result["grid"][0] * result["grid"][1] * result["grid"][2]
        floor = ms(voxels * 4 / BYTES_PER_S * 1e3) + " (each voxel written once)"
        stages = ", ".join(f"{stage} {time:.2f}" for stage, time in result["stages_ms"].items())
        for kind, time in result["update_ms"].items():
            row(f"{name}, {result['emitters']} emitters, {kind}", ms(time), floor)
        row(f"{name}: stages of all moved (ms): {stages}", ms(sum(result["stages_ms"].values())), floor)


def playback_rows(results):
    for name in sorted(n for n in results if n.startswith(("playback-", "settled-"))):
        result = results[name]
        row(f"{name}: {result['busy_frames']} frames, {result['late']} late, patterns {result['patterns']}",
            f"{result['frames_per_s']['held']:.1f} Hz of {result['frames_per_s']['asked']:.0f}",
            f"settled equal to full: {result['settled_equal_full']}", "at least 120 Hz" if name == "playback-120" else "")


def main():
    folder = pathlib.Path(sys.argv[1])
    results = {}
    for file in folder.glob("*.json"):
        text = file.read_text()
        if text.strip():
            results[file.stem] = json.loads(text)
    print("device:", ", ".join(sorted({result["device"] for result in results.values()})))
    print("| what | measured | floor | asked for |\n|---|---|---|---|")
    for rows in (render_rows, pattern_rows, field_rows, playback_rows):
        rows(results)


if __name__ == "__main__":
    main()
