"""A file of legs, ready to be solved, and its result."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict, dataclass, field, replace
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np

from calm.assemble import assemble_floating, assemble_line, assemble_water
from calm.case.measure import (
    anchor_weight_of,
    clamps_of,
    components_of,
    on_anchor,
    shape_of,
    with_anchor,
)
from calm.case.mooring import Mooring, load
from calm.case.parts import clamps_down, naming_the_piece
from calm.case.result import Accuracy
from calm.case.result_tables import Clamps, Components, Shape
from calm.case.tow import Tow
from calm.case.warnings import net_warnings_of
from calm.errors import InputError, NoEquilibrium
from calm.files import Anchor, MooringFile, Piece, read_mooring
from calm.files.legs import NET_REFUSED, EndKeys, Leg, nodes_of
from calm.physics.line import Water
from calm.physics.seabed import required_weight
from calm.solve import Settings, Solution, Status
from calm.solve.net import NetSolution, solve_net
from calm.solve.net_leg import LegEnd, NetLeg


@dataclass(frozen=True)
class EndLoad:
    """What a leg does to an end that is held, or to its anchor.

    The pull of the line and its parts up and sideways [N], its angle from the vertical [degrees];
    where the end is [m]. Of an anchor the weight in water that it needs, and has [N], and the
    unstretched length of line on the seabed [m].
    """

    leg: str
    tension: float
    vertical: float
    horizontal: float
    angle: float
    x: float
    y: float
    depth: float
    required_weight: float | None = None
    weight: float | None = None
    grounded_length: float = 0.0


@dataclass(frozen=True)
class NodePlace:
    """Where the legs of a node meet [m]; `imbalance` is what is left of their pulls there [N]."""

    name: str
    depth: float
    x: float
    y: float
    imbalance: float


@dataclass(frozen=True)
class LegResult:
    """A leg of a solved net; `used_buoyancy` and `reserve` [N] are of a float at the surface."""

    name: str
    first: int
    end: int
    shape: Shape = field(repr=False)
    closure: float
    afloat: bool
    used_buoyancy: float
    reserve: float


@dataclass(frozen=True, kw_only=True)
class NetResult:
    """A converged net. Lengths and depths [m], forces [N], angles [degrees].

    x and y are east and north of the origin of the file's places. `miss` is the worst distance of a
    leg's end from where it is held, `closure` the worst of the legs', recomputed from coordinates.
    """

    net: Net = field(repr=False)
    name: str
    type: str = "net"
    status: str
    iterations: int
    segments: int
    miss: float
    closure: float
    accuracy: Accuracy
    legs: tuple[LegResult, ...]
    components: Components = field(repr=False)
    clamps: Clamps = field(repr=False)
    nodes: tuple[NodePlace, ...]
    anchors: tuple[EndLoad, ...]
    held: tuple[EndLoad, ...]
    warnings: tuple[str, ...] = ()

    @property
    def file(self) -> MooringFile:
        """The file as read."""
        return self.net.file

    def leg_of(self, index: int) -> LegResult:
        """Return the leg that a piece belongs to."""
        return next(leg for leg in self.legs if leg.first <= index < leg.end)

    def to_dict(self) -> dict[str, Any]:
        """The JSON object of the result format; None stands where a figure is unknown."""
        from calm.version import __version__

        components, clamps = self.components.to_dicts(), self.clamps.to_dicts()
        for component in components:
            for name in ("kind", "role", "tension", "least_tension"):
                del component[name]
        for row in (*components, *clamps):
            row["leg"] = self.leg_of(row["index"]).name
        legs = [
            {
                "name": leg.name,
                "closure": leg.closure,
                "used_buoyancy": leg.used_buoyancy,
                "reserve": leg.reserve,
                "shape": {name: column.tolist() for name, column in vars(leg.shape).items()},
            }
            for leg in self.legs
        ]
        anchors = [asdict(each) for each in self.anchors]
        told = ("name", "type", "status", "iterations", "segments", "miss", "closure")
        return {
            "calm": __version__,
            **{name: getattr(self, name) for name in told},
            "accuracy": {k: v for k, v in asdict(self.accuracy).items() if v is not None},
            **({"anchor": anchors[0]} if len(anchors) == 1 else {}),
            "anchors": anchors,
            "held": [
                {k: v for k, v in asdict(each).items() if k not in _OF_ANCHORS}
                for each in self.held
            ],
            "nodes": [asdict(each) for each in self.nodes],
            "legs": legs,
            "components": components,
            "clamps": clamps,
            "warnings": list(self.warnings),
        }


_OF_ANCHORS = ("required_weight", "weight", "grounded_length")


def load_net(
    path: str | Path,
    environment: str | Path | None = None,
    catalogs: Sequence[str | Path] = (),
    text: str | None = None,
) -> Net:
    """Read the file of a net of legs; the parameters are those of `load`.

    Raises
    ------
    InputError
        With every mistake of the file, each with its line and column.
    """
    return Net(
        read_mooring(path, environment=environment, catalogs=list(catalogs), text=text, net=True)
    )


@dataclass(frozen=True)
class Net:
    """A net of legs as read from its file."""

    file: MooringFile

    @cached_property
    def water(self) -> Water:
        """Depth, current and density by level."""
        return assemble_water(self.file.environment)

    @property
    def settings(self) -> Settings:
        """Return how the legs are solved."""
        solver = self.file.solver
        return Settings(solver.angle_step, solver.tolerance, solver.seabed_friction)

    @cached_property
    def legs(self) -> tuple[NetLeg, ...]:
        """The legs as the solver takes them."""
        nodes = nodes_of(self.file.legs)
        return tuple(self._leg(leg, nodes) for leg in self.file.legs)

    def _leg(self, leg: Leg, nodes: Any) -> NetLeg:
        pieces, file = leg.of(self.file.pieces), self.file
        line = assemble_line(pieces, file.solver, self.water.gravity, free_end=False)
        upper = self._end(leg.top, nodes, pieces)
        if upper.free and file.solver.buoy_drag == "immersed":
            floating = assemble_floating(pieces, file.environment, self.water)
            line = replace(line, floating=floating)
        return NetLeg(line, upper, self._end(leg.bottom, nodes, pieces))

    def _end(self, end: EndKeys, nodes: Any, pieces: Sequence[Piece]) -> LegEnd:
        if end.join is not None:
            return LegEnd(node=nodes[end.join])
        if end.held is not None:
            return LegEnd(place=(*end.held.at, -end.held.depth))
        if end.anchor is not None:
            seabed = -(self.water.depth if end.anchor.depth is None else end.anchor.depth)
            height = pieces[-1].length or 0.0
            return LegEnd(place=(*end.anchor.at, seabed + height), seabed=seabed)
        return LegEnd()

    def equilibrium(self, water: Water) -> NetSolution:
        """The net solved in some water.

        Raises
        ------
        NoEquilibrium
        """
        lines = [piece for leg in self.file.legs for piece in _above(leg.of(self.file.pieces))]
        with naming_the_piece(lines):
            return solve_net(self.legs, len(nodes_of(self.file.legs)), water, self.settings)

    def solve(self) -> NetResult:
        """Find the static equilibrium.

        Raises
        ------
        NoEquilibrium
            With status, message and advice, where there is none that passes every check.
        """
        solution = self.equilibrium(self.water)
        still = solution
        try:
            if self.water.moving:
                still = self.equilibrium(self.water.still())
        except NoEquilibrium:
            return _result_of(self, solution, [None] * len(solution.legs))
        return _result_of(self, solution, still.legs)


def _above(pieces: Sequence[Piece]) -> Sequence[Piece]:
    """The pieces of a leg that are solved for: all but its anchor."""
    return pieces[:-1] if isinstance(pieces[-1].component, Anchor) else pieces


def _result_of(net: Net, found: NetSolution, still: Sequence[Solution | None]) -> NetResult:
    legs: list[LegResult] = []
    anchors: list[EndLoad] = []
    held: list[EndLoad] = []
    solved: list[tuple[Components, Solution]] = []
    tables: list[Components] = []
    clamps: list[Clamps] = []
    for leg, solution, before in zip(net.file.legs, found.legs, still, strict=True):
        pieces = leg.of(net.file.pieces)
        above = _above(pieces)
        components = components_of(above, solution, before)
        instruments = clamps_of(above, solution, before)
        solved.append((components, solution))
        instruments = instruments.with_columns(index=instruments.index + leg.first)
        for borne in _end_loads(net, leg, solution, components):
            (held if borne.weight is None else anchors).append(borne)
        if len(above) < len(pieces):
            assert leg.bottom.anchor is not None
            depth = leg.bottom.anchor.depth or net.water.depth
            components = with_anchor(components, pieces[-1], depth)
            for clamp in clamps_down(pieces[-1:]):
                instruments = instruments.with_row(on_anchor(clamp, components[-1]))
        tables.append(components)
        clamps.append(instruments)
        used, reserve = solution.buoyancy_used, solution.reserve
        legs.append(
            LegResult(leg.name, leg.first, leg.end, shape_of(solution), solution.closure,
                      solution.surface, used, reserve)
        )  # fmt: skip
    names = list(nodes_of(net.file.legs))
    result = NetResult(
        net=net,
        name=net.file.name,
        status=Status.CONVERGED.label,
        iterations=found.marches,
        segments=sum(leg.segments for leg in found.legs),
        miss=found.miss,
        closure=max(leg.closure for leg in legs),
        accuracy=Accuracy(found.depth_error, found.tension_error),
        legs=tuple(legs),
        components=Components.joined(tables),
        clamps=Clamps.joined(clamps),
        nodes=tuple(
            NodePlace(name, -float(at[2]), float(at[0]), float(at[1]), float(left))
            for name, at, left in zip(names, found.nodes, found.imbalance, strict=True)
        ),
        anchors=tuple(anchors),
        held=tuple(held),
    )
    return replace(result, warnings=net_warnings_of(result, solved))


def _end_loads(net: Net, leg: Leg, solution: Solution, components: Components) -> list[EndLoad]:
    """What a leg does to its anchor and to where it is held.

    Raises
    ------
    NoEquilibrium
        It lifts its anchor.
    """
    loads = []
    turned = solution.line.towed
    for end, which in ((leg.top, 0), (leg.bottom, -1)):
        if end.held is None and end.anchor is None:
            continue
        node = -1 if turned else which
        # a leg's first end is pulled by what hangs on it, its last by what stands above
        force = solution.force[node] * (-1.0 if which == 0 and not turned else 1.0)
        vertical, horizontal = float(force[2]), float(np.hypot(force[0], force[1]))
        row = components[which if which == 0 else len(components) - 1]
        at = (row.x_top, row.y_top, row.depth_top) if which == 0 else (
            row.x_bottom, row.y_bottom, row.depth_bottom)  # fmt: skip
        load = EndLoad(
            leg=leg.name,
            tension=float(np.linalg.norm(force)),
            vertical=vertical,
            horizontal=horizontal,
            angle=float(np.degrees(np.arctan2(horizontal, vertical))),
            x=at[0],
            y=at[1],
            depth=at[2],
        )
        loads.append(load if end.anchor is None else _on_anchor(net, leg, load, solution))
    return loads


def _on_anchor(net: Net, leg: Leg, load: EndLoad, solution: Solution) -> EndLoad:
    anchor, checks = leg.of(net.file.pieces)[-1], net.file.checks
    weight, own = anchor_weight_of(anchor, net.water), getattr(anchor.component, "friction", None)
    if load.vertical > weight:
        raise Status.ANCHOR_LIFTS.because(
            f"Leg {leg.name} pulls up with {load.vertical:.0f} N; its anchor weighs {weight:.0f} N "
            "in water."
        )
    friction = checks.anchor_friction if own is None else own
    needed = required_weight(load.vertical, load.horizontal, checks.anchor_factor, friction)
    return replace(
        load,
        required_weight=float(needed),
        weight=weight,
        grounded_length=solution.grounded_length,
    )


def load_any(
    path: str | Path, environment: str | Path | None = None, catalogs: Sequence[str | Path] = ()
) -> Mooring | Tow | Net:
    """Read the file of a mooring, a tow or a net; the parameters are those of `load`.

    Raises
    ------
    InputError
        With every mistake of the file, each with its line and column.
    """
    try:
        return load(path, environment, catalogs)
    except InputError as error:
        if [problem.message for problem in error.problems] != [NET_REFUSED]:
            raise
    return load_net(path, environment, catalogs)
