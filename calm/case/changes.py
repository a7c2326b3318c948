"""Reading what may be changed, and how far: ``top float.buoyancy``, ``100 N`` to ``9 kN``."""

from __future__ import annotations

from collections.abc import Sequence

from calm.case.adjustment import Adjustment, Buoyancy, Count, Length
from calm.case.parts import all_parts
from calm.case.targets import pointed
from calm.errors import UsageError
from calm.files import Anchor, Chain, Clamp, Component, Flexible, MooringFile, Piece
from calm.files.explain import unknown
from calm.units import QuantityError, parse_quantity, with_unit

Parts = tuple[Piece | Clamp, ...]


def parse_change(text: str, file: MooringFile) -> Adjustment:
    """Read what is to be changed, e.g. ``top float.buoyancy``.

    Parameters
    ----------
    text : the label of a part of the line, or of several without their numbers; a point;
        ``buoyancy``, ``length`` or ``count``
    file : the mooring, in which the label is looked up

    Raises
    ------
    UsageError
        With a caret under what is wrong, and the nearest right thing.
    """
    text = " ".join(text.split())
    name, point, field = text.rpartition(".")
    if not point or field not in _FIELDS:
        what = f"unknown field `{field}`" if point else "there is no field to change"
        message = unknown(what, field if point else "", _FIELDS)
        raise pointed("--change", text, len(name) + 1 if point else len(text), message)
    try:
        return _FIELDS[field](text, file, all_parts(file.pieces, name))
    except LookupError as error:
        raise pointed("--change", text, 0, str(error.args[0])) from None


def parse_range(texts: tuple[str, str] | None, change: Adjustment) -> tuple[float, float]:
    """The range of a change: as given, each end with its unit, or that of the adjustment.

    Raises
    ------
    UsageError
        An end is no such quantity, or they are in the wrong order.
    """
    if texts is None:
        low, high = change.range
        if low == high:
            raise UsageError(f"{change.text} is 0; give its range with --between")
        return low, high
    ends = []
    for text in texts:
        try:
            ends.append(parse_quantity(text, change.dimension))
        except QuantityError as error:
            raise UsageError(f"--between: `{text}` {error}") from None
    low, high = ends
    if not low < high:
        raise UsageError(f"--between: {texts[0]} is not below {texts[1]}")
    least = change.range[0] if isinstance(change, Length | Count) else low
    if low < least:
        limit = with_unit(least, change.unit)
        raise UsageError(f"--between: `{texts[0]}` must be at least {limit}")
    if change.whole and (low % 1 or high % 1):
        raise UsageError("--between: a count is a whole number")
    return low, high


def _buoyancy(text: str, file: MooringFile, parts: Parts) -> Adjustment:
    components = [part.component for part in parts]
    for component in components:
        if isinstance(component, Chain | Anchor):
            raise LookupError(f"{_article(component)} has a weight and no buoyancy to change")
    if any(component != components[0] for component in components):
        raise LookupError("these parts are not alike; name one")
    return Buoyancy(text, file, parts)


def _length(text: str, file: MooringFile, parts: Parts) -> Adjustment:
    pieces = [part for part in parts if isinstance(part, Piece)]
    if len(pieces) < len(parts) or not isinstance(pieces[0].component, Flexible):
        raise LookupError("only cables and chains are cut to length")
    if any(piece.length is None for piece in pieces):
        raise LookupError("it is cut to fit (`length: fit`); give it a length in the file first")
    _refuse_several_items(pieces)
    return Length(text, file, parts)


def _count(text: str, file: MooringFile, parts: Parts) -> Adjustment:
    pieces = [part for part in parts if isinstance(part, Piece)]
    if len(pieces) < len(parts):
        raise LookupError("clamped instruments are not counted; only pieces in line are")
    if isinstance(pieces[0].component, Anchor):
        raise LookupError("a line has one anchor")
    _refuse_several_items(pieces)
    item = tuple(one for one in file.pieces if one.place.item == pieces[0].place.item)
    if any((one.use, one.component) != (item[0].use, item[0].component) for one in item):
        raise LookupError("it is part of an assembly, which is counted as a whole")
    if any(one.length is None for one in item):
        raise LookupError("it is cut to fit (`length: fit`), which only one piece can be")
    return Count(text, file, item)


_FIELDS = {"buoyancy": _buoyancy, "length": _length, "count": _count}


def _refuse_several_items(pieces: Sequence[Piece]) -> None:
    if len({piece.place.item for piece in pieces}) > 1:
        named = pieces[0].label
        raise LookupError(f"several items of the line have this label; name one: {named} …")


def _article(component: Component) -> str:
    return "an anchor" if isinstance(component, Anchor) else f"a {component.kind}"
