"""Where the results of a command go: the standard output, and the files that were asked for."""

from __future__ import annotations

import os
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from calm.cli.exit_codes import ExitCode
from calm.cli.streams import narrate, show, show_rich
from calm.errors import NoEquilibrium, UsageError

if TYPE_CHECKING:
    from calm.case import Result

_STDOUT = Path("-")


@dataclass(frozen=True)
class Outcome:
    """What became of one mooring file: a result, or the reason why there is none."""

    file: Path
    name: str
    result: Result | None = None
    failure: NoEquilibrium | None = None

    @property
    def code(self) -> ExitCode:
        """The exit code of this mooring alone."""
        return ExitCode.NO_EQUILIBRIUM if self.failure else ExitCode.DONE

    @property
    def document(self) -> dict[str, Any]:
        """The JSON object of this mooring."""
        from calm.report.document import failure_document

        if self.failure:
            return failure_document(self.name, self.failure)
        assert self.result is not None
        return self.result.to_dict()


@dataclass(frozen=True)
class Outputs:
    """The outputs asked for: a path each, ``-`` for the standard output, None where not asked.

    Parameters
    ----------
    files : tuple of Path
        The mooring files the outputs are made from.
    json, csv, plot : Path or None
        One JSON document, one CSV table; a picture for each file.
    """

    files: tuple[Path, ...]
    json: Path | None
    csv: Path | None
    plot: Path | None

    @property
    def plots(self) -> tuple[Path, ...]:
        """The picture of each file; where there are several, with the file's name added."""
        if self.plot is None:
            return ()
        if len(self.files) == 1:
            return (self.plot,)
        plot = self.plot
        return tuple(plot.with_stem(f"{plot.stem}-{file.stem}") for file in self.files)

    def check(self) -> None:
        """Refuse outputs that could not be written, before anything is solved.

        Raises
        ------
        UsageError
            A path that cannot be written, that another output or a mooring file has already, or
            that looks like an option; a picture of an unknown format.
        """
        from calm.report.write import check_destination

        asked = [path for path in (self.json, self.csv, *self.plots) if path is not None]
        for path in asked:
            if str(path).startswith("-") and path != _STDOUT:
                raise UsageError(f"{path} stands where a path is needed; write ./{path} for a file")
        if self.plot is not None:
            from calm.report.plot import check_format

            check_format(self.plot)
        mooring_files = set(map(os.path.realpath, self.files))
        for real, count in Counter(map(os.path.realpath, asked)).items():
            if count > 1:
                raise UsageError(f"two outputs would go to {os.path.relpath(real)}")
            if real in mooring_files:
                raise UsageError(f"{os.path.relpath(real)} is a mooring file; it is kept")
        for path in asked:
            if path != _STDOUT:
                check_destination(path)

    def write(self, outcomes: Sequence[Outcome]) -> None:
        """Write the files, then the standard output: what was asked for there, or the tables.

        Raises
        ------
        UsageError
            The system refuses to write.
        """
        from calm.report.write import write_file

        results = [outcome.result for outcome in outcomes if outcome.result is not None]
        texts: dict[Path, str] = {}
        if self.json is not None:
            from calm.report.document import to_json

            texts[self.json] = to_json([outcome.document for outcome in outcomes])
        if self.csv is not None:
            from calm.report.csv import to_csv

            texts[self.csv] = to_csv(results)
        for path, text in texts.items():
            if path != _STDOUT:
                write_file(path, text.encode("utf-8", "replace"))
        for path, outcome in zip(self.plots, outcomes, strict=False):
            if outcome.result is not None:
                from calm.report.plot import picture

                write_file(path, picture(outcome.result, path.suffix))
        if _STDOUT in texts:
            show(texts[_STDOUT])
        else:
            from calm.report.table import result_table

            show_rich(*map(result_table, results))
        if self.csv == _STDOUT:
            _narrate_warnings(outcomes)


def _narrate_warnings(outcomes: Sequence[Outcome]) -> None:
    """Tell what neither a CSV table nor an exit code can."""
    for outcome in outcomes:
        for warning in outcome.result.warnings if outcome.result else ():
            narrate(f"{outcome.file}: {warning}")
