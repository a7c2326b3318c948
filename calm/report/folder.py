"""Files and folders of reports: looked at before anything is solved, and whole or not there.

A report as PDF is set by typst.
"""

import contextlib
import json
import os
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace
from functools import cache
from importlib.resources import files
from pathlib import Path
from typing import Any

from calm.errors import UsageError
from calm.report.blocks import Cell, Report, Section
from calm.report.html import page
from calm.report.provenance import moment
from calm.whole_file import put

REPORT_FILES = ("report.html", "report.pdf", "report.json", "checks.csv", "inventory.csv")
"""What a design check writes in the folder."""


def check_folder(folder: Path) -> None:
    """Refuse a folder in which nothing could be written, before the work for it is done.

    UsageError: it is no folder, or lies in none; it or the nearest one that exists may not be
    written.
    """
    try:
        with contextlib.suppress(FileNotFoundError):
            folder.lstat()  # refuses a name that no folder may have
        nearest = folder.absolute()
        while not os.path.lexists(nearest):
            nearest = nearest.parent
        if not nearest.is_dir():
            raise UsageError(
                f"cannot write {folder}: {nearest} is not a folder; a folder is needed"
            )
        if not os.access(nearest, os.W_OK | os.X_OK):
            raise UsageError(f"cannot write {folder}: permission denied in {nearest}")
    except OSError as error:
        raise UsageError(f"cannot write {folder}: {error.strerror}") from None


def write_report(folder: Path, files: Mapping[str, bytes]) -> None:
    """Write the files of a report as a set, making the folder where it is missing.

    All are written under temporary names before the first takes its place. Where one cannot take
    it, or the program is interrupted meanwhile, the report that was there stands again, whole.
    UsageError: the system refuses; which file, and why. No temporary file is left behind.
    """
    parts = {name: folder / f".{name}-{os.getpid()}.part" for name in files}
    kept = {name: folder / f".{name}-{os.getpid()}.old" for name in files}
    target, made = folder, not folder.exists()
    try:
        folder.mkdir(parents=True, exist_ok=True)
        for name, content in files.items():
            target = folder / name
            if target.is_dir():
                raise IsADirectoryError(None, "it is a folder")
            parts[name].write_bytes(content)
        try:
            for name in files:
                target = folder / name
                if os.path.lexists(target):
                    os.replace(target, kept[name])
                os.replace(parts[name], target)
        except BaseException:
            _restore(folder, parts, kept)
            raise
    except OSError as error:
        raise UsageError(f"cannot write {target}: {error.strerror}") from None
    finally:
        for path in (*parts.values(), *kept.values()):
            with contextlib.suppress(OSError):
                path.unlink()
        if made:
            with contextlib.suppress(OSError):
                folder.rmdir()  # which the system does only where nothing was written


def write_pages(folder: Path, name: str, report: Report) -> None:
    """Write a report as a page and as a PDF of a name, as a set like `write_report`."""
    files = {f"{name}.html": page(report).encode(), f"{name}.pdf": printed(report)}
    write_report(folder, files)


def _restore(folder: Path, parts: Mapping[str, Path], kept: Mapping[str, Path]) -> None:
    """Take away the new files that have taken their place, and put the old ones back."""
    for name, part in parts.items():
        if not part.exists():
            (folder / name).unlink(missing_ok=True)
        if os.path.lexists(kept[name]):
            os.replace(kept[name], folder / name)


def check_destination(path: Path) -> None:
    """Refuse a file that could not be written, before the work for it is done.

    UsageError: the folder is missing, or the file or its folder may not be written.
    """
    folder = os.path.dirname(os.path.realpath(path))
    if os.path.isdir(path):
        raise UsageError(f"cannot write {path}: it is a folder")
    if not os.path.isdir(folder):
        raise UsageError(f"cannot write {path}: there is no folder {folder}")
    if not os.access(path if os.path.exists(path) else folder, os.W_OK):
        raise UsageError(f"cannot write {path}: permission denied")


def write_file(path: Path, content: bytes) -> None:
    """Write a file whole: a reader sees the old content or the new, never a part.

    A device or a pipe is written as it is, and a symbolic link keeps pointing where it did.
    UsageError: the system refuses, e.g. because the disk is full; the old file is then untouched.
    """
    try:
        if os.path.exists(path) and not os.path.isfile(path):
            path.write_bytes(content)
        else:
            put(Path(os.path.realpath(path)), content)
    except OSError as error:
        raise UsageError(f"cannot write {path}: {error.strerror}") from None


def printed(
    report: Report, paper: str = "a4", least: float = 0.0, leaves: Sequence[str] | None = None
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


def _members(part: Any) -> dict[str, Any] | str:
    """A part of the report with its kind, which the template goes by; of a section its parts.

    Of a cell that is nothing but its text it is the text.
    """
    if isinstance(part, Cell):
        text, *more = vars(part).values()
        return text if not any(more) else vars(part)
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
