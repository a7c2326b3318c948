"""From a mooring file to the file of another program."""

from __future__ import annotations

import csv
import io
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path

from calm.case import load
from calm.errors import UsageError
from calm.exchange.cable_writer import cbl_file
from calm.exchange.exported_parts import ExportedLine, ExportedPart, area, assembled, remarks
from calm.exchange.mdd_writer import mdd_file
from calm.exchange.moordyn_writer import CURRENTS, current_profile, moordyn_file
from calm.suggestions import unknown


@dataclass(frozen=True)
class Exported:
    """The content of a file for another program, what it cannot hold, and the files beside it."""

    content: bytes
    lost: tuple[str, ...]
    beside: dict[str, bytes]


HEADER = (
    "name", "label", "kind", "role", "clamped at[m]", "length[m]", "diameter[m]", "whole mass[kg]",
    "whole buoyancy[N]", "whole Cd x area[m^2]", "whole tangential Cd x area[m^2]", "EA[N]",
)  # fmt: skip


def csv_file(design: ExportedLine) -> tuple[bytes, tuple[str, ...]]:
    """The content of the file, and what it cannot hold."""
    lost = ["the water", "hulls and wind: floats drag in full at the surface"]
    if design.tow is not None:
        lost.append("the speed of the ship: a list is a mooring's")
    losses = remarks(design, lost)
    text = io.StringIO()
    for line in (f"{design.name}, by CALM; lost:", *losses):
        text.write(f"# {' '.join(line.split())}\n")
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(HEADER)
    for part in design.parts:
        writer.writerow(_row(part, ""))
        for clamp, at in part.clamps:
            writer.writerow(_row(clamp, f"{at:.9g}"))
    if design.anchor is not None:
        anchor, weight = design.anchor
        mass = "" if anchor.mass is None else f"{anchor.mass:.9g}"
        shown = ["anchor", "anchor", "anchor", "anchor", "", f"{anchor.length:.9g}", "", mass]
        writer.writerow([*shown, f"{-weight:.9g}", "", "", ""])
    return text.getvalue().encode(), losses


def _row(part: ExportedPart, at: str) -> list[str]:
    whole = part.length if part.flexible else 1.0
    mass = "" if part.mass is None else f"{part.mass * whole:.9g}"
    stiffness = f"{part.stiffness:.9g}" if part.stiffness else ""
    diameter = f"{part.diameter:.9g}" if part.diameter else ""
    along = f"{area(part, along=True) * whole:.9g}" if part.directional else ""
    figures = [diameter, mass, f"{part.buoyancy * whole:.9g}", f"{area(part) * whole:.9g}"]
    figures += [along, stiffness]
    words = [part.use, part.label, part.component.kind, part.role]
    return [_cell(word) for word in words] + [at, f"{part.length:.9g}", *figures]


def _cell(text: str) -> str:
    """A text that no spreadsheet takes for a formula."""
    return f"'{text}" if text.startswith(("=", "+", "-", "@")) else text


Writer = Callable[[ExportedLine], tuple[bytes, tuple[str, ...]]]

WRITERS: dict[str, Writer] = {
    "mdd": mdd_file, "cbl": cbl_file, "csv": csv_file, "moordyn": moordyn_file,
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
    design = assembled(load(path, environment, list(catalogs)))
    content, lost = WRITERS[to](design)
    beside = {CURRENTS: current_profile(design)} if to == "moordyn" else {}
    return Exported(content, lost, beside)
