"""Whether a ship took its ranges from where they tell a place."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from calm.physics.line import Floats

NARROW = 0.15
"""Width over length of a track that is as good as a straight line."""
WIDEST_GAP = 180.0
"""Directions from the place without a range, from which on all are on one side [degrees]."""
NEAR, FAR = 0.2, 4.0
"""Horizontal distances over the depth: all nearer tell little of the place, all farther of the
depth."""


def geometry_warnings(
    ships: Floats, place: Floats, below: float, depth_given: bool
) -> Iterator[str]:
    """What of a survey leaves the place poorly known.

    Parameters
    ----------
    ships : (n, 3) places of the transducer [m]
    place : (3,) of what answers [m]
    below : its depth below the transducer [m]
    """
    away = (ships - place)[:, :2]
    distance = np.linalg.norm(away, axis=1)
    below = max(below, 1e-3)
    if distance.max() < NEAR * below:
        yield (
            "The ranges are all taken from nearly above: the place is poorly known. Take some from "
            "as far to the side as the water is deep."
        )
    if is_line(ships):
        yield (
            "The ranges are all taken along one line: a place as far on its other side fits as "
            f"well{'' if depth_given else ', and so do nearer ones that are deeper'}. Take some "
            "off that line."
        )
    elif (gap := widest_gap(away)) > WIDEST_GAP and distance.min() > 0.0:
        yield (
            f"The ranges are all taken from one side: none within {gap:.0f} degrees of directions. "
            "Take some from the other side."
        )
    if not depth_given and distance.min() > FAR * below:
        yield (
            "The ranges are all taken from afar: the depth is poorly known. Take some from nearer, "
            "or give the depth."
        )


def is_line(ships: Floats) -> bool:
    """Whether places are as good as on one line, or one place."""
    _, spread, _ = np.linalg.svd((ships - ships.mean(axis=0))[:, :2], full_matrices=False)
    return len(spread) < 2 or bool(spread[1] <= NARROW * spread[0])


def widest_gap(away: Floats) -> float:
    """The widest angle between neighbouring directions (n, 2) [degrees]."""
    bearing = np.sort(np.degrees(np.arctan2(away[:, 0], away[:, 1])))
    return float(np.diff(np.append(bearing, bearing[0] + 360.0)).max())


def mirrored(ships: Floats, place: Floats) -> Floats:
    """A place (3,) on the other side of the line that the ships (n, 3) are nearest to."""
    middle = ships.mean(axis=0)
    _, _, axes = np.linalg.svd((ships - middle)[:, :2], full_matrices=True)
    other = place.copy()
    other[:2] -= 2.0 * ((place - middle)[:2] @ axes[1]) * axes[1]
    return other
