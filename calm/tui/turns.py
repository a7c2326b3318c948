"""One key after the other: what a key opens is there before the next one is pressed.

Keys that are typed ahead, or come in one parcel over a slow line, would otherwise go to what has
the focus when they arrive: to the line instead of the field that the first of them opens.

A key is done when everything that it may have set going has come to rest. Each part of the screen
handles what it is sent in the order of its queue: a call that is sent after the key comes back
when the key is handled, and a second round finds what the key made the parts send each other.
Rounds are made until one of them finds no queue with anything left in it.
"""

from __future__ import annotations

from collections import deque
from typing import Any

from textual import events
from textual.app import App
from textual.message_pump import MessagePump
from textual.widgets import OptionList

_MOST = 50
"""Rounds: what sends itself messages without an end is not waited for."""


class InTurn(App[int]):
    """An application that handles keys, pastes and the mouse one after the other.

    `has_keys_waiting` tells whether one is not handled yet.
    """

    def __init__(self, *arguments: Any, **options: Any) -> None:
        super().__init__(*arguments, **options)
        self._waiting: deque[events.Event] = deque()
        self.has_keys_waiting = False
        self._rounds = 0

    async def on_event(self, event: events.Event) -> None:
        """Let what a person does wait for what was done before, but for the mouse that moves."""
        is_done = isinstance(event, events.InputEvent | events.Paste)
        if not is_done or event.is_forwarded or isinstance(event, events.MouseMove):
            await super().on_event(event)
            return
        self._waiting.append(event)
        if not self.has_keys_waiting:
            await self._press()

    async def _press(self) -> None:
        """Do what has waited longest."""
        self.has_keys_waiting = bool(self._waiting)
        if self.has_keys_waiting:
            before = self._listeners()
            await super().on_event(self._waiting.popleft())
            self._rounds = 0
            self._go_round(before)

    def _listeners(self) -> list[MessagePump]:
        """All that a key may set going: what has the focus and what is around it, the screen.

        Not the screens below it: each message makes them have all of the screen painted anew. A
        list hands on what is chosen in it, without the focus.
        """
        around = [] if self.focused is None else list(self.focused.ancestors_with_self)
        lists = [each for top in self.screen_stack[-1:] for each in top.query(OptionList)]
        return list(dict.fromkeys([*around, *lists, *self.screen_stack[-1:], self]))

    def _go_round(self, listeners: list[MessagePump]) -> None:
        """Wait for one after the other; one that is gone handles nothing any more."""
        while listeners:
            first, *others = listeners
            if first.call_later(self._go_round, others):
                return
            listeners = others
        self._rounds += 1
        now = self._listeners()
        is_busy = any(each.message_queue_size for each in now)
        if self._rounds < 2 or (is_busy and self._rounds < _MOST):
            self._go_round(now)
        elif self._waiting:
            self.call_after_refresh(self._press)
        else:
            self.has_keys_waiting = False
