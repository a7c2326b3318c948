"""What a file says, as plain mappings, lists and text: nothing of it is judged."""

from __future__ import annotations

from typing import Any

from calm.errors import InputError
from calm.files.document import Document
from calm.files.document import document_of as read_text

Location = tuple[str | int, ...]

_NAME = "the file"


def document_of(text: str) -> Document | None:
    """The document of a text; None where it cannot be read."""
    try:
        return read_text(_NAME, text)
    except InputError:
        return None


def written(text: str) -> dict[str, Any]:
    """What a text says; nothing where it cannot be read."""
    document = document_of(text)
    return {} if document is None else document.data


def at(text: str, location: Location) -> Any:
    """What stands at a place, such as ``("environment", "depth")``; None where nothing does."""
    found: Any = written(text)
    for key in location:
        if isinstance(found, dict):
            found = found.get(str(key))
        elif isinstance(found, list) and isinstance(key, int) and key < len(found):
            found = found[key]
        else:
            return None
    return found


def text_at(text: str, location: Location) -> str:
    """The value at a place as it is written; empty where there is none, or no plain value."""
    found = at(text, location)
    return found if isinstance(found, str) else ""


def is_tow(text: str) -> bool:
    """Whether it is the file of a tow."""
    return "tow" in written(text)
