"""Labelled arrays: coordinates, units, projection, laziness; maps."""

import os
import pickle
import shutil
import subprocess

import numpy as np
import pytest
from conftest import ROOT

import emscape as em

xarray = pytest.importorskip("xarray")


@pytest.mark.parametrize("chunks", [None, "auto"])
def test_a_series_is_computed_where_it_is_read(jamming, chunks):
    series = em.open_series(jamming, "0:60:20", ["snr_db", "jammer_to_signal_db"], chunks=chunks)
    assert dict(series.sizes) == {"time": 4, "z": 25, "y": 60, "x": 60}
    assert list(series.data_vars) == ["snr_db", "jammer_to_signal_db"]
    assert series.time.values[1] == np.datetime64("2026-06-01T06:00:20")
    field = em.Solver(jamming, "cpu", quantities=["snr_db", "jammer_to_signal_db"]).at(40)
    values = series.jammer_to_signal_db.sel(time="2026-06-01T06:00:40").values
    mask = field.mask("jammer_to_signal_db")
    assert np.array_equal(np.isnan(values), mask)
    assert np.array_equal(values[~mask], field.numpy("jammer_to_signal_db")[~mask])
    column = series.snr_db.isel(time=slice(0, 3), x=5, y=[1, 7, 3])
    assert column.shape == (3, 25, 3)
    assert np.array_equal(column.values[:, :, 1], series.snr_db.values[:3, :, 7, 5], equal_nan=True)
    assert series.snr_db.isel(time=slice(0, 0)).values.shape == (0, 25, 60, 60)


def test_a_series_can_be_pickled(quick):
    series = em.open_series(quick, "0:1:1", chunks=None)
    again = pickle.loads(pickle.dumps(series))
    assert np.array_equal(again.power_density_dbwm2.values, series.power_density_dbwm2.values)


@pytest.mark.parametrize("year", ["0900", "1600", "1800", "2200", "2500"])
def test_time_is_right_in_all_years(quick, tmp_path, year):
    scenario = quick.with_set({"epoch": f"{year}-01-01T00:00:00.250Z"})
    moments = [np.datetime64(f"{year}-01-01T00:00:0{seconds}") for seconds in ("0.250", "1.750")]
    series = em.open_series(scenario, [0, 1.5], "power_density_dbwm2", chunks=None)
    assert list(series.data_vars) == ["power_density_dbwm2"]
    assert series.time.values.tolist() == np.array(moments, series.time.dtype).tolist()
    assert em.Solver(scenario, "cpu").at(1.5).to_xarray().time.values == moments[1]
    assert em.coverage(scenario, times=1.5, cell_m=1000, threshold=0.5).time.values == moments[1]
    pytest.importorskip("netCDF4")
    series.to_netcdf(tmp_path / "series.nc")
    coder = xarray.coders.CFDatetimeCoder(use_cftime=True)
    with xarray.open_dataset(tmp_path / "series.nc", decode_times=coder) as again:
        assert again.time.values[1].isoformat() == f"{year}-01-01T00:00:01.750000"


def test_a_field_from_a_file_keeps_its_date(quick, tmp_path):
    field = em.Solver(quick, "cpu").at(2.5)
    field.write(tmp_path / "field.vdb")
    again = em.read(tmp_path / "field.vdb").to_xarray()
    assert again.time.values == field.to_xarray().time.values == np.datetime64("2026-06-01T06:00:02.5")


def test_names_are_given_once(quick):
    with pytest.raises(em.UsageError, match="quantities: 'snr_db' is given twice"):
        em.open_series(quick, 0.0, ["snr_db", "snr_db"])
    with pytest.raises(em.UsageError, match="product: 'covered' is given twice"):
        em.coverage(quick, product=["covered", "value", "covered"])
    with pytest.raises(em.UsageError, match="product: the sequence is empty"):
        em.coverage(quick, product=[])


def test_without_an_epoch_time_is_in_seconds(quick):
    series = em.open_series(quick.with_set({"epoch": None}), [0, 2.5], chunks=None)
    assert series.time.values.tolist() == [0, 2.5]
    assert series.time.attrs["units"] == "s"


def test_the_projection_is_that_of_the_frame(jamming):
    pyproj = pytest.importorskip("pyproj")
    field = em.Solver(jamming, "cpu").at(0)
    crs = pyproj.CRS.from_wkt(field.to_xarray().spatial_ref.attrs["crs_wkt"])
    to_local = pyproj.Transformer.from_crs("EPSG:4326", crs, always_xy=True)
    for x_m, y_m in ((field.x_m[0], field.y_m[0]), (field.x_m[-1], field.y_m[0]), (field.x_m[3], field.y_m[-1])):
        latitude, longitude, _ = field.geodetic(x_m, y_m, field.z_m[0])
        assert to_local.transform(longitude, latitude) == pytest.approx((x_m, y_m), abs=1e-3)


def test_rioxarray_reads_the_projection(jamming):
    pytest.importorskip("rioxarray")
    series = em.open_series(jamming, 0.0, chunks=None)
    assert "Azimuthal" in series.rio.crs.to_wkt()
    covered = em.coverage(jamming, times=40, cell_m=1000)
    assert covered.rio.crs.to_epsg() == 32616
    assert covered.rio.resolution() == (1000, -1000)


def test_maps_are_those_of_profiles(jamming):
    maps = em.coverage(jamming, "agl:150,300;msl:3000", ["value", "covered"], times="0:40:40", cell_m=1000)
    assert set(maps.data_vars) == {"value_agl", "value_msl", "covered_agl", "covered_msl"}
    assert maps.value_agl.dims == ("time", "height_agl", "y", "x")
    assert maps.value_msl.dims == ("time", "y", "x")
    assert maps.covered_agl.attrs["flag_meanings"] == "no yes"
    known = np.isfinite(maps.value_agl.values)
    assert np.array_equal(maps.covered_agl.values[known], maps.value_agl.values[known] >= 0.5)
    one = em.coverage(jamming, "agl:150", product="min_height", times=0, cell_m=1000)
    assert one.name == "min_height" and one.dims == ("y", "x") and one.attrs["units"] == "m"


def test_a_pixel_equals_the_profile_there(jamming):
    pyproj = pytest.importorskip("pyproj")
    value = em.coverage(jamming, "agl:150", "value", quantity="snr_db", threshold=10, times=40, cell_m=2000)
    to_geographic = pyproj.Transformer.from_crs(pyproj.CRS.from_wkt(value.spatial_ref.attrs["crs_wkt"]), "EPSG:4326", always_xy=True)
    lit = np.argwhere(value.values > value.values[np.isfinite(value.values)].min())
    for y, x in lit[::7]:
        longitude, latitude = to_geographic.transform(float(value.x[x]), float(value.y[y]))
        path = em.profile(jamming, "search radar", (latitude, longitude, 150), agl=True, time_s=40)
        assert path["budget"]["snr_db"] == pytest.approx(float(value[y, x]), abs=0.01)


def test_indices_say_what_they_mean(jamming):
    series = em.open_series(jamming, "0:20:20", ["dominant_emitter", "dominant_model"], chunks=None)
    emitters, models = (series[name].attrs["flag_meanings"].split() for name in ("dominant_emitter", "dominant_model"))
    assert len(emitters) == 1 + len(jamming.emitters)
    assert models[:4] == ["none", "parabolic_equation", "diffraction", "two_ray"]
    assert len(series.dominant_model.attrs["flag_values"]) == len(models)


def test_a_dataset_goes_to_netcdf_and_back(jamming, tmp_path):
    pytest.importorskip("netCDF4")
    series = em.open_series(jamming, "0:20:20", chunks=None)
    series.to_netcdf(tmp_path / "series.nc")
    with xarray.open_dataset(tmp_path / "series.nc") as again:
        xarray.testing.assert_equal(again.load(), series.load())


def test_a_file_passes_the_checker_of_the_cf_conventions(jamming, tmp_path):
    pytest.importorskip("netCDF4")
    checker = shutil.which("compliance-checker", path=os.pathsep.join([str(ROOT / ".cache/peers/bin"), os.environ["PATH"]]))
    if not checker:
        pytest.skip("compliance-checker is not installed; scripts/setup --peers does it with pip")
    series = em.open_series(jamming, "0:20:20", ["snr_db", "dominant_emitter"], chunks=None)
    maps = em.coverage(jamming, "agl:150,300", ["value", "covered", "best", "min_height"], times=0, cell_m=1000)
    files = [tmp_path / "series.nc", tmp_path / "maps.nc"]
    for file, dataset in zip(files, (series, maps)):
        dataset.to_netcdf(file)
    report = subprocess.run([checker, "--test=cf:1.8", "--criteria=strict", *files], capture_output=True, text=True)
    assert report.returncode == 0 and report.stdout.count("All tests passed") == 2, report.stdout + report.stderr
