"""The command line: python -m emscape SUBCOMMAND ... is the installed program ``emscape``."""

from __future__ import annotations

import os
import sys

from ._program import program


def main() -> None:
    """Replaces this process by the program."""
    os.execv(program(), ["emscape", *sys.argv[1:]])


if __name__ == "__main__":
    main()
