"""`calm build --serve` in a browser: the line is drawn, keys arrive, strangers do not.

The tests are skipped where there is no Chromium, unless CALM_BROWSER_TESTS is 1.
"""

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
PATIENCE = 60.0  # seconds


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
        foreign = []
        page.on("request", lambda request: foreign.append(request.url))
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
    allowed = (address, address.replace("http", "ws"), "data:")
    assert not [url for url in foreign if not url.startswith((*allowed, "https://fonts.g"))]


@pytest.mark.parametrize("header", ["Host", "Origin"])
def test_another_sites_page_is_refused(served, header):
    address, _ = served
    request = urllib.request.Request(f"{address}/ws", headers={header: "http://elsewhere.example"})
    with pytest.raises(urllib.error.HTTPError) as refused:
        urllib.request.urlopen(request)
    with refused.value as answer:
        assert answer.code == 403
