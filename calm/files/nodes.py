"""What stands where in a YAML text: a tree of values, each with its span."""

from __future__ import annotations

import re
from dataclasses import dataclass, field
from typing import Any, Literal, NamedTuple

from ruamel.yaml.nodes import CollectionNode, MappingNode, ScalarNode, SequenceNode
from ruamel.yaml.nodes import Node as ComposedNode

# They would move the cursor of a terminal, or turn the figures beside them round.
_CONTROL_CHARACTER = re.compile("[\x00-\x08\x0b\x0c\x0e-\x1f\x7f-\x9f\u202a-\u202e\u2066-\u2069]")

_COLON = re.compile(r"\s*:")
_NULL = "tag:yaml.org,2002:null"
_PLAIN_TAGS = frozenset(
    f"tag:yaml.org,2002:{kind}"
    for kind in ("map", "seq", "str", "int", "float", "bool", "null", "timestamp", "merge")
)


Kind = Literal["mapping", "sequence", "scalar"]


class Node(NamedTuple):
    """A value in a text.

    Attributes
    ----------
    kind : "mapping", "sequence" or "scalar"
    start, end : int
        Its text is ``text[start:end]``; an empty value stands right behind its colon or dash.
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

    def shifted(self, offset: int, lines: int) -> Node:
        """The same further down a text."""
        return Node(
            self.kind,
            self.start + offset,
            self.end + offset,
            self.line + lines,
            self.column,
            self.style,
            self.data,
            tuple([key.shifted(offset, lines) for key in self.keys]),
            tuple([child.shifted(offset, lines) for child in self.children]),
        )


class Refusal(NamedTuple):
    """Something YAML allows and these files do not; places count from 1."""

    line: int
    column: int
    message: str


@dataclass
class NodeReader:
    """Turns what ruamel.yaml composed of a text into nodes, noting what is not allowed."""

    text: str
    refusals: list[Refusal] = field(default_factory=list)
    _anchored: set[int] = field(default_factory=set)

    def read(self, node: ComposedNode) -> Node:
        """The node, and all below it."""
        mark = node.start_mark
        place = (mark.line + 1, mark.column + 1)
        refused = Node(_kind(node), mark.index, mark.index, *place, "", None)
        if node.anchor is not None:
            # An alias composes to the very node of its anchor: reported once, never followed.
            if id(node) not in self._anchored:
                self._anchored.add(id(node))
                message = "anchors (&) and aliases (*) are not allowed; write it out"
                self.refusals.append(Refusal(*place, message))
            return refused
        if str(node.tag) not in _PLAIN_TAGS:
            self.refusals.append(Refusal(*place, f"tags (`{node.tag}`) are not allowed"))
            return refused
        if isinstance(node, MappingNode):
            return self._mapping(node)
        if isinstance(node, SequenceNode):
            children = tuple(self.read(child) for child in node.value)
            data: Any = [child.data for child in children]
            return self._collection(node, "sequence", data, (), children)
        assert isinstance(node, ScalarNode)
        end = node.end_mark.index
        if node.style in ("|", ">"):
            end = mark.index + len(self.text[mark.index : end].rstrip())
        data = None if str(node.tag) == _NULL else _shown(node.value)
        return Node("scalar", mark.index, end, *place, node.style or "", data)

    def _mapping(self, node: MappingNode) -> Node:
        keys: dict[str, Node] = {}
        children: list[Node] = []
        for key_node, value_node in node.value:
            mark = key_node.start_mark
            place = (mark.line + 1, mark.column + 1)
            if not isinstance(key_node, ScalarNode):
                self.refusals.append(Refusal(*place, "a key must be plain text"))
                continue
            name = key_node.value
            if name in keys:
                message = f"`{name}` is given twice (first in line {keys[name].line})"
                self.refusals.append(Refusal(*place, message))
                continue
            end = key_node.end_mark.index
            keys[name] = Node("scalar", mark.index, end, *place, key_node.style or "", name)
            child = self.read(value_node)
            if child.data is None and child.start == child.end:
                # ruamel.yaml puts an empty value before whatever comes next.
                colon = _COLON.match(self.text, end)
                behind = colon.end() if colon else end
                child = Node("scalar", behind, behind, *place, "", None)
            children.append(child)
        data = {name: child.data for name, child in zip(keys, children, strict=True)}
        return self._collection(node, "mapping", data, tuple(keys.values()), tuple(children))

    def _collection(
        self,
        node: CollectionNode,
        kind: Literal["mapping", "sequence"],
        data: Any,
        keys: tuple[Node, ...],
        children: tuple[Node, ...],
    ) -> Node:
        mark = node.start_mark
        style = "flow" if node.flow_style else "block"
        end = node.end_mark.index
        if style == "block":
            # Composed, it ends where the next thing begins, below comments that are not its own.
            end = children[-1].end if children else mark.index
        place = (mark.line + 1, mark.column + 1)
        return Node(kind, mark.index, end, *place, style, data, keys, children)


def _kind(node: ComposedNode) -> Kind:
    if isinstance(node, MappingNode):
        return "mapping"
    return "sequence" if isinstance(node, SequenceNode) else "scalar"


def _shown(value: str) -> str:
    return _CONTROL_CHARACTER.sub("\N{REPLACEMENT CHARACTER}", value)
