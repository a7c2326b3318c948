"""Component definitions: what is required, what is refused, and the arithmetic of weights."""

from typing import Any

import pytest

from calm.errors import Problem
from calm.files import Anchor, Body, Cable, Chain, Cylinder, Sphere
from calm.files.catalogue import Assembly, CatalogueEntry, define
from calm.files.components import Component
from calm.files.definition import CATALOGUE_DENSITY
from calm.files.yaml_document import Document, SourceMapping
from calm.physics.seawater import REFERENCE_DENSITY

G = 9.80665


def parse(fields: dict[str, Any], family: str | None = None) -> tuple[Any, list[str]]:
    problems: list[Problem] = []
    section = SourceMapping.of(Document("file.yaml", fields), problems)
    component = define(CatalogueEntry("it", family, section), section)
    return component, [problem.message for problem in problems]


def good(**fields: Any) -> Any:
    component, problems = parse(fields)
    assert problems == []
    return component


def bad(**fields: Any) -> str:
    component, problems = parse(fields)
    assert component is None
    [problem] = problems
    return problem


def test_catalogue_and_solver_mean_the_same_water() -> None:
    assert CATALOGUE_DENSITY == REFERENCE_DENSITY


def test_sphere() -> None:
    sphere = good(kind="sphere", diameter="1250 mm", mass="300 kg", buoyancy="7000 N")
    assert isinstance(sphere, Sphere)
    assert (sphere.diameter, sphere.length, sphere.mass) == (1.25, 1.25, 300.0)
    assert sphere.net_buoyancy == 7000.0
    assert sphere.displaced_volume == pytest.approx((300 + 7000 / G) / 1025, rel=1e-15)
    assert (sphere.cx, sphere.max_tilt, sphere.source) == (None, None, None)
    assert good(kind="sphere", diameter="1 m", length="2 m", buoyancy="1 N").length == 2.0
    assert good(kind="sphere", diameter="1 m", length="0", buoyancy="1 N").length == 0.0


def test_net_force_from_mass_and_volume() -> None:
    ball = good(kind="sphere", diameter="1 m", mass="100 kg", volume="0.5 m^3")
    assert ball.net_buoyancy == pytest.approx((1025 * 0.5 - 100) * G, rel=1e-15)
    assert ball.displaced_volume == 0.5


def test_net_force_without_a_mass_has_no_volume() -> None:
    assert good(kind="sphere", diameter="1 m", buoyancy="5 N").displaced_volume is None


@pytest.mark.parametrize(("buoyancy", "agrees"), [("4083 N", True), ("4087 N", False)])
def test_mass_volume_and_buoyancy_agree_within_one_percent(buoyancy: str, agrees: bool) -> None:
    # Mass and volume give 4045.24 N; 1 % of the greater of the two is 40.8 N.
    fields = {"kind": "sphere", "diameter": "1 m", "mass": "100 kg", "volume": "0.5 m^3"}
    component, problems = parse({**fields, "buoyancy": buoyancy})
    assert (component is not None) == agrees
    if not agrees:
        assert problems == [
            "`buoyancy` is 4087 N but `mass` and `volume` give 4045.2 N, more than 1 % apart; "
            "remove one of the three"
        ]


def test_all_common_fields() -> None:
    sphere = good(
        kind="sphere",
        diameter="1 m",
        buoyancy="1 kN",
        name="A ball",
        manufacturer="Maker",
        part_number="3846",
        material="steel",
        note="a note",
        source="a list",
        date="2026-11-21",
        role="float",
        depth_rating="800 m",
        working_load="40 kN",
        breaking_load="12 tf",
        max_tilt="27 deg",
        warn_tilt="20 deg",
        slack="allowed",
        hull={"displacement": [["0.1 m", "20 L", "0.2 m^2"], ["0.2 m", "500 L", "0.3 m^2"]]},
        k_surface="40 N/(m/s)^2",
        wind_area="0.5 m^2",
        wind_cd="1.1",
        surface="painted",
    )
    assert (sphere.depth_rating, sphere.working_load) == (800.0, 40e3)
    assert sphere.breaking_load == pytest.approx(12e3 * G, rel=1e-15)
    assert (sphere.max_tilt, sphere.warn_tilt, sphere.slack) == (27.0, 20.0, "allowed")
    assert sphere.hull.displacement == ((0.1, 0.02, 0.2), (0.2, 0.5, 0.3))
    assert (sphere.part_number, sphere.date) == ("3846", "2026-11-21")


@pytest.mark.parametrize(
    ("family", "role"),
    [
        ("floats", "float"),
        ("releases", "release"),
        ("connectors", "connector"),
        (None, "instrument"),
    ],
)
def test_role_is_that_of_the_family(family: str | None, role: str) -> None:
    component, _ = parse({"kind": "sphere", "diameter": "1 m", "buoyancy": "1 N"}, family)
    assert component.role == role
    component, _ = parse(
        {"kind": "sphere", "diameter": "1 m", "buoyancy": "1 N", "role": "line"}, family
    )
    assert component.role == "line"


def test_role_without_a_family_follows_the_kind() -> None:
    assert good(kind="cable", diameter="8 mm", weight="1 N/m").role == "line"
    assert good(kind="anchor", mass="1 t").role == "anchor"


def test_cylinder() -> None:
    cylinder = good(
        kind="cylinder",
        diameter="100 mm",
        length="0.5 m",
        buoyancy="-20 N",
        cn="1.1",
        ct="0.8",
        inclination="insensitive",
        surface="smooth",
    )
    assert isinstance(cylinder, Cylinder)
    assert (cylinder.cn, cylinder.ct, cylinder.net_buoyancy) == (1.1, 0.8, -20.0)
    assert bad(kind="cylinder", diameter="1 m", buoyancy="1 N") == "`length` is missing"


BODY = {"kind": "body", "length": "0.4 m", "buoyancy": "-30 N"}


@pytest.mark.parametrize(
    "drag",
    [
        {"kn": "26 N/(m/s)^2", "kt": "9 N/(m/s)^2"},
        {"kn": "26 N/(m/s)^2", "inclination": "insensitive"},
        {"drag_area": "0.1 m^2", "cd": "1.2"},
        {"drag_area": "0.1 m^2", "cd": "1.2", "kt": "9 N/(m/s)^2"},
        {"drag_measurements": [{"speed": "0.51 m/s", "force": "1.03 kgf"}]},
        {"made_of": [{"kind": "sphere", "diameter": "0.3 m"}]},
        {"made_of": [{"kind": "cylinder", "diameter": "0.3 m", "length": "1 m", "cn": "1"}]},
    ],
)
def test_body_gives_its_drag_in_one_way(drag: dict[str, Any]) -> None:
    body = good(**BODY, **drag)
    assert isinstance(body, Body)
    assert good(**{**BODY, "length": "0 m"}, **drag).length == 0.0


@pytest.mark.parametrize(
    ("drag", "problem"),
    [
        (
            {},
            "gives no drag; drag must be given by one of: `kn` with `kt`, `drag_area` with "
            "`cd`, `drag_measurements`, or `made_of`",
        ),
        (
            {"kn": "1 N/(m/s)^2", "cd": "1"},
            "gives `kn` and `cd`; drag must be given by one of: `kn` with `kt`, `drag_area` with "
            "`cd`, `drag_measurements`, or `made_of`",
        ),
        ({"drag_area": "1 m^2"}, "`drag_area` and `cd` must be given together"),
        ({"kn": "1 N/(m/s)^2"}, "`kn` needs `kt`, or `inclination: insensitive`"),
        ({"made_of": []}, "`made_of` is empty"),
        ({"drag_measurements": []}, "`drag_measurements` is empty"),
        (
            {"drag_area": "1 m^2", "cd": "1", "inclination": "follows"},
            "`inclination: follows` needs `kt`",
        ),
        (
            {"kn": "1 N/(m/s)^2", "kt": "1 N/(m/s)^2", "inclination": "insensitive"},
            "`kt` cannot be used with `inclination: insensitive`",
        ),
        (
            {"made_of": [{"kind": "sphere", "diameter": "1 m"}], "kt": "1 N/(m/s)^2"},
            "`kt` cannot be used with `made_of`",
        ),
        ({"made_of": [{"kind": "cone"}]}, "`kind: cone` must be one of sphere, cylinder"),
        ({"made_of": [{"kind": ["cone"]}]}, "`kind: …` must be one of sphere, cylinder"),
        (
            {"role": {"a": "1"}},
            "`role: …` must be one of float, instrument, release, connector, line, anchor",
        ),
        ({"made_of": [{"diameter": "1 m"}]}, "`made_of` needs a `kind`"),
        (
            {"made_of": "sphere"},
            "`made_of` must be a list, as "
            "`made_of: [{kind: cylinder, diameter: 80 mm, length: 1 m}]`",
        ),
        (
            {"made_of": [{"kind": "sphere", "diametre": "1 m"}]},
            "unknown key `diametre`; did you mean `diameter`?",
        ),
        (
            {"drag_measurements": [{"speed": "0", "force": "1 N"}]},
            "`speed: 0` must be more than 0 m/s",
        ),
    ],
)
def test_body_with_its_drag_wrong(drag: dict[str, Any], problem: str) -> None:
    assert bad(**BODY, **drag) == problem


def test_cable() -> None:
    cable = good(kind="cable", diameter="12 mm", weight="0.5 N/m", stiffness="4 MN")
    assert isinstance(cable, Cable)
    assert (cable.net_buoyancy, cable.displaced_volume, cable.stiffness) == (-0.5, None, 4e6)
    assert good(kind="cable", diameter="12 mm", buoyancy="0.5 N/m").net_buoyancy == 0.5
    cable = good(kind="cable", diameter="12 mm", mass="0.2 kg/m", density="1380 kg/m^3")
    assert cable.net_buoyancy == pytest.approx((1025 / 1380 - 1) * 0.2 * G, rel=1e-15)
    assert cable.displaced_volume == pytest.approx(0.2 / 1380, rel=1e-14)
    # Polypropylene floats.
    assert (
        good(kind="cable", diameter="12 mm", mass="0.1 kg/m", density="0.91 t/m^3").net_buoyancy > 0
    )


@pytest.mark.parametrize(
    ("fields", "problem"),
    [
        ({}, "needs `weight` or `buoyancy` in water, or `mass` with `density`"),
        ({"mass": "1 kg/m"}, "needs `weight` or `buoyancy` in water, or `mass` with `density`"),
        (
            {"weight": "1 N/m", "buoyancy": "-1 N/m"},
            "has both `weight` and `buoyancy`; give only one, since each is the negative "
            "of the other",
        ),
        (
            {"weight": "10 N/m", "mass": "1 kg/m"},
            "weighs more in water (10 N) than its mass of 1 kg does in air",
        ),
        (
            {"weight": "1 N"},
            "`weight: 1 N` is a force; a force per length (N/m, kN/m, N/km, kgf/m, gf/m, kgf/km …) "
            "is needed",
        ),
        ({"weight": "1 N/m", "stiffness": "0"}, "`stiffness: 0` must be more than 0 N"),
        (
            {"weight": "1 N/m", "length": "5 m"},
            "unknown key `length` for kind cable",
        ),
    ],
)
def test_cable_mistakes(fields: dict[str, Any], problem: str) -> None:
    assert bad(kind="cable", diameter="12 mm", **fields) == problem


def test_chain() -> None:
    chain = good(kind="chain", diameter="13 mm")
    assert isinstance(chain, Chain)
    mass = 19.9e3 * 0.013**2
    assert chain.net_buoyancy == pytest.approx(-mass * (1 - 1025 / 7850) * G, rel=1e-14)
    assert chain.displaced_volume == pytest.approx(mass / 7850, rel=1e-15)
    chain = good(kind="chain", diameter="13 mm", mass="3.5 kg/m")
    assert chain.net_buoyancy == pytest.approx(-3.5 * (1 - 1025 / 7850) * G, rel=1e-14)
    assert chain.displaced_volume == pytest.approx(3.5 / 7850, rel=1e-13)
    chain = good(kind="chain", diameter="13 mm", weight="30 N/m")
    assert (chain.net_buoyancy, chain.displaced_volume) == (-30.0, None)


def test_anchor() -> None:
    anchor = good(kind="anchor", mass="1 t")
    assert isinstance(anchor, Anchor)
    assert (anchor.length, anchor.friction) == (0.0, None)
    assert anchor.net_buoyancy == pytest.approx(-1000 * (1 - 1025 / 7850) * G, rel=1e-14)
    assert anchor.displaced_volume == pytest.approx(1000 / 7850, rel=1e-13)
    anchor = good(kind="anchor", weight="8 kN", friction="0.5", kt="400 N/(m/s)^2")
    assert (anchor.net_buoyancy, anchor.displaced_volume, anchor.kt) == (-8000.0, None, 400.0)
    assert bad(kind="anchor") == "needs `mass`, or `weight` in water"


@pytest.mark.parametrize(
    ("fields", "problem"),
    [
        ({"diameter": "0 m"}, "`diameter: 0 m` must be more than 0 m"),
        ({"length": "-1 m"}, "`length: -1 m` must be at least 0 m"),
        ({"mass": "-1 kg"}, "`mass: -1 kg` must be at least 0 kg"),
        ({"breaking_load": "0"}, "`breaking_load: 0` must be more than 0 N"),
        ({"cx": "-0.5"}, "`cx: -0.5` must be at least 0"),
        ({"max_tilt": "181 deg"}, "`max_tilt: 181 deg` must be at most 180 deg"),
        ({"diameter": "12"}, "`diameter: 12` needs a unit; did you mean `diameter: 12 mm`?"),
        ({"buoyancy": None}, "`buoyancy` has no value"),
        ({"name": ["a"]}, "`name` must be plain text"),
        (
            {"role": "flaot"},
            "`role: flaot` must be one of float, instrument, release, connector, line, anchor; "
            "did you mean `role: float`?",
        ),
        (
            {"hull": "box"},
            "`hull: box` must be one of sphere, cylinder",
        ),
        ({"hull": {"displacement": [["1 m"]]}}, "`displacement` has a row with too few values"),
        (
            {"buoyancy": "-20 N", "mass": "1 kg"},
            "weighs more in water (20 N) than its mass of 1 kg does in air",
        ),
    ],
)
def test_rigid_mistakes(fields: dict[str, Any], problem: str) -> None:
    sphere = {"kind": "sphere", "diameter": "1 m", "buoyancy": "1 N"}
    component, problems = parse({**sphere, **fields})
    assert component is None
    # A row that is two short is two mistakes of the same words.
    assert set(problems) == {problem}


def test_kind_is_needed_and_known() -> None:
    assert bad(diameter="1 m").startswith(
        "`it`: `kind` is missing (sphere, cylinder, body, profiler,"
    )
    assert bad(kind=["a"]).startswith("`kind: …` must be one of sphere,")


def test_assembly() -> None:
    assembly = good(kind="assembly", parts=[{"use": "a"}], name="Both")
    assert isinstance(assembly, Assembly)
    assert assembly.parts == ({"use": "a"},)
    assert bad(kind="assembly") == "`parts` is missing"


def test_components_are_frozen() -> None:
    component: Component = good(kind="anchor", mass="1 t")
    with pytest.raises(ValueError, match="frozen"):
        component.length = 3.0


def test_a_hull_must_displace_what_the_float_lifts():
    table = {"displacement": [["0.1 m", "20 L", "0.2 m^2"], ["0.2 m", "50 L", "0.3 m^2"]]}
    _, problems = parse({"kind": "sphere", "diameter": "1 m", "buoyancy": "1 kN", "hull": table})
    assert problems == [
        "the `hull` displaces 0.05 m³ at most, less than required by its net buoyancy of 1000 N"
    ]
