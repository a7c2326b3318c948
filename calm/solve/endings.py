"""How the search for a shape can end, by number."""

from __future__ import annotations

(
    FOUND,
    # a march stopped: its value is why, see `calm.physics.state`
    MARCH_STOPPED,
    # no closed shape near a coarser one; one that misses its end, by its value [m]; one that hangs
    # on the last digits of the buoyancy in use
    NO_SHAPE_NEAR, MISSES, SLACK_ON_DIGITS,
    # without current, longer than the water is deep; floats that do not keep the line in the water
    SLACK_AT_REST, TOO_MANY_AFLOAT, RISES,
    # dragged down to the seabed; not lying there after all; nothing that holds it up
    DRAGGED_DOWN, NOT_LYING, UNSUPPORTED,
    # a piece below the seabed, or above the surface, by its value [m]
    BELOW_SEABED, ABOVE_SURFACE,
    # loads that do not sum up, an element out of balance: by its value, of the audit
    NOT_CLOSED, OUT_OF_BALANCE,
    # it folds in still water
    FOLDED,
) = range(16)  # fmt: skip
