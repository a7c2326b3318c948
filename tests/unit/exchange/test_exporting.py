"""Moorings given to other programs, and read back: the same equilibrium."""

import re
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
from scipy.io import loadmat

from calm.case import load
from calm.errors import UsageError
from calm.exchange.exporting import export_file
from calm.exchange.importing import import_file
from calm.shipped import shipped_folder

LINES = Path(str(shipped_folder("lines")))
ENDINGS = {"mdd": ".mat", "cbl": ".cbl", "csv": ".csv", "moordyn": ".txt"}
SUBSURFACE = ["cdms-1", "deep-current-meters", "fit-top-depth", "tidal-adcp", "thermistor-string"]


def site_of(source, tmp_path):
    """The environment of a mooring file, as a file of its own."""
    lines = source.read_text().splitlines()
    start = lines.index("environment:")
    end = next(i for i in range(start + 1, len(lines)) if lines[i][:1].isalpha())
    path = tmp_path / "site.yaml"
    path.write_text("\n".join(lines[start:end]) + "\n")
    return path


def there_and_back(tmp_path, name, to):
    source = LINES / f"{name}.yaml"
    exported = export_file(source, to)
    for beside, content in exported.beside.items():
        (tmp_path / beside).write_bytes(content)
    other = tmp_path / f"{name}{ENDINGS[to]}"
    other.write_bytes(exported.content)
    environment = site_of(source, tmp_path) if to == "csv" else None
    made = import_file(other, tmp_path / "back.yaml", environment=environment)
    before, after = load(source), load(tmp_path / "back.yaml", text=made.text)
    return before, before.solve().to_dict(), after.solve().to_dict(), exported.lost


def assert_same(before, one, other, share=1e-4):
    """The upper end within a share of the depth of the water, the pull on the anchor as well."""
    depth = before.file.environment.depth
    for key in ("depth", "x", "y"):
        assert other["top"][key] == pytest.approx(one["top"][key], abs=share * depth)
    for key in ("horizontal", "vertical"):
        assert other["anchor"][key] == pytest.approx(one["anchor"][key], rel=2e-3)


@pytest.mark.parametrize("to", ["mdd", "cbl", "csv"])
@pytest.mark.parametrize("name", SUBSURFACE)
def test_a_subsurface_mooring_comes_back(name, to, tmp_path):
    """To 1e-4 of the depth, though cylinders come back as stiff lines and floats as points."""
    before, one, other, _ = there_and_back(tmp_path, name, to)
    assert_same(before, one, other)


@pytest.mark.parametrize("name", SUBSURFACE)
def test_a_subsurface_mooring_comes_back_from_moordyn(name, tmp_path):
    """To 2e-4: its rigid pieces are stiff lengths, which drag by their axis."""
    before, one, other, _ = there_and_back(tmp_path, name, "moordyn")
    assert_same(before, one, other, 2e-4)


def test_a_rope_under_a_float_comes_back_from_moordyn(tmp_path):
    """S1000, all of which that program can be told; its current stands beside the file."""
    _, one, other, _ = there_and_back(tmp_path, "s1000", "moordyn")
    assert other["top"]["depth"] == pytest.approx(one["top"]["depth"], abs=0.1)
    assert other["top"]["x"] == pytest.approx(one["top"]["x"], abs=0.1)
    assert other["anchor"]["tension"] == pytest.approx(one["anchor"]["tension"], rel=1e-4)


def test_the_points_of_moordyn_stand_in_equilibrium():
    exported = export_file(LINES / "cdms-1.yaml", "moordyn")
    rows = exported.content.decode().split("POINTS")[1].split("LINES")[0].splitlines()[3:-1]
    first, last = rows[0].split(), rows[-1].split()
    answer = load(LINES / "cdms-1.yaml").solve().to_dict()
    assert first[1] == "Fixed"
    assert float(first[4]) == pytest.approx(-525.0 + 0.55)
    assert last[1] == "Free"
    assert float(last[2]) == pytest.approx(answer["top"]["x"], abs=1e-3)
    assert -float(last[4]) == pytest.approx(answer["top"]["depth"], abs=1e-3)
    lift = (1025 * float(last[6]) - float(last[5])) * 9.81
    assert lift == pytest.approx(682 * 9.80665, rel=2e-3)


@pytest.mark.parametrize("name", ["s1000", "tidal-adcp", "taut-nylon-surface"])
def test_the_damping_of_moordyn_spares_what_waves_do(name):
    """Of MoorDyn's BA = ζ l √(EA w) a wave at 1 rad/s feels ω BA / EA: below 1 % in each segment.

    ζ is of the highest mode of a segment, 2/l √(EA/w), far above every wave; its manual advises
    one near 1 there (MoorDyn documentation, troubleshooting: segment damping).
    """
    lines = export_file(LINES / f"{name}.yaml", "moordyn").content.decode().splitlines()
    heads = [number for number, line in enumerate(lines) if line.startswith("-----")]
    tables = [lines[a + 3 : b] for a, b in pairwise(heads[1:])]
    types = {row.split()[0]: [float(cell) for cell in row.split()[1:]] for row in tables[0]}
    for row in tables[2]:
        _, kind, _, _, length, segments, _ = row.split()
        _, mass, stiffness, damping, *_ = types[kind]
        assert damping == -0.8
        segment = float(length) / int(segments)
        assert 0.8 * segment * (mass / stiffness) ** 0.5 < 0.01
        assert 2.0 / segment * (stiffness / mass) ** 0.5 > 20.0


def test_moordyn_is_given_no_tow():
    with pytest.raises(UsageError, match="tows cannot be written for MoorDyn"):
        export_file(LINES / "depressor-fit-depth.yaml", "moordyn")


def test_a_hull_comes_back_from_whoi_cable(tmp_path):
    """In wind and current: its displacement is that of its table, its drag that at its draft."""
    before, one, other, _ = there_and_back(tmp_path, "taut-nylon-surface", "cbl")
    assert other["type"] == "surface"
    assert_same(before, one, other)
    assert other["top"]["draft"] == pytest.approx(one["top"]["draft"], abs=1e-3)


@pytest.mark.parametrize("to", ["mdd", "moordyn", "csv"])
def test_a_float_without_a_height_comes_back(to, tmp_path):
    """It is only a drag and a buoyancy at the surface: that all but WHOI Cable can be told."""
    before, one, other, _ = there_and_back(tmp_path, "braconnot-buoy", to)
    assert_same(before, one, other)


@pytest.mark.parametrize("to", ["mdd", "cbl"])
def test_a_tow_comes_back(to, tmp_path):
    source = tmp_path / "tow.yaml"
    source.write_text(
        "tow: {speed: 2 m/s, toward: 60 deg}\nline:\n"
        "  - {use: wire, length: 300 m, clamps: [{use: light, at: 200 m}]}\n  - {use: ball}\n"
        "components:\n"
        "  wire: {kind: cable, diameter: 10 mm, weight: 2.5 N/m, cn: 1.5, ct: 0, stiffness: 5 MN}\n"
        "  light: {kind: cylinder, diameter: 60 mm, length: 0.5 m, buoyancy: -20 N, cn: 1.2}\n"
        "  ball: {kind: sphere, diameter: 0.5 m, length: 0 m, buoyancy: -2 kN, cx: 0.5}\n"
    )
    exported = export_file(source, to)
    other = tmp_path / f"tow{ENDINGS[to]}"
    other.write_bytes(exported.content)
    made = import_file(other, tmp_path / "back.yaml")
    one = load(source).solve()
    back = load(tmp_path / "back.yaml", text=made.text).solve()
    assert back.body.depth == pytest.approx(one.body.depth, abs=0.02)
    assert back.body.layback == pytest.approx(one.body.layback, abs=0.02)
    assert back.tow_point.tension == pytest.approx(one.tow_point.tension, rel=2e-4)


@pytest.mark.parametrize(("toward", "speed"), [(0, 1.0), (60, 2.0), (225, 1.3), (270, 0.5)])
def test_a_tow_for_whoi_cable_heads_along_x(toward, speed, tmp_path):
    """Its statics know x and z alone: u ahead is 0.3 cos 30 deg, v to port -0.3 sin 30 deg."""
    source = tmp_path / "tow.yaml"
    tow = (
        f"tow: {{speed: {speed} m/s, toward: {toward} deg}}\n"
        "environment: {current: {speed: 0.3 m/s, toward: CURRENT deg}}\n"
        "line: [{use: wire, length: 100 m}, {use: ball}]\n"
        "components:\n"
        "  wire: {kind: cable, diameter: 10 mm, weight: 2.5 N/m, cn: 1.5}\n"
        "  ball: {kind: sphere, diameter: 0.5 m, length: 0 m, buoyancy: -2 kN, cx: 0.5}\n"
    )
    source.write_text(tow.replace("CURRENT", str(toward)))
    ahead = export_file(source, "cbl")
    text = ahead.content.decode()
    assert f"x-speed = {speed:.9g}  y-speed = 0 " in text
    assert "y-current" not in text
    assert any(f"the heading, {toward} deg true" in each for each in ahead.lost)
    assert not any("across" in each for each in ahead.lost)
    source.write_text(tow.replace("CURRENT", str(toward + 30)))
    across = export_file(source, "cbl")
    rows = dict(re.findall(r"([xy])-current = \(0, ([-0-9.e]+)\)", across.content.decode()))
    assert float(rows["x"]) == pytest.approx(0.3 * 3**0.5 / 2, abs=1e-6)
    assert float(rows["y"]) == pytest.approx(-0.15, abs=1e-6)
    assert any("currents across the heading" in each for each in across.lost)


def test_the_clamps_of_a_list_come_back(tmp_path):
    _, one, other, _ = there_and_back(tmp_path, "thermistor-string", "csv")
    depths = [[clamp["depth"] for clamp in answer["clamps"]] for answer in (one, other)]
    assert len(depths[0]) > 5
    assert depths[1] == pytest.approx(depths[0], abs=1e-4)


def test_the_matrices_are_those_of_that_program(tmp_path):
    path = tmp_path / "m.mat"
    path.write_bytes(export_file(LINES / "cdms-1.yaml", "mdd").content)
    found = loadmat(path)
    assert found["H"].shape == (4, 21)
    assert found["H"][:, 1] == pytest.approx([10.0, 0.007, 0.0, 1.0])
    assert found["B"][0, 0] == pytest.approx(682.0)
    assert found["ME"][0, 1] == pytest.approx(1.38e11, rel=1e-3)
    assert np.isinf(found["ME"][0, 0])
    assert len(found["moorele"]) == 21
    assert found["z"].ravel() == pytest.approx([525.0, 325.0, 0.0])
    assert found["U"].ravel() == pytest.approx([1.5, 0.6, 0.1])
    assert "lost" in found


def test_the_head_says_what_is_lost(tmp_path):
    exported = export_file(LINES / "chain-and-rope-surface.yaml", "cbl")
    head = exported.content.decode().split("*/")[0]
    for each in exported.lost:
        assert each in " ".join(head.split())
    assert any("constant drag" in each for each in exported.lost)


@pytest.mark.parametrize("to", ENDINGS)
def test_what_is_towed_in_air_stays(to):
    with pytest.raises(UsageError, match="towed in air"):
        export_file(LINES / "helicopter-bird.yaml", to)


def test_no_program_of_that_name():
    with pytest.raises(UsageError, match="`orca` is not a format"):
        export_file(LINES / "cdms-1.yaml", "orca")
