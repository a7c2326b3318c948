"""The water: depth, density, current and wind of each environment, with the profile beside."""

from __future__ import annotations

from typing import TYPE_CHECKING, ClassVar

from textual import on
from textual.app import ComposeResult
from textual.binding import BindingType
from textual.containers import Horizontal, Vertical, VerticalScroll
from textual.events import DescendantFocus
from textual.widgets import Static

from calm.files.definition import DENSITY
from calm.files.fields import POSITIVE_LENGTH, Quantity
from calm.tui.actions import bindings, hints
from calm.tui.bars import KeyBar, TitleBar
from calm.tui.cell_editor import CellEditor
from calm.tui.cells import Cells
from calm.tui.checking import needed, quantity
from calm.tui.cycle import Cycle
from calm.tui.field import Field
from calm.tui.grid import Grid
from calm.tui.messages import Edited
from calm.tui.profile import Profile
from calm.tui.verdict_pane import state_word
from calm.tui.water_form import CURRENT_FORMS, DENSITY_FORMS
from calm.tui.water_verbs import WaterVerbs

if TYPE_CHECKING:
    from calm.tui.live import View

_SPEED = quantity(Quantity("speed", at_least=0))
_WIND = quantity(Quantity("speed", at_least=0), optional=True)
_ANGLE = quantity(Quantity("angle"))
_TOWARD = quantity(Quantity("angle"), optional=True)


class WaterScreen(WaterVerbs):
    """A form at the left, the profile of the current at the right."""

    BINDINGS: ClassVar[list[BindingType]] = [*bindings("water")]
    HORIZONTAL_BREAKPOINTS = [(0, "-narrow"), (112, "-wide")]  # noqa: RUF012
    DEFAULT_CSS = """
    WaterScreen {
        & #water-form { width: 3fr; padding: 1 1 0 1; scrollbar-size-vertical: 1; }
        & #water-profile { width: 2fr; border-left: vkey $panel; padding: 0 1; }
        & .gone { display: none; }
        & Grid { margin-left: 16; }
        & Field > Input { width: 20; }
    }
    WaterScreen.-narrow Grid { margin-left: 0; }
    """

    def compose(self) -> ComposeResult:
        """Title; form and profile; keys."""
        yield TitleBar()
        with Horizontal():
            with VerticalScroll(id="water-form", can_focus=False):
                yield Static(id="environment-names", markup=False)
                yield Field(
                    "depth",
                    "Depth",
                    quantity(POSITIVE_LENGTH, optional=True),
                    id="depth",
                    placeholder="1100 m",
                )
                yield Cycle("Density", DENSITY_FORMS, "constant", id="density-form")
                yield Field(
                    "density",
                    "",
                    quantity(DENSITY, optional=True),
                    id="density",
                    placeholder="1025 kg/m^3",
                )
                yield Grid(id="density-table")
                yield Cycle("Current", CURRENT_FORMS, "still", id="current-form")
                yield Field("speed", "  speed", _SPEED, id="current-speed")
                yield Field("toward", "  towards", _ANGLE, id="current-toward")
                yield Field("file", "  file", needed("a file"), id="current-file")
                yield Field("time", "  time", id="current-time", placeholder="2026-03-01T06:00")
                yield Grid(id="current-table")
                yield Field("speed", "Wind", _WIND, id="wind-speed", placeholder="none")
                yield Field("toward", "  towards", _TOWARD, id="wind-toward")
            with Vertical(id="water-profile"):
                yield Profile()
        yield KeyBar()

    def on_mount(self) -> None:
        """Show what the file says."""
        self.query_one(KeyBar).show_keys(hints("water"))
        self.refresh_form()
        self.query_one("#depth", Field).focus_input()

    def show_view(self, view: View) -> None:
        """The profile and the verdict of a line as judged."""
        self.view = view
        if self.is_mounted:
            self.query_one(Profile).show(view)
            self._show_title()

    @on(DescendantFocus)
    def _show_keys(self) -> None:
        bar = self.query_one(KeyBar)
        focused = self.focused
        if isinstance(focused, CellEditor):
            bar.show_keys(hints("cell"))
        elif isinstance(focused, Cells):
            bar.show_keys([*hints("grid"), *hints("water")])
        else:
            bar.show_keys(hints("water"))
        bar.tell("")

    def _show_title(self) -> None:
        water = self.water
        unsaved = " (not saved)" if self.session.changed else ""
        left = f"The water of {self.session.name}{unsaved}"
        self.query_one(TitleBar).show(left, state_word(self.view))
        named = water.draft.value(("environments",))
        names = ["own", *(named if isinstance(named, dict) else ())]
        here = water.variant or "own"
        told = "   ".join(f"[{name}]" if name == here else name for name in names)
        self.query_one("#environment-names", Static).update(f"Environment     {told}", layout=False)

    def refresh_form(self) -> None:
        """Show what the file says now."""
        self._show_title()
        water = self.water
        self._fill("depth", water.text("depth"), "depth")
        is_table = water.density_form == "table"
        self.query_one("#density-form", Cycle).show(water.density_form)
        self._fill("density", water.text("density"), "density", shown=not is_table)
        self._fill_table("density-table", "density", shown=is_table)
        form = water.current_form
        self.query_one("#current-form", Cycle).show(form)
        for key in ("speed", "toward"):
            text = water.text("current", key)
            self._fill(f"current-{key}", text, "current", shown=form == "uniform")
        for key in ("file", "time"):
            self._fill(
                f"current-{key}", water.text("current", key), "current", shown=form == "file"
            )
        self._fill_table("current-table", "current", shown=form == "table")
        self._fill("wind-speed", water.text("wind", "speed"), "wind")
        self._fill("wind-toward", water.text("wind", "toward"), "wind")
        self.query_one(Profile).show(self.view)

    def _fill(self, id: str, text: str, key: str, *, shown: bool = True) -> None:
        field = self.query_one(f"#{id}", Field)
        field.set_class(not shown, "gone")
        if not field.has_class("-wrong"):
            field.reset(text)
        field.tell("" if self.water.is_own(key) else "as in the file's own environment")

    def _fill_table(self, id: str, key: str, *, shown: bool) -> None:
        grid = self.query_one(f"#{id}", Grid)
        grid.set_class(not shown, "gone")
        if shown:
            grid.show(*self.water.table(key))

    @on(Field.Committed)
    def _commit(self, event: Field.Committed) -> None:
        id, text = event.field.id or "", event.text
        if id.startswith("wind-"):
            self.change(lambda water: water.put_wind(event.field.key, text), "the wind")
        elif id.startswith("current-"):
            self.change(lambda water: water.put(("current", event.field.key), text), "the current")
        else:
            self.change(lambda water: water.put((id,), text), f"the {id}")

    @on(Field.Entered)
    def _onward(self) -> None:
        self.focus_next()

    @on(Grid.Changed)
    def _commit_table(self, event: Grid.Changed) -> None:
        key = (event.grid.id or "").removesuffix("-table")
        columns = event.grid.cells.columns
        self.change(lambda water: water.put_rows(key, columns, event.rows), event.label)

    @on(Cycle.Turned, "#density-form")
    def _turn_density(self, event: Cycle.Turned) -> None:
        form = next(each for each in DENSITY_FORMS if each == event.word)
        self.change(lambda water: water.put_density_form(form), f"density: {form}")

    @on(Cycle.Turned, "#current-form")
    def _turn_current(self, event: Cycle.Turned) -> None:
        form = next(each for each in CURRENT_FORMS if each == event.word)
        if form == "file":
            self.action_load_current()
        else:
            self.change(lambda water: water.put_current_form(form), f"current: {form}")

    def action_undo(self) -> None:
        """Take the last change back."""
        self._went("undone", self.session.history.undo())

    def action_redo(self) -> None:
        """Make it again."""
        self._went("done again", self.session.history.redo())

    def _went(self, what: str, label: str | None) -> None:
        for field in self.query(Field):
            field.remove_class("-wrong")
        if self.session.draft.problems:
            self.dismiss()
            return
        self.refresh_form()
        self.tell(f"{what}: {label}" if label else f"Nothing is left to be {what}")
        self.post_message(Edited())

    async def action_save(self) -> None:
        """Save the file."""
        await self.app.run_action("save")

    def action_help(self) -> None:
        """All keys."""
        from calm.tui.help_screen import HelpScreen

        self.app.push_screen(HelpScreen())

    def action_back(self) -> None:
        """Back to the line; a good text under the cursor is taken."""
        focused = self.focused
        field = next(
            (each for each in (focused.ancestors if focused else ()) if isinstance(each, Field)),
            None,
        )
        if field is not None and field.reading.is_good:
            field.settle()
            self.call_after_refresh(self._leave)
        else:
            self._leave()

    def _leave(self) -> None:
        self.dismiss()  # not waited for: it ends the very loop that would wait
