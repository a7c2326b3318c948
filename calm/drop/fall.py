"""Anchor drop: the line is towed and released, falls, and settles on the seabed."""

from contextlib import suppress
from dataclasses import dataclass, replace

import numpy as np

from calm.drop.chain import chain_of
from calm.drop.loads import WaterColumn
from calm.drop.motion import ChainState, FallingAnchor, Mover, NoStep
from calm.errors import NoEquilibrium, UsageError
from calm.physics.line import Line, Water
from calm.solve import Status
from calm.solve.least_change import bracketed_root

SKIN, THICKEST_SKIN = 5e-4, 0.3
"""Thickness of the surface layer in which floats lose their buoyancy, as a fraction of the depth,
and upper limit of this thickness [m].
"""
AT_REST = 1e-7
"""The line is at rest if no node moves by more than this fraction of the water depth in the last
time step.
"""
UNMOVED = 1e-10
"""If no node moves by more than this fraction of the water depth in a time step, the motion is due
to rounding, and the longest time step is next.
"""
MAX_STEP = 1e6
"""Limit of the time step [s]. A settling line is tested for rest when its growing time step reaches
this limit.
"""
SLOWEST_FLOW = 0.01
"""Lowest flow speed that is tried to shorten the distance over which a line streams [m/s]."""
STREAMED_WITHIN = 1e-4
"""Tolerance of the streamed distance, as a fraction of the line length."""
LEAST_COMPRESSION = 1e-4
"""Compression above which a settled bar is laid down, as a fraction of the sum of all weights."""
_FALLS = 3
RELEASED_SHARE = 0.6
"""Fraction of the anchor's weight that the ship still carries in the second time step. In each
further step, the carried weight is multiplied by this fraction. This gradual release avoids a jerk.
"""
_GROWTH = 1.3
_REST_GROWTH = 1.6
_SHORTEST = 1e-9
_MOST = 20


@dataclass(frozen=True)
class Fineness:
    """Resolution of a fall: approximate numbers of bars and time steps.

    `bars` counts the bars of all cables and chains together.
    """

    bars: int
    steps: int


@dataclass(frozen=True)
class Ship:
    """Ship that drops the anchor, with its velocity over the ground to the east and north [m/s].

    `streamed` is the horizontal distance from the anchor to the free end at the release [m]; None
    for the distance that results under tow.
    """

    east: float
    north: float
    streamed: float | None = None


@dataclass(frozen=True)
class Motion:
    """Motion of a chain as a sequence of states, one per time step."""

    mover: Mover
    states: tuple[ChainState, ...]


def towed(
    line: Line, water: Water, anchor: FallingAnchor, ship: Ship, fineness: Fineness
) -> ChainState:
    """Compute the shape of the line that streams behind the ship, with its lower end at the origin.

    If `ship.streamed` is shorter than the distance under tow, the shape is that of a slower tow. If
    it is longer, the free end is held at that distance.

    Raises
    ------
    NoEquilibrium
        ``not-converged`` if no steady shape is found; ``no-equilibrium`` if nothing has drag.
    UsageError
        The line extends farther than `ship.streamed` at any ship speed.
    """
    across = line.normal_drag[~line.directional]
    if not (anchor.drag or any(k.any() for k in (line.tangential_drag, across, line.clamp_drag))):
        raise nothing_limits()
    flow = replace(water, u=water.u - ship.east, v=water.v - ship.north)
    mover = Mover(chain_of(line, fineness.bars), _sea(flow), anchor, held=True)
    current = flow.current_at(np.zeros(()))
    astern = np.array([current[0], current[1], 0.0])
    if not astern.any():
        astern[:2] = -ship.east, -ship.north
    astern /= np.linalg.norm(astern)
    # a rope with permanent elongation is longer than its cut length even without tension
    length = mover.chain.length * (1.0 + mover.strain(np.zeros_like(mover.chain.length))[0])
    along = np.append(np.cumsum(length[::-1])[::-1], 0.0)
    state = ChainState(
        time=0.0,
        node=along[:, np.newaxis] * astern,
        tension=np.full(len(length), 0.01 * mover.scale),
        velocity=np.zeros((len(along), 3)),
    )
    state = _settled(mover, state, 1e-3 * water.depth)[-1]
    if ship.streamed is not None:
        nearer = ship.streamed < _streamed(state)
        state = (_slowed if nearer else _drawn)(mover, state, ship.streamed)
    return replace(state, time=0.0, velocity=np.zeros_like(state.node))


def fall(
    line: Line, water: Water, anchor: FallingAnchor, start: ChainState, fineness: Fineness
) -> Motion:
    """Compute the fall of a line from its shape under tow until its anchor reaches the seabed.

    Raises
    ------
    NoEquilibrium
        ``anchor-lifts`` if the anchor does not reach the seabed; ``not-converged`` if a time step
        has no solution.
    """
    mover = Mover(chain_of(line, fineness.bars), _sea(water), anchor)
    bottom = line.anchor_height - water.depth
    sinking = water.depth / fineness.steps
    states, step = [start], 0.005 * sinking
    while states[-1].node[-1, 2] > bottom:
        if len(states) > _MOST * fineness.steps or step >= MAX_STEP:
            raise Status.ANCHOR_LIFTS.because(
                f"The anchor weighs only {anchor.weight:.0f} N in water, too little to pull the "
                "line to the seabed."
            )
        # released at once, without inertia, the anchor would pass the line next to it
        carried = RELEASED_SHARE ** (len(states) - 1)
        lighter = replace(anchor, weight=(1.0 - carried) * anchor.weight)
        falling = mover if carried < 1e-3 else replace(mover, anchor=lighter)
        state = _stepped(falling, states[-1], step, water.depth)
        step = state.time - states[-1].time
        if state.node[-1, 2] <= bottom:
            # in the part of the step beyond the touchdown, the seabed would stop the pieces above
            # the anchor
            state = _stepped(replace(mover, bedded=False), states[-1], step, water.depth)
        speed = float(np.linalg.norm(state.velocity[-1]))
        step = min(_GROWTH * (state.time - states[-1].time), sinking / max(speed, 1e-300), MAX_STEP)
        states.append(state)
    return Motion(mover, (*states[:-1], _passing(states[-2], states[-1], bottom)))


def nothing_limits() -> NoEquilibrium:
    """Return the exception for a line and an anchor without drag, whose speed has no limit."""
    return Status.NO_EQUILIBRIUM.because(
        "The speed of the line is unlimited, since neither the line nor its anchor has drag.",
        advice="Set the drag of its pieces, or `kt` of the anchor.",
    )


def settle(
    line: Line, water: Water, anchor: FallingAnchor, landed: ChainState, fineness: Fineness
) -> Motion:
    """Compute the motion of a line from the touchdown of its anchor until the line is at rest.

    Raises
    ------
    NoEquilibrium
        ``not-converged`` if the line does not come to rest.
    """
    mover = Mover(chain_of(line, fineness.bars), _sea(water), anchor, held=True)
    return Motion(mover, _settled(mover, landed, 0.2 * water.depth / fineness.steps))


def _sea(water: Water) -> WaterColumn:
    return WaterColumn(water, min(SKIN * water.depth, THICKEST_SKIN))


def _passing(before: ChainState, after: ChainState, bottom: float) -> ChainState:
    """Interpolate the state at which the lower end passes the height `bottom` [m]."""
    high, low = float(before.node[-1, 2]), float(after.node[-1, 2])
    share = (high - bottom) / (high - low)
    return ChainState(
        time=before.time + share * (after.time - before.time),
        node=before.node + share * (after.node - before.node),
        tension=before.tension + share * (after.tension - before.tension),
        velocity=after.velocity,
    )


def _stepped(mover: Mover, state: ChainState, step: float, depth: float) -> ChainState:
    shortest = _SHORTEST * depth
    extrapolations = (False, True) if state.velocity.any() else (True,)
    while step > shortest:
        for gently in extrapolations:
            with suppress(NoStep):
                return mover.stepped(state, step, gently)
        step *= 0.4
    raise Status.NOT_CONVERGED.because(
        f"The fall of the line could not be computed beyond {state.time:.1f} s after its release."
    )


def _settled(mover: Mover, state: ChainState, step: float) -> tuple[ChainState, ...]:
    """Return the states until the line is at rest."""
    depth = mover.sea.water.depth
    states = [state]
    for _ in range(_FALLS + 1):
        length, moved = step, 0.0
        while length < MAX_STEP:
            after = _stepped(mover, states[-1], length, depth)
            moved = float(np.abs(after.node - states[-1].node).max())
            length = _REST_GROWTH * (after.time - states[-1].time)
            if moved < UNMOVED * depth:
                length = max(length, MAX_STEP / _REST_GROWTH)
            states.append(after)
        if moved > AT_REST * depth:
            raise Status.NOT_CONVERGED.because("The line does not settle on the seabed.")
        # long steps can leave a bar balanced upright on its lower end, under compression
        laid = _laid_down(mover, states[-1])
        if laid is None:
            break
        states[-1] = laid
    return tuple(states)


def _laid_down(mover: Mover, state: ChainState) -> ChainState | None:
    """Align bars under compression with the nearest bar above them that is under tension.

    Return None if no bar is under compression.
    """
    pushed = state.tension < -LEAST_COMPRESSION * mover.scale
    if not pushed.any() or pushed[0]:
        return None
    node, axis = state.node.copy(), np.zeros(3)
    for bar in range(len(pushed)):
        upward = state.node[bar] - state.node[bar + 1]
        if not pushed[bar]:
            axis = upward / np.linalg.norm(upward)
        else:
            node[: bar + 1] += np.linalg.norm(upward) * axis - upward
    return replace(state, node=node, velocity=np.zeros_like(node))


def _streamed(state: ChainState) -> float:
    return float(np.linalg.norm(state.node[0, :2] - state.node[-1, :2]))


def _slowed(mover: Mover, state: ChainState, streamed: float) -> ChainState:
    """Reduce the flow until the line streams over the distance `streamed` [m] behind the ship.

    Return the state of the line in this slower flow.
    """
    sea = mover.sea
    reach = float(mover.chain.length.sum())
    current = sea.water.current_at(np.zeros(()))
    whole = float(np.linalg.norm(current[:2]))

    def excess(share: float) -> float:
        nonlocal state
        water = replace(sea.water, u=share * sea.water.u, v=share * sea.water.v)
        slower = replace(mover, sea=replace(sea, water=water))
        state = _settled(slower, replace(state, time=0.0), 1e-3 * water.depth)[-1]
        return _streamed(state) - streamed

    # holding the free end closer in the full flow would bend the line as a rope does not bend
    share, least = 1.0, min(SLOWEST_FLOW / whole, 0.5)
    # halve the flow repeatedly, since a jump to a far slower flow may fold the line
    while excess(share := max(0.5 * share, least)) > 0.0:
        if share == least:
            raise UsageError(
                f"even behind a very slow ship the line extends {_streamed(state):.1f} m astern; a "
                f"distance of {streamed:g} m is not possible"
            )
    high = min(2.0 * share, 1.0)
    share, _, _ = bracketed_root(
        lambda _, x: excess(x), None, high, excess(high), share, excess(share), 0.0, 1e-7 * share
    )
    excess(share)
    if abs(_streamed(state) - streamed) > STREAMED_WITHIN * reach:
        raise Status.NOT_CONVERGED.because(
            f"The line does not extend {streamed:g} m astern at any speed of the ship."
        )
    return state


def _drawn(mover: Mover, state: ChainState, streamed: float) -> ChainState:
    """Pull the free end to a horizontal distance [m] from the lower end, and let the line settle.

    Return the settled state. `streamed` is the distance.
    """
    end = state.node[0, :2]
    here = float(np.linalg.norm(end))
    for share in np.linspace(0.0, 1.0, 21)[1:]:
        tether = end * (1.0 + share * (streamed / here - 1.0))
        state = _stepped(replace(mover, tether=tether), state, 10.0, mover.sea.water.depth)
    return _settled(replace(mover, tether=end * (streamed / here)), state, 10.0)[-1]
