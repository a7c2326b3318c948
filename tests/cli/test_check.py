import json
import re

import pypdfium2
import pytest

pytestmark = pytest.mark.usefixtures("solved_once")

STORM = """\
name: storm
environment:
  current: {speed: 1.2 m/s, toward: 45 deg}
"""


@pytest.fixture
def storm(folder):
    for name in ("storm.yaml", "2.yaml"):
        (folder / name).write_text(STORM, encoding="utf-8")
    return "storm.yaml"


def findings(done, **wanted):
    return [
        finding
        for finding in json.loads(done.out)["findings"]
        if all(finding[name] == value for name, value in wanted.items())
    ]


def test_what_a_person_reads(calm, write_mooring):
    done = calm("check", write_mooring())
    assert done.code == 1
    assert done.err == ""
    lines = done.out.splitlines()
    assert lines[0].split() == ["Test", "sub-surface,", "100", "m", "of", "water"]
    assert lines[1].split()[:3] == ["INCOMPLETE", "6", "unknown,"]
    order = [
        "load case", "1  default environment", "0  still water", "case, where", "all other checks",
        "Open items", "Not covered: waves",
    ]  # fmt: skip
    places = [next(at for at, line in enumerate(lines) if text in line) for text in order]
    assert places == sorted(places)
    told = " ".join(done.out.split())
    assert "? weight: mass missing." not in told and "depth rating missing." in told
    assert max(map(len, lines)) <= 80 and len(lines) <= 40


def test_the_governing_finding_of_each_rule_is_marked_and_the_rest_thinned(calm, write_mooring):
    file = write_mooring()
    thin = json.loads(calm("check", file, "--json", "-").out)
    every = json.loads(calm("check", file, "--json", "-", "--all-findings").out)
    assert len(every["findings"]) == every["findings_in_all"] == thin["findings_in_all"]
    assert len(thin["findings"]) < len(every["findings"])
    listed = [json.dumps(one, sort_keys=True) for one in every["findings"]]
    assert all(json.dumps(one, sort_keys=True) in listed for one in thin["findings"])
    for rule in {one["rule"] for one in every["findings"]}:
        (lead,) = [one for one in thin["findings"] if one["rule"] == rule and one["governing"]]
        uses = [one["utilisation"] for one in every["findings"] if one["rule"] == rule]
        assert lead["utilisation"] == max((one for one in uses if one is not None), default=None)
    for one in thin["findings"]:
        if one["state"] == "pass" and not one["governing"]:
            assert one["utilisation"] >= 0.5
    assert every["verdict"] == thin["verdict"] == "incomplete"


def test_json_is_what_programs_read(calm, write_mooring):
    document = json.loads(calm("check", write_mooring(), "--json", "-").out)
    assert set(document) >= {"findings", "launch", "recovery", "backup", "situations"}
    for finding in document["findings"]:
        assert set(finding) >= {
            "mooring", "environment", "rule", "component", "value", "limit", "margin", "state",
            "remedy", "source",
        }  # fmt: skip
        assert finding["state"] in ("pass", "not-judged", "warn", "fail", "unknown")
    launch = document["launch"]["Test"]
    slow, fast = launch["fall_speed_band"]
    assert slow <= launch["fall_speed"] <= fast
    assert [part["index"] for part in launch["components"]] == [0, 1]
    assert launch["components"][1]["tension_bottom"] == pytest.approx(launch["anchor_tension"])
    assert document["recovery"]["Test"]["rise_speed"] > 0.0
    assert document["backup"]["Test"] == []


def test_values_are_those_of_calm_run(calm, write_mooring):
    file = write_mooring()
    run = json.loads(calm("run", file, "--json", "-").out)
    checked = calm("check", file, "--json", "-", "--all-findings")
    (anchor,) = findings(checked, rule="anchor-weight", situation="as given")
    assert anchor["limit"] == pytest.approx(run["anchor"]["required_weight"], rel=1e-12)
    strength = findings(checked, rule="strength", component="rope")
    # the greatest tension of a rope that weighs is at its top; 20 kN over 3, of a rope of no fibre
    assert strength[0]["value"] == pytest.approx(run["components"][1]["tension_top"], rel=1e-12)
    assert strength[0]["limit"] == pytest.approx(20_000.0 / 3.0)
    assert strength[0]["margin"] == pytest.approx(20_000.0 / 3.0 - strength[0]["value"])


def test_several_moorings_in_several_environments(calm, write_mooring, storm):
    calm_sea = "name: calm\nenvironment: {current: {speed: 0 m/s, toward: 0 deg}}\n"
    with open("calm.yaml", "w", encoding="utf-8") as file:
        file.write(calm_sea)
    one, two = write_mooring("one.yaml", name="One"), write_mooring("two.yaml", name="Two")
    words = ("check", one, two, "--environment", storm, "--environment", "calm.yaml")
    done = calm(*words, "--json", "-")
    places = {(f["mooring"], f["environment"]) for f in findings(done)}
    assert places == {(m, e) for m in ("One", "Two") for e in ("storm", "calm")}
    assert calm(*words, "--json", "-", "--workers", "2").out == done.out
    matrix = calm(*words).out.splitlines()
    assert matrix[0].startswith("DESIGN CHECK OF 2 MOORINGS IN 2 ENVIRONMENTS: ")
    assert matrix[2].split() == ["highest", "utilisation,", "%", "E1", "E2", "launch"]
    assert "E1 storm, E2 calm" in matrix
    for line in matrix[3:5]:
        assert re.fullmatch(r"(One|Two) +>?\d+[~!? ]? +>?\d+[~!? ]? +\d+[~!? ]?", line)


def test_named_environments_are_all_checked(calm, write_mooring, folder):
    file = folder / write_mooring()
    text = file.read_text() + "environments: {spring: {current: {speed: 1 m/s, toward: 0 deg}}}\n"
    file.write_text(text)
    done = calm("check", "m.yaml", "--json", "-")
    assert {f["environment"] for f in findings(done)} == {"own", "spring"}
    only = calm("check", "m.yaml", "--environment", "spring", "--json", "-")
    assert {f["environment"] for f in findings(only)} == {"spring"}


def test_two_moorings_of_one_name_are_told_apart(calm, write_mooring):
    done = calm("check", write_mooring("a.yaml"), write_mooring("b.yaml"), "--json", "-")
    assert {f["mooring"] for f in findings(done)} == {"Test (a.yaml)", "Test (b.yaml)"}


def test_one_that_does_not_stand_does_not_stop_the_rest(calm, write_mooring, heavy):
    done = calm("check", heavy, write_mooring(), "--json", "-")
    assert done.code == 3
    (failed,) = findings(done, mooring="Heavy", rule="equilibrium")
    assert failed["state"] == "fail" and failed["remedy"]
    assert json.loads(done.out)["launch"]["Heavy"] is None
    assert findings(done, mooring="Test", rule="anchor-weight")


@pytest.mark.parametrize("more", [2, 4], ids=["an environment each", "a mooring each"])
def test_processes_exchange_the_reason_why_one_does_not_stand(
    calm, write_mooring, heavy, storm, folder, more
):
    """Few moorings are divided among the processes by environment, many by mooring."""
    (folder / "gale.yaml").write_text(STORM.replace("storm", "gale"), encoding="utf-8")
    others = [write_mooring(f"{number}.yaml", name=f"M{number}") for number in range(more)]
    places = ("--environment", storm, "--environment", "gale.yaml") if more == 2 else ()
    words = ("check", heavy, *others, *places, "--json", "-")
    alone, together = (calm(*words, "--workers", count) for count in (1, 2))
    assert together.code == alone.code == 3
    assert together.out == alone.out


def test_a_sound_design_ends_with_0(calm, folder):
    (folder / "sound.yaml").write_text(
        """\
name: Sound
environment: {depth: 200 m, current: {speed: 0.3 m/s, toward: 90 deg}}
line:
  - {use: ball, label: top float}
  - {use: rope, length: 100 m}
  - {use: ball, label: back-up float}
  - {use: link}
  - {use: hook, label: release pair}
  - {use: rope, length: 5 m}
  - {use: weight}
components:
  link: {kind: body, role: connector, length: 0 m, buoyancy: -5 N, kn: 0 N/(m/s)^2,
         inclination: insensitive, working_load: 20 kN}
  ball: {kind: sphere, role: float, diameter: 0.8 m, buoyancy: 1200 N, depth_rating: 1000 m,
         breaking_load: 100 kN}
  rope: {kind: cable, diameter: 10 mm, weight: 0.2 N/m, breaking_load: 60 kN}
  hook: {kind: cylinder, role: release, diameter: 0.1 m, length: 0.8 m, buoyancy: -200 N,
         depth_rating: 1000 m, max_tilt: 45 deg, breaking_load: 60 kN}
  weight: {kind: anchor, weight: 8000 N, kt: 900 N/(m/s)^2, breaking_load: 100 kN}
"""
    )
    done = calm("check", "sound.yaml", "--json", "-")
    assert done.code == 0
    assert json.loads(done.out)["state"] == "pass"
    # `planned-depth` has nothing to judge by
    assert {finding["state"] for finding in findings(done)} == {"pass", "not-judged"}
    assert len({finding["rule"] for finding in findings(done)}) == 17


def test_what_is_unknown_ends_with_1_unless_it_is_allowed(calm, write_mooring, heavy):
    file = write_mooring()
    done = calm("check", file, "--json", "-")
    assert (done.code, json.loads(done.out)["state"]) == (1, "unknown")
    allowed = calm("check", file, "--json", "-", "--allow-unknown")
    assert (allowed.code, allowed.out) == (0, done.out)  # it changes the exit code only
    # a failure stays 1, and no equilibrium 3
    strict = file_with(file, "strict.yaml", "checks: {maximum_knockdown: 1 mm}\n")
    failed = calm("check", strict, "--json", "-", "--allow-unknown")
    assert (failed.code, json.loads(failed.out)["state"]) == (1, "fail")
    for words in ((heavy,), (heavy, file), (heavy, strict)):
        assert calm("check", *words, "--allow-unknown").code == 3


def test_no_load_is_asked_of_what_is_pulled_at_one_end(calm, write_mooring, folder):
    def strengths(text):
        (folder / "m.yaml").write_text(text, encoding="utf-8")
        found = findings(calm("check", "m.yaml", "--json", "-", "--all-findings"))
        asked = {
            label: "unknown"
            for f in found
            if f["rule"] == "missing" and "strength" in f["needed_by"]
            for label in f["pieces"]
        }
        return asked | {f["component"]: f["state"] for f in found if f["rule"] == "strength"}

    text = (folder / write_mooring()).read_text(encoding="utf-8")
    assert strengths(text) == {"rope": "pass"}
    weak = text.replace("max_tilt: 80 deg", "max_tilt: 80 deg, working_load: 100 N")
    assert strengths(weak) == {"top float": "fail", "rope": "pass"}
    between = text.replace("  - {use: weight}", "  - {use: ball, label: lower}\n  - {use: weight}")
    assert strengths(between) == {"rope": "pass", "lower": "unknown"}


def test_the_verdict_counts_each_figure_of_each_mooring_once(calm, write_mooring):
    one, two = write_mooring("one.yaml", name="One"), write_mooring("two.yaml", name="Two")

    def verdict(*files):
        done = calm("check", *files, "--json", "-")
        unknown = {
            (f["mooring"], f["rule"], f["component"], f.get("quantity"))
            for f in findings(done, state="unknown")
        }
        out = calm("check", *files).out
        heads = (f"{len(unknown)} unknown", "NOTHING FAILS, 2 INCOMPLETE")
        assert heads[len(files) - 1] in out
        return len(unknown)

    assert verdict(one, two) == 2 * verdict(one) > 0


def file_with(file, name, addition):
    with open(file, encoding="utf-8") as read, open(name, "w", encoding="utf-8") as written:
        written.write(read.read() + addition)
    return name


def test_a_tow_is_refused(calm, folder):
    text = "tow: {speed: 1 m/s, toward: 0 deg}\nline: [{use: fish}]\ncomponents:\n"
    text += "  fish: {kind: sphere, diameter: 1 m, buoyancy: -10 N}\n"
    (folder / "tow.yaml").write_text(text)
    done = calm("check", "tow.yaml")
    assert (done.code, done.out) == (2, "")
    assert "calm check is only for moorings; these are tows: tow.yaml" in done.err


def test_moorings_among_tows_are_judged(calm, folder, write_mooring):
    text = "tow: {speed: 1 m/s, toward: 0 deg}\nline: [{use: fish}]\ncomponents:\n"
    text += "  fish: {kind: sphere, diameter: 1 m, buoyancy: -10 N}\n"
    for name in ("a.yaml", "z.yaml"):
        (folder / name).write_text(text)
    alone = calm("check", write_mooring(), "--json", "-")
    among = calm("check", "a.yaml", "m.yaml", "z.yaml", "--json", "-")
    assert (among.code, among.out) == (alone.code, alone.out)
    assert among.err == "tows are not checked: a.yaml, z.yaml\n"
    # a mistake in a mooring is not hidden by a tow beside it
    (folder / "bad.yaml").write_text("line: 5\n")
    assert calm("check", "a.yaml", "bad.yaml").code == 2


@pytest.mark.parametrize(
    ("words", "says"),
    [
        (("m.yaml", "m.yaml"), "given twice: m.yaml"),
        (("m.yaml", "--workers", "0"), "--workers: 0 is below 1"),
        (("m.yaml", "--environment", "strom"), "m.yaml: the file has no named environments"),
        (("m.yaml", "--environment", "storm.yaml", "--environment", "storm.yaml"), "twice"),
        (("m.yaml", "--environment", "storm.yaml", "--environment", "2.yaml"), "named storm"),
        (("m.yaml", "broken.yaml"), "broken.yaml:4:"),
        (("m.yaml", "--report", "m.yaml"), "the output must be a folder, but"),
        (("m.yaml", "--json", "none/x.json"), "there is no folder"),
        (("missing.yaml",), "missing.yaml"),
        ((), "FILE"),
    ],
)
def test_bad_input_is_told_and_nothing_is_solved(calm, write_mooring, storm, broken, words, says):
    write_mooring()
    done = calm("check", *words)
    assert (done.code, done.out) == (2, "")
    assert says in done.err
    assert "Traceback" not in done.err


def test_a_report_is_a_folder_of_five_files_the_same_every_time(calm, write_mooring, folder, storm):
    words = ("check", write_mooring(), "--environment", storm)
    first = calm(*words, "--report", "first", "--allow-unknown")
    assert first.code == 0
    assert "Report written to first" in first.err
    again = calm(*words, "--report", "deep/er", "--workers", "2", "--json", "-")
    names = ["checks.csv", "inventory.csv", "report.html", "report.json", "report.pdf"]
    for where in ("first", "deep/er"):
        assert sorted(path.name for path in (folder / where).iterdir()) == names
    for name in names:
        content = (folder / "first" / name).read_bytes()
        assert content == (folder / "deep/er" / name).read_bytes(), name
    assert (folder / "first/report.json").read_text() == again.out
    assert (folder / "first/report.pdf").read_bytes().startswith(b"%PDF")


def test_full_writes_the_pages_of_each_mooring_too(calm, write_mooring, folder):
    text = (folder / write_mooring("north.yaml")).read_text(encoding="utf-8")
    (folder / "north.yaml").write_text(text.replace("name: Test", "name: North"), encoding="utf-8")
    files = ("north.yaml", write_mooring("south.yaml"))
    done = calm("check", *files, "--report", "r", "--full", "--page", "letter")
    assert "Report written to r" in done.err
    for name, pages in (("report", 3), ("North", 3), ("Test", 3)):
        with pypdfium2.PdfDocument(folder / "r" / f"{name}.pdf") as pdf:
            assert len(pdf) == pages
            assert pdf[0].get_size() == pytest.approx((612.0, 792.0), abs=0.1)
    refused = calm("check", *files, "--full")
    assert refused.code == 2 and "--full needs --report" in refused.err


def test_a_report_that_cannot_be_written_loses_nothing_else(
    calm, write_mooring, folder, monkeypatch
):
    import errno
    from pathlib import Path

    write = Path.write_bytes

    def full(path, content):
        if "report.pdf" in path.name:
            raise OSError(errno.ENOSPC, "No space left on device")
        return write(path, content)

    monkeypatch.setattr(Path, "write_bytes", full)
    done = calm("check", write_mooring(), "--report", "cruise", "--json", "all.json")
    assert done.code == 2
    assert "cannot write cruise/report.pdf: No space left on device" in done.err
    assert done.out.startswith("Test")
    assert json.loads((folder / "all.json").read_text())["findings"]
    assert not (folder / "cruise").exists()


def test_a_failure_of_calm_itself_does_not_stop_the_rest(calm, write_mooring, monkeypatch):
    from calm.checks import design_check

    environments_checked = design_check.environments_checked

    def failing(mooring, name, day):
        if name == "Two":
            raise ValueError("a bug")
        return environments_checked(mooring, name, day)

    monkeypatch.setattr(design_check, "environments_checked", failing)
    files = write_mooring("one.yaml", name="One"), write_mooring("two.yaml", name="Two")
    done = calm("check", *files, "--json", "-")
    assert done.code == 3
    (failed,) = findings(done, mooring="Two", rule="equilibrium")
    assert failed["message"] == "internal-error: CALM failed (ValueError: a bug)."
    assert findings(done, mooring="One", rule="anchor-weight")


def test_one_line_as_a_page_and_as_pages(calm, write_mooring, folder):
    done = calm("run", write_mooring(), "-o", "m.html", "-o", "m.pdf")
    assert done.code == 0
    assert "<svg" in (folder / "m.html").read_text()
    assert (folder / "m.pdf").read_bytes().startswith(b"%PDF")
    refused = calm("run", "m.yaml", "-o", "m.htm")
    assert refused.code == 2
    assert "cannot write m.htm: its name must end in" in refused.err


def test_a_report_does_not_take_the_place_of_what_is_read(calm, write_mooring, folder):
    write_mooring("report.json")
    before = (folder / "report.json").read_bytes()
    done = calm("check", "report.json", "--report", ".")
    assert (done.code, done.out) == (2, "")
    assert "report.json is an input file; the report would overwrite it" in done.err
    assert (folder / "report.json").read_bytes() == before
    done = calm("check", write_mooring(), "--report", "r", "--json", "r/report.json")
    assert done.code == 2


def test_names_are_told_apart_whatever_they_are(calm, write_mooring):
    files = [
        write_mooring("a.yaml", name="M"),
        write_mooring("b.yaml", name="M"),
        write_mooring("c.yaml", name="M (a.yaml)"),
    ]
    found = findings(calm("check", *files, "--json", "-"), rule="anchor-weight")
    assert len({finding["mooring"] for finding in found}) == 3


def test_what_is_cut_to_fit_is_cut_once_for_all_environments(calm, write_mooring, folder):
    file = folder / write_mooring()
    text = file.read_text().replace("length: 60 m,", "length: fit, top_depth: 30 m,")
    file.write_text(text + "environments: {deep: {depth: 120 m}}\n")
    document = json.loads(calm("check", "m.yaml", "--json", "-").out)
    top = {
        (one["environment"], one["situation"]): one["top_depth"]
        for one in document["situations"]["Test"]
    }
    # one rope in 20 m more of water: its top is 20 m deeper; depths are closed to 1e-7 of 120 m
    assert top["deep", "still water"] == pytest.approx(top["own", "still water"] + 20.0, abs=1e-4)


def test_names_move_no_cursor_and_are_no_formula(calm, write_mooring, folder):
    file = folder / write_mooring()
    file.write_text(file.read_text().replace("label: top float", r'label: "=cmd|\e[31m\u202e"'))
    for words in (("check", "m.yaml"), ("run", "m.yaml"), ("run", "m.yaml", "-o", "m.csv")):
        out = calm(*words).out
        assert "\x1b" not in out and "\u202e" not in out
    assert ",'=cmd|\ufffd[31m\ufffd," in (folder / "m.csv").read_text(encoding="utf-8")


def limits(document):
    return {one["name"]: one for one in document["limits"]}


def test_limits_are_told_as_used_with_default_and_source(calm, write_mooring):
    file = write_mooring()
    plain = limits(json.loads(calm("check", file, "--json", "-").out))
    assert plain["safety_factor.steel"] == {
        "mooring": "Test", "name": "safety_factor.steel", "value": 3.0, "default": 3.0,
        "source": "UFC 4-159-03, table 3-7: a factor of 3 on the breaking strength of new chain "
        "and wire",
        "departs": False,
    }  # fmt: skip
    assert not any(one["departs"] for one in plain.values())
    assert (plain["minimum_top_depth"]["value"], plain["minimum_top_depth"]["default"]) == (10, 10)
    assert "maximum_knockdown" not in plain  # which is not judged
    own = "checks: {safety_factor: {steel: 1.2}, maximum_knockdown: 9 m, minimum_top_depth: 10 m}\n"
    document = json.loads(calm("check", file_with(file, "own.yaml", own), "--json", "-").out)
    used = limits(document)
    assert [name for name, one in used.items() if one["departs"]] == ["safety_factor.steel"]
    assert (used["safety_factor.steel"]["value"], used["safety_factor.steel"]["default"]) == (
        1.2,
        3,
    )
    assert (used["maximum_knockdown"]["value"], used["maximum_knockdown"]["default"]) == (9.0, None)
    cited = {(f["rule"], f["component"]): f["source"] for f in document["findings"]}
    assert cited["strength", "rope"] == ("The design's own `safety_factor.steel`, 1.2 instead of 3")
    assert "UFC" not in cited["strength", "rope"]


@pytest.mark.parametrize(
    ("checks", "rule", "name"),
    [
        ("{anchor_factor: 1}", "anchor-weight", "anchor_factor"),
        ("{anchor_factor: 1}", "anchor-uplift", "anchor_factor"),
        ("{anchor_friction: 0.9}", "anchor-sliding", "anchor_friction"),
        ("{minimum_tension: {wire: 1 N}}", "slack", "minimum_tension.wire"),
        ("{minimum_top_depth: 1 m}", "top-depth", "minimum_top_depth"),
        ("{minimum_rise_speed: 0.1 m/s}", "recovery", "minimum_rise_speed"),
        ("{launch_safety_factor: 1.1}", "launch-strength", "launch_safety_factor"),
    ],
)
def test_who_departs_from_a_default_cites_nobody_for_it(calm, write_mooring, checks, rule, name):
    file = write_mooring()
    document = json.loads(
        calm("check", file_with(file, "own.yaml", f"checks: {checks}\n"), "--json", "-").out
    )
    (departing,) = (one for one in document["limits"] if one["departs"])
    assert departing["name"] == name
    sources = {f["source"] for f in document["findings"] if f["rule"] == rule and f["limit"]}
    assert all(source.startswith(f"The design's own `{name}`") for source in sources), sources
    assert sources


def test_an_anchor_that_clings_departs_from_the_default(calm, write_mooring, folder):
    file = write_mooring()
    text = (folder / file).read_text().replace("weight: 5000 N", "weight: 5000 N, friction: 3")
    (folder / file).write_text(text)
    document = json.loads(calm("check", file, "--json", "-").out)
    used = limits(document)["anchor_friction"]
    assert (used["value"], used["default"], used["departs"]) == (3.0, 0.6, True)
    (finding,) = (f for f in document["findings"] if f["rule"] == "anchor-sliding")
    assert finding["source"] == "The design's own `anchor_friction`, 3 instead of 0.6"
