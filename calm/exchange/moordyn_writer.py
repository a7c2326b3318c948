"""Write a mooring as an input file of MoorDyn 2, its points where they stand in equilibrium."""

from __future__ import annotations

from dataclasses import dataclass, field
from itertools import groupby
from math import pi, sqrt

from calm.errors import UsageError
from calm.exchange.exported_parts import (
    Coordinates,
    ExportedLine,
    ExportedPart,
    PartLoad,
    PartPath,
    unique_name,
)

CURRENTS = "current_profile.txt"
"""The name under which that program looks for the current, beside its input."""

_RIGID = 1e7  # N: EA of what does not stretch; stiffer lines need shorter steps
_SHORT = 0.5  # m: what is rigid and shorter is softer in proportion, for the same reason
_OWN = 0.5  # share of its mass with which a float moves the length that stands for its own
_LENGTH, _MOST = 20.0, 60  # m of a length between two points, lengths of a cable
_CLOSE = 0.5  # m: a clamp as close to a point stands there
_SEGMENTS = 4  # of a length
_LEAST = 1e-3  # kg of mass and of displaced water per metre, for what has none


@dataclass
class _System:
    """Types, points and lines of the file, as they grow from the anchor up."""

    density: float
    gravity: float
    place: Coordinates
    types: dict[str, str] = field(default_factory=dict)
    points: list[str] = field(default_factory=list)
    lines: list[str] = field(default_factory=list)
    load: PartLoad = field(init=False)

    def __post_init__(self) -> None:
        self.load = PartLoad(self.density)

    def end_point(self, kind: str) -> int:
        """Write the point that the line has reached with what acts there; return its number."""
        volume = (self.load.mass + self.load.net / self.gravity) / self.density
        figures = f"{self.load.mass:.9g}  {volume:.9g}  {self.load.area:.9g}  0"
        x, y, depth = self.place
        number = len(self.points) + 1
        self.points.append(f"{number}  {kind}  {x:.6f}  {y:.6f}  {-depth:.6f}  {figures}")
        return number

    def line(self, name: str, figures: str, length: float, to: Coordinates) -> None:
        """Add an unstretched length [m] of a type from the point reached up to another."""
        below = self.end_point("Free" if self.points else "Fixed")
        chosen = unique_name(self.types, name, figures)
        segments = _SEGMENTS if length > 1.0 else 1
        self.lines.append(
            f"{len(self.lines) + 1}  {chosen}  {below}  {below + 1}  {length:.9g}  {segments}  -"
        )
        self.place, self.load = to, PartLoad(self.density)

    def figures(self, load: PartLoad, stiffness: float) -> str:
        """Return the line type for what acts on a metre."""
        mass = max(load.mass, _LEAST - load.net / self.gravity)
        volume = (mass + load.net / self.gravity) / self.density
        across = sqrt(4.0 * volume / pi)
        return (
            f"{across:.9g}  {mass:.9g}  {stiffness or _RIGID:.9g}  -0.8  0"
            f"  {load.area / across:.9g}  1.0  {load.along / (pi * across):.9g}  0.0"
        )


def moordyn_file(design: ExportedLine) -> tuple[bytes, tuple[str, ...]]:
    """Return the content of the file, and what it cannot hold.

    Raises
    ------
    UsageError
        It is a tow.
    NoEquilibrium
        There is none: its points have no places.
    """
    if design.tow is not None:
        raise UsageError("a tow has no anchor; MoorDyn is given moorings alone")
    paths = design.paths()
    system = _System(design.mean_density, design.gravity, paths[-1].at(1.0))
    lost = ["rigid pieces in a row: each row is one stiff length"]
    numbered = list(enumerate(design.parts))[::-1]
    for flexible, group in groupby(numbered, key=lambda pair: pair[1].flexible):
        members = list(group)
        if flexible:
            for i, part in members:
                _lay(system, part, paths[i])
            continue
        upper = members[-1][0]
        if upper == 0:
            members.pop()
        if members:
            _lay_rigid(system, [part for _, part in members], paths[members[-1][0]].at(0.0))
        if upper == 0:
            _lay_float(system, design, paths[0])
    if any(design.wind):
        lost.append("wind")
    if design.afloat:
        lost.append(
            "the hull of the float: the upper end is held where it is; its point keeps the float's "
            "mass, volume and drag as it floats here"
        )
    else:
        lost.append(
            "that the drag of the float acts at its middle and by its axis: its point has the "
            "pull found here"
        )
    system.end_point("Fixed" if design.afloat else "Free")
    losses = design.losses(lost)
    return _text(design, system, losses).encode(), losses


def _lay(system: _System, part: ExportedPart, path: PartPath) -> None:
    """Lay a cable or chain from its lower end up, cut where something is clamped on.

    It is cut into short lengths too, since that program starts with each as it hangs in still
    water.
    """
    load = PartLoad(system.density)
    load.add(part)
    figures = system.figures(load, part.stiffness)
    count = min(max(round(part.length / _LENGTH), 1), _MOST)
    cuts: dict[float, list[ExportedPart]] = {part.length * k / count: [] for k in range(count)}
    for clamp, at in part.clamps:
        near = min(cuts, key=lambda cut: abs(cut - at))
        place = near if abs(near - at) < _CLOSE else at
        cuts.setdefault(place, []).append(clamp)
    below = part.length
    for at in sorted(cuts, reverse=True):
        if below > at:
            system.line(_word(part.use), figures, below - at, path.at(at / part.length))
            below = at
        for clamp in cuts[at]:
            system.load.add(clamp)


def _lay_rigid(system: _System, parts: list[ExportedPart], top: Coordinates) -> None:
    """Rigid pieces in a row, from the lowest up."""
    load, length = PartLoad(system.density), sum(part.length for part in parts)
    if length <= 0.0:
        load = system.load
    for part in parts:
        load.add_whole(part)
    if length <= 0.0:
        return
    name = _word("_and_".join(dict.fromkeys(part.use for part in parts[:2])))
    system.line(name, system.figures(load.per_metre(length), _stiff(length)), length, top)


def _lay_float(system: _System, design: ExportedLine, path: PartPath) -> None:
    """Lay the uppermost piece: a point, on a stiff length as long as its draft.

    That length takes a share of its mass, neutral in water: that program steps too finely where a
    length is light.
    """
    part = design.parts[0]
    top, bottom = path.at(0.0), path.at(1.0)
    below = bottom[2] / (bottom[2] - top[2]) if top[2] < 0.0 else 1.0
    length = part.length * below
    if length > 0.0:
        own = PartLoad(system.density, mass=_OWN * part.likely_mass).per_metre(length)
        figures = system.figures(own, _stiff(length))
        system.line("float", figures, length, path.at(1.0 - below))
        system.load.mass -= own.mass * length
    system.load.add_whole(part, design.riding[1])
    if not design.afloat:
        net, shown = design.float_as_point(system.density)
        system.load.net += net - part.net
        system.load.area += shown - part.area(system.density)


def _stiff(length: float) -> float:
    """EA of a rigid length [N]."""
    return _RIGID * min(length / _SHORT, 1.0)


def _word(text: str) -> str:
    return "".join(sign if sign.isalnum() and sign.isascii() else "_" for sign in text)


def _text(design: ExportedLine, system: _System, lost: tuple[str, ...]) -> str:
    title = f"{design.name}, by CALM; the current stands in {CURRENTS}; lost:"
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
        *system.points,
        "---------------------- LINES ----------------------------------------",
        "ID   LineType   AttachA  AttachB  UnstrLen  NumSegs  LineOutputs",
        "(#)  (name)     (#)      (#)      (m)       (-)      (-)",
        *system.lines,
        "---------------------- OPTIONS --------------------------------------",
        *(f"{value}   {name}" for value, name in options),
        "------------------------- need this line ----------------------------",
        "",
    ]
    return "\n".join(lines)


def current_profile(design: ExportedLine) -> bytes:
    """Return the current for that program: heights from below the seabed to above the water."""
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
