"""The builder of a page under CPython: its driver, and the files that go in and come out."""

import asyncio
import time
import zipfile
from functools import partial
from io import BytesIO

import pytest
from textual.widgets import Input

from calm.files.editing.working_file import Keeper
from calm.page import driver
from calm.page.builder import BAR, FIRST, WebPage
from calm.page.documents import DOCUMENTS
from calm.shipped import shipped_folder
from calm.tui.key_table import ACTIONS

PATIENCE = 60.0  # seconds


class Sent:
    """What the page was sent, and the text on its terminal so far."""

    def __init__(self):
        self.messages, self.written = [], ""

    def __call__(self, kind, text, content):
        if kind == "write":
            self.written += text
        else:
            self.messages.append((kind, text, content))

    def of(self, kind):
        return [(text, content) for sent, text, content in self.messages if sent == kind]


async def until(condition):
    """Wait for something; what it is then."""
    deadline = time.monotonic() + PATIENCE
    while not (found := condition()):
        assert time.monotonic() < deadline
        await asyncio.sleep(0.01)
    return found


@pytest.fixture
def visit(tmp_path, monkeypatch):
    """Run a story in a page: it is given the page and what it sends."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(driver, "terminal", None)

    def run(story):
        sent = Sent()

        async def told():
            page, over = WebPage(sent, tmp_path / "moorings", 130, 40), False

            async def built():
                while not over:
                    await page.build()

            building = asyncio.ensure_future(built())
            try:
                await until(lambda: page.app is not None and page.app.is_running)
                await until(lambda: page.app.is_idle)
                await story(page, sent)
            finally:
                over = True  # Textual may swallow a cancellation, and another builder would begin
                while not building.done():
                    if page.app is not None:
                        page.app.exit(0)
                    await asyncio.sleep(0.02)

        asyncio.run(told())
        return sent

    return run


def test_a_first_visit_shows_an_example(visit):
    async def story(page, sent):
        assert sent.of("open") == [(FIRST, None)]
        assert "ADCP" in sent.written
        assert sent.written.startswith("\x1b[?1049h")

    visit(story)


def key(text):
    return {"kind": "key", "text": text}


def mouse(text, x, y, button=0):
    held = {"shift": False, "alt": False, "ctrl": False}
    return {"kind": "mouse", "text": text, "x": x, "y": y, "button": button, "held": held}


def test_keys_mouse_and_sizes_arrive(visit):
    async def story(page, sent):
        app = page.app
        page.receive({"kind": "resize", "columns": 100, "rows": 30})
        await until(lambda: app.size == (100, 30))
        page.receive({"kind": "type", "text": "m"})
        await until(lambda: app.screen is not app.builder)
        page.receive(key("escape"))
        await until(lambda: app.screen is app.builder)
        table = app.builder.query_one("LineTable")
        first = table.cursor
        page.receive(mouse("scroll down", 10, 5))
        for kind in ("move", "down", "up"):
            page.receive(mouse(kind, 10, 6, button=0 if kind == "move" else 1))
        await until(lambda: table.cursor != first)
        page.receive(key("up"))
        await until(lambda: app.is_idle and not app.has_keys_waiting)

    visit(story)


def test_text_is_typed_and_pasted_into_a_field(visit):
    async def story(page, sent):
        app = page.app
        page.receive(key("n") | {"kind": "type"})  # the label in place
        await until(lambda: isinstance(app.focused, Input))
        page.receive({"kind": "type", "text": "/-\x01 é"})
        page.receive({"kind": "paste", "text": "深 end"})
        await until(lambda: app.focused.value.endswith("/- é深 end"))
        page.receive({"kind": "type", "text": "\r"})  # as an on-screen keyboard sends it
        await until(lambda: "深 end" in app.session.draft.text)

    visit(story)


def test_a_paste_on_the_line_pastes_the_copied_rows(visit):
    async def story(page, sent):
        pieces = page.app.session.draft.text.count("use:")
        page.receive(key("ctrl+c"))
        page.receive({"kind": "paste", "text": ""})
        await until(lambda: page.app.session.draft.text.count("use:") == pieces + 1)

    visit(story)


def test_a_copied_text_goes_to_the_clipboard_of_the_browser(visit):
    async def story(page, sent):
        page.app.copy_to_clipboard("some text")
        assert sent.of("copied") == [("some text", None)]

    visit(story)


@pytest.mark.parametrize("name", [each.action for each in BAR])
def test_every_button_is_an_action(name):
    places = ("anywhere",) if name.startswith("app.") else ("line", "anywhere")
    assert name in [each.name for place in places for each in ACTIONS[place]]


def test_a_saved_file_is_handed_over(visit):
    async def story(page, sent):
        page.receive({"kind": "act", "text": "app.save"})
        await until(lambda: sent.of("saved"))
        ((name, content),) = sent.of("saved")
        assert (name, content) == (FIRST, (shipped_folder("lines") / FIRST).read_bytes())

    visit(story)


def test_help_and_a_button_while_something_is_open(visit):
    async def story(page, sent):
        page.receive({"kind": "act", "text": "app.help"})
        await until(lambda: page.app.screen is not page.app.builder)
        page.receive({"kind": "act", "text": "water"})
        assert "Esc leads back" in sent.of("told")[0][0]

    visit(story)


def test_files_are_opened_and_unsaved_work_is_offered_again(visit, tmp_path, monkeypatch):
    own = b"name: Own\n"
    monkeypatch.setattr(Keeper, "is_running", property(lambda _: False))  # as in a page

    async def story(page, sent):
        page.receive({"kind": "act", "text": "delete"})
        await until(lambda: page.app.session.changed)
        files = [["C:\\seas\\water.yaml", b"environment: {depth: 90 m}\n"], ["own.yaml", own]]
        page.receive({"kind": "open", "files": files})
        await until(lambda: ("own.yaml", None) in sent.of("open"))
        assert (tmp_path / "moorings/water.yaml").is_file()
        assert (tmp_path / "moorings/own.yaml").read_bytes() == own
        assert sent.of("told") == [("water.yaml can now be used in a mooring file", None)]
        page.receive({"kind": "example", "text": FIRST})
        await until(lambda: sent.of("open")[-1][0] == FIRST)
        await until(lambda: page.app is not None and page.app.is_running)
        await until(lambda: page.app.screen is not page.app.builder)  # the offer

    visit(story)


def test_a_file_that_is_no_text_is_refused(visit, tmp_path):
    async def story(page, sent):
        page.receive({"kind": "open", "files": [["photo.yaml", bytes(range(256))]]})
        assert sent.of("failed") == [("photo.yaml: is a binary file; text is needed", None)]
        assert sent.of("open") == [(FIRST, None)]
        assert not (tmp_path / "moorings/photo.yaml").exists()

    visit(story)


def test_new_begins_an_empty_line_with_a_name_of_its_own(visit):
    async def story(page, sent):
        page.receive({"kind": "new"})
        await until(lambda: sent.of("open")[-1][0] == "mooring.yaml")

    visit(story)


def test_a_later_visit_goes_on_with_the_last_file(visit, tmp_path):
    (tmp_path / "moorings").mkdir()
    (tmp_path / "moorings/kept.yaml").write_text("name: Kept\n", encoding="utf-8")

    async def story(page, sent):
        assert sent.of("open") == [("kept.yaml", None)]
        page.receive({"kind": "document", "text": "report"})
        ((told, _),) = await until(lambda: sent.of("failed"))
        assert told == "the line is incomplete; the verdict names the missing parts"

    visit(story)


def test_every_document_is_made(visit):
    async def story(page, sent):
        for number, each in enumerate(DOCUMENTS, 1):
            page.receive({"kind": "document", "text": each.kind})
            made = partial(lambda number: len(sent.of("document")) == number, number)
            await until(lambda made=made: made() or sent.of("failed"))
        assert not sent.of("failed")

    sent = visit(story)
    made = dict(sent.of("document"))
    assert list(made) == [f"upward-adcp-300m{each.suffix}" for each in DOCUMENTS]
    report, diagram, bill, deck = made.values()
    assert report.startswith(b"<!DOCTYPE html>") and diagram.startswith(b"<svg")
    assert b"label,use" in bill.partition(b"\n")[0]
    assert zipfile.is_zipfile(BytesIO(deck))


def test_a_tow_has_a_report(visit):
    async def story(page, sent):
        page.receive({"kind": "example", "text": "helicopter-bird.yaml"})
        await until(lambda: sent.of("open")[-1][0] == "helicopter-bird.yaml")
        await until(lambda: page.app is not None and page.app.is_running and page.app.is_idle)
        page.receive({"kind": "document", "text": "report"})
        await until(lambda: sent.of("document"))
        page.receive({"kind": "document", "text": "deck"})
        assert await until(lambda: sent.of("failed")) == [
            ("for a tow, only the report is available", None)
        ]

    visit(story)
