"""Pode's functions: table of six digits, identity, direct integration."""

import numpy as np
import pytest

from calm.analytic.uniform import cable_functions, critical_weight_ratio
from tests.unit.analytic.integration import integrate

# critical angle, f, φ (degrees); τ, σ, ξ, η
TABLE = [
    (10, 0.00, 60, 1.017122, 0.588029, 0.158486, 0.559210),
    (10, 0.00, 30, 1.042705, 1.851566, 1.087628, 1.394744),
    (10, 0.00, 12, 1.090688, 7.217782, 6.201196, 2.961826),
    (10, 0.02, 60, 1.029050, 0.591480, 0.159706, 0.562411),
    (10, 0.02, 30, 1.081109, 1.885694, 1.112322, 1.417257),
    (10, 0.02, 12, 1.250175, 7.740277, 6.695377, 3.114723),
    (20, 0.00, 45, 1.125686, 1.156392, 0.499797, 1.009646),
    (20, 0.01, 45, 1.137970, 1.162815, 0.503310, 1.014916),
    (20, 0.02, 45, 1.150388, 1.169285, 0.506851, 1.020223),
    (20, 0.03, 45, 1.162942, 1.175803, 0.510421, 1.025567),
    (20, 0.02, 25, 1.357990, 3.603604, 2.566427, 2.296805),
    (30, 0.00, 45, 1.364054, 1.467920, 0.677138, 1.261120),
    (30, 0.02, 60, 1.205823, 0.701770, 0.199734, 0.664372),
    (30, 0.02, 45, 1.398297, 1.487219, 0.688118, 1.276704),
    (60, 0.00, 80, 1.357894, 0.240017, 0.023141, 0.238596),
    (60, 0.02, 70, 2.218338, 0.825827, 0.183732, 0.801214),
]


@pytest.mark.parametrize(("critical", "f", "degrees", "tau", "sigma", "xi", "eta"), TABLE)
def test_table(critical, f, degrees, tau, sigma, xi, eta) -> None:
    p = float(critical_weight_ratio(np.radians(critical)))
    found = cable_functions(np.radians(degrees), p, f)
    # half a unit of the sixth digit behind the point
    assert np.array(found) == pytest.approx([tau, sigma, xi, eta], abs=5.1e-7)


@pytest.mark.parametrize("f", [0.0, 0.01, 0.03, 0.3])
@pytest.mark.parametrize("critical", [1.0, 10.0, 45.0, 80.0])
def test_identity(critical, f) -> None:
    p = float(critical_weight_ratio(np.radians(critical)))
    angles = np.radians(critical + (90.0 - critical) * np.array([1e-6, 1e-3, 0.1, 0.5, 1.0]))
    tau, sigma, _, eta = cable_functions(angles, p, f)
    assert tau - 1.0 == pytest.approx(p * eta + f * sigma, rel=1e-11, abs=1e-14)


def test_above_90_degrees_friction_turns_round() -> None:
    tau, sigma, xi, eta = cable_functions(np.radians([100.0, 150.0, 180.0]), 0.4, 0.05)
    assert np.all(sigma < 0.0)
    assert np.all(eta < 0.0)
    assert np.all(xi > 0.0)
    assert tau - 1.0 == pytest.approx(0.4 * eta - 0.05 * sigma, rel=1e-11)


@pytest.mark.parametrize("f", [0.0, 0.02])
@pytest.mark.parametrize("degrees", [12.0, 45.0, 89.0, 130.0])
def test_direct_integration(degrees, f) -> None:
    """With R = 1 N/m and T₀ = 1 N the functions are tension, arc, distance and height."""
    p = float(critical_weight_ratio(np.radians(10.0)))
    tau, sigma, xi, eta = cable_functions(np.radians(degrees), p, f)
    (phi, pull, x, z), _ = integrate(float(sigma), 1.0, np.pi / 2.0, p, 1.0, f, friction_exponent=0)
    assert phi == pytest.approx(np.radians(degrees), abs=1e-10)
    assert (tau, xi, eta) == pytest.approx((pull, x, z), rel=1e-10)


def test_values_out_of_range() -> None:
    with pytest.raises(ValueError, match=r"greater than the critical angle, 51\.8273°"):
        cable_functions(np.radians(51.0), 1.0)
    with pytest.raises(ValueError, match="ratio of weight to normal drag"):
        cable_functions(1.0, -1.0)
    with pytest.raises(ValueError, match="must not be negative"):
        cable_functions(1.0, 0.1, -0.01)
