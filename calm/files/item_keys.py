"""Keys of line items and clamps, including keys for individual equipment."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Annotated, Any, TypeGuard

from pydantic import Field

from calm.errors import shown
from calm.files import definition
from calm.files.check_limits import Day
from calm.files.definition import Text, described, optional
from calm.files.yaml_document import SourceMapping, validate


def listed_serials(given: str | tuple[str, ...] | None) -> tuple[str, ...]:
    """Convert the value of the key `serial`, a text or a list, to a tuple of serial numbers."""
    return (given,) if isinstance(given, str) else given or ()


class Equipment(definition.Model):
    """Keys that describe the individual equipment at one position in the line.

    `serial` is one number or a list of numbers. In an item with `count`, the list has the numbers
    of all its pieces.
    """

    serial: Text | Annotated[tuple[Text, ...], Field(min_length=1)] | None = optional(
        "serial number; for several items (`count`) or a pair of releases, a list of numbers",
        12345,
    )
    calibrated: Day | None = optional("day of the last calibration, e.g. 2026-03-01", "2026-03-01")
    sampling: Text | None = optional("sampling scheme as text, e.g. every 10 min", "every 10 min")
    battery_until: Day | None = optional(
        "day on which the battery runs out, e.g. 2027-06-30", "2028-01-31"
    )
    termination: Text | None = optional(
        "end fittings of a cable, e.g. swaged sockets", "swaged sockets"
    )
    planned_depth: Annotated[float | None, definition.LENGTH] = optional(
        "planned depth in still water; by default the depth in the label",
        "200 m",
    )

    def planned_for(self, depth: float | None) -> Equipment:
        """Return a copy of the equipment with another planned depth [m]."""
        return self.model_copy(update={"planned_depth": depth})

    @property
    def serials(self) -> tuple[str, ...]:
        """Serial numbers, as a tuple; empty if there are none."""
        return listed_serials(self.serial)

    def of(self, repeat: int, items: int) -> Equipment:
        """Return the equipment of one of the pieces that an item of the line produces.

        Parameters
        ----------
        repeat : index of the piece within the `count` of the item
        items : number of serial numbers per piece, such as 2 for a pair of releases
        """
        if not isinstance(self.serial, tuple):
            return self
        first = min(repeat * items, len(self.serial) - items)
        own = self.serial[first : first + items]
        return self.model_copy(update={"serial": own if items > 1 else own[0]})


LOAD = definition.QuantityField("force", usual_unit="kN", at_least=0)


class LengthAt(definition.Model):
    """Length of a cable [m], and the load under which the length was measured [N]."""

    load: Annotated[float, LOAD] = described("load on the cable", "2 kN")
    length: Annotated[float, definition.POSITIVE_LENGTH] = described(
        "length measured under `load`", "480 m"
    )


ASSEMBLY_FIGURES = (
    "working_load", "breaking_load", "opening_load", "grip", "max_tilt", "depth_rating"
)  # fmt: skip
"""Values of an assembly that are used for every part without a value of its own."""
MOST_PIECES = 10_000
"""Maximum number of pieces in a line, after expansion of assemblies and counts."""


Label = Annotated[Text, described("name of the piece in results; by default its id", "top float")]


class ClampKeys(Equipment):
    """Keys of a clamp, which is an instrument clamped on a piece."""

    use: str = described("id of a component in the catalogue or in `components`", "sbe37")
    label: Label = ""
    at: Annotated[float, definition.LENGTH] = described(
        "unstretched distance from the top of the piece", "20 m"
    )


class ItemKeys(Equipment):
    """Keys of a line item, which may also contain keys that override values of its component."""

    use: str = described("id of a component in the catalogue or in `components`", "wire-jacketed-8")
    label: Label = ""
    count: Annotated[int, Field(ge=1, le=MOST_PIECES)] = described(
        "number of consecutive pieces", 6, default=1
    )
    length: definition.Length = 0.0
    length_at: LengthAt = described(
        "a length measured under a load, e.g. {load: 2 kN, length: 480 m}",
        {"load": "2 kN", "length": "480 m"},
    )
    top_depth: Annotated[float, definition.LENGTH] = described(
        "required depth of the top of the line in still water", "105 m"
    )
    body_depth: Annotated[float, definition.LENGTH] = described(
        "required depth of the lower end of this cable in a tow, at the speed of the tow", "70 m"
    )
    clamps: tuple[ClampKeys, ...] = described(
        "instruments fixed to this piece", [{"use": "sbe37", "at": "20 m"}]
    )


EQUIPMENT_KEYS = frozenset(Equipment.model_fields)
NO_EQUIPMENT = Equipment()


def read_equipment(item: SourceMapping) -> Equipment:
    """Read the `Equipment` keys of an item or a clamp."""
    given = {key: item.data[key] for key in item.data.keys() & EQUIPMENT_KEYS}
    if not given:
        return NO_EQUIPMENT
    return validate(Equipment, item.holding(given)) or NO_EQUIPMENT


def check_counted(item: SourceMapping, count: int, items: int | None) -> None:
    """Check that serial numbers and planned depths of an item fit its number of pieces.

    Clamps of the item are checked as well. Only a single piece may have a planned depth.

    `items` is the number of serial numbers per piece, such as 2 for a pair of releases; None if
    unknown.
    """
    clamps: Any = item.data.get("clamps")
    below = [(("clamps", i), one) for i, one in enumerate(clamps if _is_list(clamps) else ())]
    for place, data in [((), item.data), *below]:
        serials = data.get("serial") if isinstance(data, dict) else None
        each = 1 if place else items
        if _is_list(serials) and each is not None and len(serials) != each * count:
            of = f" of {each} items each" if each > 1 else ""
            message = f"`serial` has {len(serials)} numbers for a count of {count}{of}"
            item.refuse((*place, "serial"), message)
        elif _is_list(serials) and (twice := _repeated_number(serials)):
            item.refuse((*place, "serial"), f"`serial` lists {shown(twice)} twice")
        if isinstance(data, dict) and "planned_depth" in data and count > 1:
            message = f"`planned_depth` is for single pieces; this item has a `count` of {count}"
            item.refuse((*place, "planned_depth"), message, key=True)


def _repeated_number(serials: Sequence[object]) -> str:
    texts = [str(one) for one in serials]
    # texts without digits, such as question marks, may be repeated
    numbers = (one for one in texts if any(digit.isdigit() for digit in one))
    return next((one for one in numbers if texts.count(one) > 1), "")


def _is_list(value: object) -> TypeGuard[Sequence[object]]:
    return isinstance(value, (list, tuple))
