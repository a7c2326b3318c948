"""``calm check``: judge moorings in all their environments."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

from cyclopts import Parameter

from calm.cli.exit_codes import ExitCode, gravest
from calm.cli.outputs import OutputPath, Outputs
from calm.cli.streams import narrate
from calm.cli.workers import mapped
from calm.errors import InputError, Problem, UsageError

if TYPE_CHECKING:
    from calm.case import Mooring, Tow
    from calm.checks.assessment import Assessment, Stand
    from calm.report.section import Section

CHECK_EXAMPLES = """Examples:

  calm check mooring.yaml
  calm check mooring.yaml --environment storm.yaml --environment neap.yaml
  calm check north.yaml south.yaml --report cruise/
  calm check mooring.yaml --json - | jq '.findings[] | select(.state == "fail")'"""


def check(
    files: list[Path],
    /,
    *,
    environment: list[str] | None = None,
    catalog: list[Path] | None = None,
    json: OutputPath = None,
    report: Path | None = None,
    workers: Annotated[int | None, Parameter(name="--workers")] = None,
) -> ExitCode:
    """Check designs: solve every mooring in every environment, and judge it by rule.

    Each mooring is solved as given, in still water, and where its file asks for
    it at high and low water, with growth on its cables, and with cables that
    strum; then let go anchor last, released, and parted at each connection. The
    exit code is 1 when a rule fails, 3 when a mooring has no equilibrium.

    Parameters
    ----------
    files
        Mooring files.
    environment
        An environment named in the files, or an environment file. Repeatable; without
        it, each file's own environment and all that it names.
    catalog
        A catalogue of your own; its components hide others of the same id. Repeatable.
    json
        Write every finding as JSON, - to print it.
    report
        Write report.html, report.pdf, report.json, checks.csv and inventory.csv in this folder.
    workers
        How many processes share the work; one on each core unless said.
    """
    outputs = Outputs(tuple(files), json)
    outputs.check()
    if workers is not None and workers < 1:
        raise UsageError(f"--workers: {workers} is not 1 or more")
    if report is not None:
        from calm.report.folder import check_folder

        check_folder(report)
    moorings = _read(files, environment, catalog or [], workers)
    stands = mapped(_stand, _tasks(moorings), workers, "moorings solved")
    judged = _assessed(stands, workers, drawn=report is not None)
    assessments = [each.assessment for each in judged]
    for each in moorings:
        for notice in dict.fromkeys(n for one in each.stands for n in one.file.notices):
            narrate(f"{each.path}: {notice}")
    _show(assessments, outputs)
    if report is not None:
        _write(report, judged)
    return gravest(code for each in assessments for code in _codes(each))


@dataclass(frozen=True)
class _Read:
    """A mooring file, read in each of its environments."""

    path: Path
    name: str
    stands: tuple[Mooring, ...]


@dataclass(frozen=True)
class _Judged:
    """An assessment, and its part of the report where there is to be one."""

    assessment: Assessment
    section: Section | None


def _read(
    files: Sequence[Path],
    environments: Sequence[str] | None,
    catalogs: Sequence[Path],
    workers: int | None,
) -> list[_Read]:
    """Every mooring in every environment, or an error with the mistakes of all of them."""
    given = Counter([*map(str, files), *(environments or ())])
    twice = [word for word, count in given.items() if count > 1]
    if twice:
        raise UsageError(f"given twice: {', '.join(twice)}")
    names: Sequence[str | None] = environments or [None]
    asked = [(file, name) for file in files for name in names]
    read = _loaded(asked, catalogs, workers)
    if environments is None:
        others = [(file, name) for file in files for name in read[file, None].file.variants]
        read |= _loaded(others, catalogs, workers)
    stands = {file: [one for (path, _), one in read.items() if path == file] for file in files}
    for its in stands.values():
        _refuse_one_name(its)
    called = Counter(its[0].file.name for its in stands.values())
    return [
        _Read(path, name if called[name] == 1 else f"{name} ({path})", tuple(its))
        for path, its in stands.items()
        for name in [its[0].file.name]
    ]


def _loaded(
    asked: Sequence[tuple[Path, str | None]], catalogs: Sequence[Path], workers: int | None
) -> dict[tuple[Path, str | None], Mooring]:
    from calm.case import Mooring

    tasks = [(file, name, catalogs) for file, name in asked]
    problems: dict[Problem, None] = {}
    moorings = {}
    for (file, name), read in zip(asked, mapped(_load, tasks, workers, "files read"), strict=True):
        if isinstance(read, tuple):
            problems |= dict.fromkeys(read)  # what files share has its mistakes told once
        elif isinstance(read, Mooring):
            moorings[file, name] = read
        else:
            raise UsageError(f"calm check is for moorings; {file} is a tow")
    if problems:
        raise InputError(list(problems))
    return moorings


def _load(
    task: tuple[Path, str | None, Sequence[Path]],
) -> Mooring | Tow | tuple[Problem, ...]:
    """What was read, or what is wrong with it."""
    import calm

    file, environment, catalogs = task
    try:
        return calm.load(file, environment=environment, catalogs=catalogs)
    except InputError as error:
        return error.problems


def _refuse_one_name(moorings: Sequence[Mooring]) -> None:
    """Two environments of one name could not be told apart."""
    names = Counter(mooring.file.environment.name for mooring in moorings)
    for name, count in names.items():
        if count > 1:
            raise UsageError(f"{count} environments are called {name}; give them other names")


def _tasks(moorings: Sequence[_Read]) -> list[tuple[str, Mooring]]:
    return [(each.name, mooring) for each in moorings for mooring in each.stands]


def _stand(task: tuple[str, Mooring]) -> tuple[str, Stand]:
    from calm.checks.assess import stand_of

    name, mooring = task
    return name, stand_of(mooring, name)


def _assessed(
    stands: Sequence[tuple[str, Stand]], workers: int | None, *, drawn: bool
) -> list[_Judged]:
    """The stands of each mooring together, with its part of the report where that is drawn."""
    together: dict[str, list[Stand]] = {}
    for name, stand in stands:
        together.setdefault(name, []).append(stand)
    tasks = [(name, tuple(its)) for name, its in together.items()]
    return mapped(_drawn if drawn else _judged, tasks, workers, "moorings judged")


def _judged(task: tuple[str, tuple[Stand, ...]]) -> _Judged:
    from calm.checks.assess import assessment_of

    return _Judged(assessment_of(*task), None)


def _drawn(task: tuple[str, tuple[Stand, ...]]) -> _Judged:
    from calm.report.check_section import mooring_section

    assessment = _judged(task).assessment
    return _Judged(assessment, mooring_section(assessment))


def _show(assessments: Sequence[Assessment], outputs: Outputs) -> None:
    from calm.report.check_document import check_document
    from calm.report.check_table import check_table

    outputs.write_answer(check_document(assessments), check_table(assessments))


def _write(folder: Path, judged: Sequence[_Judged]) -> None:
    from calm.report.check_csv import checks_csv, inventory_csv
    from calm.report.check_document import check_document
    from calm.report.document import to_json
    from calm.report.folder import write_report
    from calm.report.html import report_html
    from calm.report.pdf import report_pdf

    assessments = [each.assessment for each in judged]
    sections = [each.section for each in judged if each.section is not None]
    texts = {
        "report.html": report_html(sections),
        "report.json": to_json([check_document(assessments)]),
        "checks.csv": checks_csv(assessments),
        "inventory.csv": inventory_csv(assessments),
    }
    files = {name: text.encode("utf-8", "replace") for name, text in texts.items()}
    write_report(folder, files | {"report.pdf": report_pdf(sections)})
    narrate(f"the report is in {folder}")


def _codes(assessment: Assessment) -> list[ExitCode]:
    from calm.checks.finding import State

    codes = [ExitCode.NO_EQUILIBRIUM for stand in assessment.stands if stand.result is None]
    if any(finding.state is State.FAIL for finding in assessment.all_findings()):
        codes.append(ExitCode.FINDING)
    return codes
