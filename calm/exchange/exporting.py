"""From a mooring file to the file of another program."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path

from calm.case import load
from calm.errors import UsageError
from calm.exchange.cable_writer import cbl_file
from calm.exchange.exported_parts import ExportedLine, ExportedPart, exported_line
from calm.exchange.mdd_writer import mdd_file
from calm.exchange.moordyn_writer import CURRENTS, current_profile, moordyn_file
from calm.records.csv_writer import table_csv
from calm.suggestions import unknown

_HEADER = (
    "name", "label", "kind", "role", "clamped at[m]", "length[m]", "diameter[m]", "whole mass[kg]",
    "whole buoyancy[N]", "whole Cd x area[m^2]", "whole tangential Cd x area[m^2]", "EA[N]",
)  # fmt: skip
Writer = Callable[[ExportedLine], tuple[bytes, tuple[str, ...]]]


@dataclass(frozen=True)
class Exported:
    """Hold the content of a file for another program, what it cannot hold, and files beside it."""

    content: bytes
    lost: tuple[str, ...]
    beside: dict[str, bytes]


def _csv_file(design: ExportedLine) -> tuple[bytes, tuple[str, ...]]:
    """Return the content of the file, and what it cannot hold."""
    lost = ["the water", "hulls and wind: floats drag in full at the surface"]
    if design.tow is not None:
        lost.append("the speed of the ship: a list is a mooring's")
    losses = design.losses(lost)
    rows = [
        row
        for part in design.parts
        for row in (_row(part, None), *(_row(clamp, at) for clamp, at in part.clamps))
    ]
    if design.anchor is not None:
        anchor, weight = design.anchor
        figures = [None, anchor.length, None, anchor.mass, -weight, None, None, None]
        rows.append([*["anchor"] * 4, *figures])
    comments = (f"{design.name}, by CALM; lost:", *losses)
    above = "".join(f"# {' '.join(line.split())}\n" for line in comments)
    return (above + table_csv(_HEADER, rows)).encode(), losses


def _row(part: ExportedPart, at: float | None) -> list[str | float | None]:
    whole = part.length if part.flexible else 1.0
    return [
        part.use,
        part.label,
        part.component.kind,
        part.role,
        at,
        part.length,
        part.diameter or None,
        None if part.mass is None else part.mass * whole,
        part.buoyancy * whole,
        part.area() * whole,
        part.area(along=True) * whole if part.directional else None,
        part.stiffness or None,
    ]


WRITERS: dict[str, Writer] = {
    "mdd": mdd_file, "cbl": cbl_file, "csv": _csv_file, "moordyn": moordyn_file,
}  # fmt: skip
"""What a mooring can be written for."""


def export_file(
    path: Path,
    to: str,
    *,
    environment: str | None = None,
    catalogs: Sequence[Path] = (),
) -> Exported:
    """Write a mooring or a tow for another program.

    Parameters
    ----------
    to : one of `WRITERS`
    environment : a name in the file, or an environment file
    catalogs : as `calm.load` takes them

    Raises
    ------
    InputError, NoEquilibrium, UsageError
        The file has mistakes, no length of a piece that is cut to fit is right, or `to` is no
        program.
    """
    if to not in WRITERS:
        raise UsageError(
            unknown(f"--to: `{to}` is not a program that CALM writes for", to, WRITERS)
        )
    design = exported_line(load(path, environment, list(catalogs)))
    content, lost = WRITERS[to](design)
    beside = {CURRENTS: current_profile(design)} if to == "moordyn" else {}
    return Exported(content, lost, beside)
