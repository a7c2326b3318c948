"""A file of legs, ready to be solved, and its result."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, fields, replace
from functools import cached_property
from itertools import combinations, permutations, product
from math import dist, inf, isfinite, nan
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from calm.assemble import assemble_water
from calm.case.measure import result_of
from calm.case.mooring import Mooring, refuse_in_the_slope
from calm.case.parts import Origin, OtherEnvironment, ReadFromFile, as_read, naming_the_piece
from calm.case.result import NetResult, Result
from calm.case.result_tables import Accuracy, AnchorLoad, EndLoad, NodePlace
from calm.case.tow import Tow
from calm.errors import InputError, NoEquilibrium, Problem
from calm.files import MooringFile, Piece
from calm.files.environment import Environment
from calm.files.legs import EndKeys, Leg, leg_numbers, nodes_of
from calm.files.mooring_file import STAND_IN
from calm.files.reader import MooringReader
from calm.physics.hull import AIR_DENSITY
from calm.physics.line import Floats, Line, Water
from calm.quantities import say
from calm.records.grids import SeabedGrid
from calm.solve import Settings, Solution, Status

if TYPE_CHECKING:
    from calm.solve.leg_layout import LegEnd, NetLeg
    from calm.solve.net import NetSolution

_SKIN = 1e-3  # m above the surface, in which water turns into air


@dataclass(frozen=True)
class Net(ReadFromFile):
    """A net of legs as read from its file."""

    file: MooringFile
    origin: Origin | None = field(default=None, repr=False, compare=False)

    @cached_property
    def water(self) -> Water:
        """Depth, current and density by level."""
        return self.water_of(self.file.environment)

    def water_of(self, environment: Environment) -> Water:
        """The water of an environment, with still air above it where an end is held there."""
        if isinstance(environment.seabed, SeabedGrid):  # its plane is that of one place
            environment = replace(environment, seabed=None)
        water, ends = assemble_water(environment), [e for leg in self.file.legs for e in leg.ends]
        if all(end.held is None or end.held.depth >= 0.0 for end in ends):
            return water
        below, surface = water.level > 0.0, np.zeros(())
        level = np.array([-_SKIN, 0.0, *water.level[below]])
        u, v, w = (
            np.array([0.0, speed, *column[below]])
            for speed, column in zip(
                water.current_at(surface), (water.u, water.v, water.w), strict=True
            )
        )
        density = np.array([AIR_DENSITY, water.density_at(surface), *water.density[below]])
        return replace(water, level=level, u=u, v=v, w=w, density=density)

    @property
    def settings(self) -> Settings:
        """Return how the legs are solved."""
        return self.lines[0].settings

    @cached_property
    def lines(self) -> tuple[Mooring, ...]:
        """The legs, each as a mooring of its own."""
        return tuple(Mooring(leg.line_of(self.file)) for leg in self.file.legs)

    @cached_property
    def legs(self) -> tuple[NetLeg, ...]:
        """The legs as the solver takes them."""
        from calm.solve.leg_layout import NetLeg

        nodes = nodes_of(self.file.legs)
        found = []
        for leg, mooring in zip(self.file.legs, self.lines, strict=True):
            upper, lower = (self._end(end, nodes, mooring) for end in leg.ends)
            line = mooring.line if upper.free else replace(mooring.line, floating=None)
            found.append(NetLeg(line, upper, lower))
        return tuple(found)

    @cached_property
    def meant(self) -> tuple[Mooring, ...]:
        """The legs, each known to be meant for the surface where still water has it there."""
        try:
            afloat = [bool(leg.afloat) for leg in self.equilibrium(self.water.still()).legs]
        except NoEquilibrium:
            afloat = [False] * len(self.lines)
        return tuple(
            Mooring(line.file, surface) for line, surface in zip(self.lines, afloat, strict=True)
        )

    def with_lines(self, lines: Sequence[Sequence[Piece]]) -> Net:
        """Return the net with other pieces in its legs, stand-ins for anchors among them."""
        legs: list[Leg] = []
        pieces: list[Piece] = []
        for leg, own in zip(self.file.legs, lines, strict=True):
            first = len(pieces)
            pieces += [piece for piece in own if piece.use != STAND_IN]
            legs.append(replace(leg, first=first, end=len(pieces)))
        listed = tuple(replace(piece, index=index) for index, piece in enumerate(pieces))
        return Net(replace(self.file, pieces=listed, legs=tuple(legs)))

    def with_length(self, index: int, length: float) -> Net:
        """Return the net with another unstretched length [m] of a piece of the file."""
        number = leg_numbers(self.file)[index]
        own = index - self.file.legs[number].first
        lines = [line.line for line in self.lines]
        lines[number] = lines[number].with_length(own, length)
        return self.with_own(lines)

    def with_own(self, lines: Sequence[Line], water: Water | None = None) -> Net:
        """Return the net with lines for its legs that are not its file's, and other water."""
        other, own = Net(self.file), zip(self.lines, lines, strict=True)
        vars(other)["lines"] = tuple(
            Mooring(each.file, line=line, water=each.water) for each, line in own
        )
        vars(other).update({"water": water or self.water, "near": self.standing})
        return other

    @cached_property
    def standing(self) -> NetSolution:
        """The net in its own water; NoEquilibrium where it does not stand."""
        return self.equilibrium(self.water, vars(self).get("near"))

    def _end(self, end: EndKeys, nodes: Mapping[str, int], mooring: Mooring) -> LegEnd:
        from calm.solve.leg_layout import LegEnd

        if end.join is not None:
            return LegEnd(node=nodes[end.join])
        if end.held is not None:
            return LegEnd(place=(*end.held.at, -end.held.depth))
        if end.anchor is not None:
            water, seabed = mooring.water, -mooring.water.depth
            place = (*end.anchor.at, seabed + mooring.line.anchor_height)
            deeper = water.deeper_east, water.deeper_north
            return LegEnd(place=place, seabed=seabed, deeper=deeper)
        return LegEnd()

    def equilibrium(self, water: Water, near: NetSolution | None = None) -> NetSolution:
        """The net solved in some water, sought first near another solution of it.

        Raises
        ------
        NoEquilibrium
        """
        from calm.solve.net import solve_net

        solved_for = [piece for line in self.lines for piece in line.file.pieces[:-1]]
        try:
            with naming_the_piece(solved_for):
                nodes = len(nodes_of(self.file.legs))
                return solve_net(self.legs, nodes, water, self.settings, near)
        except NoEquilibrium as failure:
            if failure.status == Status.SLACK.label:
                raise
            raise self._why_not() or failure from None

    def _why_not(self) -> NoEquilibrium | None:
        """Return why it sinks or held ends are out of reach, if weights or lengths say so.

        What may lie on the seabed weighs nothing. Between every two ends the shortest way through
        the net counts (Floyd and Warshall).
        """
        lift = 0.0
        for leg in self.legs:
            upto = np.cumsum(leg.line.total_buoyancy)
            lift += max(float(upto.max()), 0.0) if isfinite(leg.lower.seabed) else float(upto[-1])
        if lift <= 0.0 and not any(end.held for leg in self.file.legs for end in leg.ends):
            return Status.NO_EQUILIBRIUM.because(
                f"It sinks: its legs weigh {say('force', -lift)} more in water than their floats "
                "lift, without those that may lie on the seabed, and no end is held.",
                advice="Add buoyancy.",
            )
        ways: dict[Any, tuple[float, tuple[str, ...]]] = defaultdict(lambda: (inf, ()))
        for leg, keys in zip(self.legs, self.file.legs, strict=True):
            ends = [end.node if end.place is None else end.place for end in (leg.upper, leg.lower)]
            for pair in permutations(ends):
                ways[pair] = min(ways[pair], (float(leg.line.length.sum()), (keys.name,)))
        points = dict.fromkeys(end for pair in ways for end in pair if end != -1)  # -1: free
        for by, first, last in product(points, repeat=3):
            (one, some), (other, more) = ways[first, by], ways[by, last]
            ways[first, last] = min(ways[first, last], (one + other, some + more))
        for first, last in combinations((one for one in points if isinstance(one, tuple)), 2):
            length, names = ways[first, last]
            if length < dist(first, last):
                legs = f"Leg {names[0]} is" if len(names) == 1 else f"Legs {', '.join(names)} are"
                return Status.NO_EQUILIBRIUM.because(
                    f"{legs} {say('length', length)} long in all, but its ends are held "
                    f"{say('length', dist(first, last))} apart.",
                    advice="Lengthen a leg, or bring the ends closer together.",
                )
        return None

    def solve(self, environment: OtherEnvironment | None = None) -> NetResult:
        """Find the static equilibrium, in another of its environments where one is given.

        NoEquilibrium: with status, message and advice, where there is none that passes every check.
        """
        if environment is not None:
            return self.with_(environment=environment).solve()
        solution = self.standing
        still: Sequence[Solution | None] = solution.legs
        if self.water.moving:
            try:
                still = self.equilibrium(self.water.still()).legs
            except NoEquilibrium:
                still = [None] * len(solution.legs)
        return net_result(self, solution, still)


def net_result(net: Net, found: NetSolution, still: Sequence[Solution | None]) -> NetResult:
    """The result of a solution; `still` are its legs in still water, None where that is unknown.

    NoEquilibrium: an anchor is lifted, or a leg hangs into the slope.
    """
    legs: list[Result] = []
    ends: list[EndLoad] = []
    for mooring, solution, before in zip(net.lines, found.legs, still, strict=True):
        _refuse_a_lifted_anchor(mooring, solution)
        refuse_in_the_slope(mooring.file, solution, mooring.water.depth)
        upright = before or solution
        meant = Mooring(mooring.file, bool(upright.afloat), line=mooring.line, water=mooring.water)
        result = result_of(meant, solution, before)
        if mooring.file.pieces[-1].use == STAND_IN:
            none = {each.name: nan for each in fields(result.anchor)}
            result = replace(result, anchor=AnchorLoad(**none))
        legs.append(result)
        ends += _end_loads(result, solution)
    places = zip(nodes_of(net.file.legs), found.nodes, found.imbalance, strict=True)
    return NetResult(
        mooring=net,
        name=net.file.name,
        status=Status.CONVERGED.label,
        iterations=found.marches,
        segments=sum(leg.segments for leg in found.legs),
        miss=found.miss,
        closure=max(leg.closure for leg in legs),
        accuracy=Accuracy(found.depth_error, found.tension_error),
        legs=tuple(legs),
        nodes=tuple(
            NodePlace(name, -float(at[2]), float(at[0]), float(at[1]), float(left))
            for name, at, left in places
        ),
        anchors=tuple(end for end in ends if end.weight is not None),
        held=tuple(end for end in ends if end.weight is None),
        warnings=(
            *net.file.notices,
            *(said for leg in legs for said in leg.warnings),
            *(said for leg in legs if (said := _upside_down(leg))),
            *(
                f"The anchors of legs {one.leg} and {other.leg} stand in one place, and each is "
                "judged for itself; where they are one anchor, join the legs at a node above it."
                for one, other in combinations((end for end in ends if end.weight is not None), 2)
                if dist((one.x, one.y), (other.x, other.y)) < 1e-3
            ),
        ),
    )


def _upside_down(leg: Result) -> str:
    """Return what is said of a leg with a free end that hangs or stands the other way round."""
    (keys,), rows = leg.file.legs, leg.components
    top, bottom = float(rows.depth_top[0]), float(rows.depth_bottom[len(rows) - 2])
    if not (keys.top.free or keys.bottom.free) or top <= bottom:
        return ""
    return (
        f"Leg {leg.name} is the other way round: its upper end is {say('length', top - bottom)} "
        "deeper than its lower one. Legs are listed from their upper to their lower ends."
    )


def _end_loads(leg: Result, solution: Solution) -> Iterator[EndLoad]:
    """Return what a leg does to where it is held, and to its anchor."""
    (keys,), rows = leg.file.legs, leg.components
    if keys.top.held is not None:
        # what hangs down from its upper end is marched from its lower one
        row, force = rows[0], solution.force[-1] if solution.line.towed else -solution.force[0]
        yield _end_load(leg.name, force, (row.x_top, row.y_top, row.depth_top))
    if keys.bottom.held is not None:
        row = rows[len(rows) - 2]
        place = row.x_bottom, row.y_bottom, row.depth_bottom
        yield _end_load(leg.name, solution.force[-1], place)
    if keys.bottom.anchor is not None:
        row = rows[len(rows) - 1]
        borne = _end_load(leg.name, solution.force[-1], (row.x_top, row.y_top, row.depth_top))
        yield replace(
            borne,
            required_weight=leg.anchor.required_weight,
            weight=leg.anchor.weight,
            grounded_length=leg.anchor.grounded_length,
            slack_length=solution.slack,
        )


def _end_load(leg: str, force: Floats, place: tuple[float, float, float]) -> EndLoad:
    vertical, horizontal = float(force[2]), float(np.hypot(force[0], force[1]))
    angle = float(np.degrees(np.arctan2(horizontal, vertical)))
    return EndLoad(leg, float(np.linalg.norm(force)), vertical, horizontal, angle, *place)


def _refuse_a_lifted_anchor(mooring: Mooring, solution: Solution) -> None:
    (leg,) = mooring.file.legs
    pull = float(solution.force[-1, 2])
    if leg.bottom.anchor is not None and pull > mooring.anchor_weight:
        raise Status.ANCHOR_LIFTS.because(
            f"Leg {leg.name} has a vertical pull of {pull:.0f} N; its anchor weighs "
            f"{mooring.anchor_weight:.0f} N in water."
        )


def load(
    path: str | Path,
    environment: str | Path | None = None,
    catalogs: Sequence[str | Path] = (),
    text: str | None = None,
) -> Mooring | Tow | Net:
    """Read the file of a mooring, a tow or a net of legs.

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
    return load_in(path, (environment,), catalogs, text)[0]


def load_in(
    path: str | Path,
    environments: Sequence[str | Path | None] | None,
    catalogs: Sequence[str | Path] = (),
    text: str | None = None,
) -> list[Mooring | Tow | Net]:
    """Read a file as `load` does in several environments; None is its own and all that it names.

    InputError: with the mistakes of all.
    """
    reader = MooringReader(path, catalogs=catalogs, text=text, net=True)
    asked, read = [*(environments or (None,))], []
    problems: dict[Problem, None] = {}
    for name in asked:
        try:
            file = reader.in_environment(name)
        except InputError as error:
            problems |= dict.fromkeys(error.problems)
            continue
        if environments is None and name is None and file.tow is None:
            asked += file.variants
        origin = Origin(path, name, tuple(map(Path, catalogs)), text)
        read.append(as_read(Net, file, origin) if file.legs else _line_of(file, origin))
    if problems:
        raise InputError(list(problems))
    return read


def load_line(
    path: str | Path, environment: str | Path | None = None, catalogs: Sequence[str | Path] = ()
) -> Mooring | Tow:
    """Read the file of a mooring or a tow as `load` does; InputError: it is a net."""
    origin = Origin(path, environment, tuple(map(Path, catalogs)), None)
    return _line_of(origin.read(), origin)


def _line_of(file: MooringFile, origin: Origin) -> Mooring | Tow:
    moored = file.tow is None
    return as_read(Mooring, file, origin) if moored else as_read(Tow, file, origin)
