"""Fields as arrays: values, lifetime, speed, threads."""

import gc
import multiprocessing
import os
import subprocess
import sys
import threading
import time

import numpy as np
import pytest
from conftest import ROOT, SCENARIOS

import emscape as em
from emscape._native import native as _emscape


def test_an_array_is_a_read_only_view_with_the_field_as_owner(quick):
    field = em.Solver(quick, "cpu").at(0)
    values = field.numpy("power_density_dbwm2")
    assert values.shape == field.shape == (20, 40, 40)
    assert values.dtype == np.float32 and values.flags.c_contiguous and not values.flags.writeable
    assert np.shares_memory(values, field.numpy())
    assert np.shares_memory(values, np.from_dlpack(field.dlpack()))
    with pytest.raises(ValueError, match="read-only"):
        values[0, 0, 0] = 1


def test_the_axes_are_z_y_x(quick):
    field = em.Solver(quick.with_set({"emitters.radar.power_w": 1e-6}), "cpu").at(0)
    assert (field.z_m.size, field.y_m.size, field.x_m.size) == field.shape
    values = field.numpy()
    z, y, x = np.unravel_index(np.argmax(values), values.shape)
    latitude, longitude, _ = field.geodetic(field.x_m[x], field.y_m[y], field.z_m[z])
    # The voxel with the largest value holds the transmitter that is left.
    mast_latitude, mast_longitude, _ = quick.positions()["mast"]
    assert np.hypot((latitude - mast_latitude) * 111e3, (longitude - mast_longitude) * 68e3) < 400
    assert np.all(np.diff(field.z_m) > 0) and field.z_m[0] == 125


def test_an_array_outlives_field_and_solver(quick):
    solver = em.Solver(quick, "cpu")
    field = solver.at(0)
    values = field.numpy()
    copy = values.copy()
    del solver, field
    gc.collect()
    em.Solver(quick, "cpu").at(1)
    assert np.array_equal(values, copy)


def test_a_later_update_does_not_change_an_earlier_field(quick):
    solver = em.Solver(quick, "cpu")
    first = solver.at(0)
    values, copy = first.numpy(), first.numpy().copy()
    second = solver.at(2)
    solver.at(3, quick.with_set({"emitters.transmitter.power_w": 1}))
    assert np.array_equal(values, copy)
    assert not np.array_equal(second.numpy(), copy)
    assert not np.shares_memory(values, second.numpy())


def test_a_posed_platform_equals_a_fixed_site_there(jamming):
    platform = jamming.platforms[0]
    solver = em.Solver(jamming, "cpu")
    before = solver.at(0).numpy().copy()
    posed = solver.at(0, poses={platform: (36.28, -84.24, 900, 90)}).numpy()
    edits = {
        f"platforms.{platform}.position": {"latitude_deg": 36.28, "longitude_deg": -84.24, "height_msl_m": 900},
        f"platforms.{platform}.attitude": {"heading_deg": 90},
    }
    fixed = em.Solver(jamming.with_set(edits), "cpu").at(0).numpy()
    assert np.array_equal(posed, fixed, equal_nan=True)
    assert not np.array_equal(posed, before, equal_nan=True)
    assert np.array_equal(solver.at(0).numpy(), before, equal_nan=True), "poses are of one call"
    with pytest.raises(em.UsageError, match="2 numbers"):
        solver.at(0, poses={platform: (1, 2)})
    with pytest.raises(em.InputError, match="no platform 'nobody'"):
        solver.at(0, poses={"nobody": (1, 2, 3)})


def test_an_edited_scenario_equals_a_new_solver(jamming):
    edited = jamming.with_set({"emitters.stand-off jammer.power_w": 1000})
    solver = em.Solver(jamming, "cpu")
    solver.at(40)
    again, new = solver.at(40, edited), em.Solver(edited, "cpu").at(40)
    for name in new.quantities:
        assert np.array_equal(again.numpy(name), new.numpy(name), equal_nan=True)
    assert solver.scenario.edits == edited.edits


# Scenario: quantities, edits.
SERIES = {
    "jamming": ("detection_probability,jammer_to_signal_db,burn_through_margin_db,power_density_dbwm2", {}),
    "sinr": ("received_power_dbm,sinr_db,intercept_margin_db", {}),
    "clutter": ("mean_power_density_dbwm2,sclnr_db", {}),
    "interval": ("occupancy,power_density_dbwm2", {"output.interval.kind": "mean"}),
    "jamming, cumulative": (
        "detection_age_s,detection_probability",
        {"output.quantities": ["detection_age_s"], "output.interval": {"kind": "cumulative", "seconds": 10}},
    ),
}
OTHERS = {name for name, *_ in _emscape.quantity_table()} - {name for row in SERIES.values() for name in row[0].split(",")}
SERIES["quick"] = (",".join(sorted(OTHERS | {"power_density_dbwm2", "detection_probability"})), {})


@pytest.mark.parametrize("series", SERIES)
def test_values_are_those_of_simulate_bit_by_bit(series, program, tmp_path):
    quantities, edits = SERIES[series]
    file = SCENARIOS / f"{series.partition(',')[0]}.yaml"
    edits = {**edits, "region.dims": [30, 28, 12]}
    words = [word for path, value in edits.items() for word in ("--set", f"{path}={value}")]
    subprocess.run(
        [program, "simulate", file, "-o", tmp_path, "--format", "raw", "--quantity", quantities, "--times", "2",
         *words, "--backend", "cpu", "--quiet"],
        check=True,
    )  # fmt: skip
    field = em.Solver(em.load(file, edits), "cpu", quantities=quantities.split(",")).at(2)
    files = sorted(tmp_path.glob("*.raw"))
    assert len(files) == len(field.quantities)
    for quantity in field.quantities:
        (file,) = [f for f in files if quantity in f.name]
        values = field.numpy(quantity)
        if field.info(quantity)["categorical"]:
            values = values.astype(np.int32)  # as the file holds indices
        assert file.read_bytes() == values.tobytes(), quantity


def test_a_written_field_reads_back(jamming, tmp_path):
    field = em.Solver(jamming, "cpu").at(40)
    for ending in ("vdb", "vti", "nvdb"):
        file = tmp_path / f"field.{ending}"
        if ending == "nvdb":
            field.write(file, ["detection_probability"])
        else:
            field.write(file)
        again = em.read(file)
        for name in again.quantities:
            assert np.array_equal(again.numpy(name), field.numpy(name)), (ending, name)
        assert again.grid == field.grid and again.time_s == 40
        assert again.time == field.time is not None


def test_a_field_of_a_file_without_an_epoch_has_no_date(quick, tmp_path):
    field = em.Solver(quick.with_set({"epoch": None}), "cpu").at(1)
    field.write(tmp_path / "field.vdb")
    assert field.time is None and em.read(tmp_path / "field.vdb").time is None


def test_the_grid_is_a_copy(quick):
    field = em.Solver(quick, "cpu").at(0)
    field.grid["dims"] = (1, 1, 1)
    assert field.grid["dims"] == (40, 40, 20) and field.shape == (20, 40, 40)


def test_masked_voxels_are_those_below_ground(jamming):
    field = em.Solver(jamming, "cpu").at(0)
    ground = field.ground_msl_m()
    assert ground.shape == field.shape[1:]
    mask = field.mask("detection_probability")
    below = field.z_m[:, None, None] < ground[None]
    assert np.all(mask[below])
    assert 0 < mask.sum() < mask.size
    assert np.all(field.numpy("detection_probability")[mask] == field.info("detection_probability")["floor"])


def test_dlpack_of_a_field_on_a_gpu_is_device_memory(jamming):
    cupy = pytest.importorskip("cupy")
    try:
        field = em.Solver(jamming, "cuda").at(0)
    except em.DeviceError as missing:
        pytest.skip(str(missing))
    for name in field.quantities:
        values = cupy.from_dlpack(field.dlpack(name))
        assert field.dlpack(name).__dlpack_device__() == (2, 0)
        assert values.data.ptr == cupy.from_dlpack(field.dlpack(name)).data.ptr, "no copy at later calls"
        assert np.array_equal(cupy.asnumpy(values), field.numpy(name)), "the floor in masked voxels, too"
    assert cupy.from_dlpack(field).data.ptr == cupy.from_dlpack(field.dlpack()).data.ptr
    kept = cupy.asnumpy(values)
    del field
    assert np.array_equal(cupy.asnumpy(values), kept), "the array keeps the field's memory"


def test_memory_does_not_grow(quick):
    def resident_kb():
        with open("/proc/self/statm") as statm:
            return int(statm.read().split()[1]) * os.sysconf("SC_PAGE_SIZE") // 1024

    solver = em.Solver(quick.with_set({"region.dims": [16, 16, 8]}), "cpu", threads=1)

    def cycle(count):
        for i in range(count):
            field = solver.at(i % 5)
            values = field.numpy()
            tensor = field.dlpack()
            del field, values, tensor

    cycle(2000)
    before = resident_kb()
    cycle(10000)
    gc.collect()
    assert resident_kb() - before < 2048


def test_the_interpreter_is_not_held_up_by_the_solver(jamming):
    scenario = jamming.with_set({"region.dims": [120, 120, 50]})
    solver = em.Solver(scenario, "cpu", threads=1)
    longest, done = 0.0, threading.Event()

    def tick():
        nonlocal longest
        last = time.perf_counter()
        while not done.is_set():
            time.sleep(0.001)
            now = time.perf_counter()
            longest = max(longest, now - last)
            last = now

    ticker = threading.Thread(target=tick)
    ticker.start()
    begin = time.perf_counter()
    for i in range(4):
        solver.at(20 + 2 * i)
    spent = time.perf_counter() - begin
    done.set()
    ticker.join()
    # Held, the ticker would wait as long as an update. The machine may be busy: a quarter of the whole is far less.
    assert longest < spent / 8 + 0.05


def test_threads_share_a_solver(jamming):
    solver = em.Solver(jamming, "cpu")
    expected = {t: solver.at(t).numpy().copy() for t in (0, 20, 40)}
    wrong = []

    def work(t):
        for _ in range(5):
            if not np.array_equal(solver.at(t).numpy(), expected[t]):
                wrong.append(t)

    threads = [threading.Thread(target=work, args=(t,)) for t in expected]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    # Fields depend on the calls before by the tolerance of moves alone, which this scenario's tracks exceed.
    assert not wrong


def test_a_text_is_one_quantity(quick, tmp_path):
    field = em.Solver(quick, "cpu", quantities="snr_db").at(0)
    assert field.quantities == ["snr_db"]
    field.write(tmp_path / "field.vti", "snr_db")
    assert em.read(tmp_path / "field.vti").quantities == ["snr_db"]


def _solve(file):
    try:
        em.Solver(em.load(file), "cpu").at(0)
    except em.Error as error:
        return str(error)
    return "solved"


def test_a_forked_process_is_refused_and_a_spawned_one_works(quick):
    em.Solver(quick, "cpu").at(0)
    with multiprocessing.get_context("fork").Pool(1) as pool:
        assert "forked" in pool.apply(_solve, (quick.file,))
    with multiprocessing.get_context("spawn").Pool(1) as pool:
        assert pool.apply(_solve, (quick.file,)) == "solved"


def test_points_of_pyvista_are_voxel_centres(jamming):
    pytest.importorskip("pyvista")
    field = em.Solver(jamming, "cpu").at(40)
    image = field.to_pyvista()
    z, y, x = field.shape
    assert image.dimensions == (x, y, z)
    values = np.where(field.mask("jammer_to_signal_db"), np.nan, field.numpy("jammer_to_signal_db"))
    assert np.isnan(values).any()
    for k in (0, z - 1):
        for j in (0, y - 1):
            for i in (0, x - 1):
                point = image.find_closest_point((field.x_m[i], field.y_m[j], field.z_m[k]))
                assert np.allclose(image.points[point], (field.x_m[i], field.y_m[j], field.z_m[k]))
                assert np.array_equal(image.point_data["jammer_to_signal_db"][point], values[k, j, i], equal_nan=True)


def test_the_example_runs_and_states_its_usage(tmp_path):
    def example(*words):
        return subprocess.run([sys.executable, ROOT / "examples" / "field.py", *words], capture_output=True, text=True)

    done = example(SCENARIOS / "quick.yaml", "1", tmp_path / "field.vdb")
    assert done.returncode == 0 and "with 1 kW: mean change" in done.stdout, done.stderr
    assert em.read(tmp_path / "field.vdb").time_s == 1
    wrong = example()
    assert (wrong.returncode, wrong.stderr) == (1, "usage: python examples/field.py SCENARIO TIME_S VOLUME\n")
