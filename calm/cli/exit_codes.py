"""How a command ends, for scripts."""

from __future__ import annotations

from collections.abc import Iterable
from enum import IntEnum


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
