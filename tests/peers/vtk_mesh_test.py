"""VTK reads the meshes that emscape simulate wrote: cells, orientation and values, the same as the closed form; and emscape
reads what VTK writes of them, compressed and inline."""

import json
import math
import pathlib
import subprocess
import sys
import xml.etree.ElementTree

import series

try:
    from vtkmodules.util.numpy_support import vtk_to_numpy
    from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridReader, vtkXMLUnstructuredGridWriter
except ImportError:
    series.skip("python3-vtk9 is not installed")

PYTHON = pathlib.Path(__file__).resolve().parent.parent.parent / ".cache" / "peers" / "bin" / "python"
LAYERS = 8
POINTS = series.DIMS[0] * series.DIMS[1] * (LAYERS + 1)
CELLS = 6 * (series.DIMS[0] - 1) * (series.DIMS[1] - 1) * LAYERS
TETRAHEDRON = 10


def read(file):
    reader = vtkXMLUnstructuredGridReader()
    series.check(reader.CanReadFile(str(file)) == 1, f"VTK does not take {file} for an unstructured grid")
    reader.SetFileName(str(file))
    reader.Update()
    series.check(reader.GetErrorCode() == 0, f"VTK cannot read {file}")
    return reader.GetOutput()


def volume_m3(grid):
    """Sum of the signed volumes of the cells: that of the solid only if none is inverted."""
    points = vtk_to_numpy(grid.GetPoints().GetData())
    corners = points[vtk_to_numpy(grid.GetCells().GetConnectivityArray()).reshape(-1, 4)]
    a, b, c = (corners[:, n] - corners[:, 0] for n in (1, 2, 3))
    signed = (a[:, [1, 2, 0]] * b[:, [2, 0, 1]] - a[:, [2, 0, 1]] * b[:, [1, 2, 0]]) * c
    series.check(signed.sum(axis=1).min() > 0, "a cell is inverted")
    return signed.sum() / 6


def info(emscape, file):
    result = subprocess.run([emscape, "info", file, "--json"], check=True, text=True, stdout=subprocess.PIPE).stdout
    return json.loads(result)


if __name__ == "__main__":
    emscape, folder = sys.argv[1], pathlib.Path(sys.argv[2])
    subprocess.run([emscape, "simulate", pathlib.Path(__file__).with_name("hollow.yaml"), "-o", folder, "--mesh",
                    f"terrain:{LAYERS}", "--force", "--quiet"], check=True)
    entries = list(xml.etree.ElementTree.parse(folder / "hollow.pvd").getroot().iter("DataSet"))
    series.check(tuple(float(entry.get("timestep")) for entry in entries) == series.TIMES_S, "the times of the .pvd")
    first = None
    for entry in entries:
        grid = read(folder / entry.get("file"))
        time_s = float(entry.get("timestep"))
        series.check(grid.GetNumberOfPoints() == POINTS, f"{grid.GetNumberOfPoints()} points")
        series.check(grid.GetNumberOfCells() == CELLS, f"{grid.GetNumberOfCells()} cells")
        series.check(set(vtk_to_numpy(grid.GetCellTypesArray())) == {TETRAHEDRON}, "cells that are no tetrahedra")
        positions = vtk_to_numpy(grid.GetPoints().GetData())
        first = positions if first is None else first
        series.check((positions == first).all(), "the mesh changes with time")
        # 24 x 25 columns, 23 km x 19.2 km, up to 4 km above the lowest ground.
        height_m = volume_m3(grid) / (23000 * 19200)
        series.check(3300 < height_m < 4000, f"the mesh is {height_m} m high")
        values = vtk_to_numpy(grid.GetPointData().GetArray("power_density_dbwm2"))
        for position, value in zip(positions, values):
            expected = series.power_density_dbwm2(tuple(position), time_s)
            series.check(math.isclose(value, expected, abs_tol=series.TOLERANCE_DB), f"{value} at {position}: {expected}")
        emitters = set(vtk_to_numpy(grid.GetPointData().GetArray("dominant_emitter")))
        series.check(emitters == {1 if time_s >= 0.5 else 0}, f"dominant emitters {emitters}")

    if PYTHON.exists():  # with meshio
        script = "import meshio, sys; m = meshio.read(sys.argv[1]); print(len(m.points), len(m.cells_dict['tetra']))"
        read_by_meshio = subprocess.run([PYTHON, "-c", script, folder / "hollow_0001.vtu"], check=True, text=True,
                                        stdout=subprocess.PIPE).stdout
        series.check(read_by_meshio.split() == [str(POINTS), str(CELLS)], f"meshio reads {read_by_meshio}")

    expected = info(emscape, folder / "hollow_0001.vtu")
    for name, configure in (("compressed", lambda w: w.SetCompressorTypeToZLib()),
                            ("inline", lambda w: (w.SetDataModeToBinary(), w.SetHeaderTypeToUInt32()))):
        copy = folder.parent / f"{folder.name}_{name}.vtu"
        writer = vtkXMLUnstructuredGridWriter()
        writer.SetFileName(str(copy))
        writer.SetInputData(read(folder / "hollow_0001.vtu"))
        configure(writer)
        series.check(writer.Write() == 1, f"VTK cannot write {copy}")
        found = info(emscape, copy)
        for key in ("points", "tetrahedra", "boundary_faces", "inverted_tetrahedra", "lower_m", "upper_m"):
            series.check(found[key] == expected[key], f"{name}: {key} {found[key]}, expected {expected[key]}")
        for key in ("min", "max", "mean"):
            series.check(found["fields"][0][key] == expected["fields"][0][key], f"{name}: {key}")
        copy.unlink()
