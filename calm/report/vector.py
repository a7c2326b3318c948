"""A figure or drawing as SVG that can stand inside a page."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

from calm.report.picture import image

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_PROLOGUE = re.compile(r"^.*?(?=<svg\b)", re.DOTALL)
_ASIDE = re.compile(r"<metadata>.*?</metadata>|<style\b.*?</style>|<!--.*?-->\s*", re.DOTALL)
_TAG = re.compile(r"<[^<>]+>")
_IDENTIFIER = re.compile(r'\b(id="|href="#|url\(#)')
_NOT_XML = re.compile("[^\t\n\r\x20-\ud7ff\ue000-\ufffd\U00010000-\U0010ffff]")


def figure_svg(figure: Figure) -> str:
    """What matplotlib drew, without a prologue and what it says about itself.

    Its style sheet would hold for all of a page; the drawing carries what it says as attributes.
    """
    text = image(figure, ".svg").decode("utf-8")
    text = within_xml(_ASIDE.sub("", _PROLOGUE.sub("", text, count=1)))
    return text.replace("<svg ", '<svg stroke-linejoin="round" ', 1)


def within_xml(text: str) -> str:
    """A drawing whose texts may hold any sign, with � for those that XML does not know."""
    return _NOT_XML.sub("\ufffd", text)


def set_apart(svg: str, prefix: str) -> str:
    """The drawing with its identifiers under a prefix: those of one page must differ."""
    return _TAG.sub(lambda tag: _IDENTIFIER.sub(rf"\g<1>{prefix}-", tag[0]), svg)
