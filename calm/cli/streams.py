"""Standard output is for data, standard error for narration; and how a command ends."""

from __future__ import annotations

import codecs
import io
import os
import re
import sys
from collections.abc import Iterable
from enum import IntEnum
from typing import TYPE_CHECKING

from calm.drawing.picture import encodable, printable
from calm.errors import UsageError

if TYPE_CHECKING:
    from calm.cli.outputs import Shows

_NARROWEST = 40  # columns: figures are no longer cut, but wrapped by the terminal
_WRITTEN_OUT = "calm-written-out"  # the handler of signs that a stream cannot carry
_SIGNS = "°×–−→≤≥²³"  # those of the tables


def prepare() -> None:
    """Let no sign that the terminal cannot show stop a command: it is written out, or becomes ?."""
    codecs.register_error(_WRITTEN_OUT, _written_out)
    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, io.TextIOWrapper):
            stream.reconfigure(errors=_WRITTEN_OUT)


def _written_out(error: UnicodeError) -> tuple[str, int]:
    from calm.drawing.picture import in_ascii

    assert isinstance(error, UnicodeEncodeError)
    text = in_ascii(error.object[error.start : error.end])
    return text.encode("ascii", "replace").decode(), error.end


def show(text: str, *, styled: bool = False) -> None:
    """Write data to the standard output, at once.

    Nothing in it steers a terminal, unless it is `styled` by CALM; a file or a pipe gets it as it
    is.

    A reader that has seen enough (``calm run m.yaml | head``) is no error.

    UsageError: the output cannot be written, e.g. because the disk is full.
    """
    try:
        print(text if styled or not _on_terminal() else printable(text), end="", flush=True)
    except BrokenPipeError:
        _abandon_output()
    except OSError as error:
        _abandon_output()
        raise UsageError(f"cannot write to the standard output: {error.strerror}") from None


def show_parts(*parts: Shows) -> None:
    """Write to the standard output as the terminal allows, a blank line between two things."""
    from rich.console import Console

    from calm.report.blocks import ReportPart
    from calm.report.terminal import shown

    text = io.StringIO()
    console = Console(file=text, force_terminal=_on_terminal() or None, highlight=False)
    console.width = max(console.width, _NARROWEST)
    plain = not encodable(getattr(sys.stdout, "encoding", None), _SIGNS)
    for number, part in enumerate(parts):
        if number:
            console.print()
        console.print(shown(part, plain=plain) if isinstance(part, ReportPart) else part)
    # Tables are padded to full width, which only clutters a text that is kept.
    show(re.sub(" +$", "", text.getvalue(), flags=re.MULTILINE), styled=True)


def _on_terminal() -> bool:
    return sys.stdout is not None and sys.stdout.isatty()


def narrate(text: str) -> None:
    """Write a line to the standard error, and nothing in it that steers a terminal."""
    print(printable(text), file=sys.stderr, flush=True)


def _abandon_output() -> None:
    """Throw away what is still buffered, which would fail again when the interpreter ends."""
    os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())


class ExitCode(IntEnum):
    """The exit codes of ``calm``, the same for every command."""

    DONE = 0
    """What was asked is done."""

    FINDING = 1
    """A check failed, or lacks a figure that it needs."""

    BAD_INPUT = 2
    """A file, an option or an output path cannot be used; nothing was solved."""

    NO_EQUILIBRIUM = 3
    """A mooring has no equilibrium that may be shown."""

    INTERNAL_ERROR = 70
    """CALM itself failed: a bug, worth a report."""

    INCOMPLETE = 75
    """A batch was stopped; what is done is kept, and the same command does the rest."""

    INTERRUPTED = 130
    """Stopped by Ctrl-C."""


_GRAVEST_FIRST = (ExitCode.BAD_INPUT, ExitCode.NO_EQUILIBRIUM, ExitCode.FINDING)


def gravest(codes: Iterable[ExitCode]) -> ExitCode:
    """The code of a command that did several things: the first of 2, 3, 1, 0 that occurred."""
    occurred = set(codes)
    return next((code for code in _GRAVEST_FIRST if code in occurred), ExitCode.DONE)
