"""Pictures of fields."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Union

import numpy as np
import numpy.typing as npt

from ._arguments import PathName, path_text
from ._field import Field
from ._native import native

Camera = Union[str, Mapping[str, float]]
"""A camera in the command line's syntax ("orbit:azimuth_deg=200,elevation_deg=35", "lookat:eye_x_m=..."), or the keys of an orbit
(``{"azimuth_deg": 200}``) or, if they include ``eye_x_m``, of a lookat."""


def _camera(camera: Camera) -> str:
    if isinstance(camera, str):
        return camera
    kind = "lookat" if "eye_x_m" in camera else "orbit"
    return kind + ":" + ",".join(f"{key}={value}" for key, value in camera.items()) if camera else kind


def render(
    field: Field,
    quantity: str | None = None,
    *,
    size: tuple[int, int] = (1280, 720),
    camera: Camera = "orbit",
    mode: str = "dvr",
    range: tuple[float, float] | None = None,
    transfer: PathName = "",
    theme: str = "dark",
    terrain: bool = True,
    emitters: bool = True,
    shading: bool = False,
    iso_value: float | None = None,
    exaggeration: float = 0.0,
    note: str = "",
    **settings: bool | float | str | Sequence[str],
) -> npt.NDArray[np.uint8]:
    """Draws a field with the ray caster, with ground, emitters, legend and time; casts every ray.

    :param quantity: None: the first
    :param size: width and height in pixels
    :param mode: "dvr", "mida", "mip" or "iso"
    :param range: of the colours, in the quantity's unit; None: fitted to the values
    :param transfer: file of a transfer function; empty: fitted
    :param theme: "dark" or "light"
    :param iso_value: of the isosurface, in the quantity's unit; None: the middle of the colours
    :param exaggeration: of heights, up to 100; 0: chosen from the shape of the region
    :param note: small text at the bottom
    :param settings: further settings of the picture by their keys in view files (docs/view-state.md), such as
        ``map_layer=100``, ``labels="all"``, ``units="nautical"`` or ``range_rings=["radar:spacing_m=10000"]``
    :return: (height, width, 4) uint8: red, green, blue and opacity, rows from the top
    Raises UsageError for an argument that is not allowed, InputError for an invalid transfer function file.
    """
    return native.render(
        field._handle,
        quantity if quantity is not None else "",
        size,
        _camera(camera),
        mode,
        range,
        path_text(transfer) if transfer else "",
        theme,
        terrain,
        emitters,
        shading,
        iso_value,
        exaggeration,
        note,
        {**settings},
    )
