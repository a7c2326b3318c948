"""An independent continuous solution of a mooring: the referee of CALM's march.

Nothing here is shared with the solver, which cuts cables into straight rods: cables are integrated
(`cables`), rigid pieces turn until no moment is left (`rods`). Pieces that do not float, listed
above the first float, make one rod with it. A line that lands comes down level on the seabed below
its last float, and what is left of it lies there along its pull, out of the current, without
friction.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace

import numpy as np

from calm.physics.line import Line, Water
from tests.validation.cables import Cable, NoContinuousSolution, follow
from tests.validation.loads import DOWN, Load, Profile, Vector
from tests.validation.rods import rod_axis


@dataclass
class Shape:
    """A line marched down from its free end: n pieces and m clamps, positions and forces above.

    x and y count from the free end. `depths` are those of the points visited above the seabed,
    the extremes among them; `slackest` is the least tension inside a cable, but for the bare end
    of one; `grounded` is the unstretched length on the seabed, None for a line that does not land.
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

    def shifted(self, by: Vector) -> Shape:
        """The same shape elsewhere: `by` (2,) added to every x, y [m]."""
        move = np.array([by[0], by[1], 0.0])
        top, bottom, clamp = self.top + move, self.bottom + move, self.clamp + move
        return replace(self, top=top, bottom=bottom, clamp=clamp)


@dataclass
class Place:
    """Where a march has come to: position, force above, and whether it lies on the seabed."""

    position: Vector
    force: Vector
    lying: bool = False

    def pass_load(self, pull: Vector, lands: bool) -> None:
        """Take up a load; one that a landing line no longer carries rests on the seabed."""
        carried, self.force = self.force[2], self.force + pull
        if lands and carried > 0.0 >= self.force[2]:
            self.lie_down()

    def lie_down(self) -> None:
        """Leave the water: what the vertical force does not carry, the seabed does."""
        self.force = self.force * [1.0, 1.0, 0.0]
        self.lying = True

    def along_seabed(self, length: float) -> None:
        """Go along the seabed against the pull [m]."""
        pull = float(np.linalg.norm(self.force))
        if pull == 0.0:
            raise NoContinuousSolution("nothing pulls the line straight on the seabed")
        self.position = self.position - length * self.force / pull


class March:
    """Goes down one line in one water; `tolerance` is the relative error of a step."""

    def __init__(self, line: Line, water: Water, tolerance: float) -> None:
        self.line, self.profile, self.tolerance = line, Profile(water), tolerance
        self.gravity, self.depth = float(water.gravity), float(water.depth)
        self.head = head(line)
        self.clamps = [
            sorted(np.flatnonzero(line.clamp_piece == piece), key=lambda c: line.clamp_at[c])
            for piece in range(len(line.length))
        ]
        self.lowest_lift = lowest_lift(line)

    def down(
        self, depth: float, share: Vector, until: int | None = None, lands: bool = False
    ) -> Shape:
        """The shape with the free end at `depth` and the part `share` (n,) of each buoyancy.

        It is left blank below the top of the piece `until`. It may come down level and lie on the
        seabed, wherever that is, if it `lands`.
        """
        n, m = len(self.line.length), len(self.line.clamp_piece)
        shape = Shape(*(np.zeros((k, 3)) for k in (n, n, n, n, m, m, m)))
        place = Place(np.array([0.0, 0.0, -depth]), np.zeros(3))
        shape.depths.append(depth)
        piece = 0
        while piece < (n if until is None else until):
            if self.line.flexible[piece]:
                self._cable(piece, place, share, shape, lands)
                piece += 1
            else:
                rod = range(piece, self.head if piece == 0 else piece + 1)
                self._rod(rod, place, share, shape, lands and (piece, 0.0) > self.lowest_lift)
                piece = rod.stop
            shape.depths.append(-float(place.position[2]))
        if place.lying and shape.grounded is None:
            shape.grounded = 0.0
        return shape

    def _load(self, piece: int, share: Vector) -> Load:
        line, part = self.line, float(share[piece])
        return Load(
            part * float(line.buoyancy[piece]), part * float(line.volume[piece]),
            float(line.normal_drag[piece]), float(line.tangential_drag[piece]),
            bool(line.directional[piece]), self.gravity,
        )  # fmt: skip

    def _clamp(self, clamp: int) -> Load:
        line, drag = self.line, float(self.line.clamp_drag[clamp])
        buoyancy, volume = float(line.clamp_buoyancy[clamp]), float(line.clamp_volume[clamp])
        return Load(buoyancy, volume, drag, drag, False, self.gravity)

    def _rod(self, rod: range, place: Place, share: Vector, shape: Shape, lands: bool) -> None:
        line, origin = self.line, place.position
        length = float(line.length[rod].sum())
        tops = np.cumsum(line.length[rod]) - line.length[rod]
        loads: list[tuple[int, int, float, Load]] = []  # piece, clamp or -1, distance, load
        for piece, top in zip(rod, tops, strict=True):
            middle = float(top + line.length[piece] / 2.0)
            loads.append((piece, -1, middle, self._load(piece, share)))
            for c in self.clamps[piece]:
                loads.append((piece, c, float(top + line.clamp_at[c]), self._clamp(c)))
        loads.sort(key=lambda entry: entry[:1] + entry[2:3])
        if place.lying:
            axis: Vector | None = -place.force / np.linalg.norm(place.force)
            shape.grounded = (shape.grounded or 0.0) + length
        else:
            on_it = [(at, load) for _, _, at, load in loads]
            axis = rod_axis(on_it, length, origin, place.force, self.profile)
        if axis is None:
            raise NoContinuousSolution("a rigid piece finds no balance of moments")
        for piece, top in zip(rod, tops, strict=True):
            shape.top[piece], shape.force_top[piece] = origin + top * axis, place.force
            for _, c, at, load in (entry for entry in loads if entry[0] == piece):
                point, above = origin + at * axis, place.force
                if not place.lying:
                    pull = load.force(self.profile.at(-float(point[2])), axis)
                    place.pass_load(pull, lands)
                if c >= 0:
                    shape.clamp[c] = point
                    shape.clamp_above[c], shape.clamp_below[c] = above, place.force
            place.position = origin + (top + line.length[piece]) * axis
            shape.bottom[piece], shape.force_bottom[piece] = place.position, place.force

    def _cable(self, piece: int, place: Place, share: Vector, shape: Shape, lands: bool) -> None:
        line, load = self.line, self._load(piece, share)
        shape.top[piece], shape.force_top[piece] = place.position, place.force
        s = 0.0
        for c in [*self.clamps[piece], None]:
            at = float(line.length[piece] if c is None else line.clamp_at[c])
            may_land = lands and (piece, s) >= self.lowest_lift
            self._stretch(piece, load, at - s, place, shape, may_land)
            s = at
            if c is None:
                continue
            shape.clamp[c], shape.clamp_above[c] = place.position, place.force
            if not place.lying:
                pull = self._clamp(c).force(self.profile.at(-float(place.position[2])), DOWN)
                place.pass_load(pull, lands and (piece, at) > self.lowest_lift)
            shape.clamp_below[c] = place.force
        shape.bottom[piece], shape.force_bottom[piece] = place.position, place.force

    def _stretch(
        self, piece: int, load: Load, length: float, place: Place, shape: Shape, lands: bool
    ) -> None:
        """Along a stretch of cable without clamps, in the water and then on the seabed."""
        compliance, thinning = float(self.line.compliance[piece]), float(self.line.thinning[piece])
        if not place.lying and length > 0.0:
            cable = Cable(load, length, compliance, thinning)
            way = follow(cable, place.position, place.force, self.profile, self.tolerance, lands)
            place.position, place.force = way.position, way.force
            shape.depths += way.depths
            shape.slackest = min(shape.slackest, way.slackest)
            length -= way.length
            if length > 0.0:
                place.lie_down()
        if place.lying:
            strain = compliance * float(np.linalg.norm(place.force))
            shape.grounded = (shape.grounded or 0.0) + length
            place.along_seabed(length * (1.0 + strain))


def head(line: Line) -> int:
    """How many pieces from the free end on are one rod: up to the first float if all are rigid."""
    for piece, flexible in enumerate(line.flexible):
        if flexible:
            break
        if line.buoyancy[piece] > 0.0:
            return piece + 1
    return 1


def lowest_lift(line: Line) -> tuple[int, float]:
    """The lowest thing that lifts: its piece, and how far down that piece it ends [m]."""
    lifting = [(int(piece), np.inf) for piece in np.flatnonzero(line.buoyancy > 0.0)]
    for clamp in np.flatnonzero(line.clamp_buoyancy > 0.0):
        lifting.append((int(line.clamp_piece[clamp]), float(line.clamp_at[clamp])))
    return max(lifting, default=(-1, 0.0))
