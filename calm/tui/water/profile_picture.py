"""The profile of the current, beside the form of the water."""

from __future__ import annotations

from typing import TYPE_CHECKING

from rich.text import Text
from textual.geometry import Size
from textual.strip import Strip
from textual.widget import Widget

if TYPE_CHECKING:
    from calm.tui.live import View

_LEAST = (20, 6)


class ProfilePicture(Widget):
    """Speed and direction over depth, of the environment that the line was judged in."""

    DEFAULT_CSS = """
    ProfilePicture { height: 1fr; }
    ProfilePicture.-old { text-style: dim; }
    """

    def __init__(self) -> None:
        super().__init__()
        self._view: View | None = None
        self._drawn: Size | None = None  # the size that the rows are for
        self._rows: list[Text] = []

    def show(self, view: View | None, *, old: bool = False) -> None:
        """Draw another one, dimmed where it is `old`; one that cannot be read dims the last."""
        if view is not None and view.file is not None:
            self._view, self._drawn = view, None
            self.refresh()
        else:
            old = True
        self.set_class(old, "-old")

    def render_line(self, y: int) -> Strip:
        """A row of the screen."""
        size = self.size
        if self._drawn != size:
            self._drawn = size
            self._rows = self._draw(size.width, size.height)
        if y >= len(self._rows):
            return Strip.blank(size.width, self.rich_style)
        strip = Strip(self._rows[y].render(self.app.console)).apply_style(self.rich_style)
        return strip.adjust_cell_length(size.width, self.rich_style)

    def _draw(self, width: int, height: int) -> list[Text]:
        if width < _LEAST[0] or height < _LEAST[1] or self._view is None or self._view.file is None:
            return []
        from calm.assemble import assemble_water
        from calm.drawing.sketch import current_profile

        if self._view.file.environment.depth is None:
            return [Text("No depth is given: the water is deep.", style="dim")]
        return current_profile(assemble_water(self._view.file.environment), width, height)
