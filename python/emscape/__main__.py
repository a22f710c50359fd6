"""The command line: python -m emscape SUBCOMMAND ..."""

from __future__ import annotations

import signal
import sys


def main() -> int:
    """Runs the command line in this process; returns its exit status."""
    from ._emscape import run_command_line

    # The program's own handlers: the first Ctrl-C shuts down in order, the second ends the program at once.
    signal.signal(signal.SIGINT, signal.SIG_DFL)
    return run_command_line(["emscape", *sys.argv[1:]])


if __name__ == "__main__":
    sys.exit(main())
