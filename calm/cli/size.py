"""``calm size``: find the smallest change of a mooring that meets a target."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

from cyclopts import Parameter

from calm.cli import options
from calm.cli.outputs import ExitCode, Outputs, narrate


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
    r"""Find the smallest change of a mooring that meets a target.

    The changed mooring is solved as in calm run. A change of buoyancy leaves size
    and drag unchanged. If the target cannot be met, the exit code is 3, and the
    reason and the nearest value are reported.

    Parameters
    ----------
    file
        A mooring file, or the file of a net of legs.
    target
        Condition to meet: a quantity of a part of the line, then <=, >= or =, then a limit with its
        unit.
    change
        Value to change, written LABEL.buoyancy, LABEL.length or LABEL.count. A label without a
        number, such as glass, stands for glass 1, glass 2 and so on.
    between
        Smallest and largest value to try, with units. By default CALM tries a buoyancy of 0 to 100
        times its present value, lengths up to twice the water depth, and counts up to 1000.

    Examples
    --------
      calm size mooring.yaml --target "knockdown(top) <= 20 m" \
          --change "top float.buoyancy"
      calm size mooring.yaml --target "tilt(current meter) <= 5 deg" \
          --change "back-up glass.count" --between 4 40
      calm size mooring.yaml --target "depth(CTD 130 m) = 130 m" \
          --change wire.length --environment storm
      calm size mooring.yaml --target "required_weight <= 8 kN" \
          --change "top float.buoyancy" --json -

    A target limits the knockdown, depth, excursion, tilt or tension of one part,
    which is given by its label or as `top`. A target can also limit the weight
    required of the anchor: write required_weight or, in a net,
    required_weight(LEG).
    """
    outputs = Outputs((file,), json)
    from calm.case import load
    from calm.case.size import size as sized
    from calm.files.mooring_file import refuse_tow
    from calm.report.explanation import refusal, sizing_part

    mooring = load(file, environment, catalog or [])
    refuse_tow(mooring.file)
    options.show_units(units, [mooring.file])
    sizing = sized(mooring, target, change, between)
    if sizing.after is not None:
        outputs.write_answer(sizing.to_dict, sizing_part(sizing))
        return ExitCode.DONE
    outputs.write_answer(sizing.to_dict, None)
    narrate(f"{file}: {refusal(sizing)}")
    return ExitCode.NO_EQUILIBRIUM
