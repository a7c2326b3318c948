"""The component catalogue: shipped, the user's own, files given with a command, and in-file ones.

Definitions are kept as written and validated when they are asked for, so that a run pays only for
the components it uses.
"""

from __future__ import annotations

import os
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import islice
from pathlib import Path
from typing import Any, Literal

from pydantic import Field

from calm.errors import InputError, Problem, UsageError
from calm.files.components import KINDS, Component
from calm.files.definition import Definition
from calm.files.entries import FAMILY_ROLES, Entry, Level, UnreadLevel, entries_of, read_level
from calm.files.explain import validate
from calm.files.section import Section
from calm.files.unchanged import Unchanged
from calm.shipped import shipped_folder
from calm.suggestions import nearest, shown, unknown


class Assembly(Definition):
    """Pieces that are always used together; `parts` are items as in the `line` of a mooring."""

    kind: Literal["assembly"] = Field(description="which kind of component it is")
    parts: tuple[dict[str, Any], ...] = Field(
        description="pieces as in `line`, from the top",
        examples=[[{"use": "glass-17in", "count": 2}, {"use": "chain-13", "length": "1 m"}]],
    )


@dataclass(frozen=True)
class Catalogue:
    """Component definitions in levels, the nearest first: it hides those of the same id below."""

    levels: tuple[Level, ...]

    @classmethod
    def load(cls, files: Sequence[str | Path] = ()) -> Catalogue:
        """The shipped catalogue, under the user's own, under the files given (the last on top).

        Raises
        ------
        InputError
            A catalogue of the user cannot be read.
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
        """The catalogue that comes with CALM."""
        return cls((UnreadLevel(_shipped_files()),))

    def under(self, definitions: Section, problems: list[Problem]) -> Catalogue:
        """This catalogue under the `components:` of a mooring file."""
        entries = entries_of(definitions, None, problems)
        return Catalogue(({entry.id: entry for entry in entries}, *self.levels))

    def ids(self) -> list[str]:
        """Every id, in the order of the files."""
        return list(dict.fromkeys(id for level in reversed(self.levels) for id in level))

    def entry(self, id: str) -> Entry | None:
        """The definition of an id as written; None when there is none."""
        return next(self._of(id), None)

    def hidden(self, id: str) -> Entry | None:
        """The definition that a nearer one of the same id hides."""
        return next(islice(self._of(id), 1, None), None)

    def _of(self, id: str) -> Iterator[Entry]:
        """The definitions of an id, the nearest first."""
        return (level[id] for level in self.levels if id in level)

    def _all(self) -> dict[str, Entry]:
        return {id: next(self._of(id)) for id in self.ids()}

    def nearest(self, id: str) -> str | None:
        """The id most like a text."""
        return nearest(id, self.ids())

    def get(self, id: str) -> Component | Assembly:
        """A component or assembly, validated.

        Raises
        ------
        UsageError
            There is no such id.
        InputError
            Its definition is wrong.
        """
        entry = self.entry(id)
        if entry is None:
            raise UsageError(unknown(f"no component is called `{id}`", id, self.ids()))
        problems: list[Problem] = []
        definition = define(entry, entry.section, problems)
        if definition is None:
            raise InputError(problems)
        return definition

    def all(self) -> dict[str, Component | Assembly]:
        """Every component and assembly, validated.

        Raises
        ------
        InputError
            With the mistakes of all definitions.
        """
        problems: list[Problem] = []
        found = {
            id: definition
            for id, entry in self._all().items()
            if (definition := define(entry, entry.section, problems)) is not None
        }
        if problems:
            raise InputError(problems)
        return found

    def same_thing(self, id: str) -> list[str]:
        """The ids that describe the thing an id does, the one to use first; the id alone if none.

        Those are the id that it prefers and all that prefer the same.
        """
        preferred = {each: entry.section.data.get("prefer") for each, entry in self._all().items()}
        first = preferred.get(id) or id
        return [first, *(each for each, other in preferred.items() if other == first)]

    def search(self, words: Iterable[str]) -> list[str]:
        """The ids whose definition (or family) holds every one of the words."""
        wanted = [word.casefold() for word in words]
        return [
            id
            for id, entry in self._all().items()
            if all(word in _searchable(entry) for word in wanted)
        ]


_LOADED: Unchanged[Catalogue] = Unchanged()


def _shipped_files() -> list[Path]:
    return sorted(shipped_folder("catalog").glob("*.yaml"))


def user_folder() -> Path:
    """The folder of the user's own catalogue: `CALM_CATALOG_DIR`, or one in the home folder."""
    if folder := os.environ.get("CALM_CATALOG_DIR"):
        return Path(folder)
    configuration = os.environ.get("XDG_CONFIG_HOME") or os.path.expanduser("~/.config")
    return Path(configuration) / "calm" / "catalog"


def define(
    entry: Entry,
    section: Section,
    problems: list[Problem],
    *,
    also_allowed: Iterable[str] = (),
    context: Mapping[str, object] | None = None,
) -> Component | Assembly | None:
    """The model of an entry, or of a section laid over it; None when it has mistakes.

    `context` is None or, where it is to be used in air, `IN_AIR`.
    """
    kind = section.data.get("kind")
    if kind is None:
        problems.append(section.problem((), f"`{entry.id}`: `kind` is missing ({_kinds()})"))
        return None
    if not isinstance(kind, str) or kind not in (*KINDS, "assembly"):
        text = shown(kind)
        near = nearest(text, KINDS)
        offer = f"; did you mean `kind: {near}`?" if near else ""
        message = f"`kind: {text}` must be one of {_kinds()}{offer}"
        problems.append(section.problem(("kind",), message))
        return None
    role = FAMILY_ROLES.get(entry.family or "")
    if role and "role" not in section.data:
        family_default = Section.of(section.document, section.location, {"role": role})
        section = section.over(family_default)
    if kind == "assembly":
        return validate(Assembly, section, problems)
    return validate(KINDS[kind], section, problems, also_allowed=also_allowed, context=context)


def _kinds() -> str:
    return ", ".join([*KINDS, "assembly"])


def _searchable(entry: Entry) -> str:
    texts = [value for value in entry.section.data.values() if isinstance(value, str)]
    return " ".join([entry.id, entry.family or "", *texts]).casefold()
