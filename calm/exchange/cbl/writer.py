"""Write a mooring or a tow as a WHOI Cable problem, for static and dynamic analysis."""

from dataclasses import dataclass, field, replace
from itertools import pairwise
from math import atan2, degrees, hypot, pi, sqrt

from calm.exchange.exported_parts import (
    AS_A_POINT,
    ExportedDesign,
    ExportedLine,
    ExportedPart,
    PartLoad,
    unique_name,
)
from calm.exchange.part_names import is_called
from calm.exchange.registry import Exported
from calm.files import Chain, Cylinder, Rigid, Sphere
from calm.files.rigid import Displacement
from calm.physics.hull import Hull, cylindrical_hull, spherical_hull, tabulated_hull

_RIGID = 1e8  # N: EA of inextensible pieces
_LEAST_MASS = 0.01  # kg per metre: smallest mass, needed for the dynamics
_LEAST_WEIGHT = 1e-6  # N per metre: for a weight of 0, WHOI Cable uses the mass instead
_FINEST, _COARSEST = 3, 401  # smallest and largest number of nodes of a segment
_APART = 0.5  # m between nodes, within these limits
_CALM = 1e-6  # m/s: a smaller current across the heading is ignored
_LEAST = 1e-3  # smallest diameter in m and mass in kg


@dataclass
class _Problem:
    """Sections of a problem file, collected from the lower end of the line up.

    `density` is the uniform density of the water [kg/m³].
    """

    density: float
    materials: dict[str, str] = field(default_factory=dict)
    connectors: dict[str, str] = field(default_factory=dict)
    layout: list[str] = field(default_factory=list)
    load: PartLoad | None = None
    last: tuple[str, float] = ("", 0.0)

    def segment(self, name: str, length: float) -> None:
        if length <= 0.0:
            return
        if self.load is None and self.last[0] == name:
            length += self.last[1]
            self.layout.pop()
        self._add_connector()
        self.last = name, length
        count = min(max(round(length / _APART) + 1, _FINEST), _COARSEST)
        self.layout.append(
            f"    segment = {{ length = {length:.10g}  material = {name}  nodes = ({count}, 1.0) }}"
        )

    def add_point_load(self, part: ExportedPart) -> None:
        if self.load is None:
            self.load = PartLoad(self.density)
        self.load.add(part)

    def _add_connector(self) -> None:
        if self.load is None:
            return
        load, self.load = self.load, None
        across = sqrt(4.0 * load.area / pi)
        base = load.names[0] if len(set(load.names)) == 1 else "_and_".join(load.names[:2])
        figures = (
            f"d = {max(across, 1e-6):.9g}  wet = {-load.net:.9g}  m = {load.mass:.9g}"
            f"  Cdn = {1.0 if across else 0.0:g}"
        )
        name = unique_name(self.connectors, f"p_{_name_of(base)}", figures)
        self.layout.append(f"    connector = {name}")


def write_cbl(exported: ExportedDesign) -> Exported:
    """Write a design with a single leg as a problem file for WHOI Cable."""
    (design,) = exported.legs
    lost: list[str] = []
    if design.tow is not None:
        design = _along_the_heading(design, lost)
    density = design.mean_density
    problem = _Problem(density)
    if max(row[4] for row in design.levels) - min(row[4] for row in design.levels) > 1e-9:
        lost.append(
            "the density profile: weights and drags are computed for the depths of the parts when "
            "the line is upright"
        )
    parts = list(design.parts)
    if design.tow is None:
        buoy, parts = parts[0], parts[1:]
    else:
        buoy, parts = parts[-1], parts[:-1]
    for part in reversed(parts):
        _add_part(problem, part, lost)
    if buoy.clamps:
        lost.append("clamps on the float: their loads act at the end of the line")
        for clamp, _ in buoy.clamps:
            problem.add_point_load(clamp)
    floating = design.afloat
    if floating and not design.has_draft:
        lost.append("the constant drag of the float: WHOI Cable computes the drag from the draft")
    if design.tow is not None and design.tow.height:
        lost.append("the height of the sheave: in WHOI Cable the line begins at the surface")
    if floating:
        lost.append(
            "the dependence of the float's drag on its draft: Cdn gives the drag at the "
            "present draft"
        )
    elif design.tow is None:
        lost.append(AS_A_POINT)
    if buoy.flexible:
        lost.append("the free end of the line, which is replaced by a small weightless sphere")
    elif not floating and design.tow is None and buoy.length > 0.0:
        problem.segment(_rigid_link(problem), buoy.length)
    if problem.load is not None:
        problem.segment(_rigid_link(problem), 0.001)
    text = _text(design, problem, _buoy_keys(buoy, design, density, lost), density)
    losses = design.losses(lost)
    head = [f"{design.name}, exported by CALM without:", *(f"- {each}" for each in losses)]
    comment = "\n   ".join(line.replace("*/", "* /") for line in head)
    return Exported(f"/* {comment} */\n{text}".encode(), losses)


def _along_the_heading(design: ExportedLine, lost: list[str]) -> ExportedLine:
    """Rotate a tow to the axes of the ship, x ahead and y to port.

    The statics of WHOI Cable use only x and z.
    """
    assert design.tow is not None
    speed = hypot(design.tow.east, design.tow.north)
    if not speed:
        return design
    ahead, port = design.tow.east / speed, design.tow.north / speed
    levels = []
    for depth, east, north, up, density in design.levels:
        along, across = east * ahead + north * port, north * ahead - east * port
        # rounding would otherwise leave a small cross current for a current from ahead or astern
        across = 0.0 if abs(across) < _CALM else across
        levels.append((depth, along, across, up, density))
    heading = degrees(atan2(design.tow.east, design.tow.north)) % 360.0
    lost.append(f"the heading, {heading:.4g} deg true: the x axis of WHOI Cable points ahead")
    if any(level[2] for level in levels):
        lost.append("currents across the heading: the statics of WHOI Cable only use x and z")
    tow = replace(design.tow, east=speed, north=0.0)
    return replace(design, tow=tow, levels=tuple(levels))


def _add_part(problem: _Problem, part: ExportedPart, lost: list[str]) -> None:
    if part.flexible or (part.directional and part.length > 0.0):
        name = _material(problem, part)
        below = part.length
        for clamp, at in sorted(part.clamps, key=lambda pair: -pair[1]):
            problem.segment(name, below - at)
            problem.add_point_load(clamp)
            below = min(at, below)
        problem.segment(name, below)
        return
    link = _rigid_link(problem) if part.length > 0.0 else ""
    if link:
        problem.segment(link, part.length / 2.0)
    problem.add_point_load(part)
    for clamp, at in part.clamps:
        problem.add_point_load(clamp)
        if abs(at - part.length / 2.0) > 0.05:
            lost.append(
                "the positions of clamps on rigid pieces: their loads act at the middle of the "
                "piece"
            )
    if link:
        problem.segment(link, part.length / 2.0)


def _rigid_link(problem: _Problem) -> str:
    figures = (
        f"d = 0.001  m = {_LEAST_MASS}  wet = {_LEAST_WEIGHT}  Cdn = 0  Cdt = 0"
        f"  EA = {_RIGID:g}  EI = 1e-4  GJ = 1e-4"
    )
    return unique_name(problem.materials, "link", figures)


def _material(problem: _Problem, part: ExportedPart) -> str:
    per = 1.0 if part.flexible else part.length
    wet, across = 0.0 - part.net / per, part.diameter or part.area() / per
    normal = part.area(problem.density) / per / across if across else 0.0
    along = part.area(problem.density, along=True) / per / (pi * across) if across else 0.0
    figures = (
        f"d = {across:.9g}  m = {max(part.likely_mass / per, _LEAST_MASS):.9g}  wet = "
        f"{wet if abs(wet) > _LEAST_WEIGHT else _LEAST_WEIGHT:.9g}  Cdn = {normal:.9g}  Cdt = "
        f"{along:.9g}  EA = {part.stiffness or _RIGID:.9g}  EI = 1e-4  GJ = 1e-4"
    )
    name = _name_of(part.use)
    if isinstance(part.component, Chain) and not is_called(name, "chain"):
        name = f"chain_{name}"
    return unique_name(problem.materials, name, figures)


def _name_of(text: str) -> str:
    word = "".join(sign if sign.isalnum() and sign.isascii() else "_" for sign in text)
    return word if word[:1].isalpha() else f"n_{word}"  # a name must begin with a letter


def _text(design: ExportedLine, problem: _Problem, buoy: str, density: float) -> str:
    depth, wind = [], []
    if design.tow:
        buoys, anchors = [f"    towed  {buoy}", "    vessel  type = ship"], []
        speeds = f"x-speed = {design.tow.east:.9g}  y-speed = {design.tow.north:.9g}"
        ends = "buoy = towed", f"buoy = vessel  {speeds}"
    else:
        assert design.anchor is not None
        anchor, weight = design.anchor
        friction = f"  mu = {anchor.friction:.9g}" if anchor.friction else ""
        height = f"  z = {anchor.length:.9g}" if anchor.length else ""
        bottom = "bottom-stiffness = 100   bottom-damping = 1"
        depth = [f"    depth = {design.depth:.9g}   {bottom}"]
        buoys = [f"    upper_end  {buoy}"]
        figures = f"wet = {weight:.9g}  m = {weight / 8.0:.9g}{friction}"
        anchors = ["", "Anchors", f"    anchor  {figures}"]
        ends = f"anchor = anchor{height}", "buoy = upper_end"
    currents = [
        f"    {axis}-current = " + " ".join(f"({r[0]:.9g}, {r[column]:.9g})" for r in design.levels)
        for axis, column in (("x", 1), ("y", 2), ("z", 3))
        if any(r[column] for r in design.levels)
    ]
    if any(design.wind):
        wind = [f"    x-wind = {design.wind[0]:.9g}   y-wind = {design.wind[1]:.9g}"]
    lines = [
        "Problem Description",
        f'    title = "{design.name.replace(chr(34), chr(39))}"',
        f"    type = {'towing' if design.tow else 'surface' if design.afloat else 'subsurface'}",
        "",
        "Analysis Parameters",
        f"    static-solution = {'shooting' if design.tow else 'relaxation'}",
        "    static-relaxation = 0.1   static-iterations = 20000   static-tolerance = 1e-5",
        "    static-outer-iterations = 500   static-outer-tolerance = 1e-3",
        "    duration = 60   time-step = 0.1   ramp-time = 10",
        "    dynamic-relaxation = 1.0   dynamic-iterations = 20   dynamic-tolerance = 1e-6",
        "",
        "Environment",
        f"    rho = {density:.9g}   gravity = {design.gravity:.9g}",
        *(*depth, *currents, *wind, "", "Buoys", *buoys, *anchors, "", "Connectors"),
        *(f"    {name}  {each}" for name, each in problem.connectors.items()),
        *("", "Materials"),
        *(f"    {name}  {each}" for name, each in problem.materials.items()),
        *("", "Layout", f"    terminal = {{ {ends[0]} }}", *problem.layout),
        *(f"    terminal = {{ {ends[1]} }}", "", "End", ""),
    ]
    return "\n".join(lines)


def _buoy_keys(part: ExportedPart, design: ExportedLine, density: float, lost: list[str]) -> str:
    if part.flexible:
        return "type = sphere  d = 0.001  m = 0.001  buoyancy = 0.01  Cdn = 0"
    floating, gravity = design.afloat, design.gravity
    net, seen = part.net, part.area(density)
    if not floating and design.tow is None:
        net, seen = design.float_as_point(density)
    mass = max(part.likely_mass, _LEAST)
    lift = net + mass * gravity
    if lift <= 0.0:
        mass, lift = -net / gravity * 1.2, 0.2 * -net
    form = getattr(part.component, "hull", None)
    form = form if isinstance(form, Displacement) else part.component
    wind = _windage_keys(part, design)
    if floating and isinstance(form, Displacement | Cylinder):
        if isinstance(form, Displacement):
            diameters, rows = _hull_of_revolution(form)
            hull, volume = tabulated_hull(rows), rows[-1][1]
            size = f"type = axisymmetric  m = {mass:.9g}  diameters = {diameters}"
        else:
            hull = cylindrical_hull(form.diameter, part.length)
            volume = pi / 4.0 * form.diameter**2 * part.length
            size = (
                f"type = cylinder  d = {form.diameter:.9g}  h = {part.length:.9g}  m = {mass:.9g}"
            )
        most = density * gravity * volume
        drag = seen / hull.area * _drag_share(design, hull, mass, part.net, most)
        return f"{size}  Cdn = {drag:.9g}{wind}"
    if floating and not isinstance(part.component, Sphere):
        lost.append("the hull of the float, which is replaced by a sphere with the same drag")
    across = part.diameter if isinstance(part.component, Sphere) else sqrt(4.0 * seen / pi)
    hull = spherical_hull(max(across, _LEAST))
    drag = seen / hull.area
    if floating:
        drag *= _drag_share(design, hull, mass, part.net, lift)
    size = f"type = sphere  d = {hull.height:.9g}"
    return f"{size}  m = {mass:.9g}  buoyancy = {lift:.9g}  Cdn = {drag:.9g}{wind}"


def _windage_keys(part: ExportedPart, design: ExportedLine) -> str:
    component = part.component
    if not isinstance(component, Rigid):
        return ""
    seen, coefficient = component.wind_area, component.wind_cd
    if any(design.wind) and design.afloat:
        seen, coefficient = design.windage
    shown = f"  Sw = {seen:.9g}" if seen else ""
    return shown + (f"  Cdw = {coefficient:.9g}" if coefficient else "")


def _drag_share(design: ExportedLine, hull: Hull, mass: float, net: float, most: float) -> float:
    """Return the factor on a hull's drag coefficient that gives the drag computed by CALM.

    `net` is the net buoyancy of the immersed float [N]. `most` is the weight of the water that the
    whole hull displaces [N].
    """
    used, seen = design.riding
    immersed = min(max((mass * design.gravity + used * net) / most, 0.0), 1.0)
    shown = hull.curve(immersed)[1]
    return seen / shown if shown > 0.0 else 1.0


def _hull_of_revolution(form: Displacement) -> tuple[str, list[tuple[float, float, float]]]:
    """Convert a displacement table to levels and diameters of a hull of revolution.

    Also return rows of draft [m], displaced volume [m³] and area [m²] of this hull.
    """
    table = form.displacement
    if table[0][0] > 0.0:
        table = ((0.0, 0.0, 0.0), *table)
    pairs, rows, shown = [], [(0.0, 0.0, 0.0)], 0.0
    for (low, less, _), (high, more, _) in pairwise(table):
        across = sqrt(4.0 * (more - less) / (high - low) / pi)
        pairs += [(low, across), (high - 1e-6, across)]
        shown += (high - low) * across
        rows.append((high, more, shown))
    return " ".join(f"({level:.9g}, {across:.9g})" for level, across in pairs), rows
