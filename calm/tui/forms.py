"""Forms of the file: what is asked for the keys of a model, and how their values are typed.

A value that is no plain text is typed as YAML in brackets, `[98 m, 104 m]`; a list of rows is a
table, whose text is that YAML, too.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial
from types import NoneType, UnionType
from typing import Any, Literal, Union, get_args, get_origin

from pydantic import BaseModel

from calm.files.definition import ColumnHeading, QuantityField, quantity_of
from calm.files.editing import Draft, Value, inline, read_inline
from calm.files.yaml_document import Location, complaint
from calm.tui.checking import Check, Reading, anything, one_of, quantity

Rows = tuple[tuple[str, ...], ...]

_EXAMPLE = re.compile(r",? ?e\.g\. [^;]+;? ?")


@dataclass(frozen=True)
class FormColumn:
    """A column of a table: the key of the mapping that a row is, none where a row is a list."""

    key: str
    heading: str
    check: Check = anything


@dataclass(frozen=True)
class Asked:
    """A text that is asked for.

    Attributes
    ----------
    key : what it is known by; of a form of the file its place there, `position.latitude`
    takes : stands beside it
    above : begins a group with it
    columns : of a table, whose rows are in the text
    is_needed : whether its model cannot do without
    """

    key: str
    title: str
    text: str = ""
    check: Check = anything
    placeholder: str = ""
    takes: str = ""
    above: str = ""
    columns: tuple[FormColumn, ...] = ()
    is_needed: bool = False


def form_of(model: type[BaseModel], at: str = "", *, needed: bool = True) -> list[Asked]:
    """What is asked for the keys of a model: those it needs first, then those of models in it.

    Parameters
    ----------
    at : what leads to its keys in the file, `deployed.`
    needed : whether the model has to be there; the keys that it requires may be blank where not
    """
    model.model_rebuild()  # which finds what was named before it was defined
    own: list[Asked] = []
    inner: list[Asked] = []
    for name, field in model.model_fields.items():
        inside = model_in(field.annotation)
        if inside is None:
            own.append(_asked(model, name, at, needed=needed))
        else:
            first, *rest = form_of(inside, f"{at}{name}.", needed=needed and field.is_required())
            inner += [replace(first, above=first.above or name.replace("_", " ")), *rest]
    return [*sorted(own, key=lambda each: not each.is_needed), *inner]


def model_in(annotation: Any) -> type[BaseModel] | None:
    """The model that holds what is under a key; None where it is of another form, or of several."""
    members = _members(annotation)
    return members[0] if len(members) == 1 and _is_model(members[0]) else None


def _asked(model: type[BaseModel], name: str, at: str, *, needed: bool) -> Asked:
    field = model.model_fields[name]
    members, is_needed = _members(field.annotation), field.is_required()
    found, words = quantity_of(field), _words(members)
    check: Check = partial(_judged, model, name, is_needed and needed)
    if found is not None:
        optional = not (is_needed and needed)
        check = quantity(found, optional=optional, usual_unit=found.usual_unit)
    elif words:
        check = one_of(words)
    elif members == (float,):
        check = anything  # what it is depends on another key; all of them are judged together
    example = text_of(_as_texts(field.examples[0])) if field.examples else ""
    takes = _EXAMPLE.sub("", field.description or "")  # which stands in the field
    return Asked(
        f"{at}{name}",
        name.replace("_", " ") + " *" * (is_needed and needed),
        check=check,
        placeholder=f"e.g. {example}" if example else "",
        takes=f"{' | '.join(words)}: {takes}" if words else takes,
        columns=_columns(members),
        is_needed=is_needed,
    )


def _judged(model: type[BaseModel], name: str, needed: bool, text: str) -> Reading:
    """Read a text as the model does, which allows or refuses its value."""
    tidy = " ".join(text.split())
    if not tidy:
        return Reading("", "a value is needed" if needed else "")
    return Reading(tidy, complaint(model, name, value_of(tidy)))


def _columns(members: tuple[Any, ...]) -> tuple[FormColumn, ...]:
    """The columns of a list of models, or of rows of as many values each; none of another value."""
    if len(members) != 1 or get_origin(members[0]) is not tuple:
        return ()
    row = get_args(members[0])[0]
    if model := model_in(row):
        return tuple(FormColumn(each.key, each.title, each.check) for each in form_of(model))
    if get_origin(row) is not tuple or ... in get_args(row):
        return ()
    columns = []
    for number, value in enumerate(get_args(row), 1):
        _, *notes = get_args(value) or (value,)
        heading = next((str(one) for one in notes if isinstance(one, ColumnHeading)), str(number))
        found = next((one for one in notes if isinstance(one, QuantityField)), None)
        check = anything if found is None else quantity(found, usual_unit=found.usual_unit)
        columns.append(FormColumn("", heading, check))
    return tuple(columns)


def _members(annotation: Any) -> tuple[Any, ...]:
    """The types of a union but None, without annotations."""
    if get_origin(annotation) in (Union, UnionType):
        return tuple(member for each in get_args(annotation) for member in _members(each))
    if hasattr(annotation, "__metadata__"):
        return _members(get_args(annotation)[0])
    return () if annotation is NoneType else (annotation,)


def _is_model(member: Any) -> bool:
    return isinstance(member, type) and issubclass(member, BaseModel)


def _words(members: tuple[Any, ...]) -> tuple[str, ...]:
    """The words that a field may be, where it is one of some words and nothing else."""
    if members == (bool,):
        return "true", "false"
    if all(get_origin(each) is Literal for each in members):
        return tuple(word for each in members for word in get_args(each))
    return ()


def _as_texts(value: Any) -> Value:
    """An example as the file has it."""
    if isinstance(value, dict):
        return {key: _as_texts(each) for key, each in value.items()}
    if isinstance(value, list | tuple):
        return [_as_texts(each) for each in value]
    if isinstance(value, bool):
        return str(value).lower()
    return f"{value:g}" if isinstance(value, float) else str(value)


# the values of the file as they are typed


def text_of(value: Value | None) -> str:
    """A value as it is typed: what is no text in the brackets of YAML."""
    return value or "" if isinstance(value, str | None) else inline(value)


def value_of(text: str) -> Value | None:
    """The value that is typed; None where nothing is."""
    value = read_inline(text) if text[:1] in ("[", "{") else text
    return None if value in ("", [], {}) else value


def rows_of(text: str, columns: Sequence[FormColumn]) -> Rows | None:
    """The rows of a table; None of a value that has others, which only the text can show."""
    return rows_in(value_of(text), columns)


def rows_in(value: Value | None, columns: Sequence[FormColumn]) -> Rows | None:
    """The same of a value of the file; what a row lacks is blank."""
    keys = {column.key for column in columns}
    rows = []
    for row in value if isinstance(value, list) else [] if value is None else [value]:
        if isinstance(row, Mapping) and "" not in keys and row.keys() <= keys:
            rows.append(tuple(text_of(row.get(column.key)) for column in columns))
        elif isinstance(row, list) and keys == {""} and len(row) <= len(columns):
            rows.append((*map(text_of, row), *[""] * (len(columns) - len(row))))
        else:
            return None
    return tuple(rows)


def text_of_rows(rows: Iterable[Sequence[str]], columns: Sequence[FormColumn]) -> str:
    """The text of a table, without the rows that say nothing."""
    return text_of([_row(row, columns) for row in rows if any(row)])


def _row(row: Sequence[str], columns: Sequence[FormColumn]) -> Value:
    cells = [(column.key, value_of(text)) for column, text in zip(columns, row, strict=True)]
    if columns[0].key:
        return {key: value for key, value in cells if value is not None}
    return [value for _, value in cells]


def filled(asked: Iterable[Asked], values: Any) -> list[Asked]:
    """The same with the texts that are in their places among values of the file."""

    def at(key: str) -> Any:
        found = values
        for step in key.split("."):
            found = found.get(step) if isinstance(found, dict) else None
        return found

    return [replace(each, text=text_of(at(each.key))) for each in asked]


def values_of(texts: Mapping[str, str]) -> dict[str, Any]:
    """The values of a form by key, those of models in mappings; what is blank is left out."""
    values: dict[str, Any] = {}
    for place, text in texts.items():
        *outer, key = place.split(".")
        value, inside = value_of(text), values
        for step in outer if value is not None else ():
            inside = inside.setdefault(step, {})
        if value is not None:
            inside[key] = value
    return values


def written(draft: Draft, texts: Mapping[str, str], below: Location = ()) -> Draft:
    """The file with the texts of a form in their places; a blank one takes its key away."""
    for key, text in texts.items():
        place = (*below, *key.split("."))
        old, new = draft.value(place), value_of(text)
        if text == text_of(old):
            continue
        if isinstance(old, list) and isinstance(new, list):
            draft = draft.put_rows(place, new)
        else:
            draft = draft.put_at(place, new)
    return draft
