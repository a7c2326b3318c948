"""Which quality flags count as measured."""

from __future__ import annotations

from calm.errors import UsageError
from calm.records.cf_files import MISSING

GOOD = frozenset({1, 2})
"""Good and probably good: what is taken unless something else is asked for."""
INTERPOLATED = 8
"""Never a measurement."""


def parse_flags(text: str) -> frozenset[int]:
    """The flags of a text such as ``1,2``.

    Raises
    ------
    UsageError
        They are no flags, or 8 is among them: what was interpolated is no measurement.
    """
    try:
        flags = frozenset(int(part) for part in text.split(","))
    except ValueError:
        raise UsageError(f"--flags: `{text[:40]}` is not a list of flags; write 1,2") from None
    if INTERPOLATED in flags:
        raise UsageError("--flags: 8 marks what was interpolated, which is never a measurement")
    if not flags <= set(range(MISSING)):
        raise UsageError(f"--flags: `{text[:40]}`: flags are from 0 to 8")
    return flags
