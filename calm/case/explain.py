"""Explanation of a mooring's equilibrium: contribution of each drag, and effect of changed
inputs.
"""

from collections.abc import Callable, Iterator
from dataclasses import asdict, dataclass, field, replace
from typing import Any

import numpy as np

from calm.case import attribution
from calm.case.design import Design, Result
from calm.case.draws import Draw, drawn_water
from calm.case.parts import TOP, one_part
from calm.case.result_tables import ColumnTable
from calm.case.targets import Figures, figures_of, leg_at
from calm.errors import NoEquilibrium, UsageError
from calm.files import Place
from calm.files.mooring_file import refuse_tow
from calm.files.pieces import clamps_in
from calm.physics.line import Floats, Line, Water
from calm.solve import CompiledPart, expect_many

SOLVES = 100.0
"""Computing time of one explanation, as an approximate number of equilibria."""

CHANGE = 0.1
"""Relative change of buoyancy, drag and current in the what-if cases."""


@dataclass(frozen=True, slots=True)
class Cause:
    """Contribution of the drag of one piece or clamp; a row of the table `Causes`."""

    index: int
    label: str
    clamped: bool
    drag: float
    knockdown: float
    excursion: float
    used_buoyancy: float


class Causes(ColumnTable[Cause]):
    """Contributions of the p pieces and clamped instruments that have drag, in file order.

    Attributes
    ----------
    index : (p,) index of the piece, or of the piece that carries the clamp
    drag : (p,) horizontal drag force [N]
    knockdown, excursion, used_buoyancy : (p,) contribution of the drag to these quantities [m],
        [m], [-]
    """

    record = Cause


@dataclass(frozen=True)
class WhatIf:
    """Result for a changed input: the new values, or the reason why there is no equilibrium."""

    name: str
    figures: Figures | None = None
    failure: NoEquilibrium | None = None


@dataclass(frozen=True)
class Explanation:
    """Causes of the knockdown and excursion of a mooring, and the effects of changed inputs.

    Attributes
    ----------
    quantities : names of the explained columns of `causes`. These are excursion and used buoyancy
        for a leg with a surface float. For other legs, they are knockdown and excursion, or
        excursion alone if the knockdown is undefined
    figures : values of the original mooring
    without_drag : contribution to each quantity that is not caused by drag
    causes : contributions of the drags; None if unknown
    miss : largest relative error of the sums of the contributions, before the contributions are
        scaled to the total
    changes : results for more buoyancy, less drag, and more and less current
    """

    label: str
    quantities: tuple[str, ...]
    figures: Figures
    without_drag: dict[str, float] = field(repr=False)
    causes: Causes | None
    miss: float
    changes: tuple[WhatIf, ...] = field(repr=False)
    notes: tuple[str, ...]

    def to_dict(self) -> dict[str, Any]:
        """Return the object `explain` of the JSON results, in SI units; unknown values are null."""
        causes = None
        if self.causes is not None:
            names = ("index", "label", "clamped", "drag", *self.quantities)
            rows = self.causes.to_dicts()
            causes = [{name: row[name] for name in names} for row in rows]
        return {
            "label": self.label,
            "quantities": list(self.quantities),
            "figures": asdict(self.figures),
            "without_drag": self.without_drag,
            "causes": causes,
            "miss": self.miss,
            "changes": [_change_document(change) for change in self.changes],
            "notes": list(self.notes),
        }


def _change_document(change: WhatIf) -> dict[str, Any]:
    if change.failure is not None:
        return {"change": change.name, **change.failure.to_dict()}
    assert change.figures is not None
    return {"change": change.name, "status": "converged", **asdict(change.figures)}


def explain(result: Result, label: str | None = None) -> Explanation:
    """Explain the knockdown and excursion of a mooring or a net of legs.

    The mooring is also solved with changed inputs; the length of a fitted piece does not change
    with the inputs. The explained point is the clamp, or the upper end of the piece, with the
    `label`. By default, the point is the free end of the line, or the first free end of a net.

    Raises
    ------
    UsageError
        No part above the anchor has the label, or the design is a tow.
    """
    refuse_tow(result.file)
    mooring = result.design
    pieces = [piece for leg in mooring.legs for piece in leg.file.pieces[: len(leg.line.length)]]
    free = [leg.file.pieces[0].label for leg in mooring.legs if leg.top.free]
    try:
        part = one_part(pieces, label or (free or [TOP])[0])
    except LookupError as error:
        raise UsageError(str(error.args[0])) from None
    expect_many(SOLVES)
    expect_many(SOLVES, CompiledPart.NEARBY)
    figures = figures_of(result, part.place)
    quantities: tuple[str, ...] = ("knockdown", "excursion")
    surface = leg_at(result, part.place).type == "surface"
    if figures.knockdown is None or surface:
        quantities = ("excursion", "used_buoyancy") if surface else ("excursion",)
    notes = list(_notes(result, quantities, surface=surface))
    causes, without_drag, miss = None, dict.fromkeys(quantities, 0.0), 0.0
    try:
        shares = _shares(result, figures, "knockdown" in quantities, part.place)
    except NoEquilibrium as failure:
        notes.append(
            "The effect of the drag of each part cannot be computed, because the line has no "
            f"equilibrium with reduced drag ({failure.status}: {failure.message})"
        )
    else:
        causes = _causes(result, shares)
        columns = [_COLUMNS.index(name) for name in quantities]
        miss = float(np.abs(shares.miss[columns]).max()) if mooring.water.moving else 0.0
        for name, column in zip(quantities, columns, strict=True):
            without_drag[name] = 0.0 if name == "knockdown" else float(shares.start[column])
        if miss > attribution.LARGEST_MISS:
            notes.append(
                "The shares are approximate, because the effect is not proportional to the drag. "
                f"Their sum differed from the total effect by {miss:.0%}, so they were scaled to "
                "match it."
            )
    return Explanation(
        label=part.label,
        quantities=quantities,
        figures=figures,
        without_drag=without_drag,
        causes=causes,
        miss=miss,
        changes=tuple(_changed(name, other, part.place) for name, other in _variations(mooring)),
        notes=tuple(notes),
    )


_COLUMNS = ("knockdown", "excursion", "used_buoyancy")
"""Names of the three columns of an `Attribution`."""


def _notes(result: Result, quantities: tuple[str, ...], *, surface: bool) -> Iterator[str]:
    if result.several:
        yield (
            "Excursions are measured from the origin of the coordinates; the anchor values are "
            "those of the anchor with the largest required weight."
        )
    if surface:
        yield (
            "A float at the surface has no knockdown. The table shows how much each cause adds to "
            "its excursion and to its buoyancy in use."
        )
    elif "knockdown" not in quantities:
        yield (
            "The line has no unique shape in still water, so its knockdown is undefined. The table "
            "shows how much each cause adds to its excursion."
        )
    if not result.design.water.moving:
        yield "There is no current, so there is no drag."


def _shares(
    result: Result, figures: Figures, has_rest: bool, place: Place
) -> attribution.Attribution:
    design, point = result.design, _point(result, place)
    lines = [leg.line for leg in design.legs]
    whole = np.array([figures.depth, figures.excursion, figures.used_buoyancy])
    start = None
    if design.several:
        near = attribution.of_a_net(design, point)
        if has_rest:
            bare = [attribution.with_drag(line, 0.0) for line in lines]
            start = near(bare)(0, bare[0])
        return attribution.attribute(lines, near, start, whole)
    if has_rest:
        assert figures.knockdown is not None
        start = np.array([figures.depth - figures.knockdown, 0.0, 1.0])
    return attribution.attribute(lines, attribution.of_a_line(design.water, point), start, whole)


def _point(result: Result, place: Place) -> attribution.SolverPart:
    leg = leg_at(result, place)
    pieces, own = leg.file.pieces, replace(place, clamp=-1)
    index = next(piece.index for piece in pieces if piece.place == own)
    clamps = [clamp.place for clamp in clamps_in(pieces)]
    number = [each is leg for each in result.legs].index(True)
    return number, index, clamps.index(place) if place.is_clamp else -1


def _causes(result: Result, shares: attribution.Attribution) -> Causes:
    legs = result.legs
    labels = []
    for leg, piece, clamp in shares.parts:
        pieces = legs[leg].file.pieces
        labels.append((clamps_in(pieces)[clamp] if clamp >= 0 else pieces[piece]).label)
    first = [leg.leg.keys.first for leg in legs]
    return Causes(
        index=np.array([first[leg] + piece for leg, piece, _ in shares.parts], dtype=np.intp),
        label=labels,
        clamped=[clamp >= 0 for *_, clamp in shares.parts],
        drag=_drags(result, shares.parts),
        knockdown=shares.shares[:, 0],
        excursion=shares.shares[:, 1],
        used_buoyancy=shares.shares[:, 2],
    )


def _drags(result: Result, parts: list[attribution.SolverPart]) -> Floats:
    """Compute the horizontal force of the water on each part (p,) [N]."""
    solutions = result.design.solutions
    found = []
    for leg, p, m in parts:
        one = solutions[leg]
        own = len(one.line.length) - 1 - p if one.line.towed else p
        mine = (one.element_piece == own) & (one.element_clamp == m)
        mine &= np.arange(len(mine)) < one.hanging
        found.append(float(np.hypot(*np.diff(one.force[:, :2], axis=0)[mine].sum(axis=0))))
    return np.array(found)


def _variations(mooring: Design) -> Iterator[tuple[str, Design]]:
    percent = f"{CHANGE:.0%}".replace("%", " %")
    yield f"buoyancy +{percent}", _with(mooring, lambda line: _with_buoyancy(line, 1.0 + CHANGE))
    yield f"drag −{percent}", _with(mooring, lambda line: attribution.with_drag(line, 1.0 - CHANGE))
    for sign, share in (("+", 1.0 + CHANGE), ("−", 1.0 - CHANGE)):
        flow = drawn_water(mooring.water, Draw(share))
        yield f"current {sign}{percent}", _with(mooring, lambda line: line, flow)


def _with(design: Design, changed: Callable[[Line], Line], water: Water | None = None) -> Design:
    return design.with_lines([changed(leg.line) for leg in design.legs], water)


def _with_buoyancy(line: Line, factor: float) -> Line:
    floating, floats = line.floating, np.flatnonzero(~line.flexible & (line.buoyancy > 0.0))
    if floating is not None and len(floats):
        more = (factor - 1.0) * float(line.buoyancy[floats[0]])
        floating = replace(floating, lift=floating.lift + more)
    return replace(
        line,
        floating=floating,
        buoyancy=np.where(line.buoyancy > 0.0, factor, 1.0) * line.buoyancy,
        clamp_buoyancy=np.where(line.clamp_buoyancy > 0.0, factor, 1.0) * line.clamp_buoyancy,
    )


def _changed(name: str, mooring: Design, place: Place) -> WhatIf:
    try:
        return WhatIf(name, figures_of(mooring.solve(), place))
    except NoEquilibrium as failure:
        return WhatIf(name, failure=failure)
