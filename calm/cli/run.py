"""``calm run``: solve moorings and tows, and show the results."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Literal

from cyclopts import Parameter

from calm.cli import options, reading, tow_speeds
from calm.cli.outputs import STDOUT, SUFFIXES, ExitCode, Outputs, gravest
from calm.cli.solved_file import solve_files
from calm.errors import UsageError

if TYPE_CHECKING:
    from cyclopts import Token

    from calm.case import Design


def _require_dash(_: object, tokens: Sequence[Token]) -> str:
    if (value := tokens[0].value) != "-":
        raise UsageError(
            f"--json {value}: the value must be -, which prints the result; use -o FILE.json to "
            "write a file"
        )
    return value


PrintedJson = Annotated[
    Literal["-"] | None, Parameter(allow_leading_hyphen=True, converter=_require_dash)
]


def run(
    files: list[Path],
    /,
    *,
    environment: options.EnvironmentName = None,
    catalog: options.CatalogFiles = None,
    output: Annotated[list[Path] | None, Parameter(alias="-o", allow_leading_hyphen=True)] = None,
    json: PrintedJson = None,
    speeds: options.Signed = None,
    explain: bool = False,
    schematic: bool = False,
    uncertainty: bool = False,
    samples: options.Samples = 2048,
    units: options.Units = None,
    verbose: Annotated[bool, Parameter(name=["--verbose", "-v"], negative=())] = False,
) -> ExitCode:
    """Solve moorings, tows and nets of legs, and print the table of each line.

    All files are read first. If a file has mistakes, all mistakes are listed and
    nothing is solved. Error messages go to standard error.

    Parameters
    ----------
    files
        Mooring files. A file with `tow:` describes a tow; a file with `legs:` describes a net of
        mooring legs.
    output
        Write the result to this file, in the format of its suffix. Repeatable. All moorings are
        written to a single .json or .csv file. The .csv file has a row per component or, with
        --speeds, a row per speed. In the other formats, each mooring gets its own file; for several
        moorings, p.svg becomes p-FILE.svg. The formats .svg and .png give a drawing of the line,
        .html and .pdf a report with table, drawings and inputs, and .nc a NetCDF file with the
        variable names of `calm batch`.
    json
        Print the result as JSON instead of the table; several files give an array.
    speeds
        Solve tows at the speeds from A to B in steps of STEP, and print a row for each
        speed; -o draws depth, layback and tension against speed. If there is no equilibrium
        at a speed, its row has only the status, and the exit code is 3.
    explain
        Show the contribution of each drag force to the knockdown, and the effect of
        more buoyancy, less drag, and more or less current. Also applies to --json. Not for tows.
    schematic
        Print a schematic (not to scale) above the table, or instead of it if there
        is no equilibrium.
    uncertainty
        Solve each mooring for many samples of the inputs under `uncertainty` in
        its file (current, drag, buoyancy, lengths, depth), and print the 5th, 50th
        and 95th percentiles of the results and the contribution of each input to
        the spread. The JSON, the plot and the reports include these, too.
    verbose
        Also print the numerical error and solver statistics.

    Examples
    --------
      calm run mooring.yaml
      calm run mooring.yaml --environment storm -o storm.png
      calm run mooring.yaml -o components.csv -o result.json
      calm run mooring.yaml --explain
      calm run mooring.yaml --uncertainty -o band.svg
      calm run mooring.yaml --schematic
      calm run mooring.yaml -o mooring.html -o mooring.pdf
      calm run spring.yaml neap.yaml tow.yaml --json -
      calm run tow.yaml --speeds "1 knot:12 knot:0.5 knot" -o speeds.svg
    """
    suffixes = SUFFIXES if speeds is None else tow_speeds.SUFFIXES
    outputs = Outputs(tuple(files), json and STDOUT, tuple(output or ()), suffixes)
    draws = options.draws_of(uncertainty, samples)
    chosen = None if speeds is None else tow_speeds.speed_range(speeds)
    single = {
        "--explain": explain, "--schematic": schematic, "--uncertainty": uncertainty,
        "--verbose": verbose,
    }  # fmt: skip
    if chosen is not None and (excluded := [option for option, value in single.items() if value]):
        raise UsageError(f"{', '.join(excluded)} cannot be combined with --speeds")
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
    chosen = [option for option, value in options.items() if value]
    if chosen and designs:
        raise UsageError(
            f"{chosen[0]} is only for {what}: {', '.join(one.file.path for one in designs)}"
        )
