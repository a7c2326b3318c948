"""What a text says, and what it is to say after an edit."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any
from unicodedata import category

from calm.files.document import Location
from calm.files.editing.layout import Value
from calm.files.nodes import Node


def child_of(node: Node, step: str | int) -> Node | None:
    """What stands below a node under a key or number."""
    if node.kind == "mapping":
        named = zip(node.keys, node.children, strict=True)
        return next((child for key, child in named if key.data == step), None)
    if node.kind == "sequence" and isinstance(step, int) and 0 <= step < len(node.children):
        return node.children[step]
    return None


def nested(location: Location, value: Value) -> dict[str, Value]:
    """Mappings that lead to a value."""
    for step in reversed(location):
        value = {str(step): value}
    assert isinstance(value, dict)
    return value


def data_of(value: Value) -> Any:
    """What is read again of a value."""
    if value is None or isinstance(value, str):
        return value
    if isinstance(value, Mapping):
        return {key: data_of(one) for key, one in value.items()}
    return [data_of(one) for one in value]


def with_value(data: Any, location: Location, value: Value) -> Any:
    """Data with another value at a location; mappings that lead to it are made."""
    if not location:
        return data_of(value)
    step, below = location[0], location[1:]
    if isinstance(data, list) and isinstance(step, int):
        return [with_value(one, below, value) if i == step else one for i, one in enumerate(data)]
    base = data if isinstance(data, dict) else {}
    return {**base, step: with_value(base.get(step), below, value)}


def without(data: Any, location: Location) -> Any:
    """Data without a key."""
    step, below = location[0], location[1:]
    if isinstance(data, list):
        return [without(one, below) if i == step else one for i, one in enumerate(data)]
    if below:
        return {**data, step: without(data[step], below)}
    return {key: one for key, one in data.items() if key != step}


def has_control(data: Any) -> bool:
    """Whether a text of some data has signs that only control how the others are shown."""
    if isinstance(data, str):
        return any(category(sign) in ("Cc", "Cf") for sign in data if sign not in "\t\n\r")
    parts = [*data, *data.values()] if isinstance(data, dict) else data or ()
    return any(map(has_control, parts))


def cells_that_differ(
    old: Any, new: Sequence[Sequence[str | None]]
) -> list[tuple[int, int, str]] | None:
    """Row, column and text of each value in which tables of the same shape differ.

    None where they have not the same shape, or a value goes without another in its place.
    """
    if _shape(old) != _shape(new):
        return None
    cells = [
        (i, j, text)
        for i, (before, row) in enumerate(zip(old, new, strict=True))
        for j, (value, text) in enumerate(zip(before, row, strict=True))
        if value != text
    ]
    texts = [(i, j, text) for i, j, text in cells if text is not None]
    return texts if len(texts) == len(cells) else None


def _shape(rows: Any) -> list[int]:
    """How many values each row has, -1 where it is no row."""
    if not isinstance(rows, list | tuple):
        return []
    return [len(row) if isinstance(row, list | tuple) else -1 for row in rows]
