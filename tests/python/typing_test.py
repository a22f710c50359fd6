"""Names, types and stubs: mypy --strict over the package and the examples, and the stub against the extension."""

import os
import pathlib
import shutil
import subprocess
import sys

import pytest
from conftest import ROOT

import emscape
from emscape import _emscape

PACKAGE = pathlib.Path(emscape.__file__).parent


@pytest.fixture
def environment(tmp_path):
    """mypy finds names in tmp_path: by itself, as it refuses a folder of installed packages among its arguments."""
    pytest.importorskip("mypy")
    return {**os.environ, "MYPYPATH": str(tmp_path), "PYTHONPATH": str(tmp_path)}


def test_package_and_examples_pass_mypy_strict(environment, tmp_path):
    examples = sorted((ROOT / "examples").glob("*.py"))
    assert examples
    package = shutil.copytree(PACKAGE, tmp_path / "emscape", ignore=shutil.ignore_patterns("*.so", "__pycache__"))
    options = ["--strict", "--cache-dir", tmp_path / "cache", "--config-file", ROOT / "pyproject.toml"]
    words = [sys.executable, "-m", "mypy", *options, package, *examples]
    result = subprocess.run(list(map(str, words)), capture_output=True, text=True, env=environment)
    assert result.returncode == 0, result.stdout


def test_the_stub_is_that_of_the_extension(environment, tmp_path):
    # By itself, which is quicker than with all that the package imports.
    for file in PACKAGE.glob("_emscape*"):
        shutil.copy(file, tmp_path)
    # stubtest does not know nanobind's types of functions and classes; the stub is made from their own signatures.
    known = [name for name in dir(_emscape) if type(getattr(_emscape, name)).__module__ == "nanobind"]
    (tmp_path / "nanobind").write_text("\n".join([*(f"_emscape.{name}" for name in known), r"_emscape\.\w+\.__init__"]))
    words = [sys.executable, "-m", "mypy.stubtest", "--allowlist", "nanobind", "--ignore-unused-allowlist", "_emscape"]
    result = subprocess.run(words, capture_output=True, text=True, env=environment, cwd=tmp_path)
    assert result.returncode == 0, result.stdout + result.stderr


def test_modules_are_imported_when_they_are_first_used():
    command = "import emscape; print(emscape.datasets.VolumeDataset.__name__, emscape.distributed.study.__name__)"
    result = subprocess.run([sys.executable, "-c", command], capture_output=True, text=True)
    assert result.stdout == "VolumeDataset study\n", result.stderr
