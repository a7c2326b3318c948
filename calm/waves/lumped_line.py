"""A line in equilibrium as lumped masses and springs, for small motions about this equilibrium."""

from __future__ import annotations

from dataclasses import dataclass
from math import pi
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from calm.assemble import mass_in_air
from calm.files import Cable, Chain, Component, Cylinder, Flexible
from calm.physics.line import Floats, Integers, Line
from calm.physics.seawater import REFERENCE_DENSITY

if TYPE_CHECKING:
    from calm.case.leg import Leg
    from calm.solve import Solution

Complexes = NDArray[np.complex128]

SHORTEST = 0.05
"""Length below which an element is not treated as a spring; its mass is added to the node [m]."""

RIGID = 1e9
"""Stiffness EA of elements that are treated as inextensible [N]."""

CHAIN_STIFFNESS = 0.854e11
"""Stiffness EA of studless chain divided by the squared bar diameter [N/m²], from the catenary
tables of OrcaFlex.
"""

CYLINDER_ADDED, SPHERE_ADDED, BODY_ADDED = 1.0, 0.5, 1.0
"""Ratios of added mass to displaced mass: normal to a cylinder, for a sphere, and for other bodies
(DNV-RP-C205, appendix D).
"""


@dataclass(frozen=True)
class LumpedLine:
    """Line of n lumped masses with n - 1 springs between the masses, free end first.

    The last mass does not move. Unit vectors point down the line. Normal and tangential values are
    for motion normal to the line and along the line.

    Attributes
    ----------
    position : (n, 3) position east, north, and up from the surface [m]
    added_across, added_along : (n,) normal and tangential added mass [kg]
    water_across, water_along : (n,) mass of displaced water for normal and tangential wave pressure
        [kg]; the tangential mass of a cable or chain is 0
    across_drag, along_drag, any_drag : (n,) K of the drag K|v|v for normal flow, for tangential
        flow, and for flow in any direction [N/(m/s)²]
    tangent, spring : (n, 3), (n-1, 3) unit vectors at the nodes and along the springs
    tension, stiffness : (n-1,) tension of the springs [N], and their stiffness dT/d(length) [N/m]
    span : (n-1,) stretched lengths of the springs [m]
    current : (n, 3) current at the nodes [m/s]
    piece_spring, piece_below : (pieces,) indices of the first and the second spring of each piece.
        Both are equal for a piece with one spring. For a piece of the top float, the first is the
        spring below the float; for a piece on the seabed, it is -1
    piece_node : (pieces,) node at the upper end of each piece; -1 on the seabed
    top_pieces : number of pieces of the top float, with the pieces that the float carries
    inextensible : labels of cables with unknown stiffness
    """

    position: Floats
    mass: Floats
    added_across: Floats
    added_along: Floats
    water_across: Floats
    water_along: Floats
    across_drag: Floats
    along_drag: Floats
    any_drag: Floats
    tangent: Floats
    tension: Floats
    stiffness: Floats
    spring: Floats
    span: Floats
    current: Floats
    piece_spring: Integers
    piece_below: Integers
    piece_node: Integers
    top_pieces: int
    inextensible: tuple[str, ...]

    def turned(self, motion: Complexes) -> Complexes:
        """Return the rotations of the springs [rad] for given motions of the nodes.

        Motions (f, n, 3) give rotations (f, n-1, 3): the changes of the unit vectors along the
        springs.
        """
        turn = np.diff(motion, axis=1) / self.span[:, None]
        return np.asarray(turn - (turn * self.spring).sum(2, keepdims=True) * self.spring)

    def upper_ends(self, middle: Complexes) -> Complexes:
        """Extrapolate values from the midpoints of springs to the upper ends of pieces.

        The arrays are (f, n-1, …) and (f, pieces, …). The value is 0 for pieces on the seabed.
        """
        first, next_one = self.piece_spring, self.piece_below
        share = self.span[first] / (self.span[first] + self.span[next_one])
        shape = (-1,) + (1,) * (middle.ndim - 2)
        ends = middle[:, first] + share.reshape(shape) * (middle[:, first] - middle[:, next_one])
        return np.asarray(np.where((first >= 0).reshape(shape), ends, 0.0))


def lumped_line(leg: Leg, solution: Solution, longest: float) -> LumpedLine:
    """Represent the line of an equilibrium by lumped masses and springs.

    Parts on the seabed are omitted, since they do not move.

    Parameters
    ----------
    leg : leg to which the solution belongs
    longest : largest length of an element [m]
    """
    pieces = leg.file.pieces
    carried = solution.carried
    buoy = (solution.afloat[0] + 1) if solution.afloat else 0
    first = int(solution.piece_nodes[buoy - 1, 1]) if buoy else 0
    last = max(solution.hanging, first + 1)
    span = np.linalg.norm(np.diff(solution.position, axis=0), axis=1)

    position = [solution.position[first]]
    elements: list[tuple[int, float, float, float]] = []  # piece, span, unstretched, tension
    lumps: list[tuple[int, int, int, float]] = []  # node, piece, clamp, unstretched
    starts: dict[int, int] = {}
    for one in range(first, last):
        piece, clamp = int(solution.element_piece[one]), int(solution.element_clamp[one])
        starts.setdefault(piece, len(position) - 1)
        if clamp >= 0 or span[one] < SHORTEST:
            lumps.append((len(position) - 1, piece, clamp, float(solution.cut[one])))
            continue
        flexible = isinstance(pieces[piece].component, Flexible)
        count = max(int(np.ceil(span[one] / longest)), 1) if flexible else 1
        begin, end = solution.position[one], solution.position[one + 1]
        for part in range(1, count + 1):
            position.append(begin + (end - begin) * part / count)
            tension = 0.5 * float(solution.tension[one] + solution.tension[one + 1])
            elements.append((piece, span[one] / count, solution.cut[one] / count, tension))

    n = len(position)
    where = np.array(position)
    node = {name: np.zeros(n) for name in _NODE_FIGURES}
    inextensible: dict[str, None] = {}
    stiffness = np.empty(n - 1)
    stretches = ("stiffness", "elongation", "dynamic_stiffness")
    for number, (piece, length, cut, tension) in enumerate(elements):
        component = pieces[piece].component
        for name, value in _element_figures(component, carried, piece, cut).items():
            node[name][number : number + 2] += 0.5 * value
        if isinstance(component, Cable) and not any(getattr(component, way) for way in stretches):
            inextensible[pieces[piece].label] = None
        stiffness[number] = _axial(component, tension) / (cut if cut > 0.0 else length)
    clamps = [clamp for each in pieces for clamp in each.clamps]
    for at, piece, clamp, cut in lumps:
        if clamp < 0:
            figures = _element_figures(pieces[piece].component, carried, piece, cut)
        else:
            own = _figures_of(clamps[clamp].component, _length_of(clamps[clamp].component))
            figures = {**own, "any_drag": float(carried.clamp_drag[clamp])}
        for name, value in figures.items():
            node[name][at] += value

    spring = np.diff(where, axis=0)
    span = np.linalg.norm(spring, axis=1)
    spring /= span[:, None]
    tangent = np.vstack([spring[:1], spring[:-1] + spring[1:], spring[-1:]])
    tangent /= np.linalg.norm(tangent, axis=1)[:, None]
    water, depth = leg.water, np.maximum(-where[:, 2], 0.0)
    denser = water.density_at(depth) / REFERENCE_DENSITY
    for name in ("across_drag", "along_drag", "any_drag"):
        node[name] *= denser
    count = len(solution.line.length)
    piece_node = np.array([starts.get(piece, -1) for piece in range(count)])
    piece_spring = np.where(piece_node >= 0, np.minimum(piece_node, n - 2), -1)
    if buoy:
        piece_node[:buoy], piece_spring[:buoy] = 0, 0
    elif count > 1:
        piece_spring[0] = piece_spring[1]
    owner = np.array([each[0] for each in elements])
    below = np.minimum(piece_spring + 1, n - 2)
    return LumpedLine(
        position=where,
        **node,
        tangent=tangent,
        tension=np.array([each[3] for each in elements]),
        stiffness=stiffness,
        spring=spring,
        span=span,
        current=water.current_at(depth),
        piece_spring=piece_spring,
        piece_below=np.where(owner[below] == owner[piece_spring], below, piece_spring),
        piece_node=piece_node,
        top_pieces=max(buoy, 1),
        inextensible=tuple(inextensible),
    )


_NODE_FIGURES = (
    *("mass", "added_across", "added_along", "water_across", "water_along"),
    *("across_drag", "along_drag", "any_drag"),
)


def _element_figures(
    component: Component, carried: Line, piece: int, cut: float
) -> dict[str, float]:
    """Return masses and drag of a rigid piece, or of `cut` metres of a flexible piece."""
    flexible = isinstance(component, Flexible)
    share, length = (cut, 1.0) if flexible else (1.0, _length_of(component))
    across, along = float(carried.normal_drag[piece]), float(carried.tangential_drag[piece])
    drags = {"across_drag": 0.0, "along_drag": 0.0, "any_drag": across}
    if carried.directional[piece]:
        drags = {"across_drag": across, "along_drag": along, "any_drag": 0.0}
    figures = {**_figures_of(component, length), **drags}
    return {name: share * value for name, value in figures.items()}


def _length_of(component: Component) -> float:
    return float(getattr(component, "length", 0.0) or 0.0)


def _figures_of(component: Component, length: float) -> dict[str, float]:
    """Return the masses of a component [kg], or for a flexible component per metre [kg/m].

    If the mass is unknown, it is computed from the net buoyancy and the displaced volume.
    """
    water = REFERENCE_DENSITY * _volume(component, length)
    mass = mass_in_air(component)
    if mass is None:
        mass = max(water - component.net_buoyancy / 9.80665, 0.0)
    slender = isinstance(component, Flexible)
    across, along = CYLINDER_ADDED, 0.0
    if not slender and not isinstance(component, Cylinder):
        across = along = SPHERE_ADDED if component.kind == "sphere" else BODY_ADDED
    return {
        "mass": mass,
        "added_across": across * water,
        "added_along": along * water,
        "water_across": water,
        "water_along": 0.0 if slender else water,
    }


def _volume(component: Component, length: float) -> float:
    """Return the displaced volume [m³], or [m³/m] for a flexible component."""
    diameter = float(getattr(component, "diameter", 0.0) or 0.0)
    if isinstance(component, Cable):
        return pi * diameter**2 / 4.0
    if component.displaced_volume:
        return float(component.displaced_volume)
    if isinstance(component, Chain):
        mass = mass_in_air(component) or 0.0
        return mass / 7850.0
    if isinstance(component, Cylinder):
        return pi * diameter**2 / 4.0 * length
    if component.kind == "sphere":
        return pi * diameter**3 / 6.0
    return 0.0


def _axial(component: Component, tension: float) -> float:
    """Return the stiffness EA for small changes about a tension [N]."""
    if isinstance(component, Chain):
        return component.stiffness or CHAIN_STIFFNESS * component.diameter**2
    if isinstance(component, Cable):
        if component.dynamic_stiffness is not None:
            return component.dynamic_stiffness
        if component.stiffness is not None:
            return component.stiffness
        if component.elongation is not None:
            step = max(0.01 * tension, 1.0)
            below = max(tension - step, 0.0)
            strained = component.strain_under(tension + step) - component.strain_under(below)
            return (tension + step - below) / strained if strained > 0.0 else RIGID
    return RIGID
