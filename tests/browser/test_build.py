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
    command = [sys.executable, "-m", "calm", "build", str(file), "--serve", "--port", str(port)]
    with subprocess.Popen(command, stderr=subprocess.PIPE, stdout=subprocess.PIPE) as server:
        address = f"http://localhost:{port}"
        deadline = time.monotonic() + PATIENCE
        while True:
            try:
                with urllib.request.urlopen(address) as answer:
                    assert answer.status == 200
                break
            except urllib.error.URLError:
                assert server.poll() is None, server.stderr.read()
                assert time.monotonic() < deadline
                time.sleep(0.1)
        yield address, file
        server.terminate()


def test_the_line_is_built_in_a_browser(served):
    if CHROMIUM is None and os.environ.get("CALM_BROWSER_TESTS") != "1":
        pytest.skip("there is no Chromium")
    from playwright.sync_api import sync_playwright

    address, file = served
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=CHROMIUM, args=["--no-sandbox"])
        page = browser.new_page(viewport={"width": 1200, "height": 800})
        asked, answered, complained = [], [], []
        page.on("console", lambda message: message.type == "log" or complained.append(message.text))
        page.on("pageerror", lambda error: complained.append(str(error)))
        page.on("request", lambda request: asked.append(request.url))
        page.on("response", lambda response: answered.append(response.url))
        page.goto(address)
        page.wait_for_selector("body.-first-byte", timeout=PATIENCE * 1e3)
        page.wait_for_timeout(3000)
        if folder := os.environ.get("CALM_BROWSER_PICTURES"):
            page.screenshot(path=f"{folder}/build.png")
        page.mouse.click(300, 600)
        page.keyboard.type("n")
        page.keyboard.type("named in a browser")
        page.keyboard.press("Enter")
        page.keyboard.press("Control+s")
        deadline = time.monotonic() + PATIENCE
        while b"named in a browser" not in file.read_bytes() and time.monotonic() < deadline:
            page.wait_for_timeout(100)
        browser.close()
    assert b"label: named in a browser" in file.read_bytes()
    own = (address, address.replace("http", "ws"), "data:")
    assert answered and not [url for url in asked if not url.startswith(own)]
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
    own = address.removeprefix("http://")
    other = own.replace("localhost", "elsewhere.example")
    for path in ("", "/ws"):
        assert status(address + path, Host=other) == 403
        assert status(address + path, Origin=f"http://{other}") == 403
        assert status(address + path, Origin="null") == 403
    assert status(address, Host=own, Origin=address) == 200
    assert status(address, Host=own.upper(), Origin=address.upper().replace("HTTP", "http")) == 200
    assert status(address, Host=own.replace("localhost", "127.0.0.1")) == 200
    assert status(address + "/favicon.ico") == 204  # browsers ask for it


@pytest.mark.parametrize(
    ("port", "host", "passes"),
    [
        (80, "localhost", True),  # as browsers say it
        (80, "localhost:80", True),
        (80, "elsewhere.example", False),
        (8000, "localhost", False),
        (8000, "localhost:8000", True),
    ],
)
def test_the_host_as_browsers_send_it(port, host, passes):
    from aiohttp import web
    from aiohttp.test_utils import make_mocked_request

    from calm.tui.serve import Browser

    async def answer(_):
        return web.Response()

    browser = Browser(["calm"], port, print)
    request = make_mocked_request("GET", "/", headers={"Host": host})
    asking = browser._only_own_page(request, answer)
    if passes:
        assert asyncio.run(asking).status == 200
    else:
        with pytest.raises(web.HTTPForbidden):
            asyncio.run(asking)
    # what the page names are addresses that pass, never those of https
    assert browser.public_url.startswith("http://localhost")


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

    place = f"{address}/ws?width=110&height=40"
    async with ClientSession() as session, session.ws_connect(place, origin=address) as page:
        await _until(page, b"Anchor")
        await page.send_json(["stdin", keys.decode()])
        await _until(page, b"not saved")


async def _until(page, word):
    """Until the page has been sent a word of the screen."""
    shown = b""
    while word not in shown:
        message = await page.receive(timeout=PATIENCE)
        shown += message.data if isinstance(message.data, bytes) else b""
