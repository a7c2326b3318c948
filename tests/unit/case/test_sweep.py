"""A tow solved at several speeds."""

import calm
from calm.case.tow import sweep
from calm.errors import NoEquilibrium
from calm.shipped import shipped_folder

SONAR = shipped_folder("lines") / "depressor-fit-depth.yaml"


def test_one_outcome_for_each_speed_in_order_taken_one_at_a_time():
    tow = calm.load(SONAR)
    speeds = iter([2.5, 0.5, tow.file.tow.speed])
    fast, slow, own = sweep(tow, speeds)
    assert fast.file.tow.speed == 2.5
    assert isinstance(slow, NoEquilibrium) and slow.status == "grounded"
    assert own.body == tow.solve().body
    # the fitted cable keeps its length
    assert fast.components.cut_length[0] == own.components.cut_length[0]
