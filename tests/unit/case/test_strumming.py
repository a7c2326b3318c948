"""Strumming of a tow against the analysis of a bare cable by its towing angle."""

from math import radians

import pytest

import calm
from calm.physics.strumming import BourgetMarichal

BARE = """\
tow: {speed: 0.6 m/s, toward: 0 deg}
environment: {density: 1000 kg/m^3}
line: [{use: cable, length: 10 m}]
solver: {strumming: bourget-marichal}
components:
  cable: {kind: cable, diameter: 17 mm, weight: 3.0795 N/m, cn: 1.2, ct: 0}
"""


def test_the_angle_of_a_bare_cable_gives_the_drag_and_amplitude_that_it_was_towed_with(tmp_path):
    (tmp_path / "bare.yaml").write_text(BARE)
    towed = calm.load(tmp_path / "bare.yaml").solve()
    law, angle = BourgetMarichal(), radians(towed.body.angle)
    cn, amplitude = law.from_bare_cable(angle, 0.6, 0.017, 3.0795, 1000.0)
    # The cable is straight: the march adds rounding only. The paper prints a/D of 0.9 at 0.6 m/s.
    assert cn == pytest.approx(towed.strumming.cn_max, rel=1e-6)
    assert law.frequency(0.6, angle, 0.017) == pytest.approx(towed.strumming.frequency, rel=1e-6)
    assert amplitude == pytest.approx(0.9, abs=0.05)
