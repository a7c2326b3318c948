"""The catalogue as it is searched: by id, name, maker and kind, and what each component is for."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property

from calm.errors import InputError
from calm.files.catalogue import Catalogue
from calm.files.document import compose
from calm.files.entries import FAMILY_ROLES, Entry
from calm.files.section import Section

_ROLES = {"cable": "line", "chain": "line", "anchor": "anchor"}
CLAMPABLE = frozenset({"sphere", "cylinder", "body"})
WITH_LENGTH = frozenset({"cable", "chain"})
_BETWEEN = re.compile(r"[\s_-]+")


@dataclass(frozen=True)
class Listed:
    """A component as the list shows it."""

    id: str
    name: str
    maker: str
    kind: str
    role: str
    own: bool

    @cached_property
    def searched(self) -> str:
        """All that the words are looked for in."""
        return " ".join((self.id, self.name, self.maker, self.kind, self.role)).casefold()


class Index:
    """The components that a line can use, in the order of the catalogue, the file's own first."""

    def __init__(self, catalogue: Catalogue) -> None:
        self.catalogue = catalogue
        shipped = catalogue.levels[-1]
        found = [
            _listed(entry, shipped) for id in catalogue.ids() if (entry := catalogue.entry(id))
        ]
        self._listed = {each.id: each for each in sorted(found, key=lambda each: not each.own)}

    @classmethod
    def of(cls, catalogue: Catalogue, text: str) -> Index:
        """The index of a catalogue under the `components:` of a mooring file that can be read."""
        try:
            document = compose("", text)
        except InputError:
            return cls(catalogue)
        if isinstance(document.data.get("components"), dict):
            definitions = Section.of(document, (), document.data).child("components")
            catalogue = catalogue.under(definitions, [])
        return cls(catalogue)

    def get(self, id: str) -> Listed | None:
        """One component; None where there is none of that id."""
        return self._listed.get(id)

    def search(self, text: str, kinds: Iterable[str] | None = None) -> list[Listed]:
        """Those that hold every word of a text; first those whose id begins with it.

        Hyphens part words as blanks do: makers, catalogues and people set them differently.
        """
        words = [word for word in _BETWEEN.split(text.casefold()) if word]
        wanted = None if kinds is None else frozenset(kinds)
        hits = [
            each
            for each in self._listed.values()
            if (wanted is None or each.kind in wanted)
            and all(word in each.searched for word in words)
        ]
        return sorted(hits, key=lambda each: _rank(each, words)) if words else hits


def _rank(each: Listed, words: Sequence[str]) -> int:
    """How well a component fits: its id, the beginning of it, all words in it, elsewhere."""
    joined, id = "".join(words), _BETWEEN.sub("", each.id)
    if id == joined:
        return 0
    if id.startswith(joined):
        return 1
    return 2 if all(word in each.id for word in words) else 3


def _listed(entry: Entry, shipped: object) -> Listed:
    fields = entry.section.data

    def text(key: str) -> str:
        value = fields.get(key)
        return " ".join(value.split()) if isinstance(value, str) else ""

    role = text("role") or FAMILY_ROLES.get(entry.family or "", "")
    own = not (isinstance(shipped, Mapping) and shipped.get(entry.id) is entry)
    return Listed(
        id=entry.id,
        name=text("name"),
        maker=text("manufacturer"),
        kind=text("kind"),
        role=role or _ROLES.get(text("kind"), "instrument"),
        own=own,
    )
