"""Tables kept by column: their rows, and what of them goes to another process."""

import pickle
from dataclasses import fields

import numpy as np
import pytest

from calm.case.result_tables import Clamps
from calm.files import Clamp, Place


@pytest.fixture
def clamps():
    figures = {
        name: np.array([1.5, np.nan])
        for name in ("depth", "planned_depth", "x", "y", "tension", "tilt", "knockdown")
    }
    part = [
        Clamp("a", "A", None, 1.0, Place(0, clamp=0)),
        Clamp("b", "B", None, 2.0, Place(2, clamp=0)),
    ]
    return Clamps(part=part, index=np.array([0, 2]), use=["a", "b"], label=["A", "B"], **figures)


def test_rows_are_plain_numbers_and_the_same_each_time(clamps):
    first, second = clamps
    assert (first.index, first.label, first.depth) == (0, "A", 1.5)
    assert type(first.depth) is float and type(first.index) is int
    assert np.isnan(second.depth) and [*clamps] == [first, *[*clamps][1:]]
    assert clamps[0] == first


def test_a_table_that_was_read_by_rows_is_pickled_as_its_columns(clamps):
    before = pickle.dumps(clamps)
    assert len([*clamps]) == 2
    assert pickle.dumps(clamps) == before
    assert pickle.loads(before).label == ["A", "B"]


def test_a_table_has_the_columns_of_its_rows_and_no_others(clamps):
    assert Clamps.names() == [field.name for field in fields(Clamps.record)]
    assert [*vars(clamps)] == Clamps.names()
    with pytest.raises(TypeError, match="Clamps has only the columns part, index, use, label"):
        clamps.with_columns(drag=np.zeros(2))


def test_tables_are_joined_and_get_rows(clamps):
    both = Clamps.joined([clamps, clamps.with_columns(label=["C", "D"])])
    assert both.label == ["A", "B", "C", "D"] and both.depth[2] == 1.5
    longer = clamps.with_row(clamps[0])
    assert longer.label == ["A", "B", "A"] and longer.depth.tolist()[2] == 1.5
    assert longer.index.dtype == clamps.index.dtype


def test_a_reader_gets_no_model_of_the_file(clamps):
    assert all("part" not in row for row in clamps.to_dicts())
    assert clamps.to_dicts()[1]["depth"] is None
    assert "part" not in clamps.to_pandas()
