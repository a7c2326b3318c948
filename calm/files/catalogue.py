"""Component catalogue in levels: mooring file, given files, the user's folder, and shipped files.

Definitions are kept as text and validated on first use.
"""

from __future__ import annotations

import os
import re
import unicodedata
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import islice, zip_longest
from pathlib import Path
from typing import Any, Literal

from pydantic import Field

from calm.errors import InputError, Problem, UsageError, nearest, shown, unknown
from calm.files.components import KINDS, Component, Outline, contradicted, lacking
from calm.files.definition import Definition, described
from calm.files.yaml_document import Document, SourceMapping, compose, read_document, validate
from calm.shipped import shipped_folder
from calm.whole_file import FileCache, read_text

FAMILY_ROLES = {
    "floats": "float",
    "instruments": "instrument",
    "releases": "release",
    "ropes": "line",
    "chains": "line",
    "connectors": "connector",
    "anchors": "anchor",
}
"""Catalogue families, one file each, and the role of their components."""

_HEAD = re.compile(r"^(?=[^ \n#])(?:([\w.-]+): *(?:#.*)?$)?", re.MULTILINE | re.ASCII)
"""Pattern of an unindented line; its group is the id if the line contains only an id."""


class Assembly(Definition):
    """A group of pieces that are always used together, written like the items of a `line`."""

    kind: Literal["assembly"] = Field(description="kind of the component")
    parts: tuple[dict[str, Any], ...] = described(
        "pieces from the top down, in the form of `line`",
        [{"use": "glass-17in", "count": 2}, {"use": "chain-13", "length": "1 m"}],
    )


Defined = Component | Assembly | Outline


@dataclass(frozen=True)
class Catalogue:
    """Component definitions in levels, the level with the highest precedence first.

    A definition hides all definitions with the same id in later levels.
    """

    levels: tuple[Level, ...]

    @classmethod
    def load(cls, files: Sequence[str | Path] = ()) -> Catalogue:
        """Load the catalogue.

        The last of the `files` has the highest precedence. All `files` precede the user's catalogue
        folder, which precedes the shipped files.

        Raises
        ------
        InputError
            A file cannot be read or has mistakes.
        """
        folder = user_folder()
        own = sorted(folder.glob("*.yaml")) if folder.is_dir() else []
        given = [Path(path) for path in files]

        def read() -> Catalogue:
            problems: list[Problem] = []
            levels = [read_level([path], problems) for path in reversed(given)]
            if own:
                levels.append(read_level(own, problems))
            if problems:
                raise InputError(problems)
            return cls((*levels, *cls.shipped().levels))

        return _LOADED.of([*given, *own, *_shipped_files()], read)

    @classmethod
    def shipped(cls) -> Catalogue:
        """Return the catalogue that comes with CALM."""
        return cls((UnreadLevel(_shipped_files()),))

    def under(self, definitions: SourceMapping) -> Catalogue:
        """Return this catalogue with the `components:` of a mooring file as its first level."""
        entries = map(self._completed, entries_of(definitions, None))
        return Catalogue(({entry.id: entry for entry in entries}, *self.levels))

    def _completed(self, entry: CatalogueEntry) -> CatalogueEntry:
        """Add missing keys to an entry that has no `kind`.

        The keys are taken from the definition with the same id in this catalogue.
        """
        below = self.entry(entry.id)
        given = {key: value for key, value in entry.section.data.items() if value is not None}
        section = entry.section.holding(given)
        kind = None if below is None else below.section.data.get("kind")
        if below is None or "kind" in given or kind not in KINDS:
            return CatalogueEntry(entry.id, entry.family, section)
        void = contradicted(str(kind), below.section.data.keys(), given.keys())
        whole = section.over(below.section, dropping=void)
        return CatalogueEntry(entry.id, below.family, whole)

    def ids(self) -> list[str]:
        """Return all ids, last level first, and in file order within a level."""
        return list(dict.fromkeys(id for level in reversed(self.levels) for id in level))

    def entry(self, id: str) -> CatalogueEntry | None:
        """Return the unvalidated definition with an id, or None if the id is unknown."""
        return next(self._of(id), None)

    def hidden(self, id: str) -> CatalogueEntry | None:
        """Return the next definition of an id below the definition in use.

        Return None if the id has only one definition.
        """
        return next(islice(self._of(id), 1, None), None)

    def _of(self, id: str) -> Iterator[CatalogueEntry]:
        return (level[id] for level in self.levels if id in level)

    def _all(self) -> dict[str, CatalogueEntry]:
        return {id: next(self._of(id)) for id in self.ids()}

    def nearest(self, id: str) -> str | None:
        """Return the known id with the most similar spelling, or None if no id is similar."""
        return nearest(id, self.ids())

    def of_a_sort(self, word: str) -> list[str]:
        """Return up to six ids of components whose family, role or kind is the given word."""
        sort = word.casefold().rstrip("s")
        return [
            id
            for id, entry in self._all().items()
            if "prefer" not in entry.section.data
            and sort
            in {(entry.family or "").rstrip("s"), *map(entry.section.data.get, ("role", "kind"))}
        ][:6]

    def get(self, id: str) -> Defined:
        """Return the validated definition of an id.

        Raises
        ------
        UsageError
            No component has this id.
        InputError
            The definition has mistakes.
        """
        entry = self.entry(id)
        if entry is None:
            raise UsageError(unknown(f"no component is called `{id}`", id, self.ids()))
        problems: list[Problem] = []
        definition = define(entry, entry.section.into(problems))
        if definition is None:
            raise InputError(problems)
        return definition

    def all(self) -> dict[str, Defined]:
        """Validate all definitions of the catalogue, and return them by id.

        Raises
        ------
        InputError
            Definitions have mistakes; all mistakes are listed.
        """
        problems: list[Problem] = []
        found = {
            id: definition
            for id, entry in self._all().items()
            if (definition := define(entry, entry.section.into(problems))) is not None
        }
        if problems:
            raise InputError(problems)
        return found

    def same_thing(self, id: str) -> list[str]:
        """Return the ids of all definitions of the product that `id` defines.

        The preferred id is the first. The other definitions contain this id in the key `prefer`.
        """
        preferred = {each: entry.section.data.get("prefer") for each, entry in self._all().items()}
        first = preferred.get(id) or id
        return [first, *(each for each, other in preferred.items() if other == first)]


def _shipped_files() -> list[Path]:
    return sorted(shipped_folder("catalog").glob("*.yaml"))


def user_folder() -> Path:
    """Return the folder of the user's catalogue.

    The folder is `CALM_CATALOG_DIR`, or `calm/catalog` in the user's configuration folder.
    """
    if folder := os.environ.get("CALM_CATALOG_DIR"):
        return Path(folder)
    configuration = os.environ.get("XDG_CONFIG_HOME") or os.path.expanduser("~/.config")
    return Path(configuration) / "calm" / "catalog"


def define(
    entry: CatalogueEntry,
    section: SourceMapping,
    *,
    also_allowed: Iterable[str] = (),
    context: Mapping[str, object] | None = None,
) -> Defined | None:
    """Validate a definition; return the component that it defines.

    Return None if the definition has mistakes. The mistakes are recorded in `section`.

    Parameters
    ----------
    section : section of the entry in its file, or overrides of the values in that section
    also_allowed : additional keys that messages about an unknown key may suggest
    context : `IN_AIR` for a component used in air, otherwise None
    """
    kind = section.data.get("kind")
    if kind is None:
        section.refuse((), f"`{entry.id}`: `kind` is missing ({_kinds()})")
        return None
    if not isinstance(kind, str) or kind not in (*KINDS, "assembly"):
        text = shown(kind)
        near = nearest(text, KINDS)
        offer = f"; did you mean `kind: {near}`?" if near else ""
        section.refuse(("kind",), f"`kind: {text}` must be one of {_kinds()}{offer}")
        return None
    role = FAMILY_ROLES.get(entry.family or "")
    if role and "role" not in section.data:
        section = section.over(section.holding({"role": role}))
    if kind == "assembly":
        return validate(Assembly, section)
    if lacking(section.data):
        return validate(Outline, section)
    return validate(KINDS[kind], section, also_allowed=also_allowed, context=context)


def _kinds() -> str:
    return ", ".join([*KINDS, "assembly"])


@dataclass(frozen=True, eq=False)
class CatalogueEntry:
    """Unvalidated definition of a component.

    `family` is the name of the catalogue file, or None if this name is not a known family.
    """

    id: str
    family: str | None
    section: SourceMapping

    @property
    def replaces(self) -> list[str]:
        """Keys that override the base definition, without keys such as `source` and `note`."""
        base = self.section.base
        given = frozenset[str]() if base is None else self.section.own & base.data.keys()
        return sorted(given - {"source", "sources", "searched", "note", "date"})

    @property
    def place(self) -> str:
        """File and line of the definition, for messages."""
        place = self.section.problem((), "")
        return f"{place.path}:{place.line}" if place.line else place.path


Level = Mapping[str, CatalogueEntry]


class UnreadLevel(Level):
    """Entries of catalogue files; each entry is parsed when it is first used.

    Ids are recognised as unindented lines. In a quoted text, an unindented line that looks like an
    id is mistaken for a definition.

    Raises
    ------
    InputError
        A file cannot be read or has mistakes; the mistakes of all files are listed.
    """

    def __init__(self, paths: Sequence[Path]) -> None:
        self._paths = paths
        self._read: dict[str, CatalogueEntry] = {}
        cuts = [(id, path, cut) for path in paths for id, cut in _cuts(path)]
        self._cuts = {id: (path, cut) for id, path, cut in cuts if id}
        if len(self._cuts) < len(cuts):
            self._read_whole()

    def __getitem__(self, id: str) -> CatalogueEntry:
        if id not in self._read:
            path, cut = self._cuts[id]
            problems: list[Problem] = []
            try:
                document = compose(str(path), cut)
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
    """Read the entries of several catalogue files by id. Mistakes are added to `problems`.

    An id that is defined twice is a mistake.
    """
    level: dict[str, CatalogueEntry] = {}
    for path in paths:
        try:
            document = read_document(path)
        except InputError as error:
            problems.extend(error.problems)
            continue
        for entry in _entries_of(document, problems):
            if entry.id in level:
                message = f"`{entry.id}` is already defined, in {level[entry.id].place}"
                problems.append(document.problem((entry.id,), message, key=True))
            else:
                level[entry.id] = entry
    return level


def entries_of(definitions: SourceMapping, family: str | None) -> list[CatalogueEntry]:
    """Return the catalogue entries in a mapping from ids to definitions.

    `family` is the catalogue family; None for `components:` of a mooring file.
    """
    entries = []
    for id, fields in definitions.data.items():
        if isinstance(fields, dict):
            entries.append(CatalogueEntry(id, family, definitions.child(id)))
        else:
            definitions.refuse((id,), f"`{shown(id)}` must hold `key: value` entries")
    return entries


def _entries_of(document: Document, problems: list[Problem]) -> list[CatalogueEntry]:
    stem = Path(document.path).stem
    family = stem if stem in FAMILY_ROLES else None
    return entries_of(SourceMapping.of(document, problems), family)


def _cuts(path: Path) -> Iterator[tuple[str | None, str]]:
    """Yield the id and the text of each definition in a file.

    The id is None if it cannot be recognised. Empty lines are put before each text, so that line
    numbers in the text equal those in the file.
    """
    text = read_text(path)
    heads, above, end = list(_HEAD.finditer(text)), 0, 0
    for head, following in zip_longest(heads, heads[1:]):
        above += text.count("\n", end, head.start())
        end = head.start()
        yield head[1], "\n" * above + text[end : following.start() if following else None]


_LOADED: FileCache[Catalogue] = FileCache()


def defined(id: str, values: Mapping[str, Any]) -> tuple[Component | None, tuple[Problem, ...]]:
    """Build a component from its values; return the component and any mistakes in the values.

    The component is None if the values have mistakes, or if they define an assembly or outline.
    """
    problems: list[Problem] = []
    section = SourceMapping.of(Document(id, {id: dict(values)}), problems).child(id)
    definition = define(CatalogueEntry(id, None, section), section)
    return (definition if isinstance(definition, Component) else None), tuple(problems)


_LETTERS = str.maketrans(
    {"ø": "o", "æ": "ae", "œ": "oe", "đ": "d", "ð": "d", "þ": "th", "ł": "l", "ı": "i", "⁄": "-"}
)
"""ASCII replacements for letters such as ø, and for the fraction slash.

Unicode normalisation does not split these letters into a plain letter and an accent.
"""


def tidy_id(text: str) -> str:
    """Convert a text to an id: lower-case letters without accents, digits and hyphens.

    ``Bøye 1½"`` becomes ``boye-1-1-2``.
    """
    decomposed = unicodedata.normalize("NFKD", re.sub(r"(?<=\d)(?=[¼-¾⅐-⅞])", " ", text).casefold())
    plain = re.sub(r"[\u0300-\u036f]", "", decomposed).translate(_LETTERS)
    return re.sub(r"[^a-z0-9]+", "-", plain).strip("-")
