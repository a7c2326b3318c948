"""Forces on the loads of a chain that moves, and how they change with its motion."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from calm.drop.chain import BarChain
from calm.physics.drag import Friction
from calm.physics.line import Floats, Water
from calm.physics.seawater import REFERENCE_DENSITY

SLOWEST = 1e-3
"""Speed below which drag goes with the speed and not with its square [m/s]; else a line at rest
would have nothing to keep it where it is."""


@dataclass(frozen=True)
class WaterColumn:
    """Water by depth with its gradients.

    Attributes
    ----------
    water : the sea
    skin : thickness of the layer below the surface in which what floats there loses its buoyancy,
        where nothing is known of its hull [m]
    """

    water: Water
    skin: float

    @cached_property
    def _rows(self) -> tuple[Floats, Floats]:
        """Rows u, v, w, density at every level, and their growth per metre below it."""
        water = self.water
        values = np.stack([water.u, water.v, water.w, water.density])
        slopes = np.zeros((4, values.shape[1] + 1))
        slopes[:, 1:-1] = np.diff(values) / np.diff(water.level)
        return values, slopes

    def at(self, depth: Floats) -> tuple[Floats, Floats, Floats]:
        """Current (3, k), its growth per metre of depth (3, k), and density (k,)."""
        values, slopes = self._rows
        interval = self.water.level.searchsorted(depth, side="right")
        origin = np.maximum(interval - 1, 0)
        slope = slopes.take(interval, axis=1)
        found = slope * (depth - self.water.level[origin])
        found += values.take(origin, axis=1)
        return found[:3], slope[:3], found[3]


@dataclass(frozen=True)
class Loads:
    """Forces on the k loads of a chain and what they change by.

    Attributes
    ----------
    force : (3, k) [N]
    by_flow : (3, 3, k) per metre per second of the water past the load
    by_axis : (3, 3, k) per unit that its bar's axis turns by, at right angles to it
    by_height : (3, k) per metre upward, the current it meets there included
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
    """The forces on a chain's loads.

    Parameters
    ----------
    height : (k,) of the loads above the surface [m]
    velocity : (3, k) over the ground [m/s]
    axis : (3, k) of their bars, unit, downward along the line
    strain : (k,) of their bars
    variation : (k,) how many times its constant drag a smooth body has
    slowest : speed below which drag goes with the speed [m/s]
    """
    on = chain.elements
    current, shear, density = sea.at(-height)
    flow = current - velocity
    dense = density / REFERENCE_DENSITY
    grown = dense * (1.0 + 2.0 * on.thinning * (np.sqrt(1.0 + np.maximum(strain, 0.0)) - 1.0))
    lift, stiffness, wet, wetting, push = _afloat(chain, sea, height, density)
    speed = np.sqrt((flow * flow).sum(axis=0) + slowest**2)
    along = on.directional * (flow * axis).sum(axis=0)
    across = flow - along * axis
    size = np.sqrt((across * across).sum(axis=0) + slowest**2)
    kn, kt = grown * variation * on.normal_drag, on.directional * grown * on.tangential_drag
    square, slope, aside, oblique = _friction(chain, kt, along, speed, slowest)
    sized = kn * size
    drag = sized * across + square * axis
    # d(s n)/dn of the normal drag is s + n n/s; n = V - (V.t) t is at right angles to t
    held, skewed = wet * sized, wet * (slope - on.directional * sized)
    turned = wet * square - along * held
    normal = (wet * kn / size * across)[:, np.newaxis] * across
    by_flow = normal + (skewed * axis)[:, np.newaxis] * axis
    by_axis = axis[:, np.newaxis] * (skewed * across - turned * axis) - along * normal
    by_axis[_DIAGONAL] += turned
    if aside is not None:
        by_flow += (wet * aside * axis)[:, np.newaxis] * flow
    if oblique is not None:
        drag += oblique * flow
        by_flow += (wet * oblique / speed**2 * flow)[:, np.newaxis] * flow
        held = held + wet * oblique
    by_flow[_DIAGONAL] += held
    force = wet * drag + push
    force[2] += lift
    if on.lifts:
        raised = dense * on.lift * wet
        force[2] += raised * speed**2
        by_flow[2] += 2.0 * raised * flow
    by_height = wetting * drag - (by_flow * shear).sum(axis=1)
    by_height[2] += stiffness
    return Loads(force, by_flow, by_axis, by_height)


_DIAGONAL = np.arange(3), np.arange(3)


def _friction(
    chain: BarChain, kt: Floats, along: Floats, speed: Floats, slowest: float
) -> tuple[Floats, Floats, Floats | None, Floats | None]:
    """Drag along the axis, its growth with the flow along it and, times the flow, with all of it.

    The last is of Hoerner's law: the drag that goes with the flow, over that flow. None is none.
    """
    law = chain.line.friction
    straight = kt * np.sqrt(along**2 + slowest**2)
    square, slope = straight * along, 2.0 * straight
    cable = chain.elements.flexible
    if law is Friction.CONSTANT:
        # the whole of V², towards where the flow goes along the cable
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
    """Net force, its growth per metre upward, share of the drag and its growth, push of the wind.

    What lifts loses its buoyancy over the skin of the sea as its top comes out; where its mass is
    known it then weighs on the line. A float whose hull is known loses it, and its drag, by its
    draft.
    """
    on, gravity = chain.elements, sea.water.gravity
    net = on.buoyancy + (density - REFERENCE_DENSITY) * gravity * on.volume
    top, push = height + 0.5 * on.height, on.push
    lift, wet, stiffness = net.copy(), np.ones(len(net)), np.zeros(len(net))
    wetting = stiffness.copy()
    if top.max() > 0.0:
        weight = REFERENCE_DENSITY * gravity * on.volume - on.buoyancy
        dry = np.where(on.out & (on.volume > 0.0), weight, np.maximum(weight, 0.0))
        way = np.clip(1.0 - top / sea.skin, 0.0, 1.0)
        share = way**2 * (3.0 - 2.0 * way)
        rise = -6.0 * way * (1.0 - way) / sea.skin
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
"""Of a draft, to find what a hull's buoyancy grows by."""
