"""Dialogs over the screen: questions, input sheets and long texts."""

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
from calm.tui.forms import FormField
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
    """Open a screen on top of other screens.

    `take` is called with the result of the screen, unless the screen is cancelled.
    """

    def taken(given: T | None) -> None:
        if given is not None:
            take(given)

    app.push_screen(screen, taken)


def choose(app: App[Any], question: Question) -> None:
    """Show a question, and run the action of the chosen answer."""
    ask(app, question, lambda then: then())


def enter(
    app: App[Any],
    title: str,
    text: str,
    fields: Sequence[FormField],
    take: Callable[[dict[str, str]], object],
) -> None:
    """Request several texts on an `InputSheet`, and call `take` with the texts."""
    ask(app, InputSheet(title, text, fields), take)


@dataclass(frozen=True)
class Answer:
    """Answer to a question, with its key, text and action."""

    key: str
    title: str
    then: Then | None = None


def numbered(answers: Iterable[tuple[str, Then]]) -> list[Answer]:
    """Create answers from pairs of title and action, with keys numbered from 1."""
    return [Answer(str(number), *answer) for number, answer in enumerate(answers, 1)]


class Question(ModalScreen[Then | None]):
    """Question that is answered by key, by arrows and Enter, or by mouse.

    Esc calls `back`, unless an answer is compulsory (`must`).
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
        for answer in self._answers:
            if event.key in (answer.key, answer.key.lower()):
                event.stop()
                self.dismiss(answer.then)
                return

    def on_mount(self) -> None:
        if self._answers[0].key == "1":  # a numbered list
            self.action_move(1)

    def action_move(self, by: int) -> None:
        if self._marked is None:
            self._marked = 0 if by > 0 else len(self._answers) - 1
        else:
            self._marked = (self._marked + by) % len(self._answers)
        for number, shown in enumerate(self.query(".answer")):
            shown.set_class(number == self._marked, "-marked")

    def action_give(self) -> None:
        if self._marked is not None:
            self.action_answer_number(self._marked)

    def action_answer_number(self, number: int) -> None:
        self.dismiss(self._answers[number].then)

    def action_leave(self) -> None:
        if not self._must:
            self.dismiss(self._back)


class Form(Screen[T | None]):
    """Screen of fields that are accepted together.

    Enter moves to the next field; on the last field, Enter accepts all fields.
    """

    @property
    def fields(self) -> list[Field]:
        """All fields in order, without tables."""
        return list(self.query(Field))

    @property
    def all_parts(self) -> list[Part]:
        """All fields and tables in order."""
        found = self.query(f"{Field.__name__}, {TableField.__name__}")
        return [part for part in found if isinstance(part, Field | TableField)]

    @property
    def texts(self) -> dict[str, str]:
        """Entered texts, by key of the field."""
        return {part.key: part.text for part in self.all_parts}

    def parts_of(self, fields: Iterable[FormField]) -> Iterator[Widget]:
        """Yield widgets for fields, with a heading above each group."""
        for each in fields:
            if each.above:
                yield Static(each.above, classes="above", markup=False)
            if each.columns:
                yield Static(f"{each.title}  {each.takes}", classes="above", markup=False)
                yield TableField(each, self.tell)
            else:
                yield Field(each)

    def tell(self, text: str, *, wrong: bool = False) -> None:
        """Show a message below the fields."""
        raise NotImplementedError

    @on(Field.Entered)
    def _onward(self, event: Field.Entered) -> None:
        if event.field is self.all_parts[-1]:
            self.action_take()
        else:
            self.focus_next()

    def action_take(self) -> None:
        """Close the form with the entered values, if all values are valid."""
        raise NotImplementedError

    def action_leave(self) -> None:
        self.dismiss(None)


_BELOW = 7
"""Number of lines on a sheet that are not fields: margins, a two-line note, the keys."""
_TABLE_KEYS = "a adds a row, Enter edits a value, Del deletes the row, ↑ ↓ move"


class InputSheet(Form[dict[str, str]], ModalScreen[dict[str, str] | None]):
    """Sheet with several text fields; Esc closes the sheet and discards the texts.

    The sheet is wide if there are notes next to the fields.
    """

    BINDINGS = key_table.bindings("sheet")
    DEFAULT_CSS = (
        "InputSheet {" + _FRAME + " & Field > Input { width: 1fr; }"
        " & .above { text-style: bold; margin-top: 1; text-wrap: nowrap;"
        " text-overflow: ellipsis; } & TableField { margin-left: 2; }"
        " &.-wide > Vertical { width: 110; }"
        " & #asked { height: auto; scrollbar-size-vertical: 1; }"
        " &.-wide Field > Input { width: 24; margin-left: 22; }"
        "& #sheet-note { height: auto; min-height: 1; color: $text-muted; margin-top: 1; }"
        "& #sheet-note.-wrong { color: $text-error; } }"
    )

    def __init__(self, title: str, text: str, fields: Sequence[FormField]) -> None:
        super().__init__(classes="-wide" if any(each.takes for each in fields) else None)
        self._title, self._text, self._form_fields = title, text, fields

    def compose(self) -> ComposeResult:
        with Vertical():
            with VerticalScroll(id="asked", can_focus=False):
                yield Static(self._title, classes="title", markup=False)
                if self._text:
                    yield Static(self._text, classes="text", markup=False)
                yield from self.parts_of(self._form_fields)
            yield Static(id="sheet-note", markup=False)
            yield Static(
                "[b]Enter[/b] next field, or accept after the last   [b]Ctrl+S[/b] accept   "
                "[b]Esc[/b] cancel",
                classes="keys",
            )

    def on_mount(self) -> None:
        self.all_parts[0].input.focus()

    def on_resize(self) -> None:
        # keep the note below the fields visible
        self.query_one("#asked").styles.max_height = max(self.size.height - _BELOW, 1)

    @on(Field.Judged)
    def _judge(self, event: Field.Judged) -> None:
        self.tell(event.field.note(event.reading), wrong=not event.reading.is_good)

    @on(DescendantFocus)
    def _note(self) -> None:
        for field in self.fields:
            if field.input.has_focus:
                reading = field.reading if field.input.value else Reading("")
                self.tell(field.note(reading), wrong=not reading.is_good)
        for table in self.query(TableField):
            if table.cells.has_focus:
                reading = table.reading
                self.tell(reading.note or _TABLE_KEYS, wrong=not reading.is_good)

    def tell(self, text: str, *, wrong: bool = False) -> None:
        note = self.query_one("#sheet-note", Static)
        note.update(text)
        note.set_class(wrong, "-wrong")

    def action_take(self) -> None:
        if all_settled(self.all_parts):
            self.dismiss(self.texts)


class LongText(ModalScreen[None]):
    """Screen with a long text that scrolls; `wide` makes room for tables."""

    BINDINGS = key_table.bindings("help")
    DEFAULT_CSS = (
        "LongText {" + _FRAME + " & > VerticalScroll { width: 84; height: 90%; }"
        " &.-wide > VerticalScroll { width: 110; } }"
    )

    def __init__(self, text: RenderableType, *, wide: bool = False) -> None:
        super().__init__(classes="-wide" if wide else None)
        self._text = text

    def compose(self) -> ComposeResult:
        with VerticalScroll():
            yield Static(self._text)
