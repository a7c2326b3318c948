"""Live verdict of a text while it is edited: the line solved and judged, or what it still lacks.

Nothing here knows of the screen. `judge` is for a worker at every change; `judge_fully` adds what
takes longer.
"""

from __future__ import annotations

import os
from collections import defaultdict
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from pathlib import Path

from calm.case import Design, Result
from calm.case.columns import Output
from calm.case.memory import Memory
from calm.case.result_tables import ComponentRow, rows_by_place, table_columns
from calm.checks import assess, design_check
from calm.checks.assessment import MooringInEnvironment, Situation
from calm.checks.finding import AS_GIVEN, OWN, Finding, State
from calm.checks.missing import with_missing
from calm.checks.strength import strength
from calm.errors import InputError, NoEquilibrium, Problem, internal_failure
from calm.files import MooringFile, Piece, Place, editing, pieces, read_mooring, yaml_document
from calm.quantities import show_in

UNNAMED = "unnamed.yaml"
"""The path of a text that belongs to no file yet."""


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
    tighter : of each rule and part what another situation uses more, without being graver
    environments : the names of those that the file gives besides its own
    rows : down the file, clamps below their piece
    complete : whether the findings are all that `calm check` has, see `judge_fully`; a tow's, which
        has none, are
    stands : the line in each of its environments, once they are judged
    elsewhere : what is wrong with environments other than that which the line stands in
    memory : what was solved, for the next text
    """

    text: str
    path: Path
    environment: str | None
    problems: tuple[Problem, ...] = ()
    missing: tuple[str, ...] = ()
    file: MooringFile | None = None
    result: Result | None = None
    failure: NoEquilibrium | None = None
    findings: tuple[Finding, ...] = ()
    tighter: tuple[Finding, ...] = ()
    environments: tuple[str, ...] = ()
    rows: tuple[FoundRow, ...] = ()
    complete: bool = False
    stands: tuple[MooringInEnvironment, ...] = ()
    elsewhere: tuple[Problem, ...] = ()
    memory: Memory = field(default_factory=Memory, repr=False, compare=False)

    def is_of(self, text: str, path: Path | None, environment: str | None) -> bool:
        """Return whether a text, of the file of a path, was judged in this environment."""
        return (self.text, self.path, self.environment) == (text, _placed(path), environment)

    @cached_property
    def items(self) -> tuple[editing.LineItem, ...]:
        """The items of the text, as written."""
        return editing.Draft(self.text).items

    @property
    def here(self) -> str:
        """The environment that the line stands in, as findings name it."""
        return OWN if self.file is None else self.file.environment.name or OWN

    @property
    def anchored(self) -> bool:
        """Return whether the line has an anchor of its own, or needs none."""
        return self.file is not None and self.file.pieces[-1].use != pieces.STAND_IN


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
    memory = Memory() if keep is None else keep.memory
    view = View(text, _placed(path), environment, memory=memory)
    try:
        return _judged(view, catalogs)
    except Exception as error:
        if os.environ.get("CALM_DEBUG") == "1":
            raise
        return replace(view, failure=internal_failure(error))


def _placed(path: str | Path | None) -> Path:
    """Return where a text belongs, beside which the files that it names are looked for."""
    return Path.cwd() / UNNAMED if path is None else Path(path)


def judge_fully(view: View, catalogs: Sequence[str | Path] = ()) -> View:
    """Return the same with all that `calm check` finds: in every environment and situation, in
    waves, at launch and at recovery, and where a part breaks.

    A tow, and a line without an anchor of its own or without equilibrium, is returned as it is.
    """
    if view.complete or not view.anchored or view.result is None or view.result.towed:
        return view
    file = view.result.file
    moorings, problems = in_all_environments(view, view.result.design, catalogs)
    assessment = design_check.check(*moorings)
    findings, tighter = tuple(assessment.all_findings()), tuple(assessment.tighter_findings())
    rows = tuple(rows_of(file, view.result, (*findings, *tighter)))
    return replace(
        view, findings=findings, tighter=tighter, rows=rows, stands=assessment.stands,
        elsewhere=tuple(problems), complete=True,
    )  # fmt: skip


def in_all_environments(
    view: View, here: Design, catalogs: Sequence[str | Path] = ()
) -> tuple[list[Design], list[Problem]]:
    """The mooring in each of its environments, as long in all as here; what is wrong with them."""
    found: list[Design] = []
    problems: list[Problem] = []
    for name in dict.fromkeys([None, *view.environments, view.environment]):
        if name == view.environment:
            found.append(here)
            continue
        try:
            file = read_mooring(view.path, environment=name, catalogs=catalogs, text=view.text)
        except InputError as error:
            problems += error.problems
        else:
            leg = here.legs[0]  # nothing in one of several is cut to fit
            found.append(Design(leg.cut(file), memory=view.memory))
    return found, problems


def _judged(view: View, catalogs: Sequence[str | Path]) -> View:
    try:
        document = yaml_document.compose(str(view.path), view.text)
    except InputError as error:
        return _wrong(view, error.problems)
    named = document.data.get("environments")
    view = replace(view, environments=tuple(named) if isinstance(named, dict) else ())
    try:
        file = read_mooring(
            view.path, environment=view.environment, catalogs=catalogs, text=view.text,
            stand_in=True,
        )  # fmt: skip
    except InputError as error:
        return _wrong(view, error.problems)
    show_in(file.units)
    view = replace(view, file=file, missing=tuple(_lacking(file)))
    if "no float" in view.missing:
        return replace(view, rows=tuple(rows_of(file, None)))
    return _solved(view, file)


def _lacking(file: MooringFile) -> Iterator[str]:
    """Return what no mooring stands without and this line has not; nothing of a tow."""
    if file.tow is not None or file.legs:
        return
    clamps = [clamp.component for piece in file.pieces for clamp in piece.clamps]
    parts = [*(piece.component for piece in file.pieces), *clamps]
    if not any(part.net_buoyancy > 0.0 for part in parts):
        yield "no float"
    if file.pieces[-1].use == pieces.STAND_IN:
        yield "no anchor"


def _solved(view: View, file: MooringFile) -> View:
    design = Design(file, memory=view.memory)
    try:
        result, failure = design.solve(), None
    except NoEquilibrium as error:
        result, failure = None, error
    findings: list[Finding] = []
    if not design.towed:  # no rule is of a tow
        for each in (None,) if result is None else result.legs:
            situation = Situation(AS_GIVEN, each, failure)
            findings += assess.findings_of(situation, file.name, file.environment.name or OWN)
    parts = {part.label: part for part in pieces.parts_of(file.pieces)}
    findings = with_missing(findings, parts, file.name, file.environment.name or OWN)
    rows = tuple(rows_of(file, result, findings))
    return replace(
        view, result=result, failure=failure, findings=tuple(findings), rows=rows,
        complete=result is not None and design.towed,
    )  # fmt: skip


def _wrong(view: View, problems: Sequence[Problem]) -> View:
    """Return what is wrong and what is lacking, apart."""
    lacking = dict.fromkeys(problem.lacks for problem in problems if problem.lacks)
    wrong = tuple(problem for problem in problems if not problem.lacks)
    return replace(view, problems=wrong, missing=tuple(lacking))


@dataclass(frozen=True)
class FoundRow:
    """A piece, or an instrument clamped on the piece above it.

    Attributes
    ----------
    place : in the line as read
    label : as in results
    length : as cut [m]; None of a clamp, and of one to be cut to fit until it is solved
    figures : what the columns of the builder have of it, by name; none where nothing is solved
    use : the greatest utilisation of its findings; None where none is known
    state : the gravest of its findings; None where there is none
    lacks_strength : whether a figure of its strength is missing
    """

    place: Place
    label: str
    length: float | None
    figures: Mapping[str, float] = field(default_factory=dict)
    use: float | None = None
    state: State | None = None
    lacks_strength: bool = False


def rows_of(
    file: MooringFile, result: Result | None, findings: Iterable[Finding] = ()
) -> Iterator[FoundRow]:
    """Down the file; with figures where there is a result, and what the findings say of each."""
    solved = {} if result is None else rows_by_place(result)
    columns = table_columns(Output.BUILDER)
    found: defaultdict[Place | None, list[Finding]] = defaultdict(list)
    for finding in findings:
        for place in finding.places:
            found[place].append(finding)
    for piece in file.pieces:
        if piece.use == pieces.STAND_IN:
            continue
        for part in pieces.parts_of([piece]):
            own, length = found[part.place], part.length if isinstance(part, Piece) else None
            row, figures = solved.get(part.place), {}
            if row is not None:
                length = row.cut_length if isinstance(row, ComponentRow) else None
                told = {one.name: one.value(row, file) for one in columns}
                figures = {
                    name: one for name, one in told.items() if one is not None and one == one
                }
            gravest = max(own, key=lambda each: each.state.severity, default=None)
            yield FoundRow(
                part.place,
                part.label,
                length,
                figures,
                use=max(
                    (use for each in own if (use := each.utilisation) is not None), default=None
                ),
                state=gravest.state if gravest else None,
                lacks_strength=any(map(_lacks_strength, own)),
            )


def _lacks_strength(finding: Finding) -> bool:
    """Whether `strength` lacks a figure, or would if nobody had accepted it."""
    if finding.missing is not None:
        return strength.name in finding.missing.needed_by
    lacks = finding.lacks is not None and finding.utilisation is None
    return lacks and finding.rule == strength.name
