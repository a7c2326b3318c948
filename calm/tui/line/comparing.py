"""What is worked out beside the line: advice that is tried, comparisons, its papers."""

from __future__ import annotations

import subprocess
import sys
from difflib import unified_diff
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

from calm.errors import CalmError
from calm.files.editing import WorkingFile
from calm.tui.checking import needed
from calm.tui.dialogs import Answer, Asked, InputSheet, LongText, Question, ask, choose
from calm.tui.line.line_pane import LinePane
from calm.tui.pictures import Pictures

if TYPE_CHECKING:
    from rich.console import RenderableType

    from calm.case import Mooring, Result
    from calm.case.net import Net
    from calm.case.net_result import NetResult
    from calm.files.editing import Draft
    from calm.tui.advice import Offer
    from calm.tui.live import View

_MOST_LINES = 24


class Comparing:
    """Shows what has changed since the file was saved, or what is different in another one."""

    def __init__(self, line: LinePane, pictures: Pictures) -> None:
        self._line, self._pictures, self._workspace = line, pictures, line.workspace

    def with_saved(self) -> None:
        """Judge what was saved in a thread, and show the differences."""
        if not self._line.settle():
            return
        session = self._workspace.session
        if session.changed:
            self._judge(session.history.saved_text, None)
        else:
            self._pictures.put_beside(None)
            self._workspace.tell("Nothing has changed since it was saved")

    def with_file(self) -> None:
        """Ask for another file; draw its line beside this one, and show the differences."""
        if not self._line.settle():
            return

        def take(texts: dict[str, str]) -> None:
            if not texts["file"]:
                self._pictures.put_beside(None)
                return
            try:
                text = WorkingFile(Path(texts["file"])).read()
            except (CalmError, OSError) as error:
                self._workspace.tell(str(error), wrong=True)
            else:
                self._judge(text, Path(texts["file"]))

        asked = [Asked("file", "File", placeholder="e.g. other.yaml")]
        text = "Its line is drawn dashed beside this one; no name takes it away again."
        ask(self._line.app, InputSheet("Compare with another file", text, asked), take)

    def _judge(self, text: str, file: Path | None) -> None:
        """Judge a text beside the line's: of another file, or of its own as it was saved."""
        view = self._workspace.view
        if view is None or not self._workspace.is_fresh:
            self._workspace.tell("The line is still being judged; ask again")
            return
        catalogs = self._workspace.session.catalogs
        name = "what was saved" if file is None else str(file)

        def work() -> None:
            from calm.tui.advice import differences
            from calm.tui.live import judge, judge_fully

            if file is None:
                before = judge(text, view.path, view.environment, catalogs, keep=view)
            else:
                before = judge(text, file, None, catalogs)
            lines = differences(judge_fully(before, catalogs), judge_fully(view, catalogs))
            lines += ["", *changed_lines(text, view.text)]
            self._line.call_later(self._show, name, before, lines)

        self._workspace.tell("Comparing …")
        self._line.run_worker(work, thread=True, group="advice", exclusive=True)

    def _show(self, name: str, before: View, lines: list[str]) -> None:
        self._workspace.tell("")
        view = self._workspace.view
        shape = getattr(before.result, "shape", None)  # a net has one for each leg
        if shape is not None and view and type(before.result) is type(view.result):
            self._pictures.put_beside((name, shape))
        answers = [Answer("b", "back to the line")]
        choose(self._line.app, Question(f"Beside {name}", "\n".join(lines), answers))


def changed_lines(before: str, after: str) -> list[str]:
    """The lines that were taken out (``-``) and put in (``+``), the first of many."""
    diff = unified_diff(before.splitlines(), after.splitlines(), n=0, lineterm="")
    lines = [line for line in diff if not line.startswith(("---", "+++", "@@"))]
    more = len(lines) - _MOST_LINES
    return lines[:_MOST_LINES] + ([f"and {more} lines more"] if more > 0 else [])


_COMMANDS = {"report": ("check", "--report"), "deck": ("deck", "--output")}
"""What writes each, and its option of where."""


class Papers:
    """Shows the bill, and has report and sheets written of the file as it is saved."""

    def __init__(self, line: LinePane) -> None:
        self._line, self._workspace = line, line.workspace

    def offer(self) -> None:
        """Ask what is wanted."""
        from calm.case import TowResult

        view = self._workspace.view
        if not self._line.settle():
            return
        result = None if view is None else view.result
        if not self._workspace.is_fresh or result is None or isinstance(result, TowResult):
            self._workspace.tell("Reports and sheets need a mooring that stands")
            return

        def bill() -> None:
            self._line.app.push_screen(LongText(_bill(result), wide=True))

        report, deck = (partial(self._ask_where, what) for what in _COMMANDS)
        answers = [
            Answer("b", "bill and totals: pieces, cut lengths, masses, weights, buoyancy", bill),
            Answer("r", "report of the design check: page, PDF, tables", report),
            Answer("d", "sheets for the deck: diagram, logs, cutting list, anchor drop", deck),
        ]
        choose(self._line.app, Question("On paper", "", answers))

    def _ask_where(self, what: str) -> None:
        session, path = self._workspace.session, self._workspace.session.file.path
        if path is None or session.changed:
            self._workspace.tell("Save the file first: reports are made from the saved file")
            return

        def take(texts: dict[str, str]) -> None:
            self._write(what, path, Path(texts["folder"]).expanduser())

        folder = path.with_name(f"{path.stem}-{what}")
        asked = [Asked("folder", "Folder", str(folder), needed("a folder"))]
        ask(self._line.app, InputSheet("Where to write it", "", asked), take)

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


def _bill(result: Result | NetResult) -> RenderableType:
    from calm.case.net_result import legs_of
    from calm.checks.inventory import inventory_of
    from calm.files.mooring_file import STAND_IN
    from calm.quantities import QUANTITIES
    from calm.report.blocks import Pairs, ReportPart
    from calm.report.check_tables import inventory_table
    from calm.report.terminal import shown

    listed = [item for leg in legs_of(result) for item in inventory_of(leg.mooring)]
    items = tuple(item for item in listed if item.use != STAND_IN)
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


class Advising:
    """Asks which change is wanted, and puts it into the line once its effect was seen."""

    def __init__(self, line: LinePane) -> None:
        self._line, self._workspace = line, line.workspace

    def offer(self) -> None:
        """Ask which of the changes that would help is wanted."""
        from calm.case import Result, TowResult
        from calm.tui.advice import offers

        workspace, view = self._workspace, self._workspace.view
        if not self._line.settle():
            return
        if view is None or not workspace.is_fresh:
            workspace.tell("Advice is available once the line is solved")
            return
        catalogue = None if workspace.index is None else workspace.index.catalogue
        found = offers(view, catalogue)[:9]
        answers = [
            Answer(str(number), offer.title, partial(self._try, offer, view))
            for number, offer in enumerate(found, 1)
        ]
        result = view.result
        if result is not None and not isinstance(result, TowResult):
            other = partial(self._ask_for_target, view, result.mooring)
            answers.append(Answer("o", "another target, as in `calm size`", other))
        text = "What it changes is shown before it is taken."
        if not found:
            text = "No finding has a remedy that can be computed here. " + text
        if isinstance(result, Result) and not view.complete:
            text += " Launch, recovery, breaks and waves are still being judged."
        choose(self._line.app, Question("Advice", text, answers))

    def _ask_for_target(self, view: View, mooring: Mooring | Net) -> None:
        from calm.tui.advice import sized

        def take(texts: dict[str, str]) -> None:
            try:
                offer = sized(mooring, texts["target"], texts["change"])
            except CalmError as error:
                self._workspace.tell(str(error).replace("\n", " "), wrong=True)
            else:
                self._try(offer, view)

        row = self._line.table.row
        label = "top float" if row is None else row.texts.get("label") or row.texts["component"]
        asked = [
            Asked("target", "Target", "knockdown(top) <= 20 m", needed("a target")),
            Asked("change", "Change", f"{label.strip('├ ')}.buoyancy", needed("a change")),
        ]
        text = "LABEL.buoyancy, LABEL.length or LABEL.count; depth(LABEL) = 100 m, tilt(LABEL) …"
        ask(self._line.app, InputSheet("A target to meet", text, asked), take)

    def _try(self, offer: Offer, before: View) -> None:
        """Work the change out in a thread, and what it would do."""
        self._workspace.tell(f"Working out {offer.label} …")
        later, draft = self._line.call_later, self._workspace.session.draft
        catalogs = self._workspace.session.catalogs

        def work() -> None:
            from calm.tui.advice import differences
            from calm.tui.live import judge, judge_fully

            try:
                made = offer.make(draft)
            except CalmError as error:
                later(self._workspace.tell, str(error), wrong=True)
                return
            path, environment = before.path, before.environment
            view = judge(made.text, path, environment, catalogs, keep=before)
            lines = differences(judge_fully(before, catalogs), judge_fully(view, catalogs))
            later(self._show, offer, draft, made, lines)

        self._line.run_worker(work, thread=True, group="advice", exclusive=True)

    def _show(self, offer: Offer, before: Draft, made: Draft, lines: list[str]) -> None:
        session = self._workspace.session

        def take() -> None:
            if session.draft is before:
                self._line.attempt(lambda: session.do(made, offer.label), f"{offer.label}: taken")
            else:
                self._workspace.tell("The line has changed meanwhile; ask again", wrong=True)

        self._workspace.tell("")
        back = partial(self._workspace.tell, "Not taken")
        answers = [Answer("y", "take it", take)]
        choose(self._line.app, Question(offer.title, "\n".join(lines), answers, back=back))
