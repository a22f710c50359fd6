#!/usr/bin/env python3
"""Measures pixel interpolation as the paper that it comes from did, and writes paper.md and images/paper_*.

    docs/make_paper.py [--frames 100] [--views 10] [--stagbeetle stagbeetle277x277x164.dat]

Runs `emscape bench reconstruction` and `bench render`; the Engine volume is taken from $EMSCAPE_REFERENCE_DIR/volumes (default:
../shared beside the checkout). What the paper measured stands in this file. Needs matplotlib (Debian's
python3-matplotlib) and, for the pictures, ffmpeg. --keep FOLDER keeps the measurements, and takes those that are there already.
"""

import argparse
import json
import os
import pathlib
import platform
import subprocess
import tempfile

FOLDER = pathlib.Path(__file__).resolve().parent
ROOT = FOLDER.parent
TRANSFER = "scenarios/transfer/paper.json"
MODES = ("dvr", "mida")
LARGE = "1200x900"
REAL_TIME_MS = 40  # the paper's bound
PATTERNS = ("--rays", "columns,quarter,adaptive")
RATIOS = {"1:1": "columns", "1:3": "quarter"}  # interpolated to cast pixels, in the paper's notation and in ours

# The paper's measurements: mean times of 100 frames of EME (ms).
PAPER_MS = {"dvr": {"full": 51.84, "columns": 29.68, "quarter": 18.96}, "mida": {"full": 59.06, "columns": 33.79, "quarter": 21.08}}
# Its tables 1 (1200 x 900 pixels) and 2 (as many pixels as the two largest dimensions have voxels): max, mean, ratio in %.
PAPER_ERRORS = {
    "EME": {
        "large": {"1:1": ("5-3-0-6", ".50-.61-0-.62", 4.8), "1:3": ("5-3-0-5", ".52-.62-0-.63", 7.7)},
        "equal": {"1:1": ("5-4-0-5", ".59-.71-0-.70", 10.4), "1:3": ("5-6-0-5", ".60-.73-0-.70", 17.1)},
    },
    "Sphere": {
        "large": {"1:1": ("3-3-0-3", ".67-.80-0-.67", 4.8), "1:3": ("3-3-0-3", ".72-.85-0-.75", 12.2)},
        "equal": {"1:1": ("5-4-0-4", ".65-1.07-0-.51", 15.0), "1:3": ("5-4-0-4", ".75-1.16-0-.55", 25.1)},
    },
    "Engine": {
        "large": {"1:1": ("16-23-0-23", ".58-.90-0-.35", 13.0), "1:3": ("20-24-0-24", ".71-1.04-0-.43", 23.4)},
        "equal": {"1:1": ("66-68-0-70", "2.61-3.29-0-1.93", 31.6), "1:3": ("106-68-0-102", "2.86-3.32-0-2.18", 48.5)},
    },
    "stagbeetle": {
        "large": {"1:1": ("12-30-0-11", "1.02-1.30-0-.96", 27.8), "1:3": ("28-41-0-26", "1.53-1.87-0-1.44", 45.7)},
        "equal": {"1:1": ("51-53-0-56", "6.05-5.72-0-6.03", 34.1), "1:3": ("61-53-0-65", "6.77-6.26-0-6.78", 53.6)},
    },
}


class Volume:
    def __init__(self, name, file, shown, equal, computed):
        self.name = name
        self.file = file  # None: not available
        self.shown = shown  # as commands in the document call it
        self.sizes = {"large": LARGE, "equal": equal}
        self.computed = computed  # else scanned


def volumes(options):
    reference = pathlib.Path(os.environ.get("EMSCAPE_REFERENCE_DIR", ROOT.parent / "shared"))
    engine = reference / "volumes/engine_256x256x110_uint8.raw"
    return [
        Volume("EME", ROOT / "scenarios/eme_200.yaml", "scenarios/eme_200.yaml", "200x200", True),
        Volume("Sphere", ROOT / "scenarios/sphere_64.yaml", "scenarios/sphere_64.yaml", "64x64", True),
        Volume("Engine", engine if engine.exists() else None, "engine_256x256x110_uint8.raw", "256x256", False),
        Volume("stagbeetle", options.stagbeetle, "stagbeetle277x277x164.dat", "277x277", False),
    ]


class Emscape:
    """The program, and its measurements."""

    def __init__(self, options):
        self.program = options.emscape
        self.keep = options.keep

    def command(self, volume, size, mode, frames, *more):
        words = ["emscape bench reconstruction", volume.shown, "--transfer", TRANSFER, "--size", volume.sizes[size], "--mode", mode,
                 "--frames", frames, *more, "--json"]
        return " ".join(map(str, words))

    def reconstruction(self, volume, size, mode, frames, *more):
        kept = self.keep / ("_".join(map(str, (volume.name, size, mode, frames, *more))) + ".json")
        if not kept.exists():
            kept.write_text(self.run("reconstruction", volume, size, "--mode", mode, "--frames", frames, *more, "--json"))
        result = json.loads(kept.read_text())
        result["by"] = {(p["name"], p["interpolate"]): p for p in result["patterns"]}
        return result

    def picture(self, volume, size, rays, file):
        self.run("render", volume, size, "--rays", rays, "--frames", 1, "--picture", file)

    def run(self, what, volume, size, *more):
        command = [self.program, "bench", what, volume.file, "--size", volume.sizes[size], "--transfer", ROOT / TRANSFER,
                   "--quiet", *more]
        return subprocess.run([str(part) for part in command], check=True, text=True, stdout=subprocess.PIPE).stdout


# --- figures as text ---


def short(value):
    """As the paper writes: .50, 1.07, 0."""
    return "0" if value == 0 else f"{value:.2f}".lstrip("0")


def error_cells(error):
    max_text = "-".join(map(str, error["max"]))
    return f"{max_text} | {'-'.join(map(short, error['mean']))} | {error['ratio_percent']:.1f}"


def percent(part):
    return f"{100 * part:.1f} %"


def psnr(error):
    return "equal" if error["psnr_db"] is None else f"{error['psnr_db']:.1f}"


def table(head, rows):
    lines = ["| " + " | ".join(head) + " |", "|" + "---|" * len(head)]
    return "\n".join(lines + ["| " + " | ".join(row) + " |" for row in rows])


def error_table(measured, all_volumes, size, mode):
    head = ["volume", "rays", "paper: max", "mean", "%", "8 bit: max", "mean", "%", "float: max", "mean", "%", "PSNR dB"]
    rows = []
    for volume in all_volumes:
        result = measured.get((volume.name, size, mode))
        for ratio, pattern in RATIOS.items():
            max_text, mean_text, share = PAPER_ERRORS[volume.name][size][ratio]
            row = [volume.name if ratio == "1:1" else "", f"`{pattern}` ({ratio})", max_text, mean_text, f"{share}"]
            if result is None:
                row += ["not available", "", "", "", "", "", ""]
            else:
                row += [error_cells(result["by"][pattern, way]["error"]) for way in ("8bit", "float")]
                row += [psnr(result["by"][pattern, "float"]["error"])]
            rows.append(row)
        if result:
            adaptive = result["by"]["adaptive", "float"]
            share = percent(adaptive["rays_fraction_of_hits"])
            rows.append(["", f"`adaptive`, {share} of the rays", "", "", "", "", "", "", error_cells(adaptive["error"]),
                         psnr(adaptive["error"])])
    return table(head, rows)


def time_table(measured):
    head = ["mode", "rays", "paper: mean ms", "of full", "ours: mean ms", "median ms", "of full", "restore ms"]
    rows = []
    for mode in MODES:
        result = measured["EME", "timed", mode]
        for pattern in ("full", "columns", "quarter", "adaptive"):
            ours = result["by"][pattern, "float"]
            paper = PAPER_MS[mode].get(pattern)
            rows.append([mode.upper() if pattern == "full" else "", f"`{pattern}`",
                         f"{paper}" if paper else "", percent(paper / PAPER_MS[mode]["full"]) if paper else "",
                         f"{ours['busy_ms']['mean']:.1f}", f"{ours['busy_ms']['median']:.1f}", percent(ours["ratio_to_full"]),
                         f"{ours['restore_ms']['median']:.1f}" if pattern != "full" else ""])
    return table(head, rows)


# --- figure 5: time of each frame ---

COLORS = {"full": "#d55e00", "columns": "#0072b2", "quarter": "#009e73", "adaptive": "#cc79a7"}


def draw_figure_5(measured, file):
    """An SVG; equal times give equal bytes."""
    import matplotlib
    matplotlib.use("svg")
    import matplotlib.pyplot as plt

    with plt.rc_context({"svg.fonttype": "none", "svg.hashsalt": "emscape", "font.family": "sans-serif"}):
        figure, panels = plt.subplots(1, len(MODES), figsize=(10, 3.6), sharey=True, layout="tight")
        for panel, mode in zip(panels, MODES):
            for pattern, color in COLORS.items():
                panel.plot(measured["EME", "timed", mode]["by"][pattern, "float"]["busy_ms"]["frames"], color=color, label=pattern)
            panel.set(title=mode.upper(), xlabel="frame")
            panel.set_ylim(bottom=0)
            panel.grid(axis="y", color="#dddddd")
        panels[0].set_ylabel("ms")
        figure.legend(*panels[0].get_legend_handles_labels(), loc="lower left", ncols=len(COLORS), frameon=False)
        figure.get_layout_engine().set(rect=(0, 0.08, 1, 1))  # the legend is below
        figure.savefig(file, metadata={"Date": None})
        plt.close(figure)


# --- pictures ---

PANEL = 256  # pixels a side
GAIN = {"large": 50, "equal": 10}  # of the errors
CROP = {"large": f"crop={PANEL}:{PANEL},", "equal": "crop=iw/2:ih/2,"}  # of the middle


def pictures(emscape, volume, size, patterns, folder):
    """Cast and interpolated pictures side by side, with the errors: images/paper_NAME_SIZE.png."""
    files = {}
    for rays in ("full", *patterns):
        files[rays] = folder / f"{volume.name}_{size}_{rays}.png"
        emscape.picture(volume, size, rays, files[rays])
    inputs = [part for file in files.values() for part in ("-i", str(file))]
    gain = f"val*{GAIN[size]}"
    panel = f"{CROP[size]}scale={PANEL}:{PANEL}:flags=neighbor,format=rgb24"
    graph = [f"[0]format=rgb24,split={len(patterns) + 1}" + "".join(f"[full{i}]" for i in range(len(patterns) + 1)),
             f"[full{len(patterns)}]{panel}[panel0]"]
    for i in range(len(patterns)):
        graph += [f"[{i + 1}]format=rgb24,split=2[a{i}][b{i}]", f"[a{i}]{panel}[panel{i + 1}]",
                  f"[full{i}][b{i}]blend=all_mode=difference,lutrgb=r={gain}:g={gain}:b={gain},"
                  f"{panel}[error{i}]"]
    row = "".join(f"[panel{i}]" for i in range(len(files))) + "".join(f"[error{i}]" for i in range(len(patterns)))
    graph.append(f"{row}hstack={len(files) + len(patterns)}")
    target = FOLDER / "images" / f"paper_{volume.name.lower()}_{size}.png"
    subprocess.run(["ffmpeg", "-loglevel", "error", "-y", *inputs, "-filter_complex", ";".join(graph), "-frames:v", "1",
                    "-compression_level", "100", str(target)], check=True)
    return target.name


def picture_section(emscape, present):
    patterns = ("columns", "quarter", "adaptive")
    shown = ", ".join(["full", *(f"`{p}`" for p in patterns), *(f"error of `{p}`" for p in patterns)])
    text = [f"DVR, interpolated in float. From left to right: {shown}.\n"]
    with tempfile.TemporaryDirectory() as folder:
        for volume in present:
            for size, place in (("equal", "the middle half"), ("large", f"{PANEL} x {PANEL} pixels in the middle")):
                file = pictures(emscape, volume, size, patterns, pathlib.Path(folder))
                name = f"{volume.name}, {place} of {volume.sizes[size]}; errors {GAIN[size]} times"
                text.append(f"![{name}](images/{file})\n*{name}*\n")
    return "\n".join(text)


# --- claims ---


class Claims:
    """Each claim of the paper with our figure."""

    def __init__(self, measured, present):
        self.measured = measured
        self.present = present
        self.rows = []

    def add(self, claim, paper, ours, holds):
        self.rows.append([claim, paper, ours, "yes" if holds else "**no**"])

    def error(self, volume, size, pattern, way="8bit", mode="dvr"):
        return self.measured[volume.name, size, mode]["by"][pattern, way]["error"]

    def eme(self, mode, pattern):
        return self.measured["EME", "timed", mode]["by"][pattern, "float"]

    def times(self):
        ours = {mode: {p: self.eme(mode, p)["ratio_to_full"] for p in ("columns", "quarter")} for mode in MODES}
        for ratio, pattern in RATIOS.items():
            paper = [PAPER_MS[mode][pattern] / PAPER_MS[mode]["full"] for mode in MODES]
            mine = [ours[mode][pattern] for mode in MODES]
            self.add(f"{ratio} takes this part of the time of a full frame (DVR, MIDA)", ", ".join(map(percent, paper)),
                     ", ".join(map(percent, mine)), all(m <= p + 0.02 for m, p in zip(mine, paper)))
        spread = max(abs(ours["dvr"][p] - ours["mida"][p]) for p in ("columns", "quarter"))
        self.add("the speed-up holds for DVR and MIDA alike", "within 0.9 points", f"within {100 * spread:.1f} points",
                 spread <= 0.05)
        full, quarter = (max(self.eme(mode, p)["busy_ms"]["mean"] for mode in MODES) for p in ("full", "quarter"))
        self.add(f"frames that miss {REAL_TIME_MS} ms come below it by interpolation", "59.06 to 21.08 ms (MIDA)",
                 f"{full:.1f} to {quarter:.1f} ms (the slower mode)", quarter <= REAL_TIME_MS)
        for ratio, pattern, bound in (("1:1", "columns", 1), ("1:3", "quarter", 4 / 3)):
            factor = 1 if ratio == "1:1" else 1.5
            of_epsilon = max(self.eme(m, pattern)["restore_ms"]["median"] / (factor * self.eme(m, pattern)["busy_ms"]["median"])
                             for m in MODES)
            self.add(f"restoring takes about this many epsilon ({ratio})", f"{bound:.2f}", f"{of_epsilon:.2f}",
                     of_epsilon <= 1.25 * bound)

    def errors(self):
        # Share of erroneous pixels, and largest error: both must follow the claim.
        def less(pairs):
            pairs = list(pairs)
            kept = sum(a["ratio_percent"] <= b["ratio_percent"] and max(a["max"]) <= max(b["max"]) + 1 for a, b in pairs)
            return f"{kept} of {len(pairs)} pairs", kept == len(pairs)

        text, holds = less((self.error(v, s, "columns", mode=m), self.error(v, s, "quarter", mode=m))
                           for v in self.present for s in v.sizes for m in MODES)
        self.add("fewer interpolated pixels lower the error", "8 of 8 pairs", text, holds)
        text, holds = less((self.error(v, "large", p, mode=m), self.error(v, "equal", p, mode=m))
                           for v in self.present for p in RATIOS.values() for m in MODES)
        self.add("a higher resolution lowers the error", "8 of 8 pairs", text, holds)

        scans = [v for v in self.present if not v.computed]
        computed = [v for v in self.present if v.computed]
        for size, name in (("large", LARGE), ("equal", "equal resolution")):
            if not scans:
                continue
            mine = max(self.error(v, size, "quarter", "float")["ratio_percent"] for v in computed)
            scan = min(self.error(v, size, "quarter", "float")["ratio_percent"] for v in scans)
            worst = max(max(self.error(v, size, "quarter")["max"]) for v in computed)
            worst_scan = min(max(self.error(v, size, "quarter")["max"]) for v in scans)
            self.add(f"computed volumes have lower errors than scans ({name}, 1:3)",
                     "max 6, 25.1 % against 102, 48.5 %" if size == "equal" else "max 5, 12.2 % against 24, 23.4 %",
                     f"max {worst}, {mine:.1f} % (float) against {worst_scan}, {scan:.1f} %", worst < worst_scan and mine < scan)
        if scans:
            eme, scan = (self.error(v, "equal", "quarter", "float") for v in (self.present[0], scans[0]))
            self.add("at equal resolution scans blur visibly and EME does not (PSNR)", "by eye",
                     f"EME {psnr(eme)} dB, {scans[0].name} {psnr(scan)} dB; pictures above",
                     eme["psnr_db"] >= scan["psnr_db"] + 6)
        for way in ("8bit", "float"):
            large = self.error(self.present[0], "large", "quarter", way)
            self.add(f"EME, 1200 x 900, 1:3: max, mean and share of errors are small ({way})", "5-3-0-5, .52-.62-0-.63, 7.7 %",
                     error_cells(large).replace(" | ", ", ") + " %", max(large["max"]) <= 5 and large["ratio_percent"] <= 7.7)

    def restore(self):
        results = self.measured.values()
        views = sum(result["frames"] * (len(result["patterns"]) - 1) for result in results)
        equal = all(p["restored_equals_full"] for result in results for p in result["patterns"])
        self.add("restoring brings the exact picture back", "stated", f"bit by bit in {views} of {views} pictures", equal)

    def text(self):
        self.times()
        self.errors()
        self.restore()
        return table(["claim", "paper", "ours", "confirmed"], self.rows)


def beyond(measured, present):
    """Results beyond the paper: float interpolation and adaptive rays."""
    rows = []

    def add(name, p):
        way = f"`{p['name']}`, {p['interpolate']}"
        rows.append([name, way, percent(p["rays_fraction_of_hits"]), "-".join(map(str, p["error"]["max"])),
                     f"{p['error']['ratio_percent']:.1f}", psnr(p["error"]), f"{p['busy_ms']['median']:.1f}",
                     percent(p["ratio_to_full"])])

    for volume in present:
        for size in volume.sizes:
            result = measured[volume.name, size, "dvr"]
            for key in (("quarter", "8bit"), ("quarter", "float"), ("adaptive", "float")):
                add(f"{volume.name}, {volume.sizes[size]}", result["by"][key])
    return table(["picture", "rays", "of the rays that meet the box", "max", "erroneous %", "PSNR dB", "busy ms", "of full"], rows)


# --- the document ---


def machine(result):
    model = platform.machine()
    info = pathlib.Path("/proc/cpuinfo")
    if info.exists():
        model = next((line.split(":")[1].strip() for line in info.read_text().splitlines() if line.startswith("model name")), model)
    return f"{model}, {result['threads']} threads, device `{result['device']}`"


def document(options, emscape, all_volumes, measured):
    present = [volume for volume in all_volumes if volume.file]
    timed = measured["EME", "timed", "dvr"]
    many_views = timed["by"]["quarter", "float"]["error"]
    absent = [volume.name for volume in all_volumes if not volume.file]
    parts = {
        "machine": machine(timed), "frames": options.frames, "views": options.views,
        "times": time_table(measured),
        "command": emscape.command(all_volumes[0], "large", "dvr", options.frames, *PATTERNS),
        "table_1": error_table(measured, all_volumes, "large", "dvr"), "table_2": error_table(measured, all_volumes, "equal", "dvr"),
        "table_1_mida": error_table(measured, all_volumes, "large", "mida"),
        "table_2_mida": error_table(measured, all_volumes, "equal", "mida"),
        "error_command": emscape.command(all_volumes[2], "equal", "dvr", options.views, *PATTERNS),
        "pictures": picture_section(emscape, present),
        "claims": Claims(measured, present).text(), "beyond": beyond(measured, present),
        "absent": f"Not available here: {', '.join(absent)}; its rows hold the paper's figures alone.\n" if absent else "",
        "opacity": opacity_text(), "tolerance": timed["tolerance_levels"],
        "many_max": "-".join(map(str, many_views["max"])), "many_worst": "-".join(map(str, many_views["max_worst"])),
    }
    return (FOLDER / "paper.md.in").read_text().format(**parts)


def opacity_text():
    function = json.loads((ROOT / TRANSFER).read_text())
    return ", ".join(f"{point['opacity']:g} at {point['at']:g}" for point in function["opacity"])


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--emscape", default=ROOT / "build/release/bin/emscape", type=pathlib.Path)
    parser.add_argument("--frames", type=int, default=100, help="of the timings")
    parser.add_argument("--views", type=int, default=10, help="over which errors are means")
    parser.add_argument("--stagbeetle", type=pathlib.Path, help="stagbeetle277x277x164.dat")
    parser.add_argument("--keep", type=pathlib.Path, help="folder of the measurements")
    options = parser.parse_args()

    with tempfile.TemporaryDirectory() as folder:
        options.keep = options.keep or pathlib.Path(folder)
        options.keep.mkdir(parents=True, exist_ok=True)
        emscape = Emscape(options)
        all_volumes = volumes(options)
        measured = {("EME", "timed", mode): emscape.reconstruction(all_volumes[0], "large", mode, options.frames, *PATTERNS)
                    for mode in MODES}
        for volume in all_volumes:
            for size in volume.sizes if volume.file else ():
                for mode in MODES:
                    measured[volume.name, size, mode] = emscape.reconstruction(volume, size, mode, options.views, *PATTERNS)
        draw_figure_5(measured, FOLDER / "images/paper_figure_5.svg")
        (FOLDER / "paper.md").write_text(document(options, emscape, all_volumes, measured))


if __name__ == "__main__":
    main()
