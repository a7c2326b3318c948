"""A tow file, ready to be solved, and its result."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import asdict, dataclass, field, replace
from functools import cached_property
from math import atan2, degrees, hypot
from typing import Any

from calm.assemble import assemble_line, assemble_water
from calm.case.measure import clamps_of, components_of, shape_of
from calm.case.memory import Forgetful, Memory
from calm.case.parts import Origin, OtherEnvironment, ReadFromFile, cut_like, naming_the_piece
from calm.case.result import Solved, line_document
from calm.case.result_tables import Accuracy, TowedBody, TowPoint
from calm.case.strumming import StrummingBand, band_of, strumming_of
from calm.case.warnings import warnings_of
from calm.errors import NoEquilibrium, UsageError, or_why_not
from calm.files import MooringFile, TowKeys
from calm.files.strumming_keys import BourgetMarichalKeys
from calm.physics.line import Line, Water
from calm.records.profile_tables import components
from calm.solve import Settings, Solution, Status, Towing, fit_tow_length, solve_tow


@dataclass(frozen=True, kw_only=True, repr=False)
class TowResult(Solved):
    """A converged tow. Lengths and depths [m], forces [N], angles [degrees], speed [m/s].

    `components` run from the ship down, `shape` from the free end; x and y are east and north of
    the tow point, depths above the water negative. `miss`, `closure` and `accuracy` are as in
    `Result`, the ship in place of the anchor.
    """

    tow: Tow
    speed: float
    toward: float
    tow_point: TowPoint
    body: TowedBody

    @property
    def other_equilibrium(self) -> dict[str, float] | None:
        """Depth of the free end in another equilibrium [m]."""
        return None if self.other is None else {"depth": self.other.depth}

    @property
    def file(self) -> MooringFile:
        """The file as read."""
        return self.tow.file

    @cached_property
    def strumming_band(self) -> StrummingBand | None:
        """Return the same tow with more drag on its cables; solved when first asked for."""
        return band_of(self.tow)

    def to_dict(self) -> dict[str, Any]:
        """The JSON object of the result format; None stands where a figure is unknown."""
        ends = {
            "speed": self.speed,
            "toward": self.toward,
            "tow_point": asdict(self.tow_point),
            "body": asdict(self.body),
        }
        return line_document(self, ends)


@dataclass(frozen=True, init=False)
class Tow(ReadFromFile):
    """A tow as read from its file; `line`, `water` and `towing` are what the solver takes.

    The line follows from the file where it is not given. `memory` keeps what was solved for other
    states of the same file.
    """

    file: MooringFile
    memory: Memory = field(repr=False, compare=False)
    origin: Origin | None = field(default=None, repr=False, compare=False)

    def __init__(
        self, file: MooringFile, memory: Memory | None = None, line: Line | None = None
    ) -> None:
        vars(self).update(file=file, memory=Forgetful() if memory is None else memory)
        if line is not None:
            vars(self)["line"] = line

    def __reduce__(self) -> tuple[type[Tow], tuple[object, ...]]:
        """Return what another process needs: all else follows from it."""
        return Tow, (self.file, None, vars(self).get("line"))

    @property
    def keys(self) -> TowKeys:
        """The keys of `tow` in the file."""
        assert self.file.tow is not None
        return self.file.tow

    @cached_property
    def water(self) -> Water:
        """Depth, current over the ground and density by level."""
        return assemble_water(self.file.environment)

    @property
    def settings(self) -> Settings:
        """Return how the line is solved."""
        return Settings(self.file.solver.angle_step, self.file.solver.tolerance)

    @property
    def towing(self) -> Towing:
        """The ship's way, the sheave's height and the wind."""
        wind = self.file.environment.wind
        return Towing(
            *components(self.keys.speed, self.keys.toward),
            height=self.keys.height,
            wind=(0.0, 0.0) if wind is None else components(wind.speed, wind.toward),
            in_air=self.file.environment.fluid == "air",
        )

    @cached_property
    def line(self) -> Line:
        """The pieces from the ship down; one that is paid out to reach a depth has its cut length.

        NoEquilibrium: where no length reaches the depth.
        """
        line = assemble_line(self.file.pieces, self.file.solver, self.water.gravity)
        for piece in self.file.pieces:
            if piece.fit_body_depth is not None:
                with naming_the_piece(self.file.pieces):
                    length = self.memory.of(
                        fit_tow_length, line, self.water, self.towing, piece.index,
                        piece.fit_body_depth, self.settings,
                    )  # fmt: skip
                return line.with_length(piece.index, length)
        return line

    def solved(self, line: Line) -> Solution:
        """Return another line towed likewise; NoEquilibrium: it has no equilibrium."""
        return solve_tow(line, self.water, self.towing, self.settings)

    def at_speed(self, speed: float) -> Tow:
        """Return the same tow at another speed [m/s], a fitted cable as long as at its own."""
        keys = self.keys.model_copy(update={"speed": speed})
        return Tow(replace(self.file, tow=keys), line=self.line)

    def solve(self, environment: OtherEnvironment | None = None) -> TowResult:
        """Find the steady shape, in another of its environments where one is given.

        NoEquilibrium: with status, message and advice, where there is none that passes every check.
        """
        if environment is not None:
            return self.with_(environment=environment).solve()
        with naming_the_piece(self.file.pieces, towed=True):
            solution = self.memory.of(solve_tow, self.line, self.water, self.towing, self.settings)
        return _result_of(self, solution)


def _result_of(tow: Tow, solution: Solution) -> TowResult:
    pieces = tow.file.pieces
    force = solution.force[-1]
    backward = hypot(force[0], force[1])
    result = TowResult(
        tow=tow,
        name=tow.file.name,
        type="tow",
        status=Status.CONVERGED.label,
        iterations=solution.marches,
        segments=solution.segments,
        miss=solution.miss,
        closure=solution.closure,
        accuracy=Accuracy(solution.depth_error, solution.tension_error),
        speed=tow.keys.speed,
        toward=tow.keys.toward,
        tow_point=TowPoint(
            tension=float(solution.tension[-1]),
            angle=degrees(atan2(-force[2], backward)),
            vertical=-float(force[2]),
            horizontal=backward,
        ),
        body=_body(solution),
        strumming=strumming_of(tow.file.solver, solution),
        components=components_of(pieces, solution),
        clamps=clamps_of(pieces, solution),
        shape=shape_of(solution),
        other=solution.other,
    )
    return replace(result, warnings=warnings_of(result, solution))


def _body(solution: Solution) -> TowedBody:
    node = solution.body_node
    x, y, z = solution.position[node]
    pull = -solution.force[node]
    if solution.line.flexible[0]:
        pull = solution.position[1] - solution.position[0]
    return TowedBody(
        depth=-float(z),
        layback=hypot(x, y),
        tension=float(solution.tension[node]),
        angle=degrees(atan2(pull[2], hypot(pull[0], pull[1]))),
    )


SOLVES = 3.0
"""About how many equilibria one speed takes."""

CHANGE = 0.1
"""Share by which `sensitivity` changes a coefficient, down and up."""

_COEFFICIENTS = ("a1", "b1", "c1")


@dataclass(frozen=True)
class Variation:
    """A tow with one coefficient of its strumming changed.

    Attributes
    ----------
    coefficient : ``"a1"``, ``"b1"`` or ``"c1"``; empty for the tow as its file gives it
    change : relative, e.g. -0.1
    outcome : the result, or why there is none
    """

    coefficient: str
    change: float
    outcome: TowResult | NoEquilibrium


def sweep(tow: Tow, speeds: Iterable[float]) -> list[TowResult | NoEquilibrium]:
    """Return the result at each speed of the ship [m/s], > 0, or the reason why there is none.

    Speeds are taken one at a time; the tow's own only decides the length of a cable that is fitted.
    NoEquilibrium: no length of that reaches its depth at the tow's own speed.
    """
    return [or_why_not(tow.at_speed(speed).solve) for speed in speeds]


def sensitivity(tow: Tow) -> list[Variation]:
    """Return a tow as it is, then with A₁, B₁ and C₁ each smaller and greater by `CHANGE`.

    UsageError: the tow does not strum by Bourget & Marichal. NoEquilibrium: as in `sweep`.
    """
    keys = tow.file.solver.strumming
    if not isinstance(keys, BourgetMarichalKeys):
        raise UsageError(
            f"{tow.file.name} has no coefficients to change; they belong to "
            "`solver: {strumming: bourget-marichal}`"
        )
    variations = [Variation("", 0.0, or_why_not(tow.solve))]
    for name in _COEFFICIENTS:
        for change in (-CHANGE, CHANGE):
            changed = keys.model_copy(update={name: getattr(keys, name) * (1.0 + change)})
            solver = tow.file.solver.model_copy(update={"strumming": changed})
            other = Tow(replace(cut_like(tow.file, tow), solver=solver))
            variations.append(Variation(name, change, or_why_not(other.solve)))
    return variations
