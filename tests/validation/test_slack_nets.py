"""Surface buoys on several chains, in a current that slackens lee legs.

Those of the folder `nets` are a draw that an earlier solver refused or solved in one frame alone.
Their nodes and slack lengths were found by another way to a slack leg: it hangs free, cut at the
length that hangs, which turns of the whole solution settle. Asked for is 1e-4 of the depth.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from calm.case import Design, load
from calm.solve.net import NetSolution
from tests.validation.surface_nets import SurfaceNet, surface_net

NETS = Path(__file__).parent / "nets"
TURN = 1.1
TURNED = np.array([[np.cos(TURN), -np.sin(TURN)], [np.sin(TURN), np.cos(TURN)]])
MIRRORED = TURNED @ np.diag([1.0, -1.0])
AS_IT_IS = np.eye(2)


def read(path: Path | str, text: str | None = None) -> Design:
    net = load(path, text=text)
    return net


@pytest.mark.parametrize(
    ("name", "node", "slack"),
    [
        ("net9_current", (-240.5013, 567.0598, -77.9770), {"a4": 132.74}),
        ("net25_still", (-0.2862, -0.8978, -4.1304), {}),
        ("net44_still", (5.6021, -1.2761, -4.8100), {"a5": 2.96}),
        *(
            pytest.param(*each, marks=pytest.mark.thorough)
            for each in (
                ("net14_current", (-121.6698, -212.6569, -75.7025), {"a0": 422.39}),
                ("net23_current", (6.3538, 45.3311, -10.1430), {"a2": 20.02}),
                ("net28_current", (-50.3526, 68.2040, -90.5099), {"a1": 81.13}),
                ("net44_current", (6.3852, 2.4176, -4.6598), {"a1": 6.83}),
            )
        ),
    ],
)
def test_nets_that_were_refused(
    name: str, node: tuple[float, float, float], slack: dict[str, float]
) -> None:
    net = read(NETS / f"{name}.yaml")
    result = net.solve()
    near = 1e-4 * net.water.depth
    (at,) = result.nodes
    assert (at.x, at.y, -at.depth) == pytest.approx(node, abs=near)
    found = {end.leg: end.slack_length for end in result.anchors if end.slack_length > 0.0}
    assert found == {leg: pytest.approx(length, abs=near + 0.005) for leg, length in slack.items()}
    told = [said for said in result.warnings if " is slack: " in said]
    assert [said.split(" is slack: ")[0] for said in told] == [f"Leg {leg}" for leg in slack]
    for end in result.anchors:
        if end.leg in slack:
            assert (end.tension, end.horizontal, end.required_weight) == (0.0, 0.0, 0.0)


def test_what_is_said_of_a_slack_leg() -> None:
    said = read(NETS / "net14_current.yaml").solve().warnings
    expected = (
        "Leg a0 is slack: the chain on the seabed is 422.4 m longer than the distance from the "
        "touchdown point to the anchor."
    )
    assert expected in said


def test_a_clump_drifts_over_the_seabed() -> None:
    """It was said to sink: its chain weighs more than the buoy lifts, but lies on the seabed."""
    result = read(NETS / "net35_current.yaml").solve()
    assert result.status == "converged"
    assert max(leg.closure for leg in result.legs) < 1e-8


def test_a_float_of_no_length_is_as_good_as_another() -> None:
    """It stretches its soft line up to the surface."""
    text = (NETS / "float_of_no_length.yaml").read_text()
    none = read("none.yaml", text).standing
    long = read(
        "long.yaml", text.replace("length: 0 m, buoyancy: 27", "length: 1.5 m, buoyancy: 27")
    )
    assert none.nodes == pytest.approx(long.standing.nodes, abs=2.0)
    short = read("s.yaml", text.replace("length: 0 m, buoyancy: 27", "length: 1 mm, buoyancy: 27"))
    assert none.nodes == pytest.approx(short.standing.nodes, abs=0.02)


CHAINS = """\
environment: {{depth: 8 m, current: {{speed: {speed} m/s, toward: {toward} deg}}}}
components:
  buoy: {{kind: body, length: 0.5 m, buoyancy: 3 kN, kn: 100 N/(m/s)^2, inclination: insensitive}}
  chain: {{kind: chain, diameter: 16 mm, weight: 48 N/m}}
  block: {{kind: anchor, weight: 30 kN, length: 0 m}}
legs:
  float: {{line: [{{use: buoy}}], bottom: {{join: A}}}}
"""
CHAIN = """\
  {leg}:
    line: [{{use: chain, length: 50 m}}, {{use: block}}]
    top: {{join: A}}
    bottom: {{anchor: {{at: [{at[0]} m, {at[1]} m]}}}}
"""
ANCHORS = np.array([(25.0, 0.0), (-12.0, 22.0), (-12.0, -22.0)])


def farthest(way: np.ndarray, reach: float) -> np.ndarray:
    """The place farthest along a way of those that are within a reach of every anchor."""
    places = [at + reach * way for at in ANCHORS]
    for first, second in ((0, 1), (1, 2), (2, 0)):
        apart = ANCHORS[second] - ANCHORS[first]
        aside = np.array([-apart[1], apart[0]]) / np.hypot(*apart)
        high = np.sqrt(reach**2 - 0.25 * apart @ apart)
        places += [ANCHORS[first] + 0.5 * apart + side * high * aside for side in (1.0, -1.0)]
    near = [p for p in places if np.hypot(*(p - ANCHORS).T).max() <= reach * (1.0 + 1e-9)]
    return max(near, key=lambda place: float(place @ way))


@pytest.mark.parametrize(
    ("speed", "toward"),
    [
        (0.1, 17.0),
        pytest.param(0.05, 77.0, marks=pytest.mark.thorough),
        pytest.param(0.015, 17.0, marks=pytest.mark.thorough),
        (0.015, 200.0),
    ],
)
def test_a_weak_current_carries_a_buoy_on_slack_chains_as_far_as_they_reach(
    speed: float, toward: float
) -> None:
    """Where chain hangs plumb 42.5 m of 50 m lie, and hold what drifts within that of the anchor.

    Drag bends a chain by a few times H/w, 2 cm at 0.1 m/s, and where two bear it each by more.
    """
    legs = "".join(CHAIN.format(leg=f"a{i}", at=at) for i, at in enumerate(ANCHORS))
    net = read("chains.yaml", CHAINS.format(speed=speed, toward=toward) + legs)
    (at,) = net.solve().nodes
    way = np.array([np.sin(np.radians(toward)), np.cos(np.radians(toward))])
    drag = 100.0 * speed**2 + 1025.0 * 0.016 * 7.5 * speed**2 * 1.4
    a = 2.0 * drag / 48.0
    bent = a * np.arccosh(1.0 + 7.5 / a) - np.sqrt(7.5**2 + 2.0 * 7.5 * a) + 7.5
    assert (at.x, at.y) == pytest.approx(farthest(way, 42.5), abs=4.0 * bent + 1e-3)


def of_images(net: SurfaceNet) -> list[tuple[np.ndarray, SurfaceNet]]:
    return [
        (TURNED, net.placed(TURNED)), (MIRRORED, net.placed(MIRRORED)), (AS_IT_IS, net.reordered()),
    ]  # fmt: skip


def found_alike(net: SurfaceNet) -> NetSolution:
    """The solution of a net, which is that of its images."""
    solution = read("net.yaml", net.text).standing
    for matrix, image in of_images(net):
        other = read("image.yaml", image.text).standing
        place = np.array(other.nodes[0])
        place[:2] = matrix.T @ place[:2]
        assert place == pytest.approx(solution.nodes[0], abs=1e-7 * net.depth)
    return solution


def test_a_net_with_a_slack_leg_is_the_same_in_every_frame_and_order() -> None:
    assert [leg.slack > 0.0 for leg in found_alike(surface_net(24)).legs].count(True) > 0


@pytest.mark.thorough
@pytest.mark.parametrize("number", range(80))
def test_nets_are_the_same_in_every_frame_and_order(number: int) -> None:
    found_alike(surface_net(number))


@pytest.mark.parametrize(
    "name", ["net9_current", pytest.param("net44_current", marks=pytest.mark.thorough)]
)
def test_a_batch_solves_slack_legs_as_a_run_does(name: str) -> None:
    from calm.batch.net_profiles import NetProfiles

    net = read(NETS / f"{name}.yaml")
    profiles, water = NetProfiles(net), net.water
    shares = np.array([[1.0], [0.7], [0.4]])
    u, v = shares * water.u, shares * water.v
    status = np.zeros(3, np.int8)
    found = profiles.solve((np.array([water.level]), u, v, 0.0 * u), status, 1)
    assert not status.any()
    first = [leg.first for leg in net.file.legs]
    for case in range(3):
        columns = tuple(map(tuple, (water.level, u[case], v[case], 0.0 * u[case])))
        alone = net.together(profiles.water(*columns))
        assert case > 0 or any(leg.slack > 0.0 for leg in alone.legs)
        near = 1e-4 * water.depth
        for leg, row in zip(alone.legs, first, strict=True):
            expected = leg.position[0] * [1.0, 1.0, -1.0]
            place = [found[name][case, row] for name in ("x_top", "y_top", "depth_top")]
            assert place == pytest.approx(expected, abs=near)
        greatest = max(float(leg.tension.max()) for leg in alone.legs)
        tops = [float(leg.tension[0]) for leg in alone.legs]
        assert found["tension_top"][case, first] == pytest.approx(tops, abs=2e-4 * greatest)
        ends = [float(np.hypot(*leg.force[-1, :2])) for leg in alone.legs[1:]]
        assert found["anchor_horizontal"][case, 1:] == pytest.approx(ends, abs=2e-4 * greatest)
