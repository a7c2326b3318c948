"""Pictures of the line (elevation, plan, tension, schematic) and of the current profile."""

from __future__ import annotations

from collections.abc import Sequence
from textwrap import wrap
from typing import TYPE_CHECKING, Literal

from rich.text import Text
from textual import events, on
from textual.app import ComposeResult
from textual.containers import ScrollableContainer, Vertical
from textual.geometry import Size
from textual.reactive import reactive
from textual.widgets import Static

from calm.tui import scrolled, theme

if TYPE_CHECKING:
    from calm.case import Result
    from calm.case.result_tables import Shape
    from calm.tui.live import View

Tab = Literal["elevation", "plan", "tension", "schematic"]
TABS: tuple[Tab, ...] = ("elevation", "plan", "tension", "schematic")

_LEAST = (20, 6)
_MIN_WIDTH_FOR_CURRENT = 52
_CURRENT_SHARE, _MAX_CURRENT_WIDTH = 3, 26


class Picture(scrolled.DrawnRows, can_focus=True):
    """A picture of the line, drawn to fit the widget."""

    DEFAULT_CSS = """
    Picture { height: 1fr; width: 1fr; background: $background; scrollbar-size: 1 1;
              overflow-x: auto; padding: 0 1; }
    Picture:focus { background-tint: $foreground 3%; }
    """

    BINDINGS = ScrollableContainer.BINDINGS

    def __init__(self) -> None:
        super().__init__()
        self.tab: Tab = "elevation"
        self._view: View | None = None
        self._overlays: Sequence[Shape] = ()

    def show(self, view: View | None, tab: Tab, overlays: Sequence[Shape] = ()) -> None:
        """Draw the line of a view, and other lines (`overlays`) for comparison."""
        if tab != self.tab:
            self.scroll_to(0, 0, animate=False)
        self._view, self.tab, self._overlays = view, tab, overlays
        self.draw_again()

    def rows_for(self, size: Size) -> list[scrolled.Row]:
        """Draw the picture for a given size; a schematic larger than this size can be scrolled."""
        rows = self._picture(size)
        widest = max((row.cell_len for row in rows), default=0)
        self.virtual_size = Size(widest, len(rows)) if self.tab == "schematic" else Size(0, 0)
        return [[*row.render(self.app.console)] for row in rows]

    def _picture(self, size: Size) -> list[Text]:
        result = None if self._view is None else self._view.result
        if _is_small(size):
            return [Text("(window too small)", style="dim")]
        if result is None:
            waits = "A picture appears once the line has an equilibrium."
            words = waits if self._view else theme.ELLIPSIS
            return [Text(""), *(Text(line, style="dim") for line in wrap(words, size.width))]
        from calm.drawing.schematic.in_terminal import schematic_text
        from calm.drawing.sketch import plan, tension

        if self.tab == "plan":
            return plan(result, *size, self._overlays)
        lines = result.legs
        if self.tab == "tension":
            rows = size.height // len(lines)
            if rows < _LEAST[1]:
                return [Text("(window too small to show the tension of each leg)", style="dim")]
            return [row for line in lines for row in tension(line, size.width, rows)]
        if self.tab == "schematic":
            texts = [schematic_text(line.file, line, size.width) for line in lines]
            return [Text(row) for text in texts for row in text.splitlines()]
        return self._elevation(result, size)

    def _elevation(self, result: Result, size: Size) -> list[Text]:
        from calm.drawing.sketch import current_profile, elevation

        if size.width < _MIN_WIDTH_FOR_CURRENT or result.file.environment.depth is None:
            return elevation(result, *size, self._overlays)
        current_width = min(size.width // _CURRENT_SHARE, _MAX_CURRENT_WIDTH)
        line = elevation(result, size.width - current_width - 1, size.height, self._overlays)
        profile = current_profile(result.water, current_width, size.height)
        rows = []
        for left, right in zip(line, profile, strict=True):
            left.truncate(size.width - current_width, pad=True)
            rows.append(left.append_text(right))
        return rows


def _is_small(size: Size) -> bool:
    return size.width < _LEAST[0] or size.height < _LEAST[1]


class Pictures(Vertical):
    """Tabs with pictures, dimmed if they show an earlier state of the line."""

    DEFAULT_CSS = """
    Pictures { height: 1fr; width: 1fr; }
    Pictures.-old Picture { text-style: dim; }
    Pictures > #tabs {
        height: 1; color: $text-muted; link-style: none; link-color: $text-muted;
        link-color-hover: $foreground; link-background-hover: $primary-muted;
        link-style-hover: bold;
    }
    Pictures > #beside { height: 1; padding: 0 1; color: $text-muted; display: none; }
    """

    tab: reactive[Tab] = reactive("elevation", init=False)

    def __init__(self, *, id: str | None = None) -> None:
        super().__init__(id=id)
        self._view: View | None = None
        self._note = ""
        self._saved: Shape | None = None
        self._tabs, self._picture = Static(id="tabs"), Picture()
        self._caption = Static("dashed: the saved line", id="beside", markup=False)

    def compose(self) -> ComposeResult:
        yield self._tabs
        yield self._caption
        yield self._picture

    def on_mount(self) -> None:
        self._show()

    def show(self, view: View | None, note: str = "") -> None:
        """Draw the line of a view, with a note."""
        self._view, self._note = view, note
        self._show()

    def overlay(self, saved: Shape | None) -> None:
        """Draw the saved line for comparison, or remove it if `saved` is None."""
        self._saved = saved
        self._show()

    def watch_tab(self) -> None:
        self._show()

    def _show(self) -> None:
        saved = () if self._saved is None else (self._saved,)
        self._show_tabs()
        self._caption.display = bool(saved) and self.tab in ("elevation", "plan")
        self._picture.show(self._view, self.tab, saved)

    @on(events.DescendantFocus)
    @on(events.DescendantBlur)
    def _show_tabs(self) -> None:
        parts = [theme.CURSOR if self._picture.has_focus else " "]
        for number, tab in enumerate(TABS, 1):
            style = ("[reverse bold]", "[/]") if tab == self.tab else ("", "")
            parts.append(f"[@click=screen.picture('{tab}')]{style[0]} {number} {tab} {style[1]}[/]")
        parts.append(f"  [italic]{self._note}[/]" if self._note else "")
        self._tabs.update("".join(parts), layout=False)

    def on_click(self, event: events.Click) -> None:
        self._picture.focus()


class ProfilePicture(scrolled.DrawnRows):
    """Picture of current speed and direction against depth, in the selected environment."""

    DEFAULT_CSS = """
    ProfilePicture { height: 1fr; overflow: hidden; }
    ProfilePicture.-old { text-style: dim; }
    """

    _view: View | None = None

    def show(self, view: View | None, *, old: bool = False) -> None:
        """Draw the current profile of a view, dimmed if `old`.

        If the file cannot be read, the last profile remains and is dimmed.
        """
        if view is not None and view.file is not None:
            self._view = view
            self.draw_again()
        else:
            old = True
        self.set_class(old, "-old")

    def rows_for(self, size: Size) -> list[scrolled.Row]:
        """Draw the current profile.

        Return [] if the widget is too small or if there is no environment.
        """
        file = None if self._view is None else self._view.file
        if _is_small(size) or file is None:
            return []
        from calm.assemble import assemble_water
        from calm.drawing.sketch import current_profile

        if file.environment.depth is None:
            rows = [Text("The depth is not set: deep water is assumed.", style="dim")]
        else:
            rows = current_profile(assemble_water(file.environment), *size)
        return [[*row.render(self.app.console)] for row in rows]
