"""Record of a fall: depths, tensions and shapes of the pieces, from the states of a chain."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from calm.case.leg_result import LegResult
from calm.drop.chain import BarChain
from calm.drop.fall import Motion
from calm.drop.motion import ChainState, Mover
from calm.files import Clamp, Piece
from calm.files.pieces import clamps_in
from calm.physics.line import Floats, Integers

REPORTED_ROLES = ("float", "instrument", "release")
"""Of pieces and clamps whose depth in the drop matters."""
MOMENTS = 5
"""Shapes from letting go to the touchdown; one more is that at rest."""


@dataclass(frozen=True)
class DepthReached:
    """Tell how deep a piece or clamp comes while the line falls and straightens.

    Attributes
    ----------
    part : the piece or clamp
    rest : its depth when all is at rest, of its lower end [m]
    greatest : the largest depth of its lower end [m]
    time : when, after the anchor was let go [s]
    rating : the depth it is made for [m]; None where it is not known
    """

    part: Piece | Clamp
    rest: float
    greatest: float
    time: float
    rating: float | None

    @property
    def label(self) -> str:
        """Of the piece or clamp."""
        return self.part.label

    @property
    def beyond(self) -> bool:
        """Return whether it comes deeper than it is made for."""
        return self.rating is not None and self.greatest > self.rating


@dataclass(frozen=True)
class Pull:
    """The greatest tension in a piece during the fall [N], and when [s]."""

    part: Piece
    tension: float
    time: float


@dataclass(frozen=True)
class ShapeInTime:
    """The shape of the line at a time [s]: distance towards the float and depth of nodes [m]."""

    time: float
    name: str
    x: Floats
    depth: Floats


@dataclass(frozen=True)
class FallPath:
    """Hold what happens over time, from the moment the anchor is let go to its touchdown; (t,)
    each.

    Attributes
    ----------
    time : [s]
    anchor_depth : of its foot [m]
    anchor_speed : downward [m/s]
    anchor_x, float_x : distance from where the anchor was let go, towards the float [m]
    float_depth : of the free end [m]
    anchor_tension : of the line at the anchor [N]
    """

    time: Floats
    anchor_depth: Floats
    anchor_speed: Floats
    anchor_x: Floats
    float_x: Floats
    float_depth: Floats
    anchor_tension: Floats


def place_of(state: ChainState, bar: Integers, place: Floats) -> Floats:
    """(m, 3) of points at places of bars [m]."""
    share = place[:, np.newaxis]
    found: Floats = (1.0 - share) * state.node[bar] + share * state.node[bar + 1]
    return found


def piece_ends(chain: BarChain, state: ChainState) -> tuple[Floats, Floats]:
    """(p, 3) of the upper and of the lower end of every piece [m]."""
    first, end = chain.bars.T
    last = np.maximum(end - 1, first)
    return place_of(state, first, chain.span[:, 0]), place_of(state, last, chain.span[:, 1])


def end_tensions(mover: Mover, state: ChainState, *, within: bool = False) -> Floats:
    """Return (n, 2) in every bar at its upper and at its lower end [N]; 0 in one that is pushed.

    Parameters
    ----------
    within : whether at the bar's side of what is at its very ends, else beyond that

    In the first moment the anchor pushes what is beside it, where a real line goes slack.
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
    return np.where(state.tension[:, np.newaxis] > 0.0, ends, 0.0)


def path_of(drop: Motion, toward: Floats, anchor_height: float) -> FallPath:
    """The fall over time.

    Parameters
    ----------
    toward : (2,) horizontal unit vector from the anchor to the free end at the start
    anchor_height : of the line's end above the anchor's foot [m]
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
    """Shapes at equal intervals from letting go to the touchdown, and at rest where known."""
    times = np.array([state.time for state in drop.states])
    chosen = [int(np.argmin(np.abs(times - t))) for t in np.linspace(0.0, times[-1], MOMENTS)]
    shown = [drop.states[i] for i in chosen]
    names = ["let go", *(f"after {state.time:.0f} s" for state in shown[1:-1]), "touchdown"]
    if rest is not None:
        shown.append(rest.states[-1])
        names.append("at rest")
    return tuple(
        ShapeInTime(state.time, name, state.node[:, :2] @ toward, -state.node[:, 2])
        for state, name in zip(shown, names, strict=True)
    )


def depths_of(pieces: Sequence[Piece], drop: Motion, rest: Motion) -> tuple[DepthReached, ...]:
    """Return how deep floats, instruments and releases come, from letting go to rest."""
    parts: list[Piece | Clamp] = [*pieces[:-1], *clamps_in(pieces[:-1])]
    chain, states = drop.mover.chain, (*drop.states, *rest.states[1:])
    depth = np.array([_depths(chain, state) for state in states])
    deepest = depth.argmax(axis=0)
    return tuple(
        DepthReached(
            part=part,
            rest=float(depth[-1, i]),
            greatest=float(depth[deepest[i], i]),
            time=states[deepest[i]].time,
            rating=part.component.depth_rating,
        )
        for i, part in enumerate(parts)
        if part.component.role in REPORTED_ROLES
    )


def _depths(chain: BarChain, state: ChainState) -> Floats:
    """Of the deeper end of every piece, and of every clamp [m]."""
    upper, lower = piece_ends(chain, state)
    clamps = place_of(state, chain.clamp_bar, chain.clamp_place)
    return -np.append(np.minimum(upper[:, 2], lower[:, 2]), clamps[:, 2])


def pulls_of(pieces: Sequence[Piece], drop: Motion) -> tuple[Pull, ...]:
    """Return the greatest tension in every piece from letting go to the touchdown."""
    _, tension = piece_tensions(drop)
    latest = tension.argmax(axis=0).tolist()
    return tuple(
        Pull(piece, float(tension[when, number]), drop.states[1 + when].time)
        for number, (piece, when) in enumerate(zip(pieces[:-1], latest, strict=True))
    )


def piece_tensions(drop: Motion) -> tuple[Floats, Floats]:
    """Return the tensions of every piece at its ends, (t-1, p, 2), and the greatest, (t-1, p) [N].

    The first state is left out: the ship still tows, and the water flows past it otherwise.
    Pieces that are rigid with the free end are one bar, and have the tensions of its ends.
    """
    tension = np.array([end_tensions(drop.mover, one, within=True) for one in drop.states[1:]])
    ends = _ends_of_pieces(drop, tension)
    greatest: Floats = ends.max(axis=2)
    for piece, (first, end) in enumerate(drop.mover.chain.bars.tolist()):
        if end - first > 1:
            greatest[:, piece] = tension[:, first:end].max(axis=(1, 2))
    return ends, greatest


def _ends_of_pieces(drop: Motion, tension: Floats) -> Floats:
    """Return (t, p, 2) of the pieces from (t, n, 2) of the bars [N]."""
    first, end = drop.mover.chain.bars.T
    last = np.maximum(end, first + 1) - 1
    found = np.stack([tension[:, first, 0], tension[:, last, 1]], axis=2)
    # a piece without length is on the bar beside it
    short = end == first
    found[:, short] = tension[:, first[short]].max(axis=2)[:, :, np.newaxis]
    return found


def rest_difference(result: LegResult, rest: Motion) -> float:
    """Farthest that an end of a piece comes to rest from its place in the equilibrium [m].

    Of a line that comes down on the seabed before its anchor, pieces that lie there are left out:
    the equilibrium has them at the foot of the anchor, where here they go up to its top.
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
    if result.anchor.grounded_length > 0.0:
        away = away[expected[:, 2] > -result.leg.water.depth + 1e-6 * result.leg.water.depth]
    return float(away.max())
