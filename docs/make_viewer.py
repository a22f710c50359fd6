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
BEGIN = [{"do": "seek", "time_s": 90}, {"do": "orbit", "azimuth_deg": 20, "elevation_deg": 4},
         {"do": "panel", "name": "colors", "open": True}]
PICTURES = {
    "view_dark": (["--size", "1280x860"], BEGIN),
    "view_light": (["--size", "1280x860", "--theme", "light"], [*BEGIN, {"do": "panel", "name": "help", "open": True}]),
}


def picture(programs, display, name, options, commands):
    target = ROOT / "docs" / "images" / f"{name}.png"
    with tempfile.TemporaryDirectory() as folder:
        full = pathlib.Path(folder) / "full.png"
        script = pathlib.Path(folder) / "script.jsonl"
        settled = {"do": "wait_state", "state": "exact", "timeout_s": 120}
        steps = [settled, *commands, settled, {"do": "wait_s", "seconds": 5}, {"do": "screenshot", "file": str(full)}, {"do": "quit"}]
        script.write_text("".join(json.dumps(step) + "\n" for step in steps))
        subprocess.run([programs / "emscape", "view", ROOT / "scenarios" / "jacksboro.yaml", "--backend", "cpu", "--quiet", "--script", script, *options],
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
    read, write = os.pipe()
    server = subprocess.Popen(["Xvfb", "-displayfd", str(write), "-screen", "0", "1920x1200x24"], pass_fds=[write],
                              stderr=subprocess.DEVNULL)
    try:
        display = ":" + os.read(read, 16).decode().strip()
        for name, (options, commands) in PICTURES.items():
            picture(programs, display, name, options, commands)
    finally:
        server.terminate()
        server.wait()


if __name__ == "__main__":
    main()
