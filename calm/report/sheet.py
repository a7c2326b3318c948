"""Text report of a result: a summary, and a table of the line that marks values near limits.

For a net, there are tables of legs, nodes and end loads.
"""

import math
from collections.abc import Iterator, Sequence
from dataclasses import replace
from typing import Any

from calm.case.columns import Output, ResultColumn, columns_of, shown_in
from calm.case.design import AnyResult, Result
from calm.case.leg_result import LegResult
from calm.case.profilers import ProfilerTravel
from calm.case.result_tables import ClampRow, ComponentRow, item_numbers, rows_down, table_columns
from calm.case.strumming import StrummingBand
from calm.case.warnings import counted_working_load
from calm.checks.finding import State, percent_used
from calm.checks.posture import reaches_the_surface
from calm.checks.strength import safety_factor
from calm.files import Component
from calm.files.legs import EndKeys
from calm.files.strumming_keys import BourgetMarichalKeys
from calm.quantities import duration, say
from calm.report import blocks
from calm.report.blocks import (
    Cell,
    Column,
    Field,
    Note,
    Pairs,
    Prose,
    ReportPart,
    Table,
    words,
)
from calm.solve import Status

_NOTE = "are given at the upper end of each part; tension is the highest along the part."
_MARKS = {State.WARN: "~ close to a limit.", State.FAIL: "! limit exceeded."}
_TYPES = {"subsurface": "sub-surface mooring", "surface": "surface mooring"}


def result_part(
    result: Result, facts: Sequence[tuple[str, str]] = (), *, verbose: bool = False
) -> ReportPart:
    """Build the short report of a result, for a terminal of 80 columns.

    Values beyond a limit are marked ``!``, values close to a limit ``~``. `facts` are titles and
    texts after the summary. `verbose` adds accuracy and convergence.
    """
    if result.several:
        return net_part(result, verbose=verbose)
    table = table_of_line(result)
    quality = quality_of(result.leg).lines if verbose else ()
    summary = Pairs((*summary_pairs(result.leg), *facts))
    warnings = blocks.warned(result.warnings)
    shown: tuple[blocks.Block, ...] = (summary, *warnings, Note((table.note, *map(str, quality))))
    return ReportPart(title_of(result.leg), (replace(table, note=""), *shown))


def title_of(result: LegResult) -> str:
    """Format the name of the mooring or tow, its kind, and its water depth or speed."""
    if (tow := result.file.tow) is not None:
        return f"{result.name}: tow at {say('speed', tow.speed)} towards {tow.toward:.0f}°"
    depth = say("depth", result.file.environment.depth)
    return f"{result.name}: {_TYPES[result.type]}, {depth} of water"


def summary_of(result: LegResult) -> tuple[Pairs | Prose, ...]:
    """Return the blocks that summarise the line and its ends, followed by the warnings."""
    return (Pairs(summary_pairs(result)), *blocks.warned(result.warnings))


def summary_pairs(result: LegResult) -> tuple[tuple[str, str], ...]:
    """Return named texts that describe the line and its ends."""
    return tuple(_tow_summary(result) if result.towed else _mooring_summary(result))


def quality_of(result: LegResult) -> Prose:
    """Describe the numerical error of the solution, and the convergence of the solver."""
    good, end = result.accuracy, "anchor" if result.leg.anchored else "lower end"
    if result.towed:
        end = "tow point"
    load = "" if good.anchor is None else f", {good.anchor:.2g} N in the load at the {end}"
    return Prose(
        (
            f"Numerical error: {good.depth:.2g} m in depth, {good.tension:.2g} N in tension{load}.",
            f"{result.status.capitalize()} after {result.iterations} integrations over "
            f"{result.segments} segments; error in position at the {end} {abs(result.miss):.1g} m, "
            f"relative imbalance of forces {result.closure:.1g}.",
        )
    )


def accuracy_text(results: Sequence[LegResult]) -> str:
    """Describe the numerical error of several results.

    The text adds that the uncertainty of the inputs is larger.
    """
    depth = max(one.accuracy.depth for one in results)
    share = max(
        100.0 * one.accuracy.tension / max(float(one.components.tension.max()), 1.0)
        for one in results
    )
    return (
        f"The numerical error of the solution is below {math.ceil(10.0 * depth) / 10.0:.1f} m in "
        f"depth and {max(math.ceil(10.0 * share) / 10.0, 0.1):.1f} % of the tension. Inputs are "
        "less certain: the current is known to about 10 %, the drag of a cable to about 20 %."
    )


def _profiler_text(profiler: ProfilerTravel) -> str:
    upper, lower, worst = (
        f"{say('depth', place.depth)} ({say('tension', place.tension)}, {say('tilt', place.tilt)})"
        for place in (profiler.upper, profiler.lower, profiler.worst)
    )
    text = f"{profiler.label} travels from {upper} to {lower}; largest wire angle at {worst}"
    if profiler.time is not None:
        text += f"; a profile takes {duration(profiler.time)}"
    if profiler.profiles is not None:
        text += f", and the batteries last for {profiler.profiles} profiles"
    return text


def _mooring_summary(result: LegResult) -> Iterator[tuple[str, str]]:
    top = result.top
    off = f"{say('offset', math.hypot(top.x, top.y))} off the anchor" * result.leg.anchored
    if result.type == "surface":
        text = [", ".join(filter(None, ("at the surface", off)))]
        text.append(f"{100 * top.used_buoyancy:.1f} % of its buoyancy in use, reserve buoyancy "
                    f"{say('reserve', top.reserve)}")  # fmt: skip
    else:
        deep, down = say("depth", top.depth), say("knockdown", top.knockdown)
        text = [", ".join(filter(None, (f"{deep} deep", f"knockdown {down}", off)))]
    if top.draft is not None:
        text.append(f"draft {say('draft', top.draft)}, freeboard {say('freeboard', top.freeboard)}")
    yield "Top", "\n".join((*text, *_strumming_texts(result)))
    if result.profilers:
        yield "Profilers", "\n".join(map(_profiler_text, result.profilers))
    yield "Line", _line_text(result)
    if result.leg.anchored:
        yield "Anchor", _anchor_text(result)


def _line_text(result: LegResult) -> str:
    rows = result.components
    text = f"{say('depth', sum(row.length for row in rows))} under load"
    if result.leg.anchored:
        text += f", scope {sum(row.cut_length for row in rows) / result.leg.water.depth:.3f}"
    if result.anchor_load.grounded_length > 0.0:
        text += f", {say('grounded_length', result.anchor_load.grounded_length)} on the seabed"
    most = max(rows, key=lambda row: row.tension)
    text += f"; largest tension {say('tension', most.tension)} in {most.label}"
    known = [row for row in rows if not math.isnan(row.safety_factor)]
    if known:
        least = min(known, key=lambda row: row.safety_factor)
        text += f"; least safety factor {least.safety_factor:.1f} in {least.label}"
    return text


def _anchor_text(result: LegResult) -> str:
    anchor, share = result.anchor_load, ""
    if anchor.weight > 0.0:
        share = f" ({percent_used(anchor.required_weight / anchor.weight):.0f} %)"
    beyond = f" {State.FAIL.sign}" * (anchor.weight < anchor.required_weight)
    return (
        f"{say('required_weight', anchor.weight)} in water, "
        f"{say('required_weight', anchor.required_weight)} required{share}{beyond}\n"
        f"load {say('vertical', anchor.vertical)} vertical, "
        f"{say('horizontal', anchor.horizontal)} horizontal, {say('angle', anchor.angle)} from "
        "the vertical"
    )


def _tow_summary(result: LegResult) -> Iterator[tuple[str, str]]:
    point, body = result.tow_point, result.body
    assert point is not None and body is not None
    at_ship, at_body = (
        f"{say('tension', end.tension)}, {say('angle', end.angle)} from the horizontal"
        for end in (point, body)
    )
    vertical = f"{say('vertical', abs(point.vertical))} {'down' if point.vertical >= 0.0 else 'up'}"
    yield (
        "Tow point",
        f"load {at_ship} ({vertical}, {say('horizontal', point.horizontal)} astern)",
    )
    text = f"{_level_text(result, body.depth)}, layback {say('layback', body.layback)}"
    yield "Body", "\n".join((f"{text}; tension {at_body}", *_strumming_texts(result)))


def _strumming_texts(result: LegResult) -> tuple[str, ...]:
    strumming, band = result.strumming, result.strumming_band
    if strumming is not None:
        together = isinstance(result.file.solver.strumming, BourgetMarichalKeys)
        frequency = f"{'' if together else 'up to '}{say('frequency', strumming.frequency)}"
        least, greatest = say("cn", strumming.cn_min), say("cn", strumming.cn_max)
        return (f"strumming at {frequency}, Cn from {least} to {greatest}",)
    if band is not None:
        drag = f"normal drag of the cables × {band.factor:g}"
        return (f"with strumming ({drag}): {_band_text(result, band)}",)
    return ()


def _band_text(result: LegResult, band: StrummingBand) -> str:
    if band.status != Status.CONVERGED.label:
        return band.status
    assert band.depth is not None
    if result.towed:
        return f"body {_level_text(result, band.depth)}, tow point {say('tension', band.tension)}"
    if (
        result.type == "surface" and band.depth <= 0.0
    ):  # a float at its draft is partly out of the water
        top = "top at the surface"
    elif band.knockdown is None:
        top = f"top {say('depth', band.depth)} deep"
    else:
        top = f"knockdown {say('knockdown', band.knockdown)}"
    return top


def _level_text(result: LegResult, depth: float) -> str:
    tow = result.file.tow
    if tow is not None and result.file.environment.fluid == "air":
        return f"{say('depth', depth + tow.height)} below the tow point"
    return f"{say('depth', depth)} deep" if depth >= 0.0 else f"{say('depth', -depth)} in the air"


def table_of_line(result: AnyResult, title: str = "", *, places: bool = False) -> Table:
    """Tabulate the line in file order; clamps are indented below their piece.

    If `places` is true, clamps show their position on the piece in the column of lengths.
    """
    output, of_an_end, heads = Output.MOORING_TABLE, "Depth, height and offset", {}
    if result.towed:
        output, of_an_end = Output.TOW_TABLE, "Depth and layback"
    elif result.several:
        output, of_an_end = Output.NET_TABLE, "Depth, east and north"
        heads = {leg.leg.keys.first: leg_title(leg) for leg in result.legs}
    plans = (*result.components.planned_depth, *result.clamps.planned_depth)
    planned = not all(map(math.isnan, plans))
    figures = [one for one in table_columns(output) if planned or one.name != "planned_depth"]
    columns = [Column("no.", numeric=True, narrow=False), Column("piece", short="")]
    rows: list[tuple[Cell, ...]] = []
    numbers = item_numbers(result)
    for piece, clamps in rows_down(result):
        if piece.index in heads:
            rows.append((Cell(heads[piece.index], strong=True),))
        label, factor = (
            Cell(piece.label, strong=piece.role == "instrument"),
            safety_state(result, piece),
        )
        rows.append((Cell(numbers[piece.label]), label, *_cells(result, figures, piece, factor)))
        for clamp in clamps:
            cells = [*_cells(result, figures, clamp)]
            if places:
                from calm.drawing.schematic.shown_parts import place_text

                at = [one.name for one in figures].index("length")
                cells[at] = Cell(place_text(clamp.part.at))
            strong = clamp.part.component.role == "instrument"
            label = Cell(clamp.label, indented=True, strong=strong)
            rows.append((Cell(numbers[clamp.label]), label, *cells))
    columns += (blocks.quantity_column(one.quantity) for one in figures if one.quantity)
    marked = {cell.state for row in rows for cell in row if cell.mark}
    legend = " ".join(text for state, text in _MARKS.items() if state in marked)
    note = "\n".join(filter(None, (f"{of_an_end} {_NOTE}", legend)))
    table = Table(title, tuple(columns), tuple(rows), note, dense=True)
    return table.without_empty_columns()


def tilt_state(component: Component, tilt: float) -> State | None:
    """Return FAIL for a tilt above `max_tilt`, WARN above `warn_tilt` [degrees], else None."""
    if component.max_tilt is not None and tilt > component.max_tilt:
        return State.FAIL
    if component.warn_tilt is not None and tilt > component.warn_tilt:
        return State.WARN
    return None


def safety_state(result: AnyResult, record: ComponentRow) -> State | None:
    """Return FAIL if the safety factor is too small or the working load is exceeded, else None.

    The required factor depends on `checks.safety_factor`, material and type of mooring. For a
    synthetic rope, the working load counts only if the breaking load is unknown. An unknown safety
    factor (NaN) is not a failure.
    """
    # the intended purpose of a single leg is irrelevant if the whole net is shown
    alone = not (result.several or result.towed)
    meant = alone and reaches_the_surface(result.legs[0].leg)
    surface = meant or result.type == "surface"
    component = record.part.component
    least = safety_factor(component, result.file.checks.safety_factor, surface)
    loaded = record.utilisation > 1.0 and counted_working_load(component) is not None
    return State.FAIL if loaded or record.safety_factor < least else None


def _cells(
    result: AnyResult,
    figures: Sequence[ResultColumn],
    row: ComponentRow | ClampRow,
    factor: State | None = None,
) -> Iterator[Cell]:
    states = {"tilt": tilt_state(row.part.component, row.tilt), "safety_factor": factor}
    for one in figures:
        if one.quantity:
            value = one.value(row, result.file)
            yield blocks.figure_cell(one.quantity, value, states.get(one.name))


def net_part(result: Result, *, verbose: bool = True) -> ReportPart:
    """Build the short report of a net: pieces by leg, nodes, anchors and held ends.

    Parameters
    ----------
    verbose : whether to include the accuracy and convergence of the solution
    """
    depth = say("depth", result.file.environment.depth)
    count = len(result.legs)
    title = f"{result.name}: net of {count} leg{'s' * (count != 1)}, {depth} of water"
    table = table_of_line(result)
    note = Note((table.note, *((_convergence_text(result),) if verbose else ())))
    shown = (replace(table, note=""), *_end_tables(result), *blocks.warned(result.warnings), note)
    return ReportPart(title, shown)


def leg_title(leg: LegResult) -> str:
    """Format the name of a leg, and the connections of its ends."""
    top = "at the surface" if leg.type == "surface" else end_text(leg.leg.top)
    return f"{leg.name}: {top} to {end_text(leg.leg.bottom)}"


def leg_titles(result: Result) -> dict[str, str]:
    """Return the titles of legs by name, or an empty mapping for a single line."""
    return {leg.name: f"leg {leg_title(leg)}" for leg in result.legs if result.several}


def end_descriptions(line: LegResult) -> tuple[str | None, str | None]:
    """Describe the connections of the upper and the lower end of a leg.

    The result for a free upper end, or for a lower end with an anchor, is None.
    """
    top, bottom = line.leg.top, line.leg.bottom
    return (
        None if top.free else f"from {end_text(top)}",
        None if bottom.anchor is not None else end_text(bottom),
    )


def end_text(end: EndKeys) -> str:
    """Describe the connection of one end of a leg."""
    if end.join is not None:
        return f"node {end.join}"
    if end.held is not None:
        return "held end"
    return "free end" if end.anchor is None else "anchor"


def _end_tables(result: Result) -> Iterator[Table | Prose]:
    ends = {"Nodes": result.nodes, "Anchors": result.anchors, "Held ends": result.held}
    for title, rows in ends.items():
        if rows:
            head = words("", "name") if title == "Nodes" else words("leg")
            yield blocks.table_of(title, rows, head, *_known_columns(rows))
    afloat = [
        f"{leg.name}: float at the surface, {100 * leg.top.used_buoyancy:.1f} % of its buoyancy in "
        f"use, reserve buoyancy {say('reserve', leg.top.reserve)}"
        for leg in result.legs
        if leg.type == "surface"
    ]
    if afloat:
        yield Prose(tuple(afloat))


def _known_columns(rows: Sequence[Any]) -> Iterator[Field]:
    columns = shown_in(columns_of(type(rows[0])), Output.NET_TABLE)
    for one in sorted(columns, key=lambda one: one.place):
        known = any(getattr(row, one.name) is not None for row in rows)
        if known and one.quantity:
            yield blocks.quantity(one.quantity, one.name)


def _convergence_text(result: Result) -> str:
    accuracy = result.accuracy
    left = max((node.imbalance for node in result.nodes), default=0.0)
    return (
        f"{result.status.capitalize()} after {result.iterations} integrations of the legs over "
        f"{result.segments} segments. Numerical error: {accuracy.depth:.2g} m in depth, "
        f"{accuracy.tension:.2g} N in tension. Remaining error: {result.miss:.1g} m in the "
        f"position of the ends, {left:.1g} N in the balance of the nodes, {result.closure:.1g} in "
        "the relative balance of forces."
    )
