"""Words of a record that holds a part of the current: the tides, what is left of them, a mean.

A mooring meets the whole current. What tides, filters and long means leave of it is too weak.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from typing import Any

_FILTERED = (
    r"\b(low|high|band) ?pass(ed)?\b|\blanczos\b|\bbutterworth\b|\bdemerliac\b|"
    r"\b(godin|doodson|pl ?(33|64|66)\w*) ?(tidal )?filter"
)
_WITHOUT_TIDES = (
    r"\bde ?tided\b|\bsub ?tidal\b|\bnon ?tidal\b|"
    r"\btid(al|es?)( \w+){0,2} (removed|subtracted|filtered out)\b|"
    r"\b(remov\w+|subtract\w+|without|minus|excluding) (the )?tid(al|es?)\b"
)
_TIDES_ALONE = (
    r"\b(only|purely|just) (the )?tid(al|es?)\b|\btid(al|es?)( \w+){0,2} (only|alone)\b|"
    r"\btidal (constituents?|harmonics?|predictions?|ellips\w+)\b|\bpredicted tid(al|es?)\b|"
    r"\b(baroclinic|barotropic|internal) tides?\b"
)
_LONG_MEANS = (
    r"\bclimatological (mean|average|current|velocit\w+|month|year|value)\w*\b|"
    r"\b(mean|monthly|annual|seasonal|daily) climatolog(y|ies)\b|\bclimatology of\b|"
    r"\b(annual|seasonal|decadal|long term|multi ?year) (mean|average)\b|"
    r"\b(mean|averaged?) over \d+ years\b|\b\d+ years? (mean|average)\b"
)
_IN_TEXTS = re.compile("|".join((_FILTERED, _WITHOUT_TIDES, _TIDES_ALONE, _LONG_MEANS)))
_IN_NAMES = re.compile(
    r"\bclimatolog\w+\b|\b(perturbation|fluctuat\w+|turbulen\w+|orbital|ekman|(near )?inertial|"
    r"increments?|tendency|trend|spread|skewness|kurtosis|normali[sz]ed|non ?dimensional|squared|"
    r"logarithm|displacement|eof|mode \d+|counts?|number of|eddy)\b|"
    r"\brelative to \d+|\bof sound\b"
)
_IN_TITLES = re.compile(
    r"\bclimatolog(y|ies)\b|"
    r"\b(residual|geostrophic|ekman|stokes) (currents?|velocit\w+|flow|drift)\b"
)
_TIDAL = re.compile(r"\btid(al|es?)\b")
_WITH_TIDES = re.compile(r"\b(total|includ\w+|with|and|plus|waves?|not removed)\b")

_TEXTS = re.compile(
    r"(?i)title|summary|abstract|comments?|notes?|description|(data_)?processing(_\w+)?|"
    r"(\w+_)?filter(ing|ed|s)?(_\w+)?"
)
_TITLES = ("title", "Title", "data_type")
_SENTENCE = re.compile(r"[.;\n]")
_OF_OTHERS = re.compile(
    r"\b(temperatures?|salinit\w+|pressures?|sea level|elevations?|conductivit\w+|headings?|"
    r"pitch|roll|not|no|never|against|before|elsewhere|see|also)\b"
)
"""What speaks of another variable, or against itself."""

_OVER_YEARS = re.compile(r"\b(within|over) (years|days)\b")


def part_in_words(own: str) -> str | None:
    """The words by which the name of a quantity is a part of the current; None where none is.

    Parameters
    ----------
    own : its names as plain lower-case words, one blank between them
    """
    found = _IN_TEXTS.search(own) or _IN_NAMES.search(own)
    if found is None and not _WITH_TIDES.search(own):
        found = _TIDAL.search(own)
    return None if found is None else found.group()


def part_in_texts(attributes: Mapping[Any, Any]) -> str | None:
    """Why a current is a part of the whole, by titles, comments and filters; None if it may be it.

    A sentence that denies it, or speaks of another variable too, does not count.

    Parameters
    ----------
    attributes : those of a dataset or of a variable
    """
    for name, said in attributes.items():
        if not isinstance(said, str) or (not _TEXTS.fullmatch(str(name)) and name not in _TITLES):
            continue
        for sentence in _SENTENCE.split(said.lower()):
            words = re.sub(r"[\W_]+", " ", sentence).strip()
            found = _IN_TEXTS.search(words)
            if found is None and name in _TITLES:
                found = _IN_TITLES.search(words)
            if found is not None and not _OF_OTHERS.search(words):
                return f"is not the whole current by its {name}: {said.strip()[:80]}"
    methods = str(attributes.get("cell_methods", ""))
    if _OVER_YEARS.search(methods):
        return f"is a mean of many years, `cell_methods: {methods}`, not a current at one time"
    return None
