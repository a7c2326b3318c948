"""Refusals of files of other programs."""

from __future__ import annotations

from calm.errors import InputError, Problem
from calm.exchange.design import one_line


def refused(path: object, *messages: str) -> InputError:
    """Why a file cannot be read, or what in it CALM cannot represent."""
    return InputError([Problem(str(path), 0, 0, one_line(message)) for message in messages])


def refused_at(path: object, line: int, column: int, message: str) -> InputError:
    """The same, with the place in a text."""
    return InputError([Problem(str(path), line, column, one_line(message))])
