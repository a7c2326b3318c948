"""C6: Pode's cable functions, and the identities they satisfy."""

from __future__ import annotations

from dataclasses import replace
from functools import cache, partial
from math import degrees, radians

from calm.analytic.pode import CableFunctions, cable_functions
from calm.analytic.uniform import critical_angle, critical_weight_ratio, tension_ratio
from calm.physics.friction import Friction
from calm.verification.case import PRINTED, Case, CaseColumn, Kind, Source, table
from calm.verification.ends import Wake, towed
from calm.verification.pieces import LinePiece, deep_water, line_of, point

_TABLE = (
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
)
"""φc [degrees], f, φ [degrees], τ, σ, ξ, η."""

_CRITICAL = (
    (0.05, 12.7578), (0.1, 17.9642), (0.2, 25.1784), (0.5, 38.6683), (1.0, 51.8273),
    (2.0, 65.5302), (5.0, 78.8965), (10.0, 84.3173),
)  # fmt: skip
"""p, φc [degrees]."""

_PULL = 100.0
"""Of the body that the march tows [N]."""


@cache
def _functions(critical: float, friction: float, angle: float) -> CableFunctions:
    ratio = float(critical_weight_ratio(radians(critical)))
    return cable_functions(radians(angle), ratio, friction)


@cache
def _march(critical: float, friction: float, arc: float) -> Wake:
    """A body of 100 N without drag on a cable whose normal drag is 1 N/m at 1 m/s."""
    weight = float(critical_weight_ratio(radians(critical)))
    cable = LinePiece(_PULL * arc, True, -weight, 1.0, friction)
    line = replace(line_of(cable, point(-_PULL, 0.0)), friction=Friction.CONSTANT)
    return towed(line, deep_water(), 1.0)


def _name(critical: float, friction: float, angle: float) -> str:
    return f"C6 φc {critical}°, f {friction:g}, φ {angle}°"


def _identity_missed() -> float:
    """The worst |τ − 1 − p η − f σ| of the table."""
    misses = []
    for critical, friction, angle, *_ in _TABLE:
        tau, sigma, _, eta = _functions(critical, friction, angle)
        ratio = float(critical_weight_ratio(radians(critical)))
        misses.append(abs(float(tau - 1.0 - ratio * eta - friction * sigma)))
    return max(misses)


def _tension(critical: float, angle: float, tau: float) -> Case:
    def got() -> float:
        ratio = float(critical_weight_ratio(radians(critical)))
        return float(tension_ratio(radians(angle), radians(90.0), ratio))

    return Case(
        f"{_name(critical, 0.0, angle)}: τ, closed form", tau, "", 5.5e-7, PRINTED, got,
        Kind.INDEPENDENT,
    )  # fmt: skip


def _critical_angle(ratio: float) -> float:
    """[degrees]"""
    return degrees(float(critical_angle(ratio)))


PODE = Source(
    "Pode's cable functions",
    """L. Pode's functions of a heavy cable in a uniform stream (David Taylor Model Basin reports
687 and 717, 1951), constant friction F = f R along it (C6): τ, σ, ξ, η between φ and 90°, as
evaluated by quadrature to 1e-10 from his integrals, not copied from his tables. They are held
against `calm.analytic.pode` and τ − 1 = p η + f σ; those with friction against the march of a towed
body, the tensions without against their closed form. The critical angle,
cos φc = √(1 + p²/4) − p/2, is E. E. Zajac's, too (Bell System Technical Journal 36, 1957).""",
    (
        *table(
            [
                CaseColumn[CableFunctions]("τ", "", 5.5e-7, lambda row: float(row.tau)),
                CaseColumn[CableFunctions]("σ", "", 5.5e-7, lambda row: float(row.sigma)),
                CaseColumn[CableFunctions]("ξ", "", 5.5e-7, lambda row: float(row.xi)),
                CaseColumn[CableFunctions]("η", "", 5.5e-7, lambda row: float(row.eta)),
            ],
            [(_name(*given), partial(_functions, *given), row)
             for *given, tau, sigma, xi, eta in _TABLE
             for row in [(tau, sigma, xi, eta)]],
            PRINTED,
            Kind.INDEPENDENT,
        ),
        *table(
            [
                CaseColumn[Wake]("φ, march", "°", 1e-4, lambda wake: wake.angle),
                CaseColumn[Wake]("τ, march", "", 2e-6, lambda wake: wake.tension / _PULL),
                CaseColumn[Wake]("ξ, march", "", 2e-6, lambda wake: wake.aft / _PULL),
                CaseColumn[Wake]("η, march", "", 2e-6, lambda wake: wake.depth / _PULL),
            ],
            [(_name(critical, f, angle), partial(_march, critical, f, sigma),
              (angle, tau, xi, eta))
             for critical, f, angle, tau, sigma, xi, eta in _TABLE if f > 0.0],
            "The cable is cut to σ, printed to 5e-7; the march errs by 1e-7 of its length, some "
            "1e-6, at an angle step of 0.1°.",
            Kind.INDEPENDENT,
        ),
        *(_tension(critical, angle, tau) for critical, f, angle, tau, *_ in _TABLE if f == 0.0),
        Case("C6 all rows: greatest |τ − 1 − p η − f σ|", 0.0, "", 1e-11,
             "Exact; the quadratures go on to 1e-12.", _identity_missed, Kind.PROPERTY),
        *(
            Case(f"critical angle, p {ratio:g}", expected, "°", 5.5e-5, PRINTED,
                 partial(_critical_angle, ratio), Kind.CLOSED_FORM)
            for ratio, expected in _CRITICAL
        ),
    ),
)  # fmt: skip
