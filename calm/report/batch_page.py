"""Statistics of a batch as an HTML page with drawings, as terminal output, and as files."""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace
from functools import partial
from math import floor, log10
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from calm.batch.finished import open_result
from calm.batch.statistics import summary as statistics
from calm.batch.statistics.extremes import EXTRAPOLATION, METHODS, Fit, Level
from calm.batch.statistics.limits import Exceedance
from calm.batch.statistics.summary import PERCENTILES, Distribution, Response, Summary
from calm.case import Design
from calm.checks.finding import State
from calm.drawing import graph
from calm.drawing.graph import COLOURS, Graph, LegendEntry, Scale, Stroke, covering, seconds
from calm.quantities import QUANTITIES, Quantity
from calm.report import batch_summary, blocks, check_tables
from calm.report.batch_summary import QUANTITY, TITLES, percent, when
from calm.report.blocks import Cell, Figure, Prose, ReportPart, Table, number, table_of, words
from calm.report.folder import write_file
from calm.report.html import page
from calm.report.provenance import NOT_JUDGED, made_by, report_of
from calm.report.read_card import card_blocks
from calm.report.result_files import to_json


def summary_html(summary: Summary) -> str:
    """Render a summary as an HTML page that needs no other file and no network."""
    return page(summary_report(summary))


def summary_report(summary: Summary) -> blocks.Report:
    """Build the report of a summary.

    The report contains the frequency of exceeded limits, distributions, the most severe profiles,
    return levels and drawings.
    """
    lost = State.WARN if summary.count - summary.solved else None
    left_out = blocks.warned(filter(None, [batch_summary.left_out(summary)]))
    not_judged = (f"Not judged: {name}, because {why}." for name, why in summary.not_judged.items())
    moving = [part for part in summary.parts if part.clamped] or list(summary.parts[:-1])
    through_time = series_figure(summary)
    responses = Figure("Responses of the line", exceedance_figure(summary))
    instruments = parts_figure(moving)
    parts: dict[str, tuple[blocks.Block, ...]] = {
        "Result": (
            Prose((f"{batch_summary.status_counts(summary)}.",), lost),
            batch_summary.rules_table(summary),
            *left_out,
            Prose(batch_summary.DEFINITIONS),
        ),
        "Through time": (Figure("Minimum and maximum in each interval", through_time),),
        "How often": (
            responses, Figure("Clamped instruments, or components", instruments), *left_out,
        ),
        **{table.title: (table,) for table in batch_summary.stops_tables(summary)},
        "Return levels": (*levels_tables(summary), Prose((_EXTRAPOLATED,))),
        "Worst profiles": tuple(worst_tables(summary)),
        "Limits": (
            limits_table(summary),
            Prose(tuple(not_judged)),
            check_tables.limits_table(summary.limits_used),
        ),
        "Distributions": (*left_out, *statistics_tables(summary)),
        NOT_JUDGED.title: NOT_JUDGED.blocks,
        "Inputs": (
            *card_blocks(summary.read),
            *(
                blocks.Listing(name.replace("_", " ").capitalize(), text)
                for name, text in summary.source.items()
            ),
            Prose((f"Gathered with {made_by()}",)),
        ),
    }  # fmt: skip
    extent = batch_summary.extent(summary)
    return report_of(summary.name, extent, *(ReportPart(*part) for part in parts.items()))


_EXTRAPOLATED = (
    f"Return periods are limited to {EXTRAPOLATION:.0f} times the length of the record. Return "
    "levels describe the response to currents like those recorded. They do not include events that "
    "a short or gappy record misses, or changes of the current regime. A fitted tail has no "
    "bounds: a tilt above 90° or a knockdown below the seabed means that the record cannot be "
    "extrapolated that far."
)


def limits_table(summary: Summary) -> Table:
    """Tabulate how often each limit is exceeded, and the most severe value for each limit."""

    def state(one: Exceedance) -> Cell:
        broken = one.limit.criterion.beyond if one.share else State.PASS
        state = State.UNKNOWN if one.share is None else broken
        return Cell(state.value, state=state)

    def figure(one: Exceedance, value: float | None, bound: str = "") -> str:
        return "-" if value is None else bound + QUANTITIES[one.limit.rule.quantity].say(value)

    def limit(one: Exceedance) -> str:
        criterion = one.limit.criterion
        return figure(one, criterion.limit, "≥ " if criterion.least else "≤ ")

    return table_of(
        "Limits",
        [(one, rule) for rule in summary.rules for one in rule.exceedances],
        *blocks.of_first(words("state", state, 0.0)),
        words("rule", lambda row: row[1].title),
        *blocks.of_first(
            words("component", "limit.criterion.part.label"),
            number("limit", limit),
            number("exceeded in", lambda one: percent(one.share), "% of profiles"),
            number("worst value", lambda one: figure(one, one.worst)),
            words("when", lambda one: when(one.time), 0.0),
        ),
        note="Strength is judged at the ends of a piece and at its clamps; minimum tension is "
        "judged at the ends. For anchor sliding, the value is H + friction × V, where H is the "
        "horizontal and V the vertical anchor load. The limit is friction × weight in water / "
        "factor.",
        sortable=True,
    )


def statistics_tables(summary: Summary) -> Iterator[Table]:
    """Yield a table for each quantity, with mean, percentiles and maximum by component."""
    for name in _QUANTITIES:

        def figures(part: Any, name: str = name) -> list[str]:
            one: Distribution | None = getattr(part, name)
            if one is None:
                return ["-"] * (len(PERCENTILES) + 3)
            values = one.mean, *one.percentiles, one.maximum
            return [*map(QUANTITIES[name].format, values), when(one.time)]

        heads = "mean", *(f"{percentile:g} %" for percentile in PERCENTILES), "maximum"
        yield table_of(
            QUANTITIES[name].label.capitalize(),
            [(Cell(part.label, indented=part.clamped), *figures(part)) for part in summary.parts],
            words("component", 0),
            *(number(head, at) for at, head in enumerate(heads, 1)),
            words("maximum reached", -1, 0.0),
        )


def worst_tables(summary: Summary) -> Iterator[Table | Prose]:
    """Yield a table of the worst profiles for each response.

    Each table shows all responses of these profiles.
    """
    for name, profiles in summary.worst.items():
        if not profiles:
            yield Prose((f"The {TITLES[name]} is unknown in all profiles.",), State.UNKNOWN)
            continue
        worst = "worst " * (len(profiles) == statistics.WORST)
        title = f"The {len(profiles)} {worst}profiles by {TITLES[name]}"
        yield batch_summary.profiles_table(title, [("", profile) for profile in profiles])


def levels_tables(summary: Summary) -> Iterator[Table | Prose]:
    """Yield tables of return levels with confidence intervals, and reasons for missing levels."""
    for response in summary.responses:
        quantity = QUANTITIES[QUANTITY[response.name]]
        fits = [fit for fit in response.return_levels if isinstance(fit, Fit)]
        rows = [
            (METHODS[fit.method], each.period, quantity.format(each.level),
             " – ".join(_interval_ends(each, quantity, "not set")))
            for fit in fits for each in fit.levels
        ]  # fmt: skip
        if fits:
            yield table_of(
                TITLES[response.name].capitalize(),
                rows,
                words("method", 0),
                number("return period", 1, "years"),
                number("level", 2, quantity.display_unit),
                number("95 % interval", 3, quantity.display_unit),
                note=" ".join(map(_fit_text, fits)),
            )
    for reason in batch_summary.refusals(summary):
        yield Prose((f"{reason[0].upper()}{reason[1:]}.",), State.UNKNOWN)


def _interval_ends(level: Level, quantity: Quantity, unknown: str) -> Iterator[str]:
    for end in (level.low, level.high):
        yield unknown if end is None else quantity.format(end)


def _fit_text(fit: Fit) -> str:
    fitted = f"location {fit.location:.4g}, scale {fit.scale:.4g}, shape {fit.shape:.3f}"
    return f"{METHODS[fit.method]}: {fitted}; {fit.rules}."


def write_summary(result: Path, mooring: Design) -> Summary:
    """Write the summary of a finished batch as JSON and HTML files next to the batch file.

    `result` is the path of the batch file. Raise UsageError if a file cannot be read or written, or
    if the disk has no room for the uncompressed result.
    """
    with open_result(result) as stored:
        summary = statistics.summarize(stored, mooring, result.parent, result)
    document, page = summary_paths(result)
    write_file(document, to_json([batch_summary.summary_document(summary)]).encode())
    write_file(page, summary_html(summary).encode())
    return summary


def summary_paths(result: Path) -> tuple[Path, Path]:
    """Return the paths of the JSON file and the HTML page with the summary of a result."""
    return result.with_suffix(".summary.json"), result.with_suffix(".summary.html")


_QUANTITIES = ("knockdown", "tilt", "tension")
_PERIODS = (10, 50, 100)
_ALL = (
    "The JSON file and the HTML page list all percentiles, limits and profiles. Depths and offsets "
    "agree with `calm run` to 1e-4 of the water depth, and tensions to 2e-4 of the tension. "
    "Individual profiles are not audited."
)


def summary_part(summary: Summary) -> ReportPart:
    """Build the summary of a batch for a terminal of 80 columns.

    The first table gives the 99th percentile and the maximum of each quantity, by component and
    clamp.
    """
    lost = State.FAIL if summary.count - summary.solved else None
    ended = blocks.Span(batch_summary.status_counts(summary), lost)
    worst = [(name, one) for name, each in summary.worst.items() for one in each[:1]]
    shown: tuple[blocks.Block, ...] = (
        blocks.Heading(summary.name),
        Prose((batch_summary.extent(summary), (ended,))),
        _parts_table(summary),
        replace(batch_summary.rules_table(summary), title="", note=""),
        *blocks.warned(filter(None, [batch_summary.left_out(summary)])),
        *batch_summary.stops_tables(summary),
        batch_summary.profiles_table("", worst),
        *_level_tables(summary),
        *blocks.warned(batch_summary.refusals(summary)),
        blocks.quiet(_ALL),
    )
    return ReportPart("", shown)


def _parts_table(summary: Summary) -> Table:
    def extreme(part: Any, name: str, of: Callable[[Distribution], float]) -> str:
        one = getattr(part, name)
        return "-" if one is None else QUANTITIES[name].format(of(one))

    fields = [words("", lambda part: Cell(part.label, indented=part.clamped))]
    for name in _QUANTITIES:
        high = partial(extreme, name=name, of=lambda one: one.percentiles[2])
        highest = partial(extreme, name=name, of=lambda one: one.maximum)
        fields.append(number(f"{QUANTITIES[name].heading}\n99 %", high))
        fields.append(number(f"{QUANTITIES[name].display_unit}\nmaximum", highest))
    return table_of("", summary.parts, *fields)


def _level_tables(summary: Summary) -> Iterator[Table]:
    rows = []
    for response in summary.responses:
        quantity = QUANTITIES[QUANTITY[response.name]]
        of = f"{TITLES[response.name]} [{quantity.display_unit}]"
        for fit in response.return_levels:
            if isinstance(fit, Fit):
                levels = {each.period: each for each in fit.levels}
                values = (_level_text(levels.get(period), quantity) for period in _PERIODS)
                method = batch_summary.METHODS_IN_SHORT[fit.method]
                rows.append((f"{of}, {method}", *values))
    if rows:
        years = (number(f"{period} years", at) for at, period in enumerate(_PERIODS, 1))
        yield table_of("", rows, words("return level, and 95 % interval", 0), *years)


def _level_text(level: Level | None, quantity: Quantity) -> str:
    if level is None:
        return "-"
    return f"{quantity.format(level.level)}\n{'–'.join(_interval_ends(level, quantity, '?'))}"


_WIDTH = 533.0  # text width of an A4 page [pt]
_SIZE = 7.0  # font size [pt]
_LEFT, _RIGHT, _BELOW, _GAP = 60.0, 6.0, 30.0, 14.0  # room around and between axes [pt]
_LIMIT = Stroke("#b3261e", 1.0, (4.0, 2.0))


def series_figure(summary: Summary) -> str:
    """Draw the minimum and maximum of each response in successive time intervals, as SVG."""
    tall, responses = 108.0, summary.known_responses
    page = Graph(_WIDTH, len(responses) * (tall + _GAP) + 20.0, "responses through time", _SIZE)
    begin = responses[0].begin
    across = covering(seconds(begin))
    ticks = graph.moments(begin[0], begin[-1], 7)
    for row, response in enumerate(responses):
        quantity, limit = QUANTITIES[QUANTITY[response.name]], _limit_of(summary, response)
        low, high = (quantity.scale * edge for edge in (response.low, response.high))
        up = covering(low, high, [limit or np.nan])
        top = 6.0 + row * (tall + _GAP)
        axes = page.axes(_LEFT, top, _WIDTH - _LEFT - _RIGHT, tall, across, up)
        if np.array_equal(low, high, equal_nan=True):
            axes.line(seconds(begin), high, Stroke(COLOURS[0], 0.8))
        else:
            axes.band(seconds(begin), low, high, COLOURS[0])
        if limit is not None:
            axes.level(limit, _LIMIT)
        axes.frame(
            ticks, 5,
            beside=f"{TITLES[response.name]}\n[{quantity.display_unit}]",
            grid=True, numbered=(row == len(responses) - 1, True),
        )  # fmt: skip
    return page.svg()


class _Panel(NamedTuple):
    """Exceedance curves of one quantity, each with its stroke and label, and the design limit."""

    title: str
    name: str
    curves: Sequence[tuple[Distribution, Stroke, str]]
    limit: float | None = None


def exceedance_figure(summary: Summary) -> str:
    """Draw, as SVG, the fraction of profiles in which each response exceeds a given value."""
    panels = []
    for response in summary.known_responses:
        one, limit = response.distribution, _limit_of(summary, response)
        curves = [] if one is None else [(one, Stroke(COLOURS[0], 1.5), "")]
        panels.append(_Panel(TITLES[response.name], QUANTITY[response.name], curves, limit))
    return _exceedance_panels("how often each value is exceeded", panels, 150.0)


def parts_figure(parts: Sequence[statistics.PartDistributions]) -> str:
    """Draw exceedance curves of the components with the largest knockdown and tilt, as SVG."""
    panels = []
    for name in ("knockdown", "tilt"):
        known = [(part.label, getattr(part, name)) for part in parts]
        curves = [(label, one) for label, one in known if one is not None]
        curves.sort(key=lambda curve: -curve[1].maximum)
        drawn = [
            (one, Stroke(colour), label)
            for (label, one), colour in zip(curves, COLOURS, strict=False)
        ]
        panels.append(_Panel(name, name, drawn))
    return _exceedance_panels("how often each value is exceeded, by part", panels, 200.0)


def _exceedance_panels(title: str, panels: Sequence[_Panel], tall: float) -> str:
    rows, wide = -(-len(panels) // 2), (_WIDTH - _LEFT - _RIGHT - _GAP) / 2
    page = Graph(_WIDTH, rows * (tall + _BELOW) + 6.0, title, _SIZE)
    least = min([0.1, *(one.share[-1] for panel in panels for one, _, _ in panel.curves)])
    up = Scale(100.0 * 10.0 ** floor(log10(least) + 1e-9), 100.0, logarithmic=True)
    for at, panel in enumerate(panels):
        row, column = divmod(at, 2)
        quantity = QUANTITIES[panel.name]
        values = [one.value * quantity.scale for one, _, _ in panel.curves]
        across = covering(*values, [np.nan if panel.limit is None else panel.limit])
        left, top = _LEFT + column * (wide + _GAP), 6.0 + row * (tall + _BELOW)
        axes = page.axes(left, top, wide, tall, across, up)
        for value, (one, stroke, _) in zip(values, panel.curves, strict=True):
            axes.line(value, 100.0 * one.share, stroke)
        if panel.limit is not None:
            axes.plumb(panel.limit, _LIMIT)
        axes.frame(
            6, graph.decades(up.low, up.high),
            below=f"{panel.title} [{quantity.display_unit}]",
            beside="" if column else "reached or exceeded in [% of profiles]",
            grid=True, numbered=(True, not column),
        )  # fmt: skip
        named = [LegendEntry(label, line=stroke) for _, stroke, label in panel.curves if label]
        page.legend(named, (left + 0.6 * wide, top + 4.0), 0.4 * wide, 10.0)
    return page.svg()


def _limit_of(summary: Summary, response: Response) -> float | None:
    """Return the design limit for a response, in display units; None if there is none."""
    wanted = {"knockdown": "knockdown", "offset": "excursion"}.get(response.name)
    for rule in summary.rules:
        if rule.name == wanted:
            limit = rule.exceedances[0].limit.criterion.limit
            return (limit or 0.0) * QUANTITIES[QUANTITY[response.name]].scale
    return None
