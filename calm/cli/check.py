"""``calm check``: check moorings in all their environments."""

from __future__ import annotations

import os
from collections.abc import Callable, Sequence
from functools import cache, partial
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Literal

from cyclopts import Parameter

from calm.cli import options
from calm.cli.judging import Drawing, DrawnSection, drawn_section, judge, load_ahead
from calm.cli.outputs import ExitCode, OutputPath, Outputs, gravest, narrate, save, show
from calm.cli.reading import DesignFile, names_of_files, read_designs
from calm.errors import InputError, Problem, UsageError

if TYPE_CHECKING:
    from calm.case import Design
    from calm.checks.assessment import Assessment


def check(
    files: options.MooringPaths,
    /,
    *,
    environment: list[str] | None = None,
    catalog: options.CatalogFiles = None,
    json: OutputPath = None,
    report: Path | None = None,
    page: Literal["a4", "letter"] = "a4",
    full: bool = False,
    against: Path | None = None,
    all_findings: bool = False,
    missing: bool = False,
    output: Annotated[Path | None, Parameter(alias="-o")] = None,
    allow_unknown: bool = False,
    uncertainty: bool = False,
    samples: options.Samples = 2048,
    workers: int | None = None,
    units: options.Units = None,
) -> ExitCode:
    """Check designs: solve each mooring in each environment and apply the design
    rules.

    Each mooring is solved three times: as given, in still water, and with strumming
    cables. If the file has a tidal range, the mooring is also solved at high and
    low water; if the file has biofouling, it is also solved with biofouling. CALM also
    simulates an anchor-last deployment, the release, and a break at each
    connection. The exit code is 1 if a check fails or if a value that it needs is
    missing, 3 if a mooring has no equilibrium, and 0 otherwise.

    Parameters
    ----------
    environment
        Environment to check: a name from the files, or an environment file. Repeatable. By default,
        every environment of each file is checked.
    json
        Write the findings as JSON (- for standard output): the governing finding of each rule, all
        findings that do not pass, and those with a utilisation of at least one half.
    report
        Write report.html, report.pdf, report.json, checks.csv and inventory.csv in this folder. The
        report of one mooring has at least five pages; the report of several moorings has a matrix
        of all moorings and a page for each.
    page
        Page size of the report.
    full
        For several moorings, also write all pages of each mooring as a separate PDF file.
    against
        Mooring file of an earlier design, with which the report compares the mooring. Requires
        --report.
    all_findings
        Write all findings, for every piece and situation, to the JSON file and to checks.csv.
    missing
        Instead of the findings, print a YAML block in which you can fill in the missing values. The
        block lists these values for each component, and the rules that need them. Estimated values
        and masses in air are given as comments.
    output
        Write the block of --missing to this file.
    allow_unknown
        Ignore unknown findings in the exit code; the output stays the same.
    uncertainty
        Report for each finding the probability that the limit is exceeded, given the input
        uncertainties under `uncertainty` in the file, and rank the designs by this probability.
    workers
        Number of processes; one per core by default.

    Examples
    --------
      calm check mooring.yaml
      calm check mooring.yaml --environment storm.yaml --environment neap.yaml
      calm check north.yaml south.yaml --report cruise/
      calm check revised.yaml --report cruise/ --against design.yaml
      calm check mooring.yaml --missing -o figures.yaml
      calm check mooring.yaml --uncertainty --samples 512
      calm check mooring.yaml --json - | jq '.findings[] | select(.state == "fail")'
    """
    outputs = Outputs(tuple(files), json)
    options.from_one(workers=workers)
    if full and report is None:
        raise UsageError("--full needs --report")
    if against is not None and (report is None or len(files) > 1):
        raise UsageError(
            "--against needs --report and exactly one mooring to compare with the earlier design"
        )
    _check_missing(missing, output, files, (json, report))
    draws = options.draws_of(uncertainty, samples)
    if report is not None:
        given = [*files, *map(Path, environment or ()), *(catalog or ()), *filter(None, [against])]
        _check_report(report, json, given)
    drawing = Drawing(len(files) == 1, full and len(files) > 1, page)
    # a comparison is part of the section, so it is drawn here
    drawn = drawing if report is not None and against is None else None
    count = len(files) * len(environment or [None])
    ready = partial(load_ahead, count, drawn is not None)
    designs, tows, earlier = _read(files, environment, catalog or [], workers, against, ready)
    if tows:
        narrate(f"tows are not checked: {', '.join(map(str, tows))}")
    nets = [design.path for design in designs if design.moorings[0].several]
    if nets and uncertainty:
        from calm.files.legs import NET_SURE

        raise UsageError(f"--uncertainty is only for {NET_SURE}: {nets[0]}")
    own = names_of_files(designs, report, ["report"]) if drawing.full and report else []
    options.show_units(units, [one.file for design in designs for one in design.moorings])
    judged = judge(designs, workers, drawn, draws)
    assessments = [each.assessment for each in judged]
    for design, assessment in zip(designs, assessments, strict=True):
        of_files = (notice for one in design.moorings for notice in one.file.notices)
        found = {finding.message for finding in assessment.all_findings()}
        for notice in dict.fromkeys((*of_files, *assessment.notices)):
            if notice not in found:
                narrate(f"{design.path}: {notice}")
    drawings = [each.drawn for each in judged if each.drawn is not None]
    if earlier is not None:
        from calm.checks.comparison import comparison_of

        names = str(against), str(designs[0].path)
        compared = comparison_of(names, earlier, designs[0].moorings[0])
        drawings = [drawn_section(assessments[0], 1, drawing, compared)]
    if missing:
        _write_missing(assessments, [design.path for design in designs], output)
    else:
        _answer(assessments, drawings, outputs, report, page, own, every=all_findings)
    return gravest(_code(each, allow_unknown) for each in assessments)


def _read(
    files: Sequence[Path],
    environments: Sequence[str] | None,
    catalogs: Sequence[Path],
    workers: int | None,
    against: Path | None,
    ready: Callable[[], None],
) -> tuple[list[DesignFile], list[Path], Design | None]:
    """Read the designs and the earlier design, and separate the files that are tows.

    `ready` is called while other processes read.
    """
    from calm.case import load
    from calm.files.mooring_file import refuse_tow

    problems: list[Problem] = []
    earlier: Design | None = None
    designs: list[DesignFile] = []
    tows: list[Path] = []
    try:
        designs, tows = read_designs(files, environments, catalogs, workers, meanwhile=ready)
    except InputError as error:
        problems += error.problems
    try:
        first = environments[0] if environments else None
        earlier = None if against is None else load(against, first, catalogs)
    except InputError as error:
        problems += error.problems
    if problems:
        raise InputError(list(dict.fromkeys(problems)))
    if earlier is not None:
        refuse_tow(earlier.file)
    return designs, tows, earlier


def _check_report(folder: Path, json: Path | None, given: Sequence[Path]) -> None:
    from calm.report.folder import REPORT_FILES, check_folder
    from calm.report.provenance import moment

    check_folder(folder)
    moment()
    for name in REPORT_FILES:
        real = os.path.realpath(folder / name)
        if json is not None and os.path.realpath(json) == real:
            raise UsageError(f"two outputs have the same path, {json}")
        for path in given:
            if os.path.realpath(path) == real:
                raise UsageError(f"{path} is an input file; the report would overwrite it")


def _check_missing(
    missing: bool, output: Path | None, files: Sequence[Path], other: Sequence[Path | None]
) -> None:
    if output is not None and not missing:
        raise UsageError(
            "-o can only be used with --missing; to write the findings, use --json or --report"
        )
    if missing and any(other):
        raise UsageError(
            "--missing replaces the findings and cannot be combined with other outputs"
        )
    if output is not None:
        from calm.report.folder import check_destination

        check_destination(output)
        if os.path.realpath(output) in map(os.path.realpath, files):
            raise UsageError(f"{output} is the input file; choose another output")


def _write_missing(
    assessments: Sequence[Assessment], paths: Sequence[Path], output: Path | None
) -> None:
    from calm.report.missing_block import definition_places, missing_block

    found = [one for each in assessments for one in each.all_findings()]
    for message in dict.fromkeys(one.message for one in found if one.rule == "equilibrium"):
        narrate(message)
    parts = [one for each in assessments for one in each.inventory]
    block = missing_block(found, definition_places(paths), parts)
    if output is None:
        show(block)
    else:
        only_comments = all(line.startswith("#") for line in block.splitlines())
        save(output, block.encode(), "; it contains only comments" * only_comments)


def _answer(
    assessments: Sequence[Assessment],
    drawings: Sequence[DrawnSection],
    outputs: Outputs,
    folder: Path | None,
    page_size: str,
    names: Sequence[str],
    *,
    every: bool,
) -> None:
    """Print the findings, and write the report if requested.

    `names` are the names of the separate PDF files of the moorings, if requested.
    """
    from concurrent.futures import ThreadPoolExecutor

    from calm.report import result_files
    from calm.report.check_files import check_document, checks_csv, inventory_csv
    from calm.report.check_summary import check_part
    from calm.report.folder import write_report

    document = cache(lambda: check_document(assessments, every=every))
    if folder is None:
        outputs.write_answer(document, check_part(assessments))
        return
    from calm.report.check_report import check_report
    from calm.report.folder import printed
    from calm.report.html import page

    report = check_report([each.section for each in drawings])
    with ThreadPoolExecutor(1) as pool:
        # typst releases the interpreter lock, so the PDF is typeset at the same time
        pdf = pool.submit(printed, report, page_size, leaves=[each.pdf for each in drawings])
        outputs.write_answer(document, check_part(assessments))
        texts = {
            "report.html": page(report, [each.html for each in drawings]),
            "report.json": result_files.to_json([document()]),
            "checks.csv": checks_csv(assessments, every=every),
            "inventory.csv": inventory_csv(assessments),
        }
        files = {name: text.encode("utf-8", "replace") for name, text in texts.items()}
        own = {
            f"{name}.pdf": each.full
            for name, each in zip(names, drawings, strict=bool(names))
            if each.full is not None
        }
        write_report(folder, files | {"report.pdf": pdf.result()} | own)
    narrate(f"Report written to {folder}")


def _code(assessment: Assessment, allow_unknown: bool) -> ExitCode:
    from calm.checks.finding import Conclusion

    if any(checked.result is None for checked in assessment.in_environments):
        return ExitCode.NO_EQUILIBRIUM
    stops = {Conclusion.FAILS} | ({Conclusion.INCOMPLETE} if not allow_unknown else set())
    return ExitCode.FINDING if assessment.verdict in stops else ExitCode.DONE
