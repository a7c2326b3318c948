"""Which part of one line is which of another: by label, else by content and order.

A label decides where one part of each line has it. Those that `numbered` made are no labels: a
shackle put in at the top renumbers all below it.
"""

from __future__ import annotations

import re
from bisect import bisect_left
from collections import defaultdict
from collections.abc import Hashable, Iterable, Sequence
from dataclasses import dataclass
from difflib import SequenceMatcher
from itertools import pairwise

_NUMBERED = re.compile(r"(.+) ([1-9]\d*)")


@dataclass(frozen=True)
class Known:
    """Hold what identifies a part: its label without a number that `numbered` added, its content.

    `contents` are the ways in which parts are alike, the strictest first.
    """

    label: str
    contents: tuple[Hashable, ...]


@dataclass(frozen=True)
class Alignment:
    """Hold the places of parts in two lines.

    Attributes
    ----------
    pairs : of the same part, in the order of the first line
    moved : those of them that stand elsewhere in the order
    removed, added : in one line only
    """

    pairs: tuple[tuple[int, int], ...]
    moved: frozenset[tuple[int, int]]
    removed: tuple[int, ...]
    added: tuple[int, ...]


def own_labels(labels: Sequence[str]) -> list[str]:
    """Return the labels, without the numbers of those that go from 1 to n."""
    numbers: dict[str, list[int]] = defaultdict(list)
    matches = [_NUMBERED.fullmatch(label) for label in labels]
    for match in filter(None, matches):
        numbers[match[1]].append(int(match[2]))
    counted = {base for base, n in numbers.items() if sorted(n) == [*range(1, len(n) + 1)]}
    return [
        match[1] if match and match[1] in counted and len(numbers[match[1]]) > 1 else label
        for label, match in zip(labels, matches, strict=True)
    ]


def align(before: Sequence[Known], after: Sequence[Known]) -> Alignment:
    """Pair the parts of two lines, each at most once."""
    there = _places(after)
    pairs = {i: there[label] for label, i in _places(before).items() if label in there}
    in_order = _longest_rise([pairs[i] for i in sorted(pairs)])
    fixed = [(-1, -1), *((i, pairs[i]) for i in sorted(pairs) if pairs[i] in in_order)]
    taken = set(pairs.values())
    ways = min((len(part.contents) for part in (*before, *after)), default=0)
    for (i, j), (k, m) in pairwise((*fixed, (len(before), len(after)))):
        left = [n for n in range(i + 1, k) if n not in pairs]
        right = [n for n in range(j + 1, m) if n not in taken]
        for way in range(ways):
            _pair_between(before, after, left, right, way, pairs)
    removed = [i for i in range(len(before)) if i not in pairs]
    added = sorted(set(range(len(after))) - set(pairs.values()))
    for i in removed.copy():
        alike = [j for j in added if after[j].contents[0] == before[i].contents[0]]
        if alike:
            pairs[i] = alike[0]
            removed.remove(i)
            added.remove(alike[0])
    ordered = tuple(sorted(pairs.items()))
    steady = _longest_rise([j for _, j in ordered])
    moved = frozenset(pair for pair in ordered if pair[1] not in steady)
    return Alignment(ordered, moved, tuple(removed), tuple(added))


def _places(parts: Sequence[Known]) -> dict[str, int]:
    """Return the place of each label that only one part has."""
    places: dict[str, list[int]] = defaultdict(list)
    for place, part in enumerate(parts):
        places[part.label].append(place)
    return {label: found[0] for label, found in places.items() if len(found) == 1}


def _pair_between(
    before: Sequence[Known],
    after: Sequence[Known],
    left: list[int],
    right: list[int],
    way: int,
    pairs: dict[int, int],
) -> None:
    """Pair in order what is alike in one way between two parts that are known; take it out."""
    if not left or not right:
        return
    keys = [before[i].contents[way] for i in left], [after[j].contents[way] for j in right]
    found = {
        left[block.a + n]: right[block.b + n]
        for block in SequenceMatcher(None, *keys, autojunk=False).get_matching_blocks()
        for n in range(block.size)
    }
    pairs.update(found)
    taken = set(found.values())
    left[:] = [i for i in left if i not in found]
    right[:] = [j for j in right if j not in taken]


def _longest_rise(values: Iterable[int]) -> frozenset[int]:
    """Return the longest of the rising sequences within different values (patience sorting)."""
    ends: list[int] = []
    below: dict[int, list[int]] = {}
    for value in values:
        place = bisect_left(ends, value)
        below[value] = ends[place - 1 : place] if place else []
        ends[place : place + 1] = [value]
    chosen: list[int] = []
    rest = ends[-1:]
    while rest:
        chosen += rest
        rest = below[rest[0]]
    return frozenset(chosen)
