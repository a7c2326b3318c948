"""A mooring file ready to be solved, and its profilers at their stops and between them."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from functools import cached_property
from math import isinf

import numpy as np

from calm.assemble import assemble_floating, assemble_line, assemble_water
from calm.case import parts
from calm.case.measure import anchor_weight_of, clamps_of, result_of
from calm.case.memory import Forgetful, Memory
from calm.case.result import Result
from calm.errors import NoEquilibrium
from calm.files import Clamp, MooringFile, Place, Profiler
from calm.files.pieces import clamps_in
from calm.physics.drag import BLOCK_CD, area_drag
from calm.physics.line import Line, Water
from calm.physics.materials import STEEL_DENSITY
from calm.physics.seawater import REFERENCE_DENSITY
from calm.solve import Settings, Solution, Status, fit_length, solve_mooring
from calm.solve.problem import COARSE_STEP
from calm.solve.solution import standing_lift, too_heavy

PLACES = 11
"""Where on its way a profiler is solved for, its two stops among them."""


@dataclass(frozen=True, init=False)
class Mooring(parts.ReadFromFile):
    """A mooring as read from its file; `line` and `water` are what the solver takes.

    They follow from the file where they are not given. `for_surface` says whether it is meant to
    reach the surface, where that is known beforehand: a mooring judged with a change is meant for
    what it was meant for before. `memory` keeps what was solved for other states of the same file,
    and in other environments.
    """

    file: MooringFile
    for_surface: bool | None
    memory: Memory = field(repr=False, compare=False)
    origin: parts.Origin | None = field(default=None, repr=False, compare=False)

    def __init__(
        self,
        file: MooringFile,
        for_surface: bool | None = None,
        memory: Memory | None = None,
        line: Line | None = None,
        water: Water | None = None,
    ) -> None:
        memory = Forgetful() if memory is None else memory
        vars(self).update(file=file, for_surface=for_surface, memory=memory)
        given = {"line": line, "water": water}
        vars(self).update({name: value for name, value in given.items() if value is not None})

    def __reduce__(self) -> tuple[type[Mooring], tuple[object, ...]]:
        """Return what another process needs: all else follows from these."""
        known = vars(self)
        line, water = known.get("line"), known.get("water")
        return Mooring, (self.file, self.for_surface, self.memory, line, water)

    @cached_property
    def water(self) -> Water:
        """Depth, current and density by level."""
        return assemble_water(self.file.environment)

    @property
    def settings(self) -> Settings:
        """Return how the line is solved."""
        solver = self.file.solver
        return Settings(solver.angle_step, solver.tolerance, solver.seabed_friction)

    @cached_property
    def line(self) -> Line:
        """The pieces above the anchor, a piece that is cut to fit at its cut length.

        NoEquilibrium: where no length fits.
        """
        line = assemble_line(self.file.pieces, self.file.solver, self.water.gravity)
        if self.file.solver.buoy_drag == "immersed":
            floating = assemble_floating(self.file.pieces, self.file.environment, self.water)
            line = replace(line, floating=floating)
        for piece in self.file.pieces:
            if piece.fit_top_depth is not None:
                with parts.naming_the_piece(self.file.pieces):
                    length = self.memory.of(
                        fit_length, line, self.water, piece.index, piece.fit_top_depth,
                        self.settings,
                    )  # fmt: skip
                return line.with_length(piece.index, length)
        return line

    @cached_property
    def anchor_weight(self) -> float:
        """Weight in the water at the seabed of the anchor with what is clamped on it [N]."""
        return anchor_weight_of(self.file.pieces[-1], self.water)

    @cached_property
    def anchor_drag(self) -> float:
        """K of the falling anchor [N/(m/s)²]; where it gives none, that of a cube.

        The cube has the volume that the anchor displaces, or that of steel of its weight.
        """
        anchor = self.file.anchor
        if anchor.kt is not None:
            return anchor.kt
        volume = anchor.displaced_volume
        if not volume:
            density = anchor.material_density or STEEL_DENSITY
            volume = self.anchor_weight / ((density - REFERENCE_DENSITY) * self.water.gravity)
        return area_drag(max(volume, 0.0) ** (2.0 / 3.0), BLOCK_CD)

    def solve(self, environment: parts.OtherEnvironment | None = None) -> Result:
        """Find the static equilibrium, in another of its environments where one is given.

        NoEquilibrium: with status, message and advice, where there is none that passes every check.
        """
        if environment is not None:
            return self.with_(environment=environment).solve()
        solution = self.equilibrium(self.water)
        result = result_of(self, solution, self.still_beside(solution))
        return replace(result, profilers=profilers_of(self))

    def equilibrium(self, water: Water) -> Solution:
        """The line solved in some water, refused where the mooring is not meant to stand so.

        NoEquilibrium: as `solve` does.
        """
        with parts.naming_the_piece(self.file.pieces):
            solution = self.memory.of(solve_mooring, self.line, water, self.settings)
        self._refuse_a_lifted_anchor(solution)
        self._refuse_a_heap(solution)
        refuse_in_the_slope(self.file, solution, self.water.depth)
        return solution

    def _refuse_a_lifted_anchor(self, solution: Solution) -> None:
        pull, weight = float(solution.force[-1, 2]), self.anchor_weight
        if pull > weight:
            raise Status.ANCHOR_LIFTS.because(
                f"The vertical pull of the line is {pull:.0f} N; the anchor weighs {weight:.0f} N "
                "in water."
            )

    def _refuse_a_heap(self, solution: Solution) -> None:
        """A sub-surface line is meant to stand: only chain may lie on the seabed below it."""
        if solution.surface:
            return
        pieces = self.file.pieces
        for lying in sorted(set(solution.element_piece[solution.hanging :].tolist())):
            if pieces[lying].component.kind != "chain":
                raise self.heaped(pieces[lying].label)

    def heaped(self, label: str) -> NoEquilibrium:
        """Return why a sub-surface line is refused where more of it than chain lies on the
        seabed.
        """
        lift, length = standing_lift(self.line, self.water), np.cumsum(self.line.length)
        height = self.water.depth - self.line.anchor_height
        hung = float(np.interp(height, length, np.cumsum(lift)))
        floats_at_rest = length[-1] > height and hung > 0.0
        if float(lift.sum()) <= 0.0 and not floats_at_rest:
            return too_heavy(lift)
        pulls = "pulls the line's top under water and " if floats_at_rest else ""
        return Status.GROUNDED.because(
            f"The current {pulls}lays {label} on the seabed: only the chain of a sub-surface "
            "line may lie there."
        )

    def solved(self, line: Line) -> Solution:
        """Return another line in the same water; NoEquilibrium: it has no equilibrium."""
        return solve_mooring(line, self.water, self.settings)

    def still_beside(self, solution: Solution) -> Solution | None:
        """Return the same line without current; None where it has no unique shape."""
        floating = self.line.floating
        blown = solution.riding is not None and floating is not None and floating.blown
        return self.at_rest if self.water.moving or blown else solution

    @cached_property
    def at_rest(self) -> Solution | None:
        """The line without current and wind; None where it has no unique shape."""
        line, floating = self.line, self.line.floating
        if floating is not None:
            line = replace(line, floating=replace(floating, wind=(0.0, 0.0)))
        # a plumb line is exact with long segments
        settings = replace(self.settings, angle_step=max(self.settings.angle_step, COARSE_STEP))
        try:
            return self.memory.of(solve_mooring, line, self.water.still(), settings)
        except NoEquilibrium:
            return None


def refuse_in_the_slope(file: MooringFile, solution: Solution, depth: float) -> None:
    """Refuse a line that hangs into a seabed out of a grid, whose plane the solver knows.

    Parameters
    ----------
    solution : of the line of the file; what hangs may come as far below as what lies
    depth : of the water at the origin, or of a leg at its anchor [m]
    """
    if file.environment.seabed is None:
        return
    below = np.nan_to_num(parts.below_the_seabed(file, solution, depth), nan=-np.inf)
    lying = max(0.0, *below[solution.hanging :].tolist())
    worst = int(np.argmax(below[: solution.hanging + 1]))
    if below[worst] > lying + solution.depth_error + 1e-6 * depth:
        number = solution.piece_at(worst)
        pieces = len(file.pieces) - 1
        piece = file.pieces[pieces - 1 - number if solution.line.towed else number]
        raise Status.GROUNDED.because(
            f"{piece.label} comes {below[worst]:.2f} m below the sloping seabed.",
            advice="Raise it, or move it down the slope.",
        )


@dataclass(frozen=True)
class ProfilerPlace:
    """Hold what a profiler finds at a place on its way: depth [m], tension [N], tilt [degrees].

    `at` is the distance from the top of its wire, without load [m].
    """

    at: float
    depth: float
    tension: float
    tilt: float


@dataclass(frozen=True)
class ProfilerTravel:
    """Hold a profiler at its upper and its lower stop, and where its wire leans most.

    `distance` is between its stops, without load [m], `time` what a profile takes [s], `profiles`
    how many its batteries last for; None where its speed or its endurance is not given.
    """

    label: str
    upper: ProfilerPlace
    lower: ProfilerPlace
    worst: ProfilerPlace
    distance: float
    time: float | None
    profiles: int | None


def profilers_of(mooring: Mooring) -> tuple[ProfilerTravel, ...]:
    """Return every profiler of a line on its way; the others stay at their upper stops.

    NoEquilibrium: the line does not stand with a profiler at one of its `PLACES`.
    """
    return tuple(_travel(mooring, clamp) for clamp in profilers_in(mooring))


def profilers_in(mooring: Mooring) -> list[Clamp]:
    """Return the profilers that travel on a line."""
    return [clamp for clamp in clamps_in(mooring.file.pieces) if clamp.travel is not None]


def _travel(mooring: Mooring, clamp: Clamp) -> ProfilerTravel:
    assert clamp.travel is not None
    upper, lower = clamp.travel
    if isinf(lower):  # the end of its wire
        on = next(piece.index for piece in mooring.file.pieces if clamp in piece.clamps)
        lower = float(mooring.line.length[on])
    places = [_found(mooring, clamp, float(at)) for at in np.linspace(upper, lower, PLACES)]
    component, distance = clamp.component, lower - upper
    assert isinstance(component, Profiler)
    return ProfilerTravel(
        label=clamp.label,
        upper=places[0],
        lower=places[-1],
        worst=max(places, key=lambda place: place.tilt),
        distance=distance,
        time=None if component.speed is None else distance / component.speed,
        profiles=None if component.endurance is None else int(component.endurance // distance),
    )


def _found(mooring: Mooring, clamp: Clamp, at: float) -> ProfilerPlace:
    try:
        file = held(parts.cut_like(mooring.file, mooring), clamp.place, at)
        other = Mooring(file, mooring.for_surface, mooring.memory, water=mooring.water)
        clamps = clamps_of(file.pieces[:-1], other.equilibrium(other.water))
    except NoEquilibrium as failure:
        message = f"With {clamp.label} {at:.0f} m down its wire: {failure.message}"
        raise NoEquilibrium(failure.status, message, failure.advice) from None
    row = clamps.label.index(clamp.label)
    return ProfilerPlace(
        at, float(clamps.depth[row]), float(clamps.tension[row]), float(clamps.tilt[row])
    )


def held(file: MooringFile, place: Place | None = None, at: float = 0.0) -> MooringFile:
    """Return a file whose profilers stay where they are, one of them at another place.

    Parameters
    ----------
    place : of that profiler in the line; None where all stay
    at : distance from the top of its wire, without load [m]
    """

    def stays(clamp: Clamp) -> Clamp:
        return replace(clamp, at=at if clamp.place == place else clamp.at, travel=None)

    pieces = (piece.with_clamps(stays) if piece.clamps else piece for piece in file.pieces)
    return replace(file, pieces=tuple(pieces))
