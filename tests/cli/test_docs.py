"""`calm docs`: where the manual is, and what shows it."""

import webbrowser
from pathlib import Path

import pytest

from calm import shipped

ROOT = Path(__file__).resolve().parents[2]


@pytest.fixture
def manual(tmp_path, monkeypatch):
    """An installation with two books, each with a page `first`, and a page of the site alone."""
    docs = tmp_path / "docs"
    for page in ("index.md", "how-to/index.md", "how-to/first.md", "tutorial/first.md"):
        (docs / page).parent.mkdir(parents=True, exist_ok=True)
        (docs / page).write_text("# A page\n")
    monkeypatch.setattr(shipped, "shipped_folder", lambda _: docs)
    return docs


@pytest.fixture
def site(manual):
    for page in ("index", "how-to/index", "gallery/s1000"):
        file = manual / "_site" / f"{page}.html"
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text("<p>A page</p>\n")
    return manual / "_site"


@pytest.fixture
def opened(monkeypatch):
    """The addresses that a browser was asked to open."""
    asked = []
    monkeypatch.setattr(webbrowser, "open", lambda address: asked.append(address) or True)
    return asked


@pytest.mark.parametrize(
    ("words", "page"),
    [
        ([], "index.md"),
        (["batch"], "reference/batch.md"),
        (["reference/batch"], "reference/batch.md"),
        (["reference/batch.md"], "reference/batch.md"),
        (["how-to"], "how-to/index.md"),
    ],
)
def test_the_address_of_a_page_is_printed(calm, words, page):
    done = calm("docs", *words)
    assert (done.code, done.out, done.err) == (0, f"{ROOT / 'docs' / page}\n", "")


@pytest.mark.parametrize(
    ("page", "told"),
    [
        ("bach", "did you mean `batch`?"),
        ("../README", "no page `../README`"),
        ("", "no page ``"),
    ],
)
def test_a_page_that_does_not_exist(calm, page, told):
    done = calm("docs", page)
    assert (done.code, done.out) == (2, "")
    assert told in done.err


def test_a_word_lists_the_pages_that_contain_it_those_with_it_in_a_heading_first(calm, manual):
    chains = "A swivel, a [Swivel](x.md), one more `swivel`."
    (manual / "how-to/first.md").write_text(f"# Chains\n\n{chains}\n")
    (manual / "tutorial/first.md").write_text("# Wires\n\n## The swivel\n")
    done = calm("docs", "swivel")
    of_wires = "tutorial/first: Wires\n    The swivel\n"
    of_chains = "how-to/first: Chains\n    A swivel, a Swivel, one more swivel.\n"
    assert (done.code, done.out) == (0, of_wires + of_chains)
    assert "no page is called `swivel`" in done.err
    assert calm("docs", "swivel more").out == of_chains
    several = calm("docs", "swivel", "more", "nowhere")
    assert several.out == of_chains
    assert "contain 2 of these 3 words" in several.err


def test_a_long_line_is_shown_around_the_word(calm, manual):
    (manual / "how-to/first.md").write_text(f"# Chains\n\n{'anchor ' * 40}swivel{' float' * 40}\n")
    line = calm("docs", "swivel").out.splitlines()[1]
    assert len(line) <= 100 and line.startswith("    … anchor") and "swivel float" in line


def test_several_words_may_be_the_name_of_a_page(calm):
    assert calm("docs", "mooring", "file").out == f"{ROOT / 'docs/reference/mooring-file.md'}\n"


def test_a_name_that_two_books_have(calm, manual):
    done = calm("docs", "first")
    assert (done.code, done.out) == (2, "")
    assert "how-to/first, tutorial/first" in done.err


def test_the_site_is_opened(calm, site, opened):
    assert calm("docs", "how-to", "--open").code == 0
    assert opened == [(site / "how-to" / "index.html").as_uri()]


def test_a_page_of_the_site_alone_has_an_address(calm, site):
    assert calm("docs", "s1000").out == f"{site / 'gallery' / 's1000.html'}\n"


def test_without_the_site_the_text_is_named(calm, manual, opened):
    done = calm("docs", "--open")
    assert (done.code, done.out, opened) == (2, "", [])
    assert "the site is not part of this installation" in done.err
    assert str(manual / "index.md") in done.err


def test_without_a_browser_the_address_is_named(calm, site, monkeypatch):
    monkeypatch.setattr(webbrowser, "open", lambda _: False)
    done = calm("docs", "--open")
    assert done.code == 2
    assert f"no browser could be opened; the page is in {site / 'index.html'}" in done.err


def test_an_installation_without_the_manual(calm, monkeypatch):
    def missing(_):
        raise FileNotFoundError("CALM's folder `docs` is missing; install CALM again")

    monkeypatch.setattr(shipped, "shipped_folder", missing)
    done = calm("docs")
    assert done.code == 2
    assert "folder `docs` is missing; install CALM again" in done.err
