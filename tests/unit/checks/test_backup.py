"""Breaks at every connection above the release, by hand."""

import pytest

import calm
from calm.checks.design_check import check
from calm.checks.leg_graph import LegGraph


def losses_of(leg):
    return LegGraph.upright(leg).losses(leg)


FILE = """
name: By hand
environment:
  depth: 500 m
line:
  - {use: ball, label: top}
  - {use: thin, label: wire, length: 200 m, clamps: [{use: logger, at: 10 m}]}
  - {use: ball, label: back-up, buoyancy: 8 kN}
  - {use: thin, label: tail, length: 100 m}
  - {use: opener, label: release}
  - {use: thin, length: 50 m}
  - {use: block}
checks: {backup_margin: 0.1}
components:
  ball: {kind: body, length: 0 m, buoyancy: 2000 N, kn: 200 N/(m/s)^2, inclination: insensitive}
  opener: {kind: body, role: release, length: 0 m, buoyancy: -900 N, kn: 9 N/(m/s)^2, inclination: insensitive}
  logger: {kind: cylinder, diameter: 50 mm, length: 0.3 m, buoyancy: -20 N}
  thin: {kind: cable, diameter: 10 mm, weight: 15 N/m, ct: 0}
  block: {kind: anchor, weight: 15 kN}
"""  # noqa: E501


@pytest.fixture
def breaks(tmp_path):
    def of(text=FILE):
        path = tmp_path / "m.yaml"
        path.write_text(text)
        leg = calm.load(path).leg
        return LegGraph.upright(leg).breaks(leg)

    return of


def test_what_is_left_after_each_break(breaks):
    found = breaks()
    assert [each.break_after for each in found] == [0, 1, 2, 3]
    assert [each.label for each in found] == ["top", "wire", "back-up", "tail"]
    margins = [8000.0 - 3020.0 - 1500.0 - 900.0, 8000.0 - 2400.0, -2400.0, -900.0]
    assert [each.margin for each in found] == pytest.approx(margins)
    lifted = [3020.0 + 2400.0, 2400.0, 2400.0, 900.0]
    assert [each.weight_lifted for each in found] == pytest.approx(lifted)
    # the tail may break, and then nothing lifts the release
    assert all(each.judged for each in found)


def test_a_share_of_the_weight_is_required_and_what_raises_it(breaks):
    """At 0.3 m/s the drags of 200, 9 and, of the clamp along the wire, 0.8 N/(m/s)²."""
    required = [542.0, 240.0, 240.0, 90.0]
    assert [each.required for each in breaks()] == pytest.approx(required)
    more = breaks(FILE.replace("backup_margin: 0.1", "backup_margin: 0.2"))
    assert [each.required for each in more] == pytest.approx([2.0 * one for one in required])
    fast = "backup_margin: 0, minimum_rise_speed: 1 m/s"
    light = breaks(FILE.replace("backup_margin: 0.1", fast))
    assert [each.required for each in light[1:]] == pytest.approx([209.0, 9.0, 9.0])
    assert light[0].required == pytest.approx(209.8, abs=0.1)


def test_buoyancy_is_that_where_the_line_stands(breaks):
    """A float of 1 m³ at 400 m in water denser by 5 kg/m³ lifts 49 N more."""
    dense = "depth: 500 m\n  density: 1030 kg/m^3"
    text = FILE.replace("buoyancy: 8 kN", "buoyancy: 8 kN, volume: 1 m^3")
    plain, lifted = breaks(text), breaks(text.replace("depth: 500 m", dense))
    assert lifted[1].margin - plain[1].margin == pytest.approx(5.0 * 9.80665)


@pytest.fixture
def load(tmp_path):
    def of(text):
        path = tmp_path / "m.yaml"
        path.write_text(text)
        return calm.load(path)

    return of


def test_the_loss_of_each_float_and_clamped_ball(load):
    """The line holds: all that is above the release has to come up without the one that is lost."""
    balls = "{use: ball, at: 30 m, label: clamped, buoyancy: 1500 N}"
    text = FILE.replace("{use: logger, at: 10 m}", "{use: logger, at: 10 m}, " + balls)
    whole = 2000.0 + 1500.0 + 8000.0 - 3020.0 - 1500.0 - 900.0
    losses = losses_of(load(text).leg)
    assert [(each.index, each.label) for each in losses] == [
        (0, "top"), (1, "clamped"), (2, "back-up"),
    ]  # fmt: skip
    margins = [whole - 2000.0, whole - 1500.0, whole - 8000.0]
    assert [each.margin for each in losses] == pytest.approx(margins)
    # 3020 N of wire and logger less the 1500 N of the ball on it, 1500 N and 900 N are lifted
    assert [each.weight_lifted for each in losses] == pytest.approx([3920.0] * 3)
    assert [each.required for each in losses] == pytest.approx([392.0] * 3)


def test_a_float_that_floods_weighs_what_its_shell_does(load):
    figures = "label: top, mass: 20 kg, material: borosilicate glass"
    lost, *_ = losses_of(load(FILE.replace("label: top", figures)).leg)
    shell = 20.0 * 9.80665 * (1.0 - 1025.0 / 2230.0)
    assert lost.margin == pytest.approx(8000.0 - 3020.0 - 1500.0 - 900.0 - shell)
    assert lost.weight_lifted == pytest.approx(3020.0 + 1500.0 + 900.0 + shell)
    foam, *_ = losses_of(
        load(FILE.replace("label: top", "label: top, mass: 20 kg, material: foam")).leg
    )
    assert foam.margin == pytest.approx(8000.0 - 3020.0 - 1500.0 - 900.0)


def test_the_worse_of_breaks_and_losses_is_judged(load):
    def found(text):
        return next(one for one in check(load(text)).findings if one.rule == "backup")

    sound = FILE.replace("  - {use: thin, label: tail, length: 100 m}\n", "")
    one = found(sound)  # 2000 + 8000 - 3020 - 900 = 6080 N, 8000 N less by the loss
    assert one.message.startswith("After the loss of back-up")
    assert (one.value, one.state) == (pytest.approx(-1920.0), "fail")
    # four floats of 2 kN in place of one of 8 kN: any of them may be lost
    balls = "  - {use: ball, label: back-up, count: 4}\n"
    split = found(sound.replace("  - {use: ball, label: back-up, buoyancy: 8 kN}\n", balls))
    assert split.state == "pass"
    assert split.value == pytest.approx(4080.0)


def test_without_a_release_nothing_is_asked(breaks):
    assert breaks(FILE.replace("role: release, ", "")) == ()


def test_a_line_that_no_length_fits_tells_nothing(breaks):
    fit = "label: wire, length: fit, top_depth: 499 m"
    assert breaks(FILE.replace("label: wire, length: 200 m", fit)) == ()


def test_what_leads_from_the_lowest_floats_to_the_release_is_not_judged(breaks):
    text = FILE.replace(
        "  - {use: thin, label: tail, length: 100 m}\n",
        "  - {use: link}\n  - {use: ball, label: second, buoyancy: 8 kN}\n  - {use: link}\n",
    ).replace("components:\n", f"components:\n  {LINK}\n")
    judged = {each.label: each.judged for each in breaks(text)}
    # a break of the wire leaves both floats; between them and below, none in any design
    assert judged == {
        "top": True, "wire": True, "back-up": False, "link 1": False, "second": False,
        "link 2": False,
    }  # fmt: skip


def test_a_float_above_the_only_floats_is_no_back_up(breaks):
    """The wire between the main float and the release may break, whatever floats above that."""
    found = breaks(FILE.replace("label: top}", "label: pick-up}").replace("200 m", "11 m"))
    worst = min((each for each in found if each.judged), key=lambda each: each.margin)
    assert worst.label == "back-up" and worst.margin < 0.0


def test_a_compact_line_of_one_float_has_no_break_to_judge(breaks):
    text = FILE[: FILE.index("  - {use: thin, label: wire")]
    text += "  - {use: link}\n" + FILE[FILE.index("  - {use: opener, label: release}") :]
    text = text.replace("components:\n", f"components:\n  {LINK}\n")
    found = breaks(text.replace("length: 50 m", "length: 400 m"))
    assert [each.judged for each in found] == [False, False]


COMPACT = FILE[: FILE.index("  - {use: thin, label: wire")]
COMPACT += FILE[FILE.index("  - {use: opener, label: release}") :].replace("50 m", "400 m")


def test_a_compact_line_of_one_float_has_no_back_up_to_judge(tmp_path):
    (found,) = backup_of(tmp_path, COMPACT)
    assert (found.state, found.component) == ("not-judged", "top")
    assert found.message == "top provides all the buoyancy, so there is no back-up buoyancy."


@pytest.mark.parametrize("lead, judged", [(49.0, False), (51.0, True)])
def test_what_leads_from_the_only_float_to_the_release_may_be_short(breaks, lead, judged):
    """An instrument and a rope of less than 50 m do not ask for floats below them."""
    meter = "  - {use: ball, label: meter, buoyancy: -20 N}\n"
    rope = f"  - {{use: thin, label: rope, length: {lead} m}}\n"
    release = "  - {use: opener, label: release}"
    found = breaks(COMPACT.replace(release, meter + rope + release))
    assert [each.judged for each in found] == [judged] * 3


def test_of_several_floats_of_a_compact_line_any_may_be_lost(tmp_path):
    """Three floats of 400 N: two lift the 250 N of the release, and not 900 N."""
    three = COMPACT.replace("label: top}", "label: top, count: 3, buoyancy: 400 N}")
    (found,) = backup_of(tmp_path, three.replace("-900 N", "-250 N"))
    assert (found.state, found.value) == ("pass", pytest.approx(550.0))
    (found,) = backup_of(tmp_path, three)
    assert (found.state, found.value) == ("fail", pytest.approx(-100.0))


def test_a_release_that_floats_comes_up_after_any_break(tmp_path):
    text = COMPACT.replace("-900 N", "300 N").replace("label: top}", "label: top, count: 2}")
    (found,) = backup_of(tmp_path, text)
    assert found.state == "pass"


def test_a_surface_line_without_floats_below_its_buoy_is_warned_of(tmp_path):
    text = FILE.replace("  - {use: ball, label: back-up, buoyancy: 8 kN}\n", "")
    text = text.replace("buoyancy: 2000 N", "buoyancy: 30 kN").replace("15 kN", "60 kN")
    text = text.replace("500 m", "340 m")
    (found,) = backup_of(tmp_path, text)
    assert found.state == "warn"


def test_a_compact_line_with_glass_below_its_chain_passes(tmp_path):
    """Where float, chain and glass are all one cluster, chain parts it in two."""
    wire = FILE.index("  - {use: thin, label: wire")
    text = FILE[:wire] + "  - {use: links, label: chain, length: 2 m}\n"
    text += "  - {use: ball, label: glass}\n" + FILE[FILE.index("  - {use: opener") :]
    text = text.replace("50 m", "400 m").replace("components:\n", f"components:\n  {LINKS}\n")
    (found,) = backup_of(tmp_path, text)
    assert found.state == "pass"


def test_releases_that_follow_one_another_are_no_break_that_a_design_can_mend(breaks):
    text = FILE.replace("  - {use: thin, label: tail, length: 100 m}\n", "")
    twice = text.replace("label: release}", "label: release, count: 2}")
    assert [each.judged for each in breaks(twice)] == [True, True, False, False]


def test_a_line_hauled_in_from_its_buoy_needs_no_release(tmp_path):
    text = FILE.replace("  - {use: opener, label: release}\n", "").replace("500 m", "340 m")
    text = text.replace("buoyancy: 2000 N", "buoyancy: 30 kN").replace("15 kN", "60 kN")
    (found,) = backup_of(tmp_path, text)
    assert (found.state, found.value) == ("not-judged", None)
    assert "without a release is hauled in" in found.message
    found = check(calm.load(tmp_path / "m.yaml")).findings
    (rise,) = [one for one in found if one.rule == "recovery"]
    assert rise.state == "not-judged"


def backup_of(folder, text):
    path = folder / "m.yaml"
    path.write_text(text)
    return [one for one in check(calm.load(path)).findings if one.rule == "backup"]


LINKS = "links: {kind: chain, diameter: 10 mm, weight: 17 N/m}"
LINK = (
    "link: {kind: body, role: connector, length: 0 m, buoyancy: -5 N, kn: 0 N/(m/s)^2,"
    " inclination: insensitive}"
)
