"""Entries of a list of the file that a form asks for, each known by one of its keys."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from calm.files.editing import Draft
from calm.files.yaml_document import Location


def said(draft: Draft, rows: Location, called: tuple[str, str], key: str) -> str:
    """What an entry says under a key, where that is a plain text; else empty.

    Parameters
    ----------
    rows : the list
    called : the key and the text that the entry is known by
    """
    index = _index(draft, rows, called)
    return "" if index is None else draft.text_at((*rows, index, key))


def entered(
    draft: Draft, rows: Location, called: tuple[str, str], texts: Mapping[str, str]
) -> Draft:
    """The file with the texts in an entry, which is added where it is not there.

    One in which nothing is left but what it is known by is taken out.
    """
    changed = {key: text for key, text in texts.items() if text != said(draft, rows, called, key)}
    index = _index(draft, rows, called)
    if index is None:
        given = dict([called]) | changed
        return draft.insert(len(draft.value(rows) or ()), given, rows) if changed else draft
    left = draft.value((*rows, index)).keys() - {key for key, text in changed.items() if not text}
    if changed and left <= {called[0]} and not any(changed.values()):
        return draft.delete([index], rows)
    for key, text in changed.items():
        draft = draft.put_at((*rows, index, key), text or None)
    return draft


def _index(draft: Draft, rows: Location, called: tuple[str, str]) -> int | None:
    listed: Any = draft.value(rows)
    key, name = called
    for index, entry in enumerate(listed if isinstance(listed, list) else ()):
        if isinstance(entry, dict) and entry.get(key) == name:
            return index
    return None
