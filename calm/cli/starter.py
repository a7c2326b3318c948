"""``calm new`` and ``calm schema``: what one needs to write a mooring file."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Annotated

from cyclopts import Parameter

from calm.cli.streams import ExitCode, narrate, show
from calm.errors import UsageError
from calm.templates import Template, template

NEW_EXAMPLES = """Examples:

  calm new
  calm new -o mooring.yaml
  calm new taut-surface -o buoy.yaml
  calm new --record -o record.nc"""

SCHEMA_EXAMPLES = """Examples:

  calm schema > mooring.schema.json"""


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
        The file to write; the standard output when not given.
    force
        Overwrite the file if there is one.
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
    """Print the JSON Schema of mooring files, for editors."""
    from calm.files import mooring_schema

    show(json.dumps(mooring_schema(), indent=2) + "\n")
    return ExitCode.DONE
