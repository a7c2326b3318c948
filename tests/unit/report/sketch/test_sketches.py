"""Every picture: what it shows stands where the figures are."""

import re
from copy import copy
from dataclasses import replace

import pytest

from calm.drawing.sketch import SIGNS, current_profile, elevation, plan, tension

ALL = (
    "a-frame-sheared-tow",
    "bourget-marichal-sphere",
    "braconnot-buoy",
    "cdms-1",
    "deep-current-meters",
    "helicopter-bird",
    "receiver-line",
    "taut-nylon-surface",
    "tidal-adcp",
)
PICTURES = {"elevation": elevation, "plan": plan, "tension": tension}
ANSI = {"black", "red", "green", "yellow", "blue", "magenta", "cyan", "white"}


def rows(texts) -> list[str]:
    return [text.plain for text in texts]


def water_of(result):
    return result.water


@pytest.mark.parametrize("name", ALL)
@pytest.mark.parametrize("size", [(20, 6), (27, 9), (38, 18), (60, 30)])
def test_pictures_fill_their_cells(solved, name, size):
    result = solved(name)
    drawn = [draw(result, *size) for draw in PICTURES.values()]
    drawn.append(current_profile(water_of(result), *size))
    for texts in drawn:
        assert [text.cell_len for text in texts] == [size[0]] * size[1]


@pytest.mark.parametrize("picture", PICTURES)
def test_they_need_no_more_than_eight_colours(solved, picture):
    texts = PICTURES[picture](solved("deep-current-meters"), 38, 18)
    styles = {word for text in texts for span in text.spans for word in str(span.style).split()}
    assert styles <= ANSI | {"bold", "none"}


def test_elevation_of_s1000(solved):
    assert rows(elevation(solved("s1000"), 30, 12)) == [
        "top 131.4 m, 237.3 m off to 09",
        "   0┤⠉⡉⠉⠉⠉⠉⠉⠉⠉⠉⠉⠉⠉⠉⠉⠉⠉⠉⠉⠉⠉⠉⠉⠉⠉",
        "    │ ⠄                     ● ",
        "    │ ⠂                   ⣠⠞  ",
        "    │ ⡁                ⢀⡠⠚⠁   ",
        " 500┤ ⠄              ⣠⠔⠋      ",
        "    │ ⠂          ⢀⡠⠔⠋         ",
        "    │ ⡁       ⣀⠤⠒⠉            ",
        "    │ ⠄   ⣀⠤⠒⠉                ",
        "1000┤ ▼⠤⠒⠉                    ",
        "1100 ▒┴▒▒▒▒▒▒▒▒┴▒▒▒▒▒▒▒▒▒┴▒▒▒▒",
        "      0       100       200 m ",
    ]


def test_plan_of_veering_current(solved):
    assert rows(plan(solved("veering-current"), 24, 12)) == [
        "top 52.5 m off to 174°  ",
        "  0┤N ⠄ ⠄ ⠄ ◆▼● ⠄ ⠄ ⠄ ⠄ ",
        "   │         ⣇          ",
        "   │        ⢠●■         ",
        "-20┤        ⢸⢀          ",
        "   │        ⢸⢀          ",
        "   │        ⢸⣀          ",
        "-40┤         ■          ",
        "   │         ⢘■         ",
        "   │         ⢀■●        ",
        "  m───┴──────┴───────┴──",
        "     -25     0 m E      ",
    ]


def test_tension_of_veering_current(solved):
    assert rows(tension(solved("veering-current"), 24, 12)) == [
        "at most 3598 N; dotted: ",
        "  0┤⠉⠉⠉⠉⠉⠉⣩⠇          ⠅ ",
        "   │     ⢀⡇           ⠅ ",
        "   │    ⢀⣸            ⠅ ",
        "   │    ⢸               ",
        "   │    ⢸               ",
        "500┤    ⢸               ",
        "   │    ⠸⡤              ",
        "   │     ⡇              ",
        "   │     ⢧⣀⣀⣀           ",
        "  m─┴───────────┴───────",
        "    0         5000 N    ",
    ]


def cell_of(texts, sign):
    """Row and column of the only such sign."""
    ((row, column),) = [
        (number, match.start())
        for number, text in enumerate(rows(texts))
        for match in re.finditer(re.escape(sign), text)
    ]
    return row, column


@pytest.mark.parametrize("height", [12, 24, 40])
def test_depth_and_offset_are_read_off_the_scales(solved, height):
    result, width = solved("s1000"), 49
    texts = elevation(result, width, height)
    row, column = cell_of(texts, SIGNS["float"][0])
    drawn = height - 3
    # row 1 begins at the surface and the last ends at the seabed; a cell is known to half of it
    assert (row - 0.5) / drawn * 1100.0 == pytest.approx(131.4, abs=0.6 * 1100.0 / drawn)
    marks = [match.start() for match in re.finditer("┴", texts[-2].plain)]
    labels = [int(text) for text in re.findall(r"\d+", texts[-1].plain)]
    per_cell = (labels[-1] - labels[0]) / (marks[len(labels) - 1] - marks[0])
    assert (column - marks[0]) * per_cell == pytest.approx(237.3, abs=1.1 * per_cell)


def test_still_water_stands_beside_the_line_only_where_that_is_moved(solved):
    bent = rows(elevation(solved("deep-current-meters"), 38, 18))
    anchor = bent[-2].index("┴")
    assert all(row[anchor] in "⡁⡀⠄⠂⠁" for row in bent[2:14])


def test_a_tow_is_drawn_behind_its_ship_with_the_body_at_its_depth(solved):
    texts = elevation(solved("depressor-fit-depth"), 38, 18)
    assert texts[0].plain.rstrip() == "body 75.6 m, 101.8 m behind"
    assert cell_of(texts, "▲") == (1, 4)
    assert texts[-2].plain.startswith("95 ▒")


def test_seabed_of_a_tow_far_below_is_not_drawn(solved):
    texts = elevation(solved("a-frame-sheared-tow"), 38, 18)
    assert "▒" not in texts[-2].plain
    assert "0┤" in texts[2].plain


def test_a_helicopter_tows_in_no_water(solved):
    texts = elevation(solved("helicopter-bird"), 38, 18)
    assert texts[0].plain.rstrip() == "body 29.6 m below, 4.8 m behind"
    assert all("blue" not in str(span.style) for text in texts for span in text.spans)


def test_names_stand_beside_their_parts(solved):
    result = solved("taut-nylon-surface")
    texts = rows(elevation(result, 60, 30))
    named = {text[45:].strip(): row for row, text in enumerate(texts)}
    for clamp in result.clamps:
        if clamp.label in named:
            # within the row of its part and one and a half more
            row = clamp.depth / 2000.0 * 27
            assert named[clamp.label] - 1 + 0.5 == pytest.approx(row, abs=2.0)
    assert {"CTD 100 m", "CTD 500 m", "releases pair"} <= set(named)
    assert texts[1].rstrip().endswith(" buoy")
    assert not any("CTD" in text for text in rows(elevation(result, 49, 30)))


def test_where_names_crowd_instruments_go_first(solved):
    texts = rows(elevation(solved("deep-current-meters"), 60, 30))
    named = [text[45:].strip() for text in texts if text[45:].strip()]
    assert {"top float", "releases pair", "meter 500 m"} <= set(named)
    assert len(named) < 27


def test_plan_has_one_scale(solved):
    texts = plan(solved("deep-current-meters"), 46, 24)
    marks = [match.start() for match in re.finditer("┴", texts[-2].plain)]
    labels = [int(text) for text in re.findall(r"-?\d+", texts[-1].plain)]
    per_column = (labels[-1] - labels[0]) / (marks[-1] - marks[0])
    levels = [
        (row, int(match[1]))
        for row, text in enumerate(texts[:-2])
        if (match := re.match(r" *(-?\d+)┤", text.plain))
    ]
    (row, high), (last, low) = levels[0], levels[-1]
    # a cell is twice as high as wide; ticks are on whole cells
    assert (high - low) / (last - row) == pytest.approx(2.0 * per_column, rel=0.15)


def test_current_is_on_the_rows_of_the_elevation(solved):
    result = solved("deep-current-meters")
    side = rows(elevation(result, 38, 18))
    beside = rows(current_profile(water_of(result), 22, 18))
    assert [row[:5] for row in side[1:-1]] == [row[:5] for row in beside[1:-1]]


def test_current_tells_speed_and_direction(solved):
    texts = rows(current_profile(water_of(solved("deep-current-meters")), 22, 18))
    assert texts[1].endswith("070°→") and texts[4].endswith("064°↗")
    narrow = rows(current_profile(water_of(solved("deep-current-meters")), 14, 18))
    assert narrow[1].endswith(" →")


def test_still_water_says_so(solved):
    water = water_of(solved("s1000")).still()
    assert current_profile(water, 20, 10)[0].plain.rstrip() == "still water"


def test_tension_tells_the_greatest_and_dots_the_limits(solved):
    result = solved("deep-current-meters")
    texts = tension(result, 38, 18)
    assert texts[0].plain.rstrip() == "at most 5157 N; dotted: limits"
    assert any("red" in str(span.style) for text in texts for span in text.spans)
    texts = tension(solved("s1000"), 38, 18)
    assert texts[0].plain.rstrip() == "at most 4003 N"


def test_great_tensions_are_in_kilonewtons(solved):
    result = solved("taut-nylon-surface")
    greater = copy(result)
    vars(greater)["shape"] = replace(result.shape, tension=10.0 * result.shape.tension)
    assert tension(result, 38, 18)[-1].plain.split()[-1] == "N"
    assert tension(greater, 38, 18)[-1].plain.split()[-2:] == ["50", "kN"]
