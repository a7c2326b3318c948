"""A mooring file, ready to be solved."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np

from calm.assemble import assemble_floating, assemble_line, assemble_water, net_buoyancy
from calm.case.measure import result_of
from calm.case.memory import Forgetful, Memory
from calm.case.parts import naming_the_piece, parts_of
from calm.case.result import Result
from calm.case.tow import Tow
from calm.case.variant import Origin
from calm.errors import NoEquilibrium, UsageError
from calm.files import MooringFile
from calm.physics.drag import BLOCK_CD, area_drag
from calm.physics.line import Line, Water
from calm.physics.materials import STEEL_DENSITY
from calm.physics.seawater import REFERENCE_DENSITY
from calm.solve import Settings, Solution, Status, fit_length, solve_mooring
from calm.solve.problem import COARSE_STEP
from calm.solve.standing import standing_lift, too_heavy


def load(
    path: str | Path,
    environment: str | Path | None = None,
    catalogs: Sequence[str | Path] = (),
    text: str | None = None,
) -> Mooring | Tow:
    """Read the file of a mooring or a tow.

    Parameters
    ----------
    path : the YAML file
    environment : name of one of its `environments`, or an environment file
    catalogs : catalogue files of your own, whose definitions come before the shipped ones
    text : in place of the file's content; files that it names are still looked for beside the file

    Raises
    ------
    InputError
        With every mistake of the file, each with its line and column.
    """
    origin = Origin(path, environment, tuple(Path(each) for each in catalogs), text)
    return _read(origin)


def _read(origin: Origin) -> Mooring | Tow:
    file = origin.read()
    read = Mooring(file) if file.tow is None else Tow(file)
    vars(read)["origin"] = origin
    return read


@dataclass(frozen=True, init=False)
class Mooring:
    """A mooring as read from its file; `line` and `water` are what the solver takes.

    They follow from the file where they are not given. `for_surface` says whether it is meant to
    reach the surface, where that is known beforehand: a mooring judged with a change is meant for
    what it was meant for before. `memory` keeps what was solved for other states of the same file,
    and in other environments.
    """

    file: MooringFile
    for_surface: bool | None
    memory: Memory = field(repr=False, compare=False)
    _line: Line | None = field(repr=False, compare=False)
    _water: Water | None = field(repr=False, compare=False)
    origin: Origin | None = field(default=None, repr=False, compare=False)

    def __init__(
        self,
        file: MooringFile,
        for_surface: bool | None = None,
        memory: Memory | None = None,
        line: Line | None = None,
        water: Water | None = None,
    ) -> None:
        memory = Forgetful() if memory is None else memory
        fields = {"file": file, "for_surface": for_surface, "memory": memory}
        vars(self).update(fields, _line=line, _water=water)

    def __reduce__(self) -> tuple[type[Mooring], tuple[object, ...]]:
        """Return what another process needs: all else follows from these."""
        return Mooring, (self.file, self.for_surface, self.memory, self._line, self._water)

    @cached_property
    def water(self) -> Water:
        """Depth, current and density by level."""
        return self._water or assemble_water(self.file.environment)

    @property
    def settings(self) -> Settings:
        """Return how the line is solved."""
        solver = self.file.solver
        return Settings(solver.angle_step, solver.tolerance, solver.seabed_friction)

    @cached_property
    def line(self) -> Line:
        """The pieces above the anchor, a piece that is cut to fit at its cut length.

        Raises
        ------
        NoEquilibrium
            Where no length fits.
        """
        if self._line is not None:
            return self._line
        line = assemble_line(self.file.pieces, self.file.solver, self.water.gravity)
        if self.file.solver.buoy_drag == "immersed":
            floating = assemble_floating(self.file.pieces, self.file.environment, self.water)
            line = replace(line, floating=floating)
        for piece in self.file.pieces:
            if piece.fit_top_depth is not None:
                with naming_the_piece(self.file.pieces):
                    length = self.memory.of(
                        fit_length, line, self.water, piece.index, piece.fit_top_depth,
                        self.settings,
                    )  # fmt: skip
                return line.with_length(piece.index, length)
        return line

    @cached_property
    def anchor_weight(self) -> float:
        """Weight in the water at the seabed of the anchor with what is clamped on it [N]."""
        water = self.water
        _, density = water.at(np.array(water.depth))
        excess = (float(density) - REFERENCE_DENSITY) * water.gravity
        return -sum(
            net_buoyancy(part.component, water.gravity)
            + excess * (part.component.displaced_volume or 0.0)
            for part in parts_of(self.file.pieces[-1:])
        )

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

    def with_(
        self, label: str | None = None, /, environment: str | Path | None = None, **keys: Any
    ) -> Mooring:
        """Return the same mooring with some values of its file changed, as `Origin.with_values`.

        Parameters
        ----------
        label : of the piece or clamp that has the keys; the keys are the file's where it is not
            given: ``mooring.with_("wire 1", length="480 m")``, ``mooring.with_(solver={…})``
        environment : name of one of its `environments`, or an environment file

        Raises
        ------
        InputError
            With the mistakes that the values make.
        UsageError
            No piece has the label, or the mooring was not loaded from a file.
        """
        if self.origin is None:
            raise UsageError("a mooring that was not loaded from a file has no values to change")
        origin = self.origin.with_values(self.file, label, keys)
        changed = _read(replace(origin, environment=environment or origin.environment))
        assert isinstance(changed, Mooring)
        return changed

    def solve(self, environment: str | Path | None = None) -> Result:
        """Find the static equilibrium, in another of its environments where one is given.

        Raises
        ------
        NoEquilibrium
            With status, message and advice, where there is none that passes every check.
        """
        if environment is not None:
            return self.with_(environment=environment).solve()
        solution = self.equilibrium(self.water)
        return result_of(self, solution, self.still_beside(solution))

    def equilibrium(self, water: Water) -> Solution:
        """The line solved in some water, refused where the mooring is not meant to stand so.

        Raises
        ------
        NoEquilibrium
            As `solve` does.
        """
        with naming_the_piece(self.file.pieces):
            solution = self.memory.of(solve_mooring, self.line, water, self.settings)
        self._refuse_a_lifted_anchor(solution)
        self._refuse_a_heap(solution)
        return solution

    def _refuse_a_lifted_anchor(self, solution: Solution) -> None:
        pull, weight = float(solution.force[-1, 2]), self.anchor_weight
        if pull > weight:
            raise Status.ANCHOR_LIFTS.because(
                f"The line pulls up with {pull:.0f} N; the anchor weighs {weight:.0f} N in water."
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
            f"The current {pulls}lays {label} on the seabed: of a line below the surface nothing "
            "but chain may lie there."
        )

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
