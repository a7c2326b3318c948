"""Inverse design: find the smallest change of one parameter that meets a target."""

from collections.abc import Callable
from dataclasses import asdict, dataclass, field
from functools import cache, partial
from typing import Any

from calm.case.adjustment import Adjustment, parse_change, parse_range
from calm.case.design import Design, Result
from calm.case.targets import Figures, Target, figures_of, parse_target
from calm.errors import NoEquilibrium, UsageError
from calm.files import Place
from calm.files.mooring_file import refuse_tow
from calm.solve import expect_many
from calm.solve.least_change import LeastChange
from calm.units import with_unit

MET, MET_ALREADY, NOT_MET = "met", "met-already", "not-met"
"""Statuses of a sizing."""

_NOTHING = 1e-6
"""Relative change of the target quantity that is treated as no change."""
SOLVES = 60.0
"""Approximate number of equilibria per sizing; each value of the parameter needs three."""

_EXACT = 1e-7
"""Relative error at which a target with `=` counts as met.

The error is relative to the larger of two values: the limit, and the difference between the
original value and the limit.
"""


@dataclass(frozen=True)
class Trial:
    """The mooring with one value of the varied parameter.

    Attributes
    ----------
    value : value of the parameter, in the unit of the adjustment
    measured : value of the target's quantity, in SI units or degrees; None without an equilibrium
    place : part whose depth and excursion are reported; by default the top of the line
    """

    value: float
    measured: float | None = None
    result: Result | None = field(default=None, repr=False)
    failure: NoEquilibrium | None = None
    place: Place | None = None

    @property
    def figures(self) -> Figures | None:
        """Summary values of the line. Positions refer to the top of the line or, in a net, to the
        part in the target.
        """
        return None if self.result is None else figures_of(self.result, self.place)


@dataclass(frozen=True)
class Sizing:
    """Smallest change of a parameter with which a mooring meets a target.

    Attributes
    ----------
    range : smallest and largest value of the parameter
    status : ``met``, ``met-already`` (nothing to change) or ``not-met``
    before : the original mooring
    after : the mooring with the smallest change that meets the target, or None
    message, advice : reason why the target is not met, and advice
    steady : whether the target's quantity is monotonic over the values tried
    solves : number of equilibria computed
    """

    target: Target
    change: Adjustment
    range: tuple[float, float]
    status: str
    before: Trial
    after: Trial | None
    message: str
    advice: str
    steady: bool
    solves: int

    @property
    def notes(self) -> tuple[str, ...]:
        """Remarks about the outcome, for the user."""
        notes = [self.change.note] if self.change.note and self.status == MET else []
        if not self.steady:
            notes.append(
                f"{self.target.quantity} does not rise or fall steadily with {self.change.text}: "
                "other values may meet the target too."
            )
        return tuple(notes)

    def to_dict(self) -> dict[str, Any]:
        """Return the JSON object, in SI units and degrees; unknown values are null."""
        from calm.version import __version__

        document: dict[str, Any] = {
            "calm": __version__,
            "name": self.change.file.name,
            "status": self.status,
            "target": self.target.to_dict(),
            "change": {
                "text": self.change.text,
                "labels": list(self.change.labels),
                "unit": self.change.unit,
                "range": list(self.range),
            },
            "before": _trial_document(self.before),
            "after": None if self.after is None else _trial_document(self.after),
            "steady": self.steady,
            "solves": self.solves,
            "notes": list(self.notes),
        }
        if self.status == NOT_MET:
            document |= {"message": self.message, "advice": self.advice}
        return document


def _trial_document(trial: Trial) -> dict[str, Any]:
    document: dict[str, Any] = {"value": trial.value, "measured": trial.measured}
    if trial.failure is not None:
        document |= trial.failure.to_dict()
    if trial.figures is not None and trial.result is not None:
        document |= {"status": trial.result.status, **asdict(trial.figures)}
        document["warnings"] = list(trial.result.warnings)
    return document


def size(
    mooring: Design, target: str, change: str, between: tuple[str, str] | None = None
) -> Sizing:
    """Find the smallest change of a parameter that makes a mooring meet a target.

    The lengths of fitted pieces are computed for every value tried.

    Parameters
    ----------
    target : e.g. ``knockdown(top) <= 20 m``, see `calm.case.targets`
    change : e.g. ``top float.buoyancy``, see `calm.case.adjustment`
    between : smallest and largest value, with units. By default: buoyancy 0 to 100 times the
        present value, length at most twice the water depth, count at most 1000

    Raises
    ------
    UsageError
        Target, change or range are invalid, or the design is a tow.
    """
    refuse_tow(mooring.file)
    wanted, adjustment, limits = _understood(mooring, target, change, between)
    at = cache(partial(_trial, wanted, adjustment))
    before = at(adjustment.now)
    if wanted.relation == "=" and before.measured is None:
        raise UsageError(
            f"{wanted.text}: a search with = starts from the present value of the quantity, but "
            "the present mooring has no such value"
            f"{f' ({before.failure})' if before.failure else ''}; write <= or >= instead of ="
        )
    first = 0.0 if before.measured is None else before.measured - wanted.limit
    sign = -1.0 if wanted.relation == ">=" or (wanted.relation == "=" and first < 0.0) else 1.0

    def excess(value: float) -> float | None:
        measured = at(value).measured
        return None if measured is None else sign * (measured - wanted.limit)

    expect_many(SOLVES)
    search = LeastChange(
        excess,
        *limits,
        whole=adjustment.whole,
        exact=wanted.relation == "=",
        small=_EXACT * max(abs(wanted.limit), abs(first)),
    )
    found = search.find(adjustment.now)
    message, advice = (
        ("", "") if found is not None else _reason_and_advice(search, wanted, adjustment, at)
    )
    status = NOT_MET if found is None else MET_ALREADY if found == adjustment.now else MET
    return Sizing(
        target=wanted,
        change=adjustment,
        range=limits,
        status=status,
        before=before,
        after=None if found is None else at(found),
        message=message,
        advice=advice,
        steady=search.steady,
        solves=at.cache_info().currsize,
    )


def _trial(target: Target, change: Adjustment, value: float) -> Trial:
    file = change.file if value == change.now else change.to(value)
    try:
        result = Design(file).solve()
    except NoEquilibrium as failure:
        return Trial(value, failure=failure)
    place = target.place if file.legs else None
    return Trial(value, target.value(result), result, place=place)


def _understood(
    mooring: Design, target: str, change: str, between: tuple[str, str] | None
) -> tuple[Target, Adjustment, tuple[float, float]]:
    mistakes: list[str] = []
    wanted, adjustment, limits = None, None, None
    try:
        wanted = parse_target(target, mooring.file)
    except UsageError as error:
        mistakes.append(str(error))
    try:
        adjustment = parse_change(change, mooring.file)
        limits = parse_range(between, adjustment)
    except UsageError as error:
        mistakes.append(str(error))
    if wanted is not None and adjustment is not None and adjustment.whole:
        if any(wanted.place == part.place for part in adjustment.parts):
            mistakes.append(
                f"{wanted.label} is one of the parts that {adjustment.text} adds or removes; set "
                "the target for another part"
            )
        if wanted.relation == "=":
            mistakes.append(f"{adjustment.text} changes in steps; write <= or >= in the target")
    if wanted is None or adjustment is None or limits is None or mistakes:
        raise UsageError("\n".join(mistakes))
    return wanted, adjustment, limits


def _reason_and_advice(
    search: LeastChange, target: Target, change: Adjustment, at: Callable[[float], Trial]
) -> tuple[str, str]:
    least = search.least
    span = f"from {with_unit(search.low, change.unit)} to {with_unit(search.high, change.unit)}"
    if least is None:
        failure = at(change.now).failure
        if failure is None:
            message = (
                "A float at the surface, or a line without a unique shape in still water, has no "
                f"{target.quantity}."
            )
            return message, "Choose another quantity, such as the excursion."
        message = f"The mooring has no equilibrium for any {change.text} {span}."
        return (
            f"{message} At the present value: {failure.status}: {failure.message}",
            failure.advice,
        )
    best = at(least)
    assert best.measured is not None
    nearest, where = with_unit(best.measured, target.unit), with_unit(least, change.unit)
    as_it_is = at(change.now).measured
    if as_it_is is not None and abs(best.measured - as_it_is) <= _NOTHING * abs(as_it_is):
        message = (
            f"{change.text} was tried {span}. The present value gives the closest result, "
            f"{nearest}."
        )
    else:
        message = (
            f"{change.text} was tried {span}. The closest result is {nearest}, with {change.text} "
            f"at {where}."
        )
    for neighbour, side in zip(search.neighbours(least), ("Below", "Above"), strict=True):
        failure = at(neighbour).failure
        if failure is not None:
            message += f" {side} {where}: {failure.status}: {failure.message}"
    return message, "Relax the target, change another part, or extend the range with --between."
