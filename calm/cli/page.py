"""``calm page``: the line builder as a web page."""

from pathlib import Path
from typing import Annotated

from cyclopts import Parameter

from calm.cli.outputs import ExitCode, narrate


def page(
    *,
    output: Annotated[Path, Parameter(alias="-o")],
    runtime: Path | None = None,
) -> ExitCode:
    """Write the line builder as a web page that needs no installation.

    Any web server can serve the folder. Files opened or created in the page stay
    in the browser. Once loaded, the page works without a network.

    Parameters
    ----------
    output
        Folder for the page.
    runtime
        Folder that contains a release of Pyodide, xterm.js and xterm.css. These files are copied
        into the folder of the page, so that the page needs no other server. By default the page
        loads them from the internet.

    Examples
    --------
      calm page -o site/try
      calm page -o ship --runtime pyodide/
    """
    from calm.page.folder import write_page
    from calm.report.folder import check_folder

    check_folder(output)
    written = write_page(output, runtime)
    size = sum((output / name).stat().st_size for name in written) / 1e6
    narrate(
        f"Page written to {output} ({size:.1f} MB). To view it, run python -m http.server -d "
        f"{output} and open http://localhost:8000"
    )
    return ExitCode.DONE
