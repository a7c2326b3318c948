"""What screens and workers tell the application, and where a mistake is for a person."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from textual.content import Content
from textual.message import Message

if TYPE_CHECKING:
    from calm.errors import Problem
    from calm.files import Catalogue
    from calm.tui.live import View


class Edited(Message):
    """The file, or the environment it is seen in, is another one."""


@dataclass
class Judged(Message):
    """A worker has judged the file; `fully` with its launch, recovery and breaks."""

    view: View
    fully: bool


@dataclass
class JudgingFailed(Message):
    """CALM itself failed."""

    reason: str


@dataclass
class CatalogueRead(Message):
    """A worker has read the catalogue; None where that cannot be used, with the reason."""

    catalogue: Catalogue | None
    reason: str = ""


def is_elsewhere(problem: Problem, path: Path) -> bool:
    """Whether a mistake is in another file than the one that is edited, which has this path."""
    return problem.path not in ("", str(path))


def place_of(problem: Problem, path: Path) -> str:
    """Where a mistake is: ``line 4:2``, with the file where it is not that of the path."""
    place = f"line {problem.line}:{problem.column}" if problem.line else ""
    if not is_elsewhere(problem, path):
        return place
    file, folder = Path(problem.path), path.parent
    name = file.relative_to(folder) if file.is_relative_to(folder) else file
    return f"{name}, {place}" if place else str(name)


def said(problem: Problem, path: Path) -> Content:
    """A mistake with its sign and its place."""
    parts = filter(None, (place_of(problem, path), problem.message))
    return Content.assemble(("!", "bold $text-error"), f" {'  '.join(parts)}")


def mistakes(problems: Sequence[Problem], path: Path) -> str:
    """How many there are, and in which file; empty of none."""
    count = len(problems)
    files = {each.path for each in problems if is_elsewhere(each, path)}
    if not count:
        return ""
    if not files or any(not is_elsewhere(each, path) for each in problems):
        where = "in the file" if not files else "in the file and others"
    else:
        where = f"in {Path(*files).name}" if len(files) == 1 else "in other files"
    return f"{count} mistake{'s' * (count != 1)} {where}"
