"""The file as text, its mistakes below it: where a broken file is mended."""

from __future__ import annotations

from typing import TYPE_CHECKING, ClassVar

from textual import on
from textual.app import ComposeResult
from textual.binding import Binding, BindingType
from textual.containers import VerticalScroll
from textual.screen import Screen
from textual.widgets import Static, TextArea

from calm.errors import Problem
from calm.tui.actions import bindings, hints
from calm.tui.bars import KeyBar, TitleBar
from calm.tui.messages import Edited
from calm.tui.session import Session

if TYPE_CHECKING:
    from calm.tui.live import View

_INDENT = 2


class YamlArea(TextArea):
    """Text whose tabs are blanks, as YAML wants them."""

    BINDINGS: ClassVar[list[BindingType]] = [Binding("tab", "indent", show=False)]

    def action_indent(self) -> None:
        """Blanks up to the next column that is even."""
        _, column = self.cursor_location
        self.insert(" " * (_INDENT - column % _INDENT))


class TextScreen(Screen[None]):
    """The text, judged at each pause."""

    BINDINGS: ClassVar[list[BindingType]] = [*bindings("text")]
    DEFAULT_CSS = """
    TextScreen {
        & TextArea, & TextArea:focus { height: 1fr; border: none; padding: 0; }
        & #mistakes {
            height: auto; max-height: 40%; min-height: 2; padding: 0 1;
            border-top: hkey $panel; scrollbar-size-vertical: 1;
        }
    }
    """

    def __init__(self, session: Session, view: View | None) -> None:
        super().__init__()
        self.session = session
        self._problems: tuple[Problem, ...] = ()
        self._view = view
        self._next = 0
        self._begun = session.draft.text
        self._edited = False

    def compose(self) -> ComposeResult:
        """Title, text, mistakes, keys."""
        yield TitleBar()
        yield YamlArea(self.session.draft.text, show_line_numbers=True, compact=True)
        with VerticalScroll(id="mistakes", can_focus=False):
            yield Static(id="mistakes-text")
        yield KeyBar()

    def on_mount(self) -> None:
        """The cursor to the first mistake."""
        self.query_one(KeyBar).show_keys(hints("text"))
        self._show()
        self.text_area.focus()
        if self._problems:
            self.action_next_problem()

    @property
    def text_area(self) -> TextArea:
        """Where one writes."""
        return self.query_one(TextArea)

    def show_view(self, view: View) -> None:
        """List the mistakes that a worker has found."""
        self._view = view
        if self.is_mounted:
            self._show()

    def _show(self) -> None:
        view, draft = self._view, self.session.draft
        known = view is not None and view.text == draft.text
        self._problems = tuple(draft.problems) or (view.problems if known and view else ())
        if self._problems:
            lines = [f"[b $text-error]![/] {_said(each)}" for each in self._problems]
        elif known and view is not None and view.missing:
            lines = [f"? {each}" for each in view.missing]
        else:
            lines = ["[$text-success]✓[/] The text can be read." if known else "…"]
        self.query_one("#mistakes-text", Static).update("\n".join(lines))
        count = len(self._problems)
        right = f"{count} mistake{'s' * (count != 1)}" if count else ""
        unsaved = " (not saved)" if self.session.changed else ""
        self.query_one(TitleBar).show(f"The text of {self.session.name}{unsaved}", right)

    @on(TextArea.Changed)
    def _take(self) -> None:
        text = self.text_area.text
        if text != self.session.draft.text:
            self.session.write(text, further=self._edited)
            self._edited = self.session.draft.text != self._begun
            self._next = 0
            self._show()
            self.post_message(Edited())

    def action_next_problem(self) -> None:
        """Put the cursor on the next mistake."""
        placed = [each for each in self._problems if each.line]
        if placed:
            problem = placed[self._next % len(placed)]
            self._next += 1
            last = self.text_area.document.line_count - 1
            self.text_area.move_cursor((min(problem.line - 1, last), max(problem.column - 1, 0)))

    async def action_save(self) -> None:
        """Save the text as it stands."""
        await self.app.run_action("save")

    def action_help(self) -> None:
        """All keys."""
        from calm.tui.help_screen import HelpScreen

        self.app.push_screen(HelpScreen())

    def action_back(self) -> None:
        """To the line, if the text has one."""
        if self.session.draft.problems:
            bar = self.query_one(KeyBar)
            bar.tell("The line cannot be shown before the text can be read", wrong=True)
        else:
            self.dismiss()

    def tell(self, text: str, *, wrong: bool = False) -> None:
        """Say something in the last line."""
        self.query_one(KeyBar).tell(text, wrong=wrong)


def _said(problem: Problem) -> str:
    from rich.markup import escape

    place = f"line {problem.line}:{problem.column}  " if problem.line else ""
    return escape(place + problem.message)
