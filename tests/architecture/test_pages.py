"""The tutorials and the how-to pages run as a reader would type them, and print what they show."""

import importlib.util
from pathlib import Path

import pytest

DOCS = Path(__file__).resolve().parents[2] / "docs"
_SPEC = importlib.util.spec_from_file_location("run_pages", DOCS / "run_pages.py")
assert _SPEC is not None and _SPEC.loader is not None
run_pages = importlib.util.module_from_spec(_SPEC)
_SPEC.loader.exec_module(run_pages)


@pytest.fixture
def page(tmp_path):
    """Writes a page, and follows it."""

    def follow(text, *, check=True):
        path = tmp_path / "page.md"
        path.write_text(text, encoding="utf-8")
        run_pages.follow(path, check=check)
        return path.read_text(encoding="utf-8")

    return follow


@pytest.mark.thorough
@pytest.mark.parametrize("path", run_pages.pages(), ids=lambda path: path.stem)
def test_a_page_prints_what_it_shows(path):
    run_pages.follow(path, check=True)


def test_every_tutorial_runs_and_every_picture_kept_is_shown():
    lessons = {path for path in (DOCS / "tutorial").glob("*.md") if path.stem != "index"}
    assert lessons <= set(run_pages.pages())
    for book in ("tutorial", "how-to"):
        shown = {
            name
            for path in (DOCS / book).glob("*.md")
            for name in run_pages.PICTURE.findall(path.read_text(encoding="utf-8"))
        }
        assert shown == {path.name for path in (DOCS / book / "pictures").iterdir()}


ECHO = "```sh\nprintf 'one 1.5\\ntwo 2\\nthree\\n'\n```\n\n```text\n{}```\n"


@pytest.mark.parametrize(
    "shown",
    ["one 1.5\ntwo 2\nthree\n", "…\nthree\n", "one …5\n…\n", "one 1.5\n…\ntwo 2\n…\nthree\n"],
)
def test_elisions_stand_for_what_is_left_out(page, shown):
    page(ECHO.format(shown))


@pytest.mark.parametrize("shown", ["", "one 1.5\nthree\n", "one 1.6\n…\n", "…\ntwo 2\n"])
def test_another_output_is_found(page, shown):
    with pytest.raises(run_pages.PageError, match=r"printed:\none 1\.5"):
        page(ECHO.format(shown))


def test_what_is_shown_is_renewed_with_its_elisions(page):
    assert page(ECHO.format(""), check=False) == ECHO.format("one 1.5\ntwo 2\nthree\n")
    shown = ECHO.format("one 1.4\n…\nthree\n")
    assert page(shown, check=False) == ECHO.format("one 1.5\n…\nthree\n")


def test_a_file_is_written_and_edited(page):
    page(
        "<!-- file: a.yaml -->\n```yaml\nx: 1\ny: 2\n```\n"
        "<!-- edit: a.yaml -->\n```diff\n x: 1\n-y: 2\n+y: 3\n```\n"
        "```sh\ncat a.yaml\n```\n```text\nx: 1\ny: 3\n```\n"
    )


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("```sh\nfalse\n```\n", "ends with 1, not 0"),
        ("<!-- exit: 3 -->\n```sh\ntrue\n```\n", "ends with 0, not 3"),
        ("<!-- file: a -->\n```text\nx\n```\n<!-- edit: a -->\n```diff\n-y\n+z\n```\n", "a has 0"),
        ("```sh\ntrue\n```\n\n```text\n\n```\n", "a command prints nothing; leave out the block"),
        ("![none](pictures/none.svg)\n", "no command makes the picture none.svg"),
    ],
)
def test_what_does_not_run_is_found(page, text, message):
    with pytest.raises(run_pages.PageError, match=message):
        page(text)


def test_what_is_not_to_be_run_is_not(page):
    page("<!-- not run: it would fail -->\n```sh\nfalse\n```\n")
