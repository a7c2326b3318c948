"""What the title block of a mooring says: document, revision, project, ship, position, names."""

from __future__ import annotations

from typing import TYPE_CHECKING

from calm.quantities import say
from calm.report.blocks import Block, Cell, Column, Pairs, Part, Table

if TYPE_CHECKING:
    from calm.files import MooringFile, Position


def document_part(file: MooringFile) -> tuple[Part, ...]:
    """The title block and the history of revisions; nothing where a file gives no document."""
    if file.document is None:
        return ()
    blocks: list[Block] = [Pairs(tuple(title_pairs(file)))]
    if file.document.history:
        rows = tuple(
            (Cell(one.revision), Cell(one.date or ""), Cell(one.by or ""), Cell(one.change or ""))
            for one in file.document.history
        )
        columns = (
            Column("revision", share=0.0),
            Column("date", share=0.0),
            Column("by"),
            Column("change", share=3.0),
        )
        blocks.append(Table("History", columns, rows))
    return (Part("Document", tuple(blocks)),)


def title_pairs(file: MooringFile) -> list[tuple[str, str]]:
    """What is known of the names under which a mooring goes, and where it is."""
    document = file.document
    names = (
        ("document", "id"),
        ("revision", "revision"),
        ("date", "date"),
        ("project", "project"),
        ("ship", "ship"),
        ("cruise", "cruise"),
        ("author", "author"),
        ("checked", "checked"),
        ("approved", "approved"),
    )
    pairs = [("mooring", file.name)]
    if document is not None:
        given = ((title, getattr(document, key)) for title, key in names)
        pairs += [(title, text) for title, text in given if text is not None]
    if file.position is not None:
        pairs.append(("position", position_text(file.position)))
    if file.environment.depth is not None:
        pairs.append(("water depth", say("depth", file.environment.depth)))
    return pairs


def position_text(position: Position) -> str:
    """A position as ships write it: degrees and minutes to a thousandth, some 2 m."""
    latitude = degrees_text(position.latitude, "NS", 2)
    return f"{latitude}, {degrees_text((position.longitude + 180.0) % 360.0 - 180.0, 'EW', 3)}"


def degrees_text(degrees: float, sides: str, digits: int) -> str:
    """Degrees, of so many digits at least, and minutes to a thousandth; `sides` are + and -."""
    whole, minutes = divmod(round(abs(degrees) * 60_000), 60_000)
    return f"{whole:0{digits}d}° {minutes / 1000:06.3f}′ {sides[degrees < 0.0]}"
