"""``calm size``: the smallest change of a mooring that meets a target."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

from cyclopts import Parameter

from calm.cli.options import CatalogFiles, EnvironmentName, Units, show_units
from calm.cli.outputs import OutputPath, Outputs
from calm.cli.streams import ExitCode, narrate
from calm.errors import UsageError

SIZE_EXAMPLES = """Examples:

  calm size mooring.yaml --target "knockdown(top) <= 20 m" \\
      --change "top float.buoyancy"
  calm size mooring.yaml --target "tilt(current meter) <= 5 deg" \\
      --change "back-up glass.count" --between 4 40
  calm size mooring.yaml --target "depth(CTD 130 m) = 130 m" \\
      --change wire.length --environment storm
  calm size mooring.yaml --target "required_weight <= 8 kN" \\
      --change "top float.buoyancy" --json -

Targets: knockdown, depth, excursion, tilt or tension of a label or of top, and
required_weight of the anchor. Changes: LABEL.buoyancy, LABEL.length, LABEL.count."""


def size(
    file: Path,
    /,
    *,
    target: str,
    change: str,
    between: Annotated[tuple[str, str] | None, Parameter(allow_leading_hyphen=True)] = None,
    environment: EnvironmentName = None,
    catalog: CatalogFiles = None,
    json: OutputPath = None,
    units: Units = None,
) -> ExitCode:
    """Find the smallest change of a mooring that meets a target.

    The changed mooring is solved as calm run solves it. A change of buoyancy leaves
    size and drag as they are. When the target cannot be met, the exit code is 3,
    and the reason and the nearest value are reported.

    Parameters
    ----------
    file
        A mooring file.
    target
        A quantity of a part of the line, <=, >= or =, and a limit with its unit.
    change
        What to change: the label of a part, and its buoyancy, length or count. A
        label without its number stands for all pieces numbered under it.
    between
        The least and the greatest value, with units; when not given, a buoyancy goes from 0
        to 100 times itself, a length to twice the water depth, a count to 1000.
    json
        Write the answer as JSON, - to print it.
    """
    outputs = Outputs((file,), json)
    outputs.check()
    import calm
    from calm.case import Tow
    from calm.case.size import size as sized
    from calm.report.explanation import refusal, sizing_part

    mooring = calm.load(file, environment=environment, catalogs=catalog or [])
    if isinstance(mooring, Tow):
        raise UsageError(f"{file} is a tow; calm size changes moorings")
    show_units(units, [mooring.file])
    sizing = sized(mooring, target, change, between)
    if sizing.after is not None:
        outputs.write_answer(sizing.to_dict, sizing_part(sizing))
        return ExitCode.DONE
    outputs.write_answer(sizing.to_dict, None)
    narrate(f"{file}: {refusal(sizing)}")
    return ExitCode.NO_EQUILIBRIUM
