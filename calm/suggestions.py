"""Words of messages: what was written, what is allowed, and the nearest right thing."""

from __future__ import annotations

import difflib
from collections.abc import Iterable
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from calm.units import QuantityError

LONGEST_TEXT = 60


def unknown(what: str, text: str, known: Iterable[str]) -> str:
    """Say that `what` does not exist, and what does: the nearest, or all when they are few."""
    names = list(known)
    near = nearest(text, names)
    if near:
        return f"{what}; did you mean `{near}`?"
    if len(names) <= 12:
        return f"{what}; allowed: {', '.join(sorted(names)) or 'none'}"
    return what


def not_among(name: str, text: str, allowed: Iterable[str], offer: str | None = None) -> str:
    """Say that a value is not allowed; offer what is like it, else `offer`."""
    choices = list(allowed)
    meant = nearest(text, choices) or offer
    message = f"`{name}: {text}` must be one of {', '.join(choices)}"
    return f"{message}; did you mean `{name}: {meant}`?" if meant else message


def nearest(text: str, known: Iterable[str]) -> str | None:
    """The name most like a text, None when none is like it."""
    found = difflib.get_close_matches(text[:LONGEST_TEXT], list(known), 1)
    return found[0] if found else None


def shown(value: object) -> str:
    """An offending value as messages show it."""
    text = value if isinstance(value, str) else "…" if isinstance(value, (dict, list)) else ""
    text = " ".join(text.split())
    return text if len(text) <= LONGEST_TEXT else text[: LONGEST_TEXT - 1] + "…"


def about_quantity(name: str, value: object, error: QuantityError) -> str:
    """The message of a quantity gone wrong, with the line corrected where that is known."""
    text = f"`{name}: {shown(value)}`" if shown(value) else f"`{name}`"
    message = f"{text} {error.complaint}"
    if error.suggestion:
        message += f"; did you mean `{name}: {shown(error.suggestion)}`?"
    return message
