"""What is made of a text as it is typed."""

import pytest

from calm.assemble.catalogue_search import Index
from calm.files import Catalogue
from calm.files.definition import QuantityField
from calm.tui import checking
from calm.tui.component_screen import defined, form_fields


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
    assert checking.length()("480 m at 2 kg").complaint.endswith("write `2 kgf` or `2 kN`")
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
    index = Index(Catalogue.shipped())
    assert index.search("rcm4")[0].id == "rcm4"
    assert index.search("wire jacketed 8")[0].id == "wire-jacketed-8"
    assert not index.search("rcm4 no-such")
    assert {each.kind for each in index.search("", {"anchor"})} == {"anchor"}


@pytest.mark.parametrize(
    ("text", "first"),
    [
        ("seabird 37", "sbe37"),
        ("8mm wire jacketed", "wire-jacketed-8"),
        ("8 mm jacketed wire", "wire-jacketed-8"),
        ("17 inch glass benthos", "glass-17in"),
        ("432mm vitrovex cluster", "glass-cluster-4"),
        ("7/16 nylon", "nylon-11"),
        ("1-1/4in nylon", "nylon-32"),
        ("vinyl 16in", "viny-16in"),
        ("shackel 16", "shackle-16"),
        ("releese ar861", "release-ar861"),
    ],
)
def test_maker_size_and_misspelt_words_find(text, first):
    index = Index(Catalogue.shipped())
    found = [each.id for each in index.search(index.spelt(text))]
    assert first in found[:2]


def test_a_size_is_the_same_in_millimetres_and_inches_and_no_other():
    index = Index(Catalogue.shipped())
    found = {each.id for each in index.search("glass 432 mm")}
    assert found == {each.id for each in index.search('glass 17"')}
    assert "glass-17in" in found
    assert not found & {each.id for each in index.search("glass 10in")}
    assert index.spelt("wire breaking>50kN xyzzyqq") == "wire breaking>50kN xyzzyqq"


@pytest.mark.parametrize("text", ["sbe-37", "sbe 37", "SBE_37", "sbe  -37-"])
def test_hyphens_part_words_as_blanks_do(text):
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
