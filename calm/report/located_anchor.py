"""A located anchor as blocks, and the plot that ships use: circles and the place."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from calm.checks.finding import State
from calm.drawing.picture import empty_figure
from calm.report import blocks
from calm.report.blocks import Block, Cell, Note, Pairs, Prose, ReportPart, Table, number, table_of
from calm.report.provenance import degrees_text

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from calm.ranging import Located

_FONT_SIZE = 8.0
_CIRCLE, _LEFT_OUT, _PLACE = "#2b7bba", "#999999", "#c0392b"
_ROUND = np.linspace(0.0, 2.0 * np.pi, 1441)


def located_part(located: Located, water_depth: float) -> ReportPart:
    """The place, how well it is known, and the residual of every range; in a depth of water [m]."""
    outliers = [
        line for line, used in zip(located.survey.line, located.used, strict=True) if not used
    ]
    said = []
    if outliers:
        several = "lines" if len(outliers) > 1 else "line"
        lines = ", ".join(map(str, outliers))
        said.append(Prose((f"Not used, they do not fit the others: {several} {lines}.",)))
    notes = ["Rays are taken as straight, and the sea surface as the ellipsoid WGS 84."]
    if located.survey.timed:
        notes.append("Times are taken as two-way, without a turn-around delay of the transponder.")
    shown: tuple[Block, ...] = (
        Pairs(_figures(located, water_depth)),
        *blocks.warned(located.warnings),
        *said,
        _residuals(located),
        Note(tuple(notes)),
    )
    return ReportPart("Place of the anchor", shown)


def _figures(located: Located, water_depth: float) -> tuple[tuple[str, str], ...]:
    major, minor, bearing = located.ellipse
    within = "unknown"
    if np.isfinite(major):
        towards = f"{round(bearing) % 180:03d}°"
        within = f"{major:.1f} m by {minor:.1f} m, the longer towards {towards}"
    sure = f" ± {located.depth_95:.1f} m with 95 %" if np.isfinite(located.depth_95) else ""
    sure = ", as given" if located.depth_given else sure
    latitude = degrees_text(located.latitude, "NS", 1)
    longitude = degrees_text(located.longitude, "EW", 1)
    pairs = [
        ("Latitude, longitude", f"{located.latitude:.6f}, {located.longitude:.6f}"),
        ("", f"{latitude}  {longitude}"),
        ("Within, with 95 %", within),
        ("Depth", f"{water_depth:.1f} m{sure}"),
        ("Ranges in use", f"{int(located.used.sum())} of {len(located.used)}"),
        ("Scatter", f"{located.rms:.2f} m" if np.isfinite(located.rms) else "unknown"),
    ]
    if located.survey.timed:
        pairs.append(("Speed of sound", f"{located.sound_speed:.1f} m/s, harmonic mean"))
    return tuple(pairs)


def _residuals(located: Located) -> Table:
    """A row for each range, in the order of the file."""
    survey, used = located.survey, located.used
    decimals, measured = (4, ("time", "s")) if survey.timed else (1, ("range", "m"))

    def residual(at: int) -> Cell:
        return Cell(f"{located.residuals[at]:+.2f}", state=None if used[at] else State.FAIL)

    return table_of(
        "Ranges",
        range(len(survey.line)),
        number("line", lambda at: survey.line[at]),
        number("latitude", lambda at: f"{survey.latitude[at]:.5f}", "°"),
        number("longitude", lambda at: f"{survey.longitude[at]:.5f}", "°"),
        number(measured[0], lambda at: f"{survey.measured[at]:.{decimals}f}", measured[1]),
        number("residual", residual, "m"),
        blocks.words("", lambda at: None if used[at] else "not used", 0.0),
        note="Residual: measured less computed.",
    )


def located_figure(located: Located) -> Figure:
    """Return where each range meets the depth of what answers, as a circle about the ship.

    Left all of the survey, right the place itself with its 95 % ellipse. What is not used is
    grey and dashed, and carries the number of its line.
    """
    figure = empty_figure(9.6, 4.9)
    figure.subplots_adjust(0.075, 0.1, 0.985, 0.93, wspace=0.22)
    whole, near = figure.subplots(1, 2)
    frame, survey = located.survey.frame, located.survey
    ships = frame.place(
        survey.latitude, survey.longitude, np.full(len(survey.line), survey.transducer)
    )
    ships = ships - located.place
    ranges = located.residuals + np.linalg.norm(ships, axis=1)
    across = np.sqrt(np.maximum(ranges**2 - ships[:, 2] ** 2, 0.0))
    for axes in (whole, near):
        for (x, y, _), radius, used in zip(ships, across, located.used, strict=True):
            axes.plot(
                x + radius * np.cos(_ROUND), y + radius * np.sin(_ROUND), linewidth=0.8,
                color=_CIRCLE if used else _LEFT_OUT, linestyle="-" if used else "--",
            )  # fmt: skip
        axes.set_aspect("equal")
        axes.tick_params(labelsize=_FONT_SIZE)
        axes.grid(alpha=0.3, linewidth=0.5)
        axes.set_xlabel("east of the anchor [m]", fontsize=_FONT_SIZE)
        axes.set_ylabel("north of the anchor [m]", fontsize=_FONT_SIZE)
    reach = 1.15 * float(np.abs(ships[:, :2]).max())
    for line, (x, y, _) in zip(survey.line, ships.tolist(), strict=True):
        whole.plot(x, y, "^", color="#111111", markersize=4)
        whole.annotate(str(line), (x, y), textcoords="offset points", xytext=(4, 3),
                       fontsize=_FONT_SIZE - 1.0)  # fmt: skip
    whole.set_title("all ranges, numbered by line of the file", fontsize=_FONT_SIZE)
    _draw_ellipse(near, located)
    scatter = float(np.abs(located.residuals[located.used]).max())
    close = max(3.0 * np.nan_to_num(located.horizontal_95), 3.0 * scatter, 1.0)
    near.set_title("the place, with its 95 % ellipse", fontsize=_FONT_SIZE)
    for axes, half in ((whole, max(reach, 2.0 * close)), (near, close)):
        axes.plot(0.0, 0.0, "+", color=_PLACE, markersize=10, markeredgewidth=1.6)
        axes.set(xlim=(-half, half), ylim=(-half, half))
    return figure


def _draw_ellipse(axes: Axes, located: Located) -> None:
    major, minor, bearing = located.ellipse
    if not np.isfinite(major):
        return
    east, north = np.sin(np.radians(bearing)), np.cos(np.radians(bearing))
    along, aside = major * np.cos(_ROUND), minor * np.sin(_ROUND)
    axes.fill(along * east + aside * north, along * north - aside * east, color=_PLACE, alpha=0.25)
