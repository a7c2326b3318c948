"""A mapping of a file that remembers where each of its keys stands, and may overlay another."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

from calm.errors import Problem
from calm.files.document import Document, Location


@dataclass(frozen=True)
class Section:
    """A mapping within a document, possibly laid over a mapping of another one.

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
    base: Section | None = None
    own: frozenset[str] = field(default_factory=frozenset)

    @classmethod
    def of(cls, document: Document, location: Location, data: dict[str, Any]) -> Section:
        """The mapping `data` that stands at `location` of a document."""
        return cls(document, location, data, None, frozenset(data))

    def over(self, base: Section, *, dropping: frozenset[str] = frozenset()) -> Section:
        """This mapping laid over another one, of which some keys are dropped."""
        kept = {key: value for key, value in base.data.items() if key not in dropping}
        return Section(self.document, self.location, {**kept, **self.data}, base, self.own)

    def child(self, key: str) -> Section:
        """The mapping under a key."""
        home = self.home(key)
        return Section.of(home.document, (*home.location, key), self.data[key])

    def home(self, key: str | int) -> Section:
        """The layer that a key comes from."""
        if self.base is None or key in self.own or key not in self.data:
            return self
        return self.base.home(key)

    def problem(
        self, location: Sequence[str | int], message: str, *, key: bool = False, lacks: str = ""
    ) -> Problem:
        """A problem at a value below this mapping, or at its key."""
        home = self.home(location[0]) if location else self
        place = (*home.location, *location)
        return home.document.problem(place, message, key=key, lacks=lacks)
