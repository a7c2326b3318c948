"""Write a mooring as an input file of MoorDyn 2, with its points at their equilibrium positions."""

from dataclasses import dataclass, field, replace
from itertools import groupby
from math import pi, sqrt

from calm.errors import UsageError
from calm.exchange.exported_parts import (
    AS_A_POINT,
    Coordinates,
    ExportedDesign,
    ExportedLine,
    ExportedPart,
    PartLoad,
    place_along,
    unique_name,
)
from calm.exchange.registry import Exported
from calm.files.legs import EndKeys
from calm.physics.line import Floats

_CURRENTS = "current_profile.txt"
"""Name of the current file, which MoorDyn reads from the folder of the input file."""

_RIGID = 1e7  # N: EA of parts that do not stretch; stiffer lines need shorter time steps
_SHORT = 0.5  # m: the EA of a shorter rigid part is reduced in proportion, for the same reason
_OWN = 0.5  # share of the mass of a float that is assigned to the length below its point
_LENGTH, _MOST = 20.0, 60  # length between two points [m]; maximum number of lengths of a cable
_CLOSE = 0.5  # m: a clamp nearer to a point is moved to the point
_SEGMENTS = 4  # number of segments of a length
_LEAST = 1e-3  # kg/m: minimum mass of a line type, and of the water that it displaces


@dataclass
class _Point:
    place: Coordinates
    load: PartLoad
    kind: str = "Free"  # or "Fixed"


@dataclass
class _Length:
    """A line of MoorDyn between two points: line type and unstretched length [m]."""

    type: str
    lower: _Point
    upper: _Point
    length: float


@dataclass
class _System:
    """Contents of the MoorDyn file, collected leg by leg, each leg from its lower end up.

    `here` is the point to which the next line is attached.
    """

    density: float
    gravity: float
    types: dict[str, str] = field(default_factory=dict)
    points: list[_Point] = field(default_factory=list)
    lines: list[_Length] = field(default_factory=list)
    joined: dict[str, _Point] = field(default_factory=dict)
    here: _Point = field(init=False)

    def begin(self, place: Coordinates, kind: str) -> None:
        self.here = _Point(place, PartLoad(self.density), kind)
        self.points.append(self.here)

    def begin_at_node(self, node: str, place: Coordinates) -> None:
        if node not in self.joined:
            self.begin(place, "Free")
            self.joined[node] = self.here
        self.here = self.joined[node]

    def end_at_node(self, node: str) -> None:
        last = self.here
        if node not in self.joined:
            self.joined[node] = last
            return
        self.here = self.joined[node]
        self.points = [point for point in self.points if point is not last]
        self.here.load.merge(last.load)
        for line in self.lines:
            if line.upper is last:
                line.upper = self.here

    def line(self, name: str, figures: str, length: float, to: Coordinates) -> None:
        below, chosen = self.here, unique_name(self.types, name, figures)
        self.begin(to, "Free")
        self.lines.append(_Length(chosen, below, self.here, length))

    def rows(self) -> tuple[list[str], list[str]]:
        points, numbers = [], {id(point): n for n, point in enumerate(self.points, 1)}
        for number, point in enumerate(self.points, 1):
            load, (x, y, depth) = point.load, point.place
            volume = (load.mass + load.net / self.gravity) / self.density
            figures = f"{load.mass:.9g}  {volume:.9g}  {load.area:.9g}  0"
            points.append(f"{number}  {point.kind}  {x:.6f}  {y:.6f}  {-depth:.6f}  {figures}")
        lines = []
        for n, line in enumerate(self.lines, 1):
            ends = f"{numbers[id(line.lower)]}  {numbers[id(line.upper)]}"
            segments = _SEGMENTS if line.length > 1.0 else 1
            lines.append(f"{n}  {line.type}  {ends}  {line.length:.9g}  {segments}  -")
        return points, lines

    def figures(self, load: PartLoad, stiffness: float) -> str:
        """Return the values of a line type, from its load per metre and its EA [N]."""
        mass = max(load.mass, _LEAST - load.net / self.gravity)
        volume = (mass + load.net / self.gravity) / self.density
        across = sqrt(4.0 * volume / pi)
        return (
            f"{across:.9g}  {mass:.9g}  {stiffness or _RIGID:.9g}  -0.8  0"
            f"  {load.area / across:.9g}  1.0  {load.along / (pi * across):.9g}  0.0"
        )


def write_moordyn(exported: ExportedDesign) -> Exported:
    """Convert a line or the legs of a net to a MoorDyn file, and the current to a second file.

    Raise UsageError for a tow, and NoEquilibrium if the mooring has no equilibrium.
    """
    lines = exported.legs
    deepest = max(lines, key=lambda line: line.depth)
    first = replace(lines[0], name=exported.name, depth=deepest.depth)
    if first.tow is not None:
        raise UsageError("tows cannot be written for MoorDyn, only moorings")
    system = _System(first.mean_density, first.gravity)
    lost = ["joints between adjacent rigid pieces: the pieces become one stiff length"]
    for design in lines:
        _lay_line(system, design)
    if any(first.wind):
        lost.append("wind")
    if any(design.afloat for design in lines):
        lost.append(
            "the hull of the float: the upper end is a fixed point with the mass, volume and drag "
            "of the float at its present draft"
        )
    else:
        lost.append(AS_A_POINT)
    losses = first.losses([*lost, *(each for design in lines for each in design.omitted)])
    text = _text(first, system, losses)
    return Exported(text.encode(), losses, {_CURRENTS: _current_profile(deepest)})


def _lay_line(system: _System, design: ExportedLine) -> None:
    paths, (top, bottom) = design.paths(), design.ends or (EndKeys(), None)
    if bottom is not None and bottom.join is not None:
        system.begin_at_node(bottom.join, place_along(paths[-1], 1.0))
    else:
        hangs = bottom is not None and bottom.free
        system.begin(place_along(paths[-1], 1.0), "Free" if hangs else "Fixed")
    numbered = list(enumerate(design.parts))[::-1]
    for flexible, group in groupby(numbered, key=lambda pair: pair[1].flexible):
        members = list(group)
        if flexible:
            for i, part in members:
                _lay_flexible(system, part, paths[i])
            continue
        upper = members[-1][0]
        floats = upper == 0 and top.free
        if floats:
            members.pop()
        if members:
            _lay_rigid(
                system, [part for _, part in members], place_along(paths[members[-1][0]], 0.0)
            )
        if floats:
            _lay_float(system, design, paths[0])
    if top.join is not None:
        system.end_at_node(top.join)
    elif not top.free or design.afloat:
        system.here.kind = "Fixed"


def _lay_flexible(system: _System, part: ExportedPart, path: Floats) -> None:
    load = PartLoad(system.density)
    load.add(part)
    figures = system.figures(load, part.stiffness)
    # lengths are short, because MoorDyn starts from the shape of each length in still water
    count = min(max(round(part.length / _LENGTH), 1), _MOST)
    cuts: dict[float, list[ExportedPart]] = {part.length * k / count: [] for k in range(count)}
    for clamp, at in part.clamps:
        near = min(cuts, key=lambda cut: abs(cut - at))
        place = near if abs(near - at) < _CLOSE else at
        cuts.setdefault(place, []).append(clamp)
    below = part.length
    for at in sorted(cuts, reverse=True):
        if below > at:
            system.line(_word(part.use), figures, below - at, place_along(path, at / part.length))
            below = at
        for clamp in cuts[at]:
            system.here.load.add(clamp)


def _lay_rigid(system: _System, parts: list[ExportedPart], top: Coordinates) -> None:
    load, length = PartLoad(system.density), sum(part.length for part in parts)
    if length <= 0.0:
        load = system.here.load
    for part in parts:
        load.add_whole(part)
    if length <= 0.0:
        return
    name = _word("_and_".join(dict.fromkeys(part.use for part in parts[:2])))
    system.line(name, system.figures(load.per_metre(length), _rigid_stiffness(length)), length, top)


def _lay_float(system: _System, design: ExportedLine, path: Floats) -> None:
    """Add the uppermost piece as a point at its top and a stiff line for its immersed length.

    The stiff line is neutrally buoyant, and has half of the mass. The point has the other half.
    """
    part = design.parts[0]
    top, bottom = place_along(path, 0.0), place_along(path, 1.0)
    below = bottom[2] / (bottom[2] - top[2]) if top[2] < 0.0 else 1.0
    length = part.length * below
    if length > 0.0:
        # MoorDyn needs very short time steps for a light length
        own = PartLoad(system.density, mass=_OWN * part.likely_mass).per_metre(length)
        figures = system.figures(own, _rigid_stiffness(length))
        system.line("float", figures, length, place_along(path, 1.0 - below))
        system.here.load.mass -= own.mass * length
    system.here.load.add_whole(part, design.riding[1])
    if not design.afloat:
        net, shown = design.float_as_point(system.density)
        system.here.load.net += net - part.net
        system.here.load.area += shown - part.area(system.density)


def _rigid_stiffness(length: float) -> float:
    return _RIGID * min(length / _SHORT, 1.0)


def _word(text: str) -> str:
    return "".join(sign if sign.isalnum() and sign.isascii() else "_" for sign in text)


def _text(design: ExportedLine, system: _System, lost: tuple[str, ...]) -> str:
    points, rows = system.rows()
    title = f"{design.name}, exported by CALM, current in {_CURRENTS}, without:"
    options = (
        ("0", "writeLog"), ("0.1", "CFL"), ("RK2", "tScheme"), ("3.0e5", "kBot"),
        ("3.0e4", "cBot"), (f"{system.density:.9g}", "rho"), (f"{design.gravity:.9g}", "g"),
        (f"{design.depth:.9g}", "WtrDpth"), ("1.0", "dtIC"), ("0.0", "TmaxIC"),
        ("4.0", "CdScaleIC"), ("0.0005", "threshIC"), ("0", "WaveKin"), ("1", "Currents"),
        ("1", "disableOutput"), ("1", "disableOutTime"),
    )  # fmt: skip
    lines = [
        "--------------------- MoorDyn Input File ------------------------------------",
        *(" ".join(f"{each}".split()) for each in (title, *(f"  {each}" for each in lost))),
        "---------------------- LINE TYPES -----------------------------------",
        "TypeName   Diam    Mass/m     EA     BA/-zeta    EI    Cd     Ca    CdAx    CaAx",
        "(name)     (m)     (kg/m)     (N)    (N-s/-)   (N-m^2) (-)    (-)   (-)     (-)",
        *(f"{name}  {figures}" for name, figures in system.types.items()),
        "---------------------- POINTS ---------------------------------------",
        "ID   Attachment  X   Y   Z   Mass   Volume   CdA   Ca",
        "(#)  (-)        (m) (m) (m)  (kg)   (m^3)   (m^2)  (-)",
        *points,
        "---------------------- LINES ----------------------------------------",
        "ID   LineType   AttachA  AttachB  UnstrLen  NumSegs  LineOutputs",
        "(#)  (name)     (#)      (#)      (m)       (-)      (-)",
        *rows,
        "---------------------- OPTIONS --------------------------------------",
        *(f"{value}   {name}" for value, name in options),
        "------------------------- need this line ----------------------------",
        "",
    ]
    return "\n".join(lines)


def _current_profile(design: ExportedLine) -> bytes:
    rows = [[0.0 - row[0], *row[1:4]] for row in reversed(design.levels)]
    rows = [[rows[0][0] - 10.0, *rows[0][1:]], *rows, [10.0, *rows[-1][1:]]]
    lines = [
        "--------------------- MoorDyn steady currents File ------------------",
        f"Currents of {' '.join(design.name.split())}, by CALM",
        "z (m), ux (m/s), uy (m/s), uz (m/s)",
        *(" ".join(f"{value:.9g}" for value in row) for row in rows),
        "",
    ]
    return "\n".join(lines).encode()
