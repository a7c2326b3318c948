"""`calm page` in a browser, with the real runtime.

Skipped unless CALM_PAGE_RUNTIME names a folder with a release of Pyodide and xterm.js. With
CALM_BROWSER_PICTURES, a folder, it takes pictures.
"""

import contextlib
import functools
import http.server
import os
import re
import shutil
import threading
import time
import zipfile
from pathlib import Path

import pytest

from calm.page import folder
from calm.page.folder import write_page
from calm.shipped import shipped_folder

RUNTIME = os.environ.get("CALM_PAGE_RUNTIME")
CHROMIUM = next(
    filter(None, map(shutil.which, ("chromium", "chromium-browser", "google-chrome"))), None
)
pytestmark = [
    pytest.mark.thorough,
    pytest.mark.skipif(not RUNTIME, reason="CALM_PAGE_RUNTIME names no folder with Pyodide"),
    pytest.mark.skipif(CHROMIUM is None, reason="there is no Chromium"),
]
PATIENCE = 120e3  # milliseconds
QUIET = ["--no-sandbox", "--disable-background-networking", "--disable-component-update"]

SCREEN = """() => {
    const shown = globalThis.calm?.terminal.buffer.active;
    if (!shown) return "";
    const rows = [...Array(globalThis.calm.terminal.rows).keys()];
    return rows.map((y) => shown.getLine(y).translateToString(true)).join("\\n");
}"""


KEPT = """() => new Promise((done) => {
    indexedDB.open("/moorings").onsuccess = ({ target: { result } }) => {
        const names = result.transaction("FILE_DATA").objectStore("FILE_DATA").getAllKeys();
        names.onsuccess = () => {
            result.close();
            done(names.result.some((name) => name.endsWith(".calm-autosave")));
        };
    };
})"""
"""Whether the browser has a copy of unsaved work."""


class Files(http.server.SimpleHTTPRequestHandler):
    """A server of files, nothing else; what was asked for is noted."""

    asked: list[str] = []  # noqa: RUF012

    def log_message(self, *_):
        self.asked.append(self.path)


class Elsewhere(Files):
    """A server of the runtime for pages of other servers, as Pyodide's address is one."""

    def translate_path(self, path):
        name = Path(path.partition("?")[0]).name
        return str(next(Path(RUNTIME).rglob(name)))

    def end_headers(self):
        self.send_header("Access-Control-Allow-Origin", "*")
        self.send_header("Cache-Control", "no-store")  # by the browser itself
        super().end_headers()


def until(condition):
    deadline = time.monotonic() + PATIENCE / 1e3
    while not condition():
        assert time.monotonic() < deadline
        time.sleep(0.2)


@contextlib.contextmanager
def served(handler):
    with http.server.ThreadingHTTPServer(("127.0.0.1", 0), handler) as server:
        threading.Thread(target=server.serve_forever, daemon=True).start()
        yield f"http://127.0.0.1:{server.server_port}/"
        server.shutdown()


@pytest.fixture(scope="module")
def address(tmp_path_factory):
    made = tmp_path_factory.mktemp("page")
    write_page(made, Path(RUNTIME))
    with served(functools.partial(Files, directory=str(made))) as address:
        yield f"{address}index.html"


@pytest.fixture
def address_of_page_alone(tmp_path, monkeypatch):
    """A page that loads its runtime from another server."""
    with served(Elsewhere) as elsewhere:
        monkeypatch.setattr(folder, "PYODIDE", elsewhere)
        monkeypatch.setattr(folder, "TERMINAL", elsewhere)
        write_page(tmp_path)
        with served(functools.partial(Files, directory=str(tmp_path))) as address:
            yield address


@pytest.fixture(scope="module")
def browser():
    from playwright.sync_api import sync_playwright

    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=CHROMIUM, args=QUIET)
        yield browser
        browser.close()


class Visit:
    """A page that has been opened, and what it asked for and complained of."""

    def __init__(self, context, address):
        self.page = context.new_page()
        self.asked, self.complained, self.told = [], [], []
        self.page.on("console", self._heard)
        self.page.on("pageerror", lambda error: self.complained.append(str(error)))
        self.page.on("request", lambda request: self.asked.append(request.url))
        self.page.add_init_script("delete globalThis.showOpenFilePicker")
        self.page.goto(address)
        self.page.wait_for_selector("#loading", state="hidden", timeout=PATIENCE)

    def _heard(self, message):
        (self.complained if message.type == "error" else self.told).append(message.text)

    def shows(self, pattern):
        """Wait until the screen has a text."""
        found = "(pattern) => new RegExp(pattern).test((" + SCREEN + ")())"
        try:
            self.page.wait_for_function(found, arg=pattern, timeout=PATIENCE)
        except Exception:
            print(self.page.evaluate(SCREEN))
            raise

    def picture(self, name):
        if pictures := os.environ.get("CALM_BROWSER_PICTURES"):
            self.page.wait_for_timeout(400)
            self.page.screenshot(path=f"{pictures}/{name}.png")

    def download(self, press):
        with self.page.expect_download(timeout=PATIENCE) as waiting:
            press()
        return waiting.value.suggested_filename, Path(waiting.value.path()).read_bytes()

    def answer_ms(self, press):
        """Time from some keys to the last change of the terminal that follows them."""
        return self.page.evaluate(
            """async (keys) => {
                const { terminal, send } = globalThis.calm;
                const begun = performance.now();
                let last = 0;
                const writes = terminal.onWriteParsed(() => { last = performance.now(); });
                keys.forEach(([kind, text]) => send({ kind, text }));
                const done = () => last && performance.now() - last > 1500;
                while (!done()) await new Promise((then) => setTimeout(then, 20));
                writes.dispose();
                return Math.round(last - begun);
            }""",
            press,
        )


@pytest.fixture
def visit(browser, address):
    context = browser.new_context(viewport={"width": 1366, "height": 800}, accept_downloads=True)
    made = Visit(context, address)
    yield made
    context.close()
    assert not made.complained


def test_a_line_is_opened_edited_saved_and_printed(visit, tmp_path):
    page = visit.page
    visit.shows("ADCP")
    visit.shows(r"depth m")
    visit.picture("page-first")
    print("\n".join(visit.told))

    page.select_option("#examples", "s1000.yaml")
    visit.shows(r"s1000\.yaml")
    visit.shows(r"131\.4")  # the depth of the float, as `calm run` has it
    down, up = [["key", "down"]], [["key", "up"]]
    print("cursor key, ms:", [visit.answer_ms(down), visit.answer_ms(up)])
    edit = [*down, ["type", "l"], ["type", "990 m"], ["key", "enter"]]
    print("length of the cable edited, ms:", visit.answer_ms(edit))
    visit.shows(r"990")
    page.click("#actions >> text=Undo")
    visit.shows(r"1000")
    visit.picture("page-s1000")

    name, content = visit.download(lambda: page.click("#actions >> text=Save"))
    assert (name, content) == ("s1000.yaml", (shipped_folder("lines") / name).read_bytes())

    # a file of one's own, with the environment that it names
    own = tmp_path / "mine.yaml"
    text = (shipped_folder("lines") / "upward-adcp-300m.yaml").read_text(encoding="utf-8")
    own.write_text(re.sub(r"(?m)^name:.*", "name: My own mooring", text), encoding="utf-8")
    page.set_input_files("#chosen", own)
    visit.shows("My own mooring")
    visit.picture("page-own")

    for kind, suffix, begins in (
        ("Report", "-report.html", b"<!doctype html>"),
        ("Diagram", "-diagram.svg", b"<svg"),
        ("Bill", "-bill.csv", b""),
        ("Deck lists", "-deck.xlsx", b"PK"),
    ):
        name, content = visit.download(lambda kind=kind: page.click(f"#documents >> text={kind}"))
        assert name == f"mine{suffix}"
        assert content.lower().startswith(begins.lower()) and len(content) > 500
        if pictures := os.environ.get("CALM_BROWSER_PICTURES"):
            (Path(pictures) / name).write_bytes(content)
    visit.picture("page-documents")
    assert not [
        url for url in visit.asked if not url.startswith(("http://127.0.0.1", "blob:", "data:"))
    ]


def test_a_file_is_dropped_on_the_page(visit):
    visit.shows("ADCP")
    text = (shipped_folder("lines") / "s1000.yaml").read_text(encoding="utf-8")
    visit.page.evaluate(
        """(text) => {
            const given = new DataTransfer();
            given.items.add(new File([text], "dropped.yaml"));
            dispatchEvent(new DragEvent("drop", { dataTransfer: given, cancelable: true }));
        }""",
        text,
    )
    visit.shows(r"dropped\.yaml")
    visit.shows(r"131\.4")


def test_mouse_and_help(visit):
    visit.shows("ADCP")
    visit.page.click("#actions >> text=Help")
    visit.shows("Edit the value under the cursor")
    visit.picture("page-help")
    visit.page.click("#actions >> text=Water")
    visit.page.wait_for_function("document.getElementById('told').textContent.includes('Esc')")
    visit.page.keyboard.press("Escape")
    visit.shows("ADCP float +302")  # the line, behind the help until now
    visit.page.click("#actions >> text=Water")
    visit.shows("The water of")
    visit.picture("page-water")


def test_a_page_that_loads_its_runtime_from_elsewhere_is_kept(browser, address_of_page_alone):
    context = browser.new_context(viewport={"width": 1366, "height": 800})
    Visit(context, address_of_page_alone).page.close()
    context.set_offline(True)
    again = Visit(context, address_of_page_alone)
    again.shows("ADCP")
    context.close()
    assert not again.complained


def test_it_works_without_a_network_and_goes_on_where_it_was(browser, address):
    context = browser.new_context(viewport={"width": 1366, "height": 800})
    first = Visit(context, address)
    first.page.click("text=New")
    first.shows("The line is empty")
    first.page.keyboard.type("b")  # starts from a template: the first of the list
    first.shows("Begin with")
    first.page.keyboard.press("1")
    first.shows("not saved")
    until(lambda: first.page.evaluate(KEPT))
    first.page.close()
    context.set_offline(True)
    Files.asked.clear()
    again = Visit(context, address)
    again.shows("mooring.yaml")
    again.shows("Unsaved work")  # of the first visit
    again.picture("page-offline")
    looked_for = {each.partition("?")[0] for each in Files.asked}
    assert looked_for <= {"/offline.js"}  # whether there is a new version
    context.close()
    assert not again.complained


def test_the_archive_holds_no_compiled_code_and_no_tests(tmp_path):
    write_page(tmp_path, Path(RUNTIME))
    with zipfile.ZipFile(tmp_path / "calm.zip") as archive:
        assert not [name for name in archive.namelist() if name.endswith(".so")]
