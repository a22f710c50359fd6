"""Labelled volumes of random scenarios, for training networks.

A sample is a random scenario, its field as a volume, and a label that describes the scenario. Sample ``i`` of a seed is always
the same, in any order, to the byte on one kind of processor. This module does not need PyTorch; its DataLoader takes a
``VolumeDataset``::

    loader = torch.utils.data.DataLoader(emscape.datasets.VolumeDataset(1000, seed=1), batch_size=8)

Emitters are over a smooth earth or, with an elevation file, on terrain. Distributions, each independent:

=================  ==========================================================================================
emitters           1 to ``max_emitters``, uniform; the first is a radar, others radar, jammer or transmitter alike
place              uniform in the middle 90 % of the region; height above ground 10 to 100 m, log-uniform
frequency          0.1 to 10 GHz, log-uniform
power              10 W to 100 kW (radar), 1 to 1000 W (others), log-uniform
antenna            radar: gaussian beam of 2 to 12 deg; jammer: 20 to 90 deg, both uniform; transmitter: isotropic
beam               azimuth uniform, elevation 0 to 15 deg, fixed
=================  ==========================================================================================
"""

from __future__ import annotations

import json
import math
import os
from collections.abc import Iterator
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from ._arguments import PathName, path_text
from ._field import Field, Solver
from ._native import native
from ._scenario import Scenario, parse

KINDS = ("radar", "jammer", "transmitter")
"""Kinds of emitters; the index is the number in labels."""

FEATURES = ("kind", "x_m", "y_m", "height_agl_m", "log10_frequency_hz", "power_dbw", "beamwidth_deg", "azimuth_deg", "elevation_deg")
"""Columns of a label. Positions are metres from the region's centre; azimuth is clockwise from north;
isotropic antennas have the beamwidth 360, and NaN for the angles of a beam. The frequency enters a volume where
paths are diffracted, or where the quantity depends on it."""


class Sample(NamedTuple):
    """A volume and its label."""

    volume: npt.NDArray[np.float32]
    """Values in the quantity's unit, floor where there is no field: (z, y, x)."""
    label: npt.NDArray[np.float32]
    """A row per emitter, columns as FEATURES; padded with rows of NaN up to the maximum number of emitters: (emitter,
    feature)."""
    document: dict[str, Any]
    """The scenario as the contents of a JSON file."""
    mask: npt.NDArray[np.bool_]
    """True in voxels below the ground or without a known field, which hold the floor: (z, y, x)."""
    ground_msl_m: npt.NDArray[np.float32] | None
    """Height of the ground above mean sea level (m): (y, x); None over a smooth earth."""


class VolumeDataset:
    """Samples by number, a map-style dataset for PyTorch of (volume (1, z, y, x), label (emitter, feature)).

    With workers, pass ``multiprocessing_context="spawn"`` to the DataLoader: forked processes cannot compute.
    """

    def __init__(
        self,
        count: int,
        seed: int = 0,
        *,
        shape: tuple[int, int, int] = (64, 64, 64),
        size_m: tuple[float, float, float] = (20000.0, 20000.0, 5000.0),
        max_emitters: int = 4,
        quantity: str = "power_density_dbwm2",
        terrain: PathName | None = None,
        origin_deg: tuple[float, float] = (52.0, 5.0),
        propagation: str = "diffraction",
        backend: str = "auto",
    ) -> None:
        """
        :param count: number of samples
        :param shape: voxels along (z, y, x)
        :param size_m: size of the region along x (east), y (north) and z (up)
        :param terrain: an elevation file over the whole region; None: a smooth earth
        :param origin_deg: latitude and longitude of the region's centre
        :param propagation: model of all emitters
        """
        if count < 0 or max_emitters < 1:
            raise ValueError(f"count is {count}, max_emitters {max_emitters}; at least 0 and 1 are needed")
        self.count, self.seed, self.max_emitters, self.quantity = count, seed, max_emitters, quantity
        # Python's numbers, which JSON can hold; numpy's arrays are allowed, too.
        self.shape = tuple(int(voxels) for voxels in shape)
        self.size_m = tuple(float(length_m) for length_m in size_m)
        self.origin_deg = tuple(float(angle_deg) for angle_deg in origin_deg)
        self.terrain = os.path.abspath(path_text(terrain)) if terrain is not None else None
        self.propagation, self.backend = propagation, backend
        self._solver: Solver | None = None

    def __len__(self) -> int:
        return self.count

    def __getitem__(self, index: int) -> tuple[npt.NDArray[np.float32], npt.NDArray[np.float32]]:
        sample = self.sample(index)
        return sample.volume[np.newaxis], sample.label

    def __iter__(self) -> Iterator[tuple[npt.NDArray[np.float32], npt.NDArray[np.float32]]]:
        return (self[index] for index in range(self.count))

    def __getstate__(self) -> dict[str, Any]:
        return {**self.__dict__, "_solver": None}

    def sample(self, index: int) -> Sample:
        """A sample with its scenario. Raises IndexError."""
        document, label = self.describe(index)
        field = self.field(index)
        values = field.numpy(self.quantity).copy()  # writable, as PyTorch expects
        return Sample(values, label, document, field.mask(self.quantity), field.ground_msl_m())

    def scenario(self, index: int) -> Scenario:
        """The scenario of a sample."""
        document, _ = self.describe(index)
        return parse(document, name=document["name"] + ".json")

    def field(self, index: int) -> Field:
        """The field of a sample."""
        scenario = self.scenario(index)
        if self._solver is None:
            self._solver = Solver(scenario, self.backend, quantities=[self.quantity], allow_missing_terrain=True)
        return self._solver.at(0.0, scenario)

    def describe(self, index: int) -> tuple[dict[str, Any], npt.NDArray[np.float32]]:
        """The scenario and label of a sample, without its field. Raises IndexError."""
        if not hasattr(index, "__index__"):
            raise TypeError(f"sample {index!r}: an index is a whole number; slices are not supported")
        if not 0 <= index < self.count:
            raise IndexError(f"sample {index}: there are {self.count}")
        rng = np.random.default_rng([self.seed, index])
        label = np.full((self.max_emitters, len(FEATURES)), np.nan, np.float32)
        latitude_deg, longitude_deg = self.origin_deg
        platforms, emitters = [], []
        for e in range(int(rng.integers(1, self.max_emitters + 1))):
            kind = 0 if e == 0 else int(rng.integers(len(KINDS)))
            x_m, y_m = (float(rng.uniform(-0.45, 0.45) * size_m) for size_m in self.size_m[:2])
            height_m = _log_uniform(rng, 10, 100)
            frequency_hz = _log_uniform(rng, 1e8, 1e10)
            power_w = _log_uniform(rng, 10, 1e5) if kind == 0 else _log_uniform(rng, 1, 1e3)
            width_deg = float(rng.uniform(2, 12) if kind == 0 else rng.uniform(20, 90))
            azimuth_deg, elevation_deg = float(rng.uniform(0, 360)), float(rng.uniform(0, 15))
            antenna: dict[str, Any] = {"pattern": "isotropic"}
            if kind == 2:
                width_deg, azimuth_deg, elevation_deg = 360.0, math.nan, math.nan
            else:
                antenna = {"pattern": "gaussian", "beamwidth_az_deg": width_deg, "beamwidth_el_deg": width_deg}
            place = native.to_geodetic(latitude_deg, longitude_deg, x_m, y_m)
            position = {"latitude_deg": place[0], "longitude_deg": place[1], "height_agl_m": height_m}
            platforms.append({"name": f"site {e + 1}", "position": position})
            emitter: dict[str, Any] = {"name": f"{KINDS[kind]} {e + 1}", "platform": f"site {e + 1}", "kind": KINDS[kind]}
            emitter |= {"frequency_hz": frequency_hz, "power_w": power_w, "antenna": antenna, "propagation": self.propagation}
            if kind != 2:
                emitter["scan"] = {"kind": "fixed", "azimuth_deg": azimuth_deg, "elevation_deg": elevation_deg}
            if kind == 0:
                emitter["receiver"] = {"noise_figure_db": 4, "bandwidth_hz": 1e6}
            if kind == 1:
                emitter["bandwidth_hz"] = 20e6
            emitters.append(emitter)
            row = (kind, x_m, y_m, height_m, math.log10(frequency_hz), 10 * math.log10(power_w), width_deg, azimuth_deg, elevation_deg)
            label[e] = row
        z, y, x = self.shape
        document: dict[str, Any] = {
            "schema_version": 1,
            "name": f"sample_{self.seed}_{index}",
            "region": {
                "origin": {"latitude_deg": latitude_deg, "longitude_deg": longitude_deg, "height_msl_m": 0},
                "size_m": list(self.size_m),
                "dims": [x, y, z],
            },
            "platforms": platforms,
            "emitters": emitters,
            "output": {"quantities": [self.quantity]},
        }
        if self.terrain is not None:
            document["terrain"] = {"files": [self.terrain], "vertical_datum": "egm96"}
        return document, label


def _log_uniform(rng: np.random.Generator, lower: float, upper: float) -> float:
    return float(math.exp(rng.uniform(math.log(lower), math.log(upper))))
