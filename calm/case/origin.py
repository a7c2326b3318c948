"""What a mooring, a tow or a net was read from, and the same with some of its values changed."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, Self, TypeVar

from calm.case.parts import parts_of
from calm.errors import UsageError, unknown
from calm.files import MooringFile, read_mooring
from calm.files.editing import LINE, Draft, clamps_of
from calm.files.yaml_document import Location
from calm.whole_file import read_text

T = TypeVar("T")


@dataclass(frozen=True)
class Origin:
    """Tell what a mooring was read from; the names are those of `load`."""

    path: str | Path
    environment: str | Path | None
    catalogs: tuple[Path, ...]
    text: str | None

    def read(self, *, net: bool = False) -> MooringFile:
        """Return the file with all it refers to, as `read_mooring` does."""
        return read_mooring(
            self.path,
            environment=self.environment,
            catalogs=self.catalogs,
            text=self.text,
            net=net,
        )

    def changed(
        self,
        file: MooringFile,
        label: str | None,
        environment: str | Path | None,
        keys: Mapping[str, Any],
    ) -> Origin:
        """Return the same with values put into the text, or in another environment.

        Parameters
        ----------
        file : as it was read
        label : of the piece or clamp that has the keys; None where they are those of the file
        environment : None for its own
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
        return replace(self, text=draft.text, environment=environment or self.environment)


def _place_of(file: MooringFile, label: str) -> Location:
    places = {part.label: part.place for part in parts_of(file.pieces)}
    if label not in places:
        raise UsageError(unknown(f"no piece or clamp is labelled `{label}`", label, places))
    place = places[label]
    if place.part >= 0 and not place.is_clamp:
        raise UsageError(f"`{label}` is a part of an assembly; change the assembly")
    return (*clamps_of(place.item), place.clamp) if place.is_clamp else (*LINE, place.item)


def as_read(kind: Callable[[MooringFile], T], file: MooringFile, origin: Origin) -> T:
    """Return what a file says, which knows what it was read from."""
    read = kind(file)
    vars(read)["origin"] = origin
    return read


class ReadFromFile:
    """A mooring, a tow or a net as read from its file."""

    file: MooringFile
    origin: Origin | None

    def with_(
        self, label: str | None = None, /, environment: str | Path | None = None, **keys: Any
    ) -> Self:
        """Return the same with some values of its file changed, as `Origin.changed`.

        Parameters
        ----------
        label : of the piece or clamp that has the keys; the keys are the file's where it is not
            given: ``mooring.with_("wire 1", length="480 m")``, ``tow.with_(tow={"speed": "4 kn"})``
        environment : name of one of its `environments`, or an environment file

        Raises
        ------
        InputError
            With the mistakes that the values make.
        UsageError
            No piece has the label, or it was not loaded from a file.
        """
        if self.origin is None:
            raise UsageError("what was not loaded from a file has no values to change")
        origin = self.origin.changed(self.file, label, environment, keys)
        file = origin.read(net=bool(self.file.legs))
        if (file.tow is None) != (self.file.tow is None):
            raise UsageError("a mooring does not become a tow, nor a tow a mooring")
        return as_read(type(self), file, origin)
