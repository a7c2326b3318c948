"""The sheet that the moorings of a check are drawn on, one after another."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from functools import cache
from math import ceil
from threading import Lock
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.lines import Line2D

FONT_SIZE = 7.0  # points
_WIDTH, _HEIGHT = 7.4, 8.0  # inches: an A4 page between its margins
_LEGEND_ROW = 0.19  # inches
_LEGEND_COLUMNS = 4
_LONGEST_NAME = 22  # signs in the legend
_LOCK = Lock()


class Panels:
    """Five axes that share one legend; what is drawn on them is taken off again.

    Axes and ticks take most of the time of a drawing, and are the same in all of them.
    """

    def __init__(self) -> None:
        from matplotlib.figure import Figure

        self.figure = Figure(figsize=(_WIDTH, _HEIGHT))
        self._places: dict[Axes, tuple[float, float, float, float]] = {}
        self.elevation = self._panel(0.55, 3.55, 2.6, 4.3)
        self.current = self._panel(3.3, 3.55, 1.0, 4.3, bins=3, sharey=self.elevation)
        self.tension = self._panel(5.0, 3.55, 2.3, 4.3, bins=4)
        self.plan = self._panel(0.55, 0.45, 2.6, 2.4)
        self.breaks = self._panel(4.0, 0.45, 3.3, 2.4)

    def _panel(
        self, left: float, bottom: float, width: float, tall: float, bins: int = 5, **shared: Any
    ) -> Axes:
        """Axes whose place is in inches."""
        axes = self.figure.add_axes((0.0, 0.0, 1.0, 1.0), **shared)
        axes.tick_params(labelsize=FONT_SIZE)
        axes.locator_params(axis="x", nbins=bins)
        axes.xaxis.label.set_fontsize(FONT_SIZE)
        axes.yaxis.label.set_fontsize(FONT_SIZE)
        self._places[axes] = left, bottom, width, tall
        return axes

    def write_legend(self, entries: Sequence[tuple[Line2D, str]]) -> None:
        """One legend above all panels; the texts are set when it stands, as they may be anything.

        The panels keep their size: the sheet grows by the rows of the legend.
        """
        height = _HEIGHT + ceil(len(entries) / _LEGEND_COLUMNS) * _LEGEND_ROW
        self.figure.set_size_inches(_WIDTH, height)
        for axes, (left, bottom, width, tall) in self._places.items():
            place = (left / _WIDTH, bottom / height, width / _WIDTH, tall / height)
            axes.set_position(place)
        legend = self.figure.legend(
            [line for line, _ in entries],
            ["·"] * len(entries),
            loc="upper left",
            ncols=_LEGEND_COLUMNS,
            fontsize=FONT_SIZE,
            frameon=False,
        )
        for text, (_, name) in zip(legend.get_texts(), entries, strict=True):
            text.set_text(_short(name))
            text.set_parse_math(False)

    def clear(self) -> None:
        """Take off what was drawn; axes, ticks and labels stay."""
        from matplotlib.transforms import Bbox

        for legend in [*self.figure.legends]:
            legend.remove()
        for axes in self._places:
            for artist in [*axes.lines, *axes.collections, *axes.patches]:
                artist.remove()
            axes.containers.clear()
            axes.dataLim = Bbox.null()
            axes.autoscale(True)


@contextmanager
def panels() -> Iterator[Panels]:
    """The empty sheet of this process, for one drawing at a time."""
    with _LOCK:
        try:
            yield sheet()
        finally:
            sheet().clear()


@cache
def sheet() -> Panels:
    """The sheet of this process, and of those that are forked from it."""
    return Panels()


def _short(name: str) -> str:
    """A name on one line that fits its column of the legend."""
    line = " ".join(name.split())
    return line if len(line) <= _LONGEST_NAME else f"{line[: _LONGEST_NAME - 1]}…"
