"""``calm chart``: cables in a uniform current, solved and drawn."""

import math
from pathlib import Path
from typing import Annotated, Literal

from cyclopts import App, Group, Parameter

from calm.cli import options
from calm.cli.outputs import ExitCode, Outputs, narrate, save
from calm.errors import UsageError

_BUOY = """  calm chart solve --k 2.4 --weight "5 N/m" \\
      --phi-b "75 deg" --tension-b "350 N" --height "20 m\""""

chart = App(
    name="chart",
    help="Charts of cables in a uniform current.",
    help_epilogue=f"""Examples:

{_BUOY}
  calm chart draw --k 0.6 -o chart.svg""",
)

_SOLVE_EXAMPLES = f"""Examples:

{_BUOY}
  calm chart solve --weight "0.5 N/m" --diameter "12 mm" --cd 1.2 \\
      --speed "1 knot" --phi-b "140 deg" --tension-b "100 N" \\
      --length "100 m" --json -"""

_DRAW_EXAMPLES = """Examples:

  calm chart draw --k 0.6 -o chart.svg
  calm chart draw --k 2.4 --lower-end above-90 -o chart.pdf"""

_MEDIUM = Group("The cable and the current", sort_key=1)
_SEVEN = Group("Quantities of the cable: set three of these seven", sort_key=2)
_OUTPUT = Group("Output", sort_key=3)

# A quantity may be negative, which must not be taken for an option.
_Medium = Annotated[str | None, Parameter(allow_leading_hyphen=True, group=_MEDIUM)]
_Seven = Annotated[str | None, Parameter(allow_leading_hyphen=True, group=_SEVEN)]


@chart.command(help_epilogue=_SOLVE_EXAMPLES)
def solve(
    *,
    weight: Annotated[str, Parameter(allow_leading_hyphen=True, group=_MEDIUM)],
    k: _Medium = None,
    diameter: _Medium = None,
    cd: _Medium = None,
    speed: _Medium = None,
    density: _Medium = None,
    phi_a: _Seven = None,
    phi_b: _Seven = None,
    tension_a: _Seven = None,
    tension_b: _Seven = None,
    height: _Seven = None,
    distance: _Seven = None,
    length: _Seven = None,
    json: Annotated[Path | None, Parameter(allow_leading_hyphen=True, group=_OUTPUT)] = None,
) -> ExitCode:
    """Find every cable that matches three given quantities.

    The cable hangs in a uniform current, from its lower end A to its upper end B;
    its drag is normal to the cable. Quantities need units. The exit code is 3 if
    no cable matches.

    Parameters
    ----------
    weight
        Weight per metre in water; negative for a buoyant cable.
    k
        K = density × cd × diameter × speed² / (2 × weight), from 0 to 100.
    diameter
        Diameter of the cable; used with the next three options instead of K.
    cd
        Drag coefficient of the cable.
    speed
        Speed of the current.
    density
        Density of the water; 1025 kg/m^3 by default.
    phi_a
        Angle of the cable to the current at A; negative if the cable descends from A.
    phi_b
        Angle of the cable to the current at B.
    tension_a
        Tension at A.
    tension_b
        Tension at B.
    height
        Height of B above A.
    distance
        Distance of B downstream of A; negative upstream.
    length
        Length of the cable.
    json
        Write the result as JSON (- for standard output).
    """
    from calm.analytic.chart import chart_solve
    from calm.report.chart_page import answer_document, answer_part

    outputs = Outputs(json=json)
    known = options.quantities(
        weight=(weight, "force per length"), k=(k, "number"), diameter=(diameter, "length"),
        cd=(cd, "number"), speed=(speed, "speed"), density=(density, "density"),
        phi_a=(phi_a, "angle"), phi_b=(phi_b, "angle"),
        tension_a=(tension_a, "force"), tension_b=(tension_b, "force"),
        height=(height, "length"), distance=(distance, "length"), length=(length, "length"),
    )  # fmt: skip
    cable = {name: known.pop(name) for name in _CABLE if name in known}
    for name in known.keys() & {"phi_a", "phi_b"}:
        known[name] = math.radians(known[name])
    answer = chart_solve(_drag_over_weight(cable), cable["weight"], **known)
    part = answer_part(answer) if answer.solutions else None
    outputs.write_answer(lambda: answer_document(answer), part)
    if not answer.solutions:
        narrate(f"calm: {answer.status}: {answer.message} {answer.advice}")
        return ExitCode.NO_EQUILIBRIUM
    return ExitCode.DONE


@chart.command(help_epilogue=_DRAW_EXAMPLES)
def draw(
    *,
    k: Annotated[str, Parameter(allow_leading_hyphen=True)],
    output: options.OutputFile,
    lower_end: Literal["below-90", "above-90"] = "below-90",
) -> ExitCode:
    """Draw the chart for one value of K on an A4 page.

    Parameters
    ----------
    k
        K = density × cd × diameter × speed² / (2 × weight), from 0 to 100.
    output
        File to write: .svg, .png or .pdf.
    lower_end
        Cables to draw: those whose angle at the lower end A is below 90° (the default), or those
        whose angle is above 90°.
    """
    from calm.drawing.picture import check_format, image
    from calm.drawing.plot import figure_svg
    from calm.report.chart_page import draw_chart
    from calm.report.folder import check_destination

    check_format(output)
    check_destination(output)
    (drag_over_weight,) = options.quantities(k=(k, "number")).values()
    save(output, image(figure_svg(draw_chart(drag_over_weight, lower_end)), output.suffix))
    return ExitCode.DONE


_CABLE = ("weight", "k", "diameter", "cd", "speed", "density")


def _drag_over_weight(cable: dict[str, float]) -> float:
    from calm.physics.seawater import REFERENCE_DENSITY

    parts = ("diameter", "cd", "speed")
    if "k" in cable:
        also = [options.option(name) for name in (*parts, "density") if name in cable]
        if also:
            raise UsageError(f"--k cannot be combined with {', '.join(also)}")
        return cable["k"]
    missing = [options.option(name) for name in parts if name not in cable]
    if missing:
        raise UsageError(f"missing: {', '.join(missing)}; alternatively, set --k")
    for name in (*parts, "density"):
        if cable.get(name, 0.0) < 0.0:
            raise UsageError(f"{options.option(name)} must not be negative")
    if cable["weight"] == 0.0:
        raise UsageError("--weight must not be 0")
    density = cable.get("density", REFERENCE_DENSITY)
    drag = density * cable["cd"] * cable["diameter"] * cable["speed"] ** 2
    return drag / (2.0 * abs(cable["weight"]))
