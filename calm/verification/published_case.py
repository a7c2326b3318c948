"""Define a figure to reproduce, how CALM comes to it, and what a check of it finds."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from enum import StrEnum
from math import nan
from typing import Generic, TypeVar

Solved = TypeVar("Solved")

PRINTED = "Half a unit of the last digit printed, and a tenth."
"""The reason for a tolerance where CALM is exact beside the figure as printed."""


class Kind(StrEnum):
    """Tell where an expected figure comes from, and so how much its agreement proves."""

    PUBLISHED = "published"
    CLOSED_FORM = "closed form"
    INDEPENDENT = "independent integration"
    PROPERTY = "property"
    BY_CONSTRUCTION = "by construction"

    @property
    def meaning(self) -> str:
        """The kind in a sentence."""
        return _MEANINGS[self]

    @property
    def verifies(self) -> bool:
        """Tell whether agreement is evidence that CALM is right."""
        return self is not Kind.BY_CONSTRUCTION


_MEANINGS = {
    Kind.PUBLISHED: "Someone printed it: a paper, a manual, a maker.",
    Kind.CLOSED_FORM: "The value of a formula or the root of one, evaluated without CALM.",
    Kind.INDEPENDENT: "From an integration that shares no code with CALM: a quadrature, a solver "
    "of the differential equations, another program.",
    Kind.PROPERTY: "Must hold for any line; needs no reference.",
    Kind.BY_CONSTRUCTION: "A point that CALM's curve is drawn through or fitted to, or a figure of "
    "the library that CALM calls. It guards against slips of copying and counts as no "
    "verification.",
}


@dataclass(frozen=True)
class Case:
    """One figure to reproduce.

    Attributes
    ----------
    name : what the figure is, unique within its source
    expected : the figure, to the digits known
    unit : that of `expected`, as text for a reader; empty for a pure number
    tolerance : greatest difference allowed [unit], > 0
    why : the reason for the tolerance, a sentence
    got : computes CALM's figure [unit]; whatever it raises counts as a figure missed
    kind : where `expected` comes from
    """

    name: str
    expected: float
    unit: str
    tolerance: float
    why: str
    got: Callable[[], float]
    kind: Kind

    def check(self) -> CaseOutcome:
        """Compute the figure; never raises, but for what stops the whole program."""
        try:
            return CaseOutcome(self, float(self.got()))
        except Exception as error:
            return CaseOutcome(self, nan, f"{type(error).__name__}: {error}")


@dataclass(frozen=True)
class CaseOutcome:
    """Hold what became of a case: CALM's figure, or NaN and the reason why there is none."""

    case: Case
    got: float
    reason: str = ""

    @property
    def difference(self) -> float:
        """CALM's figure less the expected one [unit of the case]."""
        return self.got - self.case.expected

    @property
    def within(self) -> bool:
        """Tell whether the figure is met."""
        return abs(self.difference) <= self.case.tolerance


@dataclass(frozen=True)
class Source:
    """Hold the figures that come from one place.

    Attributes
    ----------
    title : a few words
    text : who printed or derived the figures, what of CALM is held against them, and why a
        published figure differs where one does; Markdown, a paragraph to each blank line
    cases : the figures
    picture : stem of the picture that shows them, empty where none does
    """

    title: str
    text: str
    cases: tuple[Case, ...]
    picture: str = ""

    def having(self, words: Iterable[str]) -> Source:
        """Return the source with the cases whose name, or its title, has every word (or part)."""
        wanted = [word.casefold() for word in words]
        chosen = tuple(
            case
            for case in self.cases
            if all(word in f"{self.title} {case.name}".casefold() for word in wanted)
        )
        return Source(self.title, self.text, chosen, self.picture)


@dataclass(frozen=True)
class CaseColumn(Generic[Solved]):
    """Describe a column of a published table.

    Attributes
    ----------
    name, unit : of the figure
    tolerance : greatest difference allowed [unit], or as a share of the figure if `relative`
    of : picks the figure out of CALM's answer
    """

    name: str
    unit: str
    tolerance: float
    of: Callable[[Solved], float]
    relative: bool = False

    def case(
        self, row: str, expected: float, why: str, solve: Callable[[], Solved], kind: Kind
    ) -> Case:
        """Return the case of one cell of the table.

        Parameters
        ----------
        row : name of the row
        expected : the printed figure [unit]
        why : the reason for the tolerance
        solve : finds CALM's answer
        kind : where the figure comes from
        """
        share = abs(expected) if self.relative else 1.0
        return Case(
            f"{row}: {self.name}", expected, self.unit, self.tolerance * share, why,
            lambda: self.of(solve()), kind,
        )  # fmt: skip


def table(
    figures: Sequence[CaseColumn[Solved]],
    rows: Iterable[tuple[str, Callable[[], Solved], Sequence[float]]],
    why: str,
    kind: Kind,
) -> tuple[Case, ...]:
    """Return the cases of a published table, row by row.

    Parameters
    ----------
    figures : its columns
    rows : the name of each row, what solves it, and its printed figures, one for each column
    why : the reason for the tolerances
    kind : where the figures come from
    """
    return tuple(
        figure.case(name, value, why, solve, kind)
        for name, solve, values in rows
        for figure, value in zip(figures, values, strict=True)
    )
