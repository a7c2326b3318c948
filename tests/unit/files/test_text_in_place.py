"""A text read in place of the file it belongs to."""

from pathlib import Path

import pytest

import calm
from calm.errors import InputError
from calm.files import read_mooring
from calm.files.pieces import STAND_IN

LINES = Path(__file__).resolve().parents[3] / "lines"
LINE = """
environment: {depth: 500 m, current: {speed: 0.4 m/s, toward: 90 deg}}
line:
  - {use: sphere-steel-1250}
  - {use: wire-jacketed-8, length: 300 m}
  - {use: anchor-wheels-4}
"""


@pytest.mark.parametrize("path", sorted(LINES.glob("*.yaml")), ids=lambda path: path.stem)
def test_the_same_text_is_the_same_mooring(path: Path) -> None:
    assert read_mooring(path, text=path.read_text(encoding="utf-8")) == read_mooring(path)


def test_the_file_need_not_exist(tmp_path: Path) -> None:
    path = tmp_path / "new.yaml"
    assert calm.load(path, text=LINE).file.name == "new"
    with pytest.raises(InputError, match=r"new\.yaml:5:11: .*wire-jacketed-8"):
        calm.load(path, text=LINE.replace("wire-jacketed-8", "wire-jackted-8"))


def test_a_line_without_an_anchor_may_stand_on_a_stand_in() -> None:
    text = LINE.replace("  - {use: anchor-wheels-4}\n", "")
    with pytest.raises(InputError, match="has no anchor") as refusal:
        read_mooring("new.yaml", text=text)
    assert [problem.lacks for problem in refusal.value.problems] == ["no anchor"]
    pieces = read_mooring("new.yaml", text=text, stand_in=True).pieces
    assert (pieces[-1].use, pieces[-1].index) == (STAND_IN, 2)
    assert read_mooring("new.yaml", text=LINE, stand_in=True) == read_mooring("new.yaml", text=LINE)


def test_what_lacks_is_told_from_what_is_wrong() -> None:
    text = LINE.replace(", length: 300 m", "").replace("depth: 500 m", "depth: 500")
    with pytest.raises(InputError) as refusal:
        read_mooring("new.yaml", text=text)
    assert [(p.line, p.lacks) for p in refusal.value.problems] == [
        (2, ""),
        (5, "no length on wire-jacketed-8"),
    ]
