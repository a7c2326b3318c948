"""The rules of the design check, in the order in which a design is reported."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import chain
from typing import TYPE_CHECKING

from calm.checks import (
    anchor_rules,
    arrangement,
    catalogue_rules,
    handling,
    posture,
    situations,
    strength,
)
from calm.checks.currents import currents
from calm.checks.finding import AS_GIVEN, Rule, State, Verdict, rule, verdict_on
from calm.files.rule_texts import RULES as TEXTS

if TYPE_CHECKING:
    from calm.errors import NoEquilibrium

_MODULES = (anchor_rules, arrangement, catalogue_rules, handling, posture, situations, strength)


@rule("equilibrium")
def equilibrium(failure: NoEquilibrium) -> Iterator[Verdict]:
    """Found only where there is none."""
    message = f"{failure.status}: {failure.message}"
    yield verdict_on(None, State.FAIL, message, failure.advice)


STILL_ONLY = verdict_on(
    None,
    State.WARN,
    "No environment has a current of 1 cm/s: what tilts, is knocked down and pulls in one is not "
    "judged.",
    "Give the current, or an environment that has one.",
)
"""What `equilibrium` says of a mooring without a current to speak of."""

_ORDER = list(TEXTS)


def _judging(*, once: bool) -> tuple[Rule, ...]:
    """Rules of the modules in the order of their texts; those of one situation come last."""
    found = chain.from_iterable(vars(module).values() for module in _MODULES)
    rules = [each for each in found if isinstance(each, Rule) and each.once == once]
    rules.sort(key=lambda each: (each.situation != AS_GIVEN, _ORDER.index(each.name)))
    return tuple(rules)


STANDING = _judging(once=False)
"""What is judged of a `Result`, in every environment and situation."""

ONCE = _judging(once=True)
"""What is judged once of a mooring: its breaks, its launch and its recovery."""

RULES = {each.name: each for each in (equilibrium, currents, *STANDING, *ONCE)}
"""Every rule by its name."""
