"""Targets for a mooring in text form, such as ``knockdown(CTD) <= 20 m``."""

import re
from dataclasses import dataclass
from math import hypot
from typing import Any

from calm.case.design import Result
from calm.case.leg_result import LegResult
from calm.case.parts import TOP, one_part
from calm.case.result_tables import ClampRow, ComponentRow, rows_by_place
from calm.errors import UsageError, unknown
from calm.files import MooringFile, Place
from calm.files.pieces import parts_of
from calm.units import DIMENSIONS, QuantityError, parse_quantity

QUANTITIES = {
    "knockdown": "length",
    "depth": "length",
    "excursion": "length",
    "tilt": "angle",
    "tension": "force",
    "required_weight": "force",
}
"""Quantities that a target may limit, and their dimensions. `required_weight` refers to the anchor.
"""

RELATIONS = {"<=": "<=", "≤": "<=", ">=": ">=", "≥": ">=", "=": "=", "==": "="}

_FORM = re.compile(
    r"\s*(?P<quantity>[^\s(<>=≤≥]*)\s*(?P<part>\((?P<label>.*)\))?\s*"
    r"(?P<relation>[<>=≤≥]*)\s*(?P<limit>.*)"
)
_EXAMPLE = "knockdown(top) <= 20 m"


def pointed(option: str, text: str, column: int, message: str) -> UsageError:
    """Return the error for an invalid command option, with a caret below the invalid position."""
    return UsageError(f"{option}: {message}\n  {text}\n  {' ' * column}^")


@dataclass(frozen=True)
class Target:
    """A limit for one quantity at one part of the line.

    Attributes
    ----------
    quantity : one of `QUANTITIES`
    label, place : label and place of the part; None for the top of the line and for the required
        anchor weight. In a net, the `label` of the required anchor weight is the name of the leg
    relation : ``<=``, ``>=`` or ``=``
    limit : in SI units or degrees
    """

    text: str
    quantity: str
    label: str | None
    relation: str
    limit: float
    place: Place | None = None

    @property
    def unit(self) -> str:
        """SI unit of the limit, or degrees."""
        return DIMENSIONS[QUANTITIES[self.quantity]].unit

    def value(self, result: Result) -> float | None:
        """Return the value of the quantity in a result, or None if the knockdown is undefined."""
        if self.quantity == "required_weight":
            (anchor,) = (one for one in result.anchors if self.label in (None, one.leg))
            return anchor.required_weight
        value: float | None = spot_of(result, self.place)[self.quantity]
        return value

    def to_dict(self) -> dict[str, Any]:
        """Return the target as a JSON object."""
        names = ("text", "quantity", "label", "relation", "limit", "unit")
        return {name: getattr(self, name) for name in names}


def parse_target(text: str, file: MooringFile) -> Target:
    """Parse a target, e.g. ``tilt(current meter 2) <= 5 deg`` or ``required_weight <= 8 kN``.

    The text has a quantity, the label of a part in brackets (by default ``top``), a relation, and a
    limit with its unit. With several anchors, the required weight needs the name of a leg:
    ``required_weight(stem) <= 8 kN``. Raises UsageError, which points to the mistake, if the text
    is invalid.
    """
    text = " ".join(text.split())
    found = _FORM.fullmatch(text)
    assert found is not None  # the pattern matches any text of one line

    def mistake(group: str, message: str) -> UsageError:
        return pointed("--target", text, found.start(group), message)

    quantity = found["quantity"]
    if quantity not in QUANTITIES:
        what = f"unknown quantity `{quantity}`" if quantity else "the quantity is missing"
        raise mistake("quantity", unknown(what, quantity, QUANTITIES))
    relation = found["relation"]
    if relation not in RELATIONS:
        what = f"`{relation}` is not a relation" if relation else "the relation is missing"
        raise mistake("relation", f"{what}; write <=, >= or =, as in `{_EXAMPLE}`")
    chosen, pieces, leg = None, file.pieces, None
    if file.legs and quantity == "required_weight":
        anchored = [each.name for each in file.legs if each.bottom.anchor is not None]
        leg = found["label"] and found["label"].strip()
        if leg not in anchored and (leg is not None or len(anchored) != 1):
            correction = f"no leg `{leg}` has an anchor" if leg else "name the leg of the anchor"
            raise mistake("part" if leg else "quantity", unknown(correction, leg or "", anchored))
    elif found["part"] is not None and quantity == "required_weight":
        raise mistake("part", "the required weight belongs to the anchor; omit the brackets")
    part = TOP if found["part"] is None else found["label"].strip()
    called_top = any(each.label == TOP for each in parts_of(pieces))
    if quantity != "required_weight" and (part != TOP or called_top):
        try:
            chosen = one_part(pieces, part)
        except LookupError as error:
            raise mistake("label", str(error.args[0])) from None
    elif file.legs and quantity != "required_weight":
        raise mistake("quantity", f"a net has no single top; name a piece: `{quantity}(LABEL)`")
    try:
        limit = parse_quantity(found["limit"], QUANTITIES[quantity])
    except QuantityError as error:
        shown = f"`{found['limit']}` {error}" if found["limit"] else "the limit is missing"
        raise mistake("limit", shown) from None
    label, place = (leg, None) if chosen is None else (chosen.label, chosen.place)
    return Target(text, quantity, label, RELATIONS[relation], limit, place)


def spot_of(result: Result, place: Place | None = None) -> dict[str, Any]:
    """Return depth, excursion and knockdown [m], tilt [degrees] and tension [N] of a part.

    Depth, excursion and knockdown of a piece are those of its upper end; the tension is the maximum
    in the piece. The knockdown is None if the shape in still water is not unique. The default part
    is the top of the line.
    """
    row: ComponentRow | ClampRow = result.components[0]
    if place is not None:
        row = rows_by_place(result)[place]
    depth, x, y = row.upper
    return {
        "depth": depth,
        "excursion": hypot(x, y),
        "knockdown": row.knockdown if row.knockdown == row.knockdown else None,
        "tilt": row.tilt,
        "tension": row.tension,
    }


@dataclass(frozen=True)
class Figures:
    """Summary values of a solved mooring: lengths [m], forces [N]. Anchor values are None without
    an anchor.

    Attributes
    ----------
    depth, knockdown, excursion : values at the line's top or at another part
    used_buoyancy : used fraction of the surface float's buoyancy; 1 if the float is submerged
    tension, vertical, horizontal : load on the anchor
    required_weight : required weight of the anchor
    """

    depth: float
    knockdown: float | None
    excursion: float
    used_buoyancy: float
    tension: float | None
    vertical: float | None
    horizontal: float | None
    required_weight: float | None


def figures_of(result: Result, place: Place | None = None) -> Figures:
    """Return the summary values of a result.

    Depth, knockdown and excursion are those of the part at `place`, by default the top of the line.
    If there are several anchors, the anchor values are those of the anchor with the largest
    required weight.
    """
    spot, leg = spot_of(result, place), leg_at(result, place)
    anchor = max(result.anchors, key=lambda one: one.required_weight or 0.0, default=None)
    names = ("tension", "vertical", "horizontal", "required_weight")
    return Figures(
        *(spot["depth"], spot["knockdown"], spot["excursion"], leg.top.used_buoyancy),
        *(None if anchor is None else getattr(anchor, name) for name in names),
    )


def leg_at(result: Result, place: Place | None = None) -> LegResult:
    """Return the leg that contains the part at a given place, by default the first leg."""
    for leg in result.legs:
        if place is None or any(part.place == place for part in parts_of(leg.leg.pieces)):
            return leg
    raise KeyError(place)
