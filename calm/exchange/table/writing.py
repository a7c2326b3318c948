"""A mooring or a tow as a list: CSV, a row each piece and each clamp, from the top down."""

from __future__ import annotations

import csv
import io

from calm.exchange.parts import ExportedLine, ExportedPart, area, remarks

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
