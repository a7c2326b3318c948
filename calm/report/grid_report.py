"""Report on gridded records: scales, sections over time, and text for a methods section."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from calm.batch.finished import open_result
from calm.drawing.plot import empty_figure, figure_svg
from calm.gridding.field import GriddedQuantity
from calm.gridding.gridded_record import COLOURS, GriddedRecord, draw_section
from calm.physics.line import Floats
from calm.quantities import QUANTITIES_MEASURED
from calm.report import blocks
from calm.report.blocks import Figure, Note, Prose, Report, ReportPart, Table, number, table_of
from calm.report.provenance import report_of
from calm.report.read_card import card_blocks
from calm.version import __version__

_WIDTH, _HEIGHT, _SIZE = 7.4, 2.3, 7.0  # size [in], font size [pt]
_READ = (
    "Lines are the depths of the instruments. Pale areas are flagged as doubtful: they lie beyond "
    "the instruments, or in a gap that the record does not resolve. White means no value."
)


def grid_report(output: Path, record: GriddedRecord) -> Report:
    """Build the report of a gridded file: sections, scales, and text for a methods section."""
    fields, levels, names = record.fields, record.levels, record.names
    figures: list[Figure] = []
    with open_result(output) as result:
        title = str(result.attrs["title"])
        for name, field in fields.items():
            ends = ("_SD", "_QC") if names[name].isupper() else ("_sd", "_qc")
            columns = [np.asarray(result[names[name] + end].values) for end in ("", *ends)]
            figures.append(_section_figure(name, field, levels, *columns))
    time = next(iter(fields.values())).samples.time
    return report_of(
        title,
        f"{str(time[0])[:16]} to {str(time[-1])[:16]}, {len(time)} times, {len(levels)} levels",
        ReportPart("Sections", (*figures, Note((_READ,)))),
        ReportPart("Scales", (scales_table(fields),)),
        ReportPart("For the methods of a cruise report", (Prose(methods_text(fields, levels)),)),
        ReportPart("Inputs", card_blocks(card.to_dict() for card in record.cards)),
        name=output.name,
    )


def grid_document(record: GriddedRecord) -> dict[str, Any]:
    """Return the JSON object with the scales of each quantity [m, s] and the file cards."""
    return {
        "quantities": {
            name: {
                "instruments": list(field.samples.label),
                "depth_scale": float(field.scales.depth),
                "time_scale": float(field.scales.time) if field.in_time else None,
                "rest": float(field.scales.share),
            }
            for name, field in record.fields.items()
        },
        "read": [card.to_dict() for card in record.cards],
    }


def grid_part(fields: Mapping[str, GriddedQuantity]) -> ReportPart:
    """Build the report on gridded records for a terminal."""
    return ReportPart("", (scales_table(fields),))


def scales_table(fields: Mapping[str, GriddedQuantity]) -> Table:
    """Tabulate the correlation scales of each quantity."""

    return table_of(
        "",
        fields.items(),
        blocks.words("quantity", 0),
        number("instruments", lambda one: _instrument_count(one[1])),
        number("depth scale", lambda one: f"{one[1].scales.depth:.3g}", "m"),
        number("time scale", lambda one: _time_scale_text(one[1]), "h"),
        number("rest", lambda one: f"{100.0 * one[1].scales.share:.2g}", "%"),
        number("widened", lambda one: f"{one[1].beyond:.2f}"),
        note="Correlation falls to 0.48 over one depth scale and to 0.37 over one time scale. "
        "Rest: uncorrelated part of the variance. Widened: factor by which the bands are widened "
        "beyond the instruments. CALM finds this factor by omitting each instrument in turn.",
    )


def methods_text(fields: Mapping[str, GriddedQuantity], levels: Floats) -> tuple[str, ...]:
    """Return sentences for the methods section of a cruise report."""
    return (
        f"The values of {', '.join(fields)} at the estimated depths of the instruments were "
        f"interpolated to {len(levels)} levels between {levels[0]:g} and {levels[-1]:g} m. "
        "The interpolation uses a Gaussian process in depth and time for the deviations from the "
        f"mean profile of the record (CALM {__version__}).",
        *(
            f"{name}: {_instrument_count(field)} instruments; correlation scales of "
            f"{field.scales.depth:.3g} m in depth and {_time_scale_text(field)} h in time; "
            f"{100.0 * field.scales.share:.2g} % of the variance was treated as uncorrelated."
            for name, field in fields.items()
        ),
        "Standard deviations include the error of the sensors, the error of their depths "
        "times the local gradient, and the error of interpolation between instruments; "
        "levels beyond the instruments are flagged.",
    )


def _instrument_count(field: GriddedQuantity) -> int:
    return int(np.isfinite(field.samples.value).any(axis=0).sum())


def _time_scale_text(field: GriddedQuantity) -> str:
    return f"{field.scales.time / 3600.0:.3g}" if field.in_time else "-"


def _section_figure(
    name: str, field: GriddedQuantity, levels: Any, value: Any, deviation: Any, flag: Any
) -> Figure:
    drawing = empty_figure(_WIDTH, 2 * _HEIGHT)
    drawing.subplots_adjust(0.08, 0.07, 0.98, 0.96, hspace=0.25)
    upper, lower = drawing.subplots(2, 1, sharex=True)
    unit = QUANTITIES_MEASURED[name].units.replace("degree_Celsius", "°C").replace("m s-1", "m/s")
    for axes, table, colours, title in (
        (upper, value, COLOURS[name], name),
        (lower, deviation, "magma_r", "standard deviation"),
    ):
        mesh = draw_section(axes, field.samples, levels, table, flag, colours)
        bar = drawing.colorbar(mesh, ax=axes, pad=0.01)
        bar.set_label(unit if unit != "1" else "", fontsize=_SIZE)
        bar.ax.tick_params(labelsize=_SIZE)
        axes.set_title(title, fontsize=_SIZE, loc="left", pad=2)
        axes.yaxis.label.set_size(_SIZE)
        axes.tick_params(labelsize=_SIZE)
    return Figure(f"{name}: value, and its standard deviation", figure_svg(drawing))
