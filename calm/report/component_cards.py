"""Components of the catalogue as a list, as cards and as JSON, with their missing values."""

import re
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import asdict
from typing import Any

from pydantic import BaseModel

from calm.assemble.component_forces import Datasheet, datasheet
from calm.checks.catalogue_rules import CatalogueFinding, MissingFigures
from calm.files import Catalogue
from calm.files.catalogue import Defined
from calm.files.components import FLEXIBLE_KINDS, KINDS, Outline
from calm.files.definition import EstimatedFigure
from calm.quantities import QUANTITIES
from calm.report import blocks
from calm.report.blocks import Cell, Field, Heading, Pairs, ReportPart, number, table_of, words

_PER_METRE = ("mass", "weight", "buoyancy", "net_buoyancy")
_FIRST = ("name", "kind", "role")
_LAST = ("note", "source", "sources", "searched", "date")
_ELSEWHERE = ("prefer",)
_AUTHOR = re.compile(r"[,;] (?![^()]*\))")
"""Pattern for the end of the publisher's name in a source: a comma outside brackets."""
_HEADING_OF_OTHERS = "other"


def to_list(catalogue: Catalogue, definitions: Mapping[str, Defined]) -> ReportPart:
    """Build a table with one line per definition, grouped by product family."""
    rows: list[Any] = []
    last = None
    for identifier, definition in definitions.items():
        family = _family(catalogue, identifier) or _HEADING_OF_OTHERS
        if family != last:
            rows += [Cell(), Cell(family.upper())]
            last = family
        rows.append((identifier, definition))

    def name(row: tuple[str, Defined]) -> str:
        _, definition = row
        text = definition.name or ""
        if definition.prefer is not None:
            text += f" (use {definition.prefer})"
        if isinstance(definition, Outline):
            text += f" (without {', '.join(map(_heading, definition.lacks))})"
        return text

    def net_force(row: tuple[str, Defined]) -> str | None:
        sheet = datasheet(row[1], catalogue)
        return (
            None
            if sheet is None
            else _value_text("net_buoyancy", sheet.net_buoyancy) + _per_metre(row[1])
        )

    def figure(heading: str, key: str) -> Field:
        def text(row: tuple[str, Defined]) -> str | None:
            return None if getattr(row[1], key, None) is None else _field_text(row[1], key)

        return number(heading, text)

    table = table_of(
        "",
        rows,
        words("id", 0),
        words("name", name),
        number("net force\nin water", net_force),
        figure("breaking\nload", "breaking_load"),
        dense=True,
    )
    return ReportPart("", (table,))


def to_card(identifier: str, definition: Defined, catalogue: Catalogue | None = None) -> ReportPart:
    """Create the card of a definition, with values in display units and their sources.

    If the catalogue defines the product several times, the card compares the definitions.
    """
    following = _derived_pairs(datasheet(definition, catalogue), _per_metre(definition))
    pairs = Pairs((*_specified_pairs(definition), *following))
    same = [] if catalogue is None else catalogue.same_thing(identifier)
    beside = [_comparison_table(catalogue, same)] if catalogue is not None and len(same) > 1 else []
    return ReportPart("", (Heading(identifier), pairs, *beside))


def to_documents(catalogue: Catalogue, definitions: Mapping[str, Defined]) -> list[dict[str, Any]]:
    """Return JSON objects with `id`, `family` and every field (SI or degrees, None if absent).

    `derived` has derived values. `same_thing` lists all definitions of the same product, preferred
    first.
    """
    return [
        {"id": identifier, "family": _family(catalogue, identifier)}
        | dict.fromkeys(
            KINDS[definition.kind].model_fields if isinstance(definition, Outline) else ()
        )
        | definition.model_dump(mode="json")
        | {
            "derived": asdict(sheet) if (sheet := datasheet(definition, catalogue)) else None,
            "same_thing": catalogue.same_thing(identifier),
        }
        for identifier, definition in definitions.items()
    ]


def _family(catalogue: Catalogue, identifier: str) -> str | None:
    entry = catalogue.entry(identifier)
    return entry.family if entry else None


def _specified_pairs(definition: Defined) -> Iterator[tuple[str, str]]:
    placed = (*_FIRST, *_LAST, *_ELSEWHERE)
    every = (*type(definition).model_fields, *(definition.model_extra or ()))
    fields = [name for name in every if name not in placed]
    for name in (*_FIRST, *fields, *_LAST):
        if getattr(definition, name) is not None:
            yield _heading(name), _field_text(definition, name)


def _derived_pairs(sheet: Datasheet | None, per_metre: str) -> Iterator[tuple[str, str]]:
    if sheet is None:
        return
    yield _heading("net_buoyancy"), _value_text("net_buoyancy", sheet.net_buoyancy) + per_metre
    if sheet.kn is None or sheet.cd_area is None:
        return
    for name, value in (("kn", sheet.kn), ("kt", sheet.kt)):
        yield (
            f"{QUANTITIES[name].symbol}",
            f"{_value_text(name, value)}{per_metre and ' per metre'}",
        )
    across = QUANTITIES["force"].figure(sheet.kn) + per_metre
    along = QUANTITIES["force"].figure(sheet.kt or 0.0) + per_metre
    yield "drag at 1 m/s", f"{across} across, {along} along"
    yield "Cd × area", QUANTITIES["cd_area"].figure(sheet.cd_area) + per_metre


def _comparison_table(catalogue: Catalogue, same: Sequence[str]) -> blocks.Table:
    defined = {each: catalogue.get(each) for each in same}
    sheets = {
        identifier: sheet
        for identifier, definition in defined.items()
        if (sheet := datasheet(definition, catalogue)) is not None
    }
    rows = [
        (
            identifier,
            "use this" if identifier == same[0] else "",
            _value_text("net_buoyancy", sheet.net_buoyancy) + _per_metre(defined[identifier]),
            "" if sheet.cd_area is None else _value_text("cd_area", sheet.cd_area),
            _AUTHOR.split(defined[identifier].source or "", maxsplit=1)[0],
        )
        for identifier, sheet in sheets.items()
    ]
    nets = [sheet.net_buoyancy for sheet in sheets.values()]
    areas = [sheet.cd_area for sheet in sheets.values() if sheet.cd_area is not None]
    for word, extreme in (("smallest", min), ("largest", max)):
        area = _value_text("cd_area", extreme(areas)) if areas else ""
        rows.append((word, "", _value_text("net_buoyancy", extreme(nets)), area, ""))
    return table_of(
        "",
        rows,
        words("entries for this product", 0, 0.0),
        words("", 1, 0.0),
        number("net force in water", 2),
        number("Cd × area", 3),
        words("listed by", 4),
    )


def _per_metre(definition: Defined) -> str:
    return "/m" if definition.kind in FLEXIBLE_KINDS else ""


def _heading(name: str) -> str:
    return QUANTITIES[name].heading if name in QUANTITIES else name.replace("_", " ")


def _field_text(definition: Defined, name: str) -> str:
    value = getattr(definition, name)
    if name == "searched":
        return ", ".join(_heading(each) for each in value) + (" (no published value found)")
    if name == "sources":
        return "\n".join(f"{_heading(each)}: {text}" for each, text in value.items())
    if isinstance(value, tuple):
        return "\n".join(_value_text(name, member) for member in value)
    return _value_text(name, value) + (_per_metre(definition) if name in _PER_METRE else "")


def _value_text(name: str, value: Any) -> str:
    if isinstance(value, float) and name in QUANTITIES:
        return QUANTITIES[name].figure(value)
    if isinstance(value, EstimatedFigure):
        return f"{_heading(value.quantity)} {value.in_words}"
    if isinstance(value, BaseModel):
        value = value.model_dump(exclude_none=True)
    if isinstance(value, Mapping):
        return ", ".join(
            f"{_heading(key)} {_value_text(key, member)}" for key, member in value.items()
        )
    if isinstance(value, tuple | list):
        return f"({'; '.join(_value_text(name, member) for member in value)})"
    return str(value)


def in_words(missing: MissingFigures) -> str:
    """List the missing values of a component; values known to be unpublished come last."""
    sought = [_heading(name) for name in missing.figures if name in missing.searched]
    open_yet = [_heading(name) for name in missing.figures if name not in missing.searched]
    parts = [f"lacks {', '.join(open_yet)}"] if open_yet else []
    parts += [f"not published: {', '.join(sought)}"] if sought else []
    return "; ".join(parts)


def summarised(missing: Sequence[MissingFigures]) -> str:
    """Return a sentence on the components with missing values.

    The sentence gives the number of these components, and how many of them lack each value.
    """
    counts = Counter(name for each in missing for name in each.figures)
    figures = ", ".join(f"{_heading(name)} {count}" for name, count in counts.most_common())
    return f"{len(missing)} of them lack values: {figures}"


def to_objects(
    findings: Sequence[CatalogueFinding], missing: Sequence[MissingFigures]
) -> list[dict[str, Any]]:
    """Return JSON objects of catalogue findings, followed by findings on missing values.

    The keys are `id`, `finding`, `message`, `missing` and `searched`.
    """
    wrong = [(one.id, True, one.message, (), ()) for one in findings]
    lacking = [(one.id, False, in_words(one), one.figures, one.searched) for one in missing]
    return [
        {"id": id, "finding": wrong, "message": message, "missing": [*named], "searched": [*sought]}
        for id, wrong, message, named, sought in (*wrong, *lacking)
    ]
