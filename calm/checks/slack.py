"""Whether the line stays taut."""

from __future__ import annotations

from collections.abc import Iterator
from functools import partial
from typing import TYPE_CHECKING

from calm.case.warnings import is_synthetic
from calm.checks.criterion import Criterion, Judged, criteria, pieces_of
from calm.checks.limits import Citing
from calm.files import Cable
from calm.quantities import say

if TYPE_CHECKING:
    from calm.case import Mooring, Result


@criteria("slack")
def slack(mooring: Mooring) -> Iterator[Criterion]:
    """The least tension in every wire and rope above the release; of the whole line without one.

    A line that falls slack wears, kinks and snatches. Mooring groups ask for some 500 to 1000 N
    above the release at slack water; no rule is published, so 500 N of wire and 300 N of rope are
    the defaults. A piece with ``slack: allowed`` is not judged, nor what lies on the seabed.
    """
    file, cite = mooring.file, Citing.of(mooring.file)
    lowest = len(file.pieces) - 1 if file.release is None else file.release
    for part in pieces_of(mooring)[:lowest]:
        if not isinstance(part.component, Cable) or part.component.slack == "allowed":
            continue
        name = "rope" if is_synthetic(part.component) else "wire"
        limit = getattr(file.checks.minimum_tension, name)
        words = partial(_words, part, limit, name)
        source = cite(f"minimum_tension.{name}")
        yield Criterion(part, "least_tension", limit, words, least=True, silent=True, source=source)


def _words(part: Judged, limit: float, name: str, least: float, _: Result) -> tuple[str, str]:
    return (
        f"{part.label} bears no more than {say('tension', least)} at its slackest; "
        f"{say('tension', limit)} keep a {name} taut.",
        "Add buoyancy above it, or take weight off; `slack: allowed` exempts a piece.",
    )
