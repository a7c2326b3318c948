"""A result drawn, as a file."""

from __future__ import annotations

from typing import TYPE_CHECKING

from calm.case import TowResult
from calm.report.picture import image

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from calm.case import Result
    from calm.case.uncertain import Uncertain


def picture(result: Result | TowResult, suffix: str, uncertain: Uncertain | None = None) -> bytes:
    """The drawing of a mooring or a tow as a file; `suffix` is one of `picture.FORMATS`."""
    return image(draw(result, uncertain), suffix)


def draw(result: Result | TowResult, uncertain: Uncertain | None = None) -> Figure:
    """The drawing of a mooring or a tow: a figure that belongs to no window.

    Parameters
    ----------
    uncertain : of a mooring; its band is drawn behind the line
    """
    if isinstance(result, TowResult):
        from calm.report.plot_tow import draw_tow

        return draw_tow(result)
    from calm.report.plot_mooring import draw_mooring

    return draw_mooring(result, uncertain)
