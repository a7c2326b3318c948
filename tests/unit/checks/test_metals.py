"""Metals that touch: neighbours down the line, and clamps only if they are of metal."""

import pytest

import calm
from calm.checks.design_check import check
from calm.deck import deck_of

FILE = """
name: Metals
environment: {depth: 100 m}
line:
  - {use: ball}
  - {use: links, length: 20 m, clamps: [{use: logger, at: 5 m}]}
  - {use: opener, label: release}
  - {use: links, length: 5 m, label: lower}
  - {use: block}
components:
  ball: {kind: body, length: 1 m, buoyancy: 3000 N, kn: 200 N/(m/s)^2, inclination: insensitive, material: steel}
  links: {kind: chain, diameter: 13 mm, material: steel}
  logger: {kind: cylinder, diameter: 60 mm, length: 0.5 m, buoyancy: -27 N, material: titanium}
  opener: {kind: body, role: release, length: 1 m, buoyancy: -200 N, kt: 1 N/(m/s)^2, kn: 9 N/(m/s)^2}
  block: {kind: anchor, weight: 15 kN}
"""  # noqa: E501
TITANIUM = ("kn: 9 N/(m/s)^2}", "kn: 9 N/(m/s)^2, material: titanium}")


@pytest.fixture
def warned(tmp_path):
    def of(*changes):
        text = FILE
        for old, new in changes:
            assert old in text
            text = text.replace(old, new)
        (tmp_path / "m.yaml").write_text(text)
        found = check(calm.load(tmp_path / "m.yaml")).findings
        return [one.component for one in found if one.rule == "metals"]

    return of


def test_instruments_are_clamped_on_in_plastic(warned):
    assert warned() == []


@pytest.mark.parametrize(
    "where",
    [
        ("material: titanium}", "material: titanium, insulated: false}"),
        ("at: 5 m", "at: 5 m, insulated: false"),
    ],
)
def test_a_clamp_of_metal_touches_its_line(warned, where):
    assert warned(where) == ["links"]


def test_a_piece_touches_its_neighbours_unless_it_is_insulated(warned):
    assert warned(TITANIUM) == ["links", "lower"]
    bushes = (TITANIUM[0], TITANIUM[1].replace("titanium", "titanium, insulated: true"))
    assert warned(bushes) == []
    chain = ("material: steel}\n  logger", "material: steel, insulated: true}\n  logger")
    assert warned(TITANIUM, chain) == []


@pytest.mark.parametrize(
    ("changes", "anodes"),
    [
        ([], set()),
        ([("at: 5 m", "at: 5 m, insulated: false")], {"anode on links"}),
        ([TITANIUM], {"anode on links"}),
        ([(TITANIUM[0], TITANIUM[1].replace("titanium", "titanium, insulated: true"))], set()),
    ],
)
def test_the_hardware_bill_has_anodes_for_the_contacts_that_are_warned_of(
    warned, tmp_path, changes, anodes
):
    found = warned(*changes)
    hardware = deck_of([calm.load(tmp_path / "m.yaml")]).hardware
    assert {one.name for one in hardware if one.kind == "anodes"} == anodes
    assert sum(one.count for one in hardware if one.kind == "anodes") == len(found)
    assert bool(found) == any(one.kind == "isolators" for one in hardware)
