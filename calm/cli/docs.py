"""``calm docs``: find and open the pages of the manual on this machine."""

import re
from collections.abc import Sequence
from pathlib import Path, PurePosixPath
from textwrap import shorten
from typing import Annotated

from cyclopts import Parameter

from calm.cli.outputs import ExitCode, narrate, show
from calm.errors import UsageError

SITE = "_site"
"""Name of the folder with the built site, inside the folder of the manual."""


MOST_PAGES = 12
"""Maximum number of pages in a list."""
_WIDTH = 100
_LINK = re.compile(r"!?\[([^\]]*)\]\([^)]*\)|[`*]|<!--.*?-->")


def docs(*words: str, open_: Annotated[bool, Parameter(name="--open")] = False) -> ExitCode:
    """Print the path of a manual page, open the page, or search the manual.

    Without options, the path of the page's text file is printed. `--open` opens
    the page in a browser and needs no network. If the words are not the name of a
    page, the pages that contain them are listed with a line of their text, the
    most relevant page first.

    Parameters
    ----------
    words
        Name of the page, with or without its part of the manual (batch, reference/batch), name of a
        part (how-to), or words to search for.
    open_
        Open the page in a browser.

    Examples
    --------
      calm docs
      calm docs batch
      calm docs instrument depth
      calm docs --open
      calm docs reference/mooring-file --open
    """
    from calm.shipped import shipped_folder

    try:
        manual = shipped_folder("docs")
    except FileNotFoundError as error:
        raise UsageError(str(error)) from None
    texts, built = _pages(manual, ".md"), _pages(manual / SITE, ".html")
    page = " ".join(words) if words else "index"
    name = _find_page(page, texts | built) or _find_page(page.replace(" ", "-"), texts | built)
    if name is None:
        _list_pages(page, texts, built)
    elif open_:
        _open_in_browser(name, texts, built)
    else:
        show(f"{texts.get(name) or built[name]}\n")
    return ExitCode.DONE


def _list_pages(words: str, texts: dict[str, Path], built: dict[str, Path]) -> None:
    """List the pages that contain most of the words, with name, title and a line of text.

    Pages with the words in headings come first, then pages in which the words are frequent.
    """
    from calm.errors import unknown
    from calm.whole_file import read_text

    wanted = [re.compile(rf"(?<!\w){re.escape(word)}", re.IGNORECASE) for word in words.split()]
    found: list[tuple[int, int, int, str]] = []
    for name, path in texts.items():
        text = read_text(path)
        counts = [len(word.findall(text)) for word in wanted]
        if any(counts):
            headings = [line for line in text.splitlines() if line.startswith("#")]
            inside = sum(bool(word.search(line)) for line in headings for word in wanted)
            has = sum(map(bool, counts))
            found.append((-has, -inside, -sum(counts), f"{name}: {_context(text, wanted)}"))
    if not found:
        pages = [*texts, *built]
        names = [*pages, *(PurePosixPath(name).name for name in pages)]
        raise UsageError(unknown(f"the manual has no page `{words}`", words, names))
    found.sort()
    most = -found[0][0]
    lines = [line for has, *_, line in found if has == -most]
    contain = (
        "contain it" if most == len(wanted) else f"contain {most} of these {len(wanted)} words"
    )
    narrate(
        f"no page is called `{words}`; these pages {contain} (`calm docs NAME` prints the path of "
        "a page):"
    )
    show("\n".join(lines[:MOST_PAGES]) + "\n")
    if len(lines) > MOST_PAGES:
        narrate(f"further pages, not shown: {len(lines) - MOST_PAGES}")


def _context(text: str, wanted: Sequence[re.Pattern[str]]) -> str:
    """Return the title of a page, and its line with most of the words, shortened
    around the first word. Sentences are preferred to tables and code.
    """

    def fit(line: str) -> tuple[int, bool]:
        return sum(bool(word.search(line)) for word in wanted), line[:1].isalpha()

    lines = text.splitlines()
    title = _LINK.sub(r"\1", next((line[2:] for line in lines if line.startswith("# ")), ""))
    best = _LINK.sub(r"\1", max(lines, key=fit)).strip(" #|>-")
    starts = [found.start() for word in wanted if (found := word.search(best))]
    first = max(0, min(starts) - _WIDTH // 3) if len(best) > _WIDTH and starts else 0
    first = best.find(" ", first) + 1 if first else 0
    shown = shorten(best[first:], _WIDTH - 8, placeholder=" …")
    return f"{title}\n    {'… ' * bool(first)}{shown}"


def _pages(folder: Path, suffix: str) -> dict[str, Path]:
    return {
        path.relative_to(folder).with_suffix("").as_posix(): path
        for path in sorted(folder.rglob(f"*{suffix}"))
        if not any(part.startswith("_") for part in path.relative_to(folder).parts)
    }


def _find_page(page: str, pages: dict[str, Path]) -> str | None:
    wanted = page.strip("/").removesuffix(".md").removesuffix(".html")
    for exact in (wanted, f"{wanted}/index"):
        if exact in pages:
            return exact
    found = [name for name in pages if PurePosixPath(name).name == wanted]
    if len(found) > 1:
        raise UsageError(f"several pages are named `{wanted}`: {', '.join(found)}")
    return found[0] if found else None


def _open_in_browser(name: str, texts: dict[str, Path], built: dict[str, Path]) -> None:
    import webbrowser

    if name not in built:
        raise UsageError(
            f"the site is not part of this installation; the text of the page is in {texts[name]}. "
            "In a checkout, `python docs/make_site.py` builds the site"
        )
    if not webbrowser.open(built[name].as_uri()):
        raise UsageError(f"no browser could be opened; the page is in {built[name]}")
