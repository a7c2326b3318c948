"""A report as one HTML page that needs no other file and no network."""

from __future__ import annotations

import re
from collections.abc import Sequence
from functools import cache
from importlib.resources import files
from typing import TYPE_CHECKING, Any

from calm.drawing.picture import set_apart

if TYPE_CHECKING:
    from jinja2 import Environment

    from calm.case import Result, TowResult
    from calm.case.uncertain import Uncertain
    from calm.report.blocks import Column, Report, Section

_LONG_WORD = re.compile(r"(\S{20,})")
_STEP = 10  # signs after which a long word may break


def report_html(sections: Sequence[Section], leaves: Sequence[str] | None = None) -> str:
    """The report of a design check, the section of each mooring in order.

    Every text is escaped. The page asks for nothing: style, script and drawings stand in it. It is
    whole without its script, which sorts and chooses among the checks. `leaves` are the sections
    as `leaf` has them, where they are made already.
    """
    from calm.report.check_report import check_report

    return page(check_report(sections), leaves)


def leaf(section: Section, number: int) -> str:
    """Return what the page shows of a section, the `number`th from 1."""
    template = _environment().get_template("parts.html.jinja")
    shown: str = template.module.parts(section.parts, f"m{number}")  # type: ignore[attr-defined]
    return shown


def result_html(result: Result | TowResult, uncertain: Uncertain | None = None) -> str:
    """The report of one solved mooring or tow, and of how sure its figures are."""
    from calm.report.result_report import result_report

    return page(result_report(result, uncertain))


def page(report: Report, leaves: Sequence[str] | None = None) -> str:
    """Any report as a page; a text that is no Unicode shows question marks."""
    leaves = leaves or [leaf(section, at) for at, section in enumerate(report.sections, 1)]
    template = _environment().get_template("page.html.jinja")
    texts = {name: _text(name) for name in ("page.css", "page.js")}
    html = template.render(
        report=report, leaves=leaves, style=texts["page.css"], script=texts["page.js"]
    )
    return html.encode("utf-8", "replace").decode("utf-8")


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
    environment.filters |= {"set_apart": set_apart, "breakable": _breakable, "kinds": _kinds}
    environment.tests["of"] = _is_of
    return environment


def _breakable(text: str) -> str:
    """The text escaped; a word too long for a column may break, and is still one when copied."""
    from markupsafe import Markup, escape

    if len(text) < 2 * _STEP:
        return escape(text)

    def broken(word: str) -> Markup:
        steps = range(0, len(word), _STEP)
        return Markup("<wbr>").join(word[start : start + _STEP] for start in steps)

    words = _LONG_WORD.split(text)
    long = words[1::2]
    if not long:
        return escape(text)
    words[1::2] = map(broken, long)
    return Markup("").join(words)


def _kinds(columns: Sequence[Column]) -> list[str]:
    """The attribute of every cell of a column: figures, or words, the more the wider it is."""
    from markupsafe import Markup

    def kind(column: Column) -> str:
        if column.numeric:
            return "number"
        return "sentence" if column.share > 2 else "words" if column.share > 1 else ""

    kinds = map(kind, columns)
    return [Markup(f' class="{each}"' if each else "") for each in kinds]


def _is_of(block: Any, kind: str) -> bool:
    """Return whether a block of a report is of a kind."""
    return type(block).__name__ == kind


def _text(name: str) -> str:
    return (files(__name__) / name).read_text(encoding="utf-8")
