"""A part of a line as a line of its own."""

from __future__ import annotations

from dataclasses import fields, replace
from itertools import compress
from typing import Any

import numpy as np

from calm.physics.line import Line


def part_of(line: Line, first: int, stop: int) -> Line:
    """The pieces from `first` up to, not including, `stop`, with their clamps."""
    index = np.arange(len(line.length))
    pieces = (first <= index) & (index < stop)
    clamps = pieces[line.clamp_piece]
    columns: dict[str, Any] = {}
    for field in fields(line):
        column, kept = getattr(line, field.name), pieces
        if field.name.startswith("clamp_"):
            kept = clamps
        if isinstance(column, np.ndarray):
            columns[field.name] = column[kept]
        elif isinstance(column, tuple):
            columns[field.name] = tuple(compress(column, kept))
    columns["clamp_piece"] = columns["clamp_piece"] - first
    return replace(line, **columns)
