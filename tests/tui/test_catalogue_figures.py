"""The catalogue as a table: figures, limits in the search, synonyms, what was used lately."""

from functools import cache

import pytest

from calm.assemble.catalogue_search import Index
from calm.files import Catalogue
from calm.files.catalogue_search import COLUMNS, wanted


@cache
def index():
    return Index(Catalogue.shipped())


def found(text, **how):
    return [each.id for each in index().search(text, **how)]


@pytest.mark.parametrize(
    "word, key, limit",
    [
        ("breaking>50kN", "breaking", 50e3),
        ("mbl>=50", "breaking", 50e3),
        ("wll<2t", "working", None),
        ("depth>4000", "depth", 4000.0),
        ("net>1kN", "net", 1000.0),
        ("mass<20", "mass", 20.0),
        ("colour>3", None, None),
        ("shackle-13", None, None),
    ],
)
def test_a_word_may_be_a_limit(word, key, limit):
    read = wanted(word)
    if limit is None:
        assert read is None
    else:
        assert (read.key, read.limit) == (key, pytest.approx(limit))


def test_limits_are_kept_by_all_that_are_found():
    ids = found("shackle breaking>100kN")
    assert ids and len(ids) < len(found("shackle"))
    assert all(index().figures(id)["breaking"] > 100e3 for id in ids)
    assert not [id for id in ids if "shackle" not in index().get(id).name.casefold()]


@pytest.mark.parametrize(
    "words, id",
    [
        ("current meter", "rcm11"),
        ("current meter", "aquadopp-deep"),
        ("twin release", "release-ar861-double"),
        ("dacron", "polyester-10"),
        ("aramid", "kevlar-9"),
        ("ctd", "sbe37-bar"),
    ],
)
def test_words_of_the_trade_find_what_is_called_otherwise(words, id):
    assert id in found(words)


def test_the_greatest_comes_first_and_what_is_unknown_last():
    loads = [index().figures(id)["breaking"] for id in found("wire", by="breaking")]
    known = [load for load in loads if load is not None]
    assert known == sorted(known, reverse=True) and loads[: len(known)] == known


def test_favourites_and_what_was_used_lately_come_first():
    assert found("13", first=["swivel-13"])[0] == "swivel-13" != found("13")[0]
    assert found("", first=["glass-17in-lpo"])[0] == "glass-17in-lpo"
    assert found("shackle-13", first=["shackle-13-ios"])[:2] == ["shackle-13", "shackle-13-ios"]
    assert found("wire", first=["glass-17in-lpo"]) == found("wire")


def test_figures_are_those_of_the_component():
    wire = index().catalogue.get("wire-jacketed-8")
    figures = index().figures("wire-jacketed-8")
    assert figures["net"] == wire.net_buoyancy and figures["breaking"] == wire.breaking_load
    shown = {each.key: each.shown(figures[each.key]) for each in COLUMNS}
    assert shown["breaking"] == f"{wire.breaking_load / 1e3:.1f}"
    assert COLUMNS[0].shown(None) == ""


def test_the_list_shows_figures_and_is_sorted_by_key(drive, small):
    async def story(driver):
        await driver.press("a")
        await driver.type("shackle")
        await driver.settle()
        rows = driver.builder.catalogue.listing
        assert "break kN" in driver.screen and "net N" in driver.screen
        first = [each.id for each in rows.rows]
        await driver.press("f4", "f4")
        await driver.settle()
        assert "sorted by breaking" in driver.screen
        by_load = [each.id for each in rows.rows]
        assert by_load != first and sorted(by_load) == sorted(first)
        load = [index().figures(id)["breaking"] or 0.0 for id in by_load]
        assert load == sorted(load, reverse=True)

    drive(story, small, size=(160, 40))
