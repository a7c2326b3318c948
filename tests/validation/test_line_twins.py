"""Twins whose line or currents are not those of the file: what is wrong is named with its size.

Made as those of `test_motion_twins`, whose line and errors they have besides.
"""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

import calm
from calm.motion.diagnosis import diagnosed
from calm.motion.line_response import Forward
from calm.motion.remarks import CURRENTS, LINE
from calm.motion.study import prepare
from tests.validation import test_motion_twins as twins

pytestmark = pytest.mark.thorough
TIMES, PARTS = twins.TIMES, 8


@pytest.fixture(scope="module")
def mooring():
    return calm.load(twins.FIELD / "mooring.yaml")


def growing(factor):
    """What solves a line whose drag grows to so much of itself by the end, in eight steps."""

    class Growing:
        def __init__(self, mooring, factors):
            steps = np.geomspace(1.0, factor, PARTS)
            names = "cable_drag", "rigid_drag"
            lines = [{**factors, **{n: factors[n] * step for n in names}} for step in steps]
            self._lines = [Forward(mooring, line) for line in lines]
            self.still = self._lines[0].still

        def solve(self, level, u, v):
            parts = np.array_split(np.arange(len(level)), PARTS)
            found = [
                line.solve(level[at], u[at], v[at])
                for line, at in zip(self._lines, parts, strict=True)
            ]
            names = "clamp_depth", "depth_top"
            both = {n: np.concatenate([getattr(one, n) for one in found]) for n in names}
            return SimpleNamespace(**both)

    return Growing


def other_line(**factors):
    """What solves a line with other factors than those that a twin is made with."""
    names = {*twins.NAMES, *factors}
    return lambda mooring, made: Forward(
        mooring, {name: made.get(name, 1.0) * factors.get(name, 1.0) for name in names}
    )


def misread(factor):
    return lambda measured: replace(measured, u=factor * measured.u, v=factor * measured.v)


def found(mooring, monkeypatch, forward=Forward, change=lambda measured: measured, seed=1):
    monkeypatch.setattr(twins, "Forward", forward)
    measured = change(twins.twin(mooring, seed, twins.THREE)[0])
    monkeypatch.undo()
    return diagnosed(prepare(mooring, measured, twins.NAMES, ()))


def test_of_a_line_that_is_as_the_file_says_nothing_is_said(mooring, monkeypatch):
    assert all(not found(mooring, monkeypatch, seed=seed) for seed in (0, 1, 2))


def test_currents_that_read_low_are_named_before_missing_floats(mooring, monkeypatch):
    """Knockdown is proportional to drag and the square of the current, so these two are one."""
    (low,) = found(mooring, monkeypatch, change=misread(0.7))
    assert (low.label, low.kind) in {(CURRENTS, "currents"), (LINE, "drag")}
    # the depths are linear in its size, which is so too far: 0.58
    assert low.value < 0.7 or low.kind == "drag"


def test_missing_floats_are_the_likeliest_where_they_are_missing(mooring, monkeypatch):
    (less,) = found(mooring, monkeypatch, other_line(buoyancy=0.65))
    assert (less.label, less.kind) == (LINE, "buoyancy")
    assert less.value < 0.65  # linear in its size, so too far


def test_cables_that_are_shorter_are_named(mooring, monkeypatch):
    (short,) = found(mooring, monkeypatch, other_line(length=0.99), seed=2)
    assert (short.label, short.kind) == (LINE, "length")
    assert short.low < 0.99 < short.high


def test_a_drag_that_grows_is_told_from_all_else(mooring, monkeypatch):
    (grown,) = found(mooring, monkeypatch, growing(2.0))
    assert (grown.label, grown.kind) == (LINE, "fouling") and grown.certain
    assert 1.5 < grown.value < 3.0  # linear in its size
