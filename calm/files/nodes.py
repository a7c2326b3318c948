"""What stands where in a YAML text: a tree of values, each with its span."""

from __future__ import annotations

from typing import Any, Literal, NamedTuple

Kind = Literal["mapping", "sequence", "scalar"]


class Node(NamedTuple):
    """A value in a text.

    Attributes
    ----------
    kind : "mapping", "sequence" or "scalar"
    start, end : int
        Its text is ``text[start:end]``; an empty value is right after its colon or dash.
    line, column : int
        Of its start, counted from 1.
    style : str
        Of a collection `block` or `flow`; of a scalar its first sign when quoted or a block.
    data : dict, list, str or None
        What it says, scalars as the text the person wrote. Shared: not to be changed.
    keys : tuple of Node
        Of a mapping, in the order of the file.
    children : tuple of Node
        The values of a mapping, or the items of a sequence.
    """

    kind: Kind
    start: int
    end: int
    line: int
    column: int
    style: str
    data: Any
    keys: tuple[Node, ...] = ()
    children: tuple[Node, ...] = ()


class Refusal(NamedTuple):
    """Something that is no YAML, or YAML that these files do not allow; places count from 1."""

    line: int
    column: int
    message: str


class Composition(NamedTuple):
    """The nodes of a text (None: it is empty, or no YAML), and what in it is not allowed."""

    root: Node | None
    refusals: tuple[Refusal, ...] = ()
