"""Outputs of a command: results, messages, and exit code."""

from __future__ import annotations

import codecs
import io
import os
import re
import sys
from collections import Counter
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from enum import IntEnum
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, Protocol

from cyclopts import Parameter

from calm.drawing.picture import encodable, printable
from calm.errors import UsageError
from calm.version import __version__

if TYPE_CHECKING:
    from calm.drawing.schematic.in_terminal import TerminalSchematic
    from calm.records.card import ReadCard
    from calm.report.blocks import ReportPart

    TerminalPart = ReportPart | TerminalSchematic

_NARROWEST = 40  # columns: below this width the terminal wraps the numbers
_ERROR_HANDLER = "calm-written-out"  # error handler for characters that a stream cannot encode
_SIGNS = "°×–−→≤≥²³█▒◦≈"  # characters in the tables


def prepare() -> None:
    """Set up the output streams: ASCII or ``?`` replaces characters that a stream cannot show."""
    codecs.register_error(_ERROR_HANDLER, _transliterated)
    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, io.TextIOWrapper):
            stream.reconfigure(errors=_ERROR_HANDLER)


def _transliterated(error: UnicodeError) -> tuple[str, int]:
    from calm.drawing.picture import in_ascii

    assert isinstance(error, UnicodeEncodeError)
    text = in_ascii(error.object[error.start : error.end])
    return text.encode("ascii", "replace").decode(), error.end


def show(text: str, *, styled: bool = False) -> None:
    """Write text to standard output immediately.

    On a terminal, control sequences are removed unless the text is `styled` by CALM. A reader that
    stops early, such as ``head``, causes no error. Raises UsageError if the output cannot be
    written.
    """
    try:
        print(text if styled or not _on_terminal() else printable(text), end="", flush=True)
    except BrokenPipeError:
        _abandon_output()
    except OSError as error:
        _abandon_output()
        raise UsageError(f"cannot write to the standard output: {error.strerror}") from None


def show_parts(*parts: TerminalPart) -> None:
    """Write report parts to standard output, separated by blank lines and formatted for the
    terminal.
    """
    from rich.console import Console

    from calm.report.blocks import ReportPart
    from calm.report.terminal import shown

    text = io.StringIO()
    console = Console(file=text, force_terminal=_on_terminal() or None, highlight=False)
    console.width = max(console.width, _NARROWEST)
    plain = not encodable(getattr(sys.stdout, "encoding", None), _SIGNS)
    for number, part in enumerate(parts):
        if number:
            console.print()
        console.print(shown(part, plain=plain) if isinstance(part, ReportPart) else part)
    # Tables are padded to full width, which only clutters stored text.
    show(re.sub(" +$", "", text.getvalue(), flags=re.MULTILINE), styled=True)


def _on_terminal() -> bool:
    return sys.stdout is not None and sys.stdout.isatty()


def narrate(text: str) -> None:
    """Write a line to standard error, without terminal control sequences."""
    print(printable(text), file=sys.stderr, flush=True)


def narrate_card(card: ReadCard) -> None:
    """Write the interpretation of an input file to standard error."""
    from calm.records.card import card_rows

    rows = card_rows(card.to_dict())
    width = max(len(name) for name, _ in rows)
    narrate(f"{card.file}: read as")
    for name, value in rows:
        narrate(f"  {name:{width}}  {' '.join(value.split())}")


def save(path: Path, content: bytes, then: str = "") -> None:
    """Write a file, and report its path on standard error, followed by the text `then`.

    Raises UsageError if the file cannot be written.
    """
    from calm.report.folder import write_file

    write_file(path, content)
    narrate(f"{path} written{then}")


def check_suffix(path: Path, allowed: Sequence[str]) -> None:
    """Raise UsageError unless the suffix of an output file is in `allowed`. An empty list allows
    any suffix.
    """
    if allowed and path.suffix.lower() not in allowed:
        *others, last = allowed
        names = f"{', '.join(others)} or {last}" if others else last
        raise UsageError(f"cannot write {path}: its name must end in {names}")


def _abandon_output() -> None:
    # writing the buffered output would fail again when the interpreter exits
    os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())


class ExitCode(IntEnum):
    """Exit codes, which have the same meaning for every command."""

    DONE = 0
    """The command succeeded."""

    FINDING = 1
    """A check failed, or a value that it requires is missing."""

    BAD_INPUT = 2
    """A file, an option or an output path is unusable; no result was computed."""

    NO_EQUILIBRIUM = 3
    """A mooring has no valid equilibrium."""

    INTERNAL_ERROR = 70
    """CALM itself failed: a bug, worth a report."""

    INTERRUPTED = 130
    """Stopped by Ctrl-C."""


_GRAVEST_FIRST = (ExitCode.BAD_INPUT, ExitCode.NO_EQUILIBRIUM, ExitCode.FINDING)


def gravest(codes: Iterable[ExitCode]) -> ExitCode:
    """Return the most severe exit code, in the order 2, 3, 1, 0."""
    occurred = set(codes)
    return next((code for code in _GRAVEST_FIRST if code in occurred), ExitCode.DONE)


OutputPath = Annotated[Path | None, Parameter(allow_leading_hyphen=True)]
"""Type of an option that takes a path, or - for the standard output."""

STDOUT = Path("-")
"""Path that stands for standard output."""


class Shown(Protocol):
    """Result of a command for one of its files."""

    @property
    def file(self) -> Path:
        """Path of the input file."""

    def document(self) -> dict[str, Any]:
        """Return the result as a JSON object."""

    def parts(self) -> list[TerminalPart]:
        """Return the tables and drawings for the terminal."""

    def rendered(self, suffix: str) -> bytes | None:
        """Return the content of a file with the given suffix: a picture, page or dataset; None
        without a result.
        """


APIECE = (".html", ".pdf", ".svg", ".png", ".nc")
"""Suffixes of outputs that are written once for each mooring file."""

SUFFIXES = (".json", ".csv", *APIECE)
"""Suffixes of all outputs that -o writes."""


@dataclass(frozen=True)
class Outputs:
    """The outputs of a command.

    Parameters
    ----------
    files : the input files, if the command has any
    json : path of the JSON document, ``-`` for standard output
    written : further output files, whose suffixes select the formats
    suffixes : allowed suffixes of the further output files
    """

    files: tuple[Path, ...] = ()
    json: Path | None = None
    written: tuple[Path, ...] = ()
    suffixes: tuple[str, ...] = SUFFIXES

    def apiece(self, path: Path) -> list[Path]:
        """Return the path of an output for each input file. With several input files, each path
        includes the name of its input file.
        """
        if len(self.files) == 1:
            return [path]
        return [path.with_stem(f"{path.stem}-{file.stem}") for file in self.files]

    def __post_init__(self) -> None:
        # invalid outputs are rejected before anything is solved
        from calm.report.folder import check_destination
        from calm.report.provenance import moment

        paths = [] if self.json is None else [self.json]
        for path in self.written:
            paths += self.apiece(path) if path.suffix.lower() in APIECE else [path]
        for path in paths:
            if str(path).startswith("-") and path != STDOUT:
                raise UsageError(
                    f"a file name is expected, not the option {path}; write ./{path} for a file"
                )
        for path in self.written:
            check_suffix(path, self.suffixes)
        if any(path.suffix.lower() in APIECE for path in self.written):
            moment()
        mooring_files = set(map(os.path.realpath, self.files))
        for real, count in Counter(map(os.path.realpath, paths)).items():
            if count > 1:
                raise UsageError(f"two outputs have the same path, {os.path.relpath(real)}")
            if real in mooring_files:
                raise UsageError(
                    f"{os.path.relpath(real)} is a mooring file and was not overwritten"
                )
        for path in paths:
            if path != STDOUT:
                check_destination(path)

    def write_answer(self, document: Callable[[], dict[str, Any]], part: ReportPart | None) -> None:
        """Print the result of a command without input files, and write its JSON document if
        requested.

        JSON on standard output replaces the printed `part`. Raises UsageError if a file cannot be
        written.
        """
        from calm.report.result_files import to_json

        def text() -> str:
            return to_json([{"calm": __version__} | document()])

        if self.json == STDOUT:
            show(text())
            return
        if part is not None:
            show_parts(part)
        if self.json is not None:
            save(self.json, text().encode())

    def write(self, shown: Sequence[Shown], to_csv: Callable[[], str]) -> None:
        """Write the output files, then print the tables, or JSON if requested on standard output.

        `shown` has one entry per input file, in order. `to_csv` returns the content of a CSV file
        for all inputs together. Raises UsageError if a file cannot be written.
        """
        from calm.report.result_files import to_json

        def document() -> str:
            return to_json([each.document() for each in shown])

        together = {".json": document, ".csv": to_csv}
        for path in self.written:
            suffix = path.suffix.lower()
            if suffix in together:
                save(path, together[suffix]().encode("utf-8", "replace"))
                continue
            for one, each in zip(self.apiece(path), shown, strict=True):
                content = each.rendered(suffix)
                if content is not None:
                    save(one, content)
        if self.json == STDOUT:
            show(document())
        else:
            show_parts(*(part for each in shown for part in each.parts()))
