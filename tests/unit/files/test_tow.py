"""Tow files: what they resolve to, and every way they can be wrong."""

from collections.abc import Callable
from pathlib import Path

import pytest

from calm.errors import InputError
from calm.files import Cable, Cylinder, MooringFile

from .conftest import GOOD, TOW, Place

KNOT = 1852 / 3600

Read = Callable[..., MooringFile]
Mistakes = Callable[..., list[Place]]


def changed(old: str, new: str) -> str:
    assert TOW.count(old) == 1, old
    return TOW.replace(old, new)


FIT = changed("length: 100 m", "length: fit, body_depth: 70 m")


def test_a_tow(read: Read) -> None:
    file = read(TOW)
    assert file.tow is not None
    assert (file.tow.speed, file.tow.toward, file.tow.height) == (2 * KNOT, 90.0, 4.0)
    cable, fish = file.pieces
    assert [piece.index for piece in file.pieces] == [0, 1]
    assert isinstance(cable.component, Cable)
    assert (cable.length, cable.fit_top_depth, cable.fit_body_depth) == (100.0, None, None)
    [clamp] = cable.clamps
    assert isinstance(clamp.component, Cylinder)
    assert clamp.at == 90.0
    assert (fish.use, fish.label, fish.length) == ("plate", "fish", 0.4)


def test_a_mooring_is_no_tow(read: Read) -> None:
    assert read(GOOD).tow is None


def test_a_tow_without_an_environment_is_in_deep_still_water(read: Read) -> None:
    environment = read(TOW).environment
    assert (environment.name, environment.fluid, environment.depth) == (None, "water", None)
    assert environment.density == 1025.0
    current = environment.current
    assert (current.depth, current.u, current.v, current.w) == ((0.0,), (0.0,), (0.0,), (0.0,))


def test_the_height_of_the_sheave_is_optional(read: Read) -> None:
    tow = read(changed(", height: 4 m", "")).tow
    assert tow is not None
    assert tow.height == 0.0


def test_a_tow_in_a_current(read: Read) -> None:
    current = "current: {columns: [depth m, u m/s, v m/s], rows: [[0, 0.5, 0], [50, 0, 0.1]]}"
    environment = read(TOW + f"environment: {{depth: 200 m, {current}}}\n").environment
    assert environment.depth == 200.0
    assert environment.current.u == (0.5, 0.0)
    assert environment.current.v == (0.0, 0.1)


def test_variants_of_a_tow(read: Read, tmp_path: Path) -> None:
    text = TOW + "environments: {shelf: {depth: 90 m}}\n"
    assert read(text).environment.depth is None
    environment = read(text, "shelf").environment
    assert (environment.name, environment.depth) == ("shelf", 90.0)
    path = tmp_path / "bay.yaml"
    path.write_text("environment: {current: {speed: 1 m/s, toward: 0}}\n")
    environment = read(text, path).environment
    assert (environment.name, environment.depth, environment.current.v) == ("bay", None, (1.0,))


def test_a_cable_paid_out_to_a_depth(read: Read) -> None:
    cable, fish = read(FIT).pieces
    assert (cable.length, cable.fit_top_depth, cable.fit_body_depth) == (None, None, 70.0)
    assert cable.clamps[0].at == 90.0
    assert fish.fit_body_depth is None


def test_pieces_of_a_tow_may_follow_one_another_in_any_number(read: Read) -> None:
    text = TOW + "  - {use: rope-16, length: 20 m}\n  - {use: ball, count: 2}\n  - {use: chain-13, "
    file = read(text + "length: 2 m}\n")
    assert [piece.label for piece in file.pieces] == [
        "rope-12", "fish", "rope-16", "ball 1", "ball 2", "chain-13",
    ]  # fmt: skip


@pytest.mark.parametrize("line", ["  - {use: rope-12, length: 9 m}\n", "  - {use: plate}\n"])
def test_a_bare_cable_and_a_body_alone(read: Read, line: str) -> None:
    assert len(read(TOW[: TOW.index("  - {use: rope-12")] + line).pieces) == 1


def test_limits_of_moorings_are_of_no_account(read: Read) -> None:
    assert read(TOW + "checks: {maximum_knockdown: 20 m}\n").checks.maximum_knockdown == 20.0


ONE_MISTAKE = {
    "speed missing": (
        changed("speed: 2 knot, ", ""),
        (2, 6, "`speed` is missing"),
    ),
    "direction missing": (
        changed(", toward: 90 deg", ""),
        (2, 6, "`toward` is missing"),
    ),
    "no speed": (
        changed("2 knot", "0"),
        (2, 14, "`speed: 0` must be more than 0 m/s"),
    ),
    "astern": (
        changed("2 knot", "-2 knot"),
        (2, 14, "`speed: -2 knot` must be more than 0 m/s"),
    ),
    "speed without a unit": (
        changed("2 knot", "2"),
        (2, 14, "`speed: 2` needs a unit; did you mean `speed: 2 m/s`?"),
    ),
    "under water": (
        changed("height: 4 m", "height: -4 m"),
        (2, 46, "`height: -4 m` must be at least 0 m"),
    ),
    "key misspelt": (
        changed("height: 4 m", "hight: 4 m"),
        (2, 38, "unknown key `hight`; did you mean `height`?"),
    ),
    "nothing": (
        changed(" {speed: 2 knot, toward: 90 deg, height: 4 m}", ""),
        (2, 1, "`tow` has no value"),
    ),
    "a speed alone": (
        changed("{speed: 2 knot, toward: 90 deg, height: 4 m}", "2 knot"),
        (2, 6, "`tow` must hold `key: value` entries, as `tow: {speed: 4 knot, toward: 90 deg}`"),
    ),
    "an anchor": (
        TOW + "  - {use: deadweight}\n",
        (6, 5, "`deadweight` is an anchor, but the line of a tow ends at the towed body"),
    ),
    "an anchor in between": (
        changed("{use: plate, label: fish}", "{use: deadweight}\n  - {use: plate}"),
        (5, 5, "`deadweight` is an anchor, but the line of a tow ends at the towed body"),
    ),
    "a mooring towed": (
        GOOD + "tow: {speed: 1 m/s, toward: 0}\n",
        (13, 5, "`deadweight` is an anchor, but the line of a tow ends at the towed body"),
    ),
    "no line": (
        TOW[: TOW.index("line:")],
        (1, 1, "`line` is missing"),
    ),
    "line empty": (
        TOW[: TOW.index("line:")] + "line: []\n",
        (3, 7, "`line` is empty"),
    ),
    "fit without a depth": (
        changed("100 m", "fit"),
        (4, 5, "`body_depth` is missing: `length: fit` needs a depth"),
    ),
    "fit to the depth of a top": (
        changed("100 m", "fit, top_depth: 70 m"),
        (4, 33, "`top_depth` is only for moorings; use `body_depth` here"),
    ),
    "fit to both": (
        changed("100 m", "fit, body_depth: 70 m, top_depth: 1 m"),
        (4, 51, "`top_depth` is only for moorings; use `body_depth` here"),
    ),
    "fit of a top in a mooring": (
        GOOD.replace("480 m", "fit, body_depth: 70 m"),
        (11, 33, "`body_depth` is only for tows; use `top_depth` here"),
    ),
    "depth of a body in a mooring": (
        GOOD.replace("{use: plate}", "{use: plate, body_depth: 70 m}"),
        (12, 18, "`body_depth` is only for tows; use `top_depth` here"),
    ),
    "depth without fit": (
        changed("100 m", "100 m, body_depth: 70 m"),
        (4, 35, "`body_depth` is only for `length: fit`"),
    ),
    "depth of a rigid piece": (
        changed("label: fish", "body_depth: 70 m"),
        (5, 18, "`body_depth` is only for `length: fit`"),
    ),
    "depth misspelt": (
        changed("100 m", "fit, body_dept: 70 m"),
        (4, 33, "unknown key `body_dept` for kind cable; did you mean `body_depth`?"),
    ),
    "depth above the water": (
        changed("100 m", "fit, body_depth: -1 m"),
        (4, 45, "`body_depth: -1 m` must be at least 0 m"),
    ),
    "depth below the seabed": (
        FIT + "environment: {depth: 70 m}\n",
        (4, 5, "`body_depth` must not be below the seabed, which is 70 m deep"),
    ),
    "depth of the ship": (
        FIT.replace("70 m", "0").replace(", height: 4 m", ""),
        (4, 5, "`body_depth` must be below the tow point, which is 0 m above the water"),
    ),
    "two fits": (
        FIT + "  - {use: rope-16, length: fit, body_depth: 80 m}\n",
        (6, 5, "only one piece can be cut to fit; the file already has one, on its line 4"),
    ),
    "clamp beyond its piece": (
        changed("at: 90 m", "at: 101 m"),
        (4, 61, "`at: 101 m` is beyond the end of the piece, which is 100 m long"),
    ),
    "environment empty": (
        TOW + "environment:\n",
        (6, 1, "`environment` has no value"),
    ),
    "no depth at all": (
        TOW + "environment: {depth: 0 m}\n",
        (6, 22, "`depth: 0 m` must be more than 0 m"),
    ),
}


@pytest.mark.parametrize(("text", "mistake"), ONE_MISTAKE.values(), ids=ONE_MISTAKE.keys())
def test_one_mistake(mistakes: Mistakes, text: str, mistake: Place) -> None:
    assert mistakes(text) == [mistake]


def test_a_mooring_still_needs_its_anchor_depth_and_environment(mistakes: Mistakes) -> None:
    line = GOOD[GOOD.index("line:") : GOOD.index("  - {use: deadweight}")]
    assert mistakes("environment: {}\n" + line) == [
        (1, 14, "`depth` is missing"),
        (2, 1, "the line has no anchor; its last item must be one (`kind: anchor`)"),
    ]
    assert mistakes(line)[0] == (1, 1, "`environment` is missing")


def test_all_mistakes_at_once(mistakes: Mistakes) -> None:
    text = """\
tow: {toward: 90, height: 4}
environment:
  depth: 50
  fluid: mud
line:
  - {use: rope-12, length: fit, top_depth: 7 m, clamps: [{use: metre, at: 1}]}
  - {use: deadweight}
environments:
  storm: {curent: {speed: 1 m/s, toward: 90 deg}}
solver: {strumming: {factor: 0}, friction: pode, drag: reynold}
"""
    assert [place[:2] for place in mistakes(text)] == [
        (1, 6),
        (1, 15),
        (1, 27),
        (3, 10),
        (4, 10),
        (6, 33),
        (6, 64),
        (6, 75),
        (7, 5),
        (9, 11),
        (10, 30),
        (10, 44),
        (10, 56),
    ]


HELICOPTER = """\
tow: {speed: 40 knot, toward: 0, height: 60 m}
environment: {fluid: air}
line:
  - {use: wire, length: 30 m, clamps: [{use: beacon, at: 1 m}]}
  - {use: bird}
components:
  wire: {kind: cable, diameter: 5 mm, mass: 0.09 kg/m}
  bird: {kind: body, length: 1 m, mass: 60 kg, kn: 1 N/(m/s)^2, kt: 1 N/(m/s)^2}
  beacon: {kind: sphere, diameter: 10 cm, mass: 1 kg}
"""

G = 9.80665
AIR = 1.225


def test_in_air_a_mass_is_enough(read: Read) -> None:
    file = read(HELICOPTER)
    assert (file.environment.fluid, file.environment.density) == ("air", AIR)
    wire, bird = file.pieces
    beacon = wire.clamps[0]
    for part, mass in ((wire, 0.09), (bird, 60.0), (beacon, 1.0)):
        # One product and its rounding.
        assert part.component.net_buoyancy == pytest.approx(-mass * G, rel=1e-15)
        assert part.component.displaced_volume is None
    assert file.notices == ()


@pytest.mark.parametrize(
    ("definition", "mass", "volume"),
    [
        ("kind: cable, diameter: 5 mm, mass: 0.1 kg/m, density: 1380 kg/m^3", 0.1, 0.1 / 1380),
        ("kind: cable, diameter: 5 mm, mass: 0.1 kg/m, weight: 0.4 N/m", 0.1, None),
        ("kind: chain, diameter: 10 mm", 1.99, 1.99 / 7850),
        ("kind: chain, diameter: 10 mm, mass: 2.2 kg/m", 2.2, 2.2 / 7850),
    ],
)
def test_in_air_what_is_known_in_water_weighs_its_mass(
    read: Read, definition: str, mass: float, volume: float | None
) -> None:
    wire = "kind: cable, diameter: 5 mm, mass: 0.09 kg/m"
    file = read(HELICOPTER.replace(wire, definition))
    component = file.pieces[0].component
    displaced = component.displaced_volume
    assert displaced is not None
    if volume is not None:
        assert displaced == pytest.approx(volume, rel=1e-13)
    in_air = component.net_buoyancy + (AIR - 1025.0) * G * displaced
    # Forces of a thousand times the density of air cancel: three digits are lost.
    assert in_air == pytest.approx(-mass * G + AIR * G * displaced, rel=1e-12)
    assert file.notices == ()


def test_in_air_a_net_force_in_water_has_to_do_for_a_mass(read: Read) -> None:
    text = HELICOPTER.replace("mass: 0.09 kg/m", "weight: 0.7 N/m").replace(
        "mass: 60 kg", "buoyancy: -500 N"
    )
    text = text.replace("  - {use: bird}\n", "  - {use: bird, count: 2}\n  - {use: bird}\n")
    file = read(text)
    assert file.pieces[0].component.net_buoyancy == -0.7
    assert file.pieces[1].component.net_buoyancy == -500.0
    assert file.notices == (
        "wire: the mass is unknown; the net force in water is used as weight in air",
        "bird: the mass is unknown; the net force in water is used as weight in air",
    )


def test_in_air_a_mass_can_be_given_on_the_line(read: Read) -> None:
    text = HELICOPTER.replace("mass: 60 kg", "buoyancy: -500 N")
    file = read(text.replace("{use: bird}", "{use: bird, mass: 70 kg}"))
    component = file.pieces[1].component
    assert component.displaced_volume is not None
    in_air = component.net_buoyancy - 1025.0 * G * component.displaced_volume
    # What it displaces follows from the net force in water, and goes again: in vacuo it is -m g.
    assert in_air == pytest.approx(-70.0 * G, rel=1e-14)
    assert file.notices == ()


def test_in_air_the_end_may_be_above_the_water(read: Read, mistakes: Mistakes) -> None:
    text = HELICOPTER.replace("length: 30 m", "length: fit, body_depth: -40 m")
    assert read(text).pieces[0].fit_body_depth == -40.0
    assert mistakes(text.replace("-40 m", "-60 m")) == [
        (4, 5, "`body_depth` must be below the tow point, which is 60 m above the water")
    ]


def test_a_variant_may_be_in_air(read: Read) -> None:
    text = HELICOPTER.replace("environment: {fluid: air}", "environments: {air: {fluid: air}}")
    assert read(text, "air").pieces[1].component.net_buoyancy == -60 * G
    with pytest.raises(InputError, match="needs `buoyancy`, or `mass` with `volume`"):
        read(text)


@pytest.mark.parametrize(
    ("old", "new", "place"),
    [
        ("mass: 0.09 kg/m", "cn: 1.2", (7, 9, "needs `mass`, or `weight`")),
        ("mass: 0.09 kg/m", "density: 1 t/m^3", (7, 9, "needs `mass`, or `weight`")),
        ("mass: 60 kg, ", "", (8, 9, "needs `mass`, or `buoyancy`")),
        ("mass: 1 kg", "volume: 1 L", (9, 11, "needs `mass`, or `buoyancy`")),
    ],
)
def test_in_air_a_weight_is_needed(mistakes: Mistakes, old: str, new: str, place: Place) -> None:
    assert mistakes(HELICOPTER.replace(old, new)) == [place]


def test_in_water_a_mass_is_not_enough(mistakes: Mistakes) -> None:
    assert mistakes(HELICOPTER.replace("fluid: air", "fluid: water")) == [
        (7, 9, "needs `weight` or `buoyancy` in water, or `mass` with `density`"),
        (8, 9, "needs `buoyancy`, or `mass` with `volume`"),
        (9, 11, "needs `buoyancy`, or `mass` with `volume`"),
    ]


def test_a_mooring_stands_in_water(mistakes: Mistakes) -> None:
    text = GOOD.replace("  depth:", "  fluid: air\n  depth:")
    assert mistakes(text) == [(3, 10, "`fluid: air` is only for tows; a mooring must be in water")]
