"""Tell what the names of pieces say about them, in English and French, and make ids of them."""

from __future__ import annotations

import re
import unicodedata
from collections.abc import Iterable

from calm.exchange.design import ImportedComponent

_RELEASE = re.compile(
    r"\brelease|\bacoustic rel|\blargu|\blargage|\bar[ -]?\d{3}|\bcdms ar\b|\b8242\b|\b866\b"
    r"|ausl[öo]se|\bliberador|\bsuelta",
    re.I,
)
_HEAVY = 20.0  # N: nothing that only joins weighs more, whatever it is called
_CHAIN = re.compile(r"chain|cha[iî]ne|\w*kette\b|\bcadena", re.I)
_CONNECTOR = re.compile(
    r"shackle|\bshac|swivel|sling|\blink|pear|\bring|ringlet|miller|manille|[ée]merillon|maillon"
    r"|anneau|sch[äa]kel|wirbel|\bgrillete|giratorio|anilla|thimble|kausch|guardacabo",
    re.I,
)
_ANCHOR = re.compile(
    r"anchor|sinker|railway|\blest|\bancre|\bcorps.mort|dead ?weight|clump|\banker|grundgewicht"
    r"|\bancla|\bmuerto|\blastre",
    re.I,
)
_RIGID = re.compile(
    r"float|buoy|sphere|syntactic|instrument|sensor|logger|release|hardware|connector|shackle|swivel"
    r"|bou[ée]e|flotteur|capteur|auftrieb|boje|kugel|ger[äa]t|boya|flotador|esfera|sonde|terminal"
    r"|\bbody\b|cylinder",
    re.I,
)
_LINE = re.compile(
    r"wire|rope|\blines?\b|\bcable|c[âa]ble\b|cordage|filin|aussi[èe]re|\bbout\b|seil\b|seile\b|draht"
    r"|leine\b|\btau\b|trosse|kabel|\bcabo\b|cuerda|estacha|tether|hawser|\bwarp\b|nilspin|jetstr"
    r"|kevlar|aramid|twaron|technora|vectran|nylon|polyamid|dacron|polyester|polyprop|polysteel|danline"
    r"|dyneema|spectra|uhmwpe|\bhmpe|amsteel|plasma|tenex|samson|colmega|dynex|steelite|phillystran"
    r"|braid|strand|\b\d{1,2}x\d{1,2}\b|\bmanila\b|sisal|hemp\b|umbilical|\bcoax",
    re.I,
)
_LONG, _SLENDER = 3.0, 60.0
"""Metres, and diameters, of which a piece is longer where it is a line, whatever it is called."""

_LONGEST_PIECE = 20.0  # m of a rigid piece
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


def is_long(name: str, length: float, across: float) -> bool:
    """Return whether a piece is a line by its size, whatever it is called.

    Parameters
    ----------
    length, across : of the piece [m]; 0 where it is not known how wide it is
    """
    if is_release(name) or is_connector(name):
        return False
    slender = length >= _LONG and across > 0.0 and length >= _SLENDER * across
    return slender or length >= _LONGEST_PIECE


def is_rigid(kind: str) -> bool:
    """Return whether a kind or family of pieces is one of floats, instruments or fittings."""
    return bool(_RIGID.search(kind))


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


def size_in(name: str) -> float:
    """Return a diameter in a name such as `8 mm wire` or `3/8" chain` [m]; 0 without one."""
    found = re.search(r"(\d+(?:[.,]\d+)?)\s*mm\b", name, re.I)
    if found:
        return float(found[1].replace(",", ".")) / 1000.0
    found = re.search(r"(?:(\d+)[ -])?(\d+)/(\d+)", name)
    if found and int(found[3]):
        return (int(found[1] or 0) + int(found[2]) / int(found[3])) * 0.0254
    found = re.search(r"(\d+(?:[.,]\d+)?)\s*(?:\"|''|in\b|inch)", name, re.I)
    return float(found[1].replace(",", ".")) * 0.0254 if found else 0.0
