"""Write the pages of the verification and their pictures from the cases of `calm verify`.

python docs/generate_verification.py            # write them
python docs/generate_verification.py --check    # exit 1 where a page is out of date

Pictures are not compared: their bytes depend on the version of matplotlib.
"""

import sys
from collections.abc import Callable, Iterator
from itertools import groupby
from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from calm.drawing.plot import figure_svg
from calm.physics.reynolds import cylinder_coefficient, sphere_coefficient
from calm.report.verification import COLUMNS, by_kind, figures
from calm.verification import (
    SOURCES,
    CaseOutcome,
    Kind,
    Source,
    drag_and_sea_water,
    march_properties,
    solved_moorings,
)

PAGE = Path(__file__).parent / "explanation" / "verification.md"
FIGURES = Path(__file__).parent / "reference" / "verification-figures.md"
IMAGES = Path(__file__).with_name("images")
HEAD = """# Verification

Printed by `python docs/generate_verification.py`; do not edit.

`calm verify` compares {verifying} values computed by CALM with values known without CALM. The exit
code is 1 if a value is out of tolerance. `calm verify cdms tension` selects the values whose
source or name contains both words; `--json -` gives all digits. The cases are in
`calm/verification/`, and the tests run them.

The significance of an agreement depends on the origin of the value, so every value has a kind:

| kind | figures | meaning |
| --- | ---: | --- |
{kinds}

{copied} more values agree **by construction**: points on a curve of CALM, values to which a law is
fitted, values of a library that CALM calls. Their agreement only excludes copying errors, so they
are checked, but not counted.

In addition, the tests compare every mooring of `lines/` and hundreds of random moorings
with an independent integration of the differential equations.

On this page, *march* means CALM's integration along the line.

{contents}

[All values, with their tolerances and the reasons for them](../reference/verification-figures.md).
"""
FIGURES_HEAD = """# Verification: every figure

Printed by `python docs/generate_verification.py`; do not edit.

The values that `calm verify` compares. [Verification](../explanation/verification.md) explains what
agreement proves, and gives the sources of the values. Above each table are its kind and the
reason for its tolerance. The values of CALM and the differences are rounded a digit or two beyond
the tolerance. C1 to C23 are names of cases in the code and the tests. *March* means CALM's
integration along the line.
"""
ORDER_TWO = {"color": "grey", "linestyle": "--", "linewidth": 1, "label": "second order"}
STYLES = {"SSMOOR": ("s", "#cc3311"), "MD&D": ("D", "#e69f00"), "independent": ("^", "#009e73")}
LINE = "#0b3c5d"


def page() -> str:
    """The text of the page."""
    totals = by_kind(case for source in SOURCES for case in source.cases)
    verifying = {kind: number for kind, number in totals.items() if kind.verifies}
    head = HEAD.format(
        verifying=sum(verifying.values()),
        kinds="\n".join(f"| {kind} | {number} | {kind.meaning} |"
                        for kind, number in verifying.items()),
        copied=sum(totals.values()) - sum(verifying.values()),
        contents=contents(),
    )  # fmt: skip
    return "\n".join([head, *map(section, SOURCES)])


def contents() -> str:
    """A table of the sources, with the number of their figures of each kind."""
    rows = [f"| source | {' | '.join(Kind)} |", f"| --- {'| ---: ' * len(Kind)}|"]
    for source in SOURCES:
        number = by_kind(source.cases)
        numbers = (str(number.get(kind, "")) for kind in Kind)
        rows.append(f"| [{source.title}](#{anchor(source.title)}) | {' | '.join(numbers)} |")
    return "\n".join(rows)


def anchor(title: str) -> str:
    """Anchor of a heading, in GitHub's form."""
    kept = (sign for sign in title.lower() if sign.isalnum() or sign in " -")
    return "".join(kept).replace(" ", "-")


def section(source: Source) -> str:
    """Section of a source: origin of its figures, and its picture."""
    figures_of_it = f"../reference/verification-figures.md#{anchor(source.title)}"
    parts = [f"## {source.title}", source.text, f"[The figures]({figures_of_it})"]
    if source.picture:
        parts.append(f"![{source.title}](../images/{source.picture}.svg)")
    return "\n\n".join(parts) + "\n"


def figures_page() -> str:
    """The text of the page of all figures."""
    return "\n".join([FIGURES_HEAD, *map(figures_section, SOURCES)])


def figures_section(source: Source) -> str:
    """A table for each kind and tolerance of a source."""
    parts = [f"## {source.title}"]
    for kind in by_kind(source.cases):
        cases = [case for case in source.cases if case.kind is kind]
        for why, alike in groupby(cases, key=lambda case: case.why):
            parts.append(f"**{kind.capitalize()}.** Tolerance: {why}")
            parts.append("\n".join(table([case.check() for case in alike])))
    return "\n\n".join(parts) + "\n"


def table(outcomes: list[CaseOutcome]) -> Iterator[str]:
    """The lines of a table."""
    yield f"| {' | '.join(COLUMNS)} |"
    yield "| --- | ---: | ---: | ---: | ---: | --- |"
    for outcome in outcomes:
        name, *others = figures(outcome)
        if not outcome.within:
            name = f"**out: {name}** {outcome.reason}"
        yield f"| {' | '.join(text.replace('|', '∣') for text in (name, *others))} |"


def draw_cdms_1() -> Figure:
    """Shape and tensions of CDMS-1, with the results of the programs."""
    figure = Figure(figsize=(9, 5), layout="constrained")
    shape, tension = figure.subplots(1, 2, sharey=True)
    answer = solved_moorings.solved_cdms_1()
    nodes = range(len(answer.tension))
    height = [solved_moorings.height_at(answer, node) for node in nodes]
    pull = [solved_moorings.tension_at(answer, node) for node in nodes]
    shape.plot(answer.position[:, 0], height, color=LINE, label="CALM")
    tension.plot(pull[1:], height[1:], color=LINE, label="CALM")
    heights = [height[node] for node in solved_moorings.nodes_of_tensions(answer)]
    for program, (high, offset, *tensions) in solved_moorings.PROGRAMS.items():
        marker, colour = STYLES[program]
        look = {"marker": marker, "color": colour, "linestyle": "none", "fillstyle": "none"}
        shape.plot(offset, high, label=program, **look)
        tension.plot(tensions, heights, label=program, **look)
    shape.set(xlabel="offset [m]", ylabel="height above the seabed [m]", title="shape")
    tension.set(xlabel="tension [kgf]", title="tension; printed below the sphere,\nbelow the third "
                "meter and at the anchor")  # fmt: skip
    shape.legend(frameon=False)
    return figure


def draw_s1000() -> Figure:
    """Shape of S1000 with the known place of its float, and the errors by angle step."""
    figure = Figure(figsize=(9, 4.5), layout="constrained")
    shape, errors = figure.subplots(1, 2)
    solution = solved_moorings.solved_s1000(1.0)
    shape.plot(solution.position[:, 0], -solution.position[:, 2], color=LINE, label="CALM at 1°")
    shape.plot(
        solved_moorings.OFFSET, solved_moorings.DEPTH, "o", color="#cc3311", label="float, known"
    )
    shape.set(xlabel="offset [m]", ylabel="depth [m]", ylim=(1100.0, 0.0))
    shape.legend(frameon=False)

    steps = np.array(march_properties.ANGLE_STEPS)
    solved = [solved_moorings.solved_s1000(step) for step in steps.tolist()]
    depth = np.array(
        [abs(solved_moorings.float_depth(each) - solved_moorings.DEPTH) for each in solved]
    )
    offset = np.array([abs(each.position[0, 0] - solved_moorings.OFFSET) for each in solved])
    stated = np.array([each.depth_error for each in solved])
    errors.plot(steps, depth, "o-", color=LINE, label="depth of the float")
    errors.plot(steps, offset, "s-", color="#cc3311", label="its offset")
    errors.plot(steps, stated, "x:", color="black", label="what CALM states, any place")
    errors.axhline(5e-5, color="#999999", linewidth=0.8)
    errors.annotate("half the last digit known", (steps[0], 5e-5), va="bottom", ha="right", size=8)
    finish(errors, steps, offset)
    return figure


def draw_convergence() -> Figure:
    """Miss of a heavy line's free end by angle step."""
    figure = Figure(figsize=(5, 4), layout="constrained")
    axes = figure.subplots()
    steps = np.array(march_properties.ANGLE_STEPS)
    missed = np.array([march_properties.heavy_line_error(step) for step in steps.tolist()])
    axes.plot(steps, missed, "o-", color=LINE, label="miss of the free end, 1000 m of line")
    finish(axes, steps, missed)
    return figure


def finish(axes: Axes, steps: np.ndarray, errors: np.ndarray) -> None:
    """Scales and labels of errors by angle step, with a line of second order."""
    axes.plot(steps, 2.0 * errors[0] * (steps / steps[0]) ** 2, **ORDER_TWO)
    axes.set(xscale="log", yscale="log", xlabel="angle step [°]", ylabel="error [m]")
    axes.set_xticks(steps, [f"{step:g}" for step in steps], minor=False)
    axes.set_xticks([], minor=True)
    axes.legend(frameon=False)


def draw_drag_curves() -> Figure:
    """Drag coefficients by Reynolds number, with the points they come from."""
    figure = Figure(figsize=(8, 4.5), layout="constrained")
    axes = figure.subplots()
    published = (
        ("Wieselsberger, measured", drag_and_sea_water.WIESELSBERGER, "o", LINE),
        ("DNV-RP-C205", drag_and_sea_water.DNV, "D", "#e69f00"),
        ("Morrison, sphere", drag_and_sea_water.MORRISON, "^", "#cc3311"),
    )
    for name, points, marker, colour in published:
        axes.plot(*zip(*points, strict=True), marker, color=colour, fillstyle="none", label=name)
    for name, coefficient, colour, least, greatest in (
        ("CALM, smooth cylinder", cylinder_coefficient, LINE, 3.0, 5e6),
        ("CALM, smooth sphere", sphere_coefficient, "#cc3311", 1.0, 1e6),
    ):
        reynolds = np.geomspace(least, greatest, 600)
        axes.plot(reynolds, [coefficient(re) for re in reynolds], color=colour, label=name)
    axes.set(xscale="log", yscale="log", xlabel="Reynolds number", ylabel="drag coefficient")
    axes.legend(frameon=False)
    return figure


PICTURES: dict[str, Callable[[], Figure]] = {
    solved_moorings.CDMS_1.picture: draw_cdms_1,
    solved_moorings.S1000.picture: draw_s1000,
    march_properties.CONVERGENCE.picture: draw_convergence,
    drag_and_sea_water.DRAG_CURVES.picture: draw_drag_curves,
}


if __name__ == "__main__":
    written = {PAGE: page(), FIGURES: figures_page()}
    if sys.argv[1:] == ["--check"]:
        missing = [name for name in PICTURES if not (IMAGES / f"{name}.svg").exists()]
        for path, text in written.items():
            if missing or not path.exists() or path.read_text(encoding="utf-8") != text:
                sys.exit(f"{path} is out of date; run python docs/generate_verification.py")
    else:
        for path, text in written.items():
            path.write_text(text, encoding="utf-8")
        for name, draw in PICTURES.items():
            (IMAGES / f"{name}.svg").write_text(figure_svg(draw()), encoding="utf-8")
