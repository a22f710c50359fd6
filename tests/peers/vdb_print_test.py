"""OpenVDB's vdb_print lists every grid that emscape simulate wrote, with type, metadata and transform."""

import shutil
import subprocess

import series

if not shutil.which("vdb_print"):
    series.skip("vdb_print (libopenvdb-tools) is not installed")

for step, time_s in enumerate(series.TIMES_S, start=1):
    file = str(series.folder() / f"hollow_{step:04}.vdb")
    printed = subprocess.run(["vdb_print", "-l", "-m", file], capture_output=True, text=True, check=True).stdout
    for text in (
        "power_density_dbwm2",
        "Tree_float_5_4_3",
        "dominant_emitter",
        "Tree_int32_5_4_3",
        "fog volume",
        "emscape:unit: dBW/m2",
        f"emscape:time_s: {time_s:g}",
        "voxel dimensions: [1e+03, 800, 200]",
    ):
        series.check(text in printed, f"vdb_print does not print '{text}' but:\n{printed}")
