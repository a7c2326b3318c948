"""The words, numbers and signs of a problem file."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from dataclasses import dataclass

from calm.exchange.cbl.source import SourceLine
from calm.exchange.refusal import refused_at

_NUMBER = re.compile(r"(?:\d+\.\d*|\.\d+|\d+)(?:[eE][+-]?\d+)?")
_KEY = re.compile(r"([A-Za-z_][\w.-]*)[ \t]*=(?!=)")
_WORD = re.compile(r"[A-Za-z_][\w/.:]*")
_QUOTED = re.compile(r"\"([^\"]*)\"|'([^']*)'")
_SIGN = re.compile(r"&&|\|\||==|!=|<=|>=|<<|>>|[-+*/%<>!~?:|^&(){}\[\],]")


@dataclass(frozen=True)
class Token:
    """A word and where it stands.

    `kind` is ``key`` (a name with its `=`), ``name``, ``text`` (in quotes), ``number``, ``sign`` or
    ``end``.
    """

    kind: str
    text: str
    path: str
    line: int
    column: int
    number: float = 0.0

    def refuse(self, message: str) -> Exception:
        """A problem at this word."""
        return refused_at(self.path, self.line, self.column, message)


def tokens_of(lines: Iterable[SourceLine]) -> Iterator[Token]:
    """The words of the lines, and an ``end``.

    Raises
    ------
    InputError
        A sign that has no place in such a file.
    """
    last = SourceLine("", "", 0)
    for line in lines:
        yield from _words(line)
        last = line
    yield Token("end", "the end", last.path, last.number, 1)


def _words(line: SourceLine) -> Iterator[Token]:
    text, at = line.text, 0
    while at < len(text):
        if text[at].isspace():
            at += 1
            continue
        place = line.path, line.number, at + 1
        if found := _KEY.match(text, at):
            yield Token("key", found[1].lower(), *place)
        elif found := _QUOTED.match(text, at):
            yield Token("text", found[1] if found[1] is not None else found[2], *place)
        elif found := _NUMBER.match(text, at):
            yield Token("number", found[0], *place, number=float(found[0]))
        elif found := _WORD.match(text, at):
            name = found[0].rstrip(":")  # of a list: `meter: (3 5)`
            yield Token("name", name, *place)
            at += len(name)
            continue
        elif found := _SIGN.match(text, at):
            yield Token("sign", found[0], *place)
        else:
            raise refused_at(*place, f"`{text[at]}` has no place in a problem of WHOI Cable")
        at = found.end()
