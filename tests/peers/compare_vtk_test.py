"""VTK's ray caster on the CPU draws what emscape draws: bench/compare_vtk on a small picture."""

import json
import pathlib
import shutil
import subprocess
import sys

import series

try:
    import numpy  # noqa: F401
    import vtkmodules.vtkRenderingVolume  # noqa: F401
except ImportError:
    series.skip("python3-vtk9 or python3-numpy is not installed")

ROOT = pathlib.Path(__file__).resolve().parents[2]
# The two differ by rounding (VTK's colours have 15 bits), and at the faces of the volume's box: VTK's goes through the centres of
# the outer voxels.
LEAST_PSNR_DB = 45

if __name__ == "__main__":
    if not shutil.which("Xvfb"):
        series.skip("xvfb is not installed")
    emscape = sys.argv[1]
    result = subprocess.run([sys.executable, ROOT / "bench/compare_vtk", ROOT / "scenarios/quick.yaml", "--emscape", emscape,
                             "--size", "200x150", "--rounds", "1", "--frames", "1", "--json"],
                            check=True, text=True, stdout=subprocess.PIPE).stdout
    psnr_db = json.loads(result)["emscape_against_vtk"]["psnr_db"]
    series.check(psnr_db is None or psnr_db >= LEAST_PSNR_DB, f"the pictures differ: PSNR {psnr_db} dB")
