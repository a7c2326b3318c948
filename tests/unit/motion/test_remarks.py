"""What is named of currents and of a datum, and what is not."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from calm.motion.common_unknowns import Common
from calm.motion.remarks import (
    LINE,
    Fault,
    alone_remarks,
    current_remarks,
    datum_remarks,
    false_current_times,
    no_drag,
)
from calm.motion.suspects import meter_remarks

TIMES = 100
TIME = np.datetime64("2026-03-01", "ns") + np.arange(TIMES) * np.timedelta64(1, "h")


def common(offset):
    count = len(offset)
    return Common({}, 0.0, np.array(offset), np.eye(count + 1))


def test_currents_that_look_false_are_listed_with_their_times():
    doubt = np.zeros((TIMES, 2))
    doubt[[7, 9], 1] = 0.6, 0.51
    doubt[8] = 0.5
    false = false_current_times(("a", "b"), TIME, doubt)
    assert list(false) == ["b"] and false["b"].tolist() == TIME[[7, 9]].tolist()
    (said,) = current_remarks(false, TIMES)
    assert "current at b" in said and "2 of 100 times, first at 2026-03-01T07:00" in said


@pytest.mark.parametrize(
    ("datum", "named"),
    [(9.0, True), (7.6, True), (-7.6, True), (7.4, False)],  # 2.5 times a hundredth of the depth
)
def test_all_sensors_off_alike_are_named(datum, named):
    found = datum_remarks(replace(common((0.0, 0.0)), datum=datum), 300.0)
    assert len(found) == named
    for one in found:
        assert one.startswith(
            f"all sensors have a common offset of {datum:+.1f} m; the water depth"
        )


@pytest.mark.parametrize(
    ("change", "said"),
    [
        (lambda flow: flow, None),
        (
            lambda flow: flow * np.exp(-1j * np.radians(15.0)),
            "rotated 16° (± 4°) clockwise; its compass",
        ),
        (lambda flow: flow * np.exp(1j * np.radians(15.0)), "rotated 14° (± 4°) anticlockwise"),
        (lambda flow: flow * np.exp(1j * np.radians(8.0)), None),
        (lambda flow: -flow, "it gives the direction from which the current comes"),
        (lambda flow: 1j * flow.conj(), "its east and north components are exchanged"),
        (
            lambda flow: 0.1 * flow,
            "its speeds are 0.11 times those of the other two; its unit is wrong",
        ),
    ],
)
def test_a_meter_that_the_two_nearest_do_not_agree_with_is_named(change, said):
    # a quarter of white noise: r² = 1 / (1 + 0.25), and of 100 times that are independent
    # 1.96 sqrt(0.25 / 2 / 100) = 4.0°
    random = np.random.default_rng(1)
    parts = random.standard_normal((TIMES, 8)).view(complex)
    flow = parts[:, :1] + np.array([0.0, 0.5, 0.0]) * parts[:, 1:]
    flow[:, 1] = change(flow[:, 1])
    flags = np.ones(flow.shape, np.int8)
    measured = SimpleNamespace(u=flow.real, v=flow.imag, flag=flags)
    found = meter_remarks(measured, ("a", "b", "c"))
    assert len(found) == (said is not None)
    for one in found:
        assert one.startswith("current at b, compared with a and c: ") and said in one
    measured.flag = 4 * flags
    assert not meter_remarks(measured, ("a", "b", "c"))


def test_an_absurd_factor_is_not_called_drag():
    assert no_drag("rigid_drag", 2.61) and no_drag("rigid_drag", 0.5)
    assert not no_drag("cable_drag", 1.3)  # 1.7 deviations of 15 %
    assert not no_drag("length", 2.0)


def test_a_fault_of_the_line_has_the_size_of_a_logarithm():
    never = np.datetime64("NaT", "ns")
    one = Fault(LINE, "length", 1.0, 1.0, 1.0, 0.0, never, never).sized(-0.02, 0.005)
    assert one.size == pytest.approx(-0.02) and one.value == pytest.approx(np.exp(-0.02))
    said = one.sentence()
    assert said == "the line: its cables are 2.0 % (1.0 to 2.9) shorter than in the file"
    gain = Fault("a", "gain", 1.0, 1.0, 1.0, 0.0, never, never).sized(0.03, 0.001)
    assert (gain.value, gain.size) == (pytest.approx(1.03), pytest.approx(0.03))


def test_a_line_that_misses_pressures_alone_is_named():
    known = replace(common((0.0,)), factors={"length": 1.008}, worst=0.07)
    assert alone_remarks(known) == []
    (said,) = alone_remarks(replace(known, factors={"length": 0.98}))
    assert said.startswith(
        "the line: its computed depths disagree with the pressures; a length, a float or the water "
        "depth is wrong. In the best fit, the cables are 2.0 % shorter than in the file"
    )
    assert len(alone_remarks(replace(known, worst=0.3))) == 1
