"""Keys of a mooring file beside the design: document, units, serial numbers, what went out."""

from __future__ import annotations

import math
from collections.abc import Sequence
from contextlib import suppress
from typing import Annotated, Any, Literal, TypeGuard

from pydantic import AfterValidator, Field, WithJsonSchema, model_validator

from calm.errors import shown, unknown
from calm.files import definition
from calm.files.check_limits import Day
from calm.files.definition import Text, described, optional
from calm.files.environment import Position
from calm.files.yaml_document import SourceMapping, validate
from calm.quantities import SHOWN_UNITS
from calm.records.current_terms import TimeChoiceError, parse_time
from calm.units import QuantityError, parse_quantity


def _moment(text: str) -> str:
    try:
        parse_time(text)
    except TimeChoiceError as error:
        raise ValueError(str(error)) from None
    return text


Moment = Annotated[
    Text,
    AfterValidator(_moment),
    WithJsonSchema({"type": "string", "pattern": r"^\d{4}-\d{2}-\d{2}"}),
]
"""A day, or a day and time, as ISO 8601 writes them; kept as written."""


class OutputUnits(definition.Model):
    """Say in which units people read tables, papers and the builder; files for programs are SI."""

    force: Literal["N", "kN", "kgf", "lbf"] | None = optional(
        "of tensions, weights and loads", "kgf"
    )
    length: Literal["m", "ft"] | None = optional("of lengths and depths", "m")
    speed: Literal["m/s", "cm/s", "kn"] | None = optional("of currents and ships", "kn")
    mass: Literal["kg", "lb"] | None = optional("of masses in air", "kg")

    @model_validator(mode="before")
    @classmethod
    def _by_dimension(cls, data: object) -> object:
        texts = data.replace(",", " ").split() if isinstance(data, str) else data
        listed = [*texts] if isinstance(texts, list | tuple | dict) else []
        meant = [unit_meant(str(text)) for text in listed if text not in cls.model_fields]
        if found := [f"{each[0]}: {each[1]}" for each in meant if each]:
            raise ValueError(f"write `units: {{{', '.join(found)}}}`")
        return data

    @property
    def chosen(self) -> dict[str, str]:
        """Return the units that are given, by dimension."""
        return self.model_dump(exclude_none=True)


def unit_meant(text: str) -> tuple[str, str] | None:
    """Return the dimension and the unit to show that a text names, as `knots`; None of no such."""
    for dimension, units in SHOWN_UNITS.items():
        with suppress(QuantityError):
            value = parse_quantity(f"1 {text}", dimension)
            alike = (unit for unit, one in units.items() if math.isclose(one, value))
            return next(((dimension, unit) for unit in alike), None)
    return None


class Revision(definition.Model):
    """A revision of the document, and what it changed."""

    revision: Text = described("letter or number", "B")
    date: Day | None = optional("day, e.g. 2026-11-20", "2026-11-20")
    by: Text | None = optional("who made it", "A. Martin")
    change: Text | None = optional("what is new", "wire 20 m longer")


class DocumentKeys(definition.Model):
    """The title block of a drawing."""

    id: Text | None = optional("of the drawing", "M-2026-17")
    revision: Text | None = optional("letter or number", "B")
    date: Day | None = optional("day, e.g. 2026-11-20", "2026-11-20")
    author: Text | None = optional("who drew it", "A. Martin")
    checked: Text | None = optional("by whom", "B. Li")
    approved: Text | None = optional("by whom", "C. Okafor")
    project: Text | None = optional("what it belongs to", "Slope currents")
    ship: Text | None = optional("the ship that deploys the mooring", "RV Example")
    cruise: Text | None = optional("its name or number", "EX-142")
    institution: Text | None = optional("whose mooring it is", "Institute of Examples")
    investigator: Text | None = optional("who is responsible for the data", "D. Ruiz")
    email: Text | None = optional("of the author", "a.martin@example.org")
    url: Text | None = optional("of the author or the institution", "https://example.org")
    license: Text | None = optional("of the data", "CC-BY-4.0")
    acknowledgement: Text | None = optional("who paid", "Funded by the Examples Fund")
    site: Text | None = optional("its code at OceanSITES", "EXAMPLE")
    platform: Text | None = optional("code of the mooring", "EXAMPLE-1")
    deck_time: (
        dict[definition.Role, Annotated[float, definition.QuantityField("time", at_least=0)]] | None
    ) = optional(
        "time that a piece takes on deck before it goes over, by its role",
        {"float": "5 min", "instrument": "3 min", "line": "2 min"},
    )
    history: tuple[Revision, ...] = described(
        "the revisions, and what each changed",
        [{"revision": "A", "date": "2026-10-02", "by": "A. Martin", "change": "first issue"}],
        default=(),
    )

    def to_dict(self) -> dict[str, Any]:
        """Return what is given, as JSON has it."""
        return self.model_dump(mode="json", exclude_none=True, exclude_defaults=True)


class ReleaseKeys(definition.Model):
    """A release by its serial number, and its codes: one text, several, or several by name."""

    serial: Text | None = optional("of the release", 1729)
    codes: Text | tuple[Text, ...] | dict[str, Text] | None = optional(
        "one text, several, or several by name, e.g. {enable: 0123, release: 4567}",
        {"enable": "0A51", "release": "0A55"},
    )

    @property
    def code_lines(self) -> tuple[str, ...]:
        """Return the codes as a person reads them, one a line."""
        if isinstance(self.codes, dict):
            return tuple(f"{name}: {code}" for name, code in self.codes.items())
        return (self.codes,) if isinstance(self.codes, str) else self.codes or ()


class DeployedItem(definition.Model):
    """A piece or a clamp as it went over the side; a cable was cut to `length` [m]."""

    label: Text = described("of the piece or clamp in results", "wire-jacketed-8")
    serial: Text | None = optional("serial number; for a count, a list with one for each", 12345)
    length: definition.PositiveLength = optional("what a cable was cut to", "480 m")
    remark: Text | None = optional("anything worth knowing", "one terminal remade")


class Deployed(definition.Model):
    """The deployment: where and when, and what of the mooring differs from the design."""

    date: Moment | None = optional("day or time, e.g. 2027-03-02T10:40", "2027-03-02T10:40")
    position: Position | None = optional(
        "where it stands", {"latitude": "48.3 deg", "longitude": "-5.2 deg"}
    )
    depth: Annotated[float | None, definition.QuantityField("length", above=0)] = optional(
        "of the water there", "1100 m"
    )
    items: tuple[DeployedItem, ...] = described(
        "what differs, piece by piece",
        [{"label": "wire-jacketed-8", "length": "479.2 m"}],
        default=(),
    )


class Equipment(definition.Model):
    """Hold what the file says of the individual thing at a place of the line.

    `serial` is a text, or as many as the `count` of the item; of an item, one of it is chosen for
    each piece. As read, `planned_depth` also holds a depth that the label names.
    """

    serial: Text | Annotated[tuple[Text, ...], Field(min_length=1)] | None = optional(
        "serial number; for a count, a list with one for each", 12345
    )
    calibrated: Day | None = optional("day of its last calibration, e.g. 2026-03-01", "2026-03-01")
    sampling: Text | None = optional(
        "how it samples, as people read it, e.g. every 10 min", "every 10 min"
    )
    battery_until: Day | None = optional(
        "day on which its battery is empty, e.g. 2027-06-30", "2028-01-31"
    )
    termination: Text | None = optional(
        "how the ends of a cable are made, e.g. swaged sockets", "swaged sockets"
    )
    planned_depth: Annotated[float | None, definition.LENGTH] = optional(
        "depth it is planned to hang at in still water; unless given, the depth in its label",
        "200 m",
    )

    def planned_for(self, depth: float | None) -> Equipment:
        """Return the equipment with another planned depth [m]."""
        return self.model_copy(update={"planned_depth": depth})

    def of(self, repeat: int) -> Equipment:
        """Return the equipment of one of a count, from 0."""
        if not isinstance(self.serial, tuple):
            return self
        return self.model_copy(update={"serial": self.serial[min(repeat, len(self.serial) - 1)]})


LOAD = definition.QuantityField("force", usual_unit="kN", at_least=0)


class LengthAt(definition.Model):
    """A length of a cable [m] as measured under a load [N]."""

    load: Annotated[float, LOAD] = described("that the cable was under", "2 kN")
    length: Annotated[float, definition.POSITIVE_LENGTH] = described(
        "as measured under `load`", "480 m"
    )


MOST_PIECES = 10_000
"""Pieces a line may have, after assemblies and counts are expanded."""


Label = Annotated[
    Text, described("name of the piece in results; the id when there is none", "top float")
]


class ClampKeys(Equipment):
    """An instrument fixed to a piece."""

    use: str = described("id of a component of the catalogue or of `components`", "sbe37")
    label: Label = ""
    at: Annotated[float, definition.LENGTH] = described(
        "distance from the top of the piece, unstretched", "20 m"
    )


class ItemKeys(Equipment):
    """A piece of the line; other fields override the component's."""

    use: str = described("id of a component of the catalogue or of `components`", "wire-jacketed-8")
    label: Label = ""
    count: Annotated[int, Field(ge=1, le=MOST_PIECES)] = described(
        "how many follow one another in the line", 6, default=1
    )
    length: definition.Length = 0.0
    length_at: LengthAt = described(
        "a length measured under a load, e.g. {load: 2 kN, length: 480 m}",
        {"load": "2 kN", "length": "480 m"},
    )
    top_depth: Annotated[float, definition.LENGTH] = described(
        "depth wanted in still water for the top of the line", "105 m"
    )
    body_depth: Annotated[float, definition.LENGTH] = described(
        "depth wanted in a tow for the lower end of this cable, at the tow's speed", "70 m"
    )
    clamps: tuple[ClampKeys, ...] = described(
        "instruments fixed to this piece", [{"use": "sbe37", "at": "20 m"}]
    )


EQUIPMENT_KEYS = frozenset(Equipment.model_fields)
NO_EQUIPMENT = Equipment()


def read_equipment(item: SourceMapping) -> Equipment:
    """Read what an item or a clamp says of the individual thing."""
    given = {key: item.data[key] for key in item.data.keys() & EQUIPMENT_KEYS}
    if not given:
        return NO_EQUIPMENT
    return validate(Equipment, item.holding(given)) or NO_EQUIPMENT


def check_counted(item: SourceMapping, count: int) -> None:
    """Check that serial numbers given as a list are as many as the item, and its clamps, count,
    and that one planned depth is not given for several pieces.
    """
    clamps: Any = item.data.get("clamps")
    below = [(("clamps", i), one) for i, one in enumerate(clamps if _is_list(clamps) else ())]
    for place, data in [((), item.data), *below]:
        serials = data.get("serial") if isinstance(data, dict) else None
        if _is_list(serials) and len(serials) != count:
            message = f"`serial` has {len(serials)} numbers for a count of {count}"
            item.refuse((*place, "serial"), message)
        if isinstance(data, dict) and "planned_depth" in data and count > 1:
            message = f"`planned_depth` is of one piece; this item counts {count}: list them"
            item.refuse((*place, "planned_depth"), message, key=True)


def _is_list(value: object) -> TypeGuard[Sequence[object]]:
    return isinstance(value, (list, tuple))


def check_deployed(
    deployed: Deployed, labels: Sequence[str], cables: Sequence[str], top: SourceMapping
) -> None:
    """Check that what was deployed is of the line, each part once, and that only cables are cut.

    Parameters
    ----------
    labels : of pieces and clamps
    cables : those of what is cut to length
    top : the mooring file
    """
    seen: set[str] = set()
    for number, item in enumerate(deployed.items):
        where = ("deployed", "items", number)
        text = shown(item.label)
        if item.label not in labels:
            message = unknown(f"no piece or clamp is called `{text}`", item.label, labels)
            top.refuse((*where, "label"), message)
        elif item.label in seen:
            top.refuse((*where, "label"), f"`{text}` is given twice")
        elif item.length is not None and item.label not in cables:
            message = f"`length` of `{text}`: only a cable or chain is cut to length"
            top.refuse((*where, "length"), message)
        seen.add(item.label)
