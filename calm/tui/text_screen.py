"""The file as text, its mistakes below it: where a broken file is mended."""

import re

from textual import on
from textual.app import ComposeResult
from textual.containers import VerticalScroll
from textual.content import Content
from textual.widgets import Static, TextArea

from calm.errors import Problem
from calm.files.editing.changes import retyped
from calm.tui import dialogs, forms, key_table, screen
from calm.tui.workspace import Workspace, is_elsewhere, mistakes, said

_INDENT = 2
_LINE_BREAK = re.compile(r"\r\n?|\n")


class YamlArea(TextArea):
    """Text whose tabs are blanks, as YAML wants them."""

    BINDINGS = key_table.bindings("area")

    def action_indent(self) -> None:
        """Blanks up to the next column that is even."""
        _, column = self.cursor_location
        self.insert(" " * (_INDENT - column % _INDENT))

    def action_end(self, way: int) -> None:
        """To the beginning or the end of the text."""
        self.move_cursor(self.document.end if way > 0 else (0, 0))

    def undo(self) -> None:
        """Take back what was typed last."""
        super().undo()
        self._wrap()

    def redo(self) -> None:
        """Type it again."""
        super().redo()
        self._wrap()

    def _wrap(self) -> None:
        # textual wraps lines that are gone where a step began with a line break
        self.wrapped_document.wrap(self.wrap_width, self.indent_width)
        self.refresh()


class TextScreen(screen.DraftScreen):
    """The text of the file, judged at each pause.

    Lines that are not touched keep their line breaks.
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
        self._line, self._sought = line, ""
        self._problems: tuple[Problem, ...] = ()
        self._next = 0
        self._begun = self.session.draft.text
        self.text_area = YamlArea(self._begun, show_line_numbers=True, compact=True)
        self._edited = False

    def parts(self) -> ComposeResult:
        """Text and mistakes."""
        yield self.text_area
        with VerticalScroll(id="mistakes", can_focus=False):
            yield Static(id="mistakes-text")

    def on_mount(self) -> None:
        """The cursor to the first mistake, or to the piece that it was on."""
        self.query_one(screen.KeyBar).show_keys(key_table.hints("text"))
        self.show_view()
        self.text_area.focus()
        if self._here:
            self.action_next_problem()
        else:
            row = _row(self.session.draft.text, self._line)
            self.text_area.move_cursor((row, 0), center=True)

    def show_view(self) -> None:
        """List the mistakes that a worker has found."""
        view, draft = self.workspace.view, self.session.draft
        known = self.workspace.is_fresh
        self._problems = tuple(draft.problems) or (view.problems if known and view else ())
        lines = [said(each, self.workspace.path) for each in self._problems]
        if not lines and known and view is not None:
            good = Content.from_markup("[$text-success]✓[/] The text can be read.")
            lines = [Content(f"? {each}") for each in view.missing] or [good]
        lines = lines or [Content("…")]
        self.query_one("#mistakes-text", Static).update(Content("\n").join(lines))
        self.show_title()

    def titles(self) -> tuple[str, str]:
        """Return what is shown, and how many mistakes it has."""
        return f"The text of {self.workspace.called}", mistakes(self._problems, self.workspace.path)

    @property
    def _here(self) -> list[Problem]:
        """The mistakes in this text, not in a file that it names."""
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
        """Take the text as it stands."""
        self._take()
        return True

    @property
    def is_typing(self) -> bool:
        """Return whether the text that is shown is not in the draft yet."""
        return self._typed != self.session.draft.text

    @property
    def _typed(self) -> str:
        return retyped(self._begun, self.text_area.document.lines)

    def show_draft(self) -> None:
        """Show the draft anew, the cursor on the line where it was."""
        area, text = self.text_area, self.session.draft.text
        self._begun, self._edited, self._next = text, False, 0
        row, column = area.cursor_location
        with self.prevent(TextArea.Changed):
            area.load_text(text)
        area.move_cursor((min(row, area.document.line_count - 1), column))
        self.show_view()

    def find(self, words: str = "") -> None:
        """Select where words are next, from the cursor on and then from the top; case is ignored.

        Without any, those that were sought last.
        """
        self._sought = words or self._sought
        if not self._sought:
            self.workspace.tell("Press Ctrl+F to type what to find")
            return
        area, sought = self.text_area, self._sought.lower()
        lines, (row, column) = area.document.lines, area.selection.end
        for number in range(len(lines) + 1):
            here = (row + number) % len(lines)
            start = lines[here].lower().find(sought, 0 if number else column)
            if start >= 0:
                area.move_cursor((here, start), center=True)
                area.move_cursor((here, start + len(sought)), select=True)
                return
        self.workspace.tell(f"{self._sought}: not in the text", wrong=True)

    def action_next_problem(self) -> None:
        """Put the cursor on the next mistake."""
        if self._problems and not self._here:
            self.workspace.tell(f"There are no mistakes in {self.session.name} itself")
        placed = [each for each in self._here if each.line]
        if placed:
            problem = placed[self._next % len(placed)]
            self._next += 1
            row = _row(self.session.draft.text, problem.line)
            last = self.text_area.document.line_count - 1
            self.text_area.move_cursor((min(row, last), max(problem.column - 1, 0)))

    def action_find(self) -> None:
        """Ask for words, and go to them."""
        asked = [forms.Asked("words", "Find", placeholder="a label, a key, a number")]
        text, app = "F3 goes to the next place.", self.app
        dialogs.enter(app, "Find in the text", text, asked, lambda it: self.find(it["words"]))

    def action_find_next(self) -> None:
        """To the next place of what was sought."""
        self.find()

    def action_back(self) -> None:
        """To the line, if the text has one."""
        if self.session.draft.problems:
            self.tell("The line cannot be shown before the text can be read", wrong=True)
        else:
            self.dismiss()


def _row(text: str, line: int) -> int:
    """Return where the editor, which knows more line breaks, has a line of the file."""
    ends = [0, *(found.end() for found in _LINE_BREAK.finditer(text))]
    return len(text[: ends[min(line, len(ends)) - 1]].splitlines())
