"""Forty ways to lay a file out: an edit changes its own bytes and no other.

Each holds `5 m` once, which is changed. What YAML allows and CALM's files do not is refused, with
its place, and stays as it is.
"""

import re
from collections import Counter
from collections.abc import Iterator
from typing import Any

import pytest

from calm.files.editing import LINE, Draft, EditError

LAYOUTS = {
    "block": "environment:\n  depth: 5 m\nline:\n  - use: ball\n  - use: dead\n",
    "flow": "environment: {depth: 5 m}\nline: [{use: ball}, {use: dead}]\n",
    "JSON": '{"environment": {"depth":"5 m"},\n "line":[{"use":"ball"},{"use":"dead"}]}\n',
    "figures in columns": (
        "line:\n"
        "  - {use: ball,   label: top,     count:  1}\n"
        "  - {use: rope,   length:  5 m,   count:  1 }\n"
        "  - {use: dead  , label: bottom}\n"
    ),
    "comments between items": (
        "line:\n  # above\n  - use: ball\n  # between\n\n  # and more\n"
        "  - {use: rope, length: 5 m}\n# of the file\n  - use: dead\n  # below\n"
    ),
    "comments at line ends": (
        "line:   # the line\n  - use: ball   # top\n  - use: rope # wire\n"
        "    length: 5 m     # cut in May\n  - use: dead # the end\n"
    ),
    "comments of several depths": (
        "line:\n  - use: rope\n      # deep\n    # as the key\n    length: 5 m\n"
        "    # below\n  # as the dash\n# left\n  - use: dead\n"
    ),
    "comments within brackets": (
        "line: [ # begins\n  {use: ball, # top\n   label: x},\n  # rope\n"
        "  {use: rope, length: 5 m}, # 5\n  {use: dead} # no comma\n  # last\n]\n"
    ),
    "blank lines": "\n\nline:\n\n\n  - use: rope\n\n    length: 5 m\n\n\n\n  - use: dead\n\n\n",
    "blank lines of spaces": "line:\n   \n  - use: rope\n  \n    length: 5 m\n \n  - use: dead\n",
    "spaces at line ends": "line:  \n  - use: rope   \n    length: 5 m  \n  - use: dead \n",
    "tabs in comments and texts": (
        "line: #\ta\n  - use: rope #\tb\n    length: 5 m\n  - use: 'x\ty'\n"
    ),
    "tabs within brackets": "line:\n  - {use: rope,\tlength:\t5 m}\n  - {use:\tdead}\n",
    "Windows line ends": "line:\r\n  - use: rope\r\n    length: 5 m\r\n  - use: dead\r\n",
    "Windows, no final line end": "# c\r\nline:\r\n  - {use: rope, length: 5 m}\r\n  - use: dead",
    "both line ends": "name: x\r\nline:\n  - use: rope\r\n    length: 5 m\n  - use: dead\r\n",
    "no final line end": "line:\n  - use: rope\n    length: 5 m\n  - use: dead",
    "a comment without line end": "line:\n  - {use: rope, length: 5 m}\n  - use: dead\n# the end",
    "a byte order mark": "\ufeffline:\n  - use: rope\n    length: 5 m\n  - use: dead\n",
    "a byte order mark and a comment": (
        "\ufeff# é\nline:\n  - {use: rope, length: 5 m}\n  - use: dead\n"
    ),
    "single quotes": "name: 'd''été'\nline:\n  - use: 'rope'\n    'length': '5 m'\n  - use: dead\n",
    "double quotes": 'name: "a\\tb"\nline:\n  - "use": "rope"\n    length: "5 m"\n  - use: dead\n',
    "quotes over two lines": (
        'description: "one\n  two \\\n  three"\n'
        "line:\n  - {use: rope, length: 5 m}\n  - use: dead\n"
    ),
    "a plain text over two lines": (
        "description: one\n  two\n\n  three\nline:\n  - {use: rope, length: 5 m}\n  - use: dead\n"
    ),
    "folded": (
        "description: >\n  one\n  two\n\n    more\n  last\n\nline:\n"
        "  - {use: rope, length: 5 m}\n  - use: dead\n"
    ),
    "folded, stripped and kept": (
        "description: >-\n   one\n   two\nname: >+\n  a\n\n\nline:\n"
        "  - {use: rope, length: 5 m}\n  - use: dead\n"
    ),
    "literal": (
        "line:\n  - use: rope\n    note: |\n      # no comment\n        x: y\n\n      z\n"
        "    length: 5 m\n  - use: dead\n"
    ),
    "literal with its indentation": (
        "description: |2\n    two more\n  none\n"
        "line:\n  - {use: rope, length: 5 m}\n  - use: dead\n"
    ),
    "a long line": (
        f"description: {'a long text ' * 30}end\nline:\n"
        f"  - {{use: rope, label: {'long ' * 40}rope, length: 5 m}}\n  - use: dead\n"
    ),
    "indented by one and by seven": (
        "environment:\n depth: 5 m\n current:\n        speed: 1 m/s\n        toward: 9 deg\n"
        "line:\n       - use: ball\n       - use: dead\n"
    ),
    "dashes below the key": "line:\n- use: rope\n  length: 5 m\n- use: dead\n",
    "wide dashes": "line:\n  -   use: rope\n      length: 5 m\n  -   use: dead\n",
    "dashes by themselves": "line:\n  -\n    use: rope\n    length: 5 m\n  -\n\n    use: dead\n",
    "- - x": (
        "environment:\n  current:\n    columns: [depth m, speed m/s, toward deg]\n    rows:\n"
        "      - - 0\n        - 1\n        - 90\n      - -   5 m\n        - 0.5\n        - 80\n"
        "line:\n  - use: dead\n"
    ),
    "? key": "? line\n:\n  - ? use\n    : rope\n    ? length\n    : 5 m\n  - use: dead\n",
    "a document of its own": (
        "%YAML 1.1\n---\nline:\n  - {use: rope, length: 5 m}\n  - use: dead\n...\n"
    ),
    "a document begins": "# c\n--- # here\nline:\n  - {use: rope, length: 5 m}\n  - use: dead\n",
    "keys far from their values": (
        "line   :\n  - use :    rope\n    length   :     5 m\n  - {use : dead, label   :   x}\n"
    ),
    "keys without values": (
        "name:\nposition: ~\nline:\n  - {use: rope, label: , length: 5 m, note}\n"
        "  - use: dead\n    label:\n"
    ),
    "other scripts": (
        "name: 深い — ø 🚢\nline:\n  - {use: rope, label: ü, length: 5 m}\n  - use: dead\n"
    ),
    "what looks like YAML 1.1": (
        "name: no\nline:\n  - {use: rope, label: 0x1F, count: 017, length: 5 m}\n"
        "  - {use: dead, label: 12:30}\n"
    ),
    "a comma before the bracket": "line: [{use: rope, length: 5 m,}, {use: dead , }, ]\n",
}


NOT_THE_SAME = {
    "an item more": ("JSON",),
    "an item below": ("JSON",),
    "the same twice": ("JSON",),
    "a key": ("figures in columns", "tabs within brackets", "a comma before the bracket"),
}
"""After these edits blanks within brackets are as CALM writes them."""
KEPT_AS_TEXT = ("comments within brackets",)
"""Items that are put in or taken out would take comments with them."""

REFUSED = {
    "anchors and aliases": ("line:\n  - &x {use: rope, length: 5 m}\n  - *x\n", 2, 5),
    "merge keys of anchors": ("a: &a {use: rope}\nline:\n  - {<<: *a, length: 5 m}\n", 1, 4),
    "tags": ("line:\n  - {use: !mine rope, length: 5 m}\n", 2, 11),
    "a list for a key": ("? [line]\n: 5 m\n", 1, 3),
    "two documents": ("line: []\n---\nline: [5 m]\n", 2, 1),
    "a key twice": ("line: []\nline: [5 m]\n", 2, 1),
    "tabs that indent": ("line:\n\t- 5 m\n", 2, 1),
    "a tab before a comment": ("line:\n  - use: rope\n    length: 5 m\t# cut\n", 3, 16),
}


def places(data: Any, location: tuple[str | int, ...] = ()) -> Iterator[tuple[str | int, ...]]:
    """Where `5 m` stands."""
    if data == "5 m":
        yield location
    pairs = data.items() if isinstance(data, dict) else enumerate(data or ())
    if not isinstance(data, str):
        for step, one in pairs:
            yield from places(one, (*location, step))


def edits(draft: Draft) -> Iterator[tuple[str, Draft]]:
    """Edits of the first item, each and then the other way round."""
    count = len(draft.items)
    yield "an item more", draft.insert(0, {"use": "x"}).delete([0])
    yield "an item below", draft.insert(count, {"use": "x"}).delete([count])
    if draft.value((*LINE, 0, "serial")) is None:
        yield "a key", draft.put(0, "serial", "17").put(0, "serial", None)
    yield "the same twice", draft.paste(1, draft.copy([0])).delete([1])


@pytest.mark.parametrize("name", LAYOUTS)
def test_a_value_is_changed_and_nothing_else(name: str) -> None:
    text = LAYOUTS[name]
    draft = Draft(text)
    (place,) = places(draft.value(()))
    assert draft.put_at(place, "7 m").text == text.replace("5 m", "7 m")


@pytest.mark.parametrize("name", LAYOUTS)
def test_what_is_put_in_and_taken_out_leaves_nothing_behind(name: str) -> None:
    draft = Draft(LAYOUTS[name])
    if name in KEPT_AS_TEXT:
        with pytest.raises(EditError, match="comments; edit the list in the text"):
            list(edits(draft))
        return
    for edit, after in edits(draft):
        assert after.text == draft.text or name in NOT_THE_SAME.get(edit, ()), edit


@pytest.mark.parametrize("name", LAYOUTS)
def test_what_is_taken_out_leaves_all_else(name: str) -> None:
    draft = Draft(LAYOUTS[name])
    if name in KEPT_AS_TEXT:
        with pytest.raises(EditError, match="comments; edit the list in the text"):
            draft.delete([0])
        return
    after = draft.delete([0])
    assert after.value(LINE) == draft.value(LINE)[1:]
    lost = words(draft.text) - words(after.text)
    assert lost <= words(draft.items[0].text)
    assert ("\r\n" in after.text) == ("\r\n" in draft.text)
    assert after.text.endswith("\n") == draft.text.endswith("\n")


def words(text: str) -> Counter[str]:
    return Counter(re.findall(r"[^\s,\[\]{}]+", text))


@pytest.mark.parametrize("name", REFUSED)
def test_what_is_refused(name: str) -> None:
    text, line, column = REFUSED[name]
    draft = Draft(text)
    assert (draft.problems[0].line, draft.problems[0].column) == (line, column)
    with pytest.raises(EditError):
        draft.put_at(("name",), "x")
    assert draft.text == text
