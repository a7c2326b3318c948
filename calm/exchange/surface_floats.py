"""Tell whether the float of an imported design is one at the surface, by the solved line."""

from pathlib import Path

from calm.case import load
from calm.errors import CalmError
from calm.exchange import model
from calm.exchange.design_writer import mooring_text


def sink_what_stays_under_water(design: model.ImportedDesign, output: Path) -> None:
    """Put `sunken` in the place of a float that the line leaves under water when nothing moves.

    What a current pulls under is still a float at the surface, and one too small. A line without
    an equilibrium is left as it is. The mooring file is to stand at `output`.
    """
    if design.sunken is None:
        return
    try:
        rest = load(output, text=mooring_text(design, "")[0]).leg.at_rest
    except CalmError:
        return
    if rest is not None and not rest.surface:
        design.items[0].component = design.sunken
