"""What screens and workers tell the application."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from textual.message import Message

if TYPE_CHECKING:
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
