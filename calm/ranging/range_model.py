"""Ranges as they should be from a place, the place that most agree on, and those that do not.

Where ranges can be spared, a fit that outliers hardly move comes first; then each doubtful range is
judged by the others (Student's test, all of them together at 1 %). Where none can, all count.

A survey may not agree with itself, or not tell one place from another: it is said.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from math import sqrt

import numpy as np

from calm.errors import UsageError
from calm.physics.line import Booleans, Floats
from calm.positions import Frame
from calm.ranging.ranges import Sound, Survey


@dataclass(frozen=True)
class RangeModel:
    """Ranges from a place: the unknowns are east, north and, where it is not given, the depth."""

    survey: Survey
    sound: Sound
    frame: Frame
    ships: Floats
    depth: float | None

    @property
    def unknowns(self) -> int:
        return 2 if self.depth is not None else 3

    def place(self, x: Floats) -> Floats:
        """Return (3,) of the unknowns; a given depth is one below the curved surface."""
        if self.depth is None:
            return x
        # the surface is that much below the plane of the frame
        sagging = self.frame.position(np.array([x[0], x[1], 0.0]))[2]
        return np.array([x[0], x[1], sagging - self.depth])

    def mean_speed(self, x: Floats) -> float:
        below = self.frame.position(self.place(x))[2]
        return self.sound.mean(self.survey.transducer, max(below, self.survey.transducer))

    def measured(self, x: Floats) -> Floats:
        """Return (n,) ranges [m], of times by the speed of sound on the way to the place."""
        if not self.survey.timed:
            return self.survey.measured
        ranges: Floats = 0.5 * self.survey.measured * self.mean_speed(x)
        return ranges

    def residuals(self, x: Floats) -> Floats:
        computed: Floats = np.linalg.norm(self.ships - self.place(x), axis=1)
        found: Floats = self.measured(x) - computed
        return found

    def jacobian(self, x: Floats) -> Floats:
        """Return (n, unknowns) of the residuals."""
        step = 0.01
        columns = []
        for i in range(self.unknowns):
            ahead, behind = x.copy(), x.copy()
            ahead[i] += step
            behind[i] -= step
            columns.append((self.residuals(ahead) - self.residuals(behind)) / (2.0 * step))
        return np.stack(columns, axis=1)


BY_CHANCE = 0.01
"""Of a survey without an outlier: how often one is called so."""
FLOOR = 2.0
"""Scatter that no range is better than [m]: the ship's antenna is some metres from its transducer,
and both move while the sound travels."""
SPARE = 2
"""Ranges beyond the unknowns that are left when others are rejected: with fewer, any two that are
wrong alike outvote a third that is right."""


def fitted(model: RangeModel) -> tuple[Floats, Booleans]:
    """Return the unknowns, and which ranges belong."""
    count = len(model.ships)
    used = np.ones(count, dtype=bool)
    if count <= model.unknowns + SPARE:
        fits = (least_squares_of(model, start, used) for start in starts_of(model))
        return min(fits, key=lambda x: float(np.sum(model.residuals(x) ** 2))), used
    x = _sturdy(model)
    residuals = np.abs(model.residuals(x))
    used = residuals <= 5.0 * scatter(residuals, model.unknowns)
    used[np.argsort(residuals)[: model.unknowns + SPARE]] = True
    for _ in range(2 * len(used)):
        x = least_squares_of(model, x, used)
        changed = _judged(model, x, used)
        if (changed == used).all():
            break
        used = changed
    return x, used


def _sturdy(model: RangeModel) -> Floats:
    """Return the unknowns by a fit that outliers hardly move, from several sides."""
    from scipy.optimize import least_squares

    found = []
    for start in starts_of(model):
        x, scale = start, 0.1 * float(np.median(model.measured(start)))
        for _ in range(4):
            fit = least_squares(
                model.residuals, x, model.jacobian, loss="cauchy", f_scale=scale, x_scale="jac",
                max_nfev=200,
            )  # fmt: skip
            x = _below(model, fit.x)
            scale = 2.0 * scatter(np.abs(model.residuals(x)), model.unknowns)
        found.append((float(np.log1p((model.residuals(x) / FLOOR) ** 2).sum()), x))
    return min(found, key=lambda each: each[0])[1]


def starts_of(model: RangeModel) -> list[Floats]:
    """Return the unknowns of places in the middle of the survey, and on its four sides."""
    middle = model.ships.mean(axis=0)
    _, _, axes = np.linalg.svd((model.ships - middle)[:, :2], full_matrices=True)
    reach = float(np.median(model.measured(np.array([0.0, 0.0, -1000.0])[: model.unknowns])))
    starts = []
    for side in (np.zeros(2), axes[1], -axes[1], axes[0], -axes[0]):
        start = np.array([*(middle[:2] + 0.7 * reach * side), -0.7 * reach])
        starts.append(start[: model.unknowns])
    return starts


def _below(model: RangeModel, x: Floats) -> Floats:
    """Return the same place below the ship, where a fit has found its mirror image above."""
    if model.depth is None:
        level = float(model.ships[:, 2].mean())
        x = np.array([x[0], x[1], min(x[2], 2.0 * level - x[2])])
    return x


def scatter(residuals: Floats, unknowns: int) -> float:
    """Return the standard deviation of most of the residuals, by their median [m]."""
    count = len(residuals)
    freedom = max(count - unknowns, 1)
    return max(1.4826 * float(np.median(residuals)) * sqrt(count / freedom), FLOOR)


def least_squares_of(model: RangeModel, x: Floats, used: Booleans) -> Floats:
    """Return the unknowns that fit the ranges in use best, from a guess.

    Parameters
    ----------
    model : of the ranges
    x : a guess of the unknowns
    used : (n,) which ranges count
    """
    from scipy.optimize import least_squares

    fit = least_squares(
        lambda x: model.residuals(x)[used], x, lambda x: model.jacobian(x)[used], x_scale="jac",
        xtol=1e-12, ftol=1e-14, gtol=1e-14, max_nfev=200,
    )  # fmt: skip
    return _below(model, fit.x)


def _judged(model: RangeModel, x: Floats, used: Booleans) -> Booleans:
    """Return the ranges that belong: the worst of them out, or what fits the others in.

    A range is judged by its residual over its standard error as the others give it.
    """
    from scipy.stats import t as student

    residuals, jacobian = model.residuals(x), model.jacobian(x)
    freedom = int(used.sum()) - model.unknowns
    if freedom < SPARE:
        return used
    inverse = np.linalg.pinv(jacobian[used].T @ jacobian[used])
    leverage = np.einsum("ij,jk,ik->i", jacobian, inverse, jacobian)
    square = float(residuals[used] @ residuals[used])
    kept = np.maximum(1.0 - leverage, 1e-9)
    without = np.where(used, square - residuals**2 / kept, square)
    free = np.where(used, freedom - 1, freedom)
    variance = np.maximum(without / free, FLOOR**2)
    spread = np.sqrt(variance * np.where(used, kept, 1.0 + leverage))
    ratio = np.abs(residuals) / spread
    limit = student.ppf(1.0 - 0.5 * BY_CHANCE / len(used), free)
    changed = used.copy()
    back = ~used & (ratio < limit)
    if back.any():
        changed[np.argmin(np.where(back, ratio, np.inf))] = True
        return changed
    worst = int(np.argmax(np.where(used, ratio, 0.0)))
    if ratio[worst] > limit[worst] and freedom > SPARE:
        changed[worst] = False
    return changed


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
            else ("half the distances: give the distance from the ship to the transponder")
        )
        return f"the {what} fit far better as {one_way}"
    two_way = (
        "twice the two-way times"
        if timed
        else ("distances there and back: give the distance from the ship to the transponder")
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
