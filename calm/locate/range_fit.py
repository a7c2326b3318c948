"""The place that fits ranges best, and how well it is known.

Ranges are straight lines from the ship's transducer; of those that belong, residuals are taken as
normal and alike.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import atan2, degrees, nan, sqrt
from typing import Any

import numpy as np

from calm.errors import UsageError
from calm.locate.range_model import RangeModel, fitted
from calm.locate.ranges import Survey
from calm.locate.sound import Sound
from calm.locate.survey_warnings import another_place, consistency, geometry_warnings
from calm.physics.line import Booleans, Floats

CONFIDENCE = 0.95
MISSED = 0.25
"""Of the ranges: where most miss the place that fits best by more, it is none."""


@dataclass(frozen=True)
class Located:
    """Describe where what answers stands.

    Attributes
    ----------
    survey : the ranges
    latitude, longitude : WGS 84 [degrees]
    depth : below the surface [m]
    horizontal_95 : greater half-axis of the ellipse that holds the place with 95 % [m]; nan where
        there are no more ranges than unknowns, or they do not tell
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
        """Return the JSON object; None stands where a figure is unknown."""
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
    frame = survey.frame
    ships = frame.place(survey.latitude, survey.longitude, np.full(count, survey.transducer))
    model = RangeModel(survey, sound, frame, ships, depth)
    x, used = fitted(model)
    residuals = model.residuals(x)
    inconsistent = consistency(model, x, used)  # a wrong unit is named for what it is
    missed, reach = (
        float(np.median(np.abs(each[used]))) for each in (residuals, model.measured(x))
    )
    if missed > MISSED * reach:
        raise UsageError(
            f"{survey.path}: the ranges meet nowhere: the place that fits best is missed by "
            f"{missed:.0f} m, by ranges of {reach:.0f} m; are positions and ranges of one survey?"
        )
    jacobian = model.jacobian(x)[used]
    freedom = int(used.sum()) - unknowns
    rms = sqrt(float(residuals[used] @ residuals[used]) / freedom) if freedom else nan
    major, minor, bearing, depth_95 = _intervals(
        jacobian, rms, freedom, depth is not None, float(model.measured(x).max())
    )
    place = model.place(x)
    latitude, longitude, found = frame.position(place)
    warnings = [
        *inconsistent,
        *geometry_warnings(ships[used], place, found - survey.transducer, depth is not None),
        *another_place(model, x, used),
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


def _intervals(
    jacobian: Floats, rms: float, freedom: int, depth_given: bool, farthest: float
) -> tuple[float, float, float, float]:
    """Half-axes [m], bearing of the greater [degrees], half the interval of the depth [m].

    None of them, nan, where they are as wide as the longest range.
    """
    from scipy.stats import f as fisher
    from scipy.stats import t as student

    if not freedom:
        return nan, nan, nan, 0.0 if depth_given else nan
    _, sizes, axes = np.linalg.svd(jacobian, full_matrices=False)
    covariance = (axes.T * (rms / np.maximum(sizes, 1e-12)) ** 2) @ axes
    lengths, ways = np.linalg.eigh(covariance[:2, :2])
    reach = np.sqrt(2.0 * fisher.ppf(CONFIDENCE, 2, freedom) * np.maximum(lengths, 0.0))
    bearing = degrees(atan2(ways[0, 1], ways[1, 1])) % 180.0
    depth = 0.0
    if not depth_given:
        depth = float(student.ppf(0.5 + 0.5 * CONFIDENCE, freedom)) * sqrt(covariance[2, 2])
    known = reach[1] < farthest
    return (
        float(reach[1]) if known else nan,
        float(reach[0]) if known else nan,
        bearing,
        depth if depth < farthest else nan,
    )
