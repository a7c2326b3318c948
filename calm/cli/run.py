"""``calm run``: solve moorings and tows, and show them."""

from __future__ import annotations

import sys
from collections.abc import Callable, Mapping, Sequence
from functools import partial
from itertools import zip_longest
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

from cyclopts import Parameter

from calm.cli import options, reading
from calm.cli.outputs import ExitCode, FileOutcome, OutputPath, Outputs, gravest, narrate
from calm.errors import NoEquilibrium, UsageError

if TYPE_CHECKING:
    from calm.case import Mooring, Result, Tow
    from calm.case.explain import Explanation
    from calm.case.net import Net
    from calm.case.result import AnyResult, NetResult
    from calm.case.uncertain import Uncertain
    from calm.drawing.schematic.in_terminal import TerminalSchematic


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
        Write the components as CSV, units in the header, - to print it.
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
    explain
        Show how much of the knockdown each drag causes, and the effect of more
        buoyancy, less drag or another current; in the JSON too. Not of tows.
    schematic
        Draw the line, part by part and not to scale, above its table; in its
        place if there is no equilibrium.
    uncertainty
        Solve each mooring for many samples of the inputs under `uncertainty` in
        its file (current, drags, buoyancy, lengths, depth), and show the 5, 50
        and 95 % points of its figures and the causes of their spread; in the
        JSON, the picture and the reports too.
    verbose
        Also say below the table how the solution was found.

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
    """
    outputs = Outputs(tuple(files), json, csv, plot, html, pdf, netcdf)
    draws = draws_of(uncertainty, samples, seed)
    from calm.case import Tow, net
    from calm.files.legs import NET_SURE

    lines = reading.read_all(net.load, files, environment, catalog or [])
    options.show_units(units, [line.file for line in lines])
    drawn = {"--uncertainty": uncertainty}
    _refuse({"--explain": explain} | drawn, "moorings; these are tows", Tow, files, lines)
    _refuse(drawn, NET_SURE, net.Net, files, lines)
    return solve_and_show(
        lines, outputs, explain=explain, schematic=schematic, draws=draws, verbose=verbose
    )


def draws_of(uncertainty: bool, samples: int, seed: int) -> tuple[int, int] | None:
    """Samples and seed by which to say how sure the figures are; None where that is not asked.

    UsageError: a number of samples that is not a power of two; a seed below zero; either without
    need.
    """
    from calm.case.draws import SAMPLES, checked_samples

    if not uncertainty:
        for option, value, usual in (("--samples", samples, SAMPLES), ("--seed", seed, 0)):
            if value != usual:
                raise UsageError(f"{option}: {value} needs --uncertainty")
        return None
    checked_samples(samples)
    if seed < 0:
        raise UsageError(f"--seed: {seed} is below 0")
    return samples, seed


def solve_and_show(
    lines: Sequence[Mooring | Tow | Net],
    outputs: Outputs,
    *,
    explain: bool = False,
    schematic: bool = False,
    draws: tuple[int, int] | None = None,
    verbose: bool = False,
) -> ExitCode:
    """Solve what was read from the files of the outputs, and write those.

    Parameters
    ----------
    explain, schematic : explain what was solved; draw each line for the terminal
    draws : samples and seed by which to say how sure the figures are
    verbose : say how each solution was reached
    """
    from calm.case import Result
    from calm.case.result import NetResult

    drawn_often = None if draws is None else _to_draw_often(*draws)
    outcomes = []
    for file, line in zip(outputs.files, lines, strict=True):
        result, failure = _solved(file, line)
        mooring = result if isinstance(result, Result) else None
        moored = result if isinstance(result, Result | NetResult) else None
        outcomes.append(FileOutcome(
            file, line.file.name, result, failure, verbose=verbose,
            explanation=_explained(moored) if moored and explain else None,
            schematic=_schematic(line, result) if schematic else (),
            uncertain=drawn_often(mooring) if mooring and drawn_often else None,
        ))  # fmt: skip

    def to_csv() -> str:
        from calm.report.result_files import to_csv

        return to_csv([outcome.result for outcome in outcomes if outcome.result is not None])

    outputs.write(outcomes, to_csv)
    return gravest(outcome.code for outcome in outcomes)


def _solved(file: Path, line: Mooring | Tow | Net) -> tuple[AnyResult | None, NoEquilibrium | None]:
    """Return the result, or why there is none."""
    try:
        return line.solve(), None
    except NoEquilibrium as failure:
        for notice in line.file.notices:  # a result has them among its warnings
            narrate(f"{file}: {notice}")
        narrate(f"{file}: {failure}")
        return None, failure


def _refuse(
    options: Mapping[str, object],
    what: str,
    kind: type,
    files: Sequence[Path],
    lines: Sequence[Mooring | Tow | Net],
) -> None:
    """Refuse the first option that is asked for, where a file is of a kind it is not for."""
    asked = [option for option, value in options.items() if value]
    those = [str(file) for file, line in zip(files, lines, strict=True) if isinstance(line, kind)]
    if asked and those:
        raise UsageError(f"{asked[0]} is for {what}: {', '.join(those)}")


def _explained(result: Result | NetResult) -> Explanation:
    from calm.case.explain import explain

    return explain(result)


def _to_draw_often(samples: int, seed: int) -> Callable[[Result], Uncertain]:
    """Return what says how sure the figures of a mooring that stands are.

    The sequence is begun now: scipy takes as long to load as the compiled march.
    """
    from calm.case.draws import normals_of
    from calm.case.uncertain import uncertain
    from calm.cli.progress import begun, mapped

    normals = begun(normals_of, samples, seed)
    solved = partial(mapped, workers=None, what="blocks of samples solved")
    return lambda result: uncertain(result, samples, seed, solved, normals)


def _schematic(
    line: Mooring | Tow | Net, result: AnyResult | None
) -> tuple[TerminalSchematic, ...]:
    """Draw a line, or its legs, in the signs that the standard output can carry."""
    from calm.case.net import Net
    from calm.case.result import NetResult
    from calm.drawing.schematic.in_terminal import TerminalSchematic, can_carry

    plain = not can_carry(getattr(sys.stdout, "encoding", None))
    results = result.legs if isinstance(result, NetResult) else [result]
    lines = line.lines if isinstance(line, Net) else [line]
    pairs = zip_longest(lines, results)
    return tuple(TerminalSchematic(of.file, one, plain) for of, one in pairs)
