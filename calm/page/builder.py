"""Line builder in a web page, controlled by messages from the page."""

from __future__ import annotations

import asyncio
import os
import sys
import traceback
from collections.abc import Callable, Mapping
from pathlib import Path, PurePosixPath
from typing import Any, NamedTuple

from textual.widgets import Input, TextArea

from calm.errors import CalmError, InputError, unexpected
from calm.files.editing import KeptWork
from calm.files.editing.working_file import SUFFIX
from calm.page import documents, driver
from calm.shipped import shipped_folder
from calm.tui.app import BuildApp
from calm.tui.key_table import ACTIONS
from calm.tui.session import Session
from calm.tui.start import open_session
from calm.whole_file import decoded

Post = Callable[[str, str, bytes | None], object]
"""Function that sends a message to the page.

Its arguments are the kind, a text (often a file name), and the content of a file or None.
"""


class Button(NamedTuple):
    """A button of the page, with its title and the name of its action."""

    title: str
    action: str


BAR = (
    Button("Save", "app.save"),
    Button("Undo", "undo"),
    Button("Redo", "redo"),
    Button("Add a piece", "search('below')"),
    Button("Delete", "delete"),
    Button("Water", "water"),
    Button("Advice", "advise"),
    Button("Name", "sheet('mooring')"),
    Button("Text", "text"),
    Button("Help", "app.help"),
)

FIRST = "upward-adcp-300m.yaml"
"""Example shown on the first visit (later visits open the latest file)."""
_YAML = ".yaml", ".yml"
NEW = "mooring.yaml"
"""Name of a new file."""


class PageBuilder(BuildApp):
    """Line builder that sends every saved file to the page."""

    def __init__(self, session: Session, kept: KeptWork | None, page: WebPage) -> None:
        super().__init__(session, kept=kept)
        self.workspace.documents_elsewhere = (
            "The buttons above the line make its report, diagram and bill of material"
        )
        session.after_save = page.hand_over
        self._page = page

    def copy_to_clipboard(self, text: str) -> None:
        super().copy_to_clipboard(text)
        self._page.copy(text)

    def get_driver_class(self) -> type[driver.PageDriver]:
        return driver.PageDriver  # the drivers of Textual need a terminal


class WebPage:
    """Python side of the page, which runs the builder on a file in memory.

    Parameters
    ----------
    post : function that sends a message of one of these kinds to the page:

        - `write`: text for the terminal
        - `open`: name of the edited file
        - `saved`, `document`: name and content of a file
        - `copied`: text for the clipboard
        - `told`, `failed`: a sentence for the user
    folder : folder of the files
    columns, rows : size of the terminal
    """

    def __init__(self, post: Post, folder: str | Path, columns: int, rows: int) -> None:
        self._post, self._folder = post, Path(folder)
        self._app: PageBuilder | None = None
        self.terminal = driver.terminal = driver.PageTerminal(self._write, columns, rows)
        self._folder.mkdir(parents=True, exist_ok=True)
        os.chdir(self._folder)
        earlier = sorted(self._folder.glob("*.yaml"), key=_touched)
        if earlier:
            self._path = earlier[-1]
        else:
            self._path = self._folder / FIRST
            self._path.write_bytes((shipped_folder("lines") / FIRST).read_bytes())

    def _write(self, text: str) -> None:
        self._post("write", text, None)

    def hand_over(self, path: Path, text: str) -> None:
        """Send a saved file to the page."""
        self._path = path
        self._post("saved", path.name, text.encode())

    def copy(self, text: str) -> None:
        """Send a text to the clipboard of the browser."""
        self._post("copied", text, None)

    # the builder

    async def run(self) -> None:
        """Run the builder without end, each time for the file opened last."""
        while True:
            await self.build()

    async def build(self) -> None:
        """Run the builder for the file opened last until the user opens another file or quits."""
        reason = ""
        try:
            session, kept = open_session(self._path)
        except CalmError as error:
            self._path, reason = _free(self._folder), str(error)
            session, kept = open_session(self._path)
        self._app = PageBuilder(session, kept, self)
        self._post("open", self._path.name, None)
        if reason:
            self._post("failed", reason, None)
        await self._app.run_async()
        self._app = None

    @property
    def app(self) -> PageBuilder | None:
        """The running builder, or None if no builder is running."""
        return self._app

    def receive(self, message: Mapping[str, Any]) -> None:
        """Handle a message from the page.

        The kinds of messages are:

        - `key`: a key in Textual's notation
        - `type`, `paste`: a text
        - `mouse`: arguments of `PageDriver.move_mouse`
        - `resize`: number of columns and rows
        - `act`: an action of `BAR`
        - `open`: names and contents of files
        - `example`: name of a file in `lines`
        - `new`: no content
        - `document`: kind of document
        """
        kind, app, given = message["kind"], self._app, self.terminal.driver
        if kind == "key" and given is not None:
            given.press(message["text"])
        elif kind == "type" and given is not None:
            given.type(message["text"])
        elif kind == "paste" and given is not None and app is not None:
            if isinstance(app.focused, Input | TextArea):
                given.paste(message["text"])
            else:
                given.press("ctrl+v")  # pastes copied rows
        elif kind == "mouse" and given is not None:
            x, y, button = message["x"], message["y"], message["button"]
            given.move_mouse(message["text"], x, y, button, message["held"])
        elif kind == "resize":
            self.terminal.resize(message["columns"], message["rows"])
        elif kind == "act" and app is not None:
            self._run_button(app, message["text"])
        elif kind == "open":
            self._open({str(name): bytes(content) for name, content in message["files"]})
        elif kind == "example":
            name = message["text"]
            self._open({name: (shipped_folder("lines") / name).read_bytes()})
        elif kind == "new":
            path = _free(self._folder)
            path.touch()  # so that a later visit finds its unsaved work
            self._turn_to(path)
        elif kind == "document":
            self._make_document(message["text"])

    def _run_button(self, app: PageBuilder, name: str) -> None:
        if name.startswith("app."):
            app.call_later(app.run_action, name)
        elif app.screen is not app.builder:
            self._post("told", "Close the open form first: Esc leads back to the line", None)
        else:
            app.take_typed()
            actions = (each for place in ("line", "anywhere") for each in ACTIONS[place])
            action = next(each for each in actions if each.name == name)
            app.call_later(app.simulate_key, action.keys.partition(",")[0])

    def _open(self, files: Mapping[str, bytes]) -> None:
        """Write files to the folder, and edit the first mooring among them."""
        paths = []
        for name, content in files.items():
            path = self._folder / PurePosixPath(name.replace("\\", "/")).name
            try:
                if path.suffix in _YAML:
                    decoded(Path(path.name), content)
            except InputError as error:
                self._post("failed", str(error), None)
                continue
            path.write_bytes(content)
            paths.append(path)
        moorings = [each for each in paths if _is_mooring(each)]
        others = [each.name for each in paths if each not in moorings[:1]]
        if others:
            self._post("told", f"{', '.join(others)} can now be used in a mooring file", None)
        if moorings:
            self._turn_to(moorings[0])

    def _turn_to(self, path: Path) -> None:
        self._path = path
        if self._app is not None:
            self._app.take_typed()
            self._app.exit(0)

    def _make_document(self, kind: str) -> None:
        app = self._app
        if app is None:
            return
        app.take_typed()
        if not app.workspace.is_fresh:  # wait until the current text is solved
            asyncio.get_running_loop().call_later(0.1, self._make_document, kind)
            return
        view = app.workspace.view
        assert view is not None
        try:
            name, content = documents.document(kind, view)
        except InputError as error:
            self._post("failed", error.problems[0].message, None)
        except CalmError as error:
            self._post("failed", str(error), None)
        except Exception as error:
            traceback.print_exc(file=sys.__stderr__)  # the console of the browser
            self._post("failed", unexpected(error), None)
        else:
            self._post("document", name, content)


def _is_mooring(path: Path) -> bool:
    from calm.files import yaml_document

    if path.suffix not in _YAML:
        return False
    try:
        data = yaml_document.compose(str(path), path.read_text("utf-8")).data
    except CalmError:
        return True  # the builder shows its mistakes
    return isinstance(data, dict) and bool({"line", "legs", "tow", "name"} & set(data))


def _touched(path: Path) -> float:
    """Return the time [s since 1970] when a file or its backup copy was last written."""
    kept = path.parent.glob(f".{path.name}.*{SUFFIX}")
    return max(each.stat().st_mtime for each in (path, *kept))


def _free(folder: Path) -> Path:
    names = [NEW, *(f"mooring-{number}.yaml" for number in range(2, 1000))]
    return next(path for path in map(folder.joinpath, names) if not path.exists())
