"""Rules on waves: maximum tension, slack line, and fatigue life."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Literal

from calm.case.leg import Leg
from calm.checks.criterion import cited
from calm.checks.finding import State, Verdict, at_least, at_most, rule, unknown, verdict_on
from calm.checks.posture import reaches_the_surface
from calm.checks.strength import (
    governing_load,
    load_text,
    no_load_known,
    passes_load_on,
    wanted_load,
)
from calm.errors import UsageError
from calm.quantities import say
from calm.waves.analysis import WaveAnalysis, analyse
from calm.waves.fatigue import YEAR
from calm.waves.pieces_in_sea import PieceInWaves

_SET_WAVES = "Set `waves:` in the environment: a design sea state, and a scatter table for fatigue."


@dataclass(frozen=True)
class MooringInWaves:
    """Mooring and its analysis in the waves of its environment.

    `waves` is the analysis, or the reason why the analysis failed; None without waves.
    """

    leg: Leg
    waves: WaveAnalysis | str | None

    @classmethod
    def of(cls, leg: Leg) -> MooringInWaves:
        """Analyse a mooring in the waves of its environment."""
        around = leg.file.environment
        if around.waves is None:
            return cls(leg, None)
        try:
            return cls(leg, analyse(leg, around.seas, around.waves.toward))
        except UsageError as error:
            return cls(leg, str(error))


@rule("wave-strength")
def wave_strength(evidence: MooringInWaves) -> Iterator[Verdict]:
    """Check the maximum tension of each piece in waves against its load ratings.

    The breaking load is divided by the factor of API RP 2SK for a dynamic analysis. The verdict is
    unknown for a surface mooring in an environment without waves.
    """
    leg, waves = evidence.leg, evidence.waves
    if not isinstance(waves, WaveAnalysis):
        if waves is not None:
            message = f"The mooring has no solution in waves: {waves}."
            yield unknown(None, message, "Set the values that are missing in `waves:`.")
        elif reaches_the_surface(leg):
            message = "The environment has no `waves:`, so loads in waves are not checked."
            yield unknown(None, message, _SET_WAVES)
        return
    checks = leg.file.checks
    factor, source = checks.waves_safety_factor, cited(leg.file, "waves_safety_factor")
    for piece in leg.file.pieces[:-1]:
        state = max(waves.states, key=lambda each: each.components[piece.index].greatest)
        row = state.components[piece.index]
        tension = row.greatest
        limit, figure = governing_load(piece.component, 1.0, factor)
        load = load_text(piece, tension, f" in waves of Hs {state.sea.significant_height:.1f} m")
        if limit is None:
            if passes_load_on(leg.file, piece.index):
                message, remedy = no_load_known(load)
                message += _measured(row, "greatest")
                lacks = wanted_load(piece.component)
                yield unknown(piece, message, remedy, tension, lacks=lacks)
            continue
        message = f"{load}; the limit is {say('load', limit)}.{_measured(row, 'greatest')}"
        remedy = "Use a stronger component, or a more elastic line."
        verdict = at_most(piece, tension, limit, message, remedy, source=source, figure=figure)
        yield _unless_stiffness_unknown(waves, verdict)


@rule("wave-slack")
def wave_slack(evidence: MooringInWaves) -> Iterator[Verdict]:
    """Check that the tension of each piece in waves stays positive.

    A slack line takes snap loads.
    """
    leg, waves = evidence.leg, evidence.waves
    if not isinstance(waves, WaveAnalysis):
        return
    for piece in leg.file.pieces[:-1]:
        state = min(waves.states, key=lambda each: each.components[piece.index].least)
        row = state.components[piece.index]
        if row.tension_std > 0.0 and piece.component.slack != "allowed":
            message = (
                f"Minimum tension in {piece.label} in waves of Hs "
                f"{state.sea.significant_height:.1f} m is {say('load', row.least)}; below zero "
                f"the line goes slack and snap loads follow.{_measured(row, 'least')}"
            )
            remedy = (
                "Add weight, use a more elastic line, or simulate the mooring in the time domain "
                "(`calm export`)."
            )
            yield _unless_stiffness_unknown(waves, at_least(piece, row.least, 0.0, message, remedy))


@rule("fatigue")
def fatigue(evidence: MooringInWaves) -> Iterator[Verdict]:
    """Check the fatigue life in waves of every piece that has a published fatigue curve.

    The life must be at least the service time × the required factor.
    """
    leg, waves = evidence.leg, evidence.waves
    if not isinstance(waves, WaveAnalysis):
        return
    given, checks = leg.file.environment.waves, leg.file.checks
    if given is None or given.scatter is None:
        message = "A fatigue life needs a wave climate, not a single sea state."
        remedy = "Set `scatter` under `waves`: sea states with their shares of time."
        yield verdict_on(None, State.NOT_JUDGED, message, remedy)
        return
    limit = checks.fatigue_factor * checks.service_time
    source = cited(leg.file, "fatigue_factor", "service_time")
    for one in waves.fatigue:
        piece = leg.file.pieces[one.index]
        if one.unknown is not None:
            message = f"The fatigue life of {one.label} is unknown: {one.unknown}."
            yield unknown(
                piece, message, "Set the component's loads, and the `curve` under its `fatigue`."
            )
        elif one.life is not None and one.life_low is not None and one.life_high is not None:
            message = (
                f"The fatigue life of {one.label} is {_years(one.life)} ({_years(one.life_low)} to "
                f"{_years(one.life_high)}) according to {one.curve}; {_years(limit / YEAR)} is "
                "required."
            )
            remedy = (
                "Use a thicker component or a more elastic line, or renew the component sooner."
            )
            life = one.life * YEAR
            yield _unless_stiffness_unknown(
                waves, at_least(piece, life, limit, message, remedy, source=source)
            )


def _measured(row: PieceInWaves, which: Literal["greatest", "least"]) -> str:
    if row.measured_low is None or row.measured_high is None:
        return ""
    tensions = sorted(getattr(each, which) for each in (row.measured_low, row.measured_high))
    low, high = (say("load", each) for each in tensions)
    return f" Measurements at sea (SOFS) imply a tension of {low} to {high}."


def _unless_stiffness_unknown(waves: WaveAnalysis, verdict: Verdict) -> Verdict:
    # computed tensions may be too high if the stiffness of a rope is unspecified
    if verdict.state is not State.FAIL or not waves.warnings:
        return verdict
    message = f"{verdict.message} {' '.join(waves.warnings)}"
    remedy = "Set the rope's `stiffness`."
    return verdict.but(state=State.UNKNOWN, message=message, remedy=remedy, limit=None, sense=None)


def _years(count: float) -> str:
    return "more than 1000 years" if count > 1000.0 else f"{float(f'{count:.2g}'):g} years"


IN_WAVES = (wave_strength, wave_slack, fatigue)
"""Rules evaluated for a `MooringInWaves`, once per environment."""
