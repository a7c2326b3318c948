"""Search of the catalogue by id, name, manufacturer, size, kind, role and limits."""

from __future__ import annotations

import difflib
import operator
import re
from collections import Counter
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import cache, cached_property, lru_cache
from math import inf
from typing import Self

from calm.errors import InputError
from calm.files.catalogue import FAMILY_ROLES, Catalogue, CatalogueEntry
from calm.files.components import lacking
from calm.files.yaml_document import SourceMapping, compose
from calm.shipped import shipped_folder
from calm.units import QuantityError, parse_quantity

_ROLES = {"cable": "line", "chain": "line", "anchor": "anchor"}
_OTHER_FIELD_RANK = 4
"""Rank of a component whose id does not contain all words of the search."""
_SEPARATORS = re.compile(r"[\s_-]+")
_SIZE = re.compile(
    r"(?<![\w.,/])((?:\d+[ -])?\d+/\d+|\d+(?:[.,]\d+)?)[ -]?"
    r"(mm|cm|inch(?:es)?|in|\"|″|(?<=/\d)|(?<=/\d\d))(?!\w)"
)
"""Pattern of a number with its unit; a fraction without a unit is in inches."""
_OF_A_SIZE = 0.02
"""Relative difference up to which two sizes are treated as equal.

Sizes in millimetres and in inches are often rounded.
"""
_USE_KEY = re.compile(r"\buse: *([\w-]+)")
_MIN_SIMILARITY = 0.8
"""Similarity above which an unknown word is treated as misspelt: `releese` and `release`
have a similarity of 0.86.
"""
_MIN_SIMILARITY_SHORT = 0.75
"""Similarity above which a word of `_SHORT_WORD` letters is treated as misspelt, if its first
letter is right: `wyre` is read as `wire`, but `back` is not read as `pack`.
"""
_SHORT_WORD = 4
"""Number of letters below which an unknown word is never treated as misspelt."""
_SUGGESTED = 3
"""Number of components that are suggested for an unknown component."""


@dataclass(frozen=True)
class Listed:
    """A component in the catalogue list, with its searchable texts."""

    id: str
    name: str
    maker: str
    kind: str
    role: str
    own: bool
    material: str
    source: str
    diameter: float | None
    second: bool

    @cached_property
    def own_words(self) -> str:
        """Searchable text of id, name, maker, kind, role and material, with and without hyphens."""
        every = (self.id, self.name, self.maker, self.kind, self.role, self.material)
        own = " ".join(every).casefold()
        return f"{own} {own.replace('-', '')}"

    @cached_property
    def searched(self) -> str:
        """Complete searchable text of the component, including synonyms and the source."""
        plain = self.own_words.replace("-", " ")
        synonyms = (words for pattern, words in _FOUND if pattern.search(plain))
        return " ".join([plain, *synonyms, self.own_words, self.source])

    @cached_property
    def sizes(self) -> tuple[float, ...]:
        """Sizes in the name and id of the component, and its diameter if known [m]."""
        named = tuple(
            _metres(*found) for found in _SIZE.findall(f"{self.name} {self.id}".casefold())
        )
        return named if self.diameter is None else (*named, self.diameter)


class WordIndex:
    """Index for searching components by words; the user's own components come first.

    The index contains no component values, so a search with a limit finds nothing.
    """

    def __init__(self, catalogue: Catalogue) -> None:
        self.catalogue = catalogue
        shipped, entries = catalogue.levels[-1], filter(None, map(catalogue.entry, catalogue.ids()))
        found = [_listed(entry, shipped.get(entry.id) is not entry) for entry in entries]
        self._listed = {each.id: each for each in sorted(found, key=lambda each: not each.own)}

    @classmethod
    def of(cls, catalogue: Catalogue, text: str) -> Self:
        """Build the index of a catalogue and of the `components:` in the text of a mooring file.

        If the text cannot be parsed, only the components of the catalogue are indexed.
        """
        try:
            document = compose("", text)
        except InputError:
            return cls(catalogue)
        if isinstance(document.data.get("components"), dict):
            catalogue = catalogue.under(SourceMapping.of(document, []).child("components"))
        return cls(catalogue)

    def get(self, id: str) -> Listed | None:
        """Return a component, or None if the id is unknown."""
        return self._listed.get(id)

    def figures(self, id: str) -> Figures:
        """Return the values of a component by column key; this index contains no values."""
        return {}

    def suggested(self, text: str, near: str | None) -> list[str]:
        """Return up to three suggested ids for a text that is not an id.

        `near` is the id with the most similar spelling, or None. Only `near` is suggested for a
        text with a digit, because the digit usually belongs to a size. Only `near` is also
        suggested if no component contains every word.
        """
        if near and any(map(str.isdigit, text)):
            return [near]
        found = self.search(text) or ([] if near else self.search(self.spelt(text)))
        ids = [each.id for each in sorted(found, key=lambda each: -_uses()[each.id])]
        return ids[:_SUGGESTED] if ids or near is None else [near]

    def search(
        self,
        text: str,
        kinds: Iterable[str] | None = None,
        *,
        first: Sequence[str] = (),
        by: str | None = None,
    ) -> list[Listed]:
        """Find the components that contain all words and meet all limits of a text.

        A limit is a word such as ``breaking>50kN``. A size such as ``8mm`` also matches an equal
        size in another unit.

        Parameters
        ----------
        text : words and limits, separated by blanks
        kinds : kinds of components to search; by default all
        first : ids to list first, in this order; exact matches precede them, and ids that do not
            contain all words do not move up
        by : key of the column that sorts the result, largest magnitude first; by default the best
            matches come first
        """
        plain, limits = _parsed(text)
        terms = _terms(plain)
        hits = [
            each for each in self._of(kinds, limits) if all(term.matches(each) for term in terms)
        ]
        if by is not None:
            return sorted(hits, key=lambda each: self._least_first(each.id, by))
        return self._ranked(hits, terms, first)

    def nearly(
        self, text: str, kinds: Iterable[str] | None = None, *, first: Sequence[str] = ()
    ) -> tuple[list[Listed], list[str]]:
        """Find the components that meet all limits in a text and contain as many words as possible.

        Returns
        -------
        found : components with the most matching words; empty if no word matches
        unknown : words that no component contains
        """
        plain, limits = _parsed(text)
        every, terms = [*self._of(kinds, limits)], _terms(plain)
        counts = {each.id: sum(term.matches(each) for term in terms) for each in every}
        most = max(counts.values(), default=0)
        found = [each for each in every if counts[each.id] == most] if most else []
        known = [term for term in terms if any(map(term.matches, every))]
        unknown = [term.text for term in terms if term not in known]
        return self._ranked(found, known, first), unknown

    def _of(self, kinds: Iterable[str] | None, limits: Sequence[Wanted]) -> Iterator[Listed]:
        only = None if kinds is None else frozenset(kinds)
        for each in self._listed.values():
            if (only is None or each.kind in only) and all(
                limit.holds(self.figures(each.id)) for limit in limits
            ):
                yield each

    def _ranked(
        self, hits: Iterable[Listed], terms: Sequence[Term], first: Sequence[str]
    ) -> list[Listed]:
        """Sort components: exact ids, then ids in `first`, then by `_rank`.

        An id in `first` moves up only if it contains all words of the search.
        """
        places = {id: number for number, id in enumerate(first)}

        def order(each: Listed) -> tuple[bool, int, bool, bool, int, int]:
            own = [term for term in terms if term.matches(each)]
            words = [word for term in own for word in term.words]
            others = [word for term in own if term.size is None for word in term.words]
            rank = _rank(each, words, others)
            place = places.get(each.id, len(places)) if rank < _OTHER_FIELD_RANK else len(places)
            elsewhere = rank > _OTHER_FIELD_RANK
            return rank > 0, place, elsewhere, each.second, rank, -_uses()[each.id]

        return sorted(hits, key=order)

    def spelt(self, text: str) -> str:
        """Correct misspelt words in a text to similar words that occur in components."""
        every = " ".join(each.searched for each in self._listed.values())
        own = _SEPARATORS.split(" ".join(each.own_words for each in self._listed.values()))
        known = {word for word in own if word.isalpha() and len(word) >= _SHORT_WORD}
        for word in _words(_SIZE.sub(" ", _parsed(text)[0])):
            if len(word) >= _SHORT_WORD and word.isalpha() and word not in every:
                short = len(word) == _SHORT_WORD
                least = _MIN_SIMILARITY_SHORT if short else _MIN_SIMILARITY
                likely = [one for one in known if not short or one[0] == word[0]]
                near = difflib.get_close_matches(word, likely, 1, least)
                text = re.sub(re.escape(word), near[0] if near else word, text, flags=re.I)
        return text

    def _least_first(self, id: str, by: str) -> float:
        value = self.figures(id).get(by)
        return inf if value is None else -abs(value)


@dataclass(frozen=True)
class Term:
    """A search term: a word, or a size [m] that is written in one or more words."""

    text: str
    words: tuple[str, ...]
    size: float | None = None

    def matches(self, each: Listed) -> bool:
        """True if a component has the size of this term, or contains all words of this term."""
        size = self.size
        if size is not None and any(abs(one - size) <= _OF_A_SIZE * size for one in each.sizes):
            return True
        return all(word in each.searched for word in self.words)


def _terms(plain: str) -> list[Term]:
    words = [Term(word, (word,)) for word in _words(_SIZE.sub(" ", plain))]
    sizes = [
        Term(found[0], tuple(_words(found[0])), _metres(*found.groups()))
        for found in _SIZE.finditer(plain)
    ]
    return words + sizes


def _parsed(text: str) -> tuple[str, list[Wanted]]:
    parsed = [(word.casefold(), wanted(word)) for word in text.split()]
    limits = [limit for _, limit in parsed if limit is not None]
    return " ".join(word for word, limit in parsed if limit is None), limits


def _words(text: str) -> list[str]:
    return [word for word in _SEPARATORS.split(text) if word]


def _metres(number: str, unit: str) -> float:
    # `1 1/4` and `1-1/4` are both 1.25
    value = sum(float(Fraction(each.replace(",", "."))) for each in _words(number))
    return value * {"mm": 1e-3, "cm": 1e-2}.get(unit, 0.0254)


@cache
def _uses() -> Counter[str]:
    files = sorted(shipped_folder("lines").glob("*.yaml"))
    return Counter(id for file in files for id in _USE_KEY.findall(file.read_text("utf-8")))


def _rank(each: Listed, words: Sequence[str], others: Sequence[str]) -> int:
    """Return the rank of a match: 0 for the exact id, more for a worse match.

    `words` are the words of the search. `others` are those words that do not belong to a size.
    """
    if not words:
        return 0
    joined, id = "".join(words), _SEPARATORS.sub("", each.id)
    if id == joined:
        return 0
    if id.startswith(joined) or id.endswith(joined):
        return 1
    if all(word in each.id for word in words):
        return 2 if id.startswith(words[0]) else 3
    return _OTHER_FIELD_RANK + any(word not in each.own_words for word in others)


@lru_cache(4096)  # an index is rebuilt whenever a file's own components change
def _listed(entry: CatalogueEntry, own: bool) -> Listed:
    fields = entry.section.data

    def text(key: str) -> str:
        value = fields.get(key)
        return " ".join(value.split()) if isinstance(value, str) else ""

    role = text("role") or FAMILY_ROLES.get(entry.family or "", "")
    return Listed(
        id=entry.id,
        name=text("name"),
        maker=text("manufacturer"),
        kind=text("kind"),
        role=role or _ROLES.get(text("kind"), "instrument"),
        own=own,
        material=f"{text('material')} {entry.family or ''}",
        source=text("source").casefold(),
        diameter=_diameter(text("diameter")),
        second="prefer" in fields or bool(lacking(fields)),
    )


def _diameter(text: str) -> float | None:
    try:
        return parse_quantity(text, "length")
    except QuantityError:
        return None


_GROUPS = (
    ("twin", "double", "dual", "paired", "pair", "two", "tandem"),
    ("current meter", "rcm", "aquadopp", "s4", "argonaut", "dvs", "rcm4", "rcm5", "rcm8", "rcm11"),
    ("current profiler", "adcp", "rdcp", "workhorse", "doppler"),
    ("75khz", "75 khz", "lr75", "longranger"),
    ("railway", "railroad", "train"),
    ("ctd", "microcat", "seacat", "sbe37", "sbe16", "sbe19", "conductivity"),
    ("thermistor", "temperature logger", "hobo", "tr", "sbe39", "sbe56"),
    ("thimble", "termination", "eye", "socket"),
    ("float", "flotation", "buoy", "buoyancy"),
    ("anchor", "sinker", "deadweight", "clump"),
    ("rope", "line", "hawser"),
    ("wire", "steel rope", "jacketed"),
    ("dyneema", "spectra", "hmpe", "amsteel"),
    ("kevlar", "aramid", "parafil"),
    ("polyester", "dacron"),
    ("nylon", "polyamide", "perlon"),
    ("ring", "link", "maillon"),
    ("glass", "benthos", "vitrovex"),
    ("release", "releaser", "acoustic release"),
)
_FOUND = tuple(
    (re.compile(r"\b(" + "|".join(map(re.escape, group)) + r")s?\b"), " ".join(group))
    for group in _GROUPS
)


@dataclass(frozen=True)
class CatalogueColumn:
    """A column of the component list: its key, heading, dimension, display unit and format."""

    key: str
    heading: str
    dimension: str
    unit: str
    scale: float = 1.0
    decimals: int = 0

    def shown(self, value: float | None) -> str:
        """Format a value in the display unit; an unknown value gives an empty text."""
        return "" if value is None else f"{value * self.scale:.{self.decimals}f}"


COLUMNS = (
    CatalogueColumn("net", "net N", "force", "N"),
    CatalogueColumn("breaking", "break kN", "force", "kN", 1e-3, 1),
    CatalogueColumn("working", "work kN", "force", "kN", 1e-3, 1),
    CatalogueColumn("depth", "to m", "length", "m"),
    CatalogueColumn("drag", "drag N", "force", "N", 1.0, 1),
    CatalogueColumn("mass", "mass kg", "mass", "kg", 1.0, 1),
)
"""Columns of the component list.

Net buoyancy is in water and positive up. Drag is the normal drag at 1 m/s, and mass is in air. For
a cable or chain, all values except loads and depths are per metre.
"""


_COLUMN_SYNONYMS = {
    "mbl": "breaking",
    "wll": "working",
    "swl": "working",
    "buoyancy": "net",
    "rating": "depth",
}
_LIMIT = re.compile(r"([a-z]+)(<=|>=|<|>)([-+]?[\d.].*)")


_RELATIONS = {"<": operator.lt, "<=": operator.le, ">": operator.gt, ">=": operator.ge}


Figures = dict[str, float | None]


@dataclass(frozen=True)
class Wanted:
    """A limit on a component value in a search text, such as ``breaking>50kN``."""

    key: str
    relation: str
    limit: float

    def holds(self, figures: Figures) -> bool:
        """True if the value that the limit concerns is known and meets the limit."""
        value = figures.get(self.key)
        return value is not None and bool(_RELATIONS[self.relation](value, self.limit))


def wanted(word: str) -> Wanted | None:
    """Parse a word of a search text as a limit; return None if it is a plain word.

    A number without a unit has the unit of its column.
    """
    found = _LIMIT.fullmatch(word)
    if found is None:
        return None
    key = _COLUMN_SYNONYMS.get(found[1], found[1])
    column = next((each for each in COLUMNS if each.key == key), None)
    if column is None:
        return None
    for text in (found[3], f"{found[3]} {column.unit}"):
        try:
            return Wanted(key, found[2], parse_quantity(text, column.dimension))
        except QuantityError:
            continue
    return None
