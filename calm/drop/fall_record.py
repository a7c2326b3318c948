"""Results of an anchor drop: depths, tensions and shapes of the line over time."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from calm.case.leg_result import LegResult
from calm.drop.chain import BarChain
from calm.drop.fall import Motion
from calm.drop.motion import ChainState, Mover
from calm.files import Clamp, Piece
from calm.files.pieces import clamps_in, holds_instrument
from calm.physics.line import Floats, Integers

OVERSHOOT = 0.05
"""A depth during the drop is reported if it exceeds the depth at rest by more than this [m]."""
MOMENTS = 5
"""Number of shapes from release to touchdown; the shape at rest is additional."""


@dataclass(frozen=True)
class DepthReached:
    """Largest depth that a piece or clamp reaches while the line falls and settles.

    Attributes
    ----------
    rest, greatest : depth of the upper end at rest, and largest depth of the upper end [m]
    time : time from the release of the anchor to the largest depth [s]; None if the depth exceeds
        the depth at rest by no more than `OVERSHOOT`
    rating : depth rating [m]; None if unknown
    beyond : whether the upper or the lower end goes below the depth rating
    """

    part: Piece | Clamp
    rest: float
    greatest: float
    time: float | None
    rating: float | None
    beyond: bool

    @property
    def label(self) -> str:
        """Label of the piece or clamp."""
        return self.part.label


@dataclass(frozen=True)
class Pull:
    """Maximum tension in a piece during the fall [N], and the time at which it occurs [s]."""

    part: Piece
    tension: float
    time: float


@dataclass(frozen=True)
class ShapeInTime:
    """Shape of the line at one time, given by the nodes.

    `depth` is the depth of the nodes [m]. `x` is their horizontal distance from the anchor at the
    release, positive towards the float [m].
    """

    time: float
    name: str
    x: Floats
    depth: Floats


@dataclass(frozen=True)
class FallPath:
    """Time series (t,) of the fall, from the release of the anchor to its touchdown.

    Attributes
    ----------
    time : time since the release [s]
    anchor_depth, float_depth : depths of the lower end of the anchor and of the free end [m]
    anchor_speed : downward speed of the anchor [m/s]
    anchor_x, float_x : horizontal distances of the anchor and of the free end from the position of
        the anchor at its release, positive towards the float [m]
    anchor_tension : tension of the line at the anchor [N]
    """

    time: Floats
    anchor_depth: Floats
    anchor_speed: Floats
    anchor_x: Floats
    float_x: Floats
    float_depth: Floats
    anchor_tension: Floats


def place_of(state: ChainState, bar: Integers, place: Floats) -> Floats:
    """Return the positions (m, 3) of points on bars [m].

    Each point is given by its bar and its position on the bar, from 0 at the upper to 1 at the
    lower end.
    """
    share = place[:, np.newaxis]
    found: Floats = (1.0 - share) * state.node[bar] + share * state.node[bar + 1]
    return found


def piece_ends(chain: BarChain, state: ChainState) -> tuple[Floats, Floats]:
    """Return the positions (p, 3) of the upper ends of all pieces, and of their lower ends [m]."""
    first, end = chain.bars.T
    last = np.maximum(end - 1, first)
    return place_of(state, first, chain.span[:, 0]), place_of(state, last, chain.span[:, 1])


def end_tensions(mover: Mover, state: ChainState, *, within: bool = False) -> Floats:
    """Return the tensions (n, 2) at the upper and the lower end of every bar [N].

    A bar under compression has zero tension. If `within` is true, the tensions do not include loads
    exactly at the ends of a bar.
    """
    on = mover.chain.elements
    strain, _ = mover.strain(state.tension)
    loads, axis, _ = mover.loads(state.node.T, state.velocity.T, strain, mover.variation(state))
    force = loads.force
    if within:
        force = np.where((on.place > 0.0) & (on.place < 1.0), force, 0.0)
    above, below = on.summed(on.share[:, np.newaxis] * force)
    pull = state.tension * axis
    ends = np.linalg.norm([pull + above, pull - below], axis=1).T
    # just after the release, the anchor pushes the pieces above; a real line would become slack
    return np.where(state.tension[:, np.newaxis] > 0.0, ends, 0.0)


def path_of(drop: Motion, toward: Floats, anchor_height: float) -> FallPath:
    """Return the time series of a fall.

    Parameters
    ----------
    toward : (2,) horizontal unit vector from the anchor to the free end at the release
    anchor_height : height of the lower end of the line above the lower end of the anchor [m]
    """
    states = drop.states
    foot, top = (np.array([state.node[i] for state in states]) for i in (-1, 0))
    return FallPath(
        time=np.array([state.time for state in states]),
        anchor_depth=anchor_height - foot[:, 2],
        anchor_speed=np.array([-state.velocity[-1, 2] for state in states]),
        anchor_x=foot[:, :2] @ toward,
        float_x=top[:, :2] @ toward,
        float_depth=-top[:, 2],
        anchor_tension=np.array([end_tensions(drop.mover, state)[-1, 1] for state in states]),
    )


def moments_of(drop: Motion, rest: Motion | None, toward: Floats) -> tuple[ShapeInTime, ...]:
    """Return the shapes of the line at equal intervals from release to touchdown, and at rest.

    Without `rest`, the shape at rest is omitted. `toward` is as in `path_of`.
    """
    times = np.array([state.time for state in drop.states])
    chosen = [int(np.argmin(np.abs(times - t))) for t in np.linspace(0.0, times[-1], MOMENTS)]
    shown = [drop.states[i] for i in chosen]
    names = ["release", *(f"after {state.time:.0f} s" for state in shown[1:-1]), "touchdown"]
    if rest is not None:
        shown.append(rest.states[-1])
        names.append("at rest")
    return tuple(
        ShapeInTime(state.time, name, state.node[:, :2] @ toward, -state.node[:, 2])
        for state, name in zip(shown, names, strict=True)
    )


def depths_of(pieces: Sequence[Piece], drop: Motion, rest: Motion) -> tuple[DepthReached, ...]:
    """Return the largest depths that floats and parts with instruments reach before rest."""
    parts: list[Piece | Clamp] = [*pieces[:-1], *clamps_in(pieces[:-1])]
    chain, states = drop.mover.chain, (*drop.states, *rest.states[1:])
    upper, deeper = np.array([_depths(chain, state) for state in states]).swapaxes(0, 1)
    greatest, deepest_of_all = upper.max(axis=0), deeper.max(axis=0)
    when = upper.argmax(axis=0)
    return tuple(
        DepthReached(
            part=part,
            rest=float(upper[-1, i]),
            greatest=float(greatest[i]),
            time=states[when[i]].time if greatest[i] > upper[-1, i] + OVERSHOOT else None,
            rating=(rating := part.component.depth_rating),
            beyond=rating is not None and float(deepest_of_all[i]) > rating,
        )
        for i, part in enumerate(parts)
        if part.component.role == "float" or holds_instrument(part)
    )


def _depths(chain: BarChain, state: ChainState) -> tuple[Floats, Floats]:
    """Return the depths [m] of the upper ends, and the depths of the deeper ends.

    Each array has the pieces, followed by the clamps. Both depths of a clamp are equal.
    """
    upper, lower = (-end[:, 2] for end in piece_ends(chain, state))
    clamps = -place_of(state, chain.clamp_bar, chain.clamp_place)[:, 2]
    return np.append(upper, clamps), np.append(np.maximum(upper, lower), clamps)


def pulls_of(pieces: Sequence[Piece], drop: Motion) -> tuple[Pull, ...]:
    """Return the maximum tension in every piece, from release to touchdown."""
    _, tension = piece_tensions(drop)
    latest = tension.argmax(axis=0).tolist()
    return tuple(
        Pull(piece, float(tension[when, number]), drop.states[1 + when].time)
        for number, (piece, when) in enumerate(zip(pieces[:-1], latest, strict=True))
    )


def piece_tensions(drop: Motion) -> tuple[Floats, Floats]:
    """Return the tensions at the ends of all pieces (t-1, p, 2), and their maximum per piece [N].

    The first of the t states is under tow, and is omitted. Rigid pieces that share one bar all have
    the tensions at the ends of this bar.
    """
    # the flow past the line under tow differs from the flow after the release
    tension = np.array([end_tensions(drop.mover, one, within=True) for one in drop.states[1:]])
    ends = _ends_of_pieces(drop, tension)
    greatest: Floats = ends.max(axis=2)
    for piece, (first, end) in enumerate(drop.mover.chain.bars.tolist()):
        if end - first > 1:
            greatest[:, piece] = tension[:, first:end].max(axis=(1, 2))
    return ends, greatest


def _ends_of_pieces(drop: Motion, tension: Floats) -> Floats:
    """Select the tensions (t, p, 2) at the ends of pieces from the tensions (t, n, 2) of bars."""
    first, end = drop.mover.chain.bars.T
    last = np.maximum(end, first + 1) - 1
    found = np.stack([tension[:, first, 0], tension[:, last, 1]], axis=2)
    # a piece without length takes the values of the adjacent bar
    short = end == first
    found[:, short] = tension[:, first[short]].max(axis=2)[:, :, np.newaxis]
    return found


def rest_difference(result: LegResult, rest: Motion) -> float:
    """Return the largest distance between a piece's end at rest and its equilibrium position [m].

    Pieces on the seabed are excluded.
    """
    state = rest.states[-1]
    upper, lower = piece_ends(rest.mover.chain, state)
    at, count = result.components, len(upper)
    expected = np.concatenate(
        [
            np.column_stack([at.x_top, at.y_top, -at.depth_top])[:count],
            np.column_stack([at.x_bottom, at.y_bottom, -at.depth_bottom])[:count],
        ]
    )
    found = np.concatenate([upper, lower]) - [*state.node[-1, :2], 0.0]
    away = np.linalg.norm(found - expected, axis=1)
    # pieces on the seabed lead up to the top of the anchor at rest, but not in the equilibrium
    if result.anchor_load.grounded_length > 0.0:
        away = away[expected[:, 2] > -result.leg.water.depth + 1e-6 * result.leg.water.depth]
    return float(away.max())
