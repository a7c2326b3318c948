"""Where the line stands, judged."""

from __future__ import annotations

from pathlib import Path

import calm
from calm.checks.posture import depth_rating

LINE = """\
environment:
  depth: 500 m
  current: {speed: 0.2 m/s, toward: 90 deg}
line:
  - {use: sphere, label: top}
  - use: wire
    length: 400 m
    clamps:
      - {use: shallow, at: 20 m, label: first}
      - {use: deep, at: 390 m, label: second}
  - {use: weight}
components:
  sphere: {kind: sphere, role: float, diameter: 1 m, buoyancy: 5 kN, depth_rating: 1000 m}
  wire: {kind: cable, diameter: 8 mm, weight: 1.6 N/m, stiffness: 3000 kN}
  shallow: {kind: cylinder, diameter: 5 cm, length: 0.5 m, buoyancy: -10 N, depth_rating: 300 m}
  deep: {kind: cylinder, diameter: 5 cm, length: 0.5 m, buoyancy: -10 N, depth_rating: 6000 m}
  weight: {kind: anchor, weight: 20 kN}
"""
LISTED = [line for line in LINE.splitlines(keepends=True) if "label: first" in line]


def test_clamps_listed_from_below_are_judged_by_their_own_limits(tmp_path: Path) -> None:
    first = LISTED[0]
    turned = LINE.replace(first, "").replace("  - {use: weight}\n", f"{first}  - {{use: weight}}\n")
    judged = []
    for text in (LINE, turned):
        path = tmp_path / "mooring.yaml"
        path.write_text(text, encoding="utf-8")
        mooring = calm.load(path)
        verdicts = {one.component: one for one in depth_rating.judge(mooring.solve().leg)}
        judged.append({label: verdicts[label].limit for label in ("first", "second")})
    # half the rating at most, and 100 m, are kept as a margin
    assert judged == [{"first": 200.0, "second": 5900.0}] * 2
