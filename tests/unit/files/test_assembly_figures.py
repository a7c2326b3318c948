"""Values of an assembly that apply to each of its parts without an own value."""

from pathlib import Path

import pytest

from calm.case.design import load
from calm.errors import InputError
from calm.files.pieces import parts_of

FILE = """
name: pair
environment: {{depth: 200 m}}
line:
  - {{use: ball}}
  - {{use: wire-jacketed-8, length: 20 m}}
  - {{use: set{given}}}
  - {{use: anchor-wheels-3}}
components:
  ball: {{kind: sphere, role: float, diameter: 1 m, buoyancy: 4000 N}}
  opener: {{kind: cylinder, role: release, diameter: 0.1 m, length: 1 m, buoyancy: -200 N}}
  known: {{kind: cylinder, role: release, diameter: 0.1 m, length: 1 m, buoyancy: -200 N,
    breaking_load: 90 kN}}
  links: {{kind: chain, diameter: 13 mm}}
  logger: {{kind: cylinder, diameter: 50 mm, length: 0.3 m, buoyancy: -5 N}}
  set: {{kind: assembly{own}, parts: [{{use: opener}}, {{use: known}},
    {{use: links, length: 1 m, clamps: [{{use: logger, at: 0.5 m}}]}}]}}
"""


def _parts(folder: Path, given: str = "", own: str = "") -> dict[str, object]:
    path = folder / "m.yaml"
    path.write_text(FILE.format(given=given, own=own))
    return {part.use: part.component for part in parts_of(load(path).file.pieces)}


@pytest.mark.parametrize("how", ["given", "own"])
def test_a_load_counts_for_the_pieces_without_any(tmp_path: Path, how: str) -> None:
    """On the item or in its definition; not for what is clamped on, which bears no load."""
    parts = _parts(tmp_path, **{how: ", working_load: 25 kN, source: certificate 7"})
    loads = {use: one.working_load for use, one in parts.items() if use != "ball"}
    assert loads["opener"] == loads["links"] == pytest.approx(25e3)
    assert loads["known"] is loads["logger"] is None
    assert parts["opener"].sources == {"working_load": "certificate 7"}


def test_other_figures_count_for_the_parts_that_they_concern(tmp_path: Path) -> None:
    figures = ", depth_rating: 700 m, opening_load: 9 kN, grip: 1 kN, max_tilt: 40 deg"
    parts = _parts(tmp_path, figures)
    told = {
        use: [getattr(one, key) for key in ("depth_rating", "opening_load", "grip", "max_tilt")]
        for use, one in parts.items()
    }
    for use in ("opener", "known"):
        assert told[use] == [700.0, 9000.0, None, 40.0]
    assert told["links"] == [None] * 4
    assert told["logger"] == [700.0, None, 1000.0, 40.0]


def test_a_figure_that_no_part_lacks_is_refused(tmp_path: Path) -> None:
    with pytest.raises(
        InputError, match="all parts of `glass-cluster-4` already have a `depth_rating`"
    ):
        path = tmp_path / "m.yaml"
        text = FILE.format(given="", own="").replace("use: set", "use: glass-cluster-4")
        path.write_text(text.replace("glass-cluster-4", "glass-cluster-4, depth_rating: 9 m", 1))
        load(path)


def test_other_keys_are_refused(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="`buoyancy` cannot be set on an assembly"):
        _parts(tmp_path, ", buoyancy: 9 N")
