"""``calm motion`` and ``calm grid``: where instruments were, and what they measured on levels."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

from cyclopts import Parameter

from calm.cli import options
from calm.cli.batch import check_output, ended, stopped_by_a_signal
from calm.cli.outputs import ExitCode, OutputPath, Outputs, narrate, show_parts
from calm.cli.progress import ProgressTeller, progress
from calm.errors import UsageError

if TYPE_CHECKING:
    import numpy as np
    from xarray import Dataset

    from calm.grid.field import GriddedQuantity
    from calm.grid.samples import MooringDepths
    from calm.motion.instrument_file import Instruments
    from calm.records.instrument_series import InstrumentSeries

_LONGEST_GAP = 1e8  # s
SeveralTexts = Annotated[list[str], Parameter(consume_multiple=True)]


def motion(
    file: options.MooringPath,
    /,
    *,
    pressures: SeveralTexts,
    output: options.OutputFile,
    currents: SeveralTexts | None = None,
    match: str = "label",
    fit: str | None = None,
    hold_out: str | None = None,
    cross_validate: bool = False,
    correct: str | None = None,
    judge: str = "",
    prior: Path | None = None,
    sea_level: Path | None = None,
    flags: str = "1,2",
    gap: str = "2 h",
    declination: options.Declination = None,
    onto: Path | None = None,
    replace_depth: Annotated[bool, Parameter(name="--replace")] = False,
    json: OutputPath = None,
    report: Path | None = None,
    workers: options.Threads = None,
    environment: options.EnvironmentName = None,
    catalog: options.CatalogFiles = None,
) -> ExitCode:
    """Estimate the depth of every instrument at every time from pressures and currents.

    The currents move the line; the pressures correct the drag for the whole
    record, and the current at each time. The result has the depth of every
    component and clamped instrument with its standard deviation, and the
    residuals of the sensors. A current meter on the line is matched by its
    label and placed where the line has it. Without currents, they are inferred
    from the pressures of two or more sensors.

    However a run is interrupted, the same command resumes it; the exit code is 75
    until everything is solved.

    Parameters
    ----------
    pressures
        Pressures of sensors on the line, one file or more: NetCDF or CSV with their
        labels, or one sensor each as LABEL=FILE, in RODB or Sea-Bird's .cnv too.
    output
        The result: a .nc file or a .zarr folder.
    currents
        Records of the current, one or more: NetCDF, zarr or CSV; one of a single meter
        may be LABEL=FILE.
    match
        How sensors are found on the line: by label, or by nominal height or depth.
    fit
        What to estimate for the whole record besides the drag: buoyancy, length.
    hold_out
        Labels of sensors, separated by commas, to hide everywhere; the result
        at these is compared with interpolation between the others.
    cross_validate
        Hide each sensor in turn, and compare.
    correct
        What to correct where a sensor is found wrong, separated by commas: clock,
        gain, offset, drift; air, where pressures are absolute. The history of the
        output says what was corrected.
    judge
        Label of a suspicious sensor: it is hidden as with --hold-out, and whether its
        pressures fit the line is said, with the odds: yes, no, or cannot tell.
    prior
        A record of currents near the mooring, of any time, such as a hindcast: without
        --currents the shapes of its profiles are taken, not their strength.
    sea_level
        Height of the sea surface over time: NetCDF, or CSV with time,level[m].
    flags
        Quality flags of the pressures that count as measured.
    gap
        Interpolate in time between values no further apart than this.
    onto
        A NetCDF file of instruments, or a folder of files: OUTPUT is then a
        copy of it with depths, their deviations and flags added (`depth` of
        several instruments, `DEPTH` of one), and the result itself is written
        beside it, with a name ending in .motion.nc. Found by label, serial
        number or nominal depth.
    replace_depth
        Replace depths that files of `--onto` already have, in the copy.
    report
        Write a page and a PDF, motion.html and motion.pdf, in this folder.
    json
        Write the factors and how well depths agree as JSON, - to print it.

    Examples
    --------
      calm motion mooring.yaml --currents adcp.nc --pressures microcats.nc -o depths.nc
      calm motion mooring.yaml --currents meters.nc --pressures top.nc "release=p2.nc" -o depths.nc
      calm motion mooring.yaml --currents adcp.nc --pressures all.csv --cross-validate -o depths.nc
      calm motion mooring.yaml --pressures two.csv -o depths.nc
    """

    from calm.batch import finished, profiles, work
    from calm.case import Tow
    from calm.case.net import load_line
    from calm.motion.instrument_file import read_instruments
    from calm.motion.matching import places_of
    from calm.motion.motion_estimate import RecoveredMooring
    from calm.motion.study import series_of
    from calm.records.instrument_series import split_label
    from calm.report.folder import check_folder, write_pages
    from calm.report.motion_report import motion_document, motion_part, motion_report

    options.from_one(workers=workers)
    outputs = Outputs(files=(file,), json=json)
    if report is not None:
        check_folder(report)
    currents = currents or []
    files = [split_label(text)[1] for text in (*currents, *pressures)]
    files += [path for path in (sea_level, onto) if path is not None]
    check_output(output, file, *files, *filter(None, [prior]))
    copy = output
    if onto is not None:
        if onto.is_dir():
            check_folder(output)
            if output.resolve() == onto.resolve():
                raise UsageError(f"{output} is an input; it is kept")
        elif output.suffix != ".nc":
            raise UsageError(f"cannot write {output}: the name of a copy must end in .nc")
        output = output.with_suffix(".motion.nc")
        check_output(output, file, *files)
    elif replace_depth:
        raise UsageError("--replace needs --onto")
    mooring = load_line(file, environment, catalog or [])
    if isinstance(mooring, Tow):
        raise UsageError(f"{file} is a tow; calm motion is for moorings")
    for notice in mooring.file.notices:
        narrate(f"{file}: {notice}")
    turned = options.quantities(declination=(declination, "angle")).get("declination")
    apart = options.span_of("--gap", gap, (0.0, _LONGEST_GAP), "0 and three years")
    instruments = None
    if onto is not None:
        instruments, matched = read_instruments(onto, places_of(mooring), replacing=replace_depth)
        for line in matched:
            narrate(line)

    recovery = RecoveredMooring(
        mooring, pressures, currents, match, _separated(fit), _separated(hold_out),
        cross_validate, _separated(correct), judge, sea_level, flags, apart, turned, prior,
    )  # fmt: skip
    for note in recovery.notes:
        narrate(note)
    teller = ProgressTeller()
    with stopped_by_a_signal() as stop:
        work.compile_solver(profiles.Batch(mooring), teller.note)
        try:
            outcome = recovery.estimate(
                output, workers=workers, progress=teller, tell=teller.note, stop=stop
            )
        finally:
            teller.clear()
        code = ended(outcome, output, len(recovery.measured.time))
        if not outcome.done:
            return code
        with finished.open_result(output) as result, finished.readable(output):
            study = recovery.study(result, narrate, workers)
            series = series_of(study, recovery.measured)
            if onto is not None and instruments is not None:
                inputs = [file, *files[:-1]]
                write_copies(instruments, result, apart, copy, inputs, recovery.source)
    name = mooring.file.name or file.stem
    if report is not None:
        given = recovery.measured.time, name, recovery.notes
        write_pages(report, "motion", motion_report(study, series, *given))
    outputs.write_answer(lambda: motion_document(study, name), motion_part(study, name))
    return code


def write_copies(
    instruments: list[Instruments],
    result: Dataset,
    gap: np.timedelta64,
    output: Path,
    inputs: list[Path],
    source: dict[str, str],
) -> None:
    """Write the copy of each file, into a folder where they come from one."""
    from calm.dataset.discovery import hashed
    from calm.motion.instrument_file import write_depths

    told = [*(hashed(path) for path in inputs), *filter(None, [source.get("corrected")])]
    folder = output.suffix != ".nc" or output.is_dir()
    if folder:
        output.mkdir(parents=True, exist_ok=True)
    for one in instruments:
        if all(point is None for point in one.point):
            narrate(f"{one.path}: no part of the line; it is not written")
            continue
        name = one.path.name if one.path.suffix == ".nc" else f"{one.path.name}.nc"
        target = output / name if folder else output
        for label in write_depths(one, result, gap, target, told):
            narrate(f"{one.path}: `{label}` is not a part of the line; its depth is NaN")


def _separated(text: str | None) -> list[str]:
    return [] if text is None else [name.strip() for name in text.split(",")]


METHODS = ("depth-time", "depth")


def grid(
    depths: Path,
    values: Annotated[list[str], Parameter(negative=())],
    /,
    *,
    output: options.OutputFile,
    levels: str,
    step: str | None = None,
    variables: str | None = None,
    method: str = METHODS[0],
    flags: str = "1,2",
    report: Path | None = None,
) -> ExitCode:
    """Put temperature, salinity and velocity at their moving depths onto fixed levels.

    A Gaussian process over depth and time, with the scales of the record
    itself. Each value has a standard deviation, which includes the sensor, the
    error of its depth times the local gradient, and the gap between sensors;
    and a flag: 8 between the sensors at that time, 3 beyond them or where the
    record says little, 9 for no value.

    Parameters
    ----------
    depths
        A result of calm motion.
    values
        NetCDF files of instruments, by label, serial number or nominal depth;
        files of one instrument as LABEL=FILE, if they do not say which; or
        folders of files.
    output
        The gridded file, .nc.
    levels
        FIRST:STEP:LAST in metres, such as "0:20:1500", or several with commas.
    step
        Values are means over this time, such as "1 h"; by default at the times
        of DEPTHS.
    variables
        temperature, salinity, u, v; by default all that are in the files. As
        TEMP, PSAL, UCUR, VCUR, all names in the file are in capitals, as in
        OceanSITES.
    method
        depth-time, or depth, which treats each time separately.
    flags
        Quality flags of the values that count as measured; 8 never does.
    report
        Write a page and a PDF, grid.html and grid.pdf, in this folder.

    Examples
    --------
      calm grid depths.nc microcats.nc -o gridded.nc --levels "0:20:1500"
      calm grid depths.nc instruments/ -o gridded.nc --levels "100:25:700" --step "1 h"
      calm grid depths.nc stack.nc -o OS_M1_D.nc --levels 50,100,200 --variables TEMP,PSAL
    """
    from calm.dataset.discovery import hashed
    from calm.drawing.plot import require_matplotlib
    from calm.errors import not_among
    from calm.grid.product import grid_layout, parse_levels, write_grid
    from calm.grid.samples import read_depths
    from calm.motion.sensors import parse_flags
    from calm.quantities import QUANTITIES_MEASURED, chosen_quantities
    from calm.records.instrument_series import files_given, read_series
    from calm.report.folder import check_folder, write_pages
    from calm.report.grid_report import grid_part, grid_report

    if method not in METHODS:
        raise UsageError(not_among("--method", method, METHODS))
    wanted, names = parse_levels(levels), chosen_quantities(variables)
    good = parse_flags(flags)
    width = (
        None
        if step is None
        else options.span_of("--step", step, (1.0, 366 * 86_400.0), "a second and a year")
    )
    if output.suffix != ".nc":
        raise UsageError(f"cannot write {output}: its name must end in .nc")
    files = files_given(values)
    check_output(output, depths, *(path for _, path in files))
    if report is not None:
        require_matplotlib("calm grid --report")
        check_folder(report)
    where = read_depths(depths)
    series = read_series(values, names, good, where.seabed)
    if variables is not None:
        for name in names:
            if not series[name]:
                raise UsageError(f"--variables: no file holds {name}")
    fields = fields_of(where, series, width, in_time=method == METHODS[0])
    archived = variables is not None and variables.isupper()
    called = {name: QUANTITIES_MEASURED[name].archive if archived else name for name in fields}
    inputs = [hashed(depths), *(hashed(path) for _, path in files)]
    layout = grid_layout(fields, wanted, where, inputs, called, step)
    write_grid(
        layout, fields, wanted, called, output, lambda each: progress(each, "blocks of times")
    )
    show_parts(grid_part(fields))
    if report is not None:
        write_pages(report, "grid", grid_report(output, fields, called, wanted))
    return ExitCode.DONE


def fields_of(
    where: MooringDepths,
    series: dict[str, list[InstrumentSeries]],
    step: np.timedelta64 | None,
    *,
    in_time: bool,
) -> dict[str, GriddedQuantity]:
    """The field of each quantity; one that has too few instruments is left out, and said.

    UsageError: none is left; no time is common; no instrument is of the line.
    """
    import numpy as np

    from calm.grid.field import field_of
    from calm.grid.samples import common_times, gather
    from calm.motion.matching import points_of
    from calm.quantities import QUANTITIES_MEASURED

    matched = {name: points_of(each, where.places) for name, each in series.items() if each}
    told = [line for _, said in matched.values() for line in said]
    for line in dict.fromkeys(told):
        narrate(line)
    used = [series[name][i] for name, (points, _) in matched.items() for i in points]
    time = common_times(where, used, step)
    fields, reasons = {}, []
    for name, (points, _) in matched.items():
        samples = gather(where, series[name], points, time)
        dropped = sum(series[name][i].dropped for i in points)
        if dropped:
            narrate(f"{name}: {dropped} values are left out because of their flag")
        for i, at in points.items():
            one, column = series[name][i], samples.label.index(where.places.label[at])
            had = one.dropped or np.isfinite(one.value).any()
            if had and not np.isfinite(samples.value[:, column]).any():
                narrate(f"{name}: {where.places.label[at]} has no good value at any of the times")
        try:
            fields[name] = field_of(samples, QUANTITIES_MEASURED[name].noise, in_time=in_time)
        except UsageError as error:
            reasons.append(f"{name}: {error}")
    if not fields:
        raise UsageError("; ".join(reasons))
    for reason in reasons:
        narrate(f"{reason}: it is left out")
    return fields
