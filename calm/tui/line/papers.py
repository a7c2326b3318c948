"""What comes of a line on paper: bill and totals, the report of the check, the deck's sheets."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path
from typing import TYPE_CHECKING, Any

from textual.app import App

from calm.tui.checking import needed
from calm.tui.dialogs import Answer, Asked, InputSheet, LongText, Question
from calm.tui.line.line_pane import LinePane

if TYPE_CHECKING:
    from rich.console import RenderableType

    from calm.case import Result

_COMMANDS = {"report": ("check", "--report"), "deck": ("deck", "--output")}
"""What writes each, and its option of where."""


class Papers:
    """Shows the bill, and has report and sheets written of the file as it is saved."""

    def __init__(self, app: App[Any], line: LinePane) -> None:
        self._app, self._line, self._workspace = app, line, line.workspace

    def offer(self) -> None:
        """Ask what is wanted."""
        from calm.case import Result

        view = self._workspace.view
        if not self._line.settle():
            return
        result = None if view is None else view.result
        if not self._workspace.is_fresh or not isinstance(result, Result):
            self._workspace.tell("Reports and sheets need a mooring that stands")
            return

        def take(answer: str | None) -> None:
            if answer == "bill":
                self._app.push_screen(LongText(_bill(result), wide=True))
            elif answer is not None:
                self._ask_where(answer)

        answers = [
            Answer("b", "bill and totals: pieces, cut lengths, masses, weights, buoyancy", "bill"),
            Answer("r", "report of the design check: page, PDF, tables", "report"),
            Answer("d", "sheets for the deck: diagram, logs, cutting list, anchor drop", "deck"),
        ]
        self._app.push_screen(Question("On paper", "", answers), take)

    def _ask_where(self, what: str) -> None:
        session, path = self._workspace.session, self._workspace.session.file.path
        if path is None or session.changed:
            self._workspace.tell("Save the file first: reports are made from the saved file")
            return

        def take(texts: dict[str, str] | None) -> None:
            if texts is not None:
                self._write(what, path, Path(texts["folder"]).expanduser())

        folder = path.with_name(f"{path.stem}-{what}")
        asked = [Asked("folder", "Folder", str(folder), needed("a folder"))]
        self._app.push_screen(InputSheet("Where to write it", "", asked), take)

    def _write(self, what: str, path: Path, folder: Path) -> None:
        """Have the command write it; what it says last is reported."""
        command, option = _COMMANDS[what]
        words = [sys.executable, "-m", "calm", command, str(path), option, str(folder)]
        for catalog in self._workspace.session.catalogs:
            words += ["--catalog", str(catalog)]
        later, tell = self._line.call_later, self._workspace.tell

        def work() -> None:
            done = subprocess.run(
                words, stdin=subprocess.DEVNULL, capture_output=True, text=True, errors="replace"
            )
            said = [line for line in done.stderr.splitlines() if line.strip()]
            later(tell, said[-1] if said else f"written to {folder}", wrong=done.returncode > 1)

        tell(f"Writing {folder} …")
        self._line.run_worker(work, thread=True, group="papers", exit_on_error=False)


def _bill(result: Result) -> RenderableType:
    from calm.checks.inventory import inventory_of
    from calm.quantities import QUANTITIES
    from calm.report.blocks import Pairs, ReportPart
    from calm.report.check_tables import inventory_table
    from calm.report.terminal import shown

    items = inventory_of(result.mooring)
    lengths = {
        kind: sum(each.cut_length or 0.0 for each in items if each.kind == kind)
        for kind in ("cable", "chain")
    }
    weights = [each.wet_weight for each in items if each.wet_weight is not None]
    say = QUANTITIES
    totals = (
        ("wire and rope", say["length"].say(lengths["cable"])),
        ("chain", say["length"].say(lengths["chain"])),
        ("buoyancy", say["wet_weight"].say(-sum(each for each in weights if each < 0.0))),
        ("weight in water", say["wet_weight"].say(sum(each for each in weights if each > 0.0))),
    )
    return shown(ReportPart("Bill", (inventory_table(items), Pairs(totals))))
