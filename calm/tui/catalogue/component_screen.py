"""A component of one's own: a form that judges each figure as it is typed, and all of them."""

from __future__ import annotations

import re
from collections.abc import Sequence
from typing import ClassVar

from textual import on
from textual.app import ComposeResult
from textual.binding import BindingType
from textual.containers import Horizontal, Vertical, VerticalScroll
from textual.screen import Screen
from textual.widgets import Static

from calm.files.components import KINDS
from calm.tui.actions import bindings, hints
from calm.tui.bars import KeyBar, TitleBar
from calm.tui.catalogue.component_form import defined, form_fields
from calm.tui.checking import Check, Reading
from calm.tui.cycle import Cycle
from calm.tui.field import Field

Defined = tuple[str, dict[str, str]]

_ID = re.compile(r"[a-z0-9]+(-[a-z0-9]+)*")
_WORDS = re.compile(r"[^a-z0-9]+")


class ComponentScreen(Screen[Defined | None]):
    """Gives the id and the values of a component; None where it is left.

    Parameters
    ----------
    listed : ids of the catalogue: a component of such an id hides the one there
    own : ids that the file defines already: no other is defined under them
    """

    BINDINGS: ClassVar[list[BindingType]] = [*bindings("form")]
    HORIZONTAL_BREAKPOINTS = [(0, "-narrow"), (112, "-wide")]  # noqa: RUF012
    DEFAULT_CSS = """
    ComponentScreen {
        & #fields { width: 3fr; padding: 1 1 0 1; scrollbar-size-vertical: 1; }
        & #kind-fields { height: auto; }
        & #outcome { width: 2fr; padding: 1 1 0 1; border-left: vkey $panel; }
        & Field > .field-title { width: 20; }
    }
    ComponentScreen.-narrow #outcome { width: 28; }
    ComponentScreen.-narrow Field > .field-title { width: 15; }
    ComponentScreen.-narrow Field > Input { width: 16; }
    """

    def __init__(self, listed: Sequence[str] = (), own: Sequence[str] = ()) -> None:
        super().__init__()
        self._listed, self._own = frozenset(listed), frozenset(own)
        self._values: dict[str, str] = {}
        self._kind = "cylinder"

    def compose(self) -> ComposeResult:
        """Title; the fields beside what they come to; keys."""
        yield TitleBar()
        with Horizontal():
            with VerticalScroll(id="fields", can_focus=False):
                yield Field("id", "id", self._check_id(), id="id", placeholder="sphere-own-1250")
                yield Cycle("kind", tuple(KINDS), self._kind, title_width=20)
                yield Vertical(id="kind-fields")
            with VerticalScroll(id="outcome", can_focus=False):
                yield Static(id="outcome-text")
        yield KeyBar()

    async def on_mount(self) -> None:
        """The fields of the first kind."""
        self.query_one(TitleBar).show("A component of one's own, kept in this file   * needed", "")
        self.query_one(KeyBar).show_keys(hints("form"))
        await self._show_fields()
        self.query_one("#id", Field).focus_input()

    def _check_id(self) -> Check:
        def check(text: str) -> Reading:
            tidy = text.strip()
            if not tidy:
                return Reading("", "an id is needed")
            if not _ID.fullmatch(tidy):
                offer = _WORDS.sub("-", tidy.casefold()).strip("-")
                return Reading(tidy, "small letters, figures and hyphens", offer or None)
            if tidy in self._own:
                return Reading(tidy, "is defined in this file already; change it in the text (t)")
            return Reading(tidy)

        return check

    async def _show_fields(self) -> None:
        holder = self.query_one("#kind-fields", Vertical)
        await holder.remove_children()
        fields = [
            Field(
                each.key,
                each.key.replace("_", " ") + (" *" if each.needed else ""),
                each.check,
                text=self._values.get(each.key, ""),
                note=each.takes,
            )
            for each in form_fields(self._kind)
        ]
        await holder.mount(*fields)
        self._judge()

    @on(Cycle.Turned)
    async def _turn(self, event: Cycle.Turned) -> None:
        self._kind = event.word
        await self._show_fields()

    @on(Field.Judged)
    def _typed(self, event: Field.Judged) -> None:
        if event.field.key != "id":
            self._values[event.field.key] = event.reading.text
        self._judge()

    @on(Field.Entered)
    def _onward(self) -> None:
        self.focus_next()

    def _fields(self) -> list[Field]:
        return list(self.query(Field))

    def _given(self) -> Defined:
        """The id and the values that have been typed."""
        texts = {field.key: field.text for field in self._fields()}
        id = texts.pop("id", "")
        return id, {"kind": self._kind} | {key: text for key, text in texts.items() if text}

    def _judge(self) -> None:
        """Say what the values come to."""
        from rich.console import Group, RenderableType
        from rich.text import Text

        from calm.report.catalogue import to_card
        from calm.report.terminal import shown

        id, values = self._given()
        component, problems = defined(id or "component", values)
        parts: list[RenderableType] = []
        if id in self._listed - self._own:
            parts.append(Text(f"~ {id} is in the catalogue; this one hides it here", "yellow"))
        for problem in problems:
            parts.append(Text(f"! {problem.message}", style="red"))
        if id in self._own:
            parts.append(Text(f"! {id} is defined in this file already", style="red"))
        elif component is not None:
            parts.append(Text("✓ It can be used.", style="green"))
        if component is not None:
            parts.append(shown(to_card(id or "component", component)))
        self.query_one("#outcome-text", Static).update(Group(*parts))

    def action_accept(self) -> None:
        """Give the component, if it is one."""
        wrong = [field for field in self._fields() if not field.settle()]
        if wrong:
            wrong[0].focus_input()
            return
        id, values = self._given()
        component, problems = defined(id, values)
        if component is None:
            message = problems[0].message if problems else "It is not complete"
            self.query_one(KeyBar).tell(message, wrong=True)
        else:
            self.dismiss((id, values))

    def action_cancel(self) -> None:
        """Give nothing."""
        self.dismiss(None)
