"""Each rule finds what it is for, and lets the next possible figure pass."""

import pytest

from calm.checks.catalogue_rules import check_catalogue
from calm.files import Anchor, Assembly, Body, Cable, Chain, Cylinder, Sphere

KINDS = {
    "sphere": Sphere,
    "cylinder": Cylinder,
    "cable": Cable,
    "chain": Chain,
    "anchor": Anchor,
    "assembly": Assembly,
    "body": Body,
}

GOOD_SPHERE = {"kind": "sphere", "diameter": "1 m", "buoyancy": "2000 N", "source": "a list"}
GOOD_ROPE = {"kind": "cable", "diameter": "10 mm", "weight": "0.2 N/m", "source": "a list"}
GOOD_WIRE = GOOD_ROPE | {"weight": "2.4 N/m", "material": "steel"}
STRETCHED = {"breaking_load": "50 kN", "elongation": [[0.01, 0.2], [0.03, 0.5]]}
GOOD_CHAIN = {"kind": "chain", "diameter": "10 mm", "source": "a list"}
GOOD_BODY = {"kind": "body", "length": "1 m", "mass": "70 kg", "buoyancy": "0 N", "cd": 0.7,
             "drag_area": "0.35 m^2", "source": "a list"}  # fmt: skip
GOOD_SHACKLE = {"kind": "body", "role": "connector", "length": "60 mm", "mass": "0.8 kg",
                "buoyancy": "-6.9 N", "cd": 1, "drag_area": "0.004 m^2", "material": "steel",
                "breaking_load": "150 kN", "source": "a list"}  # fmt: skip
GOOD_POLYESTER = GOOD_ROPE | {"material": "polyester"}
GOOD_METER = {"kind": "cylinder", "diameter": "100 mm", "length": "0.8 m", "buoyancy": "-150 N",
              "role": "instrument", "source": "a list"}  # fmt: skip
GOOD_BUOY = {"kind": "body", "length": "2 m", "mass": "1 t", "volume": "8.8 m^3", "role": "float",
             "cd": 0.7, "drag_area": "3 m^2", "wind_area": "2 m^2", "source": "a list"}  # fmt: skip
GOOD_ANCHOR = {"kind": "anchor", "mass": "1100 kg", "material": "steel", "kt": "1.2 kN/(m/s)^2",
               "source": "a list"}  # fmt: skip


def findings(definition, known=()):
    model = KINDS[definition["kind"]].model_validate(definition)
    return [finding.message for finding in check_catalogue({"x": model}, known)]


@pytest.mark.parametrize(
    "good",
    [
        GOOD_SPHERE,
        GOOD_ROPE,
        GOOD_ROPE | STRETCHED,
        GOOD_CHAIN,
        GOOD_BODY,
        GOOD_SHACKLE,
        GOOD_ANCHOR,
        GOOD_WIRE,
        GOOD_POLYESTER,
        GOOD_METER,
        GOOD_BUOY,
    ],
)
def test_good_components_pass(good):
    assert findings(good) == []


# Water displaced by a sphere of 1 m: 1025 pi/6 = 536.7 kg, 5263 N. A bar of 10 mm: steel
# 0.6165 kg/m, nylon 0.0895 kg/m. The body displaces 70/1025 m³: 0.02 of that to the power 2/3 is
# 0.003342 m², 0.7 times 0.004774 m². Two bars of 10 mm at 1.3 GPa bear 204.2 kN; the anchor weighs
# 9379 N in water, 0.2166² times 200 kN/(m/s)²; 0.8 kg of steel weigh 6.821 N there.
@pytest.mark.parametrize(
    ("good", "change", "told"),
    [
        (GOOD_SPHERE, {"source": None}, "source"),
        (GOOD_SPHERE, {"sources": {"mass": "a scale"}}, "source of `mass`"),
        (GOOD_SPHERE, {"searched": ["buoyancy"]}, "under `searched` `buoyancy`"),
        (GOOD_SPHERE, {"searched": ["stiffness"]}, "a sphere does not have"),
        (GOOD_SPHERE, {"depth_rating": "11500 m"}, "no water is deeper"),
        (GOOD_SPHERE, {"max_tilt": "20 deg", "warn_tilt": "25 deg"}, "beyond its greatest tilt"),
        (GOOD_SPHERE, {"buoyancy": "5300 N"}, "lifts 5300 N"),
        (GOOD_SPHERE, {"buoyancy": "3000 N", "mass": "300 kg"}, "displaces"),
        (GOOD_SPHERE, {"buoyancy": "-1000 N", "mass": "110 kg"}, "denser than lead"),
        (GOOD_SPHERE, {"buoyancy": "-100 N", "role": "float"}, "and weighs 100 N in water"),
        (GOOD_SPHERE, {"mass": "300 g"}, "weighs 0.3 kg and lifts 2000 N"),
        (GOOD_ROPE, {"diameter": "80 mm", "mass": "0.06 kg/m"}, "a small part of what"),
        (GOOD_WIRE, {"stiffness": "3 kN"}, "a wire of its diameter 8.659e+05"),
        (
            GOOD_WIRE,
            STRETCHED,
            "stiffness of 3000 N; a wire of its diameter",
        ),
        (GOOD_ROPE, STRETCHED | {"elongation": [[0.1, 1e-4], [0.3, 1e-3]]}, "5e+07 N; a steel bar"),
        (GOOD_ROPE, {"weight": None, "mass": "0.7 kg/m", "density": "7850 kg/m^3"}, "solid bar"),
        (GOOD_ROPE, {"weight": "6.5 N/m"}, "solid bar"),
        (GOOD_ROPE, {"weight": "0.3 N/m", "material": "nylon"}, "solid bar"),
        (GOOD_ROPE, {"weight": None, "buoyancy": "1 N/m"}, "lifts 1 N/m"),
        (GOOD_ROPE, {"weight": "0.2 N/m", "mass": "0.19 kg/m"}, "of its diameter weighs, 0.7895"),
        (GOOD_ROPE, {"stiffness": "18 MN"}, "stiffness"),
        (GOOD_ROPE, {"breaking_load": "320 kN"}, "no cable of its diameter"),
        (GOOD_ROPE, {"cn": 0.0}, "no drag across it"),
        (GOOD_CHAIN, {"cn": 0.0}, "no drag across it"),
        (GOOD_CHAIN, {"mass": "0.8 kg/m"}, "steel bars"),
        (GOOD_CHAIN, {"mass": "3.2 kg/m"}, "steel bars"),
        (
            GOOD_CHAIN,
            {"breaking_load": "205 kN"},
            "its diameter bears more than 204204",
        ),
        (GOOD_ANCHOR, {"kt": "200 kN/(m/s)^2"}, "falls at 0.22 m/s"),
        (GOOD_ANCHOR, {"kt": "4 N/(m/s)^2"}, "falls at 48 m/s"),
        # 1025 π/6 · 10³ kg of water, 5.263 MN
        (GOOD_SPHERE, {"diameter": "10 m"}, "of that size lifts 526312 N at least"),
        # 85 mm in place of 8.5 mm; 0.16 N/m in place of 1.6 N/m
        (GOOD_WIRE, {"diameter": "85 mm"}, "a rope of steel of its diameter weighs 37.98 N/m"),
        (GOOD_WIRE, {"weight": "0.16 N/m"}, "a rope of steel of its diameter weighs 0.5257 N/m"),
        (GOOD_POLYESTER, {"weight": None, "buoyancy": "0.2 N/m"}, "floats with 0.2 N/m in water"),
        (GOOD_ROPE, {"material": "polypropylene"}, "a solid bar of its diameter weighs 0 N/m"),
        (GOOD_WIRE, {"breaking_load": "450 kN"}, "its weight in water bears more than 85199"),
        (GOOD_WIRE, {"breaking_load": "4.5 kN"}, "breaks at 4500 N"),
        (GOOD_POLYESTER, {"breaking_load": "60 kN"}, "diameter and material bears more than 53250"),
        (GOOD_POLYESTER, {"breaking_load": "2 kN"}, "bears 4437 N at least"),
        (GOOD_CHAIN, {"name": "grade 30", "breaking_load": "125 kN"}, "and grade 30 bears more"),
        (GOOD_CHAIN, {"name": "chain, g80", "breaking_load": "50 kN"}, "grade 80 bears 106814 N"),
        (GOOD_CHAIN, {"cn": 14.0}, "1 at least, 6 at most"),
        (GOOD_SPHERE, {"cx": 5.0}, "0.06 at least, 2 at most"),
        (
            GOOD_ANCHOR,
            {"mass": "1900 kg", "weight": "18.6 kN", "material": "concrete"},
            "concrete of that mass weighs 10675 N",
        ),
        (GOOD_ANCHOR, {"name": "concrete clump"}, "but its `material` is steel"),
        (GOOD_METER, {"buoyancy": "15 N"}, "floats with 15 N, with `role: instrument`"),
        (GOOD_BUOY, {"wind_area": "2.2 cm^2"}, "has 0.085 to 85 m²"),
        (
            GOOD_SHACKLE,
            {"breaking_load": "15 MN"},
            "no body of its mass and length bears",
        ),
        (GOOD_SHACKLE, {"buoyancy": "-0.7 N"}, "its material weighs 6.821 N there"),
        (GOOD_BODY, {"drag_area": "0.00477 m^2"}, "of its 0.068 m³ has 0.0033 m²"),
    ],
)
def test_impossible_figures_are_found(good, change, told):
    changed = {key: value for key, value in (good | change).items() if value is not None}
    (message,) = findings(changed)
    assert told in message


@pytest.mark.parametrize(
    ("good", "change"),
    [
        (GOOD_SPHERE, {"breaking_load": "10 kN", "working_load": "10 kN"}),
        (GOOD_POLYESTER, {"breaking_load": "50 kN"}),
        (GOOD_ROPE, {"material": "polypropylene and lead"}),
        (GOOD_WIRE, {"breaking_load": "80 kN"}),
        (GOOD_CHAIN, {"name": "grade 30", "breaking_load": "50 kN"}),
        (GOOD_ANCHOR, {"name": "railway wheels of iron"}),
        (GOOD_METER, {"buoyancy": "15 N", "name": "sonar with foam collar"}),
        (GOOD_METER, {"buoyancy": "15 N", "mass": "4.9 kg"}),
        (GOOD_METER, {"buoyancy": "15 N", "role": None}),
        (GOOD_SPHERE, {"buoyancy": "5200 N"}),
        (GOOD_SPHERE, {"buoyancy": "3000 N", "mass": "240 kg"}),
        (GOOD_SPHERE, {"buoyancy": "-1000 N", "mass": "112.5 kg"}),
        (GOOD_ROPE, {"weight": "5 N/m"}),
        (GOOD_ROPE, {"weight": None, "buoyancy": "0.85 N/m"}),
        (GOOD_ROPE, {"weight": "0.2 N/m", "mass": "0.13 kg/m"}),
        (GOOD_SPHERE, {"mass": "3 kg", "role": "float"}),
        (GOOD_ROPE, {"stiffness": "16 MN"}),
        (GOOD_ROPE, {"stiffness": "3 kN", "material": "polyester"}),
        (GOOD_WIRE, {"stiffness": "1 MN"}),
        (GOOD_ROPE, {"diameter": "13 mm", "mass": "0.036 kg/m"}),
        (GOOD_CHAIN, {"mass": "1.6 kg/m"}),
        (GOOD_CHAIN, {"mass": "2.6 kg/m"}),
        (GOOD_BODY, {"drag_area": "0.00478 m^2"}),
        (GOOD_BODY, {"mass": "1 kg", "drag_area": "0.000001 m^2"}),
    ],
)
def test_possible_figures_pass(good, change):
    changed = {key: value for key, value in (good | change).items() if value is not None}
    assert findings(changed) == []


def test_cylinder_is_judged_by_its_envelope():
    cylinder = {"kind": "cylinder", "diameter": "100 mm", "length": "1 m", "source": "a list",
                "role": "float"}  # fmt: skip
    assert findings(cylinder | {"buoyancy": "78 N"}) == []
    assert "lifts" in findings(cylinder | {"buoyancy": "80 N"})[0]


def test_parts_of_an_assembly_must_exist():
    assembly = {"kind": "assembly", "parts": [{"use": "a"}, {"use": "b"}], "source": "a list"}
    assert findings(assembly, known=["a", "b"]) == []
    (message,) = findings(assembly, known=["a"])
    assert "`b`" in message


@pytest.mark.parametrize(
    ("prefer", "told"),
    [
        ("nothing", "which no catalogue has"),
        ("x", "prefers `x`, which no catalogue has"),
        ("y", "itself prefers `z`"),
    ],
)
def test_what_is_preferred_must_be_there_and_be_final(prefer, told):
    definitions = {
        "x": Sphere.model_validate(GOOD_SPHERE | {"prefer": prefer}),
        "y": Sphere.model_validate(GOOD_SPHERE | {"prefer": "z"}),
        "z": Sphere.model_validate(GOOD_SPHERE),
    }
    (finding,) = check_catalogue(definitions, list(definitions))
    assert finding.id == "x"
    assert told in finding.message
