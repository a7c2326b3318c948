"""Advice taken by key: what mends the findings is offered, tried, shown, and then taken."""

from __future__ import annotations

from typing import TYPE_CHECKING

from calm.errors import CalmError
from calm.tui.checking import needed
from calm.tui.dialogs import Answer, Asked, InputSheet, Question
from calm.tui.line.line_pane import LinePane

if TYPE_CHECKING:
    from calm.case import Mooring
    from calm.files.editing import Draft
    from calm.tui.advice import Offer
    from calm.tui.live import View

_OTHER = "another"


class Advising:
    """Asks which change is wanted, and puts it into the line once its effect was seen."""

    def __init__(self, line: LinePane) -> None:
        self._line, self._workspace = line, line.workspace

    def offer(self) -> None:
        """Ask which of the changes that would help is wanted."""
        from calm.case import Result
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
            Answer(str(number), offer.title, str(number)) for number, offer in enumerate(found, 1)
        ]
        result = view.result
        if isinstance(result, Result):
            answers.append(Answer("o", "another target, as in `calm size`", _OTHER))

        def take(answer: str | None) -> None:
            if answer == _OTHER and isinstance(result, Result):
                self._ask_for_target(view, result.mooring)
            elif answer is not None:
                self._try(found[int(answer) - 1], view)

        text = "What it changes is shown before it is taken."
        if not found:
            text = "No finding has a remedy that can be computed here. " + text
        if isinstance(result, Result) and not view.complete:
            text += " Launch, recovery, breaks and waves are still being judged."
        self._line.app.push_screen(Question("Advice", text, answers), take)

    def _ask_for_target(self, view: View, mooring: Mooring) -> None:
        from calm.tui.advice import sized

        def take(texts: dict[str, str] | None) -> None:
            if texts is None:
                return
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
        self._line.app.push_screen(InputSheet("A target to meet", text, asked), take)

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

        def take(answer: str | None) -> None:
            if answer is None:
                self._workspace.tell("Not taken")
            elif session.draft is before:
                self._line.attempt(lambda: session.do(made, offer.label), f"{offer.label}: taken")
            else:
                self._workspace.tell("The line has changed meanwhile; ask again", wrong=True)

        self._workspace.tell("")
        answers = [Answer("y", "take it", "take")]
        self._line.app.push_screen(Question(offer.title, "\n".join(lines), answers), take)
