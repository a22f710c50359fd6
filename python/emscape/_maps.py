"""Coverage maps as labelled arrays."""

from __future__ import annotations

import logging
from collections.abc import Hashable, Sequence
from typing import Any, overload

import numpy as np
import xarray

from ._arguments import distinct
from ._arrays import CONVENTIONS, NO_FILL, flags, time_coordinate, udunit_of, wkt_crs
from ._errors import UsageError
from ._native import native
from ._progress import Progress, callback
from ._scenario import Scenario, Times

_HEIGHTS = {
    "agl": {"standard_name": "height", "long_name": "height above ground", "units": "m", "positive": "up", "axis": "Z"},
    "msl": {
        "standard_name": "altitude",
        "long_name": "height above mean sea level (EGM96)",
        "units": "m",
        "positive": "up",
        "axis": "Z",
    },
}


@overload
def coverage(
    scenario: Scenario,
    heights: str = ...,
    product: str = ...,
    *,
    quantity: str = ...,
    threshold: float | None = ...,
    times: Times = ...,
    cell_m: float | None = ...,
    area: str = ...,
    crs: str = ...,
    backend: str = ...,
    progress: Progress = ...,
) -> xarray.DataArray: ...


@overload
def coverage(
    scenario: Scenario,
    heights: str = ...,
    product: Sequence[str] = ...,
    *,
    quantity: str = ...,
    threshold: float | None = ...,
    times: Times = ...,
    cell_m: float | None = ...,
    area: str = ...,
    crs: str = ...,
    backend: str = ...,
    progress: Progress = ...,
) -> xarray.Dataset: ...


def coverage(
    scenario: Scenario,
    heights: str = "agl:150",
    product: str | Sequence[str] = "covered",
    *,
    quantity: str = "detection_probability",
    threshold: float | None = None,
    times: Times = 0.0,
    cell_m: float | None = None,
    area: str = "",
    crs: str = "utm",
    backend: str = "auto",
    progress: Progress = None,
) -> xarray.DataArray | xarray.Dataset:
    """Coverage maps at heights above ground or sea level, as computed by ``emscape coverage``.

    A position is covered if the quantity is at or above the threshold; radars look at the target, wherever their scan points.

    :param heights: "agl:30,150;msl:1000:3000:500" (m)
    :param product: a name, or a sequence of names; ``products()`` lists them
    :param quantity: a quantity of the field
    :param threshold: in the quantity's unit; None: the quantity's default
    :param times: as ``Scenario.times``
    :param cell_m: side of a pixel (m); None: side of a voxel
    :param area: "LATITUDE,LONGITUDE,RADIUS_M" or "bbox:WEST,SOUTH,EAST,NORTH" (deg); empty: the scenario's region
    :param crs: "utm", "local" (azimuthal equidistant) or "EPSG:NUMBER"
    :return: for a single name a DataArray (time, height, y, x), float32, NaN where there is no value; a single time or height is a
        scalar coordinate. For a sequence of names a Dataset of such arrays, named PRODUCT_agl and PRODUCT_msl if heights are above
        ground and above sea level. The projection is in ``spatial_ref``; with rioxarray imported, ``.rio.crs``
    Raises UsageError, InputError and DeviceError, as on the command line.
    """
    if not isinstance(heights, str):
        raise UsageError(f'heights: {heights!r} is not a text such as "agl:150" or "agl:30,150;msl:1000:3000:500" (m)')
    names = [product] if isinstance(product, str) else distinct(product, "product")
    if not names:
        raise UsageError("product: the sequence is empty; give at least one name")
    maps, grid, warnings = native.coverage(
        scenario._handle,
        heights,
        names,
        quantity,
        threshold,
        scenario.times(times),
        cell_m,
        area,
        crs,
        backend,
        callback(progress),
    )
    for warning in warnings:
        logging.getLogger("emscape").warning("%s", warning)
    dataset = _dataset_of(maps, grid, scenario)
    if not isinstance(product, str):
        return dataset
    if len(dataset.data_vars) > 1:
        raise UsageError("heights above ground and above sea make two arrays: give the product in a list")
    return dataset[next(iter(dataset.data_vars))]


def _dataset_of(maps: list[dict[str, Any]], grid: dict[str, Any], scenario: Scenario) -> xarray.Dataset:
    references = {described["height"][0] for described in maps if "height" in described}
    groups: dict[str, list[dict[str, Any]]] = {}
    for described in maps:
        ending = f"_{described['height'][0]}" if "height" in described and len(references) > 1 else ""
        groups.setdefault(described["name"] + ending, []).append(described)
    step_m = grid["cell_m"]
    coordinates: dict[Hashable, Any] = {
        "x": xarray.Variable(
            "x",
            grid["left_m"] + (np.arange(grid["width"]) + 0.5) * step_m,
            {"standard_name": "projection_x_coordinate", "long_name": "easting", "units": "m", "axis": "X"},
            NO_FILL,
        ),
        "y": xarray.Variable(
            "y",
            grid["top_m"] - (np.arange(grid["height"]) + 0.5) * step_m,
            {"standard_name": "projection_y_coordinate", "long_name": "northing", "units": "m", "axis": "Y"},
            NO_FILL,
        ),
        "spatial_ref": wkt_crs(grid["wkt"]),
    }
    arrays = {name: _array_of(group, coordinates, scenario) for name, group in groups.items()}
    return xarray.Dataset(arrays, attrs={**CONVENTIONS, "title": f"Coverage of {scenario.name}"})


def _array_of(group: list[dict[str, Any]], coordinates: dict[Hashable, Any], scenario: Scenario) -> xarray.DataArray:
    """The maps of one product as an array."""
    first = group[0]
    times_s = sorted({described["time_s"] for described in group if "time_s" in described})
    heights = sorted({described["height"][1] for described in group if "height" in described})
    values = np.full((len(times_s) or 1, len(heights) or 1, *first["values"].shape), np.nan, np.float32)
    for described in group:
        t = times_s.index(described["time_s"]) if times_s else 0
        h = heights.index(described["height"][1]) if heights else 0
        values[t, h] = described["values"]
    attributes: dict[str, Any] = {"long_name": first["description"].split(" at ")[0], "grid_mapping": "spatial_ref"}
    if first["kind"] in ("classes", "category"):
        attributes |= flags(first["labels"], none=first["kind"] == "category")
    else:
        attributes["units"] = udunit_of(first["unit"])
    # Each array's coordinates have unique names, so that arrays with different times and heights fit into one dataset.
    own = dict(coordinates)
    dims = ["time", "height", "y", "x"]
    if times_s:
        own["time"] = time_coordinate(times_s, scenario.epoch, ("time",))
    if heights:
        reference = first["height"][0]
        dims[1] = f"height_{reference}"
        own[dims[1]] = xarray.Variable(dims[1], heights, _HEIGHTS[reference], NO_FILL)
    array = xarray.DataArray(values, own, dims, attrs=attributes)
    squeezed: xarray.DataArray = array.squeeze([name for name in dims[:2] if array.sizes[name] == 1])
    squeezed.encoding["_FillValue"] = np.float32("nan")  # the nodata of files that rioxarray writes
    return squeezed


def products() -> list[str]:
    """Names of the products of ``coverage``."""
    return native.product_names()
