"""Parameters that `calm size` can vary: ``LABEL.buoyancy``, ``.length`` or ``.count``.

A change acts on the data model of the file, as if the file contained the new value. All derived
values change accordingly.
"""

import re
from collections import Counter
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace

from calm.case.parts import all_parts
from calm.case.targets import pointed
from calm.errors import UsageError, unknown
from calm.files import Anchor, Cable, Chain, Clamp, Flexible, MooringFile, Piece
from calm.files.definition import STANDARD_GRAVITY
from calm.files.pieces import numbered, parts_of, placed
from calm.units import DIMENSIONS, QuantityError, parse_quantity, with_unit

MOST_BUOYANCY = 100.0
"""Default upper limit for the buoyancy of a float, as a multiple of its present buoyancy."""
MOST_LENGTH = 2.0
"""Default upper limit for the length of a piece, as a multiple of the water depth."""
LEAST_LENGTH = 0.01
"""Smallest length of a cable or chain [m]."""
MOST_COUNT = 1000
"""Default upper limit for the count of a component."""

Parts = tuple[Piece | Clamp, ...]

_ANCHOR_WEIGHT = (
    "the required weight of an anchor follows from its load; `calm run` prints this weight for one "
    "environment, and `calm check` prints the largest weight over all situations"
)


@dataclass(frozen=True)
class Adjustment:
    """A parameter of a mooring file that may be varied.

    Attributes
    ----------
    text : name of the parameter, e.g. ``top float.buoyancy``
    file : the original mooring
    parts : the original parts to which the parameter belongs
    dimension : a key of `calm.units.DIMENSIONS`
    now : value before the change
    range : default smallest and largest value
    to : function that returns the mooring for a new value
    bounded : whether the lower end of `range` is the smallest value that the user may set
    whole : whether the value must be a whole number
    """

    text: str
    file: MooringFile = field(repr=False)
    parts: Parts = field(repr=False)
    dimension: str
    now: float
    range: tuple[float, float]
    to: Callable[[float], MooringFile] = field(repr=False)
    bounded: bool = True
    whole: bool = False
    note: str = ""

    @property
    def unit(self) -> str:
        """SI unit of the parameter."""
        return DIMENSIONS[self.dimension].unit

    @property
    def labels(self) -> tuple[str, ...]:
        """Labels of the parts that the parameter changes."""
        return tuple(part.label for part in self.parts)


def _buoyancy(text: str, file: MooringFile, parts: Parts) -> Adjustment:
    """Vary the net buoyancy of a rigid piece or clamped instrument [N], or of a cable [N/m]."""
    component = parts[0].component
    for each in (part.component for part in parts):
        if isinstance(each, Anchor):
            raise LookupError(f"an anchor has a weight instead of a buoyancy; {_ANCHOR_WEIGHT}")
        if isinstance(each, Chain):
            raise LookupError(f"a {each.kind} has a weight instead of a buoyancy")
    if any(part.component != component for part in parts):
        raise LookupError("the parts with this label have different components; select one part")
    now = component.net_buoyancy
    most = MOST_BUOYANCY * now
    if most < 0.0 and component.mass is not None:
        most = max(most, -component.mass * STANDARD_GRAVITY)
    cable = isinstance(component, Cable)
    places = {part.place for part in parts}

    def to(value: float) -> MooringFile:
        # remove other keys from which the net buoyancy could follow, as in an override on the line
        replaced = "weight" if cable else "volume"
        lifted = component.model_copy(update={"buoyancy": value, replaced: None})

        def changed(clamp: Clamp) -> Clamp:
            return replace(clamp, component=lifted) if clamp.place in places else clamp

        pieces = (
            piece.with_clamps(
                changed, component=lifted if piece.place in places else piece.component
            )
            for piece in file.pieces
        )
        return replace(file, pieces=tuple(pieces))

    return Adjustment(
        *(text, file, parts, "force per length" if cable else "force", now),
        range=(min(most, 0.0), max(most, 0.0)),
        to=to,
        bounded=False,
        note="Only the net buoyancy changes; size, drag and mass do not. A real part with this "
        "buoyancy has a different drag: put that part in the file and solve the mooring again.",
    )


def _length(text: str, file: MooringFile, parts: Parts) -> Adjustment:
    """Vary the unstretched length of a cable or chain [m].

    Clamps keep their distances from the upper end of the cable or chain.
    """
    pieces = [part for part in parts if isinstance(part, Piece)]
    if len(pieces) < len(parts) or not isinstance(pieces[0].component, Flexible):
        raise LookupError("only the length of cables and chains can be changed")
    now, depth = pieces[0].length, file.environment.depth
    if now is None or any(piece.length is None for piece in pieces):
        raise LookupError(
            "the length of this piece is fitted (`length: fit`); set a length in the file first"
        )
    _refuse_several_items(pieces)
    assert depth is not None  # a mooring has a seabed
    places = {piece.place for piece in pieces}
    lowest = max((clamp.at for piece in pieces for clamp in piece.clamps), default=0.0)

    def to(value: float) -> MooringFile:
        line = (replace(p, length=value) if p.place in places else p for p in file.pieces)
        return replace(file, pieces=tuple(line))

    limits = max(lowest, LEAST_LENGTH), MOST_LENGTH * depth
    return Adjustment(text, file, parts, "length", now, limits, to)


def _count(text: str, file: MooringFile, parts: Parts) -> Adjustment:
    pieces = [part for part in parts if isinstance(part, Piece)]
    if len(pieces) < len(parts):
        raise LookupError("clamped instruments have no count; only in-line pieces do")
    if isinstance(pieces[0].component, Anchor):
        raise LookupError(
            "a line has exactly one anchor, so the count of the anchor cannot be changed"
        )
    _refuse_several_items(pieces)
    item = tuple(one for one in file.pieces if one.place.item == pieces[0].place.item)
    if len(pieces) < len(item) and pieces[0].place.part >= 0:
        name = pieces[0].named
        advice = f"change `{name}.count`" if name else "give the assembly a `label` in the file"
        raise LookupError(
            f"this piece is part of an assembly, which can only be counted as a whole; {advice}"
        )
    if any(each.length is None for each in item):
        raise LookupError(
            "this piece has a fitted length (`length: fit`), so its count cannot be changed"
        )
    once = _without_numbers([one for one in item if one.place.repeat == 0], item)
    now = len(item) // len(once)

    def to(value: float) -> MooringFile:
        repeats = (
            placed(one, replace(one.place, repeat=number))
            for number in range(int(value))
            for one in once
        )
        line = (*file.pieces[: item[0].index], *repeats, *file.pieces[item[-1].index + 1 :])
        more = len(line) - len(file.pieces)
        legs = tuple(leg.grown(item[0].index, more) for leg in file.legs)
        return replace(file, pieces=numbered(line), legs=legs)

    limits = 1.0, float(MOST_COUNT)
    return Adjustment(text, file, item, "number", float(now), limits, to, whole=True)


_NUMBERED = re.compile(r"(.+) \d+")


def _without_numbers(once: Sequence[Piece], item: Sequence[Piece]) -> list[Piece]:
    """Return the pieces `once` of one copy of an item, without the numbers of repeated labels.

    For example, ``glass 1`` becomes ``glass`` if the item also has ``glass 2``.
    """
    stems = Counter(
        found[1] for part in parts_of(item) if (found := _NUMBERED.fullmatch(part.label))
    )

    def stem(label: str) -> str:
        found = _NUMBERED.fullmatch(label)
        return found[1] if found and stems[found[1]] > 1 else label

    return [
        piece.with_clamps(
            lambda clamp: replace(clamp, label=stem(clamp.label)), label=stem(piece.label)
        )
        for piece in once
    ]


def _refuse_several_items(pieces: list[Piece]) -> None:
    if len({piece.place.item for piece in pieces}) > 1:
        raise LookupError(
            "several items of the line have this label; select one of them, such as "
            f"`{pieces[0].label}`"
        )


_FIELDS = {"buoyancy": _buoyancy, "length": _length, "count": _count}


def parse_change(text: str, file: MooringFile) -> Adjustment:
    """Parse the name of a parameter to vary, e.g. ``top float.buoyancy``.

    The text has a label, a full stop, and ``buoyancy``, ``length`` or ``count``. The label
    ``glass`` also stands for ``glass 1``, ``glass 2`` and so on. For a count, the label may name an
    assembly. Raises UsageError, which points to the mistake, if the text is invalid.
    """
    text = " ".join(text.split())
    name, point, field = text.rpartition(".")
    if not point or field not in _FIELDS:
        what = f"unknown field `{field}`" if point else "the field to change is missing"
        message = unknown(what, field if point else "", _FIELDS)
        anchors = (one for one in file.pieces if isinstance(one.component, Anchor))
        if field == "weight" and any(name in ("anchor", one.label, one.use) for one in anchors):
            message = f"calm size does not search for the weight of an anchor; {_ANCHOR_WEIGHT}"
        raise pointed("--change", text, len(name) + 1 if point else len(text), message)
    try:
        assembly = tuple(one for one in file.pieces if one.named == name and one.place.part >= 0)
        if assembly and field != "count":
            parts = parts_of(_without_numbers(assembly, assembly))
            listed = ", ".join(dict.fromkeys(f"`{part.label}`" for part in parts))
            raise LookupError(
                f"an assembly has no {field}; change its count, or change one of the parts {listed}"
            )
        return _FIELDS[field](text, file, assembly or all_parts(file.pieces, name))
    except LookupError as error:
        raise pointed("--change", text, 0, str(error.args[0])) from None


def parse_range(texts: tuple[str, str] | None, change: Adjustment) -> tuple[float, float]:
    """Parse the lower and upper end of a range, each with a unit.

    If `texts` is None, the default range of the parameter is returned. Raises UsageError if an end
    is not allowed, or if the ends are in the wrong order.
    """
    if texts is None:
        low, high = change.range
        if low == high:
            raise UsageError(f"{change.text} is 0; set its range with --between")
        return low, high
    ends = []
    for text in texts:
        try:
            ends.append(parse_quantity(text, change.dimension))
        except QuantityError as error:
            raise UsageError(f"--between: `{text}` {error}") from None
    low, high = ends
    if not low < high:
        raise UsageError(f"--between: {texts[0]} must be below {texts[1]}")
    least = change.range[0] if change.bounded else low
    if low < least:
        limit = with_unit(least, change.unit)
        raise UsageError(f"--between: `{texts[0]}` must be at least {limit}")
    if change.whole and (low % 1 or high % 1):
        raise UsageError("--between: a count must be a whole number")
    return low, high
