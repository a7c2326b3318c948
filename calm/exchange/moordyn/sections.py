"""The tables of a MoorDyn or MoorPy input file, by the headings of their columns."""

from __future__ import annotations

import re
from dataclasses import dataclass, field
from pathlib import Path

from calm.exchange.refusal import refused_at
from calm.files.document import read_text

_SECTIONS = (
    ("types", r"line (types|dictionary)"),
    ("points", r"(node|connection|point) properties|^points?( list)?$|connections"),
    ("lines", r"line properties|^lines?( list)?$"),
    ("bodies", r"bod(y|ies)"),
    ("rods", r"^rods?\b(?!.*types)"),
    ("rod types", r"rod (types|dictionary)"),
    ("options", r"options"),
    ("outputs", r"outputs?"),
)
_COLUMNS = {
    "typename": "name", "name": "name", "linetype": "type", "type": "attachment",
    "attachment": "attachment", "diam": "diameter", "mass/m": "mass", "massden": "mass",
    "massdeninair": "mass", "massperlength": "mass", "mass/length": "mass", "ea": "ea",
    "cd": "cd", "cdn": "cd", "cdax": "cdt", "cdt": "cdt", "id": "id", "node": "id", "line": "id",
    "x": "x", "y": "y", "z": "z", "m": "mass", "mass": "mass", "v": "volume", "volume": "volume",
    "cda": "cda", "fx": "fx", "fy": "fy", "fz": "fz", "unstrlen": "length", "nodeanch": "a",
    "nodefair": "b", "nodea": "a", "nodeb": "b", "attacha": "a", "attachb": "b",
}  # fmt: skip


@dataclass(frozen=True)
class SectionRow:
    """A row of a table: its words by heading, and its place in the file."""

    path: str
    line: int
    words: dict[str, str]

    def number(self, key: str, default: float | None = None) -> float:
        """A word as a number.

        Raises
        ------
        InputError
            It is missing, or no number.
        """
        text = self.words.get(key)
        if text is None and default is not None:
            return default
        try:
            value = float((text or "").split("|")[0])
        except ValueError:
            raise self.refuse(f"`{key}` is `{text or ''}`, no number") from None
        if abs(value) > 1e15 or value != value:
            raise self.refuse(f"`{key}` is {value:g}")
        return value

    def refuse(self, message: str) -> Exception:
        """A problem in this row."""
        return refused_at(self.path, self.line, 1, message)


@dataclass
class MoorDynSections:
    """The tables of a file, and its options."""

    rows: dict[str, list[SectionRow]] = field(default_factory=dict)
    options: dict[str, str] = field(default_factory=dict)


def is_moordyn(content: bytes) -> bool:
    """Whether a file has the sections that each such file must have."""
    text = content.decode("latin-1").lower()
    found = {_section(line) for line in text.splitlines() if line.strip().startswith("---")}
    return b"\0" not in content and {"types", "lines"} <= found


def read_sections(path: Path) -> MoorDynSections:
    """Read a file.

    Raises
    ------
    InputError
        A table has a row with too few words.
    """
    sections, current, headings, skip = MoorDynSections(), "", list[str](), 0
    for number, text in enumerate(read_text(path).splitlines(), 1):
        line = text.split("#")[0] if not text.lstrip().startswith("(") else text
        if line.strip().startswith("---"):
            current, headings, skip = _section(line.lower()) or "", [], 2
        elif not line.strip() or not current or current == "outputs":
            continue
        elif current == "options":
            words = line.split()
            if len(words) >= 2:
                sections.options.setdefault(words[1].lower(), words[0])
        elif skip:
            skip -= 1
            if skip == 1:
                headings = [_heading(word, current) for word in line.split()]
        else:
            words = line.split()
            if len(words) < min(len(headings), 4):
                raise refused_at(str(path), number, 1, f"the row has {len(words)} words")
            kept = dict(zip(headings, words, strict=False))
            sections.rows.setdefault(current, []).append(SectionRow(str(path), number, kept))
    return sections


def _section(line: str) -> str | None:
    title = line.strip().strip("-").strip()
    return next((name for name, pattern in _SECTIONS if re.search(pattern, title)), None)


def _heading(word: str, section: str) -> str:
    plain = word.lower().strip("()#*")
    if section == "types" and plain in ("linetype", "type", "name", "typename"):
        return "name"
    return _COLUMNS.get(plain, plain)
