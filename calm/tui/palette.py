"""The command palette: every action by its name."""

from __future__ import annotations

from collections.abc import Awaitable, Callable
from functools import partial

from textual.command import DiscoveryHit, Hit, Hits, Provider

from calm.tui.actions import shown_key
from calm.tui.keys.action import Action
from calm.tui.keys.table import ACTIONS

_PLACES = ("line", "anywhere")


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
        """Those whose name or meaning is like the words."""
        matcher = self.matcher(query)
        for action in self._offered:
            score = max(matcher.match(action.title), 0.8 * matcher.match(action.meaning))
            if score > 0:
                title = matcher.highlight(_shown(action))
                yield Hit(score, title, self._run(action), help=action.meaning)

    def _run(self, action: Action) -> Callable[[], Awaitable[bool]]:
        from calm.tui.line.pane import LinePane

        owner = self.screen.query_one(LinePane) if action.place == "line" else self.screen
        return partial(self.app.run_action, action.name, owner)


def _shown(action: Action) -> str:
    return f"{action.title}  ({shown_key(action.keys.split(',')[0])})"
