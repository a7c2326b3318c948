"""Sea water against printed tables and against formulas it does not use."""

import gsw
import numpy as np
import pytest

from calm.physics import seawater
from calm.physics.seawater import REFERENCE_VISCOSITY

TEMPERATURES = (0, 5, 10, 15, 20, 25, 30)


@pytest.mark.parametrize(
    ("salinity", "printed"),
    [
        (0, (1.7914, 1.5181, 1.3060, 1.1377, 1.0018, 0.8902, 0.7973)),
        (30, (1.8871, 1.6031, 1.3824, 1.2069, 1.0649, 0.9482, 0.8509)),
        (35, (1.9056, 1.6193, 1.3968, 1.2199, 1.0766, 0.9588, 0.8606)),
        (40, (1.9247, 1.6361, 1.4116, 1.2332, 1.0887, 0.9698, 0.8707)),
    ],
)
def test_dynamic_viscosity_to_the_printed_digits(salinity, printed):
    """mPa s. Half a unit of the last digit and a little: 0.890149 at (25, 0) is printed 0.8902."""
    got = [1e3 * seawater.dynamic_viscosity(t, salinity) for t in TEMPERATURES]
    assert got == pytest.approx(printed, abs=5.5e-5)


@pytest.mark.parametrize(
    ("salinity", "printed"),
    [
        (0, (1.79, 1.52, 1.31, 1.14, 1.01, 0.89, 0.80)),
        (10, (1.82, 1.55, 1.34, 1.17, 1.03, 0.91, 0.82)),
        (20, (1.85, 1.58, 1.36, 1.19, 1.05, 0.93, 0.84)),
        (30, (1.88, 1.60, 1.38, 1.21, 1.07, 0.95, 0.86)),
        (35, (1.89, 1.61, 1.39, 1.22, 1.09, 0.96, 0.87)),
    ],
)
def test_dynamic_viscosity_agrees_with_the_table_of_the_calm_paper(salinity, printed):
    """The table is of other measurements and of three digits: 1.5 %, the formula's own accuracy."""
    got = [1e3 * seawater.dynamic_viscosity(t, salinity) for t in TEMPERATURES]
    assert got == pytest.approx(printed, rel=0.015)


def test_dynamic_viscosity_of_pure_water_and_of_dorsey():
    assert seawater.dynamic_viscosity(10, 30) == pytest.approx(1.38238e-3, abs=5e-9)
    assert seawater.dynamic_viscosity(20, 0) == pytest.approx(1.0016e-3, rel=2e-4)
    # the regression of Dorsey's table (1940), another set of measurements, 0.1 % apart
    assert seawater.dynamic_viscosity(10, 30) == pytest.approx(1.383779e-3, rel=1.1e-3)


def test_kinematic_viscosity_to_the_printed_digits():
    """1e-6 m²/s at practical salinity 35 and the surface; half a unit of the last digit."""
    printed = (1.8535, 1.5757, 1.3601, 1.1890, 1.0506, 0.9370, 0.8423)
    density = seawater.density(TEMPERATURES, 35, 0)
    got = [
        1e6 * seawater.kinematic_viscosity(t, 35, float(rho))
        for t, rho in zip(TEMPERATURES, density, strict=True)
    ]
    assert got == pytest.approx(printed, abs=5.5e-5)
    assert got[2] == pytest.approx(1e6 * REFERENCE_VISCOSITY, abs=5e-4)


@pytest.mark.parametrize(
    ("latitude", "printed"),
    [(0, 9.780327), (30, 9.793249), (45, 9.806200), (60, 9.819179), (90, 9.832186)],
)
def test_gravity_by_latitude(latitude, printed):
    assert seawater.gravity(latitude) == pytest.approx(printed, abs=5.1e-7)
    assert seawater.gravity(-latitude) == seawater.gravity(latitude)
    assert seawater.gravity(latitude) == pytest.approx(gsw.grav(latitude, 0), abs=1e-6)


@pytest.mark.parametrize(
    ("salinity", "temperature", "depth", "printed"),
    [
        (35.165, 10, 0, 1026.952),
        (35.2, 10, 500, 1029.237),
        (35.0, 5, 1000, 1032.160),
        (34.9, 1.5, 4000, 1046.132),
        (34.9, 1.5, 5000, 1050.502),
        (34.9, 1.5, 6000, 1054.787),
    ],
)
def test_density_from_absolute_salinity_to_the_printed_digits(
    salinity, temperature, depth, printed
):
    got = seawater.absolute_density(salinity, temperature, depth, latitude=30)
    assert got == pytest.approx(printed, abs=5.1e-4)


def test_density_from_what_a_probe_measures():
    """Against the Gibbs function, which takes the temperature in situ.

    The 75-term expression fits it to the uncertainty of the measurements: a few g/m³ at depth.
    """
    depth = np.array([0.0, 1000.0, 5000.0])
    temperature, salinity = np.array([20.0, 5.0, 1.5]), np.array([35.5, 35.0, 34.8])
    pressure = gsw.p_from_z(-depth, 30)
    absolute = gsw.SA_from_SP(salinity, pressure, -40, 30)
    got = seawater.density(temperature, salinity, depth, 30, -40)
    assert got == pytest.approx(gsw.rho_t_exact(absolute, temperature, pressure), abs=5e-3)


def test_density_agrees_with_the_equation_of_state_of_1980():
    """Its check value at salinity 35, 5 °C, surface; the two differ by some 0.01 kg/m³."""
    assert seawater.density(5, 35, 0) == pytest.approx(1027.67547, abs=0.015)


def test_density_without_a_position():
    at_home = seawater.density(2, 34.8, 5000)
    assert at_home == seawater.density(2, 34.8, 5000, latitude=45)
    span = seawater.density(2, 34.8, 5000, latitude=90) - seawater.density(2, 34.8, 5000, 0)
    assert span == pytest.approx(0.12, abs=0.01)
    # the North Pacific holds the most of what the reference composition lacks
    pacific = seawater.density(2, 34.8, 5000, 45, -150)
    assert 0.01 < pacific - at_home < 0.03
    # the atlas ends at 86 degrees south, and the sea before it
    assert seawater.density(2, 34.8, 500, -88, 0) == seawater.density(2, 34.8, 500, -88)
