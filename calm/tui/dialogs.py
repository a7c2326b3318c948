"""Dialogs over the screen: one of some answers, some texts to enter, a text to read."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass
from typing import Any, TypeVar

from rich.console import RenderableType
from textual import on
from textual.app import App, ComposeResult
from textual.containers import Vertical, VerticalScroll
from textual.events import DescendantFocus, Key
from textual.markup import escape
from textual.screen import ModalScreen, Screen
from textual.widget import Widget
from textual.widgets import Static

from calm.tui import key_table
from calm.tui.checking import Reading
from calm.tui.field import Field, Part, all_settled
from calm.tui.forms import Asked
from calm.tui.table_field import TableField

_FRAME = """
    align: center middle;
    & > Vertical, & > VerticalScroll {
        width: 72; max-width: 100%; height: auto; max-height: 100%; padding: 1 2;
        background: $panel; border-left: outer $primary; scrollbar-size-vertical: 1;
    }
    & .title { text-style: bold; }
    & .text { color: $text-muted; margin-bottom: 1; }
    & Static { link-style: none; link-color: $foreground; link-background-hover: $primary-muted; }
    & .keys { color: $text-muted; margin-top: 1; }
"""


T = TypeVar("T")
Then = Callable[[], object]


def ask(app: App[Any], screen: Screen[T | None], take: Callable[[T], object]) -> None:
    """Put a screen over this one; what it gives is taken, and nothing where it is left."""

    def taken(given: T | None) -> None:
        if given is not None:
            take(given)

    app.push_screen(screen, taken)


def choose(app: App[Any], question: Question) -> None:
    """Ask a question, and do what the answer stands for."""
    ask(app, question, lambda then: then())


def enter(
    app: App[Any],
    title: str,
    text: str,
    asked: Sequence[Asked],
    take: Callable[[dict[str, str]], object],
) -> None:
    """Ask for some texts on an `InputSheet`, and take what is entered."""
    ask(app, InputSheet(title, text, asked), take)


@dataclass(frozen=True)
class Answer:
    """An answer: its key, its text, and what is done then."""

    key: str
    title: str
    then: Then | None = None


def numbered(answers: Iterable[tuple[str, Then]]) -> list[Answer]:
    """Titles and what is done then, their keys the numbers from 1."""
    return [Answer(str(number), *answer) for number, answer in enumerate(answers, 1)]


class Question(ModalScreen[Then | None]):
    """One of several answers, by its key, with arrows and Enter, or with the mouse.

    Esc is `back` unless one `must` be given.
    """

    BINDINGS = key_table.bindings("question")
    DEFAULT_CSS = "Question {" + _FRAME + " .answer.-marked { background: $primary-muted; } }"

    def __init__(
        self,
        title: str,
        text: str,
        answers: Sequence[Answer],
        *,
        back: Then | None = None,
        must: bool = False,
    ) -> None:
        super().__init__()
        self._title, self._text, self._answers = title, text, answers
        self._back, self._must = back, must
        self._marked: int | None = None

    def compose(self) -> ComposeResult:
        """Return what is asked, and the answers below each other."""
        with Vertical():
            yield Static(self._title, classes="title", markup=False)
            yield Static(self._text, classes="text", markup=False)
            for number, answer in enumerate(self._answers):
                yield Static(
                    f"[@click=screen.answer_number({number})][b]{answer.key}[/b]  "
                    f"{escape(answer.title)}[/]",
                    classes="answer",
                )
            if not self._must:
                yield Static("[@click=screen.leave][b]Esc[/b]  go back[/]")

    def on_key(self, event: Key) -> None:
        """The key of an answer gives it; every other key does nothing."""
        for answer in self._answers:
            if event.key in (answer.key, answer.key.lower()):
                event.stop()
                self.dismiss(answer.then)
                return

    def on_mount(self) -> None:
        """In a numbered list the first answer is marked; elsewhere none is until an arrow."""
        if self._answers[0].key == "1":
            self.action_move(1)

    def action_move(self, by: int) -> None:
        """Mark the answer above or below."""
        if self._marked is None:
            self._marked = 0 if by > 0 else len(self._answers) - 1
        else:
            self._marked = (self._marked + by) % len(self._answers)
        for number, shown in enumerate(self.query(".answer")):
            shown.set_class(number == self._marked, "-marked")

    def action_give(self) -> None:
        """Give the answer that is marked."""
        if self._marked is not None:
            self.action_answer_number(self._marked)

    def action_answer_number(self, number: int) -> None:
        """Give an answer by its number."""
        self.dismiss(self._answers[number].then)

    def action_leave(self) -> None:
        """Give none of the answers."""
        if not self._must:
            self.dismiss(self._back)


class Form(Screen[T | None]):
    """Fields that are entered together: Enter goes through them, and from the last takes all."""

    @property
    def fields(self) -> list[Field]:
        """Return them as they follow one another, without the tables."""
        return list(self.query(Field))

    @property
    def all_parts(self) -> list[Part]:
        """Return the fields and the tables as they follow one another."""
        found = self.query(f"{Field.__name__}, {TableField.__name__}")
        return [part for part in found if isinstance(part, Field | TableField)]

    @property
    def texts(self) -> dict[str, str]:
        """Return what is entered, by key."""
        return {part.key: part.text for part in self.all_parts}

    def parts_of(self, asked: Iterable[Asked]) -> Iterator[Widget]:
        """Yield what is shown for what is asked, under the names of its groups."""
        for each in asked:
            if each.above:
                yield Static(each.above, classes="above", markup=False)
            if each.columns:
                yield Static(f"{each.title}  {each.takes}", classes="above", markup=False)
                yield TableField(each, self.tell)
            else:
                yield Field(each)

    def tell(self, text: str, *, wrong: bool = False) -> None:
        """Say something below the fields."""
        raise NotImplementedError

    @on(Field.Entered)
    def _onward(self, event: Field.Entered) -> None:
        if event.field is self.all_parts[-1]:
            self.action_take()
        else:
            self.focus_next()

    def action_take(self) -> None:
        """Give what is entered, if it is good."""
        raise NotImplementedError

    def action_leave(self) -> None:
        """Give nothing."""
        self.dismiss(None)


_BELOW = 7
"""Lines of a sheet around its fields: its margins, a note of two lines, the keys."""
_TABLE_KEYS = "a adds a row, Enter edits a value, Del deletes the row, ↑ ↓ go on"


class InputSheet(Form[dict[str, str]], ModalScreen[dict[str, str] | None]):
    """Some texts, entered together; Esc leaves all as it was.

    It is wider where it is said beside them what they take.
    """

    BINDINGS = key_table.bindings("sheet")
    DEFAULT_CSS = (
        "InputSheet {" + _FRAME + " & Field > Input { width: 1fr; }"
        " & .field-note { display: none; }"
        " & .above { text-style: bold; margin-top: 1; text-wrap: nowrap;"
        " text-overflow: ellipsis; } & TableField { margin-left: 2; }"
        " &.-wide > Vertical { width: 110; }"
        " & #asked { height: auto; scrollbar-size-vertical: 1; }"
        " &.-wide .field-note { display: block; } &.-wide Field > Input { width: 24; }"
        " &.-wide .field-title { width: 22; }"
        "& #sheet-note { height: auto; min-height: 1; color: $text-muted; margin-top: 1; }"
        "& #sheet-note.-wrong { color: $text-error; } }"
    )

    def __init__(self, title: str, text: str, asked: Sequence[Asked]) -> None:
        super().__init__(classes="-wide" if any(each.takes for each in asked) else None)
        self._title, self._text, self._asked = title, text, asked

    def compose(self) -> ComposeResult:
        """Return what is asked, and where it is typed."""
        with Vertical():
            with VerticalScroll(id="asked", can_focus=False):
                yield Static(self._title, classes="title", markup=False)
                if self._text:
                    yield Static(self._text, classes="text", markup=False)
                yield from self.parts_of(self._asked)
            yield Static(id="sheet-note", markup=False)
            yield Static(
                "[b]Enter[/b] next, then done   [b]Ctrl+S[/b] done   [b]Esc[/b] go back",
                classes="keys",
            )

    def on_mount(self) -> None:
        """Type at once."""
        self.all_parts[0].input.focus()

    def on_resize(self) -> None:
        """What is said below the fields stays in sight."""
        self.query_one("#asked").styles.max_height = max(self.size.height - _BELOW, 1)

    @on(Field.Judged)
    def _judge(self, event: Field.Judged) -> None:
        self.tell(event.field.note(event.reading), wrong=not event.reading.is_good)

    @on(DescendantFocus)
    def _note(self) -> None:
        """Say what the field takes, whole."""
        for field in self.fields:
            if field.input.has_focus:
                reading = field.reading if field.input.value else Reading("")
                self.tell(field.note(reading), wrong=not reading.is_good)
        for table in self.query(TableField):
            if table.cells.has_focus:
                reading = table.reading
                self.tell(reading.note or _TABLE_KEYS, wrong=not reading.is_good)

    def tell(self, text: str, *, wrong: bool = False) -> None:
        """Say something below the fields."""
        note = self.query_one("#sheet-note", Static)
        note.update(text)
        note.set_class(wrong, "-wrong")

    def action_take(self) -> None:
        """Give the texts, if all are good."""
        if all_settled(self.all_parts):
            self.dismiss(self.texts)


class LongText(ModalScreen[None]):
    """A text over the screen, scrolled where it is longer; of tables, `wide`."""

    BINDINGS = key_table.bindings("help")
    DEFAULT_CSS = (
        "LongText {" + _FRAME + " & > VerticalScroll { width: 84; height: 90%; }"
        " &.-wide > VerticalScroll { width: 110; } }"
    )

    def __init__(self, text: RenderableType, *, wide: bool = False) -> None:
        super().__init__(classes="-wide" if wide else None)
        self._text = text

    def compose(self) -> ComposeResult:
        """The text."""
        with VerticalScroll():
            yield Static(self._text)
