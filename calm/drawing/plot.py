"""Drawing of lines on matplotlib axes, and conversion of matplotlib figures to SVG.

matplotlib is installed with the extra `plot`.
"""

from __future__ import annotations

import io
import re
import warnings
from typing import TYPE_CHECKING, Any

from calm.drawing.line_drawing import LEAST_SPAN, LINE_COLOUR, SEABED_COLOUR, SIGNS, WATER_COLOUR
from calm.drawing.line_picture import LineKind, LinePicture
from calm.drawing.picture import within_xml

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

_STYLES: dict[LineKind, dict[str, Any]] = {
    LineKind.LINE: {"color": LINE_COLOUR, "linewidth": 1.5},
    LineKind.STILL: {"color": "grey", "linewidth": 1.0, "linestyle": "--"},
    LineKind.BESIDE: {"color": "grey", "linewidth": 1.0},
    LineKind.SEABED: {"color": SEABED_COLOUR, "linewidth": 3.0},
}


def empty_figure(width: float, height: float, **options: Any) -> Figure:
    """Create a figure of a given size [inches] without opening a window."""
    from matplotlib.figure import Figure

    return Figure(figsize=(width, height), **options)


# patterns are compiled at their first use
_PROLOGUE = r"(?s)^.*?(?=<svg\b)"
_ASIDE = r"(?s)<metadata>.*?</metadata>|<style\b.*?</style>|<!--.*?-->\s*"


def figure_svg(figure: Figure) -> str:
    """Convert a figure to SVG without prologue and metadata; letters remain text.

    A style sheet in the drawing would apply to the whole page. The settings of the style sheet are
    therefore converted to attributes of elements.
    """
    import matplotlib

    content = io.BytesIO()
    with (
        matplotlib.rc_context({"svg.fonttype": "none", "svg.hashsalt": "calm"}),
        warnings.catch_warnings(),
    ):
        # a label may contain characters that the font of matplotlib lacks
        warnings.filterwarnings("ignore", message="Glyph")
        figure.savefig(content, format="svg", metadata={"Date": None})
    text = re.sub(_PROLOGUE, "", content.getvalue().decode("utf-8"), count=1)
    return within_xml(re.sub(_ASIDE, "", text)).replace("<svg ", '<svg stroke-linejoin="round" ', 1)


def plot_elevation(side: LinePicture, ax: Axes | None = None) -> Axes:
    """Draw a side view on matplotlib axes, by default on a new figure."""
    if ax is None:
        ax = empty_figure(6.0, 6.0, layout="constrained").subplots()
    if side.surface:
        ax.axhline(0.0, color=WATER_COLOUR, linewidth=1)
    if side.seabed is not None:
        ax.axhspan(side.seabed, max(2.0 * side.seabed, side.bottom), color=SEABED_COLOUR)
    for line in side.lines:
        if line.kind is LineKind.BAND:
            ax.fill(line.x, line.y, color=LINE_COLOUR, alpha=0.2, linewidth=0, label=line.label)
        else:
            ax.plot(line.x, line.y, label=line.label or None, **_STYLES[line.kind])
    if side.ship is not None:
        ax.plot(*side.ship, "^", color="black", markersize=8)
    for role, (sign, size, colour) in SIGNS.items():
        there = [(mark.x, mark.y) for mark in side.marks if mark.role == role]
        if there:
            ax.plot(*zip(*there, strict=True), sign, label=role, color=colour, markersize=size)
    start, end = side.span()
    spare = max(LEAST_SPAN * side.height - (end - start), 0.0) + 0.05 * (end - start)
    ax.set(xlim=(start - spare, end + spare), ylim=(side.bottom, side.top))
    ax.set(xlabel=side.across, ylabel=side.up)
    return ax
