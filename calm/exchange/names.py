"""Ids for components that other programs call by free text."""

from __future__ import annotations

import re
import unicodedata
from collections.abc import Iterable

from calm.exchange.design import Component

_LONGEST = 40
_SIGNS = {'"': "in ", "″": "in ", "↑": " up ", "↓": " down ", "+": " ", "&": " and ", "µ": "u"}


def kebab(name: str) -> str:
    """A name as an id: ``3/8" wire rope`` becomes ``3-8in-wire-rope``."""
    text = "".join(_SIGNS.get(sign, sign) for sign in name)
    text = unicodedata.normalize("NFKD", text).encode("ascii", "ignore").decode().lower()
    text = re.sub(r"(?<=\d)\.(?=\d)", "p", text)
    return re.sub(r"[^a-z0-9]+", "-", text)[:_LONGEST].strip("-")


def ids_of(components: Iterable[Component]) -> dict[int, str]:
    """The id of every component, by its `id()`: those that say the same thing share one."""
    components = list(components)
    ids: dict[int, str] = {}
    said: dict[tuple[object, ...], str] = {}
    taken = {component.entry for component in components}
    for component in components:
        if component.entry:
            ids[id(component)] = component.entry
            continue
        says = component.says()
        if says not in said:
            base = kebab(component.name) or component.kind
            chosen, number = base, 1
            while chosen in taken:
                number += 1
                chosen = f"{base}-v{number}"
            taken.add(chosen)
            said[says] = chosen
        ids[id(component)] = said[says]
    return ids
