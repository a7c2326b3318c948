"""``calm waves`` as it is typed."""

import json

import pytest

from tests.drawings import assert_none_overlap, svgs_of

BUOY = """\
name: Small buoy
environment: {depth: 80 m, current: {speed: 0.3 m/s, toward: 90 deg}}
line:
  - {use: buoy, label: buoy}
  - {use: rope, length: 95 m, label: rope}
  - {use: chain, length: 12 m, label: chain}
  - {use: block, label: block}
components:
  buoy: {kind: cylinder, role: float, diameter: 1.6 m, length: 1.2 m, mass: 700 kg,
         volume: 2.4127 m^3, HULL}
  rope: {kind: cable, diameter: 20 mm, weight: 0.5 N/m, mass: 0.3 kg/m, material: nylon,
         STIFF}
  chain: {kind: chain, diameter: 16 mm, mass: 5.6 kg/m}
  block: {kind: anchor, weight: 20 kN}
"""


@pytest.fixture
def buoy(tmp_path):
    def written(hull="hull: cylinder", stiff="stiffness: 90 kN"):
        path = tmp_path / "buoy.yaml"
        path.write_text(BUOY.replace("HULL", hull).replace("STIFF", stiff))
        return str(path)

    return written


SEA = ("--hs", "1.5 m", "--tp", "6 s")


def test_the_table_and_the_object(calm, buoy):
    shown = calm("waves", buoy(), *SEA)
    assert shown.code in (0, 3)
    assert "Hs 1.5 m, Tp 6.0 s" in shown.out
    told = json.loads(calm("waves", buoy(), *SEA, "--json", "-").out)
    (state,) = told["states"]
    assert (state["significant_wave_height"], state["peak_period"], state["share"]) == (1.5, 6, 1)
    assert [one["label"] for one in state["components"]] == ["buoy", "rope", "chain"]
    rope = state["components"][1]
    assert rope["tension_max"] - rope["tension_mean"] == pytest.approx(
        rope["tension_mean"] - rope["tension_min"]
    )
    assert set(told["accuracy"]) == {"mesh", "frequencies", "linearisation"}
    assert [(one["label"], one["curve"]) for one in told["fatigue"]] == [
        ("rope", None),
        ("chain", "dnv-studless-chain"),
    ]
    assert told["units"]["force"] == "N"


def test_of_two_equally_high_seas_the_steeper_is_shown(calm, buoy, folder):
    rows = "1,6,0.5\n1.5,8,0.3\n1.5,6,0.2\n"
    (folder / "s.csv").write_text(f"significant_wave_height[m],peak_period[s],share\n{rows}")
    shown = calm("waves", buoy(), "--scatter", "s.csv").out
    assert "In the highest sea, Hs 1.5 m, Tp 6.0 s" in shown


def test_the_band_measured_at_sea_and_other_cut_offs(calm, buoy):
    """In words and in a table; every piece has its tensions in the object."""
    text = calm("waves", buoy(), *SEA).out
    told = json.loads(calm("waves", buoy(), *SEA, "--json", "-").out)
    (state,) = told["states"]
    top, band = state["components"][0], state["measured_over_computed"]
    assert band == {"low": 0.57, "high": 1.0, "from_height": 1.0, "to_height": 5.0}
    words = " ".join(text.split())
    assert "in seas of Hs 1 to 5 m" in words
    assert "0.57 to 1.00 times the computed standard deviation" in words
    low, high = (top[end]["tension_std"] for end in ("measured_low", "measured_high"))
    assert f"a standard deviation of {low:.0f} N to {high:.0f} N at the top" in words
    assert "outside that range" not in words
    for name, factor in (("half", 0.5), ("as above", 1.0), ("twice", 2.0)):
        (row,) = [line for line in text.splitlines() if line.startswith(f"{name} ")]
        loads = top if factor == 1.0 else top[f"{name}_cut_off"]
        figures = row.removeprefix(name).split()
        assert figures[0] == f"{factor * state['cut_off']:.1f}"
        assert figures[1:4] == [
            f"{loads[each]:.0f}" for each in ("tension_std", "tension_max", "tension_min")
        ]
    low_sea = " ".join(calm("waves", buoy(), "--hs", "0.4 m", "--tp", "4 s").out.split())
    assert "The height of this sea is outside that range of Hs." in low_sea
    chain = told["fatigue"][1]
    assert chain["life_twice_cut_off"] <= chain["life"] <= chain["life_half_cut_off"]


def test_slack_has_a_status_of_its_own(calm, buoy):
    shown = calm("waves", buoy(), "--hs", "6 m", "--tp", "9 s", "--json", "-")
    assert shown.code == 3
    told = json.loads(shown.out)
    assert told["status"] == "slack-in-waves"
    assert told["states"][0]["slack"]
    assert "slack-in-waves" in shown.err


def test_a_scatter_table(calm, buoy, tmp_path):
    table = tmp_path / "seas.csv"
    table.write_text("significant_wave_height[m],peak_period[s],share\n0.5,4,3\n1.0,5,1\n")
    told = json.loads(calm("waves", buoy(), "--scatter", str(table), "--json", "-").out)
    assert [one["share"] for one in told["states"]] == [0.75, 0.25]
    deviations = [one["components"][1]["tension_std"] for one in told["states"]]
    assert deviations[0] < deviations[1]
    shown = calm("waves", buoy(), "--scatter", str(table)).out.splitlines()
    for state in told["states"]:
        (row,) = [one for one in shown if one.startswith(f"{state['significant_wave_height']}  ")]
        top = state["components"][0]
        ends = [top[end]["tension_std"] for end in ("measured_low", "measured_high")]
        halved, doubled = (top[f"{each}_cut_off"]["tension_std"] for each in ("half", "twice"))
        figures = f"{ends[0]:.0f} to {ends[1]:.0f} {halved:.0f} {doubled:.0f}".split()
        assert row.split()[4:9] == figures


def test_a_rope_of_unknown_stiffness_is_told(calm, buoy):
    shown = calm("waves", buoy(stiff="cn: 1.2"), *SEA)
    assert "rope has no `stiffness` and is assumed inextensible" in shown.out


@pytest.mark.parametrize(
    ("options", "told"),
    [
        (("--hs", "0 m", "--tp", "6 s"), "--hs: must be above 0"),
        (("--hs", "2 m", "--tp", "-1 s"), "--tp: must be above 0"),
        (("--hs", "2 m"), "missing: --tp"),
        (("--hs", "2", "--tp", "6 s"), "--hs"),
        (("--hs", "5 m", "--tp", "4 s"), "would break"),
        (("--hs", "40 m", "--tp", "25 s"), "the maximum wave height is 30 m"),
        (("--hs", "3 m", "--tp", "60 s"), "and the maximum period is 30 s"),
        ((*SEA, "--duration", "2 s"), "--duration must be at least one minute"),
        ((*SEA, "--spectrum", "jonswop"), "did you mean `jonswap`?"),
        ((*SEA, "--scatter", "none.csv"), "a --scatter file already contains heights"),
        (("--scatter", "none.csv"), "none.csv"),
    ],
)
def test_seas_that_cannot_be_are_refused(calm, buoy, options, told):
    shown = calm("waves", buoy(), *options)
    assert shown.code == 2
    assert told in shown.err
    assert "Traceback" not in shown.err


def test_a_buoy_without_a_hull_is_refused(calm, tmp_path, buoy):
    path = buoy().replace("buoy.yaml", "body.yaml")
    text = (tmp_path / "buoy.yaml").read_text()
    body = (
        text.replace(
            "{kind: cylinder, role: float, diameter: 1.6 m, length: 1.2 m, mass: 700 kg,",
            "{kind: body, role: float, drag_area: 1.9 m^2, cd: 1, length: 1.2 m, mass: 700 kg,",
        )
        .replace(", hull: cylinder", "")
        .replace("volume: 2.4127 m^3, }", "volume: 2.4127 m^3}")
    )
    (tmp_path / "body.yaml").write_text(body)
    shown = calm("waves", path, *SEA)
    assert shown.code == 2
    assert "has no hull" in shown.err
    for hull in ("cylinder", "sphere"):  # of its volume, as it rides
        (tmp_path / "body.yaml").write_text(body.replace("m^3}", f"m^3, hull: {hull}}}"))
        assert "std" in calm("waves", path, *SEA).out


def test_a_buoy_that_follows_and_one_by_its_own_response(calm, buoy):
    def deviation(hull, *options, stiff="stiffness: 90 kN"):
        told = json.loads(calm("waves", buoy(hull, stiff), *SEA, "--json", "-", *options).out)
        (state,) = told["states"]
        return state["components"][1]["tension_std"], state["follower_std"]

    filtered, follower = deviation("hull: cylinder")
    following, _ = deviation("heave: follows")
    given, _ = deviation('rao: {"0.1": [1, 0 deg], "12": [1, 0 deg]}')
    # the drag is linearised to 5e-3, from another beginning
    assert following == pytest.approx(follower, rel=5e-3)
    assert given == pytest.approx(following, rel=1e-6)
    assert filtered < following
    stiffer, _ = deviation("heave: follows", stiff="stiffness: 90 kN, dynamic_stiffness: 200 kN")
    assert stiffer > following


def test_the_pitch_of_a_float_that_gives_what_it_takes(calm, buoy):
    """Of a given response of 4° per metre it is that of the elevation; it is the float's tilt."""

    def pitch(hull):
        shown = calm("waves", buoy(hull), *SEA)
        told = json.loads(calm("waves", buoy(hull), *SEA, "--json", "-").out)
        return shown.out, told["states"][0], told["pitch_unknown"]

    text, state, missing = pitch("hull: cylinder")
    assert state["pitch_std"] is None
    assert missing == "it requires `hull`, `centre_of_mass` and `radius_of_gyration`"
    assert "The pitch of the float is not computed: it requires `hull`" in " ".join(text.split())
    text, state, missing = pitch("centre_of_mass: 0.3 m, radius_of_gyration: 0.6 m")
    assert missing is None
    assert f"The float pitches by {state['pitch_std']:.1f}°" in text
    assert state["components"][0]["tilt_std"] == state["pitch_std"] > 0.0
    _, state, _ = pitch('rao: {"0.1": [1, 0 deg, 4 deg, 90 deg], "12": [1, 0 deg, 4 deg, 90 deg]}')
    assert state["pitch_std"] == pytest.approx(4.0 * 1.5 / 4.0, rel=2e-3)


def test_a_sea_steeper_than_seas_are_is_doubted(calm, buoy):
    assert "steeper than any measured sea" not in calm("waves", buoy(), *SEA).out
    doubted = calm("waves", buoy(), "--hs", "5 m", "--tp", "6.5 s").out
    assert "steeper than any measured sea (1 in 13)" in doubted


@pytest.mark.parametrize(
    ("hull", "told"),
    [
        ("heave: floats", "`heave: floats` must be one of filtered, follows"),
        ('rao: {"fast": [1, 0 deg], "2": [1, 0 deg]}', "`fast` is not an angular frequency"),
        ('rao: {"1": [1, 0 deg]}', "two frequencies or more"),
        (
            'rao: {"1": [1, 0 deg], "2": [1, 0 deg, 5 deg, 0 deg]}',
            "with the pitch at all of them or at none",
        ),
        ('rao: {"1": [1, 0 deg, 5 deg], "2": [1, 0 deg]}', "four with the pitch"),
        ("centre_of_mass: 0.4 m", "needs both its `centre_of_mass` and `radius_of_gyration`"),
        ("bail: 0 m", "needs both its `centre_of_mass`"),
        ("centre_of_mass: 2 m, radius_of_gyration: 0.6 m", "does not float upright"),
        ('rao: {"1": [-1, 0 deg], "2": [1, 0 deg]}', "at least 0"),
        ('rao: {"1": [60, 0 deg], "2": [1, 0 deg]}', "at most 10"),
        ('rao: {"inf": [1, 0 deg], "2": [1, 0 deg]}', "is not an angular frequency"),
    ],
)
def test_a_response_that_cannot_be_is_refused(calm, buoy, hull, told):
    shown = calm("waves", buoy(hull), *SEA)
    assert shown.code == 2
    assert told in shown.err


def test_a_sea_breaks_in_shallow_water(calm, buoy, tmp_path):
    path = buoy()
    text = (tmp_path / "buoy.yaml").read_text().replace("depth: 80 m", "depth: 9 m")
    (tmp_path / "buoy.yaml").write_text(text.replace("length: 95 m", "length: 20 m"))
    shown = calm("waves", path, "--hs", "6 m", "--tp", "12 s")
    assert shown.code == 2
    assert "breaks in 9 m of water; the largest significant height is 5.4 m" in shown.err


def in_its_file(buoy, waves, **more):
    from pathlib import Path

    path = Path(buoy(**more))
    text = path.read_text().replace("toward: 90 deg}}", f"toward: 90 deg}}, waves: {waves}}}")
    path.write_text(text)
    return str(path)


TABLE = "significant_wave_height[m],peak_period[s],share\n0.5,4,3\n1.5,6,1\n"


def test_the_seas_of_the_file(calm, buoy, tmp_path):
    """What the file gives is what the options would; an option comes before it."""
    path = in_its_file(buoy, "{significant_height: 1.5 m, peak_period: 6 s}")
    assert calm("waves", path).out == calm("waves", buoy(), *SEA).out
    path = in_its_file(buoy, "{significant_height: 1.5 m, peak_period: 6 s}")
    assert "Hs 0.5 m" in calm("waves", path, "--hs", "0.5 m", "--tp", "4 s").out
    (tmp_path / "seas.csv").write_text(TABLE)
    both = "{significant_height: 2 m, peak_period: 7 s, scatter: seas.csv}"
    told = json.loads(calm("waves", in_its_file(buoy, both), "--json", "-").out)
    assert [state["share"] for state in told["states"]] == [0.75, 0.25, 0.0]
    alone = json.loads(calm("waves", in_its_file(buoy, "{scatter: seas.csv}"), "--json", "-").out)
    # the sea to be survived adds nothing to the damage of the table
    assert told["fatigue"][1]["damage_per_year"] == pytest.approx(
        alone["fatigue"][1]["damage_per_year"], rel=1e-3
    )


def test_a_report_has_the_life_and_its_pictures(calm, buoy, tmp_path):
    (tmp_path / "seas.csv").write_text(TABLE)
    path = in_its_file(buoy, "{scatter: seas.csv}")
    shown = calm("waves", path, "--report", str(tmp_path / "report"))
    assert shown.code in (0, 3)
    assert "dnv-studless-chain" in shown.out
    assert "Life unknown: rope." in shown.out
    page = (tmp_path / "report" / "waves.html").read_text()
    assert page.count("<svg") == 1
    (svg,) = svgs_of(page)
    assert_none_overlap(svg)
    assert "Hs [m]" in page  # several seas: tension over height
    assert "dnv-studless-chain" in page
    assert (tmp_path / "report" / "waves.pdf").read_bytes().startswith(b"%PDF")
    (tmp_path / "file").write_text("")
    assert calm("waves", path, "--report", str(tmp_path / "file" / "in")).code == 2


@pytest.mark.parametrize(
    ("waves", "message"),
    [
        ("{}", "needs `significant_height`"),
        ("{significant_height: 2 m}", "needs a `peak_period`"),
        ("{peak_period: 6 s, scatter: seas.csv}", "needs `significant_height`"),
        ("{significant_height: 0 m, peak_period: 6 s}", "at least 0.05 m"),
        ("{significant_height: 2, peak_period: 6 s}", "did you mean `significant_height: 2 m`"),
        ("{significant_height: 9 m, peak_period: 4 s}", "would break"),
        ("{significant_heigth: 2 m, peak_period: 4 s}", "significant_height"),
        ("{significant_height: 2 m, peak_period: 6 s, spectrum: jonswop}", "mean `jonswap`"),
        ("{significant_height: 2 m, peak_period: 6 s, gamma: 30}", "at most 10"),
        ("{significant_height: 2 m, peak_period: 6 s, spectrum: ochi-hubble}", "remove the period"),
        ("{spectrum: sea.csv, significant_height: 2 m}", "remove these keys"),
        ("{scatter: none.csv}", "no such file"),
        ("{scatter: bad.csv}", "the row must contain numbers"),
        ("{scatter: seas.csv, spectrum: ochi-hubble}", "has its own periods"),
    ],
)
def test_seas_of_the_file_that_cannot_be(calm, buoy, tmp_path, waves, message):
    (tmp_path / "seas.csv").write_text(TABLE)
    (tmp_path / "bad.csv").write_text(TABLE + "2,x,1\n")
    shown = calm("waves", in_its_file(buoy, waves))
    assert shown.code == 2
    assert message in " ".join(shown.err.split())
    assert "Traceback" not in shown.err
    assert calm("check", in_its_file(buoy, waves)).code == 2


RULES = ("wave-strength", "wave-slack", "fatigue")


def judged(calm, path):
    told = json.loads(calm("check", path, "--json", "-").out)
    found = [one for one in told["findings"] if one["rule"] in RULES]
    return {(one["rule"], one["component"]): one for one in found}


LOADS = "stiffness: 12 kN, breaking_load: BREAK"


def test_a_surface_mooring_without_waves_is_unknown(calm, buoy):
    found = judged(calm, buoy())
    assert [(key, one["state"]) for key, one in found.items()] == [
        (("wave-strength", None), "unknown")
    ]


def test_the_check_judges_the_waves_of_the_file(calm, buoy, tmp_path):
    """The tension of `calm waves` against breaking load over 1.67, slack, and the life."""
    (tmp_path / "seas.csv").write_text(TABLE)
    strong = LOADS.replace("BREAK", "60 kN")
    path = in_its_file(buoy, "{scatter: seas.csv}", stiff=strong)
    told = json.loads(calm("waves", path, "--json", "-").out)
    rope = max(state["components"][1]["greatest"] for state in told["states"])
    found = judged(calm, path)
    strength = found["wave-strength", "rope"]
    assert strength["value"] == pytest.approx(rope, rel=1e-6)
    assert strength["limit"] == pytest.approx(60e3 / 1.67)
    assert strength["state"] == "pass"
    greatest = max(
        (state["components"][1] for state in told["states"]), key=lambda one: one["greatest"]
    )
    low, high = (greatest[f"measured_{end}"]["greatest"] for end in ("low", "high"))
    band = f"Measurements at sea (SOFS) imply a tension of {low:.0f} N to {high:.0f} N."
    assert strength["message"].endswith(band)
    assert found["fatigue", "rope"]["state"] == "unknown"  # no curve of nylon is published
    chain = found["fatigue", "chain"]
    (life,) = [one["life"] for one in told["fatigue"] if one["label"] == "chain"]
    assert chain["value"] == pytest.approx(life * 365.25 * 86400.0, rel=1e-6)
    assert chain["limit"] == pytest.approx(3.0 * 365.0 * 86400.0)
    assert chain["state"] == "pass"
    weak = LOADS.replace("BREAK", "0.5 kN")
    found = judged(calm, in_its_file(buoy, "{scatter: seas.csv}", stiff=weak))
    assert found["wave-strength", "rope"]["state"] == "fail"
    one_sea = "{significant_height: 1.5 m, peak_period: 6 s}"
    found = judged(calm, in_its_file(buoy, one_sea, stiff=strong))
    assert found["fatigue", None]["state"] == "not-judged"


def test_the_check_says_what_falls_slack(calm, buoy):
    sea = "{significant_height: 6 m, peak_period: 9 s}"
    found = judged(calm, in_its_file(buoy, sea))
    states = {one["state"] for key, one in found.items() if key[0] == "wave-slack"}
    assert "fail" in states
    slack = [one for one in found.values() if one["rule"] == "wave-slack"]
    assert all((one["value"] < 0.0) == (one["state"] == "fail") for one in slack)
    assert all("Measurements at sea (SOFS) imply a tension of " in one["message"] for one in slack)
