"""A mooring or tow as it would be with some values of its file changed."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from calm.case.parts import parts_of
from calm.errors import UsageError
from calm.files import MooringFile, read_mooring
from calm.files.editing import Draft
from calm.files.editing.draft import LINE, clamps_of
from calm.files.yaml_document import Location
from calm.suggestions import unknown
from calm.whole_file import read_text


@dataclass(frozen=True)
class Origin:
    """Tell what a mooring was read from; the names are those of `load`."""

    path: str | Path
    environment: str | Path | None
    catalogs: tuple[Path, ...]
    text: str | None

    def read(self) -> MooringFile:
        """Return the file with all it refers to, as `read_mooring` does."""
        nearer = list(self.catalogs)
        return read_mooring(
            self.path, environment=self.environment, catalogs=nearer, text=self.text
        )

    def with_values(self, file: MooringFile, label: str | None, keys: Mapping[str, Any]) -> Origin:
        """Return the same with values put into the text.

        Parameters
        ----------
        file : as it was read
        label : of the piece or clamp that has the keys; None where they are those of the file
        keys : names and values as the file writes them; None takes a key out; where the file has a
            mapping under a name, its keys are changed one by one

        Raises
        ------
        UsageError
            No piece and no clamp has the label.
        """
        draft = Draft(read_text(Path(self.path)) if self.text is None else self.text)
        place: Location = () if label is None else _place_of(file, label)
        for name, value in keys.items():
            inner = value if isinstance(value, Mapping) and label is None else {None: value}
            for key, each in inner.items():
                where = (*place, name) if key is None else (*place, name, key)
                written = str(each) if isinstance(each, (int, float)) else each
                draft = draft.put_at(where, written)
        return replace(self, text=draft.text)


def _place_of(file: MooringFile, label: str) -> Location:
    places = {part.label: part.place for part in parts_of(file.pieces)}
    if label not in places:
        raise UsageError(unknown(f"no piece or clamp is labelled `{label}`", label, places))
    place = places[label]
    if place.part >= 0 and not place.is_clamp:
        raise UsageError(f"`{label}` is a part of an assembly; change the assembly")
    return (*clamps_of(place.item), place.clamp) if place.is_clamp else (*LINE, place.item)
