"""What is done with environments and currents on the screen of the water."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING

from textual.screen import Screen

from calm.errors import CalmError
from calm.files.editing import Draft
from calm.tui.bars import KeyBar
from calm.tui.checking import needed
from calm.tui.dialogs import Answer, Asked, Question, Sheet
from calm.tui.field import Field
from calm.tui.messages import Edited
from calm.tui.presets import COLUMNS, PRESETS
from calm.tui.session import Session
from calm.tui.water_form import Water

if TYPE_CHECKING:
    from calm.tui.live import View


class WaterVerbs(Screen[None]):
    """A screen that shows the water of a file and can `refresh_form`."""

    def __init__(self, session: Session, view: View | None) -> None:
        super().__init__()
        self.session = session
        self.view = view

    def refresh_form(self) -> None:
        """Show what the file says now."""
        raise NotImplementedError

    @property
    def water(self) -> Water:
        """The environment that is shown, as the file has it now."""
        draft = self.session.draft
        named = draft.value(("environments",))
        variant = self.session.environment
        return Water(draft, variant if isinstance(named, dict) and variant in named else None)

    def tell(self, text: str, *, wrong: bool = False) -> None:
        """Say something in the last line."""
        self.query_one(KeyBar).tell(text, wrong=wrong)

    def change(self, make: Callable[[Water], Draft], label: str) -> None:
        """Change the file; what refuses is told."""
        try:
            self.session.do(make(self.water), label)
        except CalmError as error:
            self.tell(str(error), wrong=True)
        self.refresh_form()
        self.post_message(Edited())

    def action_next_environment(self) -> None:
        """Show the next environment, and stand the line in it."""
        named = self.session.draft.value(("environments",))
        names = [None, *(named if isinstance(named, dict) else ())]
        here = names.index(self.water.variant)
        self._stand_in(names[(here + 1) % len(names)])

    def _stand_in(self, name: str | None) -> None:
        self.session.environment = name
        for field in self.query(Field):
            field.remove_class("-wrong")
        self.refresh_form()
        self.post_message(Edited())

    def action_new_environment(self) -> None:
        """A named environment with the current of the one that is shown."""

        def take(texts: dict[str, str] | None) -> None:
            if texts is None:
                return
            name, water = texts["name"], self.water
            current = water.value("current") or {"speed": "0.5 m/s", "toward": "90 deg"}
            place = ("environments", name, "current")
            self.change(lambda _: water.draft.put_at(place, current), f"environment {name}")
            self._stand_in(name)

        asked = [Asked("name", "Name", check=needed("a name"), placeholder="storm")]
        text = "It says only what differs from the file's own environment."
        self.app.push_screen(Sheet("Another environment", text, asked), take)

    def action_drop_environment(self) -> None:
        """Take the named environment out of the file."""
        name = self.water.variant
        if name is None:
            self.tell("The file's own environment stays; F5 goes to a named one")
            return
        self.change(lambda water: water.draft.put_at(water.place, None), f"drop {name}")
        self._stand_in(None)

    def action_preset(self) -> None:
        """A profile to begin with."""

        def take(key: str | None) -> None:
            chosen = next((preset for preset in PRESETS if preset.key == key), None)
            if chosen is not None:
                rows = chosen.rows(self.water.depth)
                self.change(
                    lambda water: water.put_rows("current", COLUMNS, rows), "a preset current"
                )

        answers = [Answer(preset.key, preset.name, preset.key) for preset in PRESETS]
        text = (
            f"As a table down to {self.water.depth:g} m, towards the east; then change its figures."
        )
        self.app.push_screen(Question("A current to begin with", text, answers), take)

    def action_load_current(self) -> None:
        """A current from CSV or NetCDF: referred to, or its profile copied."""
        from calm.tui.current_import import ImportSheet, imported

        def take(texts: dict[str, str] | None) -> None:
            if texts is None:
                self.refresh_form()
                return
            path, time = texts["file"], texts["time"]
            if texts["how"] == "refer":
                self.change(lambda water: water.put_file(path, time), f"current of {path}")
                return
            try:
                columns, rows = imported(self._folder / path, time, self.water)
            except CalmError as error:
                self.tell(str(error).partition("\n")[0], wrong=True)
                return
            self.change(
                lambda water: water.put_rows("current", columns, rows), f"current of {path}"
            )

        self.app.push_screen(ImportSheet(self._folder), take)

    @property
    def _folder(self) -> Path:
        path = self.session.file.path
        return Path.cwd() if path is None else path.absolute().parent
