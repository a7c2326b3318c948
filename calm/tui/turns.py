"""One key after the other: what a key opens is there before the next one is pressed.

Keys that are typed ahead, or come in one parcel over a slow line, would otherwise go to what has
the focus when they arrive: to the line instead of the field that the first of them opens.
"""

from __future__ import annotations

from collections import deque
from dataclasses import dataclass
from time import monotonic
from typing import TYPE_CHECKING, Any

from textual import events, on
from textual.app import App
from textual.message import Message
from textual.message_pump import MessagePump

if TYPE_CHECKING:
    from textual.timer import Timer

_LOOK = 0.05  # seconds between two looks whether what a key went to is still there
_PATIENCE = 5.0  # seconds after which a key is taken as done whatever it started


@dataclass
class Passed(Message):
    """Follows a key through everything that might handle it, and comes to the application last.

    What a key does may be told from widget to widget before it is done: as many `rounds` are made.
    """

    rounds: int = 4


class InTurn(App[int]):
    """An application that handles its keys one after the other."""

    def __init__(self, *arguments: Any, **options: Any) -> None:
        super().__init__(*arguments, **options)
        self._waiting: deque[events.Key] = deque()
        self._is_pressed = False
        self._pressed_at = 0.0
        self._target: MessagePump = self
        self._looking: Timer | None = None

    @property
    def has_keys_waiting(self) -> bool:
        """Whether a key is not handled yet."""
        return self._is_pressed

    async def on_event(self, event: events.Event) -> None:
        """Let keys wait for those before them."""
        if isinstance(event, events.Key) and not event.is_forwarded:
            self._waiting.append(event)
            if not self._is_pressed:
                await self._press()
        else:
            await super().on_event(event)

    async def _press(self) -> None:
        """Press the key that has waited longest."""
        self._is_pressed = bool(self._waiting)
        if self._is_pressed:
            self._target, self._pressed_at = self.focused or self.screen, monotonic()
            await super().on_event(self._waiting.popleft())
            self._target.post_message(Passed())
            if self._looking is None:
                self._looking = self.set_interval(_LOOK, self._look)

    def _look(self) -> None:
        """Go on where the key has closed what it went to, which then lets nothing pass."""
        gone = not self._target.is_attached or monotonic() - self._pressed_at > _PATIENCE
        if self._is_pressed and gone:
            self._go_on()

    @on(Passed)
    def _follow(self, passed: Passed) -> None:
        if passed.rounds and self._target.is_attached:
            self._target.post_message(Passed(passed.rounds - 1))
        else:
            self._go_on()

    def _go_on(self) -> None:
        if self._looking is not None:
            self._looking.stop()
            self._looking = None
        if self._waiting:
            self.call_after_refresh(self._press)
        else:
            self._is_pressed = False
