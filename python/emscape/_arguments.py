"""Arguments of the package's functions as the extension takes them."""

from __future__ import annotations

import os
from collections.abc import Sequence
from typing import Any, Union

from ._errors import UsageError

PathName = Union[str, bytes, "os.PathLike[str]", "os.PathLike[bytes]"]
"""Name of a file or folder."""


def utf8(text: str) -> str:
    """The text itself. Raises UsageError if it has bytes of a file name that are not UTF-8."""
    try:
        text.encode("utf-8")
    except UnicodeEncodeError:
        raise UsageError(f"{os.fsencode(text)!r} is not UTF-8, as names of files must be") from None
    return text


def path_text(file: PathName) -> str:
    """Name of a file or folder as a text. Raises UsageError if it is empty or not UTF-8."""
    text = utf8(os.fsdecode(file))
    if not text:
        raise UsageError("the name of a file or folder is empty")
    return text


def listed(names: str | Sequence[Any]) -> list[Any]:
    """Names as a list; a text is one name, an empty text none."""
    if isinstance(names, str):
        return [names] if names else []
    return list(names)


def distinct(names: str | Sequence[str], argument: str) -> list[str]:
    """As ``listed``. Raises UsageError for a name that is given twice.

    :param argument: its name, for the message
    """
    items = listed(names)
    for i, name in enumerate(items):
        if name in items[:i]:
            raise UsageError(f"{argument}: '{name}' is given twice")
    return items
