"""Text editor for the file, with a list of mistakes."""

import re

from textual import on
from textual.app import ComposeResult
from textual.containers import VerticalScroll
from textual.content import Content
from textual.widgets import Static, TextArea

from calm.errors import Problem
from calm.files.editing.changes import retyped
from calm.tui import dialogs, forms, key_table, screen
from calm.tui.workspace import Workspace, is_elsewhere, mistakes, problem_text

_INDENT = 2
_LINE_BREAK = re.compile(r"\r\n?|\n")


class YamlArea(TextArea):
    """Text editor that inserts blanks instead of tabs, as YAML requires."""

    BINDINGS = key_table.bindings("area")

    def action_indent(self) -> None:
        _, column = self.cursor_location
        self.insert(" " * (_INDENT - column % _INDENT))

    def action_end(self, direction: int) -> None:
        self.move_cursor(self.document.end if direction > 0 else (0, 0))

    def undo(self) -> None:
        super().undo()
        self._wrap()

    def redo(self) -> None:
        super().redo()
        self._wrap()

    def _wrap(self) -> None:
        # Textual wraps deleted lines if a step begins with a line break
        self.wrapped_document.wrap(self.wrap_width, self.indent_width)
        self.refresh()


class TextScreen(screen.DraftScreen):
    """Screen with the text of the file; the text is checked after each pause in typing.

    Unchanged lines keep their line breaks.
    """

    BINDINGS = key_table.bindings("text")

    DEFAULT_CSS = """
    TextScreen {
        & TextArea, & TextArea:focus { height: 1fr; border: none; padding: 0; }
        & #mistakes {
            height: auto; max-height: 40%; min-height: 2; padding: 0 1;
            border-top: hkey $panel; scrollbar-size-vertical: 1;
        }
    }
    """

    def __init__(self, workspace: Workspace, line: int = 1) -> None:
        super().__init__(workspace)
        self._line, self._search_text = line, ""
        self._problems: tuple[Problem, ...] = ()
        self._next = 0
        self._begun = self.session.draft.text
        self.text_area = YamlArea(self._begun, show_line_numbers=True, compact=True)
        self._edited = False

    def parts(self) -> ComposeResult:
        yield self.text_area
        with VerticalScroll(id="mistakes", can_focus=False):
            yield Static(id="mistakes-text")

    def on_mount(self) -> None:
        self.query_one(screen.KeyBar).show_keys(key_table.hints("text"))
        self.show_view()
        self.text_area.focus()
        if self._own_problems:
            self.action_next_problem()
        else:
            row = _row(self.session.draft.text, self._line)
            self.text_area.move_cursor((row, 0), center=True)

    def show_view(self) -> None:
        """List the mistakes in the text, or the missing parts of the line."""
        view, draft = self.workspace.view, self.session.draft
        known = self.workspace.is_fresh
        self._problems = tuple(draft.problems) or (view.problems if known and view else ())
        lines = [problem_text(each, self.workspace.path) for each in self._problems]
        if not lines and known and view is not None:
            good = Content.from_markup("[$text-success]✓[/] The text is valid.")
            lines = [Content(f"? {each}") for each in view.missing] or [good]
        lines = lines or [Content("…")]
        self.query_one("#mistakes-text", Static).update(Content("\n").join(lines))
        self.show_title()

    def titles(self) -> tuple[str, str]:
        return f"The text of {self.workspace.called}", mistakes(self._problems, self.workspace.path)

    @property
    def _own_problems(self) -> list[Problem]:
        return [each for each in self._problems if not is_elsewhere(each, self.workspace.path)]

    @on(TextArea.Changed)
    def _take(self) -> None:
        text = self._typed
        if text != self.session.draft.text:
            self.session.write(text, further=self._edited)
            self._edited = self.session.draft.text != self._begun
            self._next = 0
            self.workspace.edited()

    def settle(self) -> bool:
        self._take()
        return True

    @property
    def is_typing(self) -> bool:
        """Whether the displayed text differs from the draft."""
        return self._typed != self.session.draft.text

    @property
    def _typed(self) -> str:
        return retyped(self._begun, self.text_area.document.lines)

    def show_draft(self) -> None:
        """Load the draft again, without moving the cursor to another line."""
        area, text = self.text_area, self.session.draft.text
        self._begun, self._edited, self._next = text, False, 0
        row, column = area.cursor_location
        with self.prevent(TextArea.Changed):
            area.load_text(text)
        area.move_cursor((min(row, area.document.line_count - 1), column))
        self.show_view()

    def find(self, words: str = "") -> None:
        """Select the next match after the cursor, continuing at the top; case is ignored.

        Without words, the last search is repeated.
        """
        self._search_text = words or self._search_text
        if not self._search_text:
            self.workspace.tell("Press Ctrl+F to enter search words")
            return
        area, search_text = self.text_area, self._search_text.lower()
        lines, (row, column) = area.document.lines, area.selection.end
        for number in range(len(lines) + 1):
            here = (row + number) % len(lines)
            start = lines[here].lower().find(search_text, 0 if number else column)
            if start >= 0:
                area.move_cursor((here, start), center=True)
                area.move_cursor((here, start + len(search_text)), select=True)
                return
        self.workspace.tell(f"{self._search_text}: not found", wrong=True)

    def action_next_problem(self) -> None:
        if self._problems and not self._own_problems:
            self.workspace.tell(f"{self.session.name} itself has no mistakes")
        placed = [each for each in self._own_problems if each.line]
        if placed:
            problem = placed[self._next % len(placed)]
            self._next += 1
            row = _row(self.session.draft.text, problem.line)
            last = self.text_area.document.line_count - 1
            self.text_area.move_cursor((min(row, last), max(problem.column - 1, 0)))

    def action_find(self) -> None:
        fields = [forms.FormField("words", "Find", placeholder="a label, a key, a number")]
        text, app = "F3 goes to the next match.", self.app
        dialogs.enter(app, "Find in the text", text, fields, lambda it: self.find(it["words"]))

    def action_find_next(self) -> None:
        self.find()

    def action_back(self) -> None:
        if self.session.draft.problems:
            self.tell("Correct the text first: it is not valid", wrong=True)
        else:
            self.dismiss()


def _row(text: str, line: int) -> int:
    """Convert a line number of the file to a row of the editor.

    The numbers may differ, because the editor breaks lines at more characters.
    """
    ends = [0, *(found.end() for found in _LINE_BREAK.finditer(text))]
    return len(text[: ends[min(line, len(ends)) - 1]].splitlines())
