"""A form of all figures that the design check does not know: asked for, and written in the file."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any, ClassVar

from textual import on
from textual.app import App, ComposeResult
from textual.binding import BindingType
from textual.containers import VerticalScroll
from textual.screen import Screen
from textual.widget import Widget
from textual.widgets import Static

from calm.tui.actions import bindings, hints
from calm.tui.bars import KeyBar, TitleBar
from calm.tui.field import Field, all_settled
from calm.tui.line.missing_figures import Missing, filled, missing_figures
from calm.tui.line.pane import LinePane

Filled = tuple[dict[tuple[str, str], str], str]
"""What was typed by component and key, and the source of it."""

_MOST_LABELS = 4
_ELSEWHERE = "part of an assembly of the catalogue: use its parts, or define it in the file (o)"


class MissingScreen(Screen[Filled | None]):
    """Gives what was filled in; None where it is left."""

    BINDINGS: ClassVar[list[BindingType]] = [*bindings("form")]
    HORIZONTAL_BREAKPOINTS = [(0, "-narrow"), (112, "-wide")]  # noqa: RUF012
    DEFAULT_CSS = """
    MissingScreen {
        & VerticalScroll { padding: 1 1 0 1; scrollbar-size-vertical: 1; }
        & .component { margin-top: 1; text-style: bold; }
        & .elsewhere { color: $text-muted; }
        & Field > .field-title { width: 20; }
        & #source { margin-top: 1; }
    }
    """

    def __init__(self, missing: Sequence[Missing]) -> None:
        super().__init__()
        self._missing = tuple(missing)
        self._asked: dict[Field, tuple[str, str]] = {}

    def compose(self) -> ComposeResult:
        """Title; each component with what is not known of it; keys."""
        yield TitleBar()
        with VerticalScroll(can_focus=False):
            for each in self._missing:
                yield from self._component(each)
            note = "source of the figures: data sheet, test certificate …"
            yield Field("source", "source", id="source", note=note)
        yield KeyBar()

    def _component(self, missing: Missing) -> Iterator[Widget]:
        labels = ", ".join(list(missing.labels)[:_MOST_LABELS])
        more = len(missing.labels) - _MOST_LABELS
        labels += f" and {more} more" if more > 0 else ""
        called = missing.use if labels == missing.use else f"{missing.use}: {labels}"
        yield Static(called, classes="component", markup=False)
        if not missing.fields:
            yield Static(_ELSEWHERE, classes="elsewhere", markup=False)
            return
        for field in missing.fields:
            title = field.key.replace("_", " ")
            asked = Field(field.key, title, field.check, note=field.takes)
            self._asked[asked] = (missing.use, field.key)
            yield asked

    def on_mount(self) -> None:
        """Type at once."""
        count = len(self._missing)
        what = f"Figures missing of {count} component{'s' * (count != 1)}; any may stay empty"
        self.query_one(TitleBar).show(what, "")
        self.query_one(KeyBar).show_keys(hints("form"))
        self.query(Field).first().focus_input()

    @on(Field.Entered)
    def _onward(self, event: Field.Entered) -> None:
        if event.field.id == "source":
            self.action_accept()
        else:
            self.focus_next()

    def action_accept(self) -> None:
        """Give what was filled in, if all of it is good."""
        if not all_settled(self.query(Field)):
            return
        texts = {asked: field.text for field, asked in self._asked.items() if field.text}
        self.dismiss((texts, self.query_one("#source", Field).text))

    def action_cancel(self) -> None:
        """Give nothing."""
        self.dismiss(None)


class Filling:
    """Asks for all that is missing, and writes what was given."""

    def __init__(self, app: App[Any], line: LinePane) -> None:
        self._app, self._line, self._workspace = app, line, line.workspace

    def ask(self) -> None:
        """Show the form, once the line is judged."""
        workspace, session = self._workspace, self._workspace.session
        if not self._line.settle():
            return
        if workspace.view is None or not workspace.is_fresh:
            workspace.tell("Missing figures are known once the line is judged")
            return
        missing = missing_figures(workspace.view, session.draft)
        if not missing:
            workspace.tell("No figure of a component is missing")
            return

        def take(given: Filled | None) -> None:
            if given is not None and given[0]:
                count = len(given[0])
                self._line.attempt(
                    lambda: session.do(filled(session.draft, missing, *given), "fill in figures"),
                    f"{count} figure{'s' * (count != 1)} filled in",
                )

        self._app.push_screen(MissingScreen(missing), take)
