"""Which environment a mooring stands in: the file's own, or another laid over it."""

from __future__ import annotations

import os.path
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from calm.errors import InputError, Problem
from calm.files.environment import read_environment
from calm.files.fields import Model, Text
from calm.files.mistakes import validate
from calm.files.yaml_document import SourceMapping, read_document
from calm.suggestions import unknown


class EnvironmentFileKeys(Model):
    """The keys at the top level of an environment file."""

    name: Text | None = None
    environment: dict[str, Any]


def choose_environment(
    top: SourceMapping, chosen: str | Path | None, problems: list[Problem], *, towed: bool
) -> tuple[SourceMapping, str | None] | None:
    """Return the `environment` of a file, or the chosen one laid over it, and its name; unread.

    Variants that are not chosen, and the own environment where another one is, are checked here,
    so that mistakes are reported where they are. None where there is no environment.

    Parameters
    ----------
    top : the mooring file
    chosen : a variant named in the file, or an environment file; None for the file's own
    towed : a tow may be without an environment: in deep, still sea water
    """
    own = top.child("environment") if _is_mapping(top, "environment") else None
    if own is None:
        if "environment" in top.data:
            return None
        if chosen is None and not towed:
            message = "`environment` is missing"
            problems.append(top.problem((), message, lacks="no environment"))
            return None
        own = SourceMapping.of(top.document, (), {})
    variants = top.child("environments") if _is_mapping(top, "environments") else None
    overlays = dict(_mappings(variants)) if variants else {}
    for overlay in overlays.values():
        _check(overlay, problems, towed)
    if chosen is None:
        return own, None
    _check(own, problems, towed)
    if isinstance(chosen, str) and chosen in overlays:
        return overlays[chosen].over(own), chosen
    if isinstance(chosen, str) and not _is_file_name(chosen):
        message = unknown(f"no environment is called `{chosen}`", chosen, overlays)
        problems.append(top.problem(("environments",), message, key=True))
        return None
    return _from_file(Path(chosen), own, problems)


def _from_file(
    path: Path, own: SourceMapping, problems: list[Problem]
) -> tuple[SourceMapping, str | None] | None:
    try:
        document = read_document(path)
    except InputError as error:
        problems.extend(error.problems)
        return None
    file = SourceMapping.of(document, (), document.data)
    keys = validate(EnvironmentFileKeys, file, problems)
    if keys is None:
        return None
    return file.child("environment").over(own), keys.name or path.stem


def _check(section: SourceMapping, problems: list[Problem], towed: bool) -> None:
    """Look for mistakes in keys that may stand over, or under, others: on any depth."""
    section = section.over(SourceMapping.of(section.document, (), {"depth": "1 m"}))
    read_environment(section, None, problems, [], open_files=False, towed=towed)


def _mappings(section: SourceMapping) -> Iterator[tuple[str, SourceMapping]]:
    for key in section.data:
        if _is_mapping(section, key):
            yield key, section.child(key)


def _is_mapping(section: SourceMapping, key: str) -> bool:
    return isinstance(section.data.get(key), dict)


def _is_file_name(text: str) -> bool:
    return os.path.isfile(text) or os.sep in text or text.endswith((".yaml", ".yml"))
