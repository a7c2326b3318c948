"""Tensions and motions of a mooring in sea states, each settled and with its own accuracy."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import asdict, dataclass, replace
from math import degrees
from typing import TYPE_CHECKING, Any

import numpy as np

from calm.errors import UsageError
from calm.physics.line import Floats
from calm.records.sea_states import SeaState
from calm.waves.buoy import Buoy, buoy_of
from calm.waves.fatigue import (
    PieceFatigue,
    fatigue_of,
    greatest_of,
    moments_of,
    passing_probability,
)
from calm.waves.lumped_line import LumpedLine, lumped_line
from calm.waves.response import WaveResponse, Waves, respond

if TYPE_CHECKING:
    from calm.case import Mooring
    from calm.solve import Solution

SHALLOWEST = 0.6
"""Significant height over the depth of the water where a sea breaks (Thornton and Guza 1983, 0.42
as the root mean square height)."""

CONVERGED, SLACK = "converged", "slack-in-waves"

SETTLED = 0.01
"""Change of the standard deviations of tension and pitch with twice the elements or frequencies
below which there are enough of them."""

COARSEST, FEWEST, MOST_HALVINGS = 1.0 / 50.0, 32, 4
"""Elements as a share of the depth, frequencies, and how often both are refined."""

SMALL = 0.05
"""Of the greatest standard deviation: below it a change is not looked at."""


@dataclass(frozen=True)
class PieceInWaves:
    """Hold a piece of the line in a sea: tensions [N] at its upper end, motions [m], [degrees].

    Greatest and least are the most probable ones of the duration; `slack_probability` that of
    falling slack in it. `greatest` and `least` are those anywhere along the piece.
    """

    index: int
    label: str
    tension_mean: float
    tension_std: float
    tension_max: float
    tension_min: float
    zero_crossing_period: float
    slack_probability: float
    heave_std: float
    tilt_std: float
    greatest: float
    least: float


@dataclass(frozen=True)
class MooringInSea:
    """Hold a mooring in a sea: its pieces down the line, and the labels of those that fall slack.

    `worst` are the mean of the tension and its moments m0, m1, m2, m4 by frequency where each piece
    is pulled about most. `spectrum` is that of the tension at the top, N² s/rad at rad/s, and
    `along` the depth [m], mean, standard deviation and greatest tension down the line.
    `follower_std` is the deviation of the tension below a float that follows every wave [N], of
    the highest of several seas alone; None of a line below the surface. `pitch_std` is that of the
    pitch of the float [degrees]; None where it is not known.
    """

    sea: SeaState
    components: tuple[PieceInWaves, ...]
    slack: tuple[str, ...]
    follower_std: float | None
    pitch_std: float | None
    worst: tuple[tuple[float, Floats], ...]
    spectrum: tuple[Floats, Floats]
    along: tuple[Floats, Floats, Floats, Floats]


@dataclass(frozen=True)
class WaveAccuracy:
    """Hold how much the deviations of tension, and of the float's pitch, change, as shares.

    `mesh` and `frequencies`: with twice as many elements or frequencies. `linearisation`: with a
    fifth less of the linearised drag, of which they are a measure of the share.
    """

    mesh: float
    frequencies: float
    linearisation: float


@dataclass(frozen=True)
class WaveAnalysis:
    """Hold what waves do to a mooring.

    Attributes
    ----------
    name : of the mooring
    states : in the order given
    accuracy : in the highest and in the shortest of them
    fatigue : of each piece, by the shares of the seas; a single one lasts all the year
    warnings : what rests on assumptions
    pitch_unknown : why the pitch of the float is not computed; None where it is
    """

    name: str
    states: tuple[MooringInSea, ...]
    fatigue: tuple[PieceFatigue, ...]
    accuracy: WaveAccuracy
    warnings: tuple[str, ...]
    pitch_unknown: str | None

    @property
    def status(self) -> str:
        """Return "slack-in-waves" where a piece falls slack in a sea, else "converged"."""
        return SLACK if any(state.slack for state in self.states) else CONVERGED

    def to_dict(self) -> dict[str, Any]:
        """Return the JSON object of the result: SI units and degrees."""
        from calm.version import __version__

        return {
            "calm": __version__,
            "name": self.name,
            "status": self.status,
            "states": [
                {
                    "significant_wave_height": state.sea.significant_height,
                    "peak_period": state.sea.peak_period,
                    "share": state.sea.share,
                    "components": [asdict(one) for one in state.components],
                    "slack": list(state.slack),
                    "follower_std": state.follower_std,
                    "pitch_std": state.pitch_std,
                }
                for state in self.states
            ],
            "fatigue": [asdict(one) for one in self.fatigue],
            "accuracy": asdict(self.accuracy),
            "warnings": list(self.warnings),
            "pitch_unknown": self.pitch_unknown,
        }


@dataclass(frozen=True)
class _Setting:
    """Hold what is solved: the line, its float, the water, and how many frequencies of each sea."""

    line: LumpedLine
    buoy: Buoy | None
    water: Waves
    count: int

    def waves(self, sea: SeaState) -> Waves:
        return replace(self.water, omega=sea.frequencies(self.count))

    def respond(
        self, sea: SeaState, first: Floats | None = None, *, once: bool = False, drag: float = 1.0
    ) -> tuple[WaveResponse, Floats]:
        """Return the response to a sea, and the flow past its nodes; `first` of one like it."""
        waves = self.waves(sea)
        return respond(self.line, self.buoy, waves, sea, drag_factor=drag, first=first, once=once)

    def deviations(
        self, seas: Sequence[SeaState], first: Sequence[Floats | None], **how: Any
    ) -> tuple[tuple[Floats, Floats], list[Floats]]:
        """Return the deviations of tension (seas, pieces) [N], 0 on the seabed, and the flows.

        Beside those of tension stand those of the float's pitch (seas, 1), 0 where it is not known.
        """
        found = [self.respond(sea, flow, **how) for sea, flow in zip(seas, first, strict=True)]
        tensions = np.array([_by_piece(self.line, response) for response, _ in found])
        pitches = np.array([[response.moments(response.pitch)[0]] for response, _ in found])
        return (tensions, pitches), [flow for _, flow in found]


def analyse(
    mooring: Mooring,
    seas: Sequence[SeaState],
    toward: float,
    duration: float = 10_800.0,
    watched: Callable[[Sequence[SeaState]], Iterable[SeaState]] = iter,
) -> WaveAnalysis:
    """Return the tensions and motions of a mooring in sea states.

    The line is lumped masses about its equilibrium in the mean current, the waves are linear and
    long-crested, the drag is linearised to what it dissipates. Elements and frequencies are refined
    in the highest and in the shortest sea until the deviations of tension settle to 1 %.

    Parameters
    ----------
    seas : one or more
    toward : where the waves run [degrees], clockwise from north
    duration : for the greatest and the least tension [s]
    watched : hands on the seas one by one, such as to show how many are done

    Raises
    ------
    NoEquilibrium
        The mooring does not stand.
    UsageError
        The float at the surface has no hull, or no mass; a sea breaks in this depth.
    """
    for sea in seas:
        if sea.significant_height > SHALLOWEST * mooring.water.depth:
            raise UsageError(
                f"a sea of {sea.significant_height:g} m breaks in {mooring.water.depth:g} m of "
                f"water, where it is {SHALLOWEST * mooring.water.depth:.1f} m high at most"
            )
    solution = mooring.equilibrium(mooring.water)
    highest = max(seas, key=lambda sea: sea.significant_height)
    shortest = min(seas, key=lambda sea: sea.shortest or sea.peak_period)
    judged = [highest] if shortest == highest else [highest, shortest]
    setting, flow, accuracy = _settled(mooring, solution, judged, toward)
    states, before = [], highest
    for sea in watched(seas):
        near = flow * (sea.significant_height / before.significant_height)
        response, flow = setting.respond(sea, near)
        before = sea
        beside = sea is highest
        states.append(_in_sea(mooring, solution, setting, sea, response, flow, duration, beside))
    warnings = [
        f"{label} gives no `stiffness` and is taken as inextensible: its tensions are "
        "overestimated."
        for label in setting.line.inextensible
    ]
    fatigue = tuple(
        fatigue_of(
            mooring.file.pieces[index].component, index, mooring.file.pieces[index].label,
            [(state.sea.share, *state.worst[index]) for state in states],
        )
        for index in range(setting.line.top_pieces, len(mooring.file.pieces) - 1)
    )  # fmt: skip
    missing = None
    if setting.buoy is not None and setting.buoy.profile is None:
        missing = "it takes its `hull`, `centre_of_mass` and `radius_of_gyration`"
    elif getattr(mooring.file.pieces[0].component, "centre_of_mass", None) and not setting.buoy:
        missing = "it stands below the surface"
    return WaveAnalysis(
        mooring.file.name, tuple(states), fatigue, accuracy, tuple(warnings), missing
    )


def _settled(
    mooring: Mooring, solution: Solution, seas: Sequence[SeaState], toward: float
) -> tuple[_Setting, Floats, WaveAccuracy]:
    """Return elements and frequencies that are enough for seas, and what twice as many change.

    Between them stands the flow past the nodes in the first of them.
    """
    density = mooring.water.density_at(np.array(0.0))
    water = Waves(np.zeros(0), toward, mooring.water.depth, float(density), mooring.water.gravity)
    longest, count = COARSEST * mooring.water.depth, FEWEST
    buoy = buoy_of(mooring, solution, follows=False)
    setting = _Setting(lumped_line(mooring, solution, longest), buoy, water, count)
    found, flows = setting.deviations(seas, [None] * len(seas))
    mesh = frequencies = np.inf
    for _ in range(MOST_HALVINGS):
        if mesh > SETTLED:
            longest *= 0.5
            finer = replace(setting, line=lumped_line(mooring, solution, longest))
            carried = [_carried(setting.line, finer.line, flow) for flow in flows]
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


def _carried(line: LumpedLine, finer: LumpedLine, flow: Floats) -> Floats:
    """Return the flow past the nodes of a line at those of a finer one of the same shape."""
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


def _in_sea(
    mooring: Mooring,
    solution: Solution,
    setting: _Setting,
    sea: SeaState,
    response: WaveResponse,
    flow: Floats,
    duration: float,
    beside: bool,
) -> MooringInSea:
    line = setting.line
    spectral = np.abs(response.pull) ** 2 * response.weight[:, None]
    moments = moments_of(response.omega, spectral)
    tension, period = response.moments(response.pull)
    departs = np.array([greatest_of(*each, duration) for each in zip(tension, period, strict=True)])
    deviations, periods = response.moments(line.upper_ends(response.pull))
    motion, _ = response.moments(response.motion)
    lean, _ = response.moments(line.upper_ends(line.turned(response.motion)))
    pitch = None
    if setting.buoy is not None and setting.buoy.profile is not None:
        pitch = degrees(float(response.moments(response.pitch)[0]))
    rows: list[PieceInWaves] = []
    worst: list[tuple[float, Floats]] = []
    for piece in mooring.file.pieces[:-1]:
        spring, node = int(line.piece_spring[piece.index]), int(line.piece_node[piece.index])
        mean = float(solution.tension[int(solution.piece_nodes[piece.index, 0])])
        if piece.index < line.top_pieces:  # nothing pulls at the upper end of what floats on top
            mean = float(solution.tension[int(solution.piece_nodes[line.top_pieces - 1, 1])])
        own, most_moved = slice(0), (mean, np.zeros(4))  # on the seabed
        if spring >= 0:
            below = line.piece_spring[line.piece_spring > spring]
            own = slice(spring, int(below.min()) if len(below) else len(tension))
            at = spring + int(tension[own].argmax())
            most_moved = float(line.tension[at]), moments[:, at]
        worst.append(most_moved)
        deviation, apart = float(deviations[piece.index]), float(periods[piece.index])
        most = greatest_of(deviation, apart, duration)
        rows.append(
            PieceInWaves(
                index=piece.index,
                label=piece.label,
                tension_mean=mean,
                tension_std=deviation,
                tension_max=mean + most,
                tension_min=mean - most,
                zero_crossing_period=apart,
                slack_probability=passing_probability(mean, deviation, apart, duration),
                heave_std=float(motion[node, 2]),
                tilt_std=degrees(float(np.linalg.norm(lean[piece.index])))
                if pitch is None or piece.index >= line.top_pieces
                else pitch,
                greatest=float((line.tension + departs)[own].max(initial=mean + most)),
                least=float((line.tension - departs)[own].min(initial=mean - most)),
            )
        )
    follower = None
    if setting.buoy is not None and beside:
        following = replace(setting, buoy=replace(setting.buoy, follows=True))
        follower = float(_by_piece(line, following.respond(sea, flow)[0])[0])
    slack = tuple(row.label for row in rows if row.least < 0.0 < row.tension_std)
    depth = -0.5 * (line.position[1:, 2] + line.position[:-1, 2])
    return MooringInSea(
        sea,
        tuple(rows),
        slack,
        follower,
        pitch,
        worst=tuple(worst),
        spectrum=(response.omega, np.abs(response.pull[:, 0]) ** 2 * sea.density(response.omega)),
        along=(depth, line.tension, tension, line.tension + departs),
    )
