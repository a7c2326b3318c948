"""A mooring with some values of its file changed is that of the file so written."""

import numpy as np
import pytest

import calm
from calm import InputError

FILE = """\
environment: {depth: 300 m, current: {speed: 0.3 m/s, toward: 90 deg}}
environments:
  still: {current: {speed: 0 m/s, toward: 90 deg}}
line:
  - {use: ball, label: top}
  - {use: rope, length: 200 m, label: upper, clamps: [{use: logger, at: 50 m, label: probe}]}
  - {use: pack}
  - {use: block}
components:
  ball: {kind: sphere, diameter: 1 m, buoyancy: 3 kN}
  rope: {kind: cable, diameter: 12 mm, weight: 0.3 N/m}
  logger: {kind: cylinder, diameter: 10 cm, length: 0.5 m, buoyancy: -20 N}
  pack: {kind: assembly, parts: [{use: logger, label: spare}]}
  block: {kind: anchor, weight: 10 kN}
"""
FINE = "solver: {angle_step: 0.5 deg}"


@pytest.fixture
def mooring(tmp_path):
    (tmp_path / "m.yaml").write_text(FILE)
    return calm.load(tmp_path / "m.yaml")


def written(tmp_path, old, new):
    assert FILE.count(old) == 1
    (tmp_path / "other.yaml").write_text(FILE.replace(old, new))
    return calm.load(tmp_path / "other.yaml").solve()


@pytest.mark.parametrize(
    ("label", "keys", "old", "new"),
    [
        ("upper", {"length": "180 m"}, "length: 200 m", "length: 180 m"),
        ("probe", {"at": "80 m"}, "at: 50 m", "at: 80 m"),
        (None, {"environment_": "still"}, "speed: 0.3 m/s", "speed: 0 m/s"),
        (None, {"environment_": {"current": {"speed": "0.4 m/s", "toward": "90 deg"}}},
         "speed: 0.3 m/s", "speed: 0.4 m/s"),
        (None, {"solver": {"angle_step": "0.5 deg"}}, "line:\n", f"{FINE}\nline:\n"),
    ],
)  # fmt: skip
def test_it_is_solved_as_the_file_with_the_values(mooring, tmp_path, label, keys, old, new):
    keys = {name.rstrip("_"): value for name, value in keys.items()}
    changed = mooring.with_(label, **keys).solve()
    assert changed.shape.depth.tolist() == written(tmp_path, old, new).shape.depth.tolist()
    assert (tmp_path / "m.yaml").read_text() == FILE
    assert changed.top.depth != mooring.solve().top.depth


def test_it_is_solved_in_another_environment(mooring):
    assert mooring.solve("still").top.knockdown == pytest.approx(0.0, abs=1e-6)
    assert mooring.solve().top.knockdown > 0.1


def test_changes_add_up_and_keep_the_environment(mooring):
    both = mooring.with_(environment="still").with_("upper", length="180 m")
    assert both.file.environment.name == "still"
    assert both.solve().components["upper"].cut_length == 180.0


def test_mistakes_are_those_of_a_file(mooring):
    with pytest.raises(calm.UsageError, match=r"no piece or clamp is labelled `uper`.*`upper`"):
        mooring.with_("uper", length="3 m")
    with pytest.raises(calm.UsageError, match="part of an assembly"):
        mooring.with_("spare", length="3 m")
    with pytest.raises(calm.InputError, match=r"`length: 3 N` is a force"):
        mooring.with_("upper", length="3 N")
    with pytest.raises(calm.UsageError, match="not loaded from a file"):
        calm.Design(mooring.file).with_("upper", length="3 m")


def test_a_tow_is_changed_as_a_mooring_is(tmp_path):
    tow = FILE.replace("  - {use: block}", "tow: {speed: 2 m/s, toward: 0 deg}")
    tow = tow.replace("ball, label: top", "logger, label: top").replace("still:", "ebb:")
    (tmp_path / "t.yaml").write_text(
        tow.replace("{speed: 0 m/s, toward: 90", "{speed: 1 m/s, toward: 180")
    )
    towed = calm.load(tmp_path / "t.yaml")
    faster = towed.with_(tow={"speed": "3 m/s"}).solve()
    assert (faster.file.tow.speed, faster.body.layback) > (3.0 - 1e-9, towed.solve().body.layback)
    assert towed.solve(environment="ebb").file.environment.name == "ebb"


def test_the_same_serial_number_twice_is_said(mooring):
    clamps = [
        {"use": "logger", "at": f"{at} m", "label": f"T{at}", "serial": "7"} for at in (20, 40)
    ]
    said = "T20 and T40 have the same serial number, 7."
    assert said in mooring.with_("upper", clamps=clamps).solve().warnings
    clamps[1]["serial"] = "8"
    warnings = mooring.with_("upper", clamps=clamps).solve().warnings
    assert not [warning for warning in warnings if "serial" in warning]


def test_rows_are_found_by_label(mooring):
    result = mooring.solve()
    assert result.components["upper"] == result.components[1]
    assert result.clamps["probe"] == result.clamps[0]
    with pytest.raises(KeyError, match="did you mean `top`"):
        result.components["topp"]


def test_what_is_printed_of_it_is_short(mooring):
    result = mooring.solve()
    for each in (mooring, result, result.components, result.components[0], result.shape):
        assert len(repr(each)) < 1000 and repr(each).count("\n") < 10
    assert repr(result.clamps) == "Clamps(1 rows: probe)"


@pytest.mark.parametrize("speed", [0.3, np.float32(0.3), np.float64(0.3)])
def test_a_number_without_a_unit_is_reported_wherever_it_stands(mooring, speed):
    with pytest.raises(InputError, match=r"`speed: 0\.3\d*` needs a unit; did you mean `speed: 0"):
        mooring.with_(environment={"current": {"speed": speed, "toward": "90 deg"}})
    rows = [[0, speed, 90], [100, 0.1, 90]]
    table = {"columns": ["depth m", "speed m/s", "toward deg"], "rows": rows}
    sheared = mooring.with_(environment={"current": table})
    assert float(sheared.water.u[0]) == pytest.approx(float(speed), rel=1e-6)


def test_a_label_without_its_number_means_the_item_with_a_count(tmp_path):
    path = tmp_path / "m.yaml"
    path.write_text(FILE.replace("{use: ball, label: top}", "{use: ball, label: top, count: 2}"))
    mooring = calm.load(path)
    changed = mooring.with_("top", count=3)
    assert len(changed.file.pieces) == len(mooring.file.pieces) + 1
    assert changed.file == mooring.with_("top 1", count=3).file
