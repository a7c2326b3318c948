"""What the design check finds and the design accepts, with a reason."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from datetime import date as calendar_date
from fnmatch import fnmatchcase
from typing import Annotated

from pydantic import AfterValidator, Field, WithJsonSchema, model_validator

from calm.errors import Problem
from calm.files.fields import Model, Text
from calm.files.rules import ACCEPTABLE
from calm.files.section import Section
from calm.suggestions import shown, unknown


def _day(text: str) -> str:
    try:
        if calendar_date.fromisoformat(text).isoformat() == text:
            return text
    except ValueError:
        pass
    raise ValueError(f"`{shown(text)}` is not a day of the calendar; write it as 2027-06-30")


def _said(text: str) -> str:
    if not text.strip():
        raise ValueError("`reason` is blank")
    if not any(sign.isalnum() for sign in text):
        raise ValueError(f"`reason: {shown(text)}` gives no reason; say it in words")
    return text.strip()


Day = Annotated[
    Text,
    AfterValidator(_day),
    WithJsonSchema({"type": "string", "pattern": r"^\d{4}-\d{2}-\d{2}$"}),
]
"""A day such as 2027-06-30; such texts sort by date."""

Reason = Annotated[Text, AfterValidator(_said)]


class AcceptKeys(Model):
    """An item of `checks: accept:`."""

    rule: Annotated[Text, WithJsonSchema({"enum": list(ACCEPTABLE)})] = Field(
        description="of the design check", examples=["knockdown"]
    )
    reason: Reason = Field(
        description="why the finding is accepted",
        examples=["the maker gives no load; hung on chain"],
    )
    component: Text | None = Field(
        default=None,
        description="label of the line, or a pattern of labels; all when absent",
        examples=["glass *"],
    )
    by: Text | None = Field(default=None, description="who accepts it", examples=["A. Martin"])
    date: Day | None = Field(
        default=None, description="day, e.g. 2026-11-20", examples=["2026-11-22"]
    )
    until: Day | None = Field(
        default=None, description="last day on which it counts", examples=["2027-12-31"]
    )

    @model_validator(mode="after")
    def _ends_after_it_begins(self) -> AcceptKeys:
        if self.date is not None and self.until is not None and self.until < self.date:
            raise ValueError(f"the `accept` ends on {self.until}, before its `date`, {self.date}")
        return self


@dataclass(frozen=True)
class Accept:
    """What is accepted of a mooring.

    Attributes
    ----------
    rule : its id
    component : as written, a label or a pattern of labels; None for every finding of the rule
    labels : of the pieces and clamps that it stands for; None as above
    reason : why
    by, date : who accepted it, and when; None where it is not said
    until : the last day on which it counts; None where it does not end
    line : of the mooring file
    """

    rule: str
    component: str | None
    labels: tuple[str, ...] | None
    reason: str
    by: str | None
    date: str | None
    until: str | None
    line: int

    def covers(self, rule: str, component: str | None) -> bool:
        """Whether it is of that rule and component."""
        return self.rule == rule and (self.labels is None or component in self.labels)

    def counts_on(self, day: calendar_date) -> bool:
        """Whether it has not ended before that day, and is not dated after it."""
        begun = self.date is None or self.date <= day.isoformat()
        return begun and (self.until is None or day.isoformat() <= self.until)


def read_accepts(
    keys: Sequence[AcceptKeys], labels: Sequence[str] | None, top: Section, problems: list[Problem]
) -> tuple[Accept, ...]:
    """What a mooring file accepts, the most specific first; mistakes are added to `problems`.

    Parameters
    ----------
    labels : of the line; None where the line has mistakes of its own
    top : the mooring file
    """
    found = [
        accept
        for number, one in enumerate(keys)
        if (accept := _accept(one, number, labels, top, problems)) is not None
    ]
    return tuple(sorted(found, key=lambda one: _breadth(one, labels or ())))


def _accept(
    keys: AcceptKeys,
    number: int,
    labels: Sequence[str] | None,
    top: Section,
    problems: list[Problem],
) -> Accept | None:
    def wrong(key: str, message: str) -> None:
        problems.append(top.problem(("checks", "accept", number, key), message))

    if keys.rule not in ACCEPTABLE:
        rule = shown(keys.rule)
        wrong("rule", unknown(f"no rule that can be accepted is called `{rule}`", rule, ACCEPTABLE))
    covered = None
    if keys.component is not None and labels is not None:
        covered = tuple(matching(keys.component, labels))
        if not covered:
            wrong("component", _nothing_called(keys.component, labels))
    line = top.problem(("checks", "accept", number), "").line
    return Accept(
        keys.rule, keys.component, covered, keys.reason, keys.by, keys.date, keys.until, line
    )


def matching(component: str, labels: Iterable[str]) -> list[str]:
    """The labels that a label or a pattern of labels stands for.

    A text that is a label is that label alone, whatever signs it has. Otherwise ``*`` stands for
    any signs, ``?`` for one, ``[ab]`` for a or b; capitals count.
    """
    labels = list(labels)
    if component in labels:
        return [component]
    return [label for label in labels if fnmatchcase(label, component)]


def _nothing_called(component: str, labels: Sequence[str]) -> str:
    text = shown(component)
    message = f"no piece or clamp is called `{text}`"
    if any(label.startswith(f"{component} ") for label in labels):
        return f"{message}; did you mean `{text} *`?"
    return unknown(message, component, labels)


def _breadth(accept: Accept, labels: Sequence[str]) -> int:
    """0 of a label, 1 of a pattern, 2 of every component."""
    return 2 if accept.component is None else int(accept.component not in labels)
