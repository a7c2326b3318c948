"""The rule `joints`: unlike pieces of metal that nothing joins."""

from __future__ import annotations

from pathlib import Path

import pytest

import calm
from calm.checks.joints import bare_joints

LINE = """\
name: joints
environment: {{depth: 1000 m}}
line:
  - {{use: glass-17in, label: glass}}
  - {{use: sphere-ore-48in, label: float}}
  - {{use: shackle-13}}
  - {{use: wire-jacketed-8, length: 300 m, label: upper wire}}
{rows}
  - {{use: shackle-13}}
  - {{use: release-ar861, label: release}}
  - {{use: nylon-18, length: 5 m, label: nylon}}
  - {{use: chain-buoy-13, length: 5 m, label: chain}}
  - {{use: shackle-19}}
  - {{use: anchor-wheels-4, label: anchor}}
"""


@pytest.mark.parametrize(
    ("rows", "bare"),
    [
        ((), []),
        (("shackle-13}", "rcm11, label: meter}", "shackle-13}", "glass-17in, count: 3}"), []),
        (("rcm11, label: meter}",), ["upper wire to meter"]),
        (("wire-jacketed-8, length: 30 m, label: wire}",), ["upper wire to wire"]),
        (("chain-buoy-13, length: 3 m, label: chain}",), ["upper wire to chain 1"]),
        (("polyester-13, length: 30 m, label: rope}",), []),
        (("swivel-19}", "rcm11, label: meter}", "glass-17in, label: ball}"), ["meter to ball"]),
        (("glass-cluster-4, count: 2, label: balls}",), []),
    ],
)
def test_hardware_joins_wire_chain_and_what_is_rigid(
    tmp_path: Path, rows: tuple[str, ...], bare: list[str]
) -> None:
    path = tmp_path / "joints.yaml"
    path.write_text(LINE.format(rows="\n".join(f"  - {{use: {row}" for row in rows)))
    found = bare_joints(calm.load(path).file.pieces)
    assert [f"{one.label} to {other.label}" for one, other in found] == bare


def test_the_termination_of_a_wire_says_how_it_is_joined(tmp_path: Path) -> None:
    path = tmp_path / "joints.yaml"
    text = LINE.format(rows="  - {use: rcm11, label: meter}")
    path.write_text(text.replace("label: upper wire", "label: w, termination: sockets and shackle"))
    assert bare_joints(calm.load(path).file.pieces) == []
