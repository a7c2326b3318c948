"""The place that fits ranges best, how well it is known, and which ranges do not belong.

Ranges are straight lines from the ship's transducer. Of those that fit, residuals are taken as
normal and alike; what does not belong is found by a fit that outliers hardly move, and then each
doubtful range is judged by the others (Student's test, all of them together at 1 %).
"""

from __future__ import annotations

from dataclasses import dataclass
from math import atan2, degrees, nan, sqrt
from typing import Any

import numpy as np

from calm.errors import UsageError
from calm.locate.ellipsoid import Frame
from calm.locate.geometry import geometry_warnings, mirrored
from calm.locate.ranges import Survey
from calm.locate.sound import Sound
from calm.physics.line import Booleans, Floats

CONFIDENCE = 0.95
BY_CHANCE = 0.01
"""Of a survey without an outlier: how often one is called so."""
_FLOOR = 0.02
"""Scatter that no range is better than, to tell what does not belong [m]."""


@dataclass(frozen=True)
class Located:
    """Where what answers stands.

    Attributes
    ----------
    survey : the ranges
    latitude, longitude : WGS 84 [degrees]
    depth : below the surface [m]
    horizontal_95 : greater half-axis of the ellipse that holds the place with 95 % [m]; nan where
        there are no more ranges than unknowns
    ellipse : both half-axes [m] and the bearing of the greater [degrees]
    depth_95 : half of the interval of 95 % of the depth [m]; 0 where the depth was given
    rms : of the residuals of the ranges in use, by the degrees of freedom [m]
    residuals : (n,) measured less computed range [m]
    used : (n,) False of what does not belong
    sound_speed : harmonic mean on the way [m/s]
    warnings : about geometry and consistency
    place : (3,) east, north, up in the frame of the survey [m]
    depth_given : whether the depth was given
    """

    survey: Survey
    latitude: float
    longitude: float
    depth: float
    horizontal_95: float
    ellipse: tuple[float, float, float]
    depth_95: float
    rms: float
    residuals: Floats
    used: Booleans
    sound_speed: float
    warnings: tuple[str, ...]
    place: Floats
    depth_given: bool

    def to_dict(self) -> dict[str, Any]:
        """The JSON object; None stands where a figure is unknown."""
        lines = self.survey.line
        major, minor, bearing = map(_known, self.ellipse)
        return {
            "latitude": self.latitude,
            "longitude": self.longitude,
            "depth": self.depth,
            "horizontal_95": _known(self.horizontal_95),
            "depth_95": _known(self.depth_95),
            "residuals": self.residuals.tolist(),
            "rms": _known(self.rms),
            "ellipse_95": {"major": major, "minor": minor, "bearing": bearing},
            "sound_speed": self.sound_speed if self.survey.timed else None,
            "lines": list(lines),
            "outliers": [
                {"line": line, "residual": residual}
                for line, residual, used in zip(
                    lines, self.residuals.tolist(), self.used, strict=True
                )
                if not used
            ],
            "warnings": list(self.warnings),
        }


def _known(value: float) -> float | None:
    return value if np.isfinite(value) else None


@dataclass(frozen=True)
class _Model:
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
        """(3,) of the unknowns; a given depth is one below the curved surface."""
        if self.depth is None:
            return x
        # the surface is that much below the plane of the frame
        sagging = self.frame.position(np.array([x[0], x[1], 0.0]))[2]
        return np.array([x[0], x[1], sagging - self.depth])

    def mean_speed(self, x: Floats) -> float:
        below = self.frame.position(self.place(x))[2]
        return self.sound.mean(self.survey.transducer, max(below, self.survey.transducer))

    def measured(self, x: Floats) -> Floats:
        """(n,) ranges [m], of times by the speed of sound on the way to the place."""
        if not self.survey.timed:
            return self.survey.measured
        ranges: Floats = 0.5 * self.survey.measured * self.mean_speed(x)
        return ranges

    def residuals(self, x: Floats) -> Floats:
        computed: Floats = np.linalg.norm(self.ships - self.place(x), axis=1)
        found: Floats = self.measured(x) - computed
        return found

    def jacobian(self, x: Floats) -> Floats:
        """(n, unknowns) of the residuals."""
        step = 0.01
        columns = []
        for i in range(self.unknowns):
            ahead, behind = x.copy(), x.copy()
            ahead[i] += step
            behind[i] -= step
            columns.append((self.residuals(ahead) - self.residuals(behind)) / (2.0 * step))
        return np.stack(columns, axis=1)


def locate(survey: Survey, sound: Sound, depth: float | None = None) -> Located:
    """Find where what answers stands.

    Parameters
    ----------
    sound : its speed, for times
    depth : of what answers [m], where it is known; else it is found too

    Raises
    ------
    UsageError
        Fewer ranges than unknowns, a depth that no range reaches, or ranges that meet nowhere.
    """
    unknowns = 2 if depth is not None else 3
    count = len(survey.line)
    if count < unknowns:
        raise UsageError(
            f"{survey.path}: {count} range{'s' * (count != 1)}; "
            f"{unknowns} are needed to find {'a place' if depth is not None else 'place and depth'}"
            f"{', or 2 with --depth' if count == 2 and depth is None else ''}"
        )
    frame = Frame(float(survey.latitude.mean()), survey.middle_longitude)
    ships = frame.place(survey.latitude, survey.longitude, np.full(count, survey.transducer))
    model = _Model(survey, sound, frame, ships, depth)
    x, used = _fitted(model)
    residuals = model.residuals(x)
    jacobian = model.jacobian(x)[used]
    freedom = int(used.sum()) - unknowns
    rms = sqrt(float(residuals[used] @ residuals[used]) / freedom) if freedom else nan
    major, minor, bearing, depth_95 = _intervals(jacobian, rms, freedom, depth is not None)
    place = model.place(x)
    latitude, longitude, found = frame.position(place)
    warnings = [
        *_consistency(model, x, used),
        *geometry_warnings(ships[used], place, found - survey.transducer, depth is not None),
        *_mirrored(model, x, used),
    ]
    if not freedom:
        warnings.append(
            "There are no more ranges than unknowns: nothing tells how well they fit, and no "
            "interval can be given."
        )
    return Located(
        survey=survey,
        latitude=latitude,
        longitude=longitude,
        depth=found,
        horizontal_95=major,
        ellipse=(major, minor, bearing),
        depth_95=depth_95,
        rms=rms,
        residuals=residuals,
        used=used,
        sound_speed=model.mean_speed(x),
        warnings=tuple(warnings),
        place=place,
        depth_given=depth is not None,
    )


def _fitted(model: _Model) -> tuple[Floats, Booleans]:
    """The unknowns, and which ranges belong."""
    x = _sturdy(model)
    residuals = np.abs(model.residuals(x))
    used = residuals <= 5.0 * _scatter(residuals, model.unknowns)
    if used.sum() < model.unknowns:
        used[np.argsort(residuals)[: model.unknowns]] = True
    for _ in range(2 * len(used)):
        x = _least_squares(model, x, used)
        changed = _judged(model, x, used)
        if (changed == used).all():
            break
        used = changed
    return x, used


def _sturdy(model: _Model) -> Floats:
    """The unknowns by a fit that outliers hardly move, from several sides."""
    from scipy.optimize import least_squares

    found = []
    for start in _starts(model):
        x, scale = start, 0.1 * float(np.median(model.measured(start)))
        for _ in range(4):
            fit = least_squares(
                model.residuals, x, model.jacobian, loss="cauchy", f_scale=scale, x_scale="jac",
                max_nfev=200,
            )  # fmt: skip
            x = _below(model, fit.x)
            scale = 2.0 * _scatter(np.abs(model.residuals(x)), model.unknowns)
        found.append((float(np.log1p((model.residuals(x) / _FLOOR) ** 2).sum()), x))
    return min(found, key=lambda each: each[0])[1]


def _starts(model: _Model) -> list[Floats]:
    middle = model.ships.mean(axis=0)
    _, _, axes = np.linalg.svd((model.ships - middle)[:, :2], full_matrices=True)
    reach = float(np.median(model.measured(np.array([0.0, 0.0, -1000.0])[: model.unknowns])))
    starts = []
    for side in (np.zeros(2), axes[1], -axes[1], axes[0], -axes[0]):
        start = np.array([*(middle[:2] + 0.7 * reach * side), -0.7 * reach])
        starts.append(start[: model.unknowns])
    return starts


def _below(model: _Model, x: Floats) -> Floats:
    """The same place below the ship, where a fit has found its mirror image above."""
    if model.depth is None:
        level = float(model.ships[:, 2].mean())
        x = np.array([x[0], x[1], min(x[2], 2.0 * level - x[2])])
    return x


def _scatter(residuals: Floats, unknowns: int) -> float:
    """Standard deviation of most of the residuals, by their median [m]."""
    count = len(residuals)
    freedom = max(count - unknowns, 1)
    return max(1.4826 * float(np.median(residuals)) * sqrt(count / freedom), _FLOOR)


def _least_squares(model: _Model, x: Floats, used: Booleans) -> Floats:
    from scipy.optimize import least_squares

    fit = least_squares(
        lambda x: model.residuals(x)[used], x, lambda x: model.jacobian(x)[used], x_scale="jac",
        xtol=1e-12, ftol=1e-14, gtol=1e-14, max_nfev=200,
    )  # fmt: skip
    return _below(model, fit.x)


def _judged(model: _Model, x: Floats, used: Booleans) -> Booleans:
    """The ranges that belong: the worst of them out, or what fits the others in.

    A range is judged by its residual over its standard error as the others give it.
    """
    from scipy.stats import t as student

    residuals, jacobian = model.residuals(x), model.jacobian(x)
    freedom = int(used.sum()) - model.unknowns
    if freedom < 2:
        return used
    inverse = np.linalg.pinv(jacobian[used].T @ jacobian[used])
    leverage = np.einsum("ij,jk,ik->i", jacobian, inverse, jacobian)
    square = float(residuals[used] @ residuals[used])
    kept = np.maximum(1.0 - leverage, 1e-9)
    without = np.where(used, square - residuals**2 / kept, square)
    free = np.where(used, freedom - 1, freedom)
    variance = np.maximum(without / free, _FLOOR**2)
    spread = np.sqrt(variance * np.where(used, kept, 1.0 + leverage))
    ratio = np.abs(residuals) / spread
    limit = student.ppf(1.0 - 0.5 * BY_CHANCE / len(used), free)
    changed = used.copy()
    back = ~used & (ratio < limit)
    if back.any():
        changed[np.argmin(np.where(back, ratio, np.inf))] = True
        return changed
    worst = int(np.argmax(np.where(used, ratio, 0.0)))
    if ratio[worst] > limit[worst] and freedom > 2:
        changed[worst] = False
    return changed


def _intervals(
    jacobian: Floats, rms: float, freedom: int, depth_given: bool
) -> tuple[float, float, float, float]:
    """Half-axes [m], bearing of the greater [degrees], half the interval of the depth [m]."""
    from scipy.stats import f as fisher
    from scipy.stats import t as student

    if not freedom:
        return nan, nan, nan, 0.0 if depth_given else nan
    covariance = rms**2 * np.linalg.pinv(jacobian.T @ jacobian)
    lengths, axes = np.linalg.eigh(covariance[:2, :2])
    reach = np.sqrt(2.0 * fisher.ppf(CONFIDENCE, 2, freedom) * np.maximum(lengths, 0.0))
    bearing = degrees(atan2(axes[0, 1], axes[1, 1])) % 180.0
    depth = 0.0
    if not depth_given:
        depth = float(student.ppf(0.5 + 0.5 * CONFIDENCE, freedom)) * sqrt(covariance[2, 2])
    return float(reach[1]), float(reach[0]), bearing, depth


def _consistency(model: _Model, x: Floats, used: Booleans) -> list[str]:
    """Whether the ranges fit better when all are longer or shorter by a factor.

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
    scale = 2.0 * _scatter(np.abs(own), unknowns)
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


def _mirrored(model: _Model, x: Floats, used: Booleans) -> list[str]:
    """Whether a place on the other side of the ship's track fits as well."""
    other = _least_squares(model, mirrored(model.ships[used], model.place(x))[: len(x)], used)
    apart = float(np.linalg.norm((other - x)[:2]))
    own, its = (model.residuals(each)[used] for each in (x, other))
    least = float(used.sum()) * _FLOOR**2
    if apart < 1.0 or float(its @ its) > 4.0 * max(float(own @ own), least):
        return []
    latitude, longitude, _ = model.frame.position(model.place(other))
    return [
        f"Another place fits nearly as well, {apart:.0f} m away: latitude {latitude:.6f}, "
        f"longitude {longitude:.6f}."
    ]
