"""Water screen, with a form for each environment and its current profile."""

from collections.abc import Callable, Sequence
from functools import partial
from pathlib import Path

from textual import events, on
from textual.app import ComposeResult
from textual.containers import Horizontal, Vertical, VerticalScroll
from textual.content import Content
from textual.dom import DOMNode
from textual.events import DescendantFocus
from textual.widget import Widget
from textual.widgets import Static

from calm.errors import CalmError, Problem, unexpected
from calm.files.editing import Draft, Value
from calm.files.environment import CurrentFile
from calm.records.delimited import CopiedTable
from calm.tui import cell_editor, checking, dialogs, key_table, pictures, screen, verdict_pane
from calm.tui.field import Field
from calm.tui.forms import FormField, Rows
from calm.tui.table_field import GridCells
from calm.tui.water_form import (
    DENSITY_FORMS,
    FormChoice,
    Place,
    ProfileGrid,
    WaterForm,
    fields_of_water,
)
from calm.tui.water_tables import (
    CURRENT_COLUMNS,
    PRESETS,
    SHARES,
    USUAL_DEPTH,
    NoRows,
    import_sheet,
    imported,
    previewed,
    rows_in,
)
from calm.tui.workspace import Workspace, problem_text

_ELSEWHERE = (
    "The line is solved in {0}, so profile and verdict are for {0}. The values below are those of "
    "the default environment; {0} overrides some of them."
)
_INHERITED = "as in the default environment"
_FORMS: dict[type[Widget], str] = {FormChoice: "", Field: "constant", ProfileGrid: "table"}
"""Form that each type of widget edits, ``constant`` or ``table``; "" for any form."""


class WaterScreen(screen.DraftScreen):
    """Screen for depth, density, current and wind of each environment.

    The line is solved in the environment shown.
    """

    BINDINGS = key_table.bindings("water")
    HORIZONTAL_BREAKPOINTS = [(0, "-narrow"), (112, "-wide")]  # noqa: RUF012
    DEFAULT_CSS = """
    WaterScreen {
        & #water-form { width: 3fr; padding: 1 1 0 1; scrollbar-size-vertical: 1; }
        & #water-profile { width: 2fr; border-left: vkey $panel; padding: 0 1; }
        & .gone { display: none; }
        & .above { color: $text-muted; }
        & Grid { margin-left: 24; }
        & Field > Input { width: 20; margin-left: 24; }
        &.-narrow Grid { margin-left: 0; }
        &.-narrow Field > Input { margin-left: 20; }
    }
    """

    def __init__(self, workspace: Workspace) -> None:
        super().__init__(workspace)
        # values of replaced forms, to restore them
        self._left: dict[tuple[str | None, Place, str], Value | None] = {}
        # the focus moves to the first value of a form and keeps the message
        self._goes_on = False

    def parts(self) -> ComposeResult:
        with Horizontal():
            with VerticalScroll(id="water-form", can_focus=False):
                yield Static(id="environment-names", markup=False)
                yield Static(id="water-notes")
                grid = partial(
                    ProfileGrid, self.workspace.tell, self._take_rows, self._preview_paste
                )
                for part in fields_of_water(self.session.draft.is_tow, grid):
                    part.set_class(self._is_hidden(part), "gone", update=False)
                    yield part
            with Vertical(id="water-profile"):
                yield pictures.ProfilePicture()

    def on_mount(self) -> None:
        self.show_draft()
        self.query_one("#depth", Field).input.focus()

    @property
    def water(self) -> WaterForm:
        """The displayed environment in the current draft."""
        choice = self.session.choice
        here = choice.environment
        return WaterForm(self.session.draft, here if here in choice.environments else None)

    @property
    def environment_file(self) -> str | None:
        """Path of the displayed environment file; None for an environment of the mooring file."""
        choice, draft = self.session.choice, self.session.draft
        here = choice.environment
        return None if here in choice.environments or draft.problems else here

    def titles(self) -> tuple[str, str]:
        state = verdict_pane.state_word(self.workspace.view, old=not self.workspace.is_fresh)
        return f"The water of {self.workspace.called}", state

    def show_view(self) -> None:
        """Show the current profile of the last view; the profile is dimmed if it is out of date."""
        view, fresh = self.workspace.view, self.workspace.is_fresh
        self._show_notes(view.problems if view is not None and fresh else ())
        self.query_one(pictures.ProfilePicture).show(view, old=self.workspace.is_old)
        self.show_title()

    def _show_notes(self, problems: Sequence[Problem]) -> None:
        file, path = self.environment_file, self.workspace.path
        notes = [Content.styled(_ELSEWHERE.format(file), "$text-warning")] if file else []
        notes += [problem_text(each, path) for each in problems]
        shown = self.query_one("#water-notes", Static)
        shown.set_class(not notes, "gone")
        shown.update(Content("\n").join(notes))

    def show_draft(self) -> None:
        """Show the current draft, except in fields that are being edited."""
        self.show_view()
        water = self.water
        file = self.environment_file
        names = ["default" if name is None else name for name in self.session.choice.environments]
        names += [file] if file else []
        here = file or water.variant or "default"
        listing = "   ".join(f"[{name}]" if name == here else name for name in names)
        self.query_one("#environment-names", Static).update(
            f"Environment     {listing}", layout=False
        )
        for choice in self.query(FormChoice):
            choice.set_class(self._is_hidden(choice), "gone")
            choice.show(water.form(*_place(choice)))
        for field in self.query(Field):
            place = _place(field)
            field.set_class(self._is_hidden(field), "gone")
            if not field.is_typing:
                field.reset(water.text(*place))
            is_lacking = field.form_field.is_needed and len(place) > 1 and water.value(*place[:-1])
            lacks = is_lacking and not water.text(*place)
            note = f"is needed: {field.form_field.takes}" if lacks else ""
            field.tell(note if water.is_own(place[0]) else _INHERITED)
        for grid in self.query(ProfileGrid):
            grid.set_class(self._is_hidden(grid), "gone")
            grid.show_profile(*water.table(*_place(grid)), water.depth)

    def _is_hidden(self, part: Widget) -> bool:
        form = _FORMS.get(type(part))
        if form is None:
            return False
        water, place = self.water, _place(part)
        key = place[0]
        if key == "density" and place[1:] and water.form(key) != DENSITY_FORMS[2]:
            return True
        if key == "current" and place[1:]:
            is_of_file = place[1] in CurrentFile.model_fields
            return water.form(key) != ("file" if is_of_file else "uniform")
        return bool(form) and key in ("density", "current") and water.form(*place) != form

    def replaced(self) -> None:
        """Show a new draft, and discard typed text.

        The values that a property had in its earlier forms are discarded, too.
        """
        self._left.clear()
        self.discard_typing()
        self.show_draft()

    # changes

    def change(self, make: Callable[[WaterForm], Draft], label: str, message: str = "") -> bool:
        """Change the file; return whether the change succeeded.

        If the change fails, a message shows the reason.
        """
        is_made, _ = self.workspace.attempt(lambda: self.session.do(make(self.water), label))
        self.show_draft()
        if is_made:
            self.workspace.tell(message)
            self.workspace.edited()
        return is_made

    def put_table(self, columns: Sequence[str], rows: Sequence[Sequence[str]], label: str) -> None:
        """Replace the current of the displayed environment by a table."""
        self.change(lambda water: water.put_rows(("current",), columns, rows), label)

    # typed text

    @property
    def is_typing(self) -> bool:
        return any(part.is_typing for part in (*self.query(Field), *self.query(ProfileGrid)))

    def settle(self) -> bool:
        """Write typed text to the draft, and return whether all values are valid.

        The first invalid value stays in its field, with a message.
        """
        if not all(grid.settle() for grid in self.query(ProfileGrid)):
            return False
        for field in self.query(Field):
            if not field.is_typing:
                continue
            reading = field.reading
            with field.prevent(Field.Committed):
                if not field.settle():
                    field.input.focus()
                    text = f"Not accepted yet, {field.key}: {reading.note}"
                    self.workspace.tell(text, wrong=True)
                    return False
            self._take(field, reading.text)
        return True

    def discard_typing(self) -> None:
        """Discard typed text that is not in the draft yet."""
        for field in self.query(Field):
            field.reset(field.begun)
        for grid in self.query(ProfileGrid):
            grid.leave_cell()

    @on(Field.Committed)
    def _commit(self, event: Field.Committed) -> None:
        self._take(event.field, event.text)

    def _take(self, field: Field, text: str) -> None:
        place = _place(field)
        is_needed = field.form_field.is_needed
        self.change(lambda water: water.put(place, text, is_needed=is_needed), f"the {place[0]}")

    @on(Field.Entered)
    def _onward(self) -> None:
        self.focus_next()

    def _take_rows(self, grid: ProfileGrid, label: str) -> None:
        place, cells = _place(grid), grid.cells
        self.change(lambda water: water.put_rows(place, cells.headings, cells.rows), label)

    def _preview_paste(self, grid: ProfileGrid, copied: CopiedTable, headings: list[str]) -> None:
        columns = grid.cells.headings

        def taken(text: str) -> Rows:
            return rows_in(columns, [one.strip() for one in text.split(",")], copied.rows)

        def check(text: str) -> checking.Reading:
            try:
                return checking.Reading(text, explained=previewed(columns, taken(text)))
            except NoRows as error:
                return checking.Reading(text, str(error))

        def take(answers: dict[str, str]) -> None:
            rows, chosen = taken(answers["columns"]), answers["columns"]
            grid.change(rows, f"{len(rows)} rows pasted: {chosen}")
            self.call_after_refresh(grid.cells.focus)  # a table may not be shown yet

        text = "This replaces all rows."
        if copied.headings is None:
            text += " The pasted table has no headings: check the columns below."
        first = "   ".join(copied.rows[0])
        text += f" First pasted row:  {first}"
        form_field = FormField("columns", "Columns", ", ".join(headings), check)
        dialogs.enter(self.app, "Paste a table", text, [form_field], take)

    def on_paste(self, event: events.Paste) -> None:
        # a table of the form that has the focus takes its own pastes
        if len(event.text.splitlines()) > 1 and self.settle():
            grid = self.query_one("#current-table", ProfileGrid)
            if self.water.form("current") != "table":
                grid.show_profile(CURRENT_COLUMNS, (), self.water.depth)
            grid.take_text(event.text)

    @on(FormChoice.Taken)
    def _take_form(self, event: FormChoice.Taken) -> None:
        place, form, message = _place(event.choice), event.form, ""
        if form == "file":
            self.action_load_current()
            return
        if not self.settle():
            return
        water = self.water
        self._left[water.variant, place, water.form(*place)] = water.own(*place)
        key = (water.variant, place, form)
        is_new = key not in self._left
        value = water.begun(place, form) if is_new else self._left[key]
        if is_new and value is not None:
            message = "Filled with typical values; replace them with your own"
            if water.depth is None:
                message += f"; the depth is not set, so tables go down to {USUAL_DEPTH:g} m"
        self.change(lambda water: water.put_form(place, value), f"{place[-1]}: {form}", message)
        self._goes_on = True
        self.call_after_refresh(self._first_widget(place, form).focus)

    def _first_widget(self, place: Place, form: str) -> Widget:
        key = "-".join(place)
        if form == "table":
            return self.query_one(f"#{key}-table GridCells")
        if form == DENSITY_FORMS[2]:
            return self.query_one("#density-temperature-form")
        # still water has no widget: the wind is next
        where = {"uniform": "current-speed", "still": "wind-speed"}.get(form, key)
        return self.query_one(f"#{where}", Field).input

    # environments, currents, and closing the screen

    @on(DescendantFocus)
    def _show_keys(self) -> None:
        bar, focused = self.query_one(screen.KeyBar), self.focused
        if isinstance(focused, cell_editor.CellEditor):
            bar.show_keys(key_table.hints("cell"))
        else:
            grid = key_table.hints("grid") if isinstance(focused, GridCells) else []
            bar.show_keys([*grid, *key_table.hints("water")])
        if not self._goes_on:
            bar.tell("")
        self._goes_on = False

    def action_next_environment(self) -> None:
        if self.settle():
            self._environment_file_in_use(self.session.choice.next_environment)

    def action_new_environment(self) -> None:
        def take(texts: dict[str, str]) -> None:
            name, water = texts["name"], self.water
            if name in self.session.choice.environments:
                self.workspace.tell(f"There is an environment {name} already", wrong=True)
                return
            known = water.value("current")
            current = known or water.begun(("current",), "uniform")
            place = ("environments", name, "current")
            if self.change(lambda _: water.draft.put_at(place, current), f"environment {name}"):
                note = "" if known else "Filled with a typical current; replace it with your own"
                self._environment_file_in_use(name)
                self.workspace.tell(note)

        if self.settle():
            fields = [
                FormField("name", "Name", check=checking.needed("a name"), placeholder="e.g. storm")
            ]
            text = (
                "A new environment needs only the values that differ from the default environment."
            )
            dialogs.enter(self.app, "New environment", text, fields, take)

    def action_drop_environment(self) -> None:
        name = self.water.variant
        if name is None:
            self.workspace.tell("The default environment cannot be removed; F5 shows a named one")
            return
        self.discard_typing()
        if self.change(lambda water: water.draft.put_at(water.place, None), f"drop {name}"):
            self._environment_file_in_use(None)

    def _environment_file_in_use(self, name: str | None) -> None:
        before, self.session.choice.environment = self.environment_file, name
        self.discard_typing()
        self.show_draft()
        self.workspace.tell(f"The line is no longer solved in {before}" if before else "")
        self.workspace.edited()

    def action_preset(self) -> None:
        def take(speed: Callable[[float], float]) -> None:
            deep = self.water.depth or USUAL_DEPTH
            rows = [(f"{part * deep:.4g}", f"{speed(part):.2g}", "90") for part in SHARES]
            self.put_table(CURRENT_COLUMNS, rows, "a preset current")

        if self.settle():
            depth = self.water.depth
            down = f"{USUAL_DEPTH:g} m, since no depth is set" if depth is None else f"{depth:g} m"
            answers = dialogs.numbered(
                (name, partial(take, each)) for name, each in PRESETS.items()
            )
            text = f"The table goes down to {down}. The current is towards the east; edit it."
            dialogs.choose(self.app, dialogs.Question("A current to start from", text, answers))

    def action_load_current(self) -> None:
        def take(texts: dict[str, str] | None) -> None:
            if texts is None:
                self.show_draft()
                return
            path, time = texts["file"], texts["time"]
            if texts["how"] != "copy":
                given = {"file": path} | ({"time": time} if time else {})
                message = f"current of {path}"
                self.change(lambda water: water.put_form(("current",), given), message)
            else:
                self.workspace.tell(f"Reading {path} …")
                read = partial(self._read_in_thread, self.water, path, time)
                self.run_worker(read, thread=True, exit_on_error=False)

        if self.settle():
            self.app.push_screen(import_sheet(self._folder), take)

    def _read_in_thread(self, water: WaterForm, path: str, time: str) -> None:
        tell = self.workspace.tell

        def put(columns: Sequence[str], rows: Sequence[Sequence[str]]) -> None:
            if water.variant != self.water.variant:
                tell(f"{path} was read for another environment; read it again", wrong=True)
            else:
                self.put_table(columns, rows, f"current of {path}")
                tell(f"The current of {path} was copied to the table")

        try:
            table = imported(self._folder / path, time, water.depth or USUAL_DEPTH)
        except CalmError as error:
            self.call_later(tell, str(error).partition("\n")[0], wrong=True)
        except Exception as error:  # NetCDF libraries may raise any exception
            self.call_later(tell, f"{path} cannot be read: {unexpected(error)}", wrong=True)
        else:
            self.call_later(put, *table)

    @property
    def _folder(self) -> Path:
        path = self.session.file.path
        return Path.cwd() if path is None else path.absolute().parent

    def action_undo(self) -> None:
        if self.settle():
            super().action_undo()
        else:
            self.discard_typing()
            self.show_draft()

    def action_back(self) -> None:
        self.settle()
        self.dismiss()  # not awaited, because this ends the loop that would wait


def _place(part: DOMNode | None) -> Place:
    name = part.id if part else None
    return tuple((name or "").removesuffix("-form").removesuffix("-table").split("-"))
