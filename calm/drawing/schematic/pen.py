"""Elements of an SVG picture; texts and attributes are escaped."""

from __future__ import annotations

import unicodedata
from xml.etree import ElementTree

from rich.cells import cell_len

INK, SOFT, FAINT = "#1b2733", "#5a6672", "#c3ccd4"
"""Colours of primary, secondary and faint texts and lines."""


FONTS = "'Source Sans 3', Helvetica, Arial, 'Liberation Sans', 'DejaVu Sans', sans-serif"
"""Fonts of all texts, in order of preference."""


class Pen:
    """Pen that draws inside one element of a picture."""

    def __init__(self, element: ElementTree.Element) -> None:
        self.element = element

    def draw(self, tag: str, **attributes: float | str) -> Pen:
        """Add an element, and return a pen that draws inside the new element.

        ``_`` in the names of attributes becomes ``-``.
        """
        written = {name.replace("_", "-"): _text(value) for name, value in attributes.items()}
        return Pen(ElementTree.SubElement(self.element, tag, written))

    def group(self, x: float, y: float, scale: float = 1.0, **attributes: float | str) -> Pen:
        """Add a group with its own origin."""
        transform = f"translate({_text(x)} {_text(y)})"
        if scale != 1.0:
            transform += f" scale({_text(scale)})"
        return self.draw("g", transform=transform, **attributes)

    def title(self, text: str) -> None:
        """Set the tooltip of the element."""
        self.draw("title").element.text = text

    def line(self, x1: float, y1: float, x2: float, y2: float, **attributes: float | str) -> None:
        """Draw a straight line."""
        self.draw("line", x1=x1, y1=y1, x2=x2, y2=y2, **attributes)

    def circle(self, x: float, y: float, radius: float, **attributes: float | str) -> None:
        """Draw a circle about a point."""
        self.draw("circle", cx=x, cy=y, r=radius, **attributes)

    def box(
        self, x: float, y: float, width: float, height: float, **attributes: float | str
    ) -> None:
        """Draw a rectangle centred at a point."""
        left, top = x - width / 2, y - height / 2
        self.draw("rect", x=left, y=top, width=width, height=height, **attributes)

    def path(self, d: str, **attributes: float | str) -> None:
        """Draw a path."""
        self.draw("path", d=d, **attributes)

    def write(
        self, x: float, y: float, text: str, width: float, *, size: float, bold: bool = False
    ) -> None:
        """Write a text, vertically centred at `y`.

        A text wider than `width` is shortened, and its tooltip contains the whole text.
        """
        shown = shortened(text, width, size, bold=bold)
        pen = self.letters(x, y, shown, size=size, bold=bold)
        if shown != text:
            pen.element.text = None
            pen.title(text)
            pen.element[-1].tail = shown

    def letters(
        self,
        x: float,
        y: float,
        text: str,
        *,
        size: float,
        colour: str = INK,
        bold: bool = False,
        anchor: str = "start",
    ) -> Pen:
        """Write a text of any width, vertically centred at `y`; an empty text draws nothing."""
        if not text:
            return self
        weight = {"font_weight": "bold"} if bold else {}
        pen = self.draw(
            "text", x=x, y=y + 0.35 * size, font_size=size, fill=colour, text_anchor=anchor,
            **weight,
        )  # fmt: skip
        pen.element.text = text
        return pen


def _text(value: float | str) -> str:
    return value if isinstance(value, str) else f"{round(value, 2) + 0.0:g}"


def picture(width: float, height: float, title: str, size: tuple[str, str] | None = None) -> Pen:
    """Create an empty picture with a white background, and return its pen.

    The origin is the upper left corner. Units are points, unless `size` gives a printed width and
    height with units.
    """
    printed = size or (f"{width:g}pt", f"{height:g}pt")
    attributes = {
        "xmlns": "http://www.w3.org/2000/svg", "width": printed[0], "height": printed[1],
        "viewBox": f"0 0 {width:g} {height:g}", "role": "img", "font-family": FONTS,
        "stroke-linejoin": "round",
    }  # fmt: skip
    element = ElementTree.Element("svg", attributes)
    pen = Pen(element)
    pen.title(title)
    pen.draw("rect", width=width, height=height, fill="white")
    return pen


def svg_text(picture: Pen) -> str:
    """Convert a picture to SVG text, with one element per line."""
    ElementTree.indent(picture.element)
    return ElementTree.tostring(picture.element, encoding="unicode") + "\n"


ELLIPSIS = "…"

# Widths in ems, no less than those of Arial, Helvetica, Liberation Sans and DejaVu Sans.
_USUAL, _CAPITAL, _WIDE = 0.64, 0.79, 1.03
_CLASSES = {
    **dict.fromkeys("ijlIJ.,:;'|/\\ ", 0.36),
    **dict.fromkeys("frt!()[]-", 0.42),
    **dict.fromkeys("ckszvxyL?", 0.6),
    **dict.fromkeys("mwMWQ@%&#+=<>~^×–", _WIDE),
}
_BOLD = 1.19


def text_width(text: str, size: float, *, bold: bool = False) -> float:
    """Return an upper bound for the width of a text, in the unit of the font size `size`."""
    ems = sum(map(_ems, text))
    return size * ems * (_BOLD if bold else 1.0)


def shortened(text: str, width: float, size: float, *, bold: bool = False) -> str:
    """Shorten a text with an ellipsis, if necessary, to fit a width."""
    if text_width(text, size, bold=bold) <= width:
        return text
    room = width - text_width(ELLIPSIS, size, bold=bold)
    kept = 0
    for sign in text:
        room -= text_width(sign, size, bold=bold)
        if room < 0.0:
            break
        kept += 1
    return text[:kept].rstrip() + ELLIPSIS


def wrapped(text: str, width: float, size: float, *, bold: bool = False) -> list[str]:
    """Break a text into lines that fit a width; words that are too wide are divided."""
    lines: list[str] = []
    line = ""
    for word in text.split():
        longer = f"{line} {word}" if line else word
        if text_width(longer, size, bold=bold) <= width:
            line = longer
            continue
        if line:
            lines.append(line)
        line = ""
        for sign in word:
            if line and text_width(line + sign, size, bold=bold) > width:
                lines.append(line)
                line = ""
            line += sign
    return [*lines, line] if line else lines


def _ems(sign: str) -> float:
    if sign in _CLASSES:
        return _CLASSES[sign]
    sign = unicodedata.normalize("NFD", sign)[0]
    if sign.isascii():
        return _CAPITAL if sign.isupper() else _USUAL
    if unicodedata.combining(sign) or cell_len(sign) == 0:
        return 0.0
    # other scripts: a character of one terminal cell is at most an em wide
    return _WIDE * cell_len(sign)
