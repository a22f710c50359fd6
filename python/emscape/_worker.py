"""A process that computes parts of a study: it reads their numbers from standard input and prints each when it is complete."""

from __future__ import annotations

import json
import signal
import sys
from collections.abc import Sequence

from ._errors import Error
from ._native import native


def worker_command(file: str, edits: Sequence[tuple[str, str]], folder: str, backend: str) -> list[str]:
    """The command of the process, without the last argument, its number of threads."""
    return [sys.executable, "-m", "emscape._worker", file, json.dumps(edits), folder, backend]


def main() -> int:
    """Serves until the input ends; returns the exit status."""
    file, edits, folder, backend, threads = sys.argv[1:]
    native.set_log(None)
    signal.signal(signal.SIGTERM, signal.default_int_handler)  # the file in work is taken back
    try:
        native.serve_study(file, [(path, value) for path, value in json.loads(edits)], folder, backend, int(threads))
    except Error as error:
        print(f"emscape: error: {error}", file=sys.stderr)
        return error.status
    except KeyboardInterrupt:
        return 130
    return 0


if __name__ == "__main__":
    sys.exit(main())
