"""``calm verify``: figures that are known without CALM against what it computes."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import islice
from typing import TYPE_CHECKING

from calm.cli.exit_codes import ExitCode
from calm.cli.outputs import OutputPath, Outputs
from calm.cli.streams import progress
from calm.errors import UsageError

if TYPE_CHECKING:
    from calm.verification import CaseOutcome, Source

VERIFY_EXAMPLES = """Examples:

  calm verify
  calm verify cdms tension
  calm verify braconnot --json -
  calm verify --field"""


def verify(
    words: list[str] | None = None, /, *, field: bool = False, json: OutputPath = None
) -> ExitCode:
    """Compute figures that are known without CALM, and compare them.

    Each figure is published, or comes from a closed form or an independent
    integration, or is a property that any line must have. Those that CALM meets
    by construction are checked and not counted. The exit code is 1 when a figure
    is out of its tolerance.

    Parameters
    ----------
    words
        Only cases whose source or name contains all these words or parts of words.
    field
        Instead, estimate the depths of a real mooring at hidden sensors, and compare them
        with the measured depths: see `calm docs motion`.
    json
        Write the figures, with the reason for each tolerance, as JSON, - to print it.
    """
    from calm.report.verification import verification_document, verification_part
    from calm.solve import expect_many

    outputs = Outputs(json=json)
    outputs.check()
    if field:
        from calm.cli.verify_field import verify_field

        if words:
            raise UsageError("--field takes no words")
        return verify_field(outputs)
    chosen = _chosen(words or [])
    expect_many(sum(len(source.cases) for source in chosen))
    findings = _checked(chosen)
    document = verification_document(findings)
    outputs.write_answer(lambda: document, verification_part(findings))
    return ExitCode.FINDING if document["out"] else ExitCode.DONE


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


def _checked(sources: Sequence[Source]) -> list[tuple[Source, list[CaseOutcome]]]:
    """The outcomes of every case, source by source."""
    cases = [case for source in sources for case in source.cases]
    outcomes = iter([case.check() for case in progress(cases, "figures")])
    return [(source, list(islice(outcomes, len(source.cases)))) for source in sources]
