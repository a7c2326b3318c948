"""What is taken from neighbours."""

import numpy as np
import pytest

from calm.motion.line_response import filled

LEVEL = np.array([0.0, 100.0, 200.0, 300.0])


def test_levels_are_linear_between_the_others_and_constant_beyond():
    known = np.array([[False, True, False, True]])
    found = filled(LEVEL[None], np.array([[9.0, 1.0, 9.0, 3.0]]), known)
    assert found == pytest.approx(np.array([[1.0, 1.0, 2.0, 3.0]]))
