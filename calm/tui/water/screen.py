"""The water: depth, density, current and wind of each environment, with the profile beside."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, ClassVar

from textual import on
from textual.app import ComposeResult
from textual.binding import BindingType
from textual.containers import Horizontal, Vertical, VerticalScroll
from textual.content import Content
from textual.events import DescendantFocus
from textual.widget import Widget
from textual.widgets import Static

from calm.files.definition import DENSITY
from calm.files.fields import POSITIVE_LENGTH, Quantity
from calm.files.tables import SALINITY, TEMPERATURE
from calm.tui.actions import bindings, hints
from calm.tui.bars import KeyBar, TitleBar
from calm.tui.checking import needed, quantity
from calm.tui.field import Field
from calm.tui.line.cell_editor import CellEditor
from calm.tui.messages import said
from calm.tui.profile import Profile
from calm.tui.verdict_pane import state_word
from calm.tui.water.cells import Cells
from calm.tui.water.form import CURRENT_FORMS, DENSITY_FORMS, PROFILE_FORMS, Place
from calm.tui.water.form_choice import FormChoice
from calm.tui.water.grid import Grid
from calm.tui.water.verbs import WaterVerbs

if TYPE_CHECKING:
    from calm.errors import Problem
    from calm.tui.live import View

_DEPTH = quantity(POSITIVE_LENGTH, optional=True)
_DENSITY = quantity(DENSITY, optional=True)
_SPEED = quantity(Quantity("speed", at_least=0))
_WIND = quantity(Quantity("speed", at_least=0), optional=True)
_ANGLE = quantity(Quantity("angle"))
_TOWARD = quantity(Quantity("angle"), optional=True)
_ELSEWHERE = (
    "The line stands in {0}: the profile and the verdict are of that. Below is the file's own "
    "environment; what {0} gives takes its place."
)
_INHERITED = "as in the file's own environment"


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
                yield Static(id="water-notes")
                yield from self._parts()
            with Vertical(id="water-profile"):
                yield Profile()
        yield KeyBar()

    def _parts(self) -> Iterator[Widget]:
        """The parts of the form; the id of each tells its place, as `_place` reads it."""
        yield Field("depth", "Depth", _DEPTH, id="depth", placeholder="1100 m")
        yield FormChoice("Density", DENSITY_FORMS, id="density-form")
        yield Field("density", "", _DENSITY, id="density", placeholder="1025 kg/m^3")
        yield Grid(id="density-table")
        for name, kind in (("temperature", TEMPERATURE), ("salinity", SALINITY)):
            yield FormChoice(f"  {name}", PROFILE_FORMS, id=f"density-{name}-form")
            yield Field(name, "", quantity(kind), id=f"density-{name}")
            yield Grid(id=f"density-{name}-table")
        yield FormChoice("Current", CURRENT_FORMS, id="current-form")
        yield Field("speed", "  speed", _SPEED, id="current-speed")
        yield Field("toward", "  towards", _ANGLE, id="current-toward")
        yield Field("file", "  file", needed("a file"), id="current-file")
        yield Field("time", "  time", id="current-time", placeholder="2026-03-01T06:00")
        yield Grid(id="current-table")
        yield Field("speed", "Wind", _WIND, id="wind-speed", placeholder="none")
        yield Field("toward", "  towards", _TOWARD, id="wind-toward", placeholder="where it blows")

    def on_mount(self) -> None:
        """Show what the file says."""
        self.query_one(KeyBar).show_keys(hints("water"))
        self.refresh_form()
        self.query_one("#depth", Field).focus_input()

    def show_view(self, view: View) -> None:
        """The profile and the verdict of a line as judged."""
        self.view = view
        if self.is_mounted and self.is_attached:
            self._show_study()

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

    def _show_study(self) -> None:
        """The title and the profile, dimmed where they are of what is edited no more."""
        old = not self.is_fresh(self.view)
        self._show_notes([] if old or self.view is None else self.view.problems)
        left = f"The water of {self.called}"
        self.query_one(TitleBar).show(left, state_word(self.view, old=old), old=old)
        self.query_one(Profile).show(self.view, old=old)

    def _show_notes(self, problems: Sequence[Problem]) -> None:
        """What keeps the line from standing in the water that the form shows."""
        file, path = self.environment_file, self.view.path if self.view else Path()
        notes = [Content.styled(_ELSEWHERE.format(file), "$text-warning")] if file else []
        notes += [said(each, path) for each in problems]
        shown = self.query_one("#water-notes", Static)
        shown.set_class(not notes, "gone")
        shown.update(Content("\n").join(notes))

    def refresh_form(self) -> None:
        """Show what the file says now, but where something is being typed."""
        self._show_study()
        water = self.water
        file = self.environment_file
        names = ["own" if name is None else name for name in self.environments]
        names += [file] if file else []
        here = file or water.variant or "own"
        told = "   ".join(f"[{name}]" if name == here else name for name in names)
        self.query_one("#environment-names", Static).update(f"Environment     {told}", layout=False)
        for choice in self.query(FormChoice):
            place = _place(choice)
            choice.set_class(not self._is_shown(place), "gone")
            choice.show(water.form(*place))
        for field in self.query(Field):
            place = _place(field)
            field.set_class(not self._is_shown(place, "constant"), "gone")
            if not field.is_typing:
                field.reset(water.text(*place))
            is_lacking = place == ("wind", "toward") and water.lacks_direction
            note = "is needed: where the wind blows" if is_lacking else ""
            field.tell(note if water.is_own(place[0]) else _INHERITED)
        for grid in self.query(Grid):
            place = _place(grid)
            grid.set_class(not self._is_shown(place, "table"), "gone")
            grid.show(*water.table(*place))

    def _is_shown(self, place: Place, form: str = "") -> bool:
        """Whether a part of the form is of use as the water is given, in this form of its own."""
        match place:
            case ("density", _) if self.water.form("density") != DENSITY_FORMS[2]:
                return False
            case ("current", "speed" | "toward"):
                return self.water.form("current") == "uniform"
            case ("current", "file" | "time"):
                return self.water.form("current") == "file"
            case ("density",) | ("density", _) | ("current",):
                return not form or self.water.form(*place) == form
        return True

    # what is typed

    @property
    def is_typing(self) -> bool:
        """Whether something is typed that is not in the draft yet."""
        return any(part.is_typing for part in (*self.query(Field), *self.query(Grid)))

    def settle(self) -> bool:
        """Take what is typed; the first bad value stays to be corrected, and is told."""
        for grid in self.query(Grid):
            typed = grid.is_typing
            reading = grid.settle()
            if not reading.is_good:
                self.tell(f"Not taken yet: {reading.note}", wrong=True)
                return False
            if typed:
                self._take_rows(grid, "a value")
        for field in self.query(Field):
            if not field.is_typing:
                continue
            reading = field.reading
            with field.prevent(Field.Committed):
                if not field.settle():
                    field.focus_input()
                    self.tell(f"Not taken yet, {field.key}: {reading.note}", wrong=True)
                    return False
            self._take(field, reading.text)
        return True

    def drop_typing(self) -> None:
        """Take away what is typed and not in the draft."""
        for field in self.query(Field):
            field.reset(field.begun)
        for grid in self.query(Grid):
            grid.drop()

    @on(Field.Committed)
    def _commit(self, event: Field.Committed) -> None:
        self._take(event.field, event.text)

    def _take(self, field: Field, text: str) -> None:
        place = _place(field)
        self.change(lambda water: water.put(place, text), f"the {place[0]}")

    @on(Field.Entered)
    def _onward(self) -> None:
        self.focus_next()

    @on(Grid.Changed)
    def _commit_table(self, event: Grid.Changed) -> None:
        self._take_rows(event.grid, event.label)

    def _take_rows(self, grid: Grid, label: str) -> None:
        place, cells = _place(grid), grid.cells
        self.change(lambda water: water.put_rows(place, cells.columns, cells.rows), label)

    @on(Grid.Refused)
    def _tell_refusal(self, event: Grid.Refused) -> None:
        self.tell(event.reason, wrong=True)

    @on(FormChoice.Taken)
    def _take_form(self, event: FormChoice.Taken) -> None:
        place = _place(event.choice)
        if event.form == "file":
            self.action_load_current()
        else:
            self.give_in_form(place, event.form)


def _place(part: Widget) -> Place:
    """Where in an environment the value of a part of the form is written."""
    return tuple((part.id or "").removesuffix("-form").removesuffix("-table").split("-"))
