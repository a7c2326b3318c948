"""``calm batch``: a mooring in every current profile of a record."""

from __future__ import annotations

import os
import signal
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from threading import current_thread, main_thread
from types import FrameType
from typing import TYPE_CHECKING

from calm.cli import options
from calm.cli.outputs import ExitCode, check_suffix, narrate, narrate_card, show_parts
from calm.cli.progress import ProgressTeller, grouped
from calm.errors import UsageError

if TYPE_CHECKING:
    from calm.batch.blocks import Progress
    from calm.case import Design
    from calm.records.record import Record


def batch(
    file: options.MooringPath,
    /,
    *,
    currents: Path,
    output: options.OutputFile,
    time: str | None = None,
    every: int = 1,
    at: options.Signed = None,
    declination: options.Declination = None,
    workers: options.Threads = None,
    scheduler: str | None = None,
    no_statistics: bool = False,
    environment: options.EnvironmentName = None,
    catalog: options.CatalogFiles = None,
    units: options.Units = None,
) -> ExitCode:
    """Solve a mooring, or a net of legs, in every profile of a record or a
    hindcast.

    Each profile replaces the current in the file. The result has values for every
    component and every clamped instrument at each time step. For a profile without
    equilibrium, these values are NaN, and the status gives the reason. Statistics
    are printed, and are also written to RESULT.summary.json and
    RESULT.summary.html.

    The result is written completely or not at all. After an interruption, run the
    command again from the beginning.

    Parameters
    ----------
    currents
        Record of currents: NetCDF, zarr or CSV.
    output
        Result file, .nc.
    time
        Only profiles from A to B inclusive, such as 2024-03/2024-05.
    every
        Only every Nth profile.
    at
        Latitude and longitude [degrees] of the grid column to use; by default the `position` of the
        mooring file.
    scheduler
        Address of a dask scheduler whose workers solve the profiles.
    no_statistics
        Write no statistics, for instance if the record is only part of a longer one.

    Examples
    --------
      calm batch mooring.yaml --currents adcp.nc -o moved.nc
      calm batch mooring.yaml --currents glorys.nc --at 48.3,-5.2 -o hindcast.nc
      calm batch mooring.yaml --currents adcp.nc --time 2024-03/2024-05 -o spring.nc
      calm batch mooring.yaml --currents ensemble.zarr -o moved.nc --workers 32
    """
    options.from_one(every=every, workers=workers)
    from calm.batch.run import run_batch
    from calm.case import load
    from calm.files.mooring_file import refuse_tow
    from calm.records.current_file import open_record
    from calm.records.current_terms import Terms
    from calm.records.record import RULES, parse_period, parse_place
    from calm.report.batch_page import summary_part, write_summary

    period = None if time is None else parse_period(time)
    check_output(output, file, currents)
    mooring = load(file, environment, catalog or [])
    refuse_tow(mooring.file)
    options.show_units(units, [mooring.file])
    position = mooring.file.position
    own = None if position is None else (position.latitude, position.longitude)
    place = own if at is None else parse_place(at)
    seabed = float(mooring.water.depth)
    teller = ProgressTeller()
    turned = options.quantities(declination=(declination, "angle")).get("declination")
    with stopped_by_a_signal(teller) as progress:
        terms = Terms(seabed, place, turned)
        with open_record(currents, terms, period, every) as record:
            for card in record.cards:
                narrate_card(card)
            for notice in (*mooring.file.notices, *record.notes):
                if notice not in RULES:
                    narrate(f"{currents}: {notice}")
            try:
                counts = run_batch(
                    mooring, record, output, workers=workers, scheduler=scheduler,
                    progress=progress, tell=teller.note,
                )  # fmt: skip
            finally:
                teller.clear()
            if counts.get("implausible-current"):
                narrate(f"{currents}: {_implausible(counts, mooring, record)}")
        code = ended(counts, output)
        if not no_statistics:
            show_parts(summary_part(write_summary(output, mooring)))
    return code


def _implausible(counts: Mapping[str, int], mooring: Design, record: Record) -> str:
    from calm.batch.statuses import first_implausible

    greatest = mooring.file.environment.maximum_speed
    count = grouped(counts["implausible-current"])
    return (
        f"{count} profiles have no result because their current is implausible (above "
        f"`maximum_speed`, {greatest:g} m/s): {first_implausible(record, greatest)}"
    )


def ended(counts: Mapping[str, int], output: Path) -> ExitCode:
    """Report the output file and the profiles without a result, and return the exit code."""
    from calm.batch.statuses import Ending, endings

    narrate(f"{output} written")
    done = sum(counts.values())
    solved = endings(counts)[Ending.SOLVED]
    if solved < done:
        narrate(
            f"{output}: {grouped(done - solved)} of {grouped(done)} profiles are NaN: "
            f"{', '.join(_failure_counts(counts))}"
        )
    return ExitCode.DONE if solved else ExitCode.NO_EQUILIBRIUM


def _failure_counts(counts: Mapping[str, int]) -> Iterator[str]:
    from calm.batch.statuses import Ending, ending_of, endings

    for ending, count in endings(counts).items():
        if count and ending is not Ending.SOLVED:
            statuses = ", ".join(
                f"{grouped(number)} {status}"
                for status, number in counts.items()
                if ending_of(status) is ending
            )
            yield f"{grouped(count)} {ending.value} ({statuses})"


def check_output(output: Path, *inputs: Path) -> None:
    """Reject an output path that cannot be written, or that would overwrite an input."""
    # unlike `Path.resolve`, `realpath` accepts links that form a circle
    place = os.path.realpath(output)
    if output.is_symlink() and not output.exists():
        raise UsageError(f"cannot write {output}: it is a symbolic link to a missing file")
    folder = os.path.dirname(place)
    if not os.path.isdir(folder):
        raise UsageError(f"cannot write {output}: there is no folder {folder}")
    if not os.access(folder, os.W_OK):
        raise UsageError(f"cannot write {output}: permission denied")
    for path in inputs:
        if place == os.path.realpath(path):
            raise UsageError(f"{output} is an input file and was not overwritten")
    check_suffix(output, (".nc",))
    if os.path.isdir(output):
        raise UsageError(f"cannot write {output}: it is a folder")


@contextmanager
def stopped_by_a_signal(
    progress: Callable[[Progress], None],
) -> Iterator[Callable[[Progress], None]]:
    """Convert SIGINT and SIGTERM to KeyboardInterrupt while a batch runs.

    If a queueing system stops the batch, no temporary files are left. The context yields a
    replacement for `progress`, and the batch must call this replacement. The replacement also
    raises KeyboardInterrupt after a signal.
    """
    if current_thread() is not main_thread():
        yield progress
        return
    came: list[int] = []

    def stop(number: int, _: FrameType | None) -> None:
        came.append(number)
        raise KeyboardInterrupt

    def stopping(now: Progress) -> None:
        # Python ignores an exception raised by a handler during the callback of a weak reference
        if came:
            raise KeyboardInterrupt
        progress(now)

    handled = [
        number
        for number in (signal.SIGINT, signal.SIGTERM)
        if signal.getsignal(number) is not signal.SIG_IGN
    ]
    before = {number: signal.signal(number, stop) for number in handled}
    try:
        yield stopping
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)
