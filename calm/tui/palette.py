"""Command palette, in which actions of the main screen are found by name."""

from collections.abc import Awaitable, Callable
from functools import partial

from textual.command import CommandList, CommandPalette, DiscoveryHit, Hit, Hits, Provider

from calm.tui.builder import BuilderScreen
from calm.tui.key_table import ACTIONS, Action, shown_key
from calm.tui.line_pane import LinePane


class Commands(CommandPalette):
    """Command palette of Textual, adapted to terminals of any height."""

    def check_action(self, action: str, parameters: tuple[object, ...]) -> bool | None:
        # page keys need a visible line of the list
        is_page = action == "command_list" and str(parameters[0]).startswith("page")
        return not is_page or self.query_one(CommandList).size.height > 0


class Actions(Provider):
    """Provider of the actions of the main screen for the palette."""

    @property
    def _offered(self) -> list[Action]:
        if not isinstance(self.screen, BuilderScreen):
            return []
        return [each for each in (*ACTIONS["line"], *ACTIONS["anywhere"]) if each.palette]

    async def discover(self) -> Hits:
        for action in self._offered:
            yield DiscoveryHit(_shown(action), self._run(action), help=action.meaning)

    async def search(self, query: str) -> Hits:
        matcher = self.matcher(query)
        for action in self._offered:
            score = max(matcher.match(action.title), 0.8 * matcher.match(action.meaning))
            if score > 0:
                title = matcher.highlight(_shown(action))
                yield Hit(score, title, self._run(action), help=action.meaning)

    def _run(self, action: Action) -> Callable[[], Awaitable[bool]]:
        name = action.name.removeprefix("screen.")
        is_of_line = action.place == "line" and name == action.name
        owner = self.screen.query_one(LinePane) if is_of_line else self.screen
        return partial(self.app.run_action, name, owner)


def _shown(action: Action) -> str:
    return f"{action.title}  ({shown_key(action.keys.split(',')[0])})"
