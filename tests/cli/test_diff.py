import json
import re

import pytest

EXTRA = """\
document: {id: M-17, revision: A}
deployed:
  date: 2027-03-02
  depth: 104 m
  items: [{label: rope, length: 58 m, remark: remade}, {label: logger, serial: 12}]
"""


@pytest.fixture
def two(write_mooring, folder):
    """A design, and one changed in five ways."""
    write_mooring("a.yaml")
    text = (folder / "a.yaml").read_text()
    for old, new in (
        ("depth: 100 m", "depth: 105 m"),
        ("length: 60 m", "length: 65 m"),
        ("at: 10 m}", "at: 12 m, label: upper}, {use: logger, at: 50 m, label: lower}"),
        ("  - {use: weight}", "  - {use: rope, length: 5 m, label: tail}\n  - {use: weight}"),
        ("buoyancy: 2000 N", "buoyancy: 2100 N"),
    ):
        assert text.count(old) == 1
        text = text.replace(old, new)
    (folder / "b.yaml").write_text(text)
    return "a.yaml", "b.yaml"


def test_what_changed(calm, two):
    done = calm("diff", *two, "--json", "-")
    assert done.code == 0
    document = json.loads(done.out)
    assert document["changed"] == [
        {"where": "environment.depth", "from": 100.0, "to": 105.0},
        {"where": "top float.buoyancy", "from": 2000.0, "to": 2100.0},
        {"where": "rope.length", "from": 60.0, "to": 65.0},
        {"where": "logger.label", "from": "logger", "to": "upper"},
        {"where": "logger.at", "from": 10.0, "to": 12.0},
    ]
    assert (document["added"], document["removed"]) == (["tail", "lower"], [])


def test_a_utilisation_without_any_capacity_is_said(calm, two, folder):
    heavy = (folder / "b.yaml").read_text().replace("buoyancy: 2100 N", "buoyancy: 4500 N")
    (folder / "b.yaml").write_text(heavy)
    done = calm("diff", *two)
    assert re.search(r"utilisation: Anchor sliding +[\d.]+. +none left! +-\n", done.out)


def test_what_it_does_is_what_each_run_says(calm, two):
    figures = {
        one["name"]: (one["from"], one["to"])
        for one in json.loads(calm("diff", *two, "--json", "-").out)["figures"]
    }
    before, after = (json.loads(calm("run", file, "--json", "-").out) for file in two)
    for name, part, key in (
        ("top.depth", "top", "depth"),
        ("top.knockdown", "top", "knockdown"),
        ("anchor.tension", "anchor", "tension"),
        ("anchor.required_weight", "anchor", "required_weight"),
    ):
        assert figures[name] == (before[part][key], after[part][key])
    assert figures["rope.cut_length"] == (60.0, 65.0)
    assert figures["logger.depth"] == (before["clamps"][0]["depth"], after["clamps"][0]["depth"])
    greatest = [max(max(c["tension_top"], c["tension_bottom"]) for c in each["components"])
                for each in (before, after)]  # fmt: skip
    assert figures["greatest_tension"] == pytest.approx(greatest)


def test_a_utilisation_is_the_greatest_of_any_situation(calm, two):
    figures = json.loads(calm("diff", *two, "--json", "-").out)["figures"]
    (use,) = [one for one in figures if one["name"] == "utilisation.anchor-weight"]
    checked = [json.loads(calm("check", file, "--json", "-").out) for file in two]
    most = [
        max(one["utilisation"] for one in found["findings"] if one["rule"] == "anchor-weight")
        for found in checked
    ]
    assert [use["from"], use["to"]] == pytest.approx(most)


def test_the_table(calm, two):
    out = calm("diff", *two).out
    assert out.splitlines()[0] == "a.yaml → b.yaml"
    assert "changed  rope.length         60 m    65 m" in out
    assert "added    tail" in out
    for words in ("Results", "knockdown of the top", "Governing checks", "+5.00"):
        assert words in out
    assert max(map(len, out.splitlines())) <= 80


def test_named_environments_are_compared(calm, write_mooring, folder):
    names = write_mooring("a.yaml"), write_mooring("b.yaml")
    for name, speed in zip(names, ("0.8 m/s", "0.9 m/s"), strict=True):
        with (folder / name).open("a") as text:
            text.write(f"environments: {{storm: {{current: {{speed: {speed}, toward: 0}}}}}}\n")
    document = json.loads(calm("diff", *names, "--json", "-").out)
    assert document["changed"] == [
        {
            "where": "environments.storm.current",
            "from": "speed: 0.8 m/s, toward: 0",
            "to": "speed: 0.9 m/s, toward: 0",
        }
    ]


def test_nothing_differs(calm, write_mooring):
    done = calm("diff", write_mooring("a.yaml"), write_mooring("b.yaml"))
    assert done.code == 0
    assert "The designs are identical." in done.out


def test_the_design_and_what_was_deployed(calm, write_mooring, folder):
    file = write_mooring()
    with (folder / file).open("a") as text:
        text.write(EXTRA)
    document = json.loads(calm("diff", file, "--json", "-").out)
    assert document["names"] == ["design", "deployed"]
    assert document["changed"] == [
        {"where": "environment.depth", "from": 100.0, "to": 104.0},
        {"where": "rope.length", "from": 60.0, "to": 58.0},
        {"where": "logger.serial", "from": None, "to": "12"},
    ]
    figures = {one["name"]: one for one in document["figures"]}
    # 2 m less rope in 4 m more water: 6 m deeper, as the line hardly leans
    assert figures["top.depth"]["to"] - figures["top.depth"]["from"] == pytest.approx(6.0, abs=0.1)


def test_a_design_that_does_not_stand_is_compared(calm, write_mooring, heavy):
    done = calm("diff", write_mooring(), heavy)
    assert done.code == 0
    assert "has no equilibrium" in done.out
    assert "top float.buoyancy" in done.out
    figures = json.loads(calm("diff", "m.yaml", heavy, "--json", "-").out)["figures"]
    depth = next(one for one in figures if one["name"] == "top.depth")
    assert depth["from"] > 0.0 and depth["to"] is None


def test_the_mistakes_of_both_files_at_once(calm, broken, write_mooring, folder):
    text = (folder / write_mooring("other.yaml")).read_text().replace("name:", "nam:")
    (folder / "other.yaml").write_text(text)
    done = calm("diff", broken, "other.yaml")
    assert done.code == 2
    assert done.out == ""
    assert done.err.count("broken.yaml:") == 2
    assert "other.yaml:1:1: unknown key `nam`; did you mean `name`?" in done.err


@pytest.mark.parametrize(
    ("words", "complaint"),
    [
        (("m.yaml",), "m.yaml has no `deployed:` section to compare with its design"),
        (("m.yaml", "tow.yaml"), "a mooring cannot be compared with a tow"),
        (("tow.yaml",), "tow.yaml is a tow; name a second tow to compare it with"),
        (("m.yaml", "none.yaml"), "none.yaml"),
    ],
)
def test_usage(calm, write_mooring, folder, words, complaint):
    write_mooring()
    (folder / "tow.yaml").write_text(
        "tow: {speed: 2 m/s, toward: 0}\n"
        "line:\n  - {use: rope, length: 50 m}\n  - {use: fish}\n"
        "components:\n  rope: {kind: cable, diameter: 10 mm, weight: 2 N/m}\n"
        "  fish: {kind: body, length: 1 m, buoyancy: -900 N, drag_area: 0.1 m^2, cd: 1}\n"
    )
    done = calm("diff", *words)
    assert (done.code, done.out) == (2, "")
    assert complaint in done.err


def test_the_report_prints_the_document_and_the_differences(calm, two, folder):
    with (folder / "b.yaml").open("a") as text:
        text.write("document: {id: M-17, history: [{revision: B, change: deeper}]}\n")
    done = calm("check", "b.yaml", "--report", "out", "--against", "a.yaml", "--allow-unknown")
    page = (folder / "out" / "report.html").read_text()
    for words in ("M-17", "deeper", "a.yaml → b.yaml", "environment.depth", "105 m"):
        assert words in page
    assert json.loads((folder / "out" / "report.json").read_text())["document"] == {
        "Test": {"id": "M-17", "history": [{"revision": "B", "change": "deeper"}]}
    }
    assert done.code in (0, 1)


def test_against_needs_a_report_of_one_mooring(calm, two):
    for words in (("b.yaml",), (*two, "--report", "out")):
        done = calm("check", *words, "--against", "a.yaml")
        assert done.code == 2
        assert "--against needs --report and exactly one mooring" in done.err
