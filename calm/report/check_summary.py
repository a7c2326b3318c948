"""Design check on a terminal: verdict, load cases, utilisations, open items, and exclusions.

A mooring without failures takes at most `MOST_LINES` lines. Several moorings appear as a matrix.
"""

from collections.abc import Iterator, Sequence
from dataclasses import replace
from math import ceil
from textwrap import wrap

from calm.checks.assess import RULES
from calm.checks.assessment import Assessment
from calm.checks.finding import (
    DEFAULT_ENVIRONMENT,
    OWN,
    Conclusion,
    Finding,
    State,
    governing_of_each_rule,
)
from calm.checks.situations import FOULED, STILL, STILL_LOW, STRUMMING
from calm.quantities import QUANTITIES, say
from calm.report import blocks
from calm.report.blocks import Cell, Line, OpenItem, Prose, ReportPart, Span, number, words
from calm.report.check_matrix import MatrixCell, environments_of, summary_row
from calm.report.likelihood import likelihood_tables
from calm.report.load_cases import LoadCase, load_cases
from calm.report.open_items import (
    STATES,
    counts_text,
    limit_text,
    open_groups,
    open_items,
    percent_text,
    short,
    without_asides,
)
from calm.report.page_one import case_columns, governing_rows, shown_cases
from calm.report.provenance import WAVES_IN_TIDE

MOST_LINES = 40
"""Maximum number of terminal lines for a mooring without failures."""
_WIDTH = 80
_FRAME = 7  # number of lines for the head, the exclusions, and the frame of the open items
_MOST_ITEMS = 12  # largest number of open items for a mooring that fails
_MOST_ROWS = 10  # largest number of checks with a row
_HALF = 0.5  # utilisation from which a check has a row


def check_part(assessments: Sequence[Assessment]) -> ReportPart:
    """Build the summary of a design check; states have symbols, so that colour is not needed."""
    if len(assessments) > 1:
        return ReportPart("", tuple(_matrix_blocks(assessments)))
    return ReportPart("", tuple(_mooring_blocks(assessments[0])))


def _mooring_blocks(assessment: Assessment) -> Iterator[blocks.Block]:
    verdict = Prose((_name_and_kind(assessment), _verdict_line(assessment)))
    cases, checks = [*_cases(assessment)], [*_checks(assessment)]
    likely = [*likelihood_tables([(assessment.name, [*assessment.all_findings()])])]
    items = [_shortened_item(one) for one in open_items(assessment, keys=True)]
    beyond = beyond_text([assessment])
    room = MOST_LINES - _FRAME - sum(map(_estimated_lines, (*cases, *checks, *likely)))
    fails = assessment.verdict is Conclusion.FAILS
    yield verdict
    yield from (*cases, *checks, *likely)
    if items:
        yield _shown_items(items, _MOST_ITEMS if fails else None, room)
    yield blocks.Note(beyond)


def _name_and_kind(assessment: Assessment) -> Line:
    file = assessment.file
    given = file.document
    document = "" if given is None or not given.id else given.id
    if given is not None and given.id and given.revision:
        document += f" rev. {given.revision}"
    results = [
        checked.result for checked in assessment.in_environments if checked.result is not None
    ]
    kind = "surface" if any(one.type == "surface" for one in results) else "sub-surface"
    if file.legs or len({checked.leg.name for checked in assessment.in_environments}) > 1:
        kind = "net of legs"
    depth = file.environment.depth
    water = "" if depth is None else f"{say('depth_rating', depth)} of water"
    return _at_both_ends(assessment.name, ", ".join(filter(None, (document, kind, water))))


def _verdict_line(assessment: Assessment) -> Line:
    verdict = assessment.verdict.words.upper() + ", DRAFT" * assessment.draft
    counts = counts_text(open_groups(assessment)) or "no open items"
    return (Span(_at_both_ends(verdict, counts), STATES[assessment.verdict]),)


def _at_both_ends(left: str, right: str) -> str:
    gap = _WIDTH - len(left) - len(right)
    return f"{left}{' ' * gap}{right}" if gap > 1 else f"{left}\n{right}"


def _cases(assessment: Assessment) -> Iterator[blocks.Block]:
    every = load_cases(assessment)
    cases, note = shown_cases(every)
    fallen = [one for one in cases if one.failure is not None]
    moored = [one for one in cases if one.results]
    if moored:
        yield blocks.table_of(
            "",
            moored,
            words("", lambda one: Cell(one.code, strong=True), 0.0),
            words("load case", lambda one: _case_text(one, moored)),
            *case_columns(moored),
            note=note,
            dense=True,
        )
    if fallen:
        texts = (f"! {one.code} {one.words}: no equilibrium ({one.failure})" for one in fallen)
        yield Prose(tuple((Span(text, State.FAIL),) for text in texts))


def _case_text(case: LoadCase, cases: Sequence[LoadCase]) -> str:
    """Describe a load case briefly.

    If `cases` contains the unchanged environment, the description of a changed case begins with
    "same" in place of the name.
    """
    if case.situation in (STILL, STILL_LOW):
        return case.situation
    own = brief = case.environment
    if own == OWN:
        own, brief = DEFAULT_ENVIRONMENT, "default"
    if case.as_given:
        return short(own, 24)
    changed = {STRUMMING: "strumming", FOULED: "growth"}.get(case.situation, case.situation)
    named = any(one.as_given and one.environment == case.environment for one in cases)
    return short(f"same, {changed}" if named else f"{brief}, {changed}", 32)


def _checks(assessment: Assessment) -> Iterator[blocks.Block]:
    rows, rest = _listed_and_other([*assessment.every_finding()])
    if rows:
        yield blocks.table_of(
            "",
            rows,
            words("", lambda one: Cell(_sign(one.state), state=one.state), 0.0),
            words("check", _title, 0.0),
            number("use %", lambda one: percent_text(one.utilisation)),
            words(f"{'100':>12}", _bar, 0.0),
            number("found", _value_without_unit),
            words("limit", limit_text, 0.0),
            words("case, where", _where),
            note=_checks_note(rows, rest),
            dense=True,
        )


def _checks_note(rows: Sequence[Finding], rest: Sequence[Finding]) -> str:
    most = max((one.utilisation or 0.0 for one in rest), default=None)
    others = [f"all other checks: {percent_text(most)} % or less"] if rest else []
    shown = {one.case[-1] for one in rows if one.case}
    codes = ", ".join(f"{code} {means}" for code, means in _CODES.items() if code in shown)
    return "  " + "; ".join(filter(None, (*others, codes)))


_CODES = {"L": "launch", "R": "rise", "B": "break", "w": "in waves"}


def _title(finding: Finding) -> str:
    return RULES[finding.rule].title.lower().replace(" during ", ", ")


def _listed_and_other(every: Sequence[Finding]) -> tuple[list[Finding], list[Finding]]:
    failed = governing_of_each_rule(one for one in every if one.state is State.FAIL)
    used = [one for one in governing_rows(every) if one not in failed]
    most = [one for one in used if (one.utilisation or 0.0) >= _HALF or _is_open(one)]
    most = most[: max(_MOST_ROWS, sum(map(_is_beyond, most)))] or used[:3]
    rest = [one for one in used if one not in most]
    return [*sorted(failed, key=lambda one: one.rank), *most], rest


def _is_open(finding: Finding) -> bool:
    return finding.state not in (State.PASS, State.NOT_JUDGED, State.ESTIMATED)


def _is_beyond(finding: Finding) -> bool:
    return (finding.utilisation or 0.0) > 1.0


def _sign(state: State) -> str:
    return "" if state is State.PASS else state.sign


def _bar(finding: Finding) -> Cell | None:
    used = finding.utilisation
    return None if used is None else Cell(bar=min(used, 9.99), state=finding.state)


def _value_without_unit(finding: Finding) -> str:
    quantity = QUANTITIES.get(RULES[finding.rule].quantity)
    if finding.value is None or quantity is None:
        return ""
    return quantity.number_and_unit(finding.value, finding.limit)[0]  # the limit has the unit


def _where(finding: Finding) -> str:
    return f"{finding.case or '':2} {finding.component or 'whole line'}"


def _shortened_item(item: OpenItem) -> OpenItem:
    text = without_asides(item.text.replace("\u00a0", " "))
    return replace(item, head=item.head.replace("\u00a0", " "), text=text)


def _shown_items(items: Sequence[OpenItem], most: int | None, room: int) -> blocks.OpenItems:
    """Select the first `most` open items or, if None, as many as fit into `room` lines."""
    kept: list[OpenItem] = []
    for item in items:
        room -= len(wrap(f"{item.head} {item.text}", _WIDTH - 3))
        if len(kept) == most or (most is None and room < 0 and kept):
            break
        kept.append(item)
    left = items[len(kept) :]
    more = f"{len(left)} more open item{'s' * (len(left) != 1)}"
    notes = [f"{more}: see the report (--report) or the JSON (--json)"] if left else []
    unknown = [one.head.removesuffix(".") for one in left if one.state is State.UNKNOWN]
    notes += wrap(f"Also unknown: {'; '.join(unknown)}.", _WIDTH - 3) if unknown else []
    return blocks.OpenItems("Open items", tuple(kept), "\n".join(f"   {one}" for one in notes))


def _estimated_lines(block: blocks.Block) -> int:
    if isinstance(block, blocks.Table):
        heads = max(len(column.heading.split("\n")) + bool(column.unit) for column in block.columns)
        columns = zip(*block.rows, strict=True)
        *fixed, last = (
            [len(cell.text) if cell.bar is None else 14 for cell in cells] for cells in columns
        )
        left = _WIDTH - sum(max(cells) + 1 for cells in fixed)
        return 1 + heads + sum(ceil(width / left) for width in last) + bool(block.note)
    if isinstance(block, blocks.Note | Prose):
        return 1 + len(block.lines)
    return 1


def beyond_text(assessments: Sequence[Assessment]) -> tuple[str, ...]:
    """Return a sentence on the effects that no check covers."""
    waves = any(one.rule == "wave-slack" for each in assessments for one in each.all_findings())
    waters = (one.leg.file.environment for each in assessments for one in each.in_environments)
    tide = any(one.depth_range is not None for one in waters)
    beyond = ["snap loads", "fatigue", "wear", "soil", "trawls", "hauling"]
    if tide or not waves:
        beyond.insert(0, WAVES_IN_TIDE if waves else "waves")
    return (f"Not covered: {', '.join(beyond)}.",)


def _matrix_blocks(assessments: Sequence[Assessment]) -> Iterator[blocks.Block]:
    rows = [summary_row(each) for each in assessments]
    names, kept, codes = environments_of(rows)
    failing = [each for each in assessments if each.verdict is Conclusion.FAILS]
    lacking = sum(each.verdict is Conclusion.INCOMPLETE for each in assessments)
    fail = "FAILS" if len(failing) == 1 else "FAIL"
    outcome = f"{len(failing)} {fail} in at least one" if failing else "NOTHING FAILS"
    outcome += f", {lacking} INCOMPLETE" * bool(lacking)
    state = State.FAIL if failing else State.UNKNOWN if lacking else State.PASS
    places = f"{len(names)} ENVIRONMENT{'S' * (len(names) != 1)}"
    head = f"DESIGN CHECK OF {len(rows)} MOORINGS IN {places}: {outcome}"
    yield Prose(((Span(head, state),),))
    milder = f"; milder environments omitted: {len(names) - len(kept)}" * (len(kept) < len(names))
    room = max(20, _WIDTH - 6 * len(kept) - 8)
    yield blocks.table_of(
        "",
        rows,
        words("highest utilisation, %", lambda row: short(row.mooring, room)),
        *(_environment_column(name, codes[name]) for name in kept),
        number("launch", lambda row: _matrix_text(row.handling)),
        note="! fails  ~ over 100, a warning or accepted  ? unknown\n"
        + ", ".join(
            f"{codes[name]} {DEFAULT_ENVIRONMENT if name == OWN else name}"
            for name in kept
            if codes[name] != name
        )
        + milder,
        dense=True,
    )
    yield from likelihood_tables([(each.name, [*each.all_findings()]) for each in assessments])
    left = _MOST_ITEMS
    for each in failing or [one for one in assessments if one.verdict is Conclusion.INCOMPLETE]:
        grave = (
            one for one in open_items(each, keys=True) if one.state in (State.FAIL, State.UNKNOWN)
        )
        items = [_shortened_item(one) for one in grave]
        if left and items:
            yield blocks.OpenItems(each.name, tuple(items[:left]))
            left -= min(left, len(items))
    yield blocks.Note(beyond_text(assessments))


def _environment_column(name: str, code: str) -> blocks.Field:
    return number(code, lambda row: _matrix_text(row.cells.get(name)))


def _matrix_text(cell: MatrixCell | None) -> str:
    if cell is None:
        return "-"
    text = "" if cell.use is None else percent_text(cell.use)
    if cell.state in (State.FAIL, State.UNKNOWN):
        return f"{text}{cell.state.sign}"
    return f"{text}~" if (cell.use or 0.0) > 1.0 else f"{text} "
