"""Input, state and record of a march, the integration down a line.

The input is a line and the water, as float64 arrays that are checked on construction.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field, fields, replace
from functools import cached_property, partial, wraps
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
    """Raised if a march cannot continue.

    The reason is an element out of balance, a line that extends without limit, or a line that needs
    too many segments.
    """


# a bare tuple, because creating a named tuple takes half as long as the balance of a segment
State = tuple[float, float, float, float, float, float, float, int]
"""State of a march (x, y, z, fx, fy, fz, tz, level): position [m], force above this position [N],
vertical component of the last axis, and interval of the water profile.
"""

GOES_ON, RUNS_OFF, SEGMENT_UNBALANCED, ROD_UNBALANCED, ENDLESS, NO_ROOM = range(6)
"""Outcomes of a march: the march can continue (GOES_ON), or the reason why the march stopped."""
FAILURES = (
    "",
    "the line extends without limit",
    "the forces on a segment do not balance",
    "the moments on a rigid piece do not balance",
    "the line would need more than 50000 segments",
    "the line needs more segments than the solver can hold",
)
"""Description of each outcome of a march."""
NO_BALANCE = -2.0
"""Value of a segment's strain, or of the vertical component of a rod's axis, without balance."""


class Bed(NamedTuple):
    """Plane seabed at an anchor, with the friction on a line that lies on the seabed.

    Attributes
    ----------
    east, north : increase in depth per metre to the east and north [-]
    friction : friction coefficient between line and seabed [-]
    excess : buoyancy per displaced volume, minus the value in reference water [N/m³]
    """

    east: float
    north: float
    friction: float
    excess: float


def off_bed(bed: Bed, x: float, y: float, z: float) -> float:
    """Return the height of a point above the seabed plane.

    x, y, z are relative to any point on the plane. If x, y, z is a force, the result is the normal
    component of the force, multiplied by √(1 + tan² slope).
    """
    return z + bed.east * x + bed.north * y


@within
def along_bed(bed: Bed, x: float, y: float, z: float) -> tuple[float, float, float]:
    """Return the component of a force parallel to the seabed plane."""
    across = off_bed(bed, x, y, z) / (1.0 + bed.east * bed.east + bed.north * bed.north)
    x, y = x - across * bed.east, y - across * bed.north
    return x, y, 0.0 - bed.east * x - bed.north * y


Record = Any
"""Record of a march: columns of numbers written by `write_node`, as lists or as rows of an
array.
"""
COLUMNS = 17
SEGMENT, BETTER = 10, 11
"""Columns of a record.

- SEGMENT: kind of an element's end, `NO_SEGMENT` to `SPLITS`
- BETTER: first of six columns with extrapolated positions and forces
"""
NO_SEGMENT, ENDS, HALVES, SPLITS = range(4)
"""Kinds of an element's lower end.

- NO_SEGMENT: the element is rigid, is a clamp, or lies on the seabed
- ENDS: end of a cable segment
- HALVES: middle of a part of a segment that is marched in two halves
- SPLITS: level of the water profile that splits a segment
"""


def write_node(record: Record, n: int, state: State) -> None:
    """Write position [m] and force above the position [N] of a state to node n of a record."""
    x, y, z, fx, fy, fz, _, _ = state
    record[0][n] = x
    record[1][n] = y
    record[2][n] = z
    record[3][n] = fx
    record[4][n] = fy
    record[5][n] = fz


def write_element(
    record: Record, n: int, piece: int, clamp: int, cut: float, strain: float
) -> None:
    """Write the element that ends at node n to a record.

    `clamp` is the index of the clamped instrument, or -1 if the element is a part of the piece.
    """
    record[6][n] = piece
    record[7][n] = clamp
    record[8][n] = cut
    record[9][n] = strain
    record[SEGMENT][n] = NO_SEGMENT


@dataclass(frozen=True)
class Trace:
    """Recorded shape of a line: k + 1 nodes from the free end on, and k elements between them.

    Attributes
    ----------
    position, force : (k+1, 3) position of each node [m], and force above the node [N]
    piece : (k,) index of the piece to which each element belongs
    clamp : (k,) index of the clamp that each element represents; -1 for a part of the piece
    cut, strain : (k,) unstretched length [m] and strain of each element; strain 0 for rigid pieces
        and clamps
    better : (k+1, 6) extrapolated position [m] and force [N] of each node, if the shape was refined
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
        """Build the trace from the first `nodes` nodes of a record."""
        compiled = isinstance(record, np.ndarray)
        columns = record[:, :nodes].copy() if compiled else np.array([c[:nodes] for c in record])
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
    """Base class of frozen dataclasses whose array arguments are converted by `_of_arrays`."""

    @classmethod
    def completed(cls, given: dict[str, Any]) -> dict[str, Any]:
        """Add array fields that depend on other arguments, before conversion."""
        return given

    def __getstate__(self) -> dict[str, Any]:
        # without the values that `once_per_input` has stored in the object
        return {each.name: getattr(self, each.name) for each in fields(self)}  # type: ignore[arg-type]

    def _same_length(self, *names: str) -> None:
        lengths = {name: len(getattr(self, name)) for name in names}
        if len(set(lengths.values())) > 1:
            raise ValueError(f"{type(self).__name__}: arrays differ in length: {lengths}")


_Given = TypeVar("_Given", bound=_Arrays)
_Made = TypeVar("_Made")


def once_per_input(make: Callable[[_Given], _Made]) -> Callable[[_Given], _Made]:
    """Decorate a function of a `Line` or `Water` so that each object stores its result.

    The function is called only once for each object, because the objects do not change.
    """
    name = f"{make.__module__}.{make.__qualname__}"

    @wraps(make)
    def stored(given: _Given) -> _Made:
        kept = vars(given)
        if name not in kept:
            kept[name] = make(given)
        result: _Made = kept[name]
        return result

    return stored


def once_at_rest(make: Callable[[Line, Water], _Made]) -> Callable[[Line, Water], _Made]:
    """Decorate a function of a line and of water, whose result does not depend on the current.

    The line stores the latest result, for all water with the same depth, density and gravity.
    """
    name = f"{make.__module__}.{make.__qualname__}"

    @wraps(make)
    def stored(line: Line, water: Water) -> _Made:
        kept = vars(line).get(name)
        if kept is None or not water.same_at_rest(kept[0]):
            kept = vars(line)[name] = water, make(line, water)
        result: _Made = kept[1]
        return result

    return stored


_DTYPES: dict[str, Any] = {"Floats": np.float64, "Integers": np.intp, "Booleans": np.bool_}

_OfArrays = TypeVar("_OfArrays", bound=_Arrays)


def _of_arrays(made: type[_OfArrays]) -> type[_OfArrays]:
    """Decorate a dataclass to convert arguments to the array types of the fields.

    Raises ValueError if an array has a value that is not finite.
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
    """Return a value as a read-only array of a given type.

    Arrays that are already read-only are returned unchanged.
    """
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
"""Optional arrays of a `Line`, whose default is zero.

Each key names an array that is always given. The value names the optional arrays of the same
length.
"""

_CURVES = ("elongation", "drag_curve", "clamp_drag_curve")


@_of_arrays
@dataclass(frozen=True)
class Line(_Arrays):
    """The n pieces of a line, and the m instruments clamped on the pieces.

    A mooring is listed from the free end to the anchor, a tow from the ship to the towed body.
    Buoyancies and drags refer to sea water of 1025 kg/m³. For cables and chains, `buoyancy`,
    `volume` and drags are per unstretched metre.

    Attributes
    ----------
    length : (n,) unstretched length [m]
    flexible : (n,) True for a cable or chain, False for a rigid piece
    buoyancy : (n,) net buoyancy, positive up [N or N/m]
    volume : (n,) displaced volume [m³ or m³/m]; 0 if unknown
    normal_drag, tangential_drag : (n,) Kn and Kt [N/(m/s)², per metre if flexible]
    directional : (n,) False if the drag is Kn|V|V for any direction of the flow
    compliance : (n,) compliance 1/EA [1/N]; 0 if the piece is inextensible
    thinning : (n,) exponent of 1 + strain in the drag per unstretched metre: 1/2 for cables
        (constant volume), 0 for chains
    clamp_piece : (m,) index of the piece that carries the instrument
    clamp_at : (m,) unstretched distance of the instrument from the top of this piece [m]
    clamp_buoyancy, clamp_volume, clamp_drag : (m,) net buoyancy [N], displaced volume [m³], and
        factor K of the drag K|V|V [N/(m/s)²]
    anchor_height : height of the end of the line above the seabed [m]
    lift, clamp_lift : (n,), (m,) hydrodynamic lift at 1 m/s, positive up [N/(m/s)²]; default 0
    diameter : (n,) diameter of cables that may strum [m]; default 0
    friction : tangential drag law of cables and chains
    strumming : strumming law that increases `normal_drag` of the cables, or None
    towed : whether the free end is towed; rigid pieces at a towed end do not form one rigid body
    push_east, push_north : (n,) force of the wind [N]; default 0
    floating : surface properties of the first float; if None, a float that reaches the surface is
        placed just below the surface
    elongation : (n,) elongation curves of cables, instead of `compliance`
    drag_curve, clamp_drag_curve : (n,), (m,) normal drag of smooth spheres and cylinders against
        Reynolds number

    Tuples of curves have None for pieces or clamps without a curve, and may be empty.
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
        """Return the given arguments, with zeros for forces and diameters that are not given."""
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
            raise ValueError("Line: every clamp must be on a piece")
        if not 0.0 <= self.anchor_height < inf:
            raise ValueError("Line.anchor_height must be finite and not negative")

    @property
    def total_buoyancy(self) -> Floats:
        """Net buoyancy (n,) of each whole piece with its clamps, in reference water [N]."""
        return self.net_force(np.zeros(len(self.length)))

    def net_force(self, excess: Floats) -> Floats:
        """Return the net buoyancy (n,) of each whole piece with its clamps [N].

        `excess` (n,) is the buoyancy per displaced volume, minus the value in reference water
        [N/m³].
        """
        whole = np.where(self.flexible, self.length, 1.0)
        total: Floats = (self.buoyancy + excess * self.volume) * whole
        on = self.clamp_piece
        np.add.at(total, on, self.clamp_buoyancy + excess[on] * self.clamp_volume)
        return total

    @property
    def plumb_drag(self) -> Floats:
        """Drag factor (n,) of each whole piece with its clamps, if line and flow are vertical.

        The unit is N/(m/s)². The factor applies to reference water and constant drag coefficients.
        """
        along = np.where(self.directional, self.tangential_drag, self.normal_drag)
        total: Floats = along * np.where(self.flexible, self.length, 1.0)
        np.add.at(total, self.clamp_piece, self.clamp_drag)
        return total

    def with_length(self, piece: int, length: float) -> Line:
        """Return a copy of the line in which one piece has another unstretched length [m]."""
        lengths = self.length.copy()
        lengths[piece] = length
        return replace(self, length=lengths)

    @property
    def _of_pieces(self) -> dict[str, Any]:
        return {
            column.name: getattr(self, column.name)
            for column in fields(self)
            if (column.type in _DTYPES or column.name in _CURVES)
            and not column.name.startswith("clamp_")
        }

    def below_a_point(self) -> Line:
        """Return a copy of the line with a point as an additional first piece.

        This piece has no length, weight or drag.
        """
        columns: dict[str, Any] = {
            name: np.append(np.zeros(1, column.dtype), column)
            if isinstance(column, np.ndarray)
            else column and (None, *column)
            for name, column in self._of_pieces.items()
        }
        return replace(self, **columns, clamp_piece=self.clamp_piece + 1)

    def reversed(self) -> Line:
        """Return a copy of the line whose pieces and clamps are listed from the other end."""
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
    """Water depth, and profiles of current, density and viscosity.

    Profiles are linear between levels, and constant above the first and below the last level.

    Attributes
    ----------
    depth : water depth [m]; infinite if there is no seabed
    level : (k,) depths of current and density [m], strictly increasing, k ≥ 1
    u, v, w : (k,) components of the current to the east, to the north, and upward [m/s]
    density : (k,) density [kg/m³]
    gravity : acceleration of gravity [m/s²]
    deeper_east, deeper_north : increase in depth of the seabed per metre east and north [-]
    viscosity_level, viscosity : (j,) depths [m], strictly increasing, and kinematic viscosity
        [m²/s]
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
            raise ValueError("Water: levels must increase")

    @cached_property
    def moving(self) -> bool:
        """Whether there is any current."""
        return bool(self.u.any() or self.v.any() or self.w.any())

    def still(self) -> Water:
        """Return a copy of the water without current."""
        return replace(self, u=(zero := np.zeros_like(self.u)), v=zero, w=zero)

    def same_at_rest(self, other: Water) -> bool:
        """Return whether the water has the same depth, density and gravity as other water."""
        return self is other or (
            (self.depth, self.gravity) == (other.depth, other.gravity)
            and np.array_equal(self.level, other.level)
            and np.array_equal(self.density, other.density)
        )

    def current_at(self, depth: Floats) -> Floats:
        """Return the current (..., 3) [m/s] at depths [m] in an array of any shape."""
        return np.stack([np.interp(depth, self.level, c) for c in (self.u, self.v, self.w)], -1)

    def density_at(self, depth: Floats) -> Floats:
        """Return the density (...) [kg/m³] at depths [m] in an array of any shape."""
        return np.interp(depth, self.level, self.density)

    def viscosity_at(self, depth: Floats) -> Floats:
        """Return the kinematic viscosity (...) [m²/s] at depths [m] in an array of any shape."""
        return np.interp(depth, self.viscosity_level, self.viscosity)
