"""`calm check --missing`: the block of missing figures, and what completing it does."""

import json
import re

import pytest
import yaml

pytestmark = pytest.mark.usefixtures("solved_once")

LINE = """\
name: Completed
environment:
  depth: 300 m
  current: {speed: 0.4 m/s, toward: 90 deg}
line:
  - {use: sphere-steel-1250, label: float}
  - use: wire-jacketed-8
    length: 80 m
    clamps:
      - {use: sbe56-uwa, at: 10 m}
      - {use: sbe56-uwa, at: 20 m}
  - {use: link, count: 2}
  - {use: wire-jacketed-8, length: 40 m}
  - {use: anchor-wheels-4}
"""
OWN = """\
  link: {kind: body, role: connector, length: 0.1 m, buoyancy: -5 N, kn: 1 N/(m/s)^2,
         inclination: insensitive, estimate: {quantity: working_load, value: 9 kN, low: 10 N,
         source: its chain}}
"""
SPACER = """\
  spacer: {kind: body, role: connector, length: 0.1 m, buoyancy: -5 N, kn: 1 N/(m/s)^2,
           inclination: insensitive, working_load: 30 kN}
"""
CABLE = "{}: {{kind: cable, diameter: 8 mm, cn: 1.3, weight: 1.5 N/m, stiffness: 4 MN}}"
CATALOGUE = """\
sbe56-uwa: {kind: body, role: instrument, length: 0.2 m, buoyancy: -2 N, kn: 1 N/(m/s)^2,
            inclination: insensitive, max_tilt: 90 deg, source: a list}
"""


@pytest.fixture
def unknowns(folder):
    (folder / "own.yaml").write_text(CATALOGUE, encoding="utf-8")
    (folder / "m.yaml").write_text(f"{LINE}components:\n{OWN}", encoding="utf-8")
    return "m.yaml", "--catalog", "own.yaml"


def test_a_file_that_defines_other_components_takes_all_entries(calm, folder):
    (folder / "own.yaml").write_text(CATALOGUE + OWN.replace("  link", "link"), encoding="utf-8")
    (folder / "m.yaml").write_text(f"{LINE}components:\n{SPACER}", encoding="utf-8")
    done = calm("check", "m.yaml", "--catalog", "own.yaml", "--missing")
    assert "# Copy these entries into the section `components:`, line 15 of m.yaml.\n" in done.out


def test_the_block_names_each_component_once_with_its_keys_and_estimate(calm, unknowns):
    done = calm("check", *unknowns, "--missing")
    assert done.code == 1
    block = yaml.safe_load(done.out)
    assert block["sbe56-uwa"] == {"depth_rating": None}
    assert block["link"] == {"working_load": None}
    assert "Copy the other entries into the section `components:`, line 15 of m.yaml.\n" in done.out
    assert "  sbe56-uwa:  # sbe56-uwa 1 and 2\n" in done.out
    assert "  link:  # link 1 and 2; defined in line 16 of m.yaml\n" in done.out
    assert (
        "    depth_rating:  # e.g. 2000 m: maximum depth of use\n      # needed for depth rating\n"
    ) in done.out
    assert "working_load:  # e.g. 20 kN: maximum load in use, or `breaking_load`" in done.out
    assert "is estimated: at least 10 N, probably 9.00 kN (its chain)\n" in done.out


def test_a_file_without_components_gets_a_whole_section(calm, folder):
    text = LINE.replace("  - {use: link, count: 2}\n", "").replace("sbe56-uwa", "release-rt161")
    (folder / "m.yaml").write_text(text, encoding="utf-8")
    block = yaml.safe_load(calm("check", "m.yaml", "--missing").out)
    assert block == {"components": {"release-rt161": {"depth_rating": None}}}


def test_screen_json_and_block_count_the_same_figures(calm, folder):
    text = f"""\
name: Alike
environment: {{depth: 300 m, current: {{speed: 0.2 m/s, toward: 90 deg}}}}
line:
  - {{use: float}}
  - {{use: wire, length: 40 m}}
  - {{use: cord, length: 40 m}}
  - {{use: release-ar861}}
  - {{use: anchor}}
components:
  float: {{kind: sphere, role: float, diameter: 1 m, buoyancy: 3 kN}}
  {CABLE.format("wire")}
  {CABLE.format("cord")}
  anchor: {{kind: anchor, weight: 9 kN}}
"""
    (folder / "m.yaml").write_text(text, encoding="utf-8")
    done = calm("check", "m.yaml", "--json", "all.json")
    written = json.loads((folder / "all.json").read_text(encoding="utf-8"))
    block = yaml.safe_load(calm("check", "m.yaml", "--missing").out)
    count = sum(map(len, block.values()))
    assert {id for id, keys in block.items() if "breaking_load" in keys} == {"wire", "cord"}
    assert f" {count} unknown" in done.out
    assert sum(one["state"] == "unknown" for one in written["findings"]) == count
    assert written["key_figures"]["Alike"]["counts"]["unknown"] == count
    for id, keys in block.items():
        assert all(f"{id}: {key.replace('_', ' ')}" in done.out for key in keys)


def test_a_completed_block_in_the_file_settles_what_it_gives(calm, unknowns, folder):
    assert calm("check", *unknowns, "--missing", "-o", "block.yaml").out == ""
    block = (folder / "block.yaml").read_text(encoding="utf-8")
    given = re.sub(r"( +depth_rating):", r"\1: 500 m", block)
    # the file defines `link` itself
    pasted = re.sub(r"  link:.*?\n(?=  \S|\Z)", "", given, flags=re.DOTALL)
    (folder / "m.yaml").write_text(f"{LINE}components:\n{pasted}\n{OWN}", encoding="utf-8")
    done = calm("check", *unknowns, "--json", "-")
    assert "hides" not in done.err
    found = json.loads(done.out)["findings"]
    asked = {f["component_id"] for f in found if f["rule"] == "missing"}
    assert "sbe56-uwa" not in asked
    assert "link" in asked
    rated = {f["component"]: f["limit"] for f in found if f["rule"] == "depth-rating"}
    assert rated["sbe56-uwa 2"] == pytest.approx(400.0)


def test_a_key_without_a_value_stays_unknown(calm, unknowns, folder):
    own = OWN.replace("{kind: body,", "{breaking_load: , kind: body,")
    empty = f"{LINE}components:\n  sbe56-uwa: {{depth_rating: }}\n{own}"
    (folder / "m.yaml").write_text(empty, encoding="utf-8")
    block = yaml.safe_load(calm("check", *unknowns, "--missing").out)
    assert block["sbe56-uwa"] == {"depth_rating": None}
    assert block["link"] == {"working_load": None}


def test_optional_values_are_listed_as_comments(calm, folder):
    line = LINE.replace("  - {use: link, count: 2}\n", "  - {use: swivel-13}\n  - {use: spacer}\n")
    (folder / "m.yaml").write_text(
        f"{line.replace('sbe56-uwa', 'sbe37')}components:\n{SPACER}", encoding="utf-8"
    )
    done = calm("check", "m.yaml", "--missing", "-o", "block.yaml")
    assert done.err.rstrip().endswith("block.yaml written; it contains only comments")
    block = (folder / "block.yaml").read_text(encoding="utf-8")
    assert block.startswith("# All values that the checks need are known.\n")
    assert "#   swivel-13:\n#     working_load:  # estimated: at least 9.81 kN\n" in block
    assert "#   spacer:\n#     mass:  # in air; the total mass is a lower bound" in block
    assert "#   sbe37:  # sbe37 1 and 2\n#     grip:  # without it, clamp grip is not" in block
    assert yaml.safe_load(block) is None
    uncommented = "".join(f"{line[2:]}\n" for line in block.splitlines() if line.startswith("#   "))
    assert yaml.safe_load(uncommented)["spacer"] == {"mass": None}


def test_a_missing_value_is_not_also_optional(calm, folder):
    """An estimate that suffices for the strength, but not in the launch."""
    text = LINE.replace("  - {use: link, count: 2}\n", "  - {use: rcm11, label: meter}\n")
    (folder / "m.yaml").write_text(text.replace("sbe56-uwa", "sbe37"), encoding="utf-8")
    block = calm("check", "m.yaml", "--missing").out
    assert yaml.safe_load(block) == {"components": {"rcm11": {"working_load": None}}}
    assert block.count("working_load:") == 1
    assert "#   rcm11:  # meter\n#     mass:" in block
    shown = calm("check", "m.yaml").out
    assert "? rcm11: estimated working load too low" in shown
    assert "Meter: passes with an estimated value" not in shown


@pytest.mark.parametrize(
    ("words", "says"),
    [
        (("-o", "x.yaml"), "-o can only be used with --missing"),
        (("--missing", "--json", "-"), "--missing replaces the findings"),
        (("--missing", "-o", "m.yaml"), "m.yaml is the input file; choose another output"),
    ],
)
def test_what_cannot_be_is_refused_before_anything_is_solved(calm, unknowns, words, says):
    done = calm("check", *unknowns, *words)
    assert done.code == 2
    assert says in done.err


def test_without_equilibrium_no_figure_is_known_to_be_missing(calm, unknowns, folder):
    text = (folder / "m.yaml").read_text(encoding="utf-8")
    sunk = text.replace("count: 2", "count: 4000")
    (folder / "m.yaml").write_text(sunk, encoding="utf-8")
    done = calm("check", *unknowns, "--missing", "-o", "block.yaml")
    assert done.code == 3
    assert "buoyancy" in done.err  # why there is none
    assert "block.yaml written" in done.err
    block = (folder / "block.yaml").read_text(encoding="utf-8")
    assert block.startswith("# The mooring has no equilibrium")
