"""Whatever is done to a file, what was not touched stays byte for byte, and undo gives it back."""

import re
from collections import Counter
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from calm.files.editing import Draft, EditError, History, clamps_of
from tests.property.ugly_files import UGLY

pytestmark = pytest.mark.thorough

LINES = Path(__file__).resolve().parents[2] / "lines"
FILES = {path.stem: path.read_bytes().decode() for path in sorted(LINES.glob("*.yaml"))} | UGLY

WORDS = st.one_of(
    st.sampled_from(
        [
            "5 m",
            "fit",
            "top float",
            "a, b",
            "é: ü",
            "# no",
            "it's",
            '"',
            "null",
            "-",
            "- x",
            "{",
            "",
        ]
    ),
    st.text(st.characters(codec="utf-8", categories=("L", "N", "P", "S", "Zs")), max_size=8),
)
KEYS = st.sampled_from(["label", "length", "count", "cd", "top_depth"])
VALUES = st.fixed_dictionaries(
    {"use": st.sampled_from(["ball", "rope"])}, optional={"label": WORDS}
)
CLAMPS = st.lists(st.fixed_dictionaries({"use": st.just("meter"), "at": WORDS}), max_size=2)


def test_the_files_can_be_edited() -> None:
    assert all(not Draft(text).problems and Draft(text).items for text in FILES.values())


@dataclass
class Editor:
    """A history, and how it is changed at random."""

    draw: Callable[[st.SearchStrategy], object]
    history: History
    comments: set[str]

    @property
    def draft(self) -> Draft:
        return self.history.draft

    def index(self, beyond: int = 0) -> int:
        return self.draw(st.integers(0, len(self.draft.items) - 1 + beyond))

    def some(self) -> list[int]:
        count = len(self.draft.items)
        return self.draw(st.lists(st.integers(0, count - 1), max_size=3)) if count else []

    def insert(self) -> None:
        draft, at = self.draft, self.index(1)
        values, clamps = self.draw(VALUES), self.draw(CLAMPS)
        new = draft.insert(at, {**values, "clamps": clamps} if clamps else values)
        assert new.items[at].values == values
        assert [clamp.values for clamp in new.items[at].clamps] == clamps
        self.kept(new, [*range(at), None, *range(at, len(draft.items))])

    def delete(self) -> None:
        gone = self.some()
        new = self.draft.delete(gone)
        self.kept(new, [i for i in range(len(self.draft.items)) if i not in gone])

    def move(self) -> None:
        if not self.draft.items:
            return
        index, to = self.index(), self.index()
        order = list(range(len(self.draft.items)))
        order.insert(to, order.pop(index))
        self.kept(self.draft.move(index, to), order)

    def duplicate(self) -> None:
        chosen = sorted(set(self.some()))
        below = chosen[-1] + 1 if chosen else 0
        count = len(self.draft.items)
        new = self.draft.paste(below, self.draft.copy(chosen))
        assert [new.items[below + i].values for i in range(len(chosen))] == [
            self.draft.items[i].values for i in chosen
        ]
        self.kept(new, [*range(below), *[None] * len(chosen), *range(below, count)])

    def paste(self) -> None:
        """Pieces of one file go into another."""
        other = Draft(FILES[self.draw(st.sampled_from(sorted(FILES)))])
        chosen = self.draw(st.lists(st.integers(0, len(other.items) - 1), unique=True, max_size=2))
        at = self.index(1)
        new = self.draft.paste(at, other.copy(chosen))
        values = [one.values for one in new.items[at : at + len(chosen)]]
        assert values == [other.items[i].values for i in sorted(chosen)]
        self.kept(new, [*range(at), *[None] * len(chosen), *range(at, len(self.draft.items))])

    def put(self) -> None:
        if not self.draft.items:
            return
        index, key = self.index(), self.draw(KEYS)
        item = self.draft.items[index]
        if not item.values:
            return
        value = self.draw(st.none() | WORDS)
        new = self.draft.put(index, key, value)
        assert new.items[index].values == self.with_value(item.values, key, value)
        self.only_within(new, index, taken_out=value is None)

    def clamp(self) -> None:
        if not self.draft.items:
            return
        index = self.index()
        item = self.draft.items[index]
        if not item.values:
            return
        count = len(item.clamps)
        at = self.draw(st.integers(0, count))
        choice = self.draw(st.integers(0, 4))
        match choice:
            case 0:
                values = self.draw(VALUES)
                new = self.draft.insert(at, values, clamps_of(index))
                assert new.items[index].clamps[at].values == values
            case 1 if at < count:
                new = self.draft.delete([at], clamps_of(index))
                assert len(new.items[index].clamps) == count - 1
            case 2 if at < count:
                key, value = self.draw(KEYS), self.draw(WORDS)
                new = self.draft.put(at, key, value, clamps_of(index))
                assert new.items[index].clamps[at].values[key] == value
            case 3 if at < count:
                to = self.draw(st.integers(0, count - 1))
                new = self.draft.move(at, to, clamps_of(index))
                assert new.items[index].clamps[to].values == item.clamps[at].values
            case 4 if at < count:
                new = self.draft.paste(
                    at + 1, self.draft.copy([at], clamps_of(index)), clamps_of(index)
                )
                assert new.items[index].clamps[at + 1].values == item.clamps[at].values
            case _:
                return
        self.only_within(new, index, taken_out=choice == 1)

    def put_at(self) -> None:
        draft = self.draft
        location = self.draw(
            st.sampled_from(
                [
                    ("name",),
                    ("description",),
                    ("position", "latitude"),
                    ("environment", "depth"),
                    ("environment", "wind", "speed"),
                    ("environments", "winter storm", "current", "speed"),
                    ("checks", "maximum_knockdown"),
                    ("solver", "strumming", "factor"),
                ]
            )
        )
        value = self.draw(st.none() | WORDS)
        new = draft.put_at(location, value)
        assert new.value(location) == value
        if value is not None and draft.value(location) is None:
            # what is new takes lines of its own, or goes into one within brackets
            lost = Counter(draft.text.splitlines()) - Counter(new.text.splitlines())
            assert lost.total() <= 1
        self.kept(new, list(range(len(draft.items))), taken_out=value is None)

    def table(self) -> None:
        cells = st.lists(st.sampled_from(["0", "1.5", "90"]), min_size=2, max_size=2)
        old = self.draft.value(("environment", "current", "rows")) or []
        rows = [*old, *self.draw(st.lists(cells, max_size=3))]
        if rows:
            del rows[self.draw(st.integers(0, len(rows) - 1))]
        new = self.draft.put_table(("environment", "current"), ["depth m", "u m/s"], rows)
        assert new.value(("environment", "current")) == {
            "columns": ["depth m", "u m/s"],
            "rows": rows,
        }
        self.kept(new, list(range(len(self.draft.items))), taken_out=True)

    def component(self) -> None:
        values = {"kind": "sphere", "diameter": self.draw(WORDS)}
        new = self.draft.put_component(self.draw(st.sampled_from(["mine", "n° 2"])), values)
        self.kept(new, list(range(len(self.draft.items))))

    def undo(self) -> None:
        self.history.undo()

    def redo(self) -> None:
        self.history.redo()

    @staticmethod
    def with_value(values: dict[str, str], key: str, value: str | None) -> dict[str, str]:
        others = {name: one for name, one in values.items() if name != key}
        return others if value is None else {**others, key: value}

    def kept(self, new: Draft, order: list[int | None], *, taken_out: bool = False) -> None:
        """Items that stay have the text they had, and so has all that is outside of the line."""
        old = self.draft
        assert len(new.items) == len(order)
        for item, index in zip(new.items, order, strict=True):
            if index is not None:
                assert bare(item.text) == bare(old.items[index].text)
        self.consistent(new, taken_out=taken_out or len(order) < len(old.items))

    def only_within(self, new: Draft, index: int, *, taken_out: bool) -> None:
        """The texts differ within the lines of an item and nowhere else."""
        old = self.draft
        same = same_beginning(old.text, new.text)
        behind = same_beginning(old.text[::-1], new.text[::-1])
        item = old.items[index]
        lines = old.text.splitlines(keepends=True)
        start = sum(map(len, lines[: item.line - 1]))
        assert same >= start - len(item.text)
        tail = len(old.text) - start - len(item.text) - len(lines[item.line - 1])
        assert behind >= min(tail, len(old.text) - same)
        for i, other in enumerate(old.items):
            if i != index:
                assert bare(new.items[i].text) == bare(other.text)
        self.consistent(new, taken_out=taken_out)

    def consistent(self, new: Draft, *, taken_out: bool) -> None:
        """The manner of the file is kept, and so are its comments unless something went."""
        old = self.draft
        for comment in self.comments:
            assert taken_out or new.text.count(comment) >= old.text.count(comment)
        assert ("\r\n" in new.text) == ("\r\n" in old.text)
        if "\r\n" in old.text:
            assert new.text.count("\n") == new.text.count("\r\n")
        assert new.text.startswith("\ufeff") == old.text.startswith("\ufeff")
        assert new.text.endswith("\n") == old.text.endswith("\n")
        self.history.do(new, "edit")


def has_comments_in_brackets(text: str, refusal: str) -> bool:
    """Whether an edit is refused since it would lose a comment between entries in brackets."""
    found = re.fullmatch(
        r"line (\d+) of the file: .* items or comments; edit the list in the text of the file",
        refusal,
    )
    if found is None:
        return False
    inside = "\n".join(text.splitlines()[int(found[1]) - 1 :])
    opened = re.search(r"[\[{]", inside)
    return opened is not None and "#" in inside[opened.start() :]


def same_beginning(one: str, other: str) -> int:
    """How many signs two texts begin with alike."""
    pairs = zip(one, other, strict=False)
    shorter = min(len(one), len(other))
    return next((i for i, (left, right) in enumerate(pairs) if left != right), shorter)


def bare(text: str) -> str:
    """The text of an item but for the comma behind it, which depends on what comes next."""
    lines = [line.split("#")[0].rstrip().removesuffix(",") for line in text.splitlines()]
    return "\n".join([*lines, *[line.partition("#")[2] for line in text.splitlines()]])


STEPS = [
    Editor.insert,
    Editor.delete,
    Editor.move,
    Editor.duplicate,
    Editor.paste,
    Editor.put,
    Editor.put,
    Editor.clamp,
    Editor.clamp,
    Editor.put_at,
    Editor.table,
    Editor.component,
    Editor.undo,
    Editor.redo,
]


@pytest.mark.parametrize("name", FILES)
@given(data=st.data())
@settings(max_examples=25)
def test_random_edits(name: str, data: st.DataObject) -> None:
    history = History(Draft(FILES[name]))
    comments = set(re.findall(r"(?m)(?:^|\s)(#.*?)\r?$", FILES[name]))
    editor = Editor(data.draw, history, comments)
    for step in data.draw(st.lists(st.sampled_from(STEPS), min_size=1, max_size=12)):
        try:
            step(editor)
        except EditError as refusal:
            assert has_comments_in_brackets(editor.draft.text, str(refusal))
        assert not editor.draft.problems
    last = editor.draft.text
    while history.redo():
        last = editor.draft.text
    while history.undo():
        pass
    assert editor.draft.text == FILES[name]
    while history.redo():
        pass
    assert editor.draft.text == last
