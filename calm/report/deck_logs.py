"""The deployment log and the recovery log, with boxes to fill in."""

from collections.abc import Sequence
from dataclasses import replace

from calm.case.result_tables import run_of
from calm.deck import Deck, RecoveredItem
from calm.deck.deck_items import DeckItem, DeckRow, Order, hardware_text, printed_rows
from calm.drop import DropPlan
from calm.quantities import QUANTITIES, say
from calm.report import blocks
from calm.report.anchor_sheets import offset_from_target
from calm.report.blocks import (
    Block,
    Cell,
    Prose,
    ReportPart,
    Table,
    blank,
    number,
    quantity,
    table_of,
    words,
)
from calm.report.provenance import position_text
from calm.report.sheet import leg_titles

_BOX = Cell("☐")
_BLANK = Cell("\u00a0", "\u00a0")
"""Empty cell for handwriting, as high as two lines of text."""
_LEAST = 9.0
"""Font size of the logs, which are read and filled in on deck [pt]."""


def deployment_part(deck: Deck) -> ReportPart:
    """Build the deployment log: preparations, soundings, anchor position, deployment order."""
    last = deck.order is Order.ANCHOR_LAST
    sentences = (
        ("Anchor-last deployment: the top" if last else "Anchor-first deployment: the lower end")
        + f"{' of each leg' if deck.result.several else ''} goes over the side first. "
        + (_LEGS if deck.result.several else "")
        + "Lengths are as cut; positions of clamps are from the upper end of the unloaded piece."
    )
    unit = QUANTITIES["depth"].display_unit
    soundings = table_of(
        "Soundings",
        "1234",
        words("sounding", str, 0.0),
        blank("time", "UTC"),
        blank("position", share=2.0),
        *(blank(heading, unit) for heading in ("uncorrected", "correction", "corrected")),
        by_hand=True,
    )
    shown: tuple[Block, ...] = (
        _station_table(deck, _deployment_texts(deck)[0]),
        Prose((sentences,)),
        *_releases_table(deck, _TESTED, boxes=True),
        soundings,
        _positions_table(deck),
        *_deployment_tables(deck),
    )
    return ReportPart("Deployment log", shown, _LEAST)


def recovery_part(deck: Deck) -> ReportPart:
    """Build the recovery log, with the release events and the order of surfacing."""
    rise = deck.rise
    sentences = []
    if deck.result.several:
        sentences.append(
            "The ascent of a net is not computed; the pieces of each leg are listed from top to "
            "bottom."
        )
    elif rise is None:
        sentences.append("The ascent could not be computed; pieces are listed from top to bottom.")
    elif rise.time_to_surface is None:
        sentences.append(
            "After release the line does not rise; pieces are listed from top to bottom."
        )
    elif rise.time_to_surface == 0.0:
        sentences.append(
            "The float is at the surface; pieces that rise from below are listed with their times."
        )
    else:
        first = rise.time_to_surface / 60.0
        sentences.append(
            f"After release the line rises at {say('speed', rise.rise_speed)}; the first float "
            f"surfaces after {first:.0f} min."
        )
        if rise.tangles:
            sentences.append(
                "The line may double back during the ascent; pieces then surface in another order."
            )
        if rise.in_still_water:
            sentences.append("The ascent is computed in still water.")
    named = zip(("deployed", "position", "water depth"), _deployment_texts(deck), strict=True)
    known = tuple((name, text) for name, text in named if text)
    events = table_of(
        "At the release",
        _EVENTS,
        words("event", str),
        blank("time", "UTC", 0.7),
        blank("position"),
        blank("remarks", share=1.5),
        by_hand=True,
    )
    shown: tuple[Block, ...] = (
        _station_table(deck, ""),
        *([blocks.Pairs(known)] if known else []),
        Prose(tuple(sentences)),
        *_releases_table(deck, _FIRED, boxes=False),
        events,
        *_surfacing_tables(deck),
    )
    return ReportPart("Recovery log", shown, _LEAST)


_LEGS = (
    "The legs are listed in file order, or in reverse for anchor-first deployment; CALM does not "
    "plan their sequence. "
)
_EVENTS = (
    "On station", "First float seen, bearing", "All floats counted", "Hooked", "All on board",
)  # fmt: skip
_TESTED = ("tested in\nthe laboratory", "tested\nat depth", "armed,\non deck")
_FIRED = ("enabled\nUTC", "range", "command\nsent, UTC", "confirmed\nUTC")


def _station_table(deck: Deck, day: str) -> Table:
    document = deck.file.document
    known = {
        "ship": document.ship if document else None,
        "cruise": document.cruise if document else None,
        "station": None,
        "date, UTC": day,
        "observer": None,
        "wind, sea, current, weather": None,
    }
    shares = {"station": 0.7, "wind, sea, current, weather": 2.4}
    row = [Cell(text) if text else _BLANK for text in known.values()]
    heads = (words(name, at, shares.get(name, 1.0)) for at, name in enumerate(known))
    return table_of("", [row], *heads, by_hand=True)


def _deployment_texts(deck: Deck) -> tuple[str, str, str]:
    """Format date, position and water depth of the deployment; each is "" if unknown."""
    deployed = deck.file.deployed
    if deployed is None:
        return "", "", ""
    position = "" if deployed.position is None else position_text(deployed.position)
    depth = "" if deployed.depth is None else say("depth", deployed.depth)
    return deployed.date or "", position, depth


def placed(items: Sequence[DeckItem], deck: Deck) -> str:
    """Format clamp positions, measured from the upper end of the piece.

    For an anchor-first deployment, the distances from the lower end are added.
    """
    places = [at for one in items for at in one.places]
    if not places:
        return ""
    text = f"at {_span(places)}"
    length = items[0].of_length
    if deck.order is Order.ANCHOR_FIRST and length is not None:
        text += f", {_span([length - at for at in places])} from the lower end"
    return text


def _span(values: Sequence[float]) -> str:
    ends = dict.fromkeys(map(QUANTITIES["at"].format, (values[0], values[-1])))
    return " to ".join(ends)


def _item_numbers(row: DeckRow, deck: Deck) -> str:
    return run_of([deck.numbers[one.label] for one in (*row.items, *row.floats, *row.joints)])


def _piece_cell(row: DeckRow, order: Order = Order.ANCHOR_LAST) -> Cell:
    joints = hardware_text(row.joints)
    detail = f"{row.name}; with {joints}" if joints else row.name
    if joints and row.is_followed_by_clamps:  # the clamps are listed before the next piece
        detail += f" at the {'lower' if order is Order.ANCHOR_LAST else 'upper'} end"
    return Cell(row.label, detail, indented=row.first.on is not None, strong=True, goes_on=True)


def _releases_table(deck: Deck, checks: Sequence[str], *, boxes: bool) -> list[Table]:
    codes = {one.serial: "\n".join(one.code_lines) for one in deck.file.releases}
    rows = []
    for part in deck.parts:
        if part.role == "release":
            items = max(part.part.component.items or 1, len(part.serials))
            for serial in (*part.serials, *[""] * items)[:items]:
                rows.append((Cell(serial, part.label), codes.pop(serial, "")))
    rows += [(Cell(serial or ""), text) for serial, text in codes.items()]
    table = table_of(
        "Releases",
        rows,
        words("release, serial number", 0),
        words("codes", 1),
        *(
            words(check, lambda _: _BOX, 0.0) if boxes else blank(check, share=0.7)
            for check in checks
        ),
        blank("battery, remarks"),
        by_hand=True,
    )
    return [table] if rows else []


def _deployment_tables(deck: Deck) -> list[Table]:
    planned = any(one.planned_depth is not None for one in deck.deployment)

    def length(row: DeckRow) -> str:
        first = row.first
        if first.on is not None or first.is_rigid:
            return placed(row.items, deck)
        return "\n".join(filter(None, (row.lengths, placed(row.floats, deck))))

    def plan(row: DeckRow) -> str:
        depth = row.first.planned_depth
        return "" if depth is None else QUANTITIES["planned_depth"].format(depth)

    unit, deep = QUANTITIES["length"].display_unit, QUANTITIES["depth"].display_unit
    fields = (
        number("no.", lambda row: _item_numbers(row, deck)),
        words("piece", lambda row: _piece_cell(row, deck.order), 3.8),
        words("length,\nor position", length, 1.3, unit=unit),
        *([quantity("depth", "first.depth"), number("planned", plan, deep)] if planned else []),
        words("serial\nnumber", "first.serial", 0.7),
        blank("over", "UTC", 0.6),
        blank("remarks"),
        words("☐", lambda _: _BOX, 0.0),
    )
    return [
        table_of(title, printed_rows(items), *fields, by_hand=True)
        for title, items in _titled_by_leg("Order over the side", deck, deck.deployment)
    ]


def _titled_by_leg(
    title: str, deck: Deck, items: Sequence[DeckItem]
) -> list[tuple[str, list[DeckItem]]]:
    legs = leg_titles(deck.result)
    return [
        (f"{title}: {legs[name]}" if name else title, own)
        for name, own in deck.by_leg(items, lambda one: one.index)
    ]


def _positions_table(deck: Deck) -> Table:
    file, plan = deck.file, deck.plan
    target = "" if file.position is None else position_text(file.position)
    start = let_go = ""
    if isinstance(plan, DropPlan):
        let_go = offset_from_target(plan, plan.let_go)
        start = "" if plan.start is None else offset_from_target(plan, plan.start.place)
    rows = (
        ("Target", "", target, QUANTITIES["depth"].say(file.environment.depth)),
        ("Fall-back target", "", "", ""),
        ("First piece over", start, "", ""),
        ("Anchor release", let_go, "", ""),
        ("Anchor, ranged", "", *_deployment_texts(deck)[1:]),
    )
    return table_of(
        "Positions",
        rows,
        words("", 0),
        words("planned, from the target", 1, 1.9),
        words("position", 2, 1.9),
        words("depth,\ncorrected", 3, 0.8),
        blank("time", "UTC", 0.6),
        by_hand=True,
    )


def _surfacing_tables(deck: Deck) -> list[Table]:
    risen = {id(one.item): one for one in deck.recovery}
    listed = [one.item for one in deck.recovery if not one.item.is_joint]

    def expected(row: DeckRow) -> Cell:
        return _surfacing_cell([risen[id(one)] for one in (*row.items, *row.floats)])

    fields = (
        number("no.", lambda row: _item_numbers(row, deck)),
        words("piece", _piece_cell, 4.6),
        words("serial\nnumber", "first.deployed_serial", 0.95),
        words("surfaces\nor hangs", expected, 0.0),
        blank("seen", "UTC", 0.65),
        blank("on deck", "UTC", 0.65),
        words("whole,\nruns,\nfouled", lambda _: "☐ ☐ ☐", 0.0),
        words("remarks", "first.remark"),
    )
    note = (
        "Surfaces or hangs: time from release to surfacing, or the depth at which the piece hangs "
        "from the surfaced line. By itself: the piece is buoyant enough to surface alone; all "
        "other pieces need the lift of their neighbours. Pieces are listed in order of surfacing, "
        "not of hauling. "
        "Shackles, links and swivels surface with the pieces they connect."
    )
    tables = [
        table_of(title, printed_rows(items), *fields, by_hand=True)
        for title, items in _titled_by_leg("Order of surfacing", deck, listed)
    ]
    return [*tables[:-1], *(replace(last, note=note) for last in tables[-1:])]


def _surfacing_cell(items: Sequence[RecoveredItem]) -> Cell:
    sentences = []
    for one in (items[0], items[-1]):
        if one.time is not None:
            minutes = one.time / 60.0
            sentences.append(f"{minutes:.{1 if minutes < 10.0 else 0}f} min")
        elif one.hangs_at is not None:
            sentences.append(f"at {say('depth', one.hangs_at)}")
    text = (
        "\nto ".join(dict.fromkeys(sentences)).replace(" min\nto", " to").replace("to at ", "to ")
    )
    return Cell(text, "by itself" if any(one.by_itself for one in items) else "")
