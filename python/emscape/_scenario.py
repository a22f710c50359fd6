"""Scenarios."""

from __future__ import annotations

import datetime
import json
import logging
import math
import os
from collections.abc import Iterable, Mapping, Sequence
from typing import Any, Union

from ._arguments import PathName, path_text, utf8
from ._errors import InputError, Problem, ScenarioError, UsageError
from ._native import native

Time = Union[float, str, datetime.datetime, datetime.timedelta]
"""A time: seconds since the epoch, a timedelta since it, or UTC as "2026-06-01T06:00:00Z" or a datetime with a time zone; numpy's
datetime64 (UTC) and timedelta64, too."""

Times = Union[Time, Sequence[Time]]
"""Times: "BEGIN:END:STEP", "BEGIN:END" (the scenario's step), one time, or an ascending sequence of times. An empty string: all steps
of the scenario's clock."""


def _plain(value: Any) -> Any:
    """A value that JSON lacks as one that it has; called by json.dumps. Raises TypeError or ValueError."""
    if isinstance(value, datetime.datetime):
        if value.utcoffset() is None:
            raise ValueError(f"the time {value} has no time zone; give one, such as tzinfo=datetime.timezone.utc")
        return value.astimezone(datetime.timezone.utc).replace(tzinfo=None).isoformat() + "Z"
    if isinstance(value, datetime.date):
        return value.isoformat()
    if isinstance(value, os.PathLike):
        return path_text(value)
    if hasattr(value, "tolist"):  # numpy's scalars and arrays
        import numpy as np

        if isinstance(value, (np.datetime64, np.ndarray)) and value.dtype.kind == "M":
            return np.datetime_as_string(value, unit="us", timezone="UTC").tolist()
        return value.tolist()
    raise TypeError(f"a {type(value).__name__} is no value; give None, a bool, number, text, path or time, or a list or dict of these")


def edit_texts(edits: Mapping[str, Any] | None) -> list[tuple[str, str]]:
    """Edits as (path, value); values are JSON, which is YAML. Raises UsageError, which names the path."""
    texts = []
    for path, value in (edits or {}).items():
        if not isinstance(path, str):
            raise UsageError(f"edit of {path!r}: a path is a text")
        try:
            text = json.dumps(value, ensure_ascii=False, default=_plain)
            (path + text).encode("utf-8")
        except UnicodeEncodeError as fault:
            raise UsageError(f"edit of {path!r}: {fault.object[fault.start]!r} is not a character of UTF-8") from None
        except (TypeError, ValueError, OverflowError) as fault:
            raise UsageError(f"edit of {path!r}: {fault}") from None
        texts.append((path, text))
    return texts


def utc_time(text: str) -> datetime.datetime | None:
    """The time of a UTC text "YYYY-MM-DDTHH:MM:SS[.fraction][Z]"; None if it has another form, or is empty."""
    whole, _, fraction = text.removesuffix("Z").partition(".")
    try:
        # Python 3.10 requires fractions of 3 or 6 digits.
        return datetime.datetime.fromisoformat(f"{whole}.{fraction[:6]:0<6}+00:00")
    except ValueError:
        return None


class Scenario:
    """A scenario: emitters, platforms, terrain and time. Immutable; ``with_set`` returns a changed copy.

    Made by ``load``, or by ``parse`` of a text or dict. It can be pickled: unpickling reads its file again and applies its edits;
    InputError if the file, or one that it names, has changed. A copy is the object itself.
    """

    __slots__ = ("_handle", "_text")

    def __init__(self, handle: native.Scenario, text: str | None = None) -> None:
        self._handle = handle
        self._text = text  # of a scenario that was not read from a file

    @property
    def name(self) -> str:
        """Name of the scenario."""
        return self._handle.name

    @property
    def file(self) -> str:
        """File from which it was read, an absolute path; of a parsed text the name that was given to it."""
        return self._handle.file

    @property
    def hash(self) -> str:
        """FNV-1a hash (64 bits, hex) of its text with the edits, and of the files that it names."""
        return self._handle.hash

    @property
    def epoch(self) -> datetime.datetime | None:
        """Time 0 (UTC); None if the scenario has no epoch."""
        return utc_time(self._handle.epoch_utc)

    @property
    def duration_s(self) -> float:
        """Length of the scenario's clock (s)."""
        return self._handle.duration_s

    @property
    def step_s(self) -> float:
        """Step of the scenario's clock (s)."""
        return self._handle.step_s

    @property
    def shape(self) -> tuple[int, int, int]:
        """Voxels along (z, y, x): the shape of a field's arrays."""
        x, y, z = self._handle.dims
        return z, y, x

    @property
    def size_m(self) -> tuple[float, float, float]:
        """Size of the region along x (east), y (north) and z (up), in metres."""
        return self._handle.size_m

    @property
    def quantities(self) -> list[str]:
        """Names of the scenario's output quantities; each ends in its unit."""
        return self._handle.quantities

    @property
    def emitters(self) -> list[str]:
        """Names of the emitters, in the order of the file."""
        return self._handle.emitters

    @property
    def platforms(self) -> list[str]:
        """Names of the platforms, in the order of the file."""
        return self._handle.platforms

    @property
    def receivers(self) -> list[str]:
        """Names of the receivers on platforms, in the order of the file."""
        return self._handle.receivers

    @property
    def targets(self) -> list[str]:
        """Names of the targets, in the order of the file."""
        return self._handle.targets

    @property
    def edits(self) -> dict[str, str]:
        """Changes by ``with_set`` since the file was read: path to value (YAML)."""
        return dict(self._handle.edits)

    @property
    def files(self) -> list[str]:
        """The files from which it was read: its own, tracks, antennas, elevation."""
        return self._handle.files

    def times(self, times: Times = "") -> list[float]:
        """Times as a list of seconds since the epoch.

        Raises UsageError for invalid times, such as ones beyond 1e9 s, and UTC without an epoch.
        """
        if isinstance(times, str):
            return self._handle.times(times)
        if isinstance(times, (bytes, bytearray)):  # sequences of numbers
            raise UsageError(f"times: {times!r} is not a number of seconds")
        items: Any = times  # numpy's arrays and numbers, too
        try:
            items = list(items)
        except TypeError:
            items = [items]
        values: list[float] = []
        for item in items:
            time_s = self._seconds(item, "times")
            if values and time_s <= values[-1]:
                raise UsageError(f"times: {time_s} s follows {values[-1]} s; times must be ascending")
            values.append(time_s)
        if not values:
            raise UsageError("times: the sequence is empty; give at least one time")
        for extreme_s in (values[0], values[-1]):
            self._handle.times(repr(extreme_s))  # checks the range
        return values

    def _seconds(self, time: Any, argument: str = "time_s") -> float:
        """A time as seconds since the epoch. Raises UsageError, which names the argument."""
        if isinstance(time, str):
            values = self._handle.times(time or "-")  # an empty text would be all times
            if len(values) != 1:
                raise UsageError(f"{argument}: '{time}' is not a single time")
            return values[0]
        kind = getattr(getattr(time, "dtype", None), "kind", "")
        if isinstance(time, datetime.datetime) or kind == "M":
            try:
                return self._seconds(_plain(time) if kind != "M" else str(time.astype("datetime64[us]")) + "Z", argument)
            except ValueError as fault:
                if isinstance(fault, UsageError):
                    raise
                raise UsageError(f"{argument}: {fault}") from None
        if isinstance(time, datetime.timedelta):
            return time.total_seconds()
        try:
            seconds = float(time.astype("timedelta64[ns]").astype("int64")) / 1e9 if kind == "m" else float(time)
        except (TypeError, ValueError, OverflowError):
            seconds = math.nan
        if not math.isfinite(seconds):
            raise UsageError(f"{argument}: '{time}' is not a number of seconds")
        return seconds

    def positions(self, time_s: Time = 0.0) -> dict[str, tuple[float, float, float]]:
        """Positions of the platforms at a time: name to (latitude deg, longitude deg, height above mean sea level m).

        Platforms that are absent, before and after their tracks, are left out.
        """
        return dict(self._handle.positions(self._seconds(time_s)))

    def with_set(self, edits: Mapping[str, Any]) -> Scenario:
        """Returns a scenario with other values; this one is not changed.

        Paths are those of the command line's ``--set``: keys of the scenario format separated by dots, items of lists by name or
        index: ``{"emitters.jammer.power_w": 500, "region.dims": [100, 100, 50]}``. None removes an optional key.
        Times are datetimes with a time zone, or numpy's datetime64, which are UTC. The result is checked after all edits.

        Raises ScenarioError, whose location is the edit; UsageError for a value that no scenario can have, such as a range.
        """
        return _checked(*self._handle.edit(edit_texts(edits)), text=self._text)

    def save(self, file: PathName) -> None:
        """Writes the scenario's text with its edits; comments and order are kept.

        Raises OtherError if the file cannot be written.
        """
        self._handle.save(path_text(file))

    def __repr__(self) -> str:
        z, y, x = self.shape
        return f"<emscape.Scenario {self.name!r}: {x} x {y} x {z} voxels, {len(self.emitters)} emitters, {self.duration_s:g} s>"

    def __copy__(self) -> Scenario:
        return self

    def __deepcopy__(self, _: dict[int, Any]) -> Scenario:
        return self

    def __reduce__(self) -> tuple[Any, ...]:
        return _unpickled, (self.file, self._handle.edits, self.hash, self._text)


_MAX_TOLD = 10000
_told: set[tuple[str, str]] = set()
"""Files and their warnings that were logged: each is logged once in a process."""


def _checked(
    handle: native.Scenario | None, rows: Iterable[tuple[str, int, int, str, str]], text: str | None = None
) -> Scenario:
    """A scenario that was read; logs its warnings that are new. Raises ScenarioError for its errors."""
    errors = []
    for file, line, column, severity, message in rows:
        if severity == "error":
            errors.append(Problem(file, line, column, message))
        elif (file, message) not in _told:
            if len(_told) < _MAX_TOLD:
                _told.add((file, message))
            logging.getLogger("emscape").warning("%s:%d:%d: %s", file, line, column, message)
    if handle is None:
        raise ScenarioError(errors)
    return Scenario(handle, text)


def _load_text(file: str, edits: list[tuple[str, str]]) -> Scenario:
    return _checked(*native.load(file, edits))


def _unpickled(file: str, edits: list[tuple[str, str]], expected_hash: str, text: str | None = None) -> Scenario:
    scenario = _load_text(file, edits) if text is None else _checked(*native.load_text(file, text, edits), text=text)
    if scenario.hash != expected_hash:
        raise InputError("has changed since the pickled scenario was loaded from it", file)
    return scenario


def load(file: PathName, edits: Mapping[str, Any] | None = None) -> Scenario:
    """Reads a scenario (YAML or JSON) and the files that it names; elevation files are read when needed.

    A relative name is resolved now: the scenario does not depend on the current folder later, nor in another process.

    :param edits: as for ``Scenario.with_set``
    Raises ScenarioError, whose ``problems`` lists all errors with file, line and column.
    """
    text = path_text(file)
    if not os.path.isabs(text):
        text = os.path.join(os.getcwd(), text)
    return _load_text(text, edit_texts(edits))


def path_step(name: str) -> str:
    """A name as an element of an edit path, quoted if necessary, as in ``emitters."a=b".power_w``."""
    return native.path_step(name)


def parse(
    source: str | Mapping[str, Any], *, folder: PathName = ".", name: str = "", edits: Mapping[str, Any] | None = None
) -> Scenario:
    """Reads a scenario from a text (YAML or JSON) or a dict, without a file of its own.

    :param source: the text, or a dict with the keys of the scenario format; times as for ``Scenario.with_set``
    :param folder: where relative names of tracks, antennas and elevation files begin
    :param name: of the text, in messages; empty: scenario.yaml, of a dict scenario.json
    :param edits: as for ``Scenario.with_set``
    Raises ScenarioError, whose ``problems`` lists all errors with line and column; UsageError for a value that no scenario can have.
    """
    if isinstance(source, str):
        text, own_name = source, "scenario.yaml"
    elif isinstance(source, Mapping):
        try:
            text, own_name = json.dumps(dict(source), ensure_ascii=False, indent=1, default=_plain), "scenario.json"
        except (TypeError, ValueError, OverflowError) as fault:
            raise UsageError(f"source: {fault}") from None
    else:
        raise UsageError(f"source: a {type(source).__name__} is no scenario; give a text or a dict, or a file's name to load()")
    file = os.path.join(os.path.abspath(path_text(folder)), name or own_name)
    return _checked(*native.load_text(file, utf8(text), edit_texts(edits)), text=text)
