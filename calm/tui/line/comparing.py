"""What is worked out beside the line: advice that is tried, comparisons, its papers."""

from __future__ import annotations

import subprocess
import sys
from difflib import unified_diff
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

from calm.errors import CalmError
from calm.files.editing import Draft, WorkingFile
from calm.tui.checking import needed
from calm.tui.dialogs import Answer, Asked, InputSheet, LongText, Question, ask, choose
from calm.tui.line.line_pane import LinePane
from calm.tui.pictures import Pictures

if TYPE_CHECKING:
    from rich.console import RenderableType

    from calm.case import Mooring, Result
    from calm.case.net import Net
    from calm.case.result import NetResult
    from calm.tui.advice import Offer
    from calm.tui.live import View

_MOST_LINES = 24


def compare_with_saved(pane: LinePane, pictures: Pictures) -> None:
    """Judge what was saved in a thread, and show the differences."""
    if not pane.settle():
        return
    session = pane.workspace.session
    if session.changed:
        _judge_beside(pane, pictures, session.history.saved_text, None)
    else:
        pictures.put_beside(None)
        pane.workspace.tell("Nothing has changed since it was saved")


def compare_with_file(pane: LinePane, pictures: Pictures) -> None:
    """Ask for another file; draw its line beside this one, and show the differences."""
    if not pane.settle():
        return

    def take(texts: dict[str, str]) -> None:
        if not texts["file"]:
            pictures.put_beside(None)
            return
        try:
            text = WorkingFile(Path(texts["file"])).read()
        except (CalmError, OSError) as error:
            pane.workspace.tell(str(error), wrong=True)
        else:
            _judge_beside(pane, pictures, text, Path(texts["file"]))

    asked = [Asked("file", "File", placeholder="e.g. other.yaml")]
    text = "Its line is drawn dashed beside this one; no name takes it away again."
    ask(pane.app, InputSheet("Compare with another file", text, asked), take)


def _judge_beside(pane: LinePane, pictures: Pictures, text: str, file: Path | None) -> None:
    """Judge a text beside the line's: of another file, or of its own as it was saved."""
    view = pane.workspace.view
    if view is None or not pane.workspace.is_fresh:
        pane.workspace.tell("The line is still being judged; ask again")
        return
    catalogs = pane.workspace.session.catalogs
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
        pane.call_later(_show_beside, pane, pictures, name, before, lines)

    pane.workspace.tell("Comparing …")
    pane.run_worker(work, thread=True, group="advice", exclusive=True)


def _show_beside(
    pane: LinePane, pictures: Pictures, name: str, before: View, lines: list[str]
) -> None:
    pane.workspace.tell("")
    view = pane.workspace.view
    shape = getattr(before.result, "shape", None)  # a net has one for each leg
    if shape is not None and view and type(before.result) is type(view.result):
        pictures.put_beside((name, shape))
    answers = [Answer("b", "back to the line")]
    choose(pane.app, Question(f"Beside {name}", "\n".join(lines), answers))


def changed_lines(before: str, after: str) -> list[str]:
    """The lines that were taken out (``-``) and put in (``+``), the first of many."""
    diff = unified_diff(before.splitlines(), after.splitlines(), n=0, lineterm="")
    lines = [line for line in diff if not line.startswith(("---", "+++", "@@"))]
    more = len(lines) - _MOST_LINES
    return lines[:_MOST_LINES] + ([f"and {more} lines more"] if more > 0 else [])


_COMMANDS = {"report": ("check", "--report"), "deck": ("deck", "--output")}
"""What writes each, and its option of where."""


def offer_papers(pane: LinePane) -> None:
    """Show the bill, or have report and sheets written of the file as it is saved."""
    from calm.case import TowResult

    view = pane.workspace.view
    if not pane.settle():
        return
    result = None if view is None else view.result
    if not pane.workspace.is_fresh or result is None or isinstance(result, TowResult):
        pane.workspace.tell("Reports and sheets need a mooring that stands")
        return

    def bill() -> None:
        pane.app.push_screen(LongText(_bill(result), wide=True))

    report, deck = (partial(_ask_where, pane, what) for what in _COMMANDS)
    answers = [
        Answer("b", "bill and totals: pieces, cut lengths, masses, weights, buoyancy", bill),
        Answer("r", "report of the design check: page, PDF, tables", report),
        Answer("d", "sheets for the deck: diagram, logs, cutting list, anchor drop", deck),
    ]
    choose(pane.app, Question("On paper", "", answers))


def _ask_where(pane: LinePane, what: str) -> None:
    session, path = pane.workspace.session, pane.workspace.session.file.path
    if path is None or session.changed:
        pane.workspace.tell("Save the file first: reports are made from the saved file")
        return

    def take(texts: dict[str, str]) -> None:
        _write(pane, what, path, Path(texts["folder"]).expanduser())

    folder = path.with_name(f"{path.stem}-{what}")
    asked = [Asked("folder", "Folder", str(folder), needed("a folder"))]
    ask(pane.app, InputSheet("Where to write it", "", asked), take)


def _write(pane: LinePane, what: str, path: Path, folder: Path) -> None:
    """Have the command write it; what it says last is reported."""
    command, option = _COMMANDS[what]
    words = [sys.executable, "-m", "calm", command, str(path), option, str(folder)]
    for catalog in pane.workspace.session.catalogs:
        words += ["--catalog", str(catalog)]
    later, tell = pane.call_later, pane.workspace.tell

    def work() -> None:
        done = subprocess.run(
            words, stdin=subprocess.DEVNULL, capture_output=True, text=True, errors="replace"
        )
        said = [line for line in done.stderr.splitlines() if line.strip()]
        later(tell, said[-1] if said else f"written to {folder}", wrong=done.returncode > 1)

    tell(f"Writing {folder} …")
    pane.run_worker(work, thread=True, group="papers", exit_on_error=False)


def _bill(result: Result | NetResult) -> RenderableType:
    from calm.case.result import legs_of
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


def offer_advice(pane: LinePane) -> None:
    """Ask which of the changes that would help is wanted."""
    from calm.case import Result, TowResult
    from calm.tui.advice import offers

    workspace, view = pane.workspace, pane.workspace.view
    if not pane.settle():
        return
    if view is None or not workspace.is_fresh:
        workspace.tell("Advice is available once the line is solved")
        return
    catalogue = None if workspace.index is None else workspace.index.catalogue
    found = offers(view, catalogue)[:9]
    answers = [
        Answer(str(number), offer.title, partial(_try, pane, offer, view))
        for number, offer in enumerate(found, 1)
    ]
    result = view.result
    if result is not None and not isinstance(result, TowResult):
        other = partial(_ask_for_target, pane, view, result.mooring)
        answers.append(Answer("o", "another target, as in `calm size`", other))
    text = "What it changes is shown before it is taken."
    if not found:
        text = "No finding has a remedy that can be computed here. " + text
    if isinstance(result, Result) and not view.complete:
        text += " Launch, recovery, breaks and waves are still being judged."
    choose(pane.app, Question("Advice", text, answers))


def _ask_for_target(pane: LinePane, view: View, mooring: Mooring | Net) -> None:
    from calm.tui.advice import sized

    def take(texts: dict[str, str]) -> None:
        try:
            offer = sized(mooring, texts["target"], texts["change"])
        except CalmError as error:
            pane.workspace.tell(str(error).replace("\n", " "), wrong=True)
        else:
            _try(pane, offer, view)

    row = pane.table.row
    label = "top float" if row is None else row.texts.get("label") or row.texts["component"]
    asked = [
        Asked("target", "Target", "knockdown(top) <= 20 m", needed("a target")),
        Asked("change", "Change", f"{label.strip('├ ')}.buoyancy", needed("a change")),
    ]
    text = "LABEL.buoyancy, LABEL.length or LABEL.count; depth(LABEL) = 100 m, tilt(LABEL) …"
    ask(pane.app, InputSheet("A target to meet", text, asked), take)


def _try(pane: LinePane, offer: Offer, before: View) -> None:
    """Work the change out in a thread, and what it would do."""
    pane.workspace.tell(f"Working out {offer.label} …")
    later, draft = pane.call_later, pane.workspace.session.draft
    catalogs = pane.workspace.session.catalogs

    def work() -> None:
        from calm.tui.advice import differences
        from calm.tui.live import judge, judge_fully

        try:
            made = offer.make(draft)
        except CalmError as error:
            later(pane.workspace.tell, str(error), wrong=True)
            return
        path, environment = before.path, before.environment
        view = judge(made.text, path, environment, catalogs, keep=before)
        lines = differences(judge_fully(before, catalogs), judge_fully(view, catalogs))
        later(_show_effect, pane, offer, draft, made, lines)

    pane.run_worker(work, thread=True, group="advice", exclusive=True)


def _show_effect(
    pane: LinePane, offer: Offer, before: Draft, made: Draft, lines: list[str]
) -> None:
    session = pane.workspace.session

    def take() -> None:
        if session.draft is before:
            pane.attempt(lambda: session.do(made, offer.label), f"{offer.label}: taken")
        else:
            pane.workspace.tell("The line has changed meanwhile; ask again", wrong=True)

    pane.workspace.tell("")
    back = partial(pane.workspace.tell, "Not taken")
    answers = [Answer("y", "take it", take)]
    choose(pane.app, Question(offer.title, "\n".join(lines), answers, back=back))
