"""Anchors without a weight in the files of other programs: made heavy enough to hold the line."""

from __future__ import annotations

from pathlib import Path

from calm.case import Mooring, load
from calm.errors import CalmError
from calm.exchange.design import Design, ImportedComponent
from calm.exchange.writing import written
from calm.files.definition import CATALOGUE_DENSITY, STANDARD_GRAVITY, STEEL_DENSITY
from calm.quantities import rounded

_HOLDS = 1e8  # N: holds whatever is tied to it
_IN_WATER = (1.0 - CATALOGUE_DENSITY / STEEL_DENSITY) * STANDARD_GRAVITY  # N of a kilogram of steel
_DIGITS = 2  # that a guessed weight keeps
_LEAST = 100.0  # N of a guessed weight


def hold(design: Design, environment: list[str] | None, output: Path) -> None:
    """Give the anchor a weight where the file gives none, or one that the line would lift.

    The shape of the line does not depend on it. The weight is what `calm check` asks for in this
    current. A line without an equilibrium is left to `calm run`, which says so.
    """
    anchor = design.items[-1].component if design.items and design.tow is None else None
    if anchor is None or anchor.kind != "anchor":
        return
    mass, weight = anchor.figures.get("mass"), anchor.figures.get("weight")
    given = weight if weight is not None or mass is None else _IN_WATER * float(mass)
    pull, required = _pull(design, anchor, environment, output)
    if isinstance(given, float) and (pull is None or pull <= given):
        return
    anchor.figures.pop("mass", None)
    anchor.guesses.pop("mass", None)
    if pull is None:
        anchor.figures["weight"], reason = _HOLDS, "the file gives no weight; this holds anything"
    else:
        anchor.figures["weight"] = rounded(max(required, _LEAST), _DIGITS, up=True)
        reason = (
            "the file gives no weight; 1.5 × (V + H/0.6) in this current"
            if given is None
            else f"the file's {given:.5g} N would be lifted: the line pulls up with {pull:.5g} N"
        )
    anchor.guesses["weight"] = reason


def _pull(
    design: Design, anchor: ImportedComponent, environment: list[str] | None, output: Path
) -> tuple[float | None, float]:
    """The upward pull of the line, and the weight that holds it [N]."""
    figures = dict(anchor.figures)
    anchor.figures.pop("mass", None)
    anchor.figures["weight"] = _HOLDS
    try:
        mooring = load(output, text=written(design, "", environment).text)
        assert isinstance(mooring, Mooring)
        anchored = mooring.solve().anchor
    except CalmError:
        return None, 0.0
    finally:
        anchor.figures = figures
    return anchored.vertical, anchored.required_weight
