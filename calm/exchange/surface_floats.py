"""Find whether the float of an imported design is at the surface, from a still-water solution."""

from pathlib import Path

from calm.case import load
from calm.errors import CalmError
from calm.exchange import model
from calm.exchange.design_writer import mooring_text


def sink_what_stays_under_water(design: model.ImportedDesign, output: Path) -> None:
    """Replace the uppermost float with `design.sunken` if the float is submerged in still water.

    A line without an equilibrium is not changed. `output` is the path of the future mooring file.
    """
    if design.sunken is None:
        return
    try:
        rest = load(output, text=mooring_text(design, "")[0]).leg.at_rest
    except CalmError:
        return
    # a float submerged only in a current is a surface float that is too small, and is kept
    if rest is not None and not rest.surface:
        design.items[0].component = design.sunken
