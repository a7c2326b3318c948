"""What of a survey does not agree with itself, or does not tell one place from another."""

from __future__ import annotations

from collections.abc import Iterator
from math import sqrt

import numpy as np

from calm.errors import UsageError
from calm.locate.range_model import (
    BY_CHANCE,
    FLOOR,
    RangeModel,
    least_squares_of,
    scatter,
    starts_of,
)
from calm.physics.line import Booleans, Floats


def consistency(model: RangeModel, x: Floats, used: Booleans) -> list[str]:
    """Return whether the ranges fit better when all are longer or shorter by a factor.

    Parameters
    ----------
    model : of the ranges
    x : the unknowns found
    used : (n,) which ranges count

    Raises
    ------
    UsageError
        By a factor of two: one-way for two-way times, or the other way round.
    """
    from scipy.optimize import least_squares
    from scipy.stats import t as student

    unknowns, count = model.unknowns, len(used)
    if count < unknowns + 3:
        return []

    def residuals(y: Floats) -> Floats:
        place = y[:-1]
        found: Floats = model.residuals(place) + (y[-1] - 1.0) * model.measured(place)
        return found

    own = model.residuals(x)
    scale = 2.0 * scatter(np.abs(own), unknowns)
    for factor in (2.0, 0.5):
        start = np.append(x if unknowns == 2 else x * [1.0, 1.0, factor], factor)
        fit = least_squares(residuals, start, loss="cauchy", f_scale=scale, x_scale="jac")
        again = residuals(fit.x)
        much_better = np.median(np.abs(again)) < 0.1 * np.median(np.abs(own))
        if much_better and abs(fit.x[-1] / factor - 1.0) < 0.05:
            raise UsageError(f"{model.survey.path}: {_doubled(model.survey.timed, factor)}")
    if used.sum() < unknowns + 3:
        return []
    fit = least_squares(lambda y: residuals(y)[used], np.append(x, 1.0), x_scale="jac")
    freedom = int(used.sum()) - unknowns - 1
    square = float(fit.fun @ fit.fun) / freedom
    deviation = sqrt(square * float(np.linalg.pinv(fit.jac.T @ fit.jac)[-1, -1]))
    away = float(fit.x[-1]) - 1.0
    if abs(away) <= student.ppf(1.0 - 0.5 * BY_CHANCE, freedom) * deviation:
        return []
    if abs(away) < 1e-3:
        return []
    said = f"The ranges fit better when all are {abs(100.0 * away):.1f} % "
    said += "longer" if away > 0.0 else "shorter"
    if model.survey.timed:
        said += f": is the speed of sound {(1.0 + away) * model.mean_speed(x):.0f} m/s?"
        return [said]
    return [f"{said}: were they taken with another speed of sound?"]


def _doubled(timed: bool, factor: float) -> str:
    what = "times" if timed else "ranges"
    if factor > 1.0:
        one_way = (
            "one-way times: two-way times are needed, there and back"
            if timed
            else ("half the distances: give the distance from the ship to what answers")
        )
        return f"the {what} fit far better as {one_way}"
    two_way = (
        "twice the two-way times"
        if timed
        else ("distances there and back: give the distance from the ship to what answers")
    )
    return f"the {what} fit far better as {two_way}"


def another_place(model: RangeModel, x: Floats, used: Booleans) -> Floats | None:
    """Return the unknowns of another place that fits nearly as well; None where there is none.

    Parameters
    ----------
    model : of the ranges
    x : the unknowns found
    used : (n,) which ranges count
    """
    starts = [mirrored(model.ships[used], model.place(x))[: len(x)], *starts_of(model)]
    fits = [least_squares_of(model, start, used) for start in starts]
    least = float(used.sum()) * FLOOR**2
    most = 4.0 * max(_squares(model, x, used), least)
    others = [
        fit
        for fit in fits
        if np.linalg.norm((fit - x)[:2]) > APART and _squares(model, fit, used) <= most
    ]
    return min(others, key=lambda fit: _squares(model, fit, used), default=None)


def _squares(model: RangeModel, x: Floats, used: Booleans) -> float:
    """Return the sum of the squares of the residuals of the ranges in use [m²]."""
    return float(np.sum(model.residuals(x)[used] ** 2))


APART = 10.0
"""Distance from which two places are two [m]."""
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
    """Return what of a survey leaves the place poorly known.

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
    """Return whether places are as good as on one line, or one place."""
    _, spread, _ = np.linalg.svd((ships - ships.mean(axis=0))[:, :2], full_matrices=False)
    return len(spread) < 2 or bool(spread[1] <= NARROW * spread[0])


def widest_gap(away: Floats) -> float:
    """Return the widest angle between neighbouring directions (n, 2) [degrees]."""
    bearing = np.sort(np.degrees(np.arctan2(away[:, 0], away[:, 1])))
    return float(np.diff(np.append(bearing, bearing[0] + 360.0)).max())


def mirrored(ships: Floats, place: Floats) -> Floats:
    """Return a place (3,) on the other side of the line that the ships (n, 3) are nearest to."""
    middle = ships.mean(axis=0)
    _, _, axes = np.linalg.svd((ships - middle)[:, :2], full_matrices=True)
    other = place.copy()
    other[:2] -= 2.0 * ((place - middle)[:2] @ axes[1]) * axes[1]
    return other
