from itertools import pairwise

import pytest

from calm.drawing.line_picture import named_parts, names, spread


def texts(result, near=1.0):
    return [text for text, _ in names(named_parts(result), near)]


def test_only_what_matters_is_named(result):
    assert texts(result) == [
        "top float",
        "sbe37 1",
        "adcp",
        "current meter",
        "glass 1–2",
        "wheels",
    ]


def test_numbered_parts_far_from_each_other_keep_their_names(result):
    assert texts(result, near=0.1)[4:6] == ["glass 1", "glass 2"]


def test_labels_of_ones_own_are_never_merged(make_result):
    result = make_result()
    result.components[4].label = "upper ball"
    result.components[5].label = "lower ball"
    assert texts(result)[4:6] == ["upper ball", "lower ball"]


def test_clamped_floats_are_floats(make_result):
    result = make_result()
    clamp = result.design.file.pieces[2].clamps[0]
    clamp.component = type(clamp)(role="float")
    assert named_parts(result)[1].role == "float"


def test_spread_keeps_order_and_distance():
    wanted = [0.0, 0.01, 0.01, 0.5, 0.98, 0.99, 1.0]
    placed = spread(wanted, 0.05, 0.0, 1.0)
    # 1e-12: sums of gaps round in the last digits
    assert all(after - before >= 0.05 - 1e-12 for before, after in pairwise(placed))
    assert placed[3] == 0.5
    assert min(placed) >= 0.0
    assert max(placed) <= 1.0 + 1e-12


def test_spread_moves_a_cluster_evenly():
    assert spread([0.5, 0.5, 0.5], 0.1, 0.0, 1.0) == pytest.approx([0.4, 0.5, 0.6], abs=1e-12)


def test_spread_leaves_what_has_room():
    assert spread([0.1, 0.5, 0.9], 0.1, 0.0, 1.0) == pytest.approx([0.1, 0.5, 0.9], abs=1e-12)


def test_spread_of_too_many_passes_the_end():
    placed = spread([0.5] * 5, 0.5, 0.0, 1.0)
    assert placed == pytest.approx([0.0, 0.5, 1.0, 1.5, 2.0], abs=1e-12)


def test_spread_of_nothing_is_nothing():
    assert spread([], 0.1, 0.0, 1.0) == []
