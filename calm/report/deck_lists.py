"""Cutting list, hardware bill, shipping list, lifts and instrument sheet."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from itertools import groupby

from calm.deck import Deck
from calm.deck.deck_items import (
    DeckInstrument,
    DeckItem,
    Extreme,
    label_of_run,
    name_of_run,
    rows_on_paper,
)
from calm.deck.hardware import LENGTH_ERROR, Mark
from calm.deck.shipping import total_of
from calm.quantities import QUANTITIES, say
from calm.report.blocks import Cell, Column, Note, Prose, ReportPart, Table, table_of
from calm.report.net_sheet import leg_titles
from calm.report.sheet import figure_cell, quantity_column, quantity_field

_SHARE = f"{LENGTH_ERROR:.1%}".replace("%", " %")
_SPARES = (
    "Spares: a tenth, rounded up, at least one; of shackles, pins and thimbles at least two. A "
    "default of this program."
)
_IMPLIED = (
    "Each shackle is counted with a bolt, nut and cotter pin unless its name or note says screw "
    "pin, and a termination that names a thimble with one at each end. Where metals touch that "
    "corrode each other (calm check warns of them), an isolator is counted for each contact and an "
    "anode for each piece of the baser metal. Nothing else is counted unless the line lists it."
)


def cutting_part(deck: Deck) -> ReportPart:
    """Lengths, marks, and how exactly they have to be."""
    rows: list[tuple[Cell, ...]] = []
    length = QUANTITIES["length"]
    kinds = {one.label: one for one in deck.parts}
    clusters = {
        one.label: row.cluster for row in rows_on_paper(deck.parts) for one in row.items
    }  # fmt: skip
    legs, above = leg_titles(deck.result), ""
    for _, alike in groupby(deck.cuts, lambda one: clusters.get(one.item.label) or id(one)):
        cuts = [*alike]
        cut, last = cuts[0], cuts[-1]
        many = f"{len(cuts)} × " if len(cuts) > 1 else ""
        leg = deck.leg(cut.item.index)
        rows += [(Cell(legs[leg], strong=True),)] if leg != above else []
        above = leg
        load = "" if cut.load == 0.0 else f"at {say('tension', cut.load)}"
        effect = "-" if cut.effect is None else f"{cut.effect * length.scale:+.2f}"
        label = label_of_run([one.item for one in cuts])
        over, onto = (
            "–".join(dict.fromkeys((str(one), str(other))))
            for one, other in ((cut.over, last.over), (cut.onto, last.onto))
        )
        named = Cell(label, cut.item.name, strong=True, goes_on=True)
        tolerance = f"± {length.format(cut.tolerance)}"
        figures = (tolerance, effect, cut.termination or "", over, onto, "", "☐")
        rows.append((named, Cell(many + length.format(cut.length), load), *map(Cell, figures)))
        rows += [
            (Cell(_marked(marks, kinds), indented=True), *[Cell()] * 7, Cell("☐"))
            for _, marks in groupby(cut.marks, key=lambda mark: kinds[mark.label].kind)
        ]
    columns = (
        Column("wire or rope, marks below", share=2.4),
        quantity_column("length", "length"),
        quantity_column("length", "tolerance"),
        quantity_column("length", "top deeper"),
        Column("terminations", share=0.9),
        Column("over side", numeric=True),
        Column("onto drum", numeric=True),
        Column("drum", share=0.5),
        Column("done", share=0.0),
    )
    note = (
        "Lengths are without load unless one is given; marks are measured from the upper end, "
        f"under the same load. Tolerance: {_SHARE} of the length. Top deeper: by how much "
        f"{'that of its leg is ' if deck.file.legs else ''}if this "
        f"piece alone is {_SHARE} longer, in the environment {deck.environment}. Over side, onto "
        "drum: the order; the piece that goes over last is spooled first."
    )
    table = Table("Wires and ropes", columns, tuple(rows), note, by_hand=True)
    return ReportPart("Cutting and marking list", (table,))


def hardware_part(deck: Deck) -> ReportPart:
    """The hardware with its spares."""
    rows: list[tuple[Cell, ...]] = []
    kind = ""
    for stock in deck.hardware:
        if stock.kind != kind:
            kind = stock.kind
            rows.append((Cell(kind),))
        length = "" if stock.length is None else QUANTITIES["length"].format(stock.length)
        figures = (stock.use, str(stock.count), length, str(stock.spares), str(stock.total), "☐")
        named = Cell(stock.name, stock.basis and f"({stock.basis})", goes_on=True)
        rows.append((named, *map(Cell, figures)))
    columns = (
        Column("hardware", share=2.4),
        Column("id", share=0.8),
        Column("in the line", numeric=True),
        quantity_column("length", "length"),
        Column("spares", numeric=True),
        Column("to bring", numeric=True),
        Column("packed", share=0.0),
    )
    table = Table("", columns, tuple(rows), _SPARES)
    return ReportPart("Hardware bill", (table, Note((_IMPLIED,))))


def shipping_part(deck: Deck) -> ReportPart:
    """All that is shipped, and what the sums lack."""
    table = table_of(
        "",
        deck.shipped,
        (Column("component", share=1.6), lambda one: one.name),
        (Column("id"), lambda one: one.use),
        (Column("pieces", numeric=True), lambda one: str(one.count)),
        (
            quantity_column("length", "length"),
            lambda one: "" if one.length is None else QUANTITIES["length"].format(one.length),
        ),
        (
            quantity_column("dry_mass", "mass in air"),
            lambda one: _at_least("dry_mass", one.mass, one.missing_masses, one.count),
        ),
        (
            Column("volume", "l", numeric=True),
            lambda one: _at_least("volume", one.volume, one.missing_volumes, one.count),
        ),
        (Column("packed in", share=0.8), lambda one: ""),
        note="Volumes are of the parts themselves, without packing: spheres, cylinders and "
        "cables by their size, others by what they displace. ≥ marks a lower bound, "
        "because figures are missing. Spares are not included.",
        sums=[total_of(deck.shipped)],
    )
    return ReportPart("Shipping list", (table,))


def _at_least(name: str, value: float, missing: int, count: int) -> Cell:
    if missing == count:
        return Cell("unknown")
    text = QUANTITIES[name].format(value)
    return Cell(f"≥ {text}", f"{missing} unknown") if missing else Cell(text)


def lifts_part(deck: Deck) -> ReportPart:
    """The stages of deployment and recovery."""
    lifts = deck.lifts
    said = []
    if lifts.heaviest is not None:
        heaviest = lifts.heaviest
        said.append(
            f"Heaviest single lift: {heaviest.label}, {say('lift_mass', heaviest.mass)} in air, "
            f"{say('wet_weight', heaviest.weight)} in water."
        )
    if lifts.unknown:
        shown = ", ".join(lifts.unknown[:6]) + (" …" if len(lifts.unknown) > 6 else "")
        said.append(f"A lower bound: no mass in air is known for {shown}.")
    greatest = max(
        (one for one in lifts.deployment if one.hanging is not None),
        key=lambda one: one.hanging or 0.0,
        default=None,
    )
    if greatest is not None and (greatest.hanging or 0.0) > 0.0:
        said.append(
            f"The greatest hanging load is {say('wet_weight', greatest.hanging)} in water, "
            f"with {greatest.label} over the side."
        )
    note = (
        "In air: mass of the piece with its clamps, as the crane lifts it; cables are paid out. "
        "Hanging: weight in water of everything over the side, of a net of the leg alone, hanging "
        "straight down from the ship; below 0 it floats. Drag and swell are not included. "
        "Shackles, links and swivels are lifted with the pieces next to them; in the files each "
        "has its own row."
    )
    return ReportPart("Lifts", (Prose(tuple(said)), _stages(deck), Note((note,))))


def _marked(alike: Iterable[Mark], items: Mapping[str, DeckItem]) -> str:
    """Return the places of the marks of like clamps, and what is clamped there."""
    marks = [*alike]
    places = ", ".join(QUANTITIES["at"].format(mark.at) for mark in marks)
    marked = [items[mark.label] for mark in marks]
    floats = len(marked) > 1 and marked[0].role == "float"
    words = name_of_run(marked) if floats else label_of_run(marked)
    return f"mark at {places}: {words}"


def _stages(deck: Deck) -> Table:
    """Each lift once, with what hangs below it on the way down and on the way up."""
    joints = {one.label for one in deck.parts if one.is_joint}
    recovery = {one.label: one.hanging for one in deck.lifts.recovery}
    return table_of(
        f"In the order over the side{', leg by leg' * bool(deck.file.legs)}",
        [one for one in deck.lifts.deployment if one.label not in joints],
        *([(Column("leg"), lambda one: deck.leg(one.index))] if deck.file.legs else []),
        (Column("no.", numeric=True), lambda one: str(one.index)),
        (Column("at the rail", share=2.0), lambda one: one.label),
        quantity_field("lift_mass", "mass", "lift in\nair"),
        quantity_field("wet_weight", "weight", "lift in\nwater"),
        quantity_field("wet_weight", "hanging", "hangs at\ndeployment"),
        (
            quantity_column("wet_weight", "hangs at\nrecovery"),
            lambda one: figure_cell("wet_weight", recovery.get(one.label)),
        ),
    )


def instruments_part(deck: Deck) -> ReportPart:
    """Every instrument and release: where it hangs, and what the file says of it."""
    several = len(deck.environments) > 1
    legs = leg_titles(deck.result)
    rows: list[tuple[Cell, ...]] = []
    for name, own in deck.by_leg(deck.instruments, lambda one: one.item.index):
        rows += [(Cell(legs[name], strong=True),)] if name else []
        rows += [_instrument_row(one, several) for one in own]
    columns = (
        Column("instrument", share=2.0),
        Column("serial number", share=0.8),
        quantity_column("depth", "depth"),
        quantity_column("depth", "still\nwater"),
        *(
            (quantity_column("depth", "least"), quantity_column("depth", "greatest"))
            if several
            else ()
        ),
        Column("tilt", "°", numeric=True),
        Column("limit", "°", numeric=True),
        Column("sampling", share=0.9),
        Column("battery\nuntil", share=0.0),
        Column("calibrated", share=0.0),
    )
    note = f"Depths are in the environment {deck.environment}."
    if several:
        note += (
            f" Least and greatest depth, and tilt, are over {len(deck.environments)} "
            "environments; the line below names which."
        )
    table = Table("Instruments and releases", columns, tuple(rows), note)
    return ReportPart("Instrument sheet", (table,))


def _instrument_row(one: DeckInstrument, several: bool) -> tuple[Cell, ...]:
    component, equipment = one.item.part.component, one.item.part.equipment
    limits = [
        "-" if limit is None else QUANTITIES["tilt"].format(limit)
        for limit in (component.warn_tilt, component.max_tilt)
    ]
    return (
        Cell(
            one.item.label,
            one.item.name,
            indented=one.item.on is not None,
            strong=True,
            goes_on=True,
        ),
        Cell(one.item.serial or ""),
        figure_cell("depth", one.item.depth),
        figure_cell("depth", one.still),
        *((_extreme(one.shallowest), _extreme(one.deepest)) if several else ()),
        figure_cell("tilt", one.greatest_tilt),
        Cell(limits[1], "" if limits[0] == "-" else f"warn {limits[0]}"),
        Cell(equipment.sampling or ""),
        Cell(equipment.battery_until or ""),
        Cell(equipment.calibrated or ""),
    )


def _extreme(extreme: Extreme) -> Cell:
    return Cell(QUANTITIES["depth"].format(extreme.depth), extreme.environment)
