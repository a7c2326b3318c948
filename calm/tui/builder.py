"""Main screen of the builder, with the commands that open the other screens."""

from functools import partial
from typing import Any

from textual import on
from textual.events import DescendantFocus, Key

from calm.files.components import KINDS
from calm.files.reader import MooringKeys
from calm.shipped import TEMPLATES, Template, template
from calm.tui.catalogue_pane import Purpose
from calm.tui.cell_editor import CellEditor
from calm.tui.comparing import ComparingScreen
from calm.tui.component_screen import Defined
from calm.tui.dialogs import Question, ask, choose, numbered
from calm.tui.forms import values_of, written
from calm.tui.key_table import bindings, hints
from calm.tui.mooring_sheet import (
    PENDING,
    figures_sheet,
    missing_figures,
    part_of_row,
    settings,
    sheet_of,
    with_figures,
)
from calm.tui.pictures import Picture, Tab
from calm.tui.screen import KeyBar
from calm.tui.verdict_pane import VerdictPane

_MOST_STEPS = 9
"""Maximum number of history steps in the list."""


class BuilderScreen(ComparingScreen):
    """Main screen with the line, and with the commands that open all other screens."""

    BINDINGS = bindings("anywhere")

    def on_resize(self) -> None:
        self.show_title()

    def on_mount(self) -> None:
        self.line.show_rows()
        self.line.table.focus()

    def on_key(self, event: Key) -> None:
        if not self.line.editor.is_open:
            self.tell("")

    @on(DescendantFocus)
    def show_keys(self) -> None:
        """Show the keys of the focused widget in the key bar."""
        places: dict[Any, str] = {CellEditor: "cell", VerdictPane: "verdict", Picture: "anywhere"}
        place = places.get(type(self.focused), "line")
        if self.focused is not None and self.catalogue in self.focused.ancestors_with_self:
            place = "catalogue"
        self.query_one(KeyBar).show_keys(hints(place), beside_message=place == "catalogue")

    def action_suspend(self) -> None:
        if self.is_typing or self.app.is_web or self.app.is_headless:
            self.action_undo()
        else:
            self.app.action_suspend_process()

    def action_picture(self, tab: Tab) -> None:
        self.pictures.tab = tab

    def action_zoom(self) -> None:
        self.remove_class("-searching")
        self.toggle_class("-zoomed")
        is_zoomed = self.has_class("-zoomed")
        (self.query_one(Picture) if is_zoomed else self.line.table).focus()

    def action_next_environment(self) -> None:
        choice = self.session.choice
        if len(choice.environments) == 1:
            self.tell("The file has one environment; add others on the water screen (w)")
            return
        choice.environment = name = choice.next_environment
        self.show_draft()
        which = f"environment {name}" if name else "default environment"
        self.tell(f"The line is shown in the {which}")
        self.workspace.edited()

    def action_verdict(self) -> None:
        self.remove_class("-zoomed", "-searching")
        self.add_class("-reading")
        self.verdict.focus()

    def action_figures(self) -> None:
        session = self.session
        if not self.settle():
            return
        view = self.workspace.judged("Missing values can be listed once the line has been checked")
        if view is None:
            return
        missing = missing_figures(view, session.draft)

        def take(texts: dict[str, str]) -> None:
            source = texts.pop("source", "")
            figures = {key: text for key, text in texts.items() if text}
            if figures:
                count = f"{len(figures)} value{'s' * (len(figures) != 1)} filled in"
                self.line.attempt(
                    lambda: session.do(
                        with_figures(session.draft, missing, figures, source), "fill in values"
                    ),
                    count,
                )

        if missing:
            ask(self.app, figures_sheet(missing, complete=view.complete), take)
        elif view.complete or view.result is None:
            self.tell("All component values are present")
        else:
            self.tell(f"All component values are present so far. {PENDING}")

    def action_begin(self) -> None:
        session = self.session
        if session.draft.items:
            self.tell("The line is not empty; templates are for new files")
            return

        def begin(kind: Template) -> None:
            self.line.attempt(lambda: session.write(template(kind), f"begin with {kind}"))

        answers = numbered(
            (f"{kind}: {meaning}", partial(begin, kind)) for kind, meaning in TEMPLATES.items()
        )
        text = "Each template has an equilibrium. Adapt depth, current and pieces."
        choose(self.app, Question("Begin with", text, answers))

    def action_history(self) -> None:
        steps = self.session.history
        if not self.settle():
            return
        if not steps.steps:
            self.tell("No changes to undo yet")
            return

        def undo(count: int) -> None:
            self._go("undone", lambda: [steps.undo() for _ in range(count)][-1])

        answers = numbered(
            (f"before: {label}", partial(undo, number))
            for number, label in enumerate(steps.steps[:_MOST_STEPS], 1)
        )
        text = f"Go back to the state before one of the last {len(answers)} changes."
        text += " U redoes an undone change."
        if (more := len(steps.steps) - _MOST_STEPS) > 0:
            text += f" Older changes, not listed: {more}; u undoes one change at a time."
        choose(self.app, Question("Changes", text, answers))

    def action_search(self, purpose: Purpose) -> None:
        self.search(purpose)

    def action_define(self) -> None:
        from calm.tui.component_screen import ComponentScreen

        index, session = self.workspace.index, self.session

        def take(defined: Defined) -> None:
            id, values = defined[0], values_of(defined[1])
            if self.line.attempt(
                lambda: session.do(session.draft.put_component(id, values), f"define {id}"),
                f"{id} is defined in the file and listed in the catalogue",
            ):
                self.search("below")
                self.catalogue.search.value = id

        listed = () if index is None else tuple(index.catalogue.ids())
        ask(self.app, ComponentScreen(listed, session.components), take)

    def action_change_component(self) -> None:
        from calm.tui.component_screen import ComponentScreen

        spot, session = self.line.table.spot, self.session
        if spot is None or not self.settle():
            return
        id = session.item(spot).values["use"]
        values = session.components.get(id)
        if not isinstance(values, dict) or values.get("kind") not in KINDS:
            what = "is an assembly: change it in the text (t)" if id in session.components else (
                "is not defined in this file: edit the keys of this row in the text (t), or define "
                "a component in this file (o)"
            )  # fmt: skip
            self.tell(f"{id} {what}")
            return

        def take(defined: Defined) -> None:
            place = "components", id
            # keys without a field in the form are kept
            self.line.attempt(
                lambda: session.do(written(session.draft, defined[1], place), f"change {id}")
            )

        ask(self.app, ComponentScreen(begun=(id, values)), take)

    def action_water(self) -> None:
        from calm.tui.water_screen import WaterScreen

        self.app.push_screen(WaterScreen(self.workspace), self._back)

    def action_text(self) -> None:
        from calm.tui.text_screen import TextScreen

        spot, session = self.line.table.spot, self.session
        line = 1
        if spot is not None and spot in session.spots():  # invalid text has no rows
            line = session.item(spot).line
        self.app.push_screen(TextScreen(self.workspace, line), self._back)

    def _back(self, _: None) -> None:
        self.show_draft()
        self.tell("")
        self.workspace.edited()

    def action_sheet(self, name: str) -> None:
        session, view = self.session, self.workspace.view if self.workspace.is_fresh else None
        part = part_of_row(None if view is None else view.file, self.line.table.spot)
        sheet, label, changed = sheet_of(name, session.draft, part)

        def take(texts: dict[str, str]) -> None:
            self.line.attempt(lambda: session.do(changed(session.draft, texts), label))

        ask(self.app, sheet, take)

    def action_settings(self) -> None:
        models = MooringKeys.model_fields
        answers = numbered(
            (f"{name}: {models[name].description}", partial(self.action_sheet, name))
            for name in settings()
        )
        choose(self.app, Question("Settings", "Forms of the file's other sections.", answers))
