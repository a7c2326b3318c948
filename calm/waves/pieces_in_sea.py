"""Tensions and motions of the pieces of a mooring in one sea state.

The results include tensions for other cut-off frequencies and for the band measured at sea.
"""

from __future__ import annotations

from dataclasses import asdict, dataclass
from math import degrees
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from calm.physics.line import Floats
from calm.records.sea_states import SeaState
from calm.waves.buoy import Buoy
from calm.waves.fatigue import greatest_of, moments_of, passing_probability
from calm.waves.lumped_line import LumpedLine
from calm.waves.measured import MeasuredBand, measured_band
from calm.waves.response import WaveResponse

if TYPE_CHECKING:
    from calm.case.leg import Leg
    from calm.solve import Solution


@dataclass(frozen=True)
class PieceLoads:
    """Tensions of a piece in a sea state [N].

    Attributes
    ----------
    tension_max, tension_min : most probable maximum and minimum at the upper end within the
        duration of the analysis
    slack_probability : probability that the upper end becomes slack within this duration
    greatest, least : most probable maximum and minimum over the whole piece
    """

    tension_std: float
    tension_max: float
    tension_min: float
    slack_probability: float
    greatest: float
    least: float


@dataclass(frozen=True)
class PieceInWaves:
    """Results for a piece of the line in a sea state.

    Tensions are defined in `PieceLoads`. Heave is in m, and tilt in degrees.

    Attributes
    ----------
    half_cut_off, twice_cut_off : tensions for half and for twice the cut-off frequency of the waves
    measured_low, measured_high : tensions scaled by the limits of the `MeasuredBand`; None if no
        band applies
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
    half_cut_off: PieceLoads
    twice_cut_off: PieceLoads
    measured_low: PieceLoads | None
    measured_high: PieceLoads | None


PieceMoments = tuple[tuple[float, Floats], ...]
"""Mean tension [N] and spectral moments m0, m1, m2, m4 of each piece, at the spring of the piece
with the largest standard deviation.
"""


class CutOffs(NamedTuple):
    """Responses to a sea state for three cut-off frequencies of the waves.

    They are the cut-off frequency of the analysis, half of this frequency, and twice this
    frequency.
    """

    full: WaveResponse
    half: WaveResponse
    twice: WaveResponse


@dataclass(frozen=True)
class MooringInSea:
    """Results for a mooring in one sea state.

    Attributes
    ----------
    components : results for the pieces, from the top down
    slack : labels of the pieces that become slack
    cut_off : cut-off frequency of the waves [rad/s]
    band : range of measured to computed tension; None below the surface or for a prescribed
        response
    follower_std : standard deviation of the tension below a float that follows every wave [N]; only
        in the highest sea state
    pitch_std : standard deviation of the pitch of the float [degrees]; None if unknown
    moments : spectral moments of tension, for the three cut-off frequencies in `CutOffs`
    spectrum : angular frequencies [rad/s], and spectrum of the tension at the top [N² s/rad]
    along : depths down the line [m], and mean, standard deviation and maximum of the tension there
        [N]
    """

    sea: SeaState
    components: tuple[PieceInWaves, ...]
    slack: tuple[str, ...]
    cut_off: float
    band: MeasuredBand | None
    follower_std: float | None
    pitch_std: float | None
    moments: tuple[PieceMoments, ...]
    spectrum: tuple[Floats, Floats]
    along: tuple[Floats, Floats, Floats, Floats]

    def to_dict(self) -> dict[str, Any]:
        """Return the results as a dictionary for JSON, in SI units and degrees."""
        return {
            "significant_wave_height": self.sea.significant_height,
            "peak_period": self.sea.peak_period,
            "share": self.sea.share,
            "components": [asdict(one) for one in self.components],
            "slack": list(self.slack),
            "follower_std": self.follower_std,
            "pitch_std": self.pitch_std,
            "cut_off": self.cut_off,
            "measured_over_computed": None if self.band is None else asdict(self.band),
        }


class _Tensions:
    """Statistics of the tension in the springs of a line, and at the upper ends of its pieces."""

    def __init__(self, line: LumpedLine, response: WaveResponse, duration: float) -> None:
        spectral = np.abs(response.pull) ** 2 * response.weight[:, None]
        self.moments = moments_of(response.omega, spectral)
        self.deviation, period = response.moments(response.pull)
        pairs = zip(self.deviation, period, strict=True)
        self.departs = np.array([greatest_of(*each, duration) for each in pairs])
        self.at_ends, self.periods = response.moments(line.upper_ends(response.pull))
        self.mean, self.duration = line.tension, duration

    def loads(self, piece: int, mean: float, own: slice, factor: float = 1.0) -> PieceLoads:
        """Return the tensions of a piece, with standard deviations multiplied by `factor`.

        `mean` is the mean tension at the upper end [N], and `own` selects the springs of the piece.
        """
        deviation, apart = factor * float(self.at_ends[piece]), float(self.periods[piece])
        most = greatest_of(deviation, apart, self.duration)
        departs = factor * self.departs[own]
        return PieceLoads(
            tension_std=deviation,
            tension_max=mean + most,
            tension_min=mean - most,
            slack_probability=passing_probability(mean, deviation, apart, self.duration),
            greatest=float((self.mean[own] + departs).max(initial=mean + most)),
            least=float((self.mean[own] - departs).min(initial=mean - most)),
        )

    def most_moved(self, mean: float, own: slice) -> tuple[float, Floats]:
        """Return mean and spectral moments of tension at the spring with the largest deviation.

        The moments are 0 for a piece on the seabed.
        """
        if own == slice(0):
            return mean, np.zeros(4)
        at = own.start + int(self.deviation[own].argmax())
        return float(self.mean[at]), self.moments[:, at]


def mooring_in_sea(
    leg: Leg,
    solution: Solution,
    line: LumpedLine,
    buoy: Buoy | None,
    sea: SeaState,
    responses: CutOffs,
    duration: float,
    follower: float | None,
) -> MooringInSea:
    """Compute tensions and motions of the pieces of a mooring in a sea state.

    Parameters
    ----------
    responses : responses of the line to this sea state
    duration : duration for which maximum and minimum tension are computed [s]
    follower : value of `MooringInSea.follower_std`
    """
    response = responses.full
    pitches = buoy is not None and buoy.profile is not None
    way = None if buoy is None else buoy.heaves
    band = None if way is None else measured_band(sea.significant_height, way)
    cases = [_Tensions(line, each, duration) for each in responses]
    full, half, twice = cases
    motion, _ = response.moments(response.motion)
    lean, _ = response.moments(line.upper_ends(line.turned(response.motion)))
    pitch = degrees(float(response.moments(response.pitch)[0])) if pitches else None
    rows: list[PieceInWaves] = []
    moments: list[list[tuple[float, Floats]]] = [[] for _ in cases]
    for piece in leg.file.pieces[:-1]:
        at, node = piece.index, int(line.piece_node[piece.index])
        # pieces on top of the float have no tension at their upper end
        on_top = at < line.top_pieces
        end = (line.top_pieces - 1, 1) if on_top else (at, 0)
        mean, own = float(solution.tension[int(solution.piece_nodes[end])]), _springs(line, at)
        for each, case in zip(moments, cases, strict=True):
            each.append(case.most_moved(mean, own))
        tilt = degrees(float(np.linalg.norm(lean[at])))
        rows.append(
            PieceInWaves(
                index=at,
                label=piece.label,
                tension_mean=mean,
                zero_crossing_period=float(full.periods[at]),
                heave_std=float(motion[node, 2]),
                tilt_std=pitch if pitch is not None and on_top else tilt,
                half_cut_off=half.loads(at, mean, own),
                twice_cut_off=twice.loads(at, mean, own),
                measured_low=full.loads(at, mean, own, band.low) if band else None,
                measured_high=full.loads(at, mean, own, band.high) if band else None,
                **vars(full.loads(at, mean, own)),
            )
        )
    depth = -0.5 * (line.position[1:, 2] + line.position[:-1, 2])
    return MooringInSea(
        sea,
        tuple(rows),
        slack=tuple(row.label for row in rows if row.least < 0.0 < row.tension_std),
        cut_off=float(response.omega[-1]),
        band=band,
        follower_std=follower,
        pitch_std=pitch,
        moments=tuple(tuple(each) for each in moments),
        spectrum=(response.omega, np.abs(response.pull[:, 0]) ** 2 * sea.density(response.omega)),
        along=(depth, line.tension, full.deviation, line.tension + full.departs),
    )


def _springs(line: LumpedLine, piece: int) -> slice:
    first = int(line.piece_spring[piece])
    if first < 0:  # on the seabed
        return slice(0)
    below = line.piece_spring[line.piece_spring > first]
    return slice(first, int(below.min()) if len(below) else len(line.tension))
