"""What several explanations come to together, and which are tried, by their laws written out."""

from types import SimpleNamespace

import numpy as np
import pytest

from calm.motion import common_unknowns
from calm.motion.currents_law import ReadCurrents
from calm.motion.estimate import Mixture, Posterior, _odds, _sets

GROUP = np.array([0, 1])


def way(u):
    u = np.full((2, 2), u)
    return ReadCurrents(np.tile([10.0, 90.0], (2, 1)), u, 0.5 * u, np.zeros((2, 2, 2)))


def found(evidence, depth, variance, current, logs):
    times = len(evidence)
    depth, none = np.tile(depth, (times, 1)), np.zeros((times, 1, 1))
    return Posterior(
        np.tile(logs, (times, 1)), np.full(times, current), depth, np.full_like(depth, variance),
        np.array(evidence), none[:, :, 0], none, np.full(times, current),
    )  # fmt: skip


def test_mean_and_deviation_are_those_of_all_explanations_by_their_weights():
    first = found([-1.0, -2.0], [100.0, 150.0], 1.0, 0.1, [0.1, 0.2])
    mixture = Mixture(SimpleNamespace(group=GROUP, groups=2), way(0.4), first)
    one = np.array([1])  # a second explanation of the second time only, and one that fails
    other = found([-1.5], [110.0, 151.0], 4.0, -0.3, [0.3, -0.2])
    mixture.add(
        one, ReadCurrents(*(x[:1] for x in vars(way(0.8)).values())), other, np.array([0.2]), (1,)
    )
    lost = found([np.nan, np.nan], [np.nan, np.nan], np.nan, np.nan, [np.nan, np.nan])
    mixture.add(np.arange(2), way(0.1), lost, np.zeros(2), (0,))
    assert mixture.best == pytest.approx([-1.0, -1.3])
    all_of = mixture.estimate()
    assert all_of.depth[0] == pytest.approx([100.0, 150.0])
    assert all_of.deviation[0] == pytest.approx([1.0, 1.0])
    share = np.exp(-1.3) / (np.exp(-1.3) + np.exp(-2.0))
    mean = np.array([100.0 + 10.0 * share, 150.0 + share])
    apart = np.array([10.0, 1.0]) ** 2 * share * (1.0 - share)
    assert all_of.depth[1] == pytest.approx(mean)
    assert all_of.deviation[1] == pytest.approx(np.sqrt(1.0 + 3.0 * share + apart))
    assert all_of.sea == pytest.approx([0.1, 0.1 - 0.4 * share])
    assert all_of.current == pytest.approx(np.exp([0.1, 0.1 - 0.4 * share]))
    assert all_of.doubt == pytest.approx(np.array([[0.0, 0.0], [0.0, share]]))
    # the likeliest reading of the currents has the factors of its explanation
    u = np.array([0.4 * np.exp([0.1, 0.2]), 0.8 * np.exp([0.3, -0.2])])
    assert all_of.likely.u == pytest.approx(u)
    assert all_of.likely.v == pytest.approx(0.5 * u)


def test_the_odds_of_a_false_current_are_those_of_its_flag():
    flag = np.array([[1, 3, 4], [2, 9, 1]], np.int8)
    u = np.array([[0.1, 0.2, 0.3], [0.1, 0.2, np.nan]])
    measured = SimpleNamespace(u=u, v=0.0 * u, flag=flag, time=np.zeros(2))
    odds = _odds(SimpleNamespace(measured=measured, groups=2, group=np.array([0, 1, 1])))
    mean = 0.5 * (common_unknowns.FALSE[3] + common_unknowns.FALSE[4])
    assert odds[0] == pytest.approx([np.log(0.01 / 0.99), np.log(mean / (1.0 - mean))])
    assert odds[1] == pytest.approx([np.log(0.03 / 0.97), np.log(0.30 / 0.70)])


def test_one_group_or_two_are_taken_for_false_never_all():
    sets = [[*each] for each in _sets(3)]
    assert sets == [[()], [(0,), (1,), (2,)], [(0, 1), (0, 2), (1, 2)]]
    assert [[*each] for each in _sets(2)] == [[()], [(0,), (1,)]]
    assert [[*each] for each in _sets(1)] == [[()]]
