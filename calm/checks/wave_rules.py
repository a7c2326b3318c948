"""Wave rules: maximum tension, slack line, and fatigue life."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import Literal

from calm.case.leg import Leg
from calm.checks.criterion import cited
from calm.checks.finding import State, Verdict, at_least, at_most, rule, unknown, verdict_on
from calm.checks.posture import reaches_the_surface
from calm.checks.strength import lesser_load, passes_load_on, wanted_load
from calm.errors import UsageError
from calm.quantities import say
from calm.waves.analysis import WaveAnalysis, analyse
from calm.waves.fatigue import YEAR
from calm.waves.pieces_in_sea import PieceInWaves

_HOW = "Give `waves:` in the environment: a design sea, and a scatter table for fatigue."


@dataclass(frozen=True)
class MooringInWaves:
    """Mooring in the waves of its environment: analysis, reason why it failed, or None without
    waves.
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
    """Compare the maximum tension of each piece in waves with its loads.

    The limits are its working load, and its breaking load over the factor that API RP 2SK requires
    for dynamic analysis. Without waves, a mooring that reaches the surface is unknown.
    """
    leg, waves = evidence.leg, evidence.waves
    if not isinstance(waves, WaveAnalysis):
        if waves is not None:
            yield unknown(None, f"Not judged in waves: {waves}.", "Give what is missing.")
        elif reaches_the_surface(leg):
            yield unknown(None, "Waves are not judged: no `waves:` are given.", _HOW)
        return
    checks = leg.file.checks
    factor, source = checks.waves_safety_factor, cited(leg.file, "waves_safety_factor")
    for piece in leg.file.pieces[:-1]:
        state = max(waves.states, key=lambda each: each.components[piece.index].greatest)
        row = state.components[piece.index]
        tension = row.greatest
        limit = lesser_load(piece.component, 1.0, factor)
        sea = f"Hs {state.sea.significant_height:.1f} m"
        bears = f"{piece.label} bears {say('tension', tension)} in waves of {sea}"
        if limit is None:
            if passes_load_on(leg.file, piece.index):
                message = f"{bears}; neither its working nor its breaking load is known."
                message += _measured(row, "greatest")
                remedy, lacks = "Give its `breaking_load`.", wanted_load(piece.component)
                yield unknown(piece, message, remedy, tension, lacks=lacks)
            continue
        message = f"{bears}; its loads allow {say('tension', limit)}.{_measured(row, 'greatest')}"
        remedy = "Use a stronger component, or add stretch to the line."
        yield _sure(waves, at_most(piece, tension, limit, message, remedy, source=source))


@rule("wave-slack")
def wave_slack(evidence: MooringInWaves) -> Iterator[Verdict]:
    """Compare the minimum tension of each piece in waves with zero, where snap loads begin."""
    leg, waves = evidence.leg, evidence.waves
    if not isinstance(waves, WaveAnalysis):
        return
    for piece in leg.file.pieces[:-1]:
        state = min(waves.states, key=lambda each: each.components[piece.index].least)
        row = state.components[piece.index]
        if row.tension_std > 0.0 and piece.component.slack != "allowed":
            message = (
                f"The least tension of {piece.label} is {say('tension', row.least)} in waves of "
                f"Hs {state.sea.significant_height:.1f} m; below 0 it goes slack and snatches."
                f"{_measured(row, 'least')}"
            )
            remedy = "Add weight or stretch, or solve it in the time domain: `calm export`"
            yield _sure(waves, at_least(piece, row.least, 0.0, message, f"{remedy}."))


@rule("fatigue")
def fatigue(evidence: MooringInWaves) -> Iterator[Verdict]:
    """Judge the life of every piece whose curve is published, by the service time × the factor."""
    leg, waves = evidence.leg, evidence.waves
    if not isinstance(waves, WaveAnalysis):
        return
    given, checks = leg.file.environment.waves, leg.file.checks
    if given is None or given.scatter is None:
        message = "One sea is not a wave climate: no fatigue life follows from it."
        remedy = "Give `waves: {scatter: FILE}`, seas with their shares of the time."
        yield verdict_on(None, State.NOT_JUDGED, message, remedy)
        return
    limit = checks.fatigue_factor * checks.service_time
    source = cited(leg.file, "fatigue_factor", "service_time")
    for one in waves.fatigue:
        piece = leg.file.pieces[one.index]
        if one.unknown is not None:
            message = f"The fatigue life of {one.label} is not known: {one.unknown}."
            yield unknown(piece, message, "Give its `fatigue: {curve: NAME}` and its loads.")
        elif one.life is not None and one.life_low is not None and one.life_high is not None:
            message = (
                f"The fatigue life of {one.label} is {_years(one.life)} ({_years(one.life_low)} "
                f"to {_years(one.life_high)}), by {one.curve}; {_years(limit / YEAR)} is required."
            )
            remedy = "Use a thicker component, add stretch to the line, or renew it sooner."
            life = one.life * YEAR
            yield _sure(waves, at_least(piece, life, limit, message, remedy, source=source))


def _measured(row: PieceInWaves, which: Literal["greatest", "least"]) -> str:
    """Return the tension by the band of those measured at sea, as a sentence."""
    if row.measured_low is None or row.measured_high is None:
        return ""
    tensions = sorted(getattr(each, which) for each in (row.measured_low, row.measured_high))
    low, high = (say("tension", each) for each in tensions)
    return f" The band measured at sea (SOFS) gives {low} to {high}."


def _sure(waves: WaveAnalysis, verdict: Verdict) -> Verdict:
    """Turn a failure into unknown if a rope without stiffness makes the tensions too high."""
    if verdict.state is not State.FAIL or not waves.warnings:
        return verdict
    message = f"{verdict.message} {' '.join(waves.warnings)}"
    return replace(
        verdict, state=State.UNKNOWN, message=message, remedy="Give the rope's `stiffness`.",
        limit=None, sense=None,
    )  # fmt: skip


def _years(count: float) -> str:
    return "more than 1000 years" if count > 1000.0 else f"{float(f'{count:.2g}'):g} years"


IN_WAVES = (wave_strength, wave_slack, fatigue)
"""Rules evaluated for a `MooringInWaves`, once per environment."""
