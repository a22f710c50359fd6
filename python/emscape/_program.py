"""The installed program ``emscape``."""

from __future__ import annotations

import json
import logging
import os
import shutil
import subprocess
from typing import Any

from ._arguments import PathName, path_text, utf8
from ._errors import OtherError, UsageError, make

def program() -> str:
    """Its file: $EMSCAPE_PROGRAM, else the one on PATH. Raises OtherError if there is none."""
    file = os.environ.get("EMSCAPE_PROGRAM") or shutil.which("emscape")
    if not file:
        raise OtherError("the program emscape is not on PATH; install it, or set EMSCAPE_PROGRAM to its file")
    return file


def command(*arguments: PathName) -> Any:
    """Runs a subcommand of the installed program and returns the JSON that ``emscape SUBCOMMAND ... --json`` prints.

    The program is $EMSCAPE_PROGRAM, else ``emscape`` on PATH.

    :param arguments: words of the command line, texts or paths: ``command("info", "out/jacksboro_0001.vdb")``
    Raises UsageError for arguments that cannot be parsed, otherwise the Error of the exit status; OtherError without the program. A failed check and
    faults that ``validate`` finds are results, not errors.
    """
    words = []
    for argument in arguments:
        if not isinstance(argument, (str, bytes, os.PathLike)):
            raise UsageError(f"command: {argument!r} is neither a text nor a path; give each word as an argument of its own")
        words.append(utf8(argument) if isinstance(argument, str) else path_text(argument))
    result = subprocess.run([program(), *words, "--json", "--quiet"], capture_output=True, text=True)
    logger, messages = logging.getLogger("emscape"), []
    for line in result.stderr.splitlines():
        if line.startswith("emscape: warning: "):
            logger.warning("%s", line.removeprefix("emscape: warning: "))
        else:
            messages.append(line.removeprefix("emscape: error: "))
    text = result.stdout.strip()
    if result.returncode != 0 and not text:
        raise make(result.returncode, "\n".join(messages), "", 0, 0)
    return json.loads(text) if text else None
