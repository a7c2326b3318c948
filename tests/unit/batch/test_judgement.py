"""How often rules fail in a batch, by hand."""

import numpy as np
import pytest

from calm.batch.statistics.summary import summarize
from tests.unit.batch.made_result import made_mooring, make_result


@pytest.fixture(scope="module")
def mooring(tmp_path_factory):
    return made_mooring(tmp_path_factory.mktemp("made"))


def test_shares_of_limits_and_rules_by_hand(mooring):
    # the meter leans 1 … 100 degrees (20 are allowed, 10 warn), the rope below it bears too much
    # in the first 5 profiles, the top is knocked down by more than 30 m in the last 3
    ramp = np.arange(1.0, 101.0)
    tilt, tension = np.ones((100, 5)), np.full((100, 5), 5000.0)
    tilt[:, 2] = ramp
    tension[:5, 3] = 10001.0
    summary = summarize(
        make_result(
            100, tilt=tilt, tension_top=tension, tension_bottom=tension,
            knockdown=np.where(ramp > 97.0, 31.0, 30.0), depth_top=119.0 + 0.02 * ramp,
            anchor_vertical=3000.0 + 0.0 * ramp, anchor_horizontal=ramp * 20.0,
        ),
        mooring,
    )  # fmt: skip
    rules = {rule.name: rule for rule in summary.rules}
    assert (rules["tilt"].fails, rules["tilt"].warns) == (0.80, 0.10)
    labelled = ((one, one.limit.criterion.part.label) for one in rules["tilt"].exceedances)
    failing, warning = (one for one, label in labelled if label == "meter")
    assert (failing.share, failing.worst) == (0.80, 100.0)
    assert failing.time == np.datetime64("2001-01-05T03:00")
    assert warning.share == 0.90
    assert rules["strength"].fails == 0.05
    assert rules["strength"].unknown == 1  # the meter; sphere and anchor are asked for no load
    assert rules["knockdown"].fails == 0.03
    # 119 + 0.02 k beyond 150 - 30 from the 51st on; of the loggers and the meter nothing is known
    assert rules["depth-rating"].fails == 0.50
    assert rules["depth-rating"].unknown == 3
    # 9000 ≥ 1.5 (3000 + 20 k / 0.6) up to k = 90, and the slide is the same rule
    assert rules["anchor-weight"].fails == rules["anchor-sliding"].fails == 0.10
    assert rules["anchor-uplift"].fails == 0.0
    assert rules["slack"].fails == 0.0
    assert {rule.judged for rule in summary.rules} == {100}
    assert "reserve" not in rules


def test_shares_are_of_the_profiles_solved(mooring):
    summary = summarize(
        make_result(10, status=[0, 1] * 5, knockdown=[40.0, 0.0, 0.0, 0.0, 0.0] * 2), mooring
    )
    knockdown = next(rule for rule in summary.rules if rule.name == "knockdown")
    assert knockdown.exceedances[0].count == knockdown.judged == 5
    assert knockdown.fails == pytest.approx(0.2)
    assert knockdown.fails_at_most == pytest.approx(0.6)  # with the five that were not solved
    equilibrium = summary.rules[0]
    assert (equilibrium.name, equilibrium.judged, equilibrium.fails) == ("equilibrium", 10, 0.5)


def test_what_has_no_data_is_in_no_share(mooring):
    ended = [0, 0, 0, 1, 3, 3]  # three solved, one without equilibrium, two without a current
    summary = summarize(make_result(6, status=ended, knockdown=[40.0] + [0.0] * 5), mooring)
    rules = {rule.name: rule for rule in summary.rules}
    assert rules["equilibrium"].fails == rules["equilibrium"].fails_at_most == 0.25
    assert rules["knockdown"].fails == pytest.approx(1.0 / 3.0)
    assert rules["knockdown"].fails_at_most == 0.5


def test_what_did_not_converge_is_not_known_to_lack_an_equilibrium(mooring):
    made = make_result(10, status=[0] * 6 + [1] + [2] * 3)
    made["status"].attrs["flag_meanings"] = "converged no-equilibrium not-converged no-current"
    summary = summarize(made, mooring)
    assert summary.unsolved == 4
    equilibrium = summary.rules[0]
    assert (equilibrium.judged, equilibrium.fails) == (7, pytest.approx(1.0 / 7.0))
    assert equilibrium.fails_at_most == 0.4


def test_nothing_solved_is_said(mooring):
    summary = summarize(make_result(5, status=[1] * 5), mooring)
    assert summary.solved == 0
    assert all(part.tension is None for part in summary.parts)
    assert all(response.distribution is None for response in summary.responses)
    assert summary.worst["knockdown"] == ()
    assert (summary.rules[0].fails, summary.rules[0].fails_at_most) == (1.0, 1.0)
    for rule in summary.rules[1:]:
        assert rule.fails is rule.fails_at_most is rule.warns is None
        assert (rule.judged, rule.unknown) == (0, len(rule.exceedances))


def test_a_rule_is_judged_in_the_profiles_in_which_one_of_its_limits_is(mooring):
    # the rope lies on the seabed in half of the profiles, the wire in a quarter of them
    depth, tension = np.full((100, 5), 100.0), np.full((100, 5), 5000.0)
    depth[:50, 3], depth[:25, 1] = 300.0, 300.0
    tension[80:, 3] = 0.0
    summary = summarize(
        make_result(100, depth_top=depth, tension_top=tension, tension_bottom=tension), mooring
    )
    slack = next(rule for rule in summary.rules if rule.name == "slack")
    assert [one.count for one in slack.exceedances] == [75, 50]
    assert slack.judged == 75
    assert slack.fails == pytest.approx(20.0 / 75.0)
