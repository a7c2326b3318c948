"""What follows from the figures of a component: net force, drags and the area they stand for."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, fields
from typing import Any

from calm.assemble.line_arrays import drag_of
from calm.files import Anchor, Catalogue, Component, Flexible
from calm.files.catalogue import Defined
from calm.files.components import Outline
from calm.files.definition import CATALOGUE_DENSITY
from calm.units import QuantityError, parse_quantity

_PART_KEYS = {"use", "label", "length", "count", "clamps", "at"}


@dataclass(frozen=True)
class Datasheet:
    """Figures that follow, in sea water of `CATALOGUE_DENSITY`; per metre of a cable or chain.

    Attributes
    ----------
    net_buoyancy : + up [N]
    kn, kt : drag across and along the axis, in newtons at 1 m/s [N/(m/s)²]; `kn` is None for an
        anchor, `kt` its drag in the fall
    cd_area : drag coefficient times area, across the axis [m²]
    """

    net_buoyancy: float
    kn: float | None
    kt: float | None
    cd_area: float | None


def datasheet(definition: Defined, catalogue: Catalogue | None = None) -> Datasheet | None:
    """Return what follows from the figures of a definition; for an assembly, the sums over its
    parts.

    None for an outline, and for an assembly whose parts cannot be summed here: they override
    figures of a component, or use what the catalogue does not have (`catalogue` None: no catalogue
    at all).
    """
    if isinstance(definition, Component):
        return _of_component(definition, 1.0)
    if catalogue is None or isinstance(definition, Outline):
        return None
    sheets = []
    for item in _items(definition.parts):
        component = _component(catalogue, item)
        if component is None:
            return None
        try:
            metres = parse_quantity(item["length"], "length") if "length" in item else 1.0
        except QuantityError:
            return None
        sheets.append(_of_component(component, metres))
    names = [each.name for each in fields(Datasheet)]
    return Datasheet(*(sum(getattr(sheet, name) or 0.0 for sheet in sheets) for name in names))


def _items(parts: tuple[dict[str, Any], ...]) -> Iterator[Mapping[str, Any]]:
    for part in parts:
        count = part.get("count", 1)
        for _ in range(count if isinstance(count, int) else 1):
            yield part
            yield from part.get("clamps", ())


def _component(catalogue: Catalogue, item: Mapping[str, Any]) -> Component | None:
    """The component that an item uses as it is."""
    if not item.keys() <= _PART_KEYS or catalogue.entry(str(item.get("use"))) is None:
        return None
    found = catalogue.get(str(item["use"]))
    return found if isinstance(found, Component) else None


def _of_component(component: Component, metres: float) -> Datasheet:
    """Return the figures of some metres of a cable or chain; a rigid piece has its own length."""
    if isinstance(component, Anchor):
        return Datasheet(component.net_buoyancy, None, component.kt, None)
    kn, kt, along = drag_of(component)
    times = metres if isinstance(component, Flexible) else 1.0
    return Datasheet(
        times * component.net_buoyancy,
        times * kn,
        times * (kt if along else kn),
        times * kn / (0.5 * CATALOGUE_DENSITY),
    )
