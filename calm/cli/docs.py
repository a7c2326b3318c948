"""``calm docs``: the pages of the manual on this machine."""

from pathlib import Path, PurePosixPath
from typing import Annotated

from cyclopts import Parameter

from calm.cli.outputs import ExitCode, narrate, show
from calm.errors import UsageError

SITE = "_site"
"""The folder of the built site inside the manual's."""


def docs(
    page: str = "index", /, *, open_: Annotated[bool, Parameter(name="--open")] = False
) -> ExitCode:
    """Print where a page of the manual is on this machine, open it, or list pages by a word.

    CALM prints the path of the page's text; `--open` shows the page of the
    built site in a browser, without a network. A word that is not the name of a
    page lists the pages that contain it, the most relevant first.

    Parameters
    ----------
    page
        Name of the page, with or without its part of the manual (batch, reference/batch, how-to),
        or words to search for.
    open_
        Open the page in a browser.

    Examples
    --------
      calm docs
      calm docs batch
      calm docs swivel
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
    if name is None:
        _list(page, texts, built)
    elif open_:
        _open(name, texts, built)
    else:
        show(f"{texts.get(name) or built[name]}\n")
    return ExitCode.DONE


def _list(words: str, texts: dict[str, Path], built: dict[str, Path]) -> None:
    """Print path and title of each page that contains all words.

    Pages with more of them in their headings come first, then those that have them more often.
    UsageError: no page contains them.
    """
    from calm.errors import unknown
    from calm.whole_file import read_text

    wanted = [word for word in words.casefold().split() if word]
    found: list[tuple[int, int, str]] = []
    for path in texts.values():
        text = read_text(path)
        counts = [text.casefold().count(word) for word in wanted]
        if wanted and all(counts):
            headings = [line for line in text.casefold().splitlines() if line.startswith("#")]
            inside = sum(word in line for line in headings for word in wanted)
            title = next((line[1:].strip() for line in text.splitlines() if line[:2] == "# "), "")
            found.append((-inside, -sum(counts), f"{path}  {title}\n"))
    if not found:
        pages = [*texts, *built]
        names = [*pages, *(PurePosixPath(name).name for name in pages)]
        raise UsageError(unknown(f"the manual has no page `{words}`", words, names))
    narrate(f"no page is called `{words}`; these contain it:")
    show("".join(line for *_, line in sorted(found)))


def _pages(folder: Path, suffix: str) -> dict[str, Path]:
    """The pages of a folder, by book and name."""
    return {
        path.relative_to(folder).with_suffix("").as_posix(): path
        for path in sorted(folder.rglob(f"*{suffix}"))
        if not any(part.startswith("_") for part in path.relative_to(folder).parts)
    }


def _named(page: str, pages: dict[str, Path]) -> str | None:
    """The page of a name, None if there is none.

    UsageError: there are several.
    """
    wanted = page.strip("/").removesuffix(".md").removesuffix(".html")
    for exact in (wanted, f"{wanted}/index"):
        if exact in pages:
            return exact
    found = [name for name in pages if PurePosixPath(name).name == wanted]
    if len(found) > 1:
        raise UsageError(f"several pages are named `{wanted}`: {', '.join(found)}")
    return found[0] if found else None


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
