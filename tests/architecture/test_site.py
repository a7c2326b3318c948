"""What `docs/make_site.py` finds wrong with a site that it has built."""

import importlib.util
import sys
from pathlib import Path

import pytest

DOCS = Path(__file__).resolve().parents[2] / "docs"


@pytest.fixture(scope="module")
def dead_ends():
    sys.path.insert(0, str(DOCS))
    try:
        spec = importlib.util.spec_from_file_location("make_site", DOCS / "make_site.py")
        assert spec is not None and spec.loader is not None
        module = importlib.util.module_from_spec(spec)
        spec.loader.exec_module(module)
    finally:
        sys.path.remove(str(DOCS))
    return module.dead_ends


@pytest.mark.parametrize(
    ("body", "found"),
    [
        ('<a href="book/other.html#there">x</a><p id="here"></p><a href="#here">x</a>', None),
        ('<a href="https://example.org/a">x</a><a href="mailto:a@b">x</a>', None),
        ('<img alt="x" src="data:image/png;base64,AA"/>', None),
        ('<a href="book/none.html">x</a>', "book/none.html does not exist"),
        ('<a href="book/other.html#away">x</a>', "book/other.html#away has no such place"),
        ('<a href="#away">x</a>', "#away has no such place"),
        ('<img alt="x" src="none.png?v=1">', "none.png?v=1 does not exist"),
        ('<script src="https://example.org/a.js">', "<script> fetches https://example.org/a.js"),
        ('<link rel="x" href="//example.org/a.css">', "<link> fetches //example.org/a.css"),
    ],
)
def test_what_leads_nowhere_or_outside_is_named(dead_ends, tmp_path, body, found):
    (tmp_path / "book").mkdir()
    (tmp_path / "book" / "other.html").write_text('<h1 id="there">Other</h1>')
    (tmp_path / "index.html").write_text(body)
    assert list(dead_ends(tmp_path)) == ([f"index.html: {found}"] if found else [])
