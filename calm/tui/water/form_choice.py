"""The form in which something is given: another one takes the place of what was written."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

from textual import events, on
from textual.binding import BindingType
from textual.message import Message

from calm.tui.actions import bindings
from calm.tui.cycle import Cycle

_TAKE_IT = "Enter takes it"


class FormChoice(Cycle):
    """A name and a form; the arrows show other ones, Enter takes what is shown.

    When it is left without, it shows the form there is again.
    """

    BINDINGS: ClassVar[list[BindingType]] = [*bindings("given")]

    @dataclass
    class Taken(Message):
        """Another form is wanted."""

        choice: FormChoice
        form: str

    def __init__(self, title: str, forms: tuple[str, ...], *, id: str | None = None) -> None:
        super().__init__(title, forms, forms[0], id=id)
        self._given = forms[0]

    def show(self, word: str) -> None:
        """Show the form there is."""
        self._given = word
        super().show(word)

    def action_turn(self, by: int) -> None:
        """Show the next form."""
        here = self.words.index(self.word)
        super().show(self.words[(here + by) % len(self.words)])

    def action_take(self) -> None:
        """Choose the form shown, and go on."""
        if self.word != self._given:
            self.post_message(self.Taken(self, self.word))
        else:
            self.screen.focus_next()

    @on(events.Click)
    def _press(self, event: events.Click) -> None:
        """The mouse goes on, or takes the form by a press on the words that say so."""
        event.prevent_default()
        if self.word != self._given and event.x >= self.render().cell_len - len(_TAKE_IT):
            self.action_take()
        else:
            self.action_turn(1)

    def on_blur(self) -> None:
        """What was not taken is not there."""
        self.show(self._given)

    @property
    def hint(self) -> str:
        """How the form that is shown is taken, where it is another one."""
        return _TAKE_IT if self.word != self._given else super().hint
