"""All figures that the design check does not know: asked for, and written in the file."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field

from calm.case.parts import parts_of
from calm.checks.finding import State
from calm.files import Place
from calm.files.editing import Draft
from calm.files.rule_texts import RULES
from calm.files.yaml_document import Location
from calm.tui.catalogue.component_screen import FormField, form_fields
from calm.tui.dialogs import Asked, InputSheet, ask
from calm.tui.line.line_pane import LinePane
from calm.tui.line.table import location
from calm.tui.live import View

_MOST_LABELS = 4
_ELSEWHERE = "part of an assembly of the catalogue: use its parts, or define it in the file (o)"
_SOURCE = "data sheet, test certificate …"


class Filling:
    """Asks for all that is missing, and writes what was given."""

    def __init__(self, line: LinePane) -> None:
        self._line, self._workspace = line, line.workspace

    def ask(self) -> None:
        """Show the form, once the line is judged."""
        workspace, session = self._workspace, self._workspace.session
        if not self._line.settle():
            return
        if workspace.view is None or not workspace.is_fresh:
            workspace.tell("Missing figures are known once the line is judged")
            return
        missing = missing_figures(workspace.view, session.draft)
        if not missing:
            workspace.tell("No figure of a component is missing")
            return

        def take(texts: dict[str, str]) -> None:
            source = texts.pop("source", "")
            figures = {_keys(asked): text for asked, text in texts.items() if text}
            if figures:
                count = len(figures)
                self._line.attempt(
                    lambda: session.do(
                        filled(session.draft, missing, figures, source), "fill in figures"
                    ),
                    f"{count} figure{'s' * (count != 1)} filled in",
                )

        ask(self._line.app, figures_sheet(missing), take)


def figures_sheet(missing: Sequence[Missing]) -> InputSheet:
    """Ask for all figures of each component, and for their source; any may stay empty."""
    asked: list[Asked] = []
    elsewhere = [f"{each.called}: {_ELSEWHERE}" for each in missing if not each.fields]
    for each in missing:
        for number, figure in enumerate(each.fields):
            above = "" if number else each.called
            key, title = f"{each.use}.{figure.key}", figure.key.replace("_", " ")
            asked.append(Asked(key, title, "", figure.check, takes=figure.takes, above=above))
    asked.append(Asked("source", "source", takes=_SOURCE, above="Of the figures"))
    count = len(missing)
    title = f"Figures missing of {count} component{'s' * (count != 1)}; any may stay empty"
    return InputSheet(title, "\n".join(elsewhere), asked)


def _keys(asked: str) -> tuple[str, str]:
    """Component and key of what is asked for."""
    use, _, key = asked.rpartition(".")
    return use, key


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
    def called(self) -> str:
        """Return the component, with the labels of the first rows that lack a figure."""
        labels = ", ".join(list(self.labels)[:_MOST_LABELS])
        more = len(self.labels) - _MOST_LABELS
        labels += f" and {more} more" if more > 0 else ""
        return self.use if labels == self.use else f"{self.use}: {labels}"

    @property
    def fields(self) -> list[FormField]:
        """Return what would do and can be filled in, as the form of a component has it."""
        return [each for each in form_fields(self.kind) if self.targets.get(each.key)]


def missing_figures(view: View, draft: Draft) -> list[Missing]:
    """Return what the unknown findings of a line ask for, down the line."""
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
                targets[location(part.place)] = None
    return list(found.values())


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
