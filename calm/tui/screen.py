"""Base class of the screens that display and edit the draft, with title bar and key bar."""

from collections.abc import Callable, Iterable

from rich.cells import cell_len
from rich.text import Text
from textual.app import ComposeResult
from textual.content import Content
from textual.screen import Screen
from textual.style import Style
from textual.widget import Widget
from textual.widgets import Static

from calm.tui.key_table import Action, shown_key
from calm.tui.workspace import Workspace


class DraftScreen(Screen[None]):
    """Screen that displays and edits the draft of a workspace.

    The application calls `settle` on the top screen before saving or quitting, and `replaced` on
    all screens after another text has replaced the draft.
    """

    def __init__(self, workspace: Workspace) -> None:
        super().__init__()
        self.workspace, self.session = workspace, workspace.session

    def compose(self) -> ComposeResult:
        for at_least, of_width in sorted(self.HORIZONTAL_BREAKPOINTS or (), reverse=True):
            if self.app.size.width >= at_least:
                # setting the class after the mount would style every widget again
                self.set_class(True, of_width, update=False)
                break
        yield TitleBar()
        yield from self.parts()
        yield KeyBar()

    def on_mount(self) -> None:
        self.show_title()

    # implemented by subclasses

    def parts(self) -> ComposeResult:
        """Yield the widgets between title bar and key bar."""
        raise NotImplementedError

    @property
    def is_typing(self) -> bool:
        """Whether the user has typed text that is not in the draft yet."""
        raise NotImplementedError

    def settle(self) -> bool:
        """Write typed text to the draft; return whether the text is valid.

        An invalid text stays in its field, with a message.
        """
        raise NotImplementedError

    def show_draft(self) -> None:
        """Show the draft again, for example after undo or redo."""
        raise NotImplementedError

    def replaced(self) -> None:
        """Show the text that has replaced the draft; typed text and marks are discarded.

        If the new draft cannot be parsed, the application opens the text editor.
        """
        self.show_draft()

    def show_view(self) -> None:
        """Show the results that a worker has computed from the draft."""
        raise NotImplementedError

    def titles(self) -> tuple[str, str]:
        """Return the texts at the left and the right end of the title bar."""
        raise NotImplementedError

    # shared by all screens

    def show_title(self) -> None:
        """Update the title bar; a verdict on an earlier draft is dimmed."""
        self.query_one(TitleBar).show(*self.titles(), old=not self.workspace.is_fresh)

    def tell(self, text: str, *, wrong: bool = False) -> None:
        """Show a message in the last line until the next key."""
        self.query_one(KeyBar).tell(text, wrong=wrong)

    def action_undo(self) -> None:
        self._go("undone", self.session.history.undo)

    def action_redo(self) -> None:
        self._go("redone", self.session.history.redo)

    def _go(self, what: str, step: Callable[[], str | None]) -> None:
        if not self.settle():
            return
        label = step()
        if label is None:
            self.tell(f"No changes left to be {what}")
        else:
            self.show_draft()
            self.tell(f"{what}: {label}")
            self.workspace.edited()


_GAP = "  "


class TitleBar(Widget):
    """Title bar with a text at the left, such as the file name, and the verdict at the right."""

    DEFAULT_CSS = """
    TitleBar { height: 1; background: $panel; color: $foreground; padding: 0 1; text-style: bold; }
    """

    def __init__(self) -> None:
        super().__init__()
        self._texts = "", "", False

    def show(self, left: str, right: str, *, old: bool = False) -> None:
        """Replace the left and the right text; `old` dims the right text."""
        if (left, right, old) != self._texts:
            self._texts = left, right, old
            self.refresh()

    def render(self) -> Text:
        width = self.content_size.width
        text, verdict, old = self._texts
        right = Text(verdict, style="dim" if old else "", no_wrap=True)
        right.truncate(max(width * 2 // 3, 1), overflow="ellipsis")
        left = Text(text, no_wrap=True)
        left.truncate(max(width - cell_len(right.plain) - 1, 0), overflow="ellipsis", pad=True)
        return Text(" ").join([left, right])


class KeyBar(Static):
    """Bar with the keys of the focused widget, or with a message until the next key."""

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
        self._message = ""
        self._beside_message = False

    def show_keys(self, actions: Iterable[Action], *, beside_message: bool = False) -> None:
        """Show the keys of the given actions.

        With `beside_message`, the keys remain next to a message, unless the message is an error.
        """
        if ((chosen := list(actions)), beside_message) != (self._actions, self._beside_message):
            self._actions, self._beside_message = chosen, beside_message
            self._show()

    def tell(self, text: str, *, wrong: bool = False) -> None:
        """Show a message; an empty message shows the keys again."""
        if (text, wrong) == (self._message, self.has_class("-wrong")):
            return
        self._message = text
        self.set_class(bool(text) and wrong, "-wrong")
        self.set_class(bool(text) and not wrong, "-told")
        self._show()

    def on_resize(self) -> None:
        self._show()

    def _show(self) -> None:
        width = self.content_size.width or 78
        keys = Content(_GAP).join(self._keys(width))
        if self._message:
            beside_message = self._beside_message and not self.has_class("-wrong")
            room = max(width - keys.cell_length - len(_GAP), 0) if beside_message else width
            text = Text(self._message)
            text.truncate(room, overflow="ellipsis")
            message = Content(text.plain)
            keys = Content.assemble(keys, _GAP, message) if beside_message else message
        self.update(keys, layout=False)

    def _keys(self, width: int) -> list[Content]:
        parts, used = [], 0
        for action in self._actions:
            pressed = action.keys.split(",")[0]
            press = Style.from_meta({"@click": f"app.simulate_key({pressed!r})"})
            key, title = shown_key(pressed), f" {action.title}"
            if used + cell_len(key + title) <= width:
                used += cell_len(key + title) + len(_GAP)
                parts.append(Content.assemble((key, press + Style(bold=True)), (title, press)))
        return parts
