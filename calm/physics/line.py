"""The line and the water as the march takes them: plain float64 arrays, checked on entry;
where a march stands, and the record it may leave.
"""

from __future__ import annotations

from dataclasses import dataclass, field, fields, replace
from functools import partial, wraps
from math import inf
from typing import TYPE_CHECKING, Any, NamedTuple, TypeVar

import numpy as np
from numpy.typing import NDArray

from calm.physics.compiled import within
from calm.physics.drag import Friction
from calm.physics.hull import Floating
from calm.physics.seawater import REFERENCE_VISCOSITY
from calm.physics.strumming import BourgetMarichal

if TYPE_CHECKING:
    from calm.physics.reynolds import DragCurve
    from calm.physics.stretch import ElongationCurve


class MarchError(ArithmeticError):
    """The march cannot go on: an element has no balance, or the line needs endless segments."""


State = tuple[float, float, float, float, float, float, float, int]
"""The point reached, x, y, z, fx, fy, fz, tz and level: its place [m], the force above it [N], the
last axis's rise, the interval of the water. A bare tuple: in CPython a named one costs as much as
half of a segment's balance."""

GOES_ON, RUNS_OFF, SEGMENT_UNBALANCED, ROD_UNBALANCED, ENDLESS, NO_ROOM = range(6)
"""Whether a march can go on, or why it cannot."""
FAILURES = (
    "",
    "the line runs off to infinity",
    "a segment finds no balance",
    "a rigid piece finds no balance",
    "the line would need more than 50000 segments",
    "there is no room for so many segments",
)
"""The same in words."""
NO_BALANCE = -2.0
"""In place of the strain of a segment, or of the rise of a rod, that finds no balance."""


class Bed(NamedTuple):
    """The seabed below an anchor, as a plane, and how it holds a line that lies on it.

    Attributes
    ----------
    east, north : how much deeper it is per metre [-]
    friction : along a line that lies there [-]
    excess : what a displaced cubic metre lifts more there than in reference water [N/m³]
    """

    east: float
    north: float
    friction: float
    excess: float


@within
def off_bed(bed: Bed, x: float, y: float, z: float) -> float:
    """Height of a place above the plane through another, by the way from there; of a force, what
    it has across the plane, times √(1 + tan² slope)."""
    return z + bed.east * x + bed.north * y


@within
def along_bed(bed: Bed, x: float, y: float, z: float) -> tuple[float, float, float]:
    """A force without what it has across the plane."""
    across = off_bed(bed, x, y, z) / (1.0 + bed.east * bed.east + bed.north * bed.north)
    x, y = x - across * bed.east, y - across * bed.north
    return x, y, 0.0 - bed.east * x - bed.north * y


Record = Any
"""Columns of numbers, as written by `write_node`: lists, or the rows of an array."""
COLUMNS = 17
SEGMENT, BETTER = 10, 11
"""Column of how an element ends, see below, and the first of six with extrapolated places and
forces."""
NO_SEGMENT, ENDS, HALVES, SPLITS = range(4)
"""An element is no part of a hanging segment; it ends one; it ends in the middle of a part that is
passed in two halves; it ends at a level that splits one."""


@within
def write_node(record: Record, n: int, state: State) -> None:
    """Write node n: the place [m] and the force above it [N] of a state."""
    x, y, z, fx, fy, fz, _, _ = state
    record[0][n] = x
    record[1][n] = y
    record[2][n] = z
    record[3][n] = fx
    record[4][n] = fy
    record[5][n] = fz


@within
def write_element(
    record: Record, n: int, piece: int, clamp: int, cut: float, strain: float
) -> None:
    """Write the element that ends at node n; `clamp` is -1 for a part of the piece."""
    record[6][n] = piece
    record[7][n] = clamp
    record[8][n] = cut
    record[9][n] = strain
    record[SEGMENT][n] = NO_SEGMENT


@dataclass(frozen=True)
class Trace:
    """Hold what a recorded march leaves: k + 1 nodes and the k elements between, free end first.

    Attributes
    ----------
    position : (k+1, 3) [m]
    force : (k+1, 3) above each node [N]
    piece, clamp : (k,) the piece of each element, and the clamp that it is or -1
    cut : (k,) unstretched length [m]
    strain : (k,) of cables and chains
    better : (k+1, 6) extrapolated place [m] and force [N] of each node, of a shape that was refined
    """

    position: Floats
    force: Floats
    piece: Integers
    clamp: Integers
    cut: Floats
    strain: Floats
    better: Floats

    @staticmethod
    def of(record: Record, nodes: int) -> Trace:
        """The trace of a record with so many nodes."""
        columns = np.array([column[:nodes] for column in record])
        return Trace(
            position=columns[:3].T.copy(),
            force=columns[3:6].T.copy(),
            piece=columns[6, 1:].astype(np.intp),
            clamp=columns[7, 1:].astype(np.intp),
            cut=columns[8, 1:],
            strain=columns[9, 1:],
            better=columns[BETTER : BETTER + 6].T,
        )


Floats = NDArray[np.float64]
Integers = NDArray[np.intp]
Booleans = NDArray[np.bool_]


class _Arrays:
    """A frozen dataclass of arrays, whose arguments `_of_arrays` converts."""

    @classmethod
    def completed(cls, given: dict[str, Any]) -> dict[str, Any]:
        """Return the arguments with those that depend on others, before they are converted."""
        return given

    def _same_length(self, *names: str) -> None:
        lengths = {name: len(getattr(self, name)) for name in names}
        if len(set(lengths.values())) > 1:
            raise ValueError(f"{type(self).__name__}: arrays differ in length: {lengths}")


_DTYPES: dict[str, Any] = {"Floats": np.float64, "Integers": np.intp, "Booleans": np.bool_}

_OfArrays = TypeVar("_OfArrays", bound=_Arrays)


def _of_arrays(made: type[_OfArrays]) -> type[_OfArrays]:
    """Have a dataclass take whatever numpy makes arrays of, each by the type of its field.

    ValueError: an array has a value that is not finite.
    """
    plain = made.__init__
    names = [column.name for column in fields(made)]  # type: ignore[arg-type]
    kinds = {
        column.name: _DTYPES[str(column.type)]
        for column in fields(made)  # type: ignore[arg-type]
        if column.type in _DTYPES
    }

    @wraps(plain)
    def converting(self: _OfArrays, *given: Any, **named: Any) -> None:
        arguments = made.completed(dict(zip(names, given, strict=False)) | named)
        for name, kind in kinds.items():
            if name in arguments:
                arguments[name] = _frozen(arguments[name], kind, f"{made.__name__}.{name}")
        plain(self, **arguments)

    made.__init__ = converting  # type: ignore[method-assign,assignment]
    return made


def _frozen(value: Any, kind: Any, name: str) -> NDArray[Any]:
    """Return a value as an array of a type; one that is frozen already, as it is."""
    if type(value) is np.ndarray and not value.flags.writeable and value.dtype == kind:
        return value
    array = np.array(value, dtype=kind, ndmin=1)
    if not np.isfinite(array).all():
        raise ValueError(f"{name} must be finite")
    array.setflags(write=False)
    return array


def _none() -> Floats:
    return _frozen((), np.float64, "")


def _one(value: float) -> Floats:
    return _frozen(value, np.float64, "")


_ZERO_BY_DEFAULT = {
    "length": ("lift", "diameter", "push_east", "push_north"),
    "clamp_at": ("clamp_lift",),
}
"""Columns that are zeros if not given, by the column that is as long."""

_CURVES = ("elongation", "drag_curve", "clamp_drag_curve")


@_of_arrays
@dataclass(frozen=True)
class Line(_Arrays):
    """The n pieces of a line and the m instruments clamped on them.

    Those of a mooring stand above the anchor, free end first; those of a tow reach from the ship
    to the towed body.

    Buoyancies and drags are those in sea water of 1025 kg/m³. Where a piece is `flexible`
    (cable, chain) its `buoyancy`, `volume` and drags are per unstretched metre.

    Attributes
    ----------
    length : (n,) unstretched length [m]
    flexible : (n,) cable or chain, cut into segments; else one rigid element
    buoyancy : (n,) net force in water, + up [N or N/m]
    volume : (n,) displaced volume that follows the water's density [m³ or m³/m]; 0 where unknown
    normal_drag, tangential_drag : (n,) Kn and Kt [N/(m/s)², per metre where flexible]
    directional : (n,) False where the drag is Kn|V|V whatever the axis
    compliance : (n,) 1/EA [1/N]; 0 where inextensible
    thinning : (n,) drag per unstretched metre grows by (1 + strain)**thinning: 1/2 where the
        volume is conserved (cables), 0 where only the length grows (chains)
    clamp_piece : (m,) index of the piece a clamp sits on
    clamp_at : (m,) distance from that piece's top along its unstretched length [m]
    clamp_buoyancy, clamp_volume, clamp_drag : (m,) [N], [m³], K of K|V|V [N/(m/s)²]
    anchor_height : the line ends this far above the seabed [m]
    lift, clamp_lift : (n,), (m,) upward force of bodies at 1 m/s [N/(m/s)²]; 0 where not given
    diameter : (n,) of cables and chains [m]; 0 where not given, and then nothing strums
    friction : the law of `tangential_drag` on cables and chains
    strumming : of the cables, whose `normal_drag` then is that at rest; None without
    towed : whether the free end is towed: then no pieces there are rigid with one another
    push_east, push_north : (n,) force of the wind on a piece [N]; 0 where not given
    floating : how the first float rides when it is at the surface; None leaves it just below
    elongation : (n,) of cables that stretch by a table, whose `compliance` is not used; None for
        the others, and nothing, (), where no cable does
    drag_curve, clamp_drag_curve : (n,), (m,) how the normal drag of a smooth sphere or cylinder
        goes with the Reynolds number; None for the others, and (), where none does
    """

    length: Floats
    flexible: Booleans
    buoyancy: Floats
    volume: Floats
    normal_drag: Floats
    tangential_drag: Floats
    directional: Booleans
    compliance: Floats
    thinning: Floats
    clamp_piece: Integers
    clamp_at: Floats
    clamp_buoyancy: Floats
    clamp_volume: Floats
    clamp_drag: Floats
    anchor_height: float = 0.0
    lift: Floats = field(default_factory=_none)
    clamp_lift: Floats = field(default_factory=_none)
    diameter: Floats = field(default_factory=_none)
    friction: Friction = Friction.BERTEAUX
    strumming: BourgetMarichal | None = None
    towed: bool = False
    push_east: Floats = field(default_factory=_none)
    push_north: Floats = field(default_factory=_none)
    floating: Floating | None = None
    elongation: tuple[ElongationCurve | None, ...] = ()
    drag_curve: tuple[DragCurve | None, ...] = ()
    clamp_drag_curve: tuple[DragCurve | None, ...] = ()

    @classmethod
    def completed(cls, given: dict[str, Any]) -> dict[str, Any]:
        """Return the arguments with zeros for forces and diameters that are not given."""
        absent = {
            name: np.zeros(np.size(given.get(like, ())))
            for like, names in _ZERO_BY_DEFAULT.items()
            for name in names
            if not np.size(given.get(name, ()))
        }
        return given | absent

    def __post_init__(self) -> None:
        self._same_length(
            "length", "flexible", "buoyancy", "volume", "normal_drag", "tangential_drag",
            "directional", "compliance", "thinning", "lift", "diameter",
            "push_east", "push_north",
        )  # fmt: skip
        self._same_length(
            "clamp_piece", "clamp_at", "clamp_buoyancy", "clamp_volume", "clamp_drag", "clamp_lift"
        )
        for name in _CURVES:
            if getattr(self, name):
                self._same_length(name, "clamp_at" if name.startswith("clamp_") else "length")
        for name in (
            "length", "normal_drag", "tangential_drag", "compliance", "clamp_drag", "diameter",
        ):  # fmt: skip
            if (getattr(self, name) < 0).any():
                raise ValueError(f"Line.{name} must not be negative")
        on = self.clamp_piece
        if ((on < 0) | (on >= len(self.length))).any() or (self.clamp_at < 0).any():
            raise ValueError("Line: a clamp sits on no piece")
        if not 0.0 <= self.anchor_height < inf:
            raise ValueError("Line.anchor_height must be finite and not negative")

    @property
    def total_buoyancy(self) -> Floats:
        """(n,) net force of each whole piece with its clamps in reference water [N]."""
        return self.net_force(np.zeros(len(self.length)))

    def net_force(self, excess: Floats) -> Floats:
        """(n,) net force of each whole piece with its clamps [N].

        Parameters
        ----------
        excess : (n,) what a displaced cubic metre lifts more than in reference water [N/m³]
        """
        whole = np.where(self.flexible, self.length, 1.0)
        total: Floats = (self.buoyancy + excess * self.volume) * whole
        on = self.clamp_piece
        np.add.at(total, on, self.clamp_buoyancy + excess[on] * self.clamp_volume)
        return total

    def with_length(self, piece: int, length: float) -> Line:
        """Return the same line with one piece cut to another unstretched length [m]."""
        lengths = self.length.copy()
        lengths[piece] = length
        return replace(self, length=lengths)

    @property
    def _of_pieces(self) -> dict[str, Any]:
        """Return what it holds of every piece."""
        return {
            column.name: getattr(self, column.name)
            for column in fields(self)
            if (column.type in _DTYPES or column.name in _CURVES)
            and not column.name.startswith("clamp_")
        }

    def below_a_point(self) -> Line:
        """Return the same line below a piece without length, weight and drag, to be pulled at."""
        columns: dict[str, Any] = {
            name: np.append(np.zeros(1, column.dtype), column)
            if isinstance(column, np.ndarray)
            else column and (None, *column)
            for name, column in self._of_pieces.items()
        }
        return replace(self, **columns, clamp_piece=self.clamp_piece + 1)

    def reversed(self) -> Line:
        """Return the same line from its other end, from where its clamps are measured then."""
        on = self.clamp_piece
        return replace(
            self,
            **{name: column[::-1] for name, column in self._of_pieces.items()},
            clamp_piece=len(self.length) - 1 - on,
            clamp_at=np.maximum(self.length[on] - self.clamp_at, 0.0),
        )


@_of_arrays
@dataclass(frozen=True)
class Water(_Arrays):
    """The sea: depth, and current and density by level.

    Attributes
    ----------
    depth : water depth [m]; inf where the seabed is out of reach (of a tow)
    level : (k,) depths of the levels [m], strictly increasing, k ≥ 1
    u, v, w : (k,) current to the east, to the north, upward [m/s]
    density : (k,) [kg/m³]
    gravity : [m/s²]
    deeper_east, deeper_north : how much deeper the seabed is per metre from the anchor [-]
    viscosity_level, viscosity : (j,), (j,) depths [m], strictly increasing, and the kinematic
        viscosity at them [m²/s], for drags that go with the Reynolds number

    Between levels everything is linear in depth; above the first and below the last it is constant.
    """

    depth: float
    level: Floats
    u: Floats
    v: Floats
    w: Floats
    density: Floats
    gravity: float = 9.80665
    viscosity_level: Floats = field(default_factory=partial(_one, 0.0))
    viscosity: Floats = field(default_factory=partial(_one, REFERENCE_VISCOSITY))
    deeper_east: float = 0.0
    deeper_north: float = 0.0

    def __post_init__(self) -> None:
        self._same_length("level", "u", "v", "w", "density")
        self._same_length("viscosity_level", "viscosity")
        if not (self.depth > 0.0 and 0.0 < self.gravity < inf):
            raise ValueError("Water: depth and gravity must be positive")
        if (self.density <= 0).any() or (self.viscosity <= 0).any():
            raise ValueError("Water: densities and viscosities must be positive")
        if (np.diff(self.level) <= 0).any() or (np.diff(self.viscosity_level) <= 0).any():
            raise ValueError("Water: levels must rise")

    @property
    def moving(self) -> bool:
        """Return whether there is any current at all."""
        return bool(self.u.any() or self.v.any() or self.w.any())

    def still(self) -> Water:
        """Return the same water without current."""
        return replace(self, u=(zero := np.zeros_like(self.u)), v=zero, w=zero)

    def current_at(self, depth: Floats) -> Floats:
        """Current (..., 3) [m/s] at depths of any shape [m]."""
        return np.stack([np.interp(depth, self.level, c) for c in (self.u, self.v, self.w)], -1)

    def density_at(self, depth: Floats) -> Floats:
        """Density (...) [kg/m³] at depths of any shape [m]."""
        return np.interp(depth, self.level, self.density)

    def viscosity_at(self, depth: Floats) -> Floats:
        """Kinematic viscosity (...) [m²/s] at depths of any shape [m]."""
        return np.interp(depth, self.viscosity_level, self.viscosity)
