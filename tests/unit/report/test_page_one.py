"""Page one of the check report: what an engineer signs, of moorings that nobody tidied."""

import hashlib

import numpy as np
import pypdfium2
import pytest

import calm
import calm.report.html
from calm.checks.finding import State
from calm.report.check_facts import facts_of
from calm.report.check_files import check_document
from calm.report.check_report import check_report, mooring_section
from calm.report.check_summary import check_part
from calm.report.check_tables import named
from calm.report.folder import printed
from calm.units import KILOGRAM_FORCE, KNOT
from tests.judged import judged

_LINE = """
line:
  - {use: sphere-steel-1250, label: Auftriebskörper ganz oben über der Übertiefe}
  - {use: wire-jacketed-8, length: 100 m, label: Draht}
  - {use: glass-17in, count: 4, label: glass}
  - {use: release-rt161, label: Auslöser}
  - {use: polyester-14, length: 100 m, label: rope}
  - {use: anchor-wheels-4, label: Räder}
"""
_HEAD = """name: Größe
environment:
  depth: 300 m
  current: {columns: [depth m, speed m/s, toward deg], rows: [[0, 0.8, 90], [300, 0.1, 60]]}
environments:
  ebb: {current: {columns: [depth m, speed m/s, toward deg], rows: [[0, 0.1, 9], [50, 1.1, 9],
    [300, 0.2, 9]]}}
"""
_ACCEPTS = """
checks:
  anchor_factor: 9
  accept:
    - {rule: strength, component: Auslöser, reason: tested to 700 bar, by: B. Li,
       date: 2026-01-02, until: 2031-12-31}
"""


@pytest.fixture(scope="module")
def path(tmp_path_factory):
    path = tmp_path_factory.mktemp("signed") / "größe.yaml"
    path.write_text(_HEAD + _LINE + _ACCEPTS, encoding="utf-8")
    return path


@pytest.fixture(scope="module")
def assessment(path):
    return judged(path, "ebb")


@pytest.fixture(scope="module")
def facts(assessment):
    return facts_of(assessment)


def pages(*assessments):
    with pypdfium2.PdfDocument(
        printed(check_report([mooring_section(each) for each in assessments]))
    ) as pdf:
        return [" ".join(page.get_textpage().get_text_range().split()) for page in pdf]


def test_the_hash_is_that_of_the_file_byte_for_byte(path, facts):
    assert facts.sha256 == hashlib.sha256(path.read_bytes()).hexdigest()


def test_the_strongest_current_is_that_of_all_environments(facts):
    assert (facts.current.speed, facts.current.depth) == pytest.approx((1.1, 50.0))
    assert facts.current.environment == "ebb"
    assert facts.current.weak == ""


def test_a_weak_current_is_said(tmp_path):
    path = tmp_path / "weak.yaml"
    weak = "name: weak\nenvironment: {depth: 300 m, current: {speed: 0.05 m/s, toward: 9 deg}}\n"
    path.write_text(weak + _LINE, encoding="utf-8")
    first = pages(judged(path))[0]
    assert "0.05 m/s (0.10 kn)" in first
    assert "a wind of 7 m/s alone drives 0.20 m/s at the surface" in first


def test_the_least_factor_is_that_of_every_situation(assessment, facts):
    results = [one.result for stand in assessment.stands for one in stand.situations if one.result]
    factors = [result.components.safety_factor for result in results]
    assert facts.factor.factor == np.nanmin(factors)
    rows = {result.components.label[int(np.nanargmin(each))]
            for result, each in zip(results, factors, strict=True)
            if np.nanmin(each) == np.nanmin(factors)}  # fmt: skip
    assert facts.factor.component in rows
    assert facts.factor.unknown == np.isnan(factors[0][:-1]).sum()


def test_the_anchor_that_fails_has_its_margin(assessment, facts):
    weights = [one for one in assessment.all_findings() if one.rule == "anchor-weight"]
    assert facts.anchor.state is State.FAIL
    assert facts.anchor.margin == min(one.margin for one in weights) < 0
    assert facts.anchor.margin == pytest.approx(facts.anchor.value - facts.anchor.limit)


def test_all_that_is_signed_stands_on_page_one(path, facts):
    first = pages(judged(path, "ebb"))[0]
    weight, needed = facts.anchor.value, facts.anchor.limit
    for words in (
        f"{1.1:.2f} m/s ({1.1 / KNOT:.2f} kn) at a depth of 50.0 m, environment ebb",
        f"{weight:.0f} N ({weight / KILOGRAM_FORCE:.0f} kgf) held",
        f"{needed:.0f} N ({needed / KILOGRAM_FORCE:.0f} kgf) needed",
        f"{facts.factor.factor:.2f}, {facts.factor.component}", facts.sha256,
        f"CALM {calm.__version__}", "not given document, revision, date, author",
        "tested to 700 bar", "B. Li 2026-01-02 2031-12-31",
        "Limits that depart from their defaults", "anchor_factor", "Designed by", "Checked by",
    ):  # fmt: skip
        assert words in first, words


def test_the_title_block_is_that_of_the_document(tmp_path):
    path = tmp_path / "titled.yaml"
    document = "document: {id: M-17, revision: C, author: A. Martin, date: 2026-03-04}\n"
    path.write_text(_HEAD + document + _LINE, encoding="utf-8")
    first = pages(judged(path))[0]
    for words in ("document M-17", "revision C", "author A. Martin", "date 2026-03-04"):
        assert words in first
    assert "not given" not in first


@pytest.mark.parametrize("count", [1, pytest.param(150, marks=pytest.mark.thorough)])
def test_page_one_is_one_page(path, tmp_path, count):
    long = tmp_path / "long.yaml"
    text = path.read_text(encoding="utf-8").replace(
        "  - {use: glass-17in, count: 4, label: glass}\n",
        "".join(f"  - {{use: wire-jacketed-8, length: 20 cm, label: Stück {n} des Drahtes}}\n"
                "  - {use: glass-17in, label: glass " f"{n}}}\n" for n in range(1, count + 1)),
    )  # fmt: skip
    long.write_text(text, encoding="utf-8")
    first, second, *_ = pages(judged(long))
    assert "Checked by" in first
    assert second.index("What is not judged") < 60


def test_several_moorings_have_their_figures_before_the_signatures(assessment, facts):
    texts = " ".join(pages(assessment, assessment))
    assert texts.index("Checked by") > [at for at in range(len(texts))
        if texts.startswith("strongest current", at)][1]  # fmt: skip
    assert texts.count(facts.sha256) == 2


def test_no_text_is_smaller_than_it_may_be(assessment):
    with pypdfium2.PdfDocument(printed(check_report([mooring_section(assessment)]))) as pdf:
        sizes = {
            round(pypdfium2.raw.FPDFText_GetFontSize(text.raw, at), 1)
            for text in [pdf[0].get_textpage()]
            for at in range(text.count_chars())
            if text.get_text_range(at, 1).strip()
        }
    assert min(sizes) == 8.0  # head and foot
    assert sizes - {8.0} and min(sizes - {8.0}) >= 9.0


def test_the_document_the_page_and_the_terminal_say_the_same(assessment, facts):
    said = check_document([assessment])["key_figures"]["Größe"]
    assert said["sha256"] == facts.sha256
    assert said["strongest_current"]["speed"] == facts.current.speed
    assert said["anchor"]["margin"] == facts.anchor.margin
    assert said["least_safety_factor"]["component"] == facts.factor.component
    assert said["counts"]["fail"] >= 1 and said["departures"] == ["anchor_factor"]
    (pairs,) = [one for one in check_part([assessment]).blocks if type(one).__name__ == "Pairs"]
    html = calm.report.html.page(check_report([mooring_section(assessment)]))
    for name, value in pairs.pairs:
        assert name in html and value.split("\n")[0] in html


def test_labels_that_follow_are_named_as_a_run():
    assert named(["glass 1", "glass 3", "cable", "glass 2"]) == "glass 1 to 3, cable"
    assert named(["a 1", "a 3", "b", "c", "d 7", "d 8"]) == "a 1, a 3, b and 3 more"
    assert named(["300 m", "500 m"]) == "300 m, 500 m"
    assert named(["d 7", "d 8"]) == "d 7 and 8"
