"""Many profiles: order, company and workers change nothing; gaps, shapes, statuses."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pandas
import pytest
import xarray

import calm
from calm.batch import profiles
from calm.batch.profiles import Profiles, solve_profiles
from calm.batch.statuses import STATUSES
from calm.case import Design, load
from calm.errors import UsageError
from calm.shipped import shipped_folder
from tests.unit.batch.drawn_profiles import CHARACTERS, drawn

COUNT = 25 * CHARACTERS


@pytest.fixture(scope="module", params=["veering-current", "taut-nylon-surface"])
def mooring(request: pytest.FixtureRequest) -> Design:
    found = load(shipped_folder("lines") / f"{request.param}.yaml")
    return found


@pytest.fixture(scope="module")
def subsurface() -> Design:
    found = load(shipped_folder("lines") / "thermistor-string.yaml")
    return found


def assert_same(one: Profiles, other: Profiles, order: np.ndarray | slice = slice(None)) -> None:
    """Bit for bit."""
    for name in Profiles.names():
        a, b = getattr(one, name), getattr(other, name)
        if isinstance(a, np.ndarray):
            assert a[order].tobytes() == b.tobytes(), name


@pytest.mark.thorough
def test_neither_order_nor_company_nor_workers_change_a_bit(
    mooring: Design, monkeypatch: pytest.MonkeyPatch
) -> None:
    depth, u, v, w = drawn(3, COUNT, mooring.water.depth)
    whole = solve_profiles(mooring, u, v, depth, w, workers=1)
    order = np.random.default_rng(4).permutation(COUNT)
    assert_same(whole, solve_profiles(mooring, u[order], v[order], depth, w[order]), order)
    part = slice(17, 30)
    assert_same(whole, solve_profiles(mooring, u[part], v[part], depth, w[part]), part)
    monkeypatch.setattr(profiles, "BLOCK", 37)
    assert_same(whole, solve_profiles(mooring, u, v, depth, w, workers=2))


def test_a_level_without_a_value_is_left_out(subsurface: Design) -> None:
    depth, u, v, _ = drawn(5, 12, subsurface.water.depth)
    gaps = [3, 4, 17, len(depth) - 1]
    kept = np.delete(np.arange(len(depth)), gaps)
    without = solve_profiles(subsurface, u[:, kept], v[:, kept], depth[kept])
    holed = u.copy()
    holed[:, gaps] = np.nan
    assert_same(without, solve_profiles(subsurface, holed, v, depth))
    airy = np.where(np.isin(np.arange(len(depth)), gaps), -1.0 - np.arange(len(depth)), depth)
    assert_same(without, solve_profiles(subsurface, u, v, airy))


def test_profiles_may_have_as_many_levels_as_they_like(subsurface: Design) -> None:
    depth, u, v, w = drawn(5, 64, subsurface.water.depth)
    holed = u.copy()
    holed[::2, 1:-1] = np.nan
    found = solve_profiles(subsurface, holed, v, depth, w)
    few = solve_profiles(subsurface, holed[::2], v[::2], depth, w[::2])
    assert_same(found, few, slice(None, None, 2))
    assert_same(
        found, solve_profiles(subsurface, u[1::2], v[1::2], depth, w[1::2]), slice(1, None, 2)
    )


def test_levels_may_vary_and_come_in_any_order(subsurface: Design) -> None:
    depth, u, v, w = drawn(6, 12, subsurface.water.depth)
    each = np.tile(depth, (12, 1))
    each[6:], flipped = each[6:, ::-1], [np.vstack([a[:6], a[6:, ::-1]]) for a in (u, v, w)]
    assert_same(
        solve_profiles(subsurface, u, v, depth, w),
        solve_profiles(subsurface, flipped[0], flipped[1], each, flipped[2]),
    )


@pytest.mark.parametrize("friction", ["berteaux", "hoerner"])
def test_profiles_that_cannot_be_solved_have_a_status(subsurface: Design, friction: str) -> None:
    solver = subsurface.file.solver.model_copy(update={"friction": friction})
    subsurface = Design(replace(subsurface.file, solver=solver))
    depth, u, v, _ = drawn(7, 3, subsurface.water.depth)
    each = np.tile(depth, (3, 1))
    u[0] = np.nan
    each[1, 4] = each[1, 5]
    found = solve_profiles(subsurface, u, v, each)
    assert [STATUSES[s] for s in found.status] == ["no-current", "levels-coincide", "converged"]
    assert np.isnan(found.depth_top[:2]).all()
    assert np.isfinite(found.depth_top[2]).all()


def test_still_water_leaves_the_line_upright(subsurface: Design) -> None:
    depth, u, v, _ = drawn(8, 1, subsurface.water.depth)
    found = solve_profiles(subsurface, 0.0 * u, 0.0 * v, depth)
    assert STATUSES[found.status[0]] == "converged"
    np.testing.assert_allclose(found.knockdown, 0.0, atol=1e-6 * subsurface.water.depth)


def test_single_precision_does(subsurface: Design) -> None:
    depth, u, v, _ = drawn(9, 6, subsurface.water.depth)
    u, v = u.astype(np.float32), v.astype(np.float32)
    assert_same(
        solve_profiles(subsurface, u, v, depth),
        solve_profiles(subsurface, u.astype(float), v.astype(float), depth),
    )


def test_profiles_come_in_any_dimensions(subsurface: Design) -> None:
    depth, u, v, w = drawn(10, 6, subsurface.water.depth)
    flat = solve_profiles(subsurface, u, v, depth, w)
    grid = solve_profiles(subsurface, *(a.reshape(2, 3, -1) for a in (u, v)), depth,
                          w.reshape(2, 3, -1))  # fmt: skip
    assert grid.tilt.shape == (2, 3, *flat.tilt.shape[1:])
    assert grid.status.shape == grid.top_depth.shape == (2, 3)
    assert grid.tilt.tobytes() == flat.tilt.tobytes()
    one = solve_profiles(subsurface, u[4], v[4], depth, w[4])
    assert one.knockdown.tobytes() == flat.knockdown[4].tobytes()
    assert one.status.shape == ()


def test_what_is_masked_is_a_gap(subsurface: Design) -> None:
    depth, u, v, _ = drawn(12, 3, subsurface.water.depth)
    gaps = np.zeros(u.shape, bool)
    gaps[:, 2] = True
    filled = np.where(gaps, 1e20, u)
    assert_same(
        solve_profiles(subsurface, np.where(gaps, np.nan, u), v, depth),
        solve_profiles(subsurface, np.ma.masked_array(filled, gaps), v, depth),
    )


def test_what_is_no_mooring_and_no_current_is_refused(subsurface: Design) -> None:
    depth, u, v, _ = drawn(13, 1, subsurface.water.depth)
    tow = load(shipped_folder("lines") / "helicopter-bird.yaml")
    with pytest.raises(UsageError, match="is a tow; only a mooring can be used here"):
        solve_profiles(tow, u, v, depth)
    for wrong in (u.astype(complex), u > 0.0, u.astype(str)):
        with pytest.raises(TypeError, match="the current must be numeric, not "):
            solve_profiles(subsurface, wrong, v, depth)
    for workers in (0, -1):
        with pytest.raises(ValueError, match="must be at least 1"):
            solve_profiles(subsurface, u, v, depth, workers=workers)


def test_arrays_of_any_layout_are_taken(subsurface: Design) -> None:
    depth, u, v, w = drawn(11, 4, subsurface.water.depth)
    found = solve_profiles(subsurface, u, v, depth, w)
    u.setflags(write=False)
    other = solve_profiles(subsurface, np.asfortranarray(u), np.repeat(v, 2, axis=0)[::2], depth, w)
    assert_same(found, other)


@pytest.mark.parametrize(
    ("shapes", "message"),
    [
        (((3, 5), (3, 4), (5,)), "same shape, profiles by levels; their shapes are .3, 5., .3, 4."),
        (((), (), (5,)), "must have the same shape, profiles by levels"),
        (((3, 5), (3, 5), (4,)), "depth must have the shape"),
        (((3, 5), (3, 5), (2, 5)), "depth must have the shape"),
    ],
)
def test_shapes_that_do_not_fit_are_refused(
    subsurface: Design, shapes: tuple[tuple[int, ...], ...], message: str
) -> None:
    u, v, depth = (np.ones(shape) for shape in shapes)
    with pytest.raises(ValueError, match=message):
        solve_profiles(subsurface, u, v, depth)


def test_a_dataset_has_labels_and_units(subsurface: Design) -> None:
    depth, u, v, _ = drawn(5, 6, subsurface.water.depth)
    found = solve_profiles(subsurface, u, v, depth)
    dataset = found.to_xarray()
    top = dataset.depth_top.sel(component=found.component_label[0])
    assert np.array_equal(top, found.depth_top[:, 0], equal_nan=True)
    assert (top.dims, top.attrs["units"]) == (("profile",), "m")
    assert dataset.clamp_tension.dims == ("profile", "clamp")
    assert dataset.tension_top.attrs["units"] == "N"
    assert dataset.status.attrs["flag_meanings"].split()[0] == STATUSES[0]
    frame = found.to_pandas()
    assert len(frame) == found.status.size
    assert frame["status", 0].tolist() == found.status.tolist()
    label = found.component_label[0]
    assert np.array_equal(frame["depth_top", label], found.depth_top[:, 0], equal_nan=True)
    square = solve_profiles(subsurface, u.reshape(2, 3, -1), v.reshape(2, 3, -1), depth).to_xarray()
    assert square.tilt.dims == ("profile_0", "profile_1", "component")
    one = calm.load(shipped_folder("lines") / "s1000.yaml").solve()
    assert float(one.to_xarray().top_depth) == one.top.depth


def test_a_record_is_solved_from_its_file_a_dataset_or_a_table(
    subsurface: Design, tmp_path: Path
) -> None:
    time = np.arange("2026-03-01", "2026-03-03", 6, dtype="datetime64[h]").astype("datetime64[ns]")
    depth = np.array([0.0, 50.0, 150.0])
    u, v = np.random.default_rng(8).uniform(-0.3, 0.3, (2, len(time), len(depth))).round(3)
    named = {"u": ("eastward_sea_water_velocity", u), "v": ("northward_sea_water_velocity", v)}
    record = xarray.Dataset(
        {
            name: (("time", "depth"), values, {"standard_name": meaning, "units": "m s-1"})
            for name, (meaning, values) in named.items()
        },
        {"time": time, "depth": ("depth", depth, {"units": "m", "positive": "down"})},
    )
    columns = {"depth[m]": np.tile(depth, len(time)), "u[m/s]": u.ravel(), "v[m/s]": v.ravel()}
    table = pandas.DataFrame(columns, index=pandas.DatetimeIndex(np.repeat(time, len(depth))))
    record.to_netcdf(tmp_path / "r.nc", engine="h5netcdf")
    arrays = solve_profiles(subsurface, u, v, depth)
    assert not arrays.status.any()
    for given in (tmp_path / "r.nc", str(tmp_path / "r.nc"), record, table):
        assert_same(arrays, solve_profiles(subsurface, given))


def test_a_record_and_arrays_are_not_mixed(subsurface: Design) -> None:
    with pytest.raises(TypeError, match="v or depth is missing"):
        solve_profiles(subsurface, np.zeros((2, 3)))
    with pytest.raises(TypeError, match="contains the whole current"):
        solve_profiles(subsurface, "record.nc", np.zeros((2, 3)), np.zeros(3))
