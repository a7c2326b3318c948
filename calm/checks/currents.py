"""The currents a mooring is judged in: how strong they are, and whether they cover the line."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING

import numpy as np

from calm.checks.finding import State, Verdict, at_least, rule, verdict_on
from calm.files.environment import Environment
from calm.quantities import say
from calm.records.current_file import strongest_of
from calm.records.current_terms import left_out

if TYPE_CHECKING:
    from calm.case import Mooring

LEAST_CURRENT = 0.01
"""Speed below which a current counts as none [m/s]."""

USUAL_CURRENT = 0.2
"""What a wind of 7 m/s alone drives at the surface, 0.03 of it by DNV-RP-C205 [m/s]."""

SHARE_OF_ITS_RECORD = 0.9
"""Share of the strongest current of its own record below which a judged one is too weak."""

WEAK_BESIDE_OTHERS = 0.02
"""Share of the strongest current below which another was typed in another unit: 1/100 is cm/s."""


@rule("current")
def currents(moorings: Sequence[Mooring]) -> Iterator[tuple[Mooring, Verdict]]:
    """Judge the strongest current of all environments, and what each leaves out.

    Each verdict comes with the mooring in the environment that it is of.
    """
    speeds = [_strongest(mooring) for mooring in moorings]
    for mooring, speed in zip(moorings, speeds, strict=True):
        if 0.0 < speed < WEAK_BESIDE_OTHERS * max(speeds):
            message = (
                f"The current is {speed:.2g} m/s at its strongest, {say('speed', max(speeds))} in "
                "another environment: a hundredth is cm/s read as m/s."
            )
            yield mooring, verdict_on(None, State.WARN, message, "Look at its unit.", speed)
        if speed >= LEAST_CURRENT and (left := _left_out(mooring)):
            remedy = "Give the current at more levels, or say with a level at each end what it is."
            yield mooring, verdict_on(None, State.WARN, left, remedy, speed)
    strongest = max(range(len(speeds)), key=speeds.__getitem__)
    speed = speeds[strongest]
    for mooring, recorded in _records(moorings):
        if speed < SHARE_OF_ITS_RECORD * recorded:
            message = (
                f"The record that this current is of has {say('speed', recorded)}; the strongest "
                f"current judged is {say('speed', speed)}."
            )
            remedy = "Add an environment with that current, or solve the record with `calm batch`."
            yield mooring, verdict_on(None, State.WARN, message, remedy, speed, recorded)
    if speed < LEAST_CURRENT:
        return
    message = f"The strongest current judged is {say('speed', speed)}"
    if speed < USUAL_CURRENT:
        message += f"; a wind of 7 m/s alone drives {say('speed', USUAL_CURRENT)} at the surface"
    remedy = "Add an environment with the strongest current of the site."
    yield (
        moorings[strongest],
        at_least(None, speed, USUAL_CURRENT, f"{message}.", remedy, State.WARN),
    )


def _records(moorings: Sequence[Mooring]) -> Iterator[tuple[Mooring, float]]:
    """Return the strongest current of each record that an environment is a time of [m/s]."""
    sources = {mooring.file.environment.current.record: mooring for mooring in moorings}
    for source, mooring in sources.items():
        if source is not None:
            yield mooring, strongest_of(*source)


def _strongest(mooring: Mooring) -> float:
    return float(np.hypot(mooring.water.u, mooring.water.v).max())


def _left_out(mooring: Mooring) -> str:
    """Return what of the depth a profile of the current says nothing of; "" of one that covers it.

    One speed at the surface is taken for a current that is the same everywhere.
    """
    environment: Environment = mooring.file.environment
    levels = environment.current.depth
    if levels == (0.0,):
        return ""
    left = left_out(levels[0], levels[-1], mooring.water.depth)
    return left and f"{left[0].upper()}{left[1:]}."
