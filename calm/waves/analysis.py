"""Tensions and motions of a mooring in sea states.

Elements and frequencies are refined automatically, and the remaining error is estimated.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import asdict, dataclass, replace
from typing import TYPE_CHECKING, Any

import numpy as np

from calm.errors import UsageError
from calm.physics.line import Floats
from calm.records.sea_states import SeaState
from calm.waves.buoy import Buoy, buoy_of
from calm.waves.fatigue import PieceFatigue, fatigue_of
from calm.waves.lumped_line import LumpedLine, lumped_line
from calm.waves.pieces_in_sea import CutOffs, MooringInSea, mooring_in_sea
from calm.waves.response import WaveResponse, Waves, respond

if TYPE_CHECKING:
    from calm.case.leg import Leg
    from calm.files import Piece
    from calm.solve import Solution

SHALLOWEST = 0.6
"""Ratio of significant height to water depth at which waves break (Thornton and Guza 1983, who give
0.42 for the root mean square height).
"""

CONVERGED, SLACK = "converged", "slack-in-waves"

SETTLED = 0.01
"""Tolerance of refinement: relative change in the standard deviations of tension and pitch if the
number of elements or frequencies is doubled.
"""

COARSEST, FEWEST, MOST_HALVINGS = 1.0 / 50.0, 32, 4
"""Initial length of the longest elements, as a fraction of the depth, initial number of
frequencies, and maximum number of refinements of elements and frequencies.
"""

SMALL = 0.05
"""Fraction of the largest standard deviation below which changes are ignored."""


@dataclass(frozen=True)
class WaveAccuracy:
    """Estimated relative errors of the standard deviations of tension and of the float's pitch.

    Attributes
    ----------
    mesh, frequencies : change if the number of elements or of frequencies is doubled
    linearisation : change if the linearised drag is reduced by a fifth
    """

    mesh: float
    frequencies: float
    linearisation: float


@dataclass(frozen=True)
class WaveAnalysis:
    """Results for a mooring in one or more sea states.

    Attributes
    ----------
    accuracy : estimated errors in the highest and in the shortest sea
    fatigue : fatigue of each piece, from the shares of time of the sea states
    warnings : warnings about assumptions
    pitch_unknown : reason why the pitch of the float is not computed; None if it is computed
    """

    name: str
    states: tuple[MooringInSea, ...]
    fatigue: tuple[PieceFatigue, ...]
    accuracy: WaveAccuracy
    warnings: tuple[str, ...]
    pitch_unknown: str | None

    @property
    def status(self) -> str:
        """Either "slack-in-waves", if a piece becomes slack in a sea state, or "converged"."""
        return SLACK if any(state.slack for state in self.states) else CONVERGED

    def to_dict(self) -> dict[str, Any]:
        """Return the results as a dictionary for JSON, in SI units and degrees."""
        from calm.version import __version__

        return {
            "calm": __version__,
            "name": self.name,
            "status": self.status,
            "states": [state.to_dict() for state in self.states],
            "fatigue": [asdict(one) for one in self.fatigue],
            "accuracy": asdict(self.accuracy),
            "warnings": list(self.warnings),
            "pitch_unknown": self.pitch_unknown,
        }


@dataclass(frozen=True)
class _Setting:
    line: LumpedLine
    buoy: Buoy | None
    water: Waves
    count: int

    def waves(self, sea: SeaState) -> Waves:
        return replace(self.water, omega=sea.frequencies(self.count))

    def respond(
        self, sea: SeaState, first: Floats | None = None, *, once: bool = False, drag: float = 1.0
    ) -> tuple[WaveResponse, Floats]:
        waves = self.waves(sea)
        return respond(self.line, self.buoy, waves, sea, drag_factor=drag, first=first, once=once)

    def cut_offs(self, sea: SeaState, response: WaveResponse, flow: Floats) -> CutOffs:
        """Return the responses to a sea state for three cut-off frequencies of the waves.

        These are the cut-off frequency of `response`, half of this frequency, and twice this
        frequency. All three responses have the linearised drag for `flow`.
        """
        last = float(response.omega[-1])
        count = int(np.ceil(np.log(2.0) / np.log(last / float(response.omega[-2])))) + 1
        above = replace(self.water, omega=np.geomspace(last, 2.0 * last, count))
        beyond, _ = respond(self.line, self.buoy, above, sea, first=flow, once=True)
        return CutOffs(response, response.below(0.5 * last), response.joined(beyond))

    def below_a_follower(self, sea: SeaState, flow: Floats) -> float | None:
        """Return the standard deviation of tension below a float that follows every wave [N]."""
        if self.buoy is None:
            return None
        following = replace(self, buoy=replace(self.buoy, follows=True))
        return float(_by_piece(self.line, following.respond(sea, flow)[0])[0])

    def deviations(
        self, seas: Sequence[SeaState], first: Sequence[Floats | None], **how: Any
    ) -> tuple[tuple[Floats, Floats], list[Floats]]:
        """Compute the standard deviations of tension and of pitch in several sea states.

        Return the arrays (seas, pieces) [N] and (seas, 1) [rad], and the flow past the nodes in
        each sea. Tensions on the seabed and unknown pitches are 0.
        """
        found = [self.respond(sea, flow, **how) for sea, flow in zip(seas, first, strict=True)]
        tensions = np.array([_by_piece(self.line, response) for response, _ in found])
        pitches = np.array([[response.moments(response.pitch)[0]] for response, _ in found])
        return (tensions, pitches), [flow for _, flow in found]


def analyse(
    leg: Leg,
    seas: Sequence[SeaState],
    toward: float,
    duration: float = 10_800.0,
    watched: Callable[[Sequence[SeaState]], Iterable[SeaState]] = iter,
) -> WaveAnalysis:
    """Compute tensions and motions of a mooring in sea states.

    Waves are linear and long-crested, and drag is linearised about the mean current. Standard
    deviations of tension and pitch converge to 1 % in the highest and in the shortest sea.

    Parameters
    ----------
    toward : direction in which the waves travel [degrees], clockwise from north
    duration : duration for which maximum and minimum tension are computed [s]
    watched : wrapper around the iteration over the sea states, for instance to show progress

    Raises
    ------
    NoEquilibrium
        The mooring has no equilibrium.
    UsageError
        Hull or mass of the float is unknown, or the waves of a sea state break in this depth.
    """
    for sea in seas:
        if sea.significant_height > SHALLOWEST * leg.water.depth:
            raise UsageError(
                f"a sea of {sea.significant_height:g} m breaks in {leg.water.depth:g} m of "
                f"water; the largest significant height is {SHALLOWEST * leg.water.depth:.1f} m"
            )
    solution = leg.equilibrium(leg.water)
    highest = max(seas, key=SeaState.severity)
    shortest = min(seas, key=lambda sea: sea.shortest or sea.peak_period)
    judged = [highest] if shortest == highest else [highest, shortest]
    setting, flow, accuracy = _settled(leg, solution, judged, toward)
    states, before = [], highest
    for sea in watched(seas):
        near = flow * (sea.significant_height / before.significant_height)
        response, flow = setting.respond(sea, near)
        before = sea
        responses = setting.cut_offs(sea, response, flow)
        follower = setting.below_a_follower(sea, flow) if sea is highest else None
        line, buoy = setting.line, setting.buoy
        states.append(mooring_in_sea(leg, solution, line, buoy, sea, responses, duration, follower))
    warnings = [
        f"{label} has no `stiffness` and is assumed inextensible: its tensions are overestimated."
        for label in setting.line.inextensible
    ]
    fatigue = tuple(
        _fatigue(piece, states) for piece in leg.file.pieces[setting.line.top_pieces : -1]
    )
    missing = None
    if setting.buoy is not None and setting.buoy.profile is None:
        missing = "it requires `hull`, `centre_of_mass` and `radius_of_gyration`"
    elif getattr(leg.file.pieces[0].component, "centre_of_mass", None) and not setting.buoy:
        missing = "the float is below the surface"
    return WaveAnalysis(leg.file.name, tuple(states), fatigue, accuracy, tuple(warnings), missing)


def _fatigue(piece: Piece, states: Sequence[MooringInSea]) -> PieceFatigue:
    found, half, twice = (
        fatigue_of(
            piece.component, piece.index, piece.label,
            [(state.sea.share, *state.moments[case][piece.index]) for state in states],
        )
        for case in range(3)
    )  # fmt: skip
    return replace(found, life_half_cut_off=half.life, life_twice_cut_off=twice.life)


def _settled(
    leg: Leg, solution: Solution, seas: Sequence[SeaState], toward: float
) -> tuple[_Setting, Floats, WaveAccuracy]:
    """Refine elements and frequencies until they suffice for all given sea states.

    Return the refined line with its float and waves, the flow past the nodes in the first sea
    state, and the remaining error.
    """
    density = leg.water.density_at(np.array(0.0))
    water = Waves(np.zeros(0), toward, leg.water.depth, float(density), leg.water.gravity)
    longest, count = COARSEST * leg.water.depth, FEWEST
    buoy = buoy_of(leg, solution, follows=False)
    setting = _Setting(lumped_line(leg, solution, longest), buoy, water, count)
    found, flows = setting.deviations(seas, [None] * len(seas))
    mesh = frequencies = np.inf
    for _ in range(MOST_HALVINGS):
        if mesh > SETTLED:
            longest *= 0.5
            finer = replace(setting, line=lumped_line(leg, solution, longest))
            carried = [_interpolated_flow(setting.line, finer.line, flow) for flow in flows]
            better, passing = finer.deviations(seas, carried)
            mesh = _change(found, better)
            if mesh > SETTLED:
                setting, found, flows = finer, better, passing
        if frequencies > SETTLED:
            more = replace(setting, count=2 * setting.count)
            better, passing = more.deviations(seas, flows)
            frequencies = _change(found, better)
            if frequencies > SETTLED:
                setting, found, flows = more, better, passing
    less, _ = setting.deviations(seas, flows, once=True, drag=0.8)
    return setting, flows[0], WaveAccuracy(mesh, frequencies, _change(found, less))


def _interpolated_flow(line: LumpedLine, finer: LumpedLine, flow: Floats) -> Floats:
    along, at = (np.concatenate([[0.0], each.span.cumsum()]) for each in (line, finer))
    nodes = np.column_stack([np.interp(at, along, values) for values in flow[:-1].T])
    return np.vstack([nodes, flow[-1:]])


def _change(before: tuple[Floats, Floats], after: tuple[Floats, Floats]) -> float:
    changes = []
    for one, other in zip(before, after, strict=True):
        counted = other > SMALL * other.max(1, initial=0.0, keepdims=True)
        changes.append(float(np.abs(one[counted] / other[counted] - 1.0).max(initial=0.0)))
    return max(changes)


def _by_piece(line: LumpedLine, response: WaveResponse) -> Floats:
    return response.moments(line.upper_ends(response.pull))[0]
