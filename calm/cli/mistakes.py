"""Messages for command lines that the parser rejects."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from cyclopts import (
    CoercionError,
    CycloptsError,
    MissingArgumentError,
    UnknownCommandError,
    UnknownOptionError,
    UnusedCliTokensError,
)

from calm.cli.help import metavar
from calm.errors import nearest

if TYPE_CHECKING:
    from cyclopts import App, Argument


def complaint(error: CycloptsError) -> str:
    """Return the message for an invalid command line, with the correct form."""
    command = " ".join(("calm", *(error.command_chain or ())))
    if isinstance(error, UnusedCliTokensError):
        extra = " ".join(error.unused_tokens or ())
        return f"unexpected argument: {extra}; see `{command} --help`"
    if type(error) is MissingArgumentError and error.argument is not None:
        return _missing_message(command, error, error.argument)
    if isinstance(error, UnknownOptionError) and (message := _suggest_longer_options(error)):
        return f"`{command}`: {message}"
    if isinstance(error, CoercionError) and error.token is not None:
        path = error.token.value
        file = f" For a file: -o {path}" if Path(path).suffix in (".yaml", ".yml") else ""
        return f"{error}{file}"
    if isinstance(error, UnknownCommandError):
        word, *others = error.unused_tokens or [""]
        if word == "help":
            return f"for the help of a command, type `{' '.join(('calm', *others))} --help`"
        if Path(word).suffix and Path(word).exists():
            return f"`{word}` is a file, not a command; see `calm --help`, or `calm run {word}`"
        return f"{error} See `{command} --help`."
    return str(error)


def _suggest_longer_options(error: UnknownOptionError) -> str:
    word = error.token.keyword or error.token.value
    if word == "-":
        return "CALM does not read standard input; name a file"
    names = [name for one in error.argument_collection for name in one.names]
    longer = [name for name in names if name.startswith(word) and word.startswith("--")]
    return f"unknown option {word}; did you mean {' or '.join(longer)}?" if longer else ""


def _missing_message(command: str, error: MissingArgumentError, argument: Argument) -> str:
    if error.keyword is not None or argument.tokens:
        return f"`{command}`: {error.keyword or argument.name} needs a value: {_form(argument)}"
    typed = [word.partition("=")[0] for word in error.root_input_tokens or () if word[:1] == "-"]
    every = [*error.app.assemble_argument_collection()] if error.app is not None else []
    later = every[next((i for i, one in enumerate(every) if one.name == argument.name), 0) :]
    lacking = [one for one in later if one.required and not set(one.names) & {*typed}]
    forms = [_form(one, error.app) for one in lacking] or [_form(argument)]
    options = [name for one in every for name in one.names]
    strange = [word for word in typed if word.startswith("--") and word not in options]
    offers = [(nearest(word, options), word) for word in strange]
    meant = next((f"; did you mean {near} for {word}?" for near, word in offers if near), "")
    *first, last = forms
    needs = f"{', '.join(first)} and {last}" if first else last
    return f"`{command}` needs {needs}{meant or f'; see `{command} --help`'}"


def _form(argument: Argument, app: App | None = None) -> str:
    """Return the form of an argument on the command line: ``--currents FILE``, ``FILE...``."""
    if argument.name.startswith("-"):
        short = min(argument.names, key=len)
        return f"{short} {metavar(argument.name) or 'PATH'}"
    place = argument.index or 0
    words = _usage_positionals(app)
    return words[place] if place < len(words) else argument.name


def _usage_positionals(app: App | None) -> Sequence[str]:
    usage = "" if app is None or not app.usage else app.usage
    return [word for word in usage.partition("[OPTIONS]")[2].split() if word[0] != "["]
