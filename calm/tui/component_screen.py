"""Form for a component defined in the file.

Each key press checks the typed value and the whole component.
"""

from collections.abc import Collection
from typing import Any

from textual import events, on
from textual.app import ComposeResult
from textual.containers import Horizontal, Vertical, VerticalScroll
from textual.widgets import Static

from calm.files.catalogue import defined, tidy_id
from calm.files.components import KINDS
from calm.files.definition import Definition
from calm.tui import dialogs, key_table
from calm.tui.checking import Check, Reading
from calm.tui.field import Cycle, Field, all_settled
from calm.tui.forms import FormField, filled, form_of, values_of
from calm.tui.screen import KeyBar, TitleBar

Defined = tuple[str, dict[str, str]]
"""Component id, and form texts by key."""


class ComponentScreen(dialogs.Form[Defined]):
    """Screen to define or change a component.

    The screen returns the id and the values of the component, or None if the user cancels.

    Parameters
    ----------
    listed : ids in the catalogue
    own : ids of components in the file; a new component cannot have one of these ids
    begun : id and all keys of the component to change; None for a new component
    """

    BINDINGS = key_table.bindings("form")
    HORIZONTAL_BREAKPOINTS = [(0, "-narrow"), (112, "-wide")]  # noqa: RUF012
    DEFAULT_CSS = """
    ComponentScreen {
        & #fields { width: 3fr; padding: 1 1 0 1; scrollbar-size-vertical: 1; }
        & #kind-fields { height: auto; }
        & .above { text-style: bold; text-wrap: nowrap; text-overflow: ellipsis; }
        & #outcome { width: 2fr; padding: 1 1 0 1; border-left: vkey $panel; }
        & Field > Input { margin-left: 20; }
    }
    ComponentScreen.-narrow #outcome { width: 28; }
    ComponentScreen.-narrow Field > Input { width: 16; }
    """

    def __init__(
        self,
        listed: Collection[str] = (),
        own: Collection[str] = (),
        begun: tuple[str, dict[str, Any]] | None = None,
    ) -> None:
        super().__init__()
        self._listed, self._own = frozenset(listed), frozenset(own)
        self._component, self._begun = begun or ("", {})
        self._kind = self._begun.get("kind", "cylinder")
        self._values = dict(self._begun)

    def compose(self) -> ComposeResult:
        yield TitleBar()
        with Horizontal():
            with VerticalScroll(id="fields", can_focus=False):
                if not self._begun:
                    form_field = FormField(
                        "id",
                        "id",
                        "",
                        id_check(self._own),
                        "e.g. sphere-own-1250",
                        "lower-case letters, digits and hyphens",
                    )
                    yield Field(form_field, id="id")
                    yield Cycle("kind", tuple(KINDS), self._kind, title_width=20)
                yield Vertical(id="kind-fields")
            with VerticalScroll(id="outcome", can_focus=False):
                yield Static(id="outcome-text")
        yield KeyBar()

    async def on_mount(self) -> None:
        what = f"{self._component}, a {self._kind}" if self._begun else "A component of your own"
        self.query_one(TitleBar).show(f"{what}, defined in this file   * required", "")
        self.query_one(KeyBar).show_keys(key_table.hints("form"))
        await self._show_fields()
        self.fields[0].input.focus()

    async def _show_fields(self) -> None:
        holder = self.query_one("#kind-fields", Vertical)
        await holder.remove_children()
        await holder.mount(*self.parts_of(filled(form_fields(self._kind), self._values)))
        self._show_outcome()

    @on(Cycle.Turned)
    async def _turn(self, event: Cycle.Turned) -> None:
        self._values |= values_of(self.texts)  # values are kept for the next kind
        self._kind = event.word
        await self._show_fields()

    def _given(self) -> Defined:
        texts = self.texts
        id = texts.pop("id", self._component)
        return id, texts if self._begun else {"kind": self._kind, **texts}

    def _full_definition(self) -> tuple[str, dict[str, Any]]:
        id, texts = self._given()
        shown = {key.partition(".")[0] for key in texts}
        others = {key: value for key, value in self._begun.items() if key not in shown}
        return id, others | values_of(texts)

    def tell(self, text: str, *, wrong: bool = False) -> None:
        """Show a message in the last line until the next key."""
        self.query_one(KeyBar).tell(text, wrong=wrong)

    @on(Field.Judged)
    @on(events.DescendantFocus)
    def _show_outcome(self) -> None:
        from rich.console import Group, RenderableType
        from rich.text import Text

        from calm.report import component_cards, terminal

        id, values = self._full_definition()
        component, problems = defined(id or "component", values)
        here = next((each.form_field for each in self.fields if each.input.has_focus), None)
        parts: list[RenderableType] = [Text(f"{here.takes}\n", "dim")] if here else []
        if id in self._listed - self._own:
            note = f"~ {id} exists in the catalogue; this definition overrides it in this file"
            parts.append(Text(note, "yellow"))
        for problem in problems:
            parts.append(Text(f"! {problem.message}", style="red"))
        if id in self._own:
            parts.append(Text(f"! {id} is defined in this file already", style="red"))
        elif component is not None:
            parts.append(Text("✓ The component is valid.", style="green"))
        if component is not None:
            parts.append(terminal.shown(component_cards.to_card(id or "component", component)))
        self.query_one("#outcome-text", Static).update(Group(*parts))

    def action_take(self) -> None:
        if not all_settled(self.all_parts):
            return
        component, problems = defined(*self._full_definition())
        if component is None:
            message = problems[0].message if problems else "Required fields are missing"
            self.tell(message, wrong=True)
        else:
            self.dismiss(self._given())


_FIRST = ("name", "manufacturer", "role")


def form_fields(kind: str) -> list[FormField]:
    """Return the form fields for a kind of component.

    The order is: fields for names, required keys, other keys of the kind, keys common to all kinds.
    """
    fields = [each for each in form_of(KINDS[kind]) if each.key != "kind"]

    def rank(each: FormField) -> tuple[int, ...]:
        is_common = each.key.partition(".")[0] in Definition.model_fields
        first = _FIRST.index(each.key) if each.key in _FIRST else len(_FIRST)
        return first, not each.is_needed or is_common, is_common

    return sorted(fields, key=rank)


def id_check(own: Collection[str]) -> Check:
    """Return a check for the id of a new component, which must not be among the ids `own`."""

    def check(text: str) -> Reading:
        tidy = text.strip()
        if not tidy:
            return Reading("", "an id is needed")
        if tidy_id(tidy) != tidy:
            return Reading(tidy, "lower-case letters, digits and hyphens", tidy_id(tidy) or None)
        if tidy in own:
            return Reading(tidy, "is defined in this file already")
        return Reading(tidy)

    return check
