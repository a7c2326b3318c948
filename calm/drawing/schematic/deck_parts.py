"""Selection of the parts in a mooring diagram for the deck, from the top down."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from functools import partial
from itertools import groupby
from math import nan

from calm.case.result_tables import run_of
from calm.deck import Deck
from calm.deck.deck_items import DeckItem, DeckRow, hardware_text, printed_rows
from calm.drawing.schematic.shown_parts import ShownPart, TextRow, afloat, one_line, place_text
from calm.drawing.schematic.symbols import BALLS, LINES, Sign, Symbol, sign_of
from calm.files import MooringFile
from calm.files.file_differences import own_labels
from calm.quantities import QUANTITIES

Cells = Callable[[Sequence[DeckItem], tuple[str, str]], tuple[str, ...]]
"""Function that returns the values next to items.

The arguments are the items, and the texts of their cut length and stretched length.
"""


def parts_of_deck(
    deck: Deck, listed: Sequence[DeckItem], *, surface: bool
) -> tuple[ShownPart, ...]:
    """Convert the listed items of a line or leg of a net to parts with values.

    Planned depths are included if any part has one. `surface` is true if the line reaches the
    surface.
    """
    weights = {one.label: one.wet_weight for one in deck.assessment.inventory}
    cells = partial(_values, deck.numbers, weights=weights, planned=has_plans(deck))
    return parts_of(deck.file, deck.parts, listed, cells, surface=surface)


def parts_of(
    file: MooringFile,
    every: Sequence[DeckItem],
    listed: Sequence[DeckItem],
    cells: Cells,
    *,
    surface: bool,
) -> tuple[ShownPart, ...]:
    """Convert the listed items of a line, or of a leg of a net, to parts from the top down.

    Consecutive connectors form one junction. A connector is separate if it is marked `apart` or has
    clamps.

    Parameters
    ----------
    every : all items of the line, from which the labels chosen by the user are taken
    cells : function that returns the values next to a part
    surface : whether the line reaches the surface
    """
    own = _chosen_labels(every)
    codes = {one.serial: " · ".join(one.code_lines) for one in file.releases}
    found: list[ShownPart] = []
    joints: list[DeckItem] = []
    cable: Symbol | None = None
    for row in printed_rows(listed, drawn=True):
        one = row.first
        if one.is_connector and not one.apart and not getattr(one.part, "clamps", ()):
            joints += (*row.items, *row.joints)
            continue
        if joints:
            found.append(_junction(joints, own, cells))
        joints = [*row.after]
        if row.first.on is None:
            sign = _sign(row.first)
            cable = sign.symbol if sign.symbol in LINES else None
        found.append(_piece(row, cable, codes, cells))
    if joints:
        found.append(_junction(joints, own, cells))
    if surface:
        found[0] = replace(found[0], sign=afloat(found[0].sign))
    return tuple(found)


def has_plans(deck: Deck) -> bool:
    """Return whether any part on deck has a planned depth."""
    return any(one.planned_depth is not None for one in deck.parts)


def _chosen_labels(parts: Sequence[DeckItem]) -> dict[int, str]:
    """Map the identity of each part to the label chosen by the user; "" for a default label."""
    labels = own_labels([one.label for one in parts])
    return {
        id(one): "" if label == one.part.use else one.label
        for one, label in zip(parts, labels, strict=True)
    }


def _sign(one: DeckItem) -> Sign:
    return sign_of(one.part.use, one.label, one.part.component)


def _piece(
    row: DeckRow, cable: Symbol | None, codes: Mapping[str | None, str], cells: Cells
) -> ShownPart:
    first, label = row.first, one_line(row.label)
    sign, floats = _sign(first), sum(one.role == "float" for one in (*row.items, *row.floats))
    if row.floats:
        sign = _sign(row.floats[0])
    if sign.symbol in BALLS:
        sign = replace(sign, count=sign.count * max(floats, 1))
    words = [
        "" if (name := one_line(row.name)) == label else name,
        f"on {one_line(first.name)}" if row.floats else "",
        f"with {one_line(hardware_text(row.between))}" if row.between else "",
        "" if first.serial is None else f"no. {one_line(first.serial)}",
        _codes_text(first, codes) if first.role == "release" else "",
    ]
    if first.on is not None:
        places = dict.fromkeys((row.items[0].places[0], row.items[-1].places[-1]))
        lengths = " – ".join(place_text(at) for at in places), ""
    elif len(row.items) > 1:
        lengths = "" if first.is_rigid else row.lengths, ""
    else:
        lengths = _number_text("length", first.cut_length), _number_text("length", first.stretched)
    connector_row = TextRow(
        label,
        " · ".join(filter(None, words)),
        cells([*row.items, *row.floats, *row.between], lengths),
        strong=first.role != "line" or bool(row.floats),
    )
    return ShownPart(
        sign,
        (connector_row,),
        labels=tuple(one.label for one in (*row.items, *row.floats, *row.between)),
        cable=cable,
        length=first.cut_length if first.cut_length is not None else nan,
        clamped=first.on is not None,
    )


def _codes_text(one: DeckItem, codes: Mapping[str | None, str]) -> str:
    known = {serial: one_line(codes[serial]) for serial in one.serials if codes.get(serial)}
    if len(one.serials) < 2:
        return "".join(known.values())
    return " · ".join(f"{one_line(serial)}: {text}" for serial, text in known.items())


def _values(
    numbers: Mapping[str, str],
    items: Sequence[DeckItem],
    lengths: tuple[str, str],
    weights: Mapping[str, float | None],
    *,
    planned: bool,
) -> tuple[str, ...]:
    plan = items[0].planned_depth
    tension = max((one.tension for one in items if one.tension is not None), default=None)
    own = [weights.get(one.label) for one in items]
    known = [one for one in own if one is not None]
    buoyancy = -sum(known) if len(known) == len(own) else None
    return (
        run_of([numbers[one.label] for one in items]),
        *lengths,
        _number_text("depth", items[0].depth),
        *(["" if plan is None else _number_text("planned_depth", plan)] if planned else []),
        _number_text("depth", items[0].height),
        "" if tension is None else _number_text("tension", tension),
        "?" if buoyancy is None else _number_text("wet_weight", buoyancy),
    )


def _number_text(name: str, value: float | None) -> str:
    return QUANTITIES[name].format(value)


def _junction(parts: Sequence[DeckItem], own: Mapping[int, str], cells: Cells) -> ShownPart:
    words = []  # connectors in their usual notation, with their own labels and serial numbers
    for one in parts:
        hardware, label = one_line(one.hardware), one_line(own[id(one)])
        text = f"{label} ({hardware})" if label else hardware
        words.append(text if one.serial is None else f"{text} no. {one_line(one.serial)}")
    joined = " – ".join(
        word if count == 1 else f"{count} × {word}"
        for word, count in ((word, len([*same])) for word, same in groupby(words))
    )
    signs = [_sign(one) for one in parts]
    lengths = (
        _number_text("length", sum(one.cut_length or 0.0 for one in parts)),
        _number_text("length", sum(one.stretched or 0.0 for one in parts)),
    )
    sign = next((sign for sign in signs if sign.symbol is Symbol.SWIVEL), signs[0])
    labels = tuple(one.label for one in parts)
    return ShownPart(
        sign, (TextRow(joined, "", cells(parts, lengths)),), labels=labels, junction=True
    )
