"""Page 2 of a design check: drawing of the mooring from top to anchor, with one row per part."""

from collections.abc import Iterator, Mapping, Sequence
from math import ceil

from calm.case.result_tables import item_numbers, run_of
from calm.deck.deck_items import DeckItem, deck_items_of
from calm.drawing.check_figures import beside_row, row_height, seabed_row, surface_row
from calm.drawing.schematic.pen import text_width
from calm.drawing.schematic.shown_parts import ShownPart, TextRow, place_text
from calm.quantities import QUANTITIES
from calm.report.blocks import Block, Cell, PageBreak, Table, number, table_of, words
from calm.report.load_cases import LOAD, load_text
from calm.report.page_one import SignedMooring, afloat, drawn_parts
from calm.report.sheet import leg_title

_SHEET = {"a4": 688.0, "letter": 648.0}
"""Height available for the rows of a drawing [pt], by page size."""
_WORDS, _DEPTHS = (
    322.0,
    38.0,
)  # width of the text of a row together with its depths, and of one depth
_LINE_HEIGHT = 9.6
_BOLD, _REGULAR, _WRAPPED = 0.70, 0.77, 1.08
"""Estimates of text widths.

`_BOLD` and `_REGULAR` are the width of a bold and of a regular text, relative to the bound from
`text_width`. `_WRAPPED` is the total width of wrapped lines, relative to the text on a single line.
"""
_SEA_ROW = 16.0


def drawing_pages(signed: SignedMooring, page_size: str = "a4") -> Iterator[Block]:
    """Yield the drawing of the mooring from top to anchor, on one or more sheets."""
    if not signed.moored:
        return
    numbers = item_numbers(*signed.moored[0].results)
    for leg, result in enumerate(signed.moored[0].results):
        title = "Mooring drawing"
        if result.leg.of_several:
            title = f"Mooring drawing, leg {leg_title(result)}"
        for sheet, table in enumerate(_sheets(signed, leg, numbers, title, _SHEET[page_size])):
            if sheet:
                yield PageBreak()
            yield table


def _sheets(
    signed: SignedMooring, leg: int, numbers: Mapping[str, str], title: str, room: float
) -> Iterator[Table]:
    case = signed.moored[0]
    changed = [one for one in signed.moored[1:] if one.code != "0"]
    other = max(changed, key=lambda one: one.knockdown, default=None)
    still = next((one for one in signed.moored if one.code == "0"), None)
    chosen = (still if still is not case else None, case, other)
    cases = [one for one in chosen if one is not None and len(one.results) > leg]
    weights = {one.label: one.wet_weight for one in signed.assessment.inventory}
    tension: dict[str, float] = {}
    for one in signed.moored:
        for label, row in one.rows.items():
            tension[label] = max(tension.get(label, 0.0), row.tension)
    depth = QUANTITIES["depth"].format

    def cells(items: Sequence[DeckItem], lengths: tuple[str, str]) -> tuple[str, ...]:
        first = items[0].label
        own = [weights.get(one.label) for one in items]
        known = [one for one in own if one is not None]
        plan = items[0].planned_depth
        levels = (one.rows[first].upper[0] if first in one.rows else None for one in cases)
        loads = [tension[one.label] for one in items if one.on is None]
        length = _length_or_position(items, lengths[0])
        return (
            run_of([numbers[one.label] for one in items]),
            length,
            _signed_buoyancy(-sum(known)) if len(known) == len(own) else "?",
            *(["" if plan is None else depth(plan)] if planned else ()),
            *(depth(level) for level in levels),
            load_text(max(loads)) if loads else "",
        )

    result = case.results[leg]
    items = deck_items_of(result, signed.apart)
    planned = any(one.planned_depth is not None for one in items)
    surface = afloat(result)
    parts = drawn_parts(result, items, cells)
    width = _WORDS - _DEPTHS * (len(cases) + planned)
    rows = [_row(part, width, first=part is parts[0], last=part is parts[-1]) for part in parts]
    ends = len(cases), planned
    sea = _end_row(surface_row(_SEA_ROW), "sea surface", depth(0.0), *ends)
    bed = _end_row(seabed_row(_SEA_ROW), "seabed", depth(result.water.depth), *ends)
    heads = ["still" if one.code == "0" else f"case {one.code}" for one in cases]
    first, *others = [*["planned"] * planned, *heads]
    heads = [f"Depth {QUANTITIES['depth'].display_unit}\n{first}", *(f"\n{one}" for one in others)]
    columns = (
        words("", 0, 0.0), words("Item", 1, 0.0), words("", 2),
        number("Length\n" + QUANTITIES["length"].display_unit, 3),
        number(f"Net buoy-\nancy {LOAD.display_unit}", 4),
        *(number(head, 5 + at) for at, head in enumerate(heads)),
        number(f"Largest\ntension {LOAD.display_unit}", 5 + len(heads)),
    )  # fmt: skip
    heights = [height for height, _ in rows]
    breaks = [at for at, part in enumerate(parts) if part.junction]
    groups = [*_sheet_rows(heights, breaks, room - 2 * _SEA_ROW)]
    for sheet, (begin, end) in enumerate(groups):
        shown = [row for _, row in rows[begin:end]]
        if begin == leg == 0 and result.leg.top.free and not surface:
            shown.insert(0, sea)
        if end == len(rows) and result.leg.anchored:
            shown.append(bed)
        yield table_of(
            title if sheet == 0 else f"{title}, continued",
            shown,
            *columns,
            aside="top of the line first, not to scale; all tables use these item numbers",
            note=_DRAWING_NOTE if end == len(rows) and result is case.results[-1] else "",
        )


def _length_or_position(items: Sequence[DeckItem], given: str) -> str:
    if items[0].on is not None:
        return place_text(items[0].places[0]).removesuffix(".00")
    return " ".join(word.removesuffix(".00") for word in given.split(" "))


def _signed_buoyancy(force: float) -> str:
    text = load_text(force)
    return f"+{text}" if force > 0.0 and text.strip("0.") else text


_DRAWING_NOTE = (
    "Depths are given at the upper end: the depth planned in the mooring file, and the depths "
    "computed in still water and in the load cases. Lengths are as cut; for a clamp, the column "
    "gives the position on the piece. The largest tension is the maximum in all moored cases. Net "
    "buoyancy is positive upwards."
)


def _end_row(picture: str, name: str, depth: str, cases: int, planned: bool) -> tuple[Cell, ...]:
    depths = *[Cell()] * planned, *(Cell(detail=depth) for _ in range(cases))
    return (Cell(picture=picture), Cell(), Cell(detail=name), Cell(), Cell(), *depths, Cell())


def _row(
    part: ShownPart, width: float, *, first: bool, last: bool
) -> tuple[float, tuple[Cell, ...]]:
    """Return the height and the cells of a row; junctions are in small type.

    `width` is the width of the column with the name.
    """
    (row,) = part.rows
    height = max(row_height(part), _LINE_HEIGHT * _line_count(row, part, width) + 3.0)
    picture = Cell(picture=beside_row(part, height, first=first, last=last))
    if part.junction:
        return height, (
            picture, Cell(detail=row.cells[0]), Cell(detail=row.label),
            *(Cell(detail=one) for one in row.cells[1:]),
        )  # fmt: skip
    name = Cell(row.label, row.name, strong=True, goes_on=True)
    number_, *figures = row.cells
    return height, (picture, Cell(number_), name, *map(Cell, figures))


def _line_count(row: TextRow, part: ShownPart, width: float) -> int:
    if part.junction:
        needed = _REGULAR * text_width(row.label, 8.0)
    else:
        needed = _BOLD * text_width(row.label, 9.0, bold=True)
        needed += _REGULAR * text_width(f"  {row.name}", 8.0)
    return 1 if needed <= width else ceil(_WRAPPED * needed / width)


def _sheet_rows(
    heights: Sequence[float], breaks: Sequence[int], room: float
) -> Iterator[tuple[int, int]]:
    """Yield start and end (exclusive) of the rows on each sheet.

    A sheet ends above a junction if there is a junction in its second half.
    """
    begin = 0
    while begin < len(heights):
        end, used = begin, 0.0
        while end < len(heights) and (end == begin or used + heights[end] <= room):
            used += heights[end]
            end += 1
        if end < len(heights):
            fits = [at for at in breaks if begin + (end - begin) // 2 < at <= end]
            end = fits[-1] if fits else end
        yield begin, end
        begin = end
