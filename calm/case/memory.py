"""Memory of what was solved before, for a line that is edited or stands in many environments."""

from __future__ import annotations

import io
import pickle
from collections import OrderedDict
from collections.abc import Callable
from dataclasses import fields, is_dataclass
from functools import cache
from threading import Lock
from types import FunctionType
from typing import Any, ParamSpec, TypeVar

from calm.errors import NoEquilibrium

MOST = 256
"""How many outcomes are kept, the latest."""

P = ParamSpec("P")
T = TypeVar("T")


class Memory:
    """Outcomes of solvers by what they were given: the same digits are not solved twice.

    A new label solves nothing anew, another current does not solve still water anew. Threads may
    share it.
    """

    def __init__(self) -> None:
        self._outcomes: OrderedDict[bytes, Any] = OrderedDict()
        self._lock = Lock()

    def __reduce__(self) -> tuple[type[Memory], tuple[()]]:
        """Another process begins with nothing."""
        return Memory, ()

    def of(self, solver: Callable[P, T], *given: P.args, **named: P.kwargs) -> T:
        """Return what a solver returns for what it is given, or the `NoEquilibrium` that it
        raises.
        """
        key = _digits((solver.__module__, solver.__qualname__, given, named))
        with self._lock:
            known = key in self._outcomes
            if known:
                self._outcomes.move_to_end(key)
                outcome = self._outcomes[key]
        if not known:
            try:
                outcome = solver(*given, **named)
            except NoEquilibrium as failure:
                outcome = failure
            with self._lock:
                self._outcomes[key] = outcome
                while len(self._outcomes) > MOST:
                    self._outcomes.popitem(last=False)
        if isinstance(outcome, NoEquilibrium):
            raise NoEquilibrium(outcome.status, outcome.wording, outcome.advice, outcome.piece)
        solved: T = outcome
        return solved


class Forgetful(Memory):
    """Keeps nothing: every line is solved."""

    def __reduce__(self) -> tuple[type[Memory], tuple[()]]:
        """Another process keeps nothing either."""
        return Forgetful, ()

    def of(self, solver: Callable[P, T], *given: P.args, **named: P.kwargs) -> T:
        """Return what the solver returns."""
        return solver(*given, **named)


class _Describing(pickle.Pickler):
    """Writes down what it is given.

    A record by its fields, without what it has computed since; a function, such as the curve of a
    hull, by its name and what it encloses.
    """

    def reducer_override(self, thing: Any) -> Any:
        """As `pickle.Pickler`."""
        if is_dataclass(thing) and not isinstance(thing, type):
            values = [getattr(thing, name) for name in _names(type(thing))]
            return tuple, ((type(thing).__qualname__, values),)
        if not isinstance(thing, FunctionType):
            return NotImplemented
        enclosed = [cell.cell_contents for cell in thing.__closure__ or ()]
        return tuple, ((thing.__module__, thing.__qualname__, thing.__defaults__, enclosed),)


@cache
def _names(record: type) -> tuple[str, ...]:
    """The fields of a data class."""
    return tuple(each.name for each in fields(record))


def _digits(given: object) -> bytes:
    """All that a solver is given, digit by digit."""
    written = io.BytesIO()
    _Describing(written).dump(given)
    return written.getvalue()
