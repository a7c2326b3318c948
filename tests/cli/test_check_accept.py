"""What a design accepts of its findings: what it covers, until when, and what is no accept."""

import json

import pytest

DAY = "1798675200"  # 2026-12-31

pytestmark = pytest.mark.usefixtures("solved_once")


@pytest.fixture(autouse=True)
def on_a_day(monkeypatch):
    monkeypatch.setenv("SOURCE_DATE_EPOCH", DAY)


@pytest.fixture
def accepting(write_mooring, folder):
    """A mooring that accepts; its line begins with labels of every kind."""

    def write(*accepts, more="", labels=("top float",), **figures):
        file = folder / write_mooring("accepting.yaml", **figures)
        text = file.read_text(encoding="utf-8")
        balls = "".join(f"  - {{use: ball, label: {json.dumps(label)}}}\n" for label in labels)
        # the top piece is asked for no load
        crown = "  - {use: ball, label: crown, diameter: 10 mm, buoyancy: 0.001 N}\n"
        text = text.replace("  - {use: ball, label: top float}\n", crown + balls)
        items = "".join(f"    - {accept}\n" for accept in accepts)
        file.write_text(f"{text}checks:\n{more}  accept:\n{items}", encoding="utf-8")
        return "accepting.yaml"

    return write


def checked(calm, file):
    done = calm("check", file, "--json", "-")
    document = json.loads(done.out)
    states = {}
    for finding in document["findings"]:
        states.setdefault((finding["rule"], finding["component"]), []).append(finding["state"])
    for finding in document["findings"]:
        for rule in finding.get("needed_by", ()):  # of one missing figure
            for label in finding["pieces"]:
                states.setdefault((rule, label), [finding["state"]])
    return done, document, states


def test_a_failure_and_an_unknown_are_accepted_with_a_reason(calm, accepting):
    file = accepting(
        "{rule: strength, component: top float, reason: proof loaded to 20 kN, by: A. Nonymous,"
        " date: 2026-11-22}",
        "{rule: knockdown, reason: the site is deep enough}",
        more="  maximum_knockdown: 1 mm\n",
    )
    done, document, states = checked(calm, file)
    assert set(states["strength", "top float"]) == {"accepted"}
    assert set(states["depth-rating", "top float"]) == {"unknown"}
    assert set(states["knockdown", "crown"]) == {"accepted"}
    assert (done.code, document["state"]) == (1, "unknown")
    by_rule = {one["rule"]: one for one in document["accepted"]}
    assert by_rule["strength"] == {
        "mooring": "Test", "rule": "strength", "component": "top float",
        "reason": "proof loaded to 20 kN", "by": "A. Nonymous", "date": "2026-11-22", "until": None,
        "load": None,
    }  # fmt: skip
    assert by_rule["knockdown"]["by"] is None
    reasons = {f["reason"] for f in document["findings"] if f["state"] == "accepted"}
    assert reasons == {"proof loaded to 20 kN", "the site is deep enough"}


def test_what_is_all_accepted_ends_with_0_and_reads_pass(calm, accepting):
    done, document, _ = checked(calm, accepting("{rule: scope, reason: none}"))
    rules = {f["rule"] for f in document["findings"] if f["state"] == "unknown"}
    file = accepting(*(f"{{rule: {rule}, reason: a test}}" for rule in sorted(rules)))
    done, document, _ = checked(calm, file)
    assert done.code == 0
    assert document["state"] in ("pass", "warn")
    assert {f["state"] for f in document["findings"]} >= {"accepted", "pass"}


@pytest.mark.parametrize(
    ("component", "labels", "covered"),
    [
        ("*", ["a", "b"], {"a", "b", "rope"}),
        ("ball ?", ["ball", "ball"], {"ball 1", "ball 2"}),
        ("ADCP [a]", ["ADCP [a]", "ADCP [b]", "ADCP a"], {"ADCP [a]"}),  # a label is that label
        ("ADCP [ab]", ["ADCP [a]", "ADCP a", "ADCP b"], {"ADCP a", "ADCP b"}),
        ("ADCP [[]*", ["ADCP [a]", "ADCP [b]", "ADCP a"], {"ADCP [a]", "ADCP [b]"}),
        ("*", ["*", "b"], {"*"}),
        ("B*", ["b1", "B2"], {"B2"}),  # capitals count
        ("浮標*", ["浮標 1", "b"], {"浮標 1"}),
        ("[!b]", ["a", "b"], {"a"}),
        ("a*a*a*a*a*a*a*a*a*", ["a" * 60, "b"], {"a" * 60}),
        ("[/x]", ["[/x]", "x"], {"[/x]"}),
    ],
)
def test_a_component_is_a_label_or_a_pattern_of_labels(calm, accepting, component, labels, covered):
    accept = f"{{rule: strength, component: {json.dumps(component)}, reason: a test}}"
    _, document, states = checked(calm, accepting(accept, labels=labels, buoyancy="900 N"))
    accepted = {part for (rule, part), state in states.items() if state == ["accepted"]}
    assert accepted == covered - {"rope"}  # whose strength is known, and passes
    assert {one["component"] for one in document["accepted"]} == accepted


@pytest.mark.parametrize(
    ("accept", "place", "says"),
    [
        ("{rule: strenght, reason: x}", "17:14", "is called `strenght`; did you mean `strength`?"),
        ("{rule: equilibrium, reason: x}", "17:14", "no rule that can be accepted is called"),
        (
            "{rule: tilt, component: top flaot, reason: x}",
            "17:31",
            "no piece or clamp is called `top flaot`; did you mean `top float`?",
        ),
        ("{rule: tilt, component: 'x*', reason: x}", "17:31", "no piece or clamp is called `x*`"),
        ("{rule: tilt, component: '', reason: x}", "17:31", "no piece or clamp is called"),
        ("{rule: tilt, component: '[', reason: x}", "17:31", "no piece or clamp is called `[`"),
        ("{rule: tilt}", "17:7", "`reason` is missing"),
        ("{reason: x}", "17:7", "`rule` is missing"),
        ("{rule: tilt, reason: ' '}", "17:28", "`reason` is blank"),
        ("{rule: tilt, reason: x, until: 2027-02-30}", "17:38", "not a date"),
        ("{rule: tilt, reason: x, until: 30.6.2027}", "17:38", "write it as 2027-06-30"),
        ("{rule: tilt, reason: x, untill: 2027-06-30}", "17:31", "did you mean `until`?"),
        ("{rule: tilt, reason: x, date: 2027-06-30, until: 2027-06-29}", "17:7", "before its"),
        ("tilt", "17:7", "accept"),
    ],
)
def test_what_is_no_accept_is_a_mistake_at_its_place(calm, accepting, accept, place, says):
    for command in ("check", "run"):
        done = calm(command, accepting(accept))
        assert (done.code, done.out) == (2, "")
        assert f"accepting.yaml:{place}: " in done.err, done.err
        assert says in done.err


def test_several_alike_are_offered_together(calm, accepting):
    done = calm("check", accepting("{rule: tilt, component: ball, reason: x}", labels=["ball"] * 2))
    assert "no piece or clamp is called `ball`; did you mean `ball *`?" in done.err


def test_mistakes_of_the_line_hide_no_others_and_make_none(calm, accepting, folder):
    file = accepting("{rule: tlit, component: buoy, reason: x}", length="60 kg")
    done = calm("check", file)
    assert done.code == 2
    assert "did you mean `tilt`?" in done.err and "60 kg" in done.err
    assert "`buoy`" not in done.err  # whether there is one is not known


def test_an_accept_that_nothing_needs_is_a_notice(calm, accepting):
    file = accepting(
        "{rule: anchor-weight, reason: a test}",
        "{rule: strength, component: rope, reason: a test}",
        "{rule: strength, component: top float, reason: a test}",
    )
    done = calm("check", file, "--json", "-")
    assert (
        "accepting.yaml: line 17 of the file: `accept` for anchor-weight is not needed" in done.err
    )
    assert "line 18 of the file: `accept` for strength of rope is not needed" in done.err
    assert "line 19" not in done.err


@pytest.mark.parametrize(
    ("until", "counts"), [("2026-12-30", False), ("2026-12-31", True), ("2027-01-01", True)]
)
def test_an_accept_counts_through_its_last_day(calm, accepting, until, counts):
    file = accepting(f"{{rule: strength, component: top float, reason: a test, until: {until}}}")
    done, _, states = checked(calm, file)
    assert states["strength", "top float"] == ["accepted" if counts else "unknown"]
    ended = f"line 17 of the file: `accept` for strength of top float expired on {until}"
    assert (ended in done.err) is not counts


@pytest.mark.parametrize(("date", "counts"), [("2026-12-31", True), ("2027-01-01", False)])
def test_an_accept_of_a_day_to_come_does_not_count_yet(calm, accepting, date, counts):
    own = "{rule: strength, component: top float, reason: a test, date: "
    needless = "{rule: strength, component: rope, reason: a test, date: "
    done, _, states = checked(calm, accepting(f"{own}{date}}}", f"{needless}{date}}}"))
    assert states["strength", "top float"] == ["accepted" if counts else "unknown"]
    for label in ("top float", "rope"):
        told = f"of {label} is dated {date} and does not apply yet" in done.err
        assert told is not counts


@pytest.mark.parametrize("reason", [".", "-", "?!"])
def test_a_reason_is_said_in_words(calm, accepting, reason):
    done = calm("check", accepting(f'{{rule: strength, component: top float, reason: "{reason}"}}'))
    assert done.code == 2
    assert f"`reason: {reason}` contains no words; give a reason" in done.err


@pytest.mark.parametrize(
    ("limit", "refused"),
    [
        ("safety_factor: {steel: 0.01}", "`steel: 0.01` must be at least 1"),
        ("safety_factor: {synthetic: 0.9}", "`synthetic: 0.9` must be at least 1"),
        ("safety_factor: {surface: 0.5}", "`surface: 0.5` must be at least 1"),
        ("anchor_factor: 0.01", "`anchor_factor: 0.01` must be at least 1"),
        ("launch_safety_factor: 0.1", "`launch_safety_factor: 0.1` must be at least 1"),
        ("maximum_tilt: 180 deg", "`maximum_tilt: 180 deg` must be at most 90 deg"),
        ("rating_margin: -5000 m", "`rating_margin: -5000 m` must be at least 0 m"),
    ],
)
def test_a_limit_that_would_pass_anything_is_refused(calm, accepting, limit, refused):
    reason = "{rule: strength, component: top float, reason: a test}"
    done = calm("check", accepting(reason, more=f"  {limit}\n"))
    assert done.code == 2
    assert refused in done.err


def test_the_more_particular_accept_is_the_one_that_counts(calm, accepting):
    file = accepting(
        "{rule: strength, reason: all of it}",
        "{rule: strength, component: 't*', reason: some}",
        "{rule: strength, component: top float, reason: this one}",
        labels=("top float", "ball"),
    )
    done, document, _ = checked(calm, file)
    reasons = {one["component"]: one["reason"] for one in document["accepted"]}
    assert reasons == {"top float": "this one", "ball": "all of it"}
    assert "line 19 of the file: `accept` for strength of t* is not needed" in done.err


def test_a_warning_cannot_be_accepted(calm, accepting, folder):
    file = accepting("{rule: tilt, component: top float, reason: x}")
    text = (folder / file).read_text(encoding="utf-8")
    (folder / file).write_text(
        text.replace("max_tilt: 80 deg", "warn_tilt: 0.1 deg, max_tilt: 80 deg")
    )
    done, document, states = checked(calm, file)
    assert states["tilt", "top float"] == ["warn"]
    assert document["accepted"] == []
    assert "is not needed" in done.err


def test_no_equilibrium_cannot_be_accepted_away(calm, accepting):
    file = accepting("{rule: strength, reason: x}", buoyancy="10 N")
    assert calm("check", file, "--allow-unknown").code == 3


def test_an_accepted_failure_says_by_whom(calm, accepting):
    more = "  maximum_knockdown: 1 mm\n"
    nobody = accepting("{rule: knockdown, reason: deep enough}", more=more)
    done = calm("check", nobody)
    assert "1 accepted" in done.out
    assert "1 of 1 `accept` entries lacks a name" in done.err
    own = "by: A. Martin, until: 2036-12-31"
    signed = accepting(f"{{rule: knockdown, reason: deep enough, {own}}}", more=more)
    assert "names nobody" not in calm("check", signed).err


def test_what_is_not_judged_is_listed(calm, accepting):
    _, document, _ = checked(calm, accepting("{rule: knockdown, reason: deep enough}"))
    assert "waves" in document["not_judged"]
    assert any("ADCP beams" in each for each in document["not_judged"])
