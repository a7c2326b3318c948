"""Bindings, hints and names of keys, from the table of all actions."""

from __future__ import annotations

from collections.abc import Iterator

from textual.binding import Binding

from calm.tui.key_table import ACTIONS, Action, Place

_SIGNS = {
    "up": "↑",
    "down": "↓",
    "left": "←",
    "right": "→",
    "enter": "Enter",
    "escape": "Esc",
    "delete": "Del",
    "insert": "Ins",
    "space": "Space",
    "tab": "Tab",
    "home": "Home",
    "end": "End",
    "pageup": "PgUp",
    "pagedown": "PgDn",
    "question_mark": "?",
    "slash": "/",
    "plus": "+",
    "minus": "-",
    "equals_sign": "=",
    "asterisk": "*",
    "colon": ":",
}


def shown_key(key: str) -> str:
    """A key as it is written on a keyboard: ``ctrl+s`` → ``Ctrl+S``, ``question_mark`` → ``?``."""
    *held, last = key.split("+")
    if len(last) == 1:
        last = last.upper() if held else last
    else:
        last = _SIGNS.get(last, last.capitalize())
    return "+".join([*(part.capitalize() for part in held), last])


def shown_keys(keys: str) -> str:
    """Keys separated by commas as people read them."""
    return "  ".join(map(shown_key, keys.split(",")))


def actions_in(place: Place) -> Iterator[Action]:
    """The actions of one place, in order."""
    return (action for action in ACTIONS if action.place == place)


def bindings(place: Place, target: str = "") -> list[Binding]:
    """The keys of a place for a widget or screen.

    Parameters
    ----------
    target : the textual namespace that has the methods, such as ``screen.``; empty for its own
    """
    return [
        Binding(
            action.keys,
            action.name if action.name.startswith("app.") else target + action.name,
            action.title,
            show=False,
        )
        for action in actions_in(place)
    ]


def hints(place: Place) -> list[Action]:
    """The actions shown while a place has the focus, the most used first."""
    own = [action for action in actions_in(place) if action.hint is not None]
    if place == "line":
        own += [action for action in actions_in("anywhere") if action.hint is not None]
    return sorted(own, key=lambda action: action.hint or 0)
