"""VTK reads the .pvd series that emscape simulate wrote: times, grid and values, the same as the closed form."""

import xml.etree.ElementTree

import series

try:
    from vtkmodules.util.numpy_support import vtk_to_numpy
    from vtkmodules.vtkIOXML import vtkXMLImageDataReader
except ImportError:
    series.skip("python3-vtk9 is not installed")


def read_series(pvd):
    """(time, image) of each step that a .pvd lists."""
    for data_set in xml.etree.ElementTree.parse(pvd).getroot().iter("DataSet"):
        reader = vtkXMLImageDataReader()
        file = pvd.parent / data_set.get("file")
        series.check(reader.CanReadFile(str(file)) == 1, f"VTK does not take {file} for image data")
        reader.SetFileName(str(file))
        reader.Update()
        series.check(reader.GetErrorCode() == 0, f"VTK cannot read {file}")
        yield float(data_set.get("timestep")), reader.GetOutput()


def values_of(image, name):
    """An array of the image by [k, j, i]."""
    array = image.GetPointData().GetArray(name)
    series.check(array is not None, f"no point array {name}")
    return vtk_to_numpy(array).reshape(tuple(reversed(image.GetDimensions())))


if __name__ == "__main__":
    steps = list(read_series(series.folder() / "hollow.pvd"))
    series.check(tuple(time_s for time_s, _ in steps) == series.TIMES_S, "the times of the .pvd")
    for time_s, image in steps:
        series.check(image.GetDimensions() == series.DIMS, f"dimensions {image.GetDimensions()}")
        series.check(image.GetSpacing() == series.SPACING_M, f"spacing {image.GetSpacing()}")
        series.check(image.GetOrigin() == series.FIRST_CENTER_M, f"origin {image.GetOrigin()}")
        values = values_of(image, "power_density_dbwm2")
        dominant = values_of(image, "dominant_emitter")
        below_ground = 0
        for i, j, k in series.voxels():
            value = values[k, j, i]
            if value == series.FLOOR_DBWM2:
                below_ground += 1
                continue
            expected = series.power_density_dbwm2(image.GetPoint(image.ComputePointId((i, j, k))), time_s)
            series.check(abs(value - expected) < series.TOLERANCE_DB, f"voxel {i, j, k} holds {value}, not {expected}")
            series.check(dominant[k, j, i] == (1 if time_s >= 0.5 else 0), f"dominant emitter of {i, j, k}")
        series.check(0 < below_ground < values.size / 2, f"{below_ground} voxels below ground")
