"""`calm motion` as a user runs it: a small mooring whose motion is known."""

import json
import re

import numpy as np
import pytest
import xarray

import calm as package
from calm.motion.sensors import depth_of
from tests.drawings import assert_none_overlap, svgs_of

HOURS = 48
LATITUDE = 48.0
MOORING = """\
name: Twin
position: {latitude: 48 deg, longitude: -5 deg}
environment:
  depth: 300 m
  current: {speed: 0.5 m/s, toward: 90 deg}
line:
  - {use: ball, label: top float}
  - {use: rope, length: 250 m, clamps: [{use: logger, at: 10 m, label: upper}, {use: logger, at: 100 m, label: middle}, {use: logger, at: 200 m, label: lower}]}
  - {use: weight}
components:
  ball: {kind: sphere, role: float, diameter: 1 m, buoyancy: 2000 N}
  rope: {kind: cable, diameter: 10 mm, weight: 0.2 N/m, stiffness: 1 MN}
  logger: {kind: cylinder, role: instrument, diameter: 40 mm, length: 0.3 m, buoyancy: -5 N}
  weight: {kind: anchor, weight: 9000 N}
"""  # noqa: E501
LEVELS = (0.0, 150.0, 300.0)
NAMES = ("upper", "middle", "lower")


@pytest.fixture(scope="module")
def truth(tmp_path_factory):
    """Hourly currents, and the depths of the three loggers in them [m]."""
    path = tmp_path_factory.mktemp("truth") / "m.yaml"
    path.write_text(MOORING)
    random = np.random.default_rng(7)
    speed = 0.35 + 0.3 * np.sin(2 * np.pi * np.arange(HOURS) / 12.4)
    u = speed[:, None] * np.array([1.0, 0.8, 0.5])
    depths = package.solve_profiles(package.load(path), u, 0.0 * u, LEVELS).clamp_depth
    return u, depths + 0.05 * random.standard_normal(depths.shape)


def stamps():
    return [f"2026-03-0{1 + hour // 24}T{hour % 24:02d}:00" for hour in range(HOURS)]


def dbar(depth):
    import gsw

    return gsw.p_from_z(-depth, LATITUDE)


@pytest.fixture
def given(folder, truth):
    """The files of a mooring, its currents and its pressures; returns what writes other ones."""
    u, depth = truth
    (folder / "m.yaml").write_text(MOORING)
    rows = [
        f"{time},{level},{value:.5f},0"
        for time, profile in zip(stamps(), u, strict=True)
        for level, value in zip(LEVELS, profile, strict=True)
    ]
    (folder / "c.csv").write_text("time,depth[m],u[m/s],v[m/s]\n" + "\n".join(rows) + "\n")

    def pressures(name="p.csv", labels=NAMES, unit="dbar", factor=1.0, values=None, times=None):
        values = dbar(depth) if values is None else values
        lines = [
            f"{time}," + ",".join(f"{value * factor:.5f}" for value in row)
            for time, row in zip(times or stamps(), values, strict=True)
        ]
        head = ",".join(f"{label}[{unit}]" if unit else label for label in labels)
        (folder / name).write_text(f"time,{head}\n" + "\n".join(lines) + "\n")
        return name

    pressures()
    return pressures


WITHOUT_STANDARD_NAME = {
    *("x_top", "y_top", "clamp_x", "clamp_y", "knockdown", "clamp_knockdown", "tilt", "clamp_tilt"),
    *("tension_top", "tension_bottom", "clamp_tension", "anchor_vertical", "anchor_horizontal"),
    *("used_buoyancy", "other_used_buoyancy", "residual", "current_factor", "current_doubt"),
}
"""Quantities of a motion file that the standard name table of CF lacks (version 93)."""
COMMAND = ("motion", "m.yaml", "--currents", "c.csv", "--workers", 1)


def test_depths_sensors_and_a_hidden_one(calm, given, truth, folder):
    done = calm(*COMMAND, "--pressures", "p.csv", "-o", "d.nc", "--hold-out", "middle",
                "--json", "-")  # fmt: skip
    assert done.code == 0, done.err
    said = json.loads(done.out)
    assert set(said["factors"]) == {"cable_drag", "rigid_drag"}
    for one in said["factors"].values():
        assert one["low"] < 1.0 < one["high"]  # nothing was wrong with the drag
    assert [one["label"] for one in said["sensors"]] == ["upper", "lower"]
    (held,) = said["held_out"]
    assert held["label"] == "middle" and held["n"] == HOURS
    assert held["rms"] < 0.5 * held["linear_rms"]
    with xarray.open_dataset(folder / "d.nc", engine="h5netcdf") as result:
        assert result["residual"].dims == ("time", "sensor")
        assert result["depth_sd"].dims == ("time", "component")
        off = result["clamp_depth"].values - truth[1]
        assert np.sqrt((off**2).mean()) < 0.5
        spread = result["clamp_depth_sd"].values
        assert (np.abs(off) < 4.0 * spread).all() and (spread > 0.0).all()
        depth = np.hstack([result["clamp_depth"].values, result["depth_top"].values])
        extent = [result.attrs[f"geospatial_vertical_{end}"] for end in ("min", "max")]
        assert extent == [depth.min(), depth.max()]
        nameless = {
            name for name, one in result.variables.items()
            if "units" in one.attrs and not {"standard_name", "axis"} & {*one.attrs}
        }  # fmt: skip
        assert nameless == WITHOUT_STANDARD_NAME
        assert result["current_factor"].values == pytest.approx(np.ones(HOURS), abs=0.15)
        assert (result["status"].values == 0).all()


@pytest.mark.thorough
def test_python_finds_what_the_command_writes(calm, given, folder):
    done = calm(*COMMAND, "--pressures", "p.csv", "-o", "d.nc", "--hold-out", "middle",
                "--json", "-")  # fmt: skip
    said = json.loads(done.out)
    mooring = package.load("m.yaml")
    found = package.estimate_motion(mooring, ["p.csv"], ["c.csv"], hold_out=["middle"], workers=1)
    with xarray.open_dataset(folder / "d.nc", engine="h5netcdf") as result:
        xarray.testing.assert_equal(found.to_xarray(), result.load())
    assert found.held_out["middle"].rms == said["held_out"][0]["rms"]
    assert found.factors["cable_drag"][0] == said["factors"]["cable_drag"]["value"]
    assert list(found.sensors) == ["upper", "lower"]
    assert repr(found).startswith(f"Twin: {HOURS} times, 2026-03-01T00:00 to 2026-03-02T23:00\n")
    assert len(repr(found).splitlines()) <= 10


@pytest.mark.thorough
def test_the_same_again_gives_the_same_bytes_and_another_takes_their_place(calm, given, folder):
    words = (*COMMAND, "--pressures", "p.csv", "-o", "d.nc")
    first = calm(*words)
    before = (folder / "d.nc").read_bytes()
    assert (first.code, calm(*words).out) == (0, first.out)
    assert (folder / "d.nc").read_bytes() == before
    assert calm(*words, "--hold-out", "upper").code == 0
    assert (folder / "d.nc").read_bytes() != before


@pytest.mark.thorough
def test_cross_validation_hides_each_in_turn(calm, given):
    done = calm(*COMMAND, "--pressures", "p.csv", "-o", "d.nc", "--cross-validate", "--json", "-")
    assert done.code == 0, done.err
    assert [one["label"] for one in json.loads(done.out)["held_out"]] == list(NAMES)


@pytest.mark.parametrize(("unit", "factor"), [("bar", 0.1), ("kPa", 10.0), ("Pa", 1e4)])
@pytest.mark.thorough
def test_declared_units_convert(calm, given, truth, unit, factor, folder):
    given("q.csv", unit=unit, factor=factor)
    done = calm(*COMMAND, "--pressures", "q.csv", "-o", "d.nc")
    assert done.code == 0, done.err
    with xarray.open_dataset(folder / "d.nc", engine="h5netcdf") as result:
        off = result["clamp_depth"].values - truth[1]
        assert np.sqrt((off**2).mean()) < 0.5


@pytest.mark.thorough
def test_netcdf_with_flags_and_one_file_for_a_sensor(calm, given, truth, folder):
    values = dbar(truth[1])
    flags = np.ones(values.shape, np.int8)
    values[5, 0], flags[5, 0] = 500.0, 4
    values[6, 0], flags[6, 0] = 400.0, 8
    time = np.array(stamps(), "M8[ns]")
    attributes = {"standard_name": "sea_water_pressure", "units": "dbar"}
    both = xarray.Dataset(
        {
            "pressure": (("time", "instrument"), values[:, :2], attributes),
            "pressure_qc": (("time", "instrument"), flags[:, :2], {"flag_values": [1, 2, 4, 8]}),
        },
        {"time": time, "instrument": list(NAMES[:2])},
    )
    both.to_netcdf(folder / "p.nc", engine="h5netcdf")
    one = xarray.Dataset({"PRES": (("time",), values[:, 2], attributes)}, {"time": time})
    one.to_netcdf(folder / "one.nc", engine="h5netcdf")
    done = calm(*COMMAND, "--pressures", "p.nc", "lower=one.nc", "-o", "d.nc", "--json", "-")
    assert done.code == 0, done.err
    assert "upper: 2 pressures were excluded by their flag" in done.err
    said = json.loads(done.out)
    assert [one["n"] for one in said["sensors"]] == [46, 48, 48]
    files = [one["file"] for one in said["read"]]
    assert files[-2:] == ["p.nc", "one.nc"] and "p.nc: read as" in done.err
    with xarray.open_dataset("d.nc", engine="h5netcdf") as result:
        assert json.loads(result.attrs["read"]) == said["read"]
        assert result.attrs["history"].count("\nread ") == len(files)


def test_what_cannot_be_used_is_refused_and_nothing_is_written(calm, given, truth, folder):
    depth = dbar(truth[1])
    later = [time.replace("2026", "2027") for time in stamps()]
    cases = {
        "needs a unit": given("a.csv", unit=""),
        "no instrument matches a part of the line": given("b.csv", labels=("x", "y", "z")),
        "no time has both": given("c2.csv", times=later),
        "its unit (bar, kPa?)": given("d.csv", factor=0.1),
        "is a speed; a pressure": given("e.csv", unit="knot"),
        "two sensors are called": given("f.csv", labels=("upper", "upper", "lower")),
        "two sensors are called `upper`": given("h.csv", labels=("upper", "UPPER", "lower")),
        "no usable sensor remains": given("g.csv", values=0.0 * depth + 100.0),
        "no such file": "missing.csv",
    }
    for reason, file in cases.items():
        done = calm(*COMMAND, "--pressures", file, "-o", "d.nc")
        assert (done.code, done.out) == (2, ""), (reason, done)
        assert reason in done.err, (reason, done.err)
    assert not list(folder.glob("d.nc*"))


def test_readings_that_cannot_be_and_pressures_of_the_air_are_named(calm, given, truth, folder):
    values = dbar(truth[1]) + 10.1325
    values[:5], values[9, 1] = 0.3, 99999.0  # on deck; a fill value that its file does not declare
    values[11, 1] = np.inf
    given("air.csv", values=values)
    done = calm(*COMMAND, "--pressures", "air.csv", "-o", "d.nc", "--json", "-")
    assert done.code == 0, done.err
    said = re.findall(r"(\w+): (\d+) of its readings are impossible", done.err)
    assert said == [("upper", "5"), ("middle", "6"), ("lower", "5")]
    assert "The pressures appear to be absolute: `--correct air` subtracts" in done.err
    with xarray.open_dataset(folder / "d.nc", engine="h5netcdf") as result:
        off = result["clamp_depth"].values - truth[1]
        assert off.mean() == pytest.approx(9.7, abs=0.3) and off.std() < 0.3
    # taken off when told so, or where the readings on deck say it
    values[:5] = 10.1
    for file, more in (("air.csv", ("--correct", "air")), (given("deck.csv", values=values), ())):
        done = calm(*COMMAND, "--pressures", file, *more, "-o", "e.nc")
        assert done.code == 0 and "appear to be absolute" not in done.err
        assert (
            "so its pressures are absolute; the pressure of the air, 10.13 dbar" in done.err
        ) == (not more)
        with xarray.open_dataset(folder / "e.nc", engine="h5netcdf") as result:
            assert (result["clamp_depth"].values - truth[1]).mean() == pytest.approx(0.0, abs=0.5)
        (folder / "e.nc").unlink()


def test_depths_recorded_as_pressures_are_named(calm, given, truth):
    for file, said in (("p.csv", False), (given("m.csv", values=truth[1]), True)):
        done = calm(*COMMAND, "--pressures", file, "-o", f"{file}.nc")
        text = " ".join((done.out + done.err).split())
        assert ("0.9 % low, as if depths in metres were recorded as dbar" in text) == said


def test_flags_that_leave_no_pressure_are_named(calm, given, truth, folder):
    attributes = {"standard_name": "sea_water_pressure", "units": "dbar"}
    bad = np.full(truth[1].shape, 4, np.int8)
    dims = ("time", "instrument")
    variables = {"p": (dims, dbar(truth[1]), attributes), "p_qc": (dims, bad)}
    coordinates = {"time": np.array(stamps(), "M8[ns]"), "instrument": list(NAMES)}
    xarray.Dataset(variables, coordinates).to_netcdf(folder / "p.nc", engine="h5netcdf")
    done = calm(*COMMAND, "--pressures", "p.nc", "-o", "d.nc")
    assert done.code == 2 and "no sensor has a good pressure" in done.err
    assert "middle: 48 pressures were excluded by their flag" in done.err
    assert not list(folder.glob("d.nc*"))


@pytest.mark.parametrize(
    ("words", "reason"),
    [
        (("--hold-out", "upper,middle", "--cross-validate"), "at least two sensors are needed"),
        (("--hold-out", "uper"), "did you mean `upper`"),
        (("--hold-out", "upper,middle,lower"), "at least one sensor must remain"),
        (("--flags", "1,8"), "not measurements"),
        (("--gap", "2"), "--gap: `2` needs a unit: `2 h`?"),
        (("--gap", "2 km"), "is a length; a time (s, ms, min, h, d) is needed"),
        (("--gap", "1300 d"), "is not between 0 and three years"),
        (("--fit", "drag"), "cannot be estimated"),
        (("--match", "colour"), "must be one of label, height, depth"),
        (("--match", "height"), "no nominal height or depth"),
    ],
)
def test_options_that_make_no_sense(calm, given, folder, words, reason):
    done = calm(*COMMAND, "--pressures", "p.csv", "-o", "d.nc", *words)
    assert done.code == 2 and reason in done.err
    assert not (folder / "d.nc").exists()


def test_a_constant_sensor_is_named_and_left_out(calm, given, truth):
    values = dbar(truth[1])
    values[:, 1] = values[0, 1]
    given("k.csv", values=values)
    done = calm(*COMMAND, "--pressures", "k.csv", "-o", "d.nc", "--json", "-")
    assert done.code == 0 and "middle is constant" in done.err
    assert [one["label"] for one in json.loads(done.out)["sensors"]] == ["upper", "lower"]


def test_times_without_current_or_without_pressure_have_wider_bands(calm, given, truth, folder):
    lines = (folder / "c.csv").read_text().splitlines()
    (folder / "c.csv").write_text("\n".join([lines[0], *lines[1:31], *lines[61:]]) + "\n")
    values = dbar(truth[1])
    given("late.csv", values=values[8:], times=stamps()[8:])
    done = calm(*COMMAND, "--pressures", "late.csv", "-o", "d.nc")
    assert done.code == 0, done.err
    with xarray.open_dataset(folder / "d.nc", engine="h5netcdf") as result:
        assert result.sizes["time"] == HOURS
        assert (result["status"].values == 0).all()
        off = result["clamp_depth"].values[10:20] - truth[1][10:20]
        spread = result["clamp_depth_sd"].values
        assert (np.abs(off) < 3.0 * spread[10:20]).all()
        # besides the zeros of the sensors, whose error is the same at all times
        own = spread[:, 1] ** 2 - spread[:, 1].min() ** 2
        assert own[:8].max() > 4.0 * own[22:].max()


def test_times_far_from_any_current_have_a_status(calm, given, folder):
    lines = (folder / "c.csv").read_text().splitlines()
    (folder / "c.csv").write_text("\n".join(lines[:31]) + "\n")  # ten hours
    done = calm(*COMMAND, "--pressures", "p.csv", "-o", "d.nc")
    assert done.code == 0, done.err
    with xarray.open_dataset(folder / "d.nc", engine="h5netcdf") as result:
        meanings = result["status"].attrs["flag_meanings"].split()
        lost = [meanings[code] == "no-current" for code in result["status"].values]
        assert lost == [hour > 9 + 16 for hour in range(HOURS)]
        assert (np.isnan(result["clamp_depth"].values).all(axis=1) == lost).all()


def test_a_clamp_that_slipped_is_named(calm, given, truth):
    values = dbar(truth[1])
    values[HOURS // 2 :, 1] += 6.0
    given("s.csv", values=values)
    done = calm(*COMMAND, "--pressures", "s.csv", "-o", "d.nc", "--json", "-")
    assert any("clamp has probably slipped" in one for one in json.loads(done.out)["doubts"])


@pytest.mark.thorough
def test_a_clock_that_is_late_is_taken_off_and_the_history_says_so(calm, given, truth, folder):
    values = dbar(truth[1])
    values[1:, 1] = values[:-1, 1].copy()
    given("s.csv", values=values)
    done = calm(*COMMAND, "--pressures", "s.csv", "-o", "d.nc", "--json", "-", "--correct", "clock")
    (found,) = json.loads(done.out)["diagnosis"]
    assert (found["label"], found["kind"], found["corrected"]) == ("middle", "clock", True)
    assert found["low"] < 3600.0 < found["high"]
    with xarray.open_dataset(folder / "d.nc", engine="h5netcdf") as result:
        assert "corrected for: middle: its clock is 1.0" in result.attrs["history"]
    done = calm(*COMMAND, "--pressures", "s.csv", "-o", "e.nc", "--correct", "clocks")
    assert done.code == 2 and "did you mean `clock`?" in done.err


@pytest.mark.thorough
def test_the_sea_level_is_taken_off_and_what_is_fitted_is_told(calm, given, truth, folder):
    tide = 3.0 * np.sin(2 * np.pi * np.arange(HOURS) / 12.4 + 1.0)
    given("t.csv", values=dbar(truth[1] + tide[:, None]))
    rows = [f"{time},{100.0 * level:.2f}" for time, level in zip(stamps(), tide, strict=True)]
    (folder / "level.csv").write_text("time,level[cm]\n" + "\n".join(rows) + "\n")
    said, spread = {}, {}
    for name, words in (("fitted", ()), ("given", ("--sea-level", "level.csv"))):
        done = calm(*COMMAND, "--pressures", "t.csv", *words, "--fit", "buoyancy,length",
                    "-o", f"{name}.nc", "--json", "-")  # fmt: skip
        assert done.code == 0, done.err
        said[name] = json.loads(done.out)["factors"]
        with xarray.open_dataset(folder / f"{name}.nc", engine="h5netcdf") as result:
            off = result["clamp_depth"].values - truth[1] - tide[:, None]
            spread[name] = np.sqrt((off**2).mean())
    assert set(said["given"]) == {"cable_drag", "rigid_drag", "buoyancy", "length"}
    assert all(one["low"] < 1.0 < one["high"] for one in said["given"].values())
    assert spread["given"] < 0.3 and spread["fitted"] < 1.0


def test_depths_of_pressures_are_those_of_teos_10():
    # the check values of the function z_from_p of the Gibbs SeaWater toolbox, at 4 degrees north
    depths = depth_of(np.array([10.0, 600.0, 1000.0]), 4.0)
    assert depths == pytest.approx([9.94458, 595.82535, 992.09191], abs=1e-3)


@pytest.fixture
def own(folder):
    """A user's own file of instruments."""
    time = np.array(stamps(), "M8[ns]")
    own = xarray.Dataset(
        {"temperature": (("time", "instrument"), np.full((HOURS, 2), 4.5), {"units": "degC"})},
        {"time": time, "instrument": ["middle", "elsewhere"]},
    )
    own.to_netcdf(folder / "own.nc", engine="h5netcdf")


def test_an_interrupted_run_leaves_nothing(calm, given, folder, monkeypatch):
    def interrupted(*_, **__):
        raise KeyboardInterrupt

    before = sorted(path.name for path in folder.iterdir())
    monkeypatch.setattr("calm.motion.correction.packed", interrupted)
    done = calm(*COMMAND, "--pressures", "p.csv", "-o", "d.nc")
    assert (done.code, done.err.splitlines()[-1]) == (130, "calm: interrupted")
    assert sorted(path.name for path in folder.iterdir()) == before


@pytest.mark.thorough
def test_depths_go_onto_a_copy_of_a_users_own_file(calm, given, own, truth, folder):
    words = (*COMMAND, "--pressures", "p.csv", "--hold-out", "middle", "--report", "report")
    done = calm(*words, "--onto", "own.nc", "-o", "copy.nc")
    assert done.code == 0, done.err
    assert "`elsewhere` matches no part of the line" in done.err
    with xarray.open_dataset(folder / "copy.nc", engine="h5netcdf") as copy:
        assert (copy["temperature"].values == 4.5).all()
        off = copy["depth"].values[:, 0] - truth[1][:, 1]
        assert np.sqrt((off**2).mean()) < 0.5
        assert (copy["depth_sd"].values[:, 0] > 0.0).all()
        assert np.isnan(copy["depth"].values[:, 1]).all()
    assert (folder / "copy.motion.nc").exists()
    page = (folder / "report" / "motion.html").read_text()
    assert "middle, withheld" in page and "drag of cables and chains" in page
    assert (folder / "report" / "motion.pdf").read_bytes().startswith(b"%PDF")
    again = calm(*words, "--onto", "copy.nc", "-o", "other.nc")
    assert again.code == 2 and "already has `depth`" in again.err


@pytest.mark.thorough
def test_a_folder_in_is_a_folder_out(calm, given, truth, folder):
    (folder / "in").mkdir()
    time = np.array(stamps(), "M8[ns]")
    for name, serial in (("a", "lower"), ("b", "stranger")):
        xarray.Dataset(
            {"TEMP": ("TIME", np.full(HOURS, 4.5), {"units": "degree_Celsius"})},
            {"TIME": time, "label": ("INSTRUMENT", [serial])},
        ).to_netcdf(folder / "in" / f"{name}.nc", engine="h5netcdf")
    words = (*COMMAND, "--pressures", "p.csv", "--onto", "in")
    done = calm(*words, "-o", "in")
    assert done.code == 2 and "in is an input file and was not overwritten" in done.err
    done = calm(*words, "-o", "out")
    assert done.code == 0, done.err
    assert [one.name for one in (folder / "out").iterdir()] == ["a.nc"]
    assert "b.nc matches no part of the line; no output was written" in done.err
    with xarray.open_dataset(folder / "out" / "a.nc", engine="h5netcdf") as copy:
        assert np.abs(copy["depth"].values[:, 0] - truth[1][:, 2]).max() < 2.0
        assert copy.attrs["history"].count("sha256:") == 3
    assert (folder / "out.motion.nc").exists()


@pytest.mark.thorough
def test_currents_that_look_false_are_named(calm, given, truth, folder):
    rows = (folder / "c.csv").read_text().splitlines()
    for hour in (15, 16, 40):
        rows[1 + 3 * hour] = rows[1 + 3 * hour].rsplit(",", 2)[0] + ",2.0,0"
    (folder / "c.csv").write_text("\n".join(rows) + "\n")
    done = calm(*COMMAND, "--pressures", "p.csv", "-o", "d.nc", "--report", "r", "--json", "-")
    assert done.code == 0, done.err
    doubts = json.loads(done.out)["doubts"]
    assert any("current at 0.0 m: its direction or speed is probably wrong at 3 of 48" in one
               and "2026-03-01T15:00" in one for one in doubts), doubts  # fmt: skip
    with xarray.open_dataset(folder / "d.nc", engine="h5netcdf") as result:
        assert result["level_label"].values.tolist() == ["0.0 m", "150.0 m", "300.0 m"]
        doubt = result["current_doubt"].values
        assert (doubt[[15, 16, 40], 0] > 0.5).all() and np.median(doubt) < 0.05
    page = (folder / "r" / "motion.html").read_text(encoding="utf-8")
    assert "current is probably wrong" in page
    for svg in svgs_of(page):
        assert_none_overlap(svg)


def test_currents_that_cannot_be_are_left_out_and_named(calm, given, folder):
    rows = (folder / "c.csv").read_text().splitlines()
    for row in (1 + 3 * 5, *range(1 + 3 * 9, 4 + 3 * 9)):  # one level; all of another time
        rows[row] = rows[row].rsplit(",", 2)[0] + ",-32.768,0"
    (folder / "c.csv").write_text("\n".join(rows) + "\n")
    done = calm(*COMMAND, "--pressures", "p.csv", "--gap", "0 h", "-o", "d.nc")
    assert done.code == 0, done.err
    assert ": 4 of " in done.err and "currents were excluded as implausible" in done.err
    assert "the first is 32.768 m/s at 0 m, 2026-03-01T05:00" in done.err
    with xarray.open_dataset(folder / "d.nc", engine="h5netcdf") as result:
        assert (result["status"].values == 0).all()  # the hours before and after say enough


def test_sensors_are_found_by_nominal_depth_in_order_down_the_line(calm, given, truth, folder):
    attributes = {"standard_name": "sea_water_pressure", "units": "dbar"}
    place = {"units": "m", "standard_name": "depth", "positive": "down", "axis": "Z"}
    coordinates = {"TIME": np.array(stamps(), "M8[ns]"), "DEPTH": ("DEPTH", [59, 149, 249], place)}
    values = {"PRES": (("TIME", "DEPTH"), dbar(truth[1]), attributes)}
    xarray.Dataset(values, coordinates).to_netcdf(folder / "os.nc", engine="h5netcdf")
    done = calm(*COMMAND, "--pressures", "os.nc", "--match", "depth", "-o", "d.nc", "--json", "-")
    assert done.code == 0, done.err  # as many sensors as instruments: no other order is possible
    assert [one["label"] for one in json.loads(done.out)["sensors"]] == list(NAMES)
    middle = xarray.open_dataset(folder / "os.nc", engine="h5netcdf").isel(DEPTH=[1])
    middle.assign_coords(DEPTH=("DEPTH", [105.0], place)).to_netcdf(folder / "one.nc")
    apart = calm(*COMMAND, "--pressures", "one.nc", "--match", "depth", "-o", "e.nc")
    assert apart.code == 2 and "could be `middle` or `upper`" in apart.err


def test_two_pressures_place_the_third_without_any_current(calm, given, truth, folder):
    done = calm("motion", "m.yaml", "--pressures", "p.csv", "-o", "d.nc", "--workers", 1,
                "--hold-out", "middle", "--json", "-", "--report", "page")  # fmt: skip
    assert done.code == 0, done.err
    said = json.loads(done.out)
    assert set(said["factors"]) == {"rigid_drag", "length"}
    assert all("plain" not in one for one in said["sensors"])
    (held,) = said["held_out"]
    assert held["rms"] < held["linear_rms"] and held["coverage_95"] > 0.9
    assert (folder / "page" / "motion.html").stat().st_size > 1000
    with xarray.open_dataset(folder / "d.nc", engine="h5netcdf") as result:
        assert not {"current_factor", "plain_depth", "level_label"} & set(result)
        off = result["clamp_depth"].values - truth[1]
        assert (np.abs(off) < 4.0 * result["clamp_depth_sd"].values).all()


def test_one_pressure_without_a_current_has_wide_bands(calm, given, truth, folder):
    done = calm("motion", "m.yaml", "--pressures", "p.csv", "-o", "d.nc",
                "--hold-out", "middle,lower")  # fmt: skip
    assert done.code == 0, done.err
    with xarray.open_dataset(folder / "d.nc", engine="h5netcdf") as result:
        off = result["clamp_depth"].values - truth[1]
        spread = result["clamp_depth_sd"].values
        assert (np.abs(off) < 3.0 * spread).mean() > 0.95


def test_one_sensor_that_is_wrong_is_left_out_and_so_is_what_is_asked_for(calm, given, truth):
    values = dbar(truth[1])
    values[:, 1] /= 25.0
    given("w.csv", values=values)
    done = calm(*COMMAND, "--pressures", "w.csv", "-o", "d.nc", "--json", "-")
    assert done.code == 0, done.err
    assert "middle is at 6.0 m at its shallowest" in done.err and "it was excluded" in done.err
    assert [one["label"] for one in json.loads(done.out)["sensors"]] == ["upper", "lower"]
    done = calm(*COMMAND, "--pressures", "p.csv", "-o", "d.nc", "--json", "-", "--without", "lower")
    assert [one["label"] for one in json.loads(done.out)["sensors"]] == ["upper", "middle"]
    done = calm(*COMMAND, "--pressures", "p.csv", "-o", "d.nc", "--without", "lowest")
    assert done.code == 2 and "--without: no sensor is called `lowest`" in done.err


def test_a_sensor_that_sticks_is_left_out_there(calm, given, truth, folder):
    values = dbar(truth[1])
    values[HOURS // 2 :, 2] = values[HOURS // 2, 2]
    given("s.csv", values=values)
    done = calm(*COMMAND, "--pressures", "s.csv", "-o", "d.nc")
    assert done.code == 0 and "lower has the same value at 24 of its 48 times" in done.err
    with xarray.open_dataset(folder / "d.nc", engine="h5netcdf") as result:
        assert np.isnan(result["residual"].values[HOURS // 2 :, 2]).all()


@pytest.mark.parametrize("currents", [True, False])
def test_a_mooring_that_moved_as_a_whole_is_named(calm, given, truth, folder, currents):
    moved = truth[1] + np.where(np.arange(HOURS) >= 30, 20.0, 0.0)[:, None]
    given("s.csv", values=dbar(moved))
    command = COMMAND if currents else ("motion", "m.yaml", "--workers", 1)
    done = calm(*command, "--pressures", "s.csv", "-o", "d.nc", "--json", "-")
    assert done.code == 0, done.err
    (found,) = (one for one in json.loads(done.out)["diagnosis"] if one["kind"] == "moved")
    assert found["label"] == "all sensors" and found["since"].startswith("2026-03-02T06:00")
    assert found["low"] < 20.0 < found["high"]
    with xarray.open_dataset(folder / "d.nc", engine="h5netcdf") as result:
        seabed = result["depth_top"].values[:, -1]
        assert np.diff([seabed[:30].mean(), seabed[30:].mean()]) == pytest.approx(20.0, abs=1.0)


def test_records_that_share_no_time_are_refused(calm, given, truth, folder):
    later = [time.replace("2026", "2028") for time in stamps()]
    given("a.csv", labels=NAMES[:1], values=dbar(truth[1][:, :1]))
    given("b.csv", labels=NAMES[2:], values=dbar(truth[1][:, 2:]), times=later)
    done = calm("motion", "m.yaml", "--pressures", "a.csv", "b.csv", "-o", "d.nc")
    assert done.code == 2 and "0 of 96 times have pressures of two or more sensors" in done.err
    assert "upper 2026-03-01 to 2026-03-02; lower 2028-03-01" in done.err


def test_a_measured_clock_is_put_right_and_told(calm, given, truth, folder):
    values = dbar(truth[1])
    values[3:, 1] = values[:-3, 1].copy()  # three hours behind throughout, at the end of the record
    item = "{label: middle, clock: {checked: 2026-03-02T23:00, late: 3 h}}"
    text = MOORING + f"deployed: {{date: 2026-03-01T00:00, items: [{item}]}}\n"
    (folder / "c.yaml").write_text(text)
    done = calm("motion", "c.yaml", *COMMAND[2:], "--pressures", "p.csv", "-o", "d.nc")
    assert done.code == 0, done.err
    assert "middle: its clock was 10800 s behind at 2026-03-02T23:00" in done.err
    with xarray.open_dataset(folder / "d.nc", engine="h5netcdf") as result:
        assert "its clock was 10800 s behind" in result.attrs["history"]


def test_currents_of_instruments_on_the_line_move_with_it_by_their_serial_numbers(
    calm, given, truth, folder
):
    line = MOORING
    for number, label in enumerate(NAMES):
        line = line.replace(f"label: {label}}}", f"label: {label}, serial: {100 + number}}}")
    (folder / "s.yaml").write_text(line)
    speed = {"units": "m/s"}
    place = {"units": "m", "standard_name": "depth", "positive": "down", "axis": "Z"}
    values = {
        name: (
            ("time", "N_LEVELS"),
            part,
            {**speed, "standard_name": f"{way}ward_sea_water_velocity"},
        )
        for name, way, part in (("u", "east", truth[0]), ("v", "north", 0.0 * truth[0]))
    }
    coordinates = {
        "time": np.array(stamps(), "M8[ns]"),
        "depth": ("N_LEVELS", [57.0, 147.0, 247.0], place),
        "serial_number": ("N_LEVELS", [100, 101, 102]),
    }
    xarray.Dataset(values, coordinates).to_netcdf(folder / "c.nc", engine="h5netcdf")
    done = calm("motion", "s.yaml", "--currents", "c.nc", "--pressures", "p.csv", "-o", "d.nc")
    assert done.code == 0, done.err
    assert "the currents of upper, middle, lower are used at estimated depths" in done.err
    with xarray.open_dataset(folder / "d.nc", engine="h5netcdf") as result:
        assert result["level_label"].values.tolist() == [*NAMES]


def test_python_takes_datasets_and_tables(given, truth, folder):
    import pandas

    current = xarray.Dataset(
        {
            name: (
                ("time", "depth"),
                part,
                {"units": "m/s", "standard_name": f"{way}ward_sea_water_velocity"},
            )
            for name, way, part in (("u", "east", truth[0]), ("v", "north", 0.0 * truth[0]))
        },
        {
            "time": np.array(stamps(), "M8[ns]"),
            "depth": (
                "depth",
                list(LEVELS),
                {"units": "m", "positive": "down", "standard_name": "depth"},
            ),
        },
    )
    table = pandas.DataFrame(
        dbar(truth[1]), index=pandas.DatetimeIndex(stamps(), name="time"),
        columns=[f"{label}[dbar]" for label in NAMES],
    )  # fmt: skip
    mooring = package.load("m.yaml")
    found = package.estimate_motion(mooring, table, current, workers=1)
    off = found.to_xarray()["clamp_depth"].values - truth[1]
    assert np.sqrt((off**2).mean()) < 0.5
    assert len(found.plot().lines) == 2 * len(NAMES)


def test_a_file_of_one_current_meter_is_given_with_its_label(calm, given, truth, folder):
    rows = [f"{time},100,{u:.4f},0" for time, u in zip(stamps(), truth[0][:, 1], strict=True)]
    (folder / "one.csv").write_text("time,depth[m],u[m/s],v[m/s]\n" + "\n".join(rows) + "\n")
    done = calm("motion", "m.yaml", "--currents", "middle=one.csv", "--pressures", "p.csv",
                "-o", "d.nc")  # fmt: skip
    assert done.code == 0, done.err
    with xarray.open_dataset(folder / "d.nc", engine="h5netcdf") as result:
        assert result["level_label"].values.tolist() == ["middle"]
    done = calm("motion", "m.yaml", "--currents", "middle=c.csv", "--pressures", "p.csv",
                "-o", "e.nc")  # fmt: skip
    assert done.code == 2 and "has 3 levels" in done.err
