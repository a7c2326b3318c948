"""Tell what the names of pieces say about them, in English and French, and make ids of them."""

from __future__ import annotations

import re
import unicodedata
from collections.abc import Iterable

from calm.exchange.design import ImportedComponent

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
_LONGEST = 40
_NO_IDS = {"null", "true", "false", "yes", "no", "on", "off", "y", "n"}  # other words in YAML
_SIGNS = {'"': "in ", "″": "in ", "↑": " up ", "↓": " down ", "+": " ", "&": " and ", "µ": "u"}


def is_release(name: str) -> bool:
    """Return whether a piece is called a release."""
    return bool(_RELEASE.search(name))


def is_chain(name: str) -> bool:
    """Return whether a piece is called a chain."""
    return bool(_CHAIN.search(name))


def is_connector(name: str) -> bool:
    """Return whether a piece is called a shackle, swivel, link or the like."""
    return bool(_CONNECTOR.search(name))


def is_anchor(name: str) -> bool:
    """Return whether a piece is called an anchor or a dead weight."""
    return bool(_ANCHOR.search(name))


def is_line(name: str) -> bool:
    """Return whether a piece is called a wire, a rope or a chain."""
    return bool(_LINE.search(name)) or is_chain(name)


def role_of(name: str, buoyancy: float, *, fastener: bool = False) -> str:
    """Return the role of a rigid piece by its name and its net force in water [N, positive up].

    Parameters
    ----------
    name : as its program calls it
    buoyancy : net force in water, positive up [N]
    fastener : whether its program marks it so, which may mark instruments and floats too
    """
    if is_release(name):
        return "release"
    if is_connector(name) and buoyancy <= 0.0:
        return "connector"
    if buoyancy > 0.0:
        return "float"
    return "connector" if fastener and buoyancy > -_HEAVY else "instrument"


def _kebab(name: str) -> str:
    """Return a name as an id: ``3/8" wire rope`` becomes ``3-8in-wire-rope``."""
    text = "".join(_SIGNS.get(sign, sign) for sign in name)
    text = unicodedata.normalize("NFKD", text).encode("ascii", "ignore").decode().lower()
    text = re.sub(r"(?<=\d)\.(?=\d)", "p", text)
    return re.sub(r"[^a-z0-9]+", "-", text)[:_LONGEST].strip("-")


def ids_of(components: Iterable[ImportedComponent], taken: Iterable[str] = ()) -> dict[int, str]:
    """Return the id of every component, by its `id()`; those with the same figures share one.

    Parameters
    ----------
    taken : ids that are in use for something else
    """
    components = list(components)
    ids: dict[int, str] = {}
    known_ids: dict[tuple[object, ...], str] = {}
    known = {*taken, *(component.entry for component in components)}
    for component in components:
        if component.entry:
            ids[id(component)] = component.entry
            continue
        identity = component.identity()
        if identity not in known_ids:
            base = _kebab(component.name)
            if base in _NO_IDS or not any(sign.isalpha() for sign in base):
                base = f"{component.kind}-{base}".rstrip("-")
            chosen, number = base, 1
            while chosen in known:
                number += 1
                chosen = f"{base}-v{number}"
            known.add(chosen)
            known_ids[identity] = chosen
        ids[id(component)] = known_ids[identity]
    return ids
