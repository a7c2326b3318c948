"""The figures that the design check asks for and that no file gives, and how they are filled in."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field

from calm.case.parts import parts_of
from calm.checks.finding import State
from calm.files import Place
from calm.files.editing import Draft, clamps_of
from calm.files.rule_texts import RULES
from calm.tui.catalogue.component_screen import FormField, form_fields
from calm.tui.live import View
from calm.files.yaml_document import Location


@dataclass
class Missing:
    """What is not known of a component, once for all rows that use it.

    Attributes
    ----------
    use, kind : of the component
    labels : of the pieces and clamps that it is missing of, as the keys of a dict
    targets : by key where in the file it is written: in the definition, where the file has it,
        else in every row that lacks it; nowhere where that stands in an assembly
    """

    use: str
    kind: str
    labels: dict[str, None] = field(default_factory=dict)
    targets: dict[str, dict[Location, None]] = field(default_factory=dict)

    @property
    def fields(self) -> list[FormField]:
        """What would do and can be filled in, as the form of a component has it."""
        return [each for each in form_fields(self.kind) if self.targets.get(each.key)]


def missing_figures(view: View, draft: Draft) -> list[Missing]:
    """What the unknown findings of a line ask for, down the line."""
    if view.file is None:
        return []
    wanted: dict[Place, dict[str, None]] = {}
    for finding in view.findings:
        if finding.state is State.UNKNOWN and finding.place and RULES[finding.rule].figures:
            asked = wanted.setdefault(finding.place, {})
            asked.update(dict.fromkeys(RULES[finding.rule].figures))
    own = draft.value(("components",))
    found: dict[str, Missing] = {}
    for part in parts_of(view.file.pieces):
        if part.place not in wanted:
            continue
        missing = found.setdefault(part.use, Missing(part.use, part.component.kind))
        missing.labels[part.label] = None
        for key in wanted[part.place]:
            targets = missing.targets.setdefault(key, {})
            if isinstance(own, dict) and part.use in own:
                targets["components", part.use] = None
            elif part.place.part < 0:
                targets[_row(part.place)] = None
    return list(found.values())


def _row(place: Place) -> Location:
    """Where a row of the line stands in the file."""
    if place.is_clamp:
        return (*clamps_of(place.item), place.clamp)
    return ("line", place.item)


def filled(
    draft: Draft, missing: Iterable[Missing], texts: Mapping[tuple[str, str], str], source: str
) -> Draft:
    """The draft with figures filled in.

    Parameters
    ----------
    texts : by component and key; what is empty stays unknown
    source : of all of them; may be empty

    Raises
    ------
    EditError
        The file does not allow it.
    """
    for each in missing:
        for key, targets in each.targets.items():
            text = texts.get((each.use, key), "")
            for target in targets if text else ():
                draft = draft.put_at((*target, key), text)
                if source:
                    draft = draft.put_at((*target, "sources", key), source)
    return draft
