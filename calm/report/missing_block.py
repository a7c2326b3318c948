"""Missing values that rules need, as a block of YAML to complete."""

import json
import re
from collections.abc import Iterable, Sequence
from textwrap import wrap

from calm.checks.finding import Finding, MissingFigure
from calm.checks.missing import alternatives
from calm.report.check_tables import grouped, named

_HEAD = """\
# Values that calm check needs and the components lack. Write the known values after the colons. Put
# the keys of a component that the mooring file defines into that definition, and the other entries
# under `components:` of the file. A key without a value stays unknown.
"""
_WIDTH = 100


def missing_block(findings: Iterable[Finding]) -> str:
    """Create the `components:` section of a mooring file with the missing keys of each component
    id.

    Comments name the pieces and the rules that need a value, and its class estimate if there is
    one. If nothing is missing, or nothing can be checked, the text is a comment only.
    """
    found = list(findings)
    figures = [one.missing for one in found if one.missing is not None]
    if not figures and any(one.rule == "equilibrium" for one in found):
        return "# The mooring has no equilibrium, so its missing values are unknown.\n"
    if not figures:
        return "# No component lacks a value.\n"
    lines = ["components:"]
    for of_component in grouped(figures, lambda one: one.component_id):
        labels = named(label for one in of_component for label in one.pieces)
        id = of_component[0].component_id
        plain = id if re.fullmatch(r"[A-Za-z][\w.-]*", id) else json.dumps(id, ensure_ascii=False)
        lines.append(f"  {plain}:  # {labels}")
        for same in grouped(of_component, lambda one: one.quantity):
            lines += _key(same)
    return _HEAD + "\n".join(lines) + "\n"


def _key(same: Sequence[MissingFigure]) -> list[str]:
    """Lines of a key that one or several moorings lack."""
    first = same[0]
    rules = dict.fromkeys(rule for one in same for rule in one.needed_by)
    told = f"needed by {', '.join(rules)}"
    if instead := alternatives(first.quantity)[1:]:
        told = f"or {', '.join(instead)}; {told}"
    lines = [f"    {first.quantity}:  # {told}"]
    estimates = dict.fromkeys(str(one.class_estimate) for one in same if one.class_estimate)
    for text in estimates:
        lines += wrap(text, _WIDTH, initial_indent="    # ", subsequent_indent="    #   ")
    return lines
