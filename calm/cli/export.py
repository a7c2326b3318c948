"""``calm export``: write a mooring or a tow for another program."""

from __future__ import annotations

import os

from calm.cli import options
from calm.cli.outputs import ExitCode, check_suffix, narrate, save
from calm.errors import UsageError


def export(
    file: options.MooringPath,
    /,
    *,
    to: str,
    output: options.OutputFile,
    environment: options.EnvironmentName = None,
    catalog: options.CatalogFiles = None,
) -> ExitCode:
    """Write a mooring or a tow for another program.

    Features that the other program cannot represent are reported and listed at
    the top of the file. A piece with `length: fit` is exported with the length that
    CALM computes for it.

    Parameters
    ----------
    to
        Program or format: mdd (Mooring Design & Dynamics), cbl (WHOI Cable), moordyn (MoorDyn 2,
        with the current in a second file) or csv (a list of the pieces).
    output
        File to write: .mat for mdd, .cbl for cbl, .txt or .dat for moordyn, .csv for csv.

    Examples
    --------
      calm export mooring.yaml --to mdd -o mooring.mat
      calm export mooring.yaml --to cbl -o mooring.cbl --environment storm
      calm export mooring.yaml --to moordyn -o moordyn/mooring.txt
      calm export mooring.yaml --to csv -o mooring.csv
    """
    from calm.exchange.exporting import export_file, written_format
    from calm.report.folder import check_destination

    check_destination(output)
    if os.path.realpath(output) == os.path.realpath(file):
        raise UsageError(f"{output} is the input file; choose another output")
    check_suffix(output, written_format(to).suffixes)
    exported = export_file(file, to, environment=environment, catalogs=catalog or [])
    beside = {output.with_name(name): content for name, content in exported.beside.items()}
    for path in beside:
        check_destination(path)
    for path, content in beside.items():
        save(path, content)
    for each in exported.lost:
        narrate(f"{output}: not exported: {each}")
    save(output, exported.content)
    return ExitCode.DONE
