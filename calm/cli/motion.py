"""``calm motion``: estimate the depths of a mooring's instruments at every time."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

from cyclopts import Parameter

from calm.cli import options
from calm.cli.batch import check_output, ended, stopped_by_a_signal
from calm.cli.outputs import ExitCode, OutputPath, Outputs, narrate, narrate_card
from calm.cli.progress import ProgressTeller
from calm.errors import UsageError

if TYPE_CHECKING:
    import numpy as np
    from xarray import Dataset

    from calm.motion.instrument_file import Instruments

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
    without: str | None = None,
    cross_validate: bool = False,
    correct: str | None = None,
    sea_level: Path | None = None,
    flags: str = "1,2",
    gap: str = "2 h",
    declination: options.Declination = None,
    onto: Path | None = None,
    json: OutputPath = None,
    report: Path | None = None,
    workers: options.Threads = None,
    environment: options.EnvironmentName = None,
    catalog: options.CatalogFiles = None,
) -> ExitCode:
    """Estimate the depth of every instrument over time from pressures and currents.

    CALM computes the shape of the line in the measured currents. From the
    pressures, it estimates the drag for the whole record, and corrects the
    current at each time step. The result has the depth of every component and
    clamped instrument with its standard deviation, and the residuals of the
    sensors. A current meter on the line is matched by its label, and its position
    is taken from the mooring file. If no current record is given, the currents
    are inferred from the pressures of two or more sensors.

    Parameters
    ----------
    pressures
        Pressures of sensors on the line, in one or more files. A NetCDF or CSV file names its
        sensors by their labels. For a file with a single sensor, write LABEL=FILE; it may also be
        a RODB or Sea-Bird .cnv file.
    output
        Result file, .nc.
    currents
        One or more records of the current: NetCDF, zarr or CSV. Write LABEL=FILE for the
        record of a single current meter.
    match
        How sensors are matched to the line: by label, or by nominal height or depth.
    fit
        Quantities to estimate for the whole record in addition to the drag: buoyancy, length.
    hold_out
        Labels of sensors to withhold at all times, separated by commas. The estimated depths of
        these sensors are compared with interpolation between the remaining sensors.
    without
        Labels of sensors to ignore completely, separated by commas.
    cross_validate
        Withhold each sensor in turn, and compare its measured depths with the estimate.
    correct
        Faults to correct in faulty sensors, separated by commas: clock, gain, offset, drift, and
        air (pressures that include the air pressure). The history attribute of the output lists the
        corrections.
    sea_level
        Height of the sea surface over time: NetCDF, or CSV with time,level[m].
    flags
        Use only pressures with these quality flags.
    gap
        Longest gap between values across which CALM interpolates in time.
    onto
        A NetCDF file of instruments, or a folder of such files. OUTPUT is then a copy to
        which depths are added with their standard deviations and flags (`depth` for several
        instruments, `DEPTH` for one). The result itself is written next to OUTPUT, with a
        name ending in .motion.nc. Instruments are identified by label, serial number or nominal
        depth.
    report
        Write a page and a PDF, motion.html and motion.pdf, in this folder.
    json
        Write the estimated factors and the depth residuals as JSON (- for standard output).

    Examples
    --------
      calm motion mooring.yaml --currents adcp.nc --pressures microcats.nc -o depths.nc
      calm motion mooring.yaml --currents meters.nc --pressures top.nc "release=p2.nc" -o depths.nc
      calm motion mooring.yaml --currents adcp.nc --pressures all.csv --cross-validate -o depths.nc
      calm motion mooring.yaml --pressures two.csv -o depths.nc
    """
    import xarray  # noqa: F401  # a missing extra is reported before a fault of a file

    from calm.batch import finished, profiles
    from calm.batch.compiling import compile_solver
    from calm.case import load
    from calm.files.mooring_file import refuse_all_but_moorings
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
    inputs, copy = [file, *files], output
    if onto is not None and onto.is_dir():
        check_folder(output)
        if output.resolve() == onto.resolve():
            raise UsageError(f"{output} is an input file and was not overwritten")
    else:
        check_output(output, *inputs)
    if onto is not None:
        output = output.with_suffix(".motion.nc")
        check_output(output, *inputs)
    mooring = load(file, environment, catalog or [])
    refuse_all_but_moorings(mooring.file)
    for notice in mooring.file.notices:
        narrate(f"{file}: {notice}")
    turned = options.quantities(declination=(declination, "angle")).get("declination")
    apart = options.span_of("--gap", gap, (0.0, _LONGEST_GAP), "0 and three years")
    instruments = None
    if onto is not None:
        instruments, matched = read_instruments(onto, places_of(mooring))
        for line in matched:
            narrate(line)

    recovery = RecoveredMooring(
        mooring, pressures, currents, match, _separated(fit), _separated(hold_out),
        cross_validate, _separated(correct), sea_level, flags, apart, turned,
        _separated(without),
    )  # fmt: skip
    for card in recovery.cards:
        narrate_card(card)
    for note in recovery.notes:
        narrate(note)
    teller = ProgressTeller()
    with stopped_by_a_signal(teller) as progress:
        compile_solver(profiles.Batch(mooring), teller.note)
        try:
            counts = recovery.estimate(output, workers=workers, progress=progress, tell=teller.note)
        finally:
            teller.clear()
        code = ended(counts, output)
        with finished.open_result(output) as result, finished.readable(output):
            study = recovery.study(result, narrate, workers)
            series = series_of(study, recovery.measured)
            if onto is not None and instruments is not None:
                inputs = [file, *files[:-1]]
                write_copies(instruments, result, apart, copy, inputs, recovery.source)
    name = mooring.file.name or file.stem
    if report is not None:
        given = recovery.measured.time, name, recovery.notes, recovery.cards
        write_pages(report, "motion", motion_report(study, series, *given))
    outputs.write_answer(
        lambda: motion_document(study, name, recovery.cards), motion_part(study, name)
    )
    return code


def write_copies(
    instruments: list[Instruments],
    result: Dataset,
    gap: np.timedelta64,
    output: Path,
    inputs: list[Path],
    source: dict[str, str],
) -> None:
    """Write a copy of each instrument file with the depths added; several copies are written to a
    folder.
    """
    from calm.dataset.discovery import hashed
    from calm.motion.instrument_file import write_depths

    sources = [*(hashed(path) for path in inputs), *filter(None, [source.get("corrected")])]
    folder = output.suffix != ".nc" or output.is_dir()
    if folder:
        output.mkdir(parents=True, exist_ok=True)
    for one in instruments:
        if all(point is None for point in one.point):
            narrate(
                f"The instrument in {one.path} matches no part of the line; no output was written "
                "for it"
            )
            continue
        name = one.path.name if one.path.suffix == ".nc" else f"{one.path.name}.nc"
        target = output / name if folder else output
        for label in write_depths(one, result, gap, target, sources):
            narrate(f"{one.path}: `{label}` matches no part of the line, so its depth is NaN")


def _separated(text: str | None) -> list[str]:
    return [] if text is None else [name.strip() for name in text.split(",")]
