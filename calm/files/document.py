"""YAML text with the place of everything in it, and the guards against hostile or broken files.

Scalars are kept as the text the person wrote: what `1000` means is for the field to say. Anchors,
aliases and tags have no use in these files and are refused, so that nothing can be expanded.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import lru_cache
from pathlib import Path
from typing import Any

from ruamel.yaml import YAML
from ruamel.yaml.error import MarkedYAMLError, YAMLError
from ruamel.yaml.nodes import MappingNode, Node, ScalarNode, SequenceNode

from calm.errors import InputError, Problem
from calm.files import composition, nodes

LARGEST_FILE = 1_000_000
"""Bytes; a file of text larger than this is not read."""

Place = tuple[int, int]
Location = tuple[str | int, ...]

# They would move the cursor of a terminal, or turn the figures beside them round.
_CONTROL_CHARACTER = re.compile("[\x00-\x08\x0b\x0c\x0e-\x1f\x7f-\x9f\u202a-\u202e\u2066-\u2069]")

_NULL = "tag:yaml.org,2002:null"
_PLAIN_TAGS = frozenset(
    f"tag:yaml.org,2002:{kind}"
    for kind in ("map", "seq", "str", "int", "float", "bool", "null", "timestamp", "merge")
)


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
    try:
        root = YAML(typ="safe", pure=True).compose(text)
    except MarkedYAMLError as error:
        raise InputError(_syntax_problems(name, text, error)) from None
    except RecursionError:
        raise InputError([Problem(name, 0, 0, "is nested too deeply")]) from None
    except (YAMLError, ValueError, IndexError) as error:
        first_line = str(error).partition("\n")[0]
        raise InputError([Problem(name, 0, 0, f"is not valid YAML: {first_line}")]) from None
    if root is None:
        raise InputError([Problem(name, 0, 0, "is empty")])
    if not isinstance(root, MappingNode):
        message = "must hold `key: value` lines at its top level"
        raise InputError([Problem(name, 1, 1, message)])
    reader = _Composer(name)
    data = reader.convert(root, ())
    if reader.problems:
        raise InputError(reader.problems)
    return Document(name, data, reader.values, reader.keys)


_composed = lru_cache(maxsize=32)(compose)
"""A mooring that is read in many environments is composed once."""


@lru_cache(maxsize=8)
def document_of(name: str, text: str) -> Document:
    """The document of a text that stands in place of a file's content.

    It is read again and again as a person edits it, and only what changed is composed. What is
    told of a text with mistakes is what `compose` tells.
    """
    text = text.removeprefix("\ufeff")
    try:
        composed = composition.compose(text)
    except (YAMLError, ValueError, IndexError, RecursionError):
        return compose(name, text)
    root = composed.root
    if root is None or composed.refusals or root.kind != "mapping":
        return compose(name, text)
    document = Document(name, root.data)
    _note_places(document, root, ())
    return document


def _note_places(document: Document, node: nodes.Node, location: Location) -> None:
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

    def refuse(message: str, line: int = 0) -> InputError:
        return InputError([Problem(str(path), line, 1 if line else 0, message)])

    try:
        if path.is_dir():
            raise refuse("is a folder; a file is needed")
        if not path.is_file():
            raise refuse("is not a regular file" if path.exists() else "no such file")
        if path.stat().st_size > largest:
            megabytes = path.stat().st_size / 1e6
            raise refuse(f"is {megabytes:.1f} MB; more than {largest / 1e6:g} MB is not read")
        content = path.read_bytes()
    except (OSError, ValueError) as error:
        reason = getattr(error, "strerror", None) or str(error)
        raise refuse(f"cannot be read: {reason}") from None
    if b"\0" in content:
        raise refuse("is a binary file; text is needed")
    try:
        return content.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        line = content.count(b"\n", 0, error.start) + 1
        raise refuse("is not UTF-8 text; save it as UTF-8", line) from None


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


class _Composer:
    """Walks a composed YAML tree into plain data, noting places and everything not allowed."""

    def __init__(self, path: str) -> None:
        self.path = path
        self.values: dict[Location, Place] = {}
        self.keys: dict[Location, Place] = {}
        self.problems: list[Problem] = []
        self._refused: set[int] = set()

    def convert(self, node: Node, location: Location) -> Any:
        self.values[location] = place = (node.start_mark.line + 1, node.start_mark.column + 1)
        if node.anchor is not None:
            # An alias composes to the very node of its anchor: reported once, never followed.
            if id(node) not in self._refused:
                self._refused.add(id(node))
                self._refuse(place, "anchors (&) and aliases (*) are not allowed; write it out")
            return None
        if str(node.tag) not in _PLAIN_TAGS:
            self._refuse(place, f"tags (`{node.tag}`) are not allowed")
            return None
        if isinstance(node, MappingNode):
            return self._mapping(node, location)
        if isinstance(node, SequenceNode):
            return [self.convert(child, (*location, i)) for i, child in enumerate(node.value)]
        if str(node.tag) == _NULL:
            return None
        return _CONTROL_CHARACTER.sub("\N{REPLACEMENT CHARACTER}", node.value)

    def _mapping(self, node: MappingNode, location: Location) -> dict[str, Any]:
        data: dict[str, Any] = {}
        for key_node, value_node in node.value:
            place = (key_node.start_mark.line + 1, key_node.start_mark.column + 1)
            if not isinstance(key_node, ScalarNode):
                self._refuse(place, "a key must be plain text")
                continue
            key = key_node.value
            if key in data:
                first = self.keys[(*location, key)][0]
                self._refuse(place, f"`{key}` is given twice (first in line {first})")
                continue
            self.keys[(*location, key)] = place
            data[key] = self.convert(value_node, (*location, key))
            if data[key] is None:
                # The end of an empty value may be lines below its key.
                self.values[(*location, key)] = place
        return data

    def _refuse(self, place: Place, message: str) -> None:
        self.problems.append(Problem(self.path, *place, message))
