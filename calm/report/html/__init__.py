"""A report as one HTML page that needs no other file and no network."""

from __future__ import annotations

import re
from collections.abc import Sequence
from functools import cache
from importlib.resources import files
from typing import TYPE_CHECKING, Any

from calm.report.vector import set_apart

if TYPE_CHECKING:
    from jinja2 import Environment

    from calm.case import Result, TowResult
    from calm.case.uncertain import Uncertain
    from calm.report.blocks import Report, Section

_LONG_WORD = re.compile(r"(\S{20,})")
_STEP = 10  # signs after which a long word may break


def report_html(sections: Sequence[Section]) -> str:
    """The report of a design check, the section of each mooring in order.

    Every text is escaped. The page asks for nothing: style, script and drawings stand in it. It is
    whole without its script, which sorts and chooses among the checks.
    """
    from calm.report.check.section import check_report

    return page(check_report(sections))


def result_html(result: Result | TowResult, uncertain: Uncertain | None = None) -> str:
    """The report of one solved mooring or tow, and of how sure its figures are."""
    from calm.report.result_section import result_report

    return page(result_report(result, uncertain))


def page(report: Report) -> str:
    """Any report as a page; a text that is no Unicode shows question marks."""
    template = _environment().get_template("page.html.jinja")
    texts = {name: _text(name) for name in ("page.css", "page.js")}
    html = template.render(report=report, style=texts["page.css"], script=texts["page.js"])
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
    environment.filters |= {"set_apart": set_apart, "breakable": _breakable}
    environment.tests["of"] = _is_of
    return environment


def _breakable(text: str) -> str:
    """The text escaped; a word too long for a column may break, and is still one when copied."""
    from markupsafe import Markup, escape

    def broken(word: str) -> Markup:
        steps = range(0, len(word), _STEP)
        return Markup("<wbr>").join(word[start : start + _STEP] for start in steps)

    words = _LONG_WORD.split(text)
    long = words[1::2]
    if not long:
        return escape(text)
    words[1::2] = map(broken, long)
    return Markup("").join(words)


def _is_of(block: Any, kind: str) -> bool:
    """Whether a block of a report is of a kind."""
    return type(block).__name__ == kind


def _text(name: str) -> str:
    return (files(__name__) / name).read_text(encoding="utf-8")
