"""Settings of the site. `python docs/make_site.py` stages the pages and calls Sphinx."""

from pathlib import Path

from calm.version import __version__

project = "CALM"
author = "The CALM authors"
project_copyright = author
version = release = __version__

extensions = ["myst_parser", "sphinx.ext.autodoc", "sphinx.ext.napoleon"]
source_suffix = {".md": "markdown"}
exclude_patterns = ["Thumbs.db"]

myst_heading_anchors = 4  # the anchors that a forge gives
myst_enable_extensions = ["deflist"]

default_role = "code"
autodoc_member_order = "bysource"
autodoc_typehints = "signature"
napoleon_google_docstring = False

smartquotes_action = "q"  # an option such as --json keeps its two hyphens

html_theme = "furo"
html_title = f"CALM {__version__}"
html_static_path = ["_static"]
html_css_files = ["calm.css"]
html_search_scorer = str(Path(__file__).with_name("_static") / "scorer.js")
html_copy_source = False
html_show_sourcelink = False
html_show_sphinx = False
pygments_style = "default"
pygments_dark_style = "github-dark"
