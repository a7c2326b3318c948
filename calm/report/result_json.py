"""Results as JSON."""

from __future__ import annotations

import json
import math
from collections.abc import Callable
from functools import cache
from typing import Any

UNITS = {
    "length": "m",
    "force": "N",
    "angle": "deg",
    "mass": "kg",
    "speed": "m/s",
    "time": "s",
}
"""The units of every JSON document."""


def to_json(documents: list[dict[str, Any]]) -> str:
    """Return JSON text: one document as an object, several as an array in the order given.

    Results, which name the `calm` that made them, say their units. A number that is not finite
    becomes null, since JSON has none. The text is plain ASCII, so that no terminal or pipe can
    spoil it.
    """
    told = [{**each, "units": UNITS} if "calm" in each else each for each in documents]
    content = told[0] if len(told) == 1 else told
    return _indented(content, "\n") + "\n"


def _indented(value: Any, line: str) -> str:
    """Return what `json.dumps` writes with an indent of two; `line` is what begins a line at this
    depth.

    Its encoder is fast only without an indent: so it writes all that has no further level in it.
    """
    if not isinstance(value, _NESTED) or not value:
        return _encoder(",")(_finite(value))
    below = line + "  "
    members = [*value.values()] if isinstance(value, dict) else value
    if not any(isinstance(member, _NESTED) for member in members):
        finite = [*map(_finite, members)]
        flat = dict(zip(value, finite, strict=True)) if isinstance(value, dict) else finite
        text = _encoder("," + below)(flat)
        return text[0] + below + text[1:-1] + line + text[-1]
    texts = [_indented(member, below) for member in members]
    if isinstance(value, dict):
        named = (f"{json.dumps(name)}: {text}" for name, text in zip(value, texts, strict=True))
        return "{" + below + f",{below}".join(named) + line + "}"
    return "[" + below + f",{below}".join(texts) + line + "]"


@cache
def _encoder(between: str) -> Callable[[Any], str]:
    return json.JSONEncoder(separators=(between, ": "), allow_nan=False).encode


def _finite(value: Any) -> Any:
    """Return None in place of a number that is not finite."""
    return None if isinstance(value, float) and not math.isfinite(value) else value


_NESTED = (dict, list, tuple)


def members(value: object, *names: str) -> dict[str, Any]:
    """Return what a document tells of an object: some of its attributes by their names."""
    return {name: getattr(value, name) for name in names}
