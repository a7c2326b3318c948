"""Choose mooring-file ids for parts named in other programs."""

import re
from collections.abc import Iterable

from calm.exchange.model import ImportedComponent
from calm.files.catalogue import tidy_id

_LONGEST = 40
_NO_IDS = {"null", "true", "false", "yes", "no", "on", "off", "y", "n"}  # other words in YAML
_SIGNS = {'"': "in ", "″": "in ", "↑": " up ", "↓": " down ", "+": " ", "&": " and ", "µ": "u"}


def _id_from_name(name: str) -> str:
    """Convert a name to an id: ``3/8" wire rope`` becomes ``3-8in-wire-rope``."""
    text = "".join(_SIGNS.get(sign, sign) for sign in name)
    return tidy_id(re.sub(r"(?<=\d)\.(?=\d)", "p", text))[:_LONGEST].strip("-")


def ids_of(components: Iterable[ImportedComponent], taken: Iterable[str] = ()) -> dict[int, str]:
    """Choose an id in the mooring file for each component.

    The result maps `id(component)` to the chosen id. Components with equal values share an id. Ids
    in `taken` are not used.
    """
    components = list(components)
    ids: dict[int, str] = {}
    known_ids: dict[tuple[object, ...], str] = {}
    known = {*taken, *(component.entry for component in components)}
    for component in components:
        if component.entry:
            ids[id(component)] = component.entry
            continue
        identity = component.identity()
        if identity not in known_ids:
            base = _id_from_name(component.name)
            if base in _NO_IDS or not any(sign.isalpha() for sign in base):
                base = f"{component.kind}-{base}".rstrip("-")
            chosen, number = base, 1
            while chosen in known:
                number += 1
                chosen = f"{base}-v{number}"
            known.add(chosen)
            known_ids[identity] = chosen
        ids[id(component)] = known_ids[identity]
    return ids
