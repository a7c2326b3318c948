"""Checks of what a person types, as it is typed: taken, completed by its unit, or refused."""

import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

from calm.files import editing, item_keys
from calm.files.definition import LENGTH, POSITIVE_LENGTH, QuantityField
from calm.units import QuantityError, QuantityRange

COUNT = QuantityField("number", at_least=1, at_most=10_000)
_FIT = re.compile(r"fit\b\s*(?:to\b)?\s*(.*)", re.IGNORECASE)
_AT_LOAD = re.compile(r"(.+?)\s+at\s+(.+)", re.IGNORECASE)
_UNIT = re.compile(r"[\d.]\s*([^\d.\s].*)$")


@dataclass(frozen=True)
class Reading:
    """A text as it was understood.

    Attributes
    ----------
    text : as it is to be written; with the unit that was left out
    complaint : why it cannot be used; empty where it can
    offer : the text corrected, where that is known
    comes_to : what a good text comes to, where more is to be said than the text itself
    """

    text: str
    complaint: str = ""
    offer: str | None = None
    comes_to: str = ""

    @property
    def is_good(self) -> bool:
        """Return whether it can be used."""
        return not self.complaint

    @property
    def note(self) -> str:
        """For the person who types: what is wrong, and what would be right."""
        if self.offer:
            return f"{self.complaint}: {self.offer}?"
        return self.complaint

    def told(self, typed: str) -> str:
        """Return the note of a bad text; of a good one what it comes to, where that is more."""
        is_completed = self.text and self.text != " ".join(typed.split())
        return self.note or self.comes_to or (f"= {self.text}" if is_completed else "")


Check = Callable[[str], Reading]
"""Judges a text."""


def anything(text: str) -> Reading:
    """Any text will do, without the blanks around it."""
    return Reading(" ".join(text.split()))


def one_of(words: Sequence[str]) -> Check:
    """One of some words, or nothing; the beginning of one is completed."""

    def check(text: str) -> Reading:
        tidy = text.strip()
        if not tidy or tidy in words:
            return Reading(tidy)
        near = [word for word in words if word.casefold().startswith(tidy.casefold())]
        return Reading(tidy, f"must be {' or '.join(words)}", near[0] if near else None)

    return check


def needed(what: str) -> Check:
    """Any text but none."""

    def check(text: str) -> Reading:
        reading = anything(text)
        return reading if reading.text else Reading("", f"{what} is needed")

    return check


def quantity(
    kind: QuantityRange, *, optional: bool = False, usual_unit: str | None = None
) -> Check:
    """A number with a unit; a number alone is completed by `usual_unit`, the SI unit by default."""

    def check(text: str) -> Reading:
        tidy = " ".join(text.split())
        if not tidy:
            return Reading("") if optional else Reading("", "a value is needed")
        try:
            kind.read(tidy)
        except QuantityError as error:
            return _refused(tidy, error, kind, usual_unit)
        return Reading(tidy)

    return check


def _refused(
    text: str, error: QuantityError, kind: QuantityRange, usual_unit: str | None
) -> Reading:
    offer = error.suggestion
    if offer and error.complaint == "needs a unit":
        if usual_unit:
            offer = f"{text} {usual_unit}"
        try:
            kind.read(offer)
        except QuantityError as other:
            return Reading(offer, other.complaint, other.suggestion)
        return Reading(offer)
    return Reading(text, error.complaint, offer)


def unit_of(text: str) -> str | None:
    """The unit a value was written with."""
    found = _UNIT.search(text)
    return found[1].strip() if found else None


number = quantity(QuantityField("number"))
"""Judges a plain number, of a table whose columns carry the units."""


def count(text: str) -> Reading:
    """Return how often a piece comes, a whole number; nothing is once."""
    tidy = text.strip().lstrip("x×* ")
    if not tidy:
        return Reading("1")
    try:
        value = COUNT.read(tidy)
    except QuantityError as error:
        return Reading(tidy, error.complaint, error.suggestion)
    return Reading(str(int(value))) if value == int(value) else Reading(tidy, "must be whole")


def distance(before: str = "") -> Check:
    """Return how far down a piece something is clamped."""
    return quantity(LENGTH, usual_unit=unit_of(before))


def length(before: str = "", *, towed: bool = False) -> Check:
    """A length, one with the load it is measured ``at``, or ``fit`` with the depth to reach."""
    plain = quantity(POSITIVE_LENGTH, usual_unit=unit_of(before))
    depth = quantity(QuantityField("length") if towed else LENGTH, usual_unit=unit_of(before))
    load = quantity(item_keys.LOAD, usual_unit="kN")
    what = "the depth its lower end is to reach" if towed else "the depth the top is to reach"

    def check(text: str) -> Reading:
        fit, measured = _FIT.fullmatch(text.strip()), _AT_LOAD.fullmatch(text.strip())
        if fit is None and measured is not None:
            return _joined(plain(measured[1]), load(measured[2]))
        if fit is None:
            return plain(text)
        if not fit[1]:
            return Reading("fit", f"{what} is needed", "fit 105 m")
        reading = depth(fit[1])
        offer = None if reading.offer is None else f"fit {reading.offer}"
        return Reading(f"fit {reading.text}", reading.complaint, offer)

    return check


def _joined(long: Reading, load: Reading) -> Reading:
    """A length and the load it is measured at, each with what is wrong with it."""
    offers = [each.offer or each.text for each in (long, load)]
    offer = " at ".join(offers) if long.offer or load.offer else None
    complaint = long.complaint or load.complaint
    return Reading(f"{long.text} at {load.text}", complaint, offer)


def length_values(text: str, *, towed: bool = False) -> Mapping[str, editing.Value | None]:
    """The keys of an item with this length, as `length` has read it."""
    key, other = ("body_depth", "top_depth") if towed else ("top_depth", "body_depth")
    fit, measured = _FIT.fullmatch(text), _AT_LOAD.fullmatch(text)
    if fit is not None:
        return {"length": "fit", "length_at": None, key: fit[1], other: None}
    no_depth = {"top_depth": None, "body_depth": None}
    if measured is not None:
        under = {"load": measured[2], "length": measured[1]}
        return {"length": None, "length_at": under, **no_depth}
    return {"length": text, "length_at": None, **no_depth}


def length_text(values: Mapping[str, str]) -> str:
    """The length of an item as it is shown and typed."""
    written = values.get("length", "") or values.get("length_at", "")
    if written != "fit":
        return written
    return f"fit {values.get('top_depth') or values.get('body_depth') or ''}".rstrip()
