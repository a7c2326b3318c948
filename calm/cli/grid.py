"""``calm grid``: interpolate measurements at moving depths onto fixed levels."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

from cyclopts import Parameter

from calm.cli import options
from calm.cli.batch import check_output
from calm.cli.outputs import ExitCode, OutputPath, Outputs, narrate, narrate_card
from calm.cli.progress import progress
from calm.errors import UsageError

if TYPE_CHECKING:
    import numpy as np

    from calm.grid.field import GriddedQuantity
    from calm.grid.samples import MooringDepths, Samples
    from calm.records.instrument_series import InstrumentSeries

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
    json: OutputPath = None,
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
    json
        Write the scales and what was read as JSON, - to print it.

    Examples
    --------
      calm grid depths.nc microcats.nc -o gridded.nc --levels "0:20:1500"
      calm grid depths.nc instruments/ -o gridded.nc --levels "100:25:700" --step "1 h"
      calm grid depths.nc stack.nc -o OS_M1_D.nc --levels 50,100,200 --variables TEMP,PSAL
    """
    from calm.dataset.discovery import hashed
    from calm.errors import not_among
    from calm.grid.product import grid_layout, parse_levels, write_grid
    from calm.grid.samples import read_depths
    from calm.motion.sensors import parse_flags
    from calm.quantities import QUANTITIES_MEASURED, chosen_quantities
    from calm.records.instrument_series import files_given, read_series
    from calm.report.folder import check_folder, write_pages
    from calm.report.grid_report import grid_document, grid_part, grid_report

    outputs = Outputs((depths,), json)
    if method not in METHODS:
        raise UsageError(not_among("--method", method, METHODS))
    wanted, names = parse_levels(levels), chosen_quantities(variables)
    good = parse_flags(flags)
    width = (
        None
        if step is None
        else options.span_of("--step", step, (1.0, 366 * 86_400.0), "a second and a year")
    )
    files = files_given(values)
    check_output(output, depths, *(path for _, path in files))
    if report is not None:
        import matplotlib  # noqa: F401  (missing, it is reported before the work)

        check_folder(report)
    where = read_depths(depths)
    series = read_series(values, names, good, where.seabed)
    everything = [one for each in series.values() for one in each]
    cards = [*{id(one.card): one.card for one in everything if one.card is not None}.values()]
    for card in cards:
        narrate_card(card)
    for line in dict.fromkeys(f"{one.source}: {one.note}" for one in everything if one.note):
        narrate(line)
    if variables is not None:
        for name in names:
            if not series[name]:
                raise UsageError(f"--variables: no file holds {name}")
    fields = fields_of(where, series, width, in_time=method == METHODS[0])
    archived = variables is not None and variables.isupper()
    called = {name: QUANTITIES_MEASURED[name].archive if archived else name for name in fields}
    inputs = [hashed(depths), *(hashed(path) for _, path in files)]
    layout = grid_layout(fields, wanted, where, inputs, called, step, cards)
    write_grid(
        layout, fields, wanted, called, output, lambda each: progress(each, "blocks of times")
    )
    narrate(f"{output} written")
    if report is not None:
        write_pages(report, "grid", grid_report(output, fields, called, wanted, cards))
    outputs.write_answer(lambda: grid_document(fields, cards), grid_part(fields))
    return ExitCode.DONE


def exchanged(
    where: MooringDepths,
    samples: Samples,
    name: str,
    series: list[InstrumentSeries],
    points: dict[int, int],
) -> Iterator[str]:
    """Yield instruments whose files look exchanged.

    The pressures in a file are those of another place, or two mean values in the wrong order.
    """
    import numpy as np

    from calm.grid.samples import ANOTHER_PLACE
    from calm.records.value_tests import exchanged_pair

    labels = where.places.label
    for i, at in points.items():
        usual = float(np.nanmedian(where.depth[:, at]))
        one, here = series[i], f"`{labels[at]}` was at {usual:.0f} m"
        if abs(one.pressure - usual) > max(ANOTHER_PLACE, 0.1 * usual):
            yield (
                f"{one.source}: the median of its pressures is {one.pressure:.0f} dbar, where "
                f"{here}: are two files exchanged?"
            )
        if one.called in labels and one.called != labels[at]:
            yield f"{one.source}: given as `{labels[at]}`, and calls itself `{one.called}`"
    if name == "temperature":
        known = [column[np.isfinite(column)] for column in samples.value.T]
        means = np.array([column.mean() if column.size else np.nan for column in known])
        if pair := exchanged_pair(means):
            upper, lower = (samples.label[i] for i in pair)
            yield (
                f"{name}: only if `{upper}` and `{lower}` are exchanged do the means of all "
                f"{len(means)} instruments fall or rise with depth: are two files exchanged?"
            )


def fields_of(
    where: MooringDepths,
    series: dict[str, list[InstrumentSeries]],
    step: np.timedelta64 | None,
    *,
    in_time: bool,
) -> dict[str, GriddedQuantity]:
    """Grid each quantity; quantities with too few instruments are omitted with a message.

    UsageError: no quantity remains, no times overlap, or no instrument belongs to the line.
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
        for line in exchanged(where, samples, name, series[name], points):
            narrate(line)
        dropped = sum(series[name][i].dropped for i in points)
        if dropped:
            narrate(f"{name}: {dropped} values excluded because of their flag")
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
        narrate(f"{reason}; the quantity is omitted")
    return fields
