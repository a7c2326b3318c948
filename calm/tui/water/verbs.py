"""What is done with environments and currents on the screen of the water."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from textual import on, work
from textual.message import Message

from calm.errors import CalmError
from calm.files.editing import Draft, Value
from calm.tui.checking import needed
from calm.tui.dialogs import Answer, Asked, Question, Sheet
from calm.tui.messages import Edited
from calm.tui.screen import DraftScreen
from calm.tui.session import Session
from calm.tui.water.form import CURRENT_COLUMNS, USUAL_DEPTH, Place, Water
from calm.tui.water.presets import PRESETS

if TYPE_CHECKING:
    from calm.tui.live import View

_CURRENT: Place = ("current",)


class WaterVerbs(DraftScreen):
    """A screen that shows the water of a file and can `refresh_form` and `drop_typing`."""

    @dataclass
    class Imported(Message):
        """The current of a file was read for an environment, or why it was not."""

        variant: str | None
        path: str
        columns: Sequence[str] = ()
        rows: Sequence[Sequence[str]] = ()
        reason: str = ""

    def __init__(self, session: Session, view: View | None) -> None:
        super().__init__()
        self.session = session
        self.view = view
        # what was written in forms that others took the place of, to be had back
        self._left: dict[tuple[str | None, Place, str], Value | None] = {}

    def refresh_form(self) -> None:
        """Show what the file says now."""
        raise NotImplementedError

    def drop_typing(self) -> None:
        """Take away what is typed and not in the draft."""
        raise NotImplementedError

    @property
    def water(self) -> Water:
        """The environment that is shown, as the file has it now."""
        here = self.session.environment
        return Water(self.session.draft, here if here in self.environments else None)

    def change(self, make: Callable[[Water], Draft], label: str) -> bool:
        """Change the file; what refuses is told. Whether it was changed."""
        try:
            self.session.do(make(self.water), label)
        except CalmError as error:
            self.refresh_form()
            self.tell(str(error), wrong=True)
            return False
        self.changed()
        return True

    def changed(self, *, told: str = "") -> None:
        """Show the draft, another one now, and have it judged."""
        self.refresh_form()
        self.tell(told)
        self.post_message(Edited())

    def replaced(self) -> None:
        """Show the draft anew; what is typed, and what other forms held, was of another one."""
        self._left.clear()
        self.drop_typing()
        self.refresh_form()

    def give_in_form(self, place: Place, form: str) -> None:
        """Give the current or the density in another form: as it was in it, or begun anew."""
        if not self.settle():
            return
        water = self.water
        self._left[water.variant, place, water.form(*place)] = water.own(*place)
        key = (water.variant, place, form)
        value = self._left[key] if key in self._left else water.begun(place, form)
        if self.change(lambda water: water.put_form(place, value), f"{place[-1]}: {form}"):
            begun = key not in self._left and value is not None
            self.tell(f"Begun with figures to be replaced{self._depth_told}" if begun else "")

    @property
    def _depth_told(self) -> str:
        told = f"; no depth is given, so tables go down to {USUAL_DEPTH:g} m"
        return told if self.water.depth is None else ""

    # environments

    def action_next_environment(self) -> None:
        """Show the next environment, and stand the line in it."""
        if self.settle():
            self._stand_in(self.next_environment())

    def _stand_in(self, name: str | None) -> None:
        before, self.session.environment = self.environment_file, name
        self.drop_typing()
        self.changed(told=f"The line no longer stands in {before}" if before else "")

    @property
    def environment_file(self) -> str | None:
        """The environment file that the line stands in, given with the command; None where not."""
        here, draft = self.session.environment, self.session.draft
        return None if here in self.environments or draft.problems else here

    def action_new_environment(self) -> None:
        """A named environment with the current of the one that is shown."""

        def take(texts: dict[str, str] | None) -> None:
            if texts is None:
                return
            name, water = texts["name"], self.water
            if name in self.environments:
                self.tell(f"There is an environment {name} already", wrong=True)
                return
            known = water.value("current")
            current = known or water.begun(_CURRENT, "uniform")
            place = ("environments", name, "current")
            if self.change(lambda _: water.draft.put_at(place, current), f"environment {name}"):
                self._stand_in(name)
                self.tell("" if known else "Begun with a current to be replaced")

        if self.settle():
            asked = [Asked("name", "Name", check=needed("a name"), placeholder="storm")]
            text = "It says only what differs from the file's own environment."
            self.app.push_screen(Sheet("Another environment", text, asked), take)

    def action_drop_environment(self) -> None:
        """Take the named environment out of the file."""
        name = self.water.variant
        if name is None:
            self.tell("The file's own environment stays; F5 goes to a named one")
            return
        self.drop_typing()
        if self.change(lambda water: water.draft.put_at(water.place, None), f"drop {name}"):
            self._stand_in(None)

    # currents

    def action_preset(self) -> None:
        """A profile to begin with."""

        def take(key: str | None) -> None:
            chosen = next((preset for preset in PRESETS if preset.key == key), None)
            if chosen is not None:
                rows = chosen.rows(self.water.depth or USUAL_DEPTH)
                self._take_rows_of(CURRENT_COLUMNS, rows, "a preset current")

        if self.settle():
            depth = self.water.depth
            down = f"{USUAL_DEPTH:g} m, as no depth is given" if depth is None else f"{depth:g} m"
            answers = [Answer(preset.key, preset.name, preset.key) for preset in PRESETS]
            text = f"As a table down to {down}, towards the east; then change its figures."
            self.app.push_screen(Question("A current to begin with", text, answers), take)

    def _take_rows_of(
        self, columns: Sequence[str], rows: Sequence[Sequence[str]], label: str
    ) -> None:
        self.change(lambda water: water.put_rows(_CURRENT, columns, rows), label)

    def action_load_current(self) -> None:
        """A current from CSV or NetCDF: referred to, or its profile copied."""
        from calm.tui.water.current_import import ImportSheet

        def take(texts: dict[str, str] | None) -> None:
            if texts is None:
                self.refresh_form()
                return
            path, time = texts["file"], texts["time"]
            if texts["how"] == "refer":
                given = {"file": path} | ({"time": time} if time else {})
                self.change(lambda water: water.put_form(_CURRENT, given), f"current of {path}")
                return
            self.tell(f"Reading {path} …")
            self._import(path, time, self.water)

        if self.settle():
            self.app.push_screen(ImportSheet(self._folder), take)

    @work(thread=True, exit_on_error=False)
    def _import(self, path: str, time: str, water: Water) -> None:
        from calm.tui.water.current_import import imported

        try:
            read = imported(self._folder / path, time, water.depth or USUAL_DEPTH)
        except CalmError as error:
            reason = str(error).partition("\n")[0]
            self.post_message(self.Imported(water.variant, path, reason=reason))
        except Exception as error:  # the libraries that read NetCDF raise whatever they like
            reason = f"{path} cannot be read: {type(error).__name__}: {error}"
            self.post_message(self.Imported(water.variant, path, reason=reason))
        else:
            self.post_message(self.Imported(water.variant, path, *read))

    @on(Imported)
    def _take_import(self, event: Imported) -> None:
        if event.reason:
            self.tell(event.reason, wrong=True)
        elif event.variant != self.water.variant:
            self.tell(f"{event.path} was read for another environment; read it again", wrong=True)
        else:
            self._take_rows_of(event.columns, event.rows, f"current of {event.path}")
            self.tell(f"The current of {event.path} is in the table")

    @property
    def _folder(self) -> Path:
        path = self.session.file.path
        return Path.cwd() if path is None else path.absolute().parent

    # the way back

    def action_undo(self) -> None:
        """Take the last change back, or what is typed where that is bad."""
        if self.settle():
            super().action_undo()
        else:
            self.drop_typing()
            self.refresh_form()

    def action_back(self) -> None:
        """Back to the line; what is typed is taken where it is good, and dropped elsewhere."""
        self.settle()
        self.dismiss()  # not waited for: it ends the very loop that would wait
