"""``calm docs``: the pages of the manual on this machine."""

from pathlib import Path, PurePosixPath
from typing import Annotated

from cyclopts import Parameter

from calm.cli.outputs import ExitCode, show
from calm.errors import UsageError

SITE = "_site"
"""The folder of the built site inside the manual's."""


def docs(
    page: str = "index", /, *, open_: Annotated[bool, Parameter(name="--open")] = False
) -> ExitCode:
    """Print where a page of the manual is on this machine, or open it.

    The path printed is that of the page's text; `--open` shows the page of the
    built site in a browser, without a network.

    Parameters
    ----------
    page
        Its name, with or without its book: batch, reference/batch, how-to.
    open_
        Open the page in a browser.

    Examples
    --------
      calm docs
      calm docs batch
      calm docs --open
      calm docs reference/mooring-file --open
    """
    from calm.shipped import shipped_folder

    try:
        manual = shipped_folder("docs")
    except FileNotFoundError as error:
        raise UsageError(str(error)) from None
    texts, built = _pages(manual, ".md"), _pages(manual / SITE, ".html")
    name = _named(page, texts | built)
    if open_:
        _open(name, texts, built)
    else:
        show(f"{texts.get(name) or built[name]}\n")
    return ExitCode.DONE


def _pages(folder: Path, suffix: str) -> dict[str, Path]:
    """The pages of a folder, by book and name."""
    return {
        path.relative_to(folder).with_suffix("").as_posix(): path
        for path in sorted(folder.rglob(f"*{suffix}"))
        if not any(part.startswith("_") for part in path.relative_to(folder).parts)
    }


def _named(page: str, pages: dict[str, Path]) -> str:
    """The page that a person means.

    UsageError: there is none, or there are several.
    """
    from calm.errors import unknown

    wanted = page.strip("/").removesuffix(".md").removesuffix(".html")
    for exact in (wanted, f"{wanted}/index"):
        if exact in pages:
            return exact
    found = [name for name in pages if PurePosixPath(name).name == wanted]
    if len(found) > 1:
        raise UsageError(f"several pages are named `{wanted}`: {', '.join(found)}")
    if not found:
        names = [*pages, *(PurePosixPath(name).name for name in pages)]
        raise UsageError(unknown(f"the manual has no page `{page}`", wanted, names))
    return found[0]


def _open(name: str, texts: dict[str, Path], built: dict[str, Path]) -> None:
    """Show a page of the site.

    UsageError: the site is not built, or there is no browser.
    """
    import webbrowser

    if name not in built:
        raise UsageError(
            f"the site is not part of this installation; the text of the page is {texts[name]}. "
            "In a checkout, `python docs/make_site.py` builds the site"
        )
    if not webbrowser.open(built[name].as_uri()):
        raise UsageError(f"no browser could be opened; the page is {built[name]}")
