"""The result of a leg: its pieces, its clamps, its shape and its ends."""

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
from calm.files.mooring_file import clamps_down
from calm.physics.line import Water
from calm.solve import Solution, Status
from calm.solve.solution import OtherEquilibrium


@dataclass(frozen=True, kw_only=True, repr=False)
class LegResult:
    """A leg of a converged design. Lengths and depths [m], forces [N], angles [degrees].

    Attributes
    ----------
    leg : that was solved
    type : ``subsurface``, ``surface`` or ``tow``
    top : its upper end
    anchor : the load on its anchor; NaN where it has none, which then is a stand-in among the
        components, of which nothing is true
    tow_point, body : of a tow, whose components run from the ship down and whose shape begins at
        the free end; None of other legs
    ends : what it does to what holds its ends
    still_shape : the same line without current, None where that has no unique shape
    profilers : on their way; all else is of all of them at their upper stops
    iterations, segments, miss : marches, the cuts of the final one, and how far its end is from
        where it is held [m]; of one that stands alone
    closure : the relative force residual recomputed from the final coordinates
    other : another equilibrium that was found
    """

    leg: Leg
    type: str
    iterations: int
    segments: int
    miss: float
    closure: float
    accuracy: Accuracy
    top: Top
    anchor: AnchorLoad
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
        """Its name in its design."""
        return self.leg.name

    @property
    def status(self) -> str:
        """Return ``converged``."""
        return Status.CONVERGED.label

    @property
    def file(self) -> MooringFile:
        """The file of the leg."""
        return self.leg.file

    @property
    def water(self) -> Water:
        """The water that it stands in, or goes through."""
        return self.leg.water

    @property
    def towed(self) -> bool:
        """Return whether it is drawn through the water."""
        return self.leg.towed

    @property
    def legs(self) -> tuple[LegResult, ...]:
        """It is one."""
        return (self,)

    @property
    def several(self) -> bool:
        """Return False: it is one, whatever it joins."""
        return False

    @property
    def other_used_buoyancy(self) -> float:
        """Share in use of the buoyancy of the float in another equilibrium at the surface; NaN if
        none was found.
        """
        afloat = self.other is not None and self.other.used_buoyancy < 1.0
        return self.other.used_buoyancy if self.other is not None and afloat else nan

    @property
    def other_equilibrium(self) -> dict[str, float] | None:
        """Depth of the free end, length on the seabed, buoyancy in use and anchor load of another
        equilibrium, of a tow the depth alone; None if none was found.
        """
        if self.other is None:
            return None
        return {"depth": self.other.depth} if self.leg.towed else self.other._asdict()

    @cached_property
    def strumming_band(self) -> StrummingBand | None:
        """Return the same line with more drag on its cables; solved when first asked for.

        None of a leg of a net, which does not stand alone.
        """
        if self.leg.of_several:
            return None
        still = self.still_shape
        return band_of(self.leg, None if still is None else float(still.depth[0]))


def leg_result_of(leg: Leg, solution: Solution, still: Solution | None) -> LegResult:
    """The result of a leg, without its warnings and profilers.

    Parameters
    ----------
    still : the same line in still water; None where its shape there is not unique
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
        anchor=anchor_load(leg, solution),
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
