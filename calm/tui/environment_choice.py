"""Which environment the line that is built stands in."""

from __future__ import annotations

import os.path

from calm.files.editing import History


class Standing:
    """A line that stands in its file's own environment, in a named one or in that of a file.

    Parameters
    ----------
    history : of the file
    environment : the name of one of its environments, or an environment file; None of its own
    """

    def __init__(self, history: History, environment: str | None) -> None:
        self._history, self._environment = history, environment
        self._is_file = environment not in self.environments and os.path.isfile(environment or "")

    @property
    def environments(self) -> list[str | None]:
        """Return those of the file; None is its own, the first."""
        named = self._history.draft.value(("environments",))
        return [None, *(named if isinstance(named, dict) else ())]

    @property
    def environment(self) -> str | None:
        """Return what the line stands in: the own one, too, where that chosen is in the file no
        more.
        """
        return None if self.lost_environment else self._environment

    @environment.setter
    def environment(self, name: str | None) -> None:
        self._environment, self._is_file = name, False

    @property
    def lost_environment(self) -> str | None:
        """The chosen environment, where the file, as far as it can be read, does not have it."""
        here = self._environment
        is_there = self._is_file or self._history.draft.problems or here in self.environments
        return None if is_there else here

    @property
    def next_environment(self) -> str | None:
        """The one after that, the own one after the last."""
        names, here = self.environments, self.environment
        return names[(names.index(here) + 1) % len(names)] if here in names else None
