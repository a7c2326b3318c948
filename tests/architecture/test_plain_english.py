"""Docstrings and messages name things, with a subject and a verb, one idea a sentence.

A few habits make English hard to read without context: clauses in place of nouns, pronouns without
a noun, fragments, and long sentences. The test counts sentences with such a habit. The ceilings are
what was reached; they may fall, never rise.
"""

import ast
import re
from collections.abc import Iterator
from pathlib import Path

import pytest

PACKAGE = Path(__file__).resolve().parents[2] / "calm"

HABITS = {
    "a clause in place of a noun": r"\b(?:return|find|of|to|than|from|with|for|all|is|and) what\b",
    "a question in place of a quantity": r"^(?:what|how (?:far|much|often|fast|well))\b",
    "a pronoun without a noun": r"^(?:it|its|they|those|the same|the one|that of|this is what)\b",
    "a fragment": r"^of (?:a|an|the|all|each|every)\b[^,]*$",
    "'where' in place of 'if'": r"\bwhere (?:there (?:is|are)|it is|it has|none|not|that is)\b",
    "a stranded word": r"\b(?:of|is|has|was|does)$",
    "a coined verb": r"\b(?:is|are|was|be) (?:told of|asked for|meant by|said of|hung)\b",
}
PATTERNS = {name: re.compile(pattern, re.IGNORECASE) for name, pattern in HABITS.items()}
LONGEST = 45
"""Words in a sentence."""

CEILINGS = {"docstrings": 3.3, "messages": 3.8}
"""Largest share of sentences with a habit, in percent."""


def habit_of(sentence: str) -> str | None:
    """The first habit found in a sentence."""
    text = re.sub(r"`+[^`]*`+", "X", sentence).strip().rstrip(".;:,")
    if len(text.split()) > LONGEST:
        return "a long sentence"
    return next((name for name, pattern in PATTERNS.items() if pattern.search(text)), None)


def sentences_of(text: str) -> Iterator[str]:
    """The sentences of a text, without its tables and lists."""
    prose = re.split(r"\n\s*\w[\w ]*\n\s*-{3,}\n", text)[0]
    for paragraph in re.split(r"\n\s*\n", prose):
        yield from re.split(r"(?<=[.;:])\s+(?=[A-Z`])", " ".join(paragraph.split()))


def docstrings_of(tree: ast.Module) -> Iterator[str]:
    """The docstrings of a module and of its public classes and functions."""
    for node in ast.walk(tree):
        if isinstance(node, ast.Module | ast.ClassDef | ast.FunctionDef | ast.AsyncFunctionDef):
            public = isinstance(node, ast.Module) or not node.name.startswith("_")
            if public and (text := ast.get_docstring(node)):
                yield text


def messages_of(tree: ast.Module) -> Iterator[str]:
    """The sentences that a program may print: texts of five words and more."""
    bare = {id(node.value) for node in ast.walk(tree) if isinstance(node, ast.Expr)}
    parts = {
        id(part)
        for node in ast.walk(tree)
        if isinstance(node, ast.JoinedStr)
        for part in ast.walk(node)
        if part is not node
    }
    for node in ast.walk(tree):
        if id(node) in bare or id(node) in parts:
            continue
        if isinstance(node, ast.JoinedStr):
            values = node.values
            text = "".join(each.value if isinstance(each, ast.Constant) else "X" for each in values)
        elif isinstance(node, ast.Constant) and isinstance(node.value, str):
            text = node.value
        else:
            continue
        if len(text.split()) >= 5 and re.search(r"[a-z]{3} [a-z]", text):
            yield text


SURFACES = {"docstrings": docstrings_of, "messages": messages_of}


@pytest.mark.parametrize("surface", SURFACES)
def test_prose_has_few_habits_that_need_a_second_reading(surface: str) -> None:
    counted, marked = 0, []
    for path in sorted(PACKAGE.rglob("*.py")):
        for text in SURFACES[surface](ast.parse(path.read_text("utf-8"))):
            for sentence in sentences_of(text):
                counted += 1
                if habit := habit_of(sentence):
                    marked.append(f"{path.relative_to(PACKAGE)}: {habit}: {sentence[:90]}")
    share = 100.0 * len(marked) / counted
    assert share <= CEILINGS[surface], "\n".join([f"{share:.2f} %", *marked])


@pytest.mark.parametrize(
    ("sentence", "habit"),
    [
        ("Return what is written of it.", "a clause in place of a noun"),
        ("How far the top is from its design depth.", "a question in place of a quantity"),
        ("It to the new width.", "a pronoun without a noun"),
        ("Of a mooring its name.", "a fragment"),
        ("The pieces that each is made of.", "a stranded word"),
        ("Number of stored profiles by status.", None),
        ("Whether the line strums.", None),
    ],
)
def test_a_habit_is_found(sentence: str, habit: str | None) -> None:
    assert habit_of(sentence) == habit
