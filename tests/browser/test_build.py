"""`calm build --serve` in a browser: the line is drawn, keys arrive, strangers do not.

The tests are skipped where there is no Chromium, unless CALM_BROWSER_TESTS is 1.
"""

import asyncio
import os
import shutil
import socket
import subprocess
import sys
import time
import urllib.error
import urllib.request

import pytest

from calm.shipped import shipped_folder

pytestmark = pytest.mark.thorough

pytest.importorskip("textual_serve")

CHROMIUM = next(
    filter(None, map(shutil.which, ("chromium", "chromium-browser", "google-chrome"))), None
)
PATIENCE = 600.0  # seconds


@pytest.fixture
def served(tmp_path):
    """The address of a line builder that is served, and the file it builds."""
    file = tmp_path / "m.yaml"
    file.write_bytes((shipped_folder("lines") / "s1000.yaml").read_bytes())
    with socket.socket() as free:
        free.bind(("localhost", 0))
        port = free.getsockname()[1]
    words = [str(file), "--serve", "--port", str(port)]
    command = [sys.executable, "-m", "calm", "build", *words]
    with subprocess.Popen(command, stderr=subprocess.PIPE, text=True) as server:
        told = server.stderr.readline()
        address = told.removeprefix("calm build is at ").strip()
        assert address.startswith(f"http://localhost:{port}/?token="), told
        yield address, file
        server.terminate()


@pytest.fixture
def browser():
    if CHROMIUM is None and os.environ.get("CALM_BROWSER_TESTS") != "1":
        pytest.skip("there is no Chromium")
    from playwright.sync_api import sync_playwright

    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=CHROMIUM, args=["--no-sandbox"])
        yield browser
        browser.close()


def opened(browser, address, **options):
    """A page with the line on it, what it asked for, and what it complained of."""
    page = browser.new_page(**options)
    asked, complained = [], []
    page.on("console", lambda each: each.type != "error" or complained.append(each.text))
    page.on("pageerror", lambda error: complained.append(str(error)))
    page.on("request", lambda request: asked.append(request.url))
    page.goto(address)
    page.wait_for_selector("body.-first-byte", timeout=PATIENCE * 1e3)
    page.wait_for_timeout(3000)
    if folder := os.environ.get("CALM_BROWSER_PICTURES"):
        width = page.viewport_size["width"]
        page.screenshot(path=f"{folder}/build-{width}.png")
    return page, asked, complained


def saved(page, file, words):
    """Whether a text comes to stand in the file."""
    deadline = time.monotonic() + PATIENCE
    while words not in file.read_bytes() and time.monotonic() < deadline:
        page.wait_for_timeout(100)
    return words in file.read_bytes()


@pytest.mark.parametrize("host", ["localhost", "127.0.0.1"])
def test_the_line_is_built_in_a_browser_without_a_click(served, browser, host):
    address, file = served
    address = address.replace("localhost", host)
    size = {"width": 1366, "height": 768}
    page, asked, complained = opened(browser, address, viewport=size)
    screen = page.locator(".xterm-screen").bounding_box()
    assert screen["y"] + screen["height"] <= size["height"]
    assert screen["x"] + screen["width"] <= size["width"]
    assert screen["height"] > 0.94 * size["height"]
    page.keyboard.type("nnamed in a browser")
    page.keyboard.press("Enter")
    page.keyboard.press("Control+s")
    assert saved(page, file, b"label: named in a browser")
    root = address.partition("?")[0]
    own = (root, root.replace("http", "ws"), "data:")
    assert not [url for url in asked if not url.startswith(own)]
    assert any(url.endswith("xterm.css") for url in asked)
    assert not complained


def status(address, **headers):
    try:
        with urllib.request.urlopen(urllib.request.Request(address, headers=headers)) as answer:
            return answer.status
    except urllib.error.HTTPError as refused:
        with refused:
            return refused.code


def test_another_sites_page_is_refused(served):
    address, _ = served
    root, _, query = address.partition("/?token=")
    own = root.removeprefix("http://")
    for path in (f"/?token={query}", f"/ws/{query}"):
        assert status(root + path, Host="elsewhere.example") == 403
        assert status(root + path, Origin="http://elsewhere.example") == 403
        assert status(root + path, Origin="null") == 403
        assert status(root + path, Host="localhost.elsewhere.example") == 403
    assert status(root + "/") == status(root + "/?token=x") == status(root + "/ws/x") == 403
    assert status(address, Host=own, Origin=root) == 200
    assert status(address, Host=own.upper()) == 200
    assert status(address, Host="127.0.0.1:9000", Origin="http://127.0.0.1:9000") == 200  # a tunnel
    assert status(address, Host="[::1]:80") == 200
    assert status(root + "/favicon.ico") == 204  # browsers ask for it


def test_the_address_of_the_usual_port_has_none():
    from calm.tui.serve import Browser

    assert Browser(["calm"], 80, print, token="t").address == "http://localhost/?token=t"
    tokens = {Browser(["calm"], 8000, print).token for _ in range(10)}
    assert len(tokens) == 10 and min(map(len, tokens)) >= 32


def test_each_word_of_the_command_stays_one():
    from calm.tui.serve import Browser

    words = [sys.executable, "-c", "import sys; print(sys.argv[1:])", "a b", "it's", '"c"', "$d"]
    done = subprocess.run(Browser(words, 8000, print).command, shell=True, capture_output=True)
    assert done.stdout.decode().strip() == str(words[3:])


def test_a_closed_page_keeps_the_work(served, tmp_path):
    """Through the web socket, as a browser does it."""
    address, file = served
    asyncio.run(_type_and_close(address, b"nkept\r"))
    deadline = time.monotonic() + PATIENCE
    while not (copies := list(tmp_path.glob(".m.yaml.*.calm-autosave"))):
        assert time.monotonic() < deadline
        time.sleep(0.05)
    assert b"label: kept" in copies[0].read_bytes()
    assert b"kept" not in file.read_bytes()


async def _type_and_close(address, keys):
    from aiohttp import ClientSession

    root, _, token = address.partition("/?token=")
    place = f"{root}/ws/{token}?width=110&height=40"
    async with ClientSession() as session, session.ws_connect(place, origin=root) as page:
        await _until(page, b"Anchor")
        await page.send_json(["stdin", keys.decode()])
        await _until(page, b"not saved")


async def _until(page, word):
    """Until the page has been sent a word of the screen."""
    shown = b""
    while word not in shown:
        message = await page.receive(timeout=PATIENCE)
        shown += message.data if isinstance(message.data, bytes) else b""
