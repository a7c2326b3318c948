"""What is filled in for several rows at once: a column of them, or the figures that are missing."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING

from textual.events import Paste

from calm.checks.finding import State
from calm.files import Place
from calm.files.editing import Draft
from calm.files.mooring_file import parts_of
from calm.files.rule_texts import RULES
from calm.files.yaml_document import Location
from calm.tui.catalogue.component_screen import form_fields
from calm.tui.dialogs import InputSheet
from calm.tui.field import Asked
from calm.tui.line.mooring_sheet import (
    RELEASES,
    entered,
    said,
)
from calm.tui.line.rows import LineCell
from calm.tui.session import location
from calm.tui.workspace import Workspace

if TYPE_CHECKING:
    from calm.tui.live import View


_TITLES = {"serial": "Serial numbers", "length": "Lengths", "label": "Labels", "codes": "Codes"}


class ColumnSheet(InputSheet):
    """A field for each row; a list that is pasted fills them downwards."""

    def on_paste(self, event: Paste) -> None:
        """Fill the fields from the one that is edited on."""
        lines = [line.split("\t")[0].strip() for line in event.text.splitlines()]
        fields = self.fields
        first = next((i for i, field in enumerate(fields) if field.input.has_focus), 0)
        if len(lines) < 2:
            return
        event.stop()
        for each, text in zip(fields[first:], lines, strict=False):
            each.input.value = text
        last = min(first + len(lines), len(fields)) - 1
        fields[last].input.focus()
        if len(lines) > len(fields) - first:
            self.app.bell()


class ColumnFilling:
    """A column of some rows: what it has now, and what is entered."""

    def __init__(self, workspace: Workspace, spots: Sequence[Place], column: str) -> None:
        self._session, self._column = workspace.session, column
        held = "serial" if column == "codes" else column  # by which codes are known
        self._cells = {str(i): LineCell(workspace, spot, held) for i, spot in enumerate(spots)}
        self._asked = [each for key in self._cells if (each := self._ask(key)) is not None]

    @property
    def sheet(self) -> ColumnSheet | None:
        """Where it is entered; None where none of the rows has such a value."""
        return ColumnSheet(_TITLES[self._column], "", self._asked) if self._asked else None

    def write(self, texts: Mapping[str, str]) -> None:
        """Write what is another now, in one step."""
        begun, draft = {each.key: each.text for each in self._asked}, self._session.draft
        new = {self._cells[key]: text for key, text in texts.items() if text != begun[key]}
        label = f"fill in {_TITLES[self._column].lower()}"
        if self._column == "codes":
            for cell, text in new.items():
                draft = entered(draft, RELEASES, ("serial", cell.text), {"codes": text})
            self._session.do(draft, label)
        else:
            rows = {cell.spot: cell.values_of(text) for cell, text in new.items()}
            self._session.put(rows, label)

    def _ask(self, key: str) -> Asked | None:
        cell = self._cells[key]
        values = self._session.item(cell.spot).values
        title = values.get("label") or values.get("use", "")
        if self._column != "codes":
            return None if cell.refused else Asked(key, title, cell.text, cell.check)
        if cell.listed is None or cell.listed.role != "release" or not cell.text:
            return None
        codes = said(self._session.draft, RELEASES, ("serial", cell.text), "codes")
        return Asked(key, title, codes)


_MOST_LABELS = 4
_ELSEWHERE = "part of an assembly of the catalogue: use its parts, or define it in the file (o)"
_SOURCE = "data sheet, test certificate …"


def figures_sheet(missing: Sequence[Missing]) -> InputSheet:
    """Ask for all figures of each component, and for their source; any may stay empty."""
    asked: list[Asked] = []
    elsewhere = [f"{each.called}: {_ELSEWHERE}" for each in missing if not each.fields]
    for each in missing:
        for number, figure in enumerate(each.fields):
            above = "" if number else each.called
            key, title = f"{each.use}.{figure.key}", figure.key.replace("_", " ")
            asked.append(replace(figure, key=key, title=title, above=above))
    asked.append(Asked("source", "source", takes=_SOURCE, above="Of the figures"))
    count = len(missing)
    title = f"Figures missing of {count} component{'s' * (count != 1)}; any may stay empty"
    return InputSheet(title, "\n".join(elsewhere), asked)


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
    def fields(self) -> list[Asked]:
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
    own = draft.value(("components",)) or ()
    found: dict[str, Missing] = {}
    for part in parts_of(view.file.pieces):
        if part.place not in wanted:
            continue
        missing = found.setdefault(part.use, Missing(part.use, part.component.kind))
        missing.labels[part.label] = None
        for key in wanted[part.place]:
            targets = missing.targets.setdefault(key, {})
            if part.use in own:
                targets["components", part.use] = None
            elif part.place.part < 0:
                targets[location(part.place)] = None
    return list(found.values())


def filled(
    draft: Draft, missing: Iterable[Missing], texts: Mapping[str, str], source: str
) -> Draft:
    """The draft with figures filled in.

    Parameters
    ----------
    texts : by ``component.key``; what is empty stays unknown
    source : of all of them; may be empty

    Raises
    ------
    EditError
        The file does not allow it.
    """
    for each in missing:
        for key, targets in each.targets.items():
            text = texts.get(f"{each.use}.{key}", "")
            for target in targets if text else ():
                draft = draft.put_at((*target, key), text)
                if source:
                    draft = draft.put_at((*target, "sources", key), source)
    return draft
