"""``calm run --speeds``: solve tows at many ship speeds."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from calm.cli.outputs import ExitCode, Outputs, gravest, narrate
from calm.cli.progress import progress
from calm.cli.solved_file import FileOutcome
from calm.errors import NoEquilibrium, UsageError

if TYPE_CHECKING:
    from calm.case import Design
    from calm.cli.outputs import TerminalPart
    from calm.report.tabulation import Tabulation

SUFFIXES = (".json", ".csv", ".svg", ".png", ".pdf")
"""Suffixes of the outputs of a tow at many speeds."""

MOST_SPEEDS = 10_000
"""Maximum number of speeds in one table."""

_ROUNDING = 1e-9  # of a step: rounding error of unit conversion at the end of the range


@dataclass(frozen=True)
class TabulatedTow:
    """Results for a tow at many speeds."""

    file: Path
    tabulation: Tabulation

    @property
    def code(self) -> ExitCode:
        """Exit code for this file alone."""
        failed = any(row.result is None for row in self.tabulation.rows)
        return ExitCode.NO_EQUILIBRIUM if failed else ExitCode.DONE

    def document(self) -> dict[str, Any]:
        """Return the JSON object."""
        from calm.report.tabulation import to_document

        return to_document(self.tabulation)

    def parts(self) -> list[TerminalPart]:
        """Return the table, with one row for each speed."""
        from calm.report.tabulation import tabulation_part

        return [tabulation_part(self.tabulation)]

    def rendered(self, suffix: str) -> bytes:
        """Return the drawing of depth, layback and tension against speed."""
        from calm.drawing.picture import image
        from calm.report.tabulation import sweep_drawing

        return image(sweep_drawing(self.tabulation), suffix)


def tabulate(tows: Sequence[Design], outputs: Outputs, speeds: Sequence[float]) -> ExitCode:
    """Solve each tow at each speed [m/s], and write the outputs."""
    shown: list[TabulatedTow | FileOutcome] = []
    for file, tow in zip(outputs.files, tows, strict=True):
        try:
            shown.append(_swept(file, tow, speeds))
        except NoEquilibrium as failure:  # no length of cable fits: there is nothing to tabulate
            narrate(f"{file}: {failure}")
            shown.append(FileOutcome(file, tow.file.name, failure=failure))

    def to_csv() -> str:
        from calm.report.tabulation import to_csv

        return to_csv([each.tabulation for each in shown if isinstance(each, TabulatedTow)])

    outputs.write(shown, to_csv)
    return gravest(each.code for each in shown)


def _swept(file: Path, tow: Design, speeds: Sequence[float]) -> TabulatedTow:
    from calm.case.tow import SOLVES, sweep
    from calm.report.tabulation import by_speed
    from calm.solve import CompiledPart, expect_many

    expect_many(SOLVES * len(speeds), CompiledPart.LEGS)
    outcomes = sweep(tow, progress(speeds, f"speeds of {file}"))
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
    return TabulatedTow(file, by_speed(tow, speeds, outcomes))


def speed_range(text: str) -> list[float]:
    """Return the speeds [m/s] of ``A:B:STEP``, from A up to and including B.

    Raises UsageError if the text has another form, A or STEP is not positive, B is below A, or
    there are more than `MOST_SPEEDS` speeds.
    """
    from calm.units import QuantityError, parse_quantity

    parts = text.split(":")
    if len(parts) != 3:
        raise UsageError(f"--speeds: `{text}` is not A:B:STEP, such as `1 knot:12 knot:0.5 knot`")
    values: list[float] = []
    complaints: list[str] = []
    for part in parts:
        try:
            values.append(parse_quantity(part, "speed"))
        except QuantityError as error:
            complaints.append(f"`{part.strip()}` {error}")
    if complaints:
        raise UsageError(f"--speeds: {'; '.join(complaints)}")
    first, last, step = values
    if first <= 0.0:
        raise UsageError(f"--speeds: `{text}` begins at {first:g} m/s; a tow needs a speed above 0")
    if last < first:
        raise UsageError(
            f"--speeds: `{text}` ends at {last:g} m/s, which is below its first speed, "
            f"{first:g} m/s"
        )
    if step <= 0.0:
        raise UsageError(f"--speeds: `{text}` has a step of {step:g} m/s; it must be above 0")
    whole = math.floor((last - first) / step + _ROUNDING)
    if whole >= MOST_SPEEDS:
        raise UsageError(
            f"--speeds: `{text}` makes more than {MOST_SPEEDS} speeds; use a larger step"
        )
    speeds = (first + number * step for number in range(whole + 1))
    return [*(each for each in speeds if last - each > _ROUNDING * step), last]
