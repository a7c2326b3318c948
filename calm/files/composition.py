"""Parse YAML text to a tree of nodes with their positions, from the events of PyYAML."""

from __future__ import annotations

import re
from collections.abc import Callable
from typing import Any, Literal, NamedTuple

import yaml
from yaml import events
from yaml.error import MarkedYAMLError, YAMLError
from yaml.events import CollectionEndEvent

from calm.files.yaml_mistakes import syntax_mistakes, without_colon

_DEEPEST = 100
"""Maximum depth of nested collections. Parsing time for brackets increases with the square of this
depth.
"""

# YAML 1.1, which PyYAML reads, treats these characters as line breaks, but YAML 1.2 does not.
_NO_BREAKS = str.maketrans(dict.fromkeys("\x85\u2028\u2029", " "))

_TAG = re.compile(r"(?<![^\s\[{,])!")

# These characters could move the cursor of a terminal or reverse adjacent digits, or are not text.
_CONTROL_CHARACTER = re.compile(
    "[\x00-\x08\x0b\x0c\x0e-\x1f\x7f-\x9f\u202a-\u202e\u2066-\u2069\ud800-\udfff]"
)
_KINDS: dict[type[events.Event], Kind] = {
    events.MappingStartEvent: "mapping",
    events.SequenceStartEvent: "sequence",
    events.ScalarEvent: "scalar",
}
_COLON = re.compile(r"\s*:")
_TWO_WORDS = re.compile(r"[A-Za-z_]\w*[ :]")
_DASHED = re.compile(r"-[{\[A-Za-z]")
_NULLS = frozenset({"", "~", "null", "Null", "NULL"})
_NULL_TAG = "tag:yaml.org,2002:null"
_PLAIN_TAGS = frozenset(
    f"tag:yaml.org,2002:{kind}"
    for kind in ("map", "seq", "str", "int", "float", "bool", "null", "timestamp", "merge")
) | {None, "!"}


class _Parser(yaml.SafeLoader):
    """Python parser that treats tabs and question marks inside brackets as libyaml does."""

    _within_plain = False

    def scan_to_next_token(self) -> None:
        super().scan_to_next_token()
        while self.flow_level and self.peek() == "\t":
            self.forward()
            super().scan_to_next_token()

    def scan_plain(self) -> yaml.Token:
        self._within_plain = True
        token = super().scan_plain()
        self._within_plain = False
        return token

    def peek(self, index: int = 0) -> str:
        # A question mark would end a plain text here; the text itself is taken from the buffer.
        sign = super().peek(index)
        return "x" if self._within_plain and sign == "?" else sign


class _TooDeep(Exception):
    pass


def compose(text: str) -> Composition:
    """Parse a YAML text, which may start with a byte-order mark."""
    start = int(text.startswith("\ufeff"))
    plain = text[start:] if text.isascii() else text[start:].translate(_NO_BREAKS)
    try:
        # libyaml is about thirty times as fast, but must give the same result
        if yaml.__with_libyaml__ and not _is_read_differently(plain):
            try:
                return _Reader(text, start, yaml.CSafeLoader(plain).get_event).read()
            except (YAMLError, ValueError):
                pass  # the parser in Python has a clearer message
        return _composed_by_python(text, start, plain)
    except _TooDeep:
        return Composition(None, ((0, 0, "is nested too deeply"),))


def _is_read_differently(text: str) -> bool:
    """True if libyaml and the Python parser may read a text differently.

    They differ for some tabs, byte-order marks and tags.
    """
    return "\t" in text or "\ufeff" in text or ("!" in text and _TAG.search(text) is not None)


def _composed_by_python(text: str, start: int, plain: str) -> Composition:
    try:
        return _Reader(text, start, _Parser(plain).get_event).read()
    except MarkedYAMLError as error:
        return Composition(None, tuple(syntax_mistakes(plain, error)))
    except (YAMLError, ValueError, OverflowError) as error:
        first_line = str(error).partition("\n")[0]
        return Composition(None, ((0, 0, f"is not valid YAML: {first_line}"),))


class _Reader:
    """Converter of YAML events to nodes, with a list of the rejected parts.

    `start` is the index in the text at which the parsed part begins.
    """

    def __init__(self, text: str, start: int, next_event: Callable[[], events.Event]) -> None:
        self._text = text
        self._start = start
        self._next = next_event
        self._refusals: list[Refusal] = []
        self._anchors: set[str] = set()

    def read(self) -> Composition:
        self._next()  # start of the stream
        if isinstance(self._next(), events.StreamEndEvent):
            return Composition(None)
        event = self._next()
        root = self._node(event, 0)
        self._next()  # end of the document
        behind = self._next()
        if not isinstance(behind, events.StreamEndEvent):
            what = "expected a single document in the stream", "but found another document"
            raise MarkedYAMLError(what[0], event.start_mark, what[1], behind.start_mark)
        return Composition(root, tuple(self._refusals))

    def _node(self, event: events.NodeEvent, depth: int) -> Node:
        """Build a node from its first event and from the events of all nodes inside it."""
        if depth > _DEEPEST:
            raise _TooDeep
        mark = event.start_mark
        start = mark.index + self._start
        place = mark.line + 1, mark.column + 1
        if isinstance(event, events.AliasEvent):
            if event.anchor not in self._anchors:  # a known anchor has been reported already
                raise MarkedYAMLError(None, None, f"found undefined alias '{event.anchor}'", mark)
            return Node("scalar", start, start, *place, "", None)
        if event.anchor is not None or event.tag not in _PLAIN_TAGS:
            message = f"tags (`{event.tag}`) are not allowed"
            if event.anchor is not None:
                self._anchors.add(event.anchor)
                message = "YAML anchors (&) and aliases (*) are not supported; repeat the value"
            event.anchor = event.tag = None
            return self._refused(event, depth, message)
        kind = _KINDS[type(event)]
        if kind == "scalar":
            end = event.end_mark.index + self._start
            if event.style in ("|", ">"):
                end = start + len(self._text[start:end].rstrip())
            is_plain = not event.style and event.tag in (None, "!")
            is_null = event.tag == _NULL_TAG or (is_plain and event.value in _NULLS)
            text = None if is_null else _shown(event.value)
            return Node(kind, start, end, *place, event.style or "", text)
        keys: list[Node] = []
        if kind == "sequence":
            children, ending = self._items(depth + 1)
            data: Any = [child.data for child in children]
        else:
            children, ending = self._entries(keys, depth + 1)
            data = {key.data: child.data for key, child in zip(keys, children, strict=True)}
        style, end = "flow", ending.end_mark.index + self._start
        if not event.flow_style:
            # libyaml ends a block at the next token, below comments that belong to that token.
            style, end = "block", children[-1].end if children else start
        return Node(kind, start, end, *place, style, data, tuple(keys), tuple(children))

    def _items(self, depth: int) -> tuple[list[Node], CollectionEndEvent]:
        items = []
        while not isinstance(event := self._next(), CollectionEndEvent):
            items.append(self._node(event, depth))
        return items, event

    def _entries(self, keys: list[Node], depth: int) -> tuple[list[Node], CollectionEndEvent]:
        """Return the values of a mapping, and the event that ends it; append the keys to `keys`."""
        lines: dict[str, int] = {}
        values = []
        while not isinstance(event := self._next(), CollectionEndEvent):
            if event.anchor is not None:
                self._node(event, depth)
            elif not isinstance(event, events.ScalarEvent):
                self._refused(event, depth, "a key must be plain text")
            elif (name := _shown(event.value)) in lines:
                again = f"`{name}` is given twice (first on line {lines[name]})"
                self._refusals.append(_refusal(event, again))
            elif not event.style and _DASHED.match(name):
                self._refusals.append(
                    _refusal(event, "the dash of a list item needs a space after it")
                )
            else:
                mark = event.start_mark
                lines[name] = line = mark.line + 1
                start, end = mark.index + self._start, event.end_mark.index + self._start
                key = Node("scalar", start, end, line, mark.column + 1, event.style or "", name)
                value = self._node(self._next(), depth)
                if value.data is None and value.start == value.end:
                    # The event of an empty value is placed at the next token, not at the key.
                    colon = _COLON.match(self._text, end)
                    if colon is None and _TWO_WORDS.match(name):
                        self._refusals.append(_refusal(event, without_colon(name)))
                    behind = colon.end() if colon else end
                    value = Node("scalar", behind, behind, line, key.column, "", None)
                keys.append(key)
                values.append(value)
                continue
            self._refused(self._next(), depth)
        return values, event

    def _refused(self, event: events.NodeEvent, depth: int, message: str = "") -> Node:
        """Skip a node. Report `message`, if given, but no problems inside the node."""
        before = len(self._refusals)
        node = self._node(event, depth)
        self._refusals[before:] = [_refusal(event, message)] if message else []
        return node


def _refusal(event: events.NodeEvent, message: str) -> Refusal:
    return event.start_mark.line + 1, event.start_mark.column + 1, message


def _shown(value: str) -> str:
    if value.isprintable():
        return value
    return _CONTROL_CHARACTER.sub("\N{REPLACEMENT CHARACTER}", value)


Refusal = tuple[int, int, str]
"""Line and column, counted from 1, and a message about YAML that is invalid or not allowed."""

Kind = Literal["mapping", "sequence", "scalar"]


class Node(NamedTuple):
    """A value in a YAML text, with its position.

    Attributes
    ----------
    start, end : span of the node in the text
    line, column : position of the start, from 1
    style : `block` or `flow` for a collection; first character of a quoted or block scalar; empty
        for a plain scalar
    data : content, with scalars as text; nodes share it, so it must not be changed
    keys : keys of a mapping, in the order of the file
    children : values of a mapping, or items of a sequence
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

    def entry(self, step: str | int) -> tuple[Node | None, Node | None]:
        """Return the nodes at a key of a mapping, or at an index of a list.

        Returns
        -------
        (key node, value node) in a mapping, (None, item) in a list; (None, None) if not found.
        """
        if self.kind == "mapping":
            named = zip(self.keys, self.children, strict=True)
            return next(((key, child) for key, child in named if key.data == step), (None, None))
        if self.kind == "sequence" and isinstance(step, int) and 0 <= step < len(self.children):
            return None, self.children[step]
        return None, None


class Composition(NamedTuple):
    """Node tree of a parsed YAML text, and messages about its rejected parts.

    `root` is None for an empty or invalid text.
    """

    root: Node | None
    refusals: tuple[Refusal, ...] = ()
