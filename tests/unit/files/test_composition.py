"""What stands where in a YAML text: the same by libyaml and by the parser in Python."""

import random
import re
from collections.abc import Iterator

import pytest
import yaml

from calm.files.composition import Composition, Node, compose
from tests.property.test_editing import FILES

SIGNS = (
    *("\n", "  ", "- ", ":", ": ", "{", "}", "[", "]", ",", "'", '"', "#", " # x", "\t", "|", "> "),
    *("&a", "*a", "!x", "---\n", "? ", "?", "...", "\r\n", "\r", "\x85", "\u2028", "key: v\n"),
    *("- - ", "\ufeff", "%", "\\", "\x01", "\U0001f6a2", "é", "!!str ", "@", "~", "null", "\ud800"),
)
SHIPS = {"m": "\U0001f6a2", "e": "é"}

needs_libyaml = pytest.mark.skipif(not yaml.__with_libyaml__, reason="PyYAML without libyaml")


@pytest.fixture(params=["libyaml", "python"])
def parser(request: pytest.FixtureRequest, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(yaml, "__with_libyaml__", request.param == "libyaml")


def by_both(text: str) -> Composition:
    """What a text is composed to, once it is so with both."""
    fast = compose(text)
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(yaml, "__with_libyaml__", False)
        assert fast == compose(text)
    return fast


def broken(count: int) -> Iterator[str]:
    """Signs of YAML thrown into parts of files, most of them as far left as they were."""
    choose = random.Random(14)
    for _ in range(count):
        lines = FILES[choose.choice(sorted(FILES))].splitlines(keepends=True)
        first = choose.randrange(len(lines))
        text = "".join(lines[first : first + choose.randrange(1, 20)])
        indent = len(text) - len(text.lstrip(" "))
        if choose.random() < 0.7:
            text = re.sub(rf"^ {{{indent}}}", "", text, flags=re.MULTILINE)
        for _ in range(choose.randrange(1, 4)):
            place = choose.randrange(len(text) + 1)
            text = text[:place] + choose.choice(SIGNS) + text[place + choose.choice([0, 1]) :]
        yield text


def nodes(node: Node) -> Iterator[Node]:
    yield node
    for child in (*node.keys, *node.children):
        yield from nodes(child)


def assert_places(text: str, root: Node) -> None:
    """Each node stands where it says, and what is plain there is what it says."""
    for node in nodes(root):
        before = text[: node.start].replace("\r\n", "\n").replace("\r", "\n")
        before = before.replace("\ufeff", "")  # takes no column
        if node.start < node.end:
            column = len(before) - before.rfind("\n")
            assert (node.line, node.column) == (before.count("\n") + 1, column)
        words = text[node.start : node.end]
        if node.kind == "scalar" and not node.style and not words.startswith("!"):
            assert " ".join(words.split()) == " ".join((node.data or words).split())
        if node.style in ("'", '"'):
            assert words[0] == words[-1] == node.style or words.startswith("!")
        if node.style == "flow":
            assert words[0] + words[-1] in ("[]", "{}") or text[node.start - 1] != "{"
        assert all(node.start <= each.start <= each.end for each in node.children)


@needs_libyaml
@pytest.mark.parametrize("name", FILES)
@pytest.mark.thorough
def test_files_are_the_same_by_both_parsers(name: str) -> None:
    text = FILES[name].removeprefix("\ufeff")
    for each in (
        text,
        text.replace("\n", "\r\n"),
        "\ufeff" + text,
        text.translate(str.maketrans(SHIPS)),
    ):
        composition = by_both(each)
        assert composition.root is not None and not composition.refusals
        assert_places(each, composition.root)


@needs_libyaml
def test_so_are_broken_files() -> None:
    compositions = [(text, by_both(text)) for text in broken(400)]
    read = [(text, found.root) for text, found in compositions if not found.refusals]
    assert 80 < len(read) < 320
    for text, root in read:
        if root is not None:
            assert_places(text, root)


READ = {
    "a: 1e3\nb: 12:30\nc: no\nd: 0o17\ne: 017\nf: 2026-11-21\ng: 1_000\nh: on": {
        **{"a": "1e3", "b": "12:30", "c": "no", "d": "0o17", "e": "017", "f": "2026-11-21"},
        **{"g": "1_000", "h": "on"},
    },
    "a:\nb: ~\nc: null\nd: ''\ne: '~'\nf: [~, ]\n~: Null\ng: nuLL": {
        **{"a": None, "b": None, "c": None, "d": "", "e": "~", "f": [None], "~": None},
        **{"g": "nuLL"},
    },
    "<<: {a: b}": {"<<": {"a": "b"}},
    "a: !!str ~\nb: !!int '3'\nc: ! ~\nd: !!null x": {"a": "~", "b": "3", "c": None, "d": None},
    "{a: b?, c: d ?e, f?g: '?', h: i ? j}": {"a": "b?", "c": "d ?e", "f?g": "?", "h": "i ? j"},
    "{a: b?,\tc: d ?e,\tf?g: '?', h: i ? j}": {"a": "b?", "c": "d ?e", "f?g": "?", "h": "i ? j"},
    "? a ?b\n: - ? d?\n": {"a ?b": [{"d?": None}]},
    "{a, b: , c: d}": {"a": None, "b": None, "c": "d"},
    "a: b\n\ufeffc: d": {"a": "b", "\ufeffc": "d"},
    "a: b\u2028c\nd: 'e\x85f'\n# g\u2029\nh: i": {"a": "b c", "d": "e f", "h": "i"},
    'a: "\\e[31m \\u202e \\ud800"': {"a": "\ufffd[31m \ufffd \ufffd"},
    "a: |\n  x\n   y\n\nb: >-\n  x\n  y\nc: x\n  y": {"a": "x\n y\n", "b": "x y", "c": "x y"},
    "a: [0,\t0.8,\t90]\nb: {c:\t1 m/s,\n\td: 9}": {
        "a": ["0", "0.8", "90"],
        "b": {"c": "1 m/s", "d": "9"},
    },
    "# a\tb\na: 'x\ty'\nb: |\n  x\ty": {"a": "x\ty", "b": "x\ty"},
    "%YAML 1.1\n---\na: no\n...\n": {"a": "no"},
    "# [ m\n" * 200 + f"a: '{'[' * 200}'\n": {"a": "[" * 200},
    f"b: {'[' * 100}{']' * 100}": ...,
    "": None,
    "# nothing\n": None,
}


@pytest.mark.parametrize("text", READ)
def test_what_is_read(parser: None, text: str) -> None:
    root, refusals = compose(text)
    assert not refusals
    if READ[text] is ...:
        return
    assert (root and root.data) == READ[text]


ANCHORED = "YAML anchors (&) and aliases (*) are not supported; repeat the value"
NO_YAML = "is not valid YAML: "
TAB = "a tab; YAML is indented with spaces"

REFUSED = {
    "a: &x b\nc: *x": [(1, 4, ANCHORED)],
    "a: &x {b: &y 1}\nc: *y": [(1, 4, ANCHORED)],
    "a: *x\nb: &x c": [(1, 4, "a text that begins with * must be in quotes")],
    "&a b: c": [(1, 1, ANCHORED)],
    "a: !foo b": [(1, 4, "tags (`!foo`) are not allowed")],
    "a: [!!set {b}]": [(1, 5, "tags (`tag:yaml.org,2002:set`) are not allowed")],
    "? [a]\n: b\nc: d": [(1, 3, "a key must be plain text")],
    "a: 1\nb: 2\na: 3": [(3, 1, "`a` is given twice (first on line 1)")],
    "{a: 1, 'a': 2}": [(1, 8, "`a` is given twice (first on line 1)")],
    "a: {b: {b: 1, b: 2}, b: {c: 1, c: 1}, b: 4}": [
        (1, 15, "`b` is given twice (first on line 1)"),
        (1, 22, "`b` is given twice (first on line 1)"),
        (1, 39, "`b` is given twice (first on line 1)"),
    ],
    "a: b\n---\nc: d": [
        (
            *(2, 1),
            f"{NO_YAML}expected a single document in the stream from line 1, but found another "
            "document",
        )
    ],
    "a: b: c": [(1, 5, 'a text with a colon must be in quotes: `a: "b: c"`')],
    "a: 'b\n\n": [(1, 4, "the quotes that begin here are not closed")],
    "line:\n  - {use shackle-16}": [
        (2, 6, "`use shackle-16` has no colon; did you mean `use: shackle-16`?")
    ],
    "line:\n  - {use:a, b: c}": [
        (2, 6, "`use:a` has no space after its colon; did you mean `use: a`?")
    ],
    "line\n  - {use: a}": [(1, 1, "`line` has no colon; did you mean `line:`?")],
    "a:\n  depth 3 m # low\n  c: d": [
        (2, 3, "`depth 3 m` has no colon; did you mean `depth: 3 m`?")
    ],
    "a:\n  depth:3 m\n  c: d": [
        (2, 3, "`depth:3 m` has no space after its colon; did you mean `depth: 3 m`?")
    ],
    "a:\n  - use: b\n    label: wire 2: lower": [
        (3, 18, 'a text with a colon must be in quotes: `label: "wire 2: lower"`')
    ],
    "{a: b c: d}": [
        (
            *(1, 8),
            "`a: b c:` has two colons; add a comma before the next key, or put the text in quotes",
        )
    ],
    "a:\n  - {b: c\n  - {b: c}": [(2, 5, "the `{` that begins here is not closed")],
    "a:\n  - {b: c}}": [(2, 11, "`}` closes nothing")],
    "a: 1\n  b: 2": [(2, 3, "is indented further than line 1, which already has a value")],
    "a:\n    b: 1\n  c: 2": [
        (
            *(3, 3),
            "starts in column 3, but line 2 starts in column 5, and line 1, which begins this "
            "block, starts in column 1",
        )
    ],
    "-{use: a}": [(1, 1, "the dash of a list item needs a space after it")],
    "a:\n\t- b\n\t- c": [(2, 1, TAB), (3, 1, TAB)],
    "a: b\tc": [(1, 5, f"{NO_YAML}found character '\\t' that cannot start any token")],
    "a: \x07": [
        (0, 0, f"{NO_YAML}unacceptable character #x0007: special characters are not allowed")
    ],
    "a: \ud800": [
        (0, 0, f"{NO_YAML}unacceptable character #xd800: special characters are not allowed")
    ],
    "a: @?b": [(1, 4, "a text that begins with @ must be in quotes")],
    "%? ,": [
        (
            *(1, 2),
            f"{NO_YAML}while scanning a directive from line 1, expected alphabetic or numeric "
            "character, but found '?'",
        )
    ],
    f"line:\n  - {'[' * 101}": [(0, 0, "is nested too deeply")],
    f"a: {'[' * 5000}": [(0, 0, "is nested too deeply")],
    f"a: &x {'{b: ' * 5000}": [(0, 0, "is nested too deeply")],
    "- " * 300: [(0, 0, "is nested too deeply")],
}


@pytest.mark.parametrize("text", REFUSED)
def test_what_is_refused(parser: None, text: str) -> None:
    assert list(compose(text).refusals) == REFUSED[text]


def test_places_count_characters(parser: None) -> None:
    text = (
        "\ufeff\U0001f6a2: é # c\r\nb:\r\n  - '\U0001f6a2\U0001f6a2'\r\n  - {c: }\r\n  -\r\nd:\r\n"
    )
    root, _ = compose(text)
    assert root is not None
    found = [(text[each.start : each.end], each.line, each.column) for each in nodes(root)]
    assert found[1:] == [
        ("\U0001f6a2", 1, 1),
        ("b", 2, 1),
        ("d", 6, 1),
        ("é", 1, 4),
        ("- '\U0001f6a2\U0001f6a2'\r\n  - {c: }\r\n  -", 3, 3),
        ("'\U0001f6a2\U0001f6a2'", 3, 5),
        ("{c: }", 4, 5),
        ("c", 4, 6),
        ("", 4, 6),
        ("", 5, 4),
        ("", 6, 1),
    ]
