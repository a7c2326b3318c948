"""Forms for sections of a mooring file, created from the keys of pydantic models.

A structured value is typed as YAML in brackets, such as `[98 m, 104 m]`. A list of rows is edited
as a table, whose text is also YAML.
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
    """Column of a table in a form.

    `key` is the key of the column in each row, or "" if the rows are lists.
    """

    key: str
    heading: str
    check: Check = anything


@dataclass(frozen=True)
class FormField:
    """Description of a text field in a form.

    Attributes
    ----------
    key : name of the field, or path of the edited key of the file, such as `position.latitude`
    takes : description shown next to the field
    above : heading of a group that begins with this field
    columns : for a table, its columns; `text` then contains the rows
    is_needed : whether the model requires this key
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


def form_of(model: type[BaseModel], at: str = "", *, needed: bool = True) -> list[FormField]:
    """Create the form fields of a pydantic model, with required keys first and nested models last.

    `at` is the path of the model in the file, such as `deployed.`. Unless the model is `needed`,
    required keys may be blank.
    """
    model.model_rebuild()  # resolves forward references
    own: list[FormField] = []
    inner: list[FormField] = []
    for name, field in model.model_fields.items():
        inside = model_in(field.annotation)
        if inside is None:
            own.append(_form_field(model, name, at, needed=needed))
        else:
            first, *rest = form_of(inside, f"{at}{name}.", needed=needed and field.is_required())
            inner += [replace(first, above=first.above or name.replace("_", " ")), *rest]
    return [*sorted(own, key=lambda each: not each.is_needed), *inner]


def model_in(annotation: Any) -> type[BaseModel] | None:
    """Return the pydantic model in a type annotation.

    Return None if there is no model, or if the annotation allows several types.
    """
    members = _types_in(annotation)
    return members[0] if len(members) == 1 and _is_model(members[0]) else None


def _form_field(model: type[BaseModel], name: str, at: str, *, needed: bool) -> FormField:
    field = model.model_fields[name]
    members, is_needed = _types_in(field.annotation), field.is_required()
    found, words = quantity_of(field), _allowed_words(members)
    check: Check = partial(_reading_of, model, name, is_needed and needed)
    if found is not None:
        optional = not (is_needed and needed)
        check = quantity(found, optional=optional, usual_unit=found.usual_unit)
    elif words:
        check = one_of(words)
    elif members == (float,):
        check = anything  # its meaning depends on another key; all keys are checked together
    example = text_of(_as_texts(field.examples[0])) if field.examples else ""
    takes = _EXAMPLE.sub("", field.description or "")  # the example is the placeholder of the field
    return FormField(
        f"{at}{name}",
        name.replace("_", " ") + " *" * (is_needed and needed),
        check=check,
        placeholder=f"e.g. {example}" if example else "",
        takes=f"{' | '.join(words)}: {takes}" if words else takes,
        columns=_columns(members),
        is_needed=is_needed,
    )


def _reading_of(model: type[BaseModel], name: str, needed: bool, text: str) -> Reading:
    tidy = " ".join(text.split())
    if not tidy:
        return Reading("", "a value is needed" if needed else "")
    return Reading(tidy, complaint(model, name, value_of(tidy)))


def _columns(members: tuple[Any, ...]) -> tuple[FormColumn, ...]:
    """Return the table columns for a list of models or for a list of fixed-length rows.

    For any other type, the result is empty.
    """
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


def _types_in(annotation: Any) -> tuple[Any, ...]:
    if get_origin(annotation) in (Union, UnionType):
        return tuple(member for each in get_args(annotation) for member in _types_in(each))
    if hasattr(annotation, "__metadata__"):
        return _types_in(get_args(annotation)[0])
    return () if annotation is NoneType else (annotation,)


def _is_model(member: Any) -> bool:
    return isinstance(member, type) and issubclass(member, BaseModel)


def _allowed_words(members: tuple[Any, ...]) -> tuple[str, ...]:
    if members == (bool,):
        return "true", "false"
    if all(get_origin(each) is Literal for each in members):
        return tuple(word for each in members for word in get_args(each))
    return ()


def _as_texts(value: Any) -> Value:
    if isinstance(value, dict):
        return {key: _as_texts(each) for key, each in value.items()}
    if isinstance(value, list | tuple):
        return [_as_texts(each) for each in value]
    if isinstance(value, bool):
        return str(value).lower()
    return f"{value:g}" if isinstance(value, float) else str(value)


# the values of the file as they are typed


def text_of(value: Value | None) -> str:
    """Convert a value to the text that the user would type.

    A string stays unchanged; any other value becomes inline YAML.
    """
    return value or "" if isinstance(value, str | None) else inline(value)


def value_of(text: str) -> Value | None:
    """Parse a typed value, or return None for an empty text."""
    value = read_inline(text) if text[:1] in ("[", "{") else text
    return None if value in ("", [], {}) else value


def rows_of(text: str, columns: Sequence[FormColumn]) -> Rows | None:
    """Parse a text into table rows; return None if the text does not fit the columns."""
    return rows_in(value_of(text), columns)


def rows_in(value: Value | None, columns: Sequence[FormColumn]) -> Rows | None:
    """Convert a table in the file to rows of text, with blanks for missing cells.

    Return None if the value does not fit the columns.
    """
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
    """Convert table rows to text; empty rows are omitted."""
    return text_of([_row(row, columns) for row in rows if any(row)])


def _row(row: Sequence[str], columns: Sequence[FormColumn]) -> Value:
    cells = [(column.key, value_of(text)) for column, text in zip(columns, row, strict=True)]
    if columns[0].key:
        return {key: value for key, value in cells if value is not None}
    return [value for _, value in cells]


def filled(fields: Iterable[FormField], values: Any) -> list[FormField]:
    """Return copies of form fields, filled with the values of the file as texts."""

    def at(key: str) -> Any:
        found = values
        for step in key.split("."):
            found = found.get(step) if isinstance(found, dict) else None
        return found

    return [replace(each, text=text_of(at(each.key))) for each in fields]


def values_of(texts: Mapping[str, str]) -> dict[str, Any]:
    """Return the values entered in a form, nested as in the model; blank values are omitted."""
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
    """Write the texts of a form to a draft, and return the new draft.

    A key is deleted if its text is blank.
    """
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
