"""What a file of currents says of itself is believed before the names of its variables."""

from collections.abc import Callable
from math import cos, radians, sin
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import xarray as xr

from calm.errors import InputError
from calm.records.current_file import read_current_file
from calm.records.current_terms import Terms

WRITTEN = Path(__file__).parent / "written"
"""Files that MHKiT 1.1.2 wrote: velocities (dir, range, time) of a Signature looking up, at 60 dbar
rising by 1 dbar an hour; bins 2, 6 ... 18 m above its head, `u` 0.1 m/s more in each."""

U, V = [0.5, 0.25, 0.125], [-0.5, -0.25, 0.0]
DEPTH = ("depth", [5.0, 50.0, 200.0], {"units": "m", "positive": "down"})
SPEED = {"units": "m/s"}


def currents(first: str = "u", second: str = "v", **words: Any) -> xr.Dataset:
    """Two velocities by their usual names; `words` are attributes of both."""
    return xr.Dataset(
        {first: ("depth", U, SPEED | words), second: ("depth", V, SPEED | words)}, {"depth": DEPTH}
    )


def directions(name: str = "CDIR", **words: Any) -> xr.Dataset:
    """1 m/s by direction."""
    return xr.Dataset(
        {
            "speed": ("depth", [1.0, 1.0, 1.0], SPEED),
            name: ("depth", [0.0, 90.0, 210.0], {"units": "degree"} | words),
        },
        {"depth": DEPTH},
    )


def read(dataset: xr.Dataset, folder: Path, terms: Terms = Terms(300.0)):  # noqa: B008
    path = folder / "current.nc"
    dataset.to_netcdf(path, engine="h5netcdf")
    return read_current_file(path, None, terms)


def refusal(dataset: xr.Dataset, folder: Path, terms: Terms = Terms(300.0)) -> str:  # noqa: B008
    with pytest.raises(InputError) as caught:
        read(dataset, folder, terms)
    [problem] = caught.value.problems
    return problem.message.partition("; it holds")[0]


@pytest.mark.parametrize(("words", "said"), [
    ({"cell_methods": "time: mean within years time: mean over years"}, "not a value at one time"),
    ({"cell_methods": "depth: mean"}, "has `cell_methods: depth: mean`, so it is not a value at"),
    ({"cell_methods": "time: mean (interval: 1 h) z: mean"}, "not a value at one time and depth"),
    ({"scale_factor": 0.0}, "has `scale_factor: 0`, which makes every value the same"),
])  # fmt: skip
def test_what_the_attributes_of_a_variable_betray(tmp_path, words, said):
    assert said in refusal(currents(**words), tmp_path)


def test_a_mean_over_layers_with_bounds_is_a_current(tmp_path):
    layered = currents(cell_methods="depth: mean")
    layered["depth"].attrs["bounds"] = "depth_bounds"
    layered["depth_bounds"] = ("depth", "two"), [[0.0, 10.0], [10.0, 100.0], [100.0, 300.0]]
    assert read(layered, tmp_path)[0].u == tuple(U)


@pytest.mark.parametrize("words", [
    {"title": "Geostrophic currents"}, {"summary": "Gezeitenstrom, aus harmonischer Analyse"},
    {"comment": "Positive u is toward the west. Times are local."},
])  # fmt: skip
def test_texts_decide_nothing_and_stand_on_the_card(tmp_path, words):
    table, notices = read(currents(comment="rotated").assign_attrs(words), tmp_path)
    assert table.u == tuple(U) and len(notices) == 1  # of the water below the last level
    assert table.card.texts == words
    assert table.card.to_dict()["variables"]["east"]["description"] == "rotated"
    long = read(currents().assign_attrs(title="x" * 400), tmp_path)[0].card.texts["title"]
    assert len(long) == 300 and long.endswith("…")


MAGNETIC = [
    lambda: currents("UCUR_MAG", "VCUR_MAG"),
    lambda: currents(reference_datum="magnetic north"),
    lambda: currents(long_name="velocity relative to magnetic north"),
    lambda: currents(reference_frame="magnetic"),
    lambda: currents(magnetic_declination_applied=0),
    lambda: currents().assign_attrs(magnetic_declination_applied=0),
    lambda: currents().assign_attrs(magnetic_variation_applied="no"),
    lambda: currents().assign_attrs(north_reference="magnetic"),
    lambda: currents().assign_attrs(heading_reference="Magnetic North"),
    lambda: currents().assign_attrs(coord_sys="earth magnetic"),
    lambda: directions("CDIR_MAG", long_name="current to direction"),
    lambda: directions(long_name="direction the current flows to, magnetic"),
    lambda: directions(units="degrees magnetic", standard_name="sea_water_velocity_to_direction"),
]


@pytest.mark.parametrize("make", MAGNETIC)
def test_magnetic_north_needs_a_declination(tmp_path: Path, make: Callable[[], xr.Dataset]) -> None:
    assert "relative to magnetic north; set the `declination` of the site" in refusal(
        make(), tmp_path
    )
    table, notices = read(make(), tmp_path, Terms(300.0, declination=30.0))
    true = read(make().drop_attrs().pipe(_as_true), tmp_path)[0]
    # turned clockwise by 30° by the law of a rotation
    for i in range(3):
        east = true.u[i] * cos(radians(30)) + true.v[i] * sin(radians(30))
        north = true.v[i] * cos(radians(30)) - true.u[i] * sin(radians(30))
        assert (table.u[i], table.v[i]) == pytest.approx((east, north), abs=1e-15)
    assert any("were relative to magnetic north, and were rotated by 30°" in one for one in notices)


def _as_true(dataset: xr.Dataset) -> xr.Dataset:
    names = [str(name) for name in dataset.data_vars]
    plain = {"UCUR_MAG": "u", "VCUR_MAG": "v", "CDIR_MAG": "toward", "CDIR": "toward"}
    dataset = dataset.rename({name: plain[name] for name in names if name in plain})
    for name in dataset.data_vars:
        dataset[name].attrs["units"] = "degree" if name == "toward" else "m/s"
    dataset["depth"].attrs = DEPTH[2]
    return dataset


@pytest.mark.parametrize("words", [
    {"magnetic_declination_applied": "yes"}, {"magnetic_declination_applied": 12.5},
    {"reference_datum": "true north"},
])  # fmt: skip
def test_what_was_corrected_is_true(tmp_path: Path, words: dict[str, Any]) -> None:
    assert read(currents(**words), tmp_path)[0].u == tuple(U)
    message = refusal(currents(**words), tmp_path, Terms(300.0, declination=12.5))
    assert "are relative to true north according to their attributes" in message


def test_a_declination_is_applied_to_what_does_not_name_its_north(tmp_path: Path) -> None:
    words = {"long_name": "velocity, corrected for magnetic declination"}
    assert read(currents(**words), tmp_path)[0].u == tuple(U)
    table, notices = read(currents(), tmp_path, Terms(300.0, declination=90.0))
    assert table.u == pytest.approx(V) and table.card.declination == 90.0
    assert notices[:1] == [
        "`u` and `v` were relative to magnetic north, as specified by the user, not by the file, "
        "and were rotated by 90°"
    ]


def test_true_components_before_magnetic_ones(tmp_path: Path) -> None:
    both = currents("UCUR", "VCUR").merge(currents("UCUR_MAG", "VCUR_MAG") * 2)
    assert read(both, tmp_path)[0].u == tuple(U)
    mixed = currents("UCUR", "VCUR_MAG")
    assert refusal(mixed, tmp_path) == "`VCUR_MAG` is relative to magnetic north, but `UCUR` is not"


@pytest.mark.parametrize(
    ("words", "reason"),
    [
        (
            {"cell_methods": "time: standard_deviation"},
            "not a value at one time and depth",
        ),
        ({"cell_methods": "time: maximum"}, "not a value at one time and depth"),
        ({"coord_sys": "beam"}, "has no east and north components (`coord_sys: beam`)"),
        (
            {"coordinate_system": "instrument XYZ"},
            "has no east and north components (`coord",
        ),
        (
            {"standard_name": "baroclinic_eastward_sea_water_velocity"},
            "`u` has the standard name baroclinic_eastward_sea_water_velocity instead of eastward",
        ),
        (
            {"standard_name": "eastward_sea_water_velocity standard_error"},
            "`u` has the standard name eastward_sea_water_velocity standard_error instead of",
        ),
        ({"standard_name": "surface_geostrophic_eastward_sea_water_velocity"}, "instead of"),
    ],
)
def test_other_frames_and_quantities_are_refused(
    tmp_path: Path, words: dict[str, str], reason: str
) -> None:
    assert reason in refusal(currents(**words), tmp_path)


@pytest.mark.parametrize("frame", ["beam", "inst", "xyz", "ship", "principal"])
def test_the_coordinates_of_the_file_count(tmp_path: Path, frame: str) -> None:
    message = refusal(currents().assign_attrs(coord_sys=frame), tmp_path)
    assert message == (
        f"its current has no east and north components (`coord_sys: {frame}`); rotate it to earth "
        "coordinates first"
    )
    assert read(currents().assign_attrs(coord_sys="earth"), tmp_path)[0].u == tuple(U)
    for name in ("coord_system", "coordinates_frame", "coordinate_transformation", "transform"):
        message = refusal(currents().assign_attrs({name: frame}), tmp_path)
        assert message.startswith(
            f"its current has no east and north components (`{name}: {frame}`)"
        )


@pytest.mark.parametrize(
    ("name", "value"), [("CDIR", 999.0), ("CDIR", -999.0), ("speed", -1.0), ("speed", np.inf)]
)
def test_speeds_and_directions_that_cannot_be(tmp_path: Path, name: str, value: float) -> None:
    dataset = directions(long_name="to direction")
    dataset[name][1] = value
    assert refusal(dataset, tmp_path) == (
        "the current at 50 m is not valid: the speed is infinite or negative, or the direction is "
        "outside -360 to 360°; is the number a fill value, or in another unit?"
    )


def test_a_share_of_the_depth_in_metres_is_no_depth(tmp_path: Path) -> None:
    words = {"standard_name": "ocean_sigma_coordinate"} | DEPTH[2]
    sigma = currents().assign_coords(depth=("depth", [0.1, 0.5, 0.9], words))
    assert "is ocean_sigma_coordinate, a fraction of the water depth" in refusal(sigma, tmp_path)


def test_the_way_of_a_direction_is_in_its_words(tmp_path: Path) -> None:
    table, _ = read(directions(long_name="direction from which the current comes"), tmp_path)
    assert table.u == pytest.approx([0.0, -1.0, 0.5], abs=1e-15)  # sines of 180°, 270°, 30°
    table, _ = read(directions(long_name="direction towards which it flows"), tmp_path)
    assert table.u == pytest.approx([0.0, 1.0, -0.5], abs=1e-15)
    assert "is ambiguous: the current may flow to this direction" in refusal(directions(), tmp_path)


def mhkit(**attributes: Any) -> xr.Dataset:
    """Velocities as MHKiT keeps them."""
    velocity = np.stack([[U], [V], [[0.0, 0.0, 0.01]], [[0.0, 0.0, 0.03]]])[:, 0]
    return xr.Dataset(
        {
            "vel": (("dir", "range"), velocity, {"units": "m s-1", "long_name": "Water Velocity"}),
            "vel_bt": ("dir", np.zeros(4), {"long_name": "Platform Velocity from Bottom Track"}),
            "depth": ((), 40.0, {"units": "m", "long_name": "Instrument Depth"}),
        },
        {
            "range": ("range", [2.0, 6.0, 10.0], {"units": "m", "long_name": "Profile Range"}),
            "dir": ["E", "N", "U1", "U2"],
        },
        {"coord_sys": "earth", "orientation": "up", "inst_make": "Nortek"} | attributes,
    )


def test_velocities_with_a_dimension_of_directions(tmp_path: Path) -> None:
    table, _ = read(mhkit(), tmp_path)
    assert table.depth == (30.0, 34.0, 38.0)
    assert (table.u, table.v, table.w) == ((0.125, 0.25, 0.5), (0.0, -0.25, -0.5), (0.01, 0.0, 0.0))
    assert read(mhkit(orientation="down"), tmp_path)[0].depth == (42.0, 46.0, 50.0)
    by_hand = mhkit(range_offset=0.6).drop_vars("depth")
    assert read(by_hand, tmp_path)[0].depth == (290.0, 294.0, 298.0)
    from_surface = mhkit(range_offset=0.6, orientation="down")
    assert read(from_surface, tmp_path)[0].depth == (2.0, 6.0, 10.0)


@pytest.mark.parametrize(
    ("dataset", "reason"),
    [
        (mhkit(coord_sys="beam"), "`vel` has no east and north components (`coord_sys: beam`)"),
        (
            mhkit(coord_sys="").assign_coords(dir=["X", "Y", "Z1", "Z2"]),
            "`vel` has the directions X, Y, Z1, Z2, not E and N",
        ),
        (
            mhkit(source_program="VMDAS"),
            "its current is from an ADCP on a ship (`source_program: VM",
        ),
        (
            mhkit().assign(vel_bt=("dir", np.ones(4))),
            "its current is from a platform that moves over the ground (`vel_bt`: 1 m/s)",
        ),
        (mhkit(orientation="AHRS"), "does not say whether the instrument looks up"),
        (
            mhkit().drop_vars("depth"),
            "is measured from the instrument, whose depth is not in the file",
        ),
        (
            mhkit().assign(depth=((), 40.0, {"units": "m", "long_name": "Water Depth"})),
            "whose depth is not in the file; `depth` is the water depth",
        ),
    ],
)
def test_velocities_that_are_not_those_of_the_water(
    tmp_path: Path, dataset: xr.Dataset, reason: str
) -> None:
    assert reason in refusal(dataset, tmp_path)


@pytest.mark.parametrize("which", ["instrument", "water"])
def test_files_that_mhkit_wrote(which: str) -> None:
    path = WRITTEN / f"mhkit-{which}-depth.nc"
    table, notices = read_current_file(path, "2026-03-01T02:00", Terms(100.0))
    # 62 dbar are 61.54 m by MHKiT's linear density: 10 000 x 62 / (9.81 x 1027.279)
    assert table.depth == pytest.approx([61.5226 - above for above in (18, 14, 10, 6, 2)], abs=2e-4)
    assert table.u == pytest.approx([0.52, 0.42, 0.32, 0.22, 0.12], rel=1e-6)
    assert table.v == pytest.approx([-0.25, -0.2, -0.15, -0.1, -0.05], rel=1e-6)
    assert notices == [
        "the current has no level above 43.5 m or below 59.5 m, so the value of the nearest level "
        "is used there; the water depth is 100.0 m"
    ]


def test_bins_below_the_adcp_are_no_depths(tmp_path: Path) -> None:
    levels = ("depth", [5.0, 50.0, 200.0], {"units": "m", "long_name": "depth below the ADCP"})
    assert "is measured from the instrument" in refusal(
        currents().assign_coords(depth=levels), tmp_path
    )
    bins = (
        currents()
        .rename(depth="bin")
        .assign_coords(
            bin=("bin", [5.0, 50.0, 200.0], {"units": "m", "long_name": "distance from ADCP head"}),
            DEPTH=((), 220.0, {"units": "m", "standard_name": "depth"}),
        )
    )
    assert "looks up or down" in refusal(bins.assign_coords(range=bins["bin"]), tmp_path)


def test_heights_of_roms(tmp_path: Path) -> None:
    """`z_rho` is a variable in time; the levels of the surface come last."""
    count = 3
    dataset = xr.Dataset(
        {
            "u_eastward": (("ocean_time", "s_rho"), [U[::-1]], SPEED),
            "v_northward": (("ocean_time", "s_rho"), [V[::-1]], SPEED),
            "z_rho": (
                ("ocean_time", "s_rho"),
                [[-200.0, -50.0, -5.0]],
                {"units": "meter", "long_name": "depth of RHO-points"},
            ),
        },
        {
            "s_rho": ("s_rho", np.linspace(-0.9, -0.1, count), {"axis": "Z", "units": "1"}),
            "ocean_time": ("ocean_time", [0.0], {"units": "seconds since 2026-03-01"}),
        },
    )
    table, _ = read(dataset, tmp_path)
    assert (table.depth, table.u) == ((5.0, 50.0, 200.0), tuple(U))


@pytest.mark.parametrize(
    ("attributes", "encoding", "known"),
    [
        ({"valid_range": np.array([-0.3, 0.3])}, {}, [False, True, True]),
        ({"valid_min": -9.0, "valid_max": 0.2}, {}, [False, False, True]),
        (
            {"valid_range": np.array([-260, 260], "i2")},
            {"dtype": "i2", "scale_factor": 0.001, "_FillValue": np.int16(-9999)},
            [False, True, True],
        ),
        (
            {"valid_range": np.array([-0.2, 0.2])},
            {"dtype": "i2", "scale_factor": 0.001, "_FillValue": np.int16(-9999)},
            [False, False, True],
        ),
    ],
)
def test_valid_ranges_are_honoured(
    tmp_path: Path, attributes: dict[str, Any], encoding: dict[str, Any], known: list[bool]
) -> None:
    dataset = currents()
    dataset["u"].attrs |= attributes
    dataset["u"].encoding = encoding
    table, notices = read(dataset, tmp_path)
    assert table.u == pytest.approx([u for u, good in zip(U, known, strict=True) if good])
    assert notices[0].endswith("without a value excluded from the current")


@pytest.mark.parametrize("fill", [-32.768, 99.99, 999.9, -9999.0])
def test_fill_values_not_marked_as_such_are_named(tmp_path: Path, fill: float) -> None:
    dataset = currents()
    dataset["u"][1] = fill
    message = refusal(dataset, tmp_path, Terms(300.0, maximum_speed=5.0))
    assert message.startswith(
        f"the current at 50 m is not valid: {np.hypot(fill, 0.25):.5g} m/s is faster than"
    )
    in_air = currents().assign_coords(depth=("depth", [5.0, -3.0, 200.0], DEPTH[2]))
    in_air["u"][1] = fill
    assert read(in_air, tmp_path, Terms(300.0, maximum_speed=5.0))[0].depth == (5.0, 200.0)


def test_depths_deeper_than_any_sea(tmp_path: Path) -> None:
    deep = currents().assign_coords(depth=("depth", [5.0, 50.0, 99999.0], DEPTH[2]))
    assert (
        refusal(deep, tmp_path)
        == "its depth 99999 m exceeds the greatest depth of any sea, 11000 m"
    )


def test_a_time_zone_is_not_guessed(tmp_path: Path) -> None:
    dataset = currents().expand_dims(time=[0.0])
    dataset["time"].attrs["units"] = "hours since 2026-03-01 00:00 EST"
    assert "the offset of `EST` from UTC is ambiguous" in refusal(dataset, tmp_path)
    dataset["time"].attrs["units"] = "hours since 2026-03-01 00:00 UTC"
    assert read(dataset, tmp_path)[0].u == tuple(U)
    dataset["time"].attrs["time_zone"] = "UTC+8"
    said = "`time_zone` is `UTC+8`, but CALM reads the times as UTC"
    assert said in read(dataset, tmp_path)[1]
