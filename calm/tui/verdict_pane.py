"""Pane with the verdict, whose lines link to the rows concerned."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import TYPE_CHECKING

from rich.segment import Segment
from rich.style import Style
from rich.table import Table
from rich.text import Text
from textual import events
from textual.geometry import Size
from textual.strip import Strip

from calm.checks.finding import State
from calm.tui import key_table, scrolled, theme
from calm.tui.verdict_text import VerdictLine, headline, verdict_lines

if TYPE_CHECKING:
    from rich.console import RenderableType

    from calm.tui.live import View

_CHOSEN = Style(reverse=True)


class VerdictPane(scrolled.ScrolledText, can_focus=True):
    """Pane that shows the verdict, values at the anchor and the top, and findings with reasons.

    `go_to` is called with the rows and text of a chosen line, or with () to go back.
    """

    BINDINGS = key_table.bindings("verdict")
    DEFAULT_CSS = """
    VerdictPane {
        height: auto; max-height: 60%; min-height: 5; width: 1fr; padding: 0 1; margin-top: 1;
        background: $background;
    }
    VerdictPane:focus { background-tint: $foreground 3%; }
    VerdictPane.-old { text-style: dim; }
    """

    def __init__(self, go_to: Callable[..., object]) -> None:
        super().__init__(id="verdict-pane")
        self._go_to = go_to
        self._lines: list[VerdictLine] = []
        self._chosen = 0

    def say(self, view: View | None, note: str = "") -> None:
        """Show the verdict of a view, followed by a note."""
        parts = [*_rendered_lines(view, note)]
        self._lines, self._texts = [each for each, _ in parts], [text for _, text in parts]
        self._chosen = min(self._chosen, len(self._lines) - 1)
        before = len(self._numbers)
        self.draw_again()
        self.drawn()
        if len(self._numbers) != before:
            self.refresh(layout=True)

    def get_content_height(self, container: Size, viewport: Size, width: int) -> int:
        size, rows = self._drawn
        return len(rows if size and size.width == width else self._wrapped(width))

    def render_line(self, y: int) -> Strip:
        strip, at = super().render_line(y), y + self.scroll_offset.y
        if self.has_focus and self._numbers[at : at + 1] == [self._chosen]:
            return Strip(Segment(text, style and style + _CHOSEN) for text, style, _ in strip)
        return strip

    def on_focus(self) -> None:
        if not self._is_choosable(self._chosen):
            self.action_move(1)

    def action_move(self, by: int) -> None:
        number = self._chosen + by
        while 0 <= number < len(self._lines) and not self._is_choosable(number):
            number += by
        if self._is_choosable(number):
            self._chosen = number
            self._follow()
            self.refresh()
        else:
            self.scroll_relative(y=by, animate=False)

    def action_go(self) -> None:
        if self._is_choosable(self._chosen):
            line = self._lines[self._chosen]
            text = f"{line.sign} {line.heading}: ".replace(" : ", " ") + line.text
            self._go_to(line.places, text)

    def action_leave(self) -> None:
        self._go_to(())

    def on_click(self, event: events.Click) -> None:
        place = event.get_content_offset(self)
        at = len(self._numbers) if place is None else place.y + self.scroll_offset.y
        if at < len(self._numbers) and self._is_choosable(self._numbers[at]):
            self._chosen = self._numbers[at]
            self.action_go()

    def _is_choosable(self, number: int) -> bool:
        return 0 <= number < len(self._lines) and bool(self._lines[number].places)

    def _follow(self) -> None:
        own = [at for at, number in enumerate(self._numbers) if number == self._chosen]
        top, height = self.scroll_offset.y, max(self.scrollable_content_region.height, 1)
        if own and not top <= own[0] <= own[-1] < top + height:
            self.scroll_to(y=min(own[0], max(own[-1] - height + 1, 0)), animate=False)


def _rendered_lines(view: View | None, note: str) -> Iterator[tuple[VerdictLine, RenderableType]]:
    head = headline(view)
    style = "dim" if head.state is None else theme.LOOKS[head.state]
    yield head, Text(f"{head.sign} {head.text}", style=f"{style} bold")
    for line in verdict_lines(view):
        table = Table.grid(padding=(0, 1, 0, 0), expand=True)
        table.add_column(width=1)
        table.add_column(overflow="fold", ratio=1)
        look = theme.LOOKS[line.state] if line.state else ""
        grave = line.state in (State.FAIL, State.WARN)
        heading = (f"{line.heading}  " if line.heading else "", look if grave else "dim")
        text = Text.assemble(heading, (line.text, "dim" if line.faint else ""))
        table.add_row(Text(line.sign, "" if line.pending else look), text)
        yield line, table
    if note:
        yield VerdictLine(note), Text(note, style="dim italic")


def state_word(view: View | None, *, old: bool = False) -> str:
    """Return the symbol and headline of the verdict; the symbol of an `old` view is an ellipsis."""
    sign = theme.ELLIPSIS if old else headline(view).sign.strip()
    return f"{sign} {headline(view).text}".strip()
