"""``calm run``: solve moorings and tows, and show them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

from cyclopts import Parameter

from calm.cli import options, reading, tow_speeds
from calm.cli.outputs import ExitCode, OutputPath, Outputs, gravest
from calm.cli.solved_file import solve_files
from calm.errors import UsageError

if TYPE_CHECKING:
    from calm.case import Design


def run(
    files: list[Path],
    /,
    *,
    environment: options.EnvironmentName = None,
    catalog: options.CatalogFiles = None,
    json: OutputPath = None,
    csv: OutputPath = None,
    netcdf: Path | None = None,
    plot: Path | None = None,
    html: Path | None = None,
    pdf: Path | None = None,
    speeds: options.Signed = None,
    explain: bool = False,
    schematic: bool = False,
    uncertainty: bool = False,
    samples: options.Samples = 2048,
    seed: options.Seed = 0,
    units: options.Units = None,
    verbose: Annotated[bool, Parameter(name=["--verbose", "-v"], negative=())] = False,
) -> ExitCode:
    """Solve moorings, tows and nets of legs, and print the table of each line.

    All files are read first: if one cannot be used, its mistakes are listed and
    nothing is solved. The table is printed unless `-` asks for JSON or CSV; errors
    go to the standard error.

    Parameters
    ----------
    files
        Mooring files; one with `tow:` is a tow, one with `legs:` a net.
    json
        Write the result as JSON, - to print it; several files give an array.
    csv
        Write the components, or with --speeds the speeds, as CSV, units in the header,
        - to print it.
    netcdf
        Write the result as NetCDF, with the names of `calm batch`; for several files one
        each, as with --plot.
    plot
        Draw it, as .svg, .png or .pdf; for several files p.png becomes p-FILE.png.
    html
        Write a report of the line, its table, drawings and inputs, as one
        self-contained .html file; for several files one each, as with --plot.
    pdf
        Write the same report as .pdf.
    speeds
        Solve tows at the speeds A:B:STEP, both ends included, and print a row for each;
        --plot draws depth, layback and tension against speed. A speed without
        equilibrium is a row with its status and makes the exit code 3.
    explain
        Show the contribution of each drag force to the knockdown, and the effect of
        more buoyancy, less drag or another current; also in the JSON. Not for tows.
    schematic
        Print a schematic (not to scale) above the table, or instead of it if there
        is no equilibrium.
    uncertainty
        Solve each mooring for many samples of the inputs under `uncertainty` in
        its file (current, drag, buoyancy, lengths, depth), and print the 5th, 50th
        and 95th percentiles of the results and the contribution of each input to
        the spread; also in the JSON, the plot and the reports.
    verbose
        Also print the numerical error and solver statistics.

    Examples
    --------
      calm run mooring.yaml
      calm run mooring.yaml --environment storm --plot storm.png
      calm run mooring.yaml --csv components.csv --json result.json
      calm run mooring.yaml --explain
      calm run mooring.yaml --uncertainty --plot band.png
      calm run mooring.yaml --schematic
      calm run mooring.yaml --html mooring.html --pdf mooring.pdf
      calm run spring.yaml neap.yaml tow.yaml --json -
      calm run tow.yaml --speeds "1 knot:12 knot:0.5 knot" --plot speeds.png
    """
    outputs = Outputs(tuple(files), json, csv, plot, html, pdf, netcdf)
    draws = options.draws_of(uncertainty, samples, seed)
    chosen = None if speeds is None else tow_speeds.speed_range(speeds)
    single = {
        "--netcdf": netcdf, "--html": html, "--pdf": pdf, "--explain": explain,
        "--schematic": schematic, "--uncertainty": uncertainty, "--verbose": verbose,
    }  # fmt: skip
    if chosen is not None and (asked := [option for option, value in single.items() if value]):
        raise UsageError(f"{', '.join(asked)} cannot be combined with --speeds")
    from calm.case import load
    from calm.files.legs import NET_SURE

    lines = reading.read_all(load, files, environment, catalog or [])
    options.show_units(units, [line.file for line in lines])
    drawn = {"--uncertainty": uncertainty}
    towed, moored = ([line for line in lines if line.towed is moves] for moves in (True, False))
    _refuse({"--explain": explain} | drawn, "moorings; these are tows", towed)
    _refuse(drawn, NET_SURE, [line for line in lines if line.several])
    _refuse({"--speeds": chosen}, "tows; these are moorings", moored)
    if chosen is not None:
        return tow_speeds.tabulate(lines, outputs, chosen)
    outcomes = solve_files(
        files, lines, explain=explain, schematic=schematic, draws=draws, verbose=verbose
    )

    def to_csv() -> str:
        from calm.report.result_files import to_csv

        return to_csv([outcome.result for outcome in outcomes if outcome.result is not None])

    outputs.write(outcomes, to_csv)
    return gravest(outcome.code for outcome in outcomes)


def _refuse(options: Mapping[str, object], what: str, designs: Sequence[Design]) -> None:
    """Reject the first of the options if there are designs that it does not apply to."""
    asked = [option for option, value in options.items() if value]
    if asked and designs:
        raise UsageError(f"{asked[0]} is for {what}: {', '.join(one.file.path for one in designs)}")
