"""An independent continuous solution of a mooring: the referee of CALM's march.

Nothing here is shared with the solver, which cuts cables into straight rods: cables are integrated
(`cables`), rigid pieces turn until no moment is left (`rods`). Pieces that do not float, listed
above the first float, make one rod with it. A line that lands comes down level on the seabed below
its last float, and what is left of it lies there along its pull, out of the current; friction
takes its share of what presses on the seabed from the pull, until nothing is left of that.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from itertools import pairwise

import numpy as np
from scipy.integrate import quad

from calm.physics.line import Line, Water
from tests.validation.cables import Cable, Folded, NoContinuousSolution, Path, follow
from tests.validation.loads import DOWN, Load, Profile, Vector, on_clamp, on_piece
from tests.validation.rods import rod_axis
from tests.validation.ropes import strain_law

Key = tuple[int, float, int]


@dataclass
class Shape:
    """A line marched down from its free end: n pieces and m clamps, positions and forces above.

    x and y count from the free end. `depths` are those of the points visited above the seabed,
    the extremes among them; `slackest` is the least tension inside a cable, but for the bare end
    of one; `grounded` is the unstretched length on the seabed, None for a line that does not land.
    `paths` lead down the hanging cables, where they are kept: piece, from where on it, and `Path`.
    """

    top: Vector
    bottom: Vector
    force_top: Vector
    force_bottom: Vector
    clamp: Vector
    clamp_above: Vector
    clamp_below: Vector
    depths: list[float] = field(default_factory=list)
    slackest: float = np.inf
    grounded: float | None = None
    paths: list[tuple[int, float, Path]] = field(default_factory=list)
    offset: Vector = field(default_factory=lambda: np.zeros(3))

    def shifted(self, by: Vector) -> Shape:
        """The same shape elsewhere: `by` (2,) added to every x, y [m]."""
        move = np.array([by[0], by[1], 0.0])
        top, bottom, clamp = self.top + move, self.bottom + move, self.clamp + move
        return replace(self, top=top, bottom=bottom, clamp=clamp, offset=self.offset + move)

    def inside(self, piece: int, s: Vector) -> Vector:
        """Place [m] and force above [N] (k, 6) at unstretched lengths (k,) down a hanging cable.

        NaN where it lies on the seabed.
        """
        found = np.full((len(s), 6), np.nan)
        for owner, start, (first, last, path) in self.paths:
            here = (s >= start + first) & (s <= start + last)
            if owner == piece and here.any():
                found[here] = path(s[here] - start).T
        found[:, :3] += self.offset
        return found


@dataclass
class Place:
    """Where a march has come to: position, force above, and whether it lies on the seabed."""

    position: Vector
    force: Vector
    lying: bool = False
    way: Vector | None = None

    def lie_down(self) -> None:
        """Leave the water: what the vertical force does not carry, the seabed does."""
        self.force = self.force * [1.0, 1.0, 0.0]
        self.lying = True

    def direction_on_seabed(self) -> Vector:
        """The unit vector along the seabed, against the pull."""
        if self.way is None:
            pull = float(np.linalg.norm(self.force))
            if pull == 0.0:
                raise Folded("nothing pulls the line straight on the seabed")
            self.way = -self.force / pull
        return self.way

    def hold_back(self, friction: float) -> None:
        """Leave what a friction does not hold of the pull [N]."""
        pull = float(np.linalg.norm(self.force))
        self.force = -max(pull - friction, 0.0) * self.direction_on_seabed()


class March:
    """Goes down one line in one water; `tolerance` is the relative error of a step.

    The `frequency` [Hz] is that of a line that strums, the `friction` that on the seabed.
    """

    def __init__(self, line: Line, water: Water, tolerance: float, friction: float = 0.0) -> None:
        self.line, self.profile, self.tolerance = line, Profile(water), tolerance
        self.friction, self.keeps_paths = friction, False
        self.frequency = 0.0
        self.gravity, self.depth = float(water.gravity), float(water.depth)
        self.head = head(line)
        self.clamps = [
            sorted(np.flatnonzero(line.clamp_piece == piece), key=lambda c: line.clamp_at[c])
            for piece in range(len(line.length))
        ]
        self.lowest_lift = lowest_lift(line, self.clamps)

    def kept(
        self, depth: float, share: Vector, lands: bool = False, pull: Vector | None = None
    ) -> Shape:
        """The shape, with the paths of its cables."""
        self.keeps_paths = True
        shape = self.down(depth, share, lands=lands, pull=pull)
        self.keeps_paths = False
        return shape

    def down(
        self, depth: float, share: Vector, until: int | None = None, lands: bool = False,
        pull: Vector | None = None,
    ) -> Shape:  # fmt: skip
        """The shape with the free end at `depth` and the part `share` (n,) of each buoyancy.

        It is left blank below the top of the piece `until`. It may come down level and lie on the
        seabed, wherever that is, if it `lands`. One that begins at no free end has a `pull` there.
        """
        n, m = len(self.line.length), len(self.line.clamp_piece)
        shape = Shape(*(np.zeros((k, 3)) for k in (n, n, n, n, m, m, m)))
        place = Place(np.array([0.0, 0.0, -depth]), np.zeros(3) if pull is None else pull)
        shape.depths.append(depth)
        piece = 0
        while piece < (n if until is None else until):
            if self.line.flexible[piece]:
                self._cable(piece, place, share, shape, lands)
                piece += 1
            else:
                rod = range(piece, self.head if piece == 0 else piece + 1)
                shape.force_top[piece] = place.force
                self._rod(rod, place, share, shape, lands and (piece, 0.0, 0) > self.lowest_lift)
                piece = rod.stop
            shape.depths.append(-float(place.position[2]))
        if place.lying and shape.grounded is None:
            shape.grounded = 0.0
        return shape

    def _load(self, piece: int, share: Vector) -> Load:
        return on_piece(self.line, piece, self.gravity, float(share[piece]), self.frequency)

    def _clamp(self, clamp: int) -> Load:
        return on_clamp(self.line, clamp, self.gravity)

    def _pressing(self, load: Load) -> float:
        """Friction of what lies on the seabed [N], or of a metre of it."""
        density = self.profile.at(self.depth)[3]
        return -self.friction * float(load.force((0.0, 0.0, 0.0, density), DOWN)[2])

    def _on_rod(self, rod: range, share: Vector) -> list[tuple[int, int, float, Load]]:
        """What loads a rod, downwards: piece, clamp or -1, distance from its upper end, load."""
        loads, top = [], 0.0
        for piece in rod:
            length = float(self.line.length[piece])
            here = [(piece, -1, top + length / 2.0, self._load(piece, share))]
            for c in self.clamps[piece]:
                here.append((piece, c, top + float(self.line.clamp_at[c]), self._clamp(c)))
            loads += sorted(here, key=lambda entry: entry[2])
            top += length
        return loads

    def _rod(self, rod: range, place: Place, share: Vector, shape: Shape, lands: bool) -> None:
        loads, origin, profile = self._on_rod(rod, share), place.position, self.profile
        length, in_environments = float(self.line.length[rod].sum()), False
        if not place.lying:
            on_it = [(at, load) for _, _, at, load in loads]
            axis = rod_axis(on_it, length, origin, place.force, profile)
            if axis is None:
                raise NoContinuousSolution("a rigid piece finds no balance of moments")
            depths = [-float(origin[2] + at * axis[2]) for at, _ in on_it]
            pulls = [
                load.force(profile.at(depth), axis)
                for depth, (_, load) in zip(depths, on_it, strict=True)
            ]
            rests = lands and place.force[2] > 0.0 >= (place.force + np.sum(pulls, axis=0))[2]
            in_environments = bool(rests and axis[2] < 0.0)
            if rests and not in_environments:
                place.lie_down()  # it would tip over
        if place.lying:
            axis, pulls = place.direction_on_seabed(), []
            shape.grounded = (shape.grounded or 0.0) + length
        for i, (piece, c, at, load) in enumerate(loads):
            above = place.force
            if place.lying:
                place.hold_back(self._pressing(load))
            else:
                place.force = above + pulls[i]
            if c >= 0:
                shape.clamp[c] = origin + at * axis
                shape.clamp_above[c], shape.clamp_below[c] = above, place.force
            shape.force_bottom[piece] = place.force
        for piece in rod:
            shape.top[piece] = place.position
            place.position = place.position + float(self.line.length[piece]) * axis
            shape.bottom[piece] = place.position
        if in_environments:
            place.lie_down()
            shape.force_bottom[rod[-1]] = place.force
        for piece in rod[1:]:
            shape.force_top[piece] = shape.force_bottom[piece - 1]

    def _cable(self, piece: int, place: Place, share: Vector, shape: Shape, lands: bool) -> None:
        line, load = self.line, self._load(piece, share)
        shape.top[piece], shape.force_top[piece] = place.position, place.force
        s = 0.0
        for i, c in enumerate(self.clamps[piece], start=1):
            at = float(line.clamp_at[c])
            self._stretch(piece, load, s, at, place, shape, lands)
            s = at
            shape.clamp[c], shape.clamp_above[c] = place.position, place.force
            if not place.lying:
                pull = self._clamp(c).force(self.profile.at(-float(place.position[2])), DOWN)
                carried, place.force = place.force[2], place.force + pull
                may_land = lands and (piece, at, i) > self.lowest_lift
                if may_land and carried > 0.0 >= place.force[2]:
                    place.lie_down()
            else:
                place.hold_back(self._pressing(self._clamp(c)))
            shape.clamp_below[c] = place.force
        self._stretch(piece, load, s, float(line.length[piece]), place, shape, lands)
        shape.bottom[piece], shape.force_bottom[piece] = place.position, place.force

    def _stretch(
        self, piece: int, load: Load, start: float, end: float, place: Place, shape: Shape,
        lands: bool,
    ) -> None:  # fmt: skip
        """Along a stretch of cable without clamps, in the water and then on the seabed."""
        strain, thinning = strain_law(self.line, piece), float(self.line.thinning[piece])
        length = end - start
        if not place.lying and length > 0.0:
            cable = Cable(load, length, strain, thinning)
            may_land = lands and (piece, end, 0) > self.lowest_lift
            way = follow(
                cable, place.position, place.force, self.profile, self.tolerance, may_land,
                self.keeps_paths,
            )  # fmt: skip
            shape.paths += [(piece, start, path) for path in way.paths]
            place.position, place.force = way.position, way.force
            shape.depths += way.depths
            shape.slackest = min(shape.slackest, way.slackest)
            length -= way.length
            if length > 0.0:
                place.lie_down()
        if place.lying:
            pull, held = float(np.linalg.norm(place.force)), self._pressing(load)
            pulled = min(length, pull / held) if held > 0.0 else length
            stretch, _ = quad(lambda s: strain(pull - s * held), 0.0, pulled, limit=200)
            long = length + stretch + (length - pulled) * strain(0.0)
            shape.grounded = (shape.grounded or 0.0) + length
            place.position = place.position + long * place.direction_on_seabed()
            place.hold_back(length * held)


def head(line: Line) -> int:
    """How many pieces from the free end on are one rod: up to the first float if all are rigid.

    Of a tow each is its own.
    """
    if line.towed:
        return 1
    for piece, flexible in enumerate(line.flexible):
        if flexible:
            break
        if line.buoyancy[piece] > 0.0:
            return piece + 1
    return 1


def lowest_lift(line: Line, clamps: list[list[int]]) -> Key:
    """The key of the lowest thing that lifts; below it the line may lie on the seabed.

    Keys go down the line: (piece, 0, 0) of a rigid piece; (piece, metres to its lower end, 0) of a
    stretch of cable between clamps; (piece, metres, count) of each clamp on it.
    """
    keys: list[Key] = [(-1, 0.0, 0)]
    for piece, flexible in enumerate(line.flexible):
        held = [(float(line.clamp_at[c]), float(line.clamp_buoyancy[c])) for c in clamps[piece]]
        if not flexible:
            if max([line.buoyancy[piece], *(lift for _, lift in held)]) > 0.0:
                keys.append((piece, 0.0, 0))
            continue
        keys += [(piece, at, i) for i, (at, lift) in enumerate(held, start=1) if lift > 0.0]
        ends = [at for at, _ in held] + [float(line.length[piece])]
        if line.buoyancy[piece] > 0.0:
            keys += [(piece, b, 0) for a, b in pairwise([0.0, *ends]) if b > a]
    return max(keys)
