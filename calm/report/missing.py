"""What the components of a catalogue lack, in words and as objects."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

from calm.quantities import QUANTITIES

if TYPE_CHECKING:
    from calm.checks.catalogue import CatalogueFinding
    from calm.checks.missing import MissingFigures


def in_words(missing: MissingFigures) -> str:
    """What a component lacks, what was searched for in vain last."""
    sought = [_heading(name) for name in missing.figures if name in missing.searched]
    open_yet = [_heading(name) for name in missing.figures if name not in missing.searched]
    parts = [f"gives no {', '.join(open_yet)}"] if open_yet else []
    parts += [f"searched for and not found: {', '.join(sought)}"] if sought else []
    return "; ".join(parts)


def summarised(missing: Sequence[MissingFigures]) -> str:
    """How many components lack which figure."""
    counts = Counter(name for each in missing for name in each.figures)
    figures = ", ".join(f"{_heading(name)} {count}" for name, count in counts.most_common())
    return f"{len(missing)} of them lack figures: {figures}"


def to_objects(
    findings: Sequence[CatalogueFinding], missing: Sequence[MissingFigures]
) -> list[dict[str, Any]]:
    """Findings, then what is missing: `id`, `finding`, `message`, `missing` and `searched`."""
    wrong = [
        {"id": each.id, "finding": True, "message": each.message, "missing": [], "searched": []}
        for each in findings
    ]
    lacking = [
        {
            "id": each.id,
            "finding": False,
            "message": in_words(each),
            "missing": list(each.figures),
            "searched": list(each.searched),
        }
        for each in missing
    ]
    return wrong + lacking


def _heading(name: str) -> str:
    return QUANTITIES[name].heading if name in QUANTITIES else name
