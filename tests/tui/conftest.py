"""The line builder without a terminal: keys in, screens and files out."""

import asyncio
from contextlib import asynccontextmanager

import pytest
from textual._compositor import Compositor
from textual._context import active_app
from textual.css.stylesheet import Stylesheet
from textual.pilot import Pilot

from calm.case.memory import Memory
from calm.tui.app import BuildApp
from calm.tui.line_table import LineTable
from calm.tui.start import open_session

MOORING = """\
# A mooring for tests: small, and nothing of it from the catalogue.
name: Small
environment:
  depth: 100 m                        # at low water
  current: {speed: 0.5 m/s, toward: 90 deg}

line:
  - {use: ball, label: top float}     # carries all
  - use: rope
    length: 60 m
    clamps:
      - {use: logger, at: 10 m}
      - {use: logger, at: 20 m, label: deep logger}
  # the release is ours
  - {use: releaser}
  - {use: weight}

components:
  ball: {kind: sphere, role: float, diameter: 1 m, buoyancy: 2000 N, depth_rating: 300 m}
  rope: {kind: cable, diameter: 10 mm, weight: 0.2 N/m, breaking_load: 20 kN, stiffness: 200 kN}
  logger: {kind: cylinder, diameter: 40 mm, length: 0.3 m, buoyancy: -5 N}
  releaser: {kind: cylinder, role: release, diameter: 0.2 m, length: 1 m, buoyancy: -200 N}
  weight: {kind: anchor, weight: 5000 N}
"""

PAINT = Compositor.render_update
REMEMBER = Memory.__init__
PARSE = Stylesheet._parse_rules
PARSED = {}
"""The rules of style sheets by text and variables, alike for all applications."""
TERMINAL = {"TERM": "xterm-256color"}

NAMES = {
    " ": "space", "-": "minus", ".": "full_stop", ":": "colon", "/": "slash", ",": "comma",
}  # fmt: skip


async def at_rest(*_, **__):
    """Until all keys are handled, the queues are empty and the screen is painted.

    Takes the place of two waits of textual: one asks the clock whether the processor is idle, 40 ms
    a key at the least and no proof where the machine is slow; the other sends every widget a
    message, of which it handles four a key.
    """
    app, quiet = active_app.get(), 0
    while quiet < 5 and not app._exit and app._exception is None:
        await asyncio.sleep(0)
        screen, quiet = app.screen, quiet + 1
        if any(map(is_busy, (app, *app.screen_stack, *screen.walk_children()))):
            quiet = 0
        elif screen._callbacks or screen._dirty_widgets or screen._layout_required:
            quiet = 0
            screen._on_timer_update()
        elif app.has_keys_waiting:
            quiet = 0
    return app._exception is None


def is_busy(pump):
    """Whether a widget has messages, or is in the middle of one, or about to begin."""
    if pump._closing or pump._closed or pump._task is None:
        return False
    awaited = pump._message_queue.ready_event
    return awaited.is_set() or not awaited._waiters or bool(pump._next_callbacks)


async def at_once(*_):
    """The application itself lets a key wait for the one before."""
    await asyncio.sleep(0)


@pytest.fixture(autouse=True)
def no_clock(monkeypatch):
    """Nothing is waited for by the clock."""
    monkeypatch.setattr("textual.pilot.wait_for_idle", at_rest)
    monkeypatch.setattr(Pilot, "_wait_for_screen", at_rest)
    monkeypatch.setattr("textual.app.wait_for_idle", at_once)


@pytest.fixture(autouse=True, scope="session")
def solved_once():
    """What several tests solve is solved for the first of them."""
    shared = Memory()
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(Memory, "__init__", lambda memory: vars(memory).update(vars(shared)))
        yield


@pytest.fixture
def own_memory(monkeypatch, solved_once):
    """What is solved is forgotten with the session, as in the program."""
    monkeypatch.setattr(Memory, "__init__", REMEMBER)


@pytest.fixture(autouse=True)
def parsed_once(monkeypatch):
    """A style sheet is parsed for the first application that has it."""

    def parse(sheet, *source, **how):
        key = (source, tuple(how.items()), tuple(sheet._variables.items()))
        if key not in PARSED:
            PARSED[key] = PARSE(sheet, *source, **how)
        return PARSED[key]

    monkeypatch.setattr(Stylesheet, "_parse_rules", parse)


@pytest.fixture(autouse=True)
def unpainted(monkeypatch):
    """No terminal is there to be painted: what a test looks at is painted then, or at its end."""

    def leave(compositor, **_):
        compositor._dirty_regions.clear()

    monkeypatch.setattr(Compositor, "render_update", leave)


@pytest.fixture
def painted(monkeypatch, unpainted):
    """Every change is painted at once, as in a terminal."""
    monkeypatch.setattr(Compositor, "render_update", PAINT)


@pytest.fixture(autouse=True)
def folder(tmp_path, monkeypatch):
    """An empty working folder, and no settings of the person who runs the tests."""
    for name in ("NO_COLOR", "TEXTUAL_DRIVER", "COLORTERM", "CALM_DEBUG"):
        monkeypatch.delenv(name, raising=False)
    monkeypatch.setenv("XDG_CONFIG_HOME", str(tmp_path / "configuration"))
    monkeypatch.setenv("XDG_STATE_HOME", str(tmp_path / "state"))
    work = tmp_path / "work"
    work.mkdir()
    monkeypatch.chdir(work)
    return work


@pytest.fixture
def small(folder):
    path = folder / "small.yaml"
    path.write_text(MOORING, encoding="utf-8")
    return path


class Driver:
    """An application that is driven, as a test sees it."""

    def __init__(self, app, pilot):
        self.app, self.pilot, self.has_looked = app, pilot, False

    @property
    def session(self):
        return self.app.session

    @property
    def text(self):
        return self.session.draft.text

    @property
    def builder(self):
        return self.app.builder

    @property
    def table(self):
        return self.builder.query_one(LineTable)

    @property
    def view(self):
        return self.app.workspace.view

    @property
    def screen(self):
        """What the screen shows, as lines of text."""
        self.has_looked = True
        size = self.app.size
        strips = self.app.screen._compositor.render_strips(size)
        return "\n".join(strip.text.rstrip() for strip in strips)

    @property
    def uses(self):
        """The line, clamps indented."""
        found = []
        for item in self.session.draft.items:
            found.append(item.values["use"])
            found += ["  " + clamp.values["use"] for clamp in item.clamps]
        return found

    async def press(self, *keys):
        await self.pilot.press(*keys)
        await self.pilot.pause()

    async def type(self, text):
        await self.press(*(NAMES.get(letter, letter) for letter in text))

    async def settle(self):
        """Until all that was started is done and shown."""
        for _ in range(3):
            await self.pilot.pause()
        for _ in range(200):
            await self.app.workers.wait_for_complete()
            await self.pilot.pause()
            if self.app.is_idle:
                break
        await self.pilot.pause()


@asynccontextmanager
async def driven(path=None, size=(120, 36), *, environ=TERMINAL, environment=None):
    session, kept = open_session(path, environment)
    app = BuildApp(session, kept=kept, environ=environ)
    async with app.run_test(size=size) as pilot:
        driver = Driver(app, pilot)
        await driver.settle()
        yield driver
        if app.is_running and not driver.has_looked:
            assert driver.screen


@pytest.fixture
def drive():
    """Runs a story: a coroutine function that is given the driver of a file."""

    def run(story, path=None, **options):
        async def play():
            async with driven(path, **options) as driver:
                await story(driver)

        asyncio.run(play())

    return run
