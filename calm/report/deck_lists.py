"""Lists for the deck: cutting, hardware, shipping, lifts and instruments."""

from collections.abc import Iterable, Mapping, Sequence
from itertools import groupby
from typing import Any

from calm.checks.finding import OWN, environment_text
from calm.deck import Deck
from calm.deck.deck_items import DeckInstrument, DeckItem, label_of_run, name_of_run, printed_rows
from calm.deck.hardware import LENGTH_ERROR, Cut, Mark, ShippedComponent, all_shipped
from calm.quantities import QUANTITIES, say
from calm.report import blocks
from calm.report.blocks import Cell, Field, Note, ReportPart, number, quantity, table_of, words
from calm.report.check_tables import component_text, named
from calm.report.sheet import leg_titles

_SHARE = f"{LENGTH_ERROR:.1%}".replace("%", " %")
_SPARES = (
    "CALM's rule for spares is 10 %, rounded up, and at least one (two for shackles, pins and "
    "thimbles)."
)
_IMPLIED = (
    "Each shackle includes a bolt, nut and cotter pin, unless its name or note says “screw pin”. A "
    "termination that mentions a thimble includes a thimble at each end. Each contact of "
    "dissimilar metals (a warning of calm check) adds an isolator, and an anode for the less noble "
    "metal. All other hardware must be listed in the line."
)
_BOX = "☐"


def cutting_part(deck: Deck) -> ReportPart:
    """Build the cutting list, with cut lengths, positions of marks, and tolerances."""
    note = (
        "Lengths are unloaded unless a load is stated; marks are measured from the upper end "
        f"under the same load. Tolerance: {_SHARE} of the length. Change in top depth: increase "
        f"in the depth of the top{' of the leg' if deck.result.several else ''} if only this piece "
        f"is {_SHARE} longer, in the {environment_text(deck.environment)}."
    )
    cables = [one for one in deck.cuts if not one.is_chain]
    chains = [one for one in deck.cuts if one.is_chain]
    drum = (
        " Over side and onto drum are sequence numbers: the last piece deployed is spooled first."
    )
    tables = [
        *([_cut_table("Wires and ropes", "wire or rope", deck, cables)] if cables else []),
        *([_cut_table("Chains", "chain", deck, chains)] if chains else []),
    ]
    note += drum if cables else ""
    return ReportPart("Cutting and marking list", (*tables, Note((note,))))


def _cut_table(title: str, piece: str, deck: Deck, listed: Sequence[Cut]) -> blocks.Table:
    spooled = not listed[0].is_chain
    rows: list[Any] = []
    kinds = {one.label: one for one in deck.parts}
    clusters = {one.label: row.cluster for row in printed_rows(deck.parts) for one in row.items}
    legs, above = leg_titles(deck.result), ""
    for _, alike in groupby(listed, lambda one: clusters.get(one.item.label) or id(one)):
        cuts = [*alike]
        leg = deck.leg(cuts[0].item.index)
        rows += [Cell(legs[leg], strong=True)] if leg != above else []
        above = leg
        rows.append(_cut_row(cuts))
        for _, marks in groupby(cuts[0].marks, lambda one: kinds[one.label].kind):
            rows.append((Cell(_mark_text(marks, kinds), indented=True), *[""] * 7, _BOX))
    unit = QUANTITIES["length"].display_unit
    return table_of(
        title,
        rows,
        words(f"{piece}, marks below", 0, 2.4),
        number("length", 1, unit),
        number("tolerance", 2, unit),
        number("change in\ntop depth", 3, unit),
        words("terminations", 4, 0.9),
        *(
            (number("over side", 5), number("onto drum", 6), words("drum", 7, 0.5))
            if spooled
            else ()
        ),
        words("done", 8, 0.0),
        by_hand=True,
    )


def _cut_row(cuts: Sequence[Cut]) -> tuple[Cell | str, ...]:
    cut, last, length = cuts[0], cuts[-1], QUANTITIES["length"]
    many = f"{len(cuts)} × " if len(cuts) > 1 else ""
    load = "" if cut.load == 0.0 else f"at {say('tension', cut.load)}"
    effect = "-" if cut.effect is None else f"{round(cut.effect * length.scale, 2) + 0.0:+.2f}"
    over, onto = (
        "" if one is None else "–".join(dict.fromkeys((str(one), str(other))))
        for one, other in ((cut.over, last.over), (cut.onto, last.onto))
    )
    label = label_of_run([one.item for one in cuts])
    return (
        Cell(label, cut.item.name, strong=True, goes_on=True),
        Cell(many + length.format(cut.length), load),
        f"± {length.format(cut.tolerance)}", effect, cut.termination or "", over, onto, "", _BOX,
    )  # fmt: skip


def _mark_text(alike: Iterable[Mark], items: Mapping[str, DeckItem]) -> str:
    marks = [*alike]
    places = ", ".join(QUANTITIES["at"].format(mark.at) for mark in marks)
    marked = [items[mark.label] for mark in marks]
    floats = len(marked) > 1 and marked[0].role == "float"
    return f"mark at {places}: {name_of_run(marked) if floats else label_of_run(marked)}"


def _length_column() -> Field:
    shown = QUANTITIES["length"]

    def text(one: Any) -> str | None:
        return None if one.length is None else shown.format(one.length)

    return number("length", text, shown.display_unit)


def hardware_part(deck: Deck) -> ReportPart:
    """Build the list of hardware, with spares."""
    rows: list[Any] = []
    for kind, stocks in groupby(deck.hardware, lambda one: one.kind):
        rows += [Cell(kind), *stocks]

    def named(one: Any) -> Cell:
        return Cell(one.name, one.basis and f"({one.basis})", goes_on=True)

    table = table_of(
        "",
        rows,
        words("hardware", named, 2.4),
        words("id", "use", 0.8),
        number("in the line", "count"),
        _length_column(),
        number("spares"),
        number("to bring", "total"),
        words("packed", lambda _: _BOX, 0.0),
        note=_SPARES,
    )
    return ReportPart("Hardware bill", (table, Note((_IMPLIED,))))


def shipping_part(deck: Deck) -> ReportPart:
    """Build the shipping list; each sum is followed by the number of items with unknown values."""

    def at_least(heading: str, name: str, value: str, missing: str) -> Field:
        shown = QUANTITIES[name]

        def cell(one: Any) -> Cell:
            lacking = getattr(one, missing)
            if lacking == one.count:
                return Cell("unknown")
            text = shown.format(getattr(one, value))
            return Cell(f"≥ {text}", f"{lacking} unknown") if lacking else Cell(text)

        return number(heading, cell, shown.display_unit)

    def name(one: ShippedComponent) -> str:
        return component_text(one.name, one.units // one.count) if one.use else one.name

    table = table_of(
        "",
        deck.shipped,
        words("component", name, 1.6),
        words("id", "use"),
        number("pieces", "count"),
        _length_column(),
        at_least("mass in air", "dry_mass", "mass", "missing_masses"),
        at_least("volume", "volume", "volume", "missing_volumes"),
        blocks.blank("packed in", share=0.8),
        note=(
            "Volumes exclude packing. They follow from the size of spheres, cylinders and cables, "
            "and from the displacement of other items. ≥ marks a lower bound, because values are "
            "missing. Spares are not included."
        ),
        sums=[all_shipped(deck.shipped)],
    )
    return ReportPart("Shipping list", (table,))


def lifts_part(deck: Deck) -> ReportPart:
    """Build the table of lifts for deployment and recovery, and a summary of the heaviest lifts."""
    sentences, heaviest, unknown = [], deck.lifts.heaviest, deck.lifts.unknown
    if heaviest is not None:
        of_known = " of known mass" if unknown else ""
        sentences.append(
            f"Heaviest single lift{of_known}: {heaviest.label}, "
            f"{say('lift_mass', heaviest.mass)} in air, "
            f"{say('wet_weight', heaviest.weight)} in water."
        )
    greatest = max(deck.lifts.deployment, key=lambda one: one.hanging or 0.0, default=None)
    if greatest is not None and (greatest.hanging or 0.0) > 0.0:
        sentences.append(
            f"Maximum suspended load: {say('wet_weight', greatest.hanging)} in water, with "
            f"{greatest.label} over the side."
        )
    if unknown:
        labels = named(unknown, len(unknown))
        sentences.append(f"The mass in air, and so the lift in air, is unknown for {labels}.")
    note = (
        "Lift in air: crane load of the piece with its clamps; cables have no lift in air, because "
        "they are paid out. Suspended: weight in water of all pieces over the side, hanging "
        "vertically; in a net, only the pieces of the same leg count. A negative value means that "
        "the suspended pieces float. Drag and swell are not included. Shackles, links and swivels "
        "are lifted with the adjacent pieces; the files list them in separate rows."
    )
    return ReportPart("Lifts", (blocks.Prose(tuple(sentences)), _lifts_table(deck), Note((note,))))


def _lifts_table(deck: Deck) -> blocks.Table:
    joints = {one.label for one in deck.parts if one.is_joint}
    recovery = {one.label: one.hanging for one in deck.lifts.recovery}
    return table_of(
        f"In the order over the side{', leg by leg' * deck.result.several}",
        [one for one in deck.lifts.deployment if one.label not in joints],
        *([words("leg", lambda one: deck.leg(one.index))] if deck.result.several else []),
        number("no.", lambda one: deck.numbers[one.label]),
        words("at the rail", "label", 2.0),
        quantity("lift_mass", "mass", "lift in\nair"),
        quantity("wet_weight", "weight", "lift in\nwater"),
        quantity("wet_weight", "hanging", "suspended,\ndeployment"),
        quantity("wet_weight", lambda one: recovery.get(one.label), "suspended,\nrecovery"),
    )


def instruments_part(deck: Deck) -> ReportPart:
    """Build the instrument sheet, with depths, tilts and further data from the file.

    The sheet lists all releases and instruments, and floats or frames that hold an instrument.
    """
    several, legs = len(deck.environments) > 1, leg_titles(deck.result)
    planned = any(one.item.planned_depth is not None for one in deck.instruments)
    rows: list[Any] = []
    for name, own in deck.by_leg(deck.instruments, lambda one: one.item.index):
        rows += [*([Cell(legs[name], strong=True)] if name else []), *own]

    def named(one: DeckInstrument) -> Cell:
        clamped = one.item.on is not None
        return Cell(one.item.label, one.item.name, indented=clamped, strong=True, goes_on=True)

    def limits(one: DeckInstrument) -> Cell:
        warn, most = one.item.part.component.warn_tilt, one.item.part.component.max_tilt
        tilt = QUANTITIES["tilt"]
        return Cell(tilt.format(most), "" if warn is None else f"warn {tilt.format(warn)}")

    def extreme(heading: str, name: str) -> Field:
        depth = QUANTITIES["depth"]

        def cell(one: DeckInstrument) -> Cell:
            found = getattr(one, name)
            own = found.environment == OWN
            return Cell(depth.format(found.depth), "default" if own else found.environment)

        return number(heading, cell, depth.display_unit)

    note = f"Depths are in the {environment_text(deck.environment)}."
    if several:
        note += (
            f" Minimum and maximum depth, and tilt, cover {len(deck.environments)} environments; "
            "the governing environment is named below the depth."
        )
    table = table_of(
        "Instruments and releases",
        rows,
        number("no.", lambda one: deck.numbers[one.item.label]),
        words("instrument", named, 2.0),
        words("serial number", "item.serial", 0.8),
        quantity("depth", "item.depth", "depth"),
        quantity("depth", "still", "still\nwater"),
        *([quantity("planned_depth", "item.planned_depth")] if planned else []),
        *([extreme("minimum", "shallowest"), extreme("maximum", "deepest")] if several else []),
        number("tilt", lambda one: QUANTITIES["tilt"].format(one.greatest_tilt), "°"),
        number("limit", limits, "°"),
        words("sampling", "item.part.equipment.sampling", 0.9),
        words("battery\nuntil", "item.part.equipment.battery_until", 0.0),
        words("calibrated", "item.part.equipment.calibrated", 0.0),
        note=note,
    )
    return ReportPart("Instrument sheet", (table,))
