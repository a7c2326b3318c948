"""`calm tow strumming` as a user runs it."""

import json
import math

import pytest

CABLE = ("--speed", "1.30 m/s", "--diameter", "17 mm", "--density", "1000 kg/m^3")


def ask(calm, angle, *words):
    done = calm("tow", "strumming", "--angle", angle, *CABLE, *words, "--json", "-")
    assert (done.code, done.err) == (0, "")
    return json.loads(done.out)


def test_the_angle_gives_the_coefficient_that_holds_the_weight(calm):
    answer = ask(calm, "20 deg", "--weight", "3.0795 N/m")
    # w cos φ = ½ ρ D C* (V sin φ)²
    across = 1.30 * math.sin(math.radians(20.0))
    held = 0.5 * 1000.0 * 0.017 * answer["cn"] * across**2
    assert held == pytest.approx(3.0795 * math.cos(math.radians(20.0)), rel=1e-12)
    assert answer["frequency"] == pytest.approx(0.166 * across / 0.017, rel=1e-12)
    assert answer["notes"] == []


BARE = """\
tow: {speed: 0.6 m/s, toward: 0 deg}
environment: {density: 1000 kg/m^3}
line: [{use: cable, length: 10 m}]
solver: {strumming: bourget-marichal}
components:
  cable: {kind: cable, diameter: 17 mm, weight: 3.0795 N/m, cn: 1.2, ct: 0}
"""


def test_a_bare_cable_that_is_towed_has_the_amplitude_its_angle_tells(calm, folder):
    (folder / "bare.yaml").write_text(BARE)
    towed = json.loads(calm("tow", "bare.yaml", "--json", "-").out)
    words = ("--speed", "0.6 m/s", "--diameter", "17 mm", "--density", "1000 kg/m^3")
    done = calm("tow", "strumming", "--angle", f"{towed['body']['angle']} deg", *words,
                "--weight", "3.0795 N/m", "--json", "-")  # fmt: skip
    answer = json.loads(done.out)
    # The cable is straight: the march adds rounding only. The paper prints a/D of 0.9 at 0.6 m/s.
    assert answer["cn"] == pytest.approx(towed["strumming"]["cn_max"], rel=1e-6)
    assert answer["frequency"] == pytest.approx(towed["strumming"]["frequency"], rel=1e-6)
    assert answer["amplitude"] == pytest.approx(0.9, abs=0.05)


def test_the_density_of_the_cable_in_place_of_its_weight(calm):
    answer = ask(calm, "20 deg", "--solid-density", "2383 kg/m^3")
    assert answer["weight"] == pytest.approx(1383.0 * 9.80665 * math.pi / 4.0 * 0.017**2, rel=1e-12)


def test_small_angles_are_warned_of(calm):
    assert ask(calm, "15.1 deg", "--weight", "1.5 N/m")["notes"] == []
    (note, *_) = ask(calm, "14.9 deg", "--weight", "1.5 N/m")["notes"]
    assert note.startswith("Below 15°")
    done = calm("tow", "strumming", "--angle", "14.9 deg", *CABLE, "--weight", "1.5 N/m")
    assert "! Below 15°" in done.out


def test_a_cable_at_rest_does_not_vibrate(calm):
    answer = ask(calm, "60 deg", "--weight", "3.0795 N/m")
    assert answer["cn"] < 1.2
    assert (answer["amplitude"], answer["frequency"]) == (0.0, None)
    assert "does not vibrate" in answer["notes"][0]
    done = calm("tow", "strumming", "--angle", "60 deg", *CABLE, "--weight", "3.0795 N/m")
    assert "Hz" not in done.out


def test_more_than_the_method_explains(calm):
    assert "above 3" in ask(calm, "16 deg", "--weight", "6 N/m")["notes"][0]


def test_sea_water_when_no_density_is_given(calm):
    words = ("--angle", "30 deg", "--speed", "1 m/s", "--diameter", "17 mm", "--weight", "3.1 N/m")
    assert json.loads(calm("tow", "strumming", *words, "--json", "-").out)["density"] == 1025.0
    table = calm("tow", "strumming", *words)
    assert table.code == 0
    assert "drag coefficient C*" in table.out and "amplitude a/D" in table.out


@pytest.mark.parametrize(
    ("words", "told"),
    [
        (["--angle", "20", "--weight", "3 N/m"], "--angle: `20` needs a unit: `20 deg`?"),
        (["--angle", "0 deg", "--weight", "3 N/m"], "--angle must be above 0"),
        (["--angle", "90 deg", "--weight", "3 N/m"], "--angle must be below 90 deg"),
        (["--angle", "20 deg", "--weight", "-3 N/m"], "--weight must be above 0"),
        (["--angle", "20 deg"], "give one of --weight and --solid-density"),
        (["--angle", "20 deg", "--weight", "3 N/m", "--solid-density", "2 t/m^3"], "give one of"),
        (["--angle", "20 deg", "--solid-density", "900 kg/m^3"], "above the density of the water"),
        (["--angle", "20 deg", "--weight", "3 kg/m"], "kgf/m"),
    ],
)
def test_bad_questions_are_refused_and_nothing_is_written(calm, folder, words, told):
    done = calm("tow", "strumming", *words, *CABLE, "--json", "answer.json")
    assert (done.code, done.out) == (2, "")
    assert told in done.err
    assert not list(folder.iterdir())


def test_the_old_name_does_the_same_and_says_the_new_one(calm):
    words = ("--angle", "20 deg", *CABLE, "--weight", "3.0795 N/m")
    new, old = calm("tow", "strumming", *words), calm("strumming", *words)
    assert (old.code, old.out) == (0, new.out)
    assert old.err.startswith("calm strumming is now calm tow strumming")
