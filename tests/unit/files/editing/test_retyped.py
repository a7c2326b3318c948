"""Lines edited where all line breaks look alike: the untouched ones keep theirs."""

import random

import pytest
from textual.document._document import Document

from calm.files.editing.changes import lines_of, retyped

MIXED = "name: a\r\n# one\u2028two\x0cthree\nline: []\r\n\nb: 'c'\rd: e"
BREAKS = ("\n", "\n", "\r\n", "\r", "\u2028", "\x0c", "a", "# x", "")


@pytest.mark.parametrize("text", ["", "a", "a\n", "a\r\n", "a\u2028", MIXED, MIXED + "\r\n"])
def test_lines_that_nobody_touched_give_the_text(text: str) -> None:
    assert retyped(text, [line.text for line in lines_of(text)]) == text


def edited(*, at: int, take: int = 0, put: tuple[str, ...] = ()) -> str:
    lines = [line.text for line in lines_of(MIXED)]
    lines[at : at + take] = put
    return retyped(MIXED, lines)


def test_one_line_is_changed_and_no_other() -> None:
    assert edited(at=2, take=1, put=("two!",)) == MIXED.replace("two", "two!")
    assert edited(at=0, take=1) == MIXED.removeprefix("name: a\r\n")
    assert edited(at=5, take=1) == MIXED.replace("\r\n\nb", "\r\nb")


def test_new_lines_end_in_the_manner_of_the_file() -> None:
    assert edited(at=2, put=("new",)) == MIXED.replace("two", "new\r\ntwo")
    assert edited(at=8, put=("new", "")) == MIXED + "\r\nnew\r\n"
    assert retyped("a\n", ["a", "", "b"]) == "a\n\nb"


def test_two_line_breaks_do_not_become_one() -> None:
    assert lines_of(retyped("a\rb\n\nc", ["a", "", "c"])) == lines_of("a\r\rc")


def test_an_editor_and_the_file_have_the_same_lines() -> None:
    choose = random.Random(4)
    for _ in range(2000):
        text = "".join(choose.choices(BREAKS, k=choose.randrange(9)))
        lines = [*Document(text).lines]
        assert [line.text for line in lines_of(text)] == lines
        assert retyped(text, lines) == text
        lines.insert(choose.randrange(len(lines)), "more")
        after = lines_of(retyped(text, lines))
        # a last empty line is the end of the line above it, whatever ends that
        assert [line.text for line in after if line.text] == [one for one in lines if one]
