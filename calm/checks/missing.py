"""Figures that a component does not give, and that the design check or the deck sheet then lack.

They are no fault of a catalogue: many figures are printed nowhere. What was looked for in vain is
kept with the component (`searched`), so that nobody looks twice.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass

from calm.checks.inventory import mass_in_air
from calm.checks.posture import JUDGED_ROLES
from calm.files import Anchor, Component
from calm.files.catalogue import Assembly

LOADS = ("working_load", "breaking_load")
"""Either of them lets the strength be judged."""

TILTED_ROLES = ("instrument", "release")
"""What stands upright to do its work."""


@dataclass(frozen=True)
class MissingFigures:
    """What a component does not give: `searched` was looked for and is printed nowhere."""

    id: str
    figures: tuple[str, ...]
    searched: tuple[str, ...]


def missing_figures(definitions: Mapping[str, Component | Assembly]) -> list[MissingFigures]:
    """The components of a catalogue that lack a figure, and which.

    Assemblies give no figures of their own.
    """
    found = []
    for identifier, definition in definitions.items():
        if isinstance(definition, Assembly):
            continue
        figures = tuple(_missing(definition))
        sought = tuple(name for name in figures if name in (definition.searched or ()))
        if figures:
            found.append(MissingFigures(identifier, figures, sought))
    return found


def _missing(component: Component) -> Iterator[str]:
    if mass_in_air(component) is None:
        yield "mass"
    borne = not isinstance(component, Anchor)
    if borne and all(getattr(component, load) is None for load in LOADS):
        yield from LOADS
    if component.role in JUDGED_ROLES and component.depth_rating is None:
        yield "depth_rating"
    if component.role in TILTED_ROLES and component.max_tilt is component.warn_tilt is None:
        yield "max_tilt"
    if isinstance(component, Anchor) and component.material is None and component.density is None:
        yield "material"
