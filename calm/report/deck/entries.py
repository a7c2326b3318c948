"""What the mooring diagram shows from the top down: pieces, clamps, and junctions as one."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import groupby
from typing import TYPE_CHECKING

from calm.files.alignment import own_labels
from calm.quantities import QUANTITIES
from calm.report.line import place_text
from calm.report.schematic.parts import one_line
from calm.report.schematic.sign import LINES, Sign, Symbol, sign_of

if TYPE_CHECKING:
    from calm.deck import Deck
    from calm.deck.hung import Hung

_SIZED = re.compile(r"(shackle|ring|swivel|link)(?:-[a-z]+)?-(\d+)\b.*")


@dataclass(frozen=True)
class Entry:
    """A row of the diagram.

    Attributes
    ----------
    sign : its symbol
    cable : the symbol of the cable that it is, or is clamped on; None of what is rigid
    label, name : in words; the name with the serial number after it
    cells : cut length or place on the wire, stretched length, depth, height
    clamped : whether it is clamped on the entry above it
    junction : whether pages may end above it without parting what belongs together
    strong : whether a reader looks for it
    """

    sign: Sign
    cable: Symbol | None
    label: str
    name: str
    cells: tuple[str, str, str, str]
    clamped: bool = False
    junction: bool = False
    strong: bool = False


def entries_of(deck: Deck) -> tuple[Entry, ...]:
    """Down the line; connectors that follow one another make one junction."""
    own = _own_labels(deck.parts)
    found: list[Entry] = []
    for joins, group in groupby(deck.parts, key=_is_connector):
        parts = [*group]
        if joins:
            found.append(_junction(parts, own))
        else:
            found += _pieces(parts)
    return tuple(found)


def _own_labels(parts: Sequence[Hung]) -> dict[int, str]:
    """Of each part, by its identity: its label where a person gave it, else nothing."""
    labels = own_labels([one.label for one in parts])
    return {
        id(one): "" if label == one.part.use else one.label
        for one, label in zip(parts, labels, strict=True)
    }


def _is_connector(one: Hung) -> bool:
    clamps = getattr(one.part, "clamps", ())
    return one.role == "connector" and one.on is None and one.is_rigid and not clamps


def _pieces(parts: Sequence[Hung]) -> Iterator[Entry]:
    cable: Symbol | None = None
    for one in parts:
        sign = sign_of(one.part.use, one.label, one.part.component)
        if one.on is None:
            cable = sign.symbol if sign.symbol in LINES else None
        name = one_line(one.name)
        serial = "" if one.serial is None else f"no. {one_line(one.serial)}"
        label = one_line(one.label)
        yield Entry(
            sign=sign,
            cable=cable,
            label=label,
            name=" · ".join(filter(None, ("" if name == label else name, serial))),
            cells=_cells(one),
            clamped=one.on is not None,
            strong=one.role != "line",
        )


def _junction(parts: Sequence[Hung], own: dict[int, str]) -> Entry:
    words = [_said(one, own[id(one)]) for one in parts]
    joined = " – ".join(
        word if count == 1 else f"{count} × {word}"
        for word, count in ((word, len([*same])) for word, same in groupby(words))
    )
    signs = [sign_of(one.part.use, one.label, one.part.component) for one in parts]
    swivel = next((sign for sign in signs if sign.symbol is Symbol.SWIVEL), signs[0])
    lengths = (
        sum(one.cut_length or 0.0 for one in parts),
        sum(one.stretched or 0.0 for one in parts),
    )
    first = parts[0]
    figures = {"cut_length": lengths[0], "length": lengths[1],
               "depth": first.depth, "height": first.height}  # fmt: skip
    texts = [QUANTITIES[name].format(value) for name, value in figures.items()]
    return Entry(
        sign=swivel,
        cable=None,
        label=joined,
        name="",
        cells=(texts[0], texts[1], texts[2], texts[3]),
        junction=True,
    )


def _said(one: Hung, own: str) -> str:
    """A connector as people write it, 13 shackle, with its own label and serial number."""
    sized = _SIZED.fullmatch(one.part.use)
    hardware = f"{sized[2]} {sized[1]}" if sized else one_line(one.name)
    text = f"{one_line(own)} ({hardware})" if own else hardware
    return text if one.serial is None else f"{text} no. {one_line(one.serial)}"


def _cells(one: Hung) -> tuple[str, str, str, str]:
    depth, height = (QUANTITIES["depth"].format(value) for value in (one.depth, one.height))
    if one.on is not None:
        return place_text(one.at or 0.0), "", depth, height
    cut, stretched = (QUANTITIES["length"].format(value) for value in
                      (one.cut_length, one.stretched))  # fmt: skip
    return cut, stretched, depth, height
