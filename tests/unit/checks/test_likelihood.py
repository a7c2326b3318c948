"""Probability of breaking a limit: against lines whose limit is passed at a known draw."""

from math import erf, sqrt

import pytest

import calm
from calm.case.draws import CAUSES
from calm.checks.assess import HANDLED, with_probabilities

pytestmark = pytest.mark.thorough

PLUMB = """
name: {name}
environment: {{depth: 500 m}}
line:
  - {{use: ball, label: top float}}
  - {{use: thread, length: {length} m}}
  - {{use: opener, label: release}}
  - {{use: block, label: anchor}}
uncertainty: {{{unsure}}}
checks: {{minimum_top_depth: 90 m}}
components:
  ball: {{kind: sphere, diameter: 1 m, buoyancy: 4 kN, depth_rating: 600 m, breaking_load: 100 kN}}
  thread: {{kind: cable, diameter: 8 mm, weight: 1 N/m, stiffness: 200 kN, breaking_load: 100 kN}}
  opener: {{kind: body, role: release, length: 0 m, buoyancy: 0 N, kn: 1 N/(m/s)^2,
    inclination: insensitive, breaking_load: 100 kN}}
  block: {{kind: anchor, weight: {weight}, kt: 100 N/(m/s)^2}}
"""


def judged(name="Plumb", length=400, weight="20 kN", samples=256, **unsure):
    """The assessment of an upright line; nothing is unsure but what is named."""
    said = ", ".join(
        f"{key}: {value}" for key, value in (dict.fromkeys(CAUSES, 0) | unsure).items()
    )
    text = PLUMB.format(name=name, length=length, weight=weight, unsure=said)
    mooring = calm.load("plumb.yaml", text=text)
    return with_probabilities(calm.check(mooring), samples, 0)


def probability(assessment, rule, component):
    (found,) = [
        one
        for one in assessment.all_findings()
        if (one.rule, one.component, one.situation) == (rule, component, "as given")
    ]
    return found.probability


def beyond(deviations):
    """The probability that a normal is beyond so many deviations."""
    return 0.5 * (1.0 - erf(deviations / sqrt(2.0)))


EVEN = 8e-3
"""Of a share of 256 points of a Sobol' sequence: a few of them."""


def test_an_anchor_is_too_light_where_the_float_lifts_more():
    # needed: 1.5 (4000 b - 400) N; 6 kN is passed at b = 1.1, one deviation
    found = judged(weight="6 kN", buoyancy="10 %")
    assert probability(found, "anchor-weight", "anchor") == pytest.approx(beyond(1.0), abs=EVEN)
    assert probability(found, "depth-rating", "top float") == 0.0
    assert found.draws == (256, 0)


def test_the_top_is_too_shallow_where_the_water_is():
    # upright at 500 - 400 - stretch 7.6 m; 90 m is reached 2.4 m shallower, of 5 m a deviation
    found = judged(depth="1 %")
    (result,) = [stand.result for stand in found.in_environments]
    deviations = (result.top.depth - 90.0) / 5.0
    assert 0.2 < deviations < 0.7
    assert probability(found, "top-depth", "top float") == pytest.approx(
        beyond(deviations), abs=EVEN
    )


def test_a_sample_without_equilibrium_breaks_every_limit():
    # the anchor is lifted at 4000 b - 400 > 4000, b > 1.1
    found = judged(weight="4 kN", buoyancy="10 %")
    assert probability(found, "top-depth", "top float") == pytest.approx(beyond(1.0), abs=EVEN)
    assert probability(found, "depth-rating", "top float") == pytest.approx(beyond(1.0), abs=EVEN)
    assert probability(found, "anchor-weight", "anchor") > 0.99


def test_what_is_judged_once_is_counted_in_the_first_samples():
    found = judged(weight="20 kN", buoyancy="20 %")
    once = [one for one in found.findings if one.limit is not None]
    assert {one.rule for one in once} >= {"recovery", "launch-strength"}
    assert all((one.probability * HANDLED).is_integer() for one in once)


def test_what_has_no_limit_has_no_probability():
    found = judged(buoyancy="2 %", samples=64)
    for one in found.all_findings():
        assert (one.probability is None) == (one.limit is None)


def test_the_order_and_the_share_of_the_blocks_change_nothing():
    shared = []

    def mapped(function, tasks):
        shared.append(len(tasks))
        return [function(task) for task in tasks]

    found = judged(buoyancy="10 %", weight="6 kN")
    again = with_probabilities(found, 256, 0, mapped)
    assert [one.probability for one in again.all_findings()] == [
        one.probability for one in found.all_findings()
    ]
    assert max(shared) == 8
