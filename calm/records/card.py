"""Summary card of a file: texts, variables, levels, times, flags and declination.

The card quotes texts verbatim, and gives values in their declared units.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from calm.records.current_terms import time_text
from calm.records.value_tests import gaps_of

LONGEST = 300
"""Maximum number of characters of a text in a card."""
_MOST_GAPS = 20
_TEXTS = {
    "title": ("title",),
    "summary": ("summary", "abstract", "description"),
    "comment": ("comment", "comments", "note", "notes"),
}


@dataclass(frozen=True)
class VariableSummary:
    """Name, declared unit, minimum, median and maximum of a variable.

    `description` quotes the long name and the comment of the variable. The three values are NaN if
    the variable has no finite values.
    """

    name: str
    units: str
    least: float
    median: float
    greatest: float
    description: str = ""

    @classmethod
    def of(cls, name: str, units: str, values: Any, description: str = "") -> VariableSummary:
        """Summarise the finite elements of an array."""
        values = np.asarray(values, np.float64).ravel()
        known = values[np.isfinite(values)]
        if not known.size:
            return cls(name, units, np.nan, np.nan, np.nan, description)
        ends = float(known.min()), float(np.median(known)), float(known.max())
        return cls(name, units, *ends, description)


@dataclass(frozen=True, eq=False)
class ReadCard:
    """Summary of the contents of a file.

    Attributes
    ----------
    texts : title, summary and comment, quoted from the file
    variables : summaries by role, such as east, north, depth
    levels : number of levels or of instruments
    times : (n,) increasing times; empty for a profile without a time
    clock : name and unit of the time variable
    flags : number of readings excluded by each flag variable
    declination : rotation of currents from magnetic to true north [degrees]
    """

    file: str
    texts: Mapping[str, str]
    variables: Mapping[str, VariableSummary]
    levels: int
    times: NDArray[np.datetime64]
    clock: tuple[str, str] = ("", "")
    flags: Mapping[str, int] = field(default_factory=dict)
    declination: float | None = None

    def sentence(self) -> str:
        """Format the card as a single line for the `history` attribute."""
        rows = card_rows(self.to_dict())
        texts = "; ".join(f"{name}: {' '.join(value.split())}" for name, value in rows)
        return f"read {self.file}: {texts}"

    def to_dict(self) -> dict[str, Any]:
        """Return the card as a JSON object, with times in ISO 8601 and the time step in seconds."""
        step, gaps, longest = None, [], None
        if self.times.size > 1:
            median, at = gaps_of(self.times)
            step = float(median / np.timedelta64(1, "s"))
            longest = float(np.diff(self.times).max() / np.timedelta64(1, "s")) if at.size else None
            gaps = [[time_text(self.times[k]), time_text(self.times[k + 1])] for k in at.tolist()]
        variables = {
            taken: {key: _known(value) for key, value in vars(one).items()}
            for taken, one in self.variables.items()
        }
        if self.clock[0]:
            variables["time"] = {"name": self.clock[0], "units": self.clock[1]}
        return {
            "file": self.file,
            **{name: self.texts.get(name) for name in _TEXTS},
            "variables": variables,
            "levels": self.levels,
            "first": time_text(self.times[0]) if self.times.size else None,
            "last": time_text(self.times[-1]) if self.times.size else None,
            "times": self.times.size,
            "step": step,
            "gaps": gaps[:_MOST_GAPS],
            "number_of_gaps": len(gaps),
            "longest_gap": longest,
            "flags": dict(self.flags),
            "declination": self.declination,
        }


def joined_cards(cards: Sequence[ReadCard]) -> ReadCard:
    """Merge the cards of several quantities that were read from one file."""
    variables = {role: one for card in cards for role, one in card.variables.items()}
    flags = {name: count for card in cards for name, count in card.flags.items()}
    return replace(cards[0], variables=variables, flags=flags)


def card_of_instruments(cards: Sequence[ReadCard]) -> ReadCard:
    """Merge the cards of the instruments in one file.

    The median of a variable is the median of the medians of the instruments.
    """
    variables = {}
    for role in {role: None for card in cards for role in card.variables}:
        each = [card.variables[role] for card in cards if role in card.variables]
        figures = np.array([(one.least, one.median, one.greatest) for one in each])
        least, medians, greatest = figures[np.isfinite(figures).all(axis=1)].T
        one = each[0]
        if least.size:
            ends = float(least.min()), float(np.median(medians)), float(greatest.max())
            one = VariableSummary(one.name, one.units, *ends, one.description)
        variables[role] = one
    flags = {
        name: sum(card.flags.get(name, 0) for card in cards)
        for name in {name: None for card in cards for name in card.flags}
    }
    times = np.unique(np.concatenate([card.times for card in cards]))
    levels = sum(card.levels for card in cards)
    return replace(cards[0], variables=variables, flags=flags, times=times, levels=levels)


def card_rows(card: Mapping[str, Any]) -> tuple[tuple[str, str], ...]:
    """Format the dictionary from `ReadCard.to_dict` as rows (name, text) for display."""
    rows = [(name, card[name]) for name in _TEXTS if card[name]]
    for taken, one in card["variables"].items():
        text = f"{one['name']} [{one['units']}]" if one["units"] else one["name"]
        if taken == "depth":
            text = f"{_counted(card['levels'], 'level')}; {text}"
        if taken != "time":
            text += f": {_values(one)}" + (f" ({one['description']})" if one["description"] else "")
            rows.append((taken, text))
    if "depth" not in card["variables"]:
        rows.append(("levels", str(card["levels"])))
    if card["times"]:
        rows.append(("time", _when(card)))
    removed = (f"{_counted(n, 'reading')} excluded by {name}" for name, n in card["flags"].items())
    rows.append(("flags", "; ".join(removed) or "none"))
    turned = card["declination"]
    rows.append(("declination", "none" if turned is None else f"rotated by {turned:g}°"))
    return tuple(rows)


def _values(one: Mapping[str, Any]) -> str:
    if one["median"] is None:
        return "no value"
    if one["least"] == one["greatest"]:
        return f"{one['median']:.4g}"
    return f"{one['least']:.4g} to {one['greatest']:.4g}, median {one['median']:.4g}"


def _when(card: Mapping[str, Any]) -> str:
    clock = card["variables"].get("time", {"name": "", "units": ""})
    unit = f" [{clock['units']}]" if clock["units"] else ""
    text = f"{clock['name']}{unit}: " if clock["name"] else ""
    text += f"{_counted(card['times'], 'time')}, {card['first']}"
    if card["step"] is None:
        return text
    text += f" to {card['last']}, step {_span(card['step'])}"
    if not card["gaps"]:
        return f"{text}, no gaps"
    gaps = _counted(card["number_of_gaps"], "gap")
    return f"{text}, {gaps}, the longest of {_span(card['longest_gap'])}"


def _counted(number: int, noun: str) -> str:
    return f"{number} {noun}{'s' * (number != 1)}"


def texts_in(attributes: Mapping[Any, Any]) -> dict[str, str]:
    """Extract title, summary and comment from attributes, each cut to `LONGEST` characters."""
    by_name = {str(name).lower(): value for name, value in attributes.items()}
    found = {}
    for kind, names in _TEXTS.items():
        given = [str(by_name[name]) for name in names if str(by_name.get(name, "")).strip()]
        if given:
            found[kind] = cut(given[0])
    return found


def cut(text: str) -> str:
    """Shorten a text to at most `LONGEST` characters."""
    return text if len(text) <= LONGEST else f"{text[: LONGEST - 1]}…"


def description_of(attributes: Mapping[Any, Any]) -> str:
    """Join long name and comment from the attributes of a variable, cut to `LONGEST` characters."""
    texts = (str(attributes.get(name, "")).strip() for name in ("long_name", "comment"))
    return cut("; ".join(filter(None, texts)))


def _span(seconds: float) -> str:
    units = (86_400.0, "days", 2.0), (3600.0, "h", 1.0), (60.0, "min", 1.0)
    for size, unit, fewest in units:
        if seconds >= fewest * size:
            return f"{seconds / size:.4g} {unit}"
    return f"{seconds:.4g} s"


def _known(value: Any) -> Any:
    return None if isinstance(value, float) and not np.isfinite(value) else value
