"""``calm diff``: what changed between two designs, and what it does."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

from calm.cli.options import CatalogFiles
from calm.cli.outputs import OutputPath, Outputs
from calm.cli.run import read_files
from calm.cli.streams import ExitCode, narrate
from calm.errors import NoEquilibrium, UsageError

if TYPE_CHECKING:
    from calm.case import Mooring, Tow
    from calm.checks.comparison import Comparison

DIFF_EXAMPLES = """Examples:

  calm diff design-A.yaml design-B.yaml
  calm diff design-A.yaml design-B.yaml --environment storm.yaml
  calm diff mooring.yaml             (its design against its deployed:)
  calm diff design-A.yaml design-B.yaml --json - | jq '.changed[].where'"""


def diff(
    before: Path,
    after: Path | None = None,
    /,
    *,
    environment: str | None = None,
    catalog: CatalogFiles = None,
    json: OutputPath = None,
) -> ExitCode:
    """Compare two designs piece by piece, and say what the change does.

    Pieces and clamps are matched by their labels, or else by component and position. Parts added,
    removed, moved or changed are listed, and depth, knockdown, tensions, anchor, weights and the
    margins of calm check stand side by side. With one file, its design is compared with its
    `deployed:`. A design without an equilibrium is compared too. The exit code is
    0 whether or not the designs differ.

    Parameters
    ----------
    before
        A mooring or tow file.
    after
        Another; without it, the `deployed:` of the first is compared with its design.
    environment
        An environment named in both files, or an environment file, in place of their own.
    json
        Write the differences as JSON, - to print it.
    """
    files = (before,) if after is None else (before, after)
    outputs = Outputs(files, json)
    outputs.check()
    lines = read_files(files, environment, catalog or [])
    for file, line in zip(files, lines, strict=True):
        for notice in line.file.notices:
            narrate(f"{file}: {notice}")
    comparison = compared(files, lines)
    from calm.report.explanation import comparison_part

    outputs.write_answer(comparison.to_dict, comparison_part(comparison))
    return ExitCode.DONE


def compared(files: tuple[Path, ...], lines: list[Mooring | Tow]) -> Comparison:
    """Two designs, or one with what was deployed of it.

    Raises
    ------
    UsageError
        A mooring and a tow; a single tow, or a file that says nothing of a deployment.
    """
    from calm.case import Mooring
    from calm.checks.comparison import comparison_of
    from calm.checks.situations import as_deployed

    first, last = lines[0], lines[-1]
    if isinstance(first, Mooring) != isinstance(last, Mooring):
        raise UsageError(f"{files[0]} and {files[1]}: a mooring is not compared with a tow")
    if len(lines) == 2:
        return comparison_of((str(files[0]), str(files[1])), first, last)
    if not isinstance(first, Mooring):
        raise UsageError(f"{files[0]} is a tow; give the file to compare it with")
    try:
        deployed = as_deployed(first)
        design, there = (Mooring(replace(one.file, deployed=None)) for one in (first, deployed))
        return comparison_of(("design", "deployed"), design, there)
    except NoEquilibrium as failure:
        raise UsageError(f"{files[0]}: what is cut to fit has no length: {failure}") from failure
