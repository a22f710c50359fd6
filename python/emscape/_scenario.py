"""Scenarios."""

from __future__ import annotations

import datetime
import json
import logging
import math
import os
from collections.abc import Iterable, Mapping, Sequence
from typing import Any, Union

from ._errors import InputError, Problem, ScenarioError, UsageError
from ._native import native

Times = Union[str, float, Sequence[float]]
"""Times in seconds since the epoch: "BEGIN:END:STEP", "BEGIN:END" (the scenario's step), one number, or an ascending sequence of
numbers. An empty string: all steps of the scenario's clock."""


def listed(names: str | Sequence[Any]) -> list[Any]:
    """Names as a list; a text is one name, an empty text none."""
    if isinstance(names, str):
        return [names] if names else []
    return list(names)


def _yaml(value: Any) -> str:
    """A value as the text of an edit: JSON, which is YAML."""
    if isinstance(value, (datetime.datetime, datetime.date)):
        return json.dumps(value.isoformat())
    if hasattr(value, "tolist"):  # numpy's scalars and arrays
        value = value.tolist()
    return json.dumps(value, ensure_ascii=False)


class Scenario:
    """A scenario: emitters, platforms, terrain and time. Immutable; ``with_set`` returns a changed copy.

    Made by ``load``. It can be pickled: unpickling reads its file again and applies its edits; InputError if the file, or one
    that it names, has changed. A copy is the object itself.
    """

    __slots__ = ("_handle",)

    def __init__(self, handle: native.Scenario) -> None:
        self._handle = handle

    @property
    def name(self) -> str:
        """Name of the scenario."""
        return self._handle.name

    @property
    def file(self) -> str:
        """File from which it was read."""
        return self._handle.file

    @property
    def hash(self) -> str:
        """FNV-1a hash (64 bits, hex) of its text with the edits, and of the files that it names."""
        return self._handle.hash

    @property
    def epoch(self) -> datetime.datetime | None:
        """Time 0 (UTC); None if the scenario has no epoch."""
        text = self._handle.epoch_utc
        return datetime.datetime.fromisoformat(text.replace("Z", "+00:00")) if text else None

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

        Raises UsageError for invalid times.
        """
        if isinstance(times, str):
            return self._handle.times(times)
        items: Any = times  # numpy's arrays and numbers, too
        try:
            items = list(items)
        except TypeError:
            items = [items]
        values: list[float] = []
        for item in items:
            try:
                time_s = float(item)
            except (TypeError, ValueError, OverflowError):
                time_s = math.nan
            if not math.isfinite(time_s):
                raise UsageError(f"times: '{item}' is not a number of seconds")
            if values and time_s <= values[-1]:
                raise UsageError(f"times: {time_s} s follows {values[-1]} s; times must be ascending")
            values.append(time_s)
        if not values:
            raise UsageError("times: the sequence is empty; give at least one time")
        return values

    def positions(self, time_s: float = 0.0) -> dict[str, tuple[float, float, float]]:
        """Positions of all platforms at a time (s): name to (latitude deg, longitude deg, height above mean sea level m)."""
        return dict(self._handle.positions(time_s))

    def with_set(self, edits: Mapping[str, Any]) -> Scenario:
        """Returns a scenario with other values; this one is not changed.

        Paths are those of the command line's ``--set``: keys of the scenario format separated by dots, items of lists by name or
        index: ``{"emitters.jammer.power_w": 500, "region.dims": [100, 100, 50]}``. None removes an optional key.
        The result is checked after all edits.

        Raises ScenarioError; the location of an error is the edit.
        """
        return _checked(*self._handle.edit([(path, _yaml(value)) for path, value in edits.items()]))

    def save(self, file: str | os.PathLike[str]) -> None:
        """Writes the scenario's text with its edits; comments and order are kept.

        Raises OtherError if the file cannot be written.
        """
        self._handle.save(os.fspath(file))

    def __repr__(self) -> str:
        z, y, x = self.shape
        return f"<emscape.Scenario {self.name!r}: {x} x {y} x {z} voxels, {len(self.emitters)} emitters, {self.duration_s:g} s>"

    def __copy__(self) -> Scenario:
        return self

    def __deepcopy__(self, _: dict[int, Any]) -> Scenario:
        return self

    def __reduce__(self) -> tuple[Any, ...]:
        return _unpickled, (self.file, self._handle.edits, self.hash)


def _checked(handle: native.Scenario | None, rows: Iterable[tuple[str, int, int, str, str]]) -> Scenario:
    errors = []
    for file, line, column, severity, message in rows:
        if severity == "error":
            errors.append(Problem(file, line, column, message))
        else:
            logging.getLogger("emscape").warning("%s:%d:%d: %s", file, line, column, message)
    if handle is None:
        raise ScenarioError(errors)
    return Scenario(handle)


def _load_text(file: str, edits: list[tuple[str, str]]) -> Scenario:
    return _checked(*native.load(file, edits))


def _unpickled(file: str, edits: list[tuple[str, str]], expected_hash: str) -> Scenario:
    scenario = _load_text(file, edits)
    if scenario.hash != expected_hash:
        raise InputError("has changed since the pickled scenario was loaded from it", file)
    return scenario


def load(file: str | os.PathLike[str], edits: Mapping[str, Any] | None = None) -> Scenario:
    """Reads a scenario (YAML or JSON) and the files that it names; elevation files are read when needed.

    :param edits: as for ``Scenario.with_set``
    Raises ScenarioError, whose ``problems`` lists all errors with file, line and column.
    """
    return _load_text(os.fspath(file), [(path, _yaml(value)) for path, value in (edits or {}).items()])


def path_step(name: str) -> str:
    """A name as an element of an edit path, quoted if necessary, as in ``emitters."a=b".power_w``."""
    return native.path_step(name)
