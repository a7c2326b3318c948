"""Build the manual as a site that needs no network: pages, the made ones too, and a zip of it.

python docs/make_site.py [-o FOLDER]

The default is docs/_site, which `calm docs --open` shows and a wheel carries. FOLDER.zip beside it
is the same in one file.

Warnings are errors. Needs the extra `docs`.
"""

import argparse
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

from pages import api, components, keys, results

DOCS = Path(__file__).resolve().parent


def stage(folder: Path) -> None:
    """Copy what is written by hand to where the made pages join it."""
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


def build(target: Path) -> None:
    """Make the site in the folder `target`, and the zip beside it; exit 1 where Sphinx warns."""
    with tempfile.TemporaryDirectory() as work:
        sources, site = Path(work) / "sources", Path(work) / "site"
        stage(sources)
        make(sources)
        options = ["-b", "html", "-W", "--keep-going", "-q", "-j", "2"]
        sphinx = [sys.executable, "-m", "sphinx", *options, sources, site]
        if subprocess.run(sphinx, check=False).returncode:
            sys.exit("the site is not built: mend what is named above")
        for rest in (".buildinfo", ".doctrees", "objects.inv"):
            place = site / rest
            shutil.rmtree(place) if place.is_dir() else place.unlink(missing_ok=True)
        shutil.rmtree(target, ignore_errors=True)
        shutil.copytree(site, target)
    shutil.make_archive(str(target), "zip", target)


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description="Build the manual as a site.")
    parser.add_argument("-o", dest="target", type=Path, default=DOCS / "_site")
    build(parser.parse_args().target)
