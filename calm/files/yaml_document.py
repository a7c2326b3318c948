"""YAML text with the place of everything in it, and the guards against hostile or broken files.

Scalars are kept as the text the person wrote: what `1000` means is for the field to say. Anchors,
aliases and tags have no use in these files and are refused, so that nothing can be expanded.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from calm.errors import InputError, Problem
from calm.files import composition
from calm.files.composition import Node
from calm.whole_file import read_text

LineAndColumn = tuple[int, int]
Location = tuple[str | int, ...]


@dataclass(frozen=True)
class Document:
    """Hold a YAML file as plain data, with places counted from 1.

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
    values: dict[Location, LineAndColumn] = field(default_factory=dict, repr=False)
    keys: dict[Location, LineAndColumn] = field(default_factory=dict, repr=False)

    def problem(
        self, location: Sequence[str | int], message: str, *, key: bool = False, lacks: str = ""
    ) -> Problem:
        """Put a problem at a value (or its key), or at the nearest thing around it that exists.

        Parameters
        ----------
        location : of the value, below this
        message : for people
        key : put it at the key of the value
        lacks : what is missing, where nothing is wrong
        """
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
    return compose(str(path), read_text(path))


def compose(name: str, text: str) -> Document:
    """Return the document of a text, as that of a file or in place of one.

    Parameters
    ----------
    name : of the file, as messages show it

    Raises
    ------
    InputError
        It is no valid YAML, or holds duplicate keys.
    """
    root, refusals = composition.compose(text.removeprefix("\ufeff"))
    if root is not None and root.kind != "mapping":
        message = "must hold `key: value` lines at its top level"
        raise InputError([Problem(name, 1, 1, message)])
    if refusals:
        raise InputError([Problem(name, *refusal) for refusal in refusals])
    if root is None:
        raise InputError([Problem(name, 0, 0, "is empty")])
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


@dataclass(frozen=True)
class SourceMapping:
    """Represent a mapping within a document, possibly laid over a mapping of another one.

    Attributes
    ----------
    document, location
        Where the mapping (the upper one) stands; problems without a key are put there.
    data : dict
        The mapping, its own keys over those it overlays.
    base : Section or None
        What lies below.
    """

    document: Document
    location: Location
    data: dict[str, Any]
    base: SourceMapping | None = None
    own: frozenset[str] = field(default_factory=frozenset)

    @classmethod
    def of(cls, document: Document, location: Location, data: dict[str, Any]) -> SourceMapping:
        """Return the mapping `data` that stands at `location` of a document.

        Parameters
        ----------
        document : that holds it
        location : in the document
        data : the mapping
        """
        return cls(document, location, data, None, frozenset(data))

    def over(self, base: SourceMapping, *, dropping: frozenset[str] = frozenset()) -> SourceMapping:
        """Lay this mapping over another one, of which some keys are dropped."""
        kept = {key: value for key, value in base.data.items() if key not in dropping}
        return SourceMapping(self.document, self.location, {**kept, **self.data}, base, self.own)

    def child(self, key: str) -> SourceMapping:
        """Return the mapping under a key."""
        home = self.home(key)
        return SourceMapping.of(home.document, (*home.location, key), self.data[key])

    def home(self, key: str | int) -> SourceMapping:
        """Return the layer that a key comes from."""
        if self.base is None or key in self.own or key not in self.data:
            return self
        return self.base.home(key)

    def problem(
        self, location: Sequence[str | int], message: str, *, key: bool = False, lacks: str = ""
    ) -> Problem:
        """Return a problem at a value below this mapping, or at its key.

        Parameters
        ----------
        location : of the value, below this
        message : for people
        key : put it at the key of the value
        lacks : what is missing, where nothing is wrong
        """
        home = self.home(location[0]) if location else self
        place = (*home.location, *location)
        return home.document.problem(place, message, key=key, lacks=lacks)
