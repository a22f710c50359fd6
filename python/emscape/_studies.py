"""What-if analysis and explanations. Results are the JSON of the subcommands of the same names."""

from __future__ import annotations

import json
import os
import tempfile
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

from ._arguments import PathName, distinct, listed, path_text
from ._errors import UsageError
from ._native import native
from ._progress import Progress, callback
from ._scenario import Scenario, Time, Times, edit_texts
from ._worker import worker_command

if TYPE_CHECKING:
    import xarray

Json = dict[str, Any]


def _read(text: str) -> Json:
    result: Json = json.loads(text)
    return result


def _times(scenario: Scenario, times: Times | None, usual: str = "") -> list[float]:
    return scenario.times(usual if times is None else times)


def profile(
    scenario: Scenario,
    emitter: str,
    to: tuple[float, float, float],
    *,
    agl: bool = False,
    time_s: Time = 0.0,
    models: str | Sequence[str] = (),
) -> Json:
    """Explains one path, term by term, from the transmitter's power to the power density at a point.

    :param to: latitude (deg), longitude (deg), height (m above mean sea level, with ``agl`` above the ground)
    :param models: propagation models to compare with the emitter's own
    :return: geometry, terms, obstacles and ``verdict``, a sentence that states the dominant cause; lengths in m, angles in deg
    Raises UsageError for an unknown emitter or a point outside the earth, InputError for one below ground.
    """
    try:
        numbers = [float(value) for value in to]
    except (TypeError, ValueError):
        numbers = []
    if len(numbers) != 3 or isinstance(to, (str, bytes)):
        raise UsageError(f"to: {to!r} is not (latitude, longitude, height), three numbers")
    latitude_deg, longitude_deg, height_m = numbers
    return _read(native.profile(scenario._handle, emitter, (latitude_deg, longitude_deg, height_m), agl, scenario._seconds(time_s), listed(models)))


def link(
    scenario: Scenario,
    *,
    emitters: str | Sequence[str] = (),
    receivers: str | Sequence[str] = (),
    targets: str | Sequence[str] = (),
    times: Times | None = None,
    model: str = "",
    progress: Progress = None,
) -> Json:
    """Signals of emitters at receivers, and detection of targets by radars, over time.

    :param times: as ``Scenario.times``; None: the scenario's clock
    :return: ``links`` and ``detections``, each with rows by time (powers in dBm, ratios in dB)
    """
    names = (listed(emitters), listed(receivers), listed(targets))
    return _read(native.link(scenario._handle, *names, _times(scenario, times), model, callback(progress)))


def exposure(
    scenario: Scenario,
    platform: str,
    *,
    quantity: str = "detection_probability",
    threshold: float | None = None,
    times: Times | None = None,
    look: str = "target",
    rcs_target: str = "",
    backend: str = "auto",
    progress: Progress = None,
) -> Json:
    """Exposure of a platform along its track, by time and emitter.

    :param threshold: in the quantity's unit; None: the usual one
    :param times: as ``Scenario.times``; None: the scenario's clock
    :param look: "target": beams point at the platform; "scan": beams point along the scans
    :param rcs_target: target whose cross section radars see; "none": the one assumed by each radar
    :return: ``rows`` by time (position in deg and m, value of each emitter), ``each`` and ``together`` over all times
    """
    times_s = _times(scenario, times)
    return _read(
        native.exposure(
            scenario._handle, platform, quantity, threshold, times_s, look, rcs_target, backend, callback(progress)
        )
    )


def vertical(
    scenario: Scenario,
    emitter: str,
    azimuths_deg: Sequence[float],
    *,
    quantity: str = "",
    threshold: float | None = None,
    time_s: Time = 0.0,
    height_axis: str = "msl",
    blake: bool = False,
    range_m: float | None = None,
    max_height_m: float | None = None,
    backend: str = "auto",
    progress: Progress = None,
) -> xarray.Dataset:
    """Vertical coverage of an emitter: a quantity over range and height at given azimuths. Needs xarray.

    :param azimuths_deg: clockwise from true north
    :param height_axis: heights above mean sea level ("msl") or ground ("agl")
    :param blake: use a smooth earth instead of the terrain
    :param range_m: ground range of the right edge; None: the instrumented range, or that of the region's edge
    :return: the quantity (azimuth, height, range), NaN below ground, and ``ground_msl`` (azimuth, range) in m; attributes are
        numbers and texts: station, threshold, warnings (a list as JSON), and in ``azimuths``, as JSON, the output of
        ``emscape vertical --json`` for each azimuth, including contours (range m, height m)
    """
    import numpy as np
    import xarray

    from ._arrays import udunit_of

    result = _read(
        native.vertical(
            scenario._handle,
            emitter,
            [float(azimuth_deg) for azimuth_deg in listed(azimuths_deg)],
            quantity,
            threshold,
            scenario._seconds(time_s),
            height_axis,
            blake,
            range_m,
            max_height_m,
            backend,
            callback(progress),
        )
    )
    height = next(key for key in result if key.startswith("height_"))
    cuts = result.pop("azimuths")
    ranges, heights = result.pop("range_m"), result.pop(height)
    result.pop("order")
    values = np.array([cut.pop("values") for cut in cuts], np.float32).reshape(len(cuts), len(heights), len(ranges))
    ground = [cut.pop("ground_msl_m") for cut in cuts]
    variables: dict[Any, Any] = {
        result["quantity"]: (("azimuth", height, "range"), values, {"units": udunit_of(result["unit"])}),
    }
    if all(len(row) == len(ranges) for row in ground):
        variables["ground_msl"] = (("azimuth", "range"), np.array(ground, np.float32), {"units": "m"})
    return xarray.Dataset(
        variables,
        {
            "azimuth": ("azimuth", [cut["azimuth_deg"] for cut in cuts], {"units": "degree"}),
            height: (height, heights, {"units": "m"}),
            "range": ("range", ranges, {"units": "m", "long_name": "range over the ground"}),
        },
        {name: _attribute(value) for name, value in {**result, "azimuths": cuts}.items() if value is not None},
    )


def _attribute(value: Any) -> str | int | float:
    """A JSON value as an attribute that netCDF files can have: flags as 0 or 1, lists and objects as JSON texts."""
    if isinstance(value, (str, int, float)):
        return int(value) if isinstance(value, bool) else value
    return json.dumps(value, ensure_ascii=False)


def compare(
    a: Scenario,
    b: Scenario,
    output: PathName | None = None,
    *,
    heights: str = "agl:150",
    products: str | Sequence[str] = (),
    quantity: str = "detection_probability",
    threshold: float | None = None,
    times: Times | None = None,
    cell_m: float | None = None,
    area: str = "",
    crs: str = "utm",
    formats: str | Sequence[str] = (),
    explain: int | None = None,
    backend: str = "auto",
    progress: Progress = None,
) -> Json:
    """Gains and losses of the second scenario against the first: maps, figures and explanations.

    :param output: folder for the maps and the report; None: they are not kept
    :param heights: this and the other parameters of maps: as for ``coverage``
    :param formats: of the maps in the folder
    :param explain: number of explained areas of gain, and of loss
    :return: report.json of the folder: areas in km2, differences, changed areas with the decisive paths
    """
    with tempfile.TemporaryDirectory() as folder:
        return _read(
            native.compare(
                a._handle,
                b._handle,
                path_text(output) if output is not None else os.path.join(folder, "compare"),
                heights,
                distinct(products, "products"),
                quantity,
                threshold,
                _times(a, times, "0"),
                cell_m,
                area,
                crs,
                listed(formats) or (["cog"] if output is None else []),
                3 if explain is None else explain,
                backend,
                callback(progress),
            )
        )


def study(
    file: PathName,
    output: PathName,
    *,
    jobs: int = 1,
    resume: bool = False,
    edits: Mapping[str, Any] | None = None,
    backend: str = "auto",
    progress: Progress = None,
) -> Json:
    """Measures many variants of a scenario; writes results.csv, results.nc and report.html into the folder.

    :param file: the study (YAML or JSON)
    :param jobs: processes that compute at the same time
    :param resume: computes only the missing parts
    :param edits: of the scenario, applied before those of the variants
    :return: numbers of variants and parts, and the extremes of each measure
    """
    of = (path_text(file), edit_texts(edits), path_text(output))
    return _read(native.study(*of, jobs, resume, backend, worker_command(*of, backend), callback(progress)))


def check(folder: PathName) -> Json:
    """Compares the propagation models with a folder of reference figures.

    :return: ``datasets`` with the largest difference, tolerance and unit of each, and ``pass``
    """
    return _read(native.check(path_text(folder)))


def simulate(
    scenario: Scenario,
    output: PathName,
    formats: str | Sequence[str] = ("vdb",),
    *,
    times: Times | None = None,
    quantities: str | Sequence[str] = (),
    resume: bool = False,
    force: bool = False,
    backend: str = "auto",
    progress: Progress = None,
) -> Json:
    """Writes a scenario's field over time as files into a folder.

    A folder that holds a series is refused, unless ``resume`` continues the series or ``force`` replaces it.

    :param formats: "vdb", "nvdb", "vti", "raw"
    :param times: as ``Scenario.times``; None: the scenario's clock
    :return: what ``emscape simulate --json`` prints
    """
    if resume and force:
        raise UsageError("resume and force exclude each other")
    return _read(
        native.simulate(
            scenario._handle,
            path_text(output),
            listed(formats),
            _times(scenario, times),
            distinct(quantities, "quantities"),
            resume,
            force,
            backend,
            callback(progress),
        )
    )
