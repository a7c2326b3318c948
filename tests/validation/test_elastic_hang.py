"""C15: a 19 mm nylon rope hanging 1000 m, EA = 97 817.4 N (3.45e8 Pa on its section).

Submerged weight 0.3 N/m, load at the lower end 2000 N: elongation (2000 L + 0.3 L²/2)/EA =
21.97973 m, printed to 1e-5 m. The stretch of a segment is that of its mean tension, and tension
falls linearly along a hanging rope, so CALM is exact to rounding whatever its angle step.
"""

from __future__ import annotations

import pytest

from calm.solve import solve_mooring
from tests.validation.closing import solve_continuous
from tests.validation.pieces import Piece, line_of, point, stream

LINE = line_of(point(2300.0, 0.0), Piece(1000.0, True, -0.3, compliance=1.0 / 97817.4))
SEA = stream(1100.0, 0.0)


def test_calm() -> None:
    solution = solve_mooring(LINE, SEA)
    top, bottom = solution.position[0], solution.position[-1]
    assert top[2] - bottom[2] == pytest.approx(1021.97973, abs=1e-5)
    assert top[2] - bottom[2] - 1000.0 == pytest.approx(2_150_000.0 / 97817.4, rel=1e-6)
    assert solution.force[-1] == pytest.approx([0.0, 0.0, 2000.0], abs=1e-6)


def test_referee() -> None:
    shape = solve_continuous(LINE, SEA).shape
    assert shape.top[0, 2] - shape.bottom[-1, 2] == pytest.approx(1021.97973, abs=1e-5)
