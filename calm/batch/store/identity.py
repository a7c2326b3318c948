"""What a result is made from, so that it is never continued with something else."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Iterator, Mapping
from dataclasses import fields, is_dataclass
from threading import Event
from typing import TYPE_CHECKING, Any

from pydantic import BaseModel

from calm.batch.threads import go_on
from calm.case import Mooring
from calm.version import __version__

if TYPE_CHECKING:
    from calm.records.record import Record

MOST_TOLD = 5
"""So many differences are reported, and how many more there are."""

_NO_MATTER = frozenset(
    {"path", "line", "column", "checks", "notices", "variants", "description", "current"}
    | {"sources", "searched", "prefer"}
)
"""What of a mooring file changes no figure of its results: every profile has its own current."""


def identity_of(
    mooring: Mooring, record: Record, options: Mapping[str, Any], stop: Event
) -> dict[str, Any]:
    """All that the figures of a result follow from, as JSON has it.

    Raises
    ------
    calm.batch.threads.Stopped
        While the record is read through, which may take long.
    """
    ends = (record.time[0], record.time[-1])
    identity = {
        "calm": __version__,
        "mooring": _plain(mooring.file),
        "record": {
            "profiles": record.count,
            "from": str(ends[0].astype("datetime64[s]")),
            "to": str(ends[1].astype("datetime64[s]")),
            "sha256": record.digest(lambda: go_on(stop)),
        },
        "options": dict(options),
    }
    decoded: dict[str, Any] = json.loads(to_text(identity))
    return decoded


def to_text(identity: Mapping[str, Any]) -> str:
    """The JSON text of an identity: the same for the same."""
    return json.dumps(identity, sort_keys=True, separators=(",", ":"), ensure_ascii=False)


def sha256_of(text: str) -> str:
    """Return the SHA-256 of a text, in hexadecimal."""
    return hashlib.sha256(text.encode("utf-8", "surrogateescape")).hexdigest()


def differences(before: Any, now: Any) -> str:
    """Return what differs between two identities, in words."""
    found = list(_differing("", before, now))
    listed = "; ".join(found[:MOST_TOLD])
    return f"{listed}; and {len(found) - MOST_TOLD} more" if len(found) > MOST_TOLD else listed


def _differing(place: str, before: Any, now: Any) -> Iterator[str]:
    if isinstance(before, dict) and isinstance(now, dict):
        for key in sorted({*before, *now}):
            inner = f"{place}.{key}" if place else key
            yield from _differing(inner, before.get(key), now.get(key))
    elif isinstance(before, list) and isinstance(now, list) and len(before) == len(now):
        for index, pair in enumerate(zip(before, now, strict=True)):
            yield from _differing(f"{place}[{index}]", *pair)
    elif before != now:
        yield f"{place} was {_shown(before)}, is now {_shown(now)}"


def _shown(value: Any) -> str:
    if isinstance(value, list):
        return f"a list of {len(value)}"
    if isinstance(value, dict):
        return "something else" if len(value) > 1 else str(value)
    return "absent" if value is None else str(value)


def _plain(value: Any) -> Any:
    """A model as mappings, lists, text and numbers; without what is None or does not matter."""
    if isinstance(value, BaseModel):
        return _known({name: getattr(value, name) for name in type(value).model_fields})
    if is_dataclass(value):
        return _known({each.name: getattr(value, each.name) for each in fields(value)})
    if isinstance(value, tuple | list):
        return [_plain(member) for member in value]
    return value


def _known(members: Mapping[str, Any]) -> dict[str, Any]:
    return {
        name: _plain(member)
        for name, member in members.items()
        if member is not None and name not in _NO_MATTER
    }
