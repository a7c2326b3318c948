"""Resolve comments, macros, conditions and included files of a problem file."""

import os
import re
from dataclasses import dataclass, field
from pathlib import Path

from calm.errors import InputError, UsageError, refused
from calm.exchange.cbl.formulas import constant
from calm.exchange.cbl.words import SourceLine
from calm.exchange.model import ImportOptions
from calm.whole_file import decoded, read_content

_NAME = re.compile(r"[A-Za-z_]\w*")
_PIECE = re.compile(  # a text in quotes, a number such as 6e3, a name, or characters in between
    r"\"[^\"\n]*\"|'[^'\n]*'|\d[\w.]*|[A-Za-z_]\w*|[^\w\"']+|.", re.DOTALL
)
_DIRECTIVE = re.compile(r"\s*#\s*([a-z]+)\b(.*)", re.DOTALL)
_MOST_TEXT = 4_000_000  # largest number of characters after expansion
_MOST_EXPANSIONS = 20_000
_DEEPEST = 20  # nesting depth of files, macros and conditions
_LONGEST = 100_000  # largest number of characters of an expanded line


@dataclass(frozen=True)
class _Macro:
    body: str
    parameters: tuple[str, ...] | None = None


# C preprocessor libraries do not limit macro expansion, split `6e3` if `e3` is a macro, and accept
# a comment without an end
@dataclass
class Preprocessor:
    """Preprocessor for problem files, which works like the C preprocessor."""

    options: ImportOptions
    _macros: dict[str, _Macro] = field(default_factory=dict)
    _lines: list[SourceLine] = field(default_factory=list)
    _size: int = 0
    _expansions: int = 0

    def read(self, path: Path) -> list[SourceLine]:
        """Return the lines of a file and of its included files.

        Raises
        ------
        InputError
            A file is unreadable or forbidden, a directive is invalid, or a macro expands without
            end.
        UsageError
            A macro of the user has an invalid name.
        """
        for name, value in self.options.defines.items():
            if not _NAME.fullmatch(name):
                raise UsageError(f"-D {name}={value}: `{name}` is not the name of a macro")
            self._macros[name] = _Macro(value)
        self._file(path, path.resolve().parent, ())
        return self._lines

    def _file(self, path: Path, root: Path, within: tuple[Path, ...]) -> None:
        text = decoded(path, read_content(path)).removeprefix("\ufeff")
        shown = str(path)
        # whether the condition holds, whether one has held before
        conditions: list[tuple[bool, bool]] = []
        for number, line in enumerate(_without_comments(text, shown), 1):
            found = _DIRECTIVE.match(line)
            word, rest = (found[1], found[2].strip()) if found else ("", "")
            try:
                if self._condition(word, rest, conditions) or not all(one[0] for one in conditions):
                    continue
                if found is None:
                    self._add(line, shown, number)
                else:
                    self._directive(word, rest, path, root, within)
            except ValueError as error:
                raise refused(shown, str(error), line=number) from None
        if conditions:
            raise refused(shown, "an `#if` has no `#endif`", line=len(text.splitlines()))

    def _condition(self, word: str, rest: str, conditions: list[tuple[bool, bool]]) -> bool:
        """Process `#if` and related directives; return False for other directives."""
        if word in ("if", "ifdef", "ifndef"):
            if len(conditions) >= _DEEPEST:
                raise ValueError("conditions are nested too deeply")
            outside = all(holds for holds, _ in conditions)
            holds = outside and self._holds(word, rest)
            conditions.append((holds, holds or not outside))
        elif word in ("elif", "else"):
            if not conditions:
                raise ValueError(f"`#{word}` without `#if`")
            _, had = conditions.pop()
            holds = not had and (word == "else" or self._holds("if", rest))
            conditions.append((holds, had or holds))
        elif word == "endif":
            if not conditions:
                raise ValueError("`#endif` without `#if`")
            conditions.pop()
        else:
            return False
        return True

    def _holds(self, word: str, rest: str) -> bool:
        if word != "if":
            name = _NAME.match(rest)
            if name is None:
                raise ValueError(f"`#{word}` needs a name")
            return (name[0] in self._macros) == (word == "ifdef")
        known = re.sub(
            r"\bdefined\s*(?:\(\s*(\w+)\s*\)|(\w+))",
            lambda found: str(int((found[1] or found[2]) in self._macros)),
            rest,
        )
        words = _NAME.sub("0", self._expanded(known))
        try:
            return bool(constant(words))
        except InputError:
            raise ValueError(f"`#if {rest}` cannot be evaluated") from None

    def _directive(
        self, word: str, rest: str, path: Path, root: Path, within: tuple[Path, ...]
    ) -> None:
        if word == "define":
            self._define(rest)
        elif word == "undef":
            self._macros.pop(rest.split()[0] if rest else "", None)
        elif word == "include":
            self._include(rest, path, root, within)
        elif word == "error":
            raise ValueError(f"#error {rest}")

    def _define(self, rest: str) -> None:
        found = re.match(r"([A-Za-z_]\w*)(\(([\w\s,]*)\))?(?:\s+(.*)|$)", rest, re.DOTALL)
        if found is None:
            raise ValueError(f"`#define {rest[:40]}` cannot be read")
        if found[1] in self.options.defines:
            return  # definitions by the user have precedence
        parameters = None
        if found[2] is not None:
            parameters = tuple(name.strip() for name in found[3].split(",") if name.strip())
        self._macros[found[1]] = _Macro((found[4] or "").strip(), parameters)

    def _include(self, rest: str, path: Path, root: Path, within: tuple[Path, ...]) -> None:
        found = re.match(r"[\"<']([^\">']+)[\">']", self._expanded(rest).strip() or rest)
        if found is None:
            raise ValueError(f"`#include {rest[:60]}` does not name a file")
        target = path.parent / found[1]
        real = Path(os.path.realpath(target))
        if not self.options.allow_include and not real.is_relative_to(root):
            raise ValueError(
                f"`{found[1]}` lies outside the folder of the file; use --allow-include to read it"
            )
        if not target.is_file():
            raise ValueError(f"the included file `{found[1]}` is missing")
        if len(within) >= _DEEPEST or real in within:
            raise ValueError(f"`{found[1]}` includes itself, or files are nested too deeply")
        self._file(target, root, (*within, real))

    def _add(self, line: str, path: str, number: int) -> None:
        expanded = self._expanded(line)
        self._size += len(expanded) + 1
        if self._size > _MOST_TEXT:
            raise ValueError("the text is too long after macros and includes are expanded")
        self._lines.append(SourceLine(expanded, path, number))

    def _expanded(self, text: str, hidden: frozenset[str] = frozenset()) -> str:
        """Expand the macros in a text, except texts in quotation marks and macros in `hidden`."""
        pieces: list[str] = []
        size, at = 0, 0
        while found := _PIECE.match(text, at):
            macro = None if found[0] in hidden else self._macros.get(found[0])
            piece, at = found[0], found.end()
            if macro is not None:
                piece, at = self._replaced(macro, found, text, hidden)
            pieces.append(piece)
            size += len(piece)
            if size > _LONGEST:
                raise ValueError("a macro grows without limit")
        return "".join(pieces)

    def _replaced(
        self, macro: _Macro, name: re.Match[str], text: str, hidden: frozenset[str]
    ) -> tuple[str, int]:
        """Expand one macro call; return the expansion, and the position after the call."""
        self._expansions += 1
        if self._expansions > _MOST_EXPANSIONS or len(hidden) > _DEEPEST:
            raise ValueError(f"the macro `{name[0]}` grows without limit")
        body, end = macro.body, name.end()
        if macro.parameters is not None:
            arguments, end = _arguments(text, end)
            if len(arguments) != len(macro.parameters):
                return name[0], name.end()
            given = {
                each: self._expanded(value, hidden)
                for each, value in zip(macro.parameters, arguments, strict=True)
            }
            body = _NAME.sub(lambda found: given.get(found[0], found[0]), body)
        return self._expanded(body, hidden | {name[0]}), end


def _arguments(text: str, at: int) -> tuple[list[str], int]:
    """Return the arguments in parentheses at a position, and the position after them."""
    opening = re.compile(r"\s*\(").match(text, at)
    if opening is None:
        return [], at
    depth, start, found = 1, opening.end(), []
    for i in range(start, len(text)):
        if text[i] == "(":
            depth += 1
        elif text[i] == ")":
            depth -= 1
        if depth == 0 or (depth == 1 and text[i] == ","):
            found.append(text[start:i].strip())
            start = i + 1
        if depth == 0:
            return found if found != [""] else [], i + 1
    raise ValueError("the arguments of a macro are not closed by `)`")


def _without_comments(text: str, path: str) -> list[str]:
    """Remove comments and join lines that end in a backslash with the next line.

    Empty lines replace the joined lines, so that line numbers do not change.
    """
    pieces: list[str] = []
    at = 0
    sign = re.compile(r"/\*|//|\"[^\"\n]*\"|'[^'\n]*'")
    while found := sign.search(text, at):
        pieces.append(text[at : found.start()])
        at = found.end()
        if found[0] == "/*":
            end = text.find("*/", at)
            if end < 0:
                start = text.count("\n", 0, found.start()) + 1
                raise refused(path, "a comment is not closed by `*/`", line=start)
            pieces.append(" " + "\n" * text.count("\n", at, end))
            at = end + 2
        elif found[0] == "//":
            end = text.find("\n", at)
            at = len(text) if end < 0 else end
        else:
            pieces.append(found[0])
    pieces.append(text[at:])
    lines: list[str] = []
    joined = 0
    for line in "".join(pieces).replace("\r\n", "\n").split("\n"):
        if joined:
            lines[-joined] += line.removesuffix("\\")
            lines.append("")
            joined = joined + 1 if line.endswith("\\") else 0
        else:
            lines.append(line.removesuffix("\\"))
            joined = 1 if line.endswith("\\") else 0
    return lines
