"""The report in a browser: silent, complete without network or script, legible, printable.

The tests are skipped where there is no Chromium, unless CALM_BROWSER_TESTS is 1.
"""

import os
import shutil
from contextlib import contextmanager
from dataclasses import replace
from itertools import pairwise

import pypdfium2
import pytest

import calm
import calm.report.html
from calm.checks.finding import State
from calm.report.blocks import Cell, Report, ReportPart, table_of, words
from calm.report.check_report import check_report, mooring_section
from calm.report.result_report import result_report
from tests.judged import (
    FORMULA,
    LINES,
    LONG,
    QUOTES,
    RIGHT_TO_LEFT,
    SCRIPT,
    judged,
    judged_hostile,
    unaccepting,
)

pytestmark = pytest.mark.thorough

CHROMIUM = next(
    filter(None, map(shutil.which, ("chromium", "chromium-browser", "google-chrome"))), None
)

OVERLAPS = """
() => {
  const found = [];
  for (const svg of document.querySelectorAll("svg")) {
    const texts = [...svg.querySelectorAll("text")].filter((one) => one.textContent.trim());
    const boxes = texts.map((one) => one.getBoundingClientRect());
    for (let i = 0; i < boxes.length; i++) {
      for (let j = 0; j < i; j++) {
        const [a, b] = [boxes[i], boxes[j]];
        const wide = Math.min(a.right, b.right) - Math.max(a.left, b.left);
        const tall = Math.min(a.bottom, b.bottom) - Math.max(a.top, b.top);
        // A box is as tall as the font: letters of lines that touch by a third of it are apart.
        if (wide > 1 && tall > Math.min(a.height, b.height) / 3) {
          found.push(`${texts[j].textContent} / ${texts[i].textContent}`);
        }
      }
    }
  }
  return found;
}
"""

OUTSIDE = """
() => [...document.querySelectorAll("svg")].flatMap((svg) => {
  const frame = svg.getBoundingClientRect();
  return [...svg.querySelectorAll("text")].filter((one) => {
    const box = one.getBoundingClientRect();
    return box.left < frame.left - 1 || box.right > frame.right + 1;
  }).map((one) => one.textContent);
})
"""


@pytest.fixture(scope="module")
def browser():
    if CHROMIUM is None and os.environ.get("CALM_BROWSER_TESTS") != "1":
        pytest.skip("there is no Chromium")
    assert CHROMIUM is not None, "CALM_BROWSER_TESTS is 1, and there is no Chromium"
    from playwright.sync_api import sync_playwright

    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=CHROMIUM, args=["--no-sandbox"])
        yield browser
        browser.close()


@pytest.fixture
def opened(browser, tmp_path):
    """Opens a page from a file; when it is left, nothing was said and nothing else was fetched."""

    @contextmanager
    def opening(html, **settings):
        path = tmp_path / "report.html"
        path.write_text(html, encoding="utf-8")
        said, fetched = [], []
        context = browser.new_context(viewport={"width": 1280, "height": 900}, **settings)
        page = context.new_page()
        page.on("console", lambda message: said.append(message.text))
        page.on("pageerror", lambda error: said.append(str(error)))
        page.on("dialog", lambda dialog: said.append(dialog.message))
        page.on("request", lambda request: fetched.append(request.url))
        page.goto(path.as_uri())
        yield page
        context.close()
        assert said == []
        assert fetched == [path.as_uri()]

    return opening


@pytest.fixture(scope="module")
def section(tmp_path_factory):
    path = unaccepting("tidal-adcp.yaml", tmp_path_factory.mktemp("unaccepting"))
    return mooring_section(judged(path, "ebb", "neaps"))


def test_the_page_is_silent_and_alone(opened, section):
    with opened(calm.report.html.page(check_report([section]))) as page:
        assert page.title() == "Tidal strait ADCP: design check"
        assert page.locator("figure svg").count() == 2


@pytest.mark.parametrize(
    "name", ["tidal-adcp", "deep-current-meters", "taut-nylon-surface", "chain-and-rope-surface"]
)
def test_no_labels_overlap(opened, name):
    with opened(
        calm.report.html.page(check_report([mooring_section(judged(LINES / f"{name}.yaml"))]))
    ) as page:
        assert page.evaluate(OVERLAPS) == []
        assert page.evaluate(OUTSIDE) == []


def test_no_labels_overlap_with_ten_environments(opened):
    assessment = judged(LINES / "tidal-adcp.yaml", "ebb", "neaps")
    in_environments = [
        replace(
            assessment.in_environments[number % 3], environment=f"an environment, number {number}"
        )
        for number in range(10)
    ]
    section = mooring_section(replace(assessment, in_environments=tuple(in_environments)))
    with opened(calm.report.html.page(check_report([section]))) as page:
        assert page.evaluate(OVERLAPS) == []
        assert page.evaluate(OUTSIDE) == []


@pytest.mark.parametrize("name", ["sediment-trap-undercurrent", "depressor-fit-depth"])
def test_a_single_result_is_silent_and_legible(opened, name):
    with opened(
        calm.report.html.page(result_report(calm.load(LINES / f"{name}.yaml").solve()))
    ) as page:
        assert page.evaluate(OVERLAPS) == []


def test_nothing_is_wider_than_the_page(opened, section):
    with opened(calm.report.html.page(check_report([section]))) as page:
        assert page.evaluate("document.documentElement.scrollWidth") <= 1280
        page.set_viewport_size({"width": 800, "height": 900})
        assert page.evaluate("document.documentElement.scrollWidth") <= 800


def test_a_phone_shows_it_legibly(opened, section):
    with opened(calm.report.html.page(check_report([section]))) as page:
        page.set_viewport_size({"width": 390, "height": 844})
        assert page.evaluate("document.documentElement.scrollWidth") <= 390
        assert page.evaluate(OVERLAPS) == []
        letters = page.evaluate(
            """() => [...document.querySelectorAll("svg text")]
              .filter((one) => one.textContent.trim())
              .map((one) => one.getBoundingClientRect().height)"""
        )
        assert min(letters) >= 8.0
        cells = page.evaluate(
            """() => [...document.querySelectorAll(".wide td:not(.number)")]
              .filter((one) => one.textContent.length > 12 && one.checkVisibility())
              .map((one) => one.getBoundingClientRect().width)"""
        )
        assert min(cells) >= 60.0


def test_no_head_stands_at_the_end_of_a_printed_page(opened, section):
    with opened(
        calm.report.html.page(check_report([section, replace(section, name="Another mooring")]))
    ) as page:
        heads = page.locator("h2, h3, h4, caption").all_inner_texts()
        heads += [" ".join(row.split()) for row in page.locator("thead tr").all_inner_texts()]
        content = page.pdf(prefer_css_page_size=True)
    document = pypdfium2.PdfDocument(content)
    for printed in document:
        text = printed.get_textpage().get_text_range()
        lines = ["".join(line.split()) for line in text.splitlines() if line.strip()]
        lines = [line for line in lines if not line.replace("/", "").isdigit()]
        ends = ["".join(head.split()) for head in heads if head.strip()]
        assert not lines or lines[-1] not in ends
    document.close()


def test_the_place_of_a_clamp_is_told(opened, tmp_path):
    with opened(
        calm.report.html.page(
            check_report([mooring_section(judged(LINES / "deep-current-meters.yaml"))])
        )
    ) as page:
        table = page.locator("table", has=page.locator("caption", has_text="Mooring drawing"))
        row = table.locator("tr", has_text="MicroCAT 400 m")
        assert "at 100" in row.inner_text()


def test_names_that_mean_harm_are_text(opened, tmp_path):
    with opened(
        calm.report.html.page(check_report([mooring_section(judged_hostile(tmp_path))]))
    ) as page:
        text = page.evaluate("document.body.textContent")
        for name in (SCRIPT, QUOTES, FORMULA, RIGHT_TO_LEFT, LONG):
            assert name in text
        assert page.locator("script").count() == 1
        assert page.evaluate("document.documentElement.scrollWidth") <= 1280
        assert page.evaluate(OVERLAPS) == []


def test_everything_is_read_without_script(opened, section):
    html = calm.report.html.page(check_report([section]))
    with opened(html) as page:
        rows = page.locator("td:visible").count()
    with opened(html, java_script_enabled=False) as page:
        assert page.locator("td:visible").count() == rows
        assert page.locator(".controls").count() == 0


def test_rows_are_chosen_and_sorted(opened):
    findings = [*judged(LINES / "tidal-adcp.yaml").all_findings()]
    findings[0] = replace(findings[0], state=State.FAIL)
    shown_rows = table_of(
        "Findings",
        findings,
        words("state", lambda one: Cell(one.state.value, state=one.state)),
        words("rule", lambda one: one.rule),
        words("component", lambda one: one.component),
        sortable=True,
    )
    report = Report("T", "S", (ReportPart("", (shown_rows,)),), ())
    with opened(calm.report.html.page(report)) as page:
        rows = page.locator("table.sortable tbody tr")
        controls = page.locator(".controls")
        controls.locator("select").select_option("fail")
        shown = rows.locator("visible=true")
        assert 0 < shown.count() < rows.count()
        assert set(shown.locator(".state").all_inner_texts()) == {"fail"}
        controls.locator("select").select_option("all states")
        controls.locator("input").fill("anchor-weight")
        assert all("anchor-weight" in text for text in shown.all_inner_texts())
        controls.locator("input").fill("")

        heads = page.locator("table.sortable thead th")
        heads.nth(2).click()
        names = [row.split("\t")[2].casefold() for row in rows.all_inner_texts()]
        assert names[0] <= names[-1]
        heads.nth(0).click()
        states = rows.locator(".state").all_inner_texts()
        order = ["pass", "not-judged", "accepted", "estimated", "warn", "unknown", "fail"]
        ranks = [order.index(state) for state in states]
        assert all(one <= other for one, other in pairwise(ranks))


def test_it_prints_on_a4_without_controls(opened, section):
    html = calm.report.html.page(check_report([section, replace(section, name="Another mooring")]))
    with opened(html) as page:
        content = page.pdf(prefer_css_page_size=True)
        page.emulate_media(media="print")
        assert page.locator(".controls:visible").count() == 0
    with pypdfium2.PdfDocument(content) as document:
        texts = [page.get_textpage().get_text_range() for page in document]
        assert document[0].get_size() == pytest.approx((595, 842), abs=1.5)
    starts = [number for number, text in enumerate(texts) if "Load cases" in text]
    assert len(starts) == 2
    assert starts[0] > 0
    assert f"{len(texts)} / {len(texts)}" in texts[-1]


def test_the_measure_sees_labels_that_overlap(opened):
    svg = '<svg width="300" height="60"><text x="9" y="20">one</text><text x="20" y="22">two</text>'
    with opened(
        f"<!DOCTYPE html><title>labels</title>{svg}<text x='299' y='50'>far</text></svg>"
    ) as page:
        assert page.evaluate(OVERLAPS) == ["one / two"]
        assert page.evaluate(OUTSIDE) == ["far"]
