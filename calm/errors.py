"""The exceptions that CALM raises intentionally, and common parts of their messages.

::

    CalmError
    ├── InputError      a file has mistakes, each reported with its place          (exit code 2)
    ├── UsageError      a command or a call is not valid                           (exit code 2)
    └── NoEquilibrium   the mooring has no equilibrium: the reason, and advice     (exit code 3)
"""

from __future__ import annotations

import difflib
import re
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, ParamSpec, TypeVar

if TYPE_CHECKING:
    from calm.units import QuantityError

P = ParamSpec("P")
T = TypeVar("T")


class CalmError(Exception):
    """Base class of all errors raised intentionally by CALM; messages are written for users."""

    def __reduce__(self) -> tuple[Any, ...]:
        # Python restores an exception by calling its class with its message alone, which fails in
        # a class with other parameters; processes exchange these errors
        return type(self).__new__, (type(self), *self.args), vars(self)


@dataclass(frozen=True)
class Problem:
    """A mistake at one position of a file.

    `line` and `column` count from 1; line 0 stands for the whole file. In an incomplete file,
    `lacks` names the missing value, such as ``no length on wire 2``.
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
    """An input file cannot be used; `problems` lists all mistakes found in the file."""

    def __init__(self, problems: Sequence[Problem]) -> None:
        self.problems = tuple(problems)
        super().__init__("\n".join(str(problem) for problem in self.problems))


def refused(path: object, *messages: str, line: int = 0, column: int = 1) -> InputError:
    """Create an InputError for a file, with one problem per message.

    `line` and `column` give the position in the file; line 0 stands for the whole file.
    """
    place = str(path), line, column if line else 0
    return InputError([Problem(*place, one_line(message)) for message in messages])


class UsageError(CalmError):
    """A command line or a function call is not valid."""


class NoEquilibrium(CalmError):
    """The mooring has no equilibrium that can be reported.

    Parameters
    ----------
    status : str
        One of the statuses of the result format, e.g. ``"no-equilibrium"``, ``"slack"``.
    message, advice : str
        The reason, and a change that the user can try.
    piece : int, optional
        Index of the affected piece, whose name replaces ``{piece}`` in the message.
    """

    def __init__(self, status: str, message: str, advice: str, piece: int | None = None) -> None:
        self.status = status
        self.wording = message
        self.message = message if piece is None else message.format(piece=f"piece {piece + 1}")
        self.advice = advice
        self.piece = piece
        super().__init__(f"{status}: {self.message} {advice}")

    def naming(self, piece: str) -> NoEquilibrium:
        """Return a copy of this exception whose message names the affected piece."""
        return NoEquilibrium(self.status, self.wording.format(piece=piece), self.advice)

    def to_dict(self) -> dict[str, str]:
        """Return `status`, `message` and `advice` as JSON data, for output instead of a result."""
        return {"status": self.status, "message": self.message, "advice": self.advice}


def or_why_not(solve: Callable[P, T], *given: P.args, **named: P.kwargs) -> T | NoEquilibrium:
    """Call a function; return its result, or the NoEquilibrium exception if one is raised."""
    try:
        return solve(*given, **named)
    except NoEquilibrium as failure:
        return failure


EXTRAS: dict[str, tuple[str, ...]] = {
    "records": ("llvmlite", "xarray", "pandas", "h5netcdf", "h5py", "cf_xarray", "cftime"),
    "cluster": ("distributed", "dask", "zarr"),
    "plot": ("matplotlib",),
}
"""Optional libraries, by the package extra that installs them."""


def how_to_install(missing: ModuleNotFoundError) -> str | None:
    """Return a message that names a missing library and the command that installs the library.

    The result is None if the module is part of CALM or has no name. This is an error in CALM.
    """
    library = (missing.name or "").partition(".")[0]
    if library in ("", "calm"):
        return None
    for extra, libraries in EXTRAS.items():
        if library in libraries:
            return (
                f"{library} is not installed; in the checkout of CALM, run pip install '.[{extra}]'"
            )
    return f"{library} is not installed; run pip install {library}"


def unexpected(error: Exception) -> str:
    """Return a one-line description of an exception that was not raised by CALM."""
    advice = how_to_install(error) if isinstance(error, ModuleNotFoundError) else None
    return advice or f"{type(error).__name__}: {error}"


def internal_failure(error: Exception) -> NoEquilibrium:
    """Convert an internal error or a missing library to a failed result, so that the remaining
    lines can still be solved.
    """
    if isinstance(error, ModuleNotFoundError) and (advice := how_to_install(error)):
        need, _, command = advice.partition(": ")
        return NoEquilibrium("internal-error", f"T{need[1:]}.", f"Install it: {command}")
    return NoEquilibrium(
        "internal-error",
        f"CALM failed ({type(error).__name__}: {error}).",
        "Please report this error, with the mooring file.",
    )


LONGEST_TEXT = 60


def one_line(text: str) -> str:
    """Convert a text to a single line without control characters."""
    return " ".join("".join(c if c.isprintable() else " " for c in text).split())


def unknown(what: str, text: str, known: Iterable[str]) -> str:
    """Return the message `what`, extended by the most similar known name, or by all names if few
    exist.
    """
    names = list(known)
    near = nearest(text, names)
    if near:
        return f"{what}; did you mean `{near}`?"
    if 0 < len(names) <= 12:
        return f"{what}; allowed: {', '.join(sorted(names))}"
    return what


def not_among(name: str, text: str, allowed: Iterable[str], offer: str | None = None) -> str:
    """Return the message for a value that is not allowed.

    The message ends with the allowed value most similar to `text` or, if no value is similar, with
    `offer`.
    """
    choices = list(allowed)
    meant = nearest(text, choices) or offer
    message = f"`{name}: {text}` must be one of {', '.join(choices)}"
    return f"{message}; did you mean `{name}: {meant}`?" if meant else message


def nearest(text: str, known: Iterable[str]) -> str | None:
    """Return the name most similar to a text, or None if no name is similar.

    Equal words and numbers count: for ``chain-g30-16``, ``chain-short-g30-16`` is nearer than
    ``chain-g80-16``. If the letters of no name are similar, a name is also similar if it contains
    every word of the text: ``ADCP`` gives ``ADCP 450 m``.
    """
    given, names = text[:LONGEST_TEXT], list(known)
    wanted = _parts(given)
    candidates = difflib.get_close_matches(given, names, 50)
    if not candidates and any(len(word) > 2 and word.isalpha() for word in wanted):
        candidates = [name for name in names if {*wanted} <= {*_parts(name)}]
    return max(candidates, key=lambda name: _likeness(wanted, _parts(name)), default=None)


def _parts(name: str) -> list[str]:
    parts = re.split(r"[\W_]+", name.casefold())
    # a size in millimetres, such as 12mm, is a number
    return [re.sub(r"(?<=\d)mm$", "", part) for part in parts if part]


def _likeness(wanted: Sequence[str], parts: Sequence[str]) -> float:
    best = [max((_similarity(one, other) for other in parts), default=0.0) for one in wanted]
    return sum(best) / max(len(best), 1) - 0.02 * max(len(parts) - len(wanted), 0)


def _similarity(one: str, other: str) -> float:
    if one.isdecimal() and other.isdecimal():
        least, greatest = sorted((float(one), float(other)))
        return least / greatest if greatest else 1.0
    return difflib.SequenceMatcher(None, one, other).ratio() ** 2


def shown(value: object) -> str:
    """Shorten an invalid value for a message."""
    text = value if isinstance(value, str) else "…" if isinstance(value, (dict, list)) else ""
    text = " ".join(text.split())
    return text if len(text) <= LONGEST_TEXT else text[: LONGEST_TEXT - 1] + "…"


def about_quantity(name: str, value: object, error: QuantityError) -> str:
    """Return the message about an invalid quantity, with a corrected value if one is known."""
    text = f"`{name}: {shown(value)}`" if shown(value) else f"`{name}`"
    message = f"{text} {error.complaint}"
    if error.suggestion:
        message += f"; did you mean `{name}: {shown(error.suggestion)}`?"
    return message
