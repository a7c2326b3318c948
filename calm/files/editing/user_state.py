"""Per-user state kept between sessions: open files and favourite components."""

import hashlib
import json
import os
from contextlib import suppress
from dataclasses import asdict
from pathlib import Path

from calm import whole_file
from calm.files.editing.working_file import Keeper, state_folder


class Presence:
    """Entry in the state folder that records which file this process has open."""

    def __init__(self) -> None:
        self._place: Path | None = None

    def announce(self, path: Path | None) -> list[int]:
        """Record the open file; return the ids of other processes that have the same file open.

        The path None means that this process has no file open.
        """
        if self._place is not None:
            with suppress(OSError):
                self._place.unlink(missing_ok=True)
        self._place = None
        if path is None:
            return []
        own, folder, others = Keeper.this(), state_folder(), []
        sign = hashlib.sha256(os.fsencode(os.path.realpath(path))).hexdigest()[:12]
        with suppress(OSError):
            folder.mkdir(parents=True, exist_ok=True)
            for place in folder.glob(f"open-{sign}-*.json"):
                with suppress(OSError, ValueError, TypeError):
                    keeper = Keeper(**json.loads(place.read_text(encoding="utf-8")))
                    if keeper.is_here and not keeper.is_running:
                        place.unlink(missing_ok=True)
                    elif keeper != own:
                        others.append(keeper.process)
            self._place = folder / f"open-{sign}-{own.process}.json"
            whole_file.put(self._place, json.dumps(asdict(own)).encode())
        return others


_NAME = "catalogue.json"
_MOST_RECENT = 40


class Remembered:
    """Ids of favourite and recently used components, kept between sessions, latest first.

    The lists are empty if their file cannot be read.
    """

    def __init__(self) -> None:
        try:
            kept = json.loads((state_folder() / _NAME).read_text(encoding="utf-8"))
            lists = [kept["favourites"], kept["recent"]]
            ids = [[each for each in kept if isinstance(each, str)] for kept in lists]
        except (OSError, ValueError, KeyError, TypeError):
            ids = [[], []]
        self.favourites, self.recent = ids

    def take(self, id: str) -> None:
        """Record the choice of a component, without an error if the choice cannot be saved."""
        self.recent = [id, *(each for each in self.recent if each != id)][:_MOST_RECENT]
        with suppress(OSError):
            self._keep()

    def mark(self, id: str) -> bool:
        """Mark or unmark a component as a favourite; return whether it is a favourite afterwards.

        Raises
        ------
        OSError
            The mark could not be saved, so it is lost when the builder ends.
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
