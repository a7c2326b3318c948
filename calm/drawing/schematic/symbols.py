"""SVG symbols of a schematic, chosen by the kind, role and name of a component.

Each symbol is drawn about an origin, through which the line runs vertically.
"""

import re
from collections.abc import Callable
from dataclasses import dataclass
from enum import StrEnum
from functools import partial
from operator import methodcaller
from typing import Any

from calm.drawing.schematic.pen import INK, Pen
from calm.files import Component
from calm.physics.materials import fibre_of


class Symbol(StrEnum):
    """Symbol in a schematic; the value is the name of the symbol in a legend."""

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
    """A symbol and the number of its repetitions.

    `sounding` is true if the symbol contains an ADCP. `up` is true if the ADCP looks up, and `down`
    is true if the ADCP looks down.
    """

    symbol: Symbol
    count: int = 1
    sounding: bool = False
    up: bool = False
    down: bool = False


_LARGEST_BALL = 0.6  # m; smaller spheres are drawn as balls of a pack
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
    """Choose the symbol for a piece or a clamped instrument.

    The choice depends on kind, role, name and note of the component, then on the component id
    (`use`), and last on the label.
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
    up, down = (sounding and bool(pattern.search(words)) for pattern in (_UP, _DOWN))
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
    return next((symbol for symbol, name in names.items() if re.search(name, words)), other)


def _first_number(text: str | None) -> int | None:
    found = re.search(r"\d+", text or "")
    return int(found[0]) if found else None


# fills also differ in lightness, to be distinguishable without colour
_FLOAT, _GLASS, _INSTRUMENT, _RELEASE = "#f4b13e", "#ffe6a3", "#d6e4f0", "#7fb69c"
_STEEL, _CONCRETE, _DARK = "#97a2ab", "#d3d5d6", "#46515b"

_MOST_BALLS, _MOST_WHEELS, _MOST_CONNECTORS = 14, 6, 3
_BALL, _BALL_PITCH, _BALL_ASIDE = 6.5, 8.0, 5.5
_WHEEL = 7.0
_BEAM = 11.0


@dataclass(frozen=True)
class SymbolFigure:
    """Height of a symbol, and the function that draws the symbol about the origin of a pen."""

    height: float
    draw: Callable[[Pen], None]


def figure_of(sign: Sign) -> SymbolFigure:
    """Return the drawing of a symbol; cables and chains are drawn by `draw_cable` instead."""
    if sign.symbol in BALLS:
        figure = _pack_of_balls(sign)
    elif sign.symbol is Symbol.WHEELS:
        figure = _stack_of_wheels(min(sign.count, _MOST_WHEELS))
    elif sign.symbol in _REPEATED and sign.count > 1:
        figure = _repeated(_FIGURES[sign.symbol], min(sign.count, _MOST_CONNECTORS))
    else:
        figure = _FIGURES[sign.symbol]
    return _with_adcp(figure, sign) if sign.sounding else figure


def _with_adcp(figure: SymbolFigure, sign: Sign) -> SymbolFigure:
    shift = _BEAM / 2 * (sign.up - sign.down)

    def draw(pen: Pen) -> None:
        for direction in [-1.0] * sign.up + [1.0] * sign.down:
            start = shift + direction * figure.height / 2
            for slope in (-1.0, -0.35, 0.35, 1.0):
                pen.line(4.0 * slope, start, 12.0 * slope, start + direction * _BEAM,
                         stroke_dasharray="2.5 1.5", stroke_width=0.9)  # fmt: skip
        figure.draw(pen.group(0.0, shift))
        # an ADCP of unknown direction has transducers, but no beams
        for x in (-4.5, 0.0, 4.5):
            pen.circle(x, shift, 1.9, fill=_DARK, stroke="none")

    return SymbolFigure(figure.height + _BEAM * (sign.up + sign.down), draw)


def _repeated(figure: SymbolFigure, count: int) -> SymbolFigure:
    def draw(pen: Pen) -> None:
        for number in range(count):
            figure.draw(pen.group(0.0, (number - (count - 1) / 2) * figure.height))

    return SymbolFigure(count * figure.height, draw)


def _pack_of_balls(sign: Sign) -> SymbolFigure:
    count = min(sign.count, _MOST_BALLS)
    fill = _GLASS if sign.symbol is Symbol.GLASS else _FLOAT

    def draw(pen: Pen) -> None:
        for number in range(count):
            x = 0.0 if count == 1 else (_BALL_ASIDE if number % 2 else -_BALL_ASIDE)
            y = (number - (count - 1) / 2) * _BALL_PITCH
            pen.circle(x, y, _BALL, fill=fill)
            pen.line(x - _BALL, y, x + _BALL, y)
            if sign.symbol is Symbol.GLASS:
                pen.line(x, y - _BALL, x, y + _BALL, stroke_width=0.7)

    return SymbolFigure(2 * _BALL + (count - 1) * _BALL_PITCH + 3.0, draw)


def _stack_of_wheels(count: int) -> SymbolFigure:
    height = count * _WHEEL + 8.0

    def draw(pen: Pen) -> None:
        pen.box(0.0, -height / 2 + 5.0, 5.0, 10.0, fill=_DARK)
        for number in range(count):
            y = height / 2 - (number + 0.5) * _WHEEL
            pen.box(0.0, y - 1.7, 28.0, 3.6, fill=_STEEL)
            pen.box(0.0, y + 1.7, 42.0, 3.6, fill=_STEEL, rx=1.0)

    return SymbolFigure(height, draw)


_circle, _box, _path, _line, _element = (
    partial(methodcaller, name) for name in ("circle", "box", "path", "line", "draw")
)
_HOLLOW: dict[str, Any] = {"fill": "white", "stroke_width": 0.9}
_BARE: dict[str, Any] = {"fill": "none"}


def _figure(height: float, *parts: Callable[[Pen], None]) -> SymbolFigure:
    """Create a symbol from SVG shapes, listed from back to front."""

    def draw(pen: Pen) -> None:
        for part in parts:
            part(pen)

    return SymbolFigure(height, draw)


_REPEATED = (Symbol.SHACKLE, Symbol.SWIVEL, Symbol.LINK)
"""Symbols that are drawn several times for several equal items."""
_FIGURES = {
    Symbol.SPHERE: _figure(36.0,
        _circle(0.0, 0.0, 17.0, fill=_FLOAT), _path("M-17 0Q0 7 17 0", **_BARE, stroke_width=0.9)),
    Symbol.FOAM: _figure(34.0,
        _box(0.0, 0.0, 36.0, 32.0, rx=9.0, fill=_FLOAT),
        *(_line(-18.0, y, 18.0, y, stroke_width=0.9) for y in (-5.5, 5.5))),
    Symbol.STREAMLINED: _figure(28.0,
        _path("M14 0L27 -10L27 10Z", fill=_DARK),
        _path("M-25 0C-25 -9 -14 -12 -4 -12C8 -12 16 -6 21 0C16 6 8 12 -4 12C-14 12 -25 9 -25 0Z",
              fill=_FLOAT)),
    Symbol.BUOY: _figure(26.0,  # a hull half in the water, which is at the origin, with a mast
        _path("M-7 -9L-3 -31M7 -9L3 -31M-5 -20L5 -20", **_BARE),
        _box(0.0, -33.0, 10.0, 4.0, fill=_DARK), _circle(0.0, -37.5, 2.4, fill=_FLOAT),
        _path("M-32 -9L32 -9L27 5Q0 17 -27 5Z", fill=_FLOAT)),
    Symbol.CURRENT_METER: _figure(29.0,
        _box(0.0, 0.0, 12.0, 26.0, rx=2.5, fill=_INSTRUMENT),
        _path("M6 -4L20 -11L25 -11L25 11L20 11L6 4Z", fill=_INSTRUMENT),
        _line(0.0, -9.0, 0.0, 9.0, stroke_width=0.8)),
    Symbol.ADCP: _figure(32.0,
        _box(0.0, 0.0, 15.0, 20.0, fill=_INSTRUMENT),
        _path("M-7.5 -10L-11 -15L11 -15L7.5 -10Z", fill=_INSTRUMENT),
        _path("M-7.5 10L-11 15L11 15L7.5 10Z", fill=_INSTRUMENT)),
    Symbol.CTD: _figure(30.0,
        _box(0.0, 0.0, 18.0, 28.0, **_HOLLOW), _box(0.0, 2.0, 8.0, 20.0, rx=2.0, fill=_INSTRUMENT),
        _box(0.0, -10.5, 4.0, 5.0, fill=_DARK)),
    Symbol.TRAP: _figure(42.0,
        _path("M-19 -19L19 -19L5 8L-5 8Z", fill=_INSTRUMENT),
        *(_line(x, -19.0, 0.45 * x, -9.0, stroke_width=0.8) for x in (-10.0, 0.0, 10.0)),
        *(_box(x, 15.0, 4.0, 8.0, rx=1.5, **_HOLLOW) for x in (-9.0, -3.0, 3.0, 9.0)),
        _box(0.0, 9.5, 26.0, 3.0, fill=_DARK)),
    Symbol.INSTRUMENT: _figure(30.0,
        _box(0.0, 0.0, 13.0, 28.0, rx=3.0, fill=_INSTRUMENT),
        _line(-6.5, -7.0, 6.5, -7.0, stroke_width=0.9)),
    Symbol.RELEASE: _figure(40.0,
        _box(0.0, -4.0, 12.0, 28.0, rx=2.5, fill=_RELEASE),
        _line(-6.0, -11.0, 6.0, -11.0, stroke_width=0.9),
        _path("M0 10L0 13A3.2 3.2 0 1 1 -3.2 16", **_BARE, stroke_width=1.8)),
    Symbol.RELEASE_PAIR: _figure(40.0,
        _box(0.0, -18.0, 30.0, 3.0, fill=_DARK), _box(0.0, 18.0, 30.0, 3.0, fill=_DARK),
        *(part for x in (-9.0, 9.0) for part in (
            _line(x, -17.0, x, 17.0), _box(x, -2.0, 11.0, 26.0, rx=2.5, fill=_RELEASE),
            _line(x - 5.5, -9.0, x + 5.5, -9.0, stroke_width=0.9)))),
    Symbol.SHACKLE: _figure(12.0,
        _path("M-4 -4.5L-4 1A4 4 0 0 0 4 1L4 -4.5", fill="white", stroke_width=1.8),
        _line(-6.0, -4.0, 6.0, -4.0, stroke_width=2.0)),
    Symbol.SWIVEL: _figure(18.0,
        *(_circle(0.0, y, 3.4, fill="white", stroke_width=1.6) for y in (-5.0, 5.0)),
        _box(0.0, 0.0, 11.0, 4.0, fill=_STEEL)),
    Symbol.LINK: _figure(11.0,
        _element("ellipse", cx=0.0, cy=0.0, rx=3.6, ry=5.0, fill="white", stroke_width=1.8)),
    Symbol.BLOCK: _figure(24.0,
        _path("M-17 -8L17 -8L21 12L-21 12Z", fill=_CONCRETE),
        _path("M-4 -8A4 4 0 0 1 4 -8", **_BARE, stroke_width=2.0),
        *(_circle(x, y, 0.9, fill=INK, stroke="none") for x, y in (
            (-10.0, -2.0), (-3.0, 5.0), (5.0, -3.0), (11.0, 4.0), (-13.0, 7.0), (3.0, 9.0)))),
    Symbol.BODY: _figure(26.0,
        _box(0.0, 0.0, 28.0, 24.0, rx=2.0, fill=_INSTRUMENT),
        _path("M-14 -12L14 12M14 -12L-14 12", **_BARE, stroke_width=0.7)),
}  # fmt: skip
"""Heights and SVG shapes of symbols that always look the same."""


SEABED_ROOM = 22.0
"""Height of the seabed."""
_WATER, _SURFACE, _SAND, _HULL = "#eff6fb", "#2f7fb5", "#e3d6b8", "#5b6b7a"
_ROPE = "#f3e7c4"
_STRAND = 4.6
_LINK = 7.0
_WAVE = 9.0


def draw_cable(pen: Pen, symbol: Symbol, x: float, top: float, bottom: float) -> None:
    """Draw a wire as a solid line, a rope with strands, and a chain with links."""
    if symbol is Symbol.WIRE:
        pen.line(x, top, x, bottom, stroke_width=2.4)
    elif symbol is Symbol.ROPE:
        pen.line(x, top, x, bottom, stroke_width=5.6)
        pen.line(x, top, x, bottom, stroke=_ROPE, stroke_width=3.6)
        count = max(1, round((bottom - top) / _STRAND))
        pitch = (bottom - top) / count
        strands = (f"M{x - 1.8:g} {top + n * pitch + 3.8:.2f}l3.6 -3" for n in range(count))
        pen.path("".join(strands), fill="none", stroke_width=1.1)
    else:
        _draw_chain(pen, x, top, bottom)


def _draw_chain(pen: Pen, x: float, top: float, bottom: float) -> None:
    count = max(3, round((bottom - top) / _LINK))
    pitch = (bottom - top) / count
    for number in range(count):
        y = top + (number + 0.5) * pitch
        if number % 2:
            pen.line(x, y - 0.75 * pitch, x, y + 0.75 * pitch, stroke_width=2.4)
    for number in range(0, count, 2):
        y = top + (number + 0.5) * pitch
        pen.draw("ellipse", cx=x, cy=y, rx=3.2, ry=0.62 * pitch, fill="none", stroke_width=1.7)


def draw_water(pen: Pen, width: float, top: float, bottom: float) -> None:
    """Draw the water behind the line."""
    height = bottom - top
    pen.box(width / 2, (top + bottom) / 2, width, height, fill=_WATER, stroke="none")


def draw_surface(pen: Pen, width: float, y: float) -> None:
    """Draw the waves of the sea surface."""
    waves = int(width / _WAVE / 2)
    step = width / waves / 2
    path = f"M0 {y:g}" + f"q{step / 2:.3g} -4 {step:.3g} 0t{step:.3g} 0" * waves
    pen.path(path, fill="none", stroke=_SURFACE, stroke_width=1.3)


def draw_seabed(pen: Pen, width: float, y: float) -> None:
    """Draw the hatched seabed."""
    pen.box(width / 2, y + SEABED_ROOM / 2, width, SEABED_ROOM, fill=_SAND, stroke="none")
    for number in range(int(width / 10)):
        x = 10.0 * number + 9.0
        pen.line(x, y, x - 7.0, y + 8.0, stroke_width=0.7)
    pen.line(0.0, y, width, y, stroke_width=1.6)


def draw_ship(pen: Pen) -> None:
    """Draw a ship that tows from its A-frame.

    The sheave of the A-frame is at the origin, 26 units above the water.
    """
    pen.path("M-62 16L-14 16L-12 32Q-36 36 -56 32Z", fill=_HULL)
    pen.path("M-50 16L-50 3L-30 3L-30 16Z", fill="white")
    pen.path("M-46 7L-34 7", stroke_width=2.2)
    pen.path("M-42 3L-42 -8M-45 -4L-39 -4", fill="none")
    pen.path("M-16 16L0 0M-24 16L0 0", fill="none", stroke_width=1.8)
    pen.circle(0.0, 0.0, 3.0, fill="white", stroke_width=1.6)


def draw_helicopter(pen: Pen) -> None:
    """Draw a helicopter with its hook at the origin."""
    pen.path("M-40 -26L-8 -22L-8 -17L-40 -23Z", fill=_HULL)
    pen.path("M-40 -33L-40 -19", fill="none", stroke_width=2.0)
    pen.path("M-14 -24Q-8 -31 4 -31Q20 -30 22 -19Q20 -11 8 -9L-6 -9Q-14 -11 -14 -24Z", fill=_HULL)
    pen.path("M8 -27Q17 -26 18 -19L8 -19Z", fill="white", stroke_width=0.9)
    pen.path("M2 -31L2 -37M-30 -37L34 -37", fill="none", stroke_width=2.0)
    pen.path("M-12 -3L16 -3M-5 -9L-6 -3M9 -9L10 -3", fill="none")
    pen.line(0.0, -9.0, 0.0, 0.0)


def draw_clamp(pen: Pen, reach: float) -> None:
    """Draw the clamp between an instrument and the line; the origin is on the line."""
    for y in (-3.5, 3.5):
        pen.line(0.0, y, reach, y, stroke=INK, stroke_width=1.6)
