#!/usr/bin/env python3
"""Takes the pictures of viewer.md and writes its tables.

    docs/make_viewer.py [FOLDER-OF-PROGRAMS]      by default build/release/bin; needs Xvfb
"""

import json
import os
import pathlib
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT / "bench"))

import virtual_display  # noqa: E402

BEGIN = [{"do": "seek", "time_s": 90}, {"do": "orbit", "azimuth_deg": 20, "elevation_deg": 4}]
CLOSED = {"do": "panel", "name": "scenario", "open": False}
SETTLED = {"do": "wait_state", "state": "exact", "timeout_s": 120}


def opened(name):
    return {"do": "panel", "name": name, "open": True}


# Per picture: additional options, and the commands run before it is taken.
PICTURES = {
    "view_dark": ([], [*BEGIN, opened("colors")]),
    "view_light": (["--theme", "light"], [*BEGIN, opened("help")]),
    "view_what_if": ([], [*BEGIN, {"do": "set", "path": "emitters.search radar.frequency_hz", "value": "9.4e9"},
                          {"do": "set", "path": "emitters.search radar.power_w", "value": "-3"}]),
    "view_colors": ([], [*BEGIN, CLOSED, opened("colors"), {"do": "opacity_preset", "name": "shell"}]),
    "view_probe": ([], [*BEGIN, CLOSED, opened("probe"), {"do": "probe", "latitude_deg": 36.33, "longitude_deg": -84.27, "height_agl_m": 50}, SETTLED,
                      {"do": "mouse", "x": 210, "y": 314, "button": "left"}, {"do": "mouse", "x": 400, "y": 850}]),
    "view_planes": ([], [*BEGIN, CLOSED, opened("planes"), {"do": "key", "key": "H"}, {"do": "key", "key": "Shift+H"}]),
    "view_compare": ([], [*BEGIN, {"do": "set", "path": "emitters.jammer.power_w", "value": "15000"}, {"do": "key", "key": "C"}]),
}


def picture(programs, display, name, options, commands):
    target = ROOT / "docs" / "images" / f"{name}.png"
    with tempfile.TemporaryDirectory() as folder:
        full = pathlib.Path(folder) / "full.png"
        script = pathlib.Path(folder) / "script.jsonl"
        steps = [SETTLED, {"do": "mouse", "x": 400, "y": 850}, *commands, SETTLED, {"do": "wait_s", "seconds": 5}, {"do": "screenshot", "file": str(full)}, {"do": "quit"}]
        script.write_text("".join(json.dumps(step) + "\n" for step in steps))
        subprocess.run([programs / "emscape", "view", ROOT / "scenarios" / "jacksboro.yaml", "--backend", "cpu", "--quiet", "--script", script, "--size", "1280x860", *options],
                       check=True, env={**os.environ, "DISPLAY": display, "LP_NUM_THREADS": "1"})
        subprocess.run(["ffmpeg", "-loglevel", "error", "-y", "-i", full, "-vf",
                        "split[a][b];[a]palettegen=max_colors=256[p];[b][p]paletteuse=dither=bayer:bayer_scale=4", target], check=True)
    print(f"{target.relative_to(ROOT)}: {target.stat().st_size / 1024:.1f} KiB")


def write_tables(programs):
    manual = ROOT / "docs" / "viewer.md"
    tables = subprocess.run([programs / "emscape-view", "--manual-tables"], check=True, capture_output=True, text=True).stdout
    text = manual.read_text()
    begin = text.index("a test holds them together.\n") + len("a test holds them together.\n")
    end = text.index("## Limits")
    manual.write_text(text[:begin] + "\n" + tables + "\n" + text[end:])


def main():
    programs = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else ROOT / "build" / "release" / "bin").resolve()
    write_tables(programs)
    with virtual_display.virtual_display() as display:
        for name, (options, commands) in PICTURES.items():
            picture(programs, display, name, options, commands)


if __name__ == "__main__":
    main()
