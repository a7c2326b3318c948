"""How lines and marks of a graph look."""

from __future__ import annotations

from typing import NamedTuple

from calm.report.schematic.pen import Pen


class Stroke(NamedTuple):
    """A line's colour and width [pt].

    `dashes` are the lengths [pt] of dashes and gaps, of which an unbroken line has none; a `square`
    one goes on by half its width at both ends, so that the shortest is seen.
    """

    colour: str
    width: float = 1.2
    dashes: tuple[float, ...] = ()
    square: bool = False

    def attributes(self) -> dict[str, float | str]:
        """As a pen takes them."""
        written: dict[str, float | str] = {"stroke": self.colour, "stroke_width": self.width}
        if self.dashes:
            written["stroke_dasharray"] = " ".join(f"{each:g}" for each in self.dashes)
        if self.square:
            written["stroke_linecap"] = "square"
        return written


def draw_mark(pen: Pen, x: float, y: float, sign: str, size: float, colour: str) -> None:
    """A filled sign of some width [pt] at a point: o, s (square), D (diamond) or v (downward)."""
    half = size / 2
    if sign == "o":
        pen.circle(x, y, half, fill=colour)
    elif sign == "s":
        pen.box(x, y, size, size, fill=colour)
    else:
        corners = {
            "D": ((0, -1.2), (1.2, 0), (0, 1.2), (-1.2, 0)),
            "v": ((-1, -0.9), (1, -0.9), (0, 1)),
        }[sign]
        points = " ".join(f"{x + half * u:.2f},{y + half * v:.2f}" for u, v in corners)
        pen.draw("polygon", points=points, fill=colour)
