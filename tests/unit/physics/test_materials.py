"""What a person writes as a material, and what follows from it."""

import pytest

from calm.physics.materials import (
    MATERIALS,
    density_of,
    fibre_of,
    materials_in,
    potential_of,
    published_stiffnesses,
)


@pytest.mark.parametrize("material", MATERIALS, ids=lambda material: material.name)
def test_every_material_is_known_by_its_own_name(material):
    assert materials_in(material.name) == (material,)
    assert materials_in(material.name.upper()) == (material,)


@pytest.mark.parametrize(
    ("text", "names"),
    [
        ("Ti grade 5", ["titanium"]),
        ("titane", ["titanium"]),
        ("inconel 625", ["nickel alloy"]),
        ("hot-dip galv.", ["steel"]),
        ("HDG", ["steel"]),
        ("Stahldraht", ["steel"]),
        ("SS316", ["stainless steel"]),
        ("AISI 316L", ["stainless steel"]),
        ("1.4404", ["stainless steel"]),
        ("A4", ["stainless steel"]),
        ("stainles steel", ["stainless steel"]),
        ("super duplex stainless steel", ["stainless steel"]),
        ("aluminium bronze", ["bronze"]),
        ("anodised aluminum", ["aluminium"]),
        ("Polyesterseil", ["polyester"]),
        ("HMPE core, polyester jacket", ["HMPE", "polyester"]),
        ("steel and concrete", ["steel", "concrete"]),
        ("unobtainium", []),
        ("granite", []),
        ("tin of leaded paint", []),
        (None, []),
    ],
)
def test_materials_that_a_text_names(text, names):
    assert [material.name for material in materials_in(text)] == names


@pytest.mark.parametrize(
    ("text", "density"),
    [("galvanised steel, forged steel", 7850.0), ("Concrete", 2400.0), ("cast iron", 7200.0),
     ("borosilicate glass", 2230.0), ("steel and concrete", None), ("granite", None)],
)  # fmt: skip
def test_density_of_one_material_alone(text, density):
    assert density_of(text) == density


@pytest.mark.parametrize(
    ("text", "volts"),
    [("316 stainless", -0.05), ("galvanised steel", -0.66), ("steel with titanium bolts", 0.0),
     ("titanium in a plastic jacket", None), ("polyester", None), ("not a metal", None)],
)  # fmt: skip
def test_potential_is_that_of_the_noblest_metal(text, volts):
    assert potential_of(text) == volts


@pytest.mark.parametrize(
    ("text", "name"),
    [("nylon/polyester", "nylon"), ("polypropylene with lead", "polypropylene"),
     ("steel, polyethylene sheath", None), ("UHMWPE", "HMPE"), ("Technora", "aramid")],
)  # fmt: skip
def test_fibre_of_a_rope(text, name):
    fibre = fibre_of(text)
    assert (fibre and fibre.name) == name
    assert bool(published_stiffnesses(text, 0.01)) == (name is not None)
