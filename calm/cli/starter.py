"""``calm new``, ``calm build``, ``calm schema`` and ``calm docs``: to write a mooring file."""

import json
import os
import sys
from importlib.util import find_spec
from pathlib import Path, PurePosixPath
from typing import Annotated

from cyclopts import Parameter

from calm.cli import options
from calm.cli.outputs import ExitCode, narrate, show
from calm.errors import UsageError
from calm.shipped import Template, template


def new(
    kind: Template = "shelf",
    /,
    *,
    record: bool = False,
    output: Annotated[Path | None, Parameter(alias="-o")] = None,
    force: bool = False,
) -> ExitCode:
    """Write a commented mooring file to start from, or a record of currents for it.

    Parameters
    ----------
    kind
        Kind of mooring: on the shelf, in the deep sea, an ADCP, a surface buoy, or a tow.
    record
        Write a small synthetic record, NetCDF, for `calm batch`; needs --output.
    output
        The file to write; by default the standard output.
    force
        Overwrite an existing file.

    Examples
    --------
      calm new
      calm new -o mooring.yaml
      calm new taut-surface -o buoy.yaml
      calm new --record -o record.nc
    """
    if record:
        return _new_record(output, force)
    text = template(kind)
    if output is None:
        show(text)
        return ExitCode.DONE
    _write(output, text.encode(), force)
    command = "tow" if kind == "tow" else "run"
    narrate(f"{output} written; solve it with: calm {command} {output}")
    return ExitCode.DONE


def _new_record(output: Path | None, force: bool) -> ExitCode:
    from calm.records.record import made_record

    if output is None:
        raise UsageError("a record is not text; give the file to write, --output record.nc")
    _write(output, made_record(), force)
    result = output.with_name(f"{output.stem}-result.nc")
    narrate(f"{output} written; solve it with: calm batch FILE --currents {output} -o {result}")
    return ExitCode.DONE


def _write(output: Path, content: bytes, force: bool) -> None:
    from calm.report.folder import check_destination, write_file

    if output.exists() and not force:
        raise UsageError(f"{output} exists already; --force overwrites it")
    check_destination(output)
    write_file(output, content)


def schema() -> ExitCode:
    """Print the JSON Schema of mooring files, for editors.

    Examples
    --------
      calm schema > mooring.schema.json
    """
    from calm.files import mooring_schema

    show(json.dumps(mooring_schema(), indent=2) + "\n")
    return ExitCode.DONE


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


PORT = 8000

_NO_TERMINAL = (
    "calm build needs a terminal and a keyboard; `calm build --serve` opens it in a "
    "browser, `calm run FILE --schematic` prints the line"
)
_NO_BROWSER = (
    "--serve needs textual-serve, which is not installed: pip install 'calm-mooring[browser]'"
)


def build(
    file: Path | None = None,
    /,
    *,
    environment: str | None = None,
    catalog: options.CatalogFiles = None,
    serve: bool = False,
    port: int = PORT,
) -> ExitCode:
    """Build or edit a mooring or a tow, and see it bend at every change.

    The line is a table with its picture and the design check beside it. The
    file keeps its comments, order and units: what you do not change stays as
    written. Unsaved work is kept beside the file, and offered again after a
    closed terminal, a crash or a loss of power. Press ? for all keys.

    Parameters
    ----------
    file
        A mooring file, old or new. Without it, a new file that is named when you save.
    environment
        The environment to start in: a name from the file, or an environment
        file.
    serve
        Open it in a browser on this machine; other machines cannot reach it.
    port
        Port of --serve, by default 8000. The address of the page is printed
        with its token; a tunnel may lead to it from any port.

    Examples
    --------
      calm build
      calm build mooring.yaml
      calm build mooring.yaml --environment storm
      calm build mooring.yaml --serve
    """
    if serve:
        return _serve(file, environment, catalog or [], port)
    # it draws and reads keys in a terminal, or in the browser that started it
    terminal = all(stream is not None and stream.isatty() for stream in (sys.stdin, sys.stderr))
    if not (terminal or os.environ.get("TEXTUAL_DRIVER")):
        raise UsageError(_NO_TERMINAL)
    from calm.tui.start import build

    return ExitCode(build(file, environment, catalog or []))


def _serve(file: Path | None, environment: str | None, catalogs: list[Path], port: int) -> ExitCode:
    if not 1 <= port <= 65535:
        raise UsageError(f"--port: {port} is not a port; give one from 1024 to 65535")
    if find_spec("textual_serve") is None:
        raise UsageError(_NO_BROWSER)
    from calm.tui.serve import serve
    from calm.tui.start import open_session

    open_session(file, environment, catalogs)  # what cannot be opened is reported here
    words = [] if file is None else [str(file.absolute())]
    if environment is not None:
        words += ["--environment", environment]
    for path in catalogs:
        words += ["--catalog", str(path.absolute())]
    serve(words, port, narrate)
    return ExitCode.DONE
