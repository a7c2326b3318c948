"""Keys of a mooring file besides the design: document, display units, releases, deployment."""

from __future__ import annotations

import math
from collections.abc import Sequence
from contextlib import suppress
from typing import Annotated, Any, Literal

from pydantic import AfterValidator, Field, WithJsonSchema, model_validator

from calm.errors import shown, unknown
from calm.files import definition
from calm.files.check_limits import Day
from calm.files.definition import Text, described, optional
from calm.files.environment import Position
from calm.files.item_keys import listed_serials
from calm.files.yaml_document import SourceMapping
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
"""A date, or a date and time, in ISO 8601, kept as text."""


class OutputUnits(definition.Model):
    """Display units for tables, documents and the builder; data files always use SI units."""

    force: Literal["N", "kN", "kgf", "lbf"] | None = optional(
        "unit of tensions, weights and loads", "kgf"
    )
    length: Literal["m", "ft"] | None = optional("unit of lengths and depths", "m")
    speed: Literal["m/s", "cm/s", "kn"] | None = optional("unit of currents and ship speeds", "kn")
    mass: Literal["kg", "lb"] | None = optional("unit of masses in air", "kg")

    @model_validator(mode="before")
    @classmethod
    def _by_dimension(cls, data: object) -> object:
        texts = data.replace(",", " ").split() if isinstance(data, str) else data
        listed = [*texts] if isinstance(texts, list | tuple | dict) else []
        meant = [nearest_unit(str(text)) for text in listed if text not in cls.model_fields]
        if found := [f"{each[0]}: {each[1]}" for each in meant if each]:
            raise ValueError(f"write `units: {{{', '.join(found)}}}`")
        return data

    @property
    def chosen(self) -> dict[str, str]:
        """Display units that the file sets, by dimension."""
        return self.model_dump(exclude_none=True)


def nearest_unit(text: str) -> tuple[str, str] | None:
    """Find the dimension and the display unit for a unit written as text, such as `knots`.

    Return None if no display unit equals this unit.
    """
    for dimension, units in SHOWN_UNITS.items():
        with suppress(QuantityError):
            value = parse_quantity(f"1 {text}", dimension)
            equal = (unit for unit, one in units.items() if math.isclose(one, value))
            return next(((dimension, unit) for unit in equal), None)
    return None


class Revision(definition.Model):
    """An entry in the revision list of a drawing."""

    revision: Text = described("letter or number", "B")
    date: Day | None = optional("day, e.g. 2026-11-20", "2026-11-20")
    by: Text | None = optional("author of the revision", "A. Martin")
    change: Text | None = optional("change of the design", "wire 20 m longer")


class DocumentKeys(definition.Model):
    """The title block of a drawing."""

    id: Text | None = optional("number of the drawing", "M-2026-17")
    revision: Text | None = optional("letter or number", "B")
    date: Day | None = optional("day, e.g. 2026-11-20", "2026-11-20")
    author: Text | None = optional("author of the drawing", "A. Martin")
    checked: Text | None = optional("who checked it", "B. Li")
    approved: Text | None = optional("who approved it", "C. Okafor")
    project: Text | None = optional("name of the project", "Slope currents")
    ship: Text | None = optional("the ship that deploys the mooring", "RV Example")
    cruise: Text | None = optional("name or number of the cruise", "EX-142")
    institution: Text | None = optional("owner of the mooring", "Institute of Examples")
    investigator: Text | None = optional("person responsible for the data", "D. Ruiz")
    email: Text | None = optional("email address of the author", "a.martin@example.org")
    url: Text | None = optional("web page of the author or the institution", "https://example.org")
    license: Text | None = optional("licence of the data", "CC-BY-4.0")
    acknowledgement: Text | None = optional("source of funding", "Funded by the Examples Fund")
    site: Text | None = optional("code of the site at OceanSITES", "EXAMPLE")
    platform: Text | None = optional("code of the mooring", "EXAMPLE-1")
    deck_time: (
        dict[definition.Role, Annotated[float, definition.QuantityField("time", at_least=0)]] | None
    ) = optional(
        "time on deck before a piece is deployed, by role",
        {"float": "5 min", "instrument": "3 min", "line": "2 min"},
    )
    history: tuple[Revision, ...] = described(
        "list of revisions",
        [{"revision": "A", "date": "2026-10-02", "by": "A. Martin", "change": "first issue"}],
        default=(),
    )

    def to_dict(self) -> dict[str, Any]:
        """Return the keys that the file sets, as a JSON object."""
        return self.model_dump(mode="json", exclude_none=True, exclude_defaults=True)


class ReleaseKeys(definition.Model):
    """An acoustic release with its codes, identified by its serial number.

    `codes` is one code, a list of codes, or a mapping from names to codes.
    """

    serial: Text | None = optional("serial number of the release", 1729)
    codes: Text | tuple[Text, ...] | dict[str, Text] | None = optional(
        "one code, a list of codes, or codes by name, e.g. {enable: 0123, release: 4567}",
        {"enable": "0A51", "release": "0A55"},
    )

    @property
    def code_lines(self) -> tuple[str, ...]:
        """Codes of the release, one per line of text."""
        if isinstance(self.codes, dict):
            return tuple(f"{name}: {code}" for name, code in self.codes.items())
        return (self.codes,) if isinstance(self.codes, str) else self.codes or ()


class ClockCheck(definition.Model):
    """Comparison of an instrument's clock with true time after recovery."""

    checked: Moment = described("time of the clock check", "2028-03-02T10:40")
    late: Annotated[float, definition.QuantityField("time")] = described(
        "delay of the clock; negative if the clock was ahead", "12 s"
    )


class DeployedItem(definition.Model):
    """A piece or clamp as deployed; `length` [m] is the cut length of a cable."""

    label: Text = described("label of the piece or clamp in results", "wire-jacketed-8")
    serial: Text | Annotated[tuple[Text, ...], Field(min_length=1)] | None = optional(
        "serial number, or one for each release of a pair", 12345
    )
    length: definition.PositiveLength = optional("cut length of a cable", "480 m")
    clock: ClockCheck | None = optional(
        "delay of the instrument's clock when it was checked; the delay is assumed to grow "
        "linearly from the deployment on",
        {"checked": "2028-03-02T10:40", "late": "12 s"},
    )
    remark: Text | None = optional("any remark", "one terminal remade")


class Deployed(definition.Model):
    """The deployment: place, time, and differences from the design."""

    date: Moment | None = optional("day or time, e.g. 2027-03-02T10:40", "2027-03-02T10:40")
    position: Position | None = optional(
        "position of the anchor", {"latitude": "48.3 deg", "longitude": "-5.2 deg"}
    )
    depth: Annotated[float | None, definition.QuantityField("length", above=0)] = optional(
        "water depth there", "1100 m"
    )
    items: tuple[DeployedItem, ...] = described(
        "differences from the design, by piece",
        [{"label": "wire-jacketed-8", "length": "479.2 m"}],
        default=(),
    )

    @property
    def serials(self) -> dict[str, tuple[str, ...]]:
        """Serial numbers of the deployed items, by label; items without any are omitted."""
        return {one.label: listed_serials(one.serial) for one in self.items if one.serial}


def check_deployed(
    deployed: Deployed, labels: Sequence[str], cables: Sequence[str], top: SourceMapping
) -> None:
    """Check the deployed items of a mooring file.

    Each item must be a part of the line, listed once. Only cables and chains may have a length.

    Parameters
    ----------
    labels : labels of all pieces and clamps in the line
    cables : labels of the cables and chains in the line
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
