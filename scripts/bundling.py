"""Shared by scripts/wheel and scripts/bundle: libraries that are copied into a package.

GDAL is left to the system, as Debian's contains code under the GPL: the programs load the version that they find
(base/geodesy/gdal_library.cpp), and use its C functions alone, which stay the same.
"""

import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import venv

ROOT = pathlib.Path(__file__).resolve().parent.parent


def run(*words, **options):
    return subprocess.run([str(word) for word in words], check=True, text=True, **options)


def output(*words, **options):
    return run(*words, stdout=subprocess.PIPE, **options).stdout


def run_program(main):
    """Calls main(); a failing command ends the program with its messages."""
    try:
        main()
    except subprocess.CalledProcessError as error:
        program = pathlib.Path(sys.argv[0]).name
        sys.exit(f"scripts/{program}: {' '.join(error.cmd)}: exit status {error.returncode}\n{error.stdout or ''}{error.stderr or ''}".rstrip())


def prepare_environment():
    """Installs the tools of packages-wheel.txt; returns a function from a tool's name to its path."""
    environment, packages = ROOT / "build" / "wheel" / "environment", ROOT / "scripts" / "packages-wheel.txt"
    installed = environment / "installed.txt"
    if not installed.exists() or installed.read_text() != packages.read_text():
        venv.create(environment, with_pip=True, clear=True)
        run(environment / "bin" / "pip", "install", "--quiet", "--disable-pip-version-check", "--requirement", packages)
        shutil.copy(packages, installed)
    return lambda tool: environment / "bin" / tool


def copy_copyrights(sonames, folder):
    """Copies the copyright files of the Debian packages of the libraries into the folder. Returns the packages."""
    packages = set()
    folder.mkdir(parents=True, exist_ok=True)
    for soname in sorted(sonames):
        package = subprocess.run(["dpkg", "--search", f"*/{soname}"], capture_output=True, text=True).stdout.split(":")[0]
        if not package:
            sys.exit(f"{soname}: of no Debian package, so that its licence is not known")
        packages.add(package)
        shutil.copy(f"/usr/share/doc/{package}/copyright", folder / f"{package}.txt")
    return packages
