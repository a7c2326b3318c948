"""What a rule of the design check finds."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from enum import StrEnum
from typing import Any

AS_GIVEN = "as given"
"""The situation of a mooring in its environment, with nothing changed."""


class State(StrEnum):
    """How a rule judges, the least grave first; unknown where a figure that it needs is missing."""

    PASS = "pass"
    UNKNOWN = "unknown"
    WARN = "warn"
    FAIL = "fail"

    @property
    def gravity(self) -> int:
        """0 for a pass, more the graver."""
        return list(State).index(self)


@dataclass(frozen=True)
class Rule:
    """A named rule: what it judges, the quantity of its values, and who asks for it.

    Attributes
    ----------
    name : as in findings, e.g. ``depth-rating``
    title : for people
    quantity : of `calm.quantities`, whose unit its values and limits have
    source : of the rule and of its default limit
    """

    name: str
    title: str
    quantity: str
    source: str


@dataclass(frozen=True)
class Finding:
    """What a rule says of one mooring, or of one of its components, in one environment.

    Attributes
    ----------
    mooring, environment : their names
    rule : name of the `Rule`
    component : label of a piece or a clamp; None of the mooring as a whole
    value, limit : SI units and degrees; None where unknown
    margin : how far the value keeps within the limit, in its unit, negative where it does not
    state : pass, warn, fail or unknown
    message : what was found, in a sentence with both figures
    remedy : what to change; None where nothing need be
    source : of the rule and its limit
    situation : what was changed for this finding; `AS_GIVEN` where nothing was
    """

    mooring: str
    environment: str
    rule: str
    component: str | None
    value: float | None
    limit: float | None
    margin: float | None
    state: State
    message: str
    remedy: str | None
    source: str
    situation: str = AS_GIVEN

    @property
    def share(self) -> float | None:
        """The margin as a share of the limit, which tells the worst of several; None if unknown."""
        if self.margin is None or not self.limit:
            return None
        return self.margin / abs(self.limit)

    def to_dict(self) -> dict[str, Any]:
        """The finding in JSON."""
        return asdict(self)
