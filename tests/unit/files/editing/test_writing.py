"""Texts are quoted where YAML would read them otherwise, and nowhere else."""

import pytest
import yaml
from hypothesis import given
from hypothesis import strategies as st

from calm.files.editing.writing import written

PLAIN = ["5 m", "-5.2 deg", "1/2 in", "12:30", "été", "a#b", "it's", 'a"b', "1e3", "50 %"]
BROKEN_BY_BRACKETS = ["a, b", "[x]", "x}", "what?", "a[0]"]
QUOTED = [
    "",
    " a",
    "a ",
    "a: b",
    "a #b",
    "- a",
    "null",
    "~",
    "Yes",
    "a:",
    "# a",
    ":0",
    "?x",
    "*a",
    "%",
    "a\nb",
    "=",
]


@pytest.mark.parametrize("text", PLAIN)
def test_plain(text: str) -> None:
    assert written(text, flow=True) == text == written(text, flow=False)


@pytest.mark.parametrize("text", QUOTED)
def test_quoted(text: str) -> None:
    assert written(text, flow=True)[0] == '"' == written(text, flow=False)[0]


def test_brackets_and_commas_matter_within_brackets() -> None:
    for text in BROKEN_BY_BRACKETS:
        assert written(text, flow=True) == f'"{text}"'
    assert written("a, b", flow=False) == "a, b"


def test_quotes_are_kept() -> None:
    assert written("it's", flow=True, quote="'") == "'it''s'"
    assert written('5 "', flow=True, quote='"') == '"5 \\""'
    assert written("a\nb", flow=True, quote="'") == '"a\\nb"'


@given(st.text(st.characters(codec="utf-8")), st.booleans(), st.sampled_from(["", "'", '"']))
def test_what_is_written_reads_back(text: str, flow: bool, quote: str) -> None:
    scalar = written(text, flow=flow, quote=quote)
    around = f"{{a: {scalar}, b: [{scalar}]}}" if flow else f"a: {scalar}  # c\nb:\n  - {scalar}\n"
    first, second = yaml.compose(around).value
    assert first[1].value == text == second[1].value[0].value
    assert first[1].tag != "tag:yaml.org,2002:null"
