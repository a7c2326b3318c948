"""The result of a solved mooring, in the names and units of the result format.

Its ends, its anchor, its pieces, its knockdown, and its JSON object.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import asdict, dataclass, field, replace
from functools import cached_property
from math import isnan, nan
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np

from calm.case.columns import ClampRow, Clamps, ComponentRow, Components, Shape
from calm.case.measure import clamps_down, clamps_of, components_of, shape_of
from calm.case.strumming import Strumming, StrummingBand, mooring_band, strumming_of
from calm.case.warnings import warnings_of
from calm.files import Clamp, Piece
from calm.physics.anchor import required_weight
from calm.solve import Solution, Status

if TYPE_CHECKING:
    from calm.case.mooring import Mooring
    from calm.case.tow import TowResult
    from calm.files import Clamp, MooringFile, Piece


def document_of(result: Result | TowResult, ends: dict[str, Any]) -> dict[str, Any]:
    """The JSON object of a result; `ends` holds what a mooring, or a tow, has at its ends."""
    from calm.version import __version__

    components, clamps = result.components.to_dicts(), result.clamps.to_dicts()
    for component in components:
        for name in ("kind", "role", "tension", "least_tension"):
            del component[name]
    parts: list[Piece | Clamp] = [*result.components.part, *result.clamps.part]
    for row, part in zip((*components, *clamps), parts, strict=True):
        if part.serial is not None:
            row["serial"] = part.serial
    document = result.file.document
    return {
        "calm": __version__,
        "name": result.name,
        **({} if document is None else {"document": document.to_dict()}),
        "type": result.type,
        "status": result.status,
        "iterations": result.iterations,
        "segments": result.segments,
        "miss": result.miss,
        "closure": result.closure,
        "accuracy": {k: v for k, v in asdict(result.accuracy).items() if v is not None},
        **ends,
        "other_equilibrium": result.other_equilibrium,
        "components": components,
        "clamps": clamps,
        "shape": {name: column.tolist() for name, column in vars(result.shape).items()},
        "warnings": list(result.warnings),
    }


def known(part: Strumming | StrummingBand | None) -> dict[str, Any] | None:
    """A part of a result as a dictionary; None where there is none."""
    return None if part is None else asdict(part)


@dataclass(frozen=True)
class Accuracy:
    """The solver's own estimate of its errors.

    Of the worst of any depth or offset [m], of any tension [N], of the vertical and the horizontal
    pull on the anchor [N], and of the weight that it needs [N]; the last two None in a tow.
    """

    depth: float
    tension: float
    anchor: float | None = None
    required_weight: float | None = None


@dataclass(frozen=True)
class Top:
    """The free end: depth, offsets east and north, knockdown [m]; None where there is none.

    `used_buoyancy` is the share in use of the buoyancy that is at the surface, `reserve` the
    rest of it [N]; 1 and 0 below the surface. `draft` and `freeboard` [m] are those of a float at
    the surface whose hull is known.
    """

    depth: float
    x: float
    y: float
    knockdown: float | None
    used_buoyancy: float
    reserve: float
    draft: float | None = None
    freeboard: float | None = None


@dataclass(frozen=True)
class AnchorLoad:
    """Hold what the line does to its anchor [N]; `angle` is from the vertical [degrees].

    `required_weight` is the weight in water that holds it, `weight` what it has, `friction` its
    coefficient on the bed; `grounded_length` is the unstretched length of line on the seabed [m].
    """

    tension: float
    vertical: float
    horizontal: float
    angle: float
    required_weight: float
    weight: float
    friction: float
    grounded_length: float


class Solved:
    """Describe how a result shows its table, whatever was solved.

    `notebook_form` makes HTML of a result; the rooms above set it.
    """

    components: Components
    notebook_form: ClassVar[Callable[[Any], str] | None] = None

    def to_dataframe(self) -> Any:
        """The components as a pandas data frame (pandas is not installed with CALM)."""
        return self.components.to_dataframe()

    def _repr_html_(self) -> str | None:
        """The table of the line, for notebooks; None where nothing makes it."""
        form = type(self).notebook_form
        return None if form is None else form(self)


@dataclass(frozen=True)
class Result(Solved):
    """A converged mooring. Lengths and depths [m], forces [N], angles [degrees].

    `iterations` counts marches, `segments` the cuts of the final one, `miss` is the height
    of the line's end above the anchor's top, `closure` the relative force residual recomputed
    from the final coordinates. `still_shape` is the same line without current, None where that
    has no unique shape. `other_depth` is that of the free end in another equilibrium that was
    found, `other_grounded_length` what lies on the seabed there.
    """

    mooring: Mooring = field(repr=False)
    name: str
    type: str
    status: str
    iterations: int
    segments: int
    miss: float
    closure: float
    accuracy: Accuracy
    top: Top
    anchor: AnchorLoad
    strumming: Strumming | None
    components: Components = field(repr=False)
    clamps: Clamps = field(repr=False)
    shape: Shape = field(repr=False)
    still_shape: Shape | None = field(repr=False)
    other_depth: float | None = None
    other_grounded_length: float = 0.0
    warnings: tuple[str, ...] = ()

    @property
    def other_equilibrium(self) -> dict[str, float] | None:
        """Return where the free end is in another equilibrium, and what lies on the seabed there
        [m].
        """
        if self.other_depth is None:
            return None
        return {"depth": self.other_depth, "grounded_length": self.other_grounded_length}

    @property
    def file(self) -> MooringFile:
        """The file as read."""
        return self.mooring.file

    @cached_property
    def strumming_band(self) -> StrummingBand | None:
        """Return the same mooring with more drag on its cables; solved when first asked for."""
        still = self.still_shape
        return mooring_band(self.mooring, None if still is None else float(still.depth[0]))

    def to_dict(self) -> dict[str, Any]:
        """The JSON object of the result format; None stands where a figure is unknown."""
        ends = {
            "top": asdict(self.top),
            "anchor": asdict(self.anchor),
            "strumming": known(self.strumming),
            "strumming_band": known(self.strumming_band),
        }
        return document_of(self, ends)


def result_of(mooring: Mooring, solution: Solution, still: Solution | None) -> Result:
    """The result of a solution; `still` is None where the shape in still water is not unique."""
    pieces = mooring.file.pieces
    above = components_of(pieces[:-1], solution, still)
    components = _with_anchor(above, pieces[-1], mooring.water.depth)
    clamps = clamps_of(pieces[:-1], solution, still)
    for clamp in clamps_down(pieces[-1:]):
        clamps = clamps.with_row(_on_anchor(clamp, components[-1]))
    knockdown, riding = float(components.knockdown[0]), solution.riding
    shape = shape_of(solution)
    still_shape = shape if still is solution else None if still is None else shape_of(still)
    result = Result(
        mooring=mooring,
        name=mooring.file.name,
        type="surface" if solution.surface else "subsurface",
        status=Status.CONVERGED.label,
        iterations=solution.marches,
        segments=solution.segments,
        miss=solution.miss,
        closure=solution.closure,
        accuracy=_accuracy(mooring, solution),
        top=Top(
            depth=float(components.depth_top[0]),
            x=float(components.x_top[0]),
            y=float(components.y_top[0]),
            knockdown=None if still is None else knockdown,
            used_buoyancy=solution.buoyancy_used,
            reserve=solution.reserve,
            draft=None if riding is None or isnan(riding.draft) else riding.draft,
            freeboard=None if riding is None or isnan(riding.freeboard) else riding.freeboard,
        ),
        anchor=anchor_load(mooring, solution),
        strumming=strumming_of(mooring.file.solver, solution),
        components=components,
        clamps=clamps,
        shape=shape,
        still_shape=still_shape,
        other_depth=solution.other_depth,
        other_grounded_length=solution.other_grounded_length,
    )
    return replace(result, warnings=warnings_of(result, solution))


def _with_anchor(above: Components, anchor: Piece, depth: float) -> Components:
    """The components with the anchor, which stands upright below the line's end."""
    line_end = above[-1]
    pull, height = line_end.tension_bottom, anchor.length or 0.0
    breaking, working = anchor.component.breaking_load, anchor.component.working_load
    row = ComponentRow(
        part=anchor,
        index=anchor.index,
        use=anchor.use,
        label=anchor.label,
        kind=anchor.component.kind,
        role=anchor.component.role,
        length=height,
        cut_length=height,
        depth_top=line_end.depth_bottom,
        depth_bottom=depth,
        x_top=line_end.x_bottom,
        y_top=line_end.y_bottom,
        x_bottom=0.0,
        y_bottom=0.0,
        tension_top=pull,
        tension_bottom=pull,
        tension=pull,
        least_tension=pull,
        tilt=0.0,
        knockdown=0.0,
        safety_factor=breaking / pull if breaking and pull else nan,
        utilisation=pull / working if working else nan,
        reynolds=nan,
    )
    return above.with_row(row)


def _on_anchor(clamp: Clamp, anchor: ComponentRow) -> ClampRow:
    """Return what is clamped on the anchor stands still with it, and is held with the line's
    pull.
    """
    return ClampRow(
        part=clamp,
        index=anchor.index,
        use=clamp.use,
        label=clamp.label,
        depth=anchor.depth_top + clamp.at,
        x=anchor.x_bottom,
        y=anchor.y_bottom,
        tension=anchor.tension,
        tilt=anchor.tilt,
        knockdown=anchor.knockdown,
    )


def anchor_load(mooring: Mooring, solution: Solution) -> AnchorLoad:
    """Return what the line of a mooring does to its anchor."""
    force, friction = solution.force[-1], _friction(mooring)
    vertical, horizontal = float(force[2]), float(np.hypot(force[0], force[1]))
    factor = mooring.file.checks.anchor_factor
    return AnchorLoad(
        tension=float(solution.tension[-1]),
        vertical=vertical,
        horizontal=horizontal,
        angle=float(np.degrees(np.arctan2(horizontal, vertical))),
        required_weight=max(required_weight(vertical, horizontal, factor, friction), 0.0),
        weight=mooring.anchor_weight,
        friction=friction,
        grounded_length=solution.grounded_length,
    )


def _accuracy(mooring: Mooring, solution: Solution) -> Accuracy:
    """Return what the solver states of its errors, and what follows for the weight of the
    anchor.
    """
    lift, pull = solution.lift_error, solution.pull_error
    factor = mooring.file.checks.anchor_factor
    return Accuracy(
        depth=solution.depth_error,
        tension=solution.tension_error,
        anchor=max(lift, pull),
        required_weight=required_weight(lift, pull, factor, _friction(mooring)),
    )


def _friction(mooring: Mooring) -> float:
    """Return the friction of the anchor on the bed: its own, or that of the checks."""
    own = mooring.file.anchor.friction
    return mooring.file.checks.anchor_friction if own is None else own
