"""Why a mooring stands as it does: what each drag causes, and what a change would do."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import asdict, dataclass, field, replace
from typing import TYPE_CHECKING, Any

import numpy as np

from calm.case.attribution import FAIR, Attribution, SolverPart, attribute, with_drag
from calm.case.draws import Draw, drawn_water
from calm.case.mooring import Mooring
from calm.case.parts import TOP, clamps_in, one_part
from calm.case.result_tables import ColumnTable
from calm.case.targets import Figures, figures_of
from calm.errors import NoEquilibrium, UsageError
from calm.files import Place
from calm.physics.line import Floats, Line, Water
from calm.solve import expect_many, solve_mooring

if TYPE_CHECKING:
    from calm.case.result import Result

SOLVES = 100.0
"""About how many equilibria an explanation takes, by work."""

CHANGE = 0.1
"""Share by which the buoyancy, the drag and the current are changed."""


@dataclass(frozen=True, slots=True)
class Cause:
    """Hold what the drag of a piece or clamp causes: a row of `Causes`."""

    index: int
    label: str
    clamped: bool
    drag: float
    knockdown: float
    excursion: float
    used_buoyancy: float


class Causes(ColumnTable[Cause]):
    """The p pieces and clamped instruments that have drag, in file order.

    Attributes
    ----------
    index : (p,) of the piece, or of the piece it is clamped on
    label : (p,)
    clamped : (p,)
    drag : (p,) horizontal force of the water on it [N]
    knockdown, excursion, used_buoyancy : (p,) its share of that of the mooring [m], [m], [-]
    """

    record = Cause


@dataclass(frozen=True)
class WhatIf:
    """A change by its name, and the figures it leads to, or why there are none."""

    name: str
    figures: Figures | None = None
    failure: NoEquilibrium | None = None


@dataclass(frozen=True)
class Explanation:
    """Hold what causes the knockdown and excursion of a mooring, and what would change them.

    Attributes
    ----------
    label : of the piece or clamp explained
    quantities : the columns of `causes` that have a meaning: knockdown and excursion; for a line
        without a unique shape in still water, excursion and the buoyancy in use
    figures : of the mooring as given
    without_drag : what of each quantity no drag causes
    causes : the share of each drag in the rest; None where it is not known
    miss : the worst error of the shares' sums before they were scaled, as a share of the whole
    changes : what more buoyancy, less drag, more and less current would lead to
    notes : what to keep in mind
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
        """The object `explain` of the result format: SI, null where a figure is unknown."""
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
    """Explain a solved mooring.

    Parameters
    ----------
    result : of a mooring
    label : of the piece (its upper end) or clamp to explain; ``top``, the free end, when absent

    Returns
    -------
    Explanation : the shares are those of `calm.case.attribution`; the changes are solved anew,
        with the settings of the result. A piece cut to fit keeps its length in them.

    Raises
    ------
    UsageError
        No part above the anchor is called so.
    """
    mooring = result.mooring
    try:
        part = one_part(mooring.file.pieces[:-1], label or TOP)
    except LookupError as error:
        raise UsageError(str(error.args[0])) from None
    expect_many(SOLVES)
    figures = figures_of(result, part.place)
    quantities: tuple[str, ...] = ("knockdown", "excursion")
    if figures.knockdown is None or result.type == "surface":
        quantities = ("excursion", "used_buoyancy") if result.type == "surface" else ("excursion",)
    notes = list(_notes(result, quantities))
    causes, without_drag, miss = None, dict.fromkeys(quantities, 0.0), 0.0
    try:
        shares = _shares(mooring, figures, "knockdown" in quantities, _point(mooring, part.place))
    except NoEquilibrium as failure:
        notes.append(
            "The shares of the drags cannot be found: with less drag the line has no equilibrium "
            f"({failure.status}: {failure.message})"
        )
    else:
        causes = _causes(mooring, shares)
        columns = [_COLUMNS.index(name) for name in quantities]
        miss = float(np.abs(shares.miss[columns]).max()) if mooring.water.moving else 0.0
        for name, column in zip(quantities, columns, strict=True):
            without_drag[name] = 0.0 if name == "knockdown" else float(shares.start[column])
        if miss > FAIR:
            notes.append(
                f"The shares are approximate: they do not grow steadily with the drag ({miss:.0%} "
                "were scaled)."
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
"""What the columns of an `Attribution` add up to."""


def _notes(result: Result, quantities: tuple[str, ...]) -> Iterator[str]:
    if result.type == "surface":
        yield (
            "A float at the surface is not knocked down: its excursion and the buoyancy it "
            "uses are explained instead."
        )
    elif "knockdown" not in quantities:
        yield (
            "In still water the line has no unique shape, so there is no knockdown: its excursion "
            "is explained instead."
        )
    if not result.mooring.water.moving:
        yield "There is no current, and so no drag."


def _point(mooring: Mooring, place: Place) -> SolverPart:
    """Index of the piece, and of the clamp or -1, by which the solver knows the part."""
    pieces = mooring.file.pieces
    own = replace(place, clamp=-1)
    index = next(piece.index for piece in pieces if piece.place == own)
    clamps = [clamp.place for clamp in clamps_in(pieces)]
    return index, clamps.index(place) if place.is_clamp else -1


def _shares(mooring: Mooring, figures: Figures, stands: bool, point: SolverPart) -> Attribution:
    whole = np.array([figures.depth, figures.excursion, figures.used_buoyancy])
    start = None
    if stands:
        assert figures.knockdown is not None
        start = np.array([figures.depth - figures.knockdown, 0.0, 1.0])
    return attribute(mooring.line, mooring.water, start, whole, point)


def _causes(mooring: Mooring, shares: Attribution) -> Causes:
    pieces, clamps = mooring.file.pieces, clamps_in(mooring.file.pieces)
    parts = list(zip(shares.piece.tolist(), shares.clamp.tolist(), strict=True))
    return Causes(
        index=shares.piece,
        label=[(clamps[m] if m >= 0 else pieces[p]).label for p, m in parts],
        clamped=[m >= 0 for _, m in parts],
        drag=_drags(mooring, parts),
        knockdown=shares.shares[:, 0],
        excursion=shares.shares[:, 1],
        used_buoyancy=shares.shares[:, 2],
    )


def _drags(mooring: Mooring, parts: list[SolverPart]) -> Floats:
    """(p,) size of the horizontal force of the water on each part [N]."""
    solution = solve_mooring(mooring.line, mooring.water, mooring.settings)
    change = np.diff(solution.force[: solution.hanging + 1, :2], axis=0)
    piece = solution.element_piece[: solution.hanging]
    clamp = solution.element_clamp[: solution.hanging]
    sums = [change[(piece == p) & (clamp == m)].sum(axis=0) for p, m in parts]
    return np.array([np.hypot(*force) for force in sums])


def _variations(mooring: Mooring) -> Iterator[tuple[str, Mooring]]:
    line, water, percent = mooring.line, mooring.water, f"{CHANGE:.0%}".replace("%", " %")
    yield f"buoyancy +{percent}", _with(mooring, line=_with_buoyancy(line, 1.0 + CHANGE))
    yield f"drag −{percent}", _with(mooring, line=with_drag(line, 1.0 - CHANGE))
    yield f"current +{percent}", _with(mooring, water=drawn_water(water, Draw(1.0 + CHANGE)))
    yield f"current −{percent}", _with(mooring, water=drawn_water(water, Draw(1.0 - CHANGE)))


def _with(mooring: Mooring, line: Line | None = None, water: Water | None = None) -> Mooring:
    """Return the same mooring with a line or water that differs from its file."""
    return Mooring(mooring.file, line=line or mooring.line, water=water or mooring.water)


def _with_buoyancy(line: Line, factor: float) -> Line:
    """The line with the net force of everything buoyant in it multiplied."""
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


def _changed(name: str, mooring: Mooring, place: Place) -> WhatIf:
    try:
        return WhatIf(name, figures_of(mooring.solve(), place))
    except NoEquilibrium as failure:
        return WhatIf(name, failure=failure)
