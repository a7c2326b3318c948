"""``calm strumming``: what the angle of a bare towed cable gives for its vibration."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Annotated

from cyclopts import Parameter

from calm.cli.exit_codes import ExitCode
from calm.cli.options import option, quantities
from calm.cli.outputs import OutputPath, Outputs
from calm.errors import UsageError

if TYPE_CHECKING:
    from calm.case.strumming import BareCable

STRUMMING_EXAMPLES = """Examples:

  calm strumming --angle "30 deg" --speed "1 m/s" --diameter "17 mm" \\
      --weight "3.1 N/m"
  calm strumming --angle "18 deg" --speed "1.3 m/s" --diameter "17 mm" \\
      --solid-density "2383 kg/m^3" --density "1000 kg/m^3" --json -"""

_Given = Annotated[str | None, Parameter(allow_leading_hyphen=True)]
_Asked = Annotated[str, Parameter(allow_leading_hyphen=True)]


def strumming(
    *,
    angle: _Asked,
    speed: _Asked,
    diameter: _Asked,
    weight: _Given = None,
    solid_density: _Given = None,
    density: _Given = None,
    json: OutputPath = None,
) -> ExitCode:
    """Find how a bare towed cable vibrates from the angle at which it tows.

    Bourget & Marichal: a cable towed with nothing at its end is straight, and its
    angle gives its drag coefficient C*; the excess of C* over that of a cable at
    rest gives the amplitude a of its vibration. Quantities carry their units.

    Parameters
    ----------
    angle
        Angle of the cable to the horizontal, as measured.
    speed
        Speed of the ship through the water.
    diameter
        Diameter of the cable.
    weight
        Weight in water of a metre of cable.
    solid_density
        Density of the cable, in place of its weight.
    density
        Density of the water; 1025 kg/m^3 when not given.
    json
        Write the answer as JSON, - to print it.
    """
    from calm.report.bare_cable import bare_cable_document, bare_cable_part

    outputs = Outputs(json=json)
    outputs.check()
    cable = _cable(
        quantities(
            {
                "angle": (angle, "angle"),
                "speed": (speed, "speed"),
                "diameter": (diameter, "length"),
                "weight": (weight, "force per length"),
                "solid_density": (solid_density, "density"),
                "density": (density, "density"),
            }
        )
    )
    outputs.write_answer(lambda: bare_cable_document(cable), bare_cable_part(cable))
    return ExitCode.DONE


def _cable(given: dict[str, float]) -> BareCable:
    """The cable that was measured, or what is wrong with it."""
    from calm.case.strumming import BareCable
    from calm.files.definition import CATALOGUE_DENSITY, STANDARD_GRAVITY

    if ("weight" in given) == ("solid_density" in given):
        raise UsageError("give one of --weight and --solid-density")
    given.setdefault("density", CATALOGUE_DENSITY)
    complaints = [
        f"{option(name)} must be above 0" for name, value in given.items() if value <= 0.0
    ]
    if given["angle"] >= 90.0:
        complaints.append("--angle must be below 90 deg")
    if complaints:
        raise UsageError("; ".join(complaints))
    if "solid_density" in given:
        excess = given.pop("solid_density") - given["density"]
        if excess <= 0.0:
            raise UsageError("--solid-density must be above the density of the water")
        given["weight"] = excess * STANDARD_GRAVITY * math.pi / 4.0 * given["diameter"] ** 2
    return BareCable(**given)
