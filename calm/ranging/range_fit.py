"""Position that best fits acoustic ranges, and its uncertainty.

Rays are straight lines from the ship's transducer. The residuals of ranges in use are assumed to be
normal with equal variance.
"""

from dataclasses import asdict, dataclass
from math import atan2, degrees, hypot, log, nan, sqrt
from pathlib import Path
from typing import Any

import numpy as np

from calm.errors import UsageError
from calm.files import MooringFile, read_mooring
from calm.files.editing import Draft, EditError, WorkingFile
from calm.files.mooring_file import refuse_all_but_moorings
from calm.physics.line import Booleans, Floats
from calm.positions import Frame, read_as_minutes
from calm.quantities import bearing_of, bearing_text
from calm.ranging import range_model
from calm.ranging.ranges import Sound, Survey, read_ranges

CONFIDENCE = 0.95
MISSED = 0.25
"""Median absolute residual above which the fit is rejected, as a fraction of the median range."""
SCATTERED, SCATTERED_SHARE = 10.0, 0.005
"""Largest usual scatter of ranges: a constant [m] plus a fraction of the median range."""
LEVEL = 0.05
"""Minimum depth of the transponder below the ship, as a fraction of the median range."""
MOST_REJECTED = 1.0 / 3.0
"""Fraction of rejected ranges above which the position is doubtful."""
FALL_BACK, LEAST_FALL_BACK = 0.1, 50.0
"""Standard deviation of the distance between an anchor and its planned position: fraction of
the depth, and minimum [m].
"""
ODDS = 20.0
"""Odds in favour of the more likely of two positions, below which the choice is doubtful."""


@dataclass(frozen=True)
class SecondPlace:
    """Second position that fits the ranges nearly as well as the chosen position.

    Attributes
    ----------
    latitude, longitude : WGS 84 [degrees]
    distance : distance from the chosen position [m]
    rms : as in `Located` [m]
    """

    latitude: float
    longitude: float
    distance: float
    rms: float


@dataclass(frozen=True)
class Located:
    """Position of a transponder, with its uncertainty and the residuals of the ranges.

    Values that the ranges do not determine are NaN.

    Attributes
    ----------
    latitude, longitude : WGS 84 [degrees]
    depth : depth below the surface [m]
    horizontal_95 : semi-major axis of the 95 % ellipse [m]
    ellipse : semi-major and semi-minor axis [m], and bearing of the major axis [degrees]
    depth_95 : half of the 95 % interval of the depth [m]; 0 if the depth was given
    rms : square root of (sum of squared residuals / degrees of freedom) [m]
    residuals : (n,) measured minus computed ranges [m]
    used : (n,) mask of the ranges in use
    sound_speed : harmonic mean along the ray [m/s]
    place : (3,) position east, north, up in the frame of the survey [m]
    second : another position that fits the ranges, or None
    undecided : whether the choice between the position and `second` is doubtful
    doubts : reasons not to write the position to a file without confirmation
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
    second: SecondPlace | None
    undecided: bool
    doubts: tuple[str, ...]

    def to_dict(self) -> dict[str, Any]:
        """Return the position as a JSON object; unknown values are None."""
        lines = self.survey.line
        major, minor, bearing = map(_known, self.ellipse)
        rejected = [(lines[i], self.residuals[i].item()) for i in np.flatnonzero(~self.used)]
        return {
            "latitude": self.latitude,
            "longitude": self.longitude,
            "depth": self.depth,
            "horizontal_95": _known(self.horizontal_95),
            "depth_95": _known(self.depth_95),
            "residuals": self.residuals.tolist(),
            "rms": _known(self.rms),
            "used": [line for line, used in zip(lines, self.used, strict=True) if used],
            "rejected": [line for line, _ in rejected],
            "second": None
            if self.second is None
            else asdict(self.second) | {"rms": _known(self.second.rms)},
            "ellipse_95": {"major": major, "minor": minor, "bearing": bearing},
            "sound_speed": self.sound_speed if self.survey.timed else None,
            "lines": list(lines),
            "outliers": [{"line": line, "residual": residual} for line, residual in rejected],
            "warnings": list(self.warnings),
            "doubts": list(self.doubts),
        }


def _known(value: float) -> float | None:
    return value if np.isfinite(value) else None


def locate(
    survey: Survey | str | Path,
    sound: Sound | float = 1500.0,
    depth: float | None = None,
    near: tuple[float, float] | None = None,
) -> Located:
    """Locate a transponder from acoustic ranges.

    Parameters
    ----------
    survey : ranges, or the path of their file
    sound : speed of sound, as a profile or a constant [m/s]
    depth : depth of the transponder [m]; None to estimate the depth
    near : planned latitude and longitude [degrees], used to choose between two positions that fit

    Raises
    ------
    InputError
        The file of the ranges has mistakes.
    UsageError
        There are too few ranges, or the ranges do not intersect, are nearly horizontal, or are
        wrong by a factor of about 2.
    """
    survey = survey if isinstance(survey, Survey) else read_ranges(Path(survey))
    sound = sound if isinstance(sound, Sound) else Sound.constant(sound)
    unknowns = 2 if depth is not None else 3
    count = len(survey.line)
    if count < unknowns:
        raise UsageError(
            f"{survey.path}: {count} range{'s' * (count != 1)}; {unknowns} are needed to find "
            f"{'a position' if depth is not None else 'position and depth'}"
            f"{', or 2 with --depth' if count == 2 and depth is None else ''}"
        )
    frame = survey.frame
    ships = frame.place(survey.latitude, survey.longitude, np.full(count, survey.transducer))
    model = range_model.RangeModel(survey, sound, frame, ships, depth)
    x, used = model.fitted()
    inconsistent = model.consistency(x, used)  # before the residuals, to report a wrong unit
    missed, reach = (
        float(np.median(np.abs(each[used]))) for each in (model.residuals(x), model.measured(x))
    )
    if missed > MISSED * reach:
        raise UsageError(
            f"{survey.path}: the ranges do not intersect: the best fit leaves residuals of "
            f"{missed:.0f} m for ranges of {reach:.0f} m; do positions and ranges belong to the "
            "same survey?"
        )
    scattered = SCATTERED + SCATTERED_SHARE * reach
    other = model.another_place(x, used, 2.0 * scattered)
    x, other, undecided = _more_likely(model, x, other, used, near, scattered)
    residuals = model.residuals(x)
    freedom = int(used.sum()) - unknowns
    rms = _residual_deviation(residuals[used], freedom)
    place = model.place(x)
    latitude, longitude, found = frame.position(place)
    if depth is None and found - survey.transducer < LEVEL * reach:
        raise UsageError(
            f"{survey.path}: by these ranges, the transponder is at a depth of {found:.1f} m, "
            "level with the ship: are they horizontal distances? Use slant ranges from the "
            "transducer, or set --depth"
        )
    major, minor, bearing, depth_95 = _intervals(
        model.jacobian(x)[used], rms, freedom, depth is not None, float(model.measured(x).max())
    )
    second = None if other is None else _second(model, x, other, used)
    doubts = []
    if rms > scattered:
        doubts.append(f"the ranges scatter by {rms:.0f} m, more than is usual for acoustic ranging")
    if (~used).sum() > MOST_REJECTED * count:
        doubts.append(f"{int((~used).sum())} of {count} ranges are outliers")
    warnings = [
        *inconsistent,
        *range_model.geometry_warnings(
            ships[used], place, found - survey.transducer, depth is not None
        ),
        *(f"{doubt[0].upper()}{doubt[1:]}." for doubt in doubts),
    ]
    if second is not None:
        assert other is not None
        its, own = (np.sqrt(np.mean(model.residuals(each)[used] ** 2)) for each in (other, x))
        warnings.append(
            f"Another position fits, {second.distance:.0f} m away: latitude {second.latitude:.6f}, "
            f"longitude {second.longitude:.6f}; the rms of its residuals is {its:.1f} m, compared "
            f"with {own:.1f} m for the position reported."
        )
    doubts += [undecided] if undecided else []
    if not freedom:
        warnings.append(
            "There are only as many ranges as unknowns, so the fit cannot be tested and no "
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
        second=second,
        undecided=bool(undecided),
        doubts=tuple(doubts),
    )


def _more_likely(
    model: range_model.RangeModel,
    x: Floats,
    other: Floats | None,
    used: Booleans,
    near: tuple[float, float] | None,
    scattered: float,
) -> tuple[Floats, Floats | None, str]:
    """Choose the more likely of two positions that fit the ranges.

    The choice depends on the residuals and on the distance from the planned position. Both are
    assumed to be normal; `scattered` is the standard deviation of the residuals [m]. Without a
    planned position, the first position is chosen.

    Returns
    -------
    The more likely position, the other position, and the reason why the choice is doubtful. The
    reason is "" for a clear choice.
    """
    if other is None:
        return x, None, ""
    if near is None:
        return x, other, "two positions fit; select one with --near LAT,LON"
    plan = model.frame.place(np.array(near[0]), np.array(near[1]), np.array(0.0))
    square_sums, away, cost = [], [], []
    for each in (x, other):
        place = model.place(each)
        square_sums.append(float(np.sum(model.residuals(each)[used] ** 2)))
        away.append(float(np.linalg.norm((plan - place)[:2])))
        fall_back = max(FALL_BACK * abs(float(place[2])), LEAST_FALL_BACK)
        cost.append(0.5 * (square_sums[-1] / scattered**2 + (away[-1] / fall_back) ** 2))
    order = (0, 1) if cost[0] <= cost[1] else (1, 0)
    first, second = ((x, other)[at] for at in order)
    least = float(used.sum()) * range_model.FLOOR**2
    undecided = ""
    if abs(cost[0] - cost[1]) < log(ODDS):
        undecided = "two positions fit, {:.0f} and {:.0f} m from the planned position"
    elif square_sums[order[0]] > 4.0 * max(square_sums[order[1]], least):
        undecided = (
            "two positions remain, {:.0f} and {:.0f} m from the planned position; the position "
            "nearer to the plan fits the ranges worse"
        )
    return first, second, undecided.format(*(away[at] for at in order))


def _second(model: range_model.RangeModel, x: Floats, other: Floats, used: Booleans) -> SecondPlace:
    latitude, longitude, _ = model.frame.position(model.place(other))
    freedom = int(used.sum()) - model.unknowns
    distance = float(np.linalg.norm((other - x)[:2]))
    rms = _residual_deviation(model.residuals(other)[used], freedom)
    return SecondPlace(latitude, longitude, distance, rms)


def _residual_deviation(residuals: Floats, freedom: int) -> float:
    return sqrt(float(residuals @ residuals) / freedom) if freedom else nan


def _intervals(
    jacobian: Floats, rms: float, freedom: int, depth_given: bool, farthest: float
) -> tuple[float, float, float, float]:
    """Return semi-axes [m] and bearing [degrees] of the 95 % ellipse, and uncertainty of depth [m].

    The uncertainty of depth is half of the 95 % interval. Values larger than the longest range,
    `farthest` [m], are replaced by NaN.
    """
    from scipy.stats import chi2, norm
    from scipy.stats import f as fisher
    from scipy.stats import t as student

    if not freedom:
        return nan, nan, nan, 0.0 if depth_given else nan
    _, sizes, axes = np.linalg.svd(jacobian, full_matrices=False)
    covariance = (axes.T / np.maximum(sizes, 1e-12) ** 2) @ axes
    lengths, axes = np.linalg.eigh(covariance[:2, :2])
    # the scatter of the residuals, but at least the known scatter of ranges and ship
    of_residuals = rms * sqrt(2.0 * float(fisher.ppf(CONFIDENCE, 2, freedom)))
    widest = max(of_residuals, range_model.FLOOR * sqrt(float(chi2.ppf(CONFIDENCE, 2))))
    reach = widest * np.sqrt(np.maximum(lengths, 0.0))
    bearing = degrees(atan2(axes[0, 1], axes[1, 1])) % 180.0
    depth = 0.0
    if not depth_given:
        side = 0.5 + 0.5 * CONFIDENCE
        of_residuals = rms * float(student.ppf(side, freedom))
        depth = max(of_residuals, range_model.FLOOR * float(norm.ppf(side))) * sqrt(
            covariance[2, 2]
        )
    known = reach[1] < farthest
    return (
        float(reach[1]) if known else nan,
        float(reach[0]) if known else nan,
        bearing,
        depth if depth < farthest else nan,
    )


FAR = 2.0
"""Distance from the planned position, in water depths, above which the position is doubtful."""
NEAR = 0.5
"""Fraction of the distance from the planned position.

If reading 48.18 as 48°18′ reduces the distance to this fraction or less, this reading is suggested.
"""
DEEPER, DEEPER_SHARE = 30.0, 0.03
"""Difference from the planned depth above which the depth is doubtful: the larger of a value [m]
and a share of the planned depth.
"""


def located_mooring(path: Path) -> MooringFile:
    """Read the mooring file that is to receive the anchor position.

    Raises
    ------
    InputError
        The file has mistakes.
    UsageError
        The file describes a tow or several legs.
    """
    file = read_mooring(path)
    refuse_all_but_moorings(file)
    return file


def with_deployed(
    path: Path, before: MooringFile, located: Located, water_depth: float
) -> tuple[WorkingFile, str, tuple[str, ...], tuple[str, ...]]:
    """Write the position to `deployed` in the text of a mooring file, without saving the file.

    The rest of the text is unchanged.

    Parameters
    ----------
    before : the mooring file as read by `located_mooring`
    water_depth : depth of the water at the anchor [m]

    Returns
    -------
    The mooring file, the new text of this file, sentences on the deviation from the planned
    position, and reasons to doubt the position.

    Raises
    ------
    InputError
        With the new position, the file has mistakes.
    UsageError
        The file cannot be edited automatically, or latitude and longitude appear to be exchanged.
    """
    sentences, doubts = _plan_deviation(before, located, water_depth)
    file = WorkingFile(path)
    position = {
        "latitude": f"{located.latitude:.6f} deg",
        "longitude": f"{located.longitude:.6f} deg",
    }
    try:
        draft = Draft(file.read())
        draft = draft.put_at(("deployed", "position"), position)
        draft = draft.put_at(("deployed", "depth"), f"{water_depth:.1f} m")
    except EditError as error:
        raise UsageError(f"{path}: {error}") from None
    read_mooring(path, text=draft.text)
    return file, draft.text, sentences, doubts


def _plan_deviation(
    file: MooringFile, located: Located, water_depth: float
) -> tuple[tuple[str, ...], tuple[str, ...]]:
    """Return sentences on the deviation from the planned position and depth.

    Also return the reasons to doubt the position.
    """
    planned, plan_depth = file.position, file.environment.depth
    assert plan_depth is not None  # a mooring always has a water depth
    deeper = water_depth - plan_depth
    sentences = [f"{abs(deeper):.1f} m {'deeper' if deeper >= 0.0 else 'less deep'} than planned"]
    doubts = []
    if abs(deeper) > max(DEEPER, DEEPER_SHARE * plan_depth):
        doubts.append(
            f"the depth of {water_depth:.0f} m is far from the planned depth of {plan_depth:.0f} m"
        )
    if planned is None:
        return tuple(sentences), tuple(doubts)
    frame = Frame(planned.latitude, planned.longitude)

    def away(latitude: float, longitude: float) -> float:
        place = frame.place(np.array(latitude), np.array(longitude), np.array(0.0))
        return float(np.linalg.norm(place[:2]))

    there = located.latitude, located.longitude
    east, north, _ = frame.place(np.array(there[0]), np.array(there[1]), np.array(0.0)).tolist()
    distance = hypot(east, north)
    sentences.insert(0, f"{distance:.0f} m towards {bearing_text(bearing_of(east, north))} of the "
                "planned position")  # fmt: skip
    limit = FAR * max(water_depth, plan_depth)
    if distance <= limit:
        return tuple(sentences), tuple(doubts)
    if abs(there[1]) <= 90.0 and away(there[1], there[0]) <= limit:
        raise UsageError(
            f"{located.survey.path}: latitude and longitude appear to be exchanged: the anchor "
            f"would lie {distance / 1000.0:.0f} km from the position in {file.path}"
        )
    doubt = f"the position is {distance / 1000.0:.1f} km from the planned position"
    if away(*map(read_as_minutes, there)) <= NEAR * distance:
        doubt += (
            "; it would be near the planned position if 48.18, for example, means 48 degrees 18 "
            "minutes"
        )
    sentences.append(
        "the result is far from the planned position; do the ranges belong to this mooring?"
    )
    return tuple(sentences), (*doubts, doubt)
