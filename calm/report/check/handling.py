"""The tables of a launch, a recovery, and the breaks of a line."""

from __future__ import annotations

from collections.abc import Sequence
from math import isnan
from typing import TYPE_CHECKING

from calm.quantities import QUANTITIES, say
from calm.report.blocks import Cell, Column, Table
from calm.report.line import figure_cell

if TYPE_CHECKING:
    from calm.checks.assessment import Assessment
    from calm.checks.backup import Break
    from calm.physics.line import Floats


def breaks_table(backup: Sequence[Break]) -> Table:
    """What would float the release up again after each break."""
    rows = tuple(
        (
            Cell(str(each.break_after)),
            Cell(each.label),
            figure_cell("wet_weight", each.weight_lifted),
            figure_cell("net_buoyancy", each.margin),
            figure_cell("net_buoyancy", each.required),
            Cell("yes" if each.judged else "no"),
        )
        for each in backup
    )
    columns = (
        Column("no.", numeric=True),
        Column("break below"),
        Column("weight lifted", "N", numeric=True),
        Column("buoyancy left over", "N", numeric=True),
        Column("required", "N", numeric=True),
        Column("judged"),
    )
    note = (
        "Not judged: what breaks inside the lowest cluster of floats, or between it and the "
        "release, in any design leaves the release on the seabed."
    )
    return Table("Back-up buoyancy", columns, rows, note)


def handling_summary(assessment: Assessment) -> Table:
    """The launch and the recovery in a few figures."""
    rows = []
    speed = QUANTITIES["speed"]
    if assessment.launch is not None:
        launch = assessment.launch
        low, high = launch.fall_speed_band
        band = (
            f"{speed.format(low)} to {speed.say(high)} with double and half the drag along the "
            "line and of the anchor"
        )
        rows += [
            (
                Cell("Launch, anchor last: speed at touchdown"),
                Cell(speed.say(launch.fall_speed), band),
            ),
            (Cell("Pull of the falling anchor"), Cell(say("tension", launch.anchor_tension))),
        ]
        if not launch.anchor_drag_known:
            rows.append((Cell("Drag of the anchor"), Cell("unknown; that of a cube of its volume")))
    if assessment.recovery is not None:
        recovery = assessment.recovery
        time = recovery.time_to_surface
        rows += [
            (Cell("Recovery: net buoyancy above the release"),
             Cell(say("vertical", recovery.net_buoyancy))),
            (Cell("Speed of the rise", "in still water" if recovery.in_still_water else ""),
             Cell(speed.say(recovery.rise_speed))),
            (Cell("Time to the surface"), Cell("-" if time is None else f"{time / 60:.1f} min")),
        ]  # fmt: skip
    columns = (Column(""), Column("", numeric=True))
    return Table("Launch and recovery in short", columns, tuple(rows))


def handling_table(assessment: Assessment) -> Table:
    """Tensions of each piece on its way down and up, and when and where it ends."""
    launch, recovery = assessment.launch, assessment.recovery
    rows = []
    for piece in assessment.mooring.file.pieces[:-1]:
        row = [Cell(str(piece.index)), Cell(piece.label)]
        if launch is not None:
            row += _pair(launch.tension_top, launch.tension_bottom, piece.index)
        if recovery is not None:
            row += _pair(recovery.tension_top, recovery.tension_bottom, piece.index)
            arrival = float(recovery.arrival[piece.index])
            row += [
                Cell("-" if isnan(arrival) else f"{arrival / 60:.1f}"),
                figure_cell("depth", float(recovery.hangs_at[piece.index])),
            ]
        rows.append(tuple(row))
    columns = [Column("no.", numeric=True), Column("piece")]
    if launch is not None:
        columns += [Column("launch, upper end", "N", True), Column("launch, lower end", "N", True)]
    if recovery is not None:
        columns += [
            Column("recovery, upper end", "N", True),
            Column("recovery, lower end", "N", True),
            Column("at the surface after", "min", True),
            Column("hangs at depth", "m", True),
        ]
    return Table("Tensions on the way down and up", tuple(columns), tuple(rows))


def _pair(top: Floats, bottom: Floats, index: int) -> list[Cell]:
    return [figure_cell("tension", float(top[index])), figure_cell("tension", float(bottom[index]))]
