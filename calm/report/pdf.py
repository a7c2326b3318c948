"""A report as PDF, set by typst."""

from __future__ import annotations

import json
from collections.abc import Iterable, Sequence
from dataclasses import replace
from functools import cache
from importlib.resources import files
from pathlib import Path
from typing import TYPE_CHECKING, Any

from calm.report.blocks import Section
from calm.report.provenance import moment

if TYPE_CHECKING:
    from calm.report.blocks import Report


def printed(
    report: Report,
    paper: str = "a4",
    least: float = 0.0,
    leaves: Sequence[str] | None = None,
) -> bytes:
    """Any report on pages; its texts reach the template as data, never as markup.

    The same report gives the same bytes: the fonts are those that typst and matplotlib bring, and
    the only date is that of SOURCE_DATE_EPOCH. A sign that no font has shows as �.

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
            "report": pdf_leaf(replace(report, sections=())),
            "sections": f"[{','.join(leaves)}]",
            "paper": "us-letter" if paper == "letter" else paper,
            "least": f"{least:g}",
        },
        pdf_tags=False,  # they make the file ten times as large; the page for a browser has its own
        timestamp=None if when is None else int(when.timestamp()),
    )


def pdf_leaf(part: Report | Section) -> str:
    """A report or a section as the template takes it."""
    text = legible(json.dumps(part, default=_members, ensure_ascii=False))
    return text.encode("utf-8", "replace").decode("utf-8")


def _members(part: Any) -> dict[str, Any]:
    """A part of the report with its kind, which the template goes by; of a section its parts."""
    if isinstance(part, Section):
        return {"name": part.name, "parts": part.parts}
    return {"kind": type(part).__name__, **vars(part)}


def font_folder() -> Path:
    """The fonts that are always there: those that matplotlib brings."""
    import matplotlib

    return Path(matplotlib.get_data_path(), "fonts", "ttf")


def lacking(texts: Iterable[str]) -> str:
    """The signs of some texts that no font of a PDF has, each once, in order."""
    held, known = list(texts), _signs()
    unknown = {sign for sign in set().union(*held) if sign.isprintable() and ord(sign) not in known}
    if not unknown:  # as nearly always: a report has millions of signs
        return ""
    return "".join(dict.fromkeys(sign for text in held for sign in text if sign in unknown))


def legible(text: str) -> str:
    """A text for a PDF: a sign that no font has is a question mark in a lozenge.

    A single one would otherwise have all of a drawing's label shown in boxes.
    """
    unknown = lacking([text])
    return text.translate(dict.fromkeys(map(ord, unknown), "\ufffd")) if unknown else text


@cache
def _signs() -> frozenset[int]:
    from matplotlib.ft2font import FT2Font

    fonts = sorted(font_folder().glob("DejaVuSans*.ttf"))
    return frozenset(code for font in fonts for code in FT2Font(str(font)).get_charmap())
