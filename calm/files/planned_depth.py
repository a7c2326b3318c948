"""Planned depth of a piece or a clamp, found in its label.

A label gives a depth if it contains exactly one number in one of these forms:

- followed by a unit of length (``CTD400m``, ``buoy 650 ft``);
- after ``@`` (``SBE37 @ 1500m``);
- four digits at the end, after a hyphen or an underscore, that begin with 0 or are a multiple of 50
  (``CTD_0400``, ``CTD_1500``).

The following numbers are not depths:

- a serial number, such as any number after ``SN``, ``serial`` or ``#``;
- the depth rating of the component, unless it follows ``@``;
- four digits that do not begin with 0 after a model with digits (``SBE37_1700``);
- any number in a label with words such as cable, length, range, ``rated`` or ``above``;
- a range (``50-1000 m``), a product (``3x100 m``), ``1 200 m`` or ``1.2e2 m``;
- a number below 10 m in the label of a float, which is a size.

Only labels of instruments, floats and clamped parts are searched, except those of profilers.
"""

from __future__ import annotations

import re

from calm.files.components import Component, Flexible
from calm.files.rigid import Profiler

_NUMBERED = re.compile(
    r"(?:\bs/?n|\bser(?:ial)?(?:\s*(?:no|nr|number))?|\bno|\bnr|\bnumber|\bid|#)[\s.:#=_-]*"
    r"[a-z]{0,3}\d[\w-]*",
    re.IGNORECASE,
)
_LENGTHS = re.compile(
    r"cable|wire|rope|chain|string|tether|pigtail|\blong\b|length|\brang(?:e|ing)|\brat(?:ed|ing)"
    r"|version|housing|above|below|\boff\b|\bm?a[sb]b?\b|\bmab|\bhab\b|diameter|\bdia\b|\bcell",
    re.IGNORECASE,
)
_RANGE = re.compile(r"(?<![A-Za-z0-9])[\d.]+\s*(?:m\s*)?(?:-|–|\.\.|to)\s*[\d.]+\s*(?:m|ft)\b")
_DOUBTFUL = re.compile(r"(?<![\w.])\d{1,3} \d{3}\s*(?:m|ft)\b|\d[eE]\d|\d\s*[x×*]\s*\d")
"""Pattern of a number that is written as two words, as a power of ten or as a product."""
_WITH_UNIT = re.compile(
    r"(@\s*)?(?<![\d.,])(\d{1,3}(?:,\d{3})+|\d+(?:\.\d+)?)\s*(m|met(?:er|re)s?|ft|feet)"
    r"(?![A-Za-z0-9²³^]|\s*/\s*(?:s|min|h)\b)"
)
_AFTER_AT = re.compile(r"(@\s*)(\d{1,3}(?:,\d{3})+|\d+(?:\.\d+)?)()(?![\w.,/])")
_AT_THE_END = re.compile(r"^(.*)[_-](\d{4})$")
_ROUND = 50
"""A four-digit number that does not begin with 0 is a depth only if it is a multiple of this value.

The unit is metres. Few serial numbers are multiples of this value.
"""
_FOOT = 0.3048
_LEAST_OF_A_FLOAT = 10.0


def depth_in_label(label: str, serial: str | None = None, rating: float | None = None) -> float:
    """Return the depth that a label contains [m]; NaN if it contains none.

    A number that equals `serial` or the depth `rating` [m] of the component is not a depth, unless
    the number follows ``@``.
    """
    text = _NUMBERED.sub("|", label)
    if any(pattern.search(text) for pattern in (_LENGTHS, _RANGE, _DOUBTFUL)):
        return float("nan")
    found = {
        (bool(at), float(digits.replace(",", "")) * (_FOOT if unit[:1] == "f" else 1.0), digits)
        for pattern in (_WITH_UNIT, _AFTER_AT)
        for at, digits, unit in pattern.findall(text)
    }
    if not found and (end := _AT_THE_END.match(text)):
        model, digits = end.groups()
        round_depth = int(digits) % _ROUND == 0 and not re.search(r"\d", model)
        if digits[0] == "0" or round_depth:
            found = {(False, float(digits), digits)}
    depths = {
        depth for at, depth, digits in found if at or not (digits == serial or depth == rating)
    }
    return depths.pop() if len(depths) == 1 else float("nan")


def named_depth(
    label: str, component: Component, serial: str | None, *, clamped: bool
) -> float | None:
    """Return the planned depth in the label of a piece or clamp [m], or None if it has none."""
    role = component.role
    measures = role in ("instrument", "float") or clamped
    if not measures or isinstance(component, Flexible | Profiler):
        return None
    depth = depth_in_label(label, serial, component.depth_rating)
    least = _LEAST_OF_A_FLOAT if role == "float" else 0.0
    return depth if depth >= least else None
