"""What a component lacks, by what it is for."""

import pytest

from calm.checks.catalogue_rules import missing_figures
from calm.files import Anchor, Assembly, Cable, Chain, Cylinder, Sphere

SPHERE = {"kind": "sphere", "diameter": "1 m", "buoyancy": "2000 N"}
CYLINDER = {"kind": "cylinder", "diameter": "10 cm", "length": "1 m", "buoyancy": "-50 N"}
ROPE = {"kind": "cable", "diameter": "10 mm", "weight": "0.2 N/m"}
CHAIN = {"kind": "chain", "diameter": "10 mm"}
ANCHOR = {"kind": "anchor", "weight": "10 kN", "breaking_load": "50 kN"}
LOADS = ("working_load", "breaking_load")


@pytest.mark.parametrize(
    ("model", "given", "missing"),
    [
        (Sphere, SPHERE | {"role": "float"}, ("mass", *LOADS, "depth_rating")),
        (Sphere, SPHERE | {"role": "connector"}, ("mass", *LOADS)),
        (Sphere, SPHERE | {"role": "float", "mass": "90 kg"}, (*LOADS, "depth_rating")),
        (Cylinder, CYLINDER, ("mass", *LOADS, "depth_rating", "max_tilt")),
        (Cylinder, CYLINDER | {"working_load": "9 kN"}, ("mass", "depth_rating", "max_tilt")),
        (Cylinder, CYLINDER | {"warn_tilt": "9 deg"}, ("mass", *LOADS, "depth_rating")),
        (Cable, ROPE, ("mass", *LOADS)),
        # 0.2 N/m of polyester: the mass follows from the density
        (Cable, ROPE | {"density": "1380 kg/m^3"}, LOADS),
        # a chain is of steel and its mass that of its bar
        (Chain, CHAIN, LOADS),
        (Chain, CHAIN | {"breaking_load": "50 kN"}, ()),
        (Anchor, ANCHOR, ("material",)),
        (Anchor, ANCHOR | {"material": "steel"}, ()),
        (Anchor, ANCHOR | {"density": "2400 kg/m^3"}, ()),
    ],
)
def test_what_is_missing(model, given, missing):
    found = missing_figures({"x": model.model_validate(given)})
    assert [each.figures for each in found] == ([missing] if missing else [])


def test_what_was_searched_for_is_told_apart():
    sought = Sphere.model_validate(SPHERE | {"role": "float", "searched": [*LOADS, "cx"]})
    (found,) = missing_figures({"x": sought})
    assert found.searched == LOADS


def test_an_assembly_lacks_nothing_of_its_own():
    assembly = Assembly.model_validate({"kind": "assembly", "parts": [{"use": "x"}]})
    assert missing_figures({"a": assembly}) == []
