"""What every screen of the line builder that shows the draft can be asked for."""

from __future__ import annotations

from typing import TYPE_CHECKING

from textual.screen import Screen

from calm.tui.bars import KeyBar

if TYPE_CHECKING:
    from collections.abc import Callable

    from calm.tui.live import View
    from calm.tui.session import Session


class DraftScreen(Screen[None]):
    """A screen that shows the draft, and where it may be changed.

    The application settles the screen on top before it saves or leaves, and has every one of
    them read the draft again when that was replaced from outside.

    Attributes
    ----------
    session : the file that is shown
    """

    session: Session

    def is_fresh(self, view: View | None) -> bool:
        """Whether a view is of what is edited: the text, the file's place and the environment.

        The figures of any other are shown dimmed.
        """
        session = self.session
        return view is not None and view.is_of(
            session.draft.text, session.file.path, session.environment
        )

    def settle(self) -> bool:
        """Take over what is being typed: the draft holds it when this returns True.

        False where the value is bad: it stays to be corrected, and the screen has told why.
        """
        raise NotImplementedError

    @property
    def is_typing(self) -> bool:
        """Whether a field holds something that is not in the draft yet."""
        raise NotImplementedError

    def replaced(self) -> None:
        """Read the draft again, another one having taken its place.

        An open cell editor closes without taking its value over, and marks are taken off. The
        draft may be one that cannot be read: the application then opens the text view.
        """
        raise NotImplementedError

    def show_view(self, view: View) -> None:
        """Show what a worker made of the draft."""
        raise NotImplementedError

    def tell(self, text: str, *, wrong: bool = False) -> None:
        """Say something in the last line, until the next key."""
        self.query_one(KeyBar).tell(text, wrong=wrong)

    @property
    def called(self) -> str:
        """The name of the file, and that it is not saved where it is not."""
        return self.session.name + (" (not saved)" if self.session.changed else "")

    @property
    def environments(self) -> list[str | None]:
        """The environments of the file; None is its own, the first."""
        return self.session.environments

    def next_environment(self) -> str | None:
        """The environment after the one that is shown, the own one after the last."""
        names, here = self.environments, self.session.environment
        return names[(names.index(here) + 1) % len(names)] if here in names else None

    def action_undo(self) -> None:
        """Take the last change back, once what is typed is taken."""
        self._go("undone", self.session.history.undo)

    def action_redo(self) -> None:
        """Make it again."""
        self._go("done again", self.session.history.redo)

    def _go(self, what: str, step: Callable[[], str | None]) -> None:
        if not self.settle():
            return
        label = step()
        if label is None:
            self.tell(f"Nothing is left to be {what}")
        else:
            self.changed(told=f"{what}: {label}")

    def changed(self, *, told: str = "") -> None:
        """Show the draft anew, and have it judged: it is another one now."""
        raise NotImplementedError

    async def action_save(self) -> None:
        """Save the file."""
        await self.app.run_action("save")

    def action_help(self) -> None:
        """All keys."""
        from calm.tui.help_screen import HelpScreen

        self.app.push_screen(HelpScreen())
