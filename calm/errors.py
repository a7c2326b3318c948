"""Every exception CALM raises on purpose.

::

    CalmError
    ├── InputError      a file is wrong: all its problems, each with its place     (exit code 2)
    ├── UsageError      a command or a call is wrong                               (exit code 2)
    └── NoEquilibrium   the line has no shape that may be shown: why, and what to do (exit code 3)
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass


class CalmError(Exception):
    """Mark an error that is meant for people."""


@dataclass(frozen=True)
class Problem:
    """Describe one mistake in one place of a file.

    `line` and `column` count from 1; 0 means the file as a whole. `lacks` shows, where nothing is
    wrong but something is still missing, what that is: ``no length on wire 2``.
    """

    path: str
    line: int
    column: int
    message: str
    lacks: str = ""

    def __str__(self) -> str:
        place = f":{self.line}:{self.column}" if self.line else ""
        return f"{self.path}{place}: {self.message}"


class InputError(CalmError):
    """Say that a file cannot be used as it stands; `problems` holds every mistake found in it."""

    def __init__(self, problems: Sequence[Problem]) -> None:
        self.problems = tuple(problems)
        super().__init__("\n".join(str(problem) for problem in self.problems))


class UsageError(CalmError):
    """Say that a command line or a call asks for something that does not exist."""


class NoEquilibrium(CalmError):
    """Say that the mooring has no equilibrium that may be shown.

    Parameters
    ----------
    status : str
        One of the statuses of the result format, e.g. ``"no-equilibrium"``, ``"slack"``.
    message, advice : str
        What is wrong, with its figures, and what to change.
    piece : int, optional
        Index of the piece it happens at, which stands in the message as ``{piece}``.
    """

    def __init__(self, status: str, message: str, advice: str, piece: int | None = None) -> None:
        self.status = status
        self.wording = message
        self.message = message if piece is None else message.format(piece=f"piece {piece + 1}")
        self.advice = advice
        self.piece = piece
        super().__init__(f"{status}: {self.message} {advice}")

    def naming(self, piece: str) -> NoEquilibrium:
        """Return the same exception, with the piece called by a name."""
        return NoEquilibrium(self.status, self.wording.format(piece=piece), self.advice)

    def to_dict(self) -> dict[str, str]:
        """Return `status`, `message` and `advice`, as they stand in JSON in place of a result."""
        return {"status": self.status, "message": self.message, "advice": self.advice}


def internal_failure(error: Exception) -> NoEquilibrium:
    """Report CALM's own failure as an unsolved line: it does not stop the others."""
    return NoEquilibrium(
        "internal-error",
        f"CALM failed ({type(error).__name__}: {error}).",
        "Please report it, with the file.",
    )
