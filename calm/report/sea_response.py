"""Report on the response of a mooring to waves."""

from collections.abc import Callable, Sequence
from math import isnan

from calm.checks.finding import State
from calm.drawing.graph import COLOURS, Graph, LegendEntry, Scale, Stroke, Tick, covering
from calm.quantities import QUANTITIES, say
from calm.records.sea_states import doubted
from calm.report import blocks
from calm.report.blocks import Prose, ReportPart, Table, number, table_of, words
from calm.report.provenance import report_of
from calm.waves.analysis import SLACK, WaveAnalysis
from calm.waves.fatigue import PieceFatigue
from calm.waves.measured import COMPARED, MeasuredBand
from calm.waves.pieces_in_sea import MooringInSea, PieceInWaves, PieceLoads

_NOTE = (
    "Tension is given at the upper end: mean, standard deviation, most probable maximum and "
    "minimum. Tz is the mean time between two crossings of the mean tension in the upward "
    "direction. Heave and tilt are standard deviations. ! marks a piece that goes slack."
)
_SEAS = (
    "Measured: range of the standard deviation, estimated from tensions measured at sea. Half, "
    "twice: standard deviation if the cut-off frequency is halved or doubled."
)
_CUT_OFFS = (
    "The table gives the tension at the top for other cut-off frequencies of the waves; the drag "
    "is unchanged. Most changed: the piece whose standard deviation of tension changes most."
)
_LIFE = (
    "Life: years until the damage sum reaches 1 in these seas. Low, high: life if the standard "
    "deviations of tension are 15 % larger or smaller. Half, twice: life if the cut-off frequency "
    "is halved or doubled. The fatigue curves are quoted from secondary sources: compare them with "
    "the standard."
)


def sea_response_report(analysis: WaveAnalysis) -> blocks.Report:
    """Build the report with tables and drawings of the tension.

    The drawings show the tension as a spectrum, along the line, and against Hs.
    """
    title = "Tension in the highest sea: spectrum at the top, and distribution along the line"
    if several := len(analysis.states) > 1:
        title += ". Tension at the top against Hs"
    pictures = ReportPart("Tension", (blocks.Figure(title, _tension_drawing(analysis, several)),))
    return report_of(analysis.name, "in waves", sea_response_part(analysis), pictures)


def sea_response_part(analysis: WaveAnalysis) -> ReportPart:
    """Build the tables of the response to waves.

    The tables list the pieces in the highest sea state. If there are several sea states, another
    table has a row for each sea state.
    """
    states, highest = analysis.states, _highest_sea(analysis)
    title = f"Hs {highest.sea.significant_height:.1f} m, Tp {highest.sea.peak_period:.1f} s"
    statements, several = Prose(tuple(_statements(analysis, highest))), len(states) > 1
    shown: list[blocks.Block] = [
        _pieces_table(highest, f"In the highest sea, {title}" if several else ""),
        statements,
        _cut_off_table(highest),
    ]
    if several:
        shown.insert(0, _seas_table(states))
        title = f"{len(states)} seas"
        shown.append(_fatigue_table([each for each in analysis.fatigue if each.life]))
        unknown = [each.label for each in analysis.fatigue if each.unknown]
        if unknown:
            shown.append(Prose((f"Life unknown: {', '.join(unknown)}.",)))
    doubts = [doubt for each in states if (doubt := doubted(each.sea)) is not None]
    shown += blocks.warned((*analysis.warnings, *doubts[:1]))
    if analysis.status == SLACK:
        slack = ", ".join(dict.fromkeys(label for each in states for label in each.slack))
        warning = f"Slack: {slack}. Linear tensions are not valid there."
        shown += blocks.warned([warning], State.FAIL)
    return ReportPart(f"{analysis.name}: {title}", tuple(shown))


def _highest_sea(analysis: WaveAnalysis) -> MooringInSea:
    return max(analysis.states, key=lambda state: state.sea.severity())


def _fatigue_table(known: Sequence[PieceFatigue]) -> Table:
    def years(heading: str, name: str) -> blocks.Field:
        def years(one: PieceFatigue) -> str:
            count = getattr(one, name)
            if count is None or count > 1000.0:
                return "-" if count is None else "> 1000"
            return f"{float(f'{count:.2g}'):g}"

        return number(f"{heading}\nyears", years)

    return table_of(
        "Fatigue over all seas",
        known,
        words("", "label"),
        years("life", "life"),
        years("low", "life_low"),
        years("high", "life_high"),
        years("half", "life_half_cut_off"),
        years("twice", "life_twice_cut_off"),
        words("curve"),
        note=_LIFE,
    )


def _pieces_table(state: MooringInSea, title: str) -> Table:
    tension = QUANTITIES["tension"]

    def pull(heading: str, name: str) -> blocks.Field:
        heading = f"{heading}\n{tension.display_unit}"
        return number(heading, lambda one: tension.format(getattr(one, name)))

    def period(one: PieceInWaves) -> str:
        return "-" if isnan(one.zero_crossing_period) else f"{one.zero_crossing_period:.1f}"

    return table_of(
        title,
        state.components,
        words("", lambda one: f"{'!' if one.label in state.slack else ''}{one.label}"),
        pull("mean", "tension_mean"),
        pull("std", "tension_std"),
        pull("max", "tension_max"),
        pull("min", "tension_min"),
        number("Tz\ns", period),
        number("slack\n%", lambda one: _percent(one.slack_probability)),
        number("heave\nm", lambda one: f"{one.heave_std:.2f}"),
        number("tilt\n°", lambda one: f"{one.tilt_std:.1f}"),
        note=_NOTE,
    )


def _percent(share: float) -> str:
    return f"{round(100.0 * share, 2):.3g}"


def _cut_off_table(state: MooringInSea) -> Table:
    top, tension = state.components[0], QUANTITIES["tension"]
    cases = (("half", 0.5), ("", 1.0), ("twice", 2.0))

    def most_changed(name: str) -> str:
        if not name:
            return ""
        loaded = [one for one in state.components if one.tension_std > 0.0]
        changes = {one.label: _loads(one, name).tension_std / one.tension_std for one in loaded}
        if not changes:
            return "-"
        label = max(changes, key=lambda each: abs(changes[each] - 1.0))
        change = 100.0 * (changes[label] - 1.0)
        if abs(change) < 0.05:
            return "none"
        return f"{label} {change:+.1f} %".replace(" -", " \N{MINUS SIGN}")

    def pull(heading: str, name: str) -> blocks.Field:
        heading = f"{heading}\n{tension.display_unit}"
        return number(heading, lambda case: tension.format(getattr(_loads(top, case[0]), name)))

    return table_of(
        "Cut-off frequency",
        cases,
        words("", lambda case: case[0] or "as above"),
        number("rad/s", lambda case: f"{case[1] * state.cut_off:.1f}"),
        pull("std", "tension_std"),
        pull("max", "tension_max"),
        pull("min", "tension_min"),
        number("slack\n%", lambda case: _percent(_loads(top, case[0]).slack_probability)),
        words("most changed", lambda case: most_changed(case[0])),
        note=_CUT_OFFS,
    )


def _loads(piece: PieceInWaves, cut_off: str) -> PieceInWaves | PieceLoads:
    return getattr(piece, f"{cut_off}_cut_off") if cut_off else piece


def _seas_table(states: Sequence[MooringInSea]) -> Table:
    def deviation(
        heading: str, loads: Callable[[PieceInWaves], PieceInWaves | PieceLoads]
    ) -> blocks.Field:
        return number(heading, lambda state: f"{loads(state.components[0]).tension_std:.0f}")

    def measured(state: MooringInSea) -> str:
        top = state.components[0]
        if top.measured_low is None or top.measured_high is None:
            return ""
        return f"{top.measured_low.tension_std:.0f} to {top.measured_high.tension_std:.0f}"

    return table_of(
        "",
        states,
        number("Hs\nm", lambda state: f"{state.sea.significant_height:.1f}"),
        number("Tp\ns", lambda state: f"{state.sea.peak_period:.1f}"),
        number("share\n%", lambda state: _percent(state.sea.share)),
        deviation("std at the top\nN", lambda top: top),
        number("measured\nN", measured),
        deviation("half\nN", lambda top: top.half_cut_off),
        deviation("twice\nN", lambda top: top.twice_cut_off),
        number("max at the top\nN", lambda state: f"{state.components[0].tension_max:.0f}"),
        words("slack", lambda state: ", ".join(state.slack) or "-"),
        note=_SEAS,
    )


def _statements(analysis: WaveAnalysis, state: MooringInSea) -> list[blocks.Line]:
    statements: list[blocks.Line] = []
    top = state.components[0].tension_std
    if state.follower_std is not None and abs(state.follower_std - top) > 1e-3 * top:
        statements.append(
            "If the float followed every wave, the standard deviation of the tension below it "
            f"would be {say('tension', state.follower_std)}."
        )
    if state.pitch_std is not None:
        statements.append(f"The float pitches by {state.pitch_std:.1f}° (standard deviation).")
    elif analysis.pitch_unknown is not None:
        statements.append(f"The pitch of the float is not computed: {analysis.pitch_unknown}.")
    if state.band is not None:
        statements.append(_measured_sentences(state, state.band))
    one = analysis.accuracy
    good = (
        f"Standard deviations change by {one.mesh:.1%} if the number of elements is doubled, by "
        f"{one.frequencies:.1%} if the number of frequencies is doubled, and by "
        f"{one.linearisation:.0%} if the drag is reduced by a fifth."
    ).replace("%", " %")
    return [*statements, (blocks.Span(good, quiet=True),)]


def _measured_sentences(state: MooringInSea, band: MeasuredBand) -> str:
    low, high = state.components[0].measured_low, state.components[0].measured_high
    assert low is not None and high is not None
    height = state.sea.significant_height
    outside = (
        ""
        if COMPARED[0] <= height <= COMPARED[1]
        else (" The height of this sea is outside that range of Hs.")
    )
    return (
        f"Measured at sea: in seas of Hs {band.from_height:g} to {band.to_height:g} m, the "
        "measured standard deviation of the tension below five buoys of the Southern Ocean Flux "
        f"Station was {band.low:.2f} to {band.high:.2f} times the computed standard deviation. For "
        "this mooring, these factors give a standard deviation of "
        f"{say('tension', low.tension_std)} to {say('tension', high.tension_std)} at the top, with "
        f"a maximum of {say('tension', low.tension_max)} to "
        f"{say('tension', high.tension_max)}.{outside} "
        "The wave model has been compared with measurements at that station only."
    )


_WIDTH, _TALL, _SIZE = 510.0, 180.0, 8.0  # size and font size [pt]
_TOP, _GAP = 22.0, 52.0
_MEAN, _STD, _MAX = (Stroke(COLOURS[0], 1.2, dashes) for dashes in ((), (1.2, 1.8), (4.0, 2.0)))


def _tension_drawing(analysis: WaveAnalysis, several: bool) -> str:
    state = _highest_sea(analysis)
    page = Graph(_WIDTH, _TOP + _TALL + 30.0, "Tension in waves", _SIZE)
    panels = 3 if several else 2
    wide = (_WIDTH - 8.0 - panels * _GAP) / panels
    places = [(_GAP - 4.0 + at * (wide + _GAP), _TOP, wide, _TALL) for at in range(panels)]

    omega, density = state.spectrum
    range_of = Scale(float(omega[0]), float(omega[-1]), logarithmic=True)
    axes = page.axes(*places[0], range_of, covering([0.0], 1e-6 * density))
    axes.line(omega, 1e-6 * density, _MEAN)
    ticks = [at for at in (0.2, 0.5, 1.0, 2.0, 5.0, 10.0) if omega[0] < at < omega[-1]]
    axes.frame(
        [Tick(at, f"{at:g}") for at in ticks], 6,
        below="frequency [rad/s]", beside="spectrum of tension [kN² s/rad]", grid=True,
    )  # fmt: skip

    depth, *tensions = state.along
    down = covering(depth)
    axes = page.axes(*places[1], covering([0.0], *tensions), Scale(down.high, down.low))
    strokes = (_MEAN, _STD, _MAX)
    for values, stroke in zip(tensions, strokes, strict=True):
        axes.line(values, depth, stroke)
    axes.frame(4, 6, below="tension [N]", beside="depth [m]", grid=True)
    entries = [
        LegendEntry(name, line=stroke)
        for name, stroke in zip(("mean", "std", "max"), strokes, strict=True)
    ]
    page.legend(entries, (places[1][0], 4.0), 52.0, 12.0, columns=3)
    if several:
        heights = [each.sea.significant_height for each in analysis.states]
        tops = [each.components[0] for each in analysis.states]
        columns = [[one.tension_std for one in tops], [one.tension_max for one in tops]]
        axes = page.axes(*places[2], covering(heights), Scale(0.0, covering([0.0], *columns).high))
        signs = ("+", 5.0, COLOURS[0]), ("o", 3.0, COLOURS[0])
        for column, sign in zip(columns, signs, strict=True):
            for height, value in zip(heights, column, strict=True):
                axes.mark(height, value, *sign)
        axes.frame(5, 6, below="Hs [m]", beside="tension at the top [N]", grid=True)
        entries = [LegendEntry("std", sign=signs[0]), LegendEntry("max", sign=signs[1])]
        page.legend(entries, (places[2][0], 4.0), wide / 2, 12.0, columns=2)
    return page.svg()
