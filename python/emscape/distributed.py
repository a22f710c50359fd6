"""Studies on a cluster of Dask: each part is computed by a process of its own on a worker.

All workers must have access to the folder of the results. Existing parts are not computed again, so the same call continues an
interrupted study.
"""

from __future__ import annotations

import json
import os
import re
import subprocess
from collections.abc import Mapping
from typing import Any

from ._arguments import PathName, path_text
from ._errors import Error, OtherError, UsageError, make
from ._native import native
from ._scenario import edit_texts
from ._studies import Json
from ._worker import worker_command


def _compute_part(file: str, edits: list[tuple[str, str]], folder: str, backend: str, threads: int, part: int) -> str:
    """Runs on a worker. Returns the exit status and messages of a failed part, otherwise an empty text."""
    words = [*worker_command(file, edits, folder, backend), str(threads)]
    result = subprocess.run(words, input=f"{part}\n", capture_output=True, text=True)
    return "" if result.returncode == 0 else f"{result.returncode} {result.stderr.strip()}"


def study(
    file: PathName,
    output: PathName,
    client: Any,
    *,
    parts: int,
    edits: Mapping[str, Any] | None = None,
    backend: str = "auto",
    threads: int = 0,
) -> Json:
    """Runs a study like ``emscape.study``, with parts on the workers of a ``dask.distributed.Client``.

    :param parts: number of parts, from 1 to the number of variants; must be the same in each call for a folder
    :param threads: threads per part; 0: all of the worker's machine
    :return: as ``emscape.study``
    Raises the error of the first failed part once all others are done.
    """
    if parts < 1:
        raise UsageError(f"parts is {parts}, outside the allowed range 1 to the number of variants")
    of = (os.path.abspath(path_text(file)), edit_texts(edits), os.path.abspath(path_text(output)))
    native.begin_study(*of, parts)
    futures = [client.submit(_compute_part, *of, backend, threads, part, pure=False) for part in range(1, parts + 1)]
    failures = [failure for failure in client.gather(futures) if failure]
    if failures:
        raise _error_of(failures[0])
    merged: Json = json.loads(native.merge_study(*of))
    return merged


def _error_of(failure: str) -> Error:
    status, _, output = failure.partition(" ")
    if int(status) <= 0:
        return OtherError(f"a part was ended by signal {-int(status)}")
    # Warnings stand before the error, which is the last message.
    message = output.rpartition("emscape: error: ")[2].strip()
    place = re.match(r"(?P<file>[^\n]+?):(?P<line>\d+)(?::(?P<column>\d+))?: (?P<message>.+)", message, re.DOTALL)
    if place is None:
        return make(int(status), message, "", 0, 0)
    return make(int(status), place["message"], place["file"], int(place["line"]), int(place["column"] or 0))
