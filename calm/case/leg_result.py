"""Results of legs: pieces, clamps, shape and ends."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from math import nan

from calm.case.ends import accuracy_of, anchor_load, body_of, end_loads, top_of, tow_point_of
from calm.case.leg import Leg
from calm.case.measure import clamps_of, components_of, on_anchor, shape_of, with_anchor
from calm.case.profilers import ProfilerTravel
from calm.case.result_tables import (
    Accuracy,
    AnchorLoad,
    Clamps,
    Components,
    EndLoad,
    Shape,
    Top,
    TowedBody,
    TowPoint,
)
from calm.case.strumming import Strumming, StrummingBand, band_of, strumming_of
from calm.case.warnings import warnings_of
from calm.files import MooringFile
from calm.files.pieces import clamps_down
from calm.physics.line import Water
from calm.solve import Solution, Status
from calm.solve.solution import OtherEquilibrium


@dataclass(frozen=True, kw_only=True, repr=False)
class LegResult:
    """Result of a leg in equilibrium. Lengths and depths are in m, forces in N, angles in degrees.

    The components of a tow are listed from the ship down, but its shape begins at the free end.

    Attributes
    ----------
    still : solution in still water; None if the shape in still water is not unique
    profilers : results for each profiler at several positions; in all other results, profilers are
        at their upper stops
    """

    leg: Leg
    solution: Solution
    still: Solution | None
    profilers: tuple[ProfilerTravel, ...] = ()

    def __repr__(self) -> str:
        return f"LegResult({self.name!r}, {self.type}, {len(self.components)} components)"

    @property
    def name(self) -> str:
        """Name of the leg."""
        return self.leg.name

    @property
    def status(self) -> str:
        """Status of the solver, always ``converged``."""
        return Status.CONVERGED.label

    @property
    def type(self) -> str:
        """Type of the leg: ``subsurface``, ``surface`` or ``tow``."""
        if self.towed:
            return "tow"
        return "surface" if self.solution.surface else "subsurface"

    @property
    def iterations(self) -> int:
        """Number of integrations along the line that the solver needed."""
        return self.solution.marches

    @property
    def segments(self) -> int:
        """Number of segments in the final shape."""
        return self.solution.segments

    @property
    def miss(self) -> float:
        """Vertical distance between the lower end of the solution and its required position [m]."""
        return self.solution.miss

    @property
    def closure(self) -> float:
        """Force residual relative to the forces, recomputed from the final coordinates."""
        return self.solution.closure

    @property
    def other(self) -> OtherEquilibrium | None:
        """Another equilibrium, if one was found."""
        return self.solution.other

    @cached_property
    def accuracy(self) -> Accuracy:
        """Error estimates of the solver."""
        return accuracy_of(self.leg, self.solution)

    @cached_property
    def top(self) -> Top:
        """Values at the upper end of the leg."""
        return top_of(self.solution, self.still)

    @cached_property
    def anchor_load(self) -> AnchorLoad:
        """Load on the anchor, or NaN for a leg without an anchor."""
        return anchor_load(self.leg, self.solution)

    @cached_property
    def tow_point(self) -> TowPoint | None:
        """Load of a tow on the ship, or None for other legs."""
        return tow_point_of(self.solution) if self.towed else None

    @cached_property
    def body(self) -> TowedBody | None:
        """Values at the towed body, or None for other legs."""
        return body_of(self.solution) if self.towed else None

    @cached_property
    def ends(self) -> tuple[EndLoad, ...]:
        """Loads on the anchor and on other fixed ends."""
        return tuple(end_loads(self.leg, self.components, self.solution))

    @cached_property
    def strumming(self) -> Strumming | None:
        """Strumming of the cables, or None if the file sets no strumming law."""
        return strumming_of(self.file.solver, self.solution)

    @cached_property
    def components(self) -> Components:
        """Pieces in line order; the pieces of a tow are listed from the ship down.

        The last piece of a leg without an anchor is a stand-in. The values of a stand-in have no
        meaning.
        """
        pieces = self.file.pieces
        if self.towed:
            return components_of(pieces, self.solution, self.still)
        above = components_of(pieces[:-1], self.solution, self.still)
        return with_anchor(above, pieces[-1], self.water.depth)

    @cached_property
    def clamps(self) -> Clamps:
        """Clamped instruments in file order."""
        pieces = self.file.pieces
        if self.towed:
            return clamps_of(pieces, self.solution, self.still)
        clamps = clamps_of(pieces[:-1], self.solution, self.still)
        for clamp in clamps_down(pieces[-1:]):
            clamps = clamps.with_row(on_anchor(clamp, self.components[-1]))
        return clamps

    @cached_property
    def shape(self) -> Shape:
        """Shape of the leg, node by node from the free end."""
        return shape_of(self.solution)

    @cached_property
    def still_shape(self) -> Shape | None:
        """Shape of the leg in still water, or None if this shape is not unique."""
        if self.still is self.solution:
            return self.shape
        return None if self.still is None else shape_of(self.still)

    @property
    def file(self) -> MooringFile:
        """File with this leg only."""
        return self.leg.file

    @property
    def water(self) -> Water:
        """Water of the leg."""
        return self.leg.water

    @property
    def anchor(self) -> AnchorLoad | None:
        """Load on the anchor, or None for a leg without an anchor."""
        return self.anchor_load if self.leg.anchored else None

    @property
    def towed(self) -> bool:
        """Whether a ship or an aircraft tows the leg."""
        return self.leg.towed

    @property
    def legs(self) -> tuple[LegResult, ...]:
        """This leg as a tuple, so that a leg can be used instead of a `Result`."""
        return (self,)

    @property
    def several(self) -> bool:
        """Always false, so that a leg can be used instead of a `Result`."""
        return False

    @property
    def other_used_buoyancy(self) -> float:
        """Used fraction of the surface float's buoyancy in another equilibrium, or NaN if none was
        found.
        """
        afloat = self.other is not None and self.other.used_buoyancy < 1.0
        return self.other.used_buoyancy if self.other is not None and afloat else nan

    @property
    def other_equilibrium(self) -> dict[str, float] | None:
        """Values of a second equilibrium, such as the depth of the free end; None if none was
        found.
        """
        if self.other is None:
            return None
        return {"depth": self.other.depth} if self.leg.towed else self.other._asdict()

    @cached_property
    def warnings(self) -> tuple[str, ...]:
        """Notices of the file, followed by warnings about the result."""
        return warnings_of(self)

    @cached_property
    def strumming_band(self) -> StrummingBand | None:
        """Results of the line if strumming increases the drag of its cables.

        The line is solved when the attribute is first used. The value is None for a leg of a net.
        """
        if self.leg.of_several:
            return None
        still = self.still_shape
        return band_of(self.leg, None if still is None else float(still.depth[0]))
