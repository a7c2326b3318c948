"""Compare the pieces and the other values of two mooring files.

Parts of the two lines are matched by unique label, otherwise by content and order. Labels with a
number added by `numbered` are not used for matching.
"""

from __future__ import annotations

import math
import re
from bisect import bisect_left
from collections import defaultdict
from collections.abc import Hashable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, fields, is_dataclass
from difflib import SequenceMatcher
from itertools import pairwise
from typing import Any

from pydantic import BaseModel

from calm.files.components import Flexible
from calm.files.definition import quantity_of
from calm.files.mooring_file import MooringFile
from calm.files.pieces import Clamp, Piece
from calm.quantities import bearing_of
from calm.records.profile_tables import CurrentTable, DepthTable
from calm.units import DIMENSIONS, with_unit

Value = float | str | None


@dataclass(frozen=True)
class ComparedValue:
    """A number [SI, degrees] or text in a file, with its display text.

    `table` is the whole table if the display text only summarises it.
    """

    value: Value
    text: str
    table: CurrentTable | DepthTable | None = None


NOTHING = ComparedValue(None, "-")


def _text(text: str) -> ComparedValue:
    return ComparedValue(text, text)


@dataclass(frozen=True)
class Change:
    """A changed value, named by `where`, such as ``label.field`` or ``environment.depth``."""

    where: str
    before: ComparedValue
    after: ComparedValue


@dataclass(frozen=True)
class Differences:
    """The differences between two mooring files.

    Attributes
    ----------
    changed : changed values, those outside the line first
    moved : parts moved within the line, with texts such as ``below wire 1``
    removed, added : labels of removed and added parts
    pairs : matched parts, in the order of the first line
    """

    changed: tuple[Change, ...]
    moved: tuple[Change, ...]
    removed: tuple[str, ...]
    added: tuple[str, ...]
    pairs: tuple[tuple[Piece | Clamp, Piece | Clamp], ...]

    @property
    def any(self) -> bool:
        """Whether the files differ in any key."""
        return bool(self.changed or self.moved or self.removed or self.added)


_OF_THE_SOURCE = frozenset({"kind", "source", "sources", "searched", "prefer", "date"})
"""Definition fields that describe the sources of values."""

_DIMENSIONS = {
    **dict.fromkeys(("length", "at", "depth", "fit_top_depth", "fit_body_depth"), "length"),
    "measured_load": "force",
    "gravity": "acceleration",
    "density": "density",
    "maximum_speed": "speed",
}
"""Dimensions of those fields that have no `QuantityField` in their model, by field name."""


def differences(before: MooringFile, after: MooringFile) -> Differences:
    """Compare two files of the same kind."""
    lines = before.pieces, after.pieces
    clamped = [[(piece.index, clamp) for piece in line for clamp in piece.clamps] for line in lines]
    pieces = align(*map(_known_pieces, lines))
    partner = dict(pieces.pairs)
    clamps = align(_known_clamps(clamped[0], partner), _known_clamps(clamped[1], None))
    parts = [[clamp for _, clamp in each] for each in clamped]
    kinds: list[tuple[Alignment, Sequence[Piece | Clamp], Sequence[Piece | Clamp]]] = [
        (pieces, *lines),
        (clamps, parts[0], parts[1]),
    ]
    changed = [*_changes("", _figures_outside_line(before), _figures_outside_line(after))]
    for found, first, second in kinds:
        names, others = (own_labels([part.label for part in each]) for each in (first, second))
        for i, j in found.pairs:
            changed += _of_part(first[i], second[j], names[i], others[j])
            if found is clamps and partner.get(above := clamped[0][i][0]) != (
                below := clamped[1][j][0]
            ):
                on = _text(lines[0][above].label), _text(lines[1][below].label)
                changed.append(Change(f"{first[i].label}.on", *on))
    return Differences(
        changed=tuple(changed),
        moved=tuple(
            Change(lines[0][i].label, _above(lines[0], i), _above(lines[1], j))
            for i, j in sorted(pieces.moved)
        ),
        removed=tuple(first[i].label for found, first, _ in kinds for i in found.removed),
        added=tuple(second[j].label for found, _, second in kinds for j in found.added),
        pairs=tuple(
            (first[i], second[j]) for found, first, second in kinds for i, j in found.pairs
        ),
    )


def _above(line: Sequence[Piece], place: int) -> ComparedValue:
    return _text(f"below {line[place - 1].label}" if place else "on top")


def _known_pieces(pieces: Sequence[Piece]) -> list[Known]:
    labels = own_labels([piece.label for piece in pieces])
    return [
        Known(label, ((label, *_content(piece), piece.length), piece.use, piece.component.role))
        for label, piece in zip(labels, pieces, strict=True)
    ]


def _known_clamps(
    clamps: Sequence[tuple[int, Clamp]], partner: Mapping[int, int] | None
) -> list[Known]:
    """Return the labels of clamps, and the keys by which clamps are matched.

    With these keys, clamps on matched pieces are matched first. `partner` maps each piece of the
    first line to the matched piece of the second line. For clamps of the second line, `partner` is
    None.
    """
    labels = own_labels([clamp.label for _, clamp in clamps])
    known = []
    for label, (index, clamp) in zip(labels, clamps, strict=True):
        on = index if partner is None else partner.get(index, -1)
        own = label, *_content(clamp)
        known.append(Known(label, ((on, *own, clamp.at), (on, *own), (on, clamp.use), own)))
    return known


def _content(part: Piece | Clamp) -> tuple[str, str]:
    return part.use, part.component.model_dump_json()


def _of_part(
    before: Piece | Clamp, after: Piece | Clamp, name: str, other: str
) -> Iterator[Change]:
    first, second = _part_figures(before, name), _part_figures(after, other)
    if before.use == after.use:
        first |= _figures(before.component, _OF_THE_SOURCE)
        second |= _figures(after.component, _OF_THE_SOURCE)
    yield from _changes(f"{before.label}.", first, second)


def _part_figures(part: Piece | Clamp, name: str) -> dict[str, ComparedValue]:
    found = {"use": _figure("use", part.use), "label": _figure("label", name)}
    if isinstance(part, Clamp):
        found["at"] = _figure("at", part.at)
    elif isinstance(part.component, Flexible):
        found["length"] = _figure("length", "fit" if part.length is None else part.length)
        for key in ("fit_top_depth", "fit_body_depth"):
            found[key.removeprefix("fit_")] = _figure(key, getattr(part, key))
        found["measured_load"] = _figure("measured_load", part.measured_load)
    return found | _figures(part.equipment)


def _figures_outside_line(file: MooringFile) -> dict[str, ComparedValue]:
    found = {name: _figure(name, getattr(file, name) or None) for name in ("name", "description")}
    # position and sea states follow from other values
    around = _figures(file.environment, frozenset({"position", "seas"}))
    found |= {f"environment.{key}": one for key, one in around.items()}
    names = "position", "tow", "solver", "checks", "uncertainty", "document", "deployed"
    parts = {name: part for name in names if (part := getattr(file, name)) is not None}
    for name, part in (parts | {f"legs.{leg.name}": leg for leg in file.legs}).items():
        given = _figures(part, frozenset({"first", "end"}))
        found |= {f"{name}.{key}": one for key, one in given.items()}
    for name, overlay in file.variants.items():
        given = overlay if isinstance(overlay, dict) else {"": overlay}
        found |= {
            f"environments.{name}.{key}": _text(_value_text(one)) for key, one in given.items()
        }
    found["releases"] = _figure("releases", file.releases or None)
    return found


def _figures(part: Any, left_out: frozenset[str] = frozenset()) -> dict[str, ComparedValue]:
    found: dict[str, ComparedValue] = {}
    model = type(part).model_fields if isinstance(part, BaseModel) else {}
    for name, value in _fields(part).items():
        if name in left_out:
            continue
        if isinstance(value, BaseModel):
            found |= {f"{name}.{key}": one for key, one in _figures(value).items()}
            continue
        quantity = quantity_of(model[name]) if name in model else None
        dimension = quantity.dimension if quantity else _DIMENSIONS.get(name)
        found[name] = _figure(name, value, dimension)
    return found


def _fields(part: Any) -> dict[str, Any]:
    if isinstance(part, BaseModel):
        return dict(part)
    return {field.name: getattr(part, field.name) for field in fields(part)}


def _figure(name: str, value: Any, dimension: str | None = None) -> ComparedValue:
    if value is None or value == ():
        return NOTHING
    if isinstance(value, CurrentTable):
        return _of_current(value)
    if isinstance(value, DepthTable):
        text = f"{min(value.value):g} to {max(value.value):g}, {len(value.depth)} levels"
        return ComparedValue(text, text, value)
    if isinstance(value, int | float) and not isinstance(value, bool):
        number = math.degrees(value) if name == "angle_step" else float(value)
        dimension = dimension or _DIMENSIONS.get(name)
        unit = "" if dimension is None else DIMENSIONS[dimension].unit
        return ComparedValue(number if math.isfinite(number) else None, with_unit(number, unit))
    return _text(_value_text(value))


def _of_current(table: CurrentTable) -> ComparedValue:
    speeds = [math.hypot(u, v) for u, v in zip(table.u, table.v, strict=True)]
    fastest = max(range(len(speeds)), key=speeds.__getitem__)
    toward = bearing_of(table.u[fastest], table.v[fastest])
    text = f"at most {speeds[fastest]:.3g} m/s at {table.depth[fastest]:g} m"
    if speeds[fastest] > 0.0:
        text += f" toward {toward:.0f}°"
    text += f", {len(speeds)} level{'s' * (len(speeds) != 1)}"
    return ComparedValue(text, text, table)


def _value_text(value: Any) -> str:
    if isinstance(value, BaseModel) or is_dataclass(value):
        given = {name: one for name, one in _fields(value).items() if one is not None}
        value = {name: one for name, one in given.items() if not isinstance(one, tuple) or one}
    if isinstance(value, list | tuple):
        return "; ".join(map(_value_text, value))
    if isinstance(value, dict):
        return ", ".join(f"{key}: {_value_text(one)}" for key, one in value.items())
    return f"{value:.6g}" if isinstance(value, float) else str(value)


def _changes(
    prefix: str, before: Mapping[str, ComparedValue], after: Mapping[str, ComparedValue]
) -> Iterator[Change]:
    for name in dict.fromkeys((*before, *after)):
        pair = before.get(name, NOTHING), after.get(name, NOTHING)
        if pair[0] != pair[1]:
            if pair[0].text == pair[1].text:
                text = f"{pair[1].text}, other figures"
                pair = pair[0], ComparedValue(text, text, pair[1].table)
            yield Change(prefix + name, *pair)


_NUMBERED = re.compile(r"(.+) ([1-9]\d*)")


@dataclass(frozen=True)
class Known:
    """A part to be matched with a part of another line.

    Attributes
    ----------
    label : label of the part, without the number that `numbered` adds to repeated labels
    contents : keys for matching, the strictest first; two parts match if one of the keys is equal
    """

    label: str
    contents: tuple[Hashable, ...]


@dataclass(frozen=True)
class Alignment:
    """Matched, moved, removed and added parts of two lines, given by index.

    Attributes
    ----------
    pairs : matched parts, in the order of the first line
    moved : matched pairs whose order has changed
    removed, added : parts that are in one line only
    """

    pairs: tuple[tuple[int, int], ...]
    moved: frozenset[tuple[int, int]]
    removed: tuple[int, ...]
    added: tuple[int, ...]


def own_labels(labels: Sequence[str]) -> list[str]:
    """Remove the final numbers from repeated labels that are numbered from 1 to n."""
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
    """Match the parts of two lines; each part has at most one match."""
    there = _places(after)
    pairs = {i: there[label] for label, i in _places(before).items() if label in there}
    in_order = _longest_rise([pairs[i] for i in sorted(pairs)])
    fixed = [(-1, -1), *((i, pairs[i]) for i in sorted(pairs) if pairs[i] in in_order)]
    taken = set(pairs.values())
    kinds_of_key = min((len(part.contents) for part in (*before, *after)), default=0)
    for (i, j), (k, m) in pairwise((*fixed, (len(before), len(after)))):
        left = [n for n in range(i + 1, k) if n not in pairs]
        right = [n for n in range(j + 1, m) if n not in taken]
        for key in range(kinds_of_key):
            _pair_between(before, after, left, right, key, pairs)
    removed = [i for i in range(len(before)) if i not in pairs]
    added = sorted(set(range(len(after))) - set(pairs.values()))
    for i in removed.copy():
        equals = [j for j in added if after[j].contents[0] == before[i].contents[0]]
        if equals:
            pairs[i] = equals[0]
            removed.remove(i)
            added.remove(equals[0])
    ordered = tuple(sorted(pairs.items()))
    steady = _longest_rise([j for _, j in ordered])
    moved = frozenset(pair for pair in ordered if pair[1] not in steady)
    return Alignment(ordered, moved, tuple(removed), tuple(added))


def _places(parts: Sequence[Known]) -> dict[str, int]:
    places: dict[str, list[int]] = defaultdict(list)
    for place, part in enumerate(parts):
        places[part.label].append(place)
    return {label: found[0] for label, found in places.items() if len(found) == 1}


def _pair_between(
    before: Sequence[Known],
    after: Sequence[Known],
    left: list[int],
    right: list[int],
    key: int,
    pairs: dict[int, int],
) -> None:
    """Match parts that have equal keys and the same order in both lines.

    Parameters
    ----------
    left, right : indices of the unmatched parts of each line; new matches are removed
    key : index in `Known.contents` of the key to compare
    pairs : matched indices, to which new matches are added
    """
    if not left or not right:
        return
    keys = [before[i].contents[key] for i in left], [after[j].contents[key] for j in right]
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
    """Return the longest increasing subsequence of distinct values, by patience sorting."""
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
