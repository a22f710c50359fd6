#!/usr/bin/env python3
"""The table of docs/performance.md from what bench/run_on_gpu measured.

    bench/gpu_table.py FOLDER
"""

import json
import pathlib
import sys

SAMPLES_PER_S = 510e9  # trilinear texture samples of an H100, measured with a kernel that does nothing else
BYTES_PER_S = 2994e9   # of its memory, read and written, measured with a copy


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
    for mode in ("dvr-exact", "mida-exact", "dvr", "mida"):
        for pattern in results.get(f"patterns-{mode}", {}).get("patterns", []):
            row(f"{mode}, {pattern['name']} ({pattern['interpolate']}): {pattern['busy_ms']['median']:.3f} ms, restored "
                f"{'equal' if pattern['restored_equals_full'] else 'NOT EQUAL'}",
                f"{pattern['ratio_to_full']:.3f} of full", f"{pattern['rays_fraction_of_hits']:.2f} of the rays",
                bounds.get(pattern["name"], "") if mode == "dvr-exact" else "")


def field_table(results):
    """One row per scenario; the CPU's times are in cpu-field-NAME."""
    names = sorted(n for n in results if n.startswith("field-"))
    if not names:
        return
    cpus = {results[f"cpu-{name}"]["threads"] for name in names if f"cpu-{name}" in results}
    threads = f" ({', '.join(str(count) for count in sorted(cpus))} threads)" if cpus else ""
    print(f"\n| field (ms) | fan | excess | combine | product | all moved | by the host's clock | beams turned | each voxel "
          f"written once | CPU{threads}: all moved | beams turned |")
    print("|---" * 11 + "|")
    for name in names:
        result, cpu = results[name], results.get(f"cpu-{name}", {}).get("update_ms")
        grid, stages, update = result["grid"], result["stages_ms"], result["update_ms"]
        times = [*stages.values(), sum(stages.values()), update["all_moved"], update["beams_turned"],
                 grid[0] * grid[1] * grid[2] * 4 / BYTES_PER_S * 1e3]
        times += [cpu["all_moved"], cpu["beams_turned"]] if cpu else [None, None]
        cells = ["" if time is None else f"{time:.2f}" if time < 10 else f"{time:.0f}" for time in times]
        print(f"| {name.removeprefix('field-')}, {result['emitters']} emitters | " + " | ".join(cells) + " |")


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
    for rows in (render_rows, pattern_rows, playback_rows):
        rows(results)
    field_table(results)


if __name__ == "__main__":
    main()
