"""What a line was solved from, and what no report judges."""

from __future__ import annotations

from collections.abc import Sequence
from math import hypot
from typing import TYPE_CHECKING

import numpy as np

from calm.quantities import QUANTITIES, bearing_of
from calm.report.blocks import Cell, Column, Listing, Prose, Table
from calm.report.provenance import input_hash, source_text, versions

if TYPE_CHECKING:
    from calm.files import MooringFile
    from calm.physics.line import Water

UNSEEN = (
    "A static calculation does not see waves and the tensions they cause; snap loads on a line "
    "that falls slack; fatigue, by waves and by vortices; creep, corrosion and wear; the jerk at "
    "the end of the launch and the swing of the line before it; hauling and lifts on recovery.",
    "No margin in this report covers them. They decide the life of surface moorings in harsh "
    "weather, and no factor on a static tension replaces looking at them.",
)
"""What is printed in every report."""

_MOST_LEVELS = 40


def environments_table(names: Sequence[str], waters: Sequence[Water]) -> Table:
    """Depth, density and the greatest current of each environment, and where it is."""
    rows = []
    for name, water in zip(names, waters, strict=True):
        speed = np.hypot(water.u, water.v)
        fastest = int(speed.argmax())
        densities = sorted({f"{density:.0f}" for density in water.density})
        rows.append(
            (
                Cell(name),
                Cell(QUANTITIES["depth"].format(water.depth) if np.isfinite(water.depth) else "-"),
                Cell(densities[0] + (f"–{densities[-1]}" if len(densities) > 1 else "")),
                Cell(QUANTITIES["speed"].format(float(speed[fastest]))),
                Cell(QUANTITIES["depth"].format(float(water.level[fastest]))),
                Cell(str(len(water.level))),
            )
        )
    columns = (
        Column("environment"),
        Column("water depth", "m", numeric=True),
        Column("density", "kg/m³", numeric=True),
        Column("greatest current", "m/s", numeric=True),
        Column("at depth", "m", numeric=True),
        Column("levels", numeric=True),
    )
    return Table("Environments", columns, tuple(rows))


def current_listing(name: str, water: Water) -> Listing:
    """The current as computed with, level by level; of many levels, some at equal steps."""
    count = len(water.level)
    chosen = np.unique(np.linspace(0, count - 1, min(count, _MOST_LEVELS)).round().astype(int))
    lines = [f"{'depth m':>10} {'speed m/s':>10} {'toward °':>10} {'upward m/s':>11}"]
    for level in chosen:
        u, v, w = water.u[level], water.v[level], water.w[level]
        toward = bearing_of(u, v)
        lines.append(f"{water.level[level]:10.1f} {hypot(u, v):10.3f} {toward:10.1f} {w:11.3f}")
    if len(chosen) < count:
        lines.append(f"{len(chosen)} of {count} levels")
    return Listing(f"Current, {name}", "\n".join(lines))


def file_listing(file: MooringFile) -> Listing:
    """The mooring file as it stands."""
    text = source_text(file)
    return Listing(
        "Mooring file", "The file could not be read again." if text is None else text.rstrip()
    )


def origin(files: Sequence[MooringFile]) -> Prose:
    """The hash of the inputs of one mooring, and the versions that computed."""
    made_by = ", ".join(f"{name} {number}" for name, number in versions())
    return Prose((f"SHA-256 of the inputs: {input_hash(files)}", f"Computed with {made_by}"))
