import json
import re

import pytest

from tests.drawings import assert_none_overlap, curves_of, words_of

RANGES = """\
latitude[deg],longitude[deg],range[m]
48.313488,-5.200000,2497.3
48.306743,-5.182485,2497.1
48.293256,-5.182490,2497.2
48.286512,-5.200000,2497.0
48.293256,-5.217510,2497.2
48.306743,-5.217515,2597.1
"""
"""1500 m from 48.3, -5.2 every 60 degrees, of an anchor at 2000 m; the last is 100 m too long."""


@pytest.fixture
def ranges(folder):
    def write(text=RANGES, name="ranges.csv"):
        (folder / name).write_text(text, encoding="utf-8")
        return name

    return write


def test_the_place(calm, ranges):
    done = calm("locate", ranges(), "--transducer", "3 m", "--json", "-")
    assert done.code == 0
    document = json.loads(done.out)
    assert document["latitude"] == pytest.approx(48.3, abs=1e-5)
    assert document["longitude"] == pytest.approx(-5.2, abs=1e-5)
    assert document["depth"] == pytest.approx(1999.5, abs=1.0)
    # five ranges from round about: 2 m of range and ship, no less, times 2.45 for 95 % in a plane
    assert 4.0 < document["horizontal_95"] < 7.0
    assert (document["used"], document["rejected"]) == ([2, 3, 4, 5, 6], [7])
    assert document["second"] is None
    assert len(document["residuals"]) == 6
    assert [one["line"] for one in document["outliers"]] == [7]


def test_what_a_person_reads(calm, ranges):
    done = calm("locate", ranges())
    assert done.code == 0
    assert "48° 18.000′ N" in done.out
    assert "Rejected as outliers: line 7." in done.out
    assert done.err == ""


def test_height_of_what_answers_and_a_given_depth(calm, ranges):
    found = json.loads(calm("locate", ranges(), "--above-seabed", "30 m", "--json", "-").out)
    assert found["depth"] == pytest.approx(2026.5, abs=1.0)
    done = calm("locate", ranges(), "--depth", "2026.5 m", "--above-seabed", "30 m", "--json", "-")
    assert json.loads(done.out)["depth"] == pytest.approx(2026.5, abs=1e-6)


def test_it_is_written_into_the_mooring_and_nothing_else_changes(
    calm, ranges, write_mooring, folder
):
    write_mooring("m.yaml")
    text = (folder / "m.yaml").read_text().replace("depth: 100 m", "depth: 1990 m") + (
        "deployed:   # by the mate\n  date: 2027-03-02   # a Tuesday\n"
        "  depth: 12 m\n  items: [{label: rope, remark: remade}]\n"
    )
    (folder / "m.yaml").write_text(text)
    done = calm("locate", ranges(), "--update", "m.yaml")
    assert done.code == 0
    written = (folder / "m.yaml").read_text()
    assert "deployed:   # by the mate\n  date: 2027-03-02   # a Tuesday\n" in written
    assert "position: {latitude: 48.299999 deg, longitude: -5.199998 deg}" in written
    assert "depth: 12 m" not in written
    kept = [line for line in text.splitlines() if "depth: 12 m" not in line]
    assert [line for line in kept if line not in written.splitlines()] == []
    assert calm("diff", "m.yaml").code == 0


def test_it_is_compared_with_the_plan(calm, ranges, write_mooring, folder):
    def located(position, depth=2000):
        write_mooring("m.yaml")
        text = (folder / "m.yaml").read_text()
        text = re.sub(r"depth: \d+ m", f"depth: {depth} m", text, count=1)
        (folder / "m.yaml").write_text(f"position: {{{position}}}\n{text}")
        return calm("locate", ranges(), "--update", "m.yaml", "--sound-speed", "1480 m/s")

    # a thousandth of a degree south is 111 m on WGS 84
    done = located("latitude: 48.301 deg, longitude: -5.2 deg")
    assert done.code == 0
    assert "m.yaml: 111 m towards 180° of the planned position" in done.err
    assert "3.3 m less deep than planned" in done.err
    assert "far from the planned" not in done.err
    assert "--sound-speed is ignored because the ranges are already in metres" in done.err
    done = located("latitude: 48.4 deg, longitude: -5.2 deg", depth=1500)
    assert done.code == 1
    assert "deployed" not in (folder / "m.yaml").read_text()
    assert "m.yaml was not changed: the depth of 1997 m is far from the planned " in done.err
    assert "; the position is 11.1 km from the planned position. Use --accept" in done.err
    assert "the result is far from the planned position" in done.err
    done = located("latitude: -5.2 deg, longitude: 48.3 deg")
    assert done.code == 2
    assert "latitude and longitude appear to be exchanged" in done.err
    assert "deployed" not in (folder / "m.yaml").read_text()


THREE = """\
latitude,longitude,range[m]
57.7905,-19.2033,2460
57 48.72 N,19-10.404W,1561
57°47.454'N,19 09 13.32 W,1786
"""
"""A survey of the National Oceanography Centre of an anchor at 57.801 N, 19.171 W, 954 m deep, its
release 10 m up and the transducer at 5 m; two of its positions as the bridge writes them."""


def test_three_ranges_are_all_counted(calm, ranges):
    done = calm(
        "locate", ranges(THREE), "--depth", "954 m", "--above-seabed", "10 m",
        "--transducer", "5 m", "--json", "-",
    )  # fmt: skip
    document = json.loads(done.out)
    # 57.801 N, 19.171 W to a thousandth of a degree; two were fitted exactly, 1.7 km off
    assert document["latitude"] == pytest.approx(57.801, abs=5e-4)
    assert document["longitude"] == pytest.approx(-19.171, abs=5e-4)
    assert (document["used"], document["rejected"]) == ([2, 3, 4], [])


LINE = """\
latitude,longitude,range[m]
48.300,-5.220,2487.5
48.300,-5.200,2000.0
48.300,-5.180,2487.6
48.300,-5.190,2133.6
48.300,-5.210,2133.5
"""
"""Along a parallel, of what is 1732 m deep and 1000 m to the north of it, or of its south."""


def test_of_two_places_the_one_near_the_plan_is_taken(calm, ranges, write_mooring, folder):
    def written(*options, position=None):
        write_mooring("m.yaml")
        text = (folder / "m.yaml").read_text().replace("depth: 100 m", "depth: 1732 m")
        plan = "" if position is None else f"position: {{{position}}}\n"
        (folder / "m.yaml").write_text(plan + text)
        done = calm(
            "locate", ranges(LINE), "--depth", "1732 m", "--update", "m.yaml", "--json", "-",
            *options,
        )  # fmt: skip
        return done, json.loads(done.out), "deployed" in (folder / "m.yaml").read_text()

    done, document, updated = written()
    assert (done.code, updated) == (1, False)
    assert "m.yaml was not changed: two positions fit; select one with --near LAT,LON" in done.err
    assert document["second"]["distance"] == pytest.approx(2000.0, rel=0.01)
    assert written("--accept")[2]
    for position, side in (("48 18.5 N", 1.0), ("48°17.5'N", -1.0)):
        done, document, updated = written(
            position=f"latitude: {json.dumps(position)}, longitude: 5 12.0 W"
        )
        assert (done.code, updated) == (0, True)
        assert (document["latitude"] - 48.3) * side == pytest.approx(1000.0 / 111_200.0, rel=0.01)
        # what is told on the command line goes before the plan
        other = written("--near", f"{48.3 - 0.009 * side},-5.2", position="latitude: 48.3 deg, "
                        "longitude: -5.2 deg")[1]  # fmt: skip
        assert (other["latitude"] - 48.3) * side < 0.0


@pytest.mark.parametrize(("depth", "code"), [(1968, 0), (2028, 0), (1930, 1), (2065, 1)])
def test_a_depth_far_from_the_plan_is_not_written(calm, ranges, write_mooring, folder, depth, code):
    write_mooring("m.yaml")  # found 1996.7 m deep: 3 % of the plan are 59 to 62 m
    text = (folder / "m.yaml").read_text().replace("depth: 100 m", f"depth: {depth} m")
    (folder / "m.yaml").write_text(text)
    done = calm("locate", ranges(), "--update", "m.yaml")
    assert done.code == code
    assert ("deployed" in (folder / "m.yaml").read_text()) == (code == 0)
    assert calm("locate", ranges(), "--update", "m.yaml", "--accept").code == 0


NEARLY_ON_ONE_COURSE = """\
latitude,longitude,range[m]
48.3140,-5.1860,2893.5
48.3002,-5.2005,1961.0
48.2860,-5.2140,2548.7
"""
"""Of an anchor at 48.2919 N, 5.1879 W, 1500 m deep, each range off by 10 to 35 m: a place 2520 m
away, on the other side of the course, fits all of them to 4 m."""


def test_three_ranges_on_one_course_have_two_places(calm, ranges, write_mooring, folder):
    name, given = ranges(NEARLY_ON_ONE_COURSE), ["--depth", "1500 m"]
    done = calm("locate", name, *given, "--json", "-")
    alone = json.loads(done.out)
    assert done.code == 1 and alone["longitude"] == pytest.approx(-5.214, abs=0.003)
    assert alone["second"]["distance"] == pytest.approx(2520.0, rel=0.05)
    write_mooring("m.yaml")
    text = (folder / "m.yaml").read_text().replace("depth: 100 m", "depth: 1500 m")
    plan = "position: {latitude: 48.2919 deg, longitude: -5.1879 deg}\n"
    (folder / "m.yaml").write_text(plan + text)
    done = calm("locate", name, *given, "--json", "-", "--update", "m.yaml")
    document = json.loads(done.out)
    assert done.code == 1
    assert document["latitude"] == pytest.approx(48.2919, abs=1e-3)
    assert document["longitude"] == pytest.approx(-5.1879, abs=1e-3)
    assert document["second"]["distance"] == pytest.approx(2520.0, rel=0.05)
    assert re.search(r"two positions remain, \d+ and 25\d\d m from the planned position", done.err)
    assert "deployed" not in (folder / "m.yaml").read_text()
    done = calm("locate", name, "--update", "m.yaml", "--json", "-")  # of unknown depth
    assert done.code == 1 and "two positions remain" in done.err
    assert json.loads(done.out)["second"]["distance"] > 1900.0
    assert "deployed" not in (folder / "m.yaml").read_text()
    assert calm("locate", name, *given, "--update", "m.yaml", "--accept").code == 0


@pytest.mark.parametrize(("hemisphere", "place"), [
    ("S,W", (-48.3, -5.2)), ("S", (-48.3, 5.2)), ("W,N", (48.3, -5.2)), ("N,E", (48.3, 5.2)),
])  # fmt: skip
def test_positions_without_letters_have_those_that_are_given(calm, ranges, hemisphere, place):
    text = RANGES.replace(",-5", ",5")
    done = calm("locate", ranges(text), "--hemisphere", hemisphere, "--json", "-")
    found = json.loads(done.out)
    assert (found["latitude"], found["longitude"]) == pytest.approx(place, abs=1e-4)
    signed = calm("locate", ranges(RANGES), "--hemisphere", hemisphere, "--json", "-")
    assert json.loads(signed.out)["longitude"] == pytest.approx(-5.2, abs=1e-4)
    for wrong in ("S,S", "X", "S,N"):
        done = calm("locate", ranges(text), "--hemisphere", wrong)
        assert done.code == 2 and "is not a pair of letters such as S,W" in done.err


def test_degrees_and_minutes_written_as_decimals_are_named(calm, ranges, write_mooring, folder):
    write_mooring("m.yaml")
    text = (folder / "m.yaml").read_text().replace("depth: 100 m", "depth: 2000 m")
    position = "position: {latitude: 48.5 deg, longitude: -5.333333 deg}\n"
    (folder / "m.yaml").write_text(position + text)
    done = calm("locate", ranges(), "--update", "m.yaml")
    assert done.code == 1
    assert (
        "near the planned position if 48.18, for example, means 48 degrees 18 minutes" in done.err
    )


def test_horizontal_distances_are_refused(calm, ranges):
    text = re.sub(r"\d+\.\d$", "1500.0", RANGES, flags=re.M)
    done = calm("locate", ranges(text))
    assert done.code == 2
    assert "are they horizontal distances?" in done.err


def test_what_scatters_more_than_ranging_does_is_not_written(calm, ranges, write_mooring, folder):
    lines, wrong = RANGES.splitlines(), (120.0, -90.0, 140.0, -160.0, 60.0, -70.0)
    made = [lines[0]]
    for line, off in zip(lines[1:], wrong, strict=True):
        *place, measured = line.split(",")
        made.append(",".join([*place, f"{float(measured) + off:.1f}"]))
    write_mooring("m.yaml")
    done = calm("locate", ranges("\n".join(made) + "\n"), "--update", "m.yaml")
    assert done.code == 1
    scattered = r"was not changed: the ranges scatter by \d+ m, more than is usual"
    assert re.search(scattered, done.err)
    assert "deployed" not in (folder / "m.yaml").read_text()


def test_a_file_that_cannot_take_it_is_refused_before_anything_is_written(
    calm, ranges, broken, folder
):
    done = calm("locate", ranges(), "--update", "broken.yaml", "--plot", "circles.svg")
    assert done.code == 2
    assert done.out == ""
    assert not (folder / "circles.svg").exists()
    assert calm("locate", ranges(), "--update", "none.yaml").code == 2


def test_the_plot(calm, ranges, folder):
    assert calm("locate", ranges(), "--plot", "circles.svg").code == 0
    svg = (folder / "circles.svg").read_text(encoding="utf-8")
    words = words_of(svg)
    assert {
        "all ranges, with their line numbers in the file",
        "2",
        "7",
        "north of the anchor [m]",
    } <= set(words)
    assert_none_overlap(svg)
    circles = curves_of(svg, "#2b7bba") + curves_of(svg, "#999999")
    assert [dashed for _, dashed in circles] == [False] * 10 + [True] * 2  # the last is left out
    assert calm("locate", ranges(), "--plot", "circles.txt").code == 2


def test_every_mistake_at_once_with_its_line(calm, ranges):
    text = (
        "latitude,longitude[deg],range\n148.3,-5.2,2000\n0,0,2000\n48.3,-5.2,-9999\n"
        "48.3,-5.2\n48 72N,-5.2,x\n48.3,-5.2,-1\n10.0,-5.2,2000\n48.3,-5.2,99000\n"
        "48.31,-5.21,2000\n48.32,-5.21,2000\n48.33,-5.21,2000\n48.34,-5.21,2000\n"
    )
    done = calm("locate", ranges(text))
    assert done.code == 2
    assert done.out == ""
    said = [line.split(":", 3)[1::2] for line in done.err.splitlines()]
    assert [number for number, _ in said] == ["1", "2", "3", "4", "5", "6", "6", "7", "8", "9"]
    for (_, message), part in zip(
        said,
        [
            "column `range` needs a unit; did you mean `range[m]`?",
            "is beyond 90 degrees; are latitude and longitude exchanged?",
            "position 0, 0 is a fill value",
            "is a fill value; leave the cell blank",
            "the row has 2 values; 3 are needed",
            "has minutes or seconds of 60 or more",
            "is no number",
            "must be above 0",
            "km from the other positions",
            "the maximum for an acoustic transponder",
        ],
        strict=True,
    ):
        assert part in message


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("", "is empty"),
        ("48.3,-5.2,2000\n", "there is no header"),
        ("latitude[deg],longitude[deg]\n48.3,-5.2\n", "there is no column `range[m]` or `time[s]`"),
        (
            "alt[deg],longitude[deg],range[m]\n48.3,-5.2,1\n",
            "there is no column `latitude[deg]`",
        ),
        ("latitude[deg],longitude[deg],time[s]\n48.3,-5.2,2750\n", "did you mean `time[ms]`?"),
        (
            "latitude[deg],longitude[deg],range[ell]\n48.3,-5.2,1\n",
            "`range[ell]` has an unknown unit, `ell`",
        ),
        ("latitude[deg];longitude[deg];range[m]\n48,3;-5.2;2000\n", "degrees are needed, such as"),
        (RANGES.split("48.29")[0], "2 ranges; 3 are needed"),
        (re.sub(r"\d+\.\d$", "90.0", RANGES, flags=re.M), "the ranges do not intersect"),
    ],
)
def test_files_that_are_none(calm, ranges, text, said):
    done = calm("locate", ranges(text))
    assert done.code == 2
    assert said in done.err


def test_what_was_not_answered_and_what_repeats_is_left_out(calm, ranges):
    lines = RANGES.splitlines()
    text = "\n".join(["# night of the 3rd", *lines[:6], lines[1], "48.3,-5.2,nan", "48.3,-5.2,"])
    done = calm("locate", ranges(text), "--json", "-")
    assert done.code == 0
    assert "line 8 of the file repeats line 3 and was ignored" in done.err
    assert "rows without a reply were ignored: lines 9, 10" in done.err
    assert json.loads(done.out)["lines"] == [3, 4, 5, 6, 7]


def test_times_and_a_profile_of_the_sound(calm, ranges, folder):
    times = RANGES.splitlines()[:6]
    text = "latitude[deg],longitude[deg],time[ms]\n" + "\n".join(
        ",".join([*line.split(",")[:2], str(2000.0 * float(line.split(",")[2]) / 1490.0)])
        for line in times[1:]
    )
    (folder / "sound.csv").write_text("depth[km],sound_speed[km/h]\n0,5328\n2,5400\n")
    done = calm("locate", ranges(text), "--sound-speed", "sound.csv", "--json", "-")
    assert done.code == 0
    document = json.loads(done.out)
    assert document["sound_speed"] == pytest.approx(1490.0, abs=0.1)
    assert document["depth"] == pytest.approx(1996.5, abs=2.0)
    (folder / "sound.csv").write_text("depth[m],sound_speed[m/s]\n10,1480\n5,150\n")
    done = calm("locate", ranges(text), "--sound-speed", "sound.csv")
    assert done.code == 2
    assert "must increase" in done.err
    assert "is not a speed of sound in water" in done.err
    assert calm("locate", ranges(text), "--sound-speed", "300 m/s").code == 2
