"""The solver and its fields."""

from __future__ import annotations

import datetime
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from ._arguments import PathName, distinct, listed, path_text
from ._errors import UsageError
from ._native import native
from ._scenario import Scenario, Time, utc_time

if TYPE_CHECKING:
    import pyvista
    import xarray


class Field:
    """The field of one instant: a volume per quantity, on one grid.

    Arrays have the axes (z, y, x), in C order: x (east) varies fastest, then y (north), then z (up). Made by ``Solver.at`` and
    ``read``. Later updates of the solver do not change it, and it may outlive the solver.
    """

    __slots__ = ("_handle", "_grid")

    def __init__(self, handle: native.Field) -> None:
        self._handle = handle
        self._grid: dict[str, Any] | None = None

    @property
    def grid(self) -> dict[str, Any]:
        """The grid of the voxels.

        ``dims``, ``spacing_m`` and ``first_center_m`` along (x, y, z); of a grid with a position on the earth also ``frame``
        ("altitude": z is above mean sea level; "enu": z is along the vertical at the origin), and ``latitude_deg``,
        ``longitude_deg``, ``height_msl_m`` of its origin, where x and y are 0. A new dict in every call.
        """
        return dict(self._kept_grid())

    def _kept_grid(self) -> dict[str, Any]:
        if self._grid is None:
            self._grid = self._handle.grid()
        return self._grid

    @property
    def quantities(self) -> list[str]:
        """Names of the volumes: the quantity, followed by ":" and the emitter or band unless it covers all emitters."""
        return self._handle.names

    @property
    def shape(self) -> tuple[int, int, int]:
        """Voxels along (z, y, x)."""
        x, y, z = self._kept_grid()["dims"]
        return z, y, x

    @property
    def time_s(self) -> float:
        """Time (s since the scenario's epoch)."""
        return self._handle.time_s

    @property
    def time(self) -> datetime.datetime | None:
        """Time (UTC), of a field from a file as the file states it; None without an epoch."""
        if self.scenario is None:
            return utc_time(self.info()["time_utc"])
        epoch = self.scenario.epoch
        return epoch + datetime.timedelta(seconds=self.time_s) if epoch is not None else None

    @property
    def scenario(self) -> Scenario | None:
        """The scenario; None for a field that was read from a file."""
        handle = self._handle.scenario
        return Scenario(handle) if handle is not None else None

    @property
    def is_on_gpu(self) -> bool:
        """True if the values are in the memory of a GPU; ``numpy`` then copies them, once."""
        return self._handle.is_on_gpu

    def _name(self, quantity: str | None) -> str:
        return quantity if quantity is not None else self.quantities[0]

    def _centers(self, axis: int) -> npt.NDArray[np.float64]:
        grid = self._kept_grid()
        first, step, count = grid["first_center_m"][axis], grid["spacing_m"][axis], grid["dims"][axis]
        return np.asarray(first + np.arange(count) * step, dtype=np.float64)

    @property
    def x_m(self) -> npt.NDArray[np.float64]:
        """Voxel centres along x (east, m): shape (x,)."""
        return self._centers(0)

    @property
    def y_m(self) -> npt.NDArray[np.float64]:
        """Voxel centres along y (north, m): shape (y,)."""
        return self._centers(1)

    @property
    def z_m(self) -> npt.NDArray[np.float64]:
        """Voxel centres along z (m; above mean sea level in the frame "altitude"): shape (z,)."""
        return self._centers(2)

    def numpy(self, quantity: str | None = None) -> npt.NDArray[np.float32]:
        """The values: (z, y, x) float32, in the quantity's unit; read-only, without a copy, kept alive by the array.

        Voxels below ground or without a known field hold the floor (``info``); ``mask`` marks them.

        :param quantity: None: the first
        Raises UsageError for a quantity that the field does not have.
        """
        return self._handle.array(self._name(quantity))

    def dlpack(self, quantity: str | None = None) -> Any:
        """The values as an object with ``__dlpack__``, for ``torch.from_dlpack``, ``cupy.from_dlpack`` and the like: (z, y, x)
        float32, read-only, kept alive by the array.

        In host memory it is the memory of ``numpy``. On a GPU the values are copied into linear memory once per field, on the
        GPU: every call returns the same pointer.
        """
        return self._handle.dlpack(self._name(quantity))

    def __dlpack__(self, **arguments: Any) -> Any:
        """The first quantity by DLPack."""
        return self.dlpack().__dlpack__(**arguments)

    def __dlpack_device__(self) -> tuple[int, int]:
        """DLPack device type and number of ``dlpack``."""
        device: tuple[int, int] = self.dlpack().__dlpack_device__()
        return device

    def first_valid(self, quantity: str | None = None) -> npt.NDArray[np.uint16] | None:
        """The lowest z index that holds a field, per column: (y, x) uint16; the number of voxels along z if there is none. None
        if no voxel is masked.
        """
        return self._handle.first_valid(self._name(quantity))

    def mask(self, quantity: str | None = None) -> npt.NDArray[np.bool_]:
        """True in voxels without a known field, such as those below ground: (z, y, x)."""
        first = self.first_valid(quantity)
        if first is None:
            return np.zeros(self.shape, dtype=np.bool_)
        return np.asarray(np.arange(self.shape[0])[:, np.newaxis, np.newaxis] < first[np.newaxis])

    def ground_msl_m(self) -> npt.NDArray[np.float32] | None:
        """Height of the ground above mean sea level (m) at the columns' centres: (y, x); NaN where it is unknown. None
        without terrain, and for fields from files.
        """
        return self._handle.ground()

    def info(self, quantity: str | None = None) -> dict[str, Any]:
        """Description of the values: quantity, unit, time_s, time_utc, floor, range_min, range_max, categorical, extra."""
        return self._handle.info(self._name(quantity))

    def geodetic(self, x_m: float, y_m: float, z_m: float) -> tuple[float, float, float]:
        """Latitude (deg), longitude (deg) and height above the WGS84 ellipsoid (m) of a position in the grid's frame (m).

        Raises UsageError for a grid without a position on the earth.
        """
        return self._handle.geodetic(x_m, y_m, z_m)

    def write(self, file: PathName, quantities: str | Sequence[str] = ()) -> None:
        """Writes a volume file in the format of its extension: .vdb, .nvdb, .vti, .raw. The file appears when it is complete.

        :param quantities: empty: all; formats for a single volume take one
        Raises InputError for an unknown extension or too many quantities, OtherError if the file cannot be written.
        """
        self._handle.write(path_text(file), listed(quantities))

    def to_xarray(self, quantities: str | Sequence[str] = ()) -> xarray.Dataset:
        """The field as a dataset of (z, y, x) with coordinates, units and projection by the CF conventions; NaN in masked
        voxels. The values are copied. Needs xarray.

        :param quantities: empty: all
        """
        from ._arrays import dataset_of

        return dataset_of(self, listed(quantities))

    def to_pyvista(self, quantities: str | Sequence[str] = ()) -> pyvista.ImageData:
        """The field as point data of an ImageData whose points are the voxels' centres (frame metres); NaN in masked voxels, as
        in to_xarray(). Needs pyvista.

        :param quantities: empty: all
        """
        try:
            import pyvista
        except ImportError as missing:
            raise ImportError("to_pyvista() needs pyvista: pip install 'emscape[view]'") from missing
        grid = self.grid
        image = pyvista.ImageData(dimensions=grid["dims"], spacing=grid["spacing_m"], origin=grid["first_center_m"])
        for name in listed(quantities) or self.quantities:
            values = np.where(self.mask(name), np.float32("nan"), self.numpy(name))
            image.point_data[name] = values.ravel()  # VTK has the same order of points: x fastest
        return image

    def __repr__(self) -> str:
        z, y, x = self.shape
        return f"<emscape.Field t = {self.time_s:g} s: {x} x {y} x {z} voxels, {', '.join(self.quantities)}>"


class Solver:
    """Computes the field of a scenario at any time; keeps what neither time nor edits change.

    Thread-safe: calls are serialised, and release Python's global interpreter lock.
    """

    __slots__ = ("_handle", "_text")

    def __init__(
        self,
        scenario: Scenario,
        backend: str = "auto",
        threads: int = 0,
        *,
        quantities: str | Sequence[str] = (),
        allow_missing_terrain: bool = False,
        cache_mib: float = 0,
        move_tolerance_m: float = 0.5,
    ) -> None:
        """Reads the terrain and prepares the grid.

        :param backend: "auto" (a GPU if there is a usable one), "cpu" or "cuda"
        :param threads: CPU threads, 0 to 4096; 0: one per core, or as many as the caller's oneTBB arena has
        :param quantities: names; empty: those of the scenario
        :param allow_missing_terrain: columns over holes in the terrain are masked instead of raising an error
        :param cache_mib: limit of the memory for kept results of emitters (MiB), 0 to 1e6; 0: no limit
        :param move_tolerance_m: an emitter that moves less than this (m) over time keeps its geometry; 0 to 1e6
        Raises UsageError for an argument outside its range or a name that is given twice, InputError for missing terrain,
        DeviceError for a GPU that is missing or has too little memory.
        """
        self._text = scenario._text
        self._handle = native.Solver(
            scenario._handle,
            backend,
            threads,
            distinct(quantities, "quantities"),
            allow_missing_terrain,
            cache_mib,
            move_tolerance_m,
        )

    @property
    def scenario(self) -> Scenario:
        """The scenario of the last field."""
        return Scenario(self._handle.scenario, self._text)

    @property
    def backend(self) -> str:
        """Where fields are computed: "cpu" or "cuda"."""
        return self._handle.backend

    @property
    def quantities(self) -> list[str]:
        """Names of the volumes of a field."""
        return self._handle.quantities

    @property
    def warnings(self) -> list[str]:
        """Warnings of the models so far, each listed once with its count."""
        return self._handle.warnings()

    def at(
        self, time_s: Time, scenario: Scenario | None = None, *, poses: Mapping[str, Sequence[float]] | None = None
    ) -> Field:
        """The field at a time.

        Only what has changed since the last call is computed: an emitter that has moved, a beam that has turned, or what an edit
        affects.

        :param time_s: seconds since the epoch, a timedelta, or UTC
        :param scenario: an edited scenario (``Scenario.with_set``), from now on; None: the last one
        :param poses: platforms that are elsewhere in this call, by name: latitude, longitude (deg), height above mean sea level (m),
            and optionally heading, pitch and roll (deg; 0). The field is that of a scenario with fixed sites there
        Raises InputError for a platform below ground, missing terrain, or a value that a model rejects; DeviceError.
        """
        placed = {name: _pose(name, values) for name, values in (poses or {}).items()}
        seconds = (scenario or self.scenario)._seconds(time_s)
        if scenario is not None:
            self._text = scenario._text
        return Field(self._handle.at(seconds, scenario._handle if scenario is not None else None, placed))

    def __repr__(self) -> str:
        return f"<emscape.Solver of {self.scenario.name!r} on {self.backend}>"


def _pose(platform: str, values: Sequence[float]) -> list[float]:
    if not 3 <= len(values) <= 6:
        raise UsageError(f"the pose of {platform!r} has {len(values)} numbers; allowed: 3 to 6")
    return [*map(float, values), *[0.0] * (6 - len(values))]


def read(file: PathName) -> Field:
    """Reads a volume file (.vdb, .nvdb, .vti, .raw) with all its quantities.

    Raises InputError.
    """
    return Field(native.read(path_text(file)))
