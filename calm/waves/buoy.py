"""A float at the surface in waves: what lifts it, what it weighs and what it radiates."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise
from math import pi, sqrt
from typing import TYPE_CHECKING

import numpy as np

from calm.errors import UsageError
from calm.files import Cylinder, Sphere
from calm.files.rigid import Displacement, Rigid
from calm.physics.line import Floats
from calm.waves.lumped_line import Complexes

if TYPE_CHECKING:
    from calm.case import Mooring
    from calm.solve import Solution

DISC_ADDED = 4.0 / 3.0
"""Added mass of a disc at the surface over ρR³: half of that of one deep down, 8/3 (Lamb 1932)."""

DISC_CD = 1.17
"""Drag coefficient of a disc across the flow (Hoerner 1965, 3-15)."""

SIDEWAYS_ADDED = 0.5
"""Added mass in surge over the displaced water, of a short hull."""

PANELS_UP, PANELS_ROUND = 10, 28
"""Panels of a hull: up its side and round it."""

PANEL_FREQUENCIES = (0.1, *(0.5 + 0.25 * each for each in range(15)), 5.0, 7.0, 10.0)
"""Between which what panels give is interpolated [rad/s]."""

FOLLOWING = 1e10
"""Stiffness that holds a float to a given motion [N/m]."""


@dataclass(frozen=True)
class Buoy:
    """Hold a hull afloat.

    Attributes
    ----------
    mass : of the float and what stands on it [kg]
    displaced : water it displaces [kg]
    radius : of its waterplane [m]
    draft : [m]
    drag, heave_drag : K of its drag in the current, and as it heaves [N/(m/s)²]
    rao : heave over the elevation by angular frequency [rad/s]: amplitude [-], phase [degrees]
    follows : whether it heaves as the water does
    panels : (4, f) of a panel method: frequency [rad/s], added mass [kg], radiation [kg/s] and what
        lifts per metre of elevation [N/m]; None by the formulas of a disc
    """

    mass: float
    displaced: float
    radius: float
    draft: float
    drag: float
    heave_drag: float
    rao: tuple[tuple[float, float, float], ...] = ()
    follows: bool = False
    panels: Complexes | None = None

    def heave(
        self, omega: Floats, number: Floats, density: float, gravity: float
    ) -> tuple[Complexes, Complexes]:
        """Return what resists heave, per metre of it, and what lifts, per metre of elevation [N/m].

        Froude-Krylov force of a disc at its draft, ρgA e^(-kT) 2 J1(kR)/(kR); added mass
        `DISC_ADDED`, of the water as it moves there; radiation by Haskind's relation,
        k ω |X|² / (2 ρ g²) in deep water (Newman 1977, 6.18).

        Parameters
        ----------
        omega, number : (f,) angular frequencies [rad/s] and wave numbers [1/m]
        density, gravity : of the water [kg/m³], [m/s²]
        """
        from scipy.special import j1

        if self.follows:
            return np.full(omega.shape, FOLLOWING + 0j), np.full(omega.shape, FOLLOWING + 0j)
        if self.rao:
            at, amplitude, phase = np.array(self.rao).T
            turned = np.interp(omega, at, np.unwrap(np.radians(phase)))
            return (
                np.full(omega.shape, FOLLOWING + 0j),
                FOLLOWING * np.interp(omega, at, amplitude) * np.exp(1j * turned),
            )
        spring = density * gravity * pi * self.radius**2
        if self.panels is not None:
            at = self.panels[0].real
            added, radiated, lifting = (np.interp(omega, at, one) for one in self.panels[1:])
            inertia = self.mass + added.real
            return spring - omega**2 * inertia + 1j * omega * radiated.real, lifting
        added = DISC_ADDED * density * self.radius**3
        across = number * self.radius
        smith = np.exp(-number * self.draft) * 2.0 * j1(across) / np.maximum(across, 1e-12)
        lifting = (spring - omega**2 * added) * smith
        radiated = number * omega * lifting**2 / (2.0 * density * gravity**2)
        resisting = spring - omega**2 * (self.mass + added) + 1j * omega * radiated
        return resisting, lifting + 1j * omega * radiated * smith


def buoy_of(mooring: Mooring, solution: Solution, follows: bool) -> Buoy | None:
    """Return the float at the surface; None of a line below it.

    Parameters
    ----------
    follows : heaves with the water, whatever its hull

    Raises
    ------
    UsageError
        Its hull is not known.
    """
    if not solution.afloat:
        return None
    index = solution.afloat[0]
    piece = mooring.file.pieces[index]
    above = mooring.file.pieces[: index + 1]
    riding, component = solution.riding, piece.component
    if not isinstance(component, Rigid):
        raise UsageError(f"{piece.label}, a {component.kind}, floats at the surface, and no float")
    given = component.heave_response
    follows = follows or component.heave == "follows"
    draft = 0.0 if riding is None or np.isnan(riding.draft) else riding.draft
    radius = _waterplane_radius(component, draft)
    if radius is None and not (follows or given):
        raise UsageError(
            f"{piece.label} has no hull, which decides how it heaves: give its `hull`, or "
            "`heave: follows`"
        )
    masses = [each.component.mass for each in above]
    if any(mass is None for mass in masses):
        raise UsageError(f"{piece.label} gives no `mass`, which decides how it heaves")
    density = mooring.water.density_at(np.array(0.0))
    panels = None
    if component.heave == "panels" and not follows:
        profile = _profile(component, draft)
        if profile is None:
            raise UsageError(f"{piece.label} has no hull to panel: give its `hull`")
        panels = panel_heave(profile, float(density), mooring.water.gravity)
    lift = float(solution.force[int(solution.piece_nodes[index, 1]), 2])
    mass = float(sum(mass or 0.0 for mass in masses))
    return Buoy(
        mass=mass,
        displaced=max(mass + lift / mooring.water.gravity, 0.0),
        radius=radius or 0.0,
        draft=draft,
        drag=float(solution.carried.normal_drag[index]) * float(density) / 1025.0,
        heave_drag=0.5 * float(density) * DISC_CD * pi * (radius or 0.0) ** 2,
        rao=given,
        follows=follows,
        panels=panels,
    )


def _waterplane_radius(component: object, draft: float) -> float | None:
    """Return the radius of a disc as large as the hull's waterplane [m]; None where unknown."""
    hull = getattr(component, "hull", None)
    if isinstance(hull, Displacement):
        rows = hull.displacement
        if draft <= 0.0:
            return None
        for (low, below, _), (high, above, _) in pairwise(rows):
            if draft <= high:
                return sqrt((above - below) / (high - low) / pi)
        return None
    diameter = getattr(component, "diameter", None)
    if isinstance(component, Sphere) and draft > 0.0 and diameter:
        return sqrt(max(draft * (diameter - draft), 0.0))
    if isinstance(component, Cylinder) and diameter:
        return float(diameter) / 2.0
    return None


def _profile(component: object, draft: float) -> Floats | None:
    """Return (n, 2) radius and height over the surface of a round hull, its keel first [m]."""
    hull, diameter = getattr(component, "hull", None), getattr(component, "diameter", None)
    heights = np.linspace(-draft, 0.0, PANELS_UP)
    if isinstance(hull, Displacement):
        rows = np.array(hull.displacement)
        between = 0.5 * (rows[1:, 0] + rows[:-1, 0])
        radii = np.sqrt(np.diff(rows[:, 1]) / np.diff(rows[:, 0]) / pi)
        return np.column_stack([np.interp(heights + draft, between, radii), heights])
    if isinstance(component, Sphere) and diameter:
        up = heights + draft
        return np.column_stack([np.sqrt(np.maximum(up * (diameter - up), 0.0)), heights])
    if isinstance(component, Cylinder) and diameter:
        return np.column_stack([np.full(PANELS_UP, 0.5 * float(diameter)), heights])
    return None


def panel_heave(profile: Floats, density: float, gravity: float) -> Complexes:
    """Return heave of a round hull in deep water by the panels of Capytaine, as `Buoy.panels`.

    Parameters
    ----------
    profile : (n, 2) radius and height over the surface, the keel first [m]
    density, gravity : of the water [kg/m³], [m/s²]

    Raises
    ------
    UsageError
        Capytaine, version 3 or newer, is not installed.
    """
    try:
        import capytaine
        from capytaine.bem.airy_waves import froude_krylov_force

        from_profile = capytaine.RotationSymmetricMesh.from_profile_points
    except (ImportError, AttributeError):
        raise UsageError(
            "`heave: panels` needs Capytaine 3: pip install capytaine; or leave `heave` out"
        ) from None
    capytaine.set_logging("ERROR")
    keel, bottom = profile[0]
    flat = np.linspace(0.0, keel, max(int(keel / 0.2), 2) + 1)[:-1] if keel > 0.0 else np.zeros(1)
    outline = np.vstack(
        [np.column_stack([flat, np.full(len(flat), bottom)]), profile[profile[:, 0] > 0.0]]
    )
    points = np.insert(outline, 1, 0.0, axis=1)
    body = capytaine.FloatingBody(mesh=from_profile(points, n=PANELS_ROUND))
    body.add_translation_dof(name="Heave")
    solver, found = capytaine.BEMSolver(), []
    for omega in PANEL_FREQUENCIES:
        given = {"body": body, "omega": omega, "rho": density, "g": gravity}
        moved = solver.solve(capytaine.RadiationProblem(radiating_dof="Heave", **given))
        waves = capytaine.DiffractionProblem(wave_direction=0.0, **given)
        lifts = solver.solve(waves).forces["Heave"] + froude_krylov_force(waves)["Heave"]
        mass, radiation = moved.added_masses["Heave"], moved.radiation_dampings["Heave"]
        found.append((omega, mass, radiation, np.conj(lifts)))
    return np.array(found, complex).T
