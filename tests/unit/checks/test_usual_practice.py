"""What is usual practice raises no warning; next to each case is one that does."""

from pathlib import Path

import pytest

from calm.case.design import load
from calm.checks.design_check import check
from calm.checks.finding import Finding

FILE = """
name: usual
position: {latitude: 45 deg, longitude: -8 deg}
environment: {depth: 300 m, current: {speed: 0.3 m/s, toward: 90 deg}}
line:
  - {use: glass-cluster-4, count: 2, label: glass}
  - {use: rope, length: 20 m, label: rope}
  - {use: shackle-13, label: link}
  - {use: rope, length: 20 m, label: lower rope}
  - {use: opener, label: release}
  - {use: polypropylene-13, length: 2 m, label: strop}
  - {use: chain-buoy-13, length: 3 m, label: chain}
  - {use: anchor-wheels-2}
components:
  opener: {kind: cylinder, role: release, diameter: 0.1 m, length: 1 m, buoyancy: -200 N,
    working_load: 20 kN, depth_rating: 1000 m}
  rope: {kind: cable, diameter: 12 mm, weight: 0.3 N/m, material: polyester, stiffness: 200 kN,
    breaking_load: 40 kN}
"""


def _found(folder: Path, rule: str, *changes: tuple[str, str]) -> list[Finding]:
    text = FILE
    for old, new in changes:
        assert old in text
        text = text.replace(old, new)
    (folder / "m.yaml").write_text(text)
    found = check(load(folder / "m.yaml")).all_findings()
    return [one for one in found if one.rule == rule and one.state.value in ("warn", "fail")]


@pytest.mark.parametrize(("depth", "warned"), [("300 m", True), ("90 m", False)])
def test_a_single_release_is_warned_of_where_nobody_dives_for_it(
    tmp_path: Path, depth: str, warned: bool
) -> None:
    found = _found(tmp_path, "release-present", ("depth: 300 m", f"depth: {depth}"))
    assert [one.message.partition(":")[0] for one in found] == (
        ["release is the only release"] if warned else []
    )


def test_a_buoyant_strop_below_the_release_is_none_of_its_floats(tmp_path: Path) -> None:
    shallow = ("depth: 300 m", "depth: 90 m")
    assert not _found(tmp_path, "release-present", shallow)
    ball = ("label: chain}", "label: chain}\n  - {use: glass-17in, label: low ball}")
    (found,) = _found(tmp_path, "release-present", shallow, ball)
    assert found.message.startswith("low ball is buoyant, but below the release")


@pytest.mark.parametrize(("latitude", "warned"), [("59 deg", True), ("-60 deg", False)])
def test_no_fish_bite_is_feared_in_polar_waters(
    tmp_path: Path, latitude: str, warned: bool
) -> None:
    found = _found(tmp_path, "fish-bite", ("latitude: 45 deg", f"latitude: {latitude}"))
    assert bool(found) is warned


def test_a_piece_with_strength_to_spare_is_no_weak_link(tmp_path: Path) -> None:
    """Half of the ropes' 8 kN is 4 kN; the line pulls with some 1.5 kN."""
    weak = "label: link, working_load: 3.5 kN, breaking_load: 20 kN, source: us}"
    assert not _found(tmp_path, "strength-steps", ("label: link}", weak))
    (found,) = _found(tmp_path, "strength-steps", ("label: link}", weak.replace("3.5", "2")))
    assert found.component == "link"


def test_an_estimate_is_no_weak_link(tmp_path: Path) -> None:
    load = "working_load: 2 kN, breaking_load: 20 kN"
    link = "  link: {kind: body, role: connector, length: 0 m, buoyancy: -5 N, kn: 0 N/(m/s)^2,"
    link += f" inclination: insensitive, {load}}}\ncomponents:"
    link = "components:\n" + link.removesuffix("\ncomponents:")
    own = ("use: shackle-13", "use: link"), ("components:", link)
    assert len(_found(tmp_path, "strength-steps", *own)) == 1
    estimate = "estimate: {quantity: working_load, low: 2 kN, source: its like}"
    assert not _found(tmp_path, "strength-steps", *own, (load, estimate))
