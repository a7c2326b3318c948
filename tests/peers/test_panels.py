"""Heave and pitch of a float by panels on its hull, as Capytaine has them."""

import numpy as np
import pytest

from calm.waves.buoy import Buoy, panel_response
from tests.validation.sofs import holds_the_five_lines

pytestmark = pytest.mark.peers

DENSITY, GRAVITY = 1027.0, 9.81


def test_a_disc_and_haskinds_relation():
    """The disc of SOFS-5 as Capytaine 2.2 had it on a mesh of its own; Newman 1977, 6.18.

    What lifts and what is radiated are found from two problems, and bound by k ω |X|² / (2 ρ g²)
    in deep water: within 8 % on panels of 0.2 m (2 % on finer ones), which the heave feels
    near a resonance alone.
    """
    pytest.importorskip("capytaine", reason="needs the extra `peers`")
    outline = np.column_stack([np.full(10, 1.37), np.linspace(-0.875, 0.0, 10)])
    panels = panel_response(outline, DENSITY, GRAVITY)
    disc = Buoy(2045.45, 3155.9, 1.37, 0.875, 0.0, 0.0, panels=panels)
    omega = np.array([0.5, 1.0, 1.5, 2.0])
    resisting, lifting = disc.heave(omega, omega**2 / GRAVITY, DENSITY, GRAVITY)
    assert np.abs(lifting / resisting) == pytest.approx([0.982, 0.940, 0.871, 0.803], rel=0.02)
    haskind = omega**3 / GRAVITY * np.abs(lifting) ** 2 / (2.0 * DENSITY * GRAVITY**2)
    assert resisting.imag / omega == pytest.approx(haskind, rel=0.08)


def test_long_waves_lift_it_as_still_water_does():
    pytest.importorskip("capytaine", reason="needs the extra `peers`")
    heights = np.linspace(-0.8, 0.0, 10)
    outline = np.column_stack([np.linspace(0.3, 1.2, 10), heights])
    panels = panel_response(outline, DENSITY, GRAVITY)
    cone = Buoy(1000.0, 1400.0, 1.2, 0.8, 0.0, 0.0, panels=panels)
    omega = np.array([0.1])
    resisting, lifting = cone.heave(omega, omega**2 / GRAVITY, DENSITY, GRAVITY)
    assert lifting / resisting == pytest.approx(1.0, abs=0.02)


@pytest.mark.parametrize(
    ("radius", "draft", "centre", "gyration", "bail", "pull", "beside"),
    [
        (1.37, 0.875, -0.4, 1.0, -0.875, 0.0, 2.0),
        (1.37, 0.875, 0.0, 0.9, -0.875, 10_000.0, 1.4),
        (0.5, 5.0, -3.2, 2.0, -5.0, 0.0, 1.0),
        (0.5, 5.0, -2.7, 1.8, -5.0, 3000.0, 0.9),
    ],
)
def test_pitch_by_formulas_and_by_panels(radius, draft, centre, gyration, bail, pull, beside):
    """Within 10 %, a fifth away from the resonance `beside` [rad/s], of kR below 0.8.

    There the water that moves with a section is that of long waves, as the formulas have it; the
    added masses are within 10 %, and the ten panels up the side themselves within some per cent.
    """
    pytest.importorskip("capytaine", reason="needs the extra `peers`")
    outline = np.column_stack([np.full(46, radius), np.linspace(-draft, 0.0, 46)])
    panels = panel_response(outline[::5], DENSITY, GRAVITY)
    displaced = DENSITY * np.pi * radius**2 * draft
    given = {"profile": outline, "centre": centre, "gyration": gyration, "bail": bail}
    omega = np.array([0.3, 0.5, 0.7, 1.0, 1.25, 1.5, 2.0, 2.5])
    omega = omega[(np.abs(omega / beside - 1.0) > 0.2) & (omega**2 * radius < 0.8 * GRAVITY)]
    found = []
    for way in (None, panels):
        mass = displaced - pull / GRAVITY
        buoy = Buoy(mass, displaced, radius, draft, 0.0, 0.0, panels=way, **given)
        held, pushing = buoy.pitch(outline, omega, omega**2 / GRAVITY, DENSITY, GRAVITY)
        whole = held[[[0, 1], [1, 2]]].transpose(2, 0, 1)
        moved = np.linalg.solve(whole, pushing.T[:, :, None])[:, :, 0]
        found.append(np.abs(moved[:, 1]) / (omega**2 / GRAVITY))
    assert found[0] == pytest.approx(found[1], abs=0.1, rel=0.1)


def test_the_band_of_measured_tensions_holds_five_lines():
    pytest.importorskip("capytaine", reason="needs the extra `peers`")
    holds_the_five_lines("panels")
