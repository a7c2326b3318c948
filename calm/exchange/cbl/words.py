"""Split a problem file of WHOI Cable into tokens."""

import re
from collections.abc import Iterable, Iterator
from dataclasses import dataclass

from calm.errors import refused

_TOKEN = re.compile(
    r"""(?P<key>[A-Za-z_][\w.-]*)[ \t]*=(?!=)
    |(?P<text>"[^"]*"|'[^']*')
    |(?P<number>(?:\d+\.\d*|\.\d+|\d+)(?:[eE][+-]?\d+)?)
    |(?P<name>[A-Za-z_][\w/.:]*)
    |(?P<sign>&&|\|\||==|!=|<=|>=|<<|>>|[-+*/%<>!~?:|^&(){}\[\],])""",
    re.VERBOSE,
)


@dataclass(frozen=True)
class SourceLine:
    """A line of text and its position."""

    text: str
    path: str
    number: int


@dataclass(frozen=True)
class Token:
    """A token and its position.

    `kind` is ``key`` (a name followed by `=`), ``name``, ``text`` (in quotes), ``number``, ``sign``
    (a symbol such as a bracket) or ``end``.
    """

    kind: str
    text: str
    path: str
    line: int
    column: int
    number: float = 0.0

    def refuse(self, message: str) -> Exception:
        """Return an error at this token."""
        return refused(self.path, message, line=self.line, column=self.column)


def tokens_of(lines: Iterable[SourceLine]) -> Iterator[Token]:
    """Yield the tokens of the lines, followed by a token of kind ``end``.

    Raises
    ------
    InputError
        The lines contain a character that is not allowed.
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
        found = _TOKEN.match(text, at)
        if found is None:
            message = f"`{text[at]}` is not allowed in a problem of WHOI Cable"
            raise refused(line.path, message, line=line.number, column=at + 1)
        kind = found.lastgroup or ""
        word, at = found[kind], found.end()
        if kind == "key":
            word = word.lower()
        elif kind == "text":
            word = word[1:-1]
        elif kind == "name":  # name of a list: `meter: (3 5)`
            at -= len(word) - len(word.rstrip(":"))
            word = word.rstrip(":")
        yield Token(kind, word, *place, number=float(word) if kind == "number" else 0.0)
