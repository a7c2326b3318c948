"""Forces on the loads of a moving chain, and their derivatives."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from calm.drop.chain import BarChain
from calm.physics.drag import Friction
from calm.physics.line import Floats, Water
from calm.physics.seawater import REFERENCE_DENSITY

SLOWEST = 1e-3
"""Speed below which drag is proportional to the speed instead of its square [m/s]. Otherwise a line
at rest would have no resistance to motion.
"""


@dataclass(frozen=True)
class WaterColumn:
    """Water properties as functions of depth, with their vertical gradients.

    Attributes
    ----------
    water : levels and properties of the water
    skin : thickness of the surface layer [m] in which a float with unknown hull loses its buoyancy
    """

    water: Water
    skin: float

    @cached_property
    def _rows(self) -> tuple[Floats, Floats]:
        """u, v, w and density (4, levels) at the levels, and their increase per metre of depth.

        The increases (4, levels + 1) are for the layers above, between and below the levels.
        """
        water = self.water
        values = np.stack([water.u, water.v, water.w, water.density])
        slopes = np.zeros((4, values.shape[1] + 1))
        slopes[:, 1:-1] = np.diff(values) / np.diff(water.level)
        return values, slopes

    def at(self, depth: Floats) -> tuple[Floats, Floats, Floats]:
        """Return current (3, k), vertical gradient of the current (3, k), and density at depths.

        The gradient is the increase per metre of depth.
        """
        values, slopes = self._rows
        interval = self.water.level.searchsorted(depth, side="right")
        origin = np.maximum(interval - 1, 0)
        slope = slopes.take(interval, axis=1)
        found = slope * (depth - self.water.level[origin])
        found += values.take(origin, axis=1)
        return found[:3], slope[:3], found[3]


@dataclass(frozen=True)
class Loads:
    """Forces on the k loads of a chain, and their derivatives.

    Attributes
    ----------
    force : (3, k) force [N]
    by_flow : (3, 3, k) derivative of the force by the flow past the load [N/(m/s)]
    by_axis : (3, 3, k) derivative of the force by the unit axis of the bar [N]; valid for a change
        of the axis normal to itself
    by_height : (3, k) derivative of the force by the height of the load, which includes the effect
        of the current shear [N/m]
    """

    force: Floats
    by_flow: Floats
    by_axis: Floats
    by_height: Floats


def loads_on(
    chain: BarChain,
    sea: WaterColumn,
    height: Floats,
    velocity: Floats,
    axis: Floats,
    strain: Floats,
    variation: Floats,
    slowest: float = SLOWEST,
) -> Loads:
    """Compute the forces on the k loads of a chain, and their derivatives.

    Parameters
    ----------
    height, velocity : (k,) height above the surface [m], and (3, k) velocity over the ground [m/s]
    axis, strain : (3, k) unit axis, down the line, and (k,) strain of the bar of each load
    variation : (k,) factor on the normal drag, from the Reynolds number of smooth bodies
    slowest : speed below which drag is proportional to the speed [m/s]
    """
    on = chain.elements
    current, shear, density = sea.at(-height)
    flow = current - velocity
    dense = density / REFERENCE_DENSITY
    grown = dense
    if on.thins:
        grown = dense * (1.0 + 2.0 * on.thinning * (np.sqrt(1.0 + np.maximum(strain, 0.0)) - 1.0))
    lift, stiffness, wet, wetting, push = _afloat(chain, sea, height, density)
    speed = np.sqrt(_scalar_products(flow, flow) + slowest**2)
    along = on.directional * _scalar_products(flow, axis)
    across = flow - along * axis
    size = np.sqrt(_scalar_products(across, across) + slowest**2)
    kn, kt = grown * variation * on.normal_drag, on.directional * grown * on.tangential_drag
    square, slope, aside, oblique = _friction(chain, kt, along, speed, slowest)
    sized = kn * size
    drag = sized * across + square * axis
    # d(s n)/dn of the normal drag is s + n n/s; n = V - (V.t) t is normal to t
    held, skewed = wet * sized, wet * (slope - on.directional * sized)
    turned = wet * square - along * held
    normal = (wet * kn / size * across)[:, np.newaxis] * across
    by_flow = normal + (skewed * axis)[:, np.newaxis] * axis
    by_axis = axis[:, np.newaxis] * (skewed * across - turned * axis) - along * normal
    _diagonal(by_axis)[...] += turned
    if aside is not None:
        by_flow += (wet * aside * axis)[:, np.newaxis] * flow
    if oblique is not None:
        drag += oblique * flow
        by_flow += (wet * oblique / speed**2 * flow)[:, np.newaxis] * flow
        held = held + wet * oblique
    _diagonal(by_flow)[...] += held
    force = wet * drag + push
    force[2] += lift
    if on.lifts:
        raised = dense * on.lift * wet
        force[2] += raised * speed**2
        by_flow[2] += 2.0 * raised * flow
    by_height = wetting * drag - np.einsum("ijk,jk->ik", by_flow, shear)
    by_height[2] += stiffness
    return Loads(force, by_flow, by_axis, by_height)


def _diagonal(matrices: Floats) -> Floats:
    """Return the diagonals (3, k) of matrices (3, 3, k), as a view."""
    return matrices.reshape(9, -1)[::4]


def _scalar_products(one: Floats, other: Floats) -> Floats:
    products: Floats = np.einsum("ij,ij->j", one, other)
    return products


def _friction(
    chain: BarChain, kt: Floats, along: Floats, speed: Floats, slowest: float
) -> tuple[Floats, Floats, Floats | None, Floats | None]:
    """Compute the tangential drag of the loads, and its derivatives.

    Returns
    -------
    Four arrays (k,), where None stands for zero:

    - drag along the axis;
    - derivative of this drag by the tangential flow;
    - derivative of this drag by the speed, divided by the speed;
    - for Hoerner's law, drag in the direction of the flow, divided by the speed.
    """
    law = chain.line.friction
    straight = kt * np.sqrt(along**2 + slowest**2)
    square, slope = straight * along, 2.0 * straight
    cable = chain.elements.flexible
    if law is Friction.CONSTANT:
        # |V|² in the direction of the tangential flow
        sign = along / np.sqrt(along**2 + slowest**2)
        square = np.where(cable, kt * speed**2 * sign, square)
        slope = np.where(cable, kt * speed**2 * (1.0 - sign**2) / np.hypot(along, slowest), slope)
        return square, slope, np.where(cable, 2.0 * kt * sign, 0.0), None
    if law is Friction.HOERNER:
        square, slope = (np.where(cable, 0.0, each) for each in (square, slope))
        return square, slope, None, np.where(cable, kt * speed, 0.0)
    return square, slope, None, None


def _afloat(
    chain: BarChain, sea: WaterColumn, height: Floats, density: Floats
) -> tuple[Floats, Floats, Floats, Floats, Floats]:
    """Compute buoyancy, drag fraction and wind force of the loads near or above the surface.

    Returns
    -------
    Net vertical force and its derivative by height, immersed fraction of the drag and its
    derivative by height, and wind force.
    """
    on, gravity = chain.elements, sea.water.gravity
    net = on.buoyancy + (density - REFERENCE_DENSITY) * gravity * on.volume
    top, push = height + 0.5 * on.height, on.push
    lift, wet, stiffness = net.copy(), np.ones(len(net)), np.zeros(len(net))
    wetting = stiffness.copy()
    if top.max() > 0.0:
        weight = REFERENCE_DENSITY * gravity * on.volume - on.buoyancy
        dry = np.where(on.out & (on.volume > 0.0), weight, np.maximum(weight, 0.0))
        immersion = np.clip(1.0 - top / sea.skin, 0.0, 1.0)
        share = immersion**2 * (3.0 - 2.0 * immersion)
        rise = -6.0 * immersion * (1.0 - immersion) / sea.skin
        emerges = (net > 0.0) | on.out
        lift = np.where(emerges, share * (net + dry) - dry, net)
        stiffness = np.where(emerges, rise * (net + dry), 0.0)
        wet, wetting = np.where(on.out, share, 1.0), np.where(on.out, rise, 0.0)
    if chain.afloat is not None:
        hull, i = chain.afloat, chain.afloat.element
        draft = 0.5 - height[i] / hull.height
        near = draft + np.array([-_STEP, 0.0, _STEP])
        immersed, drag = (np.interp(near, hull.draft, y) for y in (hull.immersed, hull.drag))
        whole = hull.weight + net[i]
        growth = -0.5 / (_STEP * hull.height)
        lift[i] = whole * immersed[1] - hull.weight
        stiffness[i] = growth * whole * (immersed[2] - immersed[0])
        wet[i], wetting[i] = drag[1], growth * (drag[2] - drag[0])
        push = push.copy()
        push[:2, i] += [np.interp(draft, hull.draft, hull.push[:, k]) for k in (0, 1)]
    return lift, stiffness, wet, wetting, push


_STEP = 1e-3
"""Step of the draft in the finite difference for the derivative of a hull's buoyancy."""
