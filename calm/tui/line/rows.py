"""The table of the line: what the file says beside what was found for it."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

from calm.assemble.catalogue_search import Index
from calm.checks.finding import State
from calm.files import Place
from calm.files.editing import Draft, LineItem
from calm.quantities import QUANTITIES
from calm.tui.checking import length_text
from calm.tui.line.table import TableRow
from calm.tui.theme import CLAMP, ROLES, UNKNOWN_MARGIN, UNKNOWN_ROLE, worst

if TYPE_CHECKING:
    from calm.tui.live import FoundRow, View

_MOST_MARGIN = 9.99


def table_rows(
    draft: Draft, view: View | None, index: Index | None, added: Collection[Place] = ()
) -> list[TableRow]:
    """A row for each item and clamp; figures of pieces that share an item are its worst.

    A view of an earlier text gives its figures to the rows that are called as its own are, but for
    those that were `added`.
    """
    found = _figures(draft, view, added)
    wrong = _wrong_items(draft, view)
    rows = []
    before, legs = "", draft.lists.legs
    for number, item in enumerate(draft.items):
        row = _row(Place(number), item, found.get(Place(number), ()), index)
        if legs[number] != before:  # the first row of a leg has its name
            before = row.texts["leg"] = legs[number]
        rows.append(replace(row, state=State.FAIL) if number in wrong else row)
        for below, clamp in enumerate(item.clamps):
            spot = Place(number, clamp=below)
            rows.append(_row(spot, clamp, found.get(spot, ()), index))
    return rows


def _wrong_items(draft: Draft, view: View | None) -> set[int]:
    """The items in whose lines there are mistakes."""
    if view is None or view.text != draft.text or not view.problems:
        return set()
    lines = {problem.line for problem in view.problems if problem.path == str(view.path)}
    starts = [(item.line, number) for number, item in enumerate(draft.items)]
    ends = {number: line + draft.items[number].text.count("\n") for line, number in starts}
    return {
        number
        for line, number in starts
        if any(line <= wrong < max(ends[number], line + 1) for wrong in lines)
    }


def _figures(
    draft: Draft, view: View | None, added: Collection[Place]
) -> dict[Place, Sequence[FoundRow]]:
    """Return what was found for each row."""
    if view is None:
        return {}
    found: dict[Place, list[FoundRow]] = {}
    for row in view.rows:
        found.setdefault(row.place.row, []).append(row)
    if view.text == draft.text:
        return dict(found)
    known: dict[tuple[str, str, bool], list[Sequence[FoundRow]]] = {}
    for place, rows in found.items():
        known.setdefault(_called(view.items, place), []).append(rows)
    taken: dict[Place, Sequence[FoundRow]] = {}
    for number, item in enumerate(draft.items):
        for below in range(-1, len(item.clamps)):
            place = Place(number, clamp=below)
            rest = known.get(_called(draft.items, place))
            if rest and place not in added:
                taken[place] = rest.pop(0)
    return taken


def _called(items: Sequence[LineItem], place: Place) -> tuple[str, str, bool]:
    """Return what the file says a row is: component, label, and whether it is clamped."""
    item = items[place.item]
    values = (item.clamps[place.clamp] if place.is_clamp else item).values
    use = values.get("use", "")
    return use, values.get("label", use), place.is_clamp


def _row(spot: Place, item: LineItem, found: Sequence[FoundRow], index: Index | None) -> TableRow:
    values = {key: " ".join(value.split()) for key, value in item.values.items()}  # of one line
    use = values.get("use", "")
    listed = None if index is None else index.get(use)
    sign = UNKNOWN_ROLE if listed is None else ROLES.get(listed.role, " ")
    unknown = index is not None and listed is None
    texts = {
        "component": f"{CLAMP} {use}" if spot.is_clamp else use,
        "label": values.get("label", ""),
        "count": values.get("count", ""),
        "length": f"at {values.get('at', '?')}" if spot.is_clamp else _length(values, found),
        **_told(found),
    }
    states = [row.state for row in found if row.state is not None]
    return TableRow(spot, sign if index else " ", texts, worst(states), unknown)


def _length(values: Mapping[str, str], found: Sequence[FoundRow]) -> str:
    """A length as written; of one that is fitted, what it is cut to."""
    if values.get("length") == "fit" and found and found[0].length is not None:
        return f"fit: {QUANTITIES['length'].say(found[0].length)}"
    return length_text(values)


def _told(found: Sequence[FoundRow]) -> dict[str, str]:
    """The figures of the pieces of one item: where it begins, and the worst of them."""
    depths = [row.depth for row in found if row.depth is not None]
    tensions = [row.tension for row in found if row.tension is not None]
    tilts = [row.tilt for row in found if row.tilt is not None]
    margins = [row.margin for row in found if row.margin is not None]
    texts = {}
    if depths:
        texts["depth"] = QUANTITIES["depth"].format(depths[0])
    if tensions:
        texts["tension"] = QUANTITIES["tension"].format(max(tensions))
    if tilts:
        texts["tilt"] = QUANTITIES["tilt"].format(max(tilts))
    if any(row.lacks_strength for row in found):
        texts["margin"] = UNKNOWN_MARGIN
    elif margins:
        texts["margin"] = _margin(min(margins))
    return texts


def _margin(margin: float) -> str:
    """A share of the limit as a percentage with its sign."""
    return f"{min(margin, _MOST_MARGIN):+.0%}"
