"""A tow solved at several speeds, or with its coefficients changed."""

import pytest

import calm
from calm.case.tow import sensitivity, sweep
from calm.errors import NoEquilibrium, UsageError
from calm.shipped import shipped_folder

SONAR = shipped_folder("lines") / "depressor-fit-depth.yaml"
SPHERE = shipped_folder("lines") / "bourget-marichal-sphere.yaml"


def test_one_outcome_for_each_speed_in_order_taken_one_at_a_time():
    tow = calm.load(SONAR)
    speeds = iter([2.5, 0.5, tow.file.tow.speed])
    fast, slow, own = sweep(tow, speeds)
    assert fast.file.tow.speed == 2.5
    assert isinstance(slow, NoEquilibrium) and slow.status == "grounded"
    assert own.body == tow.solve().body
    # the fitted cable keeps its length
    assert fast.components.cut_length[0] == own.components.cut_length[0]


def test_sensitivity_begins_with_the_tow_as_it_is():
    tow = calm.load(SPHERE)
    unchanged, *others = sensitivity(tow)
    assert unchanged.coefficient == "" and unchanged.outcome.body == tow.solve().body
    assert [(each.coefficient, each.change) for each in others[:2]] == [("a1", -0.1), ("a1", 0.1)]
    # The published example: 16.28° and 3.56 Hz; more amplitude, more drag, a flatter cable.
    assert unchanged.outcome.tow_point.angle == pytest.approx(16.28, abs=0.005)
    assert others[0].outcome.tow_point.angle > 16.28 > others[1].outcome.tow_point.angle


def test_only_bourget_marichal_has_coefficients():
    with pytest.raises(UsageError, match="no coefficients to change"):
        sensitivity(calm.load(SONAR))
