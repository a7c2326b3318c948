"""The place that fits ranges best, and how well it is known.

Ranges are straight lines from the ship's transducer; of those that belong, residuals are taken as
normal and alike.

What was located is written into the mooring file that it was for.
"""

from dataclasses import asdict, dataclass
from math import atan2, degrees, hypot, nan, sqrt
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
"""Of the ranges: where most miss the place that fits best by more, it is none."""
SCATTERED, SCATTERED_SHARE = 10.0, 0.005
"""Scatter [m], and as a share of the ranges, beyond which it is more than ranging gives."""
LEVEL = 0.05
"""Depth below the ship, in lengths of the ranges, of what answers at the ship's own level."""
MOST_REJECTED = 1.0 / 3.0
"""Share of the ranges that may be rejected without a doubt."""
CLEARLY = 0.5
"""Of two places the nearer is meant that is within this share of the other's distance."""


@dataclass(frozen=True)
class SecondPlace:
    """Describe another place that fits nearly as well.

    Attributes
    ----------
    latitude, longitude : WGS 84 [degrees]
    distance : from the place taken [m]
    rms : of its residuals, by the degrees of freedom [m]; nan where there are none
    """

    latitude: float
    longitude: float
    distance: float
    rms: float


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
    second : another place that fits nearly as well; None where there is none
    doubts : why the place is not to be written down without a person's word
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
    doubts: tuple[str, ...]

    def to_dict(self) -> dict[str, Any]:
        """Return the JSON object; None stands where a figure is unknown."""
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
    """Find where what answers stands.

    Parameters
    ----------
    survey : ranges as read, or their file, by a transducer at the surface
    sound : its speed, for times: by depth, or one for all depths [m/s]
    depth : of what answers [m], where it is known; else it is found too
    near : latitude and longitude [degrees] of about where it was dropped: of two places that fit
        alike the nearer is taken

    Raises
    ------
    InputError
        The file holds no ranges.
    UsageError
        Fewer ranges than unknowns, a depth that no range reaches, ranges that meet nowhere, or
        ranges along the horizontal.
    """
    survey = survey if isinstance(survey, Survey) else read_ranges(Path(survey))
    sound = sound if isinstance(sound, Sound) else Sound.constant(sound)
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
    model = range_model.RangeModel(survey, sound, frame, ships, depth)
    x, used = model.fitted()
    inconsistent = model.consistency(x, used)  # a wrong unit is named for what it is
    missed, reach = (
        float(np.median(np.abs(each[used]))) for each in (model.residuals(x), model.measured(x))
    )
    if missed > MISSED * reach:
        raise UsageError(
            f"{survey.path}: the ranges do not intersect: the best fit misses them by "
            f"{missed:.0f} m, for ranges of {reach:.0f} m; are positions and ranges from one "
            "survey?"
        )
    x, other, meant = _nearer(model, x, model.another_place(x, used), near)
    residuals = model.residuals(x)
    freedom = int(used.sum()) - unknowns
    rms = _scatter(residuals[used], freedom)
    place = model.place(x)
    latitude, longitude, found = frame.position(place)
    if depth is None and found - survey.transducer < LEVEL * reach:
        raise UsageError(
            f"{survey.path}: the transponder would be {found:.1f} m deep, level with the "
            "ship: are these horizontal distances? Slant ranges from the transducer are "
            "needed, or --depth"
        )
    major, minor, bearing, depth_95 = _intervals(
        model.jacobian(x)[used], rms, freedom, depth is not None, float(model.measured(x).max())
    )
    second = None if other is None else _second(model, x, other, used)
    doubts = []
    if rms > SCATTERED + SCATTERED_SHARE * reach:
        doubts.append(f"the ranges scatter by {rms:.0f} m, more than ranging does")
    if (~used).sum() > MOST_REJECTED * count:
        doubts.append(f"{int((~used).sum())} of {count} ranges do not fit the others")
    warnings = [
        *inconsistent,
        *range_model.geometry_warnings(
            ships[used], place, found - survey.transducer, depth is not None
        ),
        *(f"{doubt[0].upper()}{doubt[1:]}." for doubt in doubts),
    ]
    if second is not None:
        warnings.append(
            f"Another place fits nearly as well, {second.distance:.0f} m away: latitude "
            f"{second.latitude:.6f}, longitude {second.longitude:.6f}."
        )
        if not meant:
            doubts.append("two places fit; say with --near LAT,LON which is meant")
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
        second=second,
        doubts=tuple(doubts),
    )


def _nearer(
    model: range_model.RangeModel, x: Floats, other: Floats | None, near: tuple[float, float] | None
) -> tuple[Floats, Floats | None, bool]:
    """Return the place that is meant, the other one, and whether it is clear which is meant."""
    if other is None or near is None:
        return x, other, other is None
    there = model.frame.place(np.array(near[0]), np.array(near[1]), np.array(0.0))
    away, its = (float(np.linalg.norm((there - model.place(each))[:2])) for each in (x, other))
    if its < away:
        x, other, away, its = other, x, its, away
    return x, other, away <= CLEARLY * its


def _second(model: range_model.RangeModel, x: Floats, other: Floats, used: Booleans) -> SecondPlace:
    latitude, longitude, _ = model.frame.position(model.place(other))
    freedom = int(used.sum()) - model.unknowns
    distance = float(np.linalg.norm((other - x)[:2]))
    rms = _scatter(model.residuals(other)[used], freedom)
    return SecondPlace(latitude, longitude, distance, rms)


def _scatter(residuals: Floats, freedom: int) -> float:
    """Return the root of the mean square by the degrees of freedom [m]; nan of none."""
    return sqrt(float(residuals @ residuals) / freedom) if freedom else nan


def _intervals(
    jacobian: Floats, rms: float, freedom: int, depth_given: bool, farthest: float
) -> tuple[float, float, float, float]:
    """Half-axes [m], bearing of the greater [degrees], half the interval of the depth [m].

    None of them, nan, where they are as wide as the longest range.
    """
    from scipy.stats import chi2, norm
    from scipy.stats import f as fisher
    from scipy.stats import t as student

    if not freedom:
        return nan, nan, nan, 0.0 if depth_given else nan
    _, sizes, axes = np.linalg.svd(jacobian, full_matrices=False)
    covariance = (axes.T / np.maximum(sizes, 1e-12) ** 2) @ axes
    lengths, ways = np.linalg.eigh(covariance[:2, :2])
    # as the residuals tell, and no less than ranges and ship are known to scatter
    of_residuals = rms * sqrt(2.0 * float(fisher.ppf(CONFIDENCE, 2, freedom)))
    widest = max(of_residuals, range_model.FLOOR * sqrt(float(chi2.ppf(CONFIDENCE, 2))))
    reach = widest * np.sqrt(np.maximum(lengths, 0.0))
    bearing = degrees(atan2(ways[0, 1], ways[1, 1])) % 180.0
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
"""Times the depth of the water from the planned position: farther than an anchor is laid astray."""
NEAR = 0.5
"""Share of the distance as written, within which degrees read as degrees and minutes are meant."""
DEEPER = 0.05
"""Share by which the depth may differ from the planned one without a word of doubt."""


def located_mooring(path: Path) -> MooringFile:
    """Return the mooring file that a place is for.

    InputError: the file has mistakes. UsageError: it is a tow, or has several legs.
    """
    file = read_mooring(path)
    refuse_all_but_moorings(file)
    return file


def with_deployed(
    path: Path, before: MooringFile, located: Located, water_depth: float
) -> tuple[WorkingFile, str, tuple[str, ...], tuple[str, ...]]:
    """Return a mooring file, its text with the place in its `deployed`, how far that is from the
    plan, and what of that is in doubt.

    All else stays byte for byte: comments, and what `deployed` says besides.

    Parameters
    ----------
    before : the file as read, see `located_mooring`
    water_depth : at the anchor [m]

    Raises
    ------
    InputError
        The file has mistakes with the place in it.
    UsageError
        It is written in a way that does not allow this change, or planned to stand where
        latitude and longitude are exchanged.
    """
    said, doubts = _beside_the_plan(before, located, water_depth)
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
    return file, draft.text, said, doubts


def _beside_the_plan(
    file: MooringFile, located: Located, water_depth: float
) -> tuple[tuple[str, ...], tuple[str, ...]]:
    """Return where the anchor stands from its planned position, how much deeper, and the doubts."""
    planned, plan_depth = file.position, file.environment.depth
    assert plan_depth is not None  # of a mooring
    deeper = water_depth - plan_depth
    said = [f"{abs(deeper):.1f} m {'deeper' if deeper >= 0.0 else 'less deep'} than planned"]
    if abs(deeper) > DEEPER * plan_depth:
        said.append("the depth is far from the planned one: is it right?")
    if planned is None:
        return tuple(said), ()
    frame = Frame(planned.latitude, planned.longitude)

    def away(latitude: float, longitude: float) -> float:
        place = frame.place(np.array(latitude), np.array(longitude), np.array(0.0))
        return float(np.linalg.norm(place[:2]))

    there = located.latitude, located.longitude
    east, north, _ = frame.place(np.array(there[0]), np.array(there[1]), np.array(0.0)).tolist()
    distance = hypot(east, north)
    said.insert(0, f"{distance:.0f} m towards {bearing_text(bearing_of(east, north))} of the "
                "planned position")  # fmt: skip
    limit = FAR * max(water_depth, plan_depth)
    if distance <= limit:
        return tuple(said), ()
    if abs(there[1]) <= 90.0 and away(there[1], there[0]) <= limit:
        raise UsageError(
            f"{located.survey.path}: latitude and longitude are exchanged: the anchor "
            f"would stand {distance / 1000.0:.0f} km from the position in {file.path}"
        )
    doubt = f"the place is {distance / 1000.0:.1f} km from the planned position"
    if away(*map(read_as_minutes, there)) <= NEAR * distance:
        doubt += ", and near it if the positions are degrees and minutes, as 48 18 for 48.18"
    said.append("that is far from the planned position: is it this mooring's?")
    return tuple(said), (doubt,)
