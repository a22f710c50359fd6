"""Fields as labelled arrays: xarray objects with units, times and projection by the CF conventions."""

from __future__ import annotations

import datetime
import threading
from collections.abc import Hashable, Sequence
from typing import Any

import numpy as np
import numpy.typing as npt

from ._arguments import distinct
from ._field import Field, Solver
from ._native import native
from ._scenario import Scenario, Times

try:
    import xarray
    from xarray.backends import BackendArray
    from xarray.core import indexing
except ImportError as missing:
    raise ImportError("labelled arrays need xarray: pip install 'emscape[xarray]'") from missing

_UDUNITS = {
    "": "1",
    "dB": "0.1 lg(re 1)",
    "dBW/m2": "0.1 lg(re 1 W m-2)",
    "dBm": "0.1 lg(re 1 mW)",
    "dBuV/m": "0.05 lg(re 1e-6 V m-1)",
}
"""Units in UDUNITS notation where it differs: UDUNITS has no symbols for logarithmic units."""

_SPATIAL_REF = "spatial_ref"
CONVENTIONS = {"Conventions": "CF-1.8", "source": "emscape", "history": "emscape"}
"""Attributes of every dataset."""

_NANOSECONDS_REACH_S = 9.2e9
"""Largest distance from 1970 in datetime64[ns] (s): 1678-06 to 2261-07."""

NO_FILL = {"_FillValue": None}
"""Encoding of coordinates, which may not have a fill value."""


def udunit_of(unit: str) -> str:
    """A unit of the quantities in UDUNITS notation."""
    return _UDUNITS.get(unit, unit)


def flags(labels: Sequence[str], none: bool) -> dict[str, Any]:
    """Attributes that define the meaning of integer values. ``none``: -1 means no value."""
    first = -1 if none else 0
    words = (["none"] if none else []) + ["".join(c if c.isalnum() or c in "-." else "_" for c in label) for label in labels]
    return {"flag_values": np.arange(first, len(labels), dtype=np.float32), "flag_meanings": " ".join(words)}


def _local_crs(latitude_deg: float, longitude_deg: float, wkt: str) -> xarray.Variable:
    """The azimuthal equidistant projection of the frame "altitude", as a CF grid mapping."""
    return xarray.Variable(
        (),
        np.int32(0),
        {
            "long_name": "projection",
            "grid_mapping_name": "azimuthal_equidistant",
            "latitude_of_projection_origin": latitude_deg,
            "longitude_of_projection_origin": longitude_deg,
            "false_easting": 0.0,
            "false_northing": 0.0,
            "semi_major_axis": 6378137.0,
            "inverse_flattening": 298.257223563,
            "crs_wkt": wkt,
        },
    )


def wkt_crs(wkt: str) -> xarray.Variable:
    """A projection, given as WKT, as the variable spatial_ref, which rioxarray reads; with the parameters of the CF conventions
    if pyproj (extra "gis") is installed."""
    attributes: dict[str, Any] = {"long_name": "projection"}
    try:
        from pyproj import CRS

        attributes |= CRS.from_wkt(wkt).to_cf()
    except ImportError:
        pass
    return xarray.Variable((), np.int32(0), {**attributes, "crs_wkt": wkt, "spatial_ref": wkt})


def time_coordinate(times_s: Sequence[float], epoch: datetime.datetime | None, dims: tuple[str, ...]) -> xarray.Variable:
    """Times as datetime64, in ns or, where these would overflow, in us; in seconds without an epoch."""
    values = np.asarray(times_s, dtype=np.float64)
    shaped = values if dims else values[0]
    if epoch is None:
        return xarray.Variable(dims, shaped, {"long_name": "time since the beginning", "units": "s", "axis": "T"}, NO_FILL)
    utc = epoch.astimezone(datetime.timezone.utc).replace(tzinfo=None)
    start_s = epoch.timestamp()
    reach_s = np.abs(np.concatenate([[start_s], values, start_s + values])).max()
    unit, per_second = ("ns", 1e9) if reach_s < _NANOSECONDS_REACH_S else ("us", 1e6)
    start = np.datetime64(utc, "us").astype(f"datetime64[{unit}]")
    moments = start + np.rint(np.asarray(shaped) * per_second).astype(f"timedelta64[{unit}]")
    # Before 1582-10-15 the standard calendar is the Julian one, that of datetime64 is not.
    calendar = "standard" if np.all(moments >= np.datetime64("1582-10-15")) else "proleptic_gregorian"
    since = utc.isoformat(" ", "seconds")
    encoding = {"units": f"seconds since {since}", "calendar": calendar, "dtype": "float64", **NO_FILL}
    return xarray.Variable(dims, moments, {"standard_name": "time", "long_name": "time", "axis": "T"}, encoding)


def _space(grid: dict[str, Any]) -> dict[Hashable, Any]:
    """Coordinates x, y, z and, in the frame "altitude", spatial_ref."""
    frame = grid.get("frame")
    names = ("east", "north", "up")
    attributes: list[dict[str, Any]] = [
        {"long_name": f"{names[i]} of the origin" if i < 2 else "along the vertical at the origin", "units": "m"} for i in range(3)
    ]
    coordinates: dict[Hashable, Any] = {}
    if frame == "altitude":
        attributes[0]["standard_name"] = "projection_x_coordinate"
        attributes[1]["standard_name"] = "projection_y_coordinate"
        attributes[2] = {"standard_name": "altitude", "long_name": "height above mean sea level (EGM96)", "units": "m"}
        coordinates[_SPATIAL_REF] = _local_crs(grid["latitude_deg"], grid["longitude_deg"], grid["crs_wkt"])
    for axis, letter in enumerate("xyz"):
        first, step, count = grid["first_center_m"][axis], grid["spacing_m"][axis], grid["dims"][axis]
        attributes[axis]["axis"] = letter.upper()
        coordinates[letter] = xarray.Variable((letter,), first + np.arange(count) * step, attributes[axis], NO_FILL)
    coordinates["z"].attrs["positive"] = "up"
    return coordinates


def _attributes(channel: str, grid: dict[str, Any], scenario: Scenario | None) -> dict[str, Any]:
    """Attributes of a quantity's variable."""
    quantity, _, part = channel.partition(":")
    for name, unit, description, categorical in native.quantity_table():
        if name != quantity:
            continue
        attributes: dict[str, Any] = {"long_name": description + (f" ({part})" if part else "")}
        if categorical:
            attributes |= flags(scenario._handle.category_names(quantity) if scenario is not None else [], none=True)
        else:
            attributes["units"] = udunit_of(unit)
            if unit and unit != udunit_of(unit):
                attributes["unit_label"] = unit
        if grid.get("frame") == "altitude":
            attributes["grid_mapping"] = _SPATIAL_REF
        return attributes
    return {"long_name": channel}


def _masked(field: Field, channel: str) -> npt.NDArray[np.float32]:
    """The values, NaN where there is none."""
    values = field.numpy(channel)
    return values if field.first_valid(channel) is None else np.where(field.mask(channel), np.float32(np.nan), values)


def _global_attributes(title: str, grid: dict[str, Any]) -> dict[str, Any]:
    attributes: dict[str, Any] = {**CONVENTIONS, "title": title}
    if "frame" in grid:
        attributes |= {
            "frame": grid["frame"],
            "origin_latitude_deg": grid["latitude_deg"],
            "origin_longitude_deg": grid["longitude_deg"],
            "origin_height_msl_m": grid["height_msl_m"],
        }
    return attributes


def dataset_of(field: Field, quantities: Sequence[str] = ()) -> xarray.Dataset:
    """A field as a dataset (``Field.to_xarray``)."""
    grid, scenario = field.grid, field.scenario
    coordinates = _space(grid)
    if scenario is None and field.time is not None:  # the file states the time, not the epoch
        coordinates["time"] = time_coordinate([0.0], field.time, ())
    else:
        coordinates["time"] = time_coordinate([field.time_s], scenario.epoch if scenario is not None else None, ())
    ground = field.ground_msl_m()
    if ground is not None:
        coordinates["ground_msl"] = xarray.Variable(
            ("y", "x"), ground, {"standard_name": "surface_altitude", "long_name": "height of the ground", "units": "m"}
        )
    variables = {
        name: xarray.Variable(("z", "y", "x"), _masked(field, name), _attributes(name, grid, scenario))
        for name in quantities or field.quantities
    }
    title = f"Field of {scenario.name}" if scenario is not None else "Field"
    return xarray.Dataset(variables, coordinates, _global_attributes(title, grid))


class _Frames:
    """Fields of a series, computed on request; the last one is kept for its other quantities. Thread-safe. A pickled object makes
    its own solver."""

    def __init__(self, scenario: Scenario, times_s: list[float], options: dict[str, Any]) -> None:
        self.scenario, self.times_s, self.options = scenario, times_s, options
        self._lock = threading.Lock()
        self._solver: Solver | None = None
        self._last: tuple[int, Field] | None = None

    def at(self, step: int) -> Field:
        with self._lock:
            if self._last is None or self._last[0] != step:
                if self._solver is None:
                    self._solver = Solver(self.scenario, **self.options)
                self._last = (step, self._solver.at(self.times_s[step]))
            return self._last[1]

    def __reduce__(self) -> tuple[Any, ...]:
        return _Frames, (self.scenario, self.times_s, self.options)


class _SeriesArray(BackendArray):
    """One quantity of a series: (time, z, y, x); indexing computes the values."""

    def __init__(self, frames: _Frames, channel: str, shape: tuple[int, ...]) -> None:
        self.frames, self.channel, self.shape, self.dtype = frames, channel, shape, np.dtype(np.float32)

    def __getitem__(self, key: Any) -> Any:
        return indexing.explicit_indexing_adapter(key, self.shape, indexing.IndexingSupport.BASIC, self._basic)

    def _basic(self, key: tuple[Any, ...]) -> Any:
        step, space = key[0], key[1:]
        if isinstance(step, slice):
            steps = range(*step.indices(self.shape[0]))
            if not steps:
                return np.empty((0,) + self.shape[1:], np.float32)[(slice(None),) + space]
            return np.stack([_masked(self.frames.at(i), self.channel)[space] for i in steps])
        return _masked(self.frames.at(int(step)), self.channel)[space]


def open_series(
    scenario: Scenario,
    times: Times = "",
    quantities: str | Sequence[str] = (),
    *,
    chunks: Any = "auto",
    backend: str = "auto",
    threads: int = 0,
    allow_missing_terrain: bool = False,
) -> xarray.Dataset:
    """A scenario's field over time as a dataset of (time, z, y, x), float32, NaN below ground; computed when read.

    Coordinates are ``time`` (datetime64 if the scenario has an epoch, else s), ``z``, ``y``, ``x`` (m) and ``spatial_ref``;
    variables are the quantities, with units. Times are computed one after another, fastest in their order.

    :param times: as ``Scenario.times``
    :param quantities: empty: those of the scenario
    :param chunks: chunks for dask; "auto": one per time if dask is installed; None: without dask
    Raises UsageError for invalid times and a quantity that is given twice, InputError for quantities that the scenario cannot have.
    """
    times_s = scenario.times(times)
    names = distinct(quantities, "quantities")
    grid = scenario._handle.grid()
    options = {
        "backend": backend,
        "threads": threads,
        "quantities": names,
        "allow_missing_terrain": allow_missing_terrain,
        "move_tolerance_m": 0.0,  # values do not depend on what was computed before
    }
    frames = _Frames(scenario, times_s, options)
    shape = (len(times_s), *scenario.shape)
    variables = {
        name: xarray.Variable(
            ("time", "z", "y", "x"),
            indexing.LazilyIndexedArray(_SeriesArray(frames, name, shape)),
            _attributes(name, grid, scenario),
        )
        for name in scenario._handle.channels(names)
    }
    coordinates = _space(grid)
    coordinates["time"] = time_coordinate(times_s, scenario.epoch, ("time",))
    dataset = xarray.Dataset(variables, coordinates, _global_attributes(f"Field of {scenario.name}", grid))
    if chunks == "auto":
        try:
            import dask  # noqa: F401
        except ImportError:
            return dataset
        chunks = {"time": 1, "z": -1, "y": -1, "x": -1}
    return dataset if chunks is None else dataset.chunk(chunks)
