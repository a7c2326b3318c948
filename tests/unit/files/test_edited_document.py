"""A text composed part by part is the text composed whole: data, places, what is told of it."""

from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from calm.errors import InputError
from calm.files.document import compose, document_of

LINES = Path(__file__).resolve().parents[3] / "lines"
TEXTS = sorted(path.read_text(encoding="utf-8") for path in LINES.glob("*.yaml"))
SMALL = """# about it
name: a line   # so called
environment:
  current:
    rows: [[0, 1],
      [2, 3]]
line:   # from the top
  # the float
  - {use: float, label: "a: b"}

  - use: wire
    note: |
      - no item

      nor this
    clamps:
      - {use: ctd, at: 1 m}
  -
  - {use: anchor}
# the end
solver:
"""
SIGNS = [
    *"\n\t -{}[]\"'|>#:,?%&*!~a\r\x85\u2028\ufeff", "- ", ": ", "  ", "\r\n", "\n\n", "|\n", "<<: ",
    "\n---\n", "\n...\n", "\n- x", "\n  - y", "\nname: z", "\nline:\n", "\n  # c\n",
    "&x ", "*x", "!t ",
]  # fmt: skip


def said(make, text: str):
    try:
        document = make("m.yaml", text)
    except InputError as error:
        return error.problems
    return list(document.data), document.data, document.values, document.keys


@pytest.mark.parametrize("text", [*TEXTS, SMALL, SMALL.replace("\n", "\r\n"), "\ufeff" + SMALL])
def test_documents_are_the_same(text: str) -> None:
    assert said(document_of, text) == said(compose, text.removeprefix("\ufeff"))


@given(
    st.sampled_from([SMALL, *TEXTS[:3]]),
    st.lists(
        st.tuples(st.floats(0, 1, exclude_max=True), st.integers(0, 3), st.sampled_from(SIGNS)),
        max_size=4,
    ),
)
def test_so_are_those_of_broken_texts(text: str, edits: list[tuple[float, int, str]]) -> None:
    for share, out, sign in edits:
        at = int(share * len(text))
        text = text[:at] + sign + text[at + out :]
    assert said(document_of, text) == said(compose, text.removeprefix("\ufeff"))


@pytest.mark.parametrize(
    "text",
    [
        "name: [a,\nline: 3]\n",
        'name: "a\nline:\n  - b"\n',
        "line:\n  - {use: a,\n  - use: b}\n",
        "line:\n    - a\n  - b\n",
        "line:\n- a\n- b\nname: c\n",
        "a: 1\na: 2\n",
        "line: [1]\nline:\n  - 2\n",
        "  a: 1\nb: 2\n",
        "a: &x 1\nb: *x\n",
        "%YAML 1.1\n---\na: 1\n",
        "a: 1\n---\nb: 2\n",
        "? a\n: 1\n",
        "a: 1\rb: 2\n",
        "line:\t# c\n  - a\n",
        "line:# c\n  - a\n",
        "line:\n  - a\n b: 1\n",
        "description: |\n  line:\n  - a\nline:\n  - b\n",
    ],
)
def test_cuts_that_could_deceive(text: str) -> None:
    assert said(document_of, text) == said(compose, text)
