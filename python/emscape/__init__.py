"""Emscape: computes the electromagnetic environment of a scenario as arrays.

    import emscape as em

    scenario = em.load("scenarios/jacksboro.yaml")
    field = em.Solver(scenario).at(49.5)
    values = field.numpy("snr_db")        # (z, y, x) float32, without a copy

Arrays have the axes (time, z, y, x); lengths are in metres, times in seconds since the scenario's epoch, angles in degrees, and
every quantity's name ends in its unit. Messages go to the logger "emscape". Documentation: docs/python.md.
"""

from __future__ import annotations

import importlib
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from . import datasets as datasets
    from . import distributed as distributed
    from ._arrays import open_series as open_series
    from ._errors import CheckError as CheckError
    from ._errors import DeviceError as DeviceError
    from ._errors import Error as Error
    from ._errors import InputError as InputError
    from ._errors import OtherError as OtherError
    from ._errors import Problem as Problem
    from ._errors import ScenarioError as ScenarioError
    from ._errors import UsageError as UsageError
    from ._field import Field as Field
    from ._field import Solver as Solver
    from ._field import read as read
    from ._maps import coverage as coverage
    from ._maps import products as products
    from ._picture import render as render
    from ._program import command as command
    from ._scenario import Scenario as Scenario
    from ._scenario import load as load
    from ._scenario import parse as parse
    from ._scenario import path_step as path_step
    from ._studies import check as check
    from ._studies import compare as compare
    from ._studies import exposure as exposure
    from ._studies import link as link
    from ._studies import profile as profile
    from ._studies import simulate as simulate
    from ._studies import study as study
    from ._studies import vertical as vertical

# Modules are imported when a name of theirs is first used: numpy, xarray and the extension take a while to load.
_NAMES = {
    "_arrays": ("open_series",),
    "_errors": ("CheckError", "DeviceError", "Error", "InputError", "OtherError", "Problem", "ScenarioError", "UsageError"),
    "_field": ("Field", "Solver", "read"),
    "_maps": ("coverage", "products"),
    "_picture": ("render",),
    "_program": ("command",),
    "_scenario": ("Scenario", "load", "parse", "path_step"),
    "_studies": ("check", "compare", "exposure", "link", "profile", "simulate", "study", "vertical"),
}
_MODULES = ("datasets", "distributed")
_MODULE_OF = {name: module for module, names in _NAMES.items() for name in names}

__all__ = sorted([*_MODULE_OF, "__version__"])  # pyright: ignore[reportUnsupportedDunderAll]


def __getattr__(name: str) -> Any:
    if name == "__version__":
        from importlib.metadata import version

        return version("emscape")
    if name in _MODULES:
        return importlib.import_module("." + name, __name__)
    if name not in _MODULE_OF:
        raise AttributeError(f"module 'emscape' has no attribute '{name}'")
    value = getattr(importlib.import_module("." + _MODULE_OF[name], __name__), name)
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    return sorted([*__all__, *_MODULES])
