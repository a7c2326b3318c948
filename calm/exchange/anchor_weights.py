"""Set anchor weights that hold the line of an imported design."""

from pathlib import Path

from calm.case import load
from calm.errors import CalmError
from calm.exchange import model
from calm.exchange.design_writer import mooring_text
from calm.files.definition import CATALOGUE_DENSITY, STANDARD_GRAVITY
from calm.physics.materials import STEEL_DENSITY
from calm.quantities import rounded

_HOLDS = 1e8  # N: holds any line
_IN_WATER = (1.0 - CATALOGUE_DENSITY / STEEL_DENSITY) * STANDARD_GRAVITY  # N of a kilogram of steel
_DIGITS = 2  # digits of a guessed weight
_LEAST = 100.0  # smallest guessed weight in N


def secure_anchors(design: model.ImportedDesign, output: Path) -> None:
    """Set the weight of each anchor that has no weight or that the line lifts.

    The new weight is the weight that `calm check` requires in the current of the imported file.
    Without an equilibrium, only missing weights are set, to a value that holds any line. `output`
    is the path of the future mooring file.
    """
    last = design.items if design.legs else design.items[-1:]
    anchors = [item.component for item in last if item.component.kind == "anchor"]
    if design.tow is not None or not anchors:
        return
    for anchor, pull, required in _anchor_loads(design, anchors, output):
        mass, weight = anchor.figures.get("mass"), anchor.figures.get("weight")
        given = weight if weight is not None or mass is None else _IN_WATER * float(mass)
        if isinstance(given, float) and (pull is None or pull <= given):
            continue
        anchor.figures.pop("mass", None)
        anchor.guesses.pop("mass", None)
        reason = (
            "the file gives no anchor weight; `calm check` requires this weight in the current of "
            "the file"
        )
        anchor.figures["weight"] = rounded(max(required, _LEAST), _DIGITS, up=True)
        if pull is None:
            reason = "the file gives no anchor weight; this value is large enough for any line"
            anchor.figures["weight"] = _HOLDS
        elif given is not None:
            reason = (
                f"the vertical load of {pull:.5g} N exceeds the weight of {given:.5g} N in the file"
            )
        anchor.guesses["weight"] = reason


def _anchor_loads(
    design: model.ImportedDesign, anchors: list[model.ImportedComponent], output: Path
) -> list[tuple[model.ImportedComponent, float | None, float]]:
    """Return each anchor, its vertical load and its required weight [N].

    The load is None if there is no equilibrium.
    """
    # the shape of the line does not depend on the anchor weight
    before = [anchor.figures for anchor in anchors]
    for anchor in anchors:
        anchor.figures = {k: one for k, one in anchor.figures.items() if k != "mass"}
        anchor.figures["weight"] = _HOLDS
    try:
        read = load(output, text=mooring_text(design, "")[0])
        loads = read.solve().anchors
    except CalmError:
        return [(anchor, None, 0.0) for anchor in anchors]
    finally:
        for anchor, figures in zip(anchors, before, strict=True):
            anchor.figures = figures
    pairs = zip(anchors, loads, strict=True)
    return [(anchor, load.vertical, load.required_weight or 0.0) for anchor, load in pairs]
