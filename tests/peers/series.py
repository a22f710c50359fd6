"""The series that the tests in this folder read: its closed form, and what they share."""

import argparse
import math
import os
import pathlib
import sys

SKIPPED = 77  # what ctest takes for "skipped"

TIMES_S = (0.0, 1.0, 2.0)
DIMS = (24, 25, 20)
SPACING_M = (1000.0, 800.0, 200.0)
FIRST_CENTER_M = (-11500.0, -9600.0, 100.0)
SOURCE_M = (0.0, 0.0, 2000.0)
FLOOR_DBWM2 = -120.0
TOLERANCE_DB = 2e-3  # float32 values; the frame's own centimetres near the source


def powers_w(time_s):
    """Radiated powers of the two sources."""
    return (100.0, 300.0 if time_s >= 0.5 else 0.0)


def power_density_dbwm2(position_m, time_s):
    """S = P / (4 pi R^2) at a position of the frame."""
    range_m = math.dist(position_m, SOURCE_M)
    return 10 * math.log10(sum(powers_w(time_s)) / (4 * math.pi * range_m**2))


def center_m(i, j, k):
    return tuple(first + index * step for first, index, step in zip(FIRST_CENTER_M, (i, j, k), SPACING_M))


def voxels():
    return ((i, j, k) for k in range(DIMS[2]) for j in range(DIMS[1]) for i in range(DIMS[0]))


def skip(reason):
    """Ends the test as skipped, or as failed where the peers are required."""
    print("skipped:", reason)
    sys.exit(1 if os.environ.get("EMSCAPE_REQUIRE_PEERS") else SKIPPED)


def check(condition, message):
    if not condition:
        sys.exit(f"FAILED: {message}")


def folder():
    """The series' folder, from the command line."""
    parser = argparse.ArgumentParser()
    parser.add_argument("folder", type=pathlib.Path)
    return parser.parse_args().folder
