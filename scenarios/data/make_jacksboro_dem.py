#!/usr/bin/python3
"""Makes jacksboro.tif, the terrain of the example scenario.

    scenarios/data/make_jacksboro_dem.py [jacksboro_fault_dem.npz] [jacksboro.tif]

The heights are an SRTM cut (NASA/USGS, public domain) of the Jacksboro fault, Tennessee, that Debian's package
python-matplotlib-data carries. Needs python3-numpy and python3-gdal; the GeoTIFF itself is committed, so that nothing else
needs this script.

Georeference. The file holds 344 x 403 posts of 3 arc seconds, north row first, and the edges xmin, xmax, ymin, ymax of their
cells. Its latitudes are wrong: rows * dy was added to the north edge (its "ymax", 36.44625 N) instead of subtracted, which
would lay the heights 32 km too far north (its "ymin" is 36.73292 N). The true south edge is 36.15958 N. Two things show it:
the highest post then lies at 36.1983 N 84.2308 W, the summit of Cross Mountain (36.1983 N 84.2306 W, 1077 m), and the
towns of the valley (Jacksboro, LaFollette, Caryville, Rocky Top) get their published elevations within 20 m, as they do
in no other orientation. This script checks the summit.
"""

import pathlib
import sys

import numpy
from osgeo import gdal, osr

SOURCE = "/usr/share/matplotlib/mpl-data/sample_data/jacksboro_fault_dem.npz"
SUMMIT = (36.1983, -84.2306)  # Cross Mountain


def main():
    source = sys.argv[1] if len(sys.argv) > 1 else SOURCE
    target = sys.argv[2] if len(sys.argv) > 2 else str(pathlib.Path(__file__).parent / "jacksboro.tif")

    with numpy.load(source) as data:
        heights = data["elevation"]
        spacing = 3.0 / 3600.0
        assert abs(data["dx"] - spacing) < 1e-12 and abs(data["dy"] - spacing) < 1e-12
        west, north = float(data["xmin"]), float(data["ymax"])
    rows, columns = heights.shape

    row, column = numpy.unravel_index(heights.argmax(), heights.shape)
    highest = (north - (row + 0.5) * spacing, west + (column + 0.5) * spacing)
    assert max(abs(a - b) for a, b in zip(highest, SUMMIT)) < spacing, f"the highest post is at {highest}"

    image = gdal.GetDriverByName("GTiff").Create(
        target, columns, rows, 1, gdal.GDT_Int16, ["COMPRESS=DEFLATE", "PREDICTOR=2", "ZLEVEL=9"])
    image.SetMetadata({
        "AREA_OR_POINT": "Point",
        "TIFFTAG_IMAGEDESCRIPTION": "Jacksboro fault and Cross Mountain, Tennessee: SRTM, 3 arc seconds, "
                                    "heights in metres above EGM96 mean sea level",
        "TIFFTAG_COPYRIGHT": "NASA/USGS, public domain",
        "TIFFTAG_SOFTWARE": "scenarios/data/make_jacksboro_dem.py from jacksboro_fault_dem.npz "
                            "(Debian python-matplotlib-data), latitudes corrected",
    })
    image.SetGeoTransform((west, spacing, 0, north, 0, -spacing))
    reference = osr.SpatialReference()
    reference.SetFromUserInput("EPSG:4326+5773")  # WGS 84, heights above EGM96
    image.SetProjection(reference.ExportToWkt())
    band = image.GetRasterBand(1)
    band.SetUnitType("m")
    band.SetNoDataValue(-32768)
    band.WriteArray(heights)


if __name__ == "__main__":
    gdal.UseExceptions()
    main()
