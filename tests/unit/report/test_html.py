import hashlib
import os
import pickle
import re
import subprocess
import sys
from dataclasses import replace
from html import unescape
from html.parser import HTMLParser
from pathlib import Path

import pytest

import calm
import calm.report.html
from calm.checks.finding import State
from calm.drawing.picture import set_apart
from calm.errors import UsageError
from calm.report.blocks import Table
from calm.report.check_report import check_report, mooring_section
from calm.report.open_items import percent_text
from calm.report.provenance import input_hash
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

ROOT = Path(__file__).resolve().parents[3]


@pytest.fixture(scope="module")
def assessment(tmp_path_factory):
    folder = tmp_path_factory.mktemp("unaccepting")
    return judged(unaccepting("tidal-adcp.yaml", folder), "ebb", "neaps")


@pytest.fixture(scope="module")
def section(assessment):
    return mooring_section(assessment)


@pytest.fixture(scope="module")
def hostile(tmp_path_factory):
    return judged_hostile(tmp_path_factory.mktemp("hostile"))


class Page(HTMLParser):
    """Elements, attributes, and the text by which elements it stands in."""

    VOID = frozenset({"meta", "link", "br", "hr", "wbr"})

    def __init__(self, html):
        super().__init__()
        self.open, self.elements, self.attributes, self.texts = [], [], [], []
        self.feed(html)
        assert self.open == []

    def handle_starttag(self, tag, attributes):
        self.elements.append(tag)
        self.attributes += attributes
        if tag not in self.VOID:
            self.open.append(tag)

    def handle_endtag(self, tag):
        assert self.open.pop() == tag

    def handle_startendtag(self, tag, attributes):
        self.elements.append(tag)
        self.attributes += attributes

    def handle_data(self, data):
        if not {"style", "script"} & set(self.open):
            self.texts.append(data)

    @property
    def text(self):
        return "".join(self.texts)


def test_every_part_of_the_report_is_there(section):
    page = Page(calm.report.html.page(check_report([section])))
    for heading in (
        "Design check of a mooring", "Fails:", "Load cases", "The mooring", "Open items",
        "Governing checks", "Drawn", "Approved", "Mooring drawing", "The line",
        "Tension and capacity", "Connecting hardware", "Anchor: ", "Checks in full",
        "Accuracy of these values", "Launch, anchor last", "Recovery, after release",
        "Breaks and losses", "Inventory", "Limits used", "Environments", "Not covered",
        "Mooring file", "SHA-256 of the inputs", "waves", "snap loads", "fatigue",
        "creep, corrosion", "transients of the launch", "hauling and lifting",
    ):  # fmt: skip
        assert heading in page.text, heading
    drawing = next(block for block in section.parts[1].blocks if isinstance(block, Table))
    assert drawing.title == "Mooring drawing"
    rows = len(drawing.rows)
    assert page.elements.count("svg") == 2 + rows


def test_what_is_accepted_stands_before_the_signatures():
    section = mooring_section(judged(LINES / "receiver-line.yaml"))
    text = Page(calm.report.html.page(check_report([section]))).text
    reason = "example acceptance: no data sheet was found; obtain the rating from the manufacturer"
    assert text.index("Passes with open items:") < text.index(reason) < text.index("Approved")


def test_every_page_in_print_has_its_head_and_foot(section):
    html = calm.report.html.page(check_report([section]))
    texts = re.findall(r'@(\w+-\w+) \{ content: "([^"]*)"', html)
    said = {place: re.sub(r"\\([0-9a-f]+) ", lambda sign: chr(int(sign[1], 16)), text)
            for place, text in texts}  # fmt: skip
    assert said["top-left"].strip() == "Tidal strait ADCP  design check"
    assert said["top-right"].strip() == "DRAFT, fails"
    assert section.running.foot == said["bottom-left"]


def test_limits_stand_on_the_page_of_one_result(assessment):
    text = Page(calm.report.html.page(result_report(calm.Design(assessment.file).solve()))).text
    used = text[text.index("Limits as used") :]
    for key in assessment.limits:
        assert key.name in used and key.source in used


def test_the_figures_are_those_of_the_findings(assessment, section):
    text = Page(calm.report.html.page(check_report([section]))).text
    failed = next(each for each in assessment.all_findings() if each.state is State.FAIL)
    assert failed.remedy in text
    assert f"{percent_text(failed.utilisation)}\u00a0%" in text
    knockdown = assessment.in_environments[0].result.top.knockdown
    assert f"{knockdown:.1f}" in text


def test_states_are_told_by_signs(section):
    html = calm.report.html.page(check_report([section]))
    shown = {state for state, _ in re.findall(r'<span class="state ([\w-]+)">([^<]*)</span>', html)}
    style = html[html.index("<style>") : html.index("</style>")]
    assert "fail" in shown
    assert all(f".state.{state}::before" in style for state in shown)


def test_the_mooring_file_stands_in_it(assessment, section):
    listing = re.search(
        r"<pre>(.*?)</pre>", calm.report.html.page(check_report([section])), re.DOTALL
    )
    source = Path(assessment.file.path).read_text(encoding="utf-8")
    assert unescape(listing[1]) == source.rstrip()


def test_names_that_mean_harm_are_text(hostile):
    html = calm.report.html.page(check_report([mooring_section(hostile)]))
    page = Page(html)
    for name in (SCRIPT, QUOTES, FORMULA, RIGHT_TO_LEFT, LONG, "_under"):
        assert name in page.text, name
    assert page.elements.count("script") == 1
    assert "<script>alert" not in html
    assert not [name for name, _ in page.attributes if name.startswith("on")]


def test_nothing_is_fetched(section):
    html = calm.report.html.page(check_report([section]))
    links = [value for name, value in Page(html).attributes
             if name in ("src", "href", "xlink:href", "data", "action")]  # fmt: skip
    assert [link for link in links if not link.startswith("#")] == []
    assert "@import" not in html
    assert re.findall(r"url\((?!#)", html) == []
    assert "default-src 'none'" in html


def test_identifiers_are_unique_and_all_references_lead_somewhere(section):
    html = calm.report.html.page(check_report([section, replace(section, name="Another")]))
    attributes = Page(html).attributes
    identifiers = [value for name, value in attributes if name == "id"]
    assert len(identifiers) == len(set(identifiers))
    wanted = {value[1:] for name, value in attributes if name in ("href", "xlink:href")}
    wanted |= set(re.findall(r"url\(#([^)]+)\)", html))
    assert wanted <= set(identifiers)


def test_a_label_that_looks_like_an_identifier_is_left_alone():
    svg = '<svg><g id="a"/><use href="#a"/><text>id="a" url(#a)</text></svg>'
    apart = '<svg><g id="m-a"/><use href="#m-a"/><text>id="a" url(#a)</text></svg>'
    assert set_apart(svg, "m") == apart


def test_a_mooring_without_equilibrium_is_reported(assessment):
    in_environments = tuple(
        replace(stand, situations=(replace(stand.situations[0], result=None),), findings=())
        for stand in assessment.in_environments
    )
    failed = replace(
        assessment,
        in_environments=in_environments,
        launch=None,
        recovery=None,
        backup=(),
        findings=(),
    )
    text = Page(calm.report.html.page(check_report([mooring_section(failed)]))).text
    assert "Default environment: no equilibrium" in text
    assert "The mooring has no equilibrium" in text
    assert "Launch and recovery could not be computed" in text


def test_one_environment_without_equilibrium_leaves_the_others(assessment):
    first, *others = assessment.in_environments
    fallen = replace(first, situations=(replace(first.situations[0], result=None),))
    text = Page(
        calm.report.html.page(
            check_report([mooring_section(replace(assessment, in_environments=(fallen, *others)))])
        )
    ).text
    assert "Default environment: no equilibrium" in text and "Solid: case 2" in text


def test_a_section_passes_between_processes(section):
    assert calm.report.html.page(
        check_report([pickle.loads(pickle.dumps(section))])
    ) == calm.report.html.page(check_report([section]))


@pytest.mark.parametrize("name", ["taut-nylon-surface", "a-frame-sheared-tow"])
def test_a_single_result_has_a_page(name):
    result = calm.load(LINES / f"{name}.yaml").solve()
    page = Page(calm.report.html.page(result_report(result)))
    assert result.name in page.text
    assert page.elements.count("svg") == 2
    for part in ("Schematic", "Table of the line", "SHA-256 of the inputs", "snap loads"):
        assert part in page.text
    assert result.components.label[-1] in page.text


PROGRAM = """
import hashlib, sys
from pathlib import Path
from tests.judged import judged
from calm.report.check_report import check_report, mooring_section
import calm.report.html
from calm.report.folder import printed
sections = [mooring_section(judged(Path(sys.argv[1]), "ebb"))]
report = check_report(sections)
for content in (calm.report.html.page(report).encode(), printed(report)):
    print(hashlib.sha256(content).hexdigest())
"""


@pytest.mark.thorough
def test_the_same_input_gives_the_same_bytes():
    def digests(seed):
        environment = {**os.environ, "PYTHONHASHSEED": seed}
        environment.pop("SOURCE_DATE_EPOCH", None)
        command = [sys.executable, "-c", PROGRAM, "lines/tidal-adcp.yaml"]
        finished = subprocess.run(
            command, cwd=ROOT, env=environment, capture_output=True, text=True, check=False
        )
        assert finished.returncode == 0, finished.stderr
        return finished.stdout.split()

    assert digests("1") == digests("2")


def test_the_date_is_that_of_the_environment(section, monkeypatch):
    monkeypatch.setenv("SOURCE_DATE_EPOCH", "1700000000")
    assert "2023-11-14" in calm.report.html.page(check_report([section]))
    monkeypatch.setenv("SOURCE_DATE_EPOCH", "yesterday")
    with pytest.raises(UsageError, match="SOURCE_DATE_EPOCH, `yesterday`"):
        calm.report.html.page(check_report([section]))


def test_the_hash_goes_with_every_input(tmp_path):
    text = (LINES / "tidal-adcp.yaml").read_text(encoding="utf-8")

    def hashed(content, environment=None):
        path = tmp_path / "mooring.yaml"
        path.write_text(content, encoding="utf-8")
        return input_hash([calm.load(path, environment=environment).file])

    first = hashed(text)
    assert re.fullmatch("[0-9a-f]{64}", first)
    assert hashed(text) == first
    assert hashed(text + "# a comment\n") != first
    assert hashed(text, "ebb") != first
    assert first != hashlib.sha256(text.encode()).hexdigest()  # the catalogue counts, too


def test_the_hash_goes_with_the_content_of_files_and_not_with_their_place(tmp_path):
    text = (LINES / "tidal-adcp.yaml").read_text(encoding="utf-8")
    text = re.sub(
        r"(?ms)^  current:.*?(?=^\S|^  \w)",
        '  current: {file: record.csv, time: "2026-03-01T01:00"}\n'
        "  waves: {significant_height: 1 m, peak_period: 5 s, scatter: seas.csv}\n",
        text,
        count=1,
    )

    def hashed(folder, speed, height):
        (tmp_path / folder).mkdir(exist_ok=True)
        (tmp_path / folder / "record.csv").write_text(
            "time,depth[m],u[m/s],v[m/s]\n2026-03-01T00:00,10,0.1,0\n"
            f"2026-03-01T01:00,10,{speed},0\n"
        )
        (tmp_path / folder / "seas.csv").write_text(
            f"significant_wave_height[m],peak_period[s],share\n{height},5,0.5\n2,7,0.5\n"
        )
        path = tmp_path / folder / "mooring.yaml"
        path.write_text(text, encoding="utf-8")
        return input_hash([calm.load(path).file])

    first = hashed("a", 0.5, 1.0)
    assert hashed("b", 0.5, 1.0) == first
    assert hashed("b", 0.6, 1.0) != first
    assert hashed("b", 0.5, 1.2) != first


def test_a_pass_does_not_hide_what_is_unknown(assessment, section):
    unknown = [each for each in assessment.findings if each.rule == "missing"]
    assert unknown
    text = Page(calm.report.html.page(check_report([section]))).text
    for one in unknown:
        assert (
            f"{one.missing.component_id}: {one.missing.quantity.replace('_', ' ')} missing" in text
        )
