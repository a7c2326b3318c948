"""Each profile of a batch against the same profile solved by `calm run`."""

from dataclasses import replace

import numpy as np
import pytest

from calm.batch.profiles import solve_profiles
from calm.batch.statuses import STATUSES
from calm.case import Design
from tests.unit.batch.alike import assert_alike, assert_as_run, in_profile, shipped
from tests.unit.batch.drawn_profiles import CHARACTERS, drawn

LINES = [
    "braconnot-buoy", "cdms-1", "chain-and-rope-surface", "deep-current-meters", "fit-top-depth",
    "receiver-line", "s1000", "sediment-trap-undercurrent", "taut-nylon-surface",
    "thermistor-string", "tidal-adcp", "upward-adcp-300m", "veering-current",
]  # fmt: skip


@pytest.mark.parametrize("name", LINES)
def test_every_profile_equals_a_run_in_it(name: str) -> None:
    mooring = shipped(name)
    depth, u, v, w = drawn(7, 2 * CHARACTERS, mooring.water.depth)
    found = solve_profiles(mooring, u, v, depth, w)
    assert_as_run(found, mooring, depth, u, v, w)
    assert found.component_label == tuple(piece.label for piece in mooring.file.pieces)
    labels = [clamp.label for piece in mooring.file.pieces for clamp in piece.clamps]
    assert sorted(found.clamp_label) == sorted(labels)


def test_a_float_rides_or_is_pulled_under() -> None:
    mooring = shipped("taut-nylon-surface")
    depth, u, v, w = drawn(8, 20 * CHARACTERS, mooring.water.depth)
    found = solve_profiles(mooring, u, v, depth, w)
    riding = found.used_buoyancy < 1.0
    assert riding.any()
    assert (~riding & (found.top_depth > 0.0)).any()


def test_where_roots_are_near_each_other_it_is_that_of_the_run() -> None:
    # 476 m is a root, too, which the coarse cuts take for the highest
    mooring = shipped("upward-adcp-300m")
    depth, u, v, w = (a if a.ndim == 1 else a[46:47] for a in drawn(11, 47, mooring.water.depth))
    found = solve_profiles(mooring, u, v, depth, w)
    assert_alike(found, 0, in_profile(mooring, depth, u[0], v[0], w[0]).solve())


def test_an_anchor_that_would_lift_is_a_status() -> None:
    mooring = shipped("s1000")
    pieces = mooring.file.pieces
    light = pieces[-1].component.model_copy(update={"weight": 1000.0})
    file = replace(mooring.file, pieces=(*pieces[:-1], replace(pieces[-1], component=light)))
    depth, u, v, w = drawn(1, 1, mooring.water.depth)
    found = solve_profiles(Design(file), u, v, depth, w)
    assert STATUSES[found.status[0]] == "anchor-lifts"
    assert np.isnan(found.tension_top[0]).all()
