"""Page 2 of a design check: the mooring from the top to the anchor, a row a part."""

from collections.abc import Iterator, Mapping, Sequence

from calm.deck.deck_items import DeckItem, deck_items_of
from calm.drawing.check_figures import beside_row, row_height, seabed_row, surface_row
from calm.drawing.schematic.pen import wrapped
from calm.drawing.schematic.shown_parts import ShownPart, place_text
from calm.quantities import QUANTITIES
from calm.report.blocks import Block, Cell, PageBreak, Table, number, table_of, words
from calm.report.load_cases import LOAD, load_text
from calm.report.page_one import SignedMooring, afloat, drawn_parts
from calm.report.sheet import leg_title

_SHEET = {"a4": 660.0, "letter": 612.0}
"""Room for the rows of a drawing [pt]."""
_WORDS = 200.0  # width of the words of a row
_LINE_HEIGHT = 10.6
_SEA_ROW = 16.0


def drawing_pages(signed: SignedMooring, paper: str = "a4") -> Iterator[Block]:
    """Yield the mooring drawing, top to anchor, one row per part, on one or more sheets."""
    if not signed.standing:
        return
    numbers = item_numbers(signed)
    for leg, result in enumerate(signed.standing[0].results):
        title = "Mooring drawing"
        if result.leg.of_several:
            title = f"Mooring drawing, leg {leg_title(result)}"
        for sheet, table in enumerate(_sheets(signed, leg, numbers, title, _SHEET[paper])):
            if sheet:
                yield PageBreak()
            yield table


def item_numbers(signed: SignedMooring) -> dict[str, str]:
    """The number of every piece in the line, with a letter behind it of a clamp."""
    found: dict[str, str] = {}
    piece = 0
    for result in signed.standing[0].results:
        letters = 0
        for one in deck_items_of(result):
            if one.on is None:
                piece, letters = piece + 1, 0
                found[one.label] = str(piece)
            else:
                found[one.label] = f"{piece}{_letter(letters)}"
                letters += 1
    return found


def _letter(place: int) -> str:
    return chr(ord("a") + place) if place < 26 else f".{place + 1}"


def _sheets(
    signed: SignedMooring, leg: int, numbers: Mapping[str, str], title: str, room: float
) -> Iterator[Table]:
    case = signed.standing[0]
    others = [one for one in signed.standing[1:] if one.code != "0"]
    other = max(others, key=lambda one: one.knockdown, default=None)
    cases = [one for one in (case, other) if one is not None and len(one.results) > leg]
    still = next((one for one in signed.standing if one.code == "0"), None)
    weights = {one.label: one.wet_weight for one in signed.assessment.inventory}
    tension: dict[str, float] = {}
    for one in signed.standing:
        for label, row in one.rows.items():
            tension[label] = max(tension.get(label, 0.0), row.tension)
    depth = QUANTITIES["depth"].format

    def cells(items: Sequence[DeckItem], lengths: tuple[str, str]) -> tuple[str, ...]:
        first = items[0].label
        own = [weights.get(one.label) for one in items]
        known = [one for one in own if one is not None]
        plan = items[0].planned_depth
        if plan is None and still is not None and first in still.rows:
            plan = still.rows[first].upper[0]
        levels = (one.rows[first].upper[0] if first in one.rows else None for one in cases)
        loads = [tension[one.label] for one in items if one.on is None]
        length = _length(items, lengths[0])
        pieces = [one for one in items if one.on is None] or items
        return (
            run_of([numbers[one.label] for one in pieces]),
            length,
            _buoyancy(-sum(known)) if len(known) == len(own) else "?",
            "" if plan is None else depth(plan),
            *(depth(level) for level in levels),
            load_text(max(loads)) if loads else "",
        )

    result = case.results[leg]
    items = deck_items_of(result)
    surface = afloat(result)
    parts = drawn_parts(result, items, cells)
    rows = [_row(part, first=part is parts[0], last=part is parts[-1]) for part in parts]
    sea = _end_row(surface_row(_SEA_ROW), "sea surface", depth(0.0), len(cases))
    bed = _end_row(seabed_row(_SEA_ROW), "seabed", depth(result.water.depth), len(cases))
    columns = (
        words("", 0, 0.0), words("Item", 1, 0.0), words("", 2),
        number("Length\n" + QUANTITIES["length"].display_unit, 3),
        number(f"Net buoy-\nancy {LOAD.display_unit}", 4),
        number("Depth m\nplanned", 5),
        *(number(f"\ncase {one.code}", 6 + at) for at, one in enumerate(cases)),
        number(f"Largest\ntension {LOAD.display_unit}", 6 + len(cases)),
    )  # fmt: skip
    heights = [height for height, _ in rows]
    breaks = [at for at, part in enumerate(parts) if part.junction]
    groups = [*_broken(heights, breaks, room - 2 * _SEA_ROW)]
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
            aside="from the top, not to scale; item numbers are those of all tables",
            note=_DRAWING_NOTE if end == len(rows) and result is case.results[-1] else "",
        )


def _length(items: Sequence[DeckItem], given: str) -> str:
    """Cut length of a row, or the position of a clamp."""
    if items[0].on is not None:
        return place_text(items[0].places[0]).removesuffix(".00")
    return " ".join(word.removesuffix(".00") for word in given.split(" "))


def _buoyancy(force: float) -> str:
    """Format a net buoyancy with its sign; no sign if it rounds to zero."""
    text = load_text(force)
    return f"+{text}" if force > 0.0 and text.strip("0.") else text


_DRAWING_NOTE = (
    "Depths are at the upper end; without a planned depth, that column has the depth in still "
    "water. Lengths are as cut; clamps have their position on the piece. The largest tension is "
    "over all moored cases. Net buoyancy is positive upwards."
)


def _end_row(picture: str, name: str, depth: str, cases: int) -> tuple[Cell, ...]:
    depths = (Cell(detail=depth) for _ in range(1 + cases))
    return (Cell(picture=picture), Cell(), Cell(detail=name), Cell(), Cell(), *depths, Cell())


def _row(part: ShownPart, *, first: bool, last: bool) -> tuple[float, tuple[Cell, ...]]:
    """Return the height and cells of a row; junctions are set in small letters."""
    (row,) = part.rows
    told = f"{row.label}  {row.name}" if row.name else row.label
    lines = len(wrapped(told, _WORDS, 8.0))
    height = max(row_height(part), _LINE_HEIGHT * lines + 3.0)
    picture = Cell(picture=beside_row(part, height, first=first, last=last))
    if part.junction:
        return height, (
            picture, Cell(detail=row.cells[0]), Cell(detail=row.label),
            *(Cell(detail=one) for one in row.cells[1:]),
        )  # fmt: skip
    name = Cell(row.label, row.name, strong=True, goes_on=True)
    number_, *figures = row.cells
    return height, (picture, Cell(number_), name, *map(Cell, figures))


def _broken(
    heights: Sequence[float], breaks: Sequence[int], room: float
) -> Iterator[tuple[int, int]]:
    """Yield the rows of each sheet; sheets end above a junction if one is near the foot."""
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


def run_of(numbers: Sequence[str]) -> str:
    """Format the numbers of consecutive items as a range."""
    return numbers[0] if len(numbers) == 1 else f"{numbers[0]}–{numbers[-1]}"
