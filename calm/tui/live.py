"""Solve and check the text of a mooring file while the user edits the text.

This module has no user interface. `judge` runs in a worker after every change; `judge_fully` adds
the slower checks.
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
from calm.case.leg import Leg
from calm.case.leg_result import LegResult
from calm.case.memory import Memory
from calm.case.result_tables import ComponentRow, rows_by_place, table_columns
from calm.checks import assess, design_check
from calm.checks.assessment import MooringInEnvironment, Situation
from calm.checks.finding import AS_GIVEN, OWN, Finding, State, environment_text
from calm.checks.missing import with_missing
from calm.checks.situations import situations_of
from calm.checks.strength import strength
from calm.errors import InputError, NoEquilibrium, Problem, internal_failure
from calm.files import (
    Anchor,
    MooringFile,
    Piece,
    Place,
    editing,
    pieces,
    read_mooring,
    yaml_document,
)
from calm.physics.seabed import required_weight
from calm.quantities import show_in

UNNAMED = "unnamed.yaml"
"""Placeholder for the file name of a text without a file."""


@dataclass(frozen=True)
class View:
    """Results and mistakes found in the text of a mooring or tow file.

    Attributes
    ----------
    problems : mistakes in the text; a text with mistakes has no solution
    missing : names of missing parts of the line
    file : parsed file; None if the text has mistakes or the line is incomplete. A missing anchor is
        replaced by an anchor that holds any load.
    failure : reason why the line has no equilibrium
    findings : findings of the design check; empty for a tow
    tighter : findings in other situations, if their utilisation is larger than in `findings`
    environments : names of the environments besides the default environment
    rows : results of each piece and clamp in file order; clamps follow their piece
    complete : whether `findings` has all findings of `calm check`; true for a solved tow
    cases : results in each environment, after the full check
    elsewhere : mistakes in other environments
    held : solutions in every environment and situation, for a line without an anchor
    memory : previous solutions, for reuse
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
    cases: tuple[MooringInEnvironment, ...] = ()
    elsewhere: tuple[Problem, ...] = ()
    held: tuple[HeldLine, ...] = ()
    memory: Memory = field(default_factory=Memory, repr=False, compare=False)

    def is_of(self, text: str, path: Path | None, environment: str | None) -> bool:
        """Return whether the view belongs to a given text, path and environment."""
        return (self.text, self.path, self.environment) == (text, _as_path(path), environment)

    @cached_property
    def items(self) -> tuple[editing.LineItem, ...]:
        """Items of the line that the text describes."""
        return editing.Draft(self.text).items

    @property
    def here(self) -> str:
        """Name by which the findings refer to the current environment."""
        return OWN if self.file is None else self.file.environment.name or OWN

    @property
    def anchored(self) -> bool:
        """Whether the line has an anchor or needs none."""
        return self.file is not None and self.file.pieces[-1].use != pieces.STAND_IN


def judge(
    text: str,
    path: str | Path | None = None,
    environment: str | None = None,
    catalogs: Sequence[str | Path] = (),
    keep: View | None = None,
) -> View:
    """Solve the line in the text of a file, and apply the design rules to its equilibrium.

    The view has the results of `calm run`, and the findings of `calm check` for the situation as
    given. The function may be called in any thread, and raises no exception.

    Parameters
    ----------
    path : path of the file, for relative file names
    environment : name of an environment in the file, or path of an environment file
    catalogs : catalogue files of the user
    keep : earlier view of the same file, whose solutions are reused
    """
    memory = Memory() if keep is None else keep.memory
    view = View(text, _as_path(path), environment, memory=memory)
    try:
        return _judged(view, catalogs)
    except Exception as error:
        if os.environ.get("CALM_DEBUG") == "1":
            raise
        return replace(view, failure=internal_failure(error))


def _as_path(path: str | Path | None) -> Path:
    # relative file names in the text are resolved from this path
    return Path.cwd() / UNNAMED if path is None else Path(path)


def judge_fully(view: View, catalogs: Sequence[str | Path] = ()) -> View:
    """Return a view with the complete findings of `calm check`.

    A tow or a line without equilibrium gives an unchanged view. A line without an anchor is not
    checked, but solved in every environment and situation.
    """
    if view.complete or view.result is None or view.result.towed:
        return view
    if not view.anchored:
        return view if view.result.several else replace(view, held=held_lines(view, catalogs))
    file = view.result.file
    moorings, problems = in_all_environments(view, view.result.design, catalogs)
    assessment = design_check.check(*moorings)
    findings, tighter = tuple(assessment.all_findings()), tuple(assessment.tighter_findings())
    rows = tuple(rows_of(file, view.result, (*findings, *tighter)))
    return replace(
        view, findings=findings, tighter=tighter, rows=rows, cases=assessment.in_environments,
        elsewhere=tuple(problems), complete=True,
    )  # fmt: skip


@dataclass(frozen=True)
class HeldLine:
    """A line solved in one environment and situation, with an anchor that holds any load.

    The text `when` names the environment, unless it is the environment of the view. The text also
    names the situation, unless it is the situation as given.
    """

    when: str
    result: LegResult

    def needed(self, anchor: Anchor) -> float:
        """Return the weight in water that a given anchor must have in this situation [N].

        The weight depends on the friction coefficient of the anchor.
        """
        load, file = self.result.anchor_load, _with_anchor(self.result.file, anchor)
        factor = file.checks.anchor_factor
        return float(required_weight(load.vertical, load.horizontal, factor, file.anchor_friction))

    def weight(self, anchor: Anchor) -> float:
        """Return the weight in water of a given anchor and its clamps, in this environment [N]."""
        leg = self.result.leg
        return Leg(_with_anchor(leg.file, anchor), given_water=leg.water).anchor_weight


def _with_anchor(file: MooringFile, anchor: Anchor) -> MooringFile:
    last = replace(file.pieces[-1], component=anchor)  # the piece keeps its height
    return replace(file, pieces=(*file.pieces[:-1], last))


_HOLDS_ANY_LOAD = 1e9
"""Weight of an anchor that no line lifts [N]."""


def held_lines(view: View, catalogs: Sequence[str | Path] = ()) -> tuple[HeldLine, ...]:
    """Solve a single line in every environment and situation, with an anchor that holds any load.

    The result is empty if the line has no equilibrium.
    """
    found: list[HeldLine] = []

    def held(file: MooringFile) -> Design:
        unlimited = file.anchor.model_copy(update={"weight": _HOLDS_ANY_LOAD})
        return Design(_with_anchor(file, unlimited), memory=view.memory)

    if view.file is None:
        return ()
    try:
        designs, _ = in_all_environments(view, held(view.file), catalogs)
    except NoEquilibrium:  # no length fits
        return ()
    for design in designs:
        name = design.environment.name or OWN
        where = "" if name == view.here else environment_text(name)
        for situation, *_ in situations_of(held(design.file)):
            when = "" if situation.name == AS_GIVEN else situation.name
            if situation.result is not None:
                parts = filter(None, (where, when))
                found.append(HeldLine(", ".join(parts), situation.result))
    return tuple(found)


def in_all_environments(
    view: View, here: Design, catalogs: Sequence[str | Path] = ()
) -> tuple[list[Design], list[Problem]]:
    """Return a mooring in each environment, and mistakes in environments that cannot be read.

    `here` is the design in the environment of the view. Its cut lengths are used in all
    environments.
    """
    found: list[Design] = []
    problems: list[Problem] = []
    for name in dict.fromkeys([None, *view.environments, view.environment]):
        if name == view.environment:
            found.append(here)
            continue
        try:
            file = read_mooring(
                view.path, environment=name, catalogs=catalogs, text=view.text, stand_in=True
            )
        except InputError as error:
            problems += error.problems
        else:
            leg = here.legs[0]  # lines with several legs have no `fit`
            found.append(Design(leg.cut(file), memory=view.memory))
    return found, problems


def _judged(view: View, catalogs: Sequence[str | Path]) -> View:
    try:
        document = yaml_document.compose(str(view.path), view.text)
    except InputError as error:
        return _with_problems(view, error.problems)
    named = document.data.get("environments")
    view = replace(view, environments=tuple(named) if isinstance(named, dict) else ())
    try:
        file = read_mooring(
            view.path, environment=view.environment, catalogs=catalogs, text=view.text,
            stand_in=True,
        )  # fmt: skip
    except InputError as error:
        return _with_problems(view, error.problems)
    show_in(file.units)
    view = replace(view, file=file, missing=tuple(_missing_parts(file)))
    if "no float" in view.missing:
        return replace(view, rows=tuple(rows_of(file, None)))
    return _solved(view, file)


def _missing_parts(file: MooringFile) -> Iterator[str]:
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
    if not design.towed:  # no rule applies to a tow
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


def _with_problems(view: View, problems: Sequence[Problem]) -> View:
    lacking = dict.fromkeys(problem.lacks for problem in problems if problem.lacks)
    wrong = tuple(problem for problem in problems if not problem.lacks)
    return replace(view, problems=wrong, missing=tuple(lacking))


@dataclass(frozen=True)
class FoundRow:
    """Results of a piece, or of an instrument that is clamped to a piece.

    Attributes
    ----------
    place : position in the parsed file
    length : cut length [m]; None for a clamp or an unsolved fitted length
    figures : values in the columns of the line table, by column name
    use : maximum utilisation in the findings, if known
    state : most severe state of the findings, if any
    lacks_strength : whether a value needed for the strength rule is missing
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
    """Yield the results of pieces and clamps in file order, with their findings."""
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
                values = {one.name: one.value(row, file) for one in columns}
                figures = {
                    name: one for name, one in values.items() if one is not None and one == one
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
    # accepted findings count as well
    if finding.missing is not None:
        return strength.name in finding.missing.needed_by
    lacks = finding.lacks is not None and finding.utilisation is None
    return lacks and finding.rule == strength.name
