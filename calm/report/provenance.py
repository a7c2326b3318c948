"""Where a report comes from: the versions that made it, its date, and a hash of its inputs."""

from __future__ import annotations

import hashlib
import json
import os
import platform
from collections.abc import Sequence
from datetime import UTC, datetime
from importlib.metadata import version
from pathlib import Path
from typing import Any

from pydantic import BaseModel

from calm.errors import InputError, UsageError
from calm.files import MooringFile
from calm.whole_file import read_text

_LIBRARIES = ("numpy", "pydantic", "matplotlib", "jinja2", "typst")


def versions() -> tuple[tuple[str, str], ...]:
    """Name and version of CALM, of Python, and of the libraries that compute and draw."""
    from calm.version import __version__

    libraries = tuple((name, version(name)) for name in _LIBRARIES)
    return (("calm", __version__), ("python", platform.python_version()), *libraries)


_LATEST = 253_402_300_799  # the last second of the year 9999


def moment() -> datetime | None:
    """The time that SOURCE_DATE_EPOCH gives, in UTC; None without it: a report has no other date.

    Raises
    ------
    UsageError
        It is no number of seconds that a calendar has.
    """
    text = os.environ.get("SOURCE_DATE_EPOCH")
    if not text:
        return None
    if not text.isascii() or not text.isdigit() or int(text) > _LATEST:
        raise UsageError(f"SOURCE_DATE_EPOCH, `{text}`, is no number of seconds")
    return datetime.fromtimestamp(int(text), UTC)


def date() -> str | None:
    """The day of `moment`, such as 2026-11-21."""
    when = moment()
    return None if when is None else when.date().isoformat()


def source_text(file: MooringFile) -> str | None:
    """The mooring file as it stands; None where it can no longer be read."""
    try:
        return read_text(Path(file.path))
    except InputError:
        return None


def input_hash(files: Sequence[MooringFile]) -> str:
    """SHA-256 of the inputs, in hexadecimal digits.

    Parameters
    ----------
    files : one mooring or tow as read in each of its environments

    It covers the text of the mooring file, and as JSON with sorted keys the components with every
    figure of the catalogue, the settings, and each environment with its currents: what came from
    a file of currents, too. Where the files lie does not count.
    """
    digest = hashlib.sha256((source_text(files[0]) or "").encode("utf-8", "replace"))
    for file in files:
        resolved = [file.name, file.pieces, file.tow, file.environment, file.solver, file.checks]
        digest.update(canonical(resolved).encode("utf-8", "replace"))
    return digest.hexdigest()


def canonical(value: Any) -> str:
    """JSON with sorted keys and no blanks; models and records become objects."""
    return json.dumps(value, sort_keys=True, separators=(",", ":"), default=_members)


def _members(value: Any) -> dict[str, Any]:
    return value.model_dump() if isinstance(value, BaseModel) else vars(value)
