"""The files that stand beside the result of a batch."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING

from calm.batch.result import stored_result
from calm.batch.statistics.summary import summarize
from calm.report.batch.document import summary_document
from calm.report.batch.page import summary_html
from calm.report.document import to_json
from calm.whole_file import put

if TYPE_CHECKING:
    from calm.batch.statistics.summary import Summary
    from calm.case import Mooring


def write_summary(
    result: Path, mooring: Mooring, check: Callable[[], None] = lambda: None
) -> Summary:
    """Gather what a finished result says, and write it beside it, as JSON and as a page.

    The result is only read: this can be done, and done again, at any time after it is finished.

    Parameters
    ----------
    result : the .nc file or .zarr folder; RESULT.nc has RESULT.summary.json, RESULT.summary.html,
        which would be those of a RESULT.zarr beside it too: the later summary takes their place
    mooring : that it was solved for
    check : called now and then while the result is read; what it raises ends that

    Raises
    ------
    OSError
        A file cannot be written, or there is no room for a temporary one as large as the result
        is without compression.
    UsageError
        The result cannot be read.
    """
    with stored_result(result) as stored:
        summary = summarize(stored, mooring, result.parent, check, result)
    document, page = summary_paths(result)
    put(document, to_json([summary_document(summary)]).encode())
    put(page, summary_html(summary).encode())
    return summary


def summary_paths(result: Path) -> tuple[Path, Path]:
    """Where the summary of a result stands: its JSON and its page."""
    return result.with_suffix(".summary.json"), result.with_suffix(".summary.html")
