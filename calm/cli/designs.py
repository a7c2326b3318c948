"""``calm diff`` and ``calm size``: what changed in a design, and what would meet a target."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

from cyclopts import Parameter

from calm.cli import options, reading
from calm.cli.outputs import ExitCode, OutputPath, Outputs, narrate
from calm.errors import NoEquilibrium, UsageError

if TYPE_CHECKING:
    from calm.case import Mooring, Tow
    from calm.case.net import Net
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
    Parts added, removed, moved or changed are listed; depth, knockdown,
    tensions, anchor, weights and the margins of calm check are shown side by
    side. With one file, its design is compared with its `deployed:`. A design
    without equilibrium is compared too. The exit code is 0 whether or not the
    designs differ.

    Parameters
    ----------
    before
        A mooring, tow or net file.
    after
        Another; without it, the `deployed:` of the first is compared with its design.
    environment
        The environment to use instead: a name from both files, or an
        environment file.
    json
        Write the differences as JSON, - to print it.

    Examples
    --------
      calm diff design-A.yaml design-B.yaml
      calm diff design-A.yaml design-B.yaml --environment storm.yaml
      calm diff mooring.yaml             (its design against its deployed:)
      calm diff design-A.yaml design-B.yaml --json - | jq '.changed[].where'
    """
    files = (before,) if after is None else (before, after)
    outputs = Outputs(files, json)
    from calm.case.net import load

    lines = reading.read_all(load, files, environment, catalog or [])
    for file, line in zip(files, lines, strict=True):
        for notice in line.file.notices:
            narrate(f"{file}: {notice}")
    comparison = compared(files, lines)
    from calm.report.explanation import comparison_part

    outputs.write_answer(comparison.to_dict, comparison_part(comparison))
    return ExitCode.DONE


def compared(files: tuple[Path, ...], lines: list[Mooring | Tow | Net]) -> Comparison:
    """Two designs, or one with what was deployed of it.

    UsageError: a mooring and a tow; a single tow, or a file that says nothing of a deployment.
    """
    from calm.case import Mooring, Tow, net
    from calm.checks.comparison import comparison_of
    from calm.checks.situations import as_deployed, deployed_file

    first, last = lines[0], lines[-1]
    if isinstance(first, Tow) != isinstance(last, Tow):
        raise UsageError(f"{files[0]} and {files[1]}: a mooring is not compared with a tow")
    if len(lines) == 2:
        return comparison_of((str(files[0]), str(files[1])), first, last)
    if isinstance(first, Tow):
        raise UsageError(f"{files[0]} is a tow; give the file to compare it with")
    if isinstance(first, net.Net):
        laid = replace(deployed_file(first.file), deployed=None)
        planned = replace(first.file, deployed=None)
        return comparison_of(("design", "deployed"), net.Net(planned), net.Net(laid))
    try:
        deployed = as_deployed(first)
        design, there = (Mooring(replace(one.file, deployed=None)) for one in (first, deployed))
        return comparison_of(("design", "deployed"), design, there)
    except NoEquilibrium as failure:
        raise UsageError(f"{files[0]}: what is cut to fit has no length: {failure}") from failure


def size(
    file: Path,
    /,
    *,
    target: str,
    change: str,
    between: Annotated[tuple[str, str] | None, Parameter(allow_leading_hyphen=True)] = None,
    environment: options.EnvironmentName = None,
    catalog: options.CatalogFiles = None,
    json: options.JsonAnswer = None,
    units: options.Units = None,
) -> ExitCode:
    """Find the smallest change of a mooring that meets a target.

    The changed mooring is solved as by calm run. A change of buoyancy leaves
    size and drag unchanged. If the target cannot be met, the exit code is 3,
    and the reason and the nearest value are reported.

    Parameters
    ----------
    file
        A mooring file, or that of a net of legs.
    target
        A quantity of a part of the line, <=, >= or =, and a limit with its unit.
    change
        What to change: the label of a part, and its buoyancy, length or count.
        A label without its number means all pieces of that label.
    between
        The least and the greatest value, with units; by default a buoyancy may
        change from 0 to 100 times itself, a length up to twice the water depth,
        a count up to 1000.

    Examples
    --------
      calm size mooring.yaml --target "knockdown(top) <= 20 m" \\
          --change "top float.buoyancy"
      calm size mooring.yaml --target "tilt(current meter) <= 5 deg" \\
          --change "back-up glass.count" --between 4 40
      calm size mooring.yaml --target "depth(CTD 130 m) = 130 m" \\
          --change wire.length --environment storm
      calm size mooring.yaml --target "required_weight <= 8 kN" \\
          --change "top float.buoyancy" --json -

    Targets: knockdown, depth, excursion, tilt or tension of a label or of top, and
    required_weight of the anchor, in a net required_weight(LEG). Changes:
    LABEL.buoyancy, LABEL.length, LABEL.count.
    """
    outputs = Outputs((file,), json)
    from calm.case import Tow
    from calm.case.net import load
    from calm.case.size import size as sized
    from calm.report.explanation import refusal, sizing_part

    mooring = load(file, environment, catalog or [])
    if isinstance(mooring, Tow):
        raise UsageError(f"{file} is a tow; calm size is for moorings")
    options.show_units(units, [mooring.file])
    sizing = sized(mooring, target, change, between)
    if sizing.after is not None:
        outputs.write_answer(sizing.to_dict, sizing_part(sizing))
        return ExitCode.DONE
    outputs.write_answer(sizing.to_dict, None)
    narrate(f"{file}: {refusal(sizing)}")
    return ExitCode.NO_EQUILIBRIUM
