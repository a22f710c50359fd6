"""Types and stubs: mypy --strict over the package and the examples, and the stub against the extension."""

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


@pytest.fixture(scope="module")
def environment():
    """mypy finds the package where this process has found it."""
    pytest.importorskip("mypy")
    return {**os.environ, "MYPYPATH": str(PACKAGE.parent)} if "site-packages" not in str(PACKAGE) else dict(os.environ)


def test_package_and_examples_pass_mypy_strict(environment, tmp_path):
    examples = sorted((ROOT / "examples").glob("*.py"))
    assert examples
    options = ["--strict", "--cache-dir", tmp_path, "--config-file", ROOT / "pyproject.toml"]
    words = [sys.executable, "-m", "mypy", *options, PACKAGE, *examples]
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
    environment = {**environment, "MYPYPATH": str(tmp_path), "PYTHONPATH": str(tmp_path)}
    result = subprocess.run(words, capture_output=True, text=True, env=environment, cwd=tmp_path)
    assert result.returncode == 0, result.stdout + result.stderr
