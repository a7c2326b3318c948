"""The first line of the screen, file and verdict, and the last, the keys that work now."""

from __future__ import annotations

from collections.abc import Iterable

from rich.cells import cell_len
from rich.text import Text
from textual.content import Content
from textual.style import Style
from textual.widget import Widget
from textual.widgets import Static

from calm.tui.actions import shown_key
from calm.tui.key_table import Action

_GAP = "  "


class TitleBar(Widget):
    """Name and file at the left, environment and verdict at the right."""

    DEFAULT_CSS = """
    TitleBar { height: 1; background: $panel; color: $foreground; padding: 0 1; text-style: bold; }
    """

    def __init__(self) -> None:
        super().__init__()
        self._said = "", "", False

    def show(self, left: str, right: str, *, old: bool = False) -> None:
        """Say something else; the right end is dimmed where it is of an `old` state of the line."""
        if (left, right, old) != self._said:
            self._said = left, right, old
            self.refresh()

    def render(self) -> Text:
        """Both ends; the left one is cut where there is no room."""
        width = self.content_size.width
        said, verdict, old = self._said
        right = Text(verdict, style="dim" if old else "", no_wrap=True)
        right.truncate(max(width * 2 // 3, 1), overflow="ellipsis")
        left = Text(said, no_wrap=True)
        left.truncate(max(width - cell_len(right.plain) - 1, 0), overflow="ellipsis", pad=True)
        return Text(" ").join([left, right])


class KeyBar(Static):
    """The keys that matter now; what was just done takes their place until the next key."""

    DEFAULT_CSS = """
    KeyBar {
        height: 1; background: $panel; color: $text-muted; padding: 0 1;
        link-style: none; link-color: $text-muted; link-color-hover: $foreground;
        link-background-hover: $primary-muted; link-style-hover: bold;
    }
    KeyBar.-wrong { color: $text-error; }
    KeyBar.-told { color: $foreground; }
    """

    def __init__(self) -> None:
        super().__init__()
        self._actions: list[Action] = []
        self._told = ""

    def show_keys(self, actions: Iterable[Action]) -> None:
        """Show other keys."""
        chosen = list(actions)
        if chosen != self._actions:
            self._actions = chosen
            self._show()

    def tell(self, text: str, *, wrong: bool = False) -> None:
        """Show a message; an empty one shows the keys again."""
        if (text, wrong) == (self._told, self.has_class("-wrong")):
            return
        self._told = text
        self.set_class(bool(text) and wrong, "-wrong")
        self.set_class(bool(text) and not wrong, "-told")
        self._show()

    def on_resize(self) -> None:
        """As many keys as there is room for."""
        self._show()

    def _show(self) -> None:
        width = self.content_size.width or 78
        if self._told:
            text = Text(self._told)
            text.truncate(width, overflow="ellipsis")
            self.update(text, layout=False)
            return
        parts, used = [], 0
        for action in self._actions:
            key = shown_key(action.keys.split(",")[0])
            wide = cell_len(f"{key} {action.title}")
            if used + wide <= width:
                used += wide + len(_GAP)
                parts.append(_pressed(action, key))
        self.update(Content(_GAP).join(parts), layout=False)


def _pressed(action: Action, key: str) -> Content:
    """A key and what it does, which the mouse presses too."""
    pressed = action.keys.split(",")[0]
    press = Style.from_meta({"@click": f"app.simulate_key({pressed!r})"})
    return Content.assemble((key, press + Style(bold=True)), (f" {action.title}", press))
