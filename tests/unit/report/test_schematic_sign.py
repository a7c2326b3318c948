import pytest

from calm.drawing.schematic.symbols import LINES, Symbol, figure_of, sign_of
from calm.files import Body, Catalogue, Cylinder, Sphere

CATALOGUE = Catalogue.shipped()


def shipped(use, label=None):
    return sign_of(use, label or use, CATALOGUE.get(use))


@pytest.mark.parametrize(
    ("use", "symbol"),
    [
        ("sphere-steel-1250", Symbol.SPHERE),
        ("trawl-float-8in", Symbol.BALL),
        ("glass-17in", Symbol.GLASS),
        ("float-af36-workhorse", Symbol.FOAM),
        ("float-stablemoor-1000lb", Symbol.STREAMLINED),
        ("rcm11", Symbol.CURRENT_METER),
        ("s4", Symbol.CURRENT_METER),
        ("aquadopp-sbe37-frame", Symbol.CURRENT_METER),
        ("adcp-75khz-sbe37", Symbol.ADCP),
        ("sbe37", Symbol.CTD),
        ("sbe16", Symbol.CTD),  # by Sea-Bird: no bird
        ("hobo-u22", Symbol.CTD),
        ("sediment-trap-mk78", Symbol.TRAP),
        ("recorder-sm2m", Symbol.INSTRUMENT),
        ("ice-profiler-ips4", Symbol.BODY),
        ("release-ar861", Symbol.RELEASE),
        ("release-ar861-double", Symbol.RELEASE_PAIR),
        ("shackle-13", Symbol.SHACKLE),
        ("swivel-13", Symbol.SWIVEL),
        ("ring-16", Symbol.LINK),
        ("chain-buoy-13", Symbol.CHAIN),
        ("wire-jacketed-8", Symbol.WIRE),
        ("polyester-13", Symbol.ROPE),
        ("amsteel-7", Symbol.ROPE),  # of fibre, whatever its name
        ("anchor-wheels-2", Symbol.WHEELS),
        ("anchor-concrete-1", Symbol.BLOCK),
    ],
)
def test_symbol_of_a_shipped_component(use, symbol):
    assert shipped(use).symbol is symbol


@pytest.mark.parametrize(
    ("use", "count"),
    [
        ("glass-17in", 1),
        ("glass-17in-double", 2),
        ("glass-12in-triple", 3),
        ("glass-17in-chain-7", 7),
        ("glass-17in-string-3", 3),
        ("anchor-wheels-4", 4),
        ("anchor-rotors-10", 10),
    ],
)
def test_how_many_balls_and_wheels(use, count):
    assert shipped(use).count == count


@pytest.mark.parametrize(
    ("label", "looks"),
    [
        ("ADCP up", (True, False)),
        ("upward ADCP", (True, False)),
        ("ADCP down", (False, True)),
        ("looking up and down", (True, True)),
        ("ADCP 300 m", (False, False)),
        ("back-up ADCP", (False, False)),
    ],
)
def test_an_adcp_looks_where_its_label_says(label, looks):
    sign = shipped("adcp-workhorse", label)
    assert sign.sounding
    assert (sign.up, sign.down) == looks


def test_only_an_adcp_looks():
    assert not shipped("rcm11", "meter looking up").up
    assert shipped("float-adcp-1420").sounding


def test_the_label_tells_what_the_definition_does_not():
    body = Body(kind="body", length="1 m", buoyancy="-50 N", drag_area="0.1 m^2", cd="1")
    cylinder = Cylinder(kind="cylinder", diameter="0.1 m", length="1 m", buoyancy="-50 N")
    assert sign_of("thing", "current meter", cylinder).symbol is Symbol.CURRENT_METER
    assert sign_of("thing", "T 3", cylinder).symbol is Symbol.CTD
    assert sign_of("thing", "thing", cylinder).symbol is Symbol.INSTRUMENT
    assert sign_of("thing", "thing", body).symbol is Symbol.BODY
    ball = Sphere(kind="sphere", role="float", diameter="1 m", buoyancy="500 N")
    assert sign_of("ball", "float above the current meter", ball).symbol is Symbol.SPHERE


def test_every_symbol_but_a_cable_has_a_figure():
    signs = [shipped(use) for use in CATALOGUE.ids()
             if CATALOGUE.get(use).kind != "assembly"]  # fmt: skip
    for sign in signs:
        if sign.symbol not in LINES:
            assert figure_of(sign).height > 0.0
