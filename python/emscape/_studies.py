"""The command line's subcommands for what-if analysis and explanation as functions. Results are the command line's JSON."""

from __future__ import annotations

import json
import os
import tempfile
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any, Union

from ._arguments import PathName, listed, path_text, utf8
from ._errors import InputError, UsageError
from ._native import native
from ._progress import Progress, callback
from ._scenario import Scenario, Times, _checked, edit_texts, set_words

if TYPE_CHECKING:
    import xarray

Json = dict[str, Any]
_Option = Union[str, float, bool, list[Any], None]


def command(*arguments: PathName, progress: Progress = None) -> Any:
    """Runs a subcommand in this process and returns the JSON that ``emscape SUBCOMMAND ... --json`` prints.

    :param arguments: words of the command line, texts or paths: ``command("info", "out/jacksboro_0001.vdb")``. Not "view",
        whose window is a program of its own: ``python -m emscape view``
    Raises UsageError for arguments that cannot be parsed, otherwise the Error of the command's exit status. A failed check is a
    result, not an error.
    """
    words = []
    for argument in arguments:
        if not isinstance(argument, (str, bytes, os.PathLike)):
            raise UsageError(f"command: {argument!r} is neither a text nor a path; give each word as an argument of its own")
        words.append(utf8(argument) if isinstance(argument, str) else path_text(argument))
    _, text = native.command(words, callback(progress))
    return json.loads(text) if text.strip() else None


def _options(options: Mapping[str, _Option]) -> list[str]:
    """Options of the command line; None, False and empty texts are omitted. A list gives an option per item, because items may
    have commas."""
    words: list[str] = []
    for name, value in options.items():
        if value is True:
            words.append("--" + name)
        elif value is not None and value is not False and value != "":
            for item in value if isinstance(value, list) else [value]:
                words.append(f"--{name}=" + (item if isinstance(item, str) else repr(float(item))))
    return words


def _times(scenario: Scenario, times: Times | None) -> str | None:
    """Times in the command line's syntax, which requires even spacing."""
    if times is None or isinstance(times, str):
        return times
    values = scenario.times(times)
    if len(values) == 1:
        return repr(values[0])
    import numpy as np

    step, rounding = values[1] - values[0], 1e-9
    dtype = np.asarray(times).dtype
    if dtype.kind == "f" and dtype.itemsize < 8:  # rounded to fewer digits
        step, rounding = (values[-1] - values[0]) / (len(values) - 1), 2 * float(np.finfo(dtype).eps)
    for i, value in enumerate(values):
        if abs(values[0] + i * step - value) > rounding * max(1.0, abs(values[0]), abs(values[-1])):
            raise UsageError(f"times: {value} s is not in steps of {step} s; give evenly spaced times or a text BEGIN:END:STEP")
    return f"{values[0]!r}:{values[-1]!r}:{step!r}"


def _subject(scenario: Scenario) -> list[str]:
    """A scenario as arguments: its file, which must not have changed since it was loaded, and its edits."""
    edits = scenario._handle.edits
    current, rows = native.load(scenario.file, edits)
    # Without the warnings, which the command logs.
    if _checked(current, [row for row in rows if row[3] == "error"]).hash != scenario.hash:
        raise InputError("has changed since the scenario was loaded from it", scenario.file)
    return [scenario.file, *set_words(edits)]


def _run(verb: str, scenario: Scenario, options: Mapping[str, _Option], progress: Progress) -> Any:
    return command(verb, *_subject(scenario), *_options(options), progress=progress)


def _run_into_file(verb: str, scenario: Scenario, options: Mapping[str, _Option], progress: Progress) -> Json:
    """The contents of a JSON file that a subcommand writes."""
    with tempfile.TemporaryDirectory() as folder:
        file = os.path.join(folder, verb + ".json")
        _run(verb, scenario, {**options, "output": file}, progress)
        with open(file, encoding="utf-8") as stream:
            result: Json = json.load(stream)
            return result


def profile(
    scenario: Scenario,
    emitter: str,
    to: tuple[float, float, float],
    *,
    agl: bool = False,
    time_s: float = 0.0,
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
    place = ",".join(map(repr, numbers))
    options: dict[str, _Option] = {"emitter": emitter, "to": place, "agl": agl, "time": time_s, "model": listed(models)}
    result: Json = _run("profile", scenario, options, None)
    return result


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
    options: dict[str, _Option] = {"emitter": listed(emitters), "receiver": listed(receivers), "target": listed(targets)}
    options |= {"times": _times(scenario, times), "model": model}
    result: Json = _run("link", scenario, options, progress)
    return result


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
    options: dict[str, _Option] = {"platform": platform, "quantity": quantity, "threshold": threshold, "look": look}
    options |= {"times": _times(scenario, times), "rcs-target": rcs_target, "backend": backend}
    return _run_into_file("exposure", scenario, options, progress)


def vertical(
    scenario: Scenario,
    emitter: str,
    azimuths_deg: Sequence[float],
    *,
    quantity: str = "",
    threshold: float | None = None,
    time_s: float = 0.0,
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

    options: dict[str, _Option] = {"emitter": emitter, "azimuth": listed(azimuths_deg), "quantity": quantity}
    options |= {"threshold": threshold, "time": time_s, "height-axis": height_axis, "blake": blake, "range": range_m}
    options |= {"max-height": max_height_m, "backend": backend}
    result = _run_into_file("vertical", scenario, options, progress)
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
    options: dict[str, _Option] = {"heights": heights, "products": listed(products), "quantity": quantity}
    options |= {"threshold": threshold, "times": _times(a, times), "cell": cell_m, "area": area, "crs": crs}
    options |= {"format": listed(formats), "explain": str(explain) if explain is not None else None, "backend": backend}
    with tempfile.TemporaryDirectory() as folder:
        options["output"] = path_text(output) if output is not None else os.path.join(folder, "compare")
        if output is None and not formats:
            options["format"] = ["cog"]
        result: Json = command("compare", *_subjects(a, b, folder), *_options(options), progress=progress)
        return result


def _subjects(a: Scenario, b: Scenario, folder: str) -> list[str]:
    """Two scenarios as arguments of ``compare``, whose --set changes both and whose --set-b changes the second.

    :param folder: for copies of scenarios that the options cannot express
    """
    words = _subject(a)
    _subject(b)
    common, own = a._handle.edits, list(b._handle.edits)
    for edit in common:
        if own[:1] != [edit]:
            break
        del own[0]
    both, _ = native.load(b.file, common + own)
    if both is None or both.hash != b.hash:
        words = [os.path.join(folder, name) for name in ("a.yaml", "b.yaml")]
        a.save(words[0])
        b.save(words[1])
        return words
    if a.file != b.file or not own:
        words.append(b.file)
    for path, value in own:
        words += ["--set-b", f"{path}={value}"]
    return words


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
    words = ["study", path_text(file), *set_words(edit_texts(edits))]
    options: dict[str, _Option] = {"output": path_text(output), "jobs": str(jobs), "resume": resume, "backend": backend}
    result: Json = command(*words, *_options(options), progress=progress)
    return result


def check(folder: PathName) -> Json:
    """Compares the propagation models with a folder of reference figures.

    :return: ``datasets`` with the largest difference, tolerance and unit of each, and ``pass``
    """
    result: Json = command("check", path_text(folder))
    return result


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
) -> Any:
    """Writes a scenario's field over time as files into a folder.

    A folder that holds a series is refused, unless ``resume`` continues the series or ``force`` replaces it.

    :param formats: "vdb", "nvdb", "vti", "raw"
    :param times: as ``Scenario.times``; None: the scenario's clock
    :return: what ``emscape simulate --json`` prints
    """
    options: dict[str, _Option] = {"output": path_text(output), "format": listed(formats), "quantity": listed(quantities)}
    options |= {"times": _times(scenario, times), "resume": resume, "force": force, "backend": backend}
    return _run("simulate", scenario, options, progress)
