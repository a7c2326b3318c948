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
from calm.files import MooringFile
from calm.files.pieces import clamps_down
from calm.physics.line import Water
from calm.solve import Solution, Status
from calm.solve.solution import OtherEquilibrium


@dataclass(frozen=True, kw_only=True, repr=False)
class LegResult:
    """A leg of a converged design. Lengths and depths [m], forces [N], angles [degrees].

    The components of a tow run from the ship down, and its shape begins at the free end.

    Attributes
    ----------
    leg : the solved leg
    type : ``subsurface``, ``surface`` or ``tow``
    top : upper end
    anchor_load : load on the anchor; NaN for a leg without an anchor, whose last component is a
        stand-in without meaning. `anchor` is None for such a leg
    tow_point, body : both ends of a tow; None for other legs
    ends : loads on the anchor and on other fixed ends
    still_shape : shape in still water; None without a unique shape
    profilers : profilers at their places; all other figures hold with them at their upper stops
    iterations, segments : number of marches, and of segments of the final shape
    miss : distance of the lower end from its place, in height [m]
    closure : relative force residual, recomputed from the final coordinates
    other : another equilibrium, if one was found
    """

    leg: Leg
    type: str
    iterations: int
    segments: int
    miss: float
    closure: float
    accuracy: Accuracy
    top: Top
    anchor_load: AnchorLoad
    strumming: Strumming | None
    components: Components
    clamps: Clamps
    shape: Shape
    still_shape: Shape | None
    ends: tuple[EndLoad, ...]
    other: OtherEquilibrium | None = None
    tow_point: TowPoint | None = None
    body: TowedBody | None = None
    profilers: tuple[ProfilerTravel, ...] = ()
    warnings: tuple[str, ...] = ()

    def __repr__(self) -> str:
        """Return its name, and how many components it has."""
        return f"LegResult({self.name!r}, {self.type}, {len(self.components)} components)"

    @property
    def name(self) -> str:
        """Name of the leg."""
        return self.leg.name

    @property
    def status(self) -> str:
        """Return ``converged``."""
        return Status.CONVERGED.label

    @property
    def file(self) -> MooringFile:
        """File of the leg alone."""
        return self.leg.file

    @property
    def water(self) -> Water:
        """Water of the leg."""
        return self.leg.water

    @property
    def anchor(self) -> AnchorLoad | None:
        """Load on the anchor; None for a leg without an anchor."""
        return self.anchor_load if self.leg.anchored else None

    @property
    def towed(self) -> bool:
        """Whether a ship or an aircraft tows the leg."""
        return self.leg.towed

    @property
    def legs(self) -> tuple[LegResult, ...]:
        """This leg alone, as a `Result` lists its legs."""
        return (self,)

    @property
    def several(self) -> bool:
        """False, since this is a single leg."""
        return False

    @property
    def other_used_buoyancy(self) -> float:
        """Share of buoyancy in use in another equilibrium at the surface; NaN if none was found."""
        afloat = self.other is not None and self.other.used_buoyancy < 1.0
        return self.other.used_buoyancy if self.other is not None and afloat else nan

    @property
    def other_equilibrium(self) -> dict[str, float] | None:
        """Depth of the free end in another equilibrium; None if none was found.

        For a mooring also length on the seabed, share of buoyancy in use, and anchor load.
        """
        if self.other is None:
            return None
        return {"depth": self.other.depth} if self.leg.towed else self.other._asdict()

    @cached_property
    def strumming_band(self) -> StrummingBand | None:
        """The line with more drag on its cables, solved on first use; None for a leg of a net."""
        if self.leg.of_several:
            return None
        still = self.still_shape
        return band_of(self.leg, None if still is None else float(still.depth[0]))


def leg_result_of(leg: Leg, solution: Solution, still: Solution | None) -> LegResult:
    """Make the result of a leg, without warnings and profilers.

    Parameters
    ----------
    still : the line in still water; None without a unique shape
    """
    pieces = leg.file.pieces
    above = pieces if leg.towed else pieces[:-1]
    components, clamps = components_of(above, solution, still), clamps_of(above, solution, still)
    if not leg.towed:
        components = with_anchor(components, pieces[-1], leg.water.depth)
        for clamp in clamps_down(pieces[-1:]):
            clamps = clamps.with_row(on_anchor(clamp, components[-1]))
    shape = shape_of(solution)
    standing = "surface" if solution.surface else "subsurface"
    knockdown = None if still is None else float(components.knockdown[0])
    return LegResult(
        leg=leg,
        type="tow" if leg.towed else standing,
        iterations=solution.marches,
        segments=solution.segments,
        miss=solution.miss,
        closure=solution.closure,
        accuracy=accuracy_of(leg, solution),
        top=top_of(components, solution, knockdown),
        anchor_load=anchor_load(leg, solution),
        tow_point=tow_point_of(solution) if leg.towed else None,
        body=body_of(solution) if leg.towed else None,
        ends=tuple(end_loads(leg, components, solution)),
        strumming=strumming_of(leg.file.solver, solution),
        components=components,
        clamps=clamps,
        shape=shape,
        still_shape=shape if still is solution else None if still is None else shape_of(still),
        other=solution.other,
    )
