"""Masses and weights of what comes to the deck."""

from dataclasses import replace

import pytest

import calm
from calm.checks.inventory import anchor_dry_mass, inventory_of, total_of

FILE = """
name: By hand
environment:
  depth: 500 m
  gravity: 9.81 m/s^2
line:
  - {use: ball, label: top}
  - {use: thin, label: wire, length: 200 m, clamps: [{use: logger, at: 10 m}, {use: logger, at: 20 m}]}
  - {use: bare, label: unknown wire, length: 10 m}
  - {use: meter}
  - {use: links, length: 4 m}
  - {use: block}
components:
  ball: {kind: sphere, name: Ball, role: float, diameter: 1 m, buoyancy: 3000 N, volume: 0.5 m^3}
  thin: {kind: cable, diameter: 8 mm, weight: 1 N/m, mass: 0.2 kg/m}
  bare: {kind: cable, diameter: 8 mm, weight: 1 N/m}
  meter: {kind: cylinder, diameter: 0.1 m, length: 1 m, mass: 20 kg, volume: 0.01 m^3}
  logger: {kind: cylinder, diameter: 50 mm, length: 0.3 m, mass: 2 kg, buoyancy: -12 N}
  links: {kind: chain, diameter: 13 mm}
  block: {kind: anchor, weight: 20 kN, length: 0.5 m}
"""  # noqa: E501


@pytest.fixture
def inventory(tmp_path):
    def of(text=FILE):
        path = tmp_path / "m.yaml"
        path.write_text(text)
        return inventory_of(calm.load(path).leg)

    return of


def test_every_piece_and_clamp_is_an_item(inventory):
    items = inventory()
    assert [item.label for item in items] == [
        "top", "wire", "logger 1", "logger 2", "unknown wire", "meter", "links", "block",
    ]  # fmt: skip
    assert [item.index for item in items] == [0, 1, 1, 1, 2, 3, 4, 5]
    assert [item.clamped_on for item in items] == [None, None, "wire", "wire", *[None] * 4]
    assert items[0].name == "Ball"
    assert items[0].role == "float"
    assert items[0].kind == "sphere"
    assert items[1].use == "thin"
    lengths = [1.0, 200.0, 0.3, 0.3, 10.0, 1.0, 4.0, 0.5]
    assert [item.cut_length for item in items] == pytest.approx(lengths)


def test_masses_are_given_or_follow(inventory):
    """Of the ball from volume and lift, of chain from its bar, of the anchor from steel."""
    ball = 1025.0 * 0.5 - 3000.0 / 9.80665
    chain = 19.9e3 * 0.013**2 * 4.0
    anchor = 20e3 / 9.80665 / (1.0 - 1025.0 / 7850.0)
    expected = [ball, 40.0, 2.0, 2.0, None, 20.0, chain, anchor]
    for item, mass in zip(inventory(), expected, strict=True):
        assert item.dry_mass == (None if mass is None else pytest.approx(mass))


def test_the_density_of_a_rope_gives_its_mass(inventory):
    rope = FILE.replace("length: 10 m", "length: 10 m, density: 1380 kg/m^3")
    mass = 10.0 / 9.80665 / (1.0 - 1025.0 / 1380.0)
    assert inventory(rope)[4].dry_mass == pytest.approx(mass)
    impossible = FILE.replace("length: 10 m", "length: 10 m, density: 900 kg/m^3")
    assert inventory(impossible)[4].dry_mass is None


def test_weights_in_water(inventory):
    """As given, or that of the masses under the gravity of the file."""
    meter = (20.0 - 10.25) * 9.81
    chain = 19.9e3 * 0.013**2 * 4.0 * (1.0 - 1025.0 / 7850.0) * 9.81
    expected = [-3000.0, 200.0, 12.0, 12.0, 10.0, meter, chain, 20e3]
    assert [item.wet_weight for item in inventory()] == pytest.approx(expected)


def test_a_lift_is_a_piece_with_its_clamps(inventory):
    items = inventory()
    assert items[1].lift_mass == pytest.approx(44.0)
    assert items[2].lift_mass is None
    assert items[4].lift_mass is None
    assert items[5].lift_mass == pytest.approx(20.0)


def test_a_piece_cut_to_fit_has_its_cut_length(inventory):
    fit = FILE.replace("label: wire, length: 200 m", "label: wire, length: fit, top_depth: 100 m")
    wire = inventory(fit)[1]
    assert wire.cut_length == pytest.approx(500.0 - 100.0 - 1.0 - 10.0 - 1.0 - 4.0 - 0.5)
    assert wire.dry_mass == pytest.approx(0.2 * wire.cut_length)
    none = inventory(fit.replace("top_depth: 100 m", "top_depth: 499 m"))[1]
    assert (none.cut_length, none.dry_mass, none.wet_weight, none.lift_mass) == (None,) * 4


def test_an_anchor_of_steel_and_of_concrete():
    """1 - 1025/7850 = 0.869 and 1 - 1025/2400 = 0.573."""
    steel, concrete = anchor_dry_mass(9806.65, 1025.0, 9.80665)
    assert steel == pytest.approx(1000.0 / 0.869, rel=1e-3)
    assert concrete == pytest.approx(1000.0 / 0.573, rel=1e-3)


def test_a_total_says_how_much_it_lacks(inventory):
    items = inventory()
    total = total_of(items)
    known = [item.dry_mass for item in items if item.dry_mass is not None]
    assert total.dry_mass == pytest.approx(sum(known))
    assert total.missing_masses == len(items) - len(known)
    assert total.wet_weight == pytest.approx(sum(item.wet_weight for item in items))
    assert total.missing_weights == 0
    unknown = replace(items[0], dry_mass=None, wet_weight=None)
    less = total_of([unknown, *items[1:]])
    assert less.dry_mass == pytest.approx(total.dry_mass - (items[0].dry_mass or 0.0))
    assert (less.missing_masses > 0, less.missing_weights) == (True, 1)
