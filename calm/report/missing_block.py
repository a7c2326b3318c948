"""YAML block with the missing values that rules need, to be completed by the user."""

import json
import re
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from textwrap import wrap

from calm.checks.assess import RULES
from calm.checks.finding import Finding, MissingFigure, State, grouped_by
from calm.checks.inventory import InventoryItem
from calm.checks.missing import alternatives
from calm.files.components import KINDS
from calm.files.yaml_document import read_document
from calm.report.check_tables import named

_HEAD = """\
# Values that calm check needs and the components lack. Write each value with its unit after its
# colon; a key without a value stays unknown. calm build FILE, key f, asks for the same values.
"""
_OPTIONAL = """\
# Optional values: no check requires them. To set one, uncomment its key and its component
# below `components:`. A published value replaces the estimate.
"""
_WIDTH = 100

Places = Mapping[str, Sequence[str]]
"""Places in mooring files by component id, such as ``line 12 of m.yaml``. The key "" refers to
`components:` itself.
"""


def definition_places(paths: Iterable[Path]) -> Places:
    """Return the places in mooring files where components are defined, by component id.

    A place is a text such as "line 12 of a.yaml". Raise InputError if a file cannot be read.
    """
    found: dict[str, list[str]] = {}
    for path in paths:
        document = read_document(path)
        own = document.data.get("components")
        if not isinstance(own, dict):
            continue
        for id in ("", *own):
            location = ("components", id) if id else ("components",)
            line = document.problem(location, "", key=True).line
            found.setdefault(id, []).append(f"line {line} of {path.name}")
    return found


def missing_block(
    findings: Iterable[Finding], places: Places, inventory: Iterable[InventoryItem] = ()
) -> str:
    """Create the `components:` section of a mooring file, with the missing keys of each component.

    Comments explain each key; optional keys are comments, too. If a file already has a section
    `components:`, the block has no heading and is pasted into that section. The text has only
    comments if no missing value is found, for example without an equilibrium.

    The optional keys include the mass in air of any item in the `inventory` whose mass is unknown.
    """
    found = list(findings)
    figures = [one.missing for one in found if one.missing is not None]
    if not figures and any(one.rule == "equilibrium" for one in found):
        return (
            "# The mooring has no equilibrium, so the values that its check lacks are not known.\n"
        )
    optional = _optional_values(found, [*inventory])
    if not figures:
        return f"# All values that the checks need are known.\n{optional}"
    ids = grouped_by(figures, lambda one: one.component_id)
    lines = [f"#\n# {text}" for text in _instructions(ids, places)]
    lines += [] if "" in places else ["components:"]
    for id, of_component in ids.items():
        labels = named(label for one in of_component for label in one.pieces)
        own = f"defined in {' and '.join(places[id])}" if id in places else ""
        comment = "; ".join(filter(None, (labels if labels != id else "", own)))
        lines.append(f"  {_as_key(id)}:{f'  # {comment}' if comment else ''}")
        for same in grouped_by(of_component, lambda one: one.quantity).values():
            lines += _key_lines(same)
    return _HEAD + "\n".join(lines) + f"\n{optional}"


def _optional_values(findings: Sequence[Finding], inventory: Sequence[InventoryItem]) -> str:
    """List optional keys as comments; "" if there are none.

    Optional keys are:

    - published values that replace estimates
    - values for rules that are not judged because a value is unknown
    - masses in air
    """
    use = {one.label: one.use for one in inventory}
    figures = [one.missing for one in findings if one.missing is not None]
    missing = {(one.component_id, one.quantity) for one in figures}
    found: list[tuple[str, str, str, str]] = []
    for one in findings:
        label = one.component or ""
        id = use.get(label, label)
        if one.state is State.ESTIMATED:
            found += [
                (id, each.quantity, f"estimated: {each.bounds_text}", label)
                for each in one.estimates
            ]
        elif one.state is State.NOT_JUDGED and one.lacks is not None:
            title = RULES[one.rule].title.lower()
            found.append((id, one.lacks.quantity, f"without it, {title} is not judged", label))
    weighed = (one for one in inventory if one.role != "anchor")
    found += [
        (one.use, "mass", "in air; the total mass is a lower bound without it", one.label)
        for one in weighed
        if one.dry_mass is None
    ]
    found = [one for one in found if one[:2] not in missing]
    if not found:
        return ""
    lines = []
    for id, of_component in grouped_by(found, lambda one: one[0]).items():
        labels = named(dict.fromkeys(label for *_, label in of_component))
        lines.append(f"#   {_as_key(id)}:{f'  # {labels}' if labels != id else ''}")
        reasons = {key: reason for _, key, reason, _ in of_component}
        lines += [f"#     {key}:  # {reason}" for key, reason in reasons.items()]
    return f"#\n{_OPTIONAL}" + "\n".join(lines) + "\n"


def _as_key(id: str) -> str:
    return id if re.fullmatch(r"[A-Za-z][\w.-]*", id) else json.dumps(id, ensure_ascii=False)


def _instructions(ids: Iterable[str], places: Places) -> list[str]:
    defined = {id in places for id in ids}
    below = " and ".join(places.get("", ()))
    advice = ["If the file defines a component, copy the keys below into its definition."] * (
        True in defined
    )
    if False in defined:
        advice.append(
            f"Copy {'the other' if True in defined else 'these'} entries into the section "
            f"`components:`, {below}."
            if below
            else "Add this section to the mooring file. It completes components of the catalogue."
        )
    return advice


def _key_lines(same: Sequence[MissingFigure]) -> list[str]:
    first = same[0]
    field = KINDS[first.kind].model_fields[first.quantity]
    meaning = (field.description or "").partition(", e.g.")[0]
    instead = "".join(f", or `{key}`" for key in alternatives(first.quantity)[1:])
    rules = dict.fromkeys(RULES[rule].title.lower() for one in same for rule in one.needed_by)
    example = next(iter(field.examples or ()), "")
    lines = [f"    {first.quantity}:  # e.g. {example}: {meaning}{instead}"]
    notes = [f"needed for {', '.join(rules)}"]
    notes += dict.fromkeys(str(one.class_estimate) for one in same if one.class_estimate)
    for text in notes:
        lines += wrap(text, _WIDTH, initial_indent="      # ", subsequent_indent="      #   ")
    return lines
