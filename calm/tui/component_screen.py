"""A component of your own: a form that judges each figure as it is typed, and all of them."""

from collections.abc import Collection, Iterator
from dataclasses import replace
from types import UnionType
from typing import Any, Literal, Union, get_args, get_origin

from textual import on
from textual.app import ComposeResult
from textual.containers import Horizontal, Vertical, VerticalScroll
from textual.widgets import Static

from calm.files.catalogue import defined, tidy_id
from calm.files.components import KINDS
from calm.files.definition import QuantityField
from calm.tui import dialogs, key_table
from calm.tui.checking import Check, Reading, quantity
from calm.tui.field import Asked, Cycle, Field, all_settled
from calm.tui.screen import KeyBar, TitleBar
from calm.units import DIMENSIONS

Defined = tuple[str, dict[str, str]]


class ComponentScreen(dialogs.Form[Defined]):
    """Gives the id and the values of a component; None where it is left.

    Parameters
    ----------
    listed : ids of the catalogue: a component of such an id hides the one there
    own : ids that the file defines already: no other is defined under them
    begun : a component that is to be changed, with all that the file says of it
    """

    BINDINGS = key_table.bindings("form")
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
        self._values = {key: each for key, each in self._begun.items() if isinstance(each, str)}

    def compose(self) -> ComposeResult:
        """Title; the fields beside what they come to; keys."""
        yield TitleBar()
        with Horizontal():
            with VerticalScroll(id="fields", can_focus=False):
                if not self._begun:
                    asked = Asked("id", "id", "", id_check(self._own), "e.g. sphere-own-1250")
                    yield Field(asked, id="id")
                    yield Cycle("kind", tuple(KINDS), self._kind, title_width=20)
                yield Vertical(id="kind-fields")
            with VerticalScroll(id="outcome", can_focus=False):
                yield Static(id="outcome-text")
        yield KeyBar()

    async def on_mount(self) -> None:
        """The fields of the first kind."""
        what = f"{self._component}, a {self._kind}" if self._begun else "A component of your own"
        self.query_one(TitleBar).show(f"{what}, kept in this file   * needed", "")
        self.query_one(KeyBar).show_keys(key_table.hints("form"))
        await self._show_fields()
        self.fields[0].input.focus()

    async def _show_fields(self) -> None:
        holder = self.query_one("#kind-fields", Vertical)
        await holder.remove_children()
        begun, asked = self._values, form_fields(self._kind)
        await holder.mount(*(Field(replace(each, text=begun.get(each.key, ""))) for each in asked))
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

    def _given(self) -> Defined:
        """The id and the values that have been typed; empty what is to be taken away."""
        texts = {field.key: field.text for field in self.fields}
        id = texts.pop("id", self._component)
        if self._begun:
            return id, texts
        return id, {"kind": self._kind} | {key: text for key, text in texts.items() if text}

    def _all(self) -> tuple[str, dict[str, Any]]:
        """Return the same with what the form does not show."""
        id, values = self._given()
        whole = {**self._begun, **values}
        return id, {key: value for key, value in whole.items() if value != ""}

    def _judge(self) -> None:
        """Say what the values come to."""
        from rich.console import Group, RenderableType
        from rich.text import Text

        from calm.report import component_cards, terminal

        id, values = self._all()
        component, problems = defined(id or "component", values)
        parts: list[RenderableType] = []
        if id in self._listed - self._own:
            parts.append(Text(f"~ {id} is in the catalogue; this one replaces it here", "yellow"))
        for problem in problems:
            parts.append(Text(f"! {problem.message}", style="red"))
        if id in self._own:
            parts.append(Text(f"! {id} is defined in this file already", style="red"))
        elif component is not None:
            parts.append(Text("✓ It can be used.", style="green"))
        if component is not None:
            parts.append(terminal.shown(component_cards.to_card(id or "component", component)))
        self.query_one("#outcome-text", Static).update(Group(*parts))

    def action_take(self) -> None:
        """Give the component, if it is one."""
        if not all_settled(self.fields):
            return
        component, problems = defined(*self._all())
        if component is None:
            message = problems[0].message if problems else "It is not complete"
            self.query_one(KeyBar).tell(message, wrong=True)
        else:
            self.dismiss(self._given())


_FIRST = ("name", "manufacturer", "role")
_LAST = ("material", "part_number", "note", "source", "date")


def form_fields(kind: str) -> Iterator[Asked]:
    """The keys of a kind that hold one value; those that a component cannot do without first."""
    fields = KINDS[kind].model_fields
    known = [name for name in fields if name not in ("kind", *_FIRST, *_LAST)]
    known.sort(key=lambda name: not fields[name].is_required())
    for name in (*_FIRST, *known, *_LAST):
        needed, members = fields[name].is_required(), _members(fields[name].annotation)
        title = name.replace("_", " ") + " *" * needed
        metadata = fields[name].metadata
        found = next((each for each in metadata if isinstance(each, QuantityField)), None)
        words = _words(members)
        if found is not None:
            dimension = DIMENSIONS[found.dimension]
            takes = dimension.noun.removeprefix("a ").removeprefix("an ")
            takes += f" ({', '.join(list(dimension.units)[:5])})" if dimension.unit else ""
            check = quantity(found, optional=not needed, usual_unit=found.usual_unit)
            yield Asked(name, title, check=check, takes=takes)
        elif words:
            yield Asked(name, title, check=_one_of(words), takes=" | ".join(words))
        elif str in members:
            yield Asked(name, title)


def _members(annotation: Any) -> tuple[Any, ...]:
    """The types of a union, without annotations."""
    if get_origin(annotation) in (Union, UnionType):
        return tuple(member for each in get_args(annotation) for member in _members(each))
    if hasattr(annotation, "__metadata__"):
        return _members(get_args(annotation)[0])
    return (annotation,)


def _words(members: tuple[Any, ...]) -> tuple[str, ...]:
    """The words that a field may be, where it is one of some words and nothing else."""
    given = [each for each in members if each is not type(None)]
    if all(get_origin(each) is Literal for each in given):
        return tuple(word for each in given for word in get_args(each))
    return ()


def _one_of(words: tuple[str, ...]) -> Check:
    def check(text: str) -> Reading:
        tidy = text.strip()
        if not tidy or tidy in words:
            return Reading(tidy)
        near = [word for word in words if word.startswith(tidy.casefold())]
        return Reading(tidy, f"must be {' or '.join(words)}", near[0] if near else None)

    return check


def id_check(own: Collection[str]) -> Check:
    """Return whether a text can be an id; `own` are those that the file has already."""

    def check(text: str) -> Reading:
        tidy = text.strip()
        if not tidy:
            return Reading("", "an id is needed")
        if tidy_id(tidy) != tidy:
            return Reading(tidy, "small letters, figures and hyphens", tidy_id(tidy) or None)
        if tidy in own:
            return Reading(tidy, "is defined in this file already")
        return Reading(tidy)

    return check
