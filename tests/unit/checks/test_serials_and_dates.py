"""The rule `serials-and-dates`: what contradicts itself on sheets and labels."""

from __future__ import annotations

from pathlib import Path

import pytest

import calm
from calm.checks.assessment import Handling
from calm.checks.serials_and_dates import serials_and_dates
from calm.errors import InputError
from calm.solve import Status

LINE = """\
name: serials
environment: {{depth: 1000 m}}
document: {{id: M1, revision: {revision}, date: {dated}, history: [
    {{revision: A, date: 2026-01-05}}, {{revision: B, date: {second}}}]}}
deployed: {{date: 2026-05-01T10:00}}
releases: [{{serial: 17, codes: 0A55}}, {{serial: {other}, codes: {codes}}}]
line:
  - {{use: sphere-ore-48in, label: float}}
  - {{use: shackle-13, label: shackle}}
  - use: wire-jacketed-8
    length: 300 m
    label: wire
    clamps:
      - {{use: sbe37, at: 20 m, label: upper, serial: 1, calibrated: {calibrated}}}
      - {{use: sbe37, at: 90 m, label: {label}, serial: {serial}, battery_until: {battery}}}
      - {{use: rcm11, at: 99 m, label: meter, serial: 1}}
  - {{use: shackle-13, label: shackle}}
  - {{use: glass-17in, count: 3, label: glass, serial: [G1, G2, {glass}]}}
  - {{use: release-ar861, label: release, serial: 17}}
  - {{use: release-ar861, label: second release, serial: 18}}
  - {{use: chain-buoy-13, length: 5 m, label: chain}}
  - {{use: anchor-wheels-4}}
"""
GOOD = {
    "revision": "B", "dated": "2026-02-01", "second": "2026-02-01", "calibrated": "2026-03-01",
    "label": "lower", "serial": "2", "battery": "2027-06-30", "other": "18", "codes": "0A56",
    "glass": "G3",
}  # fmt: skip
_NONE = Status.NOT_CONVERGED.because("not solved in this test")


def told(folder: Path, **changes: str) -> list[str]:
    path = folder / "serials.yaml"
    path.write_text(LINE.format(**GOOD | changes))
    handling = Handling(calm.load(path).legs[0], _NONE, _NONE, ())
    return [verdict.message for verdict in serials_and_dates.judge(handling)]


def test_what_agrees_passes(tmp_path: Path) -> None:
    """Two components may share a serial number, and shackles a label."""
    assert told(tmp_path) == []


@pytest.mark.parametrize(
    ("changes", "says"),
    [
        ({"serial": "1"}, "upper and lower are both sbe37 and have the same serial number, 1"),
        ({"label": "upper"}, "2 rows of the line have the label `upper`"),
        ({"battery": "2026-01-31"}, "runs out on 2026-01-31; the deployment is on 2026-05-01"),
        ({"calibrated": "2027-03-01"}, "upper, 2027-03-01, is after the deployment"),
        ({"other": "81"}, "no release of the line has the serial number 81"),
        ({"other": "17"}, "codes for serial number 17 twice"),
        ({"codes": "0A55"}, "Two releases have the same codes"),
        ({"revision": "A"}, "is revision A, but its `history` ends with revision B"),
        ({"dated": "2026-01-05"}, "but its revision B has a later date, 2026-02-01"),
        (
            {"second": "2025-02-01"},
            "but the preceding revision A has a later date, 2026-01-05",
        ),
    ],
)
def test_what_contradicts_itself_is_a_warning(
    tmp_path: Path, changes: dict[str, str], says: str
) -> None:
    (message,) = told(tmp_path, **changes)
    assert says in message


def test_a_list_of_serial_numbers_has_each_once(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="`serial` lists G2 twice"):
        told(tmp_path, glass="G2")
