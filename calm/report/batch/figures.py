"""The drawings of a batch: its responses through time, and how often each value is passed."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from calm.batch.statistics.summary import RESPONSES
from calm.quantities import QUANTITIES
from calm.report.batch.labels import QUANTITY, TITLES
from calm.report.drawing import LINE_STYLE
from calm.report.vector import figure_svg

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from calm.batch.statistics.distribution import Distribution
    from calm.batch.statistics.summary import Part, Response, Summary

_WIDTH = 7.4  # inches: an A4 page between its margins
_FONT_SIZE = 7.0  # points; the margins are for it: finding them takes as long as drawing twice
_MOST_NAMED = 7
_LIMIT: dict[str, Any] = {"color": "#b3261e", "linewidth": 1.0, "linestyle": "--"}
_COLOURS = ("#0b3c5d", "#d55e00", "#009e73", "#cc79a7", "#56b4e9", "#a6761d", "#332288")


def series_figure(summary: Summary) -> str:
    """Least and greatest value of every response in each interval of time, as SVG."""
    from matplotlib.figure import Figure

    figure = Figure(figsize=(_WIDTH, 1.7 * len(RESPONSES)))
    figure.subplots_adjust(0.13, 0.04, 0.99, 0.99, hspace=0.12)
    panels = figure.subplots(len(RESPONSES), 1, sharex=True)
    for axes, response in zip(panels, summary.responses, strict=True):
        _draw_series(axes, response)
        _draw_limit(axes.axhline, summary, response)
    return figure_svg(figure)


def exceedance_figure(summary: Summary) -> str:
    """Share of the profiles beyond each value: of the responses, as SVG."""
    from matplotlib.figure import Figure

    figure = Figure(figsize=(_WIDTH, 5.2))
    figure.subplots_adjust(0.1, 0.08, 0.99, 0.98, hspace=0.27, wspace=0.06)
    panels = figure.subplots(2, 2, sharey=True)
    for axes, response in zip(panels.flat, summary.responses, strict=True):
        if response.distribution is not None:
            _draw_curve(axes, response.distribution, QUANTITY[response.name], **LINE_STYLE)
        _draw_limit(axes.axvline, summary, response)
        _name_shares(axes, TITLES[response.name], QUANTITY[response.name])
    return figure_svg(figure)


def parts_figure(parts: list[Part]) -> str:
    """The same of the knockdown and the tilt of some parts, those that move most, as SVG."""
    from matplotlib.figure import Figure

    figure = Figure(figsize=(_WIDTH, 3.4))
    figure.subplots_adjust(0.1, 0.12, 0.99, 0.98, wspace=0.06)
    panels = figure.subplots(1, 2, sharey=True)
    for axes, name in zip(panels, ("knockdown", "tilt"), strict=True):
        known = [(part.label, getattr(part, name)) for part in parts]
        curves = [(label, one) for label, one in known if one is not None]
        curves.sort(key=lambda curve: -curve[1].maximum)
        for (_, one), colour in zip(curves, _COLOURS, strict=False):
            _draw_curve(axes, one, name, color=colour, linewidth=1.2)
        _name_shares(axes, name, name)
        if curves:
            _write_legend(axes, [label for label, _ in curves[:_MOST_NAMED]])
    return figure_svg(figure)


def _draw_series(axes: Axes, response: Response) -> None:
    quantity = QUANTITIES[QUANTITY[response.name]]
    low, high = (quantity.scale * edge for edge in (response.low, response.high))
    time = response.begin.astype("datetime64[s]")
    if np.array_equal(low, high, equal_nan=True):
        axes.plot(time, high, **LINE_STYLE | {"linewidth": 0.8})
    else:
        axes.fill_between(time, low, high, color=LINE_STYLE["color"], linewidth=0.4)
    axes.set_ylabel(f"{TITLES[response.name]}\n[{quantity.display_unit}]")
    _tidy(axes)


def _draw_curve(axes: Axes, one: Distribution, name: str, **style: Any) -> None:
    axes.plot(one.value * QUANTITIES[name].scale, 100.0 * one.share, **style)


def _draw_limit(draw: Any, summary: Summary, response: Response) -> None:
    """The limit of the design on a response, where it gives one."""
    wanted = {"knockdown": "knockdown", "offset": "excursion"}.get(response.name)
    for rule in summary.rules:
        if rule.name == wanted:
            limit = rule.exceedances[0].limit.limit
            draw((limit or 0.0) * QUANTITIES[QUANTITY[response.name]].scale, **_LIMIT)


def _name_shares(axes: Axes, title: str, name: str) -> None:
    axes.set_yscale("log", subs=[])  # ticks between the decades take most of the drawing
    axes.set_ylim(top=100.0)
    axes.yaxis.set_major_formatter("{x:g}")
    axes.set_ylabel("reached or passed in [% of profiles]")
    axes.label_outer()
    axes.xaxis.set_tick_params(labelbottom=True)
    axes.set_xlabel(f"{title} [{QUANTITIES[name].display_unit}]")
    _tidy(axes)


def _tidy(axes: Axes) -> None:
    axes.grid(alpha=0.3)
    axes.tick_params(labelsize=_FONT_SIZE)
    axes.xaxis.label.set_fontsize(_FONT_SIZE)
    axes.yaxis.label.set_fontsize(_FONT_SIZE)


def _write_legend(axes: Axes, labels: list[str]) -> None:
    """The texts are set when the legend stands, since they may be anything."""
    legend = axes.legend(axes.get_lines(), ["·"] * len(labels), fontsize=_FONT_SIZE, frameon=False)
    for entry, text in zip(legend.get_texts(), labels, strict=True):
        entry.set_text(" ".join(text.split())[:24])
        entry.set_parse_math(False)
