"""Complete input of a batch result as JSON, and a hash of this input and the measured values."""

import hashlib
import json
from collections.abc import Iterable, Mapping
from dataclasses import fields, is_dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray
from pydantic import BaseModel

from calm.case import Design
from calm.dataset.netcdf import Attributes
from calm.version import __version__

RESOLVED, HASH = "input_resolved", "input_sha256"
"""Names of two attributes of a result file: the input as JSON, and the SHA-256 hash of input and
measurements.
"""

_NO_MATTER = frozenset(
    {"path", "line", "column", "checks", "notices", "variants", "description", "current"}
    | {"doubts", "named"}
    | {"sources", "searched", "prefer", "waves", "seas"}
)
"""Keys of a mooring file that do not affect batch results; `current` is included because profiles
replace it.
"""


class InputHash:
    """SHA-256 hash of an input, computed from its text and then from the measured values."""

    def __init__(self, text: str) -> None:
        self._digest = hashlib.sha256(text.encode("utf-8", "surrogateescape"))

    def add(self, arrays: Iterable[NDArray[Any] | None]) -> None:
        """Add measured values to the hash."""
        for array in arrays:
            if array is not None:
                self._digest.update(str(array.shape).encode())
                self._digest.update(array.tobytes())

    def attributes(self) -> dict[str, str]:
        """Return the hash as an attribute of a result file."""
        return {HASH: self._digest.hexdigest()}


def resolved_input(
    mooring: Design, time: NDArray[np.datetime64], options: Mapping[str, Any]
) -> str:
    """Return the complete input of a result as JSON, including catalogue components and defaults.

    Parameters
    ----------
    time : (n,) times of the record
    options : command options that affect the results
    """
    first, last = (str(one.astype("datetime64[s]")) for one in (time[0], time[-1]))
    known = {
        "calm": __version__,
        "mooring": _json_data(mooring.file),
        "record": {"profiles": len(time), "from": first, "to": last},
        **options,
    }
    return json.dumps(known, sort_keys=True, separators=(",", ":"), ensure_ascii=False)


def with_input(text: str) -> Attributes:
    """Return the result attributes for the input `text`, with a placeholder for the hash.

    The placeholder is as long as the hash. The hash replaces the placeholder after the measured
    values are read.
    """
    return {RESOLVED: text, **InputHash(text).attributes()}


def _json_data(value: Any) -> Any:
    if isinstance(value, BaseModel):
        return _known({name: getattr(value, name) for name in type(value).model_fields})
    if is_dataclass(value):
        return _known({each.name: getattr(value, each.name) for each in fields(value)})
    if isinstance(value, tuple | list):
        return [_json_data(member) for member in value]
    return value


def _known(members: Mapping[str, Any]) -> dict[str, Any]:
    return {
        name: _json_data(member)
        for name, member in members.items()
        if member is not None and name not in _NO_MATTER
    }
