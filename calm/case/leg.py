"""A leg of a design: its pieces from the upper to the lower end, and the supports of both ends."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np

from calm.assemble import assemble_floating, assemble_line, assemble_water, net_buoyancy
from calm.case import parts
from calm.case.memory import Memory, NoMemory
from calm.errors import NoEquilibrium
from calm.files import MooringFile, Piece
from calm.files.legs import EndKeys, FileLeg
from calm.files.mooring_file import legs_of
from calm.files.pieces import STAND_IN, parts_of
from calm.physics.drag import BLOCK_CD, area_drag
from calm.physics.line import Line, Water
from calm.physics.materials import STEEL_DENSITY
from calm.physics.seawater import REFERENCE_DENSITY
from calm.records.profile_tables import components
from calm.solve import (
    Settings,
    Solution,
    Status,
    Towing,
    fit_length,
    fit_tow_length,
    solve_mooring,
    solve_tow,
)
from calm.solve.problem import COARSE_STEP
from calm.solve.solution import standing_lift, too_heavy


@dataclass(frozen=True)
class Leg:
    """A leg, with its line and its water as arrays for the solver.

    Attributes
    ----------
    file : file with this leg only. Pieces are listed from the upper end. In a leg that is not
        towed, the last piece is the anchor, or a stand-in with the id `STAND_IN`
    for_surface : whether the leg is designed to reach the surface; None to determine this from the
        leg
    memory : cache of solutions for earlier versions of the file and other environments
    given_line, given_water : replacements for the line and the water of the file
    """

    file: MooringFile
    for_surface: bool | None = None
    memory: Memory = field(default_factory=NoMemory, repr=False, compare=False)
    given_line: Line | None = field(default=None, repr=False, compare=False)
    given_water: Water | None = field(default=None, repr=False, compare=False)

    def __reduce__(self) -> tuple[type[Leg], tuple[object, ...]]:
        known = vars(self)
        line, water = (known.get(name, known[f"given_{name}"]) for name in ("line", "water"))
        return Leg, (self.file, self.for_surface, self.memory, line, water)

    @property
    def name(self) -> str:
        """Name of the leg; for a mooring or a tow, the name of the design."""
        return self.file.name

    @property
    def keys(self) -> FileLeg:
        """Entry of the leg in the design file."""
        return legs_of(self.file)[0]

    @property
    def of_several(self) -> bool:
        """Whether the leg belongs to a net and is solved with the other legs."""
        return bool(self.file.legs)

    @property
    def top(self) -> EndKeys:
        """Support of the upper end."""
        return self.keys.top

    @property
    def bottom(self) -> EndKeys:
        """Support of the lower end."""
        return self.keys.bottom

    @property
    def towed(self) -> bool:
        """Whether a ship or an aircraft tows the leg."""
        return self.file.tow is not None

    @property
    def anchored(self) -> bool:
        """Whether the leg ends in an anchor."""
        return self.bottom.anchor is not None

    @property
    def pieces(self) -> tuple[Piece, ...]:
        """Pieces of the leg, without the stand-in for an anchor."""
        return tuple(piece for piece in self.file.pieces if piece.use != STAND_IN)

    @cached_property
    def water(self) -> Water:
        """Water of the leg: depth at the anchor, and density and current over the ground at each
        level.
        """
        return self.given_water or assemble_water(self.file.environment)

    @property
    def settings(self) -> Settings:
        """Settings of the solver."""
        solver = self.file.solver
        friction = 0.0 if self.towed else solver.seabed_friction
        return Settings(solver.angle_step, solver.tolerance, friction)

    @property
    def towing(self) -> Towing:
        """Velocity of the ship, height of the sheave, and wind."""
        keys, wind = self.file.tow, self.file.environment.wind
        assert keys is not None
        return Towing(
            *components(keys.speed, keys.toward),
            height=keys.height,
            wind=(0.0, 0.0) if wind is None else components(wind.speed, wind.toward),
            in_air=self.file.environment.fluid == "air",
        )

    @cached_property
    def line(self) -> Line:
        """Pieces above the anchor as arrays; a fitted piece has its computed cut length.

        Raises NoEquilibrium if no cut length reaches the required depth.
        """
        if self.given_line is not None:
            return self.given_line
        pieces, solver = self.file.pieces, self.file.solver
        line = assemble_line(pieces, solver, self.water.gravity)
        if self.top.free and solver.buoy_drag == "immersed":
            floating = assemble_floating(pieces, self.file.environment, self.water)
            line = line if floating is None else replace(line, floating=floating)
        for piece in pieces:
            if piece.length is None:
                with parts.naming_the_piece(pieces):
                    return line.with_length(piece.index, self._fitting(line, piece))
        return line

    def _fitting(self, line: Line, piece: Piece) -> float:
        if piece.fit_body_depth is not None:
            return self.memory.of(
                fit_tow_length, line, self.water, self.towing, piece.index, piece.fit_body_depth,
                self.settings,
            )  # fmt: skip
        assert piece.fit_top_depth is not None
        return self.memory.of(
            fit_length, line, self.water, piece.index, piece.fit_top_depth, self.settings
        )

    def cut(self, file: MooringFile) -> MooringFile:
        """Return a copy of a file with the cut length that this leg computes for the fitted piece.

        Raises NoEquilibrium if no cut length reaches the required depth.
        """
        if all(piece.length is not None for piece in file.pieces):
            return file
        pieces = tuple(
            piece
            if piece.length is not None
            else replace(
                piece,
                length=float(self.line.length[piece.index]),
                fit_top_depth=None,
                fit_body_depth=None,
            )
            for piece in file.pieces
        )
        return replace(file, pieces=pieces)

    @cached_property
    def anchor_weight(self) -> float:
        """Weight of the anchor and its clamps in the water at the seabed [N]."""
        density = self.water.density_at(np.array(self.water.depth))
        excess = (float(density) - REFERENCE_DENSITY) * self.water.gravity
        return -sum(
            net_buoyancy(part.component, self.water.gravity)
            + excess * (part.component.displaced_volume or 0.0)
            for part in parts_of(self.file.pieces[-1:])
        )

    @cached_property
    def anchor_drag(self) -> float:
        """Drag of the falling anchor at 1 m/s [N/(m/s)²].

        An anchor without `kt` has the drag of a cube with its displaced volume. An unknown volume
        follows from the weight and the density of the material, by default steel.
        """
        anchor = self.file.anchor
        if anchor.kt is not None:
            return anchor.kt
        volume = anchor.displaced_volume
        if not volume:
            density = anchor.material_density or STEEL_DENSITY
            volume = self.anchor_weight / ((density - REFERENCE_DENSITY) * self.water.gravity)
        return area_drag(max(volume, 0.0) ** (2.0 / 3.0), BLOCK_CD)

    def equilibrium(self, water: Water | None = None) -> Solution:
        """Solve the leg alone, in the water of the file or in other water.

        Raises NoEquilibrium if no equilibrium passes every check, or if the leg would lift its
        anchor, put a piece other than chain on the seabed, or penetrate a slope.
        """
        water = water or self.water
        with parts.naming_the_piece(self.file.pieces, towed=self.towed):
            if self.towed:
                return self.memory.of(solve_tow, self.line, water, self.towing, self.settings)
            solution = self.memory.of(solve_mooring, self.line, water, self.settings)
        self.refuse_a_lifted_anchor(solution)
        self._refuse_grounded_pieces(solution)
        self.refuse_in_the_slope(solution)
        return solution

    def refuse_a_lifted_anchor(self, solution: Solution) -> None:
        """Raise NoEquilibrium if the vertical load of a leg exceeds the weight of its anchor."""
        pull, weight = float(solution.force[-1, 2]), self.anchor_weight
        if pull > weight:
            line, its = "the line", "the anchor"
            if self.of_several:
                line, its = f"leg {self.name}", "its anchor"
            raise Status.ANCHOR_LIFTS.because(
                f"The vertical load of {line} is {pull:.0f} N and lifts {its}, which weighs "
                f"{weight:.0f} N in water."
            )

    def _refuse_grounded_pieces(self, solution: Solution) -> None:
        if solution.surface:
            return
        pieces = self.file.pieces
        for lying in sorted(set(solution.element_piece[solution.hanging :].tolist())):
            if pieces[lying].component.kind != "chain":
                raise self.grounded_error(pieces[lying].label)

    def grounded_error(self, label: str) -> NoEquilibrium:
        """Return the exception for a sub-surface line that has a piece other than chain on the
        seabed.
        """
        lift, length = standing_lift(self.line, self.water), np.cumsum(self.line.length)
        height = self.water.depth - self.line.anchor_height
        net_lift = float(np.interp(height, length, np.cumsum(lift)))
        floats_at_rest = length[-1] > height and net_lift > 0.0
        if float(lift.sum()) <= 0.0 and not floats_at_rest:
            return too_heavy(lift)
        pulls = "pulls the top of the line under water and " if floats_at_rest else ""
        return Status.GROUNDED.because(
            f"The current {pulls}puts {label} on the seabed. In a sub-surface mooring, only chain "
            "may lie on the seabed."
        )

    def refuse_in_the_slope(self, solution: Solution) -> None:
        """Raise NoEquilibrium if a line would penetrate the seabed of a depth grid.

        The solver assumes a plane seabed, so the grounded part of the line may be below the depth
        grid. The suspended part must not be farther below the grid than the grounded part.
        """
        depth = self.water.depth
        if self.file.environment.seabed is None:
            return
        below = np.nan_to_num(parts.below_the_seabed(self.file, solution, depth), nan=-np.inf)
        lying = max(0.0, *below[solution.hanging :].tolist())
        worst = int(np.argmax(below[: solution.hanging + 1]))
        if below[worst] > lying + solution.depth_error + 1e-6 * depth:
            number = solution.piece_at(worst)
            count = len(self.file.pieces) - 1
            piece = self.file.pieces[count - 1 - number if solution.line.towed else number]
            raise Status.GROUNDED.because(
                f"{piece.label} would be {below[worst]:.2f} m below the sloping seabed.",
                advice="Raise this part, or move the mooring down the slope.",
            )

    def solved(self, line: Line) -> Solution:
        """Solve the leg with another line. Raises NoEquilibrium if there is no equilibrium."""
        if self.towed:
            return solve_tow(line, self.water, self.towing, self.settings)
        return solve_mooring(line, self.water, self.settings)

    def still_counterpart(self, solution: Solution) -> Solution | None:
        """Return the solution of the line in still water; None for a tow, or if the shape in still
        water is not unique.
        """
        if self.towed:
            return None
        floating = self.line.floating
        blown = solution.riding is not None and floating is not None and floating.blown
        return self.at_rest if self.water.moving or blown else solution

    @cached_property
    def at_rest(self) -> Solution | None:
        """Solution of the line without current and wind, or None if the shape is not unique."""
        line, floating = self.line, self.line.floating
        if floating is not None:
            line = replace(line, floating=replace(floating, wind=(0.0, 0.0)))
        # long segments are exact for a plumb line
        settings = replace(self.settings, angle_step=max(self.settings.angle_step, COARSE_STEP))
        try:
            return self.memory.of(solve_mooring, line, self.water.still(), settings)
        except NoEquilibrium:
            return None
