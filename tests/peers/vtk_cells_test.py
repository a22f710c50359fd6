"""VTK draws what emscape draws of a field on tetrahedra: bench/compare_vtk_cells on a small mesh and picture."""

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

if __name__ == "__main__":
    if not shutil.which("Xvfb"):
        series.skip("xvfb is not installed")
    result = json.loads(subprocess.run(
        [sys.executable, ROOT / "bench/compare_vtk_cells", ROOT / "scenarios/quick.yaml", "--emscape", sys.argv[1], "--mesh",
         "terrain:6,50", "--dims", "16,16,10", "--size", "200x150", "--frames", "1", "--json"],
        check=True, text=True, stdout=subprocess.PIPE).stdout)
    for name, least_db in (("VTK ray caster", 44), ("VTK projected tetrahedra", 36)):
        psnr_db = result["against_emscape_marched"][name]["psnr_db"]
        series.check(psnr_db is None or psnr_db >= least_db, f"{name}: the pictures differ: PSNR {psnr_db} dB")
