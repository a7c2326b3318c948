"""Which parts of a line a drawing names, and where the names stand so that none overlap."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from calm.case.columns import rows_down

if TYPE_CHECKING:
    from calm.case import Result, TowResult

NAMED_ROLES = ("float", "instrument", "release", "anchor")
"""The roles a drawing marks; what only joins them is left to the table."""


@dataclass(frozen=True)
class Named:
    """A marked point of the line: text, role, and position [m] east, north and down."""

    use: str
    text: str
    role: str
    x: float
    y: float
    depth: float


def named_parts(result: Result | TowResult) -> list[Named]:
    """The floats, instruments, releases and the anchor, clamped ones too, in file order."""
    parts = []
    for component, clamps in rows_down(result):
        x = (component.x_top + component.x_bottom) / 2
        y = (component.y_top + component.y_bottom) / 2
        depth = (component.depth_top + component.depth_bottom) / 2
        parts.append(Named(component.use, component.label, component.role, x, y, depth))
        parts += [
            Named(clamp.use, clamp.label, clamp.part.component.role, clamp.x, clamp.y, clamp.depth)
            for clamp in clamps
        ]
    return [part for part in parts if part.role in NAMED_ROLES]


def names(parts: list[Named], near: float) -> list[tuple[str, Named]]:
    """Texts to write, each with the part it points at.

    Neighbours of one component within `near` [m] of each other whose labels differ only by a
    number at the end are named together: ``glass 1–6``.
    """
    runs: list[list[Named]] = []
    for part in parts:
        last = runs[-1][-1] if runs else None
        if last and _is_next(last, part) and abs(part.depth - last.depth) <= near:
            runs[-1].append(part)
        else:
            runs.append([part])
    texts = []
    for run in runs:
        texts.append((together([part.text for part in run]), run[len(run) // 2]))
    return texts


def alike(label: str, other: str) -> bool:
    """Whether two labels differ only by a number at the end."""
    stems = [text.removesuffix(_number(text)) for text in (label, other)]
    return stems[0] == stems[1] and bool(_number(other))


def together(labels: list[str]) -> str:
    """One name for labels that are alike: ``glass 1–6``."""
    return labels[0] if len(labels) == 1 else f"{labels[0]}–{_number(labels[-1])}"


def spread(wanted: list[float], gap: float, start: float, end: float) -> list[float]:
    """Positions at least `gap` apart, in the given ascending order, as near as can be to `wanted`.

    The sum of the squared shifts is the least possible between `start` and `end`; where not all
    fit, they pass the end. Once each position is reduced by the gaps before it, they only have to
    ascend: what then descends is pooled at its mean (isotonic regression).
    """
    pools: list[tuple[float, int]] = []
    for index, position in enumerate(wanted):
        mean, count = position - index * gap, 1
        while pools and pools[-1][0] > mean:
            other, size = pools.pop()
            mean, count = (mean * count + other * size) / (count + size), count + size
        pools.append((mean, count))
    last = max(start, end - (len(wanted) - 1) * gap)
    reduced = [min(max(mean, start), last) for mean, count in pools for _ in range(count)]
    return [position + index * gap for index, position in enumerate(reduced)]


def _is_next(part: Named, other: Named) -> bool:
    """Whether two parts are the same component under the same label, numbers apart."""
    return part.use == other.use and alike(part.text, other.text)


def _number(label: str) -> str:
    """The digits at the end of a label."""
    return label[len(label.rstrip("0123456789")) :]
