"""Reading of files for the commands: single designs, or moorings in all their environments."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, TypeVar

from calm.cli.progress import mapped
from calm.errors import InputError, NoEquilibrium, Problem, UsageError

if TYPE_CHECKING:
    from calm.case import Design

Line = TypeVar("Line")


def read_all(
    load: Callable[[Path, str | None, Sequence[Path]], Line],
    files: Sequence[Path],
    environment: str | None,
    catalogs: Sequence[Path],
) -> list[Line]:
    """Read all files with `calm.case.load` or a similar function. Raise one InputError with the
    mistakes of all files.
    """
    read: list[Line] = []
    problems: dict[Problem, None] = {}
    for file in files:
        try:
            read.append(load(file, environment, catalogs))
        except InputError as error:
            # mistakes of a shared catalogue are listed once
            problems |= dict.fromkeys(error.problems)
    if problems:
        raise InputError(list(problems))
    return read


@dataclass(frozen=True)
class DesignFile:
    """A mooring file with a unique name, read in each of its environments."""

    path: Path
    name: str
    moorings: tuple[Design, ...]


def read_designs(
    files: Sequence[Path],
    environments: Sequence[str] | None,
    catalogs: Sequence[Path],
    workers: int | None,
    command: str = "calm check",
    meanwhile: Callable[[], object] | None = None,
) -> tuple[list[DesignFile], list[Path]]:
    """Read every mooring in every environment, and separate the files that are tows.

    Parameters
    ----------
    environments : names or files of environments; None for all environments of each file
    meanwhile : function called in this process while other processes read

    Raises
    ------
    InputError
        Files have mistakes; all mistakes are listed.
    UsageError
        All files are tows, a file is given twice, or two environments have the same name.
    """
    given = Counter([*map(str, files), *(environments or ())])
    twice = [word for word, count in given.items() if count > 1]
    if twice:
        raise UsageError(f"given twice: {', '.join(twice)}")
    problems: dict[Problem, None] = {}
    by_path: dict[Path, list[Design]] = {}
    tows: list[Path] = []
    tasks = [(file, environments, catalogs) for file in files]
    loaded = mapped(_load, tasks, workers, "files read", meanwhile)
    for file, read in zip(files, loaded, strict=True):
        if isinstance(read, tuple):
            problems |= dict.fromkeys(read)  # mistakes of shared files are listed once
        elif any(one.towed for one in read):
            tows.append(file)
        else:
            by_path[file] = read
    if problems:
        raise InputError(list(problems))
    if not by_path:
        named = ", ".join(map(str, tows))
        raise UsageError(f"{command} is only for moorings; these are tows: {named}")
    for its in by_path.values():
        _refuse_equal_names(its)
    called = _unique_names({path: its[0].file.name for path, its in by_path.items()})
    designs = [
        DesignFile(path, called[path], _with_cuts_of_first(its)) for path, its in by_path.items()
    ]
    return designs, tows


def names_of_files(
    designs: Sequence[DesignFile], folder: Path, taken: Sequence[str] = ()
) -> list[str]:
    """Convert mooring names to names of files or folders.

    Characters that file systems reject become hyphens. Raises UsageError if two
    moorings have the same name, or a name in `taken`.
    """
    plain = (re.sub(r'[\x00-\x1f<>:"/\\|?*]+', "-", each.name).strip(" .") for each in designs)
    names = [name or "mooring" for name in plain]
    known = [one.casefold() for one in (*names, *taken)]
    for name in names:
        if known.count(name.casefold()) > 1:
            raise UsageError(f"two moorings would be written to {folder / name}; rename one")
    return names


def _unique_names(names: dict[Path, str]) -> dict[Path, str]:
    while True:
        count = Counter(names.values())
        if max(count.values()) == 1:
            return names
        names = {
            path: name if count[name] == 1 else f"{name} ({path})" for path, name in names.items()
        }


def _with_cuts_of_first(moorings: Sequence[Design]) -> tuple[Design, ...]:
    from calm.case import Design
    from calm.case.memory import Memory

    # results that do not depend on the environment, such as the line in still water, are computed
    # once
    memory = Memory()
    first, *others = (Design(each.file, memory=memory) for each in moorings)
    try:
        leg = first.legs[0]  # nets have no pieces cut to fit
        return first, *(Design(leg.cut(each.file), memory=memory) for each in others)
    except NoEquilibrium:
        return first, *others  # the missing equilibrium of the first is reported later


def _load(
    task: tuple[Path, Sequence[str] | None, Sequence[Path]],
) -> list[Design] | tuple[Problem, ...]:
    from calm.case.design import load_in

    try:
        return load_in(*task)
    except InputError as error:
        return error.problems


def _refuse_equal_names(moorings: Sequence[Design]) -> None:
    from calm.checks.finding import HANDLING_LABEL, OWN

    # results could not distinguish environments with the same name
    names = Counter(mooring.file.environment.name or OWN for mooring in moorings)
    names[HANDLING_LABEL] += 1  # this name heads a column of its own
    for name, count in names.items():
        if count > 1:
            raise UsageError(f"{count} environments are named {name}; rename all but one")
