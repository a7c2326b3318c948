"""The planned depth of a piece or a clamp: its key, or the depth that its label names."""

from __future__ import annotations

from math import isnan
from pathlib import Path

import pytest

from calm.case import load
from calm.errors import InputError
from calm.files.pieces import parts_of
from calm.files.planned_depth import depth_in_label


@pytest.mark.parametrize(
    ("label", "depth"),
    [
        ("meter 200 m", 200.0),
        ("MicroCAT 46 m", 46.0),
        ("SBE37 @ 1500m", 1500.0),
        ("SBE37 @1500", 1500.0),
        ("CTD400m", 400.0),
        ("200m_CTD", 200.0),
        ("SBE37-400m", 400.0),
        ("T 12.5 m", 12.5),
        ("Aquadopp 1,500 m", 1500.0),
        ("ADCP 75 kHz, 500 metres", 500.0),
        ("buoy 650 ft", 198.12),
        ("CTD_0400", 400.0),
        ("CTD_1500", 1500.0),
        ("MC-0050", 50.0),
        ("SBE37_0400", 400.0),
        ("SBE37 SN 12345 @ 1500m", 1500.0),
        ("meter no. 3, 800 m", 800.0),
        ("RCM #1234 800 m", 800.0),
        ("SBE37 200 m", 200.0),
    ],
)
def test_a_label_names_a_depth(label: str, depth: float) -> None:
    assert depth_in_label(label) == pytest.approx(depth)


@pytest.mark.parametrize(
    "label",
    [
        "SBE37 SN 12345",
        "SBE37 S/N 1234 m",
        "SBE37_1729",
        "SBE37_1700",
        "MC_1729",
        "MC-1730",
        "SBE37 1729",
        "SBE56 12345678",
        "serial 400 m",
        "#400",
        "meter",
        "meter 2",
        "ADCP 75 kHz",
        "wire 350 m",
        "thermistor string 50 m",
        "CTD with 20 m cable",
        "ADCP, range 300 m",
        "rated 6000 m",
        "50 m above bottom",
        "CTD 15 mab",
        "profiler 50-1000 m",
        "MMP 50 m to 1000 m",
        "300 m or 400 m",
        "100 m/500 m",
        "CTD 1 200 m",
        "CTD 12 500 m",
        "CTD 3x100 m",
        "CTD 1.2e2 m",
        "float 450 mm",
        "1.5 m/s meter",
        "glass 17in",
        "CTD_400",
        "CTD_12345",
        "",
    ],
)
def test_a_label_names_no_depth(label: str) -> None:
    assert isnan(depth_in_label(label))


def test_a_serial_number_or_a_depth_rating_is_no_plan() -> None:
    assert isnan(depth_in_label("CTD_1700", serial="1700"))
    assert depth_in_label("CTD_1700", serial="1729") == 1700.0
    assert isnan(depth_in_label("Aquadopp 6000 m", rating=6000.0))
    assert depth_in_label("SBE37 @ 350 m", rating=350.0) == 350.0
    assert depth_in_label("Aquadopp 6000 m @ 1500 m", rating=6000.0) == 1500.0


def _file(folder: Path, line: str) -> Path:
    path = folder / "planned.yaml"
    path.write_text(
        f"name: planned\nenvironment: {{depth: 500 m}}\nline:\n{line}  - {{use: anchor-wheels-3}}\n"
    )
    return path


LINE = """\
  - {use: glass-17in, label: float 150 m}
  - {use: glass-17in, label: float 0.43 m}
  - {use: shackle-13, label: shackle 150 m}
  - {use: wire-jacketed-8, length: 100 m, label: wire 100 m, clamps: [
      {use: sbe37, at: 10 m, label: CTD 160 m}, {use: sbe37, at: 20 m},
      {use: sbe37, at: 30 m, label: CTD 180 m, planned_depth: 185 m},
      {use: sbe37, at: 40 m, label: CTD_1700, serial: 1700}]}
  - {use: rcm11, label: meter, planned_depth: 250 m}
  - {use: wire-jacketed-8, length: 100 m, planned_depth: 251 m}
  - {use: glass-17in, count: 3, label: glass 350 m}
  - {use: release-ar861, label: release 360 m}
"""


def test_the_key_comes_first_and_labels_count_for_what_measures(tmp_path: Path) -> None:
    """Floats, instruments and clamps; not hardware, cables, releases, or one of a count."""
    parts = parts_of(load(_file(tmp_path, LINE)).file.pieces)
    assert {part.label: part.planned_depth for part in parts if part.planned_depth} == {
        "float 150 m": 150.0,
        "CTD 160 m": 160.0,
        "CTD 180 m": 185.0,
        "meter": 250.0,
        "wire-jacketed-8": 251.0,
    }


@pytest.mark.parametrize(
    ("item", "said"),
    [
        (
            "{use: glass-17in, count: 2, planned_depth: 150 m}",
            "`planned_depth` is for single pieces; this item has a `count` of 2",
        ),
        ("{use: glass-17in, planned_depth: 150}", "`planned_depth"),
        ("{use: glass-17in, planned_depth: -5 m}", "`planned_depth"),
        ("{use: release-pair-ar861, planned_depth: 150 m}", "cannot be set on an assembly"),
        ("{use: glass-17in, planed_depth: 150 m}", "planned_depth"),
    ],
)
def test_a_mistaken_plan_is_refused_at_its_place(item: str, said: str, tmp_path: Path) -> None:
    with pytest.raises(InputError) as refused:
        load(_file(tmp_path, f"  - {item}\n"))
    assert said in str(refused.value) and ":4:" in str(refused.value)
