#!/usr/bin/env python3
"""Draws the pictures of models.md: a slice of each scenario in scenarios/models and scenarios/level, and the ducts.

    docs/make_models.py [EMSCAPE] [NAME...]      writes docs/images/model_NAME.png; by default all
"""

import pathlib
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent
# Name: colours (dBW/m2; dB). The slices run from east to west and are seen from the south, or they are level and seen from above.
PICTURES = {
    "horizon": "-130:-50",
    "diffraction": "-130:-50",
    "deygout": "-130:-50",
    "itm": "-130:-50",
    "two_ray": "-105:-65",
    "two_ray_beam": "-105:-65",
    "p528": "-130:-70",
    "p1812": "-130:-50",
    "p452": "-130:-70",
    "gases": "-160:-60",
    "rain": "-140:-60",
    "clutter": "-10:50",
    "clutter_mti": "-10:50",
}
LEVEL = {"clutter", "clutter_mti"}
SHIP = ["profile", "ship_duct.yaml", "--emitter", "ship radar", "--to", "51.3,-18.85,5", "--plot"]
COAST = ["vertical", "coast_duct.yaml", "--emitter", "coastal radar", "--azimuth", "300", "--range", "200000", "--max-height", "3000", "-o"]
MAST = ["vertical", "jacksboro.yaml", "--emitter", "communications mast", "--azimuth", "190", "--range", "14000",
        "--max-height", "900", "--quantity", "power_density_dbwm2", "--threshold", "-90", "-o"]
# Name: command, scenario in scenarios, options (the last one for the picture); then more options.
DIAGRAMS = {
    "ship_duct": (SHIP, []),
    "ship_standard": (SHIP, ["--set", "atmosphere.refractivity.duct_height_m=0"]),
    "coast_duct": (COAST, []),
    "coast_cliff": (COAST, ["--set", "platforms.coast.position.height_msl_m=500"]),
    "mast_parabolic": (MAST, ["--set", "emitters.communications mast.propagation=parabolic_equation"]),
    "mast_diffraction": (MAST, ["--set", "emitters.communications mast.propagation=diffraction"]),
}


def compress(full, picture):
    """Reduces to 96 colours, which are enough and take a quarter of the space."""
    subprocess.run(
        ["ffmpeg", "-loglevel", "error", "-y", "-i", full, "-vf",
         "split[a][b];[a]palettegen=max_colors=96[p];[b][p]paletteuse=dither=none", picture],
        check=True)
    print(f"{picture.relative_to(ROOT)}: {picture.stat().st_size / 1024:.1f} KiB")


def draw_diagram(emscape, picture, words, more):
    command, scenario, *options = words
    with tempfile.TemporaryDirectory() as folder:
        full = pathlib.Path(folder) / "full.png"
        subprocess.run([emscape, command, ROOT / "scenarios" / scenario, *options, full, *more, "--quiet", "--size", "900x400"],
                       check=True, stdout=subprocess.DEVNULL)
        compress(full, picture)


def draw(emscape, name):
    picture = ROOT / "docs" / "images" / f"model_{name}.png"
    if name in DIAGRAMS:
        return draw_diagram(emscape, picture, *DIAGRAMS[name])
    colours = PICTURES[name]
    size, elevation_deg, distance = ("560x420", 90, 2.6) if name in LEVEL else ("640x280", 0, 1.75)
    with tempfile.TemporaryDirectory() as folder:
        full = pathlib.Path(folder) / "full.png"
        subprocess.run(
            [emscape, "render", ROOT / "scenarios" / ("level" if name in LEVEL else "models") / f"{name}.yaml", "-o", full, "--quiet",
             "--backend", "cpu", "--size", size, "--mode", "mip", f"--range={colours}", "--theme", "light",
             "--terrain", "off", "--transfer", ROOT / "scenarios" / "transfer" / "slice_viridis.json", "--camera",
             f"orbit:azimuth_deg=180,elevation_deg={elevation_deg},distance={distance},fov_deg=20,projection=orthographic"],
            check=True)
        compress(full, picture)


def main():
    emscape = sys.argv[1] if len(sys.argv) > 1 else str(ROOT / "build" / "release" / "bin" / "emscape")
    for name in sys.argv[2:] or [*PICTURES, *DIAGRAMS]:
        draw(emscape, name)


if __name__ == "__main__":
    main()
