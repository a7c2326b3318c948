"""What the sheets of the deck are made of, against sums and solves of their own."""

import math
from functools import partial

import pytest

import calm
from calm.deck import Deck, deck_of
from calm.deck.deck_items import Order, hardware_text, printed_rows
from calm.deck.hardware import Stock, all_shipped
from calm.drop import DropPlan, drop_plan
from calm.drop.fall import Fineness
from calm.files.pieces import holds_instrument
from calm.quantities import show_in
from calm.report.anchor_sheets import drop_part
from calm.report.deck_lists import cutting_part, hardware_part, lifts_part, shipping_part
from calm.report.deck_logs import deployment_part
from calm.shipped import shipped_folder

MOORING = """\
name: Sheets
environment: {depth: 300 m, current: {speed: 0.25 m/s, toward: 90 deg}}
line:
  - {use: ball, label: top float, serial: T1}
  - {use: shackle-13}
  - {use: ring-22-102}
  - {use: shackle-16, serial: 4}
  - {use: wire, length_at: {load: 2 kN, length: 100 m}, termination: thimble and link, label: wire,
     clamps: [{use: logger, at: 60 m, label: low}, {use: logger, at: 20 m, label: high}]}
  - {use: pack, count: 3, serial: [a, b, c], label: glass}
  - {use: release, serial: 77}
  - {use: rope, length: 50 m, label: rope}
  - {use: weight, mass: 800 kg}
environments:
  calm: {current: {speed: 0.05 m/s, toward: 90 deg}}
  storm: {current: {speed: 0.6 m/s, toward: 90 deg}}
deployed: {items: [{label: top float, serial: T2, remark: newly painted}]}
components:
  ball: {kind: sphere, role: float, diameter: 1 m, mass: 250 kg, buoyancy: 2500 N}
  wire: {kind: cable, diameter: 8 mm, weight: 1.6 N/m, mass: 0.21 kg/m, stiffness: 2 MN,
    material: steel}
  rope: {kind: cable, diameter: 14 mm, weight: 0.3 N/m, stiffness: 200 kN}
  logger: {kind: cylinder, diameter: 50 mm, length: 0.4 m, mass: 3 kg, buoyancy: -15 N,
    max_tilt: 30 deg}
  pack: {kind: body, role: float, length: 0.5 m, mass: 20 kg, buoyancy: 250 N, drag_area: 0.15 m^2,
    cd: 0.6}
  release: {kind: body, role: release, length: 0.8 m, mass: 30 kg, buoyancy: -220 N,
    drag_area: 0.1 m^2, cd: 1}
  weight: {kind: anchor, mass: 800 kg, length: 0.3 m}
"""


@pytest.fixture(autouse=True, scope="module")
def dropped_in_few_steps():
    """The plan of the drop from a chain of few bars: its figures are judged elsewhere."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("calm.deck.drop_plan", partial(drop_plan, fineness=Fineness(20, 20)))
        yield


@pytest.fixture(scope="module")
def moorings(tmp_path_factory):
    path = tmp_path_factory.mktemp("deck") / "m.yaml"
    path.write_text(MOORING)
    return [calm.load(path, environment=name) for name in (None, "calm", "storm")]


@pytest.fixture(scope="module")
def deck(moorings) -> Deck:
    return deck_of(moorings)


def test_the_order_over_the_side(moorings, deck):
    down = [one.label for one in deck.deployment]
    assert down[:6] == ["top float", "shackle-13", "ring-22-102", "shackle-16", "wire", "high"]
    assert down[-1] == "weight"
    other_way = deck_of(moorings[:1], Order.ANCHOR_FIRST)
    assert [(cut.over, cut.onto) for cut in other_way.cuts] == [(2, 1), (1, 2)]
    first = [one.label for one in other_way.deployment]
    # a piece goes with its lower end ahead: its lowest clamp comes first
    assert first[:2] == ["weight", "rope"]
    assert first[first.index("wire") :][:3] == ["wire", "low", "high"]
    assert sorted(first) == sorted(down)


def test_what_shares_a_row_on_paper(tmp_path, deck):
    told = [
        (row.label, row.name, hardware_text(row.joints)) for row in printed_rows(deck.deployment)
    ]
    assert told[:3] == [
        # the shackle with a serial number is a row of its own
        ("top float", "ball", "13 mm shackle, 7/8 in ring"),
        ("shackle-16", deck.parts[3].name, ""),
        ("wire", "wire", ""),
    ]
    chain = "{use: chain, length: 2 m, label: cluster, clamps: [{use: pack, at: 0.5 m},{use: pack,"
    chain += " at: 1.5 m}]}\n  - {use: shackle-13}"
    floats = "\n  - {use: shackle-13}\n  - ".join(3 * ["{use: pack}"])
    text = MOORING.replace("{use: pack, count: 3, serial: [a, b, c], label: glass}",
                           f"{chain}\n  - {floats}\n  - {{use: shackle-16}}")  # fmt: skip
    text = text.replace("  wire: {kind", "  chain: {kind: chain, diameter: 13 mm, weight: 30 N/m}\n"
                        "  wire: {kind")  # fmt: skip
    (tmp_path / "m.yaml").write_text(text)
    sheets = deck_of([calm.load(tmp_path / "m.yaml")])
    rows = {row.label: row for row in printed_rows(sheets.deployment)}
    cluster = rows["cluster"]
    assert (cluster.name, hardware_text(cluster.joints)) == ("2 × pack", "13 mm shackle")
    assert len(_parts_of(rows["cluster"])) == 4
    (shared,) = (row for row in rows.values() if len(row.items) == 3)
    assert (shared.name, hardware_text(shared.joints)) == (
        "3 × pack",
        "2 × 13 mm shackle, 16 mm shackle",
    )
    # nothing is lost, nothing counted twice; the other way round the same clusters
    for order in Order:
        listed = deck_of([sheets.result.design], order).deployment
        assert sum(len(_parts_of(row)) for row in printed_rows(listed)) == len(sheets.parts)


def _parts_of(row):
    return [*row.items, *row.floats, *row.joints]


def test_depths_and_heights_are_those_of_the_result(deck):
    depths = {row.label: row.depth_top for row in deck.result.components}
    depths |= {row.label: row.depth for row in deck.result.clamps}
    for one in deck.parts:
        assert one.depth == depths[one.label]
        assert one.depth + one.height == pytest.approx(300.0)


def test_a_cable_is_cut_and_marked_under_its_load(deck):
    wire, rope = deck.cuts
    longer = 1.0 + 2e3 / 2e6
    assert (wire.length, wire.load) == (pytest.approx(100.0), 2000.0)
    assert wire.unstretched == pytest.approx(100.0 / longer)
    assert [(mark.label, mark.at) for mark in wire.marks] == [
        ("high", pytest.approx(20.0 * longer)), ("low", pytest.approx(60.0 * longer)),
    ]  # fmt: skip
    assert (rope.length, rope.load, rope.marks) == (50.0, 0.0, ())
    assert (wire.over, wire.onto, rope.over, rope.onto) == (1, 2, 2, 1)
    assert wire.tolerance == pytest.approx(0.5)


def test_the_effect_of_an_error_is_what_another_file_gives(moorings, deck, tmp_path):
    for cut, old, new in (
        (deck.cuts[0], "length: 100 m}", "length: 100.5 m}"),
        (deck.cuts[1], "length: 50 m", "length: 50.25 m"),
    ):
        assert MOORING.count(old) == 1
        (tmp_path / "m.yaml").write_text(MOORING.replace(old, new))
        top = calm.load(tmp_path / "m.yaml").solve().top.depth
        assert cut.effect == pytest.approx(top - deck.result.top.depth, abs=1e-6)
        # half a metre more on a line that hardly leans: as much shallower
        assert cut.effect == pytest.approx(-0.005 * cut.unstretched, rel=0.02)


def test_hardware_is_counted_with_its_pins_and_thimbles(deck):
    stocks = {(one.kind, one.use): (one.count, one.spares) for one in deck.hardware}
    assert stocks == {
        ("shackles", "shackle-13"): (1, 2),
        ("shackles", "shackle-16"): (1, 2),
        ("pins", "shackle-13"): (1, 2),
        ("pins", "shackle-16"): (1, 2),
        ("cotter pins", "shackle-13"): (1, 2),
        ("cotter pins", "shackle-16"): (1, 2),
        ("rings", "ring-22-102"): (1, 1),
        ("thimbles", "wire"): (2, 2),
    }
    assert [Stock("shackles", "", "", count).spares for count in (1, 20, 21)] == [2, 2, 3]
    assert [Stock("rings", "", "", count).spares for count in (1, 10, 11)] == [1, 1, 2]


def test_unlike_metals_have_isolators_and_anodes(tmp_path):
    text = MOORING.replace("  release: {kind: body,", "  release: {kind: body, material: titanium,")
    text = text.replace("  pack: {kind", "  pack: {material: aluminium, kind")
    text = text.replace("shackle-16, serial: 4", "shackle-16, name: screw pin shackle")
    text = text.replace("use: rope, length: 50 m", "use: rope, length: 2 m")
    (tmp_path / "m.yaml").write_text(text)
    sheets = deck_of([calm.load(tmp_path / "m.yaml")], Order.ANCHOR_FIRST)
    assert sheets.cuts[1].tolerance == 0.02  # as a tape is read
    found = {one.name: one for one in sheets.hardware}
    # the lowest of three aluminium packs touches the titanium release, the highest the steel wire
    isolators = [one.name for one in found.values() if one.kind == "isolators"]
    assert isolators == ["isolator between pack and wire", "isolator between pack and release"]
    anode = found["anode on pack"]
    assert (anode.kind, anode.count, anode.spares) == ("anodes", 2, 1)
    assert found["screw pin of screw pin shackle"].count == 1
    assert "cotter pin of screw pin shackle" not in found


def test_the_shipping_list_adds_up_and_says_what_it_lacks(deck):
    shipped = {one.use: one for one in deck.shipped}
    assert shipped["pack"].mass == pytest.approx(60.0)
    assert shipped["ball"].volume == pytest.approx(math.pi / 6.0)
    assert shipped["wire"].mass == pytest.approx(21.0, rel=2e-3)
    assert shipped["wire"].volume == pytest.approx(math.pi * 0.004**2 * 99.9, rel=1e-3)
    assert (shipped["rope"].mass, shipped["rope"].missing_masses) == (0.0, 1)
    total = all_shipped(deck.shipped)
    assert total.count == len(deck.parts)
    assert total.mass == pytest.approx(sum(one.mass for one in deck.shipped))
    assert total.missing_masses == 1


def test_what_hangs_at_each_stage(deck):
    lifts = {one.label: one for one in deck.lifts.deployment}
    assert (lifts["top float"].mass, lifts["top float"].hanging) == (250.0, -2500.0)
    assert deck.lifts.heaviest is not None and deck.lifts.heaviest.label == "weight"
    # what hangs in the end is all that the line weighs in water
    weights = [one.wet_weight for one in calm.check(deck.result.design).inventory]
    assert deck.lifts.deployment[-1].hanging == pytest.approx(sum(weights))
    # hauled in from the top, the release hangs alone at last, and nothing of what stays is lifted
    assert deck.lifts.recovery[-1].label == "release"
    assert deck.lifts.recovery[-1].hanging == pytest.approx(220.0)
    assert deck.lifts.recovery[0].hanging == pytest.approx(
        deck.lifts.deployment[[*lifts].index("release")].hanging
    )
    lacking = [one.label for one in deck.assessment.inventory if one.dry_mass is None]
    assert lacking and deck.lifts.unknown == tuple(lacking)
    text = " ".join(map(str, lifts_part(deck).blocks[0].lines))
    assert all(label in text for label in lacking)


def test_surfacing_is_in_order_of_time(deck):
    times = [one.time for one in deck.recovery if one.time is not None]
    assert times == sorted(times)
    assert deck.rise is not None
    assert times[0] == deck.rise.time_to_surface
    first = deck.recovery[0].item
    assert (first.label, first.deployed_serial, first.remark) == (
        "top float",
        "T2",
        "newly painted",
    )
    assert "rope" not in [one.item.label for one in deck.recovery]


def test_instruments_in_all_environments(moorings, deck):
    results = {
        name: one.solve() for name, one in zip(("own", "calm", "storm"), moorings, strict=True)
    }
    high = next(one for one in deck.instruments if one.item.label == "high")
    depths = {
        name: next(row.depth for row in result.clamps if row.label == "high")
        for name, result in results.items()
    }
    assert (high.shallowest.depth, high.shallowest.environment) == (depths["calm"], "calm")
    assert (high.deepest.depth, high.deepest.environment) == (depths["storm"], "storm")
    assert high.item.depth == depths["own"]
    tilts = [row.tilt for one in results.values() for row in one.clamps if row.label == "high"]
    assert high.greatest_tilt == max(tilts)
    still = deck.result.design.water.still()
    rope = deck.result.design.leg.equilibrium(still).position
    top = float(-rope[0, 2])
    # still water leaves the line upright: the clamp is as far below the top as its lengths say
    above = 1.0 + sum(one.stretched for one in deck.parts[1:4]) + 20.0
    assert high.still == pytest.approx(top + above, abs=0.1)
    # the floats have serial numbers; so has a shackle, which is hardware all the same
    floats = [f"glass {n}" for n in (1, 2, 3)]
    assert [one.item.label for one in deck.instruments] == [
        "top float", "high", "low", *floats, "release",
    ]  # fmt: skip


def test_parts_that_hold_an_instrument_are_instruments(tmp_path):
    own = {
        "ball, label: top float, serial: T1": "ball, label: top float",
        "pack, count: 3, serial: [a, b, c], label: glass": "float-45in-lr75, label: ADCP",
        "use: rope, length: 50 m": "use: rope, serial: R1, length: 50 m",
        "{use: ring-22-102}": "{use: ring-22-102, sampling: every 10 s, label: load cell}",
    }
    text = MOORING.replace("mass: 800 kg}\nenv", "mass: 800 kg, serial: W1}\nenv")
    for old, new in own.items():
        assert text.count(old) == 1
        text = text.replace(old, new)
    text = text.replace("800 kg", "3000 kg")
    (tmp_path / "m.yaml").write_text(text)
    sheets = deck_of([calm.load(tmp_path / "m.yaml")])
    held = ["load cell", "high", "low", "ADCP", "release"]
    assert [one.item.label for one in sheets.instruments] == held
    assert [row.label for row in printed_rows(sheets.deployment)][:3] == [
        "top float", "load cell", "shackle-16",
    ]  # fmt: skip
    # the drop reports the same parts, and the float
    assert isinstance(sheets.plan, DropPlan)
    assert {one.label for one in sheets.plan.depths} == {*held, "top float"}
    listed = [row[0].text for row in drop_part(sheets.plan).blocks[-1].rows]
    assert {"load cell", "ADCP", "release", "low (deepest of 2)"} <= {*listed}


def test_the_float_of_an_adcp_is_an_instrument():
    line = calm.load(shipped_folder("lines") / "upward-adcp-300m.yaml")
    held = [part.label for part in line.file.pieces if holds_instrument(part)]
    assert held[:2] == ["ADCP float", "meter 500 m"]
    assert not {"four wheels", "swivel", "wire 1"} & {*held}


def test_hardware_below_a_wire_is_in_the_row_of_the_wire(tmp_path):
    text = MOORING.replace("  - {use: pack,", "  - {use: shackle-13}\n  - {use: pack,")
    (tmp_path / "m.yaml").write_text(text)
    line = calm.load(tmp_path / "m.yaml")
    for order, end, joint in (
        (Order.ANCHOR_LAST, "lower", "13 mm shackle"),
        (Order.ANCHOR_FIRST, "upper", ""),
    ):
        sheets = deck_of([line], order)
        rows = {row.label: row for row in printed_rows(sheets.deployment)}
        assert hardware_text(rows["wire"].joints) == joint
        assert not rows["high"].joints and not rows["low"].joints
        log = repr(deployment_part(sheets))
        assert (f"wire; with 13 mm shackle at the {end} end" in log) == bool(joint)
    # without its serial number, the shackle above the wire is hardware of the wire, anchor first
    (tmp_path / "m.yaml").write_text(text.replace("shackle-16, serial: 4", "shackle-16"))
    sheets = deck_of([calm.load(tmp_path / "m.yaml")], Order.ANCHOR_FIRST)
    log = repr(deployment_part(sheets))
    assert "wire; with 16 mm shackle, 7/8 in ring, 13 mm shackle at the upper end" in log
    # the diagram draws it where it is, below the clamps
    drawn = [row.label for row in printed_rows(sheets.parts, drawn=True) if row.joints]
    assert "low" in drawn


def test_every_chain_is_cut_and_none_is_spooled(tmp_path):
    chain = "  - {use: chain-short-g30-13, length: 5 m, label: chain}\n  - {use: weight"
    text = MOORING.replace("  - {use: weight", chain)
    (tmp_path / "m.yaml").write_text(text)
    sheets = deck_of([calm.load(tmp_path / "m.yaml")])
    assert [(one.item.label, one.over, one.onto) for one in sheets.cuts] == [
        ("wire", 1, 2), ("rope", 2, 1), ("chain", None, None),
    ]  # fmt: skip
    assert sheets.cuts[-1].length == 5.0 and sheets.cuts[-1].effect is not None
    tables = cutting_part(sheets).blocks[:2]
    assert [table.title for table in tables] == ["Wires and ropes", "Chains"]
    assert [row[0].text for row in tables[1].rows] == ["chain"]
    heads = [[column.heading for column in table.columns] for table in tables]
    assert "onto drum" in heads[0] and "onto drum" not in heads[1]


def test_lists_and_logs_are_in_the_units_chosen(deck):
    show_in({"length": "ft"})
    parts = (cutting_part, deployment_part, hardware_part, shipping_part)
    shown = repr([part(deck) for part in parts])
    # the wire is 100 m long, its clamps at 20 and 60 m; the rope 50 m
    for feet in ("328.0", "65.6", "196.8", "164.0"):
        assert feet in shown
    assert "'ft'" in shown and "'m'" not in shown
