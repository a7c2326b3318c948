"""Which figures of a table are marked because they pass a limit of the component or the design."""

from __future__ import annotations

from enum import StrEnum
from typing import TYPE_CHECKING

from calm.case import Result
from calm.checks.posture import meant_for_the_surface
from calm.checks.strength import safety_factor

if TYPE_CHECKING:
    from calm.case import TowResult
    from calm.case.columns import ComponentRow
    from calm.files import Component


class Mark(StrEnum):
    """The sign behind a figure: legible without colour."""

    NONE = ""
    NEAR = "~"
    BEYOND = "!"


def tilt_mark(component: Component, tilt: float) -> Mark:
    """Mark of a tilt [deg]: beyond `max_tilt` the component is not to be trusted."""
    if component.max_tilt is not None and tilt > component.max_tilt:
        return Mark.BEYOND
    if component.warn_tilt is not None and tilt > component.warn_tilt:
        return Mark.NEAR
    return Mark.NONE


def safety_mark(result: Result | TowResult, record: ComponentRow) -> Mark:
    """Mark of a safety factor: too small, or the piece bears more than its working load.

    The factor asked on the breaking load is the file's `checks.safety_factor`, for a surface
    mooring, for a synthetic cable, or for steel. What is not known, NaN, is not marked.
    """
    meant = isinstance(result, Result) and meant_for_the_surface(result)
    surface = meant or result.type == "surface"
    least = safety_factor(record.part.component, result.file.checks.safety_factor, surface)
    beyond = record.safety_factor < least or record.utilisation > 1.0
    return Mark.BEYOND if beyond else Mark.NONE
