"""Page one of a design check, which the engineer signs."""

from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from math import nan

from calm.case.leg_result import LegResult
from calm.case.result_tables import item_numbers
from calm.checks.assess import RULES
from calm.checks.assessment import Assessment
from calm.checks.finding import Finding, State, governing_of_each_rule
from calm.deck.deck_items import SHOWN_USE, DeckItem, deck_items_of, standing_out
from calm.drawing.check_figures import DrawnCase, Label, elevation
from calm.drawing.line_picture import differ_by_number, together
from calm.drawing.schematic.deck_parts import Cells, parts_of
from calm.drawing.schematic.shown_parts import ShownPart
from calm.drawing.schematic.symbols import LINES
from calm.quantities import QUANTITIES, Quantity, bearing_of, bearing_text
from calm.report import blocks, provenance
from calm.report.blocks import (
    Beside,
    Block,
    Cell,
    Figure,
    OpenItem,
    OpenItems,
    Prose,
    Running,
    SignOff,
    Span,
    Table,
    TitleBlock,
    number,
    table_of,
    words,
)
from calm.report.load_cases import LOAD, LoadCase, load_text, worst_of_each_environment
from calm.report.open_items import (
    FIGURE_FIELDS,
    draft,
    open_groups,
    percent_text,
    short,
    verdict_sentence,
    verdict_words,
    where_text,
)
from calm.version import __version__

MOST_CASES, MOST_CHECKS, MOST_LABELS = 8, 10, 24
MARKS = {
    State.FAIL: "✗", State.UNKNOWN: "?", State.WARN: "▲", State.ESTIMATED: "≈", State.ACCEPTED: "○",
    State.NOT_JUDGED: "–", State.PASS: "✓",
}  # fmt: skip
"""Signs of the states in print."""

MOST_REVISIONS = 3

TEXT_HEIGHT = {"a4": 746.0, "letter": 706.0}
"""Height of a page between header and footer [pt]."""
_FIXED, _ROW = 250.0, 12.6
_LINE = 100  # characters in a line of the verdict
_PLACE = 15  # most characters of a label below a column of the load cases
_TITLE_LINE, _TITLE_LETTERS = 12.0, 52  # height of a line of the description, and its characters
_FIGURE_WIDTH, _WIDTH = 281.0, 510.0


@dataclass(frozen=True)
class SignedMooring:
    """A mooring with all data for its printed report.

    Attributes
    ----------
    assessment : assessment of the mooring
    cases : load cases of the mooring
    items : numbered open items
    sha256 : hash of the inputs
    """

    assessment: Assessment
    cases: Sequence[LoadCase]
    items: Sequence[OpenItem]
    sha256: str

    @property
    def moored(self) -> list[LoadCase]:
        """Load cases that have an equilibrium."""
        return [one for one in self.cases if one.results]

    @cached_property
    def apart(self) -> frozenset[str]:
        """Labels of the connecting hardware that needs a table row of its own."""
        return standing_out(self.assessment.every_finding())

    @property
    def document(self) -> str:
        """Document number and revision; "" if the document has no number."""
        given = self.assessment.file.document
        if given is None or not given.id:
            return ""
        return f"{given.id} rev.\u00a0{given.revision}" if given.revision else given.id

    @property
    def verdict(self) -> str:
        """Verdict for the header of every page."""
        conclusion = self.assessment.verdict
        return f"DRAFT, {conclusion.words}" if draft(self.assessment) else verdict_words(conclusion)

    def running(self) -> Running:
        """Return the running header and footer of all pages."""
        given = self.assessment.file.document
        date = (given.date if given else None) or provenance.date() or ""
        own = [given.institution if given else None, f"CALM {__version__}"]
        foot = "  ".join(filter(None, (*own, f"inputs {self.sha256[:12]}")))
        title = f"{self.assessment.name}  design check"
        return Running(self.document, title, self.verdict, date, foot)


def title_block(signed: SignedMooring) -> TitleBlock:
    """Create the title block of page one; missing fields are empty."""
    file = signed.assessment.file
    given, position, depth = file.document, file.position, file.environment.depth

    def field(name: str) -> str:
        return (getattr(given, name) if given else None) or ""

    kind = (
        "net"
        if file.legs or len({one.leg.name for one in signed.assessment.in_environments}) > 1
        else ""
    )
    results = [one for case in signed.moored for one in case.results]
    surface = any(one.type == "surface" for one in results)
    place = "" if position is None else provenance.position_text(position)
    cruise = f"cruise {field('cruise')}" if field("cruise") else ""
    below = (field("project"), cruise, field("ship"), field("institution"))
    return TitleBlock(
        "Design check of a mooring",
        signed.assessment.name,
        tuple(filter(None, (file.description, " · ".join(filter(None, below))))),
        (
            ("Document", field("id")), ("Rev.", field("revision")),
            ("Date", field("date") or provenance.date() or ""), ("Page", ""),
            ("Position", place),
            ("Water depth", "" if depth is None else _whole("depth_rating").say(depth)),
            ("Type", kind or ("surface" if surface else "sub-surface")),
        ),
    )  # fmt: skip


def verdict_box(signed: SignedMooring) -> Prose:
    """Create the box with the verdict and its reasons."""
    head = f"{verdict_words(signed.assessment.verdict)}: "
    state = signed.assessment.state
    return Prose(((Span(head, state), Span(verdict_sentence(signed.assessment))),), state)


@dataclass(frozen=True)
class _CaseColumn:
    """Column of the table of load cases.

    Attributes
    ----------
    of : function that returns the value in a load case, or the value and its component
    least : whether the smallest value governs
    """

    heading: str
    of: Callable[[LoadCase], float | tuple[float, str] | None]
    text: Callable[[float], str]
    least: bool = False
    short: str | None = None

    def value(self, case: LoadCase) -> tuple[float, str] | None:
        found = self.of(case) if case.results else None
        return found if found is None or isinstance(found, tuple) else (found, "")

    def field(self, lead: float) -> blocks.Field:
        def show(case: LoadCase) -> Cell:
            found = self.value(case)
            if found is None:
                return Cell("–")
            return Cell(self.text(found[0]), strong=found[0] == lead)

        return number(self.heading, show, short=self.short)


def _whole(name: str) -> Quantity:
    return QUANTITIES[name]


def _all_case_columns() -> tuple[_CaseColumn, ...]:
    depth, metres = QUANTITIES["depth"].format, _whole("depth_rating").format
    unit = QUANTITIES["depth"].display_unit
    return (
        _CaseColumn(f"Top depth\n{unit}", lambda one: one.depth, metres, short=f"top\n{unit}"),
        _CaseColumn(
            f"Knock-\ndown {unit}", lambda one: one.knockdown, depth, short=f"knock-\ndown {unit}"
        ),
        _CaseColumn(f"Offset\n{unit}", lambda one: one.offset, metres, short=f"offset\n{unit}"),
        _CaseColumn(
            f"Largest\ntension {LOAD.display_unit}",
            lambda one: one.tension,
            load_text,
            short=f"tension\n{LOAD.display_unit}",
        ),
        _CaseColumn(
            "Safety\nfactor", lambda one: one.factor, "{:.1f}".format, True, "safety\nfactor"
        ),
        _CaseColumn(
            "Strength\nuse %", lambda one: one.strength, percent_text, short="strength\nuse %"
        ),
        _CaseColumn("Anchor\nuse %", lambda one: one.anchor, percent_text, short="anchor\nuse %"),
        _CaseColumn(
            "Instrument\ntilt °", lambda one: one.tilt, QUANTITIES["tilt"].format, short="tilt\n°"
        ),
    )


def case_columns(cases: Sequence[LoadCase]) -> list[blocks.Field]:
    """Return the columns in which at least one load case has a value.

    No value in these columns is bold.
    """
    known = [one for one in _all_case_columns() if any(one.value(case) for case in cases)]
    return [figure.field(nan) for figure in known]


def shown_cases(cases: Sequence[LoadCase]) -> tuple[list[LoadCase], str]:
    """Select the load cases that fit in a table; also return a note on the omitted cases."""
    cases, note = [*cases], ""
    if len(cases) > MOST_CASES:
        cases = worst_of_each_environment(cases)
        note = "For each environment, the table shows the case with the largest knockdown."
    if len(cases) > MOST_CASES:
        kept = sorted(cases, key=lambda one: -one.knockdown)[:MOST_CASES]
        note += f" Less severe cases omitted: {len(cases) - MOST_CASES}."
        cases = [one for one in cases if one in kept]
    return cases, note


def cases_table(signed: SignedMooring) -> Table:
    """Tabulate the load cases; governing values are bold.

    The last row names the components to which the governing values belong.
    """
    cases, note = shown_cases(signed.cases)

    def named(case: LoadCase) -> str:
        return short(case.words, 80) if case.results else f"{case.words}: no equilibrium"

    leads = []
    for figure in _all_case_columns():
        known = [found for one in cases if (found := figure.value(one)) is not None]
        leads.append((min if figure.least else max)(known, default=None))
    shown = [
        (one, lead)
        for one, lead in zip(_all_case_columns(), leads, strict=True)
        if lead is not None
    ]
    table = table_of(
        "Load cases",
        cases,
        words("", lambda one: Cell(one.code, strong=True), 0.0),
        words("Case", named),
        *(figure.field(lead[0]) for figure, lead in shown),
        note=note,
        ruled=False,
        aside="governing values are bold; the last row names their components",
    )
    numbers = item_numbers(*signed.moored[0].results) if signed.moored else {}

    def place(label: str) -> str:
        item = numbers.get(label)
        return label if len(label) <= _PLACE or item is None else f"item {item}"

    where = (Cell(detail=short(place(lead[1]), _PLACE)) for _, lead in shown)
    row = Cell(), Cell(detail="where"), *where
    return replace(table, rows=(*table.rows, row), totals=1) if shown else table


def governing_rows(findings: Iterable[Finding]) -> list[Finding]:
    """List the governing finding of each rule, in order of decreasing utilisation.

    Rules without a utilisation are omitted. The rule `release-load` is also omitted if its finding
    repeats the finding of `strength`.
    """
    found = [one for one in governing_of_each_rule(findings) if one.utilisation is not None]
    figures = {(one.component, one.value, one.limit) for one in found if one.rule == "strength"}
    findings = [
        one for one in found
        if one.rule != "release-load" or (one.component, one.value, one.limit) not in figures
    ]  # fmt: skip
    return sorted(findings, key=lambda one: -(one.utilisation or 0.0))


def governing_table(signed: SignedMooring) -> Table:
    """Tabulate the checks with the largest utilisations, which are drawn as bars."""
    rows = governing_rows(signed.assessment.every_finding())
    over, half = (
        sum((one.utilisation or 0.0) > share for one in rows) for share in (1.0, SHOWN_USE)
    )
    kept = rows[: max(over, min(MOST_CHECKS, half))] or rows[:3]
    rest = rows[len(kept) :]
    note = (
        "✓ passes  ≈ passes with an estimated value  ▲ warning  ○ accepted  ? unknown  ✗ fails.  "
    )
    note += "Cases: L launch, R rise, B break."
    if rest:
        most = percent_text(rest[0].utilisation)
        note = f"All other checks: {most} % or less (see checks in full). {note}"
    return table_of(
        "Governing checks",
        kept,
        *check_fields(MOST_LABELS),
        note=note,
        ruled=False,
        aside="Use is demand / capacity or, for a minimum, required / available, rounded up. "
        "Bars are hatched above the line at 100 %.",
    )


def check_fields(longest: int) -> tuple[blocks.Field, ...]:
    """Return the columns of a table of findings, with bars.

    The name of the component in the last column is cut to about `longest` characters.
    """
    return (
        words("", lambda one: Cell(state=one.state), 0.0),
        words("Check", lambda one: RULES[one.rule].title, 1.15),
        words("", lambda one: Cell(bar=min(one.utilisation, 9.99), state=one.state), 1.5),
        *FIGURE_FIELDS,
        words("Where, case", lambda one: short(where_text(one), longest + 8), 1.3),
    )


def sign_off(signed: SignedMooring) -> SignOff:
    """Create the table of revisions, with the latest first, and the boxes for signatures."""
    given = signed.assessment.file.document

    def field(name: str) -> str:
        return (getattr(given, name) if given else None) or ""

    own = (field("revision"), field("date"), "", "")  # "Drawn" below names its author
    history = [
        (one.revision or "", one.date or "", one.by or "", one.change or "")
        for one in (given.history if given else ())
    ]
    if own[0] not in [one[0] for one in history] or not history:
        history.append(own)
    roles = (("Drawn", field("author")), ("Checked", field("checked")),
             ("Approved", field("approved")))  # fmt: skip
    note = (
        "Signatures. The last page lists effects that no check covers: waves, snap loads, fatigue."
    )
    return SignOff(tuple(history[: -MOST_REVISIONS - 1 : -1]), roles, note)


def page_one(signed: SignedMooring, page_size: str = "a4") -> Iterator[Block]:
    """Yield the blocks of page one; the figure has the height that remains below the tables."""
    cases, checks, signs = cases_table(signed), governing_table(signed), sign_off(signed)
    rows = len(cases.rows) + len(checks.rows) + len(signs.revisions) + bool(cases.note)
    rows += len(verdict_sentence(signed.assessment)) // _LINE
    height = TEXT_HEIGHT[page_size] - _FIXED - _ROW * rows
    height -= _TITLE_LINE * len(signed.assessment.file.description or "") // _TITLE_LETTERS
    items = OpenItems(
        "Open items",
        tuple(signed.items) or (),
        _empty_list_text(signed),
        "more: see checks in full",
    )
    yield title_block(signed)
    yield verdict_box(signed)
    yield cases
    if signed.moored and signed.moored[0].as_given:
        yield Beside(
            (_mooring_figure(signed, height),), (items,), _FIGURE_WIDTH / _WIDTH, height + 42.0
        )
    else:
        yield items
    yield checks
    yield signs


def _empty_list_text(signed: SignedMooring) -> str:
    return "" if signed.items else "None."


def _mooring_figure(signed: SignedMooring, height: float) -> Figure:
    first, *others = signed.moored
    drawn = [DrawnCase(one.code, one.results) for one in (first, *others)]
    svg, scale = elevation(
        signed.assessment.name, drawn, _labels(signed, first), (_FIGURE_WIDTH - 6.0, height)
    )
    texts = [f"Solid: case {first.code}"]
    texts += ["dotted: strumming"] * any(one.code.endswith("s") for one in others)
    texts += ["dashed: still water"] * any(one.code == "0" for one in others)
    texts += ["thin: other cases"] * any(one.code[-1] not in "s0" for one in others)
    water = first.results[0].water
    towards = f" Current towards {bearing_text(bearing_of(water.u[0], water.v[0]))} at the surface."
    aside = f"left: to scale, 1 : {_scale_text(scale * 72.0 / 0.0254)}; right: not to scale"
    note = f"{', '.join(texts)}.{towards} Depths in m."
    return Figure("The mooring", svg, aside=aside, note=note)


def _scale_text(value: float) -> str:
    return f"{float(f'{value:.3g}'):,.0f}".replace(",", "\u00a0")


def _labels(signed: SignedMooring, case: LoadCase) -> list[Label]:
    """Select the labels next to the line in the drawing.

    Floats, instruments, releases and anchors have labels and, if there is room, the cables as well.
    """
    tags: dict[str | None, str] = {}
    for (_, label), tag in item_tags(signed).items():
        if not tag.startswith(MARKS[State.NOT_JUDGED]):
            tags.setdefault(label, tag)
    found: list[tuple[bool, Label]] = []
    for result in case.results:
        items = deck_items_of(result, signed.apart)
        own = {one.label: one for one in items}
        for part in drawn_parts(result, items, lambda *_: ()):
            if part.junction:
                continue
            first = own[part.labels[0]]
            cable = part.sign.symbol in LINES
            tag = next((tags[label] for label in part.labels if label in tags), "")
            label = part.rows[0].label
            if cable:
                length = "" if first.cut_length is None else f", {first.cut_length:.0f} m"
                found.append((True, Label(part, f"{label}{length}", "", None, tag)))
            else:
                at = case.rows[first.label].upper
                found.append((False, Label(part, label, f"{at[0]:z.0f}", at, tag)))
    if len(found) > MOST_LABELS:
        found = [one for one in found if not one[0]]
    kept = [label for _, label in found]
    if len(kept) > MOST_LABELS:  # keep ends and open items, and thin out the others evenly
        others = [one for one in kept[1:-1] if not one.tag]
        step = max(MOST_LABELS - len(kept) + len(others), 0) / max(len(others), 1)
        chosen = {id(one) for at, one in enumerate(others) if int((at + 1) * step) > int(at * step)}
        ends = (kept[0], kept[-1])
        kept = [one for one in kept if one.tag or one in ends or id(one) in chosen]
    return kept


def afloat(result: LegResult) -> bool:
    """Return whether the top of a leg is free and at the surface."""
    return result.type == "surface" and result.leg.top.free


def drawn_parts(
    result: LegResult, items: Sequence[DeckItem], cells: Cells
) -> tuple[ShownPart, ...]:
    """Return the parts of a leg as drawn; consecutive equal items share one short name."""
    found = []
    for part in parts_of(result.file, items, items, cells, surface=afloat(result)):
        (row,) = part.rows
        first, _, last = row.label.partition(" – ")
        if last and not part.junction and differ_by_number(first, last):
            part = replace(part, rows=(replace(row, label=together([first, last])),))
        found.append(part)
    return tuple(found)


def item_tags(signed: SignedMooring) -> dict[tuple[str, str | None], str]:
    """Return the mark and number of the first open item, by rule and component."""
    tags: dict[tuple[str, str | None], str] = {}
    for item, group in zip(signed.items, open_groups(signed.assessment), strict=True):
        for one in group:
            tags.setdefault((one.rule, one.component), f"{MARKS[item.state]}{item.number}")
    return tags
