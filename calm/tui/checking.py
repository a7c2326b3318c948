"""Checks of typed text at each key press, which accept, complete or reject the text."""

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
    """Interpretation of a typed text.

    Attributes
    ----------
    text : text to write, with a missing unit added
    complaint : reason why the text is invalid, if any
    offer : corrected text, if known
    explained : meaning of a valid text, unless obvious
    """

    text: str
    complaint: str = ""
    offer: str | None = None
    explained: str = ""

    @property
    def is_good(self) -> bool:
        """Whether the text is valid."""
        return not self.complaint

    @property
    def note(self) -> str:
        """Reason why the text is invalid, followed by the corrected text if known."""
        if self.offer:
            return f"{self.complaint}: {self.offer}?"
        return self.complaint

    def feedback(self, typed: str) -> str:
        """Return the error in an invalid text, or the meaning of a valid text.

        The result is empty if the meaning is obvious.
        """
        is_completed = self.text and self.text != " ".join(typed.split())
        return self.note or self.explained or (f"= {self.text}" if is_completed else "")


Check = Callable[[str], Reading]
"""Function that checks a text."""


def anything(text: str) -> Reading:
    """Accept any text, and remove superfluous blanks."""
    return Reading(" ".join(text.split()))


def one_of(words: Sequence[str]) -> Check:
    """Return a check that accepts one of the given words or an empty text.

    For an abbreviated word, the full word is offered as correction.
    """

    def check(text: str) -> Reading:
        tidy = text.strip()
        if not tidy or tidy in words:
            return Reading(tidy)
        near = [word for word in words if word.casefold().startswith(tidy.casefold())]
        return Reading(tidy, f"must be {' or '.join(words)}", near[0] if near else None)

    return check


def needed(what: str) -> Check:
    """Return a check that accepts any text that is not empty.

    `what` names the text in the error message.
    """

    def check(text: str) -> Reading:
        reading = anything(text)
        return reading if reading.text else Reading("", f"{what} is needed")

    return check


def quantity(
    kind: QuantityRange, *, optional: bool = False, usual_unit: str | None = None
) -> Check:
    """Return a check that accepts a quantity.

    A bare number gets the unit `usual_unit`; the default is the SI unit.
    """

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
    """Return the unit in a text, or None if the text has no unit."""
    found = _UNIT.search(text)
    return found[1].strip() if found else None


number = quantity(QuantityField("number"))
"""Check of a plain number, for tables with units in their headings."""


def count(text: str) -> Reading:
    """Check a number of pieces, which must be whole.

    An empty text means 1.
    """
    tidy = text.strip().lstrip("x×* ")
    if not tidy:
        return Reading("1")
    try:
        value = COUNT.read(tidy)
    except QuantityError as error:
        return Reading(tidy, error.complaint, error.suggestion)
    return Reading(str(int(value))) if value == int(value) else Reading(tidy, "must be whole")


def distance(before: str = "") -> Check:
    """Return a check for the distance of a clamp from the upper end of its piece.

    A bare number gets the unit of the previous text, `before`.
    """
    return quantity(LENGTH, usual_unit=unit_of(before))


def length(before: str = "", *, towed: bool = False) -> Check:
    """Return a check for the length of a piece.

    Valid texts are:

    - a length
    - a length under load, such as ``98 m at 2 kN``
    - ``fit`` and the required depth of the top, such as ``fit 105 m``; for a tow (`towed`), the
      depth of the lower end

    A bare number gets the unit of the previous text, `before`.
    """
    plain = quantity(POSITIVE_LENGTH, usual_unit=unit_of(before))
    depth = quantity(QuantityField("length") if towed else LENGTH, usual_unit=unit_of(before))
    load = quantity(item_keys.LOAD, usual_unit="kN")
    what = f"the required depth of the {'lower end' if towed else 'top'}"

    def check(text: str) -> Reading:
        fit, measured = _FIT.fullmatch(text.strip()), _AT_LOAD.fullmatch(text.strip())
        if fit is None and measured is not None:
            return _length_at_load(plain(measured[1]), load(measured[2]))
        if fit is None:
            return plain(text)
        if not fit[1]:
            return Reading("fit", f"{what} is needed", "fit 105 m")
        reading = depth(fit[1])
        offer = None if reading.offer is None else f"fit {reading.offer}"
        return Reading(f"fit {reading.text}", reading.complaint, offer)

    return check


def _length_at_load(long: Reading, load: Reading) -> Reading:
    offers = [each.offer or each.text for each in (long, load)]
    offer = " at ".join(offers) if long.offer or load.offer else None
    complaint = long.complaint or load.complaint
    return Reading(f"{long.text} at {load.text}", complaint, offer)


def length_values(text: str, *, towed: bool = False) -> Mapping[str, editing.Value | None]:
    """Convert a text accepted by `length` to new values of item keys; None deletes a key."""
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
    """Format the length of an item as the user would type it."""
    written = values.get("length", "") or values.get("length_at", "")
    if written != "fit":
        return written
    return f"fit {values.get('top_depth') or values.get('body_depth') or ''}".rstrip()
