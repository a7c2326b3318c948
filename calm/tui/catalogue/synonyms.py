"""Synonyms: each word of a group finds what has any other word of it."""

from __future__ import annotations

import re

_GROUPS = (
    ("twin", "double", "dual", "paired", "pair", "two", "tandem"),
    ("current meter", "rcm", "aquadopp", "s4", "argonaut", "dvs", "rcm4", "rcm5", "rcm8", "rcm11"),
    ("current profiler", "adcp", "rdcp", "workhorse", "doppler"),
    ("ctd", "microcat", "seacat", "sbe37", "sbe16", "sbe19", "conductivity"),
    ("thermistor", "temperature logger", "hobo", "tr", "sbe39", "sbe56"),
    ("thimble", "termination", "eye", "socket"),
    ("float", "flotation", "buoy", "buoyancy"),
    ("anchor", "sinker", "deadweight", "clump"),
    ("rope", "line", "hawser"),
    ("wire", "steel rope", "jacketed"),
    ("dyneema", "spectra", "hmpe", "amsteel"),
    ("kevlar", "aramid", "parafil"),
    ("polyester", "dacron"),
    ("nylon", "polyamide", "perlon"),
    ("ring", "link", "maillon"),
    ("glass", "benthos", "vitrovex"),
    ("release", "releaser"),
)
_FOUND = tuple(
    (re.compile(r"\b(" + "|".join(map(re.escape, group)) + r")s?\b"), " ".join(group))
    for group in _GROUPS
)


def with_synonyms(text: str) -> str:
    """A text in small letters, with the synonyms of its words added."""
    return " ".join([text, *(words for pattern, words in _FOUND if pattern.search(text))])
