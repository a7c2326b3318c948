from dataclasses import replace

import pypdfium2
import pytest

import calm
from calm.report.blocks import Prose, Report, ReportPart
from calm.report.check_report import CheckedSection, check_report, mooring_section
from calm.report.folder import pdf_leaf, printed
from calm.report.result_report import result_report
from tests.judged import FORMULA, LINES, judged, judged_hostile


@pytest.fixture(scope="module")
def sections():
    return [mooring_section(judged(LINES / f"{name}.yaml")) for name in ("tidal-adcp", "cdms-1")]


@pytest.fixture
def pages():
    """The pages of a document: rendered, not one of them blank or covered, and their texts."""
    documents = []

    def read(content):
        document = pypdfium2.PdfDocument(content)
        documents.append(document)
        texts = []
        for page in document:
            image = page.render(scale=0.5).to_pil().convert("L")
            assert image.getextrema()[0] < 128
            assert sum(image.histogram()[:64]) < 0.1 * image.width * image.height
            assert (page.get_width(), page.get_height()) == pytest.approx((595.3, 841.9), abs=0.1)
            texts.append(" ".join(page.get_textpage().get_text_range().split()))
        return texts

    yield read
    for document in documents:
        document.close()


@pytest.mark.thorough
def test_each_mooring_begins_a_page(sections, pages):
    texts = pages(printed(check_report(sections)))
    starts = [number for number, text in enumerate(texts) if "Judgement" in text]
    assert len(starts) == 2
    assert "Signatures" in " ".join(texts[: starts[0]])
    for start, section in zip(starts, sections, strict=True):
        assert section.name in texts[start]


def test_pages_are_numbered(sections, pages):
    texts = pages(printed(check_report(sections)))
    for number, text in enumerate(texts, 1):
        assert f"{number} / {len(texts)}" in text
        assert "Design check: 2 moorings, 1 environment" in text


def test_everything_is_said(sections, pages):
    text = " ".join(pages(printed(check_report(sections))))
    for words in (
        "Worst finding of each rule on each component", "Tensions in the launch and the rise",
        "Inventory", "SHA-256 of the inputs", "snap loads", "Designed by", "still water",
    ):  # fmt: skip
        assert words in text, words


def test_names_that_mean_harm_are_text(tmp_path, pages):
    text = " ".join(pages(printed(check_report([mooring_section(judged_hostile(tmp_path))]))))
    assert "alert(1)" in text
    assert "`e` $f_g$ {{ h }} #i" in text
    assert f"{FORMULA} 4" in text
    assert text.count("long") > 60


@pytest.mark.thorough
def test_the_date_is_that_of_the_environment(sections, monkeypatch):
    monkeypatch.delenv("SOURCE_DATE_EPOCH", raising=False)
    undated = printed(check_report(sections))
    monkeypatch.setenv("SOURCE_DATE_EPOCH", "1700000000")
    dated = printed(check_report(sections))
    assert dated == printed(check_report(sections))
    with pypdfium2.PdfDocument(undated) as one, pypdfium2.PdfDocument(dated) as other:
        assert one.get_metadata_value("CreationDate") == ""
        assert other.get_metadata_value("CreationDate").startswith("D:20231114")
        assert "2023-11-14" in other[0].get_textpage().get_text_range()


@pytest.mark.parametrize("name", ["taut-nylon-surface", "depressor-fit-depth"])
def test_a_single_result_has_pages(name, pages):
    result = calm.load(LINES / f"{name}.yaml").solve()
    text = " ".join(pages(printed(result_report(result))))
    assert result.name in text
    assert result.components.label[-1] in text
    assert "SHA-256 of the inputs" in text


def test_what_is_accepted_can_be_printed():
    """Findings of a section hold dates and models, which no printer looks at."""
    accepted = CheckedSection("M", (ReportPart("Said", (Prose(("plain",)),)),), facts=object())
    report = Report("T", "S", (), (accepted,))
    assert printed(report).startswith(b"%PDF")


def test_leaves_made_beforehand_give_the_same_bytes(sections):
    leaves = [pdf_leaf(section) for section in sections]
    bare = [replace(section, parts=()) for section in sections]
    assert printed(check_report(bare), leaves=leaves) == printed(check_report(sections))
