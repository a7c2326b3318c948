"""What the angle of a bare towed cable gives for its vibration, as a table and as a document."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

from calm.checks.finding import State
from calm.physics.strumming import BourgetMarichal
from calm.report.blocks import Pairs, Part, Prose

if TYPE_CHECKING:
    from calm.case.strumming import BareCable


def bare_cable_document(cable: BareCable) -> dict[str, Any]:
    """The JSON object: what was given (SI, degrees), `cn`, `amplitude` a/D, `frequency`, `notes`.

    `frequency` is None where the cable does not vibrate.
    """
    cn, amplitude = cable.vibration
    return {
        **vars(cable),
        "cn": cn,
        "amplitude": amplitude,
        "frequency": cable.frequency if amplitude else None,
        "notes": list(_notes(cable)),
    }


def bare_cable_part(cable: BareCable) -> Part:
    """The answer, and what to keep in mind with it."""
    cn, amplitude = cable.vibration
    pairs = [
        ("weight in water", f"{cable.weight:.3f} N/m"),
        ("drag coefficient C*", f"{cn:.3f}"),
        ("amplitude a/D", f"{amplitude:.3f}"),
    ]
    if amplitude:
        pairs += [
            ("amplitude a", f"{1000.0 * amplitude * cable.diameter:.1f} mm"),
            ("frequency", f"{cable.frequency:.2f} Hz"),
        ]
    notes = tuple(_notes(cable))
    warned = (Prose(notes, State.WARN),) if notes else ()
    title = f"Bare cable at {cable.angle:g}° behind a ship at {cable.speed:.3g} m/s"
    return Part(title, (Pairs(tuple(pairs)), *warned))


def _notes(cable: BareCable) -> Iterator[str]:
    law = BourgetMarichal()
    cn, amplitude = cable.vibration
    least = math.degrees(law.LEAST_ANGLE)
    if cable.angle < least:
        yield (
            f"Below {least:.0f}° the coefficient of a cable at rest, C0 = {law.rest:g}, is not "
            "claimed: a/D needs a look."
        )
    if not amplitude:
        yield f"C* is not above C0 = {law.rest:g}, a cable at rest: it does not vibrate."
    if cn > law.ceiling:
        yield f"C* is above {law.ceiling:g}, the greatest of the method: look at what was measured."
