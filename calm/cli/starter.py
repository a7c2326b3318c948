"""``calm new`` and ``calm schema``: what one needs to write a mooring file."""

from __future__ import annotations

import json
from importlib.resources import files
from pathlib import Path
from typing import Annotated

from cyclopts import Parameter

from calm.cli.exit_codes import ExitCode
from calm.cli.streams import narrate, show
from calm.errors import UsageError

NEW_EXAMPLES = """Examples:

  calm new
  calm new -o mooring.yaml"""

SCHEMA_EXAMPLES = """Examples:

  calm schema > mooring.schema.json"""


def new(
    *, output: Annotated[Path | None, Parameter(alias="-o")] = None, force: bool = False
) -> ExitCode:
    """Write a commented mooring file to start from.

    Parameters
    ----------
    output
        The file to write; the standard output when not given.
    force
        Overwrite the file if there is one.
    """
    from calm.report.write import check_destination, write_file

    text = (files("calm.cli") / "starter.yaml").read_text(encoding="utf-8")
    if output is None:
        show(text)
        return ExitCode.DONE
    if output.exists() and not force:
        raise UsageError(f"{output} exists already; --force overwrites it")
    check_destination(output)
    write_file(output, text.encode())
    narrate(f"{output} written; solve it with: calm run {output}")
    return ExitCode.DONE


def schema() -> ExitCode:
    """Print the JSON Schema of mooring files, for editors."""
    from calm.files import mooring_schema

    show(json.dumps(mooring_schema(), indent=2) + "\n")
    return ExitCode.DONE
