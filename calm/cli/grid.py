"""``calm grid``: interpolate measurements at moving depths onto fixed levels."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

from cyclopts import Parameter

from calm.cli import options
from calm.cli.batch import check_output
from calm.cli.outputs import ExitCode, OutputPath, Outputs, narrate, narrate_card
from calm.cli.progress import progress


def grid(
    depths: Path,
    values: Annotated[list[str], Parameter(negative=())],
    /,
    *,
    output: options.OutputFile,
    levels: str,
    step: str | None = None,
    variables: str | None = None,
    method: str = "depth-time",
    flags: str = "1,2",
    report: Path | None = None,
    json: OutputPath = None,
) -> ExitCode:
    """Map temperature, salinity and velocity from moving instruments onto fixed
    levels.

    The method is a Gaussian process over depth and time. Its scales are estimated
    from the record. Each value has a standard deviation, which includes the sensor
    error, the depth error times the local gradient, and the error of interpolation
    between sensors. Each value has a flag. Flag 8 marks a value between the sensors
    at that time. Flag 3 marks a value beyond the sensors, or a value that the data
    constrain poorly. Flag 9 marks a missing value.

    Parameters
    ----------
    depths
        Result file of calm motion.
    values
        NetCDF files of instruments, or folders of such files. The instruments are identified
        by label, serial number or nominal depth; for a file without these, write LABEL=FILE.
    output
        Gridded output file, .nc.
    levels
        Levels of the grid: FIRST:STEP:LAST in metres, such as "0:20:1500", or depths separated by
        commas.
    step
        Write means over intervals of this length, such as "1 h"; by default, values at the times of
        DEPTHS are written.
    variables
        Variables to map: temperature, salinity, u, v; by default, all of these that the files
        contain. If you write TEMP, PSAL, UCUR or VCUR, the output has the OceanSITES names in
        capitals.
    method
        Method of interpolation: depth-time, or depth, which treats each time step separately.
    flags
        Use only values with these quality flags as measurements; values with flag 8 are never used.
    report
        Write a page and a PDF, grid.html and grid.pdf, in this folder.
    json
        Write the scales and a summary of the input as JSON (- for standard output).

    Examples
    --------
      calm grid depths.nc microcats.nc -o gridded.nc --levels "0:20:1500"
      calm grid depths.nc instruments/ -o gridded.nc --levels "100:25:700" --step "1 h"
      calm grid depths.nc stack.nc -o OS_M1_D.nc --levels 50,100,200 --variables TEMP,PSAL
    """
    from calm.gridding.gridded_record import read_gridded
    from calm.gridding.product import parse_levels
    from calm.records.instrument_series import files_given
    from calm.report.folder import check_folder, write_pages
    from calm.report.grid_report import grid_document, grid_part, grid_report

    outputs = Outputs((depths,), json)
    wanted = parse_levels(levels)
    width = (
        None
        if step is None
        else options.span_of("--step", step, (1.0, 366 * 86_400.0), "a second and a year")
    )
    check_output(output, depths, *(path for _, path in files_given(values)))
    if report is not None:
        import matplotlib  # noqa: F401  (missing, it is reported before the work)

        check_folder(report)
    record = read_gridded(
        depths, values, wanted, step=width, averaged=step, variables=variables, method=method,
        flags=flags, report=narrate, show=narrate_card,
    )  # fmt: skip
    record.write(output, lambda each: progress(each, "blocks of times"))
    narrate(f"{output} written")
    if report is not None:
        write_pages(report, "grid", grid_report(output, record))
    outputs.write_answer(lambda: grid_document(record), grid_part(record.fields))
    return ExitCode.DONE
