"""Model of acoustic ranges: computed ranges, robust fit, and rejection of outliers.

Outliers are rejected by Student's t-test. In a survey without outliers, the probability that the
first test rejects a range is at most 1 %.
"""

from collections.abc import Iterator
from dataclasses import dataclass, replace
from math import sqrt

import numpy as np

from calm.errors import UsageError
from calm.physics.line import Booleans, Floats
from calm.positions import Frame
from calm.ranging.ranges import Sound, Survey

BY_CHANCE = 0.01
"""Error probability of the test for outliers, and of the test for a factor common to all ranges."""
FLOOR = 2.0
"""Minimum scatter of ranges [m], because the ship's antenna is some metres from its transducer, and
both move while the sound travels."""
SPARE = 2
"""Minimum number of redundant ranges after rejection; with fewer, two ranges with equal errors
would outvote a correct third one.
"""
APART = 10.0
"""Minimum distance between distinct positions [m]."""


@dataclass(frozen=True)
class RangeModel:
    """Model of the ranges to a transponder.

    The unknowns of the fit are east, north and, unless the depth is given, up [m].
    """

    survey: Survey
    sound: Sound
    frame: Frame
    ships: Floats
    depth: float | None

    @property
    def unknowns(self) -> int:
        """Number of unknown coordinates of the transponder."""
        return 2 if self.depth is not None else 3

    def place(self, x: Floats) -> Floats:
        """Return the position (3,) for the values `x` of the unknowns [m].

        If the depth of the transponder is given, it is converted to a height in the local frame,
        including the curvature of the sea surface.
        """
        if self.depth is None:
            return x
        # the surface is that much below the plane of the frame
        sagging = self.frame.position(np.array([x[0], x[1], 0.0]))[2]
        return np.array([x[0], x[1], sagging - self.depth])

    def mean_speed(self, x: Floats) -> float:
        """Return the mean speed of sound between the transducer and a position [m/s]."""
        below = self.frame.position(self.place(x))[2]
        return self.sound.mean(self.survey.transducer, max(below, self.survey.transducer))

    def measured(self, x: Floats) -> Floats:
        """Return the measured ranges (n,) [m]; travel times are converted at the mean speed."""
        if not self.survey.timed:
            return self.survey.measured
        ranges: Floats = 0.5 * self.survey.measured * self.mean_speed(x)
        return ranges

    def residuals(self, x: Floats) -> Floats:
        """Return measured minus computed ranges (n,) [m]."""
        computed: Floats = np.linalg.norm(self.ships - self.place(x), axis=1)
        found: Floats = self.measured(x) - computed
        return found

    def jacobian(self, x: Floats) -> Floats:
        """Return the derivatives (n, u) of n residuals with respect to the u unknowns."""
        step = 0.01
        steps = step * np.eye(self.unknowns)
        columns = [self.residuals(x + change) - self.residuals(x - change) for change in steps]
        return np.stack(columns, axis=1) / (2.0 * step)

    def fitted(self) -> tuple[Floats, Booleans]:
        """Fit the position; return the fitted unknowns and a mask of the ranges in use.

        All ranges are used if there are too few to test for outliers.
        """
        count = len(self.ships)
        used = np.ones(count, dtype=bool)
        if count <= self.unknowns + SPARE:
            fits = (self.least_squares(start, used) for start in self._start_positions())
            return min(fits, key=lambda x: float(np.sum(self.residuals(x) ** 2))), used
        x = self._robust_fit()
        residuals = np.abs(self.residuals(x))
        used = residuals <= 5.0 * scatter(residuals, self.unknowns)
        used[np.argsort(residuals)[: self.unknowns + SPARE]] = True
        for _ in range(2 * len(used)):
            x = self.least_squares(x, used)
            changed = self.tested(x, used)
            if (changed == used).all():
                break
            used = changed
        return x, used

    def _robust_fit(self) -> Floats:
        from scipy.optimize import least_squares

        found = []
        for start in self._start_positions():
            x, scale = start, 0.1 * float(np.median(self.measured(start)))
            for _ in range(4):
                fit = least_squares(
                    self.residuals, x, self.jacobian, loss="cauchy", f_scale=scale, x_scale="jac",
                    max_nfev=200,
                )  # fmt: skip
                x = self._below(fit.x)
                scale = 2.0 * scatter(np.abs(self.residuals(x)), self.unknowns)
            found.append((float(np.log1p((self.residuals(x) / FLOOR) ** 2).sum()), x))
        return min(found, key=lambda each: each[0])[1]

    def _start_positions(self) -> list[Floats]:
        """Return five starting values of the unknowns for the fit.

        One position is below the middle of the survey. The others are displaced from it, in both
        directions along and across the survey.
        """
        middle = self.ships.mean(axis=0)
        _, _, axes = np.linalg.svd((self.ships - middle)[:, :2], full_matrices=True)
        reach = float(np.median(self.measured(np.array([0.0, 0.0, -1000.0])[: self.unknowns])))
        starts = []
        for side in (np.zeros(2), axes[1], -axes[1], axes[0], -axes[0]):
            start = np.array([*(middle[:2] + 0.7 * reach * side), -0.7 * reach])
            starts.append(start[: self.unknowns])
        return starts

    def _below(self, x: Floats) -> Floats:
        """Return the unknowns of a position below the ship.

        A position above the ship is reflected about the depth of the transducer.
        """
        if self.depth is None:
            level = float(self.ships[:, 2].mean())
            x = np.array([x[0], x[1], min(x[2], 2.0 * level - x[2])])
        return x

    def least_squares(self, x: Floats, used: Booleans) -> Floats:
        """Fit the unknowns to the ranges in use by least squares, from a starting value."""
        from scipy.optimize import least_squares

        fit = least_squares(
            lambda x: self.residuals(x)[used], x, lambda x: self.jacobian(x)[used], x_scale="jac",
            xtol=1e-12, ftol=1e-14, gtol=1e-14, max_nfev=200,
        )  # fmt: skip
        return self._below(fit.x)

    def tested(self, x: Floats, used: Booleans) -> Booleans:
        """Reject the worst outlier, or restore a rejected range that fits.

        Return the new mask of the ranges in use.

        Each residual is compared with its standard error, estimated from the other ranges in use.
        """
        from scipy.stats import t as student

        residuals, jacobian = self.residuals(x), self.jacobian(x)
        freedom = int(used.sum()) - self.unknowns
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

    def consistency(self, x: Floats, used: Booleans) -> list[str]:
        """Return a warning if multiplying all ranges by a factor clearly improves the fit.

        Raises
        ------
        UsageError
            The factor is about 2 or 0.5, as if one-way and two-way values were confused.
        """
        from scipy.optimize import least_squares
        from scipy.stats import t as student

        unknowns, count = self.unknowns, len(used)
        if count < unknowns + 3:
            return []

        def residuals(y: Floats) -> Floats:
            place = y[:-1]
            found: Floats = self.residuals(place) + (y[-1] - 1.0) * self.measured(place)
            return found

        own = self.residuals(x)
        scale = 2.0 * scatter(np.abs(own), unknowns)
        for factor in (2.0, 0.5):
            start = np.append(x if unknowns == 2 else x * [1.0, 1.0, factor], factor)
            fit = least_squares(residuals, start, loss="cauchy", f_scale=scale, x_scale="jac")
            again = residuals(fit.x)
            much_better = np.median(np.abs(again)) < 0.1 * np.median(np.abs(own))
            if much_better and abs(fit.x[-1] / factor - 1.0) < 0.05:
                raise UsageError(
                    f"{self.survey.path}: {_doubling_error(self.survey.timed, factor)}"
                )
        if used.sum() < unknowns + 3:
            return []
        fit = least_squares(lambda y: residuals(y)[used], np.append(x, 1.0), x_scale="jac")
        freedom = int(used.sum()) - unknowns - 1
        square = float(fit.fun @ fit.fun) / freedom
        deviation = sqrt(square * float(np.linalg.pinv(fit.jac.T @ fit.jac)[-1, -1]))
        away = float(fit.x[-1]) - 1.0
        if abs(away) <= max(student.ppf(1.0 - 0.5 * BY_CHANCE, freedom) * deviation, 1e-3):
            return []
        text = f"The fit improves if all ranges are made {abs(100.0 * away):.1f} % "
        text += "longer" if away > 0.0 else "shorter"
        if self.survey.timed:
            text += f": is the speed of sound {(1.0 + away) * self.mean_speed(x):.0f} m/s?"
            return [text]
        return [f"{text}: were they taken with another speed of sound?"]

    def another_place(self, x: Floats, used: Booleans, scatter: float) -> Floats | None:
        """Find another position that fits the ranges nearly as well as the fitted position `x`.

        Return None if there is no such position.

        Parameters
        ----------
        x : fitted position, as values of the unknowns
        used : mask of the ranges in use
        scatter : root mean square residual up to which any position counts as a fit [m]
        """
        starts = [mirrored(self.ships[used], self.place(x))[: len(x)], *self._start_positions()]
        fits = [self.least_squares(start, used) for start in starts]
        if self.depth is None:  # another place also counts if it fits at the depth of this one
            same = replace(self, depth=self.frame.position(x)[2])
            fits += [np.append(same.least_squares(start[:2], used), x[2]) for start in starts]

        def square_sum(x: Floats) -> float:
            return float(np.sum(self.residuals(x)[used] ** 2))

        freedom = max(int(used.sum()) - self.unknowns, 1)
        most = max(4.0 * max(square_sum(x), float(used.sum()) * FLOOR**2), freedom * scatter**2)
        apart = [fit for fit in fits if np.linalg.norm((fit - x)[:2]) > APART]
        best = min(apart, key=square_sum, default=None)
        return None if best is None or square_sum(best) > most else best


def scatter(residuals: Floats, unknowns: int) -> float:
    """Estimate a standard deviation [m] from the median of absolute residuals (n,) [m].

    The result is at least `FLOOR`.
    """
    count = len(residuals)
    freedom = max(count - unknowns, 1)
    return max(1.4826 * float(np.median(residuals)) * sqrt(count / freedom), FLOOR)


def _doubling_error(timed: bool, factor: float) -> str:
    instead = "give the distance from the ship to the transponder"
    meant = {
        (True, 2.0): "one-way times, but two-way times (there and back) are needed",
        (True, 0.5): "twice the two-way times",
        (False, 2.0): f"half the distances; {instead}",
        (False, 0.5): f"distances there and back; {instead}",
    }
    return f"the {'times' if timed else 'ranges'} appear to be {meant[timed, factor]}"


NARROW = 0.15
"""Ratio of width to length below which a track counts as a straight line."""
WIDEST_GAP = 180.0
"""Angle of a sector without ranges, seen from the transponder [degrees].

If the sector is wider than this, all ranges count as taken from one side.
"""
NEAR, FAR = 0.2, 4.0
"""Horizontal distances, as multiples of the depth. Ranges that are all nearer constrain the
position poorly; ranges that are all farther constrain the depth poorly.
"""


def geometry_warnings(
    ships: Floats, place: Floats, below: float, depth_given: bool
) -> Iterator[str]:
    """Yield a warning for each weakness of the survey geometry.

    Parameters
    ----------
    ships : (n, 3) positions of the transducer [m]
    place : (3,) position of the transponder [m]
    below : depth of the transponder below the transducer [m]
    depth_given : whether the depth was not estimated
    """
    away = (ships - place)[:, :2]
    distance = np.linalg.norm(away, axis=1)
    below = max(below, 1e-3)
    if distance.max() < NEAR * below:
        yield (
            "All ranges were taken from nearly overhead, so the position is poorly constrained. "
            "Add ranges at a horizontal distance of about one water depth."
        )
    if is_line(ships):
        yield (
            "All ranges were taken along one straight line, so the mirror position fits equally "
            f"well{'' if depth_given else ', as do nearer but deeper positions'}. Add ranges off "
            "that line."
        )
    elif (gap := widest_gap(away)) > WIDEST_GAP and distance.min() > 0.0:
        yield (
            f"All ranges were taken from one side: a sector of {gap:.0f} degrees has none. Add "
            "ranges from the opposite side."
        )
    if not depth_given and distance.min() > FAR * below:
        yield (
            "All ranges were taken from far away, so the depth is poorly constrained. Add closer "
            "ranges, or give the depth."
        )


def is_line(ships: Floats) -> bool:
    """True if the positions (n, 3) lie nearly on a straight line, or at a single point."""
    _, spread, _ = np.linalg.svd((ships - ships.mean(axis=0))[:, :2], full_matrices=False)
    return len(spread) < 2 or bool(spread[1] <= NARROW * spread[0])


def widest_gap(away: Floats) -> float:
    """Return the largest angle between neighbouring directions [degrees].

    Parameters
    ----------
    away : (n, 2) horizontal directions
    """
    bearing = np.sort(np.degrees(np.arctan2(away[:, 0], away[:, 1])))
    return float(np.diff(np.append(bearing, bearing[0] + 360.0)).max())


def mirrored(ships: Floats, place: Floats) -> Floats:
    """Reflect a position (3,) across the line that best fits the positions (n, 3) of the ship."""
    middle = ships.mean(axis=0)
    _, _, axes = np.linalg.svd((ships - middle)[:, :2], full_matrices=True)
    other = place.copy()
    other[:2] -= 2.0 * ((place - middle)[:2] @ axes[1]) * axes[1]
    return other
