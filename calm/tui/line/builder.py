"""The first screen: the line, its picture, the verdict, and the catalogue when it is wanted."""

from __future__ import annotations

from typing import TYPE_CHECKING, ClassVar

from textual import on
from textual.app import ComposeResult
from textual.binding import BindingType
from textual.containers import Horizontal, Vertical
from textual.events import DescendantFocus, Key

from calm.tui.actions import Place, bindings, hints
from calm.tui.bars import KeyBar, TitleBar
from calm.tui.catalogue.pane import CataloguePane
from calm.tui.line.cell_editor import CellEditor
from calm.tui.line.cell_verbs import CellVerbs
from calm.tui.line.row_verbs import RowVerbs
from calm.tui.line.table import LineTable
from calm.tui.pictures import Picture, Pictures, Tab
from calm.tui.verdict_pane import VerdictPane

if TYPE_CHECKING:
    from calm.tui.dialogs import Sheet


class BuilderScreen(RowVerbs, CellVerbs):
    """The line in the middle."""

    BINDINGS: ClassVar[list[BindingType]] = [*bindings("anywhere")]
    HORIZONTAL_BREAKPOINTS = [(0, "-narrow"), (112, "-wide"), (176, "-huge")]  # noqa: RUF012
    VERTICAL_BREAKPOINTS = [(0, "-flat"), (17, "-high")]  # noqa: RUF012
    DEFAULT_CSS = """
    BuilderScreen {
        & #body { height: 1fr; }
        & #line-pane { width: 3fr; height: 1fr; layers: table over; }
        & #study { width: 2fr; height: 1fr; border-left: vkey $panel; }
        & #catalogue { width: 2fr; height: 1fr; border-left: vkey $panel; }
        &.-searching #study { display: none; }
        &.-searching #catalogue { display: block; }
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
        &.-narrow.-flat #study { display: none; }
        &.-narrow.-flat.-searching #line-pane { display: none; }
        &.-zoomed #line-pane, &.-zoomed VerdictPane { display: none; }
        &.-zoomed #study { display: block; border: none; }
    }
    """

    def compose(self) -> ComposeResult:
        """Title, line beside picture and verdict (or the catalogue), keys."""
        yield TitleBar()
        with Horizontal(id="body"):
            with Vertical(id="line-pane"):
                yield LineTable(id="line")
                yield CellEditor(id="cell")
            yield CataloguePane(id="catalogue")
            with Vertical(id="study"):
                yield Pictures(id="pictures")
                yield VerdictPane(id="verdict-pane")
        yield KeyBar()

    def on_resize(self) -> None:
        """The title says as much as there is room for."""
        self.show_title()

    def on_mount(self) -> None:
        """The keys go to the line."""
        self.refresh_rows()
        self.table.focus()

    def on_key(self, event: Key) -> None:
        """What was told is read."""
        if not self.editor.is_open:
            self.tell("")

    @on(DescendantFocus)
    def show_keys(self) -> None:
        """The keys of what has the focus."""
        focused = self.focused
        place: Place = "line"
        if isinstance(focused, CellEditor):
            place = "cell"
        elif focused is not None and self.catalogue in focused.ancestors_with_self:
            place = "catalogue"
        self.query_one(KeyBar).show_keys(hints(place))

    def action_picture(self, tab: Tab) -> None:
        """Show another picture."""
        self.query_one(Pictures).tab = tab

    def action_zoom(self) -> None:
        """Give the picture the screen, or take it back."""
        self.remove_class("-searching")
        self.toggle_class("-zoomed")
        (self.query_one(Picture) if self.has_class("-zoomed") else self.table).focus()

    def action_next_environment(self) -> None:
        """Stand the line in the next of its environments."""
        if len(self.environments) == 1:
            self.tell("The file has one environment; add others on the screen of the water (w)")
            return
        self.session.environment = name = self.next_environment()
        told = f"environment {name}" if name else "own `environment:`"
        self.changed(self.table.spot, f"The line stands in the file's {told}")

    def action_water(self) -> None:
        """Depth, density, current, wind."""
        from calm.tui.water.screen import WaterScreen

        self.app.push_screen(WaterScreen(self.session, self.view), lambda _: self.changed())

    def action_mooring(self) -> None:
        """Name, description, position."""
        from calm.tui.line.mooring_sheet import mooring_sheet

        self._ask(mooring_sheet(self.session.draft), "name and place")

    def action_tow(self) -> None:
        """Speed and course of a tow; a mooring becomes one."""
        from calm.tui.line.mooring_sheet import tow_sheet

        self._ask(tow_sheet(self.session.draft), "the tow")

    def _ask(self, sheet: Sheet, label: str) -> None:
        from calm.tui.line.mooring_sheet import changes

        def take(texts: dict[str, str] | None) -> None:
            if texts is not None:
                changed = changes(self.session.draft, texts)
                self.attempt(lambda: self.session.put_all(changed, label))

        self.app.push_screen(sheet, take)

    def action_text(self) -> None:
        """The file as text."""
        from calm.tui.text_screen import TextScreen

        def take(_: None) -> None:
            self.changed(self.table.spot)

        self.app.push_screen(TextScreen(self.session, self.view), take)

    async def action_save_as(self) -> None:
        """Save it under another name."""
        await self.app.run_action("save_as")

    async def action_leave(self) -> None:
        """Leave."""
        await self.app.run_action("quit")
