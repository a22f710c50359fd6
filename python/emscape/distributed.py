"""Studies on a cluster of Dask: each part is computed by ``python -m emscape study ... --part I/N`` on a worker.

The folder of the results must be one that all workers see. Parts that are there are not computed again, so that a study that
was interrupted is continued by the same call.
"""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Mapping
from typing import Any

from ._errors import Error, OtherError, make
from ._scenario import _yaml
from ._studies import Json, command


def _compute_part(arguments: list[str], part: int, parts: int) -> str:
    """Runs on a worker. The messages of a part that fails, with its exit status before them; else an empty text."""
    words = [sys.executable, "-m", "emscape", *arguments, "--part", f"{part}/{parts}", "--quiet"]
    result = subprocess.run(words, capture_output=True, text=True)
    return "" if result.returncode == 0 else f"{result.returncode} {result.stderr.strip()}"


def study(
    file: str | os.PathLike[str],
    output: str | os.PathLike[str],
    client: Any,
    *,
    parts: int,
    edits: Mapping[str, Any] | None = None,
    backend: str = "auto",
    threads: int = 0,
) -> Json:
    """As ``emscape.study``, with parts on the workers of a ``dask.distributed.Client``.

    :param parts: number of parts, at most that of the variants; the same at each call for a folder
    :param threads: of each part; 0: all that the worker's machine has
    :return: as ``emscape.study``
    Raises the error of the first part that fails, when all others are done.
    """
    arguments = ["study", os.path.abspath(file), "-o", os.path.abspath(output), "--backend", backend, "--threads", str(threads)]
    for path, value in (edits or {}).items():
        arguments += ["--set", f"{path}={_yaml(value)}"]
    futures = [client.submit(_compute_part, arguments, part, parts, pure=False) for part in range(1, parts + 1)]
    failures = [failure for failure in client.gather(futures) if failure]
    if failures:
        raise _error_of(failures[0])
    merged: Json = command(*arguments, "--merge")
    return merged


def _error_of(failure: str) -> Error:
    status, _, message = failure.partition(" ")
    message = message.removeprefix("emscape: error: ")
    return make(int(status), message, "", 0, 0) if int(status) > 0 else OtherError(f"a part was ended by signal {-int(status)}")
