"""``calm diff``: compare two designs, or a design and its deployment."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

from calm.cli import options, reading
from calm.cli.outputs import ExitCode, OutputPath, Outputs, narrate
from calm.errors import NoEquilibrium, UsageError

if TYPE_CHECKING:
    from calm.case import Design
    from calm.checks.comparison import Comparison


def diff(
    before: Path,
    after: Path | None = None,
    /,
    *,
    environment: str | None = None,
    catalog: options.CatalogFiles = None,
    json: OutputPath = None,
) -> ExitCode:
    """Compare two designs piece by piece, and show the effect of the changes.

    Pieces and clamps are matched by label, otherwise by component and position.
    Parts added, removed, moved or changed are listed; depth, knockdown, tensions,
    anchor, weights and the margins of calm check are shown side by side. With one
    file, the design is compared with the mooring as deployed (its `deployed:`
    section). A design without equilibrium can be compared, too. The exit code is
    0 whether or not the designs differ.

    Parameters
    ----------
    before
        A mooring file; it may contain a tow or a net.
    after
        Mooring file to compare with. Without it, the design in BEFORE is compared with the mooring
        as deployed (its `deployed:` section).
    environment
        Use this environment: a name from both files, or an environment file.
    json
        Write the differences as JSON (- for standard output).

    Examples
    --------
      calm diff design-A.yaml design-B.yaml
      calm diff design-A.yaml design-B.yaml --environment storm.yaml
      calm diff mooring.yaml             (the design with the mooring as deployed)
      calm diff design-A.yaml design-B.yaml --json - | jq '.changed[].where'
    """
    files = (before,) if after is None else (before, after)
    outputs = Outputs(files, json)
    from calm.case import load

    lines = reading.read_all(load, files, environment, catalog or [])
    for file, line in zip(files, lines, strict=True):
        for notice in line.file.notices:
            narrate(f"{file}: {notice}")
    comparison = compared(files, lines)
    from calm.report.explanation import comparison_part

    outputs.write_answer(comparison.to_dict, comparison_part(comparison))
    return ExitCode.DONE


def compared(files: tuple[Path, ...], lines: list[Design]) -> Comparison:
    """Compare two designs, or one design with its deployment.

    Raises UsageError if a mooring is to be compared with a tow, or if a single file contains a tow
    or has no `deployed:`.
    """
    from calm.case import Design
    from calm.checks.comparison import comparison_of
    from calm.checks.situations import as_deployed

    first, last = lines[0], lines[-1]
    if first.towed != last.towed:
        raise UsageError(f"{files[0]} and {files[1]}: a mooring cannot be compared with a tow")
    if len(lines) == 2:
        return comparison_of((str(files[0]), str(files[1])), first, last)
    if first.towed:
        raise UsageError(f"{files[0]} is a tow; name a second tow to compare it with")
    try:
        deployed = as_deployed(first)
        design, there = (Design(replace(one.file, deployed=None)) for one in (first, deployed))
        return comparison_of(("design", "deployed"), design, there)
    except NoEquilibrium as failure:
        raise UsageError(
            f"{files[0]}: no length was found for the fitted piece: {failure}"
        ) from failure
