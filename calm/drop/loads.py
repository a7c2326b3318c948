"""Forces on the loads of a chain that moves, and how they change with its motion."""

from __future__ import annotations

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
        """Columns u, v, w, density of every level, and their growth per metre below it."""
        water = self.water
        values = np.stack([water.u, water.v, water.w, water.density], axis=1)
        slopes = np.zeros((len(values) + 1, 4))
        slopes[1:-1] = np.diff(values, axis=0) / np.diff(water.level)[:, np.newaxis]
        return values, slopes

    def at(self, depth: Floats) -> tuple[Floats, Floats, Floats]:
        """Current (k, 3), its growth per metre of depth (k, 3), and density (k,)."""
        values, slopes = self._rows
        interval = np.searchsorted(self.water.level, depth, side="right")
        origin = np.maximum(interval - 1, 0)
        slope = slopes[interval]
        found = values[origin] + slope * (depth - self.water.level[origin])[:, np.newaxis]
        return found[:, :3], slope[:, :3], found[:, 3]


@dataclass(frozen=True)
class Loads:
    """Forces on the k loads of a chain (k, 3) [N] and what they change by.

    Attributes
    ----------
    force : (k, 3) [N]
    by_flow : (k, 3, 3) per metre per second of the water past the load
    by_axis : (k, 3, 3) per unit of its bar's axis
    by_height : (k, 3) per metre upward, the current it meets there included
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
    velocity : (k, 3) over the ground [m/s]
    axis : (k, 3) of their bars, unit, downward along the line
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
    speed = np.sqrt(np.einsum("ij,ij->i", flow, flow) + slowest**2)
    along = on.directional * np.einsum("ij,ij->i", flow, axis)
    across = flow - along[:, np.newaxis] * axis
    size = np.sqrt(np.einsum("ij,ij->i", across, across) + slowest**2)
    kn, kt = grown * variation * on.normal_drag, on.directional * grown * on.tangential_drag
    square, slope, aside, oblique = _friction(chain, kt, along, speed, slowest)
    sized = kn * size
    drag = sized[:, np.newaxis] * across + square[:, np.newaxis] * axis
    # d(s n)/dn of the normal drag is s + n n/s; n = V - (V.t) t is at right angles to t
    held, skewed = wet * sized, (wet * (slope - on.directional * sized))[:, np.newaxis]
    normal = _outer((wet * kn / size)[:, np.newaxis] * across, across)
    by_flow = normal + _outer(skewed * axis, axis)
    by_axis = _outer(skewed * axis, flow) - along[:, np.newaxis, np.newaxis] * normal
    np.einsum("kii->ki", by_axis)[:] += (wet * square - along * held)[:, np.newaxis]
    if aside is not None:
        by_flow += _outer((wet * aside)[:, np.newaxis] * axis, flow)
    if oblique is not None:
        drag += oblique[:, np.newaxis] * flow
        by_flow += _outer((wet * oblique / speed**2)[:, np.newaxis] * flow, flow)
        held = held + wet * oblique
    np.einsum("kii->ki", by_flow)[:] += held[:, np.newaxis]
    force = wet[:, np.newaxis] * drag + push
    force[:, 2] += lift
    if on.lifts:
        raised = dense * on.lift * wet
        force[:, 2] += raised * speed**2
        by_flow[:, 2] += 2.0 * raised[:, np.newaxis] * flow
    by_height = wetting[:, np.newaxis] * drag - np.einsum("ijk,ik->ij", by_flow, shear)
    by_height[:, 2] += stiffness
    return Loads(force, by_flow, by_axis, by_height)


def _outer(a: Floats, b: Floats) -> Floats:
    """(k, 3, 3) of the products of two vectors, (k, 3) each."""
    product: Floats = a[:, :, np.newaxis] * b[:, np.newaxis]
    return product


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
        lift[i], stiffness[i] = (
            whole * immersed[1] - hull.weight,
            growth * whole * (immersed[2] - immersed[0]),
        )
        wet[i], wetting[i] = drag[1], growth * (drag[2] - drag[0])
        push = push.copy()
        push[i, :2] += [np.interp(draft, hull.draft, hull.push[:, k]) for k in (0, 1)]
    return lift, stiffness, wet, wetting, push


_STEP = 1e-3
"""Of a draft, to find what a hull's buoyancy grows by."""
