"""What a design is judged in: currents that are weak, mistyped or cut off; places far away."""

import pytest

from calm.case import load
from calm.checks.design_check import assessment_of, environments_checked
from calm.checks.situations import currents
from calm.errors import InputError
from calm.files.strumming_keys import StrummingFactor

SOUND = """\
name: Sound
position: {latitude: 48 deg, longitude: -10 deg}
environment: {depth: 200 m, current: CURRENT}
line:
  - {use: ball, label: top float}
  - {use: rope, length: 100 m}
  - {use: ball, label: back-up float}
  - {use: hook}
  - {use: weight}
components:
  ball: {kind: sphere, role: float, diameter: 0.8 m, buoyancy: 2000 N, depth_rating: 1000 m,
         breaking_load: 100 kN}
  rope: {kind: cable, diameter: 10 mm, weight: 0.2 N/m, breaking_load: 60 kN}
  hook: {kind: cylinder, role: release, diameter: 0.1 m, length: 0.8 m, buoyancy: -200 N,
         depth_rating: 1000 m, max_tilt: 45 deg, breaking_load: 60 kN}
  weight: {kind: anchor, weight: 10000 N, kt: 900 N/(m/s)^2, breaking_load: 100 kN}
"""
UNIFORM = "{speed: SPEED m/s, toward: 90 deg}"


HALF = UNIFORM.replace("SPEED", "0.5")


def of(path, current=HALF, more=""):
    return load(path / "m.yaml", text=SOUND.replace("CURRENT", current) + more)


def said(*moorings):
    return [(verdict.state, verdict.message) for _, verdict in currents.judge(moorings)]


def table(*rows):
    return "{columns: [depth m, u m/s, v m/s], rows: [" + ", ".join(map(str, rows)) + "]}"


def test_the_strongest_current_of_all_environments_is_said(tmp_path):
    weak, strong = (of(tmp_path, UNIFORM.replace("SPEED", speed)) for speed in ("0.1", "0.6"))
    assert said(weak, strong) == [("pass", "The strongest current checked is 0.60 m/s.")]
    assert said(weak) == [
        (
            "warn",
            "The strongest current checked is 0.10 m/s; a wind of 7 m/s alone drives a surface "
            "current of 0.20 m/s.",
        )
    ]


def test_centimetres_beside_a_storm_are_told(tmp_path):
    small, storm = (of(tmp_path, UNIFORM.replace("SPEED", speed)) for speed in ("0.004", "0.8"))
    state, message = said(small, storm)[0]
    assert state == "warn"
    assert message == (
        "The strongest current is 0.004 m/s in this environment and 0.80 m/s in another; "
        "one of them may be in the wrong unit."
    )
    still = of(tmp_path, UNIFORM.replace("SPEED", "0"))
    assert said(still, storm) == [("pass", "The strongest current checked is 0.80 m/s.")]


GAPS = {
    table([0, 0.5, 0], [200, 0.1, 0]): "",
    table([10, 0.5, 0], [180, 0.1, 0]): "",
    table([0, 0.5, 0]): "",
    table([0, 0.5, 0], [20, 0.4, 0]): "below 20.0 m",
    table([100, 0.5, 0]): "above 100.0 m or below 100.0 m",
    table([120, 0.5, 0], [200, 0.4, 0]): "above 120.0 m",
}


@pytest.mark.parametrize("current", GAPS)
def test_a_profile_that_does_not_cover_the_line_is_told(current, tmp_path):
    found = [message for state, message in said(of(tmp_path, current)) if state == "warn"]
    assert len(found) == bool(GAPS[current])
    if found:
        assert found[0].startswith(
            f"The current has no level {GAPS[current]}, so the value of the nearest"
        )


def test_a_mooring_deployed_elsewhere_is_unknown(tmp_path):
    where = "deployed: {position: {latitude: 21 deg, longitude: -10 deg}}\n"
    mooring = of(tmp_path, more=where)
    assessment = assessment_of("m", environments_checked(mooring, "m"))
    (found,) = (one for one in assessment.findings if one.rule == "as-deployed")
    assert found.state == "unknown"
    assert found.message.startswith("The mooring was deployed 3002 km from the planned position")
    near = of(tmp_path, more=where.replace("21", "48.1"))
    assert not [
        one for one in assessment_of("m", environments_checked(near, "m")).findings
        if one.rule == "as-deployed"
    ]  # fmt: skip


@pytest.mark.parametrize(
    ("more", "message"),
    [
        ("checks: {anchor_friction: 5}\n", "`anchor_friction: 5` must be at most 1"),
        ("gravity", r"`gravity: 1 m/s^2` must be at least 9.7 m/s^2"),
    ],
)
def test_what_can_only_flatter_is_refused(more, message, tmp_path):
    text = SOUND.replace("CURRENT", HALF)
    if more == "gravity":
        text, more = text.replace("depth: 200 m,", "depth: 200 m, gravity: 1 m/s^2,"), ""
    with pytest.raises(InputError) as error:
        load(tmp_path / "m.yaml", text=text + more)
    assert message in str(error.value)


def test_strumming_that_lessens_drag_is_refused(tmp_path):
    with pytest.raises(InputError, match=r"`factor: 0.1` must be at least 1"):
        of(tmp_path, more="solver: {strumming: {factor: 0.1}}\n")
    assert StrummingFactor(factor=1).factor == 1.0


def test_an_accept_by_nobody_is_told(tmp_path):
    text = "checks: {accept: [{rule: figures, component: rope, reason: seen it MORE}]}\n"
    for more, count in (("", 1), (", by: A. Martin", 1), (", by: A. Martin, until: 2090-01-01", 0)):
        mooring = of(tmp_path, more=text.replace(" MORE", more)).file
        assert len(mooring.accepts) == 1
        thin = SOUND.replace("weight: 0.2 N/m", "weight: 0.2 N/m, cn: 0.001")
        thin = thin.replace("CURRENT", HALF)
        judged = load(tmp_path / "m.yaml", text=thin + text.replace(" MORE", more))
        notices = assessment_of("m", environments_checked(judged, "m")).notices
        assert (
            notices.count("1 of 1 `accept` entries lacks a name (`by`) or an end date (`until`)")
            == count
        )


RECORD = """\
time,depth[m],speed[m/s],toward[deg]
2026-01-01T00:00,0,0.3,90
2026-01-01T00:00,200,0.2,90
2026-01-01T06:00,0,0.9,90
2026-01-01T06:00,200,0.4,90
"""


def test_a_current_weaker_than_its_own_record_is_told(tmp_path):
    (tmp_path / "record.csv").write_text(RECORD)
    calm, storm = (
        of(tmp_path, f"{{file: record.csv, time: '2026-01-01T{hour}:00'}}") for hour in ("00", "06")
    )
    told = "This current profile comes from a record. The strongest current in the record is "
    assert said(calm)[0] == ("warn", f"{told}0.90 m/s; the strongest current checked is 0.30 m/s.")
    assert [state for state, _ in said(storm)] == ["pass"]
    assert [state for state, _ in said(calm, storm)] == ["pass"]
