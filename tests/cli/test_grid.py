"""`calm grid` as a user runs it: depths and values of known instruments, onto levels."""

import json
import sys
from pathlib import Path

import gsw
import numpy as np
import pandas
import pytest
import xarray

import calm as package

LABELS = ("upper", "middle", "lower", "deep")
STILL = np.array([100.0, 150.0, 200.0, 250.0])
HOURS = 60
START = np.datetime64("2026-03-01", "ns")


def profile(depth):
    """The temperature at a depth [degree C]."""
    return 14.0 - 0.02 * depth


@pytest.fixture
def depths(folder):
    """A result as of calm motion: the whole line goes up and down."""
    down = 20.0 * np.sin(np.arange(HOURS) / 6.0) ** 2
    depth = STILL + down[:, None] * np.array([1.0, 0.8, 0.6, 0.4])
    xarray.Dataset(
        {
            "clamp_depth": (("time", "clamp"), depth),
            "clamp_depth_sd": (("time", "clamp"), np.full(depth.shape, 0.5)),
            "clamp_label": ("clamp", list(LABELS)),
            "clamp_serial": ("clamp", ["11", "12", "13", "14"]),
            "depth_top": (("time", "component"), np.full((HOURS, 1), 300.0)),
            "depth_sd": (("time", "component"), np.zeros((HOURS, 1))),
            "component_label": ("component", ["anchor"]),
            "latitude": 48.0,
            "longitude": -5.0,
        },
        coords={"time": START + np.arange(HOURS) * np.timedelta64(3600, "s")},
        attrs={"title": "M1: motion of the mooring", "creator_name": "A. Martin",
               "history": "calm motion"},
    ).to_netcdf("depths.nc", engine="h5netcdf")  # fmt: skip
    return depth


def write_values(
    name, depth, labels=LABELS, *, shift=0.0, unit="degree_Celsius", flags=None, **more
):
    data = {"temperature": (("time", "instrument"), profile(depth[:, : len(labels)]),
            {"units": unit, "standard_name": "sea_water_temperature"})}  # fmt: skip
    if flags is not None:
        data["temperature_qc"] = (("time", "instrument"), flags,
                                  {"flag_values": np.arange(10, dtype="i1")})  # fmt: skip
    coords = {"time": START + np.timedelta64(round(shift * 3600), "s")
              + np.arange(HOURS) * np.timedelta64(3600, "s")}  # fmt: skip
    if labels[0] is not None:
        coords["instrument"] = list(labels)
    coords |= {key: ("instrument", *value) for key, value in more.items()}
    xarray.Dataset(data, coords=coords).to_netcdf(name, engine="h5netcdf")


def gridded(calm, *words, levels="100:25:300"):
    run = calm("grid", "depths.nc", *words, "-o", "out.nc", "--levels", levels)
    assert run.code == 0, run.err
    with xarray.open_dataset("out.nc", engine="h5netcdf", mask_and_scale=False) as result:
        return result.load(), run


def test_a_line_in_depth_is_found_again(calm, depths):
    write_values("v.nc", depths)
    result, run = gridded(calm, "v.nc", "--report", "page")
    assert result["temperature"].dims == ("time", "depth")
    assert result["depth"].values.tolist() == list(range(100, 301, 25))
    sure = result["temperature_qc"].values == 8
    off = result["temperature"].values - profile(result["depth"].values)
    # depths are off by 0.5 m at 0.02 degrees a metre
    assert np.abs(off[sure]).max() < 0.01 + 1e-3
    spread = result["temperature_sd"].values[sure]
    assert 0.005 < np.median(spread) < 0.05
    assert np.isin(result["temperature_qc"].values[:, -1], [3, 9]).all()
    assert result["temperature"].attrs["ancillary_variables"] == "temperature_sd temperature_qc"
    assert "temperature" in run.out
    assert "For the methods of a cruise report" in Path("page/grid.html").read_text()
    assert Path("page/grid.pdf").read_bytes().startswith(b"%PDF-")


def test_the_bins_of_a_profiler_move_with_it(calm, depths):
    heights = [5.0, 25.0, 45.0]  # above `lower`
    where = depths[:, 2:3] - heights
    speed = {"units": "m s-1"}
    xarray.Dataset(
        {
            "UCUR": (("TIME", "HEIGHT_ABOVE_SENSOR"), 0.002 * where, speed),
            "VCUR": (("TIME", "HEIGHT_ABOVE_SENSOR"), 0.0 * where, speed),
            "DEPTH": ("TIME", depths[:, 2], {"standard_name": "depth", "units": "m"}),
        },
        {
            "TIME": START + np.arange(HOURS) * np.timedelta64(3600, "s"),
            "HEIGHT_ABOVE_SENSOR": ("HEIGHT_ABOVE_SENSOR", heights, {
                "units": "m", "positive": "up", "long_name": "height above sensor"}),
        },
        {"instrument_serial_number": "13"},
    ).to_netcdf("adcp.nc", engine="h5netcdf")  # fmt: skip
    result, _ = gridded(calm, "adcp.nc", levels="150:10:210")
    sure = result["u_qc"].values == 8
    assert sure.any(axis=1).all()
    off = result["u"].values - 0.002 * result["depth"].values
    assert np.abs(off[sure]).max() < 0.002  # a metre of depth
    whole, _ = gridded(calm, "lower=adcp.nc", levels="150:10:210")
    assert whole["u"].equals(result["u"])


def test_what_archives_ask_for_is_there(calm, depths, monkeypatch):
    monkeypatch.setenv("SOURCE_DATE_EPOCH", "1790000000")
    write_values("v.nc", depths)
    said = gridded(calm, "v.nc")[0].attrs
    assert said["Conventions"] == "CF-1.11, ACDD-1.3, OceanSITES-1.4"
    assert said["creator_name"] == "A. Martin"
    assert said["date_created"] == "2026-09-21T14:13:20Z"
    assert said["time_coverage_start"] == "2026-03-01T00:00:00Z"
    assert said["time_coverage_duration"] == "P2DT11H"
    assert said["geospatial_vertical_max"] == 300.0
    assert said["geospatial_lat_min"] == 48.0
    first, made, read = said["history"].split("\n")
    assert first == "calm motion"
    assert "depths.nc sha256:" in made and "v.nc sha256:" in made
    assert read.startswith("read v.nc: temperature: temperature [degree_Celsius]: ")


def one_file(name, values, standard, unit, called, **more):
    """The series of one instrument, which calls itself by an attribute."""
    time = START + np.arange(HOURS) * np.timedelta64(3600, "s")
    variables = {name: ("time", values, {"standard_name": standard, "units": unit})}
    variables |= {other: ("time", one, about) for other, (one, about) in more.items()}
    xarray.Dataset(variables, {"time": time}, {"instrument": called}).to_netcdf(
        f"{called}.nc", engine="h5netcdf"
    )


WATER = ("sea_water_temperature", "degree_Celsius")


def both(calm, depths, make, *words):
    for j, label in enumerate(LABELS[:2]):
        make(label, profile(depths[:, j]))
    given = [f"{label}={label}.nc" for label in LABELS[:2]]
    return calm("grid", "depths.nc", *given, "-o", "out.nc", "--levels", "100:25:300", *words)


@pytest.mark.parametrize(("unit", "told", "likely"), [
    (lambda t: t + 273.15, "median of 28", "K"),
    (lambda t: 1.8 * t + 42.0, "of 60 values are outside", "degF"),
    (lambda t: 1e3 * t, "°C, with a median", "0.001 degC"),
])  # fmt: skip
def test_temperatures_of_another_unit_are_refused(calm, depths, unit, told, likely):
    run = both(calm, depths, lambda label, t: one_file("TEMP", unit(t), *WATER, label))
    assert run.code == 2 and told in run.err and f"is it in {likely}?" in run.err


def test_units_are_converted_and_other_quantities_refused(calm, depths):
    kelvin = ("sea_water_temperature", "K")
    run = both(calm, depths, lambda label, t: one_file("TEMP", t + 273.15, *kelvin, label))
    assert run.code == 0, run.err
    with xarray.open_dataset("out.nc", engine="h5netcdf") as result:
        assert abs(float(result["temperature"].median()) - 14.0) < 5.0
    air = ("air_temperature", "degree_Celsius")
    run = both(calm, depths, lambda label, t: one_file("TEMP", t, *air, label))
    assert run.code == 2 and "`TEMP` has the standard name air_temperature instead of" in run.err


def test_what_is_doubtful_is_said_with_a_count(calm, depths):
    run = both(calm, depths, lambda label, t: one_file("TEMP", 0.0 * t, *WATER, label))
    assert run.code == 2 and "all 60 values are 0 and were excluded" in run.err
    fresh = ("sea_water_practical_salinity", "1")
    run = both(calm, depths, lambda label, t: one_file("PSAL", 0.0345 + 1e-4 * t, *fresh, label))
    assert (
        "60 of 60 values are below 0.05, with a median of 0.03" in run.err and "kg/kg?" in run.err
    )

    def exchanged(label, t):
        pressure = {"PRES": (0.0 * t + 900.0, {"units": "dbar"})}
        one_file("TEMP", t, *WATER, label, **pressure)

    run = both(calm, depths, exchanged)
    assert "the median of its pressures is 900 dbar, but `" in run.err
    for label in LABELS[:2]:
        other = LABELS[1 - LABELS.index(label)]
        one_file("TEMP", profile(depths[:, 0]), *WATER, label)
        with xarray.open_dataset(f"{label}.nc", engine="h5netcdf") as file:
            file.load().assign_attrs(instrument=other).to_netcdf(f"x{label}.nc", engine="h5netcdf")
    run = calm("grid", "depths.nc", *(f"{one}=x{one}.nc" for one in LABELS[:2]), "-o", "out.nc",
               "--levels", "100:25:300")  # fmt: skip
    assert f"is assigned to `{LABELS[0]}`, but names its instrument `{LABELS[1]}`" in run.err


def test_salinity_is_computed_where_a_file_holds_none(calm, depths):
    def cell(label, t):
        pressure = 0.0 * t + 150.0
        more = {
            "CNDC": (gsw.C_from_SP(35.2, t, pressure) / 10.0, {"units": "S m-1"}),
            "PRES": (pressure, {"units": "dbar"}),
        }
        one_file("TEMP", t, *WATER, label, **more)

    run = both(calm, depths, cell, "--json", "grid.json")
    assert run.code == 0, run.err
    assert "salinity is computed from conductivity, temperature, pressure" in run.err
    with xarray.open_dataset("out.nc", engine="h5netcdf") as result:
        assert float(abs(result["salinity"] - 35.2).max()) < 1e-6
    said = json.loads(Path("grid.json").read_text())
    assert set(said["quantities"]) == {"temperature", "salinity"}
    assert set(said["read"][0]["variables"]) == {
        "temperature", "conductivity", "pressure", "time"
    }  # fmt: skip


def test_salinity_without_a_pressure_is_that_of_the_depth_on_the_line(calm, depths):
    def cell(label, t):
        pressure = gsw.p_from_z(-STILL[LABELS.index(label)], 48.0)
        one_file("TEMP", t, *WATER, label, CNDC=(gsw.C_from_SP(35.2, t, pressure) / unit[0],
                 {"units": unit[1]}))  # fmt: skip

    unit = (10.0, "S m-1")
    run = both(calm, depths, cell, "--variables", "salinity")
    assert run.code == 0, run.err
    with xarray.open_dataset("out.nc", engine="h5netcdf") as result:
        assert float(abs(result["salinity"] - 35.2).max()) < 0.01
    run = calm("grid", "depths.nc", *(f"{one}.nc" for one in LABELS[:2]), "-o", "out.nc",
               "--levels", "100:25:300")  # fmt: skip
    assert (
        "salinity is not computed, because there is neither a pressure nor a nominal depth"
        in run.err
    )
    unit = (10.0, "mS/cm")
    run = both(calm, depths, cell)
    assert "the median of the salinity is 2.9: is `CNDC` in another unit?" in run.err


@pytest.mark.parametrize("make", [
    lambda count: ("INDEX", ("READING", np.repeat([0, 1], count), {"instance_dimension": "PLACE"})),
    lambda count: ("COUNT", ("PLACE", [count, count], {"sample_dimension": "READING"})),
    lambda count: ("INDEX", ("READING", np.repeat([1, 2], count), {"instance_dimension": "PLACE"})),
])  # fmt: skip
def test_ragged_arrays_of_instruments_are_split(calm, depths, make):
    time = START + np.arange(HOURS) * np.timedelta64(3600, "s")
    name, index = make(HOURS)
    values = np.concatenate([profile(depths[:, j]) for j in range(2)])
    about = {"standard_name": WATER[0], "units": WATER[1]}
    nominal = {"units": "m", "standard_name": "depth", "positive": "down"}
    xarray.Dataset(
        {"TEMP": ("READING", values, about), name: index,
         "NOMINAL_DEPTH": ("PLACE", STILL[:2], nominal), "serial": ("PLACE", ["11", "12"])},
        {"TIME": ("READING", np.tile(time, 2))},
    ).to_netcdf("all.nc", engine="h5netcdf")  # fmt: skip
    run = calm("grid", "depths.nc", "all.nc", "-o", "out.nc", "--levels", "100:25:150")
    if index[1][0] == 1:  # counted from 1
        assert run.code == 2
        assert "`INDEX` must hold the number of the instrument, from 0 to 1" in run.err
        return
    assert run.code == 0, run.err
    assert f"TEMP [degree_Celsius]: {values.min():.4g} to {values.max():.4g}, median" in run.err
    assert "  levels       2" in run.err and "step 1 h, no gaps" in run.err


def test_capitals_as_oceansites_has_them(calm, depths):
    write_values("v.nc", depths)
    result, _ = gridded(calm, "v.nc", "--variables", "TEMP")
    assert result["TEMP"].dims == ("TIME", "DEPTH")
    assert {"TEMP_SD", "TEMP_QC", "LATITUDE", "LONGITUDE"} <= set(result.variables)
    assert result["TEMP"].attrs["ancillary_variables"] == "TEMP_SD TEMP_QC"


def test_what_was_interpolated_never_counts(calm, depths):
    flags = np.ones((HOURS, 4), "i1")
    flags[:, 1] = 8
    wrong = depths.copy()
    wrong[:, 1] += 200.0
    write_values("v.nc", wrong, flags=flags)
    result, run = gridded(calm, "v.nc", "--flags", "1,2")
    assert "temperature: 60 values excluded because of their flag" in run.err
    assert "temperature: middle has no good value" in run.err
    off = result["temperature"].values - profile(result["depth"].values)
    assert np.abs(off[result["temperature_qc"].values == 8]).max() < 0.02


def test_steps_are_means_and_said(calm, depths):
    write_values("v.nc", depths)
    result, _ = gridded(calm, "v.nc", "--step", "3 h")
    assert result["temperature"].attrs["cell_methods"] == "time: mean (interval: 3 h)"
    assert set(np.diff(result["time"].values)) == {np.timedelta64(3, "h")}


def test_serials_and_then_nominal_depths_say_who_is_who(calm, depths):
    write_values("v.nc", depths, (None,) * 4, serial=[["11", "12", "13", "14"]])
    by_serial, _ = gridded(calm, "v.nc")
    write_values("w.nc", depths, (None,) * 4, nominal_depth=[STILL - 8.0, {"units": "m"}])
    by_place, run = gridded(calm, "w.nc")
    assert "matched by nominal depth, from the top down" in run.err
    assert np.array_equal(by_serial["temperature"], by_place["temperature"], equal_nan=True)


def test_files_of_one_instrument_and_a_folder_of_them(calm, depths, folder):
    (folder / "in").mkdir()
    for j, label in enumerate(LABELS):
        xarray.Dataset(
            {"TEMP": (("TIME", "DEPTH"), profile(depths[:, [j]]),
                      {"units": "degree_Celsius", "standard_name": "sea_water_temperature"})},
            coords={"TIME": START + np.arange(HOURS) * np.timedelta64(3600, "s"),
                    "DEPTH": ("DEPTH", [STILL[j]], {"units": "m"})},
            attrs={"instrument_serial_number": str(11 + j)},
        ).to_netcdf(f"in/{label}.nc", engine="h5netcdf")  # fmt: skip
    whole, _ = gridded(calm, "in")
    named, _ = gridded(calm, *(f"{label}=in/{label}.nc" for label in LABELS))
    assert np.array_equal(whole["temperature"], named["temperature"], equal_nan=True)


@pytest.mark.parametrize(
    ("levels", "said"),
    [
        ("0:20", "write FIRST:STEP:LAST"),
        ("deep", "write FIRST:STEP:LAST"),
        ("100:-20:0", "does not increase"),
        ("100:0:200", "does not increase"),
        ("200,100", "must increase"),
        ("-50:10:50", "above the sea surface"),
        ("0:0.001:1000", "more than 5000 levels"),
        ("nan:1:2", "write FIRST:STEP:LAST"),
    ],
)
def test_levels_typed_wrong(calm, depths, levels, said):
    write_values("v.nc", depths)
    run = calm("grid", "depths.nc", "v.nc", "-o", "out.nc", f"--levels={levels}")
    assert run.code == 2
    assert said in run.err


def refused(calm, *words):
    run = calm("grid", *words, "-o", "out.nc", "--levels", "100,200")
    assert run.code == 2, run.err
    assert "Traceback" not in run.err and "internal error" not in run.err
    return run.err


def test_bad_inputs_are_refused(calm, depths, folder):
    write_values("v.nc", depths)
    write_values("later.nc", depths, shift=9000.0)
    assert "depths and values have no common time: the depths cover 2026-03-01" in refused(
        calm, "depths.nc", "later.nc"
    )
    write_values("other.nc", depths, ("uper", "b", "c", "d"))
    err = refused(calm, "depths.nc", "other.nc")
    assert "no instrument matches a part of the line" in err and "did you mean `upper`?" in err
    write_values("unit.nc", depths, unit="dbar")
    assert "its unit, `dbar`, cannot be converted to degC" in refused(calm, "depths.nc", "unit.nc")
    write_values("none.nc", depths, unit="")
    assert "has no unit; set one, such as degC" in refused(calm, "depths.nc", "none.nc")
    (folder / "empty.nc").write_bytes(b"")
    assert "empty.nc: is empty" in refused(calm, "depths.nc", "empty.nc")
    assert "no such file" in refused(calm, "depths.nc", "absent.nc")
    assert "is not a result of calm motion" in refused(calm, "v.nc", "v.nc")
    write_values("blank.nc", np.full_like(depths, np.nan))
    assert "no instrument has a good value" in refused(calm, "depths.nc", "blank.nc")
    write_values("twin.nc", depths)
    assert "two series belong to `upper`: v.nc, twin.nc" in refused(
        calm, "depths.nc", "v.nc", "twin.nc"
    )
    run = calm("grid", "depths.nc", "v.nc", "-o", "depths.nc", "--levels", "100,200")
    assert run.code == 2 and "was not overwritten" in run.err
    assert "v.nc holds 4 instruments" in refused(calm, "depths.nc", "upper=v.nc")
    assert not (folder / "out.nc").exists()


@pytest.mark.parametrize(
    ("option", "value", "said"),
    [
        ("--step", "1 m", "--step: `1 m`"),
        ("--step", "0 s", "is not between a second and a year"),
        ("--variables", "temprature", "did you mean `temperature`?"),
        ("--variables", "salinity", "holds no salinity"),
        ("--method", "linear", "`--method: linear` must be one of depth-time, depth"),
        ("--flags", "1,8", "8 marks interpolated values"),
    ],
)
def test_options_typed_wrong(calm, depths, option, value, said):
    write_values("v.nc", depths)
    assert said in refused(calm, "depths.nc", "v.nc", option, value)


def test_without_matplotlib_a_report_names_the_command_that_installs_it(calm, depths, monkeypatch):
    write_values("v.nc", depths)
    monkeypatch.setitem(sys.modules, "matplotlib", None)
    said = refused(calm, "depths.nc", "v.nc", "--report", "page")
    assert "matplotlib is not installed; in the checkout of CALM, run pip install '.[plot]'" in said
    assert not Path("out.nc").exists()


@pytest.fixture
def tables(depths):
    """A table of temperatures for each instrument, by its label."""
    time = pandas.DatetimeIndex(START + np.arange(HOURS) * np.timedelta64(3600, "s"))
    return {
        label: pandas.DataFrame({"temperature[degC]": profile(depths[:, j])}, time)
        for j, label in enumerate(LABELS)
    }


def test_python_grids_datasets_and_tables_as_the_command_grids_files(calm, depths, tables):
    write_values("v.nc", depths)
    written = gridded(calm, "v.nc", "--step", "1 h")[0]
    levels = np.arange(100.0, 301.0, 25.0)
    with xarray.open_dataset("depths.nc", engine="h5netcdf") as motion:
        with xarray.open_dataset("v.nc", engine="h5netcdf") as values:
            found = package.grid(motion, values, levels, step=3600.0)
        by_label = package.grid(motion.load(), tables, levels, step=3600.0)
    for one in (found, by_label):
        result = one.to_xarray()
        off = result["temperature"] - written["temperature"]
        assert float(abs(off).max()) < 1e-5
        assert result["depth"].values.tolist() == levels.tolist()
    assert repr(found).splitlines()[1].startswith("temperature: 4 instruments, scales ")
    axes = found.plot("temperature")
    assert axes.get_ylim() == (300.0, 100.0) and len(axes.lines) == len(LABELS)
    found.write("again.nc")
    assert Path("again.nc").stat().st_size > 1000


def test_a_table_of_one_instrument_is_read(calm, depths, tables):
    given = []
    for label, table in tables.items():
        table.to_csv(f"{label}.csv", index_label="time", date_format="%Y-%m-%dT%H:%M:%S")
        given.append(f"{label}={label}.csv")
    result, run = gridded(calm, *given)
    assert np.isfinite(result["temperature"].values).any()
    assert "upper.csv: read as" in run.err
    Path("upper.csv").write_text("time,temprature[degC]\n2026-03-01T00:00,4\n")
    done = calm("grid", "depths.nc", *given, "-o", "o.nc", "--levels", "100,200")
    assert done.code == 2
    assert "no column is called `temprature`; did you mean `temperature`?" in done.err


@pytest.mark.parametrize("levels", [[100.0, 100.0], [-5.0, 10.0], [], [np.nan]])
def test_levels_in_python_must_increase_below_the_surface(depths, levels):
    with pytest.raises(package.UsageError, match="--levels"):
        package.grid("depths.nc", "v.nc", levels)
