"""A report as PDF, set by typst."""

from __future__ import annotations

import json
from collections.abc import Sequence
from dataclasses import replace
from importlib.resources import files
from typing import TYPE_CHECKING, Any

from calm.report.blocks import Section
from calm.report.fonts import font_folder, legible
from calm.report.provenance import moment

if TYPE_CHECKING:
    from calm.case import Result, TowResult
    from calm.case.uncertain import Uncertain
    from calm.report.blocks import Report


def report_pdf(sections: Sequence[Section], leaves: Sequence[str] | None = None) -> bytes:
    """The report of a design check, as `calm.report.html.report_html` shows it.

    `leaves` are the sections as `pdf_leaf` has them, where they are made already.

    The same sections give the same bytes: the fonts are those that typst and matplotlib bring, and
    the only date is that of SOURCE_DATE_EPOCH. A sign that no font has shows as �.
    """
    from calm.report.check.section import check_report

    return printed(check_report(sections), leaves=leaves)


def pdf_leaf(section: Section) -> str:
    """What the pages show of a section."""
    return _text(section)


def result_pdf(result: Result | TowResult, uncertain: Uncertain | None = None) -> bytes:
    """The report of one solved mooring or tow, and of how sure its figures are."""
    from calm.report.result_section import result_report

    return printed(result_report(result, uncertain))


def printed(
    report: Report,
    paper: str = "a4",
    least: float = 0.0,
    leaves: Sequence[str] | None = None,
) -> bytes:
    """Any report on pages; its texts reach the template as data, never as markup.

    Parameters
    ----------
    paper : a4, a3 (lying) or letter
    least : size of the smallest text of its tables and notes [pt]
    leaves : its sections as `pdf_leaf` has them, where they are made already
    """
    import typst

    leaves = leaves or [pdf_leaf(section) for section in report.sections]
    fonts = typst.Fonts(include_system_fonts=False, font_paths=[font_folder()])
    when = moment()
    return typst.compile(
        (files("calm.report") / "report.typ").read_bytes(),
        font_paths=fonts,
        sys_inputs={
            "report": _text(replace(report, sections=())),
            "sections": f"[{','.join(leaves)}]",
            "paper": "us-letter" if paper == "letter" else paper,
            "least": f"{least:g}",
        },
        pdf_tags=False,  # they make the file ten times as large; the page for a browser has its own
        timestamp=None if when is None else int(when.timestamp()),
    )


def _text(part: Report | Section) -> str:
    """A report or a section as the template takes it."""
    text = legible(json.dumps(part, default=_members, ensure_ascii=False))
    return text.encode("utf-8", "replace").decode("utf-8")


def _members(part: Any) -> dict[str, Any]:
    """A part of the report with its kind, which the template goes by; of a section its parts."""
    if isinstance(part, Section):
        return {"name": part.name, "parts": part.parts}
    return {"kind": type(part).__name__, **vars(part)}
