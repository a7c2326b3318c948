"""The two root finders: they find the root, in few calls, and say when there is none."""

from math import atan, exp, tanh

import pytest

from calm.solve.least_change import bracketed_root, root_near


class Counted:
    def __init__(self, function):
        self.function, self.calls = function, 0

    def __call__(self, _, x):
        self.calls += 1
        return self.function(x)


FUNCTIONS = [
    (lambda x: 1.0 - x, 0.0, 5.0, 1.0, 1),
    (lambda x: 0.3 - x**3, 0.0, 1.0, 0.3 ** (1 / 3), 12),
    (lambda x: exp(-8 * x) - 0.01, 0.0, 3.0, 0.5756462732485114, 16),
    (lambda x: -tanh(1e6 * (x - 0.2)), 0.0, 1.0, 0.2, 40),  # almost a jump
    (lambda x: -atan(x - 0.7), -40.0, 50.0, 0.7, 12),
]


@pytest.mark.parametrize(("function", "a", "b", "root", "calls"), FUNCTIONS)
def test_a_bracketed_root_is_found_in_few_calls(function, a, b, root, calls):
    counted = Counted(function)
    x, value, _ = bracketed_root(
        counted, None, a, function(a), b, function(b), small=1e-13, narrow=1e-14
    )
    assert x == pytest.approx(root, abs=1e-10)
    assert value == function(x)
    assert counted.calls <= calls


def test_a_jump_closes_the_bracket_and_shows_its_value():
    """No root: the caller sees from the value that the closing condition is not met."""
    x, value, _ = bracketed_root(
        lambda _, x: 1.0 if x < 1 / 3 else -1.0, None, 0.0, 1.0, 1.0, -1.0, 1e-9, 1e-15
    )
    assert x == pytest.approx(1 / 3, abs=1e-12)
    assert abs(value) == 1.0


def test_a_root_at_the_end_of_the_bracket():
    assert bracketed_root(lambda _, x: -x, None, 0.0, 0.0, 1.0, -1.0, 0.0, 0.0)[0] == 0.0


def test_near_a_good_estimate_three_calls_do():
    counted = Counted(lambda x: 2.0 - x - 0.01 * x**2)
    found, x, value, slope = root_near(counted, None, 1.95, -1.04, 0, 100, 1e-10, 1e-12)
    assert found
    assert abs(value) <= 1e-10
    assert x == pytest.approx(1.9619, abs=1e-3)
    assert slope == pytest.approx(-1.0392, abs=1e-3)
    assert counted.calls <= 4


def test_near_a_bad_estimate_the_steps_widen_until_the_sign_changes():
    found, x, _, _ = root_near(lambda _, x: 60.0 - x, None, 0.001, -1e9, 0, 100, 1e-9, 1e-12)
    assert found
    assert x == pytest.approx(60)


def test_no_sign_change_within_the_limits_is_none():
    found, *_ = root_near(lambda _, x: 1.0 + x, None, 0.5, -1.0, 0, 1, 1e-9, 1e-12)
    assert not found
