"""Composing a text in parts gives what composing it whole gives, or the same failure."""

import random

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from ruamel.yaml import YAML

from calm.files import composition
from calm.files.composition import compose
from calm.files.composition import compose_whole as whole
from tests.property.test_editing import FILES

SIGNS = (
    *("\n", "  ", "- ", ":", ": ", "{", "}", "[", "]", ",", "'", '"', "#", " # x", "\t", "|", "> "),
    *("&a", "*a", "!x", "---\n", "? ", "...", "\r\n", "\r", "\x85", "\u2028", "key: v\n", "- - "),
    "\ufeff",
)


def outcome(read: object, text: str) -> object:
    try:
        return read(text)
    except Exception as error:
        return type(error)


@pytest.mark.parametrize("name", FILES)
def test_files(name: str) -> None:
    assert compose(FILES[name]) == whole(FILES[name])


def test_a_byte_order_mark_within_a_text_is_part_of_it() -> None:
    text = "name: x\n\ufeffline: []\n" + "# nothing\n" * 20
    assert compose(text) == whole(text)
    assert compose("\ufeff" + text) == whole("\ufeff" + text)


@pytest.mark.parametrize("read", [compose, whole])
@pytest.mark.parametrize("text", ["a: " + "[" * 5000, "line:\n  - " + "[" * 101 + "]" * 101])
def test_brackets_in_brackets_are_refused_before_they_are_read(monkeypatch, read, text) -> None:
    class Composed(YAML):
        def compose(self, stream: object) -> object:
            raise AssertionError("that takes a minute")

    monkeypatch.setattr(composition, "YAML", Composed)
    with pytest.raises(RecursionError):
        read(text)


def test_brackets_in_comments_and_quotes_are_no_depth() -> None:
    text = "# [ m\n" * 200 + f"a: '{'[' * 200}'\nb: {'[' * 100 + ']' * 100}\n"
    assert compose(text) == whole(text)
    assert compose(text).root is not None


@given(seed=st.integers(0, 2**32), worthwhile=st.sampled_from([0, 40, 150]))
@settings(max_examples=400)
def test_broken_files(seed: int, worthwhile: int) -> None:
    """Signs of YAML thrown into parts of files, the parts cut at any size."""
    choose = random.Random(seed)
    text = FILES[choose.choice(sorted(FILES))]
    start = choose.randrange(len(text))
    text = text[start : start + choose.randrange(20, 900)]
    for _ in range(choose.randrange(1, 5)):
        place = choose.randrange(len(text) + 1)
        text = text[:place] + choose.choice(SIGNS) + text[place + choose.choice([0, 1]) :]
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(composition, "_WORTHWHILE", worthwhile)
        assert outcome(compose, text) == outcome(whole, text)
