"""What a chain carries: weight, buoyancy and drag at places of its bars."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np

from calm.physics.line import Booleans, Floats, Integers, Line
from calm.physics.reynolds import DragCurve
from calm.physics.track import head_count

_DRAFTS = 401
"""Points of the table of a hull afloat."""


class Element(NamedTuple):
    """A load at a place of a bar, as a row of `Elements`."""

    bar: int
    place: float
    piece: int
    buoyancy: float
    volume: float
    normal_drag: float
    tangential_drag: float
    directional: bool
    flexible: bool
    thinning: float
    lift: float
    push_east: float
    push_north: float
    height: float
    out: bool
    curve: DragCurve | None


@dataclass(frozen=True)
class Elements:
    """The k loads of a chain, by growing bar; every bar has one at least.

    Attributes
    ----------
    bar : (k,) the bar it is on
    place : (k,) where on it, from 0 at its upper node to 1 at its lower
    piece : (k,) that it is part of; -1 of a clamp
    buoyancy, volume : (k,) whole, in reference water [N], [m³]
    normal_drag, tangential_drag : (k,) Kn and Kt, whole [N/(m/s)²]
    directional : (k,) False where the drag is Kn|V|V
    flexible : (k,) whether it is cable or chain
    thinning, lift, push_east, push_north : (k,) as in `Line`
    height : (k,) of what is rigid, from its top to its lower end [m]
    out : (k,) whether it stands on the float, and so out of the water where that is at the surface
    curve : (k,) of smooth spheres and cylinders, None of others
    """

    bar: Integers
    place: Floats
    piece: Integers
    buoyancy: Floats
    volume: Floats
    normal_drag: Floats
    tangential_drag: Floats
    directional: Booleans
    flexible: Booleans
    thinning: Floats
    lift: Floats
    push_east: Floats
    push_north: Floats
    height: Floats
    out: Booleans
    curve: tuple[DragCurve | None, ...]

    @staticmethod
    def of(rows: list[Element]) -> Elements:
        """The columns of rows in any order."""
        ordered = sorted(rows, key=lambda row: row[:2])
        *columns, curve = zip(*ordered, strict=True)
        arrays: list[Any] = [*(np.array(column) for column in columns), curve]
        return Elements(*arrays)


def piece_element(line: Line, piece: int, bar: int, place: float, share: float) -> Element:
    """A share of a piece, its middle at a place of a bar."""
    whole = share * (float(line.length[piece]) if line.flexible[piece] else 1.0)
    flexible = bool(line.flexible[piece])
    return Element(
        bar=bar,
        place=place,
        piece=piece,
        buoyancy=whole * float(line.buoyancy[piece]),
        volume=whole * float(line.volume[piece]),
        normal_drag=whole * float(line.normal_drag[piece]),
        tangential_drag=whole * float(line.tangential_drag[piece]),
        directional=bool(line.directional[piece]),
        flexible=flexible,
        thinning=float(line.thinning[piece]),
        lift=0.0 if flexible else float(line.lift[piece]),
        push_east=share * float(line.push_east[piece]),
        push_north=share * float(line.push_north[piece]),
        height=0.0 if flexible else float(line.length[piece]),
        out=piece < head_count(line) - 1,
        curve=line.drag_curve[piece] if line.drag_curve else None,
    )


def clamp_element(line: Line, clamp: int, bar: int, place: float) -> Element:
    """An instrument clamped at a place of a bar."""
    return Element(
        bar=bar,
        place=place,
        piece=-1,
        buoyancy=float(line.clamp_buoyancy[clamp]),
        volume=float(line.clamp_volume[clamp]),
        normal_drag=float(line.clamp_drag[clamp]),
        tangential_drag=0.0,
        directional=False,
        flexible=False,
        thinning=0.0,
        lift=float(line.clamp_lift[clamp]),
        push_east=0.0,
        push_north=0.0,
        height=0.0,
        out=int(line.clamp_piece[clamp]) < head_count(line) - 1,
        curve=line.clamp_drag_curve[clamp] if line.clamp_drag_curve else None,
    )


def first_float(line: Line) -> int:
    """The first rigid piece that lifts; -1 where none does."""
    floats = np.flatnonzero(~line.flexible & (line.buoyancy > 0.0))
    return int(floats[0]) if len(floats) else -1


@dataclass(frozen=True)
class Afloat:
    """The first float at the surface, by its draft as a share of its height, 0 to 1.

    Attributes
    ----------
    element : the load that it is
    height : [m]
    weight : in air [N]
    draft : (m,) growing
    immersed, drag : (m,) shares of the volume, and of the drag below the surface
    push : (m, 2) of the wind to the east and north [N]
    """

    element: int
    height: float
    weight: float
    draft: Floats
    immersed: Floats
    drag: Floats
    push: Floats


def afloat_of(line: Line, elements: Elements) -> Afloat | None:
    """How the first float of a line rides by its draft; None where its hull is not known."""
    floating = line.floating
    if floating is None or floating.hull is None:
        return None
    element = int(np.flatnonzero(elements.piece == first_float(line))[0])
    # by the share immersed, finer where a hull is thin: at its keel and at its top
    share = 0.5 - 0.5 * np.cos(np.linspace(0.0, np.pi, _DRAFTS))
    net = share * (floating.weight + floating.lift) - floating.weight
    ridings = [floating.riding(used) for used in (net / floating.lift).tolist()]
    draft = np.array([floating.hull.curve(one)[0] for one in share.tolist()])
    growing = np.append(True, np.diff(np.maximum.accumulate(draft)) > 0.0)
    return Afloat(
        element=element,
        height=float(elements.height[element]) or floating.hull.height,
        weight=floating.weight,
        draft=draft[growing],
        immersed=share[growing],
        drag=np.array([riding.drag for riding in ridings])[growing],
        push=np.array([riding.push for riding in ridings])[growing],
    )
