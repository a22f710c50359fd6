"""Exceptions: one class per kind of failure, with the exit status of the command line."""

from __future__ import annotations

from typing import ClassVar, NamedTuple


class Problem(NamedTuple):
    """An error or a warning about a document."""

    file: str
    """File, or the edit ("PATH=VALUE") that causes it; empty if unknown."""
    line: int
    """Counts from 1; 0: unknown."""
    column: int
    """Counts from 1; 0: unknown."""
    message: str
    """Message: the value, the allowed range and its unit."""


class Error(Exception):
    """Base of all errors of Emscape.

    ``str(error)`` starts with the location, "file:line:column: ", if it is known.
    """

    status: ClassVar[int] = 1
    """Exit status of the command line for this error."""

    def __init__(self, message: str, file: str = "", line: int = 0, column: int = 0) -> None:
        self.message = message
        """The message without the location."""
        self.file = file
        """File, or the edit that causes the error; empty if unknown."""
        self.line = line
        """Line in the file, from 1; 0: unknown."""
        self.column = column
        """Column in the line, from 1; 0: unknown."""
        place = ":".join([file] + [str(number) for number in (line, column) if number]) if file else ""
        super().__init__(f"{place}: {message}" if place else message)

    def __reduce__(self) -> tuple[type[Error], tuple[object, ...]]:
        return type(self), (self.message, self.file, self.line, self.column)


class OtherError(Error):
    """A file that cannot be written, too little memory, or any other error (status 1)."""


class UsageError(Error, ValueError):
    """An argument that is not allowed (status 2)."""

    status = 2


class InputError(Error, ValueError):
    """A file that is missing or has invalid contents (status 3)."""

    status = 3


class ScenarioError(InputError):
    """A scenario with errors, all reported together (status 3)."""

    def __init__(self, problems: list[Problem]) -> None:
        lines = [":".join(filter(None, (p.file, str(p.line or ""), str(p.column or "")))) + f": {p.message}" for p in problems]
        super().__init__("\n".join(lines))
        self.problems = problems
        """The errors, in the order of the file."""
        if problems:
            self.file, self.line, self.column = problems[0].file, problems[0].line, problems[0].column

    def __reduce__(self) -> tuple[type[Error], tuple[object, ...]]:
        return ScenarioError, (self.problems,)


class DeviceError(Error, RuntimeError):
    """A GPU that is missing, was lost, or has too little memory (status 4)."""

    status = 4


class CheckError(Error):
    """A check or bound that failed (status 5)."""

    status = 5


_CLASSES: dict[int, type[Error]] = {cls.status: cls for cls in (OtherError, UsageError, InputError, DeviceError, CheckError)}


def make(code: int, message: str, file: str, line: int, column: int) -> Error:
    """Returns the exception for an error of the extension; called by the extension."""
    return _CLASSES.get(code, OtherError)(message, file, line, column)
