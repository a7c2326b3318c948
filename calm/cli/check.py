"""``calm check``: judge moorings in all their environments."""

from __future__ import annotations

import os
from collections.abc import Callable, Sequence
from dataclasses import replace
from datetime import date, datetime
from functools import cache, partial
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

from calm.cli import options, progress, run
from calm.cli.outputs import ExitCode, OutputPath, Outputs, gravest, narrate
from calm.cli.reading import DesignFile, read_designs
from calm.errors import InputError, Problem, UsageError, internal_failure

if TYPE_CHECKING:
    from calm.case import Mooring, uncertain
    from calm.case.net import Net
    from calm.checks.assessment import Assessment, MooringInEnvironment
    from calm.report.blocks import Section


def check(
    files: options.MooringPaths,
    /,
    *,
    environment: list[str] | None = None,
    catalog: options.CatalogFiles = None,
    json: OutputPath = None,
    report: Path | None = None,
    against: Path | None = None,
    allow_unknown: bool = False,
    uncertainty: bool = False,
    samples: options.Samples = 2048,
    seed: options.Seed = 0,
    workers: int | None = None,
    units: options.Units = None,
) -> ExitCode:
    """Check designs: solve every mooring in every environment, and judge it by rule.

    Each mooring is solved as given, in still water, with cables that strum and,
    where its file asks for it, at high and low water and with growth; then launched
    anchor last, released, and broken at each connection. The exit code is 0 when
    every finding is a pass, a warning or accepted, 1 when a rule fails or lacks a
    figure, 3 when a mooring has no equilibrium.

    Parameters
    ----------
    environment
        An environment named in the files, or an environment file. Repeatable. By default, every
        environment of each file.
    json
        Write every finding as JSON, - to print it.
    report
        Write report.html, report.pdf, report.json, checks.csv and inventory.csv in this folder.
    against
        An earlier design, with which the report compares the mooring; needs --report.
    allow_unknown
        Ignore unknown figures in the exit code; the output stays the same.
    uncertainty
        Give every finding the probability of breaking its limit, with inputs as
        uncertain as `uncertainty` in the file says, and list the designs by it.
    workers
        Number of processes; by default one for each core.

    Examples
    --------
      calm check mooring.yaml
      calm check mooring.yaml --environment storm.yaml --environment neap.yaml
      calm check north.yaml south.yaml --report cruise/
      calm check revised.yaml --report cruise/ --against design.yaml
      calm check mooring.yaml --uncertainty --samples 512
      calm check mooring.yaml --json - | jq '.findings[] | select(.state == "fail")'
    """
    outputs = Outputs(tuple(files), json)
    options.from_one(workers=workers)
    if against is not None and (report is None or len(files) > 1):
        raise UsageError("--against compares one mooring with an earlier design in its --report")
    draws = run.draws_of(uncertainty, samples, seed)
    if report is not None:
        given = [*files, *map(Path, environment or ()), *(catalog or ()), *filter(None, [against])]
        _check_report(report, json, given)
    drawn = report is not None and against is None  # one that is compared is drawn with that
    count = len(files) * len(environment or [None])
    ready = partial(_ready, count, drawn)
    designs, tows, earlier = _read(files, environment, catalog or [], workers, against, ready)
    if tows:
        narrate(f"not checked, because they are tows: {', '.join(map(str, tows))}")
    nets = [design.path for design in designs if design.moorings[0].file.legs]
    if nets and uncertainty:
        from calm.files.legs import NET_SURE

        raise UsageError(f"--uncertainty is for {NET_SURE}: {nets[0]}")
    options.show_units(units, [one.file for design in designs for one in design.moorings])
    judged = _judged(designs, workers, drawn, draws)
    assessments = [each.assessment for each in judged]
    for design, assessment in zip(designs, assessments, strict=True):
        of_files = (notice for one in design.moorings for notice in one.file.notices)
        for notice in dict.fromkeys((*of_files, *assessment.notices)):
            narrate(f"{design.path}: {notice}")
    drawings = [each.drawn for each in judged if each.drawn is not None]
    if earlier is not None:
        from calm.checks.comparison import comparison_of
        from calm.report.check_report import mooring_section

        names = str(against), str(designs[0].path)
        compared = comparison_of(names, earlier, designs[0].moorings[0])
        drawings = [_drawn(mooring_section(assessments[0], compared), 1)]
    _answer(assessments, drawings, outputs, report)
    return gravest(_code(each, allow_unknown) for each in assessments)


def _read(
    files: Sequence[Path],
    environments: Sequence[str] | None,
    catalogs: Sequence[Path],
    workers: int | None,
    against: Path | None,
    ready: Callable[[], None],
) -> tuple[list[DesignFile], list[Path], Mooring | Net | None]:
    """Return what is judged, the tows among the files, and the earlier design; or all their
    mistakes.

    `ready` is called while other processes read.
    """
    from calm.case import Tow, net

    problems: list[Problem] = []
    earlier: Mooring | Tow | Net | None = None
    designs: list[DesignFile] = []
    tows: list[Path] = []
    try:
        designs, tows = read_designs(files, environments, catalogs, workers, meanwhile=ready)
    except InputError as error:
        problems += error.problems
    try:
        first = environments[0] if environments else None
        earlier = None if against is None else net.load(against, first, catalogs)
    except InputError as error:
        problems += error.problems
    if problems:
        raise InputError(list(dict.fromkeys(problems)))
    if isinstance(earlier, Tow):
        raise UsageError(f"{against} is a tow; calm check is for moorings")
    return designs, tows, earlier


class DrawnSection(NamedTuple):
    """A mooring's part of the report: what a summary takes of it, and what each form shows."""

    section: Section
    html: str
    pdf: str


class CheckedMooring(NamedTuple):
    """A mooring that is judged, and its part of the report where there is one."""

    assessment: Assessment
    drawn: DrawnSection | None


def _drawn(section: Section, number: int) -> DrawnSection:
    """The `number`th section of a report."""
    from calm.report.folder import pdf_leaf
    from calm.report.html import leaf

    return DrawnSection(replace(section, parts=()), leaf(section, number), pdf_leaf(section))


def _check_report(folder: Path, json: Path | None, given: Sequence[Path]) -> None:
    """Refuse a report that could not be written, before anything is solved."""
    from calm.report.folder import REPORT_FILES, check_folder
    from calm.report.provenance import moment

    check_folder(folder)
    moment()
    for name in REPORT_FILES:
        real = os.path.realpath(folder / name)
        if json is not None and os.path.realpath(json) == real:
            raise UsageError(f"two outputs would go to {json}")
        for path in given:
            if os.path.realpath(path) == real:
                raise UsageError(f"{path} is read here; the report would overwrite it")


def _judged(
    designs: Sequence[DesignFile], workers: int | None, drawn: bool, draws: tuple[int, int] | None
) -> list[CheckedMooring]:
    """All of them on one day: that of the report, today where it has none.

    Many moorings are shared out whole, each judged and drawn where it was solved; of a few, their
    environments are.
    """
    from calm.checks.situations import SOLVES
    from calm.report.provenance import moment
    from calm.solve import expect_many

    day = (moment() or datetime.now()).date()
    stands = [(design.name, mooring, day) for design in designs for mooring in design.moorings]
    expect_many(SOLVES * len(stands))
    if len(designs) > progress.FEW:
        _ready(len(stands), drawn)
        whole = [(number, design, day, drawn, draws) for number, design in enumerate(designs, 1)]
        return progress.mapped(_solve_and_conclude, whole, workers, "moorings judged")
    solved = iter(progress.mapped(_stands, stands, workers, "environments solved"))
    shared = partial(progress.mapped, workers=workers, what="blocks of samples solved")
    found = ([stand for _ in design.moorings for stand in next(solved)] for design in designs)
    return [
        _concluded(number, design.name, stands, day, drawn, draws, shared)
        for number, (design, stands) in enumerate(zip(designs, found, strict=True), 1)
    ]


def _ready(stands: int, drawn: bool) -> None:
    """Load what judging so many takes, once: other processes begin as copies of this one.

    The march is fetched, but not compiled before the files are found good.
    """
    import calm.checks.assess
    import calm.checks.recovery
    from calm.checks.situations import SOLVES
    from calm.solve.solution import COLD, expect_many

    expect_many(min(SOLVES * stands, COLD - 1))
    if drawn:
        import calm.report.check_report
        import calm.report.html  # noqa: F401
        from calm.drawing.typesetting import signs

        signs()  # has the font read


def _solve_and_conclude(
    task: tuple[int, DesignFile, date, bool, tuple[int, int] | None],
) -> CheckedMooring:
    number, design, day, drawn, draws = task
    stands = [each for one in design.moorings for each in _stands((design.name, one, day))]
    return _concluded(number, design.name, stands, day, drawn, draws, map)


def _concluded(
    number: int,
    name: str,
    stands: Sequence[MooringInEnvironment],
    day: date,
    drawn: bool,
    draws: tuple[int, int] | None,
    shared: uncertain.Mapped,
) -> CheckedMooring:
    """Return what is judged of a mooring as a whole, and the `number`th section of the report.

    `draws` are samples and seed of the probabilities, where they are asked for; `shared` has blocks
    of them solved.
    """
    from calm.checks import assess, net_check
    from calm.report.check_report import mooring_section

    if stands[0].mooring.file.legs:
        assessment = net_check.assessment_of_net(name, stands, day)
    else:
        assessment = assess.assessment_of(name, stands, day)
    if draws is not None:
        assessment = assess.with_probabilities(assessment, *draws, shared)
    return CheckedMooring(
        assessment, _drawn(mooring_section(assessment), number) if drawn else None
    )


def _stands(task: tuple[str, Mooring | Net, date]) -> list[MooringInEnvironment]:
    """A mooring in an environment, or each leg of a net; CALM's own failure there does not stop
    the others.
    """
    from calm.case.net import Net
    from calm.checks.assess import failed_stand, stand_of
    from calm.checks.net_check import stands_of_net

    name, mooring, day = task
    try:
        if isinstance(mooring, Net):
            return stands_of_net(mooring, name, day)
        return [stand_of(mooring, name, day)]
    except Exception as error:
        if os.environ.get("CALM_DEBUG") == "1":
            raise
        of = mooring.lines[0] if isinstance(mooring, Net) else mooring
        return [failed_stand(of, name, internal_failure(error))]


def _answer(
    assessments: Sequence[Assessment],
    drawings: Sequence[DrawnSection],
    outputs: Outputs,
    folder: Path | None,
) -> None:
    """Print what was found, and write the report if it is asked for.

    Its PDF is set meanwhile: typst does not hold Python up.
    """
    from concurrent.futures import ThreadPoolExecutor

    from calm.report import result_files
    from calm.report.check_report import check_document, check_part, checks_csv, inventory_csv
    from calm.report.folder import write_report

    document = cache(lambda: check_document(assessments))
    if folder is None:
        outputs.write_answer(document, check_part(assessments))
        return
    from calm.report.check_report import check_report
    from calm.report.folder import printed
    from calm.report.html import page

    report = check_report([each.section for each in drawings])
    with ThreadPoolExecutor(1) as beside:
        pdf = beside.submit(printed, report, leaves=[each.pdf for each in drawings])
        outputs.write_answer(document, check_part(assessments))
        texts = {
            "report.html": page(report, [each.html for each in drawings]),
            "report.json": result_files.to_json([document()]),
            "checks.csv": checks_csv(assessments),
            "inventory.csv": inventory_csv(assessments),
        }
        files = {name: text.encode("utf-8", "replace") for name, text in texts.items()}
        write_report(folder, files | {"report.pdf": pdf.result()})
    narrate(f"the report is in {folder}")


def _code(assessment: Assessment, allow_unknown: bool) -> ExitCode:
    from calm.checks.finding import State

    if any(stand.result is None for stand in assessment.stands):
        return ExitCode.NO_EQUILIBRIUM
    passes = {State.PASS, State.ESTIMATED, State.WARN} | (
        {State.UNKNOWN} if allow_unknown else set()
    )
    return ExitCode.DONE if assessment.state in passes else ExitCode.FINDING
