"""Files and folders of reports.

Paths are checked before any computation. Reports are written completely or not at all. PDF files
are typeset by typst.
"""

import contextlib
import json
import os
from collections.abc import Mapping, Sequence
from dataclasses import replace
from importlib.resources import files
from pathlib import Path
from typing import Any

from calm.drawing.typesetting import legible, typeset
from calm.errors import UsageError
from calm.report.blocks import Cell, Report, Section
from calm.report.html import page
from calm.report.provenance import moment
from calm.whole_file import put

_FILE_SUFFIXES = (".csv", ".html", ".json", ".nc", ".pdf", ".png", ".svg", ".xlsx", ".yaml")

REPORT_FILES = ("report.html", "report.pdf", "report.json", "checks.csv", "inventory.csv")
"""Names of the files that a design check writes into the folder."""


def check_folder(folder: Path) -> None:
    """Raise UsageError if files cannot be written to a folder; call this before any computation.

    The folder, or the nearest existing parent of a new folder, must be writable. The name of a new
    folder must not have a file suffix.
    """
    try:
        with contextlib.suppress(FileNotFoundError):
            folder.lstat()  # rejects a name that no folder can have
        if folder.suffix in _FILE_SUFFIXES and not folder.exists():
            raise UsageError(
                f"cannot write {folder}: the output is a folder of several files; use a folder "
                f"name, without {folder.suffix}"
            )

        nearest = folder.absolute()
        while not os.path.lexists(nearest):
            nearest = nearest.parent
        if not nearest.is_dir():
            raise UsageError(
                f"cannot write {folder}: the output must be a folder, but {nearest} is a file"
            )
        if not os.access(nearest, os.W_OK | os.X_OK):
            raise UsageError(f"cannot write {folder}: permission denied in {nearest}")
    except OSError as error:
        raise UsageError(f"cannot write {folder}: {error.strerror}") from None


def write_report(folder: Path, files: Mapping[str, bytes]) -> None:
    """Write the files of a report as a set, creating the folder if needed.

    If the program fails or is interrupted, the previous report is restored and no temporary file
    remains. Raise UsageError, with the file and the reason, if the system rejects a file.
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
            _restore_previous(folder, parts, kept)
            raise
    except OSError as error:
        raise UsageError(f"cannot write {target}: {error.strerror}") from None
    finally:
        for path in (*parts.values(), *kept.values()):
            with contextlib.suppress(OSError):
                path.unlink()
        if made:
            with contextlib.suppress(OSError):
                folder.rmdir()  # succeeds only if the folder is empty


def write_pages(folder: Path, name: str, report: Report) -> None:
    """Write a report as NAME.html and NAME.pdf, together as in `write_report`."""
    files = {f"{name}.html": page(report).encode(), f"{name}.pdf": printed(report)}
    write_report(folder, files)


def _restore_previous(folder: Path, parts: Mapping[str, Path], kept: Mapping[str, Path]) -> None:
    for name, part in parts.items():
        if not part.exists():  # already renamed
            (folder / name).unlink(missing_ok=True)
        if os.path.lexists(kept[name]):
            os.replace(kept[name], folder / name)


def check_destination(path: Path) -> None:
    """Raise UsageError if a file cannot be written; call this before any computation.

    The path must not be a folder, and its folder must exist. The file, or the folder of a new file,
    must be writable.
    """
    folder = os.path.dirname(os.path.realpath(path))
    if os.path.isdir(path):
        raise UsageError(f"cannot write {path}: it is a folder")
    if not os.path.isdir(folder):
        raise UsageError(f"cannot write {path}: there is no folder {folder}")
    if not os.access(path if os.path.exists(path) else folder, os.W_OK):
        raise UsageError(f"cannot write {path}: permission denied")


def write_file(path: Path, content: bytes) -> None:
    """Write a file atomically, so that readers see either the old content or the new.

    Devices and pipes are written directly; symbolic links are preserved. Raise UsageError if the
    system rejects the file.
    """
    try:
        if os.path.exists(path) and not os.path.isfile(path):
            path.write_bytes(content)
        else:
            put(Path(os.path.realpath(path)), content)
    except OSError as error:
        raise UsageError(f"cannot write {path}: {error.strerror}") from None


def printed(report: Report, page_size: str = "a4", leaves: Sequence[str] | None = None) -> bytes:
    """Typeset a report as PDF, of size a4, a3 (landscape) or letter.

    Equal reports give equal bytes; the only date comes from SOURCE_DATE_EPOCH. Characters that are
    not in the fonts appear as �. `leaves` are sections already converted by `pdf_leaf`.
    """
    leaves = leaves or [pdf_leaf(section) for section in report.sections]
    when = moment()
    return typeset(
        (files("calm.report") / "report.typ").read_bytes(),
        {
            # texts are passed as data, never as markup
            "report": pdf_leaf(replace(report, sections=())),
            "sections": f"[{','.join(leaves)}]",
            "paper": "us-letter" if page_size == "letter" else page_size,
        },
        "pdf",
        None if when is None else int(when.timestamp()),
    )


def pdf_leaf(part: Report | Section) -> str:
    """Convert a report or a section to JSON text for the PDF template."""
    text = legible(json.dumps(part, default=_members, ensure_ascii=False))
    return text.encode("utf-8", "replace").decode("utf-8")


def _members(part: Any) -> dict[str, Any] | str:
    """Convert an object of a report to data for the PDF template.

    - A section becomes a dictionary of its name, its parts and its running header.
    - A cell without further attributes becomes its text.
    - Any other object becomes a dictionary with its kind.
    """
    if isinstance(part, Cell):
        text, *more = vars(part).values()
        return text if not any(more) else vars(part)
    if isinstance(part, Section):
        return {"name": part.name, "parts": part.parts, "running": part.running}
    return {"kind": type(part).__name__, **vars(part)}
