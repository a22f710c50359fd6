"""python3-openvdb reads what emscape simulate wrote: values, transform, metadata, and nothing active below ground."""

import math

import series

try:
    import pyopenvdb
except ImportError:
    series.skip("python3-openvdb is not installed")


def check_metadata(grid, time_s):
    wanted = {
        "emscape:quantity": "power_density_dbwm2",
        "emscape:unit": "dBW/m2",
        "emscape:time_s": time_s,
        "emscape:time_utc": f"2026-06-01T06:00:0{time_s:.0f}.000Z",
        "emscape:frame": "enu",
        "emscape:origin_latitude_deg": 36.303,
        "emscape:origin_longitude_deg": -84.246,
        "emscape:origin_height_msl_m": 200.0,
        "emscape:floor": series.FLOOR_DBWM2,
        "emscape:dims": series.DIMS,
        "class": "fog volume",
    }
    for key, value in wanted.items():
        series.check(grid.metadata.get(key) == value, f"{key} is {grid.metadata.get(key)}, not {value}")


def check_transform(grid):
    for index in ((0, 0, 0), (1, 2, 3), (23, 24, 19)):
        world = grid.transform.indexToWorld(index)
        series.check(math.dist(world, series.center_m(*index)) < 1e-6, f"voxel {index} lies at {world}")


def check_values(grid, time_s):
    """Every active voxel holds the closed form; in each column all voxels above the first active one are active."""
    accessor = grid.getConstAccessor()
    active_below = {}
    active = 0
    for index in series.voxels():
        value, is_active = accessor.probeValue(index)
        column = index[:2]
        if is_active:
            expected = series.power_density_dbwm2(grid.transform.indexToWorld(index), time_s)
            series.check(abs(value - expected) < series.TOLERANCE_DB, f"voxel {index} holds {value}, not {expected}")
            active += 1
        else:
            series.check(value == series.FLOOR_DBWM2, f"inactive voxel {index} holds {value}")
            series.check(not active_below.get(column), f"inactive voxel {index} above an active one")
        active_below[column] = is_active
    series.check(all(active_below.values()), "a column's highest voxel is inactive")
    series.check(grid.activeVoxelCount() == active, "active voxels outside the box")
    series.check(active < math.prod(series.DIMS), "no voxel lies below ground")


ranges = set()
for step, time_s in enumerate(series.TIMES_S, start=1):
    grid = pyopenvdb.read(str(series.folder() / f"hollow_{step:04}.vdb"), "power_density_dbwm2")
    series.check(grid.background == series.FLOOR_DBWM2, f"background {grid.background}")
    check_metadata(grid, time_s)
    check_transform(grid)
    check_values(grid, time_s)
    ranges.add((grid.metadata["emscape:range_min"], grid.metadata["emscape:range_max"]))
series.check(len(ranges) == 1, f"the range differs from step to step: {ranges}")
