"""Definitions of components as written: the entries of catalogue files, by id."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import zip_longest
from pathlib import Path
from typing import NamedTuple

from calm.errors import InputError, Problem
from calm.files.document import Document, compose, read_document
from calm.files.section import Section
from calm.whole_file import read_text

FAMILY_ROLES = {
    "floats": "float",
    "instruments": "instrument",
    "releases": "release",
    "ropes": "line",
    "chains": "line",
    "connectors": "connector",
    "anchors": "anchor",
}
"""The families of the catalogue, one file each, and what their components are for."""

_HEAD = re.compile(r"^(?=[^ \n#])(?:([\w.-]+): *(?:#.*)?$)?", re.MULTILINE | re.ASCII)
"""A line that is not indented; its group is the id where it is one and nothing else."""


@dataclass(frozen=True)
class Entry:
    """A definition as written, with the name of the family (the file) it belongs to."""

    id: str
    family: str | None
    section: Section

    @property
    def place(self) -> str:
        """Where the definition is, for people."""
        place = self.section.problem((), "")
        return f"{place.path}:{place.line}" if place.line else place.path


Level = Mapping[str, Entry]


class _Cut(NamedTuple):
    """The text of one definition, and the lines of its file that are above it."""

    path: Path
    above: int
    text: str


class UnreadLevel(Level):
    """The entries of files whose mistakes need not be known before they matter.

    Only the ids are looked for beforehand, by the lines that are not indented; an entry is read
    when it is asked for. Where such a line is anything else, or an entry turns out to be wrong,
    all files are read whole. An id alone in a line within a text in quotes would be taken for one.

    Parameters
    ----------
    paths : of the files

    Raises
    ------
    InputError
        A file cannot be read; or, as soon as that is seen, with the mistakes of all.
    """

    def __init__(self, paths: Sequence[Path]) -> None:
        self._paths = paths
        self._read: dict[str, Entry] = {}
        cuts = [cut for path in paths for cut in _cuts(path)]
        self._cuts = {id: cut for id, cut in cuts if id}
        if len(self._cuts) < len(cuts):
            self._read_whole()

    def __getitem__(self, id: str) -> Entry:
        if id not in self._read:
            path, above, text = self._cuts[id]
            problems: list[Problem] = []
            try:
                document = compose(str(path), "\n" * above + text)
                for entry in _entries_of(document, problems):
                    self._read.setdefault(id, entry)
            except InputError as error:
                problems += error.problems
            if problems:
                self._read_whole()
        return self._read[id]

    def __iter__(self) -> Iterator[str]:
        return iter(self._cuts or self._read)

    def __len__(self) -> int:
        return len(self._cuts or self._read)

    def _read_whole(self) -> None:
        problems: list[Problem] = []
        self._cuts = {}
        self._read = dict(read_level(self._paths, problems))
        if problems:
            raise InputError(problems)


def read_level(paths: Iterable[Path], problems: list[Problem]) -> Level:
    """The entries of files, which together define an id once."""
    level: dict[str, Entry] = {}
    for path in paths:
        try:
            document = read_document(path)
        except InputError as error:
            problems.extend(error.problems)
            continue
        for entry in _entries_of(document, problems):
            if entry.id in level:
                message = f"`{entry.id}` is defined already, in {level[entry.id].place}"
                problems.append(document.problem((entry.id,), message, key=True))
            else:
                level[entry.id] = entry
    return level


def entries_of(definitions: Section, family: str | None, problems: list[Problem]) -> list[Entry]:
    """The entries of a mapping of definitions by id."""
    entries = []
    for id, fields in definitions.data.items():
        if isinstance(fields, dict):
            entries.append(Entry(id, family, definitions.child(id)))
        else:
            problems.append(definitions.problem((id,), f"`{id}` must hold `key: value` entries"))
    return entries


def _entries_of(document: Document, problems: list[Problem]) -> list[Entry]:
    stem = Path(document.path).stem
    family = stem if stem in FAMILY_ROLES else None
    return entries_of(Section.of(document, (), document.data), family, problems)


def _cuts(path: Path) -> list[tuple[str | None, _Cut]]:
    """The text of each definition by its id, or by None where it does not begin plainly."""
    text = read_text(path)
    heads = list(_HEAD.finditer(text))
    cuts, above = [], text.count("\n", 0, heads[0].start()) if heads else 0
    for head, following in zip_longest(heads, heads[1:]):
        part = text[head.start() : following.start() if following else None]
        cuts.append((head[1], _Cut(path, above, part)))
        above += part.count("\n")
    return cuts
