"""The seven quantities of a cable in a uniform current, and which may be asked for."""

from __future__ import annotations

import math
from collections.abc import Mapping

from calm.errors import UsageError

ANGLES = ("phi_a", "phi_b")
SIZES = ("tension_a", "tension_b", "height", "distance", "length")
GIVENS = (*ANGLES, *SIZES)


def check(known: Mapping[str, float], weight: float) -> None:
    """Refuse what is no question at all."""
    if len(known) != 3:
        names = ", ".join(known) or "none"
        raise UsageError(f"three of {', '.join(GIVENS)} are needed; given: {names}")
    if not math.isfinite(weight) or weight == 0.0:
        raise UsageError(f"the weight is {weight:g} N/m; it must be a number other than 0")
    for name, value in known.items():
        if not math.isfinite(value):
            raise UsageError(f"{name} is not a finite number")
        if name in ("height", "length") and value <= 0.0:
            raise UsageError(f"{name} is {value:g} m; it must be positive")
        if name.startswith("tension") and value < 0.0:
            raise UsageError(f"{name} is {value:g} N; it must not be negative")
    for name in known.keys() & set(ANGLES):
        least = -math.pi if (name == "phi_a") == (weight > 0.0) else 0.0
        if not least <= known[name] <= math.pi:
            raise UsageError(
                f"{name} is {math.degrees(known[name]):.6g}°; "
                f"it must be from {math.degrees(least):g}° to 180°"
            )


def mirrored(values: Mapping[str, float]) -> dict[str, float]:
    """The same cable upside down: a floating one becomes a sinking one and the other way round."""
    swapped = {"a": "b", "b": "a"}
    mirrored = {}
    for name, value in values.items():
        stem, _, end = name.rpartition("_")
        if stem == "phi":
            turned = math.pi - value
            mirrored[f"phi_{swapped[end]}"] = turned - 2 * math.pi if turned > math.pi else turned
        elif stem == "tension":
            mirrored[f"tension_{swapped[end]}"] = value
        else:
            mirrored[name] = -value if name == "distance" else value
    return mirrored
