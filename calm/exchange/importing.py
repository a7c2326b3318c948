"""Import files of other programs as mooring files.

Components may be replaced by catalogue entries, and the environment by an environment file. A
missing or insufficient anchor weight is replaced.
"""

from __future__ import annotations

import os
import re
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path

from calm.errors import InputError, UsageError, one_line, refused
from calm.exchange import model
from calm.exchange.anchor_weights import secure_anchors
from calm.exchange.catalogue_matching import CatalogueMatch, match_catalogue_entries
from calm.exchange.current_record import CurrentRecord
from calm.exchange.design_writer import mooring_text
from calm.exchange.registry import FileFormat, file_format, file_formats
from calm.exchange.surface_floats import sink_what_stays_under_water
from calm.files import read_mooring
from calm.files.editing.writing import WritingStyle
from calm.files.yaml_document import read_document
from calm.whole_file import read_head

_HEAD = 70_000  # bytes from which a format is recognised
_OWN_KEYS = (rb"^environment:", rb"^(line|legs):")


@dataclass(frozen=True)
class Imported:
    """A mooring file converted from a file of another program.

    Attributes
    ----------
    file, format : path and format name of the converted file
    text : text of the mooring file
    guessed, dropped : guessed values, and omitted features
    matched : components replaced by catalogue entries
    record : currents at several times, if any
    understood : interpretation of an ambiguous format, as text
    """

    file: Path
    format: str
    text: str
    guessed: tuple[model.Remark, ...]
    dropped: tuple[model.Remark, ...]
    matched: tuple[CatalogueMatch, ...]
    record: CurrentRecord | None
    understood: str = ""


def import_file(
    path: Path,
    output: Path,
    *,
    format: str | None = None,
    environment: Path | None = None,
    options: model.ImportOptions | None = None,
    match_catalogue: bool = False,
) -> Imported:
    """Convert a file of another program to the text of a mooring file.

    Parameters
    ----------
    output : path of the future mooring file
    format : name of a registered format; by default recognised from the content
    environment : environment file that replaces the environment in the imported file
    match_catalogue : whether components are replaced by similar catalogue entries

    Raises
    ------
    InputError
        The file is damaged, has no environment, or has an unsupported feature.
    UsageError
        The format is unknown.
    """
    options = options or model.ImportOptions()
    chosen = _format_of(path, format, listed=options.elements is not None)
    if options.elements is not None and not chosen.takes_elements:
        raise refused(path, f"is a file of {chosen.program}; --elements is only for lists")
    if options.sheet is not None and chosen.name != "table":
        raise refused(path, f"is a file of {chosen.program}; --sheet is only for workbooks")
    assert chosen.read is not None
    design = chosen.read(path, options)
    levels = 0 if design.water is None else len(design.water.current)
    for what, count in (("pieces", len(design.items)), ("levels of current", levels)):
        if count > model.MOST_PIECES:
            raise refused(path, f"has {count} {what}; the maximum is {model.MOST_PIECES}")
    if environment is not None:
        design.environment = environment_lines(environment, output)
        if design.water is not None:
            what = f"the environment in the file: {environment.name} is used instead"
            design.dropped.append(model.Remark("environment", what))
        design.record = None
    elif design.water is None and design.tow is None:
        message = "has no environment; use --environment FILE for depth, current and density"
        raise refused(path, message)
    sink_what_stays_under_water(design, output)
    matched = match_catalogue_entries(design) if match_catalogue else ()
    secure_anchors(design, output)
    text, guessed = mooring_text(design, path.name)
    _check_readable(path, output, text)
    return Imported(
        path, chosen.name, text, tuple(guessed + design.guessed),
        tuple(design.dropped), matched, design.record, design.understood,
    )  # fmt: skip


def _format_of(path: Path, name: str | None, *, listed: bool = False) -> FileFormat:
    if name is not None:
        return _format_named(name)
    content = read_head(path, _HEAD)
    if all(re.search(key, content, re.MULTILINE) for key in _OWN_KEYS):
        raise refused(path, f"is already a mooring file of CALM; solve it with: calm run {path}")
    for each in (formats := _readable()):
        if each.detect is not None and each.detect(content):
            return each
    if listed:
        return file_format("table")
    programs = ", ".join(f"{each.name} ({each.program})" for each in formats)
    raise refused(path, f"is not in a format that CALM reads: {programs}")


def _format_named(name: str) -> FileFormat:
    with suppress(KeyError):
        if (chosen := file_format(name)).read is not None:
            return chosen
    names = ", ".join(each.name for each in _readable())
    raise UsageError(f"--format: `{name}` is none of {names}")


def _readable() -> list[FileFormat]:
    return [each for each in file_formats() if each.read is not None]


def _check_readable(path: Path, output: Path, text: str) -> None:
    try:
        read_mooring(output, text=text)
    except InputError as error:
        lines = ["", *text.splitlines()]
        blamed = [lines[each.line] if each.line < len(lines) else "" for each in error.problems]
        raise refused(
            path,
            *(
                f"{each.message} (in `{' '.join(line.split())[:80]}`)" if line else each.message
                for each, line in zip(error.problems, blamed, strict=True)
            ),
        ) from None


def environment_lines(path: Path, output: Path) -> list[str]:
    """Return the lines of the `environment` key in a file, for the mooring file `output`.

    The path of a current file becomes relative to the folder of `output`. Raise InputError if the
    file is unreadable or has no `environment`.
    """
    found = read_document(path).data.get("environment")
    if not isinstance(found, dict) or not found:
        raise refused(path, "has no `environment`")
    current = found.get("current")
    if isinstance(current, dict) and isinstance(current.get("file"), str):
        target = os.path.join(path.parent, current["file"])
        found["current"] = {**current, "file": os.path.relpath(target, str(output.parent))}
    _, *below = WritingStyle().entry("environment", found, 1).splitlines()
    return [f"environment:  # from {one_line(path.name)}", *below]
