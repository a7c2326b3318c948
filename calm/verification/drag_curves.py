"""C23: drag coefficients of smooth cylinders and spheres against Reynolds number."""

from __future__ import annotations

from functools import partial
from math import exp, pow

from calm.physics.drag import end_face_coefficient, finite_length_factor
from calm.physics.reynolds import (
    cylinder_coefficient,
    finite_length_factor_above,
    sphere_coefficient,
)
from calm.verification.case import PRINTED, Case, Kind, Source

WIESELSBERGER = (
    (3.18, 4.87), (8.01, 2.94), (17.7, 2.12), (31.7, 1.73), (63.6, 1.48), (196.0, 1.27),
    (356.0, 1.15), (892.0, 0.964), (2.27e3, 0.886), (5.15e3, 0.944), (9.18e3, 1.06),
    (1.5e4, 1.14), (3.03e4, 1.16), (6.55e4, 1.17), (1.07e5, 1.17), (1.61e5, 1.18),
    (2.20e5, 1.06), (2.93e5, 0.910), (3.65e5, 0.726), (4.27e5, 0.547), (4.90e5, 0.337),
    (5.03e5, 0.302), (6.28e5, 0.318), (8.10e5, 0.355),
)  # fmt: skip
"""Reynolds number and Cn of a long cylinder, as measured."""

DNV = (
    (2.1e5, 1.21), (2.31e5, 1.20), (2.72e5, 1.17), (2.97e5, 1.11), (3.25e5, 1.01),
    (3.62e5, 0.894), (4.10e5, 0.709), (4.75e5, 0.532), (5.25e5, 0.408), (5.79e5, 0.327),
    (6.38e5, 0.284), (7.44e5, 0.297), (1.07e6, 0.389), (1.39e6, 0.470), (1.83e6, 0.539),
    (2.26e6, 0.584), (2.90e6, 0.629), (3.66e6, 0.648), (4.94e6, 0.678),
)  # fmt: skip
"""Reynolds number and Cn of a long cylinder, as recommended."""

MORRISON = (
    (1.0, 24.673), (1e2, 1.0381), (1e3, 0.4838), (1e4, 0.3926), (1e5, 0.4257), (2e5, 0.4159),
    (3e5, 0.1734), (4e5, 0.0930), (1e6, 0.1296),
)  # fmt: skip
"""Reynolds number and Cx of a sphere."""

MEASURED_UP_TO = 1.61e5
"""Reynolds number up to which CALM's cylinder follows the measurements."""

_SLENDERNESS = (2.0, 5.0, 10.0, 20.0, 40.0, 50.0, 100.0)
_KAPPA = (0.58, 0.62, 0.68, 0.74, 0.82, 0.87, 0.98)
_KAPPA_ABOVE = (0.80, 0.80, 0.82, 0.90, 0.98, 0.99, 1.00)
_END_FACE = ((0.1, 1.17), (0.6, 1.07), (0.88, 0.97), (1.3, 0.86), (1.8, 0.82))

_COPIED = "The printed digits: they are the points CALM's curve is drawn through."
_SHARE = 1e-9


def cheng(reynolds: float) -> float:
    """Cn of a smooth cylinder by Cheng's fit, below Re 2e5."""
    creeping = 11.0 * pow(reynolds, -0.75)
    middle = 0.9 * (1.0 - exp(-1000.0 / reynolds))
    return creeping + middle + 1.2 * (1.0 - exp(-pow(reynolds / 4500.0, 0.7)))


DRAG_CURVES = Source(
    "Drag curves of smooth bodies",
    """Cn of a long smooth cylinder against Reynolds number (C23): Wieselsberger's measurements
(NACA report 121) up to 1.61e5 and the recommendation of DNV-RP-C205, figure 6-6, from 2.1e5. In the
drag crisis the two differ, by a roughness or a turbulence that nobody states; CALM takes DNV's
curve there, the later and safer. Factors for finite length: DNV-RP-C205, table 6-2; flow against
the end face: Kritzinger. Cx of a sphere: F. A. Morrison's correlation (Michigan Technological
University, 2016). That the printed points come back guards against slips of copying; Cheng's fit
(Journal of Hydraulic Engineering 139, 2013), which shares none of them, is held against some.
Moorings take these curves only where a component is declared smooth.""",
    (
        *(
            Case(f"C23 cylinder, Re {reynolds:g}, Wieselsberger", cn, "", _SHARE, _COPIED,
                 partial(cylinder_coefficient, reynolds), Kind.BY_CONSTRUCTION)
            for reynolds, cn in WIESELSBERGER if reynolds <= MEASURED_UP_TO
        ),
        *(
            Case(f"C23 cylinder, Re {reynolds:g}, DNV", cn, "", _SHARE, _COPIED,
                 partial(cylinder_coefficient, reynolds), Kind.BY_CONSTRUCTION)
            for reynolds, cn in DNV
        ),
        *(
            Case(f"C23 cylinder, Re {reynolds:g}, Cheng", round(cheng(reynolds), 4), "",
                 0.05 * cheng(reynolds),
                 "5 %, to which the fit and the measurements agree from Re 17 to 1.6e5.",
                 partial(cylinder_coefficient, reynolds), Kind.CLOSED_FORM)
            for reynolds in (17.7, 63.6, 196.0, 892.0, 5.15e3, 1.5e4, 6.55e4, 1.07e5)
        ),
        *(
            Case(f"C23 κ, L/D {slenderness:g}, Re below 2e5", kappa, "", _SHARE, _COPIED,
                 partial(finite_length_factor, slenderness), Kind.BY_CONSTRUCTION)
            for slenderness, kappa in zip(_SLENDERNESS, _KAPPA, strict=True)
        ),
        *(
            Case(f"C23 κ, L/D {slenderness:g}, Re above 2e5", kappa, "", _SHARE, _COPIED,
                 partial(finite_length_factor_above, slenderness), Kind.BY_CONSTRUCTION)
            for slenderness, kappa in zip(_SLENDERNESS, _KAPPA_ABOVE, strict=True)
        ),
        Case("C23 κ, L/D 1, Wieselsberger", 0.52, "", 5.5e-3, PRINTED,
             partial(finite_length_factor, 1.0), Kind.BY_CONSTRUCTION),
        *(
            Case(f"C23 end face, L/D {slenderness:g}", ct, "", _SHARE, _COPIED,
                 partial(end_face_coefficient, slenderness), Kind.BY_CONSTRUCTION)
            for slenderness, ct in _END_FACE
        ),
        *(
            Case(f"C23 sphere, Re {reynolds:g}", cx, "", 5.5e-4 if cx > 10.0 else 5.5e-5, PRINTED,
                 partial(sphere_coefficient, reynolds), Kind.CLOSED_FORM)
            for reynolds, cx in MORRISON
        ),
    ),
    picture="verification-drag-curves",
)  # fmt: skip
