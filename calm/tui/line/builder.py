"""The first screen: the line, its picture, the verdict, and the catalogue when it is wanted."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any, ClassVar

from textual import on
from textual.app import ComposeResult
from textual.binding import BindingType
from textual.containers import Horizontal, Vertical
from textual.events import DescendantFocus, Key

from calm.files import Place
from calm.files.components import KINDS
from calm.files.editing import Draft
from calm.tui import key_table
from calm.tui.catalogue.catalogue_pane import CataloguePane, Purpose
from calm.tui.cell_editor import CellEditor
from calm.tui.dialogs import InputSheet
from calm.tui.key_table import bindings, hints
from calm.tui.line.advising import Advising
from calm.tui.line.comparing import Comparing
from calm.tui.line.line_pane import LinePane
from calm.tui.line.mooring_sheet import (
    as_deployed,
    deployed_sheet,
    document_sheet,
    documented,
    hung_at,
    mooring_sheet,
    tow_sheet,
    written,
)
from calm.tui.line.table import LineTable
from calm.tui.messages import Workspace
from calm.tui.pictures import Picture, Pictures, Tab
from calm.tui.screen import DraftScreen, KeyBar
from calm.tui.session import Location
from calm.tui.verdict_pane import VerdictPane, state_sign, state_word


class BuilderScreen(DraftScreen):
    """The line in the middle, and the ways to all other screens."""

    BINDINGS: ClassVar[list[BindingType]] = [*bindings("anywhere")]
    HORIZONTAL_BREAKPOINTS = [(0, "-narrow"), (112, "-wide"), (176, "-huge")]  # noqa: RUF012
    VERTICAL_BREAKPOINTS = [(0, "-flat"), (17, "-high")]  # noqa: RUF012
    DEFAULT_CSS = """
    BuilderScreen {
        & #body { height: 1fr; }
        & #study { width: 2fr; height: 1fr; border-left: vkey $panel; }
        & #catalogue { width: 2fr; height: 1fr; border-left: vkey $panel; }
        &.-searching #study { display: none; }
        &.-searching #catalogue { display: block; }
        &.-wide.-searching #line-pane { width: 2fr; }
        &.-wide.-searching #catalogue { width: 3fr; }
        &.-huge.-searching #study { display: block; }
        &.-huge #catalogue { width: 1fr; }
        &.-huge #line-pane { width: 2fr; }
        &.-huge #study { width: 1fr; }
        &.-narrow #body { layout: vertical; }
        &.-narrow #line-pane { width: 1fr; height: 13fr; }
        &.-narrow #study {
            width: 1fr; height: 10fr; layout: horizontal; border-left: none;
            border-top: hkey $panel;
        }
        &.-narrow #catalogue {
            width: 1fr; height: 10fr; border-left: none; border-top: hkey $panel;
        }
        &.-narrow Pictures { width: 3fr; }
        &.-narrow VerdictPane { width: 2fr; height: 1fr; max-height: 100%; margin-top: 0; }
        &.-narrow.-flat #study, &.-narrow.-flat #catalogue-title { display: none; }
        &.-narrow.-flat #catalogue { border: none; }
        &.-narrow.-flat.-zoomed #study, &.-narrow.-flat.-reading #study {
            display: block; height: 1fr; border: none;
        }
        &.-narrow.-flat.-reading #line-pane, &.-narrow.-flat.-reading Pictures { display: none; }
        &.-narrow.-flat.-searching #line-pane { display: none; }
        &.-zoomed #line-pane, &.-zoomed VerdictPane { display: none; }
        &.-zoomed #study { display: block; border: none; }
    }
    """

    def __init__(self, workspace: Workspace) -> None:
        super().__init__(workspace)
        self.line = LinePane(workspace)
        self.catalogue = CataloguePane(id="catalogue")
        self.pictures, self.verdict = Pictures(id="pictures"), VerdictPane(id="verdict-pane")

    def parts(self) -> ComposeResult:
        """The line; picture and verdict, in whose place the catalogue may be."""
        with Horizontal(id="body"):
            yield self.line
            yield self.catalogue
            with Vertical(id="study"):
                yield self.pictures
                yield self.verdict

    @property
    def is_typing(self) -> bool:
        """Return whether a value is typed in place that is not in the draft yet."""
        return self.line.editor.is_typing

    def settle(self) -> bool:
        """Take what is typed in a cell; a bad value stays to be corrected."""
        return self.line.settle()

    def show_draft(self) -> None:
        """Show the draft as it is now."""
        self.line.show_draft()
        self._show_beside()
        self.show_title()

    def show_view(self) -> None:
        """Show what a worker made of it; dim what is of an earlier one."""
        if self.workspace.is_fresh or self.workspace.is_old:
            self.line.show_rows()
        self._show_beside()
        self.show_title()

    def show_catalogue(self) -> None:
        """Search the catalogue that was read."""
        self.line.show_rows()
        self._show_beside()

    def _show_beside(self) -> None:
        index = self.workspace.index
        if index is not None and self.catalogue.index is not index:
            self.catalogue.take_index(index)
        self._show_study()

    def _show_study(self) -> None:
        """The picture and the verdict of the last view, dimmed until they are of the draft."""
        view, fresh = self.workspace.view, self.workspace.is_fresh
        last = None if view is None or view.result is not None else self.workspace.good
        if fresh:
            self.pictures.show(last or view, "the last complete line" if last else "")
            note = "The picture shows the last complete line." if last else ""
            self.verdict.show(view, note)
        self.pictures.set_class(self.workspace.is_old or last is not None, "-old")
        self.verdict.set_class(self.workspace.is_old, "-old")

    def titles(self) -> tuple[str, str]:
        """Name, file, what is not saved; environment and verdict."""
        name = " ".join(self.session.draft.text_at(("name",)).split())
        standing, parts = self.session.standing, []
        here = standing.environment
        if here is not None or len(standing.environments) > 1:
            parts.append(f"environment {here}" if here else "own environment")
        is_narrow = self.has_class("-narrow") and not self.has_class("-flat")
        state = state_sign if is_narrow else state_word
        parts.append(state(self.workspace.view, old=not self.workspace.is_fresh))
        return f"{self.workspace.called}  {name}".rstrip(), "   ".join(parts)

    # from the verdict to a row, and back

    @on(VerdictPane.RowWanted)
    def _go_to_row(self, event: VerdictPane.RowWanted) -> None:
        self.remove_class("-reading")
        table = self.line.table
        rows = {row.spot: number for number, row in enumerate(table.rows)}
        numbers = sorted(rows[place] for place in event.places if place in rows)
        if numbers:  # again and again: the next of them
            table.cursor = next((each for each in numbers if each > table.cursor), numbers[0])
            self.workspace.tell(event.text)
            self.line.came_from_verdict = True
        table.focus()

    @on(LinePane.BackWanted)
    def _back_to_verdict(self) -> None:
        self.add_class("-reading")
        self.verdict.focus()

    # components from the catalogue

    @on(LinePane.ComponentWanted)
    def _want_component(self, event: LinePane.ComponentWanted) -> None:
        self.search(event.purpose)

    def search(self, purpose: Purpose) -> None:
        """Search the catalogue for a component for the row under the cursor."""
        self.remove_class("-zoomed")
        self.add_class("-searching")
        spot = self.line.table.spot
        is_on_line = purpose == "clamp" or (
            purpose == "replace" and spot is not None and spot.is_clamp
        )
        target, towed = self._target(purpose), self.session.draft.is_tow
        used = self._used()
        role = self._role(purpose)
        self.catalogue.open(purpose, target, used, role, clampable=is_on_line, towed=towed)

    def _role(self, purpose: Purpose) -> str:
        """Return what is likely wanted there: a float on top, an anchor last, the like."""
        spot, index, items = self.line.table.spot, self.workspace.index, self.session.draft.items
        if spot is None or (purpose == "above" and spot == Place(0)):
            return "" if self.session.draft.is_tow else "float"
        if purpose == "clamp" or index is None:
            return "instrument"
        if purpose == "replace":
            listed = index.get(self.session.item(spot).values.get("use", ""))
            return listed.role if listed else ""
        listed_all = [index.get(item.values.get("use", "")) for item in items]
        roles = {each.role for each in listed_all if each}
        is_last = spot.item == len(items) - 1 and purpose == "below"
        return "anchor" if is_last and "release" in roles and "anchor" not in roles else ""

    def _used(self) -> list[str]:
        """Return what the line uses, from the bottom."""
        items = self.session.draft.items
        parts = [part for item in items for part in (item, *item.clamps)]
        return [part.values.get("use", "") for part in reversed(parts)]

    def _target(self, purpose: Purpose) -> str:
        """Return what the row is called that the component is for."""
        spot = self.line.table.spot
        if spot is None:
            return ""
        values = self.session.item(spot if purpose == "replace" else Place(spot.item)).values
        return values.get("label") or values.get("use", "")

    @on(CataloguePane.Taken)
    def _take_component(self, event: CataloguePane.Taken) -> None:
        spot, values, purpose = self.line.table.spot, event.values, event.purpose
        session, use = self.session, event.values["use"]
        if purpose == "replace" and spot is not None:
            kept: list[str] = []
            if self.line.attempt(lambda: kept.extend(session.replace(spot, values))):
                kept_keys = f"; kept from the one before: {', '.join(kept)}" if kept else ""
                self.workspace.tell(f"now {use}{kept_keys}")
            self._close_catalogue()
            return
        if purpose == "clamp" and spot is not None:
            self.line.attempt(lambda: session.clamp(spot, values), f"{use} clamped on")
        else:
            below = purpose != "above"
            self.line.attempt(lambda: session.insert(spot, values, below=below), f"{use} added")
            if not below:  # the next one comes below it: a line is listed downwards
                self.catalogue.purpose = "below"
        self.catalogue.retitle(self._target(self.catalogue.purpose))

    @on(CataloguePane.Closed)
    def _close_catalogue(self) -> None:
        self.remove_class("-searching")
        self.line.table.focus()

    @on(LineTable.Moved)
    def _retarget(self) -> None:
        if self.has_class("-searching"):
            self.catalogue.retitle(self._target(self.catalogue.purpose))

    def on_resize(self) -> None:
        """The title says as much as there is room for."""
        self.show_title()

    def on_mount(self) -> None:
        """The keys go to the line."""
        self.line.show_rows()
        self.line.table.focus()

    def on_key(self, event: Key) -> None:
        """A key removes the message that is shown."""
        if not self.line.editor.is_open:
            self.tell("")

    @on(DescendantFocus)
    def show_keys(self) -> None:
        """The keys of what has the focus."""
        focused = self.focused
        place: key_table.Place = "line"
        if isinstance(focused, CellEditor):
            place = "cell"
        elif isinstance(focused, VerdictPane):
            place = "verdict"
        elif isinstance(focused, Picture):
            place = "anywhere"
        elif focused is not None and self.catalogue in focused.ancestors_with_self:
            place = "catalogue"
        self.query_one(KeyBar).show_keys(hints(place))

    def action_suspend(self) -> None:
        """Back to the shell; undo where there is none, or a value is typed."""
        if self.is_typing or self.app.is_web or self.app.is_headless:
            self.action_undo()
        else:
            self.app.action_suspend_process()

    def action_picture(self, tab: Tab) -> None:
        """Show another picture."""
        self.pictures.tab = tab

    def action_zoom(self) -> None:
        """Give the picture the screen, or take it back."""
        self.remove_class("-searching")
        self.toggle_class("-zoomed")
        is_zoomed = self.has_class("-zoomed")
        (self.query_one(Picture) if is_zoomed else self.line.table).focus()

    def action_next_environment(self) -> None:
        """Stand the line in the next of its environments."""
        standing = self.session.standing
        if len(standing.environments) == 1:
            self.tell("The file has one environment; add others on the screen of the water (w)")
            return
        standing.environment = name = standing.next_environment
        self.show_draft()
        which = f"environment {name}" if name else "own `environment:`"
        self.tell(f"The line stands in the file's {which}")
        self.workspace.edited()

    def action_advise(self) -> None:
        """Offer changes that mend what was found."""
        Advising(self.line).offer()

    def action_compare(self) -> None:
        """Show what has changed since the file was saved."""
        Comparing(self.line, self.pictures).with_saved()

    def action_compare_file(self) -> None:
        """Show what is different in another file."""
        Comparing(self.line, self.pictures).with_file()

    def action_overlay(self) -> None:
        """Draw the line in all its environments, or in its own alone."""
        shown = self.pictures.overlay()
        self.tell("All environments that are judged are drawn" if shown else "One is drawn alone")

    def action_verdict(self) -> None:
        """The verdict line by line."""
        self.remove_class("-zoomed", "-searching")
        self.add_class("-reading")
        self.verdict.focus()

    def action_figures(self) -> None:
        """Fill in what is not known of the components."""
        from calm.tui.line.missing_figures import Filling

        Filling(self.line).ask()

    def action_papers(self) -> None:
        """Show the bill, or have report and sheets written."""
        from calm.tui.line.comparing import Papers

        Papers(self.line).offer()

    def action_begin(self) -> None:
        """Begin an empty line with a mooring."""
        from calm.templates import TEMPLATES, template
        from calm.tui.line.mooring_sheet import beginning

        session = self.session
        if session.draft.items:
            self.tell("There is a line already; a new file can begin with a mooring")
            return

        def take(answer: str | None) -> None:
            if answer is not None:
                kind = list(TEMPLATES)[int(answer) - 1]
                self.line.attempt(lambda: session.write(template(kind), f"begin with {kind}"))

        self.app.push_screen(beginning(), take)

    def action_history(self) -> None:
        """Show what was done, and go back to before any of it."""
        from calm.tui.line.mooring_sheet import history

        steps = self.session.history
        if not self.settle():
            return
        if not steps.steps:
            self.tell("There is nothing to undo yet")
            return

        def take(answer: str | None) -> None:
            if answer is not None:
                self._go("undone", lambda: [steps.undo() for _ in range(int(answer))][-1])

        self.app.push_screen(history(self.session), take)

    def action_search(self) -> None:
        """Search the catalogue for a piece below."""
        self.search("below")

    def action_define(self) -> None:
        """Define a component of one's own, and put it into the line."""
        from calm.tui.catalogue.component_screen import ComponentScreen

        def take(defined: tuple[str, dict[str, str]] | None) -> None:
            if defined is not None:
                self._put_component(*defined)

        index = self.workspace.index
        listed = () if index is None else tuple(index.catalogue.ids())
        self.app.push_screen(ComponentScreen(listed, self._own), take)

    @on(LinePane.ChangeWanted)
    def _change_component(self, event: LinePane.ChangeWanted) -> None:
        """Change a component of the file in its form; figures that it does not show stay."""
        from calm.tui.catalogue.component_screen import ComponentScreen

        id, session = event.id, self.session
        values = self._own.get(id)
        if not isinstance(values, dict) or values.get("kind") not in KINDS:
            what = "is an assembly: change it in the text (t)" if id in self._own else (
                "is not of this file: what the row says in the text (t) counts for it alone, "
                "o defines one of your own"
            )  # fmt: skip
            self.tell(f"{id} {what}")
            return

        def take(defined: tuple[str, dict[str, str]] | None) -> None:
            if defined is not None:
                changed: dict[Location, str | None] = {
                    ("components", id, key): text or None
                    for key, text in defined[1].items()
                    if text != values.get(key, "")
                }
                self.line.attempt(lambda: session.put_all(changed, f"change {id}"))

        self.app.push_screen(ComponentScreen(begun=(id, values)), take)

    @property
    def _own(self) -> dict[str, Any]:
        """The components that the file defines, as written."""
        defined = self.session.draft.value(("components",))
        return defined if isinstance(defined, dict) else {}

    def action_water(self) -> None:
        """Depth, density, current, wind."""
        from calm.tui.water.water_screen import WaterScreen

        self.app.push_screen(WaterScreen(self.workspace), self._back)

    def action_text(self) -> None:
        """The file as text."""
        from calm.tui.text_screen import TextScreen

        spot, session = self.line.table.spot, self.session
        line = 1
        if spot is not None and spot in session.spots():  # a broken text has no rows
            line = session.item(spot).line
        self.app.push_screen(TextScreen(self.workspace, line), self._back)

    def _back(self, _: None) -> None:
        """Another screen may have changed the draft."""
        self.show_draft()
        self.tell("")
        self.workspace.edited()

    def action_mooring(self) -> None:
        """Ask for name, description and position."""
        self._ask(mooring_sheet(self._draft), "name and place", written)

    def action_document(self) -> None:
        """Ask for what the title block of the drawings says, and what the revision changed."""
        self._ask(document_sheet(self._draft), "the document", documented)

    def action_deployed(self) -> None:
        """Ask when and where the mooring was deployed, and what of it hangs at the row."""
        view = self.workspace.view if self.workspace.is_fresh else None
        hung = hung_at(None if view is None else view.file, self.line.table.spot)

        def deployed(draft: Draft, texts: Mapping[str, str]) -> Draft:
            return as_deployed(draft, hung, texts)

        self._ask(deployed_sheet(self._draft, hung), "the deployment", deployed)

    def action_tow(self) -> None:
        """Ask for speed and course of a tow; a mooring becomes one."""
        self._ask(tow_sheet(self._draft), "the tow", written)

    @property
    def _draft(self) -> Draft:
        return self.session.draft

    def _ask(
        self, sheet: InputSheet, label: str, changed: Callable[[Draft, Mapping[str, str]], Draft]
    ) -> None:
        """Show a sheet, and write what is entered."""
        session = self.session

        def take(texts: dict[str, str] | None) -> None:
            if texts is not None:
                self.line.attempt(lambda: session.do(changed(session.draft, texts), label))

        self.app.push_screen(sheet, take)

    def _put_component(self, id: str, values: dict[str, str]) -> None:
        """Define a component in the file, and show it in the catalogue."""
        session = self.session
        if self.line.attempt(
            lambda: session.do(session.draft.put_component(id, values), f"define {id}"),
            f"{id} is defined in the file; the catalogue has it",
        ):
            self.search("below")
            self.catalogue.search.value = id
