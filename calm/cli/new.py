"""``calm new``: write an example of a mooring file with comments, or of a record of currents."""

from pathlib import Path
from typing import Annotated

from cyclopts import Parameter

from calm.cli.outputs import ExitCode, save, show
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
    """Write an example mooring file with comments, or a matching current record.

    Parameters
    ----------
    kind
        Kind of mooring: on the shelf, in the deep sea, an ADCP, a surface buoy, or a tow.
    record
        Write a small synthetic NetCDF record for `calm batch`; needs --output.
    output
        File to write; standard output by default.
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
    _write(output, text.encode(), force, f"; solve it with: calm run {output}")
    return ExitCode.DONE


def _new_record(output: Path | None, force: bool) -> ExitCode:
    from calm.records.record import made_record

    if output is None:
        raise UsageError("a record is binary and cannot be printed; specify --output record.nc")
    result = output.with_name(f"{output.stem}-result.nc")
    then = f"; solve it with: calm batch FILE --currents {output} -o {result}"
    _write(output, made_record(), force, then)
    return ExitCode.DONE


def _write(output: Path, content: bytes, force: bool, then: str) -> None:
    from calm.report.folder import check_destination

    if output.exists() and not force:
        raise UsageError(f"{output} exists already; use --force to overwrite it")
    check_destination(output)
    save(output, content, then)
