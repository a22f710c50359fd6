"""Blender and ParaView draw what emscape simulate writes, by the scripts of docs/volume-files.md: the pictures show something.

    draw_test.py EMSCAPE FOLDER blender|paraview
"""
import pathlib
import shutil
import subprocess
import sys

import series

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
try:
    from vtkmodules.util.numpy_support import vtk_to_numpy
    from vtkmodules.vtkIOImage import vtkPNGReader
except ImportError:
    series.skip("python3-vtk9 is not installed")


def spread(picture):
    """Standard deviation of the pixels (0..255)."""
    reader = vtkPNGReader()
    reader.SetFileName(str(picture))
    reader.Update()
    return vtk_to_numpy(reader.GetOutput().GetPointData().GetScalars()).astype(float).std()


if __name__ == "__main__":
    emscape, folder, peer = sys.argv[1], pathlib.Path(sys.argv[2]), sys.argv[3]
    program = {"blender": "blender", "paraview": "pvpython"}[peer]
    if shutil.which(program) is None:
        series.skip(f"{program} is not installed")
    options = {"blender": ["--look", "fog"], "paraview": ["--format", "vti"]}[peer]
    subprocess.run([emscape, "simulate", ROOT / "scenarios" / "jacksboro.yaml", "-o", folder, "--times", "40", "--force", "--quiet",
                    *options], check=True)
    volume = folder / ("jacksboro_0001." + {"blender": "vdb", "paraview": "vti"}[peer])
    picture = folder / "picture.png"
    picture.unlink(missing_ok=True)
    command = {"blender": ["blender", "--background", "--factory-startup", "--python", ROOT / "examples" / "blender_fog.py", "--"],
               "paraview": ["xvfb-run", "-a", "pvpython", ROOT / "examples" / "paraview_volume.py"]}[peer]
    subprocess.run([*command, volume, picture], check=True, stdout=subprocess.DEVNULL, timeout=900)
    series.check(spread(picture) > 5, f"{picture} shows nothing")
