"""The statistics of a batch as a page with tables, in short, and the files beside its result."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import replace
from pathlib import Path

from calm.batch.finished import stored_result
from calm.batch.statistics.extremes import EXTRAPOLATION, METHODS, Fit, Level
from calm.batch.statistics.limits import Exceedance
from calm.batch.statistics.summary import PERCENTILES, WORST, Distribution, Summary, summarize
from calm.case import Mooring
from calm.case.net import Net
from calm.checks.finding import State
from calm.quantities import QUANTITIES
from calm.report.batch_figures import exceedance_figure, parts_figure, series_figure
from calm.report.batch_summary import (
    DEFINITIONS,
    METHODS_IN_SHORT,
    QUANTITY,
    TITLES,
    extent,
    left_out,
    percent,
    profiles_table,
    refusals,
    rules_table,
    standing,
    stops_tables,
    summary_document,
    when,
)
from calm.report.blocks import (
    Block,
    Cell,
    Column,
    Figure,
    Heading,
    Listing,
    Prose,
    Report,
    ReportPart,
    Section,
    Span,
    Table,
    table_of,
)
from calm.report.check_summary import limits_table as limits_used_table
from calm.report.html import page
from calm.report.provenance import NOT_JUDGED, date, versions
from calm.report.result_files import to_json
from calm.report.sheet import figure_cell, quantity_column
from calm.whole_file import put


def summary_html(summary: Summary) -> str:
    """The page of a summary, which needs no other file and no network."""
    return page(summary_report(summary))


def summary_report(summary: Summary) -> Report:
    """Return how often limits are broken, distributions, worst profiles, return levels, drawn."""
    not_judged = (f"Not judged: {name}, {why}." for name, why in summary.not_judged.items())
    moving = [part for part in summary.parts if part.clamped] or list(summary.parts[:-1])
    parts = (
        ReportPart("Result", tuple(_result(summary))),
        ReportPart(
            "Through time", (Figure("Least and greatest in each interval", series_figure(summary)),)
        ),
        ReportPart(
            "How often",
            (
                Figure("Responses of the line", exceedance_figure(summary)),
                Figure("Clamped instruments, or components", parts_figure(moving)),
                *_left_out(summary),
            ),
        ),
        *(ReportPart(table.title, (table,)) for table in stops_tables(summary)),
        ReportPart("Return levels", (*levels_tables(summary), Prose((_EXTRAPOLATED,)))),
        ReportPart("Worst profiles", tuple(worst_tables(summary))),
        ReportPart(
            "Limits",
            (
                limits_table(summary),
                Prose(tuple(not_judged)),
                limits_used_table(summary.limits_used),
            ),
        ),
        ReportPart("Distributions", (*_left_out(summary), *statistics_tables(summary))),
        NOT_JUDGED,
        ReportPart("Inputs", tuple(_inputs(summary))),
    )
    section = Section(summary.name, parts)
    return Report(summary.name, extent(summary), (), (section,), date())


def _result(summary: Summary) -> Iterator[Block]:
    lost = summary.count - summary.solved
    yield Prose((f"{standing(summary)}.",), State.WARN if lost else None)
    yield rules_table(summary)
    yield from _left_out(summary)
    yield Prose(DEFINITIONS)


def _left_out(summary: Summary) -> Iterator[Prose]:
    if summary.unsolved:
        yield Prose((left_out(summary),), State.WARN)


def _inputs(summary: Summary) -> Iterator[Block]:
    for name, text in summary.source.items():
        yield Listing(name.replace("_", " ").capitalize(), text)
    made_by = ", ".join(f"{name} {number}" for name, number in versions())
    yield Prose((f"Gathered with {made_by}",))


_EXTRAPOLATED = (
    f"No level is given beyond {EXTRAPOLATION:.0f} times the length of the record. A "
    "level describes how the mooring responds to currents like those recorded: it "
    "covers neither what the record is too short to hold or lost in its gaps, nor a "
    "current field that changes. A fitted tail has no bounds: a tilt beyond 90° or a "
    "knockdown below the seabed means that the record cannot be extrapolated so far."
)


def limits_table(summary: Summary) -> Table:
    """Return how often every limit is broken, and the worst of it."""

    def state(one: Exceedance) -> Cell:
        broken = one.limit.beyond if one.share else State.PASS
        state = State.UNKNOWN if one.share is None else broken
        return Cell(state.value, state=state)

    def figure(one: Exceedance, value: float | None, bound: str = "") -> str:
        return "-" if value is None else bound + QUANTITIES[one.limit.quantity].say(value)

    return table_of(
        "Limits",
        [(rule, one) for rule in summary.rules for one in rule.exceedances],
        (Column("state", share=0.0), lambda pair: state(pair[1])),
        (Column("rule"), lambda pair: pair[0].title),
        (Column("component"), lambda pair: pair[1].limit.component),
        (
            Column("limit", numeric=True),
            lambda pair: figure(
                pair[1], pair[1].limit.limit, "≥ " if pair[1].limit.least else "≤ "
            ),
        ),
        (Column("broken in", "% of profiles", numeric=True), lambda pair: percent(pair[1].share)),
        (Column("worst value", numeric=True), lambda pair: figure(pair[1], pair[1].worst)),
        (Column("when", share=0.0), lambda pair: when(pair[1].time)),
        note="Strength: at the ends of a piece and at the clamps on it. Least tension: at the ends "
        "of a piece. Anchor sliding: H + friction × V against friction × weight in water / factor.",
        sortable=True,
    )


def statistics_tables(summary: Summary) -> Iterator[Table]:
    """Yield for each quantity the mean, the percentiles and the maximum of every part."""
    for name in ("knockdown", "tilt", "tension"):
        figures = ("mean", *(f"{percentile:g} %" for percentile in PERCENTILES), "maximum")
        numbers = (Column(figure, numeric=True) for figure in figures)
        columns = (Column("component"), *numbers, Column("maximum reached", share=0.0))
        rows = tuple(
            (Cell(part.label, indented=part.clamped), *_figures(name, getattr(part, name)))
            for part in summary.parts
        )
        yield Table(QUANTITIES[name].label.capitalize(), columns, rows)


def worst_tables(summary: Summary) -> Iterator[Table | Prose]:
    """The worst profiles by each response, with the others beside it."""
    for name, profiles in summary.worst.items():
        if not profiles:
            yield Prose((f"The {TITLES[name]} is not known in any profile.",), State.UNKNOWN)
            continue
        count = f"{len(profiles)} profiles" if len(profiles) < WORST else f"{WORST} worst profiles"
        title = f"The {count} by {TITLES[name]}"
        yield profiles_table(title, [("", profile) for profile in profiles])


def levels_tables(summary: Summary) -> Iterator[Table | Prose]:
    """Return levels with their intervals, and why others are not given."""
    for response in summary.responses:
        name = QUANTITY[response.name]
        title = TITLES[response.name].capitalize()
        fits = [fit for fit in response.return_levels if isinstance(fit, Fit)]
        if fits:
            columns = (
                Column("method"),
                Column("return period", "years", numeric=True),
                replace(quantity_column(name), heading="level"),
                replace(quantity_column(name), heading="95 % interval"),
            )
            rows = tuple(_level(name, fit, level) for fit in fits for level in fit.levels)
            yield Table(title, columns, rows, " ".join(f"{_rules(fit)}." for fit in fits))
    for reason in refusals(summary):
        yield Prose((f"{reason[0].upper()}{reason[1:]}.",), State.UNKNOWN)


def _figures(name: str, one: Distribution | None) -> Iterator[Cell]:
    if one is None:
        yield from (Cell("-") for _ in range(len(PERCENTILES) + 3))
        return
    yield from (figure_cell(name, value) for value in (one.mean, *one.percentiles, one.maximum))
    yield Cell(when(one.time))


def _level(name: str, fit: Fit, level: Level) -> tuple[Cell, ...]:
    ends = (
        "not set" if end is None else QUANTITIES[name].format(end)
        for end in (level.low, level.high)
    )
    return (
        Cell(METHODS[fit.method]),
        Cell(str(level.period)),
        figure_cell(name, level.level),
        Cell(" – ".join(ends)),
    )


def _rules(fit: Fit) -> str:
    fitted = f"location {fit.location:.4g}, scale {fit.scale:.4g}, shape {fit.shape:.3f}"
    return f"{METHODS[fit.method]}: {fitted}; {fit.rules}"


def write_summary(
    result: Path, mooring: Mooring | Net, check: Callable[[], None] = lambda: None
) -> Summary:
    """Gather what a finished result says, and write it beside it, as JSON and as a page.

    The result is only read: this can be done, and done again, at any time after it is finished.

    Parameters
    ----------
    result : the .nc file or .zarr folder; RESULT.nc has RESULT.summary.json, RESULT.summary.html,
        which would be those of a RESULT.zarr beside it too: the later summary takes their place
    mooring : that it was solved for
    check : called now and then while the result is read; what it raises ends that

    Raises
    ------
    OSError
        A file cannot be written, or there is no room for a temporary one as large as the result
        is without compression.
    UsageError
        The result cannot be read.
    """
    with stored_result(result) as stored:
        summary = summarize(stored, mooring, result.parent, check, result)
    document, page = summary_paths(result)
    put(document, to_json([summary_document(summary)]).encode())
    put(page, summary_html(summary).encode())
    return summary


def summary_paths(result: Path) -> tuple[Path, Path]:
    """Return where the summary of a result stands: its JSON and its page."""
    return result.with_suffix(".summary.json"), result.with_suffix(".summary.html")


_QUANTITIES = ("knockdown", "tilt", "tension")
_PERIODS = (10, 50, 100)
_ALL = (
    "All percentiles, limits and profiles are in the JSON and on the page. Depths "
    "and offsets agree with `calm run` to 1e-4 of the water depth, tensions to 2e-4; "
    "profiles are not audited one by one."
)


def summary_part(summary: Summary) -> ReportPart:
    """Return what a summary says; it fits 80 columns, where long labels wrap.

    Components and clamps with the 99 % percentile and the maximum of each quantity, how often
    each rule fails, the worst profile by each response, and return levels.
    """
    lost, note = summary.count - summary.solved, left_out(summary)
    ended = Span(standing(summary), State.FAIL if lost else None)
    missing = tuple(refusals(summary))
    worst = [(name, one) for name, each in summary.worst.items() for one in each[:1]]
    blocks: tuple[Block, ...] = (
        Heading(summary.name),
        Prose((extent(summary), (ended,))),
        _parts(summary),
        replace(rules_table(summary), title="", note=""),
        *([Prose((note,), State.WARN)] if note else []),
        *stops_tables(summary),
        profiles_table("", worst),
        *_levels(summary),
        *([Prose(missing, State.WARN)] if missing else []),
        Prose(((Span(_ALL, quiet=True),),)),
    )
    return ReportPart("", blocks)


def _parts(summary: Summary) -> Table:
    columns = [Column("")]
    for name in _QUANTITIES:
        quantity = QUANTITIES[name]
        columns.append(Column(f"{quantity.heading}\n99 %", numeric=True))
        columns.append(Column(f"{quantity.display_unit}\nmaximum", numeric=True))
    rows = tuple(
        (
            Cell(part.label, indented=part.clamped),
            *(Cell(text) for name in _QUANTITIES for text in _extremes(name, getattr(part, name))),
        )
        for part in summary.parts
    )
    return Table("", tuple(columns), rows)


def _extremes(name: str, one: Distribution | None) -> tuple[str, str]:
    if one is None:
        return "-", "-"
    quantity = QUANTITIES[name]
    return quantity.format(one.percentiles[2]), quantity.format(one.maximum)


def _levels(summary: Summary) -> Iterator[Table]:
    """Return levels, where there are any."""
    columns = [Column("return level, and 95 % interval")]
    columns += [Column(f"{period} years", numeric=True) for period in _PERIODS]
    rows = []
    for response in summary.responses:
        quantity = QUANTITIES[QUANTITY[response.name]]
        for fit in response.return_levels:
            if isinstance(fit, Fit):
                levels = {level.period: level for level in fit.levels}
                said = (_level_text(response.name, levels.get(period)) for period in _PERIODS)
                of = f"{TITLES[response.name]} [{quantity.display_unit}]"
                rows.append(tuple(map(Cell, (f"{of}, {METHODS_IN_SHORT[fit.method]}", *said))))
    if rows:
        yield Table("", tuple(columns), tuple(rows))


def _level_text(name: str, level: Level | None) -> str:
    if level is None:
        return "-"
    quantity = QUANTITIES[QUANTITY[name]]
    low, high = ("?" if end is None else quantity.format(end) for end in (level.low, level.high))
    return f"{quantity.format(level.level)}\n{low}–{high}"
