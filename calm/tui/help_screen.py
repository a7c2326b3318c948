"""Every key, by where it works."""

from __future__ import annotations

from collections.abc import Awaitable, Callable, Iterable, Iterator
from functools import partial

from rich.console import Group, RenderableType
from rich.table import Table
from rich.text import Text
from textual.binding import Binding, BindingType
from textual.command import CommandList, CommandPalette, DiscoveryHit, Hit, Hits, Provider
from textual.containers import ScrollableContainer
from textual.screen import Screen
from textual.widgets import Input, TextArea

from calm.tui.key_table import ACTIONS, Action, Place, actions_in, shown_key, shown_keys
from calm.tui.theme import LOOKS

_SIGNS = "Signs: " + ", ".join(f"{look.sign} {look.word}" for look in LOOKS.values())
_GROUND = (
    "Every change is solved and judged at once; until then the figures of the line before are "
    "dimmed. A number without a unit takes the unit shown. With the mouse: press a cell to go "
    "there, press it again to edit."
)
_OF_TEXTUAL: dict[str, Iterable[BindingType]] = {
    "On every screen, with Ctrl+P and Ctrl+Q": Screen.BINDINGS,
    "While a value is typed": Input.BINDINGS,
    "While the text is typed, as well": TextArea.BINDINGS,
    "Pictures, verdict and whatever is longer than the screen": ScrollableContainer.BINDINGS,
}
"""Keys that CALM leaves to the widgets it is made of; their meanings come from them."""


def all_keys() -> RenderableType:
    """Every key, by where it works."""
    parts: list[RenderableType] = [Text("Keys", style="bold"), Text(_GROUND), Text(_SIGNS)]
    for place, title in PLACES.items():
        rows = [(action.keys, action.meaning) for action in actions_in(place)]
        parts += _section(title, rows)
    for title, inherited in _OF_TEXTUAL.items():
        parts += _section(title, _told(inherited))
    return Group(*parts)


def _told(inherited: Iterable[BindingType]) -> Iterator[tuple[str, str]]:
    for binding in inherited:
        if isinstance(binding, Binding):
            yield binding.key, f"{binding.description.capitalize()}."


def _section(title: str, rows: Iterable[tuple[str, str]]) -> list[RenderableType]:
    table = Table.grid(padding=(0, 2, 0, 0))
    table.add_column(width=20, overflow="fold")
    table.add_column(overflow="fold")
    for keys, meaning in rows:
        table.add_row(Text(shown_keys(keys), style="bold"), Text(meaning))
    return [Text(f"\n{title}", style="bold underline"), table]


_PLACES = ("line", "anywhere")

PLACES: dict[Place, str] = {
    "line": "The line",
    "anywhere": "Anywhere on the first screen",
    "verdict": "The verdict, line by line",
    "cell": "While a value is edited in place",
    "catalogue": "The catalogue",
    "water": "The water",
    "grid": "A table of the water",
    "choice": "One of some words between arrows",
    "given": "The form in which density or current is given",
    "text": "The file as text",
    "area": "While the text is typed",
    "form": "A component of your own",
    "sheet": "Some values asked for together",
    "question": "A question, answered by the letter in front of each answer",
    "help": "This help",
}
"""The headings of the help, in its order."""


class Commands(CommandPalette):
    """The palette of textual, in terminals of any height."""

    def check_action(self, action: str, parameters: tuple[object, ...]) -> bool | None:
        """A list without a line on the screen has no pages."""
        is_page = action == "command_list" and str(parameters[0]).startswith("page")
        return not is_page or self.query_one(CommandList).size.height > 0


class Actions(Provider):
    """The actions of the first screen."""

    @property
    def _offered(self) -> list[Action]:
        from calm.tui.line.builder import BuilderScreen

        if not isinstance(self.screen, BuilderScreen):
            return []
        return [each for each in ACTIONS if each.palette and each.place in _PLACES]

    async def discover(self) -> Hits:
        """All of them, before a word is typed."""
        for action in self._offered:
            yield DiscoveryHit(_shown(action), self._run(action), help=action.meaning)

    async def search(self, query: str) -> Hits:
        """Return those whose name or meaning is like the words."""
        matcher = self.matcher(query)
        for action in self._offered:
            score = max(matcher.match(action.title), 0.8 * matcher.match(action.meaning))
            if score > 0:
                title = matcher.highlight(_shown(action))
                yield Hit(score, title, self._run(action), help=action.meaning)

    def _run(self, action: Action) -> Callable[[], Awaitable[bool]]:
        from calm.tui.line.line_pane import LinePane

        owner = self.screen.query_one(LinePane) if action.place == "line" else self.screen
        return partial(self.app.run_action, action.name, owner)


def _shown(action: Action) -> str:
    return f"{action.title}  ({shown_key(action.keys.split(',')[0])})"
