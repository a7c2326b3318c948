"""Registry of file formats: recognition, readers and writers.

A format is a module that calls `register_format`. CALM imports this module when the format is first
used. Other packages list such modules in the entry point ``calm.formats``.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from importlib import import_module
from importlib.metadata import entry_points
from pathlib import Path
from typing import TYPE_CHECKING

from calm.errors import CalmError

if TYPE_CHECKING:
    from calm.exchange.exported_parts import ExportedDesign
    from calm.exchange.model import ImportedDesign, ImportOptions

ENTRY_POINTS = "calm.formats"
"""Entry-point group in which packages list the modules of their formats."""

_OWN = {
    "mdd": "calm.exchange.mdd",
    "cbl": "calm.exchange.cbl",
    "moordyn": "calm.exchange.moordyn",
    "oceanarray": "calm.exchange.oceanarray",
    "moords": "calm.exchange.moords",
    "table": "calm.exchange.table",
    "csv": "calm.exchange.table",
}
"""Built-in formats and their modules, in the order in which they are tried on a file. `table` is
the last format with a reader, because `table` accepts any text in columns.
"""


@dataclass(frozen=True)
class Exported:
    """Result of an export: a file for another program.

    `lost` lists the features that the format cannot represent. `beside` has the contents of further
    files for the same folder, by file name.
    """

    content: bytes
    lost: tuple[str, ...]
    beside: Mapping[str, bytes] = field(default_factory=dict)


Detect = Callable[[bytes], bool]
"""Function that returns whether a file has a format, given its first 70 000 bytes."""

Read = Callable[[Path, "ImportOptions"], "ImportedDesign"]
"""Function that reads a file as a design; for an unreadable file it raises the error made by
`calm.errors.refused`.
"""

Write = Callable[["ExportedDesign"], Exported]
"""Function that writes a design in a format."""


@dataclass(frozen=True)
class FileFormat:
    """A registered format of design files, with the fields described in `register_format`."""

    name: str
    program: str
    detect: Detect | None
    read: Read | None
    write: Write | None
    takes_elements: bool
    writes_nets: bool
    suffixes: tuple[str, ...]


_registered: dict[str, FileFormat] = {}


def register_format(
    name: str,
    detect: Detect | None = None,
    read: Read | None = None,
    write: Write | None = None,
    *,
    program: str = "",
    takes_elements: bool = False,
    writes_nets: bool = False,
    suffixes: Sequence[str] = (),
) -> None:
    """Register a format for `calm import` or `calm export`.

    Parameters
    ----------
    name : name for `--format` and `--to`, and name of the entry point
    detect : function that recognises a file; None if the user must give `--format`
    read : function for import; None if the format cannot be imported
    write : function for export; None if the format cannot be exported
    program : name of the program, for messages; by default, `name`
    takes_elements : whether `read` uses the library `ImportOptions.elements`
    writes_nets : whether `write` accepts designs with several legs
    suffixes : file name suffixes that the program accepts, such as ".mat"; by default any
    """
    if name in _registered:
        raise ValueError(f"the format `{name}` already exists")
    _registered[name] = FileFormat(
        name, program or name, detect, read, write, takes_elements, writes_nets, tuple(suffixes)
    )


def file_format(name: str) -> FileFormat:
    """Return the format with a given name, and import the module of the format if needed.

    Raises
    ------
    KeyError
        There is no such format.
    CalmError
        The module cannot be imported, or does not register the format.
    """
    if name not in _registered:
        module = _OWN[name] if name in _OWN else _added_modules()[name]
        try:
            import_module(module)
        except Exception as error:
            reason = f"{type(error).__name__}: {error}"
            raise CalmError(
                f"the format `{name}` of {module} cannot be loaded ({reason})"
            ) from error
        if name not in _registered:
            raise CalmError(f"{module} registers no format `{name}`")
    return _registered[name]


def file_formats() -> tuple[FileFormat, ...]:
    """Return all formats, in the order in which they are tried to recognise a file.

    Formats from other packages come first.

    Raises
    ------
    CalmError
        As in `file_format`.
    """
    for name in (*_added_modules(), *_OWN):
        file_format(name)
    others = sorted(_registered.keys() - _OWN.keys())
    return tuple(_registered[name] for name in (*others, *_OWN))


def _added_modules() -> dict[str, str]:
    added = {entry.name: entry.module for entry in entry_points(group=ENTRY_POINTS)}
    if taken := sorted(added.keys() & _OWN.keys()):
        raise CalmError(
            f"{added[taken[0]]} adds a format `{taken[0]}`, but CALM itself has a format of "
            "this name"
        )
    return added
