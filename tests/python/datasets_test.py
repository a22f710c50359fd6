"""Random labelled scenarios: reproducible, in any order, and what the labels say."""

import hashlib
import json
import pickle
import subprocess

import numpy as np
import pytest
from conftest import SCENARIOS

import emscape as em
from emscape import datasets


def digest(samples):
    return hashlib.sha256(b"".join(volume.tobytes() + label.tobytes() for volume, label in samples)).hexdigest()


def test_a_seed_gives_the_same_bytes_in_any_order():
    small = {"shape": (16, 24, 32), "backend": "cpu"}
    one = datasets.VolumeDataset(6, 7, **small)
    forwards = [one[i] for i in range(6)]
    other = pickle.loads(pickle.dumps(datasets.VolumeDataset(6, 7, **small)))
    backwards = [other[i] for i in reversed(range(6))][::-1]
    assert digest(forwards) == digest(backwards)
    assert digest(forwards) != digest(datasets.VolumeDataset(6, 8, **small))
    assert forwards[0][0].shape == (1, 16, 24, 32) and forwards[0][0].flags.writeable
    assert len({volume.tobytes() for volume, _ in forwards}) == 6
    with pytest.raises(IndexError, match="sample 6: there are 6"):
        one[6]


def test_sizes_may_be_arrays_of_numpy():
    tuples = datasets.VolumeDataset(1, 7, shape=(8, 9, 10), size_m=(20000, 20000, 5000), backend="cpu")
    arrays = datasets.VolumeDataset(1, 7, shape=np.array([8, 9, 10]), size_m=np.array([20000, 20000, 5000]), backend="cpu")
    assert arrays[0][0].shape == (1, 8, 9, 10)
    assert digest(arrays) == digest(tuples)


def test_labels_say_where_emitters_are():
    data = datasets.VolumeDataset(5, 1, shape=(10, 40, 40), backend="cpu")
    for i in range(len(data)):
        rows = data[i][1]
        rows = rows[np.isfinite(rows[:, 0])]
        positions = list(data.scenario(i).positions().values())
        assert len(rows) == len(positions) and rows[0, 0] == 0
        for (_, x_m, y_m, height_agl_m, *_), (latitude, longitude, height_msl_m) in zip(rows, positions):
            assert data.field(i).geodetic(x_m, y_m, 0)[:2] == pytest.approx((latitude, longitude), abs=1e-7)
            assert height_msl_m == pytest.approx(height_agl_m, abs=0.01)


def test_terrain_is_below_the_emitters():
    data = datasets.VolumeDataset(
        2, 3, shape=(20, 20, 20), terrain=SCENARIOS / "data" / "jacksboro.tif", origin_deg=(36.303, -84.246), backend="cpu"
    )
    field, sample = data.field(0), data.sample(0)
    assert field.mask().any()
    assert np.array_equal(sample.mask, field.mask()) and np.array_equal(sample.ground_msl_m, field.ground_msl_m())
    assert np.array_equal(data.field(1).numpy(), datasets.VolumeDataset.field(pickle.loads(pickle.dumps(data)), 1).numpy())


def test_a_sample_is_a_scenario_of_the_command_line(program, tmp_path):
    data = datasets.VolumeDataset(1, 5, shape=(8, 8, 8), backend="cpu")
    file = tmp_path / "sample.json"
    file.write_text(json.dumps(data.sample(0).document))
    subprocess.run([program, "simulate", file, "-o", tmp_path / "out", "--format", "raw", "--times", "0", "--backend", "cpu", "-q"], check=True)
    (raw,) = (tmp_path / "out").glob("*.raw")
    assert raw.read_bytes() == data.sample(0).volume.tobytes()


def test_statistics_are_those_that_the_documentation_states():
    data = datasets.VolumeDataset(400, 2)
    labels = np.concatenate([data.describe(i)[1] for i in range(400)])
    rows = labels[np.isfinite(labels[:, 0])]
    counts = np.isfinite(labels[:, 0]).reshape(400, -1).sum(axis=1)
    assert np.bincount(counts, minlength=5)[1:] == pytest.approx(100, abs=40)
    column = {name: rows[:, i] for i, name in enumerate(datasets.FEATURES)}
    assert np.abs(column["x_m"]).max() <= 9000 and np.abs(column["x_m"].mean()) < 600
    assert column["log10_frequency_hz"].mean() == pytest.approx(9, abs=0.1)
    assert (column["log10_frequency_hz"].min(), column["log10_frequency_hz"].max()) == pytest.approx((8, 10), abs=0.05)
    assert column["power_dbw"][column["kind"] == 0].mean() == pytest.approx(30, abs=1.5)
    with_beam = column["kind"] != 2
    assert column["azimuth_deg"][with_beam].mean() == pytest.approx(180, abs=15)
    assert np.isnan(column["azimuth_deg"][~with_beam]).all() and np.isnan(column["elevation_deg"][~with_beam]).all()


def test_the_frequency_enters_the_volume():
    data = datasets.VolumeDataset(1, 5, shape=(16, 32, 32), backend="cpu")
    scenario = data.scenario(0)
    lower = scenario
    for emitter in data.describe(0)[0]["emitters"]:
        lower = lower.with_set({f"emitters.{emitter['name']}.frequency_hz": 0.3 * emitter["frequency_hz"]})
    before, after = em.Solver(scenario, "cpu").at(0).numpy(), em.Solver(lower, "cpu").at(0).numpy()
    assert np.abs(before - after).max() > 1


def test_a_data_loader_takes_it():
    torch = pytest.importorskip("torch")
    loader = torch.utils.data.DataLoader(datasets.VolumeDataset(4, shape=(8, 8, 8), backend="cpu"), batch_size=2)
    volumes, labels = next(iter(loader))
    assert volumes.shape == (2, 1, 8, 8, 8) and labels.shape == (2, 4, len(datasets.FEATURES))
