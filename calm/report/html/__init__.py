"""Rendering of a report as a self-contained HTML page, which needs no other file and no network."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import replace
from functools import cache
from importlib.resources import files
from typing import TYPE_CHECKING

from calm.drawing.picture import set_apart
from calm.report.blocks import Column, Report, ReportPart, Section, Table

if TYPE_CHECKING:
    from jinja2 import Environment


_LONG_WORD = re.compile(r"(\S{20,})")
_STEPS = re.compile(r"[^_./-]{1,10}[_./-]*|[_./-]+")
"""Pattern for the positions at which a long word may break: after a separator, else every ten
characters.
"""


def leaf(section: Section, number: int) -> str:
    """Render a section as HTML; `number` counts sections from 1."""
    template = _environment().get_template("parts.html.jinja")
    shown: str = template.module.parts(section.parts, f"m{number}")  # type: ignore[attr-defined]
    return shown


def page(report: Report, leaves: Sequence[str] | None = None) -> str:
    """Render a report as an HTML page with embedded style, script and drawings.

    The script only sorts and filters the checks. Texts are escaped. `leaves` are sections already
    rendered by `leaf`.
    """
    leaves = leaves or [leaf(section, at) for at, section in enumerate(report.sections, 1)]
    template = _environment().get_template("page.html.jinja")
    texts = {name: _text(name) for name in ("page.css", "page.js")}
    html = template.render(
        report=report, leaves=leaves, style=texts["page.css"], script=texts["page.js"]
    )
    return html.encode("utf-8", "replace").decode("utf-8")


def fragment(part: ReportPart) -> str:
    """Render a part as HTML for a notebook, without page style and only as wide as its text."""
    blocks = tuple(one.narrow() if isinstance(one, Table) else one for one in part.blocks)
    template = _environment().get_template("parts.html.jinja")
    shown: str = template.module.parts([replace(part, blocks=blocks)], "n")  # type: ignore[attr-defined]
    return f"<div>{shown}</div>"


def read_templates() -> None:
    """Read and compile the templates once, so that processes forked later need not do so."""
    for name in ("parts.html.jinja", "page.html.jinja"):
        _environment().get_template(name)


@cache
def _environment() -> Environment:
    from jinja2 import Environment, FunctionLoader, StrictUndefined

    environment = Environment(
        loader=FunctionLoader(_text),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    environment.filters |= {
        "set_apart": set_apart,
        "breakable": _breakable,
        "kinds": _class_attributes,
    }
    environment.filters["css_text"] = _css_text
    environment.tests["of"] = lambda block, kind: type(block).__name__ == kind
    return environment


def _css_text(text: str) -> str:
    """Convert text to a CSS string; all characters but ASCII letters and digits are escaped."""
    signs = (one if one.isascii() and one.isalnum() else f"\\{ord(one):x} " for one in text)
    return f'"{"".join(signs)}"'


def _breakable(text: str) -> str:
    """Insert <wbr> into long words: lines may break there, but copied words remain whole."""
    from markupsafe import Markup

    if not _LONG_WORD.search(text):  # the usual case
        return text
    words = _LONG_WORD.split(text)
    words[1::2] = [Markup("<wbr>").join(_STEPS.findall(word)) for word in words[1::2]]
    return Markup("").join(words)


def _class_attributes(columns: Sequence[Column]) -> list[str]:
    from markupsafe import Markup

    def kind(column: Column) -> str:
        if column.numeric:
            return "number"
        return "sentence" if column.share > 2 else "words" if column.share > 1 else ""

    kinds = map(kind, columns)
    return [Markup(f' class="{each}"' if each else "") for each in kinds]


def _text(name: str) -> str:
    return (files(__name__) / name).read_text(encoding="utf-8")
