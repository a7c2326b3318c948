"""The deployment log and the recovery log, with boxes to fill in."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from itertools import groupby
from typing import TypeVar

from calm.deck import Deck
from calm.deck.deck_items import DeckItem, Order, RecoveredItem, label_of_run, name_of_run
from calm.drop import DropPlan
from calm.quantities import QUANTITIES, say
from calm.report.blocks import Block, Cell, Column, Pairs, Prose, ReportPart, Table, table_of
from calm.report.drop_sheet import whereabouts
from calm.report.provenance import position_text, title_pairs

_Listed = TypeVar("_Listed")

_BOX = Cell("☐")
_SOUNDINGS = 6


def deployment_part(deck: Deck) -> ReportPart:
    """Return what is done before, the order over the side, and where the anchor went."""
    last = deck.order is Order.ANCHOR_LAST
    blocks: tuple[Block, ...] = (
        *(() if deck.file.document else (Pairs(tuple(title_pairs(deck.file))),)),
        Prose(
            (
                "Anchor last: the top goes over the side first."
                if last
                else "Anchor first: the lower end goes over the side first.",
            )
        ),
        _releases(deck),
        _over_the_side(deck),
        _positions(deck),
        _soundings(),
    )
    return ReportPart("Deployment log", blocks)


def recovery_part(deck: Deck) -> ReportPart:
    """Return what is done at the release, and the order in which the line comes up."""
    rise = deck.rise
    said = []
    if rise is None:
        said.append("The rise of the line is not known; the order is that of the line.")
    elif rise.time_to_surface is None:
        said.append("Freed, the line does not rise by itself; the order is that of the line.")
    elif rise.time_to_surface == 0.0:
        said.append(
            "Its float is at the surface; what comes up from below is listed with its time."
        )
    else:
        first = rise.time_to_surface / 60.0
        said.append(
            f"Freed, the line rises with {say('speed', rise.rise_speed)}; the first float is "
            f"expected after {first:.0f} min."
        )
        if rise.tangles:
            said.append("It may double back in the rise: the order may be another.")
        if rise.in_still_water:
            said.append("The rise is that in still water.")
    blocks = (Prose(tuple(said)), _events(_AT_THE_RELEASE), _surfacing(deck))
    return ReportPart("Recovery log", blocks)


_AT_THE_RELEASE = (
    "On station", "Release enabled, range", "Release command sent", "Release confirmed",
    "First float seen, bearing", "All floats counted", "Hooked", "All on board",
)  # fmt: skip


def placed(items: Sequence[DeckItem], deck: Deck) -> str:
    """Return where clamps sit: from the upper end of their piece, anchor first from the lower end
    too.
    """
    places = [one.at for one in items if one.on is not None and one.at is not None]
    if not places:
        return ""
    text = f"{_span(places)} m from the upper end"
    length = items[0].of_length
    if deck.order is Order.ANCHOR_FIRST and length is not None:
        text += f", {_span([length - at for at in places])} m from the lower end"
    return text


def _span(values: Sequence[float]) -> str:
    ends = dict.fromkeys((f"{values[0]:.2f}", f"{values[-1]:.2f}"))
    return " to ".join(ends)


def _runs(
    items: Sequence[_Listed], item: Callable[[_Listed], DeckItem]
) -> list[tuple[str, list[_Listed]]]:
    """Return like items that follow one another, with their numbers in the list."""
    runs = []
    for _, group in groupby(enumerate(items, 1), key=lambda pair: item(pair[1]).kind):
        numbers, listed = zip(*group, strict=True)
        ends = dict.fromkeys((str(numbers[0]), str(numbers[-1])))
        runs.append(("–".join(ends), [*listed]))
    return runs


def _piece(items: Sequence[DeckItem]) -> Cell:
    return Cell(label_of_run(items), name_of_run(items), indented=items[0].on is not None)


def _releases(deck: Deck) -> Table:
    rows = [
        (Cell(release.serial or ""), Cell("\n".join(release.code_lines)), *[_BOX] * 3, Cell())
        for release in deck.file.releases
    ]
    known = {release.serial for release in deck.file.releases}
    rows += [
        (Cell(one.serial or "", one.label), Cell(), *[_BOX] * 3, Cell())
        for one in deck.parts
        if one.role == "release" and (one.serial is None or one.serial not in known)
    ]
    columns = (
        Column("release, serial number"),
        Column("codes"),
        Column("tested in\nthe laboratory", share=0.0),
        Column("tested\nat depth", share=0.0),
        Column("armed,\non deck", share=0.0),
        Column("battery, remarks"),
    )
    return Table("Releases", columns, tuple(rows), by_hand=True)


def _over_the_side(deck: Deck) -> Table:
    def length(one: DeckItem) -> str:
        return "" if one.cut_length is None or one.is_rigid else f"{one.cut_length:.2f}"

    return table_of(
        "Order over the side",
        _runs(deck.deployment, lambda one: one),
        (Column("no.", numeric=True), lambda run: run[0]),
        (Column("piece", share=2.6), lambda run: _piece(run[1])),
        (
            Column("length cut, or place on its wire", "m"),
            lambda run: placed(run[1], deck) or length(run[1][0]),
        ),
        (Column("serial number", share=0.7), lambda run: run[1][0].serial or ""),
        (Column("time over", "UTC", share=0.7), lambda one: ""),
        (Column("remarks"), lambda one: ""),
        (Column("checked", share=0.0), lambda one: _BOX),
        by_hand=True,
    )


def _positions(deck: Deck) -> Table:
    file = deck.file
    target = "" if file.position is None else position_text(file.position)
    depth = QUANTITIES["depth"].say(file.environment.depth)
    plan = deck.plan
    start = let_go = ""
    if isinstance(plan, DropPlan):
        let_go = whereabouts(plan, plan.let_go)
        start = "" if plan.start is None else whereabouts(plan, plan.start.place)
    rows = (
        (Cell("Target"), Cell(), Cell(target), Cell(depth), Cell()),
        (Cell("Fall-back target"), Cell(), Cell(), Cell(), Cell()),
        (Cell("First piece over"), Cell(start), Cell(), Cell(), Cell()),
        (Cell("Anchor let go"), Cell(let_go), Cell(), Cell(), Cell()),
        (Cell("Anchor on the bottom, ranged"), Cell(), Cell(), Cell(), Cell()),
    )
    columns = (
        Column(""),
        Column("planned, from the target"),
        Column("position", share=1.5),
        Column("depth", share=0.8),
        Column("time", "UTC", share=0.8),
    )
    return Table("Positions", columns, rows, by_hand=True)


def _soundings() -> Table:
    return table_of(
        "Soundings",
        range(1, _SOUNDINGS + 1),
        (Column("sounding", share=0.0), str),
        (Column("time", "UTC"), lambda one: ""),
        (Column("position", share=2.0), lambda one: ""),
        (Column("depth as read", "m"), lambda one: ""),
        (Column("correction", "m"), lambda one: ""),
        (Column("depth", "m"), lambda one: ""),
        by_hand=True,
    )


def _events(events: tuple[str, ...]) -> Table:
    return table_of(
        "At the release",
        events,
        (Column("event"), str),
        (Column("time", "UTC", share=0.7), lambda one: ""),
        (Column("position"), lambda one: ""),
        (Column("remarks", share=1.5), lambda one: ""),
        by_hand=True,
    )


def _surfacing(deck: Deck) -> Table:
    return table_of(
        "Order of surfacing",
        _runs(deck.recovery, lambda one: one.item),
        (Column("no.", numeric=True), lambda run: run[0]),
        (Column("piece", share=3.0), lambda run: _piece([one.item for one in run[1]])),
        (Column("serial number", share=0.8), lambda run: run[1][0].item.deployed_serial or ""),
        (Column("expected after\nthe release", share=1.3), lambda run: _expected(run[1])),
        (Column("seen", "UTC", share=0.6), lambda one: ""),
        (Column("on deck", "UTC", share=0.6), lambda one: ""),
        (Column("whole", share=0.0), lambda one: _BOX),
        (Column("fouled", share=0.0), lambda one: _BOX),
        (Column("runs", share=0.0), lambda one: _BOX),
        (Column("remarks", share=1.2), lambda run: run[1][0].item.remark or ""),
        note="By itself: what is buoyant enough; the rest comes with it, or hangs below when all "
        "is up. The order is that of surfacing, not of hauling.",
        by_hand=True,
    )


def _expected(items: Sequence[RecoveredItem]) -> Cell:
    """Return when the first comes up, and until when the last has; or where they hang."""
    said = []
    for one in (items[0], items[-1]):
        if one.time is not None:
            said.append(f"{one.time / 60.0:.1f} min")
        elif one.hangs_at is not None:
            said.append(f"hangs at {say('depth', one.hangs_at)}")
    text = " to ".join(dict.fromkeys(said))
    return Cell(text, "by itself" if any(one.by_itself for one in items) else "")
