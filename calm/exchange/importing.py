"""Import a file of another program: its format is found, it is read, written, and read back.

The design is completed: an anchor that holds, entries of the catalogue, an environment.
"""

from __future__ import annotations

import os
import re
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from pydantic import ValidationError

from calm.assemble.component_forces import drag_of
from calm.errors import InputError, UsageError, one_line, refused
from calm.exchange import model
from calm.exchange.cable_reader import is_cbl, read_cbl
from calm.exchange.design_writer import figure_text, mooring_text, secure_anchors
from calm.exchange.list_cells import is_table
from calm.exchange.list_reader import read_list
from calm.exchange.mat_file import is_mat
from calm.exchange.mdd_elements import is_moords, read_moords
from calm.exchange.mdd_file import read_mdd
from calm.exchange.moordyn_reader import is_moordyn, read_moordyn
from calm.exchange.oceanarray_reader import is_oceanarray, read_oceanarray
from calm.files import Anchor, Catalogue, Rigid, read_mooring
from calm.files.components import FLEXIBLE_KINDS, KINDS, Component
from calm.files.editing.writing import WritingStyle
from calm.files.yaml_document import read_document

_HEAD = 70_000  # bytes from which a format is recognised


@dataclass(frozen=True)
class ImportFormat:
    """Describe a format that can be imported: its name, how it is recognised and read."""

    name: str
    program: str
    recognises: Callable[[bytes], bool]
    read: Callable[[Path, model.ImportOptions], model.ImportedDesign]


FORMATS = (
    ImportFormat("mdd", "Mooring Design & Dynamics", is_mat, lambda path, _: read_mdd(path)),
    ImportFormat("cbl", "WHOI Cable", is_cbl, read_cbl),
    ImportFormat("moordyn", "MoorDyn or MoorPy", is_moordyn, lambda path, _: read_moordyn(path)),
    ImportFormat("oceanarray", "oceanarray", is_oceanarray, read_oceanarray),
    ImportFormat("moords", "moords", is_moords, lambda path, _: read_moords(path)),
    ImportFormat("table", "a list in CSV or a spreadsheet", is_table, read_list),
)


@dataclass(frozen=True)
class Imported:
    """Hold a mooring file made of another program's file.

    Attributes
    ----------
    file : that it comes from
    format : name of its format
    text : of the mooring file
    guessed, dropped : what was guessed, and what was left out
    matched : components that the catalogue has
    record : currents at several times, where the file has them
    """

    file: Path
    format: str
    text: str
    guessed: tuple[model.Remark, ...]
    dropped: tuple[model.Remark, ...]
    matched: tuple[CatalogueMatch, ...]
    record: model.CurrentRecord | None


def import_file(
    path: Path,
    output: Path,
    *,
    format: str | None = None,
    environment: Path | None = None,
    options: model.ImportOptions | None = None,
    match_catalogue: bool = False,
) -> Imported:
    """Read a file of another program.

    Parameters
    ----------
    output : path of the mooring file to come; nothing is written here
    format : one of `FORMATS`; found from the content when not given
    environment : an environment file, in place of what the file has
    match_catalogue : use catalogue entries for what agrees with them

    Raises
    ------
    InputError
        The file is damaged or holds what CALM cannot represent: each by name.
    UsageError
        There is no such format.
    """
    options = options or model.ImportOptions()
    chosen = _format_of(path, format, listed=options.elements is not None)
    if options.elements is not None and chosen.name not in ("table", "oceanarray"):
        raise refused(path, f"is of {chosen.program}; --elements is for lists")
    design = chosen.read(path, options)
    levels = 0 if design.water is None else len(design.water.current)
    for what, count in (("pieces", len(design.items)), ("levels of current", levels)):
        if count > model.MOST_PIECES:
            raise refused(
                path, f"has {count} {what}; more than {model.MOST_PIECES} are not imported"
            )
    if environment is not None:
        design.environment = environment_lines(environment, output)
        if design.water is not None:
            what = f"the water of the file: {environment.name} replaces it"
            design.dropped.append(model.Remark("environment", what))
        design.record = None
    elif design.water is None and design.tow is None:
        message = "has no environment; give one: --environment FILE (depth, current, density)"
        raise refused(path, message)
    matched = match_catalogue_entries(design) if match_catalogue else ()
    secure_anchors(design, output)
    text, guessed = mooring_text(design, path.name)
    _check(path, output, text)
    return Imported(
        path, chosen.name, text, tuple(guessed + design.guessed),
        tuple(design.dropped), matched, design.record,
    )  # fmt: skip


def _format_of(path: Path, name: str | None, *, listed: bool = False) -> ImportFormat:
    """Return the format of a file: as named, or by its content.

    One that is `listed` is a list where it is of no other format, even with a single column.
    """
    if name is not None:
        for each in FORMATS:
            if each.name == name:
                return each
        raise UsageError(f"--format: `{name}` is none of {', '.join(one.name for one in FORMATS)}")
    try:
        with path.open("rb") as file:
            content = file.read(_HEAD)
    except OSError as error:
        raise refused(path, f"cannot be read: {error.strerror}") from None
    for each in FORMATS:
        if each.recognises(content) or (listed and each is FORMATS[-1]):
            return each
    programs = ", ".join(f"{each.name} ({each.program})" for each in FORMATS)
    raise refused(path, f"is not a file of a program that CALM reads: {programs}")


def _check(path: Path, output: Path, text: str) -> None:
    """Read the mooring file as `calm run` will; a mistake in it is one of its source."""
    try:
        read_mooring(output, text=text)
    except InputError as error:
        lines = ["", *text.splitlines()]
        blamed = [lines[each.line] if each.line < len(lines) else "" for each in error.problems]
        raise refused(
            path,
            *(
                f"{each.message} (in `{' '.join(line.split())[:80]}`)" if line else each.message
                for each, line in zip(error.problems, blamed, strict=True)
            ),
        ) from None


def record_file(record: model.CurrentRecord, source: str) -> bytes:
    """Return a record as a classic NetCDF file by the CF conventions."""
    import xarray as xr

    speeds = {
        name: (
            ("time", "depth"),
            np.ascontiguousarray(values, np.float64),
            {"standard_name": standard_name, "units": "m s-1"},
        )
        for name, standard_name, values in (
            ("u", "eastward_sea_water_velocity", record.u),
            ("v", "northward_sea_water_velocity", record.v),
            ("w", "upward_sea_water_velocity", record.w),
        )
    }
    seconds = np.rint(record.days * 86_400e3) / 1e3  # days hold a millisecond, hardly more
    time = {
        "standard_name": "time",
        "units": f"seconds since {record.epoch}",
        "calendar": "standard",
    }
    depth = {"standard_name": "depth", "units": "m", "positive": "down", "axis": "Z"}
    dataset = xr.Dataset(
        speeds,
        {
            "time": ("time", seconds, {**time, "axis": "T"}),
            "depth": ("depth", np.asarray(record.depth, np.float64), depth),
        },
        {"Conventions": "CF-1.11", "title": "Currents", "source": source},
    )
    return bytes(dataset.to_netcdf(engine="scipy"))


_TOLERANCE = 0.05
"""Share by which size, net force and drag may differ from those of a catalogue entry."""

_COMMON_WORDS = 0.5  # share of the words of a name that an entry must have, two at least


@dataclass(frozen=True)
class CatalogueMatch:
    """Name a component, as the file has it, and the catalogue entry used in its place."""

    name: str
    entry: str


def match_catalogue_entries(design: model.ImportedDesign) -> tuple[CatalogueMatch, ...]:
    """Use catalogue entries for the components whose name and figures agree with one.

    A component is of the same kind, shares half the words of its name, and is within `_TOLERANCE`
    in diameter, length, net force, normal drag and stiffness, as far as both give them.
    """
    catalogue = Catalogue.load()
    entries = {id: entry for id, entry in catalogue.all().items() if isinstance(entry, Component)}
    matched: dict[str, CatalogueMatch] = {}
    for component in design.components():
        model = _model(component)
        if model is None or component.entry:
            continue
        for id, entry in entries.items():
            if _alike(component.name, f"{id} {entry.name or ''}") and _agree(
                model, entry, sizeless="drag_area" in component.guesses
            ):
                component.entry = id
                matched[id + component.name] = CatalogueMatch(component.name, id)
                break
    return tuple(matched.values())


def _model(component: model.ImportedComponent) -> Component | None:
    per_metre = component.kind in FLEXIBLE_KINDS
    fields = {
        key: figure_text(key, value, per_metre=per_metre, in_kilograms=False)
        for key, value in component.figures.items()
    }
    try:
        return KINDS[component.kind].model_validate({"kind": component.kind, **fields})
    except ValidationError:
        return None


def _alike(name: str, other: str) -> bool:
    words, others = (
        set(re.findall(r"[a-z]+|\d+(?:[./]\d+)?", text.lower())) for text in (name, other)
    )
    shared = words & others
    return len(shared) >= 2 and len(shared) >= _COMMON_WORDS * len(words)


def _agree(one: Component, other: Component, *, sizeless: bool) -> bool:
    """Return whether two agree in figures; one that is `sizeless` in the file, in net force."""
    pairs: list[tuple[float | None, float | None]] = [(one.net_buoyancy, other.net_buoyancy)]
    if sizeless:
        if not isinstance(other, Rigid):
            return False
    elif one.kind != other.kind or isinstance(one, Anchor):
        return False
    else:
        sizes = ("diameter", "length", "stiffness")
        pairs += [(getattr(one, key, None), getattr(other, key, None)) for key in sizes]
        # at 1 m/s across it [N], of a cable or chain per metre
        pairs.append((drag_of(one)[0], drag_of(other)[0]))
    given = [(a, b) for a, b in pairs if a is not None and b is not None]
    return all(abs(a - b) <= _TOLERANCE * max(abs(a), abs(b)) for a, b in given)


def environment_lines(path: Path, output: Path) -> list[str]:
    """Return the `environment` of a file, its paths relative to the folder of the mooring file.

    InputError: the file cannot be read, or has no `environment`.
    """
    found = read_document(path).data.get("environment")
    if not isinstance(found, dict) or not found:
        raise refused(path, "has no `environment`")
    current = found.get("current")
    if isinstance(current, dict) and isinstance(current.get("file"), str):
        target = os.path.join(path.parent, current["file"])
        found["current"] = {**current, "file": os.path.relpath(target, str(output.parent))}
    _, *below = WritingStyle().entry("environment", found, 1).splitlines()
    return [f"environment:  # that of {one_line(path.name)}", *below]
