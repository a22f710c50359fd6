"""What the tests share."""

import os
import pathlib

import pytest

import emscape as em

ROOT = pathlib.Path(os.environ.get("EMSCAPE_SOURCE_DIR", pathlib.Path(__file__).resolve().parents[2]))
SCENARIOS = ROOT / "scenarios"


@pytest.fixture(scope="session")
def quick():
    """Two emitters over a smooth earth."""
    return em.load(SCENARIOS / "quick.yaml")


@pytest.fixture(scope="session")
def jamming():
    """A radar and a jammer over terrain."""
    return em.load(SCENARIOS / "jamming.yaml", {"region.dims": [60, 60, 25]})


@pytest.fixture(scope="session")
def program():
    """The program emscape of the same build."""
    file = os.environ.get("EMSCAPE_PROGRAM")
    if not file:
        pytest.skip("EMSCAPE_PROGRAM names no program")
    return file
