"""Forms of the file: a field for every key of the models, and what is typed as the file has it."""

from typing import Annotated

import pytest

from calm.files.check_limits import Checks
from calm.files.components import KINDS, Cable
from calm.files.definition import Model, QuantityField, described, optional
from calm.files.editing import Draft
from calm.files.environment import EnvironmentKeys, TowEnvironmentKeys
from calm.files.item_keys import Equipment
from calm.files.logbook import Deployed, DocumentKeys
from calm.files.mooring_file import Solver, TowKeys
from calm.files.reader import MooringKeys
from calm.tui.component_screen import form_fields
from calm.tui.forms import (
    FormField,
    filled,
    form_of,
    model_in,
    rows_of,
    text_of,
    text_of_rows,
    value_of,
    values_of,
    written,
)
from calm.tui.mooring_sheet import SHEETS, settings

MODELS = [MooringKeys, EnvironmentKeys, TowEnvironmentKeys, *KINDS.values(), DocumentKeys, Deployed,
          Equipment, Solver, TowKeys, Checks]  # fmt: skip


def keys_of(model: type[Model], at: str = "") -> set[str]:
    """The places of all keys, those of models within models too."""
    keys: set[str] = set()
    for name, field in model.model_fields.items():
        inner = model_in(field.annotation)
        keys |= keys_of(inner, f"{at}{name}.") if inner else {f"{at}{name}"}
    return keys


def field(asked: list[FormField], key: str) -> FormField:
    return next(each for each in asked if each.key == key)


@pytest.mark.parametrize("model", MODELS, ids=lambda model: model.__name__)
def test_every_key_has_a_field_that_takes_its_example(model):
    asked = form_of(model)
    assert {each.key for each in asked} == keys_of(model)
    for each in asked:
        example = each.placeholder.removeprefix("e.g. ")
        assert each.check(example).is_good, (each.key, each.check(example))
        if each.columns:
            assert rows_of(example, each.columns), each.key


def test_a_key_that_is_added_to_a_model_is_in_its_form():
    class Wider(Solver):
        deepest: Annotated[float | None, QuantityField("length", above=0)] = optional(
            "where the search ends", "6000 m"
        )
        seed: int = described("of the draw", 7, default=1)

    added = field(form_of(Wider, "solver."), "solver.deepest")
    assert (added.title, added.takes) == ("deepest", "where the search ends")
    assert added.placeholder == "e.g. 6000 m"
    assert added.check("6000").text == "6000 m"
    assert "is a mass" in added.check("3 kg").note
    assert not field(form_of(Wider), "seed").check("many").is_good


def test_every_section_of_the_file_that_is_a_form_is_on_a_sheet():
    sheets = {key for _, keys in SHEETS.values() for key in keys} | set(settings())
    forms = {name for name, each in MooringKeys.model_fields.items() if model_in(each.annotation)}
    assert forms <= sheets
    assert {"solver", "checks", "uncertainty", "units"} <= set(settings())


def test_what_a_key_may_be_is_judged_as_it_is_typed():
    asked = form_of(DocumentKeys)
    assert "is not a date" in field(asked, "date").check("soon").note
    asked = form_of(EnvironmentKeys)
    assert field(asked, "depth_range").check("[98 m, 104 m]").is_good
    assert not field(asked, "depth_range").check("98 m").is_good
    assert not field(asked, "seabed").check("{slope: 3 kg, toward: 90 deg}").is_good
    assert "unknown key" in field(asked, "seabed").check("{slope: 3 deg, tward: 1 deg}").note
    assert field(form_of(Solver), "friction").check("hoer").offer == "hoerner"
    asked = form_of(TowKeys)
    assert not field(asked, "speed").check("").is_good
    assert field(form_of(TowKeys, needed=False), "speed").check("").is_good


def test_what_is_no_text_is_typed_in_brackets():
    for text in ("480 m", "[98 m, 104 m]", "{factor: 1.5}", "{a: [1, 2], b: {c: d}}", ""):
        assert text_of(value_of(text)) == text
    assert value_of("{enable: 0A51}") == {"enable": "0A51"}
    assert value_of("[no list") == "[no list"
    assert value_of("[]") is None
    texts = {"name": "x", "position.latitude": "48 deg", "position.longitude": "", "rows": "[a]"}
    assert values_of(texts) == {"name": "x", "position": {"latitude": "48 deg"}, "rows": ["a"]}


ELONGATION = "[[0.1, 0.03], [0.3, 0.08]]"


@pytest.mark.parametrize(
    ("asked", "text", "rows"),
    [
        (field(form_of(Cable), "elongation"), ELONGATION, (("0.1", "0.03"), ("0.3", "0.08"))),
        (
            field(form_of(DocumentKeys), "history"),
            "[{revision: A, change: first issue}, {revision: B, date: 2026-10-02}]",
            (("A", "", "", "first issue"), ("B", "2026-10-02", "", "")),
        ),
        (
            field(form_of(MooringKeys), "releases"),
            "[{serial: 1729, codes: {enable: 0A51, release: 0A55}}]",
            (("1729", "{enable: 0A51, release: 0A55}"),),
        ),
    ],
)
def test_a_table_is_read_and_written(asked, text, rows):
    assert rows_of(text, asked.columns) == rows
    assert text_of_rows(rows, asked.columns) == text
    assert text_of_rows([*rows, ("",) * len(rows[0])], asked.columns) == text
    assert rows_of("[a, [b, c, d]]", asked.columns) is None
    assert rows_of("", asked.columns) == ()


def test_the_columns_of_a_table_judge_their_values():
    load, strain = field(form_of(Cable), "elongation").columns
    assert (load.heading, strain.heading) == ("load / breaking load", "strain")
    assert load.check("30 %").is_good and not load.check("3").is_good
    date = field(form_of(DocumentKeys), "history").columns[1]
    assert not date.check("soon").is_good


HISTORY = """\
document:
  id: M1         # of the cruise
  history:
    - {revision: A, change: first issue}   # signed
    - {revision: B, change: longer wire}
line: []
"""


def test_only_what_is_changed_is_written():
    draft = Draft(HISTORY)
    asked = filled(form_of(DocumentKeys, "document."), draft.value(()))
    texts = {each.key: each.text for each in asked}
    assert written(draft, texts).text == HISTORY
    rows = rows_of(texts["document.history"], field(asked, "document.history").columns)
    texts["document.history"] = text_of_rows(
        [rows[0], ("B", "2026-10-02", "", "longer wire")], field(asked, "document.history").columns
    )
    after = written(draft, texts | {"document.ship": "RV Example"})
    assert "  id: M1         # of the cruise\n" in after.text
    assert "    - {revision: A, change: first issue}   # signed\n" in after.text
    assert "    - {revision: B, date: 2026-10-02, change: longer wire}\n" in after.text
    assert "  ship: RV Example\n" in after.text
    gone = written(after, {"document.history": "", "document.id": ""})
    assert gone.value(("document",)) == {"ship": "RV Example"}


def test_a_form_of_a_component_begins_with_what_it_needs():
    keys = [each.key for each in form_fields("cable")]
    assert keys[:4] == ["name", "manufacturer", "role", "diameter"]
    takes = {each.key: each.takes for each in form_fields("cable")}
    assert takes["working_load"] == "maximum load in use"
    assert takes["diameter"] == "diameter; for a chain, the diameter of its bar"
    assert "kind" not in keys and keys.index("elongation") < keys.index("breaking_load")
