"""References to labels, updated when labels change, and the choice of the environment."""

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
    """Reference in the file to a label, or to a pattern of labels."""

    location: yaml_document.Location
    text: str

    @property
    def where(self) -> str:
        """Path of the reference in the file, for messages."""
        return ": ".join(str(key) for key in self.location[:2] if isinstance(key, str))


def named_in(draft: Draft) -> Iterator[Named]:
    """Yield all references to labels in a file.

    References occur in accepted findings, deployed items and profiler stops.
    """

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
    """Return the labels of the pieces in each row, without labels inside assemblies.

    The pieces of a row with a count have numbered labels.
    """
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
    """Update the references to labels after an edit; also return messages on the updates.

    `moved` maps the old positions of the remaining rows to the new positions.
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
    messages = []
    for each in names:
        matched = set(check_limits.matching(each.text, known))
        wanted = {renamed[label] for label in matched if label in renamed}
        if not matched or (set(check_limits.matching(each.text, all_now)) >= wanted and wanted):
            continue
        text = _new_reference(each.text, wanted, renamed, all_now)
        try:
            if text is None:
                raise LookupError
            after = after.put_at(each.location, text)
        except (CalmError, LookupError):
            messages.append(f"{each.where} still refers to `{each.text}`, which no longer exists")
        else:
            messages.append(f"{each.where} now refers to {text}")
    return after, list(dict.fromkeys(messages))


def _new_reference(
    text: str, wanted: set[str], renamed: Mapping[str, str], labels: Iterable[str]
) -> str | None:
    """Return a new text for a reference to renamed pieces.

    The new text must match all labels in `wanted` and no others. If no such text is found, the
    result is None.
    """
    labels = list(labels)
    if text in renamed:
        return renamed[text]
    for label, now in renamed.items():
        base, its = label.rstrip("0123456789 "), now.rstrip("0123456789 ")
        tried = text.replace(base, its)
        if base != its and wanted and set(check_limits.matching(tried, labels)) == wanted:
            return tried
    return None


def references_to(draft: Draft, place: Place) -> list[Named]:
    """Return the references to the label of a row with a single piece.

    If the row is copied, these references may be extended to the copy.
    """
    return [each for each in named_in(draft) if labels_of(draft).get(place) == [each.text]]


def with_extended_acceptances(draft: Draft, named: Iterable[Named]) -> Draft:
    """Extend the acceptances of findings on single pieces to copies of these pieces.

    For example, the label ``glass`` becomes the pattern ``glass *``.
    """
    for each in named:
        if each.location[0] == "checks" and not each.text.endswith("*"):
            draft = draft.put_at(each.location, f"{each.text} *")
    return draft


class EnvironmentChoice:
    """Environment chosen for a line: the default, a named environment, or an environment file.

    `environment` is a name or a file; None for the default.
    """

    def __init__(self, history: History, environment: str | None) -> None:
        self._history, self._environment = history, environment
        self._is_file = environment not in self.environments and os.path.isfile(environment or "")

    @property
    def environments(self) -> list[str | None]:
        """Environments of the file, beginning with None for the default environment."""
        named = self._history.draft.value(("environments",))
        return [None, *(named if isinstance(named, dict) else ())]

    @property
    def environment(self) -> str | None:
        """Chosen environment, or None (the default) if the file no longer has that environment."""
        return None if self.lost_environment else self._environment

    @environment.setter
    def environment(self, name: str | None) -> None:
        self._environment, self._is_file = name, False

    @property
    def lost_environment(self) -> str | None:
        """Chosen environment if a readable file no longer has this environment, otherwise None."""
        here = self._environment
        is_there = self._is_file or self._history.draft.problems or here in self.environments
        return None if is_there else here

    @property
    def next_environment(self) -> str | None:
        """Environment after the current environment; the default follows the last environment."""
        names, here = self.environments, self.environment
        return names[(names.index(here) + 1) % len(names)] if here in names else None
