"""Nets of WHOI Cable: branch.cbl, multi_leg.cbl and multi_leg_3d.cbl of its examples.

Lengths, diameters, weights and coefficients are those of the files (2.0 of the program), EI and the
added mass left out; the current is 0.2 m/s along x, sea water of 1027 kg/m³, g 9.81 m/s². The
figures expected are of an independent finite-element solver on meshes fine enough that they do not
change any more: places to the last digit given, anchors to 0.1 N. (WHOI's own output at its shipped
tolerance is wrong by up to 5 kN in a leg.)

Coefficients of drag are given for 1025 kg/m³ and scale with the density, as those of a catalogue.
"""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from calm.case import Result, load
from calm.exchange.importing import import_file
from calm.solve.leg_layout import LegEnd, NetLeg
from calm.solve.net import solve_net
from tests.unit.solve.nets import Point, Wire, anchored, line_of, water_of

DENSITY, GRAVITY = 1027.0, 9.81
SPHERE = Point(1590 * 4.448 + 6000, 48 * 0.0254, 0.8)
SHACKLE = Point(-4.45 * 4.448 * 0.8667, 0.168, 0.5)
SINKER = Point(-(20.0 - DENSITY * np.pi / 6 * 0.1524**3) * GRAVITY, 0.1524, 1.0)
FREE = LegEnd()


def node(number: int) -> LegEnd:
    return LegEnd(node=number)


def above(place: np.ndarray, depth: float) -> list[float]:
    """Along x, and above the seabed [m]."""
    return [place[0], place[2] + depth]


def test_branch() -> None:
    """A horizontal array between two moorings, with two strings that hang from it."""
    depth = 70.0
    legs = [
        NetLeg(line_of(SPHERE, Wire(50.0)), node(0), anchored(0.0, 0.0, depth)),
        NetLeg(line_of(Wire(20.0)), node(0), node(1)),
        NetLeg(line_of(SHACKLE, Wire(20.0), SHACKLE, Wire(10.0), SINKER), node(1), FREE),
        NetLeg(line_of(Wire(20.0)), node(1), node(2)),
        NetLeg(line_of(SHACKLE, Wire(20.0), SINKER), node(2), FREE),
        NetLeg(line_of(Wire(20.0)), node(2), node(3)),
        NetLeg(line_of(SPHERE, Wire(50.0)), node(3), anchored(120.0, 0.0, depth)),
    ]
    net = solve_net(legs, 4, water_of(depth, (0.0, 0.2, 0.0), density=DENSITY))
    places = [above(at, depth) for at in net.nodes]
    expected = [[30.011, 40.201], [50.040, 39.531], [70.080, 39.591], [90.108, 40.290]]
    assert np.array(places) == pytest.approx(np.array(expected), abs=6e-4)
    ends = [above(net.legs[i].position[0], depth) for i in (2, 4)]
    assert np.array(ends) == pytest.approx(np.array([[50.679, 9.538], [70.408, 19.593]]), abs=6e-4)
    first, last = net.legs[0].force[-1], net.legs[6].force[-1]
    assert [abs(first[0]), first[2]] == pytest.approx([9456.2, 12592.6], abs=0.1)
    assert [abs(last[0]), last[2]] == pytest.approx([9384.5, 12591.4], abs=0.1)


def test_multi_leg() -> None:
    """A sphere on three legs, the middle one shorter than the water below it is deep."""
    depth = 44.0
    legs = [
        NetLeg(line_of(SPHERE, Wire(50.0)), node(0), anchored(0.0, 0.0, depth)),
        NetLeg(line_of(Wire(40.0)), node(0), anchored(30.0, 0.0, depth)),
        NetLeg(line_of(Wire(50.0)), node(0), anchored(60.0, 0.0, depth)),
    ]
    net = solve_net(legs, 1, water_of(depth, (0.0, 0.2, 0.0), density=DENSITY))
    assert above(net.nodes[0], depth) == pytest.approx([30.0002, 40.0537], abs=6e-5)
    pulls = [leg.tension[-1] for leg in net.legs]
    assert pulls == pytest.approx([4085.8, 6254.6, 4029.9], abs=0.3)


def test_multi_leg_3d() -> None:
    """A sphere on four legs in a square."""
    depth = 44.0
    corners = [(-30.0, -30.0), (30.0, -30.0), (-30.0, 30.0), (30.0, 30.0)]
    legs = [
        NetLeg(
            line_of(*([SPHERE] if i == 0 else []), Wire(50.0)), node(0), anchored(*corner, depth)
        )
        for i, corner in enumerate(corners)
    ]
    net = solve_net(legs, 1, water_of(depth, (0.0, 0.2, 0.0), density=DENSITY))
    assert [*net.nodes[0, :2], net.nodes[0, 2] + depth] == pytest.approx(
        [0.0002, 0.0, 26.5772], abs=6e-5
    )
    pulls = [leg.tension[-1] for leg in net.legs]
    assert pulls == pytest.approx([6011.55, 5982.06, 6011.55, 5982.06], abs=0.02)


HEAD = """\
Problem Description
    title = "net"  type = {kind}
Environment
    rho = 1027  gravity = 9.81  x-current = 0.2  depth = {depth}
Buoys
    sinker  type = sphere  d = 6*0.0254  m = 20  Cdn = 1.0
Anchors
    clump
Connectors
    ball  d = 48*0.0254  wet = -1590*4.448 - 6000  Cdn = 0.8  m = 690/2.2
    joint  d = 0.168  wet = 4.45*4.448*.8667  Cdn = 0.5  m = 4.45/2.205
Materials
    wire  EA = 4.7e6  m = 0.320  wet = 2.64  d = 0.01  Cdt = 0.01  Cdn = 1.5
Layout
"""


def wire(length: float) -> str:
    return f"segment = {{ length = {length}  material = wire  nodes = (5, 1.0) }}\n"


def clump(x: float, y: float = 0.0) -> str:
    return f"terminal = {{ anchor = clump  x = {x}  y = {y}  z = 0.0 }}\n"


BALL, JOINT = "connector = ball\n", "connector = joint\n"
SUSPENDED = "terminal = { buoy = sinker }\n"


@pytest.fixture
def imported(tmp_path: Path) -> Callable[[str, float, str], Result]:
    def solve(kind: str, depth: float, layout: str) -> Result:
        path = tmp_path / "net.cbl"
        path.write_text(HEAD.format(kind=kind, depth=depth) + layout + "End\n")
        net = load(path, text=import_file(path, tmp_path / "net.yaml").text)
        return net.solve()

    return solve


def heights(net: Result, depth: float) -> np.ndarray:
    return np.array([[node.x, depth - node.depth] for node in net.nodes])


def test_branch_as_a_file(imported: Callable[[str, float, str], Result]) -> None:
    """The first sphere is a piece of the leg that stands; of the other nodes each has a branch.

    Figures and tolerances as above.
    """
    layout = (
        clump(0.0) + wire(50) + BALL + wire(20) + JOINT
        + "branch = {\n" + wire(20) + JOINT + wire(10) + SUSPENDED + "}\n"
        + wire(20) + JOINT + "branch = {\n" + wire(20) + SUSPENDED + "}\n"
        + wire(20) + BALL + wire(50) + clump(120.0)
    )  # fmt: skip
    net = imported("horizontal", 70.0, layout)
    assert len(net.legs) == 5
    assert heights(net, 70.0) == pytest.approx(
        np.array([[50.040, 39.531], [70.080, 39.591]]), abs=6e-4
    )
    balls = [(row.x_top, 70.0 - row.depth_top) for row in net.components if row.use == "ball"]
    assert np.array(balls) == pytest.approx(
        np.array([[30.011, 40.201], [90.108, 40.290]]), abs=6e-4
    )
    pulls = [[anchor.horizontal, anchor.vertical] for anchor in net.anchors]
    assert np.array(pulls) == pytest.approx(
        np.array([[9456.2, 12592.6], [9384.5, 12591.4]]), abs=0.1
    )


@pytest.mark.thorough
def test_multi_leg_as_a_file(imported: Callable[[str, float, str], Result]) -> None:
    branch = "branch = {\n" + wire(40) + clump(30.0) + "}\n"
    layout = clump(0.0) + wire(50) + BALL + branch + wire(50) + clump(60.0)
    net = imported("positioned", 44.0, layout)
    assert heights(net, 44.0)[0] == pytest.approx([30.0002, 40.0537], abs=6e-5)
    pulls = [anchor.tension for anchor in net.anchors]
    assert pulls == pytest.approx([4085.8, 6254.6, 4029.9], abs=0.3)


@pytest.mark.thorough
def test_multi_leg_3d_as_a_file(imported: Callable[[str, float, str], Result]) -> None:
    branches = "".join(
        "branch = {\n" + wire(50) + clump(x, y) + "}\n" for x, y in ((30, -30), (-30, 30))
    )
    layout = clump(-30.0, -30.0) + wire(50) + BALL + branches + wire(50) + clump(30.0, 30.0)
    net = imported("horizontal", 44.0, layout)
    assert heights(net, 44.0)[0] == pytest.approx([0.0002, 26.5772], abs=6e-5)
    pulls = [anchor.tension for anchor in net.anchors]
    assert pulls == pytest.approx([6011.55, 5982.06, 6011.55, 5982.06], abs=0.02)
