"""Nets in still water, as MoorPy 1.3 solves them: files of points and lines, which CALM reads.

MoorPy joins elastic catenaries by closed forms and balances the points to 1e-8 m; its figures here
are what it printed for the same files. Asked for is 1e-4 of every length and force: CALM cuts
lines until it expects 5e-5 of itself. Weights count as in water, no end is above it.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from calm.case import load
from calm.exchange.importing import import_file
from tests.moordyn_text import moordyn

TWICE_TIED = moordyn(
    """\
1     Fixed       0     0     -200   0      0       0      0
2     Fixed       100   0     -200   0      0       0      0
3     Free        50    0     -100   0      0       0      0
4     Free        50    0     -60    100    0.6     0.5    0
5     Free        50    0     -160   300    0.05    0.2    0
6     Vessel      100   50    -10    0      0       0      0
""",
    """\
1    rope       1        3        120       10       p
2    rope       3        2        120       10       p
3    rope       3        4        40        10       p
4    rope       3        5        60        10       p
5    rope       4        6        90        10       p
""",
)
CATENARY = moordyn(
    """\
1     Fixed       500   0     -200   0      0       0      0
2     Vessel      0     0     -14    0      0       0      0
""",
    "1    chain      1        2        560       40       p\n",
)
BRIDLE = moordyn(
    """\
1     Fixed       500   0     -200   0      0       0      0
2     Free        60    0     -40    0      0       0      0
3     Vessel      5     15    -14    0      0       0      0
4     Vessel      5     -15   -14    0      0       0      0
""",
    """\
1    chain      1        2        520       40       p
2    chain      2        3        50        10       p
3    chain      2        4        50        10       p
""",
)
SHARED = moordyn(
    """\
1     Fixed       -100  0     -200   0      0       0      0
2     Free        0     0     -50    500    2       0      0
3     Free        100   0     -50    500    2       0      0
4     Fixed       200   30    -200   0      0       0      0
""",
    """\
1    rope       1        2        180       20       p
2    rope       2        3        110       20       p
3    rope       3        4        180       20       p
""",
)


@pytest.fixture
def solved(tmp_path: Path) -> Any:
    def solve(text: str) -> Any:
        path = tmp_path / "net.txt"
        path.write_text(text)
        net = load(path, text=import_file(path, tmp_path / "net.yaml").text)
        return net.solve()

    return solve


def pulls(loads: Any) -> list[list[float]]:
    return [[load.horizontal, load.vertical] for load in loads]


def test_two_anchors_a_float_a_weight_that_hangs_and_a_tie(solved: Any) -> None:
    net = solved(TWICE_TIED)
    (node,) = net.nodes
    assert [node.x, node.y, node.depth] == pytest.approx([50.03962, 3.4178, 90.98639], rel=1e-4)
    assert np.array(pulls(net.anchors)) == pytest.approx(
        np.array([[480.16462, 887.041], [414.57542, 747.005]]), rel=1e-4
    )
    assert pulls(net.held)[0] == pytest.approx([89.47173, -194.766], rel=1e-4)


def test_a_chain_that_lies_on_the_seabed(solved: Any) -> None:
    net = solved(CATENARY)
    assert pulls(net.held)[0] == pytest.approx([59525.688, -70569.047], rel=1e-4)
    assert net.anchors[0].grounded_length == pytest.approx(160.07695, rel=1e-4)


def test_a_bridle(solved: Any) -> None:
    net = solved(BRIDLE)
    (node,) = net.nodes
    assert [node.x, node.depth] == pytest.approx([30.92974, 54.00536], rel=1e-4)
    assert net.anchors[0].tension == pytest.approx(39059.525, rel=1e-4)
    assert net.anchors[0].grounded_length == pytest.approx(226.92660, rel=1e-4)
    for end in net.held:
        assert [end.horizontal, end.vertical] == pytest.approx([22562.128, -34680.191], rel=1e-4)


def test_two_floats_that_share_a_line(solved: Any) -> None:
    """One leg goes on over the second float to its anchor."""
    net = solved(SHARED)
    (node,) = net.nodes
    assert [node.x, node.y, node.depth] == pytest.approx([-4.9752, 9.50248, 45.5784], rel=1e-4)
    other = next(row for row in net.components if row.use == "point-3")
    assert [other.x_top, other.y_top, other.depth_top] == pytest.approx(
        [104.9752, 20.49752, 45.5784], rel=1e-4
    )
    assert np.array(pulls(net.anchors)) == pytest.approx(
        np.array([[9158.37457, 14564.643]] * 2), rel=1e-4
    )
