"""Newton's method on small systems."""

import numpy as np
import pytest

from calm.physics.line import MarchError
from calm.solve.free_search import system_root


def circle_and_line(x):
    return np.array([x[0] ** 2 + x[1] ** 2 - 4.0, x[0] - x[1]])


def test_a_root_is_found():
    root, slopes = system_root(circle_and_line, np.array([3.0, 0.5]), 1e-12)
    assert root == pytest.approx(np.sqrt([2.0, 2.0]), abs=1e-11)
    assert slopes[1] == pytest.approx([1.0, -1.0])


def test_slopes_of_nearly_the_same_system_spare_the_differences():
    asked = []

    def system(x):
        asked.append(x)
        return circle_and_line(x)

    _, slopes = system_root(system, np.array([1.5, 1.4]), 1e-3)
    first, near = len(asked), asked[-1]
    asked.clear()
    root, _ = system_root(system, near, 1e-12, slopes)
    assert root == pytest.approx(np.sqrt([2.0, 2.0]), abs=1e-11)
    assert len(asked) < first
    asked.clear()
    wrong, _ = system_root(system, near, 1e-12, -slopes)
    assert wrong == pytest.approx(root, abs=1e-11)


def test_the_start_is_the_root_where_it_is_one():
    start = np.sqrt([2.0, 2.0])
    assert system_root(circle_and_line, start, 1e-9)[0] is start


def test_a_step_too_long_is_shortened():
    """Newton's own steps from 3 run away to infinity."""
    root, _ = system_root(np.arctan, np.array([3.0]), 1e-12)
    assert root == pytest.approx([0.0], abs=1e-11)


def test_where_the_march_stops_there_is_no_going():
    def fenced(x):
        if x[0] > 1.2:
            raise MarchError("beyond the fence")
        return np.sqrt(2.0 - x) - 1.0

    assert system_root(fenced, np.array([-3.0]), 1e-12)[0] == pytest.approx([1.0], abs=1e-11)
    assert system_root(fenced, np.array([1.5]), 1e-12) is None


def test_no_root_is_told():
    assert system_root(lambda x: x**2 + 1.0, np.array([1.0]), 1e-12) is None
    assert system_root(lambda x: np.ones(1), np.array([1.0]), 1e-12) is None
