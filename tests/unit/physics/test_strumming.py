"""Strumming against the printed figures, and the closed forms against quadrature."""

from math import atan2, cos, degrees, pi, radians, sin

import pytest
from scipy.integrate import quad
from scipy.optimize import brentq
from scipy.special import ellipe, ellipk

from calm.physics import strumming
from calm.physics.strumming import BourgetMarichal


def test_shedding_frequency():
    assert strumming.shedding_frequency(0.5, 0.01) == pytest.approx(10.0)
    assert strumming.shedding_frequency(0.5, 0.01, strouhal=0.21) == pytest.approx(10.5)


def test_reduced_damping():
    """S_G = 8π² St² m ζ/(ρ D²) of 0.2 kg/m, 8 mm, ζ 0.01, St 0.2, by hand."""
    got = strumming.reduced_damping(0.2, 0.008, 1025, 0.01)
    assert got == pytest.approx(8 * 9.8696044 * 0.04 * 0.2 * 0.01 / (1025 * 64e-6))


def test_amplitude_without_damping():
    """A double amplitude of 1.290 diameters for a rigid cylinder."""
    assert 2 * strumming.griffin_skop(0.0, mode=1.0) == pytest.approx(1.290, abs=5e-4)


def test_amplitudes_fall_with_damping():
    assert strumming.griffin_skop(1.0) == pytest.approx(0.645 * 1.155 / 1.43**3.35)


def test_a_light_line_in_water_strums_by_half_to_three_quarters_of_its_diameter():
    for mass, diameter in ((0.2, 0.008), (0.15, 0.014), (0.55, 0.0127)):
        assert 0.5 < strumming.line_amplitude(mass, diameter, 1025) < 0.75
    assert strumming.line_amplitude(0.0, 0.01, 1025) == strumming.griffin_skop(0.0)


@pytest.mark.parametrize(
    ("law", "printed"),
    [
        ("vandiver", (1.597, 1.833, 2.220, 2.307, 2.626)),
        # 3.940 at A/D = 1.4 is the bare formula: the factor is held from A/D = 1 on
        ("blevins", (1.630, 2.050, 2.890, 3.100, 3.100)),
        ("skop-griffin", (1.832, 2.160, 2.700, 2.820, 3.265)),
    ],
)
def test_amplification_to_the_printed_digits(law, printed):
    amplify = strumming.AMPLIFICATIONS[law]
    assert [amplify(a) for a in (0.3, 0.5, 0.9, 1.0, 1.4)] == pytest.approx(printed, abs=5.1e-4)
    assert amplify(0.0) == 1.0


@pytest.mark.parametrize("ratio", [0.0, 1e-6, 0.2345, 1.0, 1.45, 3.0, 30.0])
def test_drag_factor_against_its_integral(ratio):
    integral, _ = quad(lambda x: (1 + (ratio * cos(x)) ** 2) ** 1.5, 0, pi, epsrel=1e-12)
    assert strumming.drag_factor(ratio) == pytest.approx(integral / pi, rel=1e-11)


@pytest.mark.parametrize("ratio", [0.1, 1.0, 10.0, 1e3, 1e6])
def test_drag_factor_against_elliptic_integrals(ratio):
    m = ratio**2 / (1 + ratio**2)
    closed = (2 * (2 + ratio**2) * ellipe(m) - ellipk(m)) * (1 + ratio**2) ** 0.5 * 2 / (3 * pi)
    # at 1e6 the complement 1 - m, which scipy has to take from m, keeps four digits only
    assert strumming.drag_factor(ratio) == pytest.approx(closed, rel=1e-13)


def test_drag_factor_at_rest_is_one():
    assert strumming.drag_factor(0.0) == 1.0


# The example of Bourget & Marichal: 1.30 m/s, cable of 17 mm and 2383 kg/m³, sphere of 100 mm,
# 1.47 kg and Cx 0.90, water of 1000 kg/m³, g = 9.81; 16.280° at the ship.
WEIGHT = 9.81 * (2383 - 1000) * pi / 4 * 0.017**2
SHIP_ANGLE = radians(16.280)


def angle_at_the_sphere():
    weight = 9.81 * (1.47 - 1000 * pi / 6 * 0.1**3)
    drag = 0.5 * 1000 * 0.90 * pi / 4 * 0.1**2 * 1.30**2
    return atan2(weight, drag)


def test_bourget_marichal_amplitude_across_the_flow():
    """a/D = 0.5 at 90°, to the six digits of the coefficients."""
    assert BourgetMarichal().amplitude(pi / 2) == pytest.approx(0.5, abs=1e-5)


def test_bourget_marichal_frequency_of_the_example():
    assert BourgetMarichal().frequency(1.30, SHIP_ANGLE, 0.017) == pytest.approx(3.559, abs=5e-4)


def test_bourget_marichal_coefficient_of_the_example():
    """C* from 1.250 at the sphere to its ceiling at the ship."""
    model = BourgetMarichal()
    at_the_sphere = model.coefficient(angle_at_the_sphere(), SHIP_ANGLE)
    assert at_the_sphere == pytest.approx(1.250, abs=5e-4)
    assert model.coefficient(SHIP_ANGLE, SHIP_ANGLE) == 3.0
    assert model.coefficient(0.0, SHIP_ANGLE) == 3.0


def test_bourget_marichal_coefficient_is_that_of_its_amplitude_and_frequency():
    """λ = 2π a F/(V₀ sin φ) with the amplitude in metres: speed and diameter cancel."""
    model, angle, speed, diameter = BourgetMarichal(), radians(50), 1.30, 0.017
    vibration = 2 * pi * model.amplitude(angle) * diameter
    vibration *= model.frequency(speed, SHIP_ANGLE, diameter)
    factor = strumming.drag_factor(vibration / (speed * sin(angle)))
    assert model.coefficient(angle, SHIP_ANGLE) == pytest.approx(1.2 * factor, rel=1e-12)


def towing_angle(model, speed):
    """The angle at which the drag across a bare cable holds its weight."""
    return brentq(
        lambda phi: (
            WEIGHT * cos(phi) - 500 * 0.017 * model.coefficient(phi, phi) * (speed * sin(phi)) ** 2
        ),
        0.02,
        1.5,
    )


def test_bourget_marichal_bare_cable_gives_back_the_model():
    model = BourgetMarichal()
    for speed in (0.5, 0.6, 0.8, 1.0):
        angle = towing_angle(model, speed)
        coefficient, amplitude = model.from_bare_cable(angle, speed, 0.017, WEIGHT, 1000)
        assert coefficient == pytest.approx(model.coefficient(angle, angle), rel=1e-9)
        assert amplitude == pytest.approx(model.amplitude(angle), rel=1e-9)


def test_bourget_marichal_bare_cable_of_the_paper():
    """a/D of 0.9 to 1.4 between 0.6 and 2.0 m/s, as the paper prints for its 17 mm cable."""
    model = BourgetMarichal()
    assert model.amplitude(towing_angle(model, 0.6)) == pytest.approx(0.9, abs=0.05)
    assert model.amplitude(towing_angle(model, 2.0)) == pytest.approx(1.4, abs=0.05)


def test_bourget_marichal_bare_cable_that_does_not_strum():
    model = BourgetMarichal()
    angle, speed = radians(40), 1.0
    weight = 500 * 0.017 * 1.1 * (speed * sin(angle)) ** 2 / cos(angle)
    coefficient, amplitude = model.from_bare_cable(angle, speed, 0.017, weight, 1000)
    assert coefficient == pytest.approx(1.1)
    assert amplitude == 0.0


def test_bourget_marichal_takes_other_coefficients():
    model = BourgetMarichal(a1=0.5, b1=0.0, c1=0.0, rest=1.0, ceiling=10.0)
    assert model.amplitude(radians(30)) == 0.5
    assert model.coefficient(radians(30), radians(30)) == pytest.approx(
        strumming.drag_factor(pi * 0.166)
    )
    assert degrees(BourgetMarichal.LEAST_ANGLE) == pytest.approx(15)
