"""Growth on a component: what it adds to areas and weights, by hand."""

from math import pi

import pytest

import calm
from calm.assemble import drag_of, net_buoyancy
from calm.checks.growth import grown, grown_component
from calm.files import Anchor, Body, Cable, Chain, Cylinder, Fouling, Sphere

G = 9.80665
THICK = 0.02


def growth(density=None):
    return Fouling.model_validate(
        {"depth": "50 m", "thickness": "20 mm"}
        | ({} if density is None else {"density": f"{density} kg/m^3"})
    )


SPHERE = Sphere.model_validate(
    {"kind": "sphere", "diameter": "1 m", "mass": "200 kg", "buoyancy": "3 kN"}
)
CYLINDER = Cylinder.model_validate(
    {"kind": "cylinder", "diameter": "10 cm", "length": "50 cm", "buoyancy": "-20 N"}
)
BODY = Body.model_validate(
    {"kind": "body", "length": "1 m", "buoyancy": "500 N", "drag_area": "0.5 m^2", "cd": "1.2"}
)
MOUNTED = Body.model_validate(
    {
        "kind": "body",
        "length": "1 m",
        "buoyancy": "0 N",
        "kn": "100 N/(m/s)^2",
        "kt": "50 N/(m/s)^2",
    }
)
CHAIN = Chain.model_validate({"kind": "chain", "diameter": "13 mm"})
CABLE = Cable.model_validate({"kind": "cable", "diameter": "8 mm", "weight": "1.6 N/m"})

WIDE_BODY = (4.0 * 0.5 / pi) ** 0.5  # of its area
WIDE_MOUNTED = (4.0 * 100.0 / 512.5 / pi) ** 0.5  # of the area that a coefficient of 1 gives


@pytest.mark.parametrize(
    ("component", "across", "along", "volume"),
    [
        (SPHERE, 1.04**2, 1.04**2, pi / 6.0 * (1.04**3 - 1.0)),
        (CYLINDER, 0.14 * 0.54 / 0.05, 1.4**2, pi / 4.0 * (0.14**2 * 0.54 - 0.1**2 * 0.5)),
        (
            BODY,
            (1.0 + 0.04 / WIDE_BODY) ** 2,
            (1.0 + 0.04 / WIDE_BODY) ** 2,
            pi / 6.0 * ((WIDE_BODY + 0.04) ** 3 - WIDE_BODY**3),
        ),
        (
            MOUNTED,
            (1.0 + 0.04 / WIDE_MOUNTED) ** 2,
            (1.0 + 0.04 / WIDE_MOUNTED) ** 2,
            pi / 6.0 * ((WIDE_MOUNTED + 0.04) ** 3 - WIDE_MOUNTED**3),
        ),
        (
            CHAIN,
            53.0 / 13.0,
            53.0 / 13.0,
            pi / 4.0 * ((1.8 * 0.013 + 0.04) ** 2 - (1.8 * 0.013) ** 2),
        ),
        (CABLE, 48.0 / 8.0, 48.0 / 8.0, pi / 4.0 * (0.048**2 - 0.008**2)),
    ],
    ids=["sphere", "cylinder", "body", "kn and kt", "chain", "cable"],
)
def test_drags_grow_as_their_areas_and_weight_as_the_volume(component, across, along, volume):
    kn, kt, directional = drag_of(component)
    light = grown_component(component, growth(), G)
    assert drag_of(light) == (
        pytest.approx(across * kn),
        pytest.approx(along * kt),
        directional,
    )
    assert net_buoyancy(light, G) == net_buoyancy(component, G)  # as heavy as water
    heavy = grown_component(component, growth(1325), G)
    assert drag_of(heavy) == drag_of(light)
    weight = (1325.0 - 1025.0) * G * volume
    assert net_buoyancy(heavy, G) == pytest.approx(net_buoyancy(component, G) - weight)
    if component.mass is not None:
        assert heavy.mass == pytest.approx(component.mass + 1325.0 * volume)
    before = component.displaced_volume
    if before is not None:
        assert heavy.displaced_volume == pytest.approx(before + volume)


def test_an_anchor_stays_as_it_is():
    anchor = Anchor.model_validate({"kind": "anchor", "weight": "5 kN"})
    assert grown_component(anchor, growth(1325), G) is anchor


def test_a_body_without_drag_has_no_size_to_grow():
    bare = Body.model_validate(
        {"kind": "body", "length": "0 m", "buoyancy": "5 N", "kn": "0 N/(m/s)^2",
         "inclination": "insensitive"}
    )  # fmt: skip
    assert drag_of(grown_component(bare, growth(1325), G))[0] == 0.0


FOULED = """
environment: {depth: 120 m, current: {speed: 0.8 m/s, toward: 90 deg}}
line:
  - {use: ball}
  - {use: thin, length: 100 m, clamps: [{use: cell, at: 10 m}, {use: cell, at: 40 m}]}
  - {use: block}
components:
  ball: {kind: sphere, diameter: 1 m, buoyancy: 2000 N}
  thin: {kind: cable, diameter: 8 mm, weight: 1 N/m}
  cell: {kind: cylinder, diameter: 10 cm, length: 50 cm, buoyancy: -20 N}
  block: {kind: anchor, weight: 20 kN}
"""


def test_growth_reaches_down_to_a_depth_in_still_water(tmp_path):
    """The wire hangs from 20 m there, whatever the current does: 30 m of it are above 50 m."""
    (tmp_path / "m.yaml").write_text(FOULED)
    result = calm.load(tmp_path / "m.yaml").solve()
    assert result.top.knockdown > 1.0
    ball, upper, lower, block = grown(result.file.pieces, result, growth())
    assert (upper.length, lower.length) == (pytest.approx(30.0), pytest.approx(70.0))
    assert (upper.component.diameter, lower.component.diameter) == (0.048, 0.008)
    (high,), (low,) = upper.clamps, lower.clamps
    assert (high.at, low.at) == (10.0, pytest.approx(10.0))
    assert (high.component.cn or 0.0) > 0.0 and low.component.cn is None
    assert ball.component.cx > 0.5 and block.component.kind == "anchor"
