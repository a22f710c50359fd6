"""The extension module, loaded on first use, since it loads GDAL and OpenVDB."""

from __future__ import annotations

import atexit
import ctypes
import logging
import pathlib
import sys


def _load_gdal() -> None:
    """Loads the system's GDAL for a module that was built without knowing its version (scripts/wheel)."""
    folder = pathlib.Path(__file__).parent / "gdal"
    if not folder.is_dir():
        return  # the module is linked with GDAL
    links = sorted(folder.glob("*.so"), reverse=True)  # one per version, newest first
    for link in links:
        try:
            ctypes.CDLL(str(link))
        except OSError:
            continue
        return
    raise ImportError(
        f"emscape needs the library GDAL, libgdal.so.{links[-1].stem} to libgdal.so.{links[0].stem}, and found none that loads; "
        "install the package libgdal32 (Debian 12), libgdal34t64 (Ubuntu 24.04) or libgdal36 (Debian 13)"
    )


_load_gdal()

from . import _emscape as native  # noqa: E402

__all__ = ["native"]

_LEVELS = (logging.DEBUG, logging.INFO, logging.WARNING)
_logger = logging.getLogger("emscape")


def _log(level: int, message: str) -> None:
    _logger.log(_LEVELS[level], message)


native.set_log(_log)
native.set_program_command([sys.executable, "-m", "emscape"])
atexit.register(native.set_log, None)
