"""Designs read from files, and the results of solving the designs.

A mooring is one leg with a free top and an anchor; a tow is one leg held at the ship; a net has
several legs.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import asdict, dataclass, field, replace
from functools import cached_property
from itertools import combinations
from math import dist
from pathlib import Path
from typing import TYPE_CHECKING, Any, ClassVar, TypeAlias, TypeVar

import numpy as np

from calm.assemble import assemble_water
from calm.case.leg import Leg
from calm.case.leg_result import LegResult
from calm.case.memory import Memory, NoMemory
from calm.case.parts import Origin, OtherEnvironment
from calm.case.profilers import ProfilerTravel, profilers_of
from calm.case.result_tables import (
    MOORED_ENDS,
    Accuracy,
    AnchorLoad,
    Clamps,
    Components,
    EndLoad,
    NodePlace,
    Shape,
    Top,
    TowedBody,
    TowPoint,
    documents,
)
from calm.case.strumming import Strumming, StrummingBand
from calm.errors import InputError, NoEquilibrium, Problem, UsageError, how_to_install
from calm.files import MooringFile, Piece
from calm.files.environment import Environment
from calm.files.legs import FileLeg, nodes_of
from calm.files.mooring_file import (
    leg_numbers,
    legs_of,
    refuse_all_but_moorings,
    refuse_several,
)
from calm.files.pieces import STAND_IN
from calm.files.reader import MooringReader
from calm.physics.hull import AIR_DENSITY
from calm.physics.line import Floats, Line, Water
from calm.quantities import say
from calm.records.grids import SeabedGrid
from calm.solve import Settings, Solution, Status

if TYPE_CHECKING:
    from calm.solve.net import NetSolution

_End = TypeVar("_End")

_SKIN = 1e-3  # m: thickness of the layer above the surface in which water turns into air


@dataclass(frozen=True)
class Design:
    """A mooring, a tow or a net of legs, as `calm.load` reads it from a file.

    A design is immutable. `solve` finds the equilibrium; `with_` returns a changed copy::

        design = calm.load("mooring.yaml")
        longer = design.with_("wire 1", length="480 m")
        print(longer.solve(environment="storm").top.knockdown)

    Attributes
    ----------
    file : contents of the file, in SI units
    for_surface, memory : see `Leg`
    lines, given_water : replacements for the lines and the water of the file
    near : known equilibrium of a similar net, the starting point of the solution
    origin : path, environment and catalogues of the file; None for a design made in Python
    """

    file: MooringFile
    for_surface: bool | None = None
    memory: Memory = field(default_factory=NoMemory, repr=False, compare=False)
    lines: tuple[Line, ...] | None = field(default=None, repr=False, compare=False)
    given_water: Water | None = field(default=None, repr=False, compare=False)
    near: NetSolution | None = field(default=None, repr=False, compare=False)
    origin: Origin | None = field(default=None, repr=False, compare=False)

    def __reduce__(self) -> tuple[type[Design], tuple[object, ...]]:
        legs = vars(self).get("legs", ())
        known = tuple(leg.line for leg in legs if "line" in vars(leg))
        lines = known if known and len(known) == len(legs) else self.lines
        water = vars(self).get("water", self.given_water)
        given = self.file, self.for_surface, self.memory, lines, water, self.near, self.origin
        return Design, given

    @cached_property
    def legs(self) -> tuple[Leg, ...]:
        """Legs in the order of the file."""
        keys = legs_of(self.file)
        # each leg of a net has the water depth at its own anchor
        water = None if self.several else self.given_water
        return tuple(
            Leg(self.file.leg_alone(each), self.for_surface, self.memory, line, water)
            for each, line in zip(keys, self.lines or (None,) * len(keys), strict=True)
        )

    @property
    def several(self) -> bool:
        """Whether the file lists named legs, which are solved together."""
        return bool(self.file.legs)

    @property
    def leg(self) -> Leg:
        """The only leg of a mooring or a tow. Raises UsageError if there are several legs."""
        refuse_several(self.file)
        return self.legs[0]

    @property
    def moored(self) -> Leg:
        """The only leg of a mooring. Raises UsageError for a tow and for several legs."""
        refuse_all_but_moorings(self.file)
        return self.legs[0]

    @property
    def line(self) -> Line:
        """Line of a mooring or a tow, as arrays."""
        return self.leg.line

    @property
    def towed(self) -> bool:
        """Whether a ship or an aircraft tows the design."""
        return any(leg.towed for leg in self.legs)

    @property
    def environment(self) -> Environment:
        """Water, current and wind of the file."""
        return self.file.environment

    @property
    def settings(self) -> Settings:
        """Settings of the solver."""
        return self.legs[0].settings

    @cached_property
    def water(self) -> Water:
        """Water depth, and current and density at each level."""
        if self.given_water is not None:
            return self.given_water
        return self.water_of(self.environment) if self.several else self.legs[0].water

    def water_of(self, environment: Environment) -> Water:
        """Return the water of an environment.

        If a leg of a net is held above the surface, the levels extend into motionless air.
        """
        if not self.several:
            return assemble_water(environment)
        # the plane of a depth grid is valid at one position only
        if isinstance(environment.seabed, SeabedGrid):
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

    # changed copies

    def with_(
        self, label: str | None = None, /, environment: OtherEnvironment | None = None, **keys: Any
    ) -> Design:
        """Return a copy of the design with changed values of the file.

        Values are written as in the file, with their units: ``with_("wire 1", length="480 m")``,
        ``with_(tow={"speed": "4 kn"})``, ``with_(environment={"current": {"speed": "0.3 m/s",
        "toward": "90 deg"}})``. None removes a key. A mapping changes only the keys that it
        contains.

        Parameters
        ----------
        label : piece or clamp to change; by default, the keys are top-level keys of the file
        environment : an entry of `environments` in the file, an environment file, or changed keys
            of the default environment

        Raises
        ------
        InputError
            The values are wrong, such as a number without its unit.
        UsageError
            No piece or clamp has the label, or the design was not loaded from a file.
        """
        if self.origin is None:
            raise UsageError("a design that was not loaded from a file has no values to change")
        origin = self.origin.changed(self.file, label, environment, keys)
        file = origin.read()
        if (file.tow is None) != (self.file.tow is None):
            raise UsageError("a mooring cannot be changed to a tow, or a tow to a mooring")
        return Design(file, origin=origin)

    def with_lines(self, lines: Sequence[Line], water: Water | None = None) -> Design:
        """Return a copy of the design with the given line in each leg.

        If `water` is given, it replaces the water of the design.
        """
        near = self.standing if self.several else None
        return Design(self.file, lines=tuple(lines), given_water=water or self.water, near=near)

    def with_length(self, index: int, length: float) -> Design:
        """Return a copy of the design in which one piece of the file has a new unstretched length
        [m].
        """
        number, lines = leg_numbers(self.file)[index], [leg.line for leg in self.legs]
        own = index - self.legs[number].keys.first
        lines[number] = lines[number].with_length(own, length)
        return self.with_lines(lines)

    def with_pieces(self, pieces: Sequence[Sequence[Piece]]) -> Design:
        """Return a copy of the design with the given pieces in each leg.

        The last piece of a leg may be a stand-in for an anchor.
        """
        if not self.several:
            return Design(
                replace(self.file, pieces=tuple(pieces[0])), self.for_surface, self.memory
            )
        legs: list[FileLeg] = []
        listed: list[Piece] = []
        for leg, own in zip(self.file.legs, pieces, strict=True):
            first = len(listed)
            listed += [piece for piece in own if piece.use != STAND_IN]
            legs.append(replace(leg, first=first, end=len(listed)))
        numbered = tuple(replace(piece, index=index) for index, piece in enumerate(listed))
        return Design(replace(self.file, pieces=numbered, legs=tuple(legs)))

    # solutions

    @cached_property
    def standing(self) -> NetSolution:
        """Equilibrium of several legs in the water of the file.

        Raises NoEquilibrium if there is no equilibrium.
        """
        return self.together(self.water, self.near)

    def together(self, water: Water, near: NetSolution | None = None) -> NetSolution:
        """Solve several legs in given water; the search starts from the solution `near` if given.

        Raises NoEquilibrium if there is no equilibrium.
        """
        from calm.case.net import solve_together

        return solve_together(self.legs, water, self.settings, near)

    @property
    def solutions(self) -> tuple[Solution, ...]:
        """Solutions of all legs in the environment of the file.

        Raises NoEquilibrium if the mooring has no equilibrium.
        """
        if self.several:
            return self.standing.legs
        return (self.leg.equilibrium(self.water),)

    @cached_property
    def typed_legs(self) -> tuple[Leg, ...]:
        """Legs, with `for_surface` set for each leg of a net.

        `for_surface` is true if the leg floats at the surface in still water. The leg of a mooring
        or a tow is unchanged.
        """
        if not self.several:
            return self.legs
        try:
            afloat = [bool(leg.afloat) for leg in self.together(self.water.still()).legs]
        except NoEquilibrium:
            afloat = [False] * len(self.legs)
        pairs = zip(self.legs, afloat, strict=True)
        return tuple(replace(leg, for_surface=surface) for leg, surface in pairs)

    def solve(self, environment: OtherEnvironment | None = None) -> Result:
        """Find the static equilibrium.

        Parameters
        ----------
        environment : as in `with_`

        Raises
        ------
        NoEquilibrium
            No equilibrium passes every check; `status`, `message` and `advice` give the reason.
        """
        if environment is not None:
            return self.with_(environment=environment).solve()
        if not self.several:
            return self._alone()
        found = self.standing
        still: Sequence[Solution | None] = found.legs
        if self.water.moving:
            try:
                still = self.together(self.water.still()).legs
            except NoEquilibrium:
                still = [None] * len(found.legs)
        return result_together(self, found, still)

    def _alone(self) -> Result:
        found = solved_alone(self.leg)
        return Result(
            design=self,
            status=Status.CONVERGED.label,
            iterations=found.iterations,
            segments=found.segments,
            miss=found.miss,
            closure=found.closure,
            accuracy=found.accuracy,
            legs=(found,),
        )


def solved_alone(leg: Leg) -> LegResult:
    """Solve a leg alone, and again with its profilers at several positions.

    Raises NoEquilibrium if there is no equilibrium.
    """
    solution = leg.equilibrium()
    still = leg.still_counterpart(solution)
    return LegResult(leg=leg, solution=solution, still=still, profilers=profilers_of(leg))


def result_together(design: Design, found: NetSolution, still: Sequence[Solution | None]) -> Result:
    """Build the result of several legs that were solved together.

    `still` has the solution of each leg in still water, or None if unknown. Raises NoEquilibrium if
    a leg would lift its anchor or penetrate the slope.
    """
    legs: list[LegResult] = []
    for leg, solution, before in zip(design.legs, found.legs, still, strict=True):
        leg.refuse_a_lifted_anchor(solution)
        leg.refuse_in_the_slope(solution)
        typed = replace(leg, for_surface=bool((before or solution).afloat))
        legs.append(LegResult(leg=typed, solution=solution, still=before))
    places = zip(nodes_of(design.file.legs), found.nodes, found.imbalance, strict=True)
    return Result(
        design=design,
        status=Status.CONVERGED.label,
        iterations=found.marches,
        segments=sum(leg.segments for leg in legs),
        miss=found.miss,
        closure=max(leg.closure for leg in legs),
        accuracy=Accuracy(found.depth_error, found.tension_error),
        legs=tuple(legs),
        nodes=tuple(
            NodePlace(name, -float(at[2]), float(at[0]), float(at[1]), float(left))
            for name, at, left in places
        ),
    )


def _reversed_order_warning(result: LegResult) -> str:
    leg, rows = result.leg, result.components
    top, bottom = float(rows.depth_top[0]), float(rows.depth_bottom[len(rows) - 2])
    if not (leg.top.free or leg.bottom.free) or top <= bottom:
        return ""
    return (
        f"Leg {leg.name} is listed in reverse order: its first end is "
        f"{say('length', top - bottom)} deeper than its last end. List each leg from its "
        "upper to its lower end."
    )


@dataclass(frozen=True, kw_only=True, repr=False)
class Result:
    """Result of a converged design. Lengths and depths are in m, forces in N, angles in degrees.

    x and y are distances to the east and north of the anchor, the tow point or, with several legs,
    the origin in the file. A result with one leg has the attributes of `LegResult`, such as `top`
    and `anchor`.

    Attributes
    ----------
    iterations : number of integrations along the line that the solver needed
    segments : number of segments of the final shape
    miss : distance of an end from its required position [m]: the largest distance in a net, the
        vertical distance for a single leg
    closure : relative force residual, recomputed from the final coordinates
    nodes : positions of the nodes of a net
    notebook_form, netcdf_form, plot_form : functions for HTML, NetCDF and pictures, set by packages
        that import this one
    """

    design: Design
    status: str
    iterations: int
    segments: int
    miss: float
    closure: float
    accuracy: Accuracy
    legs: tuple[LegResult, ...]
    nodes: tuple[NodePlace, ...] = ()

    notebook_form: ClassVar[Callable[[Any], str] | None] = None
    netcdf_form: ClassVar[Callable[[Any], bytes] | None] = None
    plot_form: ClassVar[Callable[[Any, Any], Any] | None] = None

    @cached_property
    def warnings(self) -> tuple[str, ...]:
        """Notices of the file, followed by warnings about the result."""
        if not self.several:
            return self.leg.warnings
        return (
            *self.file.notices,
            *(warning for leg in self.legs for warning in leg.warnings),
            *(warning for leg in self.legs if (warning := _reversed_order_warning(leg))),
            *(
                f"The anchors of legs {one.leg} and {other.leg} are at the same position but are "
                "checked separately. If they are one anchor, join the legs at a node above it."
                for one, other in combinations(self.anchors, 2)
                if dist((one.x, one.y), (other.x, other.y)) < 1e-3
            ),
        )

    @property
    def anchors(self) -> tuple[EndLoad, ...]:
        """Loads of the legs on their anchors."""
        return tuple(end for leg in self.legs for end in leg.ends if end.weight is not None)

    @property
    def held(self) -> tuple[EndLoad, ...]:
        """Loads of the legs on fixed ends without an anchor, such as a ship or a pier."""
        return tuple(end for leg in self.legs for end in leg.ends if end.weight is None)

    @property
    def file(self) -> MooringFile:
        """Contents of the design file."""
        return self.design.file

    @property
    def name(self) -> str:
        """Name of the design."""
        return self.file.name

    @property
    def water(self) -> Water:
        """Water depth, and current and density at each level."""
        return self.design.water

    @property
    def towed(self) -> bool:
        """Whether a ship or an aircraft tows the design."""
        return self.design.towed

    @property
    def type(self) -> str:
        """Type of the design: ``subsurface``, ``surface``, ``tow`` or ``net``."""
        return "net" if self.several else self.legs[0].type

    @property
    def several(self) -> bool:
        """Whether the file lists named legs, which are solved together."""
        return self.design.several

    @property
    def leg(self) -> LegResult:
        """Result for the only leg of a mooring or a tow. Raises UsageError if there are several
        legs.
        """
        if self.several:
            raise UsageError(
                f"{self.name} has several legs, each with its own ends and shape: see `legs`, "
                "`nodes`, `anchors` and `held`"
            )
        return self.legs[0]

    @property
    def top(self) -> Top:
        """Values at the upper end of the leg."""
        return self.leg.top

    @property
    def anchor(self) -> AnchorLoad:
        """Load on the anchor of the leg. Raises UsageError for a tow."""
        if self.leg.anchor is None:
            raise UsageError(f"{self.name} has no anchor")
        return self.leg.anchor

    @property
    def tow_point(self) -> TowPoint:
        """Load of a tow on the ship. Raises UsageError for a leg that is not towed."""
        return _of_a_tow(self.leg.tow_point, self.name)

    @property
    def body(self) -> TowedBody:
        """Values at the towed body. Raises UsageError for a leg that is not towed."""
        return _of_a_tow(self.leg.body, self.name)

    @property
    def shape(self) -> Shape:
        """Shape of the leg, node by node."""
        return self.leg.shape

    @property
    def still_shape(self) -> Shape | None:
        """Shape of the leg in still water, or None if this shape is not unique."""
        return self.leg.still_shape

    @property
    def profilers(self) -> tuple[ProfilerTravel, ...]:
        """Positions and wire tensions of the profilers of the leg."""
        return self.leg.profilers

    @property
    def strumming(self) -> Strumming | None:
        """Strumming of the cables, or None if the file sets no strumming law."""
        return self.leg.strumming

    @property
    def strumming_band(self) -> StrummingBand | None:
        """Results of the leg if strumming increases the drag of its cables.

        The leg is solved when the attribute is first used.
        """
        return self.leg.strumming_band

    @property
    def other_equilibrium(self) -> dict[str, float] | None:
        """Values of another equilibrium of the leg, or None if none was found."""
        return self.leg.other_equilibrium

    @cached_property
    def components(self) -> Components:
        """Pieces of the file, leg by leg."""
        if not self.several:
            return self.leg.components
        tables = [leg.components.rows(slice(len(leg.leg.pieces))) for leg in self.legs]
        pieces = self.file.pieces
        whole = Components.joined(tables)
        return whole.with_columns(part=list(pieces), index=np.arange(len(pieces)))

    @cached_property
    def clamps(self) -> Clamps:
        """Clamps of the file, leg by leg."""
        if not self.several:
            return self.leg.clamps
        tables = [
            leg.clamps.with_columns(index=leg.clamps.index + leg.leg.keys.first)
            for leg in self.legs
        ]
        return Clamps.joined(tables)

    @property
    def ends(self) -> dict[str, Floats]:
        """Values at the ends of the legs, one value per leg and column; see `MOORED_ENDS`."""
        return {
            one.name: np.array([one.found(leg) for leg in self.legs])
            for one in MOORED_ENDS
            if one.found
        }

    def plot(self, ax: Any = None) -> Any:
        """Draw a side view of the line on matplotlib axes, and return the axes.

        Without `ax`, the line is drawn in a new figure. Raises UsageError if matplotlib is not
        installed.
        """
        form = type(self).plot_form
        assert form is not None, "use calm.load to read a design"
        try:
            return form(self, ax)
        except ModuleNotFoundError as missing:
            raise UsageError(how_to_install(missing) or str(missing)) from None

    def to_pandas(self) -> Any:
        """Return the components as a pandas data frame."""
        return self.components.to_pandas()

    def to_xarray(self) -> Any:
        """Return the dataset that `calm run -o FILE.nc` writes: components, clamps and shape, with
        units.
        """
        from io import BytesIO

        from xarray import load_dataset

        form = type(self).netcdf_form
        assert form is not None, "use calm.load to read a design"
        return load_dataset(BytesIO(form(self)))

    def _repr_html_(self) -> str | None:
        form = type(self).notebook_form
        return None if form is None else form(self)

    def __repr__(self) -> str:
        if self.several:
            lines = [f"{self.name}: {self.type} of {len(self.legs)} legs, {self.status}"]
            lines += [f"node {one.name}: depth {one.depth:.6g}" for one in self.nodes]
            lines += [
                f"{what} of leg {one.leg}: tension {one.tension:.6g}, angle {one.angle:.3g}"
                for what, ends in (("anchor", self.anchors), ("held end", self.held))
                for one in ends
            ]
            return "\n".join([*lines[:9], f"{len(self.warnings)} warnings"])
        lines = [f"{self.name}: {self.type}, {self.status}"]
        for name, end in self._ends().items():
            known = [f"{key} {value:.6g}" for key, value in end.items() if value is not None]
            lines.append(f"{name}: {', '.join(known)}")
        tables = f"{len(self.components)} components, {len(self.clamps)} clamps"
        return "\n".join([*lines, f"{tables}, {len(self.warnings)} warnings"])

    def _ends(self) -> dict[str, dict[str, Any]]:
        if self.towed:
            return {"tow_point": asdict(self.tow_point), "body": asdict(self.body)}
        return {"top": asdict(self.top), "anchor": asdict(self.anchor)}

    def to_dict(self) -> dict[str, Any]:
        """Return the JSON object of the result; None stands for unknown values."""
        from calm.version import __version__

        document = self.file.document
        own_names = ("type", "status", "iterations", "segments", "miss", "closure")
        return {
            "calm": __version__,
            "name": self.name,
            **({} if document is None else {"document": document.to_dict()}),
            **{name: getattr(self, name) for name in own_names},
            "accuracy": {k: v for k, v in asdict(self.accuracy).items() if v is not None},
            **(self._document_of_legs() if self.several else self._document_of_leg()),
            "components": documents(self.components, self.file),
            "clamps": documents(self.clamps, self.file),
            **({} if self.several else {"shape": self.shape.to_dict()}),
            "warnings": list(self.warnings),
        }

    def _document_of_leg(self) -> dict[str, Any]:
        leg, keys = self.leg, self.file.tow
        return {
            **({} if keys is None else {"speed": keys.speed, "toward": keys.toward}),
            **self._ends(),
            **({"profilers": [asdict(one) for one in leg.profilers]} if leg.profilers else {}),
            "strumming": None if leg.strumming is None else asdict(leg.strumming),
            "strumming_band": None if (band := leg.strumming_band) is None else asdict(band),
            "other_equilibrium": leg.other_equilibrium,
        }

    def _document_of_legs(self) -> dict[str, Any]:
        anchors = [asdict(each) for each in self.anchors]
        of_anchors = ("required_weight", "weight", "grounded_length", "slack_length")
        return {
            **({"anchor": anchors[0]} if len(anchors) == 1 else {}),
            "anchors": anchors,
            "held": [
                {k: v for k, v in asdict(each).items() if k not in of_anchors} for each in self.held
            ],
            "nodes": [asdict(each) for each in self.nodes],
            "legs": [
                {
                    "name": leg.name,
                    "closure": leg.closure,
                    "used_buoyancy": leg.top.used_buoyancy,
                    "reserve": leg.top.reserve,
                    "shape": leg.shape.to_dict(),
                }
                for leg in self.legs
            ],
        }


AnyResult: TypeAlias = Result | LegResult
"""Result of a design, or of a single leg."""


def load(
    path: str | Path,
    environment: str | Path | None = None,
    catalogs: Sequence[str | Path] = (),
    text: str | None = None,
) -> Design:
    """Read the file of a mooring, a tow or a net of legs.

    Parameters
    ----------
    path : the YAML file
    environment : name of an entry of `environments` in the file, or an environment file
    catalogs : additional catalogue files, which take precedence over the shipped ones
    text : text that replaces the content of the file; paths remain relative to the file

    Raises
    ------
    InputError
        The file is invalid; all mistakes are listed, each with line and column.
    """
    return load_in(path, (environment,), catalogs, text)[0]


def load_in(
    path: str | Path,
    environments: Sequence[str | Path | None] | None,
    catalogs: Sequence[str | Path] = (),
    text: str | None = None,
) -> list[Design]:
    """Read a file as `load` does, once for each environment.

    If `environments` is None, the file is read for its default environment, and for every
    environment named in the file. A tow is then read for its default environment only.

    Raises InputError with the mistakes of all environments.
    """
    reader = MooringReader(path, catalogs=catalogs, text=text)
    chosen, read = [*(environments or (None,))], []
    problems: dict[Problem, None] = {}
    for name in chosen:
        try:
            file = reader.in_environment(name)
        except InputError as error:
            problems |= dict.fromkeys(error.problems)
            continue
        if environments is None and name is None and file.tow is None:
            chosen += file.variants
        read.append(Design(file, origin=Origin(path, name, tuple(map(Path, catalogs)), text)))
    if problems:
        raise InputError(list(problems))
    return read


def _of_a_tow(end: _End | None, name: str) -> _End:
    if end is None:
        raise UsageError(f"{name} is not towed: it has no tow point and no towed body")
    return end
