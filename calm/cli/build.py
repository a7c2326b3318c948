"""``calm build``: the line builder, in a terminal or a browser."""

import os
import sys
from importlib.util import find_spec
from pathlib import Path

from calm.cli import options
from calm.cli.outputs import ExitCode, narrate
from calm.errors import UsageError

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
