"""Layout of the main screen: the line next to either the catalogue, or the picture and verdict."""

from collections.abc import Collection

from textual import on
from textual.app import ComposeResult
from textual.containers import Horizontal, Vertical

from calm.files import Place
from calm.files.editing import Value
from calm.tui import line_pane, line_table, pictures, screen
from calm.tui.catalogue_pane import CataloguePane, Purpose
from calm.tui.verdict_pane import VerdictPane, state_word
from calm.tui.workspace import Workspace


class LineScreen(screen.DraftScreen):
    """Layout of the main screen, and navigation between line, picture, verdict and catalogue."""

    HORIZONTAL_BREAKPOINTS = [(0, "-narrow"), (112, "-wide"), (176, "-huge")]  # noqa: RUF012
    DEFAULT_CSS = """
    LineScreen {
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
        &.-zoomed #line-pane, &.-zoomed VerdictPane { display: none; }
        &.-zoomed #study { display: block; border: none; }
    }
    """

    def __init__(self, workspace: Workspace) -> None:
        super().__init__(workspace)
        self.line = line_pane.LinePane(workspace, self.search)
        self.catalogue = CataloguePane(workspace, self._take_component, self.close_catalogue)
        self.pictures, self.verdict = pictures.Pictures(id="pictures"), VerdictPane(self._go_to_row)
        self._came_from_verdict = False

    def parts(self) -> ComposeResult:
        with Horizontal(id="body"):
            yield self.line
            yield self.catalogue
            with Vertical(id="study"):
                yield self.pictures
                yield self.verdict

    @property
    def is_typing(self) -> bool:
        return self.line.editor.is_typing

    def settle(self) -> bool:
        return self.line.settle()

    def show_draft(self) -> None:
        self.line.show_draft()
        self._show_side_panes()
        self.show_title()

    def show_view(self) -> None:
        if self.workspace.is_fresh or self.workspace.is_old:
            self.line.show_rows()
        self._show_side_panes()
        self.show_title()

    def show_catalogue(self) -> None:
        """Show the line and the catalogue pane with a newly loaded catalogue."""
        self.line.show_rows()
        self._show_side_panes()

    def _show_side_panes(self) -> None:
        self.catalogue.refresh_index()
        view, fresh = self.workspace.view, self.workspace.is_fresh
        last = None if view is None or view.result is not None else self.workspace.good
        if fresh:
            self.pictures.show(last or view, "last valid line" if last else "")
            note = "The drawing shows the last valid line." if last else ""
            self.verdict.say(view, note)
        self.pictures.set_class(self.workspace.is_old or last is not None, "-old")
        self.verdict.set_class(self.workspace.is_old, "-old")

    def titles(self) -> tuple[str, str]:
        name = " ".join(self.session.draft.text_at(("name",)).split())
        choice, parts = self.session.choice, []
        here = choice.environment
        if here is not None or len(choice.environments) > 1:
            parts.append(f"environment {here}" if here else "default environment")
        parts.append(state_word(self.workspace.view, old=not self.workspace.is_fresh))
        return f"{self.workspace.called}  {name}".rstrip(), "   ".join(parts)

    # from the verdict to a row, and back

    def _go_to_row(self, places: Collection[Place], text: str = "") -> None:
        self.remove_class("-reading")
        table = self.line.table
        rows = {row.spot: number for number, row in enumerate(table.rows)}
        numbers = sorted(rows[place] for place in places if place in rows)
        if numbers:  # repeated presses go to the next row
            table.cursor = next((each for each in numbers if each > table.cursor), numbers[0])
            self.workspace.tell(text)
            self._came_from_verdict = True
        table.focus()

    def action_back(self) -> None:
        if self._came_from_verdict:
            self._came_from_verdict = False
            self.add_class("-reading")
            self.verdict.focus()

    # components from the catalogue

    def search(self, purpose: Purpose) -> None:
        """Open the catalogue to find a component for the row under the cursor."""
        self.remove_class("-zoomed")
        self.add_class("-searching")
        spot = self.line.table.spot
        is_clamp = purpose == "clamp" or bool(purpose == "replace" and spot and spot.is_clamp)
        self.catalogue.open(purpose, self._target(purpose), self._role(purpose), clampable=is_clamp)

    def _role(self, purpose: Purpose) -> str:
        spot, index, items = self.line.table.spot, self.workspace.index, self.session.draft.items
        if spot is None or (purpose == "above" and spot == Place(0)):
            return "" if self.session.draft.is_tow else "float"
        if purpose == "clamp" or index is None:
            return "instrument"
        if purpose == "replace":
            listed = index.get(self.session.item(spot).values.get("use", ""))
            return listed.role if listed else ""
        roles = {each.role for item in items if (each := index.get(item.values.get("use", "")))}
        is_last = spot.item == len(items) - 1 and purpose == "below"
        return "anchor" if is_last and "release" in roles and "anchor" not in roles else ""

    def _target(self, purpose: Purpose) -> str:
        spot = self.line.table.spot
        if spot is None:
            return ""
        values = self.session.item(spot if purpose == "replace" else Place(spot.item)).values
        return values.get("label") or values.get("use", "")

    def _take_component(self, purpose: Purpose, values: dict[str, Value]) -> None:
        spot, session, use = self.line.table.spot, self.session, str(values["use"])
        if purpose == "replace" and spot is not None:
            kept: list[str] = []
            if self.line.attempt(lambda: kept.extend(session.replace(spot, values))):
                kept_keys = f"; kept from the previous component: {', '.join(kept)}" if kept else ""
                self.workspace.tell(f"now {use}{kept_keys}")
            self.close_catalogue()
            return
        if purpose == "clamp" and spot is not None:
            self.line.attempt(lambda: session.clamp(spot, values), f"{use} clamped on")
        else:
            below = purpose != "above"
            self.line.attempt(lambda: session.insert(spot, values, below=below), f"{use} added")
            if not below:  # the next component goes below: a line is listed downwards
                self.catalogue.purpose = "below"
        self.catalogue.retitle(self._target(self.catalogue.purpose))

    def close_catalogue(self) -> None:
        """Close the catalogue and return to the line."""
        self.remove_class("-searching")
        self.line.table.focus()

    @on(line_table.LineTable.Moved)
    def _retarget(self) -> None:
        if self.has_class("-searching"):
            self.catalogue.retitle(self._target(self.catalogue.purpose))
