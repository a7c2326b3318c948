"""Messages about invalid YAML that explain the mistake, not the state of the parser."""

from __future__ import annotations

import re

from yaml.error import Mark, MarkedYAMLError

from calm.errors import shown

Mistake = tuple[int, int, str]
"""Line and column, counted from 1, and the message."""

_KEY = re.compile(r"\s*(?:- +)*(?:[{\[] *)?[\w-]+:(?= |$)")
_OPENING = {"mapping": "{", "sequence": "["}


def without_colon(text: str) -> str:
    """Return the message for a line in which the colon, or the space after it, is missing."""
    key, colon, value = text.partition(":") if ":" in text else text.partition(" ")
    lacking = "space after its colon" if colon == ":" else "colon"
    meant = f"{shown(key)}: {shown(value)}".strip()
    return f"`{shown(text)}` has no {lacking}; did you mean `{meant}`?"


def syntax_mistakes(text: str, error: MarkedYAMLError) -> list[Mistake]:
    """Explain an error of the YAML parser; return one or more mistakes with their positions.

    An error of an unknown kind keeps the message of the parser.
    """
    lines = text.splitlines()
    if "\\t" in str(error.problem):
        found = [
            (number, line.index("\t") + 1, "a tab; YAML is indented with spaces")
            for number, line in enumerate(lines, 1)
            if "\t" in line[: len(line) - len(line.lstrip())]
        ]
        if found:
            return found
    return [_mistake(lines, error) or _in_words_of_the_parser(error)]


def _in_words_of_the_parser(error: MarkedYAMLError) -> Mistake:
    mark = error.problem_mark or error.context_mark
    what = error.problem or error.context
    if error.context and error.context_mark and error.problem:
        what = f"{error.context} from line {error.context_mark.line + 1}, {what}"
    return mark.line + 1, mark.column + 1, f"is not valid YAML: {what}"


def _mistake(lines: list[str], error: MarkedYAMLError) -> Mistake | None:
    problem, context = str(error.problem), str(error.context)
    mark, begun = error.problem_mark, error.context_mark or error.problem_mark
    if mark is None or begun is None:
        return None
    if "mapping values are not allowed" in problem:
        return _colon(lines, mark)
    if "could not find expected ':'" in problem:
        return _at(begun, without_colon(_content(lines[begun.line])))
    if "while scanning a quoted" in context:
        return _at(begun, "the quotes that begin here are not closed")
    sign = lines[mark.line][mark.column : mark.column + 1] if mark.line < len(lines) else ""
    if "cannot start any token" in problem and sign.isprintable():
        return _at(mark, f"a text that begins with {sign} must be in quotes")
    if "undefined alias" in problem:
        return _at(mark, "a text that begins with * must be in quotes")
    if opening := next((sign for of, sign in _OPENING.items() if f"flow {of}" in context), ""):
        if mark.line > begun.line:
            return _at(begun, f"the `{opening}` that begins here is not closed")
        if problem.endswith("got ':'"):
            text = re.split(r"[{\[,]", lines[mark.line][: mark.column])[-1].strip()
            advice = "add a comma before the next key, or put the text in quotes"
            return _at(mark, f"`{shown(text)}:` has two colons; {advice}")
    if problem.endswith(("found '}'", "found ']'")):
        return _at(mark, f"`{problem[-2]}` closes nothing")
    if "expected <block end>" in problem:
        above = _above(lines, mark.line)
        same_indent = above is not None and _indent(lines[above]) == _indent(lines[mark.line])
        if above is not None and same_indent and re.match(r"\s*[A-Za-z]\w*(?!.*: )", lines[above]):
            return _without_colon(lines, above)
        begin = f"line {begun.line + 1}, which begins this block"
        others = f"{begin}, starts in column {begun.column + 1}"
        if above is not None and above != begun.line:
            others = f"line {above + 1} starts in column {_indent(lines[above]) + 1}, and {others}"
        message = f"starts in column {mark.column + 1}, but {others}"
        return _at(mark, message)
    return None


def _colon(lines: list[str], mark: Mark) -> Mistake | None:
    """Explain a misplaced colon, such as a second colon in a line or a line indented too far."""
    line = lines[mark.line]
    if key := _KEY.match(line[: mark.column]):
        name, value = key[0].strip(), line[key.end() :].strip()
        return _at(mark, f'a text with a colon must be in quotes: `{shown(name)} "{shown(value)}"`')
    above = _above(lines, mark.line)
    if above is None:
        return None
    if not _KEY.match(lines[above]):
        return _without_colon(lines, above)
    message = f"is indented further than line {above + 1}, which already has a value"
    return mark.line + 1, _indent(line) + 1, message


def _without_colon(lines: list[str], number: int) -> Mistake:
    line = lines[number]
    return number + 1, _indent(line) + 1, without_colon(_content(line))


def _above(lines: list[str], number: int) -> int | None:
    return next((each for each in reversed(range(number)) if _content(lines[each])), None)


def _indent(line: str) -> int:
    return len(line) - len(line.lstrip())


def _content(line: str) -> str:
    return re.sub(r"(?:^|\s)#.*", "", line).strip().removeprefix("- ").strip()


def _at(mark: Mark, message: str) -> Mistake:
    return mark.line + 1, mark.column + 1, message
