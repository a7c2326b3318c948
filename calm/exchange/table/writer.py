"""Write a line as a list in CSV, with a row for each piece and each clamp."""

from calm.exchange.exported_parts import ExportedDesign, ExportedPart
from calm.exchange.registry import Exported
from calm.records.delimited import table_csv

_HEADER = (
    "name", "label", "kind", "role", "clamped at[m]", "length[m]", "diameter[m]", "whole mass[kg]",
    "whole buoyancy[N]", "whole Cd x area[m^2]", "whole tangential Cd x area[m^2]", "EA[N]",
)  # fmt: skip


def write_list(exported: ExportedDesign) -> Exported:
    """Write a line as a list in CSV."""
    (design,) = exported.legs
    lost = [
        "the water",
        "float hulls and wind: surface floats are written with the drag of immersed floats",
    ]
    if design.tow is not None:
        lost.append("the speed of the ship, for which a list has no column")
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
    comments = (f"{design.name}, exported by CALM without:", *losses)
    above = "".join(f"# {' '.join(line.split())}\n" for line in comments)
    return Exported((above + table_csv(_HEADER, rows)).encode(), losses)


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
