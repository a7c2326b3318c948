"""Drawings read back from their SVG: the texts and where they are, in the widest font."""

import re
from itertools import combinations
from xml.etree import ElementTree

import numpy as np
from fontTools.ttLib import TTFont

from calm.drawing.typesetting import FONTS

SVG = "{http://www.w3.org/2000/svg}"
# DejaVu Sans is wider than the fonts that a drawing asks for first.
_FILES = {"normal": "DejaVuSans.ttf", "bold": "DejaVuSans-Bold.ttf"}
_FONTS = {weight: TTFont(FONTS / name) for weight, name in _FILES.items()}


def width_of(text, size, weight="normal"):
    """By the advance widths of the font; a sign that it lacks shows as a box, as wide."""
    font = _FONTS[weight]
    glyphs, widths = font.getBestCmap(), font["hmtx"].metrics
    advance = sum(widths[glyphs.get(ord(sign), ".notdef")][0] for sign in text)
    return size * advance / font["head"].unitsPerEm


def _matrix(transform):
    found = np.eye(3)
    for name, figures in re.findall(r"(\w+)\(([^)]*)\)", transform or ""):
        values = [float(each) for each in figures.split()]
        step = np.eye(3)
        if name == "translate":
            step[:2, 2] = values
        elif name == "scale":
            step[:2, :2] *= values[0]
        else:
            assert name == "rotate"
            cos, sin = np.cos(np.radians(values[0])), np.sin(np.radians(values[0]))
            step[:2, :2] = [[cos, -sin], [sin, cos]]
        found = found @ step
    return found


def _walk(element, matrix):
    matrix = matrix @ _matrix(element.get("transform"))
    yield element, matrix
    for child in element:
        yield from _walk(child, matrix)


def svgs_of(page):
    """The drawings of an HTML page."""
    return re.findall(r"<svg.*?</svg>", page, re.DOTALL)


def elements_of(svg, tag):
    """Each element of a name, with the matrix of where it stands on the page."""
    page = ElementTree.fromstring(svg)
    return [found for found in _walk(page, np.eye(3)) if found[0].tag == SVG + tag]


def texts_of(svg):
    """Each text, and its box (left, top, right, bottom)."""
    found = []
    for element, matrix in elements_of(svg, "text"):
        shown = "".join([element.text or "", *(child.tail or "" for child in element)])
        size, x, y = (float(element.get(name)) for name in ("font-size", "x", "y"))
        width = width_of(shown, size, element.get("font-weight", "normal"))
        left = x - width * {"start": 0.0, "middle": 0.5, "end": 1.0}[element.get("text-anchor")]
        # Ascent and descent of its glyphs, accents and brackets included.
        corners = [(left, y - 0.93 * size, 1.0), (left + width, y + 0.24 * size, 1.0)]
        (x0, y0, _), (x1, y1, _) = (matrix @ corner for corner in corners)
        found.append((shown, (min(x0, x1), min(y0, y1), max(x0, x1), max(y0, y1))))
    return found


def words_of(svg):
    return [shown for shown, _ in texts_of(svg)]


def curves_of(svg, colour):
    """The points of each path of a colour, and whether it is dashed."""
    return [
        (np.array(re.findall(r"[ML](\S+?) ([^ML Z]+)", element.get("d")), float),
         "stroke-dasharray" in element.attrib)
        for element, _ in elements_of(svg, "path")
        if element.get("stroke") == colour
    ]  # fmt: skip


def assert_none_overlap(svg):
    page = ElementTree.fromstring(svg)
    left, top, width, height = map(float, page.get("viewBox").split())
    texts = texts_of(svg)
    for shown, box in texts:
        assert left <= box[0] and box[2] <= left + width, (shown, box)
        assert top <= box[1] and box[3] <= top + height, (shown, box)
    for (one, a), (other, b) in combinations(texts, 2):
        apart = a[2] <= b[0] or b[2] <= a[0] or a[3] <= b[1] or b[3] <= a[1]
        assert apart, (one, a, other, b)
