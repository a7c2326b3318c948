"""The rule `environment`: environments of a mooring alone and beside each other."""

from __future__ import annotations

from pathlib import Path

import pytest

import calm
from calm.checks.environments import environment

LINE = """\
name: doubtful
environment:
  depth: 1000 m
  density: {density}
  {more}
  current:
    columns: [depth m, speed m/s, {column} deg]
    rows: [[0, 0.6, {way}], [200, 0.4, {way}], [500, 0.2, {way}], [1000, 0.08, {way}]]
environments:
  {name}:
    current: {{columns: [depth m, speed m/s, toward deg], rows: {other}}}
line:
  - {{use: sphere-ore-48in, label: float}}
  - {{use: wire-jacketed-8, length: 700 m, label: wire}}
  - {{use: anchor-wheels-4}}
"""
STORM = "[[0, 1.0, 90], [200, 0.7, 90], [500, 0.4, 85], [1000, 0.15, 80]]"
DEFAULTS = {"density": "1027 kg/m^3", "more": "gravity: 9.81 m/s^2", "column": "toward", "way": 90,
            "name": "storm", "other": STORM}  # fmt: skip


def told(folder: Path, **changes: object) -> list[str]:
    path = folder / "doubtful.yaml"
    given = DEFAULTS | changes
    path.write_text(LINE.format(**given), encoding="utf-8")
    legs = [calm.load(path, environment=one).legs[0] for one in (None, given["name"])]
    return [verdict.message for _, verdict in environment.judge(legs)]


@pytest.mark.parametrize(
    "changes",
    [
        {},
        {"name": "ebb", "other": "[[0, 0.4, 270], [1000, 0.02, 270]]"},
        {"name": "undercurrent", "other": "[[0, 0.1, 90], [200, 0.8, 90], [1000, 0.02, 90]]"},
        {"density": "{temperature: 8 degC, salinity: 35}"},
        {"density": "{columns: [depth m, density kg/m^3], rows: [[0, 999], [1000, 1032]]}"},
        {"more": "depth_range: [995 m, 1005 m]"},
        {"more": "wind: {speed: 60 m/s, toward: 90 deg}"},
    ],
)
def test_usual_environments_pass(tmp_path: Path, changes: dict[str, object]) -> None:
    assert told(tmp_path, **changes) == []


@pytest.mark.parametrize(
    ("changes", "says"),
    [
        ({"way": 1.571}, "`toward` is 1.57 degrees throughout"),
        ({"way": 1.571, "column": "from"}, "`from` is 1.57 degrees throughout"),
        ({"density": "1100 kg/m^3"}, "1100 kg/m^3 is that of brine"),
        (
            {"density": "{temperature: 35 degC, salinity: 8}"},
            "are temperature and salinity exchanged",
        ),
        ({"more": "depth_range: [800 m, 1200 m]"}, "`depth_range` spans 400 m"),
        ({"more": "wind: {speed: 108 m/s, toward: 90 deg}"}, "stronger than any at sea"),
        # a decimal point too far left at two levels of the storm, found by its name or its maximum
        ({"other": STORM.replace("0.7", "0.07").replace("0.4", "0.04")}, "of storm is 0.07 m/s"),
        (
            {"name": "case 2", "other": STORM.replace("0.7", "0.07")},
            "At 200.0 m, the current of case 2 is 0.07 m/s",
        ),
        ({"other": "[[0, 0.06, 90], [1000, 0.015, 90]]"}, "of storm is 0."),
    ],
)
def test_what_is_mostly_a_mistake_is_a_warning(
    tmp_path: Path, changes: dict[str, object], says: str
) -> None:
    message, *others = told(tmp_path, **changes)
    assert all("buoyancy" in other for other in others)  # light water lifts less, too
    assert says in message
