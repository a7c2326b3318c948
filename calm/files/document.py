"""YAML text with the place of everything in it, and the guards against hostile or broken files.

Scalars are kept as the text the person wrote: what `1000` means is for the field to say. Anchors,
aliases and tags have no use in these files and are refused, so that nothing can be expanded.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from functools import lru_cache
from pathlib import Path
from typing import Any

from ruamel.yaml.error import MarkedYAMLError, YAMLError

from calm.errors import InputError, Problem
from calm.files import composition
from calm.files.composition import Composition, compose_whole
from calm.files.nodes import Node

LARGEST_FILE = 1_000_000
"""Bytes; a file of text larger than this is not read."""

Place = tuple[int, int]
Location = tuple[str | int, ...]


@dataclass(frozen=True)
class Document:
    """A YAML file as plain data, with places counted from 1.

    Attributes
    ----------
    path : str
        As messages show it.
    data : dict
        Mappings, lists, text and None.
    values, keys : dict
        The place of every value and of every key, by its location: ``("line", 0, "use")``.
    """

    path: str
    data: dict[str, Any]
    values: dict[Location, Place] = field(default_factory=dict, repr=False)
    keys: dict[Location, Place] = field(default_factory=dict, repr=False)

    def problem(
        self, location: Sequence[str | int], message: str, *, key: bool = False, lacks: str = ""
    ) -> Problem:
        """A problem at a value (or at its key), or at the nearest thing around it that exists."""
        location = tuple(location)
        places = self.keys if key else self.values
        while location and location not in places:
            location = location[:-1]
        line, column = places.get(location) or self.values.get(location, (0, 0))
        return Problem(self.path, line, column, message, lacks)


def read_document(path: Path) -> Document:
    """Read a YAML file whose top level is a mapping.

    Raises
    ------
    InputError
        The file cannot be read, is no text, no valid YAML, or holds duplicate keys.
    """
    return _composed(str(path), read_text(path))


def compose(name: str, text: str) -> Document:
    """The document of a text.

    Parameters
    ----------
    name : of the file, as messages show it

    Raises
    ------
    InputError
        It is no valid YAML, or holds duplicate keys.
    """
    return _document(name, text, compose_whole)


_composed = lru_cache(maxsize=32)(compose)
"""A mooring that is read in many environments is composed once."""


@lru_cache(maxsize=8)
def document_of(name: str, text: str) -> Document:
    """The document of a text that stands in place of a file's content.

    It is read again and again as a person edits it, and only what changed is composed.
    """
    return _document(name, text.removeprefix("\ufeff"), composition.compose)


def _document(name: str, text: str, read: Callable[[str], Composition]) -> Document:
    try:
        composed = read(text)
    except MarkedYAMLError as error:
        raise InputError(_syntax_problems(name, text, error)) from None
    except RecursionError:
        raise InputError([Problem(name, 0, 0, "is nested too deeply")]) from None
    except (YAMLError, ValueError, IndexError) as error:
        first_line = str(error).partition("\n")[0]
        raise InputError([Problem(name, 0, 0, f"is not valid YAML: {first_line}")]) from None
    root = composed.root
    if root is None:
        raise InputError([Problem(name, 0, 0, "is empty")])
    if root.kind != "mapping":
        message = "must hold `key: value` lines at its top level"
        raise InputError([Problem(name, 1, 1, message)])
    if composed.refusals:
        raise InputError([Problem(name, *refusal) for refusal in composed.refusals])
    document = Document(name, root.data)
    _note_places(document, root, ())
    return document


def _note_places(document: Document, node: Node, location: Location) -> None:
    """Note where a value is, and all below it; one that is empty is where its key is."""
    document.values[location] = node.line, node.column
    if node.kind == "sequence":
        for index, child in enumerate(node.children):
            _note_places(document, child, (*location, index))
        return
    for key, child in zip(node.keys, node.children, strict=True):
        below = (*location, key.data)
        document.keys[below] = key.line, key.column
        _note_places(document, child, below)
        if child.data is None:
            document.values[below] = key.line, key.column


def read_text(path: Path, *, largest: int = LARGEST_FILE) -> str:
    """Read a small UTF-8 text file, or raise InputError."""
    return decoded(path, read_content(path, largest=largest)).removeprefix("\ufeff")


def read_content(path: Path, *, largest: int = LARGEST_FILE) -> bytes:
    """The bytes of a small regular file, or raise InputError; nothing else is opened."""
    try:
        if path.is_dir():
            raise _refused(path, "is a folder; a file is needed")
        if not path.is_file():
            raise _refused(path, "is not a regular file" if path.exists() else "no such file")
        if path.stat().st_size > largest:
            megabytes = path.stat().st_size / 1e6
            message = f"is {megabytes:.1f} MB; more than {largest / 1e6:g} MB is not read"
            raise _refused(path, message)
        return path.read_bytes()
    except (OSError, ValueError) as error:
        reason = getattr(error, "strerror", None) or str(error)
        raise _refused(path, f"cannot be read: {reason}") from None


def decoded(path: Path, content: bytes) -> str:
    """The text of a file with its byte order mark, or raise InputError."""
    if b"\0" in content:
        raise _refused(path, "is a binary file; text is needed")
    try:
        return content.decode()
    except UnicodeDecodeError as error:
        line = content.count(b"\n", 0, error.start) + 1
        raise _refused(path, "is not UTF-8 text; save it as UTF-8", line) from None


def _refused(path: Path, message: str, line: int = 0) -> InputError:
    return InputError([Problem(str(path), line, 1 if line else 0, message)])


def _syntax_problems(name: str, text: str, error: MarkedYAMLError) -> list[Problem]:
    """Tabs in the indentation are the usual cause and are all shown; else what the parser says."""
    mark = error.problem_mark or error.context_mark
    if "\\t" in str(error.problem):
        lines = text.splitlines()
        found = [
            Problem(name, number, line.index("\t") + 1, "a tab; YAML is indented with spaces")
            for number, line in enumerate(lines, 1)
            if "\t" in line[: len(line) - len(line.lstrip())]
        ]
        if found:
            return found
    line, column = (mark.line + 1, mark.column + 1) if mark else (0, 0)
    what = str(error.problem or error.context)
    if error.context and error.context_mark and error.problem:
        what = f"{error.context} from line {error.context_mark.line + 1}, {what}"
    return [Problem(name, line, column, f"is not valid YAML: {what}")]
