"""From a mooring file to the file of another program."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path

from calm.case import load
from calm.errors import UsageError
from calm.exchange.assembling import assembled
from calm.exchange.cbl.writing import cbl_file
from calm.exchange.mdd.writing import mdd_file
from calm.exchange.moordyn.writing import CURRENTS, current_profile, moordyn_file
from calm.exchange.parts import ExportedLine
from calm.exchange.table.writing import csv_file
from calm.files.explain import unknown

Writer = Callable[[ExportedLine], tuple[bytes, tuple[str, ...]]]

WRITERS: dict[str, Writer] = {
    "mdd": mdd_file, "cbl": cbl_file, "csv": csv_file, "moordyn": moordyn_file,
}  # fmt: skip
"""What a mooring can be written for."""


@dataclass(frozen=True)
class Exported:
    """The content of a file for another program, what it cannot hold, and the files beside it."""

    content: bytes
    lost: tuple[str, ...]
    beside: dict[str, bytes]


def export_file(
    path: Path,
    to: str,
    *,
    environment: str | None = None,
    catalogs: Sequence[Path] = (),
) -> Exported:
    """Write a mooring or a tow for another program.

    Parameters
    ----------
    to : one of `WRITERS`
    environment : a name in the file, or an environment file
    catalogs : as `calm.load` takes them

    Raises
    ------
    InputError, NoEquilibrium, UsageError
        The file has mistakes, no length of a piece that is cut to fit is right, or `to` is no
        program.
    """
    if to not in WRITERS:
        raise UsageError(
            unknown(f"--to: `{to}` is not a program that CALM writes for", to, WRITERS)
        )
    design = assembled(load(path, environment, list(catalogs)))
    content, lost = WRITERS[to](design)
    beside = {CURRENTS: current_profile(design)} if to == "moordyn" else {}
    return Exported(content, lost, beside)
