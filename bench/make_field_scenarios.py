#!/usr/bin/python3
"""Makes the scenarios of `emscape bench field` in docs/performance.md: sixteen radars, a hundred, and one over 200 km.

    bench/make_field_scenarios.py FOLDER

Writes FOLDER/radars_VARIANT.yaml (the region of scenarios/jacksboro.yaml at 200 x 200 x 100 voxels, sixteen radars spread over
it; `enu` is diffraction over columns that lean), FOLDER/hundred_VARIANT.yaml (a hundred radars over 40 km, every second one
1500 m above the ground, the others on masts) and FOLDER/wide_VARIANT.yaml (512 x 512 x 128 voxels over 200 km, one radar in
the middle) with FOLDER/wide.tif. Terrain: scenarios/data/jacksboro.tif (SRTM, public domain); wide.tif repeats it by reflection
at its edges, as no public-domain data of that width is at hand. Needs python3-numpy and python3-gdal.
"""

import argparse
import pathlib

import numpy
from osgeo import gdal

ROOT = pathlib.Path(__file__).resolve().parent.parent
JACKSBORO = ROOT / "scenarios" / "data" / "jacksboro.tif"
MIDDLE = (36.303, -84.246)  # of the regions: latitude, longitude (deg)
WIDE_DEG = 2.6              # side of wide.tif

HEAD = """schema_version: 1
name: {name}
duration_s: 10
step_s: 1
region:
  origin: {{latitude_deg: {latitude}, longitude_deg: {longitude}, height_msl_m: {height}}}
  frame: {frame}
  size_m: {size}
  dims: {dims}
terrain: {{files: [{terrain}], vertical_datum: egm96}}
output: {{quantities: [power_density_dbwm2], combine: sum, floor: -150}}
"""

EMITTER = """  - name: radar {n}
    platform: site {n}
    kind: radar
    frequency_hz: {frequency}
    power_w: 20000
    losses_db: 3
    polarization: horizontal
    antenna: {antenna}
    scan: {{kind: rotate, rate_rpm: 6, elevation_deg: 1, azimuth_deg: {azimuth}}}
    {propagation}
    receiver: {{noise_figure_db: 4, bandwidth_hz: 1.0e6, pulses: 12, pfa: 1.0e-6, swerling: 1, target_rcs_m2: 5}}
"""

ANTENNAS = [
    "{pattern: cosecant2, gain_dbi: 34, beamwidth_az_deg: 3, beamwidth_el_deg: 4, side_lobe_db: -45}",
    "{pattern: gaussian, gain_dbi: 30, beamwidth_az_deg: 6, beamwidth_el_deg: 8, side_lobe_db: -40}",
    "{pattern: sinc, gain_dbi: 32, beamwidth_az_deg: 4, beamwidth_el_deg: 4, side_lobe_db: -50}",
    "{pattern: isotropic, gain_dbi: 6}",
]


# name: propagation, frame, whether there are a wide one and one of a hundred radars
VARIANTS = {
    "horizon": ("propagation: horizon", "altitude", True),
    "diffraction": ("propagation: diffraction", "altitude", True),
    "deygout": ("propagation: diffraction\n    diffraction: {method: deygout}", "altitude", False),
    "itm": ("propagation: itm", "altitude", False),
    "enu": ("propagation: diffraction", "enu", False),
    "parabolic_equation": ("propagation: parabolic_equation", "altitude", False),
}


def scenario(name, variant, places, size, dims, height, terrain, heights_agl=(20,), step_ghz=0.3):
    propagation, frame, _ = VARIANTS[variant]
    text = HEAD.format(name=name, latitude=MIDDLE[0], longitude=MIDDLE[1], height=height, frame=frame, size=size,
                       dims=dims, terrain=terrain) + "platforms:\n"
    for n, (latitude, longitude) in enumerate(places):
        text += f"  - name: site {n}\n    position: {{latitude_deg: {latitude:.5f}, longitude_deg: {longitude:.5f}, " \
                f"height_agl_m: {heights_agl[n % len(heights_agl)]}}}\n"
    text += "emitters:\n"
    for n in range(len(places)):
        text += EMITTER.format(n=n, frequency=(0.4 + step_ghz * n) * 1e9, antenna=ANTENNAS[n % len(ANTENNAS)],
                               azimuth=22.5 * n % 360, propagation=propagation)
    return text


def spread_over(count, latitude_deg, longitude_deg):
    """Places in `count` rows and columns, up to these angles from the middle."""
    half = (count - 1) / 2
    return [(MIDDLE[0] + latitude_deg * (row - half) / half, MIDDLE[1] + longitude_deg * (column - half) / half)
            for row in range(count) for column in range(count)]


def write_wide_terrain(target):
    source = gdal.Open(str(JACKSBORO))
    west, step, _, north, _, _ = source.GetGeoTransform()
    heights = source.ReadAsArray()
    side = int(WIDE_DEG / step)
    # the square's north-western post, in posts of the source
    first_row = int((north - (MIDDLE[0] + WIDE_DEG / 2)) / step)
    first_column = int(((MIDDLE[1] - WIDE_DEG / 2) - west) / step)

    def reflected(first, count):
        index = numpy.arange(first, first + side) % (2 * count)
        return numpy.where(index < count, index, 2 * count - 1 - index)

    wide = heights[numpy.ix_(reflected(first_row, heights.shape[0]), reflected(first_column, heights.shape[1]))]
    image = gdal.GetDriverByName("GTiff").Create(str(target), side, side, 1, gdal.GDT_Int16,
                                                 ["COMPRESS=DEFLATE", "PREDICTOR=2", "ZLEVEL=9"])
    image.SetMetadata({"AREA_OR_POINT": "Point"})
    image.SetGeoTransform((west + first_column * step, step, 0, north - first_row * step, 0, -step))
    image.SetProjection(source.GetProjection())
    image.GetRasterBand(1).WriteArray(wide)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("folder", type=pathlib.Path)
    options = parser.parse_args()
    options.folder.mkdir(parents=True, exist_ok=True)
    write_wide_terrain(options.folder / "wide.tif")
    (options.folder / "jacksboro.tif").write_bytes(JACKSBORO.read_bytes())
    for variant, (_, _, has_wide) in VARIANTS.items():
        (options.folder / f"radars_{variant}.yaml").write_text(
            scenario("sixteen radars", variant, spread_over(4, 0.1, 0.12), [29000, 29000, 6000], [200, 200, 100], 200, "jacksboro.tif"))
        if has_wide:
            (options.folder / f"hundred_{variant}.yaml").write_text(
                scenario("a hundred radars", variant, spread_over(10, 0.17, 0.21), [40000, 40000, 6000], [200, 200, 100], 200,
                         "wide.tif", heights_agl=(20, 1500), step_ghz=0.05))
            (options.folder / f"wide_{variant}.yaml").write_text(
                scenario("two hundred kilometres", variant, [MIDDLE], [200000, 200000, 10000], [512, 512, 128], 200,
                         "wide.tif"))


if __name__ == "__main__":
    gdal.UseExceptions()
    main()
