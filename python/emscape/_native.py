"""The extension module, loaded on first use."""

from __future__ import annotations

import atexit
import logging

from . import _emscape as native

__all__ = ["native"]

_LEVELS = (logging.DEBUG, logging.INFO, logging.WARNING)
_logger = logging.getLogger("emscape")


def _log(level: int, message: str) -> None:
    _logger.log(_LEVELS[level], message)


native.set_log(_log)
atexit.register(native.set_log, None)
