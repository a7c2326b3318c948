"""Cache of solver outcomes, for a line that is edited or solved in many environments."""

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
from calm.physics.line import Line, Water, once_per_input

MOST = 256
"""Maximum number of stored outcomes; older outcomes are discarded."""

Key = tuple[str | bytes, ...]

P = ParamSpec("P")
T = TypeVar("T")


class Memory:
    """Cache of solver outcomes by inputs, so that identical problems are solved only once.

    Labels are not part of the inputs. Several threads may use the cache.
    """

    def __init__(self) -> None:
        self._outcomes: OrderedDict[Key, Any] = OrderedDict()
        self._lock = Lock()

    def __reduce__(self) -> tuple[type[Memory], tuple[()]]:
        return Memory, ()

    def of(self, solver: Callable[P, T], *given: P.args, **named: P.kwargs) -> T:
        """Return the outcome of a solver for its arguments, from the cache if possible. A cached
        `NoEquilibrium` is raised again.
        """
        key = _key(solver, given, named)
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


class NoMemory(Memory):
    """Cache that stores nothing, so that every line is solved."""

    def __reduce__(self) -> tuple[type[Memory], tuple[()]]:
        return NoMemory, ()

    def of(self, solver: Callable[P, T], *given: P.args, **named: P.kwargs) -> T:
        """Return the result of the solver for its arguments."""
        return solver(*given, **named)


class _Describing(pickle.Pickler):
    """Pickler that converts the inputs of a solver to a cache key.

    A dataclass is represented by its fields, and a function by its name and closure.
    """

    def reducer_override(self, thing: Any) -> Any:
        if is_dataclass(thing) and not isinstance(thing, type):
            values = [getattr(thing, name) for name in _names(type(thing))]
            return tuple, ((type(thing).__qualname__, values),)
        if not isinstance(thing, FunctionType):
            return NotImplemented
        enclosed = [cell.cell_contents for cell in thing.__closure__ or ()]
        return tuple, ((thing.__module__, thing.__qualname__, thing.__defaults__, enclosed),)


@cache
def _names(record: type) -> tuple[str, ...]:
    return tuple(each.name for each in fields(record))


def _key(solver: Callable[..., object], given: tuple[object, ...], named: object) -> Key:
    inputs = (_of_arrays(one) if isinstance(one, Line | Water) else _written(one) for one in given)
    return solver.__module__, solver.__qualname__, *inputs, _written(named)


@once_per_input
def _of_arrays(given: Line | Water) -> bytes:
    return _written(given)


def _written(given: object) -> bytes:
    written = io.BytesIO()
    _Describing(written).dump(given)
    return written.getvalue()
