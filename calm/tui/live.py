"""What a text says while it is edited: the line solved and judged, or what it still lacks.

Nothing here knows of the screen. `judge` is for a worker at every change; `judge_fully` adds what
takes longer.
"""

from __future__ import annotations

import os
import time
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path

from calm.case import Mooring, Result, Tow, TowResult
from calm.case.memory import Memory
from calm.checks.assess import OWN, assessment_of, stand_of
from calm.checks.finding import Finding, State
from calm.checks.rules import STANDING, equilibrium
from calm.errors import InputError, NoEquilibrium, Problem, internal_failure
from calm.files import MooringFile, read_mooring
from calm.files.document import Document, document_of
from calm.files.reader import STAND_IN

UNNAMED = "unnamed.yaml"
"""The path of a text that belongs to no file yet."""

_Figures = tuple[float | None, float | None, float | None, float | None]
_UNSOLVED: _Figures = (None, None, None, None)
_NOTHING: tuple[float | None, State | None] = (None, None)
_GRAVITY = {state: state.severity for state in State}
_OF_THE_ANCHOR = ("anchor-weight", "anchor-uplift", "anchor-sliding")


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


@dataclass(frozen=True)
class View:
    """A text as it stands.

    Attributes
    ----------
    text, path, environment : what was judged
    problems : what is wrong with it; nothing is solved then
    missing : what it still lacks, in plain words
    file : as read; None where something is wrong or lacking, but for an anchor or a float.
        A line without an anchor stands on one that holds anything here.
    result : the line solved; None where it could not be
    failure : why it could not
    findings : of the design check; none for a tow
    seconds : that it took
    environments : the names of those that the file gives besides its own
    rows : down the file, clamps below their piece
    complete : whether the findings are all that `calm check` has, see `judge_fully`
    memory : what was solved, for the next text
    """

    text: str
    path: Path
    environment: str | None
    problems: tuple[Problem, ...] = ()
    missing: tuple[str, ...] = ()
    file: MooringFile | None = None
    result: Result | TowResult | None = None
    failure: NoEquilibrium | None = None
    findings: tuple[Finding, ...] = ()
    seconds: float = 0.0
    environments: tuple[str, ...] = ()
    rows: tuple[Row, ...] = ()
    complete: bool = False
    memory: Memory = field(default_factory=Memory, repr=False, compare=False)

    @property
    def anchored(self) -> bool:
        """Whether the line has an anchor of its own, or needs none."""
        return self.file is not None and self.file.pieces[-1].use != STAND_IN


def judge(
    text: str,
    path: str | Path | None = None,
    environment: str | None = None,
    catalogs: Sequence[str | Path] = (),
    keep: View | None = None,
) -> View:
    """Solve a text and judge it by the rules of a standing line; for any thread.

    Parameters
    ----------
    text : of a mooring or a tow file
    path : of the file it belongs to, beside which the files that it names are; None of none
    environment : one of its `environments`, or an environment file
    catalogs : catalogue files of the person's own
    keep : an earlier view of the same file: what has not changed since is not solved again

    Returns
    -------
    View : with the figures of `calm run` and the findings as given of `calm check`. Nothing that a
        person can write raises.
    """
    started = time.perf_counter()
    memory = Memory() if keep is None else keep.memory
    view = View(text, Path.cwd() / UNNAMED if path is None else Path(path), environment)
    view = replace(view, memory=memory)
    try:
        view = _judged(view, catalogs)
    except Exception as error:
        if os.environ.get("CALM_DEBUG") == "1":
            raise
        view = replace(view, failure=internal_failure(error))
    return replace(view, seconds=time.perf_counter() - started)


def judge_fully(view: View) -> View:
    """The same with all that `calm check` finds: in other situations, at launch and at recovery.

    A tow, and a line without an anchor of its own or without equilibrium, is returned as it is.
    """
    if view.complete or not view.anchored or not isinstance(view.result, Result):
        return view
    started = time.perf_counter()
    mooring = view.result.mooring
    try:
        assessment = assessment_of(mooring.file.name, [stand_of(mooring, mooring.file.name)])
    except Exception:
        if os.environ.get("CALM_DEBUG") == "1":
            raise
        return view
    findings = tuple(assessment.all_findings())
    seconds = view.seconds + time.perf_counter() - started
    document = document_of(str(view.path), view.text)
    rows = tuple(_rows(document, mooring.file, view.result, findings))
    return replace(view, findings=findings, rows=rows, seconds=seconds, complete=True)


def _judged(view: View, catalogs: Sequence[str | Path]) -> View:
    try:
        document = document_of(str(view.path), view.text)
    except InputError as error:
        return _wrong(view, error.problems)
    view = replace(view, environments=_variants(document))
    try:
        file = read_mooring(
            view.path, environment=view.environment, catalogs=catalogs, text=view.text,
            stand_in=True,
        )  # fmt: skip
    except InputError as error:
        return _wrong(view, error.problems)
    view = replace(view, file=file, missing=tuple(_lacking(file)))
    if "no float" in view.missing:
        return replace(view, rows=tuple(_rows(document, file, None)))
    return _solved(view, document, file)


def _solved(view: View, document: Document, file: MooringFile) -> View:
    line = Mooring(file, memory=view.memory) if file.tow is None else Tow(file, view.memory)
    try:
        result = line.solve()
    except NoEquilibrium as failure:
        rows = tuple(_rows(document, file, None))
        findings = () if file.tow else tuple(_of_failure(file, failure))
        return replace(view, failure=failure, findings=findings, rows=rows)
    findings = tuple(_standing(result, view.anchored)) if isinstance(result, Result) else ()
    rows = tuple(_rows(document, file, result, findings))
    return replace(view, result=result, findings=findings, rows=rows)


def _wrong(view: View, problems: Sequence[Problem]) -> View:
    """What is wrong and what is lacking, apart."""
    lacking = dict.fromkeys(problem.lacks for problem in problems if problem.lacks)
    wrong = tuple(problem for problem in problems if not problem.lacks)
    return replace(view, problems=wrong, missing=tuple(lacking))


def _variants(document: Document) -> tuple[str, ...]:
    named = document.data.get("environments")
    return tuple(named) if isinstance(named, dict) else ()


def _lacking(file: MooringFile) -> Iterator[str]:
    """What no mooring stands without."""
    if file.tow is not None:
        return
    clamps = [clamp.component for piece in file.pieces for clamp in piece.clamps]
    parts = [*(piece.component for piece in file.pieces), *clamps]
    if not any(part.net_buoyancy > 0.0 for part in parts):
        yield "no float"
    if file.pieces[-1].use == STAND_IN:
        yield "no anchor"


def _of_failure(file: MooringFile, failure: NoEquilibrium) -> Iterator[Finding]:
    for verdict in equilibrium.judge(failure):
        yield equilibrium.find(verdict, file.name, file.environment.name or OWN)


def _standing(result: Result, anchored: bool) -> Iterator[Finding]:
    file = result.file
    for rule in STANDING:
        if not anchored and rule.name in _OF_THE_ANCHOR:
            continue
        for verdict in rule.judge(result):
            if anchored or verdict.component != file.pieces[-1].label:
                yield rule.find(verdict, file.name, file.environment.name or OWN)


def _rows(
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


def _said(findings: Iterable[Finding]) -> dict[str, tuple[float | None, State | None]]:
    """By label the least margin, as a share of its limit, and the gravest state."""
    found: dict[str, list[Finding]] = {}
    for finding in findings:
        if finding.component is not None:
            found.setdefault(finding.component, []).append(finding)
    return {
        label: (
            min((each.share for each in own if each.share is not None), default=None),
            max((each.state for each in own), key=_GRAVITY.__getitem__),
        )
        for label, own in found.items()
    }
