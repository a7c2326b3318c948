"""Labels on a chart, placed so that none covers another."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.text import Text
    from matplotlib.transforms import Bbox
    from numpy.typing import NDArray

    Floats = NDArray[np.float64]

_MARGIN = 1.5  # points kept free around a label
_SHORTEST = 40.0  # points of a locus that are worth a label
_TRIALS = 41


class Labels:
    """Labels and ticks of one pair of axes, whose limits are final.

    A text that finds no free place is left out.

    Parameters
    ----------
    axes : Axes
        Of a figure that has a canvas to measure texts on.
    """

    def __init__(self, axes: Axes) -> None:
        self.axes = axes
        self.boxes: list[Bbox] = []
        self._points = axes.figure.dpi / 72.0

    def avoid(self, x: Floats, y: Floats) -> None:
        """Keep labels off a curve."""
        from matplotlib.transforms import Bbox

        line = self.axes.transData.transform(np.column_stack([x, y]))
        lengths = _lengths(line)
        half = self._points  # a point to each side
        for at in np.arange(0.0, lengths[-1], half):
            place = [np.interp(at, lengths, line[:, axis]) for axis in (0, 1)]
            self.boxes.append(Bbox([np.subtract(place, half), np.add(place, half)]))

    def tick(self, x: float, y: float, angle: float, size: float, colour: str) -> None:
        """A tick on the right of a curve that runs at `angle` [rad]; size in points, < 0: left."""
        place, right = self._place(x, y, angle)
        ends = np.array([place, place + right * size * self._points])
        across = self.axes.transData.inverted().transform(ends)
        self.axes.plot(*across.T, color=colour, linewidth=0.7, zorder=3)

    def beside(
        self, text: str, x: float, y: float, angle: float, size: float, colour: str, font: float
    ) -> None:
        """A text beyond such a tick."""
        place, right = self._place(x, y, angle)
        side = right * np.sign(size)
        label = self._text(text, place, 0.0, colour, font)
        extent = label.get_window_extent()
        reach = 0.5 * (abs(side[0]) * extent.width + abs(side[1]) * extent.height)
        self._move(label, place + side * (abs(size) * self._points + reach))
        self._keep(label)

    def along(self, text: str, path: Floats, colour: str, font: float) -> bool:
        """A text on a line of points (n, 2), turned along it; whether there is a free place."""
        line = self.axes.transData.transform(path)
        lengths = _lengths(line)
        if lengths[-1] < _SHORTEST * self._points:
            return False
        # From the middle outwards.
        offsets = np.linspace(0.0, 0.46, _TRIALS // 2 + 1)
        shares = np.unique(np.concatenate([0.5 - offsets, 0.5 + offsets]))
        for share in sorted(shares, key=lambda share: abs(share - 0.5)):
            at = share * lengths[-1]
            reach = 8.0 * self._points
            before, place, after = (
                np.array([np.interp(spot, lengths, line[:, axis]) for axis in (0, 1)])
                for spot in (at - reach, at, at + reach)
            )
            slope = after - before
            turned = (np.degrees(np.arctan2(slope[1], slope[0])) + 90.0) % 180.0 - 90.0
            label = self._text(text, place, turned, colour, font)
            if self._keep(label):
                return True
        return False

    def _place(self, x: float, y: float, angle: float) -> tuple[Floats, Floats]:
        """A point in pixels and the direction to the right of a curve there."""
        step = 1e-6
        here = np.array([x, y])
        ahead = here + step * np.array([np.cos(angle), np.sin(angle)])
        place, onward = self.axes.transData.transform(np.array([here, ahead]))
        direction = (onward - place) / np.hypot(*(onward - place))
        return place, np.array([direction[1], -direction[0]])

    def _text(self, text: str, place: Floats, turned: float, colour: str, font: float) -> Text:
        label = self.axes.text(
            0.0,
            0.0,
            text,
            color=colour,
            fontsize=font,
            rotation=turned,
            horizontalalignment="center",
            verticalalignment="center",
            zorder=4,
            bbox={"facecolor": "white", "edgecolor": "none", "pad": 0.4},
        )
        self._move(label, place)
        return label

    def _move(self, label: Text, place: Floats) -> None:
        label.set_position(tuple(self.axes.transData.inverted().transform(place)))

    def _keep(self, label: Text) -> bool:
        """Keep a label where it is free, or remove it."""
        box = label.get_window_extent().padded(_MARGIN * self._points)
        frame = self.axes.get_window_extent()
        inside = (
            frame.x0 <= box.x0 and box.x1 <= frame.x1 and frame.y0 <= box.y0 and box.y1 <= frame.y1
        )
        if inside and not any(box.overlaps(other) for other in self.boxes):
            self.boxes.append(box)
            return True
        label.remove()
        return False


def _lengths(line: Floats) -> Floats:
    """Length along a line of points, from its first."""
    return np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(line, axis=0).T))])
