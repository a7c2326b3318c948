"""Which symbol of the schematic stands for a component: by its kind, its role, and its name."""

import re
from dataclasses import dataclass
from enum import StrEnum

from calm.files import Component
from calm.physics.materials import fibre_of


class Symbol(StrEnum):
    """What a schematic draws, and what a legend calls it."""

    SPHERE = "float"
    BALL = "ball"
    GLASS = "glass float"
    FOAM = "foam float"
    STREAMLINED = "streamlined float"
    BUOY = "surface buoy"
    CURRENT_METER = "current meter"
    ADCP = "ADCP"
    CTD = "CTD or logger"
    TRAP = "sediment trap"
    INSTRUMENT = "instrument"
    RELEASE = "release"
    RELEASE_PAIR = "pair of releases"
    SHACKLE = "shackle"
    SWIVEL = "swivel"
    LINK = "link or ring"
    CHAIN = "chain"
    WIRE = "wire"
    ROPE = "rope"
    WHEELS = "anchor, wheels"
    BLOCK = "anchor"
    BODY = "body"


BALLS = (Symbol.BALL, Symbol.GLASS)
LINES = (Symbol.CHAIN, Symbol.WIRE, Symbol.ROPE)


@dataclass(frozen=True)
class Sign:
    """A symbol, how many times it is drawn; whether an ADCP is in it, and which way that looks."""

    symbol: Symbol
    count: int = 1
    sounding: bool = False
    up: bool = False
    down: bool = False


_LARGEST_BALL = 0.6  # m; what is smaller is drawn as a ball of a pack
_NUMBERS = {"double": 2, "two": 2, "triple": 3, "three": 3, "four": 4}
_COUNTED = re.compile(r"\b(?:chain|cluster|string|pack)-(\d+)|\b(\d+) x\b|\bx (\d+)\b")
_NAMES = {
    Symbol.TRAP: r"\btrap",
    Symbol.ADCP: r"adcp|\badp\b|rdcp|workhorse|current profiler",
    Symbol.CURRENT_METER: r"current|\bmeter\b|rcm|aquadopp|argonaut|vacm|vmcm|acm\b|\bs4\b|\bdvs\b",
    Symbol.CTD: r"ctd|sbe|\w+cat\b|rbr|hobo|aquameasure|thermi|temperature|\bt \d|logger|oxygen",
}
_CONNECTORS = {Symbol.SWIVEL: "swivel", Symbol.SHACKLE: "shackle"}
_ADCP = re.compile(_NAMES[Symbol.ADCP])
_PAIR = re.compile(r"\b(?:pair|paired|double|twin|dual|tandem|two|in parallel)\b")
_WHEELS = re.compile(r"wheel|rotor|\bdisc")
_STREAMLINED = re.compile(r"streamlined|stablemoor|torpedo|(?<!sea-)\bbird\b|\bfish\b")
_METAL = re.compile(r"\b(?:wire|steel|armour)")
_UP = re.compile(r"(?<!back[- ])\bup(?:ward|wards)?\b")
_DOWN = re.compile(r"\bdown(?:ward|wards)?\b")


def sign_of(use: str, label: str, component: Component) -> Sign:
    """The sign of a piece or of a clamped instrument.

    Parameters
    ----------
    use, label : what the line calls it; either may tell what it is
    component : kind, role, name and note tell first
    """
    own = f"{use} {component.name or ''} {component.note or ''}".lower()
    words = f"{own} {label.lower()}"
    symbol = _symbol(component, own, words)
    count = 1
    if symbol is Symbol.GLASS:
        named = (n for word, n in _NUMBERS.items() if re.search(rf"\b{word}\b", own))
        counted = _COUNTED.search(own)
        count = int(next(filter(None, counted.groups()))) if counted else next(named, 1)
    elif symbol is Symbol.WHEELS:
        count = _first_number(component.name) or _first_number(use) or 1
    sounding = symbol is Symbol.ADCP or bool(_ADCP.search(own))
    up, down = (sounding and bool(way.search(words)) for way in (_UP, _DOWN))
    return Sign(symbol, count, sounding, up, down)


def _symbol(component: Component, own: str, words: str) -> Symbol:
    if component.kind == "chain":
        return Symbol.CHAIN
    if component.kind == "cable":
        made_of = f"{own} {(component.material or '').lower()}"
        rope = not _METAL.search(made_of) and ("rope" in words or fibre_of(made_of))
        return Symbol.ROPE if rope else Symbol.WIRE
    if component.kind == "anchor":
        return Symbol.WHEELS if _WHEELS.search(words) else Symbol.BLOCK
    if component.role == "float":
        if _STREAMLINED.search(own) or "glass" in own:
            return Symbol.STREAMLINED if _STREAMLINED.search(own) else Symbol.GLASS
        return _sphere(component.diameter) if component.kind == "sphere" else Symbol.FOAM
    if component.role == "release":
        return Symbol.RELEASE_PAIR if _PAIR.search(own) else Symbol.RELEASE
    if component.role == "connector":
        return _named(_CONNECTORS, words, Symbol.LINK)
    if _STREAMLINED.search(words):
        return Symbol.STREAMLINED
    other = Symbol.INSTRUMENT if component.kind == "cylinder" else Symbol.BODY
    if component.kind == "sphere":
        other = _sphere(component.diameter)
    return _named(_NAMES, own, _named(_NAMES, words, other))


def _sphere(diameter: float) -> Symbol:
    return Symbol.BALL if diameter <= _LARGEST_BALL else Symbol.SPHERE


def _named(names: dict[Symbol, str], words: str, other: Symbol) -> Symbol:
    """The first symbol whose pattern the words have."""
    return next((symbol for symbol, name in names.items() if re.search(name, words)), other)


def _first_number(text: str | None) -> int | None:
    found = re.search(r"\d+", text or "")
    return int(found[0]) if found else None
