"""The rise of a line by hand, and the order in which its floats come up."""

from math import nan, sqrt
from types import SimpleNamespace

import numpy as np
import pytest

import calm
from calm.checks.handling import _hauled_in
from calm.checks.recovery import Recovery, recovery_of
from calm.shipped import shipped_folder
from calm.solve import Status, solve_rise

FILE = """
name: By hand
environment:
  depth: 500 m
line:
  - {use: ball, label: top}
  - {use: thin, length: 200 m}
  - {use: ball, label: back-up, buoyancy: 800 N, kn: 100 N/(m/s)^2}
  - {use: thin, length: 100 m}
  - {use: opener, label: release}
  - {use: thin, length: 50 m}
  - {use: block}
components:
  ball: {kind: body, length: 0 m, buoyancy: 2000 N, kn: 200 N/(m/s)^2, inclination: insensitive}
  opener: {kind: body, role: release, length: 0 m, buoyancy: -300 N, kn: 50 N/(m/s)^2, inclination: insensitive}
  thin: {kind: cable, diameter: 10 mm, weight: 1 N/m, ct: 0}
  block: {kind: anchor, weight: 5 kN}
"""  # noqa: E501


@pytest.fixture
def recovered(tmp_path):
    def of(text=FILE):
        path = tmp_path / "m.yaml"
        path.write_text(text)
        mooring = calm.load(path)
        return recovery_of(mooring.leg, mooring.solve().leg)

    return of


def test_speed_and_tensions(recovered):
    recovery = recovered()
    squared = 2200.0 / 350.0
    assert recovery.released == 4
    assert recovery.net_buoyancy == pytest.approx(2200.0)
    assert recovery.rise_speed == pytest.approx(sqrt(squared), rel=1e-8)
    assert recovery.time_to_surface == pytest.approx(150.0 / sqrt(squared))
    below = 2000.0 - 200.0 * squared
    lower = [below, below - 200.0, below + 600.0 - 100.0 * squared]
    lower += [lower[-1] - 100.0]
    assert recovery.tension_bottom[:4] == pytest.approx(lower)
    assert recovery.tension_top == pytest.approx([0.0, *lower, nan], nan_ok=True)
    assert recovery.tension_bottom[4] == pytest.approx(0.0, abs=1e-5)
    assert lower[-1] == pytest.approx(300.0 + 50.0 * squared)
    assert recovery.tangles == ()
    assert not recovery.in_still_water


def test_floats_arrive_one_after_the_other(recovered):
    """Below the top float 200 N are left on 150 N/(m/s)²; below the back-up nothing lifts."""
    recovery = recovered()
    first = 150.0 / sqrt(2200.0 / 350.0)
    second = first + 200.0 / sqrt(200.0 / 150.0)
    expected = [first, nan, second, nan, nan, nan]
    assert recovery.arrival == pytest.approx(expected, nan_ok=True)
    assert recovery.order == (0, 2)
    assert recovery.hangs_at == pytest.approx([0.0, 0.0, 0.0, 0.0, 100.0, 500.0])
    # a place on a rope hangs by the shorter way: the first rope is a bight between two floats
    assert [recovery.depth_at(1, share) for share in (0.25, 0.5, 0.75)] == pytest.approx(
        [50.0, 100.0, 50.0]
    )
    assert recovery.depth_at(3, 0.25) == pytest.approx(25.0)
    assert recovery.depth_at(5, 0.5) == pytest.approx(500.0)


def test_what_is_not_buoyant_by_itself_hangs_below_the_top_float(recovered):
    recovery = recovered(FILE.replace("buoyancy: 800 N", "buoyancy: 500 N"))
    assert recovery.order == (0,)
    assert np.isfinite(recovery.arrival).tolist() == [True] + [False] * 5
    assert recovery.hangs_at == pytest.approx([0.0, 0.0, 200.0, 200.0, 300.0, 500.0])


def test_without_a_release_all_above_the_anchor_rises(recovered):
    recovery = recovered(FILE.replace("role: release, ", ""))
    assert recovery.released == 5
    assert recovery.net_buoyancy == pytest.approx(2150.0)
    assert recovery.hangs_at[5] == pytest.approx(100.0)


def test_the_lower_of_two_releases_opens(recovered):
    text = FILE.replace("  - {use: block}", "  - {use: opener, label: second}\n  - {use: block}")
    assert recovered(text).released == 6


def test_a_buoyant_rope_is_up_when_its_lower_end_is(recovered):
    """Its end comes the 200 m up; a float below it follows over the 100 m between."""
    rope = "  - {use: thin, length: 200 m, weight: -2 N/m, diameter: 20 mm, ct: 0.01}"
    text = FILE.replace("  - {use: thin, length: 200 m}", rope)
    recovery = recovered(text)
    friction = 512.5 * np.pi * 0.02 * 0.01 * 200.0
    first = 150.0 / sqrt(2800.0 / (350.0 + friction))
    second = first + 200.0 / sqrt(800.0 / (150.0 + friction))
    assert recovery.order == (0, 1, 2)
    assert recovery.arrival[:3] == pytest.approx([first, second, second])


def test_a_beacon_comes_up_with_its_float(recovered):
    beacon = "line:\n  - {use: ball, label: beacon, buoyancy: -50 N, kn: 0 N/(m/s)^2}"
    recovery = recovered(FILE.replace("line:", beacon))
    assert recovery.order == (1, 3)
    assert recovery.arrival[0] == recovery.arrival[1] == recovery.time_to_surface


def test_a_bight_hangs_from_both_its_floats(recovered):
    meter = "  - {use: opener, label: meter, role: instrument, buoyancy: -10 N}"
    halves = f"  - {{use: thin, length: 140 m}}\n{meter}\n  - {{use: thin, length: 60 m}}"
    recovery = recovered(FILE.replace("  - {use: thin, length: 200 m}", halves))
    assert recovery.order == (0, 4)
    assert recovery.hangs_at[:5] == pytest.approx([0.0, 0.0, 60.0, 60.0, 0.0])


def test_a_line_that_is_too_heavy_stays(recovered):
    """18 m of the chain hang, the rest lies on the seabed."""
    chain = "{use: links, length: 40 m}\n  - {use: block}"
    links = "components:\n  links: {kind: chain, diameter: 40 mm, weight: 100 N/m}"
    text = FILE.replace("role: release, ", "").replace("components:", links)
    recovery = recovered(text.replace("{use: block}", chain))
    assert recovery.net_buoyancy == pytest.approx(2150.0 - 4000.0)
    assert (recovery.rise_speed, recovery.time_to_surface, recovery.order) == (0.0, None, ())
    for figures in (recovery.arrival, recovery.hangs_at, recovery.tension_top):
        assert np.isnan(figures).all()


def test_what_finds_no_motion_in_the_current_is_told_for_still_water(recovered, monkeypatch):
    def only_in_still_water(line, water, depth, settings):
        if water.moving:
            raise Status.NOT_CONVERGED.because("It tumbles.")
        return solve_rise(line, water, depth, settings)

    monkeypatch.setattr("calm.checks.recovery.solve_rise", only_in_still_water)
    moving = "depth: 500 m\n  current: {speed: 0.1 m/s, toward: 90 deg}"
    recovery = recovered(FILE.replace("depth: 500 m", moving))
    assert recovery.in_still_water
    assert recovery.rise_speed == pytest.approx(sqrt(2200.0 / 350.0), rel=1e-8)
    assert recovery.order == (0, 2)


def test_components_are_plain_figures(recovered):
    rows = recovered().components()
    assert [row["index"] for row in rows] == list(range(6))
    assert rows[5] == {
        "index": 5,
        "tension_top": None,
        "tension_bottom": None,
        "arrival": None,
        "depth": 500.0,
    }


def test_floats_at_the_surface_are_there_at_once():
    mooring = calm.load(shipped_folder("lines") / "taut-nylon-surface.yaml")
    recovery = recovery_of(mooring.leg, mooring.solve().leg)
    assert recovery.time_to_surface == 0.0
    assert recovery.order[0] == 0


def test_what_hangs_right_below_a_float_hangs_there_whatever_the_rounding():
    length = np.array([0.7, 0.1, 0.2, 50.0])  # whose sums and differences do not come out even
    none = np.full(5, np.nan)
    arrival = np.array([1.0, 1.0, 1.0, np.nan, np.nan])
    recovery = Recovery(
        3, 1.0, 1.0, 1.0, none, none, arrival, (0,), (), length=length, seabed=100.0
    )
    assert recovery.hangs_at == pytest.approx([0.0, 0.0, 0.0, 0.0, 100.0])
    assert recovery.depth_at(3, 0.5) == pytest.approx(25.0)


def test_minutes_until_what_is_hauled_in_comes_up():
    lowest = SimpleNamespace(label="releases", place=None)
    found = _hauled_in(lowest, 600.0, SimpleNamespace(rise_speed=1.0))
    assert "(releases) surfaces in 10 min" in found.message


def test_a_buoyant_rope_tail_comes_up_after_its_floats(recovered):
    """Between the last float and the end of the line nothing pulls along the rope."""
    rope = "  - {use: thin, length: 50 m, weight: -0.1 N/m, diameter: 13 mm, ct: 0.013}"
    text = FILE.replace("role: release, ", "").replace("-300 N", "-30 N")
    recovery = recovered(text.replace("  - {use: thin, length: 50 m}", rope))
    friction = 512.5 * np.pi * 0.013 * 0.013
    assert recovery.order == (0, 2)  # the opener is heavier than the tail is buoyant
    tail = text.replace("  - {use: opener, label: release}\n", "").replace(
        "  - {use: thin, length: 100 m}\n", ""
    )
    recovery = recovered(tail.replace("  - {use: thin, length: 50 m}", rope))
    assert recovery.order == (0, 2, 3)
    after = recovery.arrival[3] - recovery.arrival[2]
    assert after == pytest.approx(50.0 / sqrt(0.1 / friction))
