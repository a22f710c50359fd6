"""Reading and editing scenarios; errors with their places."""

import copy
import datetime
import decimal
import os
import pickle
import subprocess
import sys

import numpy as np
import pytest
from conftest import SCENARIOS

import emscape as em


def test_says_what_the_file_holds(quick):
    assert quick.name == "quick"
    assert quick.shape == (20, 40, 40)
    assert quick.size_m == (20000, 20000, 5000)
    assert quick.epoch == datetime.datetime(2026, 6, 1, 6, tzinfo=datetime.timezone.utc)
    assert quick.emitters == ["radar", "transmitter"]
    assert quick.platforms == ["radar site", "mast"]
    assert quick.times("") == [0, 1, 2, 3, 4]
    assert quick.times("0:1:0.5") == [0, 0.5, 1]
    assert quick.times([1, 3]) == [1, 3]
    latitude, longitude, height_msl_m = quick.positions()["mast"]
    assert (latitude, longitude) == (52.05, 5.06)
    assert height_msl_m == pytest.approx(50)


def test_times_are_numbers_or_arrays(quick):
    assert quick.times(np.array(5.0)) == quick.times(np.float32(5)) == quick.times(5) == [5]
    assert quick.times(np.array([0.5, 2])) == [0.5, 2]


@pytest.mark.parametrize(
    ("times", "message"),
    [
        ([], "the sequence is empty"),
        ([0, float("nan")], "'nan' is not a number of seconds"),
        (float("inf"), "'inf' is not a number of seconds"),
        (None, "'None' is not a number of seconds"),
        ([2, 1], r"1.0 s follows 2.0 s; times must be ascending"),
        ([1, 1], r"1.0 s follows 1.0 s; times must be ascending"),
        (b"0", "b'0' is not a number of seconds"),
        (1e10, "10000000000.* s is outside the allowed range"),
        ([-1e10, 0], "-10000000000.* s is outside the allowed range"),
    ],
)
def test_times_are_finite_and_ascending(quick, times, message):
    with pytest.raises(em.UsageError, match=message):
        quick.times(times)


def test_times_are_utc_or_intervals_too(quick):
    utc = datetime.timezone.utc
    at_2_s = datetime.datetime(2026, 6, 1, 6, 0, 2, tzinfo=utc)
    for time in ("2026-06-01T06:00:02Z", at_2_s, np.datetime64("2026-06-01T06:00:02"), datetime.timedelta(seconds=2), np.timedelta64(2, "s")):
        assert quick.times([time]) == [2]
        assert quick.positions(time) == quick.positions(2)
    assert quick.times("2026-06-01T06:00:01Z:2026-06-01T06:00:03Z:1") == [1, 2, 3]
    with pytest.raises(em.UsageError, match="has no time zone"):
        quick.times([at_2_s.replace(tzinfo=None)])
    with pytest.raises(em.UsageError, match="the scenario has no epoch"):
        quick.with_set({"epoch": None}).times("2026-06-01T06:00:02Z")
    solver = em.Solver(quick)
    assert solver.at(at_2_s).time_s == 2
    with pytest.raises(em.UsageError, match="'noon' is not a time in seconds or UTC"):
        solver.at("noon")


def test_a_text_or_dict_is_a_scenario_without_a_file(quick, tmp_path):
    text = (SCENARIOS / "quick.yaml").read_text(encoding="utf-8")
    parsed = em.parse(text, folder=tmp_path)
    assert (parsed.name, parsed.emitters) == (quick.name, quick.emitters)
    assert not os.path.exists(parsed.file)
    edited = parsed.with_set({"emitters.radar.power_w": 500})
    again = pickle.loads(pickle.dumps(edited))
    assert (again.hash, again.edits) == (edited.hash, edited.edits)
    described = {
        "schema_version": 1,
        "name": "beacon",
        "epoch": datetime.datetime(2026, 6, 1, 6, tzinfo=datetime.timezone.utc),
        "region": {"origin": {"latitude_deg": 52, "longitude_deg": 5}, "size_m": [20000, 20000, 5000], "dims": [10, 10, 5]},
        "platforms": [{"name": "mast", "position": {"latitude_deg": 52, "longitude_deg": 5, "height_agl_m": 40}}],
        "emitters": [
            {"name": "beacon", "platform": "mast", "kind": "transmitter", "frequency_hz": 1e8, "power_w": 1, "antenna": {"pattern": "isotropic"}}
        ],
    }
    assert em.Solver(em.parse(described)).at(0).time == described["epoch"]
    with pytest.raises(em.ScenarioError, match="power_kw"):
        em.parse({**described, "emitters": [{**described["emitters"][0], "power_kw": 1}]})
    with pytest.raises(em.UsageError, match="a list is no scenario"):
        em.parse([])


def test_a_warning_of_a_scenario_is_logged_once(caplog):
    edits = {"region.size_m": [29, 29, 6000]}
    scenario = em.load(SCENARIOS / "quick.yaml", edits)
    caplog.clear()
    for power_w in (1, 2, 3):
        scenario.with_set({"emitters.radar.power_w": power_w})
    em.load(SCENARIOS / "quick.yaml", edits)
    assert not [record for record in caplog.records if "size_m" in record.message]


def test_ctrl_c_in_a_handler_of_messages_is_not_lost(tmp_path):
    script = f"""
import logging, os, signal
import emscape as em
class Interrupts(logging.Handler):
    def emit(self, record):
        os.kill(os.getpid(), signal.SIGINT)
logger = logging.getLogger("emscape")
logger.setLevel(logging.DEBUG)
logger.addHandler(Interrupts())
try:
    em.simulate(em.load({str(SCENARIOS / "jamming.yaml")!r}), {str(tmp_path / "out")!r}, ("raw",), times="0:1000:0.01")
except KeyboardInterrupt:
    print("interrupted")
"""
    done = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, timeout=120)
    assert done.stdout.strip() == "interrupted", done.stderr


def test_an_edit_gives_another_scenario(quick):
    edited = quick.with_set({"emitters.radar.power_w": np.float64(500), "name": 'a "name": #1'})
    assert edited.edits == {"emitters.radar.power_w": "500.0", "name": '"a \\"name\\": #1"'}
    assert edited.name == 'a "name": #1'
    assert quick.edits == {} and quick.name == "quick"
    assert edited.hash != quick.hash
    assert edited.with_set({"emitters.radar.power_w": 10000, "name": "quick"}).emitters == quick.emitters


def test_null_removes_a_key(quick):
    assert quick.with_set({"epoch": None}).epoch is None


def test_a_pickled_scenario_is_the_same(quick):
    edited = quick.with_set({"emitters.radar.power_w": 500})
    again = pickle.loads(pickle.dumps(edited))
    assert (again.hash, again.edits) == (edited.hash, edited.edits)


def test_a_pickled_scenario_whose_file_has_changed_is_refused(tmp_path):
    file = tmp_path / "quick.yaml"
    file.write_text((SCENARIOS / "quick.yaml").read_text())
    scenario = em.load(file)
    pickled = pickle.dumps(scenario)
    file.write_text(file.read_text().replace("10000", "20000"))
    with pytest.raises(em.InputError, match="quick.yaml: has changed since the pickled scenario was loaded"):
        pickle.loads(pickled)
    assert copy.copy(scenario) is scenario and copy.deepcopy([scenario])[0] is scenario


def test_a_scenario_does_not_depend_on_the_folder_in_which_it_was_loaded(tmp_path, monkeypatch):
    monkeypatch.chdir(SCENARIOS)
    scenario = em.load("quick.yaml")
    assert scenario.file == str(SCENARIOS / "quick.yaml")
    pickled = pickle.dumps(scenario)
    monkeypatch.chdir(tmp_path)
    assert pickle.loads(pickled).hash == scenario.hash
    assert em.profile(scenario, "radar", (52.05, 5.05, 500))["verdict"]


def test_an_absolute_name_needs_no_current_folder(quick, tmp_path, monkeypatch):
    folder = tmp_path / "removed"
    folder.mkdir()
    monkeypatch.chdir(folder)
    folder.rmdir()
    assert em.load(quick.file).hash == quick.hash


def test_a_saved_scenario_is_the_same(quick, tmp_path):
    edited = quick.with_set({"emitters.radar.power_w": 500})
    edited.save(tmp_path / "saved.yaml")
    assert "power_w: 500" in (tmp_path / "saved.yaml").read_text()
    assert em.load(tmp_path / "saved.yaml").edits == {}


def test_all_faults_of_a_file_are_listed_with_their_places(tmp_path):
    text = (SCENARIOS / "quick.yaml").read_text()
    file = tmp_path / "faulty.yaml"
    file.write_text(text.replace("power_w: 10000", "power_w: -1").replace("step_s: 1", "step_s: 0"))
    with pytest.raises(em.ScenarioError) as caught:
        em.load(file)
    problems = caught.value.problems
    assert [(p.file, p.line, p.column) for p in problems] == [(str(file), 6, 9), (str(file), 19, 14)]
    assert problems[1].message == "'power_w' is -1, outside the allowed range above 0 to 1 TW"
    assert str(caught.value).splitlines()[1] == f"{file}:19:14: {problems[1].message}"
    assert caught.value.status == 3
    again = pickle.loads(pickle.dumps(caught.value))
    assert again.problems == problems


def test_the_place_of_a_faulty_edit_is_the_edit(quick):
    with pytest.raises(em.ScenarioError) as caught:
        quick.with_set({"emitters.radar.power_w": -1})
    assert caught.value.problems[0].file == "emitters.radar.power_w=-1"


CENTRAL_EUROPE = datetime.timezone(datetime.timedelta(hours=2))


@pytest.mark.parametrize(
    ("epoch", "expected"),
    [
        (datetime.datetime(2026, 6, 1, 8, tzinfo=CENTRAL_EUROPE), "2026-06-01T06:00:00+00:00"),
        (datetime.datetime(900, 6, 1, 8, 0, 0, 250000, datetime.timezone.utc), "0900-06-01T08:00:00.250000+00:00"),
        (np.datetime64("2026-06-01T06:00:00.5"), "2026-06-01T06:00:00.500000+00:00"),
        (np.datetime64("2026-06-01T06:00:00", "ns"), "2026-06-01T06:00:00+00:00"),
        (np.datetime64("2026-06-01T06:00:00.123456"), "2026-06-01T06:00:00.123456+00:00"),
    ],
)
def test_times_are_values_of_edits(quick, epoch, expected):
    assert quick.with_set({"epoch": epoch}).epoch.isoformat() == expected


def test_the_own_epoch_and_that_of_pandas_are_values_of_edits(quick):
    assert quick.with_set({"epoch": quick.epoch}).epoch == quick.epoch
    pandas = pytest.importorskip("pandas")
    assert quick.with_set({"epoch": pandas.Timestamp("2026-06-01T08:00", tz="Europe/Paris")}).epoch == quick.epoch


@pytest.mark.parametrize(
    ("value", "message"),
    [
        (datetime.datetime(2026, 6, 1), "edit of 'epoch': the time 2026-06-01 00:00:00 has no time zone"),
        (range(3), "edit of 'epoch': a range is no value; give None, a bool"),
        ([decimal.Decimal(1)], "edit of 'epoch': a Decimal is no value"),
        ("a\udcff", r"edit of 'epoch': '\\udcff' is not a character of UTF-8"),
    ],
)
def test_a_value_that_no_scenario_can_have_is_refused_with_its_path(quick, value, message):
    with pytest.raises(em.UsageError, match=message):
        quick.with_set({"epoch": value})
    with pytest.raises(em.UsageError, match=message):
        em.load(quick.file, {"epoch": value})


@pytest.mark.parametrize(
    ("path", "message"),
    [
        (1, "edit of 1: a path is a text"),
        ("na\udcffme", r"edit of 'na\\udcffme': '\\udcff' is not a character of UTF-8"),
    ],
)
def test_the_path_of_an_edit_is_a_text_in_utf_8(quick, path, message):
    with pytest.raises(em.UsageError, match=message):
        quick.with_set({path: 2})


def test_a_path_is_a_value_of_an_edit(jamming):
    terrain = SCENARIOS / "data" / "jacksboro.tif"
    assert jamming.with_set({"terrain.files": [terrain]}).edits["terrain.files"] == f'["{terrain}"]'


def test_names_of_files_are_texts_bytes_or_paths_in_utf_8(quick, tmp_path):
    name = os.fsencode(tmp_path / "höhe.yaml")
    quick.save(name)
    assert em.load(name).file == os.fsdecode(name)
    with pytest.raises(em.UsageError, match=r"n\\xff.yaml' is not UTF-8"):
        em.load(os.fsencode(tmp_path) + b"/n\xff.yaml")
    for refused in (lambda: em.load(""), lambda: em.read(""), lambda: quick.save(b"")):
        with pytest.raises(em.UsageError, match="the name of a file or folder is empty"):
            refused()


def test_errors_have_the_class_and_the_status_of_their_kind(quick, tmp_path):
    with pytest.raises(em.ScenarioError, match="nowhere.yaml") as caught:
        em.load(tmp_path / "nowhere.yaml")
    assert isinstance(caught.value, em.InputError) and isinstance(caught.value, ValueError)
    with pytest.raises(em.UsageError, match="auto, cpu") as caught:
        em.Solver(quick, "gpu")
    assert caught.value.status == 2
    with pytest.raises(em.UsageError, match="power_density_dbwm2"):
        em.Solver(quick, "cpu", quantities=["loudness"])
    field = em.Solver(quick, "cpu").at(0)
    with pytest.raises(em.UsageError, match="the field has no quantity 'loudness'; it has power_density_dbwm2"):
        field.numpy("loudness")
    with pytest.raises(em.OtherError, match="none"):
        field.write(tmp_path / "none" / "x.vdb")
    with pytest.raises(em.InputError, match=r"known are \.vdb, \.nvdb, \.vti, \.raw$"):
        field.write(tmp_path / "x.txt")
    statuses = {cls: cls.status for cls in (em.OtherError, em.UsageError, em.InputError, em.DeviceError, em.CheckError)}
    assert sorted(statuses.values()) == [1, 2, 3, 4, 5]
    assert all(issubclass(cls, em.Error) for cls in statuses)


@pytest.mark.parametrize(
    ("argument", "message"),
    [
        ({"threads": -5}, "threads is -5, outside the allowed range 0 to 4096"),
        ({"cache_mib": -1}, "cache_mib is -1, outside the allowed range 0 to 1000000 MiB"),
        ({"cache_mib": float("inf")}, "cache_mib is inf"),
        ({"cache_mib": float("nan")}, "cache_mib is nan"),
        ({"move_tolerance_m": float("nan")}, "move_tolerance_m is nan, outside the allowed range 0 to 1000000 m"),
        ({"move_tolerance_m": float("inf")}, "move_tolerance_m is inf"),
        ({"quantities": ["snr_db", "snr_db"]}, "quantities: 'snr_db' is given twice"),
    ],
)
def test_arguments_of_a_solver_have_ranges(quick, argument, message):
    with pytest.raises(em.UsageError, match=message):
        em.Solver(quick, "cpu", **argument)


def test_a_gpu_that_is_missing_is_a_device_error(quick):
    probe = "import emscape as em, sys; em.Solver(em.load(sys.argv[1]), 'cuda')"
    result = subprocess.run(
        [sys.executable, "-c", probe, quick.file], capture_output=True, text=True, env={**os.environ, "CUDA_VISIBLE_DEVICES": ""}
    )
    assert "emscape._errors.DeviceError" in result.stderr


def test_names_that_need_quotes_are_quoted():
    assert em.path_step("a=b") == '"a=b"'
    assert em.path_step("radar") == "radar"
