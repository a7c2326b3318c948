"""Solve and check designs in all their environments, in several processes."""

from __future__ import annotations

import os
from collections.abc import Sequence
from dataclasses import replace
from datetime import date, datetime
from functools import partial
from typing import TYPE_CHECKING, NamedTuple

from calm.cli import progress
from calm.errors import internal_failure

if TYPE_CHECKING:
    from calm.case import Design, uncertain
    from calm.checks.assessment import Assessment, MooringInEnvironment
    from calm.checks.comparison import Comparison
    from calm.cli.reading import DesignFile
    from calm.report.check_report import CheckedSection


class Drawing(NamedTuple):
    """Settings for the pages of the report.

    Attributes
    ----------
    alone : true for a report with all pages of a single mooring, false for one page per mooring
    full : whether each of several moorings also gets a separate PDF with all its pages
    """

    alone: bool = True
    full: bool = False
    page_size: str = "a4"


class DrawnSection(NamedTuple):
    """Section of the report for one mooring.

    The section has the row of the summary, the HTML and PDF pages and, if requested, a separate PDF
    with all pages of the mooring.
    """

    section: CheckedSection
    html: str
    pdf: str
    full: bytes | None = None


class CheckedMooring(NamedTuple):
    """Assessment of a mooring, and its section of the report (None without a report)."""

    assessment: Assessment
    drawn: DrawnSection | None


def drawn_section(
    assessment: Assessment, number: int, drawing: Drawing, against: Comparison | None = None
) -> DrawnSection:
    """Draw section `number` of a report for HTML and PDF.

    `against` is the comparison of the mooring with its earlier design.
    """
    from calm.report.check_report import check_report, mooring_section, short_section
    from calm.report.folder import pdf_leaf, printed
    from calm.report.html import leaf

    full = None
    if drawing.alone or drawing.full:
        section = mooring_section(assessment, against, drawing.page_size)
    if drawing.full:
        full = printed(check_report([section]), drawing.page_size)
    if not drawing.alone:
        section = short_section(assessment)
    bare = replace(section, parts=())
    return DrawnSection(bare, leaf(section, number), pdf_leaf(section), full)


def judge(
    designs: Sequence[DesignFile],
    workers: int | None,
    drawn: Drawing | None,
    draws: tuple[int, int] | None,
) -> list[CheckedMooring]:
    """Check designs against the design rules.

    A finding counts as accepted only if its acceptance is valid on the day of the report. With many
    moorings, each process checks whole moorings. With few moorings, the processes share the
    environments of a mooring.

    Parameters
    ----------
    workers : number of processes; None for one on each core
    drawn : settings for the report, if requested
    draws : number of samples and seed for the probabilities, if requested
    """
    from calm.report.provenance import moment

    day = (moment() or datetime.now()).date()
    tasks = [(design.name, mooring, day) for design in designs for mooring in design.moorings]
    load_ahead(len(tasks), drawn is not None)
    if len(designs) > progress.FEW:
        whole = [(number, design, day, drawn, draws) for number, design in enumerate(designs, 1)]
        return progress.mapped(_solve_and_conclude, whole, workers, "moorings judged")
    solved = iter(progress.mapped(_solved_cases, tasks, workers, "environments solved"))
    shared = partial(progress.mapped, workers=workers, what="blocks of samples solved")
    found = ([case for _ in design.moorings for case in next(solved)] for design in designs)
    return [
        _concluded(number, design.name, tasks, day, drawn, draws, shared)
        for number, (design, tasks) in enumerate(zip(designs, found, strict=True), 1)
    ]


def load_ahead(environments: int, drawn: bool) -> None:
    """Import the modules that the checks need, before processes are forked.

    If there are enough `environments` to solve, the compiled solver is loaded, too.
    """
    import calm.checks.assess
    import calm.checks.recovery
    from calm.checks.situations import SOLVES
    from calm.solve import expect_many, load_line_solver

    expect_many(SOLVES * environments)
    load_line_solver()
    if drawn:
        import calm.report.check_report  # noqa: F401  (loaded before processes are forked)
        from calm.drawing.typesetting import signs
        from calm.report.html import read_templates

        read_templates()
        signs()  # reads the font


def _solve_and_conclude(
    task: tuple[int, DesignFile, date, Drawing | None, tuple[int, int] | None],
) -> CheckedMooring:
    number, design, day, drawn, draws = task
    cases = [each for one in design.moorings for each in _solved_cases((design.name, one, day))]
    return _concluded(number, design.name, cases, day, drawn, draws, map)


def _concluded(
    number: int,
    name: str,
    cases: Sequence[MooringInEnvironment],
    day: date,
    drawn: Drawing | None,
    draws: tuple[int, int] | None,
    shared: uncertain.Mapped,
) -> CheckedMooring:
    """Assess a mooring from its solutions in all environments, and draw its report section.

    `cases` are these solutions, and `number` is the number of the section. `draws` are the number
    of samples and the seed. `shared` distributes blocks of samples over processes.
    """
    from calm.checks import assess, design_check

    assessment = design_check.assessment_of(name, cases, day)
    if draws is not None:
        assessment = assess.with_probabilities(assessment, *draws, shared)
    return CheckedMooring(
        assessment, None if drawn is None else drawn_section(assessment, number, drawn)
    )


def _solved_cases(task: tuple[str, Design, date]) -> list[MooringInEnvironment]:
    from calm.checks.design_check import environments_checked, failed_environment

    name, mooring, day = task
    try:
        return environments_checked(mooring, name, day)
    except Exception as error:
        # an internal error becomes a failed case, so that the other cases continue
        if os.environ.get("CALM_DEBUG") == "1":
            raise
        return [failed_environment(mooring, name, internal_failure(error))]
