from pathlib import Path

import pytest
from rich.cells import cell_len

import calm
from calm.drawing.schematic.in_terminal import can_carry, schematic_text

LINES = sorted((Path(__file__).resolve().parents[3] / "lines").glob("*.yaml"))
MOORING = """\
name: Small line
environment: {depth: 100 m}
line:
  - {use: adcp-float, label: ADCP float}
  - {use: shackle, count: 2}
  - {use: wire, length: 50 m, clamps: [{use: ctd, at: 20 m}, {use: ctd, at: 10 m, label: upper}]}
  - {use: glass, count: 3}
  - {use: release, label: release A}
  - {use: release, label: release B}
  - {use: rope, length: 20 m, label: 海洋观测系留线}
  - {use: block}
components:
  adcp-float: {kind: sphere, role: float, diameter: 1 m, buoyancy: 9 kN, note: looking upward}
  shackle: {kind: body, role: connector, length: 0.1 m, buoyancy: -5 N, kn: 0, kt: 0}
  wire: {kind: cable, diameter: 8 mm, weight: 1 N/m, material: steel}
  ctd: {kind: cylinder, diameter: 50 mm, length: 0.5 m, buoyancy: -10 N, name: Recorder}
  glass: {kind: sphere, role: float, diameter: 0.5 m, buoyancy: 200 N}
  release: {kind: cylinder, role: release, diameter: 0.2 m, length: 1 m, buoyancy: -100 N}
  rope: {kind: cable, diameter: 12 mm, weight: 0.2 N/m, material: polyester}
  block: {kind: anchor, length: 0.5 m, weight: 20 kN}
"""
DRAWN = """\
Small line
100.0 m of water

                                           cut          above
                                        length  depth  seabed
                                             m      m       m
~~~~~~~~~~ sea surface                            0.0   100.0

 ( ^ )     ADCP float     adcp-float      1.00   24.8    75.2
   U       shackle 1–2    shackle     2 × 0.10   25.8    74.2
   │       wire           wire           50.00   26.0    74.0
   ├─[#]     upper        Recorder    at 10.00   36.0    64.0
   ├─[#]     ctd          Recorder    at 20.00   46.0    54.0
 (ooo)     glass 1–3      glass       3 × 0.50   76.0    24.0
 [R|R]     release A      release         1.00   77.5    22.5
           release B      release         1.00   78.5    21.5
   ┊       海洋观测系留线 rope           20.00   79.5    20.5
   ┊
 /###\\     block          block           0.50   99.5     0.5
▒▒▒▒▒▒▒▒▒▒ seabed                               100.0     0.0

Not to scale. Depth and height are given at the upper end of each part, with the
line upright and unstretched."""


@pytest.fixture
def small(tmp_path):
    path = tmp_path / "small.yaml"
    path.write_text(MOORING, encoding="utf-8")
    return calm.load(path).file


def test_the_line_from_the_top(small):
    assert schematic_text(small) == DRAWN


def test_plain_signs_stand_where_the_others_stood(small):
    fancy, plain = schematic_text(small), schematic_text(small, ascii_only=True)
    assert plain.replace("海洋观测系留线", "").isascii()
    assert [cell_len(line) for line in plain.splitlines()] == [
        cell_len(line) for line in fancy.splitlines()
    ]
    assert "   |-[#]     upper" in plain
    assert "2 x 0.10" in plain


@pytest.mark.parametrize("path", LINES, ids=lambda path: path.stem)
@pytest.mark.parametrize("width", [60, 80, 132])
def test_lines_keep_to_the_width_and_columns_stand_straight(path, width):
    file = calm.load(path).file
    lines = schematic_text(file, width=width).splitlines()
    assert max(map(cell_len, lines)) <= width
    rows = [line for line in lines if line.endswith((".0", ".1", ".2", ".3", ".4", ".5", ".6",
                                                     ".7", ".8", ".9"))]  # fmt: skip
    assert len({cell_len(line) for line in rows}) <= 1


@pytest.mark.parametrize("path", LINES, ids=lambda path: path.stem)
def test_labels_are_whole_in_80_columns_or_cut_last(path):
    file = calm.load(path).file
    drawn = schematic_text(file, width=200)
    for piece in file.pieces:
        stem = piece.label.rstrip("0123456789")  # a run tells its last number alone
        assert stem in drawn
        assert all(clamp.label in drawn for clamp in piece.clamps)


def test_wide_letters_are_cut_at_cells(small):
    line = next(line for line in schematic_text(small, width=56).splitlines() if "海" in line)
    full = next(line for line in schematic_text(small, width=56).splitlines() if "upper" in line)
    assert "…" in line
    assert cell_len(line) == cell_len(full)


def test_which_outputs_carry_the_signs():
    assert can_carry("utf-8")
    assert not can_carry("ascii")
    assert not can_carry("latin-1")
    assert not can_carry("no-such-encoding")
    assert not can_carry(None)
