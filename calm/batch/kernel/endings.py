"""How a case of the lanes ended, by number."""

from __future__ import annotations

(
    # found, or not yet refused
    SOLVED,
    # its profile: no level with a value, two of one depth, no current anywhere
    NO_DATA, LEVELS_COINCIDE, STILL,
    # the search: needs more than one float, no root, another root may be near, no convergence
    AT_SURFACE, LOST, TURNS_BACK, UNCLOSED,
    # the shape: above the surface, below the seabed, an element pushed, cuts that do not get fine
    # enough
    OUT_OF_WATER, ON_SEABED, COMPRESSED, TOO_COARSE,
    # its results are written; or it is a heap of what is meant to stand
    WRITTEN, HEAP,
    # against the seabed: sags below its lower end, does not lie there after all, not tried
    SAGS, LIFTED, NOT_TRIED,
) = range(17)  # fmt: skip
