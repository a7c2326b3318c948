"""Depth, density, current, wind and environments."""

import numpy
import pytest
import xarray
from textual.events import Paste

from calm.tui.field import Field
from calm.tui.table_field import Grid, GridCells
from calm.tui.water_screen import WaterScreen
from calm.tui.water_tables import _existing, imported
from tests.tui.conftest import MOORING

CURRENT = ("environment", "current")


def field(driver, id):
    return driver.app.screen.query_one(f"#{id}", Field)


async def enter(driver, id, text):
    chosen = field(driver, id)
    chosen.input.focus()
    await driver.pilot.pause()
    chosen.input.action_select_all()
    await driver.press("delete")
    await driver.type(text)
    await driver.press("enter")


def cells(driver, id="current-table"):
    return driver.app.screen.query_one(f"#{id}", Grid).query_one(GridCells)


async def turn(driver, id, *keys):
    driver.app.screen.query_one(f"#{id}").focus()
    await driver.press(*keys or ("right",), "enter")


def value(driver, *keys):
    return driver.session.draft.value(("environment", *keys))


def test_change_the_depth_and_see_it(drive, small):
    async def story(driver):
        await driver.press("w")
        assert isinstance(driver.app.screen, WaterScreen)
        await enter(driver, "depth", "120")
        await driver.settle()
        assert driver.session.draft.value(("environment", "depth")) == "120 m"
        assert "  depth: 120 m                        # at low water\n" in driver.text
        assert driver.view.file.environment.depth == 120.0
        await driver.press("escape")
        assert driver.app.screen is driver.builder

    drive(story, small)


def test_a_mass_is_not_taken_as_depth(drive, small):
    async def story(driver):
        await driver.press("w")
        before = driver.text
        await enter(driver, "depth", "120 kg")
        assert "is a mass" in driver.screen
        await driver.press("escape")
        assert driver.text == before

    drive(story, small)


def test_a_uniform_current_becomes_a_table_whose_cells_are_edited(drive, small):
    async def story(driver):
        await driver.press("w")
        await turn(driver, "current-form")
        assert driver.session.draft.value((*CURRENT, "rows")) == [
            ["0", "0.5", "90"], ["100", "0.5", "90"],
        ]  # fmt: skip
        cells(driver).focus()
        await driver.press("right", "0", "full_stop", "8", "enter")
        await driver.settle()
        assert driver.session.draft.value((*CURRENT, "rows"))[0] == ["0", "0.8", "90"]
        assert driver.view.file.environment.current.u[0] == pytest.approx(0.8)
        await driver.press("a", "4", "0", "enter")
        assert driver.session.draft.value((*CURRENT, "rows"))[1] == ["40", "0.65", "90"]
        await driver.press("delete")
        assert len(driver.session.draft.value((*CURRENT, "rows"))) == 2

    drive(story, small)


@pytest.mark.parametrize(
    ("unit", "above", "below", "half"),
    [
        ("deg", "350", "10", "0"),
        *(
            pytest.param(*each, marks=pytest.mark.thorough)
            for each in (("deg", "20", "300", "340"), ("deg", "-20", "60", "20"),
                         ("rad", "6", "0.5", "0.108407"))
        ),
    ],
)  # fmt: skip
def test_a_row_between_others_has_the_direction_between_theirs(
    drive, small, unit, above, below, half
):
    table = f"{{columns: [depth m, speed m/s, toward {unit}], rows: [[0, 0.5, {above}], "
    table += f"[100, 0.3, {below}]]}}"
    small.write_text(MOORING.replace("{speed: 0.5 m/s, toward: 90 deg}", table))

    async def story(driver):
        await driver.press("w")
        cells(driver).focus()
        await driver.press("a", "escape")
        # in radians (6 + 0.5 + 2 pi) / 2 - 2 pi, six digits
        assert value(driver, "current", "rows")[1] == ["50", "0.4", half]

    drive(story, small)


def test_of_a_row_only_what_is_changed_is_written_anew(drive, small):
    table = """
    columns: [depth m, speed m/s, toward deg]
    rows:
      - [0, 0.50, 350]   # surf
      - [1e2, '0.20',  10]"""
    small.write_text(MOORING.replace("{speed: 0.5 m/s, toward: 90 deg}", table))

    async def story(driver):
        await driver.press("w")
        cells(driver).focus()
        await driver.press("right", *"0", "full_stop", "6", "enter")
        assert driver.text == small.read_text().replace("0.50, 350]", "0.6, 350]")

    drive(story, small)


def test_what_is_no_number_is_not_taken_in_a_table(drive, small):
    async def story(driver):
        await driver.press("w")
        await turn(driver, "current-form")
        cells(driver).focus()
        await driver.press("enter")
        await driver.type("5 x")
        await driver.press("enter", "escape")
        assert driver.session.draft.value((*CURRENT, "rows"))[0] == ["0", "0.5", "90"]

    drive(story, small)


async def paste(driver, text, *keys):
    cells(driver).post_message(Paste(text))
    await driver.settle()
    if keys:
        await driver.press(*keys)
        await driver.settle()
    return value(driver, "current", "rows")


def test_rows_of_a_spreadsheet_are_pasted(drive, small):
    async def story(driver):
        await driver.press("w")
        await turn(driver, "current-form")
        cells(driver).focus()
        await driver.pilot.pause()
        first = "depth m\tspeed m/s\ttoward deg\n0\t0.9\t70\n100\t0.1\t60\n"
        before = value(driver, "current", "rows")
        assert await paste(driver, first) == before  # it is shown before it is taken
        assert "Paste a table" in driver.screen and "100      0.1" in driver.screen
        await driver.press("enter")
        await driver.settle()
        rows = value(driver, "current", "rows")
        assert rows == [["0", "0.9", "70"], ["100", "0.1", "60"]]
        rows = await paste(
            driver, "Depth (m);Speed (knot);From (deg)\n0;1;250\n100;0.5;240\n", "enter"
        )
        assert rows == [["0", "0.514444444", "70"], ["100", "0.257222222", "60"]]
        cells(driver).focus()
        before = driver.text
        await paste(driver, "0\t0.9\t70\n50\tn/a\t70\n100\t0.1\t60")
        assert "Not pasted: row 2: `n/a` is not a plain number" in driver.screen
        assert driver.text == before

    drive(story, small)


def test_columns_without_headings_are_asked_for(drive, small):
    async def story(driver):
        await driver.press("w")
        await turn(driver, "current-form")
        cells(driver).focus()
        await driver.pilot.pause()
        before = value(driver, "current", "rows")
        assert await paste(driver, "0,0.8,70\n\n90,0.1,60") == before
        assert "has no headings" in driver.screen
        await driver.press("enter")
        await driver.settle()
        rows = [["0", "0.8", "70"], ["90", "0.1", "60"]]
        assert value(driver, "current", "rows") == rows
        cells(driver).focus()
        assert await paste(driver, "depth,u,v\n0,0.5,0\n90,0,0.1", "escape") == rows

    drive(story, small)


def test_a_preset_current(drive, small):
    async def story(driver):
        await driver.press("w", "ctrl+t", "3")
        await driver.settle()
        rows = driver.session.draft.value((*CURRENT, "rows"))
        assert rows[0] == ["0", "0.8", "90"]
        assert rows[-1] == ["100", "0", "90"]
        assert driver.view.result is not None

    drive(story, small)


def test_arrows_and_enter_choose_a_preset_current(drive, small):
    async def story(driver):
        await driver.press("w", "ctrl+t", "up", "up", "enter")
        await driver.settle()
        rows = driver.session.draft.value((*CURRENT, "rows"))
        assert (rows[0], rows[-1]) == (["0", "0.8", "90"], ["100", "0", "90"])
        await driver.press("ctrl+t", "enter")
        await driver.settle()
        rows = driver.session.draft.value((*CURRENT, "rows"))
        assert {row[1] for row in rows} == {"0.5"}

    drive(story, small)


@pytest.mark.parametrize("how", ["refer", pytest.param("copy", marks=pytest.mark.thorough)])
def test_a_current_of_a_csv_file(drive, small, how):
    table = "depth[m],speed[m/s],toward[deg]\n0,0.6,90\n100,0.2,80\n"
    small.with_name("adcp.csv").write_text(table)

    async def story(driver):
        await driver.press("w", "ctrl+o")
        await driver.type("adcp.csv")
        await driver.press("enter", "enter", "ctrl+u")
        await driver.type(how)
        await driver.press("enter")
        await driver.settle()
        if how == "refer":
            assert driver.session.draft.value(CURRENT) == {"file": "adcp.csv"}
        else:
            assert driver.session.draft.value((*CURRENT, "rows")) == [
                ["0", "0.6", "90"], ["100", "0.2", "80"],
            ]  # fmt: skip
        assert driver.view.file.environment.current.u[0] == pytest.approx(0.6)

    drive(story, small)


def test_a_file_of_current_that_is_not_there_is_told(drive, small):
    async def story(driver):
        before = driver.text
        await driver.press("w", "ctrl+o")
        await driver.type("none.nc")
        await driver.press("enter")
        assert "no such file" in driver.screen
        await driver.press("escape", "escape")
        assert driver.text == before

    drive(story, small)


def test_density_as_a_table_begins_with_the_constant_which_comes_back(drive, small):
    density = "  density: '1030 kg/m^3'  # of March\n"
    small.write_text(MOORING.replace("  current", density + "  current"))

    async def story(driver):
        await driver.press("w")
        await turn(driver, "density-form")
        assert value(driver, "density") == {
            "columns": ["depth m", "density kg/m^3"],
            "rows": [["0", "1030"], ["100", "1030"]],
        }
        await turn(driver, "density-form", "left")
        assert value(driver, "density") == "1030 kg/m^3"
        await driver.press("ctrl+z", "ctrl+z")
        assert density in driver.text

    drive(story, small)


def test_the_arrows_change_nothing_before_enter(drive, small):
    async def story(driver):
        before = driver.text
        await driver.press("w")
        form = driver.app.screen.query_one("#current-form")
        form.focus()
        await driver.press("right")
        assert "table ›   Enter accepts" in driver.screen
        await driver.press("right", "right", "tab")
        assert driver.text == before
        assert form.word == "uniform"
        await driver.pilot.click("#current-form")
        assert "table" in driver.screen and driver.text == before
        await driver.pilot.click("#current-form", offset=(40, 0))
        assert value(driver, "current", "columns")

    drive(story, small)


def test_a_form_comes_back_as_it_was_left(drive, small):
    async def story(driver):
        await driver.press("w")
        await turn(driver, "current-form")
        cells(driver).focus()
        await driver.press("right", "0", "full_stop", "8", "enter")
        table = value(driver, "current")
        await turn(driver, "current-form", "left")
        assert value(driver, "current") == {"speed": "0.5 m/s", "toward": "90 deg"}
        await turn(driver, "current-form", "left")
        assert value(driver, "current") is None
        await turn(driver, "current-form", "right", "right")
        assert value(driver, "current") == table

    drive(story, small)


def test_a_uniform_current_begins_with_that_at_the_surface(drive, small):
    table = "{columns: [depth m, speed knot, toward deg], rows: [[0, 2, 45], [100, 1, 50]]}"
    small.write_text(MOORING.replace("{speed: 0.5 m/s, toward: 90 deg}", table))

    async def story(driver):
        await driver.press("w")
        await turn(driver, "current-form", "left")
        # 2 knots of 1852/3600 m/s, six digits
        assert value(driver, "current") == {"speed": "1.02889 m/s", "toward": "45 deg"}

    drive(story, small)


def test_temperature_and_salinity_are_begun_and_edited(drive, small):
    async def story(driver):
        await driver.press("w")
        await turn(driver, "density-form", "left")
        assert value(driver, "density") == {"temperature": "10 degC", "salinity": "35"}
        await enter(driver, "density-temperature", "4")
        await turn(driver, "density-salinity-form")
        assert value(driver, "density") == {
            "temperature": "4 degC",
            "salinity": {"columns": ["depth m", "salinity"], "rows": [["0", "35"], ["100", "35"]]},
        }
        salinity = cells(driver, "density-salinity-table")
        salinity.focus()
        await driver.press("down", "right", "3", "6", "enter")
        await driver.settle()
        assert value(driver, "density", "salinity", "rows")[1] == ["100", "36"]
        assert driver.view.file.environment.density.salinity.value == (35.0, 36.0)
        await driver.press("a", "escape")
        assert len(value(driver, "density", "salinity", "rows")) == 3

    drive(story, small)


RAGGED = """\
  current:
    columns: [depth m, speed m/s, toward deg]
    rows:
      - [0, '0.5', 90]   # at the buoy
      - [50]
      - [100, , 80]      # lost
"""


def test_a_row_that_lacks_values_is_filled_and_the_others_stay(drive, small):
    ragged = RAGGED.replace(", ,", ", null,")
    small.write_text(MOORING.replace("  current: {speed: 0.5 m/s, toward: 90 deg}\n", ragged))

    async def story(driver):
        await driver.press("escape", "w")
        cells(driver).focus()
        await driver.press("down", "right", "enter", "escape")
        assert driver.text == small.read_text()
        await driver.press("down", "enter", "0", "full_stop", "1", "enter")
        assert driver.text == small.read_text().replace("null", "0.1")
        await driver.press("home", "up", "0", "full_stop", "2", "enter")
        assert "- [0, '0.5', 90]   # at the buoy\n      - [50, null, 0.2]\n" in driver.text

    drive(story, small)


def test_a_table_of_other_things_is_left_to_the_text(drive, small):
    odd = MOORING.replace(
        "{speed: 0.5 m/s, toward: 90 deg}", "{columns: [depth m], rows: [1, [2]]}"
    )
    small.write_text(odd)

    async def story(driver):
        await driver.press("escape", "w")
        cells(driver).focus()
        assert "edit this table in the text" in driver.screen
        await driver.press("enter", "a", "A", "delete", "1")
        assert driver.text == odd

    drive(story, small)


def test_wind_needs_a_direction_and_goes_without_a_speed(drive, small):
    async def story(driver):
        await driver.press("w")
        await enter(driver, "wind-speed", "12")
        assert value(driver, "wind") == {"speed": "12 m/s"}
        assert "is needed: direction" in driver.screen
        assert driver.app.focused is field(driver, "wind-toward").input
        await driver.type("45")
        await driver.press("enter")
        await driver.settle()
        assert value(driver, "wind") == {"speed": "12 m/s", "toward": "45 deg"}
        assert driver.view.file.environment.wind.toward == 45.0
        field(driver, "wind-speed").input.focus()
        await driver.press("ctrl+u", "enter")
        assert driver.session.draft.value(("environment", "wind")) is None

    drive(story, small)


STORMY = """\
  wind: {speed: 10 m/s, toward: 90 deg, surface_drift: 0.03}

environments:
  storm: {depth: 110 m}
"""


@pytest.mark.parametrize(
    ("id", "text", "expected"),
    [
        ("wind-speed", "20", {"speed": "20 m/s", "toward": "90 deg", "surface_drift": "0.03"}),
        ("current-toward", "45", {"speed": "0.5 m/s", "toward": "45 deg"}),
    ],
)
def test_what_is_changed_in_a_named_environment_has_the_rest_of_the_files_own(
    drive, small, id, text, expected
):
    small.write_text(MOORING.replace("\nline:", STORMY + "\nline:"))

    async def story(driver):
        await driver.press("w", "f5")
        await enter(driver, id, text)
        await driver.settle()
        assert driver.session.choice.environment == "storm"
        key = id.partition("-")[0]
        assert driver.session.draft.value(("environments", "storm", key)) == expected
        assert driver.view.problems == ()
        # an empty wind is that of the file's default environment, not one of no direction
        if id == "wind-speed":
            await enter(driver, id, "")
            assert field(driver, id).input.value == "10 m/s"
            assert "as in the default" in driver.screen
            assert driver.session.draft.value(("environments", "storm")) == {"depth": "110 m"}

    drive(story, small, environment=None)


def test_an_environment_stays_where_its_last_value_goes(drive, small):
    small.write_text(MOORING + "environments:\n  storm:\n    depth: 110 m\n")

    async def story(driver):
        await driver.press("w", "f5")
        await enter(driver, "depth", "")
        assert driver.session.draft.value(("environments",)) == {"storm": {}}
        await driver.settle()
        assert driver.view.problems == ()

    drive(story, small)


def test_what_is_being_typed_is_taken_before_anything_else(drive, small):
    async def story(driver):
        await driver.press("w", "ctrl+u")
        await driver.type("130")
        screen = driver.app.screen
        assert screen.is_typing
        assert screen.settle() and not screen.is_typing
        assert value(driver, "depth") == "130 m"
        await driver.press("ctrl+u")
        await driver.type("140 kg")
        await driver.press("f6")
        assert driver.app.screen is screen and "Not accepted yet, depth: is" in driver.screen
        assert not screen.settle() and screen.is_typing
        await driver.press("ctrl+u")
        await driver.type("140")
        await driver.press("f6")
        assert "New environment" in driver.screen
        assert value(driver, "depth") == "140 m"

    drive(story, small)


def test_what_is_typed_in_a_table_is_taken_before_anything_else(drive, small):
    async def story(driver):
        await driver.press("w")
        await turn(driver, "current-form")
        cells(driver).focus()
        await driver.press("right", "1", "x")
        screen = driver.app.screen
        assert not screen.settle() and screen.is_typing
        await driver.press("backspace", "full_stop", "5")
        assert screen.settle() and not screen.is_typing
        assert value(driver, "current", "rows")[0] == ["0", "1.5", "90"]
        await driver.pilot.pause()
        assert cells(driver).has_focus
        await driver.press("2", "ctrl+z")
        assert value(driver, "current", "rows")[0] == ["0", "1.5", "90"]
        await driver.press("1")
        driver.session.write(driver.text.replace("1.5", "1.7"))
        screen.replaced()
        assert not screen.is_typing and cells(driver).rows[0] == ("0", "1.7", "90")

    drive(story, small)


def test_a_value_left_with_the_mouse_is_taken_where_it_was_typed(drive, small):
    async def story(driver):
        await driver.press("w")
        await turn(driver, "current-form")
        cells(driver).focus()
        await driver.press("right", "7")
        await driver.pilot.click(cells(driver), offset=(4, 2))
        await driver.settle()
        assert value(driver, "current", "rows") == [["0", "7", "90"], ["100", "0.5", "90"]]
        assert (cells(driver).cursor, cells(driver).column) == (1, 0)
        await driver.press("7", "x")
        await driver.pilot.click(cells(driver), offset=(4, 1))
        await driver.settle()
        assert value(driver, "current", "rows")[1][0] == "100"
        assert "`7x` was not accepted: has an unknown unit" in driver.screen

    drive(story, small)


def test_a_draft_that_is_replaced_is_shown_and_what_was_typed_is_dropped(drive, small):
    async def story(driver):
        await driver.press("w", "ctrl+u", "7")
        driver.session.write(driver.text.replace("100 m ", "150 m "))
        driver.app.screen.replaced()
        assert field(driver, "depth").input.value == "150 m"
        await driver.press("escape")
        assert value(driver, "depth") == "150 m"

    drive(story, small)


def test_a_draft_that_cannot_be_read_is_shown_as_one_that_says_nothing(drive, small):
    async def story(driver):
        await driver.press("w")
        driver.session.write("line: [")
        screen = driver.app.screen
        screen.replaced()
        assert field(driver, "depth").input.value == ""
        assert not screen.change(lambda water: water.put(("depth",), "9 m"), "the depth")
        assert driver.text == "line: ["

    drive(story, small)


def netcdf(path, **variables):
    time = numpy.array(["2026-03-01T00", "2026-03-01T06"], "datetime64[ns]")
    dimensions = ("time", "depth")
    data = {
        name: (dimensions, values, {"units": "m s-1", "standard_name": standard})
        for name, (standard, values) in variables.items()
    }
    depth = ("depth", [0.0, 100.0], {"units": "m", "positive": "down", "standard_name": "depth"})
    xarray.Dataset(data, {"time": time, "depth": depth}).to_netcdf(path, engine="h5netcdf")


@pytest.mark.parametrize("how", [pytest.param("refer", marks=pytest.mark.thorough), "copy"])
def test_a_current_of_a_netcdf_file(drive, small, how):
    east = ("eastward_sea_water_velocity", [[0.1, 0.1], [0.3, 0.0]])
    north = ("northward_sea_water_velocity", [[0.0, 0.0], [0.4, 0.2]])
    netcdf(small.with_name("adcp.nc"), u=east, v=north)

    async def story(driver):
        await driver.press("w", "ctrl+o")
        await driver.type("adcp.nc")
        await driver.press("enter")
        await driver.type("2026-03-01T06:00")
        await driver.press("enter", "ctrl+u")
        await driver.type(how)
        await driver.press("enter")
        await driver.settle()
        if how == "refer":
            named = {"file": "adcp.nc", "time": "2026-03-01T06:00"}
            assert value(driver, "current") == named
        else:
            assert value(driver, "current") == {
                "columns": ["depth m", "u m/s", "v m/s"],
                "rows": [["0", "0.3", "0.4"], ["100", "0", "0.2"]],
            }
            assert "The current of adcp.nc was copied" in driver.screen
        assert driver.view.file.environment.current.v[0] == pytest.approx(0.4, abs=1e-4)

    drive(story, small)


@pytest.mark.parametrize("kind", ["csv", "float32", "float64"])
def test_a_current_that_is_copied_keeps_its_digits(tmp_path, kind):
    rows = [["0.1", "0.123456", "359.99"], ["33.3", "0.3", "36.87"], ["100", "0", "0"]]
    if kind == "csv":
        path = tmp_path / "adcp.csv"
        path.write_text(
            "\n".join(map(",".join, [["depth[m]", "speed[m/s]", "toward[deg]"], *rows]))
        )
    else:
        path = tmp_path / "adcp.nc"
        depth, speed, toward = numpy.array(rows, kind).T
        standard = "sea_water_velocity_to_direction"
        down = {"units": "m", "positive": "down", "standard_name": "depth"}
        xarray.Dataset(
            {
                "speed": ("depth", speed, {"units": "m s-1", "standard_name": "sea_water_speed"}),
                "toward": ("depth", toward, {"units": "degree", "standard_name": standard}),
            },
            {"depth": ("depth", depth, down)},
        ).to_netcdf(path, engine="h5netcdf")
    assert imported(path, "", 100.0) == (("depth m", "speed m/s", "toward deg"), rows)


def test_a_uniform_current_begins_with_components_at_the_surface(drive, small):
    table = "{columns: [depth m, u m/s, v m/s], rows: [[0, -0.3, 0.4], [100, 0, 0]]}"
    small.write_text(MOORING.replace("{speed: 0.5 m/s, toward: 90 deg}", table))

    async def story(driver):
        await driver.press("w")
        await turn(driver, "current-form", "left")
        # of 3, 4 and 5, towards the north-west: 360 - atan(3/4), six digits
        assert value(driver, "current") == {"speed": "0.5 m/s", "toward": "323.13 deg"}

    drive(story, small)


def test_a_file_that_no_library_can_read_is_told(drive, small, monkeypatch):
    small.with_name("bad.nc").write_bytes(b"\x89HDF\r\n\x1a\n" + bytes(200))

    async def load(driver):
        await driver.press("ctrl+o")
        await driver.type("bad.nc")
        await driver.press("enter", "enter", "ctrl+u")
        await driver.type("copy")
        await driver.press("enter")
        await driver.settle()

    async def story(driver):
        before = driver.text
        await driver.press("w")
        await load(driver)
        assert "bad.nc" in driver.screen.splitlines()[-1]

        def fail(*_):
            raise RuntimeError("out of luck")

        monkeypatch.setattr("calm.tui.water_screen.imported", fail)
        await load(driver)
        assert "bad.nc cannot be read: RuntimeError: out of luck" in driver.screen
        assert driver.text == before

    drive(story, small)


def test_a_name_that_no_file_can_have_is_no_such_file(tmp_path):
    check = _existing(tmp_path)
    assert check("x" * 5000).note == check("a\0b").note == "no such file"


def test_a_depth_that_is_assumed_is_told(drive, small):
    small.write_text(MOORING.replace("  depth: 100 m                        # at low water\n", ""))

    async def story(driver):
        await driver.press("w", "ctrl+t")
        assert "down to 100 m, since no depth is set" in driver.screen
        await driver.press("escape")
        await turn(driver, "current-form")
        assert "the depth is not set, so tables go down to 100 m" in driver.screen

    drive(story, small)


def test_named_environments_are_added_switched_and_dropped(drive, small):
    async def story(driver):
        await driver.press("w", "ctrl+n")
        await driver.type("storm")
        await driver.press("enter")
        await driver.settle()
        assert driver.session.choice.environment == "storm"
        await enter(driver, "current-speed", "1.1 m/s")
        await driver.settle()
        assert driver.view.file.environment.name == "storm"
        stormy = ("environments", "storm", "current", "speed")
        assert driver.session.draft.value(stormy) == "1.1 m/s"
        assert driver.session.draft.value((*CURRENT, "speed")) == "0.5 m/s"
        in_storm = driver.view.result.top.knockdown
        await driver.press("escape", "e")
        await driver.settle()
        assert driver.session.choice.environment is None
        assert driver.view.result.top.knockdown < in_storm
        await driver.press("e", "w", "f7")
        assert driver.session.draft.value(("environments",)) is None

    drive(story, small)


def test_undo_reaches_the_water(drive, small):
    async def story(driver):
        before = driver.text
        await driver.press("w")
        await enter(driver, "depth", "150 m")
        await driver.press("ctrl+z")
        assert driver.text == before
        assert field(driver, "depth").input.value == "100 m"

    drive(story, small)


def test_the_environment_file_that_the_line_stands_in_is_told(drive, small):
    small.with_name("lab.yaml").write_text("name: lab\nenvironment: {depth: 140 m}\n")

    async def story(driver):
        await driver.press("w")
        assert driver.view.file.environment.depth == 140.0
        assert "The line is solved in lab.yaml" in driver.screen
        assert "default   [lab.yaml]" in driver.screen
        await driver.press("f5")
        await driver.settle()
        assert driver.view.file.environment.depth == 100.0
        assert "[default]" in driver.screen
        assert "stands in lab.yaml:" not in driver.screen
        assert "The line is no longer solved in lab.yaml" in driver.screen

    drive(story, small, environment="lab.yaml")


def test_mistakes_of_the_water_are_told_where_they_are_mended(drive, small):
    table = "{columns: [depth m, speed m/s, toward deg], rows: [[0, -1, 90], [100, 0.2, 90]]}"
    small.write_text(MOORING.replace("{speed: 0.5 m/s, toward: 90 deg}", table))

    async def story(driver):
        await driver.press("escape", "w")
        message = "`speed` -1 m/s is negative"
        assert f"! line 5:67  {message}" in driver.screen
        cells(driver).focus()
        await driver.press("right", "1", "enter")
        await driver.settle()
        assert message not in driver.screen and driver.view.problems == ()

    drive(story, small)


def test_tab_goes_through_a_table_and_never_out_of_its_end(drive, folder):
    path = folder / "m.yaml"
    rows = "rows: [[0, 0.5, 90], [100, 0.1, 90]]"
    table = f"  current: {{columns: [depth m, speed m/s, toward deg], {rows}}}"
    old = "  current: {speed: 0.5 m/s, toward: 90 deg}"
    path.write_text(MOORING.replace(old, table), encoding="utf-8")

    async def story(driver):
        await driver.press("w")
        grid = cells(driver)
        grid.focus()
        await driver.press("tab", "tab", "tab", "tab")
        assert (grid.cursor, grid.column) == (1, 1) and driver.app.focused is grid
        await driver.type("0.2")
        await driver.press("tab")  # takes it and edits the direction
        await driver.type("100")
        await driver.press("tab", "tab")
        assert "End of the table" in driver.screen and driver.app.focused is grid
        await driver.press("tab")
        await driver.type("0.9")  # of the table, not of the wind
        await driver.press("escape", "shift+tab", "shift+tab")
        assert (grid.cursor, grid.column) == (1, 0)
        await driver.press("down")
        assert driver.app.focused is not grid
        assert "[100, 0.2, 100]" in driver.text and "wind" not in driver.text

    drive(story, path)


def test_an_arrow_takes_what_is_typed_as_in_a_spreadsheet(drive, folder):
    path = folder / "m.yaml"
    table = "  current: {columns: [depth m, u m/s, v m/s], rows: [[0, 0.5, 0], [100, 0.1, 0]]}"
    old = "  current: {speed: 0.5 m/s, toward: 90 deg}"
    path.write_text(MOORING.replace(old, table), encoding="utf-8")

    async def story(driver):
        await driver.press("w")
        grid = cells(driver)
        grid.focus()
        await driver.press("right")
        await driver.type("0.7")
        await driver.press("down")
        assert "[0, 0.7, 0]" in driver.text and (grid.cursor, grid.column) == (1, 1)
        await driver.press("left")
        await driver.type("90")
        await driver.press("right")
        assert "[90, 0.1, 0]" in driver.text and (grid.cursor, grid.column) == (1, 1)

    drive(story, path)


def test_no_row_is_proposed_below_the_seabed(drive, folder):
    table = "{columns: [depth m, speed m/s, toward deg], rows: [[0, 0.5, 90], [95, 0.1, 90]]}"
    path = folder / "table.yaml"
    path.write_text(MOORING.replace("{speed: 0.5 m/s, toward: 90 deg}", table), encoding="utf-8")

    def depths(driver):
        return [row[0] for row in driver.session.draft.value(("environment", "current", "rows"))]

    async def story(driver):
        await driver.press("w")
        cells = driver.app.screen.query_one("#current-table").cells
        cells.focus()
        await driver.press("end", "down", "a", "escape")
        assert depths(driver) == ["0", "95", "100"]
        await driver.press("a", "escape")
        assert depths(driver) == ["0", "95", "97.5", "100"]

    drive(story, path)


def test_a_table_is_pasted_from_any_field_and_is_the_current(drive, small):
    async def story(driver):
        await driver.press("w")
        driver.app.post_message(Paste("0 0.6 70\n100 0.2 70"))
        await driver.settle()
        assert value(driver, "depth") == "100 m"  # which has the focus, and is none of it
        await driver.press("enter")
        await driver.settle()
        assert value(driver, "current") == {
            "columns": ["depth m", "speed m/s", "toward deg"],
            "rows": [["0", "0.6", "70"], ["100", "0.2", "70"]],
        }
        assert driver.app.focused is cells(driver)

    drive(story, small)


def test_rows_are_typed_one_after_the_other_and_none_is_left_over(drive, small):
    async def story(driver):
        await driver.press("w")
        await turn(driver, "current-form")
        cells(driver).focus()
        await driver.press("a", *"20", "enter", "full_stop", "5", "enter", *"80", "enter")
        await driver.press(*"40", "enter", "full_stop", "4", "enter", *"85", "enter", "escape")
        rows = value(driver, "current", "rows")
        assert rows[1:3] == [["20", ".5", "80"], ["40", ".4", "85"]] and len(rows) == 4
        assert cells(driver).cursor == 2
        # at the end of a row that was there the cursor stays in it: the next one comes below it
        await driver.press("home", "up", "up", "right", "right", "enter", "enter", "a", "escape")
        assert value(driver, "current", "rows")[1] == ["10", "0.5", "85"]

    drive(story, small)


def test_enter_takes_a_form_and_goes_on(drive, small):
    async def story(driver):
        await driver.press("w")
        driver.app.screen.query_one("#density-form").focus()
        await driver.pilot.pause()
        assert "← → choose, ↑ ↓ next field" in driver.screen
        await driver.press("enter")
        assert driver.app.focused is field(driver, "density").input
        driver.app.screen.query_one("#current-form").focus()
        await driver.press("right", "enter")
        assert driver.app.focused is cells(driver)

    drive(story, small)


def test_every_key_of_an_environment_has_its_field(drive, small):
    async def story(driver):
        await driver.press("w")
        await enter(driver, "depth_range", "[98 m, 104 m]")
        await enter(driver, "fouling-depth", "50")
        assert "is needed: thickness" in driver.screen
        await enter(driver, "fouling-thickness", "20")
        await enter(driver, "seabed", "{slope: 3 deg, toward: 120 kg}")
        assert "is a mass" in driver.screen
        await driver.press("ctrl+u", "enter")
        await driver.settle()
        assert value(driver, "depth_range") == ["98 m", "104 m"]
        assert value(driver, "fouling") == {"depth": "50 m", "thickness": "20 mm"}
        assert value(driver, "seabed") is None
        assert driver.view.file.environment.fouling.thickness == 0.02
        await enter(driver, "fouling-depth", "")
        assert value(driver, "fouling") is None

    drive(story, small, size=(140, 50))
