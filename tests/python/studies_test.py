"""Explanations, studies and the installed program; pictures; messages and progress."""

import json
import logging
import subprocess
import sys

import numpy as np
import pytest
from conftest import SCENARIOS

import emscape as em


def said(program, *arguments):
    return json.loads(subprocess.run([program, *arguments, "--json", "--quiet"], check=True, capture_output=True).stdout)


def test_a_profile_is_that_of_the_command_line(jamming, program):
    edited = jamming.with_set({"emitters.search radar.power_w": 500})
    result = em.profile(edited, "search radar", (36.3, -84.2, 100), agl=True, time_s=40, models=["free_space"])
    words = ["profile", str(SCENARIOS / "jamming.yaml"), "--emitter", "search radar", "--to", "36.3,-84.2,100", "--agl", "--time", "40"]
    words += ["--model", "free_space", "--set", "emitters.search radar.power_w=500", "--set", "region.dims=[60,60,25]"]
    expected = said(program, *words)
    assert result == expected
    assert result["verdict"]


def test_exposure_and_links_are_those_of_the_command_line(program, tmp_path):
    file = SCENARIOS / "links.yaml"
    scenario = em.load(file)
    assert em.link(scenario, times="0:20:10") == said(program, "link", str(file), "--times", "0:20:10")
    result = em.exposure(scenario, scenario.platforms[-1], quantity="power_density_dbwm2", threshold=-70, times=[0, 10, 20])
    assert [row["time_s"] for row in result["rows"]] == [0, 10, 20]


def test_vertical_coverage_is_an_array(jamming):
    cuts = em.vertical(jamming, "search radar", [30, 120])
    assert cuts.detection_probability.dims == ("azimuth", "height_msl_m", "range")
    below = cuts.height_msl_m < cuts.ground_msl
    assert np.all(np.isnan(cuts.detection_probability.where(below.transpose("azimuth", "height_msl_m", "range"), drop=False).values))
    assert len(json.loads(cuts.attrs["azimuths"])) == 2
    assert json.loads(cuts.attrs["contour_columns"]) == ["range_m", "height_msl_m"]


def test_vertical_coverage_goes_to_netcdf_and_back(quick, tmp_path):
    pytest.importorskip("netCDF4")
    cuts = em.vertical(quick, "radar", [30], blake=True)
    cuts.to_netcdf(tmp_path / "cuts.nc")
    with sys.modules["xarray"].open_dataset(tmp_path / "cuts.nc") as again:
        assert again.attrs == cuts.attrs
    assert cuts.attrs["smooth_earth"] == 1


def test_compare_tells_what_is_won_and_lost(jamming):
    louder = jamming.with_set({"emitters.stand-off jammer.power_w": 5000})
    options = {"times": 40, "cell_m": 1000, "products": ["covered"]}
    lost = em.compare(jamming, louder, **options)["comparison"][0]
    won = em.compare(louder, jamming, **options)["comparison"][0]
    assert lost["lost_km2"] == won["gained_km2"] > 0
    assert lost["gained_km2"] == won["lost_km2"] == 0


def test_compare_applies_edits_of_both_scenarios_once(quick):
    options = {"quantity": "power_density_dbwm2", "threshold": -60, "times": 0, "cell_m": 2000, "products": "covered"}
    silent = quick.with_set({"emitters.transmitter": None})
    weaker = silent.with_set({"emitters.radar.power_w": 100})
    assert em.compare(silent, weaker, **options)["comparison"][0]["lost_km2"] > 0
    assert em.compare(weaker, silent, **options)["comparison"][0]["gained_km2"] > 0
    also_silent = quick.with_set({"emitters.radar.power_w": 100, "emitters.transmitter": None})
    assert em.compare(weaker, also_silent, **options)["comparison"][0]["lost_km2"] == 0
    assert em.compare(weaker, weaker, **options)["comparison"][0]["gained_km2"] == 0


def test_times_are_the_given_ones(tmp_path):
    scenario = em.load(SCENARIOS / "links.yaml")
    single = np.arange(0, 2, 0.1, dtype=np.float32)
    rows = em.link(scenario, targets="drone", times=single)["detections"][0]["rows"]
    assert [row["time_s"] for row in rows] == pytest.approx(single.tolist(), abs=1e-6)
    uneven = em.link(scenario, targets="drone", times=[0, 1, 3])["detections"][0]["rows"]
    assert [row["time_s"] for row in uneven] == [0, 1, 3]
    for refused in (
        lambda: em.link(scenario, times=[]),
        lambda: em.exposure(scenario, scenario.platforms[0], times=[]),
        lambda: em.compare(scenario, scenario, times=[]),
        lambda: em.simulate(scenario, tmp_path / "series", times=[]),
    ):
        with pytest.raises(em.UsageError, match="times: the sequence is empty"):
            refused()


def test_names_are_texts_or_lists(jamming):
    links = em.load(SCENARIOS / "links.yaml")
    assert em.link(links, emitters="search radar", times=0) == em.link(links, emitters=["search radar"], times=0)
    profile = em.profile(jamming, "search radar", (36.3, -84.2, 500), agl=True, models="free_space")
    assert profile == em.profile(jamming, "search radar", (36.3, -84.2, 500), agl=True, models=["free_space"])


def test_a_name_may_have_a_comma():
    links = em.load(SCENARIOS / "links.yaml", {"emitters.search radar.name": "radar, upper"})
    for names in ("radar, upper", ["radar, upper"], ["radar, upper", "mast"]):
        report = em.link(links, emitters=names, times=0)
        found = {row["emitter"] for row in report["links"]}
        assert found == ({names} if isinstance(names, str) else set(names))


def test_a_study_in_processes_equals_one_in_this_process(tmp_path):
    file = SCENARIOS / "study" / "jammer_power.yaml"
    one = em.study(file, tmp_path / "one")
    two = em.study(file, tmp_path / "two", jobs=2)
    assert one["variants"] == two["variants"] > 1
    assert (tmp_path / "one" / "results.csv").read_bytes() == (tmp_path / "two" / "results.csv").read_bytes()


def test_a_loaded_scenario_does_not_depend_on_its_file(tmp_path):
    file = tmp_path / "quick.yaml"
    file.write_text((SCENARIOS / "quick.yaml").read_text())
    scenario = em.load(file)
    before = em.profile(scenario, "radar", (52.05, 5.05, 500))
    file.unlink()
    assert em.profile(scenario, "radar", (52.05, 5.05, 500)) == before


def test_a_series_is_replaced_only_on_request(quick, tmp_path):
    em.simulate(quick, tmp_path / "series", "raw", times=0)
    with pytest.raises(em.UsageError, match="holds a series"):
        em.simulate(quick, tmp_path / "series", "raw", times=[0, 1])
    assert em.simulate(quick, tmp_path / "series", "raw", times=[0, 1], force=True)["steps_computed"] == 2


@pytest.mark.parametrize("to", ["36,-84,100", "123", (36, -84), (36, "north", 3), 36])
def test_a_point_is_three_numbers(quick, to):
    with pytest.raises(em.UsageError, match=r"to: .* is not \(latitude, longitude, height\), three numbers"):
        em.profile(quick, "radar", to)


def test_words_of_a_command_are_texts_or_paths(quick, program):
    assert em.command("info", SCENARIOS / "quick.yaml")["hash"] == em.command("info", quick.file)["hash"] == quick.hash
    with pytest.raises(em.UsageError, match=r"command: \['info', 'x.vdb'\] is neither a text nor a path"):
        em.command(["info", "x.vdb"])


def test_a_command_without_the_program_is_an_error(monkeypatch):
    monkeypatch.delenv("EMSCAPE_PROGRAM", raising=False)
    monkeypatch.setenv("PATH", "")
    with pytest.raises(em.OtherError, match="the program emscape is not on PATH"):
        em.command("info", "field.vdb")


def test_progress_is_called_and_may_end_the_work(jamming):
    steps = []
    em.coverage(jamming, times=40, cell_m=500, progress=lambda step, fraction: steps.append((step, fraction)))
    assert steps and all(0 <= fraction <= 1 for _, fraction in steps)

    def stop(step, fraction):
        raise RuntimeError("enough")

    with pytest.raises(RuntimeError, match="enough"):
        em.coverage(jamming, times=40, cell_m=500, progress=stop)
    with pytest.raises(RuntimeError, match="enough"):
        em.link(em.load(SCENARIOS / "links.yaml"), progress=stop)


def test_messages_go_to_the_logger(jamming, caplog):
    with caplog.at_level(logging.WARNING, "emscape"):
        em.vertical(jamming, "search radar", [30])
    assert any("far field" in record.message or "terrain" in record.message for record in caplog.records)


def test_a_handler_of_messages_may_compute():
    # In a process of its own: a deadlock would hold up the interpreter.
    probe = """
import logging, sys, threading
import emscape as em

class Handler(logging.Handler):
    def emit(self, record):
        self.setLevel(logging.CRITICAL)  # once
        other = threading.Thread(target=em.vertical, args=(scenario, "search radar", [30]))
        other.start()
        other.join()
        em.vertical(scenario, "search radar", [30])
        print("handled")

scenario = em.load(sys.argv[1], {"region.dims": [20, 20, 10]})
logging.getLogger("emscape").addHandler(Handler())
em.vertical(scenario, "search radar", [30])
"""
    words = [sys.executable, "-c", probe, SCENARIOS / "jamming.yaml"]
    result = subprocess.run(words, capture_output=True, text=True, timeout=120)
    assert (result.stdout, result.returncode) == ("handled\n", 0), result.stderr


def test_unknown_options_are_usage_errors(jamming, program):
    with pytest.raises(em.UsageError, match="--quantitie"):
        em.command("coverage", jamming.file, "-o", "none", "--quantitie", "x")
    with pytest.raises(em.UsageError, match="'nobody'"):
        em.profile(jamming, "nobody", (36.3, -84.2, 100))


def test_the_module_is_the_installed_program(program):
    words = ["profile", str(SCENARIOS / "quick.yaml"), "--emitter", "radar", "--to", "52.02,5.02,900", "--json"]
    here = subprocess.run([sys.executable, "-m", "emscape", *words], capture_output=True, text=True)
    there = subprocess.run([program, *words], capture_output=True, text=True)
    assert (here.returncode, here.stdout, here.stderr) == (there.returncode, there.stdout, there.stderr)
    wrong = subprocess.run([sys.executable, "-m", "emscape", "validate", "nowhere.yaml"], capture_output=True, text=True)
    assert wrong.returncode == 3 and "nowhere.yaml" in wrong.stderr + wrong.stdout


def test_a_picture_has_ground_field_and_labels(jamming):
    field = em.Solver(jamming, "cpu").at(40)
    picture = em.render(field, "detection_probability", size=(320, 200), camera={"azimuth_deg": 200, "elevation_deg": 35})
    assert picture.shape == (200, 320, 4) and picture.dtype == np.uint8
    assert len(np.unique(picture.reshape(-1, 4), axis=0)) > 100
    assert np.array_equal(picture, em.render(field, "detection_probability", size=(320, 200), camera="orbit:azimuth_deg=200,elevation_deg=35"))
    with pytest.raises(em.UsageError, match="azimuth_degrees"):
        em.render(field, camera={"azimuth_degrees": 3})


def test_a_picture_takes_the_settings_of_view_files(quick):
    field = em.Solver(quick, "cpu").at(0)
    size = (160, 120)
    plain = em.render(field, size=size)
    for settings in ({"map_layer": 500}, {"labels": "off"}, {"show_compass": False}, {"planes": ["horizontal:altitude_m=1500"]}):
        assert not np.array_equal(plain, em.render(field, size=size, **settings)), settings
    for settings in ({"map_layer": "high"}, {"labels": "some"}, {"map_opacity": 2}, {"planes": 3}, {"quantity_of": 1}, {"time_s": 1}):
        with pytest.raises(em.UsageError):
            em.render(field, size=size, **settings)


@pytest.mark.parametrize("bounds", [(10, -10), (5, 5), (float("nan"), 1), (0, float("inf")), (0, 1e300)])
def test_a_range_of_colours_has_ascending_numbers(quick, bounds):
    field = em.Solver(quick, "cpu").at(0)
    with pytest.raises(em.UsageError, match=r"range \(.*\) must be \(MIN, MAX\), two numbers with MIN < MAX"):
        em.render(field, size=(64, 48), range=bounds)


def test_the_value_of_an_isosurface_is_a_number(quick):
    field = em.Solver(quick, "cpu").at(0)
    with pytest.raises(em.UsageError, match="iso_value nan is not a number"):
        em.render(field, size=(64, 48), mode="iso", iso_value=float("nan"))


@pytest.mark.parametrize("exaggeration", [-1, 101, float("nan"), float("inf")])
def test_the_exaggeration_has_a_range(quick, exaggeration):
    field = em.Solver(quick, "cpu").at(0)
    with pytest.raises(em.UsageError, match=f"exaggeration is {exaggeration}, outside the allowed range 0 to 100"):
        em.render(field, size=(64, 48), exaggeration=exaggeration)


def test_a_picture_is_that_of_the_command_line(jamming, program, tmp_path):
    plt = pytest.importorskip("matplotlib.pyplot")
    words = ["--quantity", "jammer_to_signal_db", "--range=-20:60", "--size", "240x150", "--times", "40", "--rays", "full"]
    words += ["--set", "region.dims=[60,60,25]", "--backend", "cpu", "--quiet", "-o", tmp_path / "picture.png"]
    subprocess.run([program, "render", SCENARIOS / "jamming.yaml", *words], check=True)
    picture = em.render(em.Solver(jamming, "cpu").at(40), "jammer_to_signal_db", size=(240, 150), range=(-20, 60))
    drawn = np.rint(plt.imread(tmp_path / "picture.png") * 255).astype(np.uint8)
    assert np.array_equal(picture[:-20, :, :3], drawn[:-20, :, :3])  # all but the note at the bottom; emitters and tracks included


def test_import_is_light(program):
    probe = (
        "import sys, time; t = time.process_time(); import emscape; t = time.process_time() - t;"
        "kb = int(open('/proc/self/statm').read().split()[1]) * 4; print(t, kb, 'numpy' in sys.modules)"
    )
    seconds, resident_kb, has_numpy = subprocess.run(
        [sys.executable, "-c", probe], check=True, capture_output=True, text=True
    ).stdout.split()
    assert float(seconds) < 0.1 and int(resident_kb) < 30000 and has_numpy == "False"


def test_every_public_name_is_documented():
    undocumented = [name for name in em.__all__ if not name.startswith("_") and not getattr(em, name).__doc__]
    for cls in (em.Scenario, em.Solver, em.Field, em.Error, em.Problem):
        for name, member in vars(cls).items():
            if not name.startswith("_") and not getattr(member, "__doc__", None):
                undocumented.append(f"{cls.__name__}.{name}")
    assert not undocumented
    assert "load" in dir(em)
