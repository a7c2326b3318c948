"""``calm run``: solve moorings and show them."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

from cyclopts import Parameter

from calm.cli.exit_codes import ExitCode, gravest
from calm.cli.outputs import Outcome, Outputs
from calm.cli.streams import narrate
from calm.errors import InputError, NoEquilibrium, Problem

if TYPE_CHECKING:
    from calm.case import Mooring

RUN_EXAMPLES = """Examples:

  calm run mooring.yaml
  calm run mooring.yaml --environment storm --plot storm.png
  calm run mooring.yaml --csv components.csv --json result.json
  calm run spring.yaml neap.yaml --json -"""

OutputPath = Annotated[Path | None, Parameter(allow_leading_hyphen=True)]


def run(
    files: list[Path],
    /,
    *,
    environment: str | None = None,
    catalog: list[Path] | None = None,
    json: OutputPath = None,
    csv: OutputPath = None,
    plot: Path | None = None,
) -> ExitCode:
    """Solve moorings and print the table of each line.

    All files are read first: if one of them cannot be used, its mistakes are
    listed and nothing is solved. The table is printed unless - asks for JSON or
    CSV; errors go to the standard error.

    Parameters
    ----------
    files
        Mooring files.
    environment
        An environment named in the files, or an environment file, in place of their own.
    catalog
        A catalogue of your own; its components hide others of the same id. Repeatable.
    json
        Write the result as JSON, - to print it; several files give an array.
    csv
        Write the components as CSV, units in the header, - to print it.
    plot
        Draw it, as .png or .svg; for several files p.png becomes p-FILE.png for each.
    """
    outputs = Outputs(tuple(files), json, csv, plot)
    outputs.check()
    moorings = _read(files, environment, catalog or [])
    outcomes = [_solve(file, mooring) for file, mooring in zip(files, moorings, strict=True)]
    outputs.write(outcomes)
    return gravest(outcome.code for outcome in outcomes)


def _read(files: list[Path], environment: str | None, catalogs: list[Path]) -> list[Mooring]:
    """All moorings, or an `InputError` with the mistakes of all of them."""
    import calm

    moorings: list[Mooring] = []
    problems: dict[Problem, None] = {}
    for file in files:
        try:
            moorings.append(calm.load(file, environment=environment, catalogs=catalogs))
        except InputError as error:
            # A catalogue that all files share has its mistakes told once.
            problems |= dict.fromkeys(error.problems)
    if problems:
        raise InputError(list(problems))
    return moorings


def _solve(file: Path, mooring: Mooring) -> Outcome:
    try:
        return Outcome(file, mooring.file.name, result=mooring.solve())
    except NoEquilibrium as failure:
        for notice in mooring.file.notices:  # a result has them among its warnings
            narrate(f"{file}: {notice}")
        narrate(f"{file}: {failure}")
        return Outcome(file, mooring.file.name, failure=failure)
