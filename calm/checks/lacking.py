"""What a line lacks that no mooring stands without, while it is built."""

from __future__ import annotations

from collections.abc import Iterator

from calm.files import MooringFile
from calm.files.reader import STAND_IN


def lacking(file: MooringFile) -> Iterator[str]:
    """What is still to come, in plain words; nothing of a tow.

    Parameters
    ----------
    file : read so that something stands in for a missing anchor
    """
    if file.tow is not None:
        return
    clamps = [clamp.component for piece in file.pieces for clamp in piece.clamps]
    parts = [*(piece.component for piece in file.pieces), *clamps]
    if not any(part.net_buoyancy > 0.0 for part in parts):
        yield "no float"
    if file.pieces[-1].use == STAND_IN:
        yield "no anchor"
