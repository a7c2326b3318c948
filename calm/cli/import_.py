"""``calm import``: convert designs of other programs to mooring files."""

from __future__ import annotations

import os
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

from cyclopts import Parameter

from calm.cli import options
from calm.cli.outputs import STDOUT, ExitCode, OutputPath, narrate, narrate_card, save, show
from calm.errors import InputError, Problem, UsageError

if TYPE_CHECKING:
    from calm.exchange.importing import Imported


def import_(
    *files: Path,
    output: options.OutputFile,
    format: str | None = None,
    strict: bool = False,
    define: Annotated[list[str] | None, Parameter(name=["--define", "-D"])] = None,
    environment: Path | None = None,
    onto: Path | None = None,
    columns: str | None = None,
    sheet: str | None = None,
    elements: Path | None = None,
    match_catalogue: bool = False,
    allow_include: bool = False,
    json: OutputPath = None,
) -> ExitCode:
    """Convert designs of other programs to mooring files.

    The program is recognised from the content of the file. Values
    that the file lacks are guessed. Guesses and omissions are reported, and marked
    with comments in the mooring file. If CALM cannot represent a design, the
    reason is reported and nothing is written.

    Parameters
    ----------
    files
        Files of other programs to convert.
    output
        Mooring file to write; for several files, a folder.
    format
        Program or format of the file: mdd, cbl, moordyn, oceanarray, moords or table. By default it
        is recognised from the content.
    strict
        Reject files with missing values that CALM would have to guess.
    define
        For WHOI Cable files: set a macro, NAME=VALUE. For oceanarray files: set the catalogue id of
        a name, "NAME=ID". Repeatable.
    environment
        Use this environment file instead of the environment in the imported file.
    onto
        A mooring file to whose line the instruments in FILE are assigned. FILE is then a list of
        instruments with serial number, name, nominal depth and clock offset (CSV, RODB's info.dat,
        oceanarray, or NetCDF), and OUTPUT is a copy of the mooring file with the serial numbers in
        `deployed:`.
    columns
        Headings of the columns of a table, each as KEY=HEADING, such as name=Item,length=Len.
    sheet
        Name of the sheet in a workbook; needed if several sheets have headings.
    elements
        Library of elements, which supplies values that a list or oceanarray lacks: the mdcodes.mat
        of Mooring Design & Dynamics, the table of moords, or a workbook.
    match_catalogue
        Use catalogue entries for components with the same name and values.
    allow_include
        Allow a file to include files from outside its own folder.
    json
        Write guesses and omissions as JSON (- for standard output).

    Examples
    --------
      calm import moor001.mat -o moor001.yaml
      calm import *.cbl -o moorings/ --environment site.yaml
      calm import snare.cbl -o snare.yaml -D DEPTH=1200 --strict
      calm import info.dat --onto mooring.yaml -o deployed.yaml
      calm import list.csv -o list.yaml --columns name=Item,length=Len --environment site.yaml
    """
    from calm.exchange.current_record import record_file
    from calm.exchange.importing import import_file
    from calm.exchange.model import ImportOptions
    from calm.report import folder, result_files

    if not files:
        raise UsageError("no file to import was given; name one or more files")
    if onto is not None:
        if len(files) > 1:
            raise UsageError("--onto can be used with only one list of instruments")
        return _assign(files[0], onto, output, json)
    headings = _pairs("--columns", columns.split(",") if columns else [])
    given = ImportOptions(
        _pairs("--define", define or []), headings, elements, allow_include, sheet
    )
    targets = _targets(files, output)
    if json is not None and json != STDOUT:
        folder.check_destination(json)
    done: list[tuple[Imported, Path]] = []
    problems: list[Problem] = []
    for file, target in zip(files, targets, strict=True):
        try:
            imported = import_file(
                file, target, format=format, environment=environment, options=given,
                match_catalogue=match_catalogue,
            )  # fmt: skip
        except InputError as error:
            problems += error.problems
            continue
        if strict:
            problems += [
                Problem(str(file), 0, 0, f"--strict: a value would be guessed: {each}")
                for each in imported.guessed
            ]
        done.append((imported, target))
    if problems:
        raise InputError(problems)
    if _is_folder(files, output):
        output.mkdir(parents=True, exist_ok=True)
    for imported, target in done:
        record = _record_of(target) if imported.record is not None else None
        if record is not None and imported.record is not None:
            then = f"; solve it with: calm batch {target} --currents {record} -o …"
            save(record, record_file(imported.record, imported.file.name), then)
        _tell(imported, record)
        content = imported.text.encode("utf-8", "replace")
        save(target, content, f"; solve it with: calm run {target}")
    if json is not None:
        text = result_files.to_json([_document(imported, target) for imported, target in done])
        show(text) if json == STDOUT else save(json, text.encode())
    return ExitCode.DONE


def _assign(file: Path, onto: Path, output: Path, json: Path | None) -> ExitCode:
    from calm.motion.assigned_instruments import assign_instruments
    from calm.report import result_files

    (target,) = _targets((file,), output)
    if os.path.realpath(target) == os.path.realpath(onto):
        raise UsageError(f"{target} is the input file; choose another output")
    found = assign_instruments(onto, file)
    for sentence in (*found.assigned, *found.doubts):
        narrate(sentence)
    count = len(found.assigned)
    were = "instrument of {} was" if count == 1 else "instruments of {} were"
    save(target, found.text.encode(), f": {count} {were.format(file)} assigned")
    if json is not None:
        document = {"file": str(file), "output": str(target), "assigned": list(found.assigned),
                    "doubts": list(found.doubts)}  # fmt: skip
        text = result_files.to_json([document])
        show(text) if json == STDOUT else save(json, text.encode())
    return ExitCode.DONE


def _pairs(option: str, texts: list[str]) -> dict[str, str]:
    pairs = {}
    for text in texts:
        name, equals, value = text.partition("=")
        if not name.strip() or not equals:
            raise UsageError(f"{option}: `{text}` is not NAME=VALUE")
        pairs[name.strip()] = value.strip()
    return pairs


def _is_folder(files: tuple[Path, ...], output: Path) -> bool:
    return len(files) > 1 or output.is_dir() or str(output).endswith(("/", os.sep))


def _targets(files: tuple[Path, ...], output: Path) -> list[Path]:
    from calm.report.folder import check_destination

    if not _is_folder(files, output):
        check_destination(output)
        targets = [output]
    else:
        if output.exists() and not output.is_dir():
            raise UsageError(f"cannot write into {output}: it is not a folder")
        targets = [output / f"{file.stem}.yaml" for file in files]
    for target in targets:
        if targets.count(target) > 1:
            raise UsageError(f"two of the input files would be written to {target}")
        if any(os.path.realpath(target) == os.path.realpath(file) for file in files):
            raise UsageError(f"{target} is the input file; choose another output")
    return targets


def _record_of(target: Path) -> Path:
    return target.with_name(f"{target.stem}-currents.nc")


def _tell(imported: Imported, record: Path | None) -> None:
    if imported.understood:
        narrate(f"{imported.file}: read: {imported.understood}")
    for remark in imported.guessed:
        narrate(f"{imported.file}: guessed: {remark}")
    for remark in imported.dropped:
        narrate(f"{imported.file}: omitted: {remark}")
    for match in imported.matched:
        narrate(f"{imported.file}: {match.name} is replaced by {match.entry} of the catalogue")
    if record is not None:
        from calm.records.current_file import open_record
        from calm.records.current_terms import Terms

        with open_record(record, Terms()) as read:
            for card in read.cards:
                narrate_card(card)


def _document(imported: Imported, target: Path) -> dict[str, Any]:
    return {
        "file": str(imported.file),
        "format": imported.format,
        "output": str(target),
        "record": None if imported.record is None else str(_record_of(target)),
        "understood": imported.understood,
        "guessed": [vars(each) for each in imported.guessed],
        "dropped": [vars(each) for each in imported.dropped],
        "matched": [vars(each) for each in imported.matched],
    }
