"""Build the manual as an offline site: written pages, generated pages, and a zip file.

python docs/make_site.py [-o FOLDER]

The default is docs/_site, which `calm docs --open` shows and a wheel carries. FOLDER.zip beside it
is the same in one file.

Warnings are errors. Needs the extra `docs`.
"""

import argparse
import html
import re
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from pathlib import Path
from urllib.parse import unquote

from pages import api, components, gallery, keys, pictures, results

from calm.drawing.picture import image
from calm.drawing.plot import figure_svg
from calm.page.folder import write_page

_ID = re.compile(r'\bid="([^"]+)"')
_LINK = re.compile(r'<(\w+)\b[^>]*?\s(?:href|src)="([^"]*)"')
DOCS = Path(__file__).resolve().parent


def stage(folder: Path) -> None:
    """Copy the hand-written pages to the folder of the generated pages."""
    shutil.copytree(
        DOCS, folder, ignore=shutil.ignore_patterns("*.py", "__pycache__", "*.nc", "_site*")
    )
    shutil.copy(DOCS / "conf.py", folder)


def make(folder: Path) -> None:
    """Write the pages that are made from the program and its data."""
    made = {
        "reference/keys": keys.page(),
        "reference/results": results.page(),
        "reference/api": api.page(),
        **{f"reference/components/{name}": text for name, text in components.pages().items()},
    }
    for name, text in made.items():
        page = folder / f"{name}.md"
        page.parent.mkdir(parents=True, exist_ok=True)
        page.write_text(text, encoding="utf-8")
    (folder / "gallery").mkdir()
    for name, content in gallery.pages().items():
        data = content if isinstance(content, bytes) else content.encode()
        (folder / "gallery" / name).write_bytes(data)
    (folder / "images" / "hero.png").write_bytes(image(figure_svg(pictures.hero()), ".png"))


def build(target: Path) -> None:
    """Build the site in `target`, and the zip next to it; exit 1 if Sphinx warns."""
    with tempfile.TemporaryDirectory() as work:
        sources, site = Path(work) / "sources", Path(work) / "site"
        stage(sources)
        make(sources)
        options = ["-b", "html", "-W", "--keep-going", "-q", "-j", "2"]
        sphinx = [sys.executable, "-m", "sphinx", *options, sources, site]
        if subprocess.run(sphinx, check=False).returncode:
            sys.exit("the site was not built: correct the errors listed above")
        write_page(site / "try")
        if wrong := sorted(dead_ends(site)):
            sys.exit("\n".join(wrong))
        for rest in (".buildinfo", ".doctrees", "objects.inv"):
            place = site / rest
            shutil.rmtree(place) if place.is_dir() else place.unlink(missing_ok=True)
        shutil.rmtree(target, ignore_errors=True)
        shutil.copytree(site, target)
    shutil.make_archive(str(target), "zip", target)


def dead_ends(site: Path) -> Iterator[str]:
    """Broken links inside the site, and external resources of its pages."""
    ids = {page: set(_ID.findall(page.read_text("utf-8"))) for page in site.rglob("*.html")}
    for page in ids:
        for tag, address in _LINK.findall(page.read_text("utf-8")):
            place, _, anchor = unquote(html.unescape(address)).partition("#")
            place = place.partition("?")[0]
            where = page.relative_to(site)
            if re.match(r"(https?:)?//", place):
                if tag != "a":
                    yield f"{where}: <{tag}> fetches {address}"
            elif not re.match(r"(data|mailto):", place):
                target = (page.parent / place).resolve() if place else page
                if not target.exists():
                    yield f"{where}: {address} does not exist"
                elif anchor and target in ids and anchor not in ids[target]:
                    yield f"{where}: {address} has no such place"


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description="Build the manual as a site.")
    parser.add_argument("-o", dest="target", type=Path, default=DOCS / "_site")
    build(parser.parse_args().target)
