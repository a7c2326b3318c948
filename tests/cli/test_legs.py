"""`calm run` of nets of legs, their mistakes, and the other commands, which refuse them."""

from __future__ import annotations

import csv
import json
import re
from collections import Counter
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import xarray
from scipy.optimize import fsolve

from calm.case import load
from calm.case.adjustment import parse_change
from calm.case.explain import explain
from calm.checks.criterion import READINGS, pieces_of
from calm.cli.main import main
from calm.drawing.line_picture import LineKind, elevation_of, plan_of
from calm.errors import InputError, NoEquilibrium

NET = """\
name: Two floats and a pennant
environment:
  depth: 500 m
  current: {speed: 0.4 m/s, toward: 90 deg}
legs:
  main:
    line:
      - {use: sphere-steel-1250, label: main float}
      - {use: wire-jacketed-8, length: 150 m, clamps: [{use: sbe37, at: 20 m}]}
    bottom: {join: A}
  second:
    line:
      - {use: glass-17in, count: 4}
      - {use: wire-jacketed-8, length: 60 m}
    bottom: {join: A}
  pennant:
    line:
      - {use: wire-jacketed-8, length: 10 m, clamps: [{use: sbe37, at: 2 m}]}
      - {use: rcm11}
    top: {join: A}
    bottom: free
  stem:
    line:
      - {use: release-ar861}
      - {use: wire-jacketed-8, length: 200 m}
      - {use: anchor-wheels-4}
    top: {join: A}
"""


def run(*arguments: str | Path) -> int:
    return int(main([str(each) for each in arguments]))


@pytest.fixture
def net(tmp_path: Path) -> Path:
    file = tmp_path / "net.yaml"
    file.write_text(NET)
    return file


def document(file: Path, capsys: pytest.CaptureFixture[str]) -> dict[str, Any]:
    assert run("run", file, "--json", "-") == 0
    found: dict[str, Any] = json.loads(capsys.readouterr().out)
    return found


def test_the_table_goes_leg_by_leg(net: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert run("run", net, "--verbose") == 0
    said = capsys.readouterr().out
    for leg in (
        "main: free end to node A",
        "pennant: node A to free end",
        "stem: node A to anchor",
    ):
        assert leg in said
    assert "Converged" in said
    assert "in the balance of the nodes" in said
    assert max(map(len, said.splitlines())) <= 80


def test_json_has_the_title_block_and_serial_numbers(
    net: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    text = NET.replace("{use: rcm11}", "{use: rcm11, serial: 1729}")
    net.write_text(text + "document: {id: M-2026-17}\n")
    found = document(net, capsys)
    assert found["document"] == {"id": "M-2026-17"}
    assert [row["serial"] for row in found["components"] if "serial" in row] == ["1729"]


def test_json_has_the_legs(net: Path, capsys: pytest.CaptureFixture[str]) -> None:
    found = document(net, capsys)
    assert (found["type"], found["status"]) == ("net", "converged")
    by_leg = {row["label"]: row["leg"] for row in (*found["components"], *found["clamps"])}
    assert by_leg["main float"] == by_leg["sbe37 1"] == "main"
    assert by_leg["rcm11"] == by_leg["sbe37 2"] == "pennant"
    (node,) = found["nodes"]
    ends = [
        (row["depth_top"], row["x_top"]) for row in found["components"]
        if row["label"] in ("wire-jacketed-8 3", "release-ar861")
    ]  # fmt: skip
    for depth, east in ends:  # both begin at the node
        assert depth == pytest.approx(node["depth"], abs=1e-6)
        assert east == pytest.approx(node["x"], abs=1e-6)
    (anchor,) = found["anchors"]
    assert anchor == found["anchor"]
    assert (anchor["leg"], anchor["x"], anchor["y"]) == ("stem", 0.0, 0.0)
    assert [leg["name"] for leg in found["legs"]] == ["main", "second", "pennant", "stem"]


def test_the_anchor_bears_all_that_floats_and_hangs(
    net: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """Vertically the net is a sum of net forces, wherever it stands: currents are level here."""
    found = document(net, capsys)
    total = 0.0
    case = load(net)
    for leg in case.legs:
        total += float(leg.line.total_buoyancy.sum())
    # what drag lifts and presses is some newtons of the seven thousand
    assert found["anchors"][0]["vertical"] == pytest.approx(total, rel=0.01)


def test_an_instrument_that_hangs_is_below_the_node(
    net: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    found = document(net, capsys)
    clamp = next(row for row in found["clamps"] if row["label"] == "sbe37 2")
    assert clamp["depth"] == pytest.approx(found["nodes"][0]["depth"] + 2.0, abs=0.05)
    meter = next(row for row in found["components"] if row["label"] == "rcm11")
    assert meter["depth_top"] == pytest.approx(found["nodes"][0]["depth"] + 10.0, abs=0.2)
    assert all(-1.0 < row["knockdown"] < 5.0 for row in found["components"])


def test_in_still_water_nothing_is_knocked_down(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    file = tmp_path / "still.yaml"
    file.write_text(NET.replace("0.4 m/s", "0 m/s"))
    found = document(file, capsys)
    assert [row["knockdown"] for row in found["components"]] == pytest.approx(
        [0.0] * len(found["components"]), abs=1e-9
    )
    # straight up: 199.3 m of stem and the release above an anchor of 0.7 m, a little stretched
    assert found["nodes"][0]["depth"] == pytest.approx(500.0 - 0.7 - 200.0 - 0.83, abs=1.5)


@pytest.mark.parametrize("command", ["waves", "motion"])
def test_other_commands_say_which_one_solves_nets(
    command: str, net: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    more: dict[str, list[str | Path]] = {
        "waves": ["--hs", "2 m", "--tp", "8 s"],
        "motion": ["--pressures", net, "-o", tmp_path / "m.nc"],
    }
    assert run(command, net, *more.get(command, [])) == 2
    told = capsys.readouterr().err
    assert f"{net}: this file is a net of legs" in told
    assert "Only `calm run`, `check`, `batch`, `deck`, `size`, `diff` and `export`" in told


def test_a_net_goes_to_moordyn_and_back(
    net: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """Where it was: but floats are points there, of the pull that they have here."""
    there, back = tmp_path / "net.txt", tmp_path / "back.yaml"
    assert run("export", net, "--to", "moordyn", "-o", there) == 0
    assert run("import", there, "-o", back) == 0
    given, found = load(net).solve(), load(back).solve()
    assert len(found.legs) == 4
    before, after = given.nodes[0], found.nodes[0]
    assert [after.x, after.y, after.depth] == pytest.approx(
        [before.x, before.y, before.depth], abs=0.1
    )
    assert found.anchors[0].tension == pytest.approx(given.anchors[0].tension, rel=2e-3)
    assert run("export", net, "--to", "csv", "-o", tmp_path / "out.csv") == 2
    assert "does not support; use `--to moordyn`" in capsys.readouterr().err
    assert not (tmp_path / "out.csv").exists()


def test_check_judges_every_leg(
    net: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert run("check", net, "--report", tmp_path / "report", "--workers", 1) == 1
    said = capsys.readouterr()
    assert "launch, recovery and waves are not" in said.err
    assert "net of legs, 500 m of water" in said.out and said.out.splitlines()[1][:5] == "FAILS"
    report = json.loads((tmp_path / "report" / "report.json").read_text())
    (in_environments,) = report["situations"].values()
    assert {each["environment"] for each in in_environments if each["anchor_vertical"]} == {
        "own: stem"
    }
    (items,) = report["inventory"].values()
    assert [each["label"] for each in items if each["kind"] == "anchor"] == ["anchor-wheels-4"]
    page = (tmp_path / "report" / "report.html").read_text()
    assert "net" in page and "main float" in page and "wire-jacketed-8 3" in page


def test_check_refuses_to_count_samples_of_a_net(
    net: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert run("check", net, "--uncertainty") == 2
    assert "--uncertainty is only for single lines" in capsys.readouterr().err


def test_options_for_single_lines_are_refused(
    net: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert run("run", net, "--uncertainty") == 2
    assert "--uncertainty is only for single lines" in capsys.readouterr().err


def test_files_of_a_net_have_the_leg_of_each_part(
    net: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert run("run", net, "-o", tmp_path / "net.csv", "-o", tmp_path / "net.nc") == 0
    rows = list(csv.DictReader((tmp_path / "net.csv").read_text(encoding="utf-8").splitlines()))
    assert [row["leg"] for row in rows if row["part"] == "clamp"] == ["main", "pennant"]
    with xarray.open_dataset(tmp_path / "net.nc", engine="h5netcdf") as found:
        names = found["leg_label"].values
        legs = [row["leg"] for row in rows if row["part"] == "component"]
        assert names[found["component_leg"].values].tolist() == legs
        assert names[found["clamp_leg"].values].tolist() == ["main", "pennant"]
        assert np.isfinite(found["anchor_vertical"].values).tolist() == [False] * 3 + [True]
        assert np.isfinite(found["top_depth"].values).tolist() == [True, True, False, False]
        main = found["shape_depth"].values[found["node_leg"].values == 0]
        assert (main[0], main[-1]) == (found["depth_top"].values[0], main.max())
        assert "of the origin" in found["x_top"].attrs["long_name"]


def test_a_batch_gives_what_run_gives_in_every_profile(
    net: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """Within a tenth of what is promised of batches: 1e-4 of the depth and 2e-4 of tensions."""
    record, result = tmp_path / "record.csv", tmp_path / "r.nc"
    record.write_text(
        "time,depth[m],u[m/s],v[m/s]\n"
        "2024-01-01T00:00,0,0.4,0\n2024-01-01T00:00,500,0.4,0\n"
        "2024-01-01T01:00,0,,\n2024-01-01T01:00,500,,\n"
    )
    assert run("batch", net, "--currents", record, "-o", result) == 0
    said = capsys.readouterr()
    assert "1 of 2 profiles are NaN: 1 without data (1 no-current)" in said.err
    given = document(net, capsys)
    with xarray.open_dataset(result, engine="h5netcdf") as found:
        assert found["component_label"].values.tolist() == [
            row["label"] for row in given["components"]
        ]
        for name in ("depth_top", "x_top", "tension_bottom", "tilt", "knockdown"):
            expected = np.array([row[name] for row in given["components"]])
            assert found[name].values[0] == pytest.approx(expected, rel=2e-5, abs=5e-3)
        clamps = [row["depth"] for row in given["clamps"]]
        assert found["clamp_depth"].values[0] == pytest.approx(clamps, abs=5e-3)
        pull = given["anchors"][0]
        assert found["anchor_vertical"].values[0, 3] == pytest.approx(pull["vertical"], rel=2e-5)
        assert np.isnan(found["depth_top"].values[1]).all()
    summary = json.loads((tmp_path / "r.summary.json").read_text())
    assert summary["responses"]["anchor_tension"]["distribution"]["maximum"] == pytest.approx(
        pull["tension"], rel=2e-5
    )
    limits = [(one["rule"], one["component"]) for one in summary["limits"]]
    assert ("anchor-weight", "anchor-wheels-4") in limits
    assert sum(rule == "top-depth" for rule, _ in limits) == 2


def test_an_offset_is_that_from_the_own_anchor(tmp_path: Path) -> None:
    """Two equal moorings 200 m apart in one file stand alike."""
    leg = """
    line: [{use: sphere-steel-1250}, {use: wire-jacketed-8, length: 60 m}, {use: anchor-wheels-4}]
"""
    text = f"""
environment: {{depth: 100 m, current: {{speed: 0.3 m/s, toward: 90 deg}}}}
legs:
  one:{leg}  two:{leg}    bottom: {{anchor: {{at: [200 m, 0 m]}}}}
"""
    one, two = load(tmp_path / "two.yaml", text=text).solve().legs
    part = pieces_of(one.leg)[0]
    offset = READINGS["offset"](one, part)
    assert offset == pytest.approx(one.top.x, rel=1e-12)
    assert READINGS["offset"](two, part) == pytest.approx(offset, rel=1e-9)


def test_a_net_is_drawn_from_the_side_and_above(net: Path) -> None:
    result = load(net).solve()
    side, above = elevation_of(result), plan_of(result)
    kinds = Counter(line.kind for line in side.lines)
    assert kinds == {LineKind.STILL: 4, LineKind.LINE: 4}
    assert [line.label for line in side.lines if line.label] == [
        "in still water", "in the current"
    ]  # fmt: skip
    (node,) = result.nodes
    drawn = [line for line in side.lines if line.kind is LineKind.LINE]
    for line in drawn:  # every leg has an end at the node
        gaps = [np.hypot(line.x[end] - node.x, line.y[end] - node.depth) for end in (0, -1)]
        assert min(gaps) == pytest.approx(0.0, abs=1e-6)
    # the current goes east, and so does the plane; nothing leaves it
    assert side.across.endswith("towards 090°")
    assert max(np.abs(line.y).max() for line in above.lines) < 1e-9
    roles = Counter(mark.role for mark in side.marks)
    assert roles == {"float": 5, "instrument": 3, "release": 1, "anchor": 1}
    assert side.seabed == 500.0


def test_the_seabed_is_drawn_where_it_slopes(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """About each anchor at its depth, by its slope along the picture; a level one as before."""
    file = tmp_path / "slope.yaml"
    file.write_text(SLOPE)
    beds = [
        line
        for line in elevation_of(load(file).solve()).lines
        if line.kind is LineKind.SEABED
    ]  # fmt: skip
    steep = np.tan(np.radians(10.0))
    assert len(beds) == 2
    for line, anchor in zip(beds, (-30.0, 30.0), strict=True):
        assert line.x.min() <= anchor + 1e-6
        assert line.x.max() >= anchor - 1e-6
        assert line.y == pytest.approx(100.0 + steep * line.x, abs=1e-3)
    assert run("run", file, "-o", tmp_path / "slope.svg") == 0
    assert run("check", file, "--report", tmp_path / "report", "--workers", 1) == 1
    capsys.readouterr()


def test_a_net_has_its_page_and_its_schematics(
    net: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    page = tmp_path / "net.html"
    assert run("run", net, "--schematic", "-o", page) == 0
    said, html = capsys.readouterr().out, page.read_text()
    assert html.count("<svg") == 5  # of four legs, and the picture of all
    for leg in ("main: free end to node A", "stem: node A to anchor"):
        assert f"Schematic of leg {leg}" in html
    # only the leg that is anchored stands on the seabed
    assert said.count("▒ seabed") == 1
    assert said.count("~ sea surface") == 4


def test_an_anchor_that_is_lifted_is_no_result(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    file = tmp_path / "light.yaml"
    file.write_text(NET.replace("anchor-wheels-4", "anchor-wheels-1"))
    assert run("run", file) == 3
    assert "anchor-lifts: The vertical load of leg stem is" in capsys.readouterr().err


MISTAKES = {
    "bottom: {join: A}\n  second": ("bottom: {join: B}\n  second", "no other leg joins at `B`"),
    "top: {join: A}\n    bottom: free": ("bottom: free", "both ends are free"),
    "bottom: free": ("bottom: fre", "must be `free`, or one of"),
    "top: {join: A}\n    bottom": ("top: {join: A, held: {depth: 1 m}}\n    bottom", "exactly one"),
    "      - {use: anchor-wheels-4}\n": ("", "`bottom` is missing"),
    "      - {use: release-ar861}\n": (
        "      - {use: anchor-wheels-1}\n", "must be the last item of its leg"),
    "length: 60 m": ("length: fit, top_depth: 100 m", "cannot be cut to fit"),
    "legs:\n": ("nodes: {A: {}, X: {}}\nlegs:\n", "no leg joins at node `X`"),
    "name: Two floats and a pennant\n": (
        "line: [{use: anchor-wheels-1}]\n", "`line` and `legs` exclude each other"),
    "  pennant:\n    line:": ("  pennant:\n    lin:", "did you mean `line`?"),
    "top: {join: A}\n    bottom: fr": (
        "top: {held: {depth: 600 m}}\n    bottom: fr",
        "must be above the seabed, which is 500 m deep"),
}  # fmt: skip


@pytest.mark.parametrize("place", MISTAKES)
def test_mistakes_have_their_place(place: str, tmp_path: Path) -> None:
    right, expected = MISTAKES[place]
    assert place in NET
    with pytest.raises(InputError) as refused:
        load(tmp_path / "bad.yaml", text=NET.replace(place, right, 1))
    told = [str(problem) for problem in refused.value.problems]
    hits = [each for each in told if expected in each]
    assert len(hits) == 1, told
    assert re.search(r"bad\.yaml:\d+:\d+: ", hits[0])


def test_all_mistakes_come_at_once(tmp_path: Path) -> None:
    text = NET.replace("glass-17in", "glas-17in").replace("length: 10 m", "length: 10")
    text = text.replace("bottom: {join: A}\n  second", "bottom: {join: B}\n  second")
    with pytest.raises(InputError) as refused:
        load(tmp_path / "bad.yaml", text=text)
    assert len(refused.value.problems) == 3


def test_what_nothing_holds_is_refused(tmp_path: Path) -> None:
    loose = NET[: NET.index("  stem:")]
    with pytest.raises(InputError, match="leg `main` is connected to no anchor"):
        load(tmp_path / "loose.yaml", text=loose)


def test_ends_that_are_held_bear_what_pulls_them(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """A wire between a pier and a second anchor, and a string that hangs from a ship."""
    file = tmp_path / "held.yaml"
    file.write_text("""\
environment: {depth: 100 m}
legs:
  hang:
    line: [{use: wire-jacketed-8, length: 20 m}, {use: rcm11}]
    top: {held: {depth: 3 m, at: [5 m, -2 m]}}
    bottom: free
  span:
    line: [{use: wire-jacketed-8, length: 120 m}, {use: anchor-wheels-4}]
    top: {held: {depth: 3 m}}
    bottom: {anchor: {at: [60 m, 0 m], depth: 95 m}}
""")
    found = document(file, capsys)
    hang, span = found["held"]
    case = load(file)
    weight = -float(case.legs[0].line.total_buoyancy.sum())
    assert hang["vertical"] == pytest.approx(-weight, rel=1e-9)
    assert hang["horizontal"] == pytest.approx(0.0, abs=1e-6)
    assert (hang["x"], hang["y"], hang["depth"]) == pytest.approx((5.0, -2.0, 3.0))
    weight = -float(case.legs[1].line.total_buoyancy.sum())
    (anchor,) = found["anchors"]
    # in still water the pulls at both ends bear the weight between them, less what lies on the bed
    lying = weight * anchor["grounded_length"] / 120.0
    assert span["vertical"] + anchor["vertical"] == pytest.approx(lying - weight, rel=1e-6)
    assert span["horizontal"] == pytest.approx(anchor["horizontal"], rel=1e-6)
    assert "anchor" in found


def test_what_hangs_in_the_air_weighs_more(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """Two catenaries that meet at the surface, of one pull H and of the weights in air and water.

    Down to its length s the line bears V - w s: with asinh of the slopes each part gives its
    distance and its height. The reference does not stretch, nor does the line.
    """
    file = tmp_path / "air.yaml"
    file.write_text("""\
environment: {depth: 100 m, density: 1025 kg/m^3, gravity: 9.81 m/s^2}
legs:
  span:
    line: [{use: wire, length: 140 m}, {use: block}]
    top: {held: {depth: -20 m}}
    bottom: {anchor: {at: [60 m, 0 m]}}
components:
  wire: {kind: cable, diameter: 20 mm, weight: 16 N/m, mass: 2 kg/m, cn: 0, ct: 0}
  block: {kind: anchor, weight: 1e6 N}
""")
    found = document(file, capsys)
    volume = (2.0 - 16.0 / 9.80665) / 1025.0  # of a metre, by its mass and weight
    heavy = 16.0 + (1025.0 - 1.225) * 9.81 * volume

    def part(pull: float, up: float, weight: float, length: float) -> tuple[float, float, float]:
        low = up - weight * length
        across = pull / weight * (np.arcsinh(up / pull) - np.arcsinh(low / pull))
        down = (np.hypot(pull, up) - np.hypot(pull, low)) / weight
        return across, down, low

    def miss(x: tuple[float, float, float]) -> list[float]:
        pull, up, dry = 1e3 * x[0], 1e3 * x[1], 10.0 * x[2]
        east, down, left = part(pull, up, heavy, dry)
        more, deeper, _ = part(pull, left, 16.0, 140.0 - dry)
        return [down - 20.0, deeper - 100.0, east + more - 60.0]

    pull, up, _ = fsolve(miss, (0.5, 2.4, 2.1), xtol=1e-12)
    (held,) = found["held"]
    # the water turns into air within a millimetre; 5e-5 is what the net is solved to
    assert held["horizontal"] == pytest.approx(1e3 * pull, rel=1e-4)
    assert held["vertical"] == pytest.approx(-1e3 * up, rel=1e-4)


def test_legs_that_are_too_short_are_named(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """80 m and 60 m of wire meet between anchors 200 m apart; the third leg goes nowhere else."""
    file = tmp_path / "short.yaml"
    file.write_text("""\
environment: {depth: 100 m}
legs:
  west:
    line: [{use: wire-jacketed-8, length: 80 m}, {use: anchor-wheels-4}]
    top: {join: A}
  east:
    line: [{use: wire-jacketed-8, length: 60 m}, {use: anchor-wheels-4}]
    top: {join: A}
    bottom: {anchor: {at: [200 m, 0 m]}}
  float:
    line: [{use: sphere-steel-1250}]
    bottom: {join: A}
""")
    assert run("run", file) == 3
    told = capsys.readouterr().err
    assert "no-equilibrium: Legs" in told
    assert "140.00 m long in total, but the ends are held 200.00 m apart" in told


def test_rope_that_would_surface_is_told_by_the_float_of_its_leg(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    file = tmp_path / "rope.yaml"
    file.write_text("""\
environment: {depth: 85 m}
legs:
  marker:
    line:
      - {use: sphere-ore-28in, label: marker buoy}
      - {use: polypropylene-16, length: 100 m}
      - {use: anchor-wheels-1}
""")
    assert run("run", file) == 3
    told = capsys.readouterr().err
    assert "above-surface: Besides marker buoy (piece 1), other parts of the leg would" in told


SLOPE = """\
environment:
  depth: 100 m
  current: {speed: 0.2 m/s, toward: 0 deg}
  seabed: {slope: 10 deg, toward: 90 deg}
legs:
  west:
    line: [{use: wire-jacketed-8, length: 60 m}, {use: anchor-wheels-4, label: west}]
    top: {join: A}
    bottom: {anchor: {at: [-30 m, 0 m]}}
  east:
    line: [{use: wire-jacketed-8, length: 60 m}, {use: anchor-wheels-4, label: east}]
    top: {join: A}
    bottom: {anchor: {at: [30 m, 0 m]}}
  float:
    line: [{use: sphere-steel-1250}]
    bottom: {join: A}
"""


def test_anchors_stand_on_a_seabed_that_slopes_and_hold_less(tmp_path: Path) -> None:
    """Depths by the plane; the weight against that of which H pulls straight down the slope."""
    result = load(tmp_path / "slope.yaml", text=SLOPE).solve()
    rise = 30.0 * np.tan(np.radians(10.0))
    west, east = (anchor.depth for anchor in result.anchors)
    assert (west, east) == pytest.approx((100.0 - rise - 0.7, 100.0 + rise - 0.7), abs=1e-6)
    slope = np.radians(10.0)
    for anchor in result.anchors:
        # the least weight w, 1.5 of which is asked for: along the slope H cos + w sin, and friction
        # 0.6 of w cos - H sin on it
        pull = anchor.horizontal
        w = pull * (np.cos(slope) + 0.6 * np.sin(slope)) / (0.6 * np.cos(slope) - np.sin(slope))
        assert anchor.required_weight == pytest.approx(1.5 * (anchor.vertical + w), rel=1e-9)


def test_an_anchor_that_slides_by_itself_is_a_mistake(tmp_path: Path) -> None:
    """The angle of friction of 0.6 is 31 degrees."""
    text = SLOPE.replace("slope: 10 deg", "slope: 32 deg")
    with pytest.raises(
        InputError, match=r"slides under its own weight .* it holds on slopes of less than 31°"
    ):
        load(tmp_path / "slope.yaml", text=text)


def test_a_line_that_hangs_into_the_slope_is_refused(tmp_path: Path) -> None:
    """A wire held over the bed sags below it where the water is shallower than at its end."""
    text = (
        SLOPE[: SLOPE.index("legs:")].replace("10 deg", "25 deg")
        + """\
legs:
  span:
    line: [{use: wire-jacketed-8, length: 130 m}]
    top: {held: {depth: 60 m, at: [-60 m, 0 m]}}
    bottom: {held: {depth: 60 m, at: [40 m, 0 m]}}
"""
    )
    with pytest.raises(NoEquilibrium, match=r"touch the seabed: wire-jacketed-8"):
        load(tmp_path / "slope.yaml", text=text).solve()
    level = text.replace("slope: 25 deg", "slope: 0 deg")
    assert load(tmp_path / "level.yaml", text=level).solve().status == "converged"


def test_the_anchor_of_a_line_is_judged_on_the_slope(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """Level, 0.6 of friction; on 10 degrees tan(arctan 0.6 - 10°), in every rule and figure."""
    file = tmp_path / "line.yaml"
    above = "{use: sphere-steel-1250}, {use: wire-jacketed-8, length: 60 m}"
    line = f"line: [{above}, {{use: anchor-wheels-4}}]"
    file.write_text(SLOPE[: SLOPE.index("legs:")] + line)
    anchor = document(file, capsys)["anchor"]
    friction = np.tan(np.arctan(0.6) - np.radians(10.0))
    assert anchor["friction"] == pytest.approx(friction, rel=1e-12)
    needed = 1.5 * (anchor["vertical"] + anchor["horizontal"] / friction)
    assert anchor["required_weight"] == pytest.approx(needed, rel=1e-9)
    run("check", file, "--json", "-", "--all-findings", "--workers", 1)
    findings = json.loads(capsys.readouterr().out)["findings"]
    (sliding,) = (
        each for each in findings
        if each["rule"] == "anchor-sliding" and each["situation"] == "as given"
    )  # fmt: skip
    assert "on a slope of 10°" in sliding["message"]
    held = friction * (anchor["weight"] / 1.5 - anchor["vertical"])
    assert sliding["limit"] == pytest.approx(held, rel=1e-9)


@pytest.mark.thorough
def test_the_deck_of_a_net_lists_it_leg_by_leg(
    net: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert run("deck", net, "-o", tmp_path / "deck") == 0
    assert "launch, recovery and waves are not checked" in capsys.readouterr().err
    sheets = {
        name: [*csv.DictReader((tmp_path / "deck" / f"{name}.csv").read_text().splitlines())]
        for name in ("deployment", "recovery", "cutting", "lifts", "parts")
    }
    assert Counter(row["leg"] for row in sheets["deployment"]) == {
        "main": 3, "second": 5, "pennant": 3, "stem": 3,
    }  # fmt: skip
    # all but the anchor comes up: the release is the top of its leg
    assert [row["label"] for row in sheets["recovery"]][-1] == "release-ar861"
    weights = [float(row["weight_in_water[N]"]) for row in sheets["parts"] if row["leg"] == "stem"]
    last = sheets["lifts"][11]  # leg by leg: what hangs with the anchor is its own leg
    assert (last["label"], last["leg"]) == ("anchor-wheels-4", "stem")
    assert float(last["hanging[N]"]) == pytest.approx(sum(weights), rel=1e-9)
    assert json.loads((tmp_path / "deck" / "plan.json").read_text())["status"] == "net"
    diagram = (tmp_path / "deck" / "diagram.svg").read_text()
    for words in ("main: free end to node A", "from node A", "pennant: node A to free end"):
        assert words in diagram
    # by how much the top of its leg is deeper where a wire is half a percent longer
    longer = tmp_path / "longer.yaml"
    longer.write_text(NET.replace("length: 150 m", "length: 150.75 m"))
    before, after = (load(file).solve().components.depth_top[0] for file in (net, longer))
    row = next(row for row in sheets["cutting"] if row["leg"] == "main")
    effect = float(row["top_deeper_by_half_percent[m]"])
    # both within the errors that they state, some millimetres
    assert effect == pytest.approx(after - before, abs=5e-3)
    assert effect == pytest.approx(-0.75, abs=0.02)


ONE_LINE = """\
name: One line
environment: {depth: 200 m, current: {speed: 0.6 m/s, toward: 70 deg}}
line:
  - {use: sphere-steel-1250, label: float}
  - {use: wire-jacketed-8, length: 60 m, label: upper, clamps: [{use: sbe37, at: 20 m}]}
  - {use: rcm11}
  - {use: wire-jacketed-8, length: 80 m, label: lower}
  - {use: anchor-wheels-4}
"""


@pytest.mark.thorough
def test_a_net_of_one_line_cut_in_two_is_explained_as_the_line(tmp_path: Path) -> None:
    """Both by the same integral, one by the search of a line, one by the slopes of a net."""
    text = ONE_LINE.replace("line:\n", "legs:\n  above:\n    line:\n").replace("  - {", "      - {")
    text = text.replace("      - {use: wire-jacketed-8, length: 80 m, label: lower}",
                        "    bottom: {join: A}\n  below:\n    top: {join: A}\n    line:\n"
                        "      - {use: wire-jacketed-8, length: 80 m, label: lower}")  # fmt: skip
    one, two = tmp_path / "one.yaml", tmp_path / "two.yaml"
    one.write_text(ONE_LINE)
    two.write_text(text)
    results = [load(file).solve() for file in (one, two)]
    for label in ("float", "sbe37", "lower"):
        line, net = (explain(result, label) for result in results)  # type: ignore[arg-type]
        assert line.causes is not None and net.causes is not None
        assert net.causes.label == line.causes.label
        assert net.quantities == line.quantities
        for name in ("drag", "knockdown", "excursion"):
            # the shares are scaled to figures that state errors of a few 1e-5 of themselves
            expected = getattr(line.causes, name)
            assert getattr(net.causes, name) == pytest.approx(expected, rel=2e-3, abs=1e-4), name
        assert net.without_drag["excursion"] == pytest.approx(0.0, abs=1e-3)
        for ours, theirs in zip(net.changes, line.changes, strict=True):
            assert ours.figures is not None and theirs.figures is not None
            assert ours.figures.excursion == pytest.approx(theirs.figures.excursion, rel=1e-3)


@pytest.mark.thorough
def test_a_net_is_explained(net: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert run("run", net, "--explain", "--json", "-") == 0
    found = json.loads(capsys.readouterr().out)["explain"]
    assert found["label"] == "main float"
    for name in ("knockdown", "excursion"):
        whole = found["figures"][name] - found["without_drag"][name]
        assert sum(row[name] for row in found["causes"]) == pytest.approx(whole, rel=1e-6)
    assert {row["label"] for row in found["causes"]} >= {"rcm11", "sbe37 2", "release-ar861"}


@pytest.mark.thorough
def test_a_piece_of_a_net_is_sized(net: Path, capsys: pytest.CaptureFixture[str]) -> None:
    change = ["--change", "main float.buoyancy", "--json", "-"]
    assert run("size", net, "--target", "required_weight(stem) <= 10 kN", *change) == 0
    found = json.loads(capsys.readouterr().out)
    sphere = f"use: sphere-steel-1250, buoyancy: {found['after']['value']} N"
    net.write_text(NET.replace("use: sphere-steel-1250", sphere))
    (anchor,) = document(net, capsys)["anchors"]
    assert anchor["required_weight"] == pytest.approx(10e3, rel=1e-5)
    assert run("size", net, "--target", "knockdown <= 1 m", *change) == 2
    assert "name a piece: `knockdown(LABEL)`" in capsys.readouterr().err


def test_more_floats_in_one_leg_move_no_other(net: Path) -> None:
    file = load(net).file
    four = parse_change("glass-17in.count", file)
    seven = four.to(7.0)
    assert [piece.label for piece in seven.pieces if piece.use == "glass-17in"][
        -1
    ] == "glass-17in 7"
    lines = [[piece.use for piece in seven.pieces[leg.first : leg.end]] for leg in seven.legs]
    assert [len(line) for line in lines] == [2, 8, 2, 3]
    assert lines[3] == ["release-ar861", "wire-jacketed-8", "anchor-wheels-4"]


@pytest.mark.thorough
def test_two_nets_are_compared(
    net: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    other = tmp_path / "other.yaml"
    other.write_text(
        NET.replace("length: 60 m", "length: 70 m")
        .replace("    top: {join: A}\n    bottom: free", "    top: {join: B}\n    bottom: free")
        .replace("    bottom: {join: A}\n  pennant", "    bottom: {join: B}\n  pennant")
        + "  link:\n    line: [{use: wire-jacketed-8, length: 5 m}]\n"
        "    top: {join: B}\n    bottom: {join: A}\n"
    )
    assert run("diff", net, other, "--json", "-") == 0
    found = json.loads(capsys.readouterr().out)
    changed = {row["where"]: (row["from"], row["to"]) for row in found["changed"]}
    assert changed["legs.pennant.top.join"] == ("A", "B")
    assert changed["wire-jacketed-8 2.length"] == (60.0, 70.0)
    figures = {row["name"]: (row["from"], row["to"]) for row in found["figures"]}
    with_link = document(other, capsys)
    depths = {node["name"]: node["depth"] for node in with_link["nodes"]}
    assert figures["A.depth"][1] == pytest.approx(depths["A"], abs=1e-6)
    assert figures["B.depth"][0] is None
    assert figures["stem.anchor.tension"][1] == pytest.approx(with_link["anchor"]["tension"])
    uses = [pair for name, pair in figures.items() if name.startswith("utilisation.")]
    assert any(pair != (None, None) for pair in uses)


@pytest.mark.thorough
def test_a_net_is_compared_with_what_was_deployed_of_it(
    net: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    deployed = "deployed: {depth: 510 m, items: [{label: wire-jacketed-8 4, length: 205 m}]}\n"
    net.write_text(NET + deployed)
    assert run("diff", net, "--json", "-") == 0
    figures = {row["name"]: row for row in json.loads(capsys.readouterr().out)["figures"]}
    moved = figures["A.depth"]["to"] - figures["A.depth"]["from"]
    # ten metres deeper on a stem, little inclined, that is five metres longer
    assert moved == pytest.approx(5.0, abs=0.05)


def gridded(folder: Path, depth: Any, name: str = "elevation", sign: float = -1.0) -> Path:
    """A grid about 48 N 355 E, nodes some 30 m apart, of depths by metres east and north."""
    latitude, longitude = 48.0 + np.arange(-40, 41) * 3e-4, 355.0 + np.arange(-40, 41) * 4e-4
    metres = 111.2e3 * np.cos(np.radians(48.0))
    east, north = (longitude - 355.0) * metres, (latitude - 48.0) * 111.2e3
    values = sign * np.array([[depth(e, n) for e in east] for n in north])
    file = folder / "grid.nc"
    xarray.Dataset({name: (("lat", "lon"), values)}, {"lat": latitude, "lon": longitude}).to_netcdf(
        file, engine="h5netcdf"
    )
    return file


GRIDDED = "position: {latitude: 48 deg, longitude: -5 deg}\n" + SLOPE.replace(
    "{slope: 10 deg, toward: 90 deg}", "{file: grid.nc}"
)


@pytest.mark.parametrize(("name", "sign"), [("elevation", -1.0), ("depth", 1.0)])
def test_a_grid_of_a_plane_is_the_plane(tmp_path: Path, name: str, sign: float) -> None:
    """A plane is exact between nodes; the grid lies on the ellipsoid, here taken as a sphere."""
    steep = np.tan(np.radians(10.0))
    gridded(tmp_path, lambda east, north: 90.0 + steep * east, name, sign)
    plane = load(tmp_path / "slope.yaml", text=SLOPE).solve()
    grid = load(tmp_path / "grid.yaml", text=GRIDDED).solve()
    for ours, theirs in zip(grid.anchors, plane.anchors, strict=True):
        assert ours.depth == pytest.approx(theirs.depth, abs=0.03)  # 5 m by 0.4 %: the sphere
        assert ours.required_weight == pytest.approx(theirs.required_weight, rel=0.01)


def test_a_grid_is_read_in_its_unit_and_its_sign(tmp_path: Path) -> None:
    """Feet; depths by the name of elevations, as land or by `positive`; a doubtful depth."""
    file = gridded(tmp_path, lambda east, north: (90.0 + 0.1 * east) / 0.3048)
    feet = load(tmp_path / "grid.yaml", text=GRIDDED)
    assert any("295.3 m deep" in each for each in feet.solve().warnings)
    grid = xarray.load_dataset(file, engine="h5netcdf")
    grid["elevation"].attrs["units"] = "ft"
    grid.to_netcdf(file, engine="h5netcdf")
    metres = load(tmp_path / "grid.yaml", text=GRIDDED).solve()
    west, east = (anchor.depth for anchor in metres.anchors)
    away = metres.anchors[1].x - metres.anchors[0].x
    assert abs(east - west) == pytest.approx(0.1 * abs(away), rel=0.01)
    assert not any("m deep" in each for each in metres.warnings)
    (-grid).to_netcdf(file, engine="h5netcdf")
    with pytest.raises(InputError, match=r"has land, .* m high, .* to `down`"):
        load(tmp_path / "grid.yaml", text=GRIDDED)
    turned = -grid
    turned["elevation"].attrs |= {"units": "ft", "positive": "down"}
    turned.to_netcdf(file, engine="h5netcdf")
    again = load(tmp_path / "grid.yaml", text=GRIDDED).solve()
    assert [each.depth for each in again.anchors] == [west, east]


def test_an_anchor_up_the_slope_stands_in_water(tmp_path: Path) -> None:
    """500 m up a slope of 25° the seabed is 233 m higher, where the water is 100 m deep."""
    text = SLOPE.replace("slope: 10 deg", "slope: 25 deg")
    at = re.search(r"at: \[.*?\]", text)
    assert at is not None
    with pytest.raises(InputError, match=r"the seabed \d+ m above the surface at this anchor"):
        load(tmp_path / "slope.yaml", text=text.replace(at[0], "at: [-500 m, 0 m]"))


LYING = (
    "position: {latitude: 48 deg, longitude: -5 deg}\n"
    + SLOPE[: SLOPE.index("legs:")].replace("toward: 0 deg}", "toward: 45 deg}")
    + """\
line:
  - {use: sphere-steel-1250}
  - {use: wire-jacketed-8, length: 60 m}
  - {use: chain-buoy-16, length: 100 m}
  - {use: anchor-wheels-4}
"""
)


def test_a_line_lies_on_the_plane_of_a_grid(tmp_path: Path) -> None:
    """In a plane as on that; in a bowl the grid is off it by up to x²/4000 where line lies."""
    steep = np.tan(np.radians(10.0))
    plane = load(tmp_path / "plane.yaml", text=LYING).solve()
    assert plane.anchor.grounded_length > 40.0
    assert not any("bight" in warning for warning in plane.warnings)
    text = LYING.replace("{slope: 10 deg, toward: 90 deg}", "{file: grid.nc}")
    for bowl, off in ((0.0, 0.0), (1.0 / 4000.0, 0.2)):
        gridded(
            tmp_path,
            lambda e, n, b=bowl: 100.0 + steep * e - b * (e * e + n * n),
        )
        grid = load(tmp_path / "grid.yaml", text=text).solve()
        there, where = (
            np.array(
                [one.components.x_top[0], one.components.y_top[0], one.components.depth_top[1]]
            )
            for one in (grid, plane)
        )
        assert there == pytest.approx(where, abs=0.3 + off)
        said = [each for each in grid.warnings if "as a plane around" in each]
        assert len(said) == (bowl > 0.0)
        told = float(re.search(r"by up to ([\d.]+) m\.", said[0])[1]) if said else 0.0
        assert told == pytest.approx(bowl * grid.anchor.grounded_length**2, rel=0.05, abs=0.06)


def test_chain_far_from_the_origin_lies_on_the_plane(tmp_path: Path) -> None:
    """Legs lie on the plane of their file, which is nowhere off it, wherever their anchors are."""
    text = SLOPE
    for leg, at in (("west", -120), ("east", 120)):
        wire = f"{{use: wire-jacketed-8, length: 60 m}}, {{use: anchor-wheels-4, label: {leg}}}"
        chain = f"{{use: chain-buoy-16, length: 160 m}}, {{use: anchor-wheels-4, label: {leg}}}"
        near = f"at: [{at // 4} m, 0 m]"
        assert wire in text
        assert near in text
        text = text.replace(wire, chain).replace(near, f"at: [{at} m, 0 m]")
    result = load(tmp_path / "slope.yaml", text=text).solve()
    assert min(anchor.grounded_length for anchor in result.anchors) > 5.0
    assert not any("lies on the plane" in said for said in result.warnings)


def test_an_export_says_that_its_seabed_is_level(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    file = tmp_path / "slope.yaml"
    file.write_text(SLOPE)
    assert run("export", file, "--to", "moordyn", "-o", tmp_path / "slope.txt") == 0
    told = capsys.readouterr().err
    assert "not exported: the slope of the seabed: the exported seabed is level" in told
    depths = [anchor.depth for anchor in load(file).solve().anchors]
    written = (tmp_path / "slope.txt").read_text()
    deepest = next(line for line in written.splitlines() if "WtrDpth" in line)
    assert float(deepest.split()[0]) == pytest.approx(max(depths) + 0.7, abs=1e-6)


def test_a_line_that_hangs_into_a_knoll_of_a_grid_is_refused(tmp_path: Path) -> None:
    text = (
        GRIDDED[: GRIDDED.index("legs:")]
        + """\
legs:
  span:
    line: [{use: wire-jacketed-8, length: 130 m}]
    top: {held: {depth: 40 m, at: [0 m, 0 m]}}
    bottom: {held: {depth: 40 m, at: [120 m, 0 m]}}
"""
    )
    # a wire of 130 m sags by some 20 m between ends 120 m apart, over the top of the knoll
    for height, in_environments in ((60.0, False), (10.0, True)):
        gridded(
            tmp_path,
            lambda e, n, h=height: 200.0 - h * np.exp(-((e - 60.0) ** 2 + n * n) / 900.0),
        )
        net = load(tmp_path / "grid.yaml", text=text)
        if in_environments:
            assert net.solve().status == "converged"
        else:
            with pytest.raises(NoEquilibrium, match="below the sloping seabed"):
                net.solve()


BROKEN_GRIDS = [
    (GRIDDED[GRIDDED.index("environment") :], "a grid needs the `position`"),
    (GRIDDED.replace("longitude: -5", "longitude: 5"), "too few grid points near the position"),
    (
        GRIDDED.replace("[30 m, 0 m]", "[3 km, 0 m]"),
        "the grid of the seabed has no depth at the anchor",
    ),
    (GRIDDED.replace("grid.nc", "grid.tif"), "gdal_translate -of netCDF grid.tif grid.nc"),
    (GRIDDED.replace("grid.nc", "absent.nc"), "no such file"),
    (GRIDDED.replace("grid.nc", "words.nc"), "cannot be read as NetCDF"),
    (GRIDDED.replace("grid.nc", "other.nc"), "it holds salinity"),
    (GRIDDED.replace("{file: grid.nc}", "{slope: 3 deg, file: grid.nc}"), "unknown key `slope`"),
]


@pytest.mark.parametrize(("text", "told"), BROKEN_GRIDS)
def test_a_grid_that_cannot_be_used_is_a_mistake(tmp_path: Path, text: str, told: str) -> None:
    gridded(tmp_path, lambda east, north: 100.0)
    (tmp_path / "grid.tif").write_bytes(b"II*\0")
    (tmp_path / "words.nc").write_text("no grid")
    other = xarray.Dataset({"salinity": (("lat", "lon"), np.ones((3, 3)))})
    other.to_netcdf(tmp_path / "other.nc", engine="h5netcdf")
    with pytest.raises(InputError) as mistakes:
        load(tmp_path / "grid.yaml", text=text)
    assert told in str(mistakes.value)


def test_a_leg_from_a_node_to_itself_is_a_mistake(tmp_path: Path) -> None:
    text = NET.replace("  main:\n", "  main:\n    top: {join: A}\n")
    with pytest.raises(
        InputError, match="the two ends of a leg must not join at the same node, `A`"
    ):
        load(tmp_path / "net.yaml", text=text)


def test_two_anchors_in_one_place_are_a_mistake(tmp_path: Path) -> None:
    pieces = "[{use: glass-17in}, {use: wire-jacketed-8, length: 10 m}, {use: anchor-wheels-4}]"
    more = f"  other:\n    line: {pieces}\n"
    with pytest.raises(
        InputError, match="the anchor is at the position of the anchor of leg `stem`"
    ):
        load(tmp_path / "net.yaml", text=NET + more)


def test_a_leg_that_stands_the_other_way_round_is_said(tmp_path: Path) -> None:
    """A wire with its floats listed below it hangs from them: 60 m of it, less what it leans."""
    text = NET.replace("      - {use: glass-17in, count: 4}\n", "").replace(
        "length: 60 m}\n", "length: 60 m}\n      - {use: glass-17in, count: 4}\n"
    )
    (said,) = (one for one in load(tmp_path / "net.yaml", text=text).solve().warnings
               if "in reverse order" in one)  # fmt: skip
    assert "Leg second" in said


def test_a_net_that_sinks_is_refused_as_such(tmp_path: Path) -> None:
    text = NET.replace("sphere-steel-1250", "rcm11").replace("glass-17in, count: 4", "rcm11")
    with pytest.raises(NoEquilibrium, match=r"its weight in water exceeds its buoyancy by \d+ N"):
        load(tmp_path / "net.yaml", text=text).solve()


def test_two_anchors_that_are_put_in_one_place_are_told(tmp_path: Path) -> None:
    text = SLOPE.replace("at: [30 m, 0 m]", "at: [-30 m, 0 m]")
    said = [one for one in load(tmp_path / "two.yaml", text=text).solve().warnings
            if "at the same position" in one]  # fmt: skip
    assert len(said) == 1
    assert said[0].startswith("The anchors of legs west and east are at the same position")


def test_places_may_be_latitudes_and_longitudes(tmp_path: Path) -> None:
    """On the equator a minute of longitude is 6 378 137 m x π / 10 800 = 1855.325 m."""
    leg = """
    line: [{use: sphere-steel-1250}, {use: wire-jacketed-8, length: 60 m}, {use: anchor-wheels-4}]
"""
    place = "    bottom: {anchor: {at: [0 deg, 5 13.0 W]}}\n"
    text = f"environment: {{depth: 100 m}}\nlegs:\n  one:{leg}  two:{leg}{place}"
    origin = "position: {latitude: 0 deg, longitude: 5 12.0 W}\n"
    _, two = load(tmp_path / "two.yaml", text=origin + text).solve().anchors
    assert (two.x, two.y) == pytest.approx((-1855.325, 0.0), abs=2e-3)
    with pytest.raises(InputError, match="for which the file needs a `position`"):
        load(tmp_path / "two.yaml", text=text)


def test_a_leg_that_is_longer_than_its_way_is_slack(tmp_path: Path) -> None:
    """300 m down from the ship and 400 m along the seabed to the anchor are no 890 m of chain."""
    text = """
environment: {depth: 300 m}
legs:
  moor:
    line: [{use: chain-buoy-16, length: 890 m}, {use: anchor-wheels-4}]
    top: {held: {depth: 0 m}}
    bottom: {anchor: {at: [-400 m, 0 m]}}
"""
    result = load(tmp_path / "net.yaml", text=text).solve()
    assert result.status == "converged"
    # 300 m hang plumb, but for their stretch, and the anchor is 400 m from where they come down
    (slack,) = [text for text in result.warnings if "is slack" in text]
    assert slack.startswith("Leg moor is slack: the chain on the seabed is 190.")
    (anchor,) = result.anchors
    assert anchor.horizontal == pytest.approx(0.0, abs=1e-3)


def test_what_names_no_part_of_a_net_is_a_mistake(tmp_path: Path) -> None:
    """As of a line: in `deployed:` and in what is accepted."""
    text = NET + "deployed: {items: [{label: nobody, serial: '3'}]}\n"
    text += (
        "checks: {accept: [{rule: tilt, component: no one, reason: x, by: y, date: 2026-01-01}]}\n"
    )
    with pytest.raises(InputError) as mistakes:
        load(tmp_path / "net.yaml", text=text)
    told = str(mistakes.value)
    assert "nobody" in told
    assert "no one" in told
