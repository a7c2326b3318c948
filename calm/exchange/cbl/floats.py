"""The upper end of a mooring, or what is towed, as a buoy of WHOI Cable."""

from __future__ import annotations

from itertools import pairwise
from math import pi, sqrt

from calm.exchange.parts import ExportedLine, ExportedPart, area, as_point, mass_of
from calm.files import Cylinder, Rigid, Sphere
from calm.files.rigid import Displacement
from calm.physics.hull import Hull, cylindrical_hull, spherical_hull, tabulated_hull

_LEAST = 1e-3  # m of diameter, kg of mass


def buoy_figures(part: ExportedPart, design: ExportedLine, density: float, lost: list[str]) -> str:
    """Its size, mass, buoyancy and drag, in the words of that program.

    Parameters
    ----------
    density : of the water there [kg/m³]
    lost : what the other program cannot hold is added to it
    """
    if part.flexible:
        return "type = sphere  d = 0.001  m = 0.001  buoyancy = 0.01  Cdn = 0"
    floating, gravity = design.afloat[0], design.gravity
    net, seen = part.net, area(part, density)
    if not floating and design.tow is None:
        net, seen = as_point(design, density)
    mass = max(mass_of(part), _LEAST)
    lift = net + mass * gravity
    if lift <= 0.0:
        mass, lift = -net / gravity * 1.2, 0.2 * -net
    form = getattr(part.component, "hull", None)
    wind = _windage(part, design)
    if floating and isinstance(form, Displacement):
        diameters, rows = _turned(form)
        hull = tabulated_hull(rows)
        most = density * gravity * rows[-1][1]
        drag = seen / hull.area * _drag_share(design, hull, mass, part.net, most)
        size = f"type = axisymmetric  m = {mass:.9g}  diameters = {diameters}"
        return f"{size}  Cdn = {drag:.9g}{wind}"
    if floating and isinstance(part.component, Cylinder):
        hull = cylindrical_hull(part.diameter, part.length)
        most = density * gravity * pi / 4.0 * part.diameter**2 * part.length
        drag = seen / hull.area * _drag_share(design, hull, mass, part.net, most)
        size = f"type = cylinder  d = {part.diameter:.9g}  h = {part.length:.9g}"
        return f"{size}  m = {mass:.9g}  Cdn = {drag:.9g}{wind}"
    if floating and not isinstance(part.component, Sphere):
        lost.append("the hull of the float: it is a sphere of its drag")
    across = part.diameter if isinstance(part.component, Sphere) else sqrt(4.0 * seen / pi)
    hull = spherical_hull(max(across, _LEAST))
    drag = seen / hull.area
    if floating:
        drag *= _drag_share(design, hull, mass, part.net, lift)
    size = f"type = sphere  d = {hull.height:.9g}"
    return f"{size}  m = {mass:.9g}  buoyancy = {lift:.9g}  Cdn = {drag:.9g}{wind}"


def _windage(part: ExportedPart, design: ExportedLine) -> str:
    """The area of a float in the wind, where there is wind or the file gives it."""
    component = part.component
    if not isinstance(component, Rigid):
        return ""
    seen, coefficient = component.wind_area, component.wind_cd
    if design.wind[0] and design.afloat[0]:
        seen, coefficient = design.windage
    shown = f"  Sw = {seen:.9g}" if seen else ""
    return shown + (f"  Cdw = {coefficient:.9g}" if coefficient else "")


def _drag_share(design: ExportedLine, hull: Hull, mass: float, net: float, most: float) -> float:
    """Factor on the drag of a hull with which it drags, at its draft, as in CALM.

    Parameters
    ----------
    net, most : its net buoyancy, and what displaces all of it lifts [N]
    """
    used, seen = design.riding
    immersed = min(max((mass * design.gravity + used * net) / most, 0.0), 1.0)
    shown = hull.curve(immersed)[1]
    return seen / shown if shown > 0.0 else 1.0


def _turned(form: Displacement) -> tuple[str, list[tuple[float, float, float]]]:
    """Levels and diameters of a hull of revolution that displaces what a table says.

    With them the rows of draft [m], displaced volume [m³] and area [m²] that such a hull has.
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
