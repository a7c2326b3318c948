"""``calm tow`` and ``calm tow strumming``: towed lines at one speed or many, and a bare cable."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

from cyclopts import Parameter

from calm.cli import options, reading, run
from calm.cli.outputs import ExitCode, FileOutcome, OutputPath, Outputs, gravest, narrate
from calm.cli.progress import progress
from calm.errors import NoEquilibrium, UsageError

if TYPE_CHECKING:
    from calm.case import Tow
    from calm.case.strumming import BareCable
    from calm.cli.outputs import Shows
    from calm.report.tabulation import Tabulation


def tow(
    files: list[Path],
    /,
    *,
    environment: options.EnvironmentName = None,
    catalog: options.CatalogFiles = None,
    json: OutputPath = None,
    csv: OutputPath = None,
    plot: Path | None = None,
    speeds: options.Signed = None,
    sensitivity: bool = False,
    schematic: bool = False,
    units: options.Units = None,
) -> ExitCode:
    """Solve towed lines, at the speed of their file or at many speeds.

    Without --speeds and --sensitivity it does what `calm run` does, for tows only.
    With --speeds, a speed without equilibrium is a row with its status and makes
    the exit code 3; the other speeds are still solved.

    Parameters
    ----------
    files
        Mooring files with `tow:`.
    json
        Write the result as JSON, - to print it; several files give an array.
    csv
        Write the components, or with --speeds the speeds, as CSV, - to print it.
    plot
        Draw it, or with --speeds depth, layback and tension by speed; files as in `calm run`.
    speeds
        Solve at speeds A:B:STEP with their units, both ends included.
    sensitivity
        Solve with A1, B1 and C1 of bourget-marichal strumming each 10 % smaller and greater.
    schematic
        Draw the line as `calm run` does; only at the speed of its file.

    Examples
    --------
      calm tow tow.yaml
      calm tow tow.yaml --speeds "1 knot:12 knot:0.5 knot" --plot sweep.png
      calm tow tow.yaml --speeds "0.5 m/s:3 m/s:0.1 m/s" --csv sweep.csv
      calm tow tow.yaml --sensitivity
    """
    if speeds is not None and sensitivity:
        raise UsageError("give either --speeds or --sensitivity")
    if sensitivity and plot is not None:
        raise UsageError("--sensitivity is a table; it has no --plot")
    if schematic and (speeds is not None or sensitivity):
        raise UsageError("--schematic draws a tow at the speed of its file")
    chosen = None if speeds is None else options.speed_range(speeds)
    outputs = Outputs(tuple(files), json, csv, plot)
    tows = _only_tows(files, environment, catalog or [])
    options.show_units(units, [tow.file for tow in tows])
    if chosen is not None:
        return _tabulate(tows, outputs, lambda file, each: _sweep(file, each, chosen))
    if sensitivity:
        return _tabulate(tows, outputs, _vary)
    return run.solve_and_show(tows, outputs, schematic=schematic)


@dataclass(frozen=True)
class TabulatedTow:
    """A tow solved many times."""

    file: Path
    tabulation: Tabulation

    @property
    def code(self) -> ExitCode:
        failed = any(row.result is None for row in self.tabulation.rows)
        return ExitCode.NO_EQUILIBRIUM if failed else ExitCode.DONE

    @property
    def warnings(self) -> tuple[str, ...]:
        return self.tabulation.warnings

    def document(self) -> dict[str, Any]:
        from calm.report.tabulation import to_document

        return to_document(self.tabulation)

    def parts(self) -> list[Shows]:
        from calm.report.tabulation import tabulation_part

        return [tabulation_part(self.tabulation)]

    def rendered(self, suffix: str) -> bytes:
        from calm.drawing.picture import image
        from calm.report.tabulation import sweep_drawing

        return image(sweep_drawing(self.tabulation), suffix)


def _only_tows(files: list[Path], environment: str | None, catalogs: list[Path]) -> list[Tow]:
    from calm.case import Tow, net

    read = reading.read_all(net.load_line, files, environment, catalogs)
    moorings = [file for file, line in zip(files, read, strict=True) if not isinstance(line, Tow)]
    if moorings:
        raise UsageError(
            "; ".join(f"{file} is a mooring, not a tow: calm run {file}" for file in moorings)
        )
    return [line for line in read if isinstance(line, Tow)]


def _sweep(file: Path, each: Tow, speeds: list[float]) -> TabulatedTow:
    from calm.case.tow import SOLVES, sweep
    from calm.report.tabulation import by_speed
    from calm.solve import expect_many

    expect_many(SOLVES * len(speeds))
    outcomes = sweep(each, progress(speeds, f"speeds of {file}"))
    failed = [
        (speed, outcome)
        for speed, outcome in zip(speeds, outcomes, strict=True)
        if isinstance(outcome, NoEquilibrium)
    ]
    if failed:
        speed, failure = failed[0]
        narrate(
            f"{file}: no equilibrium at {len(failed)} of {len(speeds)} speeds; "
            f"at {speed:.3g} m/s, {failure}"
        )
    return TabulatedTow(file, by_speed(each, speeds, outcomes))


def _vary(file: Path, each: Tow) -> TabulatedTow:
    from calm.case.tow import sensitivity
    from calm.report.tabulation import by_coefficient

    return TabulatedTow(file, by_coefficient(each, sensitivity(each)))


def _tabulate(
    tows: Sequence[Tow], outputs: Outputs, tabulate: Callable[[Path, Tow], TabulatedTow]
) -> ExitCode:
    """Solve each tow many times, and write the outputs."""
    shown: list[TabulatedTow | FileOutcome] = []
    for file, each in zip(outputs.files, tows, strict=True):
        try:
            shown.append(tabulate(file, each))
        except NoEquilibrium as failure:  # no length of cable fits: there is nothing to tabulate
            narrate(f"{file}: {failure}")
            shown.append(FileOutcome(file, each.file.name, failure=failure))

    def to_csv() -> str:
        from calm.report.tabulation import to_csv

        return to_csv([each.tabulation for each in shown if isinstance(each, TabulatedTow)])

    outputs.write(shown, to_csv)
    return gravest(each.code for each in shown)


_Asked = Annotated[str, Parameter(allow_leading_hyphen=True)]


def strumming(
    *,
    angle: _Asked,
    speed: _Asked,
    diameter: _Asked,
    weight: options.Signed = None,
    solid_density: options.Signed = None,
    density: options.Signed = None,
    json: options.JsonAnswer = None,
) -> ExitCode:
    """Find how a bare towed cable vibrates from the angle at which it tows.

    Bourget & Marichal: a cable towed with nothing at its end is straight, and
    its angle gives its drag coefficient C*; the excess of C* over that of a
    cable at rest gives the amplitude a of its vibration. Give quantities with
    their units.

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
        Density of the water; 1025 kg/m^3 by default.

    Examples
    --------
      calm tow strumming --angle "30 deg" --speed "1 m/s" --diameter "17 mm" \\
          --weight "3.1 N/m"
      calm tow strumming --angle "18 deg" --speed "1.3 m/s" --diameter "17 mm" \\
          --solid-density "2383 kg/m^3" --density "1000 kg/m^3" --json -
    """
    from calm.report.tabulation import bare_cable_document, bare_cable_part

    outputs = Outputs(json=json)
    given = options.quantities(
        angle=(angle, "angle"), speed=(speed, "speed"), diameter=(diameter, "length"),
        weight=(weight, "force per length"), solid_density=(solid_density, "density"),
        density=(density, "density"),
    )  # fmt: skip
    cable = _cable(given)
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
        f"{options.option(name)} must be above 0" for name, value in given.items() if value <= 0.0
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
