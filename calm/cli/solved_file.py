"""Outcome of `calm run` for one file: table, JSON, pages and pictures."""

from __future__ import annotations

import sys
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial
from itertools import zip_longest
from pathlib import Path
from typing import TYPE_CHECKING, Any

from calm.cli.outputs import ExitCode, narrate, narrate_card
from calm.errors import NoEquilibrium

if TYPE_CHECKING:
    from calm.case import Design, Result
    from calm.case.explain import Explanation
    from calm.case.uncertain import Uncertain
    from calm.cli.outputs import TerminalPart
    from calm.drawing.schematic.in_terminal import TerminalSchematic


@dataclass(frozen=True)
class FileOutcome:
    """Outcome for one file: a result, or the reason why the file has no result."""

    file: Path
    name: str
    result: Result | None = None
    failure: NoEquilibrium | None = None
    explanation: Explanation | None = None
    schematic: tuple[TerminalSchematic, ...] = ()
    uncertain: Uncertain | None = None
    verbose: bool = False

    @property
    def code(self) -> ExitCode:
        """Exit code for this file alone."""
        return ExitCode.NO_EQUILIBRIUM if self.failure else ExitCode.DONE

    def document(self) -> dict[str, Any]:
        """Return the JSON object of the result or of the failure."""
        if self.failure:
            return {"name": self.name, **self.failure.to_dict()}
        assert self.result is not None
        document = self.result.to_dict()
        if self.explanation is not None:
            document["explain"] = self.explanation.to_dict()
        if self.uncertain is not None:
            document["uncertainty"] = self.uncertain.to_dict()
        return document

    def parts(self) -> list[TerminalPart]:
        """Return the table of the line with, if requested, its schematic, explanation and
        uncertainty.
        """
        parts: list[TerminalPart] = [*self.schematic]
        if self.result is not None:
            from calm.report.explanation import line_facts
            from calm.report.sheet import result_part

            facts = line_facts(self.result)
            parts.append(result_part(self.result, facts, verbose=self.verbose))
        if self.explanation is not None:
            from calm.report.explanation import explanation_part

            parts.append(explanation_part(self.explanation))
        if self.uncertain is not None:
            from calm.report.result_report import uncertainty_part

            parts.append(uncertainty_part(self.uncertain))
        return parts

    def rendered(self, suffix: str) -> bytes | None:
        """Return the drawing, report or dataset of the line, as the content of a file with the
        given suffix.
        """
        if self.result is None:
            return None
        if suffix in (".html", ".pdf"):
            from calm.report.result_report import result_report

            report = result_report(self.result, self.uncertain)
            if suffix == ".pdf":
                from calm.report.folder import printed

                return printed(report)
            from calm.report.html import page

            return page(report).encode("utf-8", "replace")
        if suffix == ".nc":
            from calm.report.result_files import result_netcdf

            return result_netcdf(self.result)
        from calm.drawing.line_drawing import line_drawing
        from calm.drawing.picture import image

        return image(line_drawing(self.result, self.uncertain), suffix)


def solve_files(
    files: Sequence[Path],
    lines: Sequence[Design],
    *,
    explain: bool = False,
    schematic: bool = False,
    draws: tuple[int, int] | None = None,
    verbose: bool = False,
) -> list[FileOutcome]:
    """Solve the designs read from files.

    Parameters
    ----------
    explain, schematic : whether to explain each result, and to draw each line for the terminal
    draws : number of samples and seed for the uncertainty; None without uncertainty
    """
    drawn_often = None if draws is None else _uncertainty_solver(*draws)
    outcomes = []
    for file, line in zip(files, lines, strict=True):
        if (card := line.file.environment.current.card) is not None:
            narrate_card(card)
        result, failure = _solved(file, line)
        outcomes.append(FileOutcome(
            file, line.file.name, result, failure, verbose=verbose,
            explanation=_explained(result) if result and explain else None,
            schematic=_schematic(line, result) if schematic else (),
            uncertain=drawn_often(result) if result and drawn_often else None,
        ))  # fmt: skip
    return outcomes


def _solved(file: Path, line: Design) -> tuple[Result | None, NoEquilibrium | None]:
    try:
        return line.solve(), None
    except NoEquilibrium as failure:
        for notice in line.file.notices:  # with a result, its warnings include these notices
            narrate(f"{file}: {notice}")
        narrate(f"{file}: {failure}")
        return None, failure


def _explained(result: Result) -> Explanation:
    from calm.case.explain import explain

    return explain(result)


def _uncertainty_solver(samples: int, seed: int) -> Callable[[Result], Uncertain]:
    from calm.case.draws import normals_of
    from calm.case.uncertain import uncertain
    from calm.cli.progress import begun, mapped

    # loading scipy takes as long as loading the compiled march, so another process starts at once
    normals = begun(normals_of, samples, seed)
    solved = partial(mapped, workers=None, what="blocks of samples solved")
    return lambda result: uncertain(result, samples, seed, solved, normals)


def _schematic(line: Design, result: Result | None) -> tuple[TerminalSchematic, ...]:
    from calm.drawing.schematic.in_terminal import TerminalSchematic, can_carry

    plain = not can_carry(getattr(sys.stdout, "encoding", None))
    pairs = zip_longest(line.legs, [] if result is None else result.legs)
    return tuple(TerminalSchematic(of.file, one, plain) for of, one in pairs)
