"""Latitudes and longitudes as people write them: degrees, minutes, seconds, hemispheres."""

from __future__ import annotations

import re
from collections.abc import Mapping

HEMISPHERES: Mapping[str, str] = {"latitude": "NS", "longitude": "EW"}
"""Letters of the positive and the negative side."""

_POSITION = re.compile(
    r"""(?P<before>[NSEW])?\s*
    (?P<sign>[+-])?(?P<degrees>\d{1,3}(?:\.\d*)?)\s*(?:°|º|deg)?
    (?:[\s-]*(?P<minutes>\d{1,2}(?:\.\d*)?)\s*(?:'|′|’|min)?
      (?:[\s-]*(?P<seconds>\d{1,2}(?:\.\d*)?)\s*(?:"|″|”|''|sec)?)?
    )?\s*(?P<after>[NSEW])?""",
    re.VERBOSE | re.IGNORECASE,
)


def degrees_of(text: str, what: str) -> float | None:
    """Return a latitude or longitude [degrees], south and west negative.

    Such as ``57 28.84 N``, ``57°28.84'N``, ``57-28.84N``, ``-5 12 30`` or ``5.2 W``. None where the
    text has neither minutes nor a hemisphere, as a plain number or one with its unit.

    Parameters
    ----------
    text : to read
    what : ``latitude`` or ``longitude``

    Raises
    ------
    ValueError
        Minutes or seconds of 60 and more, parts of degrees beside minutes, a sign beside a
        hemisphere, or a hemisphere of the other kind.
    """
    found = _POSITION.fullmatch(text.strip())
    if found is None:
        return None
    letter = (found["before"] or found["after"] or "").upper()
    if not letter and found["minutes"] is None:
        return None
    if found["before"] and found["after"]:
        raise ValueError("names two hemispheres")
    if letter and letter not in HEMISPHERES[what]:
        raise ValueError(f"is no {what}; {' or '.join(HEMISPHERES[what])} is needed")
    if letter and found["sign"]:
        raise ValueError("has a sign and a hemisphere; leave one of them out")
    parts = [found[name] for name in ("degrees", "minutes", "seconds") if found[name]]
    if any("." in part for part in parts[:-1]):
        raise ValueError("has a fraction before its last part; write 57 28.84 N or 57 28 50.4 N")
    if any(float(part) >= 60.0 for part in parts[1:]):
        raise ValueError("has 60 minutes or seconds, or more")
    size = sum(float(part) / 60.0**power for power, part in enumerate(parts))
    return -size if found["sign"] == "-" or letter in ("S", "W") else size


def plain_degrees(text: str, what: str) -> float:
    """Return the same of a text that may be a plain number of degrees, too.

    Parameters
    ----------
    text : to read
    what : ``latitude`` or ``longitude``

    Raises
    ------
    ValueError
        As `degrees_of`, or it is no number.
    """
    placed = degrees_of(text, what)
    return float(text) if placed is None else placed


def read_as_minutes(degrees: float) -> float:
    """Return what is meant by degrees and minutes with a point between: 48.18 is 48°18'."""
    size = abs(degrees)
    whole = int(size)
    minutes = (size - whole) * 100.0
    return (whole + minutes / 60.0) * (1.0 if degrees >= 0.0 else -1.0)
