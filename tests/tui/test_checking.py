"""What is made of a text as it is typed."""

import pytest

from calm.files.fields import QuantityField
from calm.tui import checking
from calm.tui.catalogue.component_screen import defined, form_fields
from calm.tui.catalogue.index import Index


@pytest.mark.parametrize(
    "text, written",
    [("480 m", "480 m"), ("480", "480 m"), ("  480   m ", "480 m"), ("fit 105", "fit 105 m"),
     ("FIT to 105 m", "fit 105 m"), ("1/2 nmi", "1/2 nmi")],
)  # fmt: skip
def test_lengths_that_can_be_used(text, written):
    reading = checking.length()(text)
    assert reading.is_good
    assert reading.text == written


@pytest.mark.parametrize(
    "text", ["", "x", "0 m", "-3 m", "60 kg", "fit", "fit 3 kg", "1,5 m", "nan"]
)
def test_lengths_that_cannot(text):
    reading = checking.length()(text)
    assert not reading.is_good
    assert reading.note


def test_the_keys_of_a_length():
    assert checking.length_values("60 m")["length"] == "60 m"
    assert checking.length_values("fit 30 m")["top_depth"] == "30 m"
    assert checking.length_values("fit 30 m", towed=True)["body_depth"] == "30 m"
    for text in ("60 m", "fit 30 m"):
        kept = {key: value for key, value in checking.length_values(text).items() if value}
        assert checking.length_text(kept) == text


def test_a_length_at_a_load():
    assert checking.length()("480 at 2").text == "480 m at 2 kN"
    assert checking.length()("480 m at 2 kN").is_good
    assert checking.length()("480 m at 2 kg").offer == "480 m at 2 kgf"
    values = checking.length_values("480 m at 2 kN")
    assert values["length_at"] == {"load": "2 kN", "length": "480 m"}
    assert values["length"] is None
    assert checking.length_text({"length_at": "480 m at 2 kN"}) == "480 m at 2 kN"


def test_counts():
    assert checking.count("6").text == "6"
    assert checking.count("×6").text == "6"
    assert checking.count("").text == "1"
    assert not checking.count("2.5").is_good
    assert not checking.count("0").is_good


def test_a_mass_where_a_force_is_wanted_offers_the_force():
    reading = checking.quantity(QuantityField("force"))("35 kg")
    assert reading.offer == "35 kgf"
    assert "35 kgf?" in reading.note


def test_an_id_comes_before_what_only_mentions_it():
    from calm.files import Catalogue

    index = Index(Catalogue.shipped())
    assert index.search("rcm4")[0].id == "rcm4"
    assert index.search("wire jacketed 8")[0].id == "wire-jacketed-8"
    assert not index.search("rcm4 no-such")
    assert {each.kind for each in index.search("", {"anchor"})} == {"anchor"}


@pytest.mark.parametrize("text", ["sbe-37", "sbe 37", "SBE_37", "sbe  -37-"])
def test_hyphens_part_words_as_blanks_do(text):
    from calm.files import Catalogue

    index = Index(Catalogue.shipped())
    found = index.search(text)
    assert found[0].id == "sbe37"
    assert len(found) > 10 and found == index.search("sbe 37")
    assert index.search("wire-jack") == index.search("wire jack") != []


@pytest.mark.parametrize("kind", ["sphere", "cylinder", "body", "cable", "chain", "anchor"])
def test_every_kind_has_its_fields_and_says_what_is_needed(kind):
    fields = {field.key: field for field in form_fields(kind)}
    assert {"name", "source", "breaking_load"} <= fields.keys()
    component, problems = defined("mine", {"kind": kind})
    assert component is None
    assert problems


def test_a_form_makes_a_component():
    values = {"kind": "cable", "diameter": "12 mm", "weight": "0.4 N/m"}
    component, problems = defined("mine", values)
    assert not problems
    assert component.diameter == pytest.approx(0.012)
