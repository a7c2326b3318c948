"""Each row of a line with its figures, its margin and its state."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass

from calm.case import Result, TowResult
from calm.case.parts import parts_of
from calm.checks.finding import Finding, State
from calm.checks.strength import strength
from calm.files import MooringFile, Piece, Place
from calm.files.mooring_file import STAND_IN

_Figures = tuple[float | None, float | None, float | None, float | None]
_Said = tuple[float | None, State | None, bool]
_NOTHING: _Said = (None, None, False)
_GRAVITY = {state: state.severity for state in State}
_STRENGTH = frozenset({strength.name})
_LACKING = (State.UNKNOWN, State.ACCEPTED)
"""What is not known stays so where somebody has accepted it."""


@dataclass(frozen=True)
class FoundRow:
    """A piece, or an instrument clamped on the piece above it.

    Attributes
    ----------
    place : in the line as read
    use, label : as in results
    length : as cut [m]; None of a clamp, and of one to be cut to fit until it is solved
    depth : of the upper end [m], None like all below where nothing is solved
    tension : the greatest [N]
    tilt : [degrees]
    margin : the least that a finding leaves, as a share of its limit; None where none is known
    state : the gravest of its findings; None where there is none
    lacks_strength : whether a figure of its strength is missing
    """

    place: Place
    use: str
    label: str
    length: float | None
    depth: float | None = None
    tension: float | None = None
    tilt: float | None = None
    margin: float | None = None
    state: State | None = None
    lacks_strength: bool = False


def rows_of(
    file: MooringFile, result: Result | TowResult | None, findings: Iterable[Finding] = ()
) -> Iterator[FoundRow]:
    """Down the file; with figures where there is a result, and what the findings say of each."""
    figures: dict[Place, _Figures] = {}
    if result is not None:
        for clamp in result.clamps:
            figures[clamp.place] = (None, clamp.depth, clamp.tension, clamp.tilt)
        for row in result.components:
            figures[row.place] = (row.cut_length, row.depth_top, row.tension, row.tilt)
    said = _said(findings)
    for piece in file.pieces:
        if piece.use == STAND_IN:
            continue
        for part in parts_of([piece]):
            length = part.length if isinstance(part, Piece) else None
            solved = figures.get(part.place, (length, None, None, None))
            yield FoundRow(
                part.place, part.use, part.label, *solved, *said.get(part.place, _NOTHING)
            )


def _said(findings: Iterable[Finding]) -> dict[Place, _Said]:
    """By place the least margin, as a share of its limit, the gravest state, what is lacking."""
    found: dict[Place, list[Finding]] = {}
    for finding in findings:
        if finding.place is not None:
            found.setdefault(finding.place, []).append(finding)
    return {place: _of_one(own) for place, own in found.items()}


def _of_one(own: list[Finding]) -> _Said:
    return (
        min((each.share for each in own if each.share is not None), default=None),
        max((each.state for each in own), key=_GRAVITY.__getitem__),
        any(
            each.rule in _STRENGTH and each.state in _LACKING and each.share is None for each in own
        ),
    )
