"""The shipped catalogue: complete, sourced, and nothing in it that cannot be."""

from __future__ import annotations

import re
from math import isfinite, pi

import pytest

from calm.assemble import drag_of
from calm.assemble.component_forces import datasheet
from calm.checks.catalogue_rules import check_catalogue
from calm.files import Anchor, Assembly, Cable, Catalogue, Chain, Component, Cylinder, Sphere

MANUAL_IDS = (
    "sphere-steel-1250",
    "shackle-13",
    "wire-jacketed-8",
    "sbe37",
    "rcm11",
    "glass-17in",
    "release-ar861",
    "polyester-14",
    "anchor-wheels-2",
)
"""The ids that the manual of the file format uses."""

FIBRE_DENSITY = {
    "polyester": 1380.0,
    "nylon": 1140.0,
    "polypropylene": 910.0,
    "aramid": 1440.0,
    "HMPE": 975.0,
}


@pytest.fixture(scope="module")
def catalogue() -> Catalogue:
    return Catalogue.shipped()


@pytest.fixture(scope="module")
def components(catalogue: Catalogue) -> dict[str, Component]:
    """Every single component; assemblies and outlines left out."""
    return {id: found for id, found in catalogue.all().items() if isinstance(found, Component)}


def test_it_holds_at_least_450_components(components: dict[str, Component]) -> None:
    assert len(components) >= 450


def test_ids_are_kebab_case(catalogue: Catalogue) -> None:
    # Two definitions of one id are an InputError of `Catalogue.shipped` itself.
    kebab = re.compile(r"[a-z0-9]+(-[a-z0-9]+)*")
    assert [id for id in catalogue.ids() if not kebab.fullmatch(id)] == []


@pytest.mark.parametrize("id", MANUAL_IDS)
def test_ids_of_the_manual_exist(catalogue: Catalogue, id: str) -> None:
    assert catalogue.entry(id) is not None


def test_everything_has_a_name_a_source_and_the_day_it_was_read(catalogue: Catalogue) -> None:
    nameless = [
        id
        for id, found in catalogue.all().items()
        if not (found.name and found.source and re.fullmatch(r"\d{4}-\d\d-\d\d", found.date or ""))
    ]
    assert nameless == []


def test_sources_name_no_web_address(catalogue: Catalogue) -> None:
    address = re.compile(r"https?:|www\.|\.(com|org|net|ca|ie)\b")
    named = {
        id: " ".join([found.source or "", *(found.sources or {}).values()])
        for id, found in catalogue.all().items()
    }
    assert [id for id, source in named.items() if address.search(source)] == []


def test_every_kind_is_there(components: dict[str, Component]) -> None:
    kinds = {found.kind for found in components.values()}
    assert kinds == {"sphere", "cylinder", "body", "cable", "chain", "anchor"}
    finishes = {found.finish for found in components.values() if isinstance(found, Cable)}
    assert finishes == {"smooth", "rough", "very-rough"}


def test_everything_can_be_computed(components: dict[str, Component]) -> None:
    for id, found in components.items():
        assert isfinite(found.net_buoyancy), id
        if not isinstance(found, Anchor):
            normal, tangential, _ = drag_of(found)
            assert isfinite(tangential) and isfinite(normal) and normal > 0.0, id


def test_parts_of_assemblies_exist(catalogue: Catalogue) -> None:
    assemblies = [found for found in catalogue.all().values() if isinstance(found, Assembly)]
    assert len(assemblies) >= 2
    used = {
        item["use"]
        for assembly in assemblies
        for part in assembly.parts
        for item in (part, *part.get("clamps", ()))
    }
    assert used <= set(catalogue.ids())


def test_the_generic_steel_sphere(catalogue: Catalogue) -> None:
    sphere = catalogue.get("sphere-steel-1250")
    assert isinstance(sphere, Sphere)
    assert (sphere.diameter, sphere.length, sphere.cx) == (1.25, 1.25, 0.5)
    assert (sphere.mass, sphere.buoyancy, sphere.depth_rating) == (300.0, 7000.0, 800.0)
    assert (sphere.working_load, sphere.breaking_load) == (40_000.0, 120_000.0)
    assert sphere.role == "float"


@pytest.mark.parametrize("id", ["rcm4", "rcm5"])
def test_aanderaa_drag_is_measured_in_kgf(components: dict[str, Component], id: str) -> None:
    normal, tangential, directional = drag_of(components[id])
    # The drags are printed to 0.01 kgf, some 0.01 of the 2.694 kgf (26.42 N) they come to.
    assert normal == pytest.approx(26.4, abs=0.05)
    assert tangential == normal and not directional


@pytest.mark.parametrize(
    ("words", "warn", "limit"),
    [
        (["aanderaa rcm-4"], None, 27.0),
        (["aanderaa rcm-7"], None, 27.0),
        (["aanderaa rcm-8"], None, 27.0),
        (["aquadopp"], None, 30.0),
        (["instruments", "adcp"], 15.0, 20.0),
        (["sediment trap"], None, 10.0),
        (["releases", "cylinder"], None, 45.0),
    ],
)
def test_tilt_limits_of_the_families(
    catalogue: Catalogue, words: list[str], warn: float | None, limit: float
) -> None:
    ids = [
        id
        for id, each in catalogue.all().items()
        if all(word in f"{catalogue.entry(id)} {each.kind}".casefold() for word in words)
    ]
    assert ids
    assert {(catalogue.get(id).warn_tilt, catalogue.get(id).max_tilt) for id in ids} == {
        (warn, limit)
    }


def test_floats_with_an_adcp_have_the_tilt_limits_of_one(catalogue: Catalogue) -> None:
    # the limits also make them instruments on the sheets of the deck
    for id, found in catalogue.all().items():
        name = found.name or ""
        if found.role == "float" and "ADCP" in name and not name.endswith("bracket"):
            assert (found.warn_tilt, found.max_tilt) == (15.0, 20.0), id


def test_the_rules_of_catalog_check_find_nothing(catalogue: Catalogue) -> None:
    assert check_catalogue(catalogue.all(), catalogue.ids()) == []


def test_no_float_lifts_more_than_its_volume(components: dict[str, Component]) -> None:
    for id, found in components.items():
        if isinstance(found, Sphere):
            room = pi / 6 * found.diameter**3
        elif isinstance(found, Cylinder):
            room = pi / 4 * found.diameter**2 * found.length
        else:
            continue
        # 1 %: diameters are printed to two or three figures
        assert found.net_buoyancy / (1025.0 * 9.80665) <= room, id
        assert (found.displaced_volume or 0.0) <= 1.01 * room, id


def test_no_fibre_rope_is_heavier_than_a_solid_bar(components: dict[str, Component]) -> None:
    for id, rope in components.items():
        density = FIBRE_DENSITY.get(rope.material or "")
        if isinstance(rope, Cable) and density is not None:
            in_water = -rope.net_buoyancy / 9.80665
            mass = rope.mass or in_water / (1.0 - 1025.0 / density)
            assert mass <= density * pi / 4 * rope.diameter**2, id


def test_chains_weigh_what_chains_weigh(components: dict[str, Component]) -> None:
    for id, chain in components.items():
        if isinstance(chain, Chain):
            mass = -chain.net_buoyancy / 9.80665 / (1.0 - 1025.0 / 7850.0)
            # 16e3 d^2 for long links to 25e3 d^2 for studs; 26e3 for the heaviest high-test row
            assert 15.5e3 <= mass / chain.diameter**2 <= 26.2e3, id


def test_breaking_loads_exceed_working_loads(components: dict[str, Component]) -> None:
    for id, found in components.items():
        if found.working_load is not None and found.breaking_load is not None:
            # 3 for the steel sphere, 4 for grade 80 chain, 6 for shackles, 12 for fibre rope
            assert 3.0 <= found.breaking_load / found.working_load <= 15.0, id


def test_depth_ratings_are_those_of_things_under_water(components: dict[str, Component]) -> None:
    for id, found in components.items():
        if found.depth_rating is not None:
            assert 100.0 <= found.depth_rating <= 7000.0, id


ROPE_STRENGTHS = {
    "nylon": (100.0, 220.0),
    "nylon/polyester": (100.0, 295.0),
    "polyester": (100.0, 295.0),
    "polypropylene": (80.0, 170.0),
    "HMPE": (900.0, 1600.0),
    "aramid": (400.0, 1600.0),
    "steel": (300.0, 1100.0),
    "galvanised steel": (300.0, 1100.0),
}
"""Strength of ropes over the section of their outside diameter [MPa]."""

CHAIN_STRENGTHS = (215.0, 800.0)
"""Mean stress in both sides of a link at the break [MPa]: long links 220, grade 80 nearly 800."""


def test_breaking_loads_go_with_the_section_of_ropes_and_chains(
    components: dict[str, Component],
) -> None:
    judged = 0
    for id, found in components.items():
        if found.breaking_load is None:
            continue
        if isinstance(found, Chain):
            least, most = CHAIN_STRENGTHS
            section = 2.0 * pi / 4 * found.diameter**2
        elif isinstance(found, Cable):
            least, most = ROPE_STRENGTHS[(found.material or "").split(" parallel")[0]]
            section = pi / 4 * found.diameter**2
        else:
            continue
        assert least <= found.breaking_load / section / 1e6 <= most, id
        judged += 1
    assert judged >= 150


@pytest.mark.parametrize(
    ("family", "least", "most"),
    # Breaking load over the square of the size in the id [N/mm^2]; a pair has that of its weaker.
    [("shackle", 340.0, 1100.0), ("link-end", 500.0, 900.0), ("link-pear", 280.0, 480.0)],
)
def test_breaking_loads_go_with_the_size_of_connectors(
    components: dict[str, Component], family: str, least: float, most: float
) -> None:
    sized = re.compile(rf"{family}(?:-[a-z]+)*-(\d+)(?:-[a-z]+)?")
    judged = 0
    for id, found in components.items():
        size = sized.fullmatch(id)
        if size and found.breaking_load is not None:
            assert least <= found.breaking_load / float(size[1]) ** 2 <= most, id
            judged += 1
    assert judged >= 8


def test_what_has_a_mass_weighs_less_in_water(components: dict[str, Component]) -> None:
    for id, found in components.items():
        volume = found.displaced_volume
        if found.mass is not None and volume is not None:
            assert volume >= 0.0, id
            # 11 340 kg/m^3 is lead; a volume this small is a figure to few digits
            assert found.mass <= 11_340.0 * volume or found.mass < 0.05, id


def test_what_is_preferred_is_much_the_same_thing(catalogue: Catalogue) -> None:
    preferring = {id: found for id, found in catalogue.all().items() if found.prefer}
    assert len(preferring) >= 40
    for id, found in preferring.items():
        assert found.prefer
        own, other = (datasheet(each, catalogue) for each in (found, catalogue.get(found.prefer)))
        assert own and other, id
        assert own.net_buoyancy == pytest.approx(other.net_buoyancy, rel=0.45), id


def test_figures_of_one_standard_are_the_same_wherever_they_stand(
    components: dict[str, Component],
) -> None:
    # 2 t and 3.25 t of working load by Crosby and RR-C-271, six times that at the break
    for id in ("shackle-13", "shackle-13-dewey", "shackle-13-ios"):
        assert components[id].working_load == pytest.approx(2000 * 9.80665, rel=1e-3)
        assert components[id].breaking_load == pytest.approx(12000 * 9.80665, rel=1e-3)
    # DIN 763: 13 mm breaks at 63 kN; EN 818-3 grade 4: 10 mm carries 1.6 t
    assert components["chain-long-13"].breaking_load == 63e3
    assert components["chain-short-g40-10"].working_load == pytest.approx(15.69e3)
