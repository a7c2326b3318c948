"""What a person took from the catalogue last, and what is marked in it."""

from __future__ import annotations

import json
from collections.abc import Iterable

from calm import whole_file
from calm.files.editing import state_folder

_NAME = "catalogue.json"
_MOST_RECENT = 40


class Remembered:
    """Ids of components, each list the last one first; a file that cannot be read is none.

    Attributes
    ----------
    favourites : marked by the person
    recent : taken from the catalogue
    """

    def __init__(self) -> None:
        self.favourites, self.recent = _read()

    def take(self, id: str) -> None:
        """Note that one was taken; where it cannot be kept, for this session only."""
        self.recent = [id, *(each for each in self.recent if each != id)][:_MOST_RECENT]
        try:
            self._keep()
        except OSError:
            return

    def mark(self, id: str) -> bool:
        """Mark a favourite, or unmark it; returns whether it is one now.

        Raises
        ------
        OSError
            It could not be kept, and is one in this session only.
        """
        is_new = id not in self.favourites
        self.favourites = [each for each in self.favourites if each != id]
        if is_new:
            self.favourites.insert(0, id)
        self._keep()
        return is_new

    def _keep(self) -> None:
        folder = state_folder()
        folder.mkdir(parents=True, exist_ok=True)
        content = json.dumps({"favourites": self.favourites, "recent": self.recent}, indent=1)
        whole_file.put(folder / _NAME, content.encode())


def _read() -> tuple[list[str], list[str]]:
    try:
        kept = json.loads((state_folder() / _NAME).read_text(encoding="utf-8"))
        return _ids(kept["favourites"]), _ids(kept["recent"])
    except (OSError, ValueError, KeyError, TypeError):
        return [], []


def _ids(kept: Iterable[object]) -> list[str]:
    return [each for each in kept if isinstance(each, str)]
