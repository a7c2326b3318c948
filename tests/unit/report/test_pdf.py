from dataclasses import replace

import pypdfium2
import pytest

import calm
from calm.report.check_report import check_report, mooring_section
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


def test_pages_are_numbered(sections, pages):
    texts = pages(printed(check_report(sections[:1])))
    for number, text in enumerate(texts, 1):
        assert f"page {number} of {len(texts)}" in text


def test_everything_is_said(sections, pages):
    text = " ".join(pages(printed(check_report(sections[:1]))))
    for words in (
        "Checks in full", "Launch, anchor last", "Inventory", "SHA-256 of the inputs",
        "snap loads", "Approved", "Still water",
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
    report = check_report(sections[:1])
    undated = printed(report)
    monkeypatch.setenv("SOURCE_DATE_EPOCH", "1700000000")
    again = check_report([mooring_section(judged(LINES / "tidal-adcp.yaml"))])
    dated = printed(again)
    assert dated == printed(again)
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


def test_leaves_made_beforehand_give_the_same_bytes(sections):
    leaves = [pdf_leaf(section) for section in sections]
    bare = [replace(section, parts=()) for section in sections]
    assert printed(check_report(bare), leaves=leaves) == printed(check_report(sections))
