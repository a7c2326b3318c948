"""The items of a line as they stand in a file, and pieces of text that hold such items."""

from __future__ import annotations

import re
from dataclasses import dataclass

from calm.files.composition import Node, compose
from calm.files.editing.splicing import Items, Slot, line_start
from calm.files.editing.writing import Value, Wording, WritingStyle, inline

_LINE_BREAK = re.compile(r"\r\n|\n")


@dataclass(frozen=True)
class LineItem:
    """Represent an item of a line, or a clamp of one.

    Attributes
    ----------
    line, column : int
        Where it stands, counted from 1: those of the pieces that it is read as.
    values : dict
        Its keys with plain values, as written; empty text where there is no value. A `length_at`
        is in it as people say it, `480 m at 2 kN`.
    clamps : tuple of Item
    text : str
        The lines it takes, with the comments that belong to it.
    """

    line: int
    column: int
    values: dict[str, str]
    clamps: tuple[LineItem, ...]
    text: str


def item_of(node: Node, text: str, *, lines: str = "") -> LineItem:
    """Return the item that a node of a text is.

    Parameters
    ----------
    node : of the item
    text : it stands in
    lines : its text, where it takes more than the node
    """
    entries = list(zip(node.keys, node.children, strict=False))
    values = {key.data: child.data or "" for key, child in entries if child.kind == "scalar"}
    clamps = [child for key, child in entries if key.data == "clamps" and child.kind == "sequence"]
    measured = next((child.data for key, child in entries if key.data == "length_at"), None)
    if isinstance(measured, dict):
        values["length_at"] = f"{measured.get('length', '?')} at {measured.get('load', '?')}"
    return LineItem(
        line=node.line,
        column=node.column,
        values=values,
        clamps=tuple(item_of(clamp, text) for found in clamps for clamp in found.children),
        text=lines or text[node.start : node.end],
    )


def new_slot(value: Value, items: Items, style: WritingStyle, *, block: bool) -> Slot:
    """Write a new item for a list, after its form.

    Parameters
    ----------
    value : of the item
    items : those of the list
    style : of the file
    block : write a key a line where that can be
    """
    if items.form == "block":
        return Slot(style.item(value, items.column, block=block))
    if items.form == "rows":
        return Slot(" " * (items.column - 1) + inline(value), style.line_break)
    return Slot(inline(value))


def worded_slot(wording: Wording, items: Items, style: WritingStyle) -> Slot:
    """Place an item as it is worded; within brackets in one line it loses its comments.

    Parameters
    ----------
    wording : of the item
    items : those of the list
    style : of the file
    """
    if items.form == "block":
        return Slot(style.moved(wording.lines, items.column))
    if items.form == "rows":
        above = style.moved(wording.above, items.column)
        behind = wording.behind.replace("\n", style.line_break)
        return Slot(above + " " * (items.column - 1) + wording.inline, behind)
    return Slot(wording.inline)


def snippet_of(slot: Slot, node: Node, items: Items) -> str:
    """Return the text of an item by itself, as an item of a block list that begins in column 1.

    Parameters
    ----------
    slot : of the item
    node : of the item
    items : those of its list
    """
    if items.form == "inline":
        return _LINE_BREAK.sub("\n", f"- {slot.value}\n")
    text = slot.text
    if items.form == "rows":
        own = len(slot.value) - (node.end - node.start)
        comments = slot.value[:own].rstrip(" \t")
        text = comments + " " * (items.column - 1) + "- " + slot.value[own:] + slot.behind
    indent = re.compile(rf"^[ ]{{1,{items.column - 1}}}" if items.column > 1 else "(?!)", re.M)
    return indent.sub("", _LINE_BREAK.sub("\n", text))


def read_snippet(snippet: str) -> Wording | None:
    """Return the item that a text as that of `snippet_of` is; None where it is none."""
    composition = compose(snippet)
    root = composition.root
    if root is None or composition.refusals or (root.kind, root.style) != ("sequence", "block"):
        return None
    if len(root.children) != 1 or root.column != 1:
        return None
    item = root.children[0]
    text = snippet[item.start : item.end]
    above = snippet[: line_start(snippet, root.start)]
    if item.style == "flow" and "\n" not in text:
        return Wording(item.data, snippet, above, text, snippet[item.end :])
    return Wording(item.data, snippet, above, inline(item.data), "\n")
