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
        (GOOD_SPHERE, {"sources": {"mass": "a scale"}}, "source for `mass`"),
        (GOOD_SPHERE, {"searched": ["buoyancy"]}, "lists `buoyancy` under `searched`"),
        (GOOD_SPHERE, {"searched": ["stiffness"]}, "but a sphere has no such key"),
        (GOOD_SPHERE, {"depth_rating": "11500 m"}, "the deepest sea is"),
        (GOOD_SPHERE, {"max_tilt": "20 deg", "warn_tilt": "25 deg"}, "above its `max_tilt`"),
        (
            GOOD_SPHERE,
            {"buoyancy": "5300 N"},
            "has a buoyancy of 5.30 kN; water of the same volume weighs only 5.26 kN",
        ),
        (GOOD_SPHERE, {"buoyancy": "3000 N", "mass": "300 kg"}, "together they exceed"),
        (GOOD_SPHERE, {"buoyancy": "-1000 N", "mass": "110 kg"}, "denser than lead"),
        (GOOD_SPHERE, {"buoyancy": "-100 N", "role": "float"}, "but weighs 100 N in water"),
        (GOOD_SPHERE, {"mass": "300 g"}, "weighs 0.3 kg and has a buoyancy of 2.00 kN"),
        (GOOD_ROPE, {"diameter": "80 mm", "mass": "0.06 kg/m"}, "the difference should be near"),
        (GOOD_WIRE, {"stiffness": "3 kN"}, "a wire of its diameter has at least 866 kN"),
        (
            GOOD_WIRE,
            STRETCHED,
            "stiffness of 3 kN; a wire of its diameter",
        ),
        (
            GOOD_ROPE,
            STRETCHED | {"elongation": [[0.1, 1e-4], [0.3, 1e-3]]},
            "50000 kN; a steel bar",
        ),
        (GOOD_ROPE, {"weight": None, "mass": "0.7 kg/m", "density": "7850 kg/m^3"}, "solid bar"),
        (GOOD_ROPE, {"weight": "6.5 N/m"}, "solid bar"),
        (GOOD_ROPE, {"weight": "0.3 N/m", "material": "nylon"}, "solid bar"),
        (GOOD_ROPE, {"weight": None, "buoyancy": "1 N/m"}, "has a buoyancy of 1 N/m"),
        (
            GOOD_ROPE,
            {"weight": "0.2 N/m", "mass": "0.19 kg/m"},
            "near 0.7895 N/m, the weight of the water that the rope displaces",
        ),
        (GOOD_ROPE, {"stiffness": "18 MN"}, "stiffness"),
        (GOOD_ROPE, {"breaking_load": "320 kN"}, "a cable of its diameter has at most"),
        (GOOD_ROPE, {"cn": 0.0}, "no normal drag"),
        (GOOD_CHAIN, {"cn": 0.0}, "no normal drag"),
        (GOOD_CHAIN, {"mass": "0.8 kg/m"}, "steel bars"),
        (GOOD_CHAIN, {"mass": "3.2 kg/m"}, "steel bars"),
        (
            GOOD_CHAIN,
            {"breaking_load": "205 kN"},
            "its diameter has at most 204.20 kN",
        ),
        (GOOD_ANCHOR, {"kt": "200 kN/(m/s)^2"}, "would sink at 0.22 m/s"),
        (GOOD_ANCHOR, {"kt": "4 N/(m/s)^2"}, "would sink at 48 m/s"),
        # 1025 π/6 · 10³ kg of water, 5.263 MN
        (GOOD_SPHERE, {"diameter": "10 m"}, "this diameter, 10 m, has at least 526.31 kN"),
        # 85 mm in place of 8.5 mm; 0.16 N/m in place of 1.6 N/m
        (
            GOOD_WIRE,
            {"diameter": "85 mm"},
            "a rope of steel of its diameter weighs at least 37.98 N/m",
        ),
        (
            GOOD_WIRE,
            {"weight": "0.16 N/m"},
            "a rope of steel of its diameter weighs at least 0.5257 N/m",
        ),
        (
            GOOD_POLYESTER,
            {"weight": None, "buoyancy": "0.2 N/m"},
            "is buoyant with 0.2 N/m in water",
        ),
        (GOOD_ROPE, {"material": "polypropylene"}, "a solid bar of its diameter weighs 0 N/m"),
        (GOOD_WIRE, {"breaking_load": "450 kN"}, "its weight in water has at most 85.20 kN"),
        (GOOD_WIRE, {"breaking_load": "4.5 kN"}, "has a breaking load of 4.50 kN"),
        (GOOD_POLYESTER, {"breaking_load": "60 kN"}, "diameter and material has at most 53.25 kN"),
        (GOOD_POLYESTER, {"breaking_load": "2 kN"}, "has at least 4.44 kN"),
        (GOOD_CHAIN, {"name": "grade 30", "breaking_load": "125 kN"}, "and grade 30 has at most"),
        (
            GOOD_CHAIN,
            {"name": "chain, g80", "breaking_load": "50 kN"},
            "grade 80 has at least 106.81 kN",
        ),
        (GOOD_CHAIN, {"cn": 14.0}, "at least 1 and at most 6"),
        (GOOD_SPHERE, {"cx": 5.0}, "at least 0.06 and at most 2"),
        (
            GOOD_ANCHOR,
            {"mass": "1900 kg", "weight": "18.6 kN", "material": "concrete"},
            "1900 kg of concrete weigh 10.67 kN",
        ),
        (GOOD_ANCHOR, {"name": "concrete clump"}, "but its `material` is steel"),
        (GOOD_METER, {"buoyancy": "15 N"}, "has `role: instrument` and a buoyancy of 15 N"),
        (GOOD_BUOY, {"wind_area": "2.2 cm^2"}, "has 0.085 to 85 m²"),
        (
            GOOD_SHACKLE,
            {"breaking_load": "15 MN"},
            "a body of its mass and length has at most",
        ),
        (GOOD_SHACKLE, {"buoyancy": "-0.7 N"}, "mass and material would weigh 6.82 N in water"),
        (GOOD_BODY, {"drag_area": "0.00477 m^2"}, "with the same volume, 0.068 m³, has 0.0033 m²"),
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
    assert "has a buoyancy of" in findings(cylinder | {"buoyancy": "80 N"})[0]


def test_parts_of_an_assembly_must_exist():
    assembly = {"kind": "assembly", "parts": [{"use": "a"}, {"use": "b"}], "source": "a list"}
    assert findings(assembly, known=["a", "b"]) == []
    (message,) = findings(assembly, known=["a"])
    assert "`b`" in message


@pytest.mark.parametrize(
    ("prefer", "told"),
    [
        ("nothing", "which must be the id of another component"),
        ("x", "has `prefer: x`, which must be the id of another"),
        ("y", "itself has `prefer: z`"),
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
