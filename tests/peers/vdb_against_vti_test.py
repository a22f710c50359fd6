"""The .vdb and .vti files of one series hold the same values, bit by bit."""

import series

try:
    import numpy
    import pyopenvdb
    import vtk_test
except ImportError:
    series.skip("python3-numpy or python3-openvdb is not installed")

for step, (time_s, image) in enumerate(vtk_test.read_series(series.folder() / "hollow.pvd"), start=1):
    grid = pyopenvdb.read(str(series.folder() / f"hollow_{step:04}.vdb"), "power_density_dbwm2")
    from_vdb = numpy.empty(series.DIMS, dtype=numpy.float32)
    grid.copyToArray(from_vdb)
    from_vti = vtk_test.values_of(image, "power_density_dbwm2").transpose()
    series.check(numpy.array_equal(from_vdb, from_vti), f"the values differ at {time_s} s")
