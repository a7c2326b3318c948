import json
import re
from collections import Counter
from typing import get_args

import pytest

from calm.cli.catalog import Kind
from calm.files.components import KINDS
from calm.shipped import shipped_folder

MINE = """\
good: {{kind: sphere, diameter: 1 m, buoyancy: 2000 N, source: me}}
{more}
"""


@pytest.fixture
def mine(folder):
    def write(more=""):
        (folder / "mine.yaml").write_text(MINE.format(more=more), encoding="utf-8")
        return "mine.yaml"

    return write


def test_list_goes_family_by_family(calm):
    done = calm("catalog", "list")
    assert done.code == 0
    families = [line for line in done.out.splitlines() if line.isalpha() and line.isupper()]
    assert sorted(families) == [
        "ANCHORS", "CHAINS", "CONNECTORS", "FLOATS", "INSTRUMENTS", "RELEASES", "ROPES"
    ]  # fmt: skip


def test_list_of_one_kind(calm):
    components = json.loads(calm("catalog", "list", "--kind", "chain", "--json").out)
    assert {component["kind"] for component in components} == {"chain"}
    assert "chain-buoy-13" in {component["id"] for component in components}


def test_every_kind_can_be_listed():
    assert get_args(Kind) == (*KINDS, "assembly")


def test_json_has_every_field_in_si(calm):
    (sphere,) = json.loads(calm("catalog", "show", "sphere-steel-1250", "--json").out)
    assert sphere["id"] == "sphere-steel-1250"
    assert sphere["family"] == "floats"
    assert (sphere["diameter"], sphere["buoyancy"], sphere["breaking_load"]) == (1.25, 7000, 120e3)
    assert sphere["max_tilt"] is None
    assert sphere["source"]


def test_card_shows_figures_and_source(calm):
    done = calm("catalog", "show", "sphere-steel-1250", "rcm4")
    assert done.code == 0
    assert "1250 mm" in done.out
    assert "120 kN" in done.out
    assert "speed 0.51 m/s, force 10.1 N" in done.out
    assert "maximum tilt" in done.out
    assert done.out.count("source ") == 2


def test_assembly_is_shown(calm):
    assert "glass-17in" in calm("catalog", "show", "glass-cluster-4").out


@pytest.mark.parametrize("id", ["glass-cluster-4", "release-pair-ar861"])
def test_the_net_force_of_an_assembly_is_listed_as_on_its_card(calm, id):
    card, listed = calm("catalog", "show", id).out, calm("catalog", "list", id).out
    (shown,) = (line.split()[-2:] for line in card.splitlines() if "net force" in line)
    row = next(line for line in listed.splitlines() if line.startswith(f"{id} "))
    assert float(shown[0].replace("−", "-")) and " ".join(shown) in row


def test_what_follows_from_the_figures_is_shown(calm):
    # Kn of a sphere: 1/2 x 1025 x 0.5 x pi/4 x 1.25^2 = 314.5 N/(m/s)^2; Cd x area is 0.6136 m^2.
    shown = calm("catalog", "show", "sphere-steel-1250").out
    assert "314.5 N/(m/s)²" in shown
    assert "314.5 N across, 314.5 N along" in shown
    assert "0.6136 m²" in shown
    (sphere,) = json.loads(calm("catalog", "show", "sphere-steel-1250", "--json").out)
    assert sphere["derived"] == {
        "net_buoyancy": 7000.0,
        "kn": pytest.approx(314.5, abs=0.05),
        "kt": pytest.approx(314.5, abs=0.05),
        "cd_area": pytest.approx(0.6136, abs=5e-5),
    }
    assert sphere["same_thing"] == ["sphere-steel-1250"]


def test_one_thing_by_several_sources_is_shown_with_the_one_to_use(calm):
    shown = calm("catalog", "show", "sbe37-clamp").out
    table = shown[shown.index("entries for this product") :]
    rows = {line.split()[0]: " ".join(line.split()) for line in table.splitlines()[1:]}
    assert rows["sbe37"].startswith("sbe37 use this -27.46 N 0.05078 m²")
    assert rows["sbe37-clamp"].startswith("sbe37-clamp -22.69 N 0.1643 m²")
    assert rows["smallest"] == "smallest -29.42 N 0.039 m²"
    assert rows["largest"] == "largest -22.69 N 0.1643 m²"
    assert "(use sbe37)" in " ".join(calm("catalog", "list", "sbe37-clamp").out.split())
    (found,) = json.loads(calm("catalog", "show", "sbe37-clamp", "--json").out)
    assert found["prefer"] == "sbe37"
    assert found["same_thing"] == ["sbe37", "sbe37-clamp", "sbe37-lpo"]


def test_sources_of_single_figures_are_shown(calm):
    shown = " ".join(calm("catalog", "show", "shackle-13-dewey").out.split())
    assert "working load: Crosby carbon shackles" in shown


def test_unknown_ids_are_told_at_once_with_the_nearest(calm):
    done = calm("catalog", "show", "wire-jackted-8", "rcm4", "shakle-13")
    assert done.code == 2
    assert done.out == ""
    assert "wire-jacketed-8" in done.err
    assert "shackle-13" in done.err
    assert len(done.err.splitlines()) == 1


def test_search_wants_every_word(calm):
    found = json.loads(calm("catalog", "list", "STEEL", "sphere", "--json").out)
    assert "sphere-steel-1250" in {component["id"] for component in found}
    assert calm("catalog", "list", "steel", "sphere").code == 0


def test_outlines_are_found_after_complete_entries_and_say_what_they_lack(calm):
    found = json.loads(calm("catalog", "list", "mmp", "--json").out)
    assert [(each["id"], each["mass"], each["derived"]) for each in found] == [
        ("mmp-mclane", 70.0, None)
    ]
    assert found[0]["length"] is None and found[0]["buoyancy"] == 0.0
    assert "(without length, drag area)" in " ".join(calm("catalog", "list", "mmp").out.split())
    ids = [each["id"] for each in json.loads(calm("catalog", "list", "smp", "--json").out)]
    assert ids[:2] == ["sbe37-smp-frame", "sbe37-smp-plastic"]


def test_list_with_words_searches_within_a_kind(calm):
    listed = json.loads(calm("catalog", "list", "wire", "--json").out)
    assert listed == json.loads(calm("catalog", "list", "wire", "--json").out)
    cables = json.loads(calm("catalog", "list", "wire", "--kind", "cable", "--json").out)
    assert cables == [each for each in listed if each["kind"] == "cable"]
    assert 0 < len(cables) < len(listed)


@pytest.mark.parametrize(
    ("written", "meant"),
    [
        ("chain-g30-16", "chain-short-g30-16"),
        ("chain-g30-16mm", "chain-short-g30-16"),
        ("chain-g30-15", "chain-short-g30-16"),
        ("chain-g80-18", "chain-g80-19"),
        ("glass17in", "glass-17in"),
    ],
)
def test_an_unknown_id_suggests_its_grade_and_size(calm, written, meant):
    assert f"did you mean `{meant}`?" in calm("catalog", "show", written).err


def test_search_takes_a_bare_fraction_for_inches_and_drops_a_word_that_nothing_has(calm):
    ids = [
        each["id"] for each in json.loads(calm("catalog", "list", "3/4", "shackle", "--json").out)
    ]
    assert ids[0] == "shackle-19" and "shackle-anchor-19" in ids[:3]
    done = calm("catalog", "list", "rbr", "quartet")
    assert "none matches `quartet`" in done.err and "rbr-duet-uwa" in done.out


@pytest.mark.parametrize(
    ("words", "first", "says"),
    [
        (["upward", "adcp"], "adcp-workhorse", "these match most of them"),
        (["single", "point", "current", "meter"], "current-meter-cdms", "none matches `point`"),
        (["wyre"], "wire-jacketed-8-5", "searched for `wire`"),
    ],
)
def test_the_components_with_most_words_are_found(calm, words, first, says):
    done = calm("catalog", "list", *words, "--json")
    assert json.loads(done.out)[0]["id"] == first
    assert says in done.err


def test_search_is_called_list(calm):
    done = calm("catalog", "search", "wire")
    assert done.code == 2 and 'Did you mean "list"?' in done.err


def test_search_without_a_find(calm):
    done = calm("catalog", "list", "unobtainium")
    assert (done.code, done.out) == (0, "")
    assert "unobtainium" in done.err
    assert json.loads(calm("catalog", "list", "unobtainium", "--json").out) == []


def test_shipped_catalogue_has_no_finding_and_lists_what_it_lacks(calm):
    done = calm("catalog", "check")
    assert done.code == 0
    lines = dict(line.split(": ", 1) for line in done.out.splitlines())
    assert lines["vacm"] == "lacks mass, working load, breaking load, depth rating, maximum tilt"
    assert lines["rcm11"].endswith("not published: mass, working load, breaking load")
    assert "shackle-13" not in lines
    assert "findings: 0" in done.err
    assert "lack values" in done.err


def test_what_is_missing_as_json(calm, mine):
    found = json.loads(calm("catalog", "check", mine(), "--json").out)
    assert found == [
        {
            "id": "good",
            "finding": False,
            "message": "lacks mass, working load, breaking load, depth rating, maximum tilt",
            "missing": ["mass", "working_load", "breaking_load", "depth_rating", "max_tilt"],
            "searched": [],
        }
    ]


def test_finding_gives_exit_code_1(calm, mine):
    file = mine("bad: {kind: sphere, diameter: 1 m, buoyancy: 9 kN, source: me}")
    done = calm("catalog", "check", file)
    assert done.code == 1
    assert done.out.startswith("bad: has a buoyancy of 9.00 kN")
    findings = json.loads(calm("catalog", "check", file, "--json").out)
    assert [finding["id"] for finding in findings if finding["finding"]] == ["bad"]
    assert {finding["id"] for finding in findings if not finding["finding"]} == {"good", "bad"}
    assert calm("catalog", "check", mine()).code == 0


def test_file_with_mistakes_is_bad_input(calm, mine):
    done = calm("catalog", "check", mine("bad: {kind: sphere, diameter: 1, mass: -2 kg}"))
    assert done.code == 2
    assert done.out == ""
    assert all(line.startswith("mine.yaml:2:") for line in done.err.splitlines())
    assert calm("catalog", "check", "missing.yaml").code == 2


def test_catalogue_of_ones_own_is_listed_last(calm, tmp_path):
    own = tmp_path / "configuration" / "calm" / "catalog"
    own.mkdir(parents=True)
    (own / "mine.yaml").write_text(MINE.format(more=""))
    assert calm("catalog", "list").out.splitlines()[-2].strip() == "OTHER"
    assert calm("catalog", "show", "good").code == 0


def test_search_says_how_it_read_a_misspelt_word(calm):
    done = calm("catalog", "list", "releese", "ar861", "--json")
    assert done.err == "no component matches `releese ar861`; searched for `release ar861`\n"
    assert "release-ar861" in [each["id"] for each in json.loads(done.out)]


def test_a_short_word_with_another_first_letter_is_not_misspelt(calm):
    done = calm("catalog", "list", "back-up", "buoyancy")
    assert "searched for" not in done.err and "none matches `back`" in done.err


def test_search_keeps_limits_and_puts_what_is_used_first(calm):
    found = json.loads(calm("catalog", "list", "wire", "breaking>40kN", "--json").out)
    assert found and all(each["breaking_load"] > 40e3 for each in found)
    shackles = json.loads(calm("catalog", "list", "bow shackle", "--json").out)
    uses = Counter(
        id
        for file in shipped_folder("lines").glob("*.yaml")
        for id in re.findall(r"\buse: *([\w-]+)", file.read_text("utf-8"))
    )
    counts = [uses[each["id"]] for each in shackles]
    assert counts[0] > 0 and counts == sorted(counts, reverse=True)


GLASS = ("kind=sphere", "role=float", "diameter=432 mm", "buoyancy=250 N", "source=tank: 2026")


def test_add_puts_a_component_where_every_command_finds_it(calm, folder, monkeypatch):
    monkeypatch.setenv("CALM_CATALOG_DIR", str(folder / "own"))
    done = calm("catalog", "add", "our-glass", *GLASS)
    assert done.code == 0
    assert "lacks mass, working load, breaking load, depth rating" in done.err
    (shown,) = json.loads(calm("catalog", "show", "our-glass", "--json").out)
    assert (shown["diameter"], shown["buoyancy"], shown["source"]) == (0.432, 250, "tank: 2026")
    assert calm("catalog", "add", "our-ball", *GLASS).code == 0
    assert calm("catalog", "show", "our-glass", "our-ball").code == 0
    again = calm("catalog", "add", "our-glass", *GLASS)
    assert (again.code, again.out) == (2, "")
    assert "is defined already, in" in again.err
    assert (
        "where it overrides the entry of the catalogue"
        in calm("catalog", "add", "glass-17in", *GLASS).err
    )


@pytest.mark.parametrize(
    ("id", "figures", "said"),
    [
        ("Bad_Glass", GLASS, "did you mean `bad-glass`?"),
        ("glass", ("kind=sphere", "diameter"), "not KEY=VALUE: diameter"),
        ("glass", ("kind=spere", *GLASS[1:]), "did you mean `kind: sphere`?"),
        ("glass", (*GLASS[:2], "diametr=432 mm", "buoyancy=250"), "did you mean `diameter`?"),
        (
            "glass",
            (*GLASS[:3], "buoyancy=2500 N"),
            "has a buoyancy of 2.50 kN; water of the same volume weighs only 424 N",
        ),
        ("glass", GLASS[:4], "has no `source` for its values"),
    ],
)
def test_add_refuses_and_writes_nothing(calm, folder, id, figures, said):
    done = calm("catalog", "add", id, *figures, "-o", "mine.yaml")
    assert (done.code, done.out) == (2, "")
    assert said in done.err
    assert not (folder / "mine.yaml").exists()
