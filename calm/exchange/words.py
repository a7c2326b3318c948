"""What the names of pieces say about them, in English and French."""

from __future__ import annotations

import re

_RELEASE = re.compile(
    r"\brelease|\bacoustic rel|\blargu|\blargage|\bar[ -]?\d{3}|\bcdms ar\b|\b8242\b|\b866\b", re.I
)
_HEAVY = 20.0  # N: nothing that only joins weighs more, whatever it is called
_CHAIN = re.compile(r"chain|cha[iî]ne", re.I)
_CONNECTOR = re.compile(
    r"shackle|\bshac|swivel|sling|\blink|pear|\bring|ringlet|miller|manille|[ée]merillon|maillon|anneau",
    re.I,
)
_ANCHOR = re.compile(r"anchor|sinker|railway|\blest|\bancre|\bcorps.mort|dead ?weight|clump", re.I)
_LINE = re.compile(
    r"\bwire|\brope|kevlar|nylon|dacron|polyester|polyprop|polysteel|\bcable|amsteel|dyneema|tenex"
    r"|\bline\b|c[âa]ble|cordage|jetstr|spectra|nilspin",
    re.I,
)


def is_release(name: str) -> bool:
    """Whether a piece is called a release."""
    return bool(_RELEASE.search(name))


def is_chain(name: str) -> bool:
    """Whether a piece is called a chain."""
    return bool(_CHAIN.search(name))


def is_connector(name: str) -> bool:
    """Whether a piece is called a shackle, swivel, link or the like."""
    return bool(_CONNECTOR.search(name))


def is_anchor(name: str) -> bool:
    """Whether a piece is called an anchor or a dead weight."""
    return bool(_ANCHOR.search(name))


def is_line(name: str) -> bool:
    """Whether a piece is called a wire, a rope or a chain."""
    return bool(_LINE.search(name)) or is_chain(name)


def role_of(name: str, buoyancy: float, *, fastener: bool = False) -> str:
    """The role of a rigid piece by its name and its net force in water [N, positive up].

    A `fastener` is marked so by its own program, which may mark instruments and floats too.
    """
    if is_release(name):
        return "release"
    if is_connector(name) and buoyancy <= 0.0:
        return "connector"
    if buoyancy > 0.0:
        return "float"
    return "connector" if fastener and buoyancy > -_HEAVY else "instrument"
