"""The limits that a design is judged by, as used."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from calm.files.check_limits import LimitKey, limit_keys

if TYPE_CHECKING:
    from calm.files import MooringFile

_SAID = {"length": "m", "force": "N", "speed": "m/s", "angle": "°", "number": ""}


def limits_used(file: MooringFile, surface: bool) -> tuple[LimitKey, ...]:
    """Every limit that the design check judges a mooring by.

    One that the design does not give has its default; one that has none and is not given is not
    used. The friction of an anchor that gives its own stands for `anchor_friction`. What the line
    lets a component bear beyond its own definition is a limit that departs from it.

    Parameters
    ----------
    surface : whether the mooring is meant for the surface: then no depth of its top is asked for
    """
    given = file.checks.minimum_top_depth is not None
    used = (
        key
        for key in _keys(file)
        if key.value is not None and (key.name != "minimum_top_depth" or given or not surface)
    )
    return (*used, *file.looser)


def _keys(file: MooringFile) -> Iterator[LimitKey]:
    friction = file.anchor.friction
    for key in limit_keys(file.checks):
        own = key.name == "anchor_friction" and friction is not None
        yield replace(key, value=friction) if own else key


@dataclass(frozen=True)
class Citing:
    """Who is cited for a limit: the source of its default, or the design that departs from it."""

    departed: dict[str, LimitKey]

    @classmethod
    def of(cls, file: MooringFile) -> Citing:
        """For the limits of a mooring file."""
        return cls({key.name: key for key in _keys(file) if key.departs})

    def __call__(self, *names: str) -> str:
        """Of the limits of some names: the design where one departs; "" where none does."""
        own = [self.departed[name] for name in names if name in self.departed]
        return "; ".join(
            f"The design's own `{key.name}`, {said(key, key.value)} in place of "
            f"{said(key, key.default)}"
            for key in own
        )


def said(key: LimitKey, value: float | None) -> str:
    """A value or a default of a limit with its unit; a dash for none."""
    if value is None:
        return "-"
    return f"{value:.10g} {_SAID[key.dimension]}".strip().replace(" °", "°")
