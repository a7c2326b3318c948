"""Anchors located from simulated surveys, whose truth is known."""

from math import acosh
from operator import attrgetter
from pathlib import Path

import numpy as np
import pytest
from scipy.stats import t as student

import calm
from calm.errors import UsageError
from calm.positions import FLATTENING, SEMI_MAJOR, Frame
from calm.ranging import Sound, Survey, locate
from calm.ranging.range_model import (
    BY_CHANCE,
    FLOOR,
    RangeModel,
    is_line,
    mirrored,
    scatter,
)

LATITUDE, LONGITUDE, DEPTH, TRANSDUCER = 48.3, -5.2, 2000.0, 5.0
HERE = Frame(LATITUDE, LONGITUDE)
ANCHOR = HERE.place(np.array([LATITUDE]), np.array([LONGITUDE]), np.array([DEPTH]))[0]
ONE = Sound.constant(1500.0)


def survey(bearing, distance, error=0.0, *, times=None, scale=1.0):
    """Ranges from places at a bearing [degrees] and distance [m] from above the anchor."""
    bearing, distance = np.broadcast_arrays(np.radians(bearing), distance)
    flat = np.column_stack([distance * np.sin(bearing), distance * np.cos(bearing), 0.0 * distance])
    latitude, longitude, _ = np.array([HERE.position(place) for place in flat]).T
    ships = HERE.place(latitude, longitude, np.full(len(flat), TRANSDUCER))
    ranges = scale * np.linalg.norm(ships - ANCHOR, axis=1) + error
    measured = ranges if times is None else 2.0 * ranges / times
    lines = tuple(range(2, len(flat) + 2))
    return Survey(
        Path("r.csv"), lines, latitude, longitude, measured, times is not None, TRANSDUCER
    )


def missed(located):
    """East and north [m] from the truth to what was found."""
    latitude, longitude = np.array([located.latitude]), np.array([located.longitude])
    return (HERE.place(latitude, longitude, np.array([DEPTH]))[0] - ANCHOR)[:2]


ROUND = np.arange(0.0, 360.0, 30.0)


def test_exact_ranges_give_the_place():
    located = locate(survey(ROUND, 1500.0), ONE)
    assert np.linalg.norm(missed(located)) < 1e-3
    assert located.depth == pytest.approx(DEPTH, abs=1e-3)
    assert located.used.all()
    assert located.warnings == ()


def test_from_a_file(tmp_path):
    known = survey(ROUND, 1500.0)
    rows = zip(known.latitude, known.longitude, known.measured, strict=True)
    text = "latitude,longitude,range[m]\n" + "".join(
        f"{latitude:.8f},{longitude:.8f},{measured:.4f}\n" for latitude, longitude, measured in rows
    )
    (tmp_path / "r.csv").write_text(text)
    located = attrgetter("locate")(calm)(tmp_path / "r.csv", 1500.0)
    # the transducer lies 5 m deep, which a file does not tell: that moves the depth alone
    assert np.linalg.norm(missed(located)) < 0.1
    assert located.depth == pytest.approx(DEPTH - TRANSDUCER, abs=0.1)


def test_two_way_times_and_a_profile():
    # the ship's distance matters little to the mean: a straight ray passes all depths evenly
    profile = Sound(np.array([0.0, 100.0, 2000.0]), np.array([1520.0, 1490.0, 1510.0]))
    mean = profile.mean(TRANSDUCER, DEPTH)
    located = locate(survey(ROUND, 1500.0, times=mean), profile)
    assert located.depth == pytest.approx(DEPTH, abs=1e-3)
    assert located.sound_speed == pytest.approx(mean, abs=1e-6)


def test_the_harmonic_mean_of_a_linear_profile():
    # ∫dz/c of c = c0 + g z is ln(c2/c1)/g
    profile = Sound(np.array([0.0, 4000.0]), np.array([1500.0, 1568.0]))
    slowness = np.log(1568.0 / 1500.0) / 0.017 / 4000.0
    assert profile.mean(0.0, 4000.0) == pytest.approx(1.0 / slowness, rel=1e-12)


def test_bent_rays_cost_less_than_a_metre():
    # Exact times between two points of a linear profile: t = arccosh(1 + g² s²/(2 c1 c2))/g.
    gradient, top = 0.017, 1500.0
    profile = Sound(np.array([0.0, 4000.0]), np.array([top, top + 4000.0 * gradient]))
    plain = survey(ROUND, 2000.0)
    speeds = [top + gradient * depth for depth in (TRANSDUCER, DEPTH)]
    times = [
        2.0 * acosh(1.0 + (gradient * s) ** 2 / (2.0 * speeds[0] * speeds[1])) / gradient
        for s in plain.measured
    ]
    bent = Survey(
        plain.path, plain.line, plain.latitude, plain.longitude, np.array(times), True, TRANSDUCER
    )
    located = locate(bent, profile)
    # the bent ray is the faster by some 0.01 % of its time at 45 degrees: a fraction of a metre
    assert np.linalg.norm(missed(located)) < 0.05
    assert located.depth == pytest.approx(DEPTH, abs=0.5)


@pytest.mark.thorough
def test_intervals_cover_as_often_as_they_say():
    random = np.random.default_rng(20)
    surveys, within, deep = 60, 0, 0
    for _ in range(surveys):
        error = random.normal(0.0, 2.0, 10)
        located = locate(
            survey(random.uniform(0, 360, 10), random.uniform(800, 1800, 10), error), ONE
        )
        major, minor, bearing = located.ellipse
        along = np.array([np.sin(np.radians(bearing)), np.cos(np.radians(bearing))])
        away = missed(located)
        aside = away @ [along[1], -along[0]]
        within += (away @ along / major) ** 2 + (aside / minor) ** 2 <= 1.0
        deep += abs(located.depth - DEPTH) <= located.depth_95
    # 95 % of 60: 57, three standard deviations are 5
    assert within >= 52
    assert deep >= 52


def test_outliers_are_found_and_do_not_move_the_place():
    random = np.random.default_rng(21)
    for wrong in ([3], [1, 8], [0, 4, 9]):
        error = random.normal(0.0, 1.0, 12)
        error[wrong] += [150.0, -60.0, 400.0][: len(wrong)]
        located = locate(survey(ROUND, random.uniform(900, 1800, 12), error), ONE)
        assert np.flatnonzero(~located.used).tolist() == wrong
        assert np.linalg.norm(missed(located)) < 3.0
        document = located.to_dict()
        assert [one["line"] for one in document["outliers"]] == [i + 2 for i in wrong]
        assert len(document["residuals"]) == 12


def test_a_given_depth_is_not_sought():
    located = locate(survey([0.0, 120.0, 240.0], 1500.0), ONE, depth=DEPTH)
    assert located.depth == pytest.approx(DEPTH, abs=1e-6)
    assert located.depth_95 == 0.0
    assert np.linalg.norm(missed(located)) < 1e-3


def test_as_many_ranges_as_unknowns_give_no_interval():
    located = locate(survey([0.0, 120.0, 240.0], 1500.0), ONE)
    assert located.depth == pytest.approx(DEPTH, abs=1e-3)
    assert located.to_dict()["horizontal_95"] is None
    assert any("only as many ranges as unknowns" in each for each in located.warnings)


def test_too_few_ranges_are_refused():
    with pytest.raises(UsageError, match=r"2 ranges; 3 are needed .* or 2 with --depth"):
        locate(survey([0.0, 120.0], 1500.0), ONE)
    with pytest.raises(UsageError, match="1 range; 2 are needed to find a position"):
        locate(survey([0.0], 1500.0), ONE, depth=DEPTH)


@pytest.mark.parametrize(
    ("bearing", "distance", "said"),
    [
        (np.linspace(0.0, 100.0, 10), 1500.0, "one side"),
        (ROUND, 150.0, "nearly overhead"),
        (ROUND, 9000.0, "from far away"),
    ],
)
def test_poor_geometry_is_reported(bearing, distance, said):
    assert any(said in each for each in locate(survey(bearing, distance), ONE).warnings)


def test_a_straight_track_leaves_two_places_or_a_circle_of_them():
    # along a line 600 m east of the anchor
    north = np.linspace(-1500.0, 1500.0, 10)
    bearing = np.degrees(np.arctan2(600.0, north))
    track = survey(bearing, np.hypot(600.0, north), np.tile([0.3, -0.3], 5))
    given = locate(track, ONE, depth=DEPTH)
    assert any("along one straight line" in each for each in given.warnings)
    assert any("Another position fits, 1200 m away" in each for each in given.warnings)
    sought = locate(track, ONE)
    assert any("as do nearer but deeper positions" in each for each in sought.warnings)
    assert sought.to_dict()["horizontal_95"] is None
    assert sought.to_dict()["depth_95"] is None


@pytest.mark.parametrize("scale", [0.5, 2.0])
@pytest.mark.thorough
def test_one_way_for_two_way_is_refused(scale):
    random = np.random.default_rng(22)
    distance = random.uniform(800, 2500, 12)
    with pytest.raises(UsageError, match="appear to be"):
        locate(survey(ROUND, distance, random.normal(0.0, 1.0, 12), times=1500.0, scale=scale), ONE)


def test_a_wrong_speed_of_sound_is_reported():
    random = np.random.default_rng(23)
    distance = np.tile([300.0, 1500.0, 3500.0], 4)
    located = locate(survey(ROUND, distance, random.normal(0.0, 0.5, 12), times=1470.0), ONE)
    assert any("is the speed of sound 14" in each for each in located.warnings)


def test_a_survey_across_the_date_line():
    frame = Frame(10.0, 180.0)
    places = 1500.0 * np.array([[1, 0, 0], [-1, 0, 0], [0, 1, 0], [0, -1, 0], [0.7, 0.7, 0]])
    latitude, longitude, _ = np.array([frame.position(place) for place in places]).T
    assert longitude.min() < -179.0 < 179.0 < longitude.max()
    anchor = frame.place(np.array([10.0]), np.array([180.0]), np.array([3000.0]))[0]
    ships = frame.place(latitude, longitude, np.zeros(5))
    ranges = np.linalg.norm(ships - anchor, axis=1)
    survey = Survey(Path("r.csv"), (2, 3, 4, 5, 6), latitude, longitude, ranges, False, 0.0)
    located = locate(survey, ONE)
    assert abs(located.longitude) == pytest.approx(180.0, abs=1e-7)
    assert located.depth == pytest.approx(3000.0, abs=1e-3)


def test_distances_are_those_of_the_ellipsoid():
    # 20 km along a meridian and along a parallel, by their radii of curvature; the chord is
    # shorter than the arc by s³/24R², 8 mm
    square = FLATTENING * (2.0 - FLATTENING)
    phi = np.linspace(48.3, 48.48, 2001)
    root = 1.0 - square * np.sin(np.radians(phi)) ** 2
    arc = np.trapezoid(SEMI_MAJOR * (1.0 - square) / root**1.5, np.radians(phi))
    north = HERE.place(np.array([48.48]), np.array([LONGITUDE]), np.zeros(1))[0]
    assert np.linalg.norm(north) == pytest.approx(arc, abs=0.02)
    across = SEMI_MAJOR / np.sqrt(root[0]) * np.cos(np.radians(LATITUDE))
    chord = 2.0 * across * np.sin(np.radians(0.25) / 2.0)
    east = HERE.place(np.array([LATITUDE]), np.array([LONGITUDE + 0.25]), np.zeros(1))[0]
    assert np.linalg.norm(east) == pytest.approx(chord, abs=1e-6)


def test_there_and_back():
    for place in ([0.0, 0.0, 0.0], [15_000.0, -9_000.0, -5_000.0], [-30_000.0, 20_000.0, 40.0]):
        latitude, longitude, depth = HERE.position(np.array(place))
        again = HERE.place(np.array([latitude]), np.array([longitude]), np.array([depth]))[0]
        assert again == pytest.approx(place, abs=1e-6)


def test_a_given_depth_is_one_below_the_curved_surface():
    """At 10 km the surface is d²/2R, 7.8 m, below the plane that touches it."""
    ships = survey(ROUND, 1500.0)
    model = RangeModel(ships, ONE, HERE, np.zeros((12, 3)), DEPTH)
    place = model.place(np.array([10e3, 0.0]))
    assert place[2] == pytest.approx(-DEPTH - 10e3**2 / (2.0 * SEMI_MAJOR), abs=0.05)
    assert HERE.position(place)[2] == pytest.approx(DEPTH, abs=0.01)


def test_the_other_side_of_a_track():
    track = np.array([[0.0, 0.0, 0.0], [100.0, 100.0, 0.0], [200.0, 200.0, 0.0]])
    assert mirrored(track, np.array([30.0, -10.0, -50.0])) == pytest.approx([-10.0, 30.0, -50.0])


def test_the_scatter_of_most_is_their_standard_deviation():
    errors = 3.0 * np.random.default_rng(5).standard_normal(20_001)
    errors[:200] = 1e4  # it does not see a few that are far off
    assert scatter(np.abs(errors), 3) == pytest.approx(3.0, rel=0.03)


@pytest.mark.parametrize(("beyond", "is_out"), [(0.98, False), (1.02, True)])
def test_a_range_is_judged_by_its_residual_as_the_others_give_it(beyond, is_out):
    """Alone wrong by δ, it is off by δ√(1 - h) of the least scatter in the fit of all, and by
    δ/√(1 + h) of it in that of the others, h being its leverage in each."""
    count, odd = 8, 3
    limit = 1.0 - 0.5 * BY_CHANCE / count
    bearing, distance = np.linspace(0.0, 280.0, count), np.linspace(700.0, 2200.0, count)

    def judged(error, used):
        errors = np.where(np.arange(count) == odd, error, 0.0)
        found = survey(bearing, distance, errors)
        ships = HERE.place(found.latitude, found.longitude, np.full(count, TRANSDUCER))
        model = RangeModel(found, ONE, HERE, ships, None)
        x = model.least_squares(ANCHOR, used)
        return model.tested(x, used), model.jacobian(ANCHOR)

    every, others = np.full(count, True), np.arange(count) != odd
    _, slopes = judged(0.0, every)
    h = slopes[odd] @ np.linalg.inv(slopes.T @ slopes) @ slopes[odd]
    alone = beyond * student.ppf(limit, count - 3 - 1) * FLOOR / np.sqrt(1.0 - h)
    assert judged(alone, every)[0][odd] != is_out
    kept = slopes[others]
    h = slopes[odd] @ np.linalg.inv(kept.T @ kept) @ slopes[odd]
    back = beyond * student.ppf(limit, count - 1 - 3) * FLOOR * np.sqrt(1.0 + h)
    assert judged(back, others)[0][odd] != is_out


def test_the_mean_speed_of_sound_is_harmonic_over_every_level_between():
    """A minimum at 900 m and a kink at 2000 m; by midpoints of 0.1 m, good to 1e-9."""
    sound = Sound(
        np.array([0.0, 900.0, 2000.0, 5000.0]), np.array([1520.0, 1482.0, 1493.0, 1546.0])
    )
    for above, below in ((5.0, 4200.0), (5.0, 1500.0), (300.0, 700.0)):
        middle = np.arange(above, below, 0.1) + 0.05
        slowness = np.mean(1.0 / np.interp(middle, sound.depth, sound.speed))
        assert sound.mean(above, below) == pytest.approx(1.0 / slowness, rel=1e-8)


@pytest.mark.parametrize(("width", "straight"), [(0.0, True), (140.0, True), (160.0, False)])
def test_a_track_that_is_narrow_is_a_line(width, straight):
    """A rectangle of stations, 1000 m long: the limit is 0.15 of that."""
    corners = np.array([[x, y, 0.0] for x in (-500.0, 500.0) for y in (-0.5, 0.5)])
    turned = np.array(
        [[np.cos(0.7), np.sin(0.7), 0.0], [-np.sin(0.7), np.cos(0.7), 0.0], [0, 0, 1]]
    )
    assert is_line(corners * [1.0, width, 1.0] @ turned) is straight
