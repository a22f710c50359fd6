"""Progress of long work."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, Union

Progress = Union[Callable[[str, float], None], bool, None]
"""A function called with the name of the step and the completed fraction, 0..1, at most ten times a second, by any thread. True:
a tqdm bar if tqdm is installed. None or False: no progress is reported."""


class _Bar:
    """A tqdm bar per step."""

    def __init__(self, tqdm: Any) -> None:
        self._tqdm = tqdm
        self._bar: Any = None
        self._step: str | None = None

    def __call__(self, step: str, fraction: float) -> None:
        if step != self._step:
            self.close()
            self._step, self._bar = step, self._tqdm(total=100, desc=step, unit="%")
        self._bar.n = round(100 * fraction)
        self._bar.refresh()
        if fraction >= 1:
            self.close()

    def close(self) -> None:
        if self._bar is not None:
            self._bar.close()
        self._bar, self._step = None, None


def callback(progress: Progress) -> Callable[[str, float], None] | None:
    """Returns the function that the extension calls."""
    if progress is None or progress is False:
        return None
    if progress is not True:
        return progress
    try:
        from tqdm.auto import tqdm
    except ImportError:
        return None
    return _Bar(tqdm)
