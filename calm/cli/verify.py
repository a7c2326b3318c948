"""``calm verify``: published figures against what CALM computes."""

from __future__ import annotations

import sys
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

from cyclopts import Parameter

from calm.cli.exit_codes import ExitCode
from calm.cli.streams import show, show_rich
from calm.errors import UsageError

if TYPE_CHECKING:
    from calm.verification import Outcome, Source

VERIFY_EXAMPLES = """Examples:

  calm verify
  calm verify cdms tension
  calm verify braconnot --json -"""

_STDOUT = Path("-")


def verify(
    words: list[str] | None = None,
    /,
    *,
    json: Annotated[Path | None, Parameter(allow_leading_hyphen=True)] = None,
) -> ExitCode:
    """Compute published figures and compare.

    Closed forms, published charts and tables, moorings that other programs have
    solved, and what must hold for any line. The exit code is 1 when a figure is
    out of its tolerance.

    Parameters
    ----------
    words
        Only cases whose source or name has every one of these words or parts of words.
    json
        Write the figures, with the reason for each tolerance, as JSON, - to print it.
    """
    from calm.report.verification import verification_document, verification_table

    _check_destination(json)
    findings = _checked(_chosen(words or []))
    document = verification_document(findings)
    if json is not None:
        from calm.report.document import to_json
        from calm.report.write import write_file

        text = to_json([document])
        if json == _STDOUT:
            show(text)
        else:
            write_file(json, text.encode())
    if json != _STDOUT:
        show_rich(verification_table(findings))
    return ExitCode.FINDING if document["out"] else ExitCode.DONE


def _check_destination(path: Path | None) -> None:
    """Refuse a file that could not be written, before anything is computed."""
    from calm.report.write import check_destination

    if path is None or path == _STDOUT:
        return
    if str(path).startswith("-"):
        raise UsageError(f"{path} stands where a path is needed; write ./{path} for a file")
    check_destination(path)


def _chosen(words: Sequence[str]) -> list[Source]:
    """The sources with the cases that have every word.

    Raises
    ------
    UsageError
        No case has them.
    """
    from calm.verification import SOURCES

    chosen = [source for source in (each.having(words) for each in SOURCES) if source.cases]
    if not chosen:
        titles = "; ".join(source.title for source in SOURCES)
        raise UsageError(f"no case has {' and '.join(words)}; the sources are: {titles}")
    return chosen


def _checked(sources: Sequence[Source]) -> list[tuple[Source, list[Outcome]]]:
    """The outcomes of every case, with a line of progress where a person looks on."""
    total, done, findings = sum(len(source.cases) for source in sources), 0, []
    for source in sources:
        outcomes = []
        for case in source.cases:
            _progress(f"{done} of {total}: {source.title}")
            outcomes.append(case.check())
            done += 1
        findings.append((source, outcomes))
    _progress("")
    return findings


def _progress(text: str) -> None:
    """Put a line in place of the last one on the terminal that the standard error is, if any."""
    if sys.stderr is not None and sys.stderr.isatty():
        print(f"\r\x1b[K{text}", end="", file=sys.stderr, flush=True)
