"""Parse YAML files with the position of each value, and reject malicious files.

Scalars are kept as text, because the meaning of `1000` depends on the key. Anchors, aliases and
tags are rejected.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any, Literal, TypeVar, get_args, get_origin

from pydantic import BaseModel, ValidationError

from calm.errors import InputError, Problem, about_quantity, nearest, not_among, shown, unknown
from calm.files import composition
from calm.files.composition import Node
from calm.units import QuantityError
from calm.whole_file import read_text

Location = tuple[str | int, ...]


@dataclass(frozen=True)
class Document:
    """Plain data of a YAML file, and the nodes of its text.

    Attributes
    ----------
    path : path as shown in messages
    data : mappings, lists, text and None
    root : top-level node; None if the data were not read from a text
    """

    path: str
    data: dict[str, Any]
    root: Node | None = field(default=None, repr=False)

    def problem(
        self, location: Sequence[str | int], message: str, *, key: bool = False, lacks: str = ""
    ) -> Problem:
        """Create a problem at the position of a value.

        If the value is empty, the position of its key is used. If the location does not exist, the
        position of the nearest enclosing value is used.

        Parameters
        ----------
        key : whether to use the position of the key even if the value is not empty
        lacks : name of the part that is missing in an incomplete file; "" for a mistake
        """
        node = place = self.root
        for step in location:
            name, node = node.entry(step) if node else (None, None)
            if node is not None and (name or not key):
                place = name if key or node.data is None else node
                place = place or node
        line, column = (place.line, place.column) if place else (0, 0)
        return Problem(self.path, line, column, message, lacks)


def read_document(path: Path) -> Document:
    """Read a YAML file whose top level is a mapping.

    Raises
    ------
    InputError
        The file cannot be read, is not text or valid YAML, or has duplicate keys.
    """
    return compose(str(path), read_text(path))


def compose(name: str, text: str) -> Document:
    """Parse a YAML text into a document; `name` is the path that messages show.

    Raises
    ------
    InputError
        The text is not valid YAML, or has duplicate keys.
    """
    root, refusals = composition.compose(text.removeprefix("\ufeff"))
    if root is not None and root.kind != "mapping":
        message = "must hold `key: value` lines at its top level"
        raise InputError([Problem(name, 1, 1, message)])
    if refusals:
        raise InputError([Problem(name, *refusal) for refusal in refusals])
    if root is None:
        raise InputError([Problem(name, 0, 0, "is empty")])
    return Document(name, root.data, root)


@dataclass(frozen=True)
class SourceMapping:
    """A mapping in a document, with an optional base mapping that supplies missing keys.

    Attributes
    ----------
    document, location : document that contains this mapping, and place of the mapping in it; the
        base may be elsewhere
    data : keys and values, including those of the base
    own : keys of this mapping without those of the base
    problems : list of mistakes, common to all mappings of a file
    """

    document: Document
    location: Location
    data: dict[str, Any]
    base: SourceMapping | None = None
    own: frozenset[str] = field(default_factory=frozenset)
    problems: list[Problem] = field(default_factory=list, repr=False, compare=False)

    @classmethod
    def of(cls, document: Document, problems: list[Problem]) -> SourceMapping:
        """Return the top-level mapping of a document; mistakes are added to `problems`."""
        return cls(document, (), document.data, None, frozenset(document.data), problems)

    def holding(self, data: dict[str, Any]) -> SourceMapping:
        """Return a mapping of the given data, without a base, at the location of this mapping."""
        own = frozenset(data)
        return SourceMapping(self.document, self.location, data, None, own, self.problems)

    def into(self, problems: list[Problem]) -> SourceMapping:
        """Return a copy of this mapping that adds mistakes to another list."""
        return replace(self, problems=problems)

    def over(self, base: SourceMapping, *, dropping: frozenset[str] = frozenset()) -> SourceMapping:
        """Return a copy of this mapping with a base; keys of the base in `dropping` are ignored."""
        kept = {key: value for key, value in base.data.items() if key not in dropping}
        return replace(self, data={**kept, **self.data}, base=base)

    def child(self, key: str, *more: str | int) -> SourceMapping:
        """Return the mapping that is the value at a key, or at a path of keys."""
        home, data = self.home(key), self.data[key]
        for step in more:
            data = data[step]
        place, own = (*home.location, key, *more), frozenset(data)
        return SourceMapping(home.document, place, data, None, own, self.problems)

    def home(self, key: str | int) -> SourceMapping:
        """Return the mapping that supplies a key: this mapping, or one of its bases."""
        if self.base is None or key in self.own or key not in self.data:
            return self
        return self.base.home(key)

    def problem(
        self, location: Sequence[str | int], message: str, *, key: bool = False, lacks: str = ""
    ) -> Problem:
        """Return a problem with a value inside this mapping.

        `location` is relative to this mapping. Other parameters are those of `Document.problem`.
        """
        home = self.home(location[0]) if location else self
        place = (*home.location, *location)
        return home.document.problem(place, message, key=key, lacks=lacks)

    def refuse(
        self, location: Sequence[str | int], message: str, *, key: bool = False, lacks: str = ""
    ) -> None:
        """Record a problem with a value inside this mapping; parameters are as in `problem`."""
        self.problems.append(self.problem(location, message, key=key, lacks=lacks))

    def refuse_at(self, line: int, column: int, message: str, *, lacks: str = "") -> None:
        """Record a problem at a line and column of the file."""
        self.problems.append(Problem(self.document.path, line, column, message, lacks))


M = TypeVar("M", bound=BaseModel)


def validate(
    model: type[M],
    section: SourceMapping,
    *,
    also_allowed: Iterable[str] = (),
    context: Mapping[str, object] | None = None,
) -> M | None:
    """Validate a mapping with a data model; if it is invalid, record the mistakes and return None.

    Parameters
    ----------
    also_allowed : additional keys that messages about an unknown key may suggest
    context : context for the validators of the model
    """
    try:
        return model.model_validate(section.data, context=context)
    except ValidationError as error:
        _explain(error, model, section, also_allowed)
        return None


def complaint(model: type[BaseModel], name: str, value: object) -> str:
    """Return the reason why a model rejects a value of one of its keys; "" if it is valid."""
    data = {name: value}
    try:
        model.model_validate(data)
    except ValidationError as error:
        own = [one for one in error.errors(include_url=False) if one["loc"][:1] == (name,)]
        for details in sorted(own, key=lambda one: one["type"] == "missing"):
            _, inner = _existing(data, details["loc"])
            keys = [part for part in details["loc"] if isinstance(part, str)]
            if details["type"] == "missing":
                return f"`{keys[-1]}` is missing"
            if details["type"] == "extra_forbidden":
                forms = _models_in(_form(model, details["loc"][:-1]))
                known = [key for form in forms for key in form.model_fields]
                return _about_key(keys[-1], inner, known, None)
            return _about_value(details, keys[-1], inner, model)
    return ""


def _explain(
    error: ValidationError,
    model: type[BaseModel],
    section: SourceMapping,
    also_allowed: Iterable[str],
) -> None:
    missing: list[tuple[Location, str]] = []
    misspelt: set[tuple[Location, str]] = set()
    for details in error.errors(include_url=False):
        if details["type"] == "default_factory_not_called":
            continue  # a consequence of another mistake
        location, value = _existing(section.data, details["loc"])
        name = str(details["loc"][-1]) if details["loc"] else ""
        if details["type"] == "missing" and isinstance(details["loc"][-1], str):
            missing.append((location, name))
        elif details["type"] == "extra_forbidden":
            forms = _models_in(_form(model, details["loc"][:-1]))
            keys = [*(name for one in forms for name in one.model_fields), *also_allowed]
            if also_allowed:
                keys.remove("kind")
            near = "toward" if name == "from" else _nearest_key(name, keys)
            if near:
                misspelt.add((location[:-1], near))
            kind = _tag(model) if len(details["loc"]) == 1 else None
            message = _about_key(name, value, keys, kind)
            section.refuse(location, message, key=True)
        else:
            field = next((part for part in reversed(location) if isinstance(part, str)), "")
            message = _about_value(details, field, value, model)
            lacks = f"no {field}" if value in (None, [], {}) else ""
            section.refuse(location, message, lacks=lacks)
    # A required key that is misspelt is one mistake, not two.
    for location, name in missing:
        if (location, name) not in misspelt:
            section.refuse(location, f"`{name}` is missing", lacks=f"no {name}")


def _existing(data: Any, loc: tuple[int | str, ...]) -> tuple[Location, Any]:
    """Convert a location from pydantic to a location in the data; also return the value there.

    Steps that do not exist in the data are omitted, such as the tags that pydantic adds for unions.
    """
    location: list[str | int] = []
    for part in loc:
        if isinstance(data, dict):
            inside = part in data
        else:
            inside = isinstance(data, list) and isinstance(part, int) and part < len(data)
        if inside:
            location.append(part)
            data = data[part]
    return tuple(location), data


def _about_key(name: str, value: object, keys: list[str], kind: str | None) -> str:
    if value is None and name[:1].isdigit():
        return f"`{shown(name)}` is not a key; is there a decimal comma? Write 0.8, not 0,8"
    if name == "from" and "toward" in keys:
        return "unknown key `from`; use `toward`, and turn the direction by 180 degrees"
    return unknown_key(name, keys, f" for kind {kind}" if kind else "")


_OTHER_NAMES = {
    "clamps": "instruments instrument sensors clamp loggers",
    "label": "name id title",
    "count": "number quantity times",
    "use": "component type",
    "latitude": "lat",
    "longitude": "lon long lng",
    "toward": "direction heading to",
    "weight": "weight_in_water wet_weight",
    "mass": "weight_in_air",
    "breaking_load": "mbl breaking_strength strength",
    "working_load": "wll swl",
}
"""Common alternative names of keys, and the keys that they stand for."""


def unknown_key(name: str, keys: list[str], owner: str = "") -> str:
    """Return the message about an unknown key, which suggests the most similar valid key."""
    return unknown(f"unknown key `{shown(name)}`{owner}", _nearest_key(name, keys) or name, keys)


def _nearest_key(name: str, keys: list[str]) -> str | None:
    others = (key for key, names in _OTHER_NAMES.items() if name in names.split() and key in keys)
    return next(others, None) or nearest(name, keys)


def _about_value(details: Any, field: str, value: object, model: type[BaseModel]) -> str:
    context = details.get("ctx", {})
    cause = context.get("error")
    if isinstance(cause, QuantityError):
        return about_quantity(field, value, cause)
    if isinstance(cause, ValueError):
        return str(cause)
    kind = details["type"]
    if value is None:
        return f"`{field}` is empty" if kind == "tuple_type" else f"`{field}` has no value"
    form = _form(model, details["loc"])
    if kind == "union_tag_invalid" and isinstance(value, dict):
        kinds = [tag for one in _models_in(form) if (tag := _tag(one))]
        return not_among("kind", shown(value.get("kind")), kinds)
    if kind == "literal_error":
        return not_among(field, shown(value), _values_in(form))
    example = _example(model, details["loc"]) if kind.endswith("_type") else ""
    return f"`{field}` {_SHAPES.get(kind, details['msg'])}{example}"


_SHAPES: Mapping[str, str] = {
    "union_tag_not_found": "needs a `kind`",
    "model_type": "must hold `key: value` entries",
    "model_attributes_type": "must hold `key: value` entries",
    "dict_type": "must hold `key: value` entries",
    "tuple_type": "must be a list",
    "too_short": "is empty",
    "string_type": "must be plain text",
    "missing": "has a row with too few values",
    "too_long": "has a row with too many values",
}


def _example(model: type[BaseModel], loc: tuple[int | str, ...]) -> str:
    field = model.model_fields.get(str(loc[0])) if loc else None
    inside = {key for one in _models_in(field and field.annotation) for key in one.model_fields}
    if loc[1:] and (len(loc) > 2 or loc[1] in inside or isinstance(loc[1], int)):
        field = None  # the location is inside the value of the key
    shape = field.examples[0] if field is not None and field.examples else None
    shape = shape[:1] if isinstance(shape, list) else shape
    return f", as `{loc[0]}: {_flow(shape)}`" if isinstance(shape, (dict, list)) else ""


def _flow(value: object) -> str:
    if isinstance(value, dict):
        return "{" + ", ".join(f"{key}: {_flow(each)}" for key, each in value.items()) + "}"
    return f"[{', '.join(map(_flow, value))}]" if isinstance(value, list) else str(value)


def _form(model: type[BaseModel], loc: tuple[int | str, ...]) -> Any:
    """Return the declared type of the value at a location in a model.

    The location may contain the tags that pydantic adds for unions.
    """
    form: Any = model
    for part in loc:
        models = _models_in(form)
        fields = [one.model_fields[part].annotation for one in models if part in one.model_fields]
        tagged = [one for one in models if part in (_tag(one), one.__name__)]
        form = fields[0] if fields else tagged[0] if tagged else form
    return form


def _models_in(form: Any) -> list[type[BaseModel]]:
    if isinstance(form, type) and issubclass(form, BaseModel):
        return [form]
    return [model for argument in get_args(form) for model in _models_in(argument)]


def _values_in(form: Any) -> list[str]:
    if get_origin(form) is Literal:
        return list(get_args(form))
    return [value for argument in get_args(form) for value in _values_in(argument)]


def _tag(model: type[BaseModel]) -> str | None:
    kind = model.model_fields.get("kind")
    return get_args(kind.annotation)[0] if kind else None
