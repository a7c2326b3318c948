"""The limits as used: those of `checks:`, and those of components that the line sets higher."""

import pytest

import calm
from calm.checks.criterion import limit_value_text, limits_used

LINE = """
environment: {{depth: 100 m}}
line:
  - {{use: ball, label: float, {float}}}
  - {{use: thread, length: 50 m, clamps: [{{use: logger, at: 2 m, label: probe, {clamp}}}]}}
  - {{use: block}}
components:
  ball: {{kind: sphere, diameter: 1 m, buoyancy: 4 kN, breaking_load: 60 kN}}
  thread: {{kind: cable, diameter: 8 mm, weight: 1 N/m}}
  logger: {{kind: body, length: 0 m, buoyancy: 0 N, kn: 1 N/(m/s)^2, inclination: insensitive,
    depth_rating: 300 m, max_tilt: 20 deg, wind_area: 2 m^2}}
  block: {{kind: anchor, weight: 20 kN}}
"""


def departing(float="", clamp=""):
    file = calm.load("line.yaml", text=LINE.format(float=float, clamp=clamp)).file
    return [key for key in limits_used(file, surface=False) if key.departs]


def test_what_a_component_may_bear_beyond_its_definition_departs():
    (strength,) = departing(float="breaking_load: 90 kN")
    assert (strength.name, strength.value, strength.default) == ("breaking_load of float", 9e4, 6e4)
    assert strength.source == "the definition of ball"
    rating, tilt = departing(clamp="depth_rating: 1 km, max_tilt: 45 deg")
    assert (rating.name, rating.value, rating.default) == ("depth_rating of probe", 1000.0, 300.0)
    assert (tilt.name, tilt.value, tilt.default) == ("max_tilt of probe", 45.0, 20.0)


def test_what_flatters_departs():
    (lift,) = departing(float="buoyancy: 5 kN")
    assert (lift.name, lift.value, lift.default) == ("buoyancy of float", 5e3, 4e3)
    (drag,) = departing(clamp="kn: 0.5 N/(m/s)^2")
    assert (drag.name, drag.value, drag.default) == ("kn of probe", 0.5, 1.0)
    assert not lift.backed and not drag.backed
    (wind,) = departing(clamp="wind_area: 1 m^2")
    assert (wind.name, wind.value, wind.default) == ("wind_area of probe", 1.0, 2.0)
    (told,) = departing(float="buoyancy: 5 kN, sources: {buoyancy: weighed}")
    assert told.backed


def test_a_time_is_said_in_days():
    text = LINE.format(float="", clamp="") + "checks: {service_time: 1.5 d}\n"
    file = calm.load("line.yaml", text=text).file
    (time,) = [key for key in limits_used(file, surface=False) if key.name == "service_time"]
    assert (limit_value_text(time, time.value), limit_value_text(time, time.default)) == (
        "1.5 d",
        "365 d",
    )


def test_settings_that_flatter_depart():
    text = LINE.format(float="", clamp="").replace("length: 50 m", "length: 50 m, slack: allowed")
    text += "solver: {strumming: {factor: 1.2}, seabed_friction: 0.3}\n"
    file = calm.load("line.yaml", text=text).file
    keys = {key.name: key for key in limits_used(file, surface=False) if key.departs}
    strumming = keys.pop("solver.strumming.factor")
    assert (strumming.value, strumming.default) == (1.2, 1.5)
    assert limit_value_text(strumming, strumming.value) == "1.2"
    assert keys.pop("solver.seabed_friction").value == 0.3
    tension = keys.pop("minimum_tension of thread")
    assert (tension.value, tension.default) == (0.0, 500.0)
    assert not keys


@pytest.mark.parametrize(
    "given",
    [
        {},
        {"float": "breaking_load: 50 kN"},  # stricter
        {"float": "breaking_load: 60 kN"},
        {"float": "depth_rating: 500 m"},  # its definition gives none
    ],
)
def test_what_is_no_looser_does_not_depart(given):
    assert departing(**given) == []
