"""Names in a file: labels of pieces, kept in step with the line; environments."""

import os.path
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from itertools import chain
from typing import Any

from calm.errors import CalmError
from calm.files import Place, check_limits, yaml_document
from calm.files.editing import Draft, History
from calm.files.pieces import numbered_labels

_MOST_OF_A_COUNT = 1000


@dataclass(frozen=True)
class Named:
    """A label, or a pattern of labels, as a file names it, and where."""

    location: yaml_document.Location
    text: str

    @property
    def where(self) -> str:
        """For people: the keys that lead there."""
        return ": ".join(str(key) for key in self.location[:2] if isinstance(key, str))


def named_in(draft: Draft) -> Iterator[Named]:
    """All that a file names of its line: what is accepted, what was deployed, stops."""

    def within(*location: str | int) -> Iterator[tuple[yaml_document.Location, Any]]:
        values = draft.value(location)
        if isinstance(values, dict | list):
            pairs = values.items() if isinstance(values, dict) else enumerate(values)
            yield from (((*location, key), value) for key, value in pairs)

    def under(key: str, *location: str | int) -> list[tuple[yaml_document.Location, Any]]:
        rows = (row for row, _ in within(*location))
        return [each for row in rows for each in within(*row) if each[0][-1] == key]

    lists = [("components",), ("line",), *((*row, "clamps") for row, _ in within("line"))]
    named = under("component", "checks", "accept") + under("label", "deployed", "items")
    for rows in lists:
        named += [each for row, _ in within(*rows) for each in within(*row, "between")]
    for place, text in named:
        if isinstance(text, str):
            yield Named(place, text)


def labels_of(draft: Draft) -> dict[Place, list[str]]:
    """The labels of each row, those of a count numbered; parts of an assembly are not told."""
    rows: list[tuple[Place, str]] = []
    for number, item in enumerate(draft.items):
        count = item.values.get("count", "1")
        parts = enumerate((item, *item.clamps), -1)
        named = [
            (Place(number, clamp=i), part.values.get("label") or part.values.get("use", ""))
            for i, part in parts
        ]
        rows += named * (min(int(count), _MOST_OF_A_COUNT) if count.isdecimal() else 1)
    found: dict[Place, list[str]] = {}
    for (place, _), label in zip(rows, numbered_labels([text for _, text in rows]), strict=True):
        found.setdefault(place, []).append(label)
    return found


def followed(before: Draft, after: Draft, moved: Mapping[Place, Place]) -> tuple[Draft, list[str]]:
    """An edited file that names its pieces as they are called now; what was done, in words.

    Parameters
    ----------
    before, after : the file, and as it was edited
    moved : the rows that are left of the line, and where they are now
    """
    names = list(named_in(after))
    old, new = labels_of(before), labels_of(after)
    renamed = {
        label: now
        for place, labels in old.items()
        for label, now in zip(labels, new.get(moved.get(place, place), ()), strict=False)
        if place in moved
    }
    known, all_now = ([*chain.from_iterable(each.values())] for each in (old, new))
    told = []
    for each in names:
        meant = set(check_limits.matching(each.text, known))
        wanted = {renamed[label] for label in meant if label in renamed}
        if not meant or (set(check_limits.matching(each.text, all_now)) >= wanted and wanted):
            continue
        text = _called(each.text, wanted, renamed, all_now)
        try:
            if text is None:
                raise LookupError
            after = after.put_at(each.location, text)
        except (CalmError, LookupError):
            told.append(f"{each.where} still names `{each.text}`, which is gone")
        else:
            told.append(f"{each.where} now names {text}")
    return after, list(dict.fromkeys(told))


def _called(
    text: str, wanted: set[str], renamed: Mapping[str, str], labels: Iterable[str]
) -> str | None:
    """Return what stands for pieces as they are called now; None where nothing does."""
    labels = list(labels)
    if text in renamed:
        return renamed[text]
    for label, now in renamed.items():
        base, its = label.rstrip("0123456789 "), now.rstrip("0123456789 ")
        tried = text.replace(base, its)
        if base != its and wanted and set(check_limits.matching(tried, labels)) == wanted:
            return tried
    return None


def namings(draft: Draft, place: Place) -> list[Named]:
    """Return what names a row, and nothing but it: a copy of it would be another piece of that
    name.
    """
    return [each for each in named_in(draft) if labels_of(draft).get(place) == [each.text]]


def widened(draft: Draft, named: Iterable[Named]) -> Draft:
    """A file in which what is accepted of a piece is so of all that are called like it."""
    for each in named:
        if each.location[0] == "checks" and not each.text.endswith("*"):
            draft = draft.put_at(each.location, f"{each.text} *")
    return draft


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
        """Return what the line stands in; its own where the chosen one is gone from the file."""
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
