"""What `dataset.calm` tells of the parts of a line."""

import numpy as np
import pytest
import xarray as xr

import calm.report.xarray_accessor  # noqa: F401  every dataset has `.calm` from here on
from calm.batch.finished import open_result
from calm.errors import UsageError
from tests.unit.batch.made_result import COMPONENTS, make_result


@pytest.fixture
def dataset():
    hours = np.arange(3.0)
    return make_result(
        3,
        depth_top=100.0 + hours[:, None] + 10.0 * np.arange(5),
        knockdown=hours[:, None] * [5.0, 4.0, 3.0, 2.0, 0.0],
        tension_top=1000.0 + 0.0 * hours,
        tension_bottom=999.0 + hours,
        clamp_depth=hours[:, None] * [1.0, 2.0],
        clamp_tilt=hours[:, None] * [3.0, 4.0],
        clamp_tension=hours[:, None] * [5.0, 6.0],
        clamp_knockdown=hours[:, None] * [7.0, 8.0],
    )


def test_a_component_is_told_by_its_label(dataset):
    assert dataset.calm.knockdown("meter").values.tolist() == [0.0, 3.0, 6.0]
    assert dataset.calm.depth("meter").values.tolist() == [120.0, 121.0, 122.0]
    assert dataset.calm.tilt("meter").values.tolist() == [1.0, 1.0, 1.0]
    assert dataset.calm.tension("sphere").values.tolist() == [1000.0, 1000.0, 1001.0]


def test_a_clamp_is_told_by_its_label(dataset):
    assert dataset.calm.depth("sbe37 2").values.tolist() == [0.0, 2.0, 4.0]
    assert dataset.calm.tilt("sbe37 2").values.tolist() == [0.0, 4.0, 8.0]
    assert dataset.calm.tension("sbe37 2").values.tolist() == [0.0, 6.0, 12.0]
    assert dataset.calm.knockdown("sbe37 1").values.tolist() == [0.0, 7.0, 14.0]


def test_the_top_is_the_first_component(dataset):
    xr.testing.assert_identical(
        dataset.calm.knockdown("top").drop_attrs(), dataset.calm.knockdown("sphere").drop_attrs()
    )


@pytest.mark.parametrize("label", ["wire", "anchor"])
def test_the_top_is_the_first_component_even_where_another_is_called_so(label):
    labels = tuple("top" if one == label else one for one in COMPONENTS)
    dataset = make_result(1, labels=labels, knockdown=np.arange(5.0)[None] + 1.0)
    assert dataset.calm.knockdown("top").values.tolist() == [1.0]


def test_what_is_told_carries_its_time_and_name(dataset):
    told = dataset.calm.knockdown("meter")
    assert told.dims == ("time",)
    assert told.name == "knockdown"
    assert told.attrs["long_name"] == "knockdown of meter"
    assert (told.time.values == dataset.time.values).all()
    assert "component_label" not in told.coords


def test_an_unknown_label_gets_the_nearest(dataset):
    with pytest.raises(UsageError, match=r"label `metre`; did you mean `meter`"):
        dataset.calm.knockdown("metre")


def test_a_result_is_opened_without_loading_it(dataset, tmp_path):
    path = tmp_path / "result.nc"
    dataset.to_netcdf(path, engine="h5netcdf")
    with open_result(path) as opened:
        assert not opened["knockdown"].variable._in_memory
        assert opened.calm.knockdown("meter").values.tolist() == [0.0, 3.0, 6.0]


def test_the_shape_is_drawn_at_the_nearest_time(dataset):
    axes = dataset.calm.plot_shape(time="2001-01-01T01:10")
    assert "2001-01-01 01:00" in axes.get_title()
    assert axes.lines[1].get_ydata().tolist() == [101.0, 111.0, 121.0, 131.0, 141.0]


def test_no_shape_of_a_profile_without_equilibrium():
    dataset = make_result(3, status=[0, 1, 0])
    with pytest.raises(UsageError, match="2001-01-01 01:00 cannot be drawn"):
        dataset.calm.plot_shape(time="2001-01-01T01:00")
