"""What was found of each row of a line: its figures, its margin and its state."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass

from calm.case import Result, TowResult
from calm.checks.finding import Finding, State
from calm.checks.strength import strength
from calm.files import MooringFile
from calm.files.document import Document
from calm.files.reader import STAND_IN

_Figures = tuple[float | None, float | None, float | None, float | None]
_Said = tuple[float | None, State | None, bool]
_UNSOLVED: _Figures = (None, None, None, None)
_NOTHING: _Said = (None, None, False)
_GRAVITY = {state: state.severity for state in State}
_STRENGTH = frozenset({strength.name})


@dataclass(frozen=True)
class Row:
    """A piece, or an instrument clamped on the piece above it.

    Attributes
    ----------
    item : index in the `line:` of the file; all pieces of a count or an assembly have the same
    clamp : index among the clamps of that item, -1 of a piece
    use, label : as in results
    length : stretched, cut where nothing is solved [m]; None of a clamp, or to be cut to fit
    depth : of the upper end [m], None like all below where nothing is solved
    tension : the greatest [N]
    tilt : [degrees]
    margin : the least that a finding leaves, as a share of its limit; None where none is known
    state : the gravest of its findings; None where there is none
    lacks_strength : whether a figure of its strength is missing
    """

    item: int
    clamp: int
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
    document: Document,
    file: MooringFile,
    result: Result | TowResult | None,
    findings: Iterable[Finding] = (),
) -> Iterator[Row]:
    """Down the file; with figures where there is a result, and what the findings say of each."""
    count = len(document.data["line"])
    items = {document.values["line", item]: item for item in range(count)}
    figures: dict[str, _Figures] = {}
    if result is not None:
        for row in result.clamps:
            figures[row.label] = (None, row.depth, row.tension, row.tilt)
        for row in result.components:
            figures[row.label] = (row.length, row.depth_top, row.tension, row.tilt)
    said = _said(findings)
    for piece in file.pieces:
        if piece.use == STAND_IN:
            continue
        item, unsolved = items[piece.line, piece.column], (piece.length, None, None, None)
        solved = figures.get(piece.label, unsolved)
        yield Row(item, -1, piece.use, piece.label, *solved, *said.get(piece.label, _NOTHING))
        for number, clamp in enumerate(piece.clamps):
            solved, told = figures.get(clamp.label, _UNSOLVED), said.get(clamp.label, _NOTHING)
            yield Row(item, number, clamp.use, clamp.label, *solved, *told)


def _said(findings: Iterable[Finding]) -> dict[str, _Said]:
    """By label the least margin, as a share of its limit, the gravest state, what is lacking."""
    found: dict[str, list[Finding]] = {}
    for finding in findings:
        if finding.component is not None:
            found.setdefault(finding.component, []).append(finding)
    return {label: _of_one(own) for label, own in found.items()}


def _of_one(own: list[Finding]) -> _Said:
    return (
        min((each.share for each in own if each.share is not None), default=None),
        max((each.state for each in own), key=_GRAVITY.__getitem__),
        any(each.state is State.UNKNOWN and each.rule in _STRENGTH for each in own),
    )
