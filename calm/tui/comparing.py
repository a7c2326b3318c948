"""Commands of the main screen for comparison, advice, and documents."""

from __future__ import annotations

import subprocess
import sys
from difflib import unified_diff
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

from calm.errors import CalmError
from calm.files.editing import Draft
from calm.tui import checking, line_screen
from calm.tui.dialogs import Answer, LongText, Question, choose, enter, numbered
from calm.tui.forms import FormField
from calm.tui.mooring_sheet import PENDING

if TYPE_CHECKING:
    from rich.console import RenderableType

    from calm.case import Design, Result
    from calm.tui.advice import Offer
    from calm.tui.live import View

_MOST_LINES = 24
_MOST_OFFERS = 9
_DOCUMENTS = {"report": ("check", "--report"), "deck": ("deck", "--output")}
"""Command, and its option for the output folder, for each kind of document."""


class ComparingScreen(line_screen.LineScreen):
    """Main screen with the commands for comparison, advice, and documents.

    Slow work runs in a thread; a dialog or a message shows the result.
    """

    def action_compare(self) -> None:
        if not self.settle():
            return
        if not self.session.changed:
            self.pictures.overlay(None)
            self.tell("There are no changes since the file was saved")
            return
        view = self.workspace.judged("Checks are still running; try again in a moment")
        if view is None:
            return
        text, catalogs = self.session.history.saved_text, self.session.catalogs

        def work() -> None:
            from calm.tui.live import judge

            before = judge(text, view.path, view.environment, catalogs, keep=view)
            effects = self._effects(before, view)
            self.call_later(show, before, [*effects, "", *changed_lines(text, view.text)])

        def show(before: View, lines: list[str]) -> None:
            self.workspace.tell("")
            now = self.workspace.view
            shape = getattr(before.result, "shape", None)  # a net has one shape for each leg
            if shape is not None and now and type(before.result) is type(now.result):
                self.pictures.overlay(shape)
            answers = [Answer("b", "back to the line")]
            choose(self.app, Question("Compared with the saved file", "\n".join(lines), answers))

        self.tell("Comparing …")
        self.run_worker(work, thread=True, group="advice", exclusive=True)

    def _effects(self, before: View, after: View) -> list[str]:
        # called in a thread, since the full check is slow
        from calm.tui.advice import differences
        from calm.tui.live import judge_fully

        catalogs = self.session.catalogs
        return differences(judge_fully(before, catalogs), judge_fully(after, catalogs))

    # advice

    def action_advise(self) -> None:
        from calm.tui.advice import offers, single

        if not self.settle():
            return
        view = self.workspace.judged("Advice is available once the line is solved")
        if view is None:
            return
        index, catalogs = self.workspace.index, self.session.catalogs

        def work() -> None:
            from calm.files import Catalogue

            try:
                catalogue = Catalogue.load(catalogs) if index is None else index.catalogue
                found = offers(view, catalogue, catalogs)[:_MOST_OFFERS]
            except CalmError as error:
                self.call_later(self.workspace.tell, str(error), wrong=True)
            else:
                self.call_later(show, found)

        def show(found: list[Offer]) -> None:
            self.workspace.tell("")
            answers = numbered(
                (offer.title, partial(self._preview, offer, view)) for offer in found
            )
            if view.result is not None and not view.result.towed:
                other = partial(self._ask_for_target, view, view.result.design)
                answers.append(Answer("o", "another target, as in `calm size`", other))
            text = "Changes are shown before you accept them."
            if not found:
                text = "No automatic remedy is available for these findings. " + text
            if single(view) is not None and not view.complete and view.anchored:
                text += f" {PENDING}"
            choose(self.app, Question("Advice", text, answers))

        self.tell("Looking for remedies …")
        self.run_worker(work, thread=True, group="advice", exclusive=True)

    def _ask_for_target(self, view: View, mooring: Design) -> None:
        from calm.tui.advice import sized

        def take(texts: dict[str, str]) -> None:
            try:
                offer = sized(mooring, texts["target"], texts["change"])
            except CalmError as error:
                self.tell(str(error).replace("\n", " "), wrong=True)
            else:
                self._preview(offer, view)

        row = self.line.table.row
        label = "top float" if row is None else row.texts.get("label") or row.texts["component"]
        fields = [
            FormField("target", "Target", "knockdown(top) <= 20 m", checking.needed("a target")),
            FormField(
                "change", "Change", f"{label.strip('├ ')}.buoyancy", checking.needed("a change")
            ),
        ]
        text = (
            "A target is written like depth(LABEL) = 100 m or tilt(LABEL) <= 5 deg; a change is "
            "LABEL.buoyancy, LABEL.length or LABEL.count."
        )
        enter(self.app, "A target to meet", text, fields, take)

    def _preview(self, offer: Offer, before: View) -> None:
        session, draft = self.session, self.session.draft

        def work() -> None:
            from calm.tui.live import judge

            path, environment, catalogs = before.path, before.environment, session.catalogs
            try:
                made = offer.make(draft)
            except CalmError as error:
                self.call_later(self.workspace.tell, str(error), wrong=True)
            else:
                view = judge(made.text, path, environment, catalogs, keep=before)
                self.call_later(show, made, self._effects(before, view))

        def show(made: Draft, lines: list[str]) -> None:
            def take() -> None:
                if session.draft is draft:
                    label = offer.label
                    self.line.attempt(lambda: session.do(made, label), f"{label}: accepted")
                else:
                    self.tell("The line has changed meanwhile; try again", wrong=True)

            self.workspace.tell("")
            answers, back = [Answer("y", "accept", take)], partial(self.tell, "Not accepted")
            choose(self.app, Question(offer.title, "\n".join(lines), answers, back=back))

        self.tell(f"Computing {offer.label} …")
        self.run_worker(work, thread=True, group="advice", exclusive=True)

    # reports and sheets

    def action_documents(self) -> None:
        if not self.settle():
            return
        view = self.workspace.view if self.workspace.is_fresh else None
        result = None if view is None else view.result
        if result is None or result.towed:
            self.tell("Reports and sheets require a mooring with an equilibrium")
            return
        report, deck = (partial(self._ask_where, what) for what in _DOCUMENTS)

        def bill() -> None:
            self.app.push_screen(LongText(_bill(result), wide=True))

        answers = [
            Answer("b", "bill and totals: pieces, cut lengths, masses, weights, buoyancy", bill),
            Answer("r", "report of the design check: page, PDF, tables", report),
            Answer("d", "sheets for the deck: diagram, logs, cutting list, anchor drop", deck),
        ]
        choose(self.app, Question("Documents", "", answers))

    def _ask_where(self, what: str) -> None:
        if self.workspace.documents_elsewhere:
            self.tell(self.workspace.documents_elsewhere)
            return
        path = self.session.file.path
        if path is None or self.session.changed:
            self.tell("Save the file first: documents are made from the saved file")
            return

        folder = path.with_name(f"{path.stem}-{what}")
        fields = [FormField("folder", "Folder", str(folder), checking.needed("a folder"))]
        write = partial(self._write_document, what, path)
        enter(self.app, "Output folder", "", fields, write)

    def _write_document(self, what: str, path: Path, texts: dict[str, str]) -> None:
        folder, (command, option) = Path(texts["folder"]).expanduser(), _DOCUMENTS[what]
        words = [sys.executable, "-m", "calm", command, str(path), option, str(folder)]
        words += [word for each in self.session.catalogs for word in ("--catalog", str(each))]

        def work() -> None:
            done = subprocess.run(
                words, stdin=subprocess.DEVNULL, capture_output=True, text=True, errors="replace"
            )
            lines = [line for line in done.stderr.splitlines() if line.strip()]
            message = lines[-1] if lines else f"written to {folder}"
            self.call_later(self.workspace.tell, message, wrong=done.returncode > 1)

        self.tell(f"Writing {folder} …")
        self.run_worker(work, thread=True, group="documents", exit_on_error=False)


def changed_lines(before: str, after: str) -> list[str]:
    """Return the first lines that differ between two texts.

    Removed lines begin with ``-``, and added lines with ``+``.
    """
    diff = unified_diff(before.splitlines(), after.splitlines(), n=0, lineterm="")
    lines = [line for line in diff if not line.startswith(("---", "+++", "@@"))]
    more = len(lines) - _MOST_LINES
    return lines[:_MOST_LINES] + ([f"and {more} more lines"] if more > 0 else [])


def _bill(result: Result) -> RenderableType:
    from calm.checks.inventory import inventory_of
    from calm.files.pieces import STAND_IN
    from calm.quantities import QUANTITIES
    from calm.report import blocks, terminal
    from calm.report.check_tables import inventory_table

    listed = [item for leg in result.legs for item in inventory_of(leg.leg)]
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
    return terminal.shown(blocks.ReportPart("Bill", (inventory_table(items), blocks.Pairs(totals))))
