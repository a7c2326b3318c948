"""A float at the surface in waves: wave forces, inertia and radiation."""

from __future__ import annotations

from dataclasses import dataclass
from math import factorial, pi
from typing import TYPE_CHECKING, Literal

import numpy as np

from calm.errors import UsageError
from calm.files.rigid import Rigid
from calm.physics.hull import SPAR, TABULATED, Hull
from calm.physics.line import Floats
from calm.waves.lumped_line import Complexes

if TYPE_CHECKING:
    from calm.case.leg import Leg
    from calm.solve import Solution

DISC_ADDED = 4.0 / 3.0
"""Added mass of a disc at the surface, divided by ρR³: half the value of a deeply submerged disc,
8/3 (Lamb 1932).
"""

DISC_CD = 1.17
"""Drag coefficient of a disc normal to the flow (Hoerner 1965, 3-15)."""

SIDEWAYS_ADDED = 0.5
"""Added mass of a short hull in surge, divided by the displaced mass."""

DISC_TURNED = 8.0 / 45.0
"""Added moment of inertia of a disc at the surface, divided by ρR⁵: half the value of a deeply
submerged disc (Lamb 1932).
"""

END_LOSS = 0.42
"""Length scale, in radii R, over which the flow around the keel reduces the added mass in surge.

The added mass of a section at height h above the keel is multiplied by 1 - e^(-h/0.42R). For
cylinders with a draft of 0.6 to 10 radii, this added mass agrees with the result of a panel method
(Capytaine 3) within 4 %.
"""

SECTIONS = 46
"""Number of horizontal sections of a hull, from its keel up."""

PANELS_ROUND = 28
"""Number of panels around a hull; each panel extends over five sections."""

PANEL_FREQUENCIES = (0.1, *(0.5 + 0.25 * each for each in range(15)), 5.0, 7.0, 10.0)
"""Frequencies of the panel method [rad/s]; results in between are interpolated."""

PRESCRIBED_STIFFNESS = 1e10
"""Stiffness that forces a float to follow a prescribed motion [N/m]."""


@dataclass(frozen=True)
class Buoy:
    """Properties of a float at the surface that determine its motion in waves.

    Heights are relative to the surface.

    Attributes
    ----------
    mass, displaced : mass of the float with the pieces on it, and of the displaced water [kg]
    radius, draft : radius of the waterplane, and draft of the float [m]
    drag, heave_drag : K of the drag K|V|V in horizontal flow, and in heave [N/(m/s)²]
    rao : prescribed response to the wave elevation, with a row for each frequency: angular
        frequency [rad/s], amplitude [-] and phase [degrees] of heave; optionally amplitude
        [degrees/m] and phase [degrees] of pitch
    follows : whether heave and pitch follow the motion of the water surface
    panels : (12, f) result of `panel_response`; None if formulas are used instead
    profile : (s, 2) radius and height of each horizontal section of the hull [m], from the keel up;
        None if pitch is not computed
    centre : height of the centre of mass, with the pieces on the float [m]
    bail : height of the attachment point of the line [m]
    gyration : radius of gyration about a horizontal axis through the centre of mass [m]
    """

    mass: float
    displaced: float
    radius: float
    draft: float
    drag: float
    heave_drag: float
    rao: tuple[tuple[float, ...], ...] = ()
    follows: bool = False
    panels: Complexes | None = None
    profile: Floats | None = None
    centre: float = 0.0
    bail: float = 0.0
    gyration: float = 0.0

    @property
    def heaves(self) -> Literal["filtered", "panels", "follows"] | None:
        """Method for computing heave; None if the mooring file prescribes the float's response."""
        if self.follows:
            return "follows"
        if self.rao:
            return None
        return "filtered" if self.panels is None else "panels"

    def heave(
        self, omega: Floats, number: Floats, density: float, gravity: float
    ) -> tuple[Complexes, Complexes]:
        """Return the dynamic stiffness and the exciting force in heave, complex arrays (f,) [N/m].

        The force is per metre of wave elevation. If the response is not prescribed, and there is no
        result of a panel method, the hull is a disc of radius R, area A and draft T. The added
        mass of the disc is `DISC_ADDED` ρR³. Its Froude-Krylov force is ρgA e^(-kT) 2 J1(kR)/(kR).
        Its radiation damping in deep water is k ω |X|² / (2 ρ g²), where X is the exciting force
        (Haskind's relation, Newman 1977, 6.18).

        Parameters
        ----------
        omega, number : (f,) angular frequencies [rad/s] and wave numbers [1/m]
        density, gravity : density of the water [kg/m³] and acceleration of gravity [m/s²]
        """
        if self.follows:
            return np.full(omega.shape, PRESCRIBED_STIFFNESS + 0j), np.full(
                omega.shape, PRESCRIBED_STIFFNESS + 0j
            )
        if self.rao:
            return np.full(
                omega.shape, PRESCRIBED_STIFFNESS + 0j
            ), PRESCRIBED_STIFFNESS * self._given(omega, 1)
        spring = density * gravity * pi * self.radius**2
        if self.panels is not None:
            rows = [np.interp(omega, self.panels[0].real, one) for one in self.panels]
            inertia = self.mass + rows[1].real
            return spring - omega**2 * inertia + 1j * omega * rows[2].real, rows[9]
        added = DISC_ADDED * density * self.radius**3
        across = number * self.radius
        smith = np.exp(-number * self.draft) * 2.0 * bessel(1, across) / np.maximum(across, 1e-12)
        lifting = (spring - omega**2 * added) * smith
        radiated = number * omega * lifting**2 / (2.0 * density * gravity**2)
        resisting = spring - omega**2 * (self.mass + added) + 1j * omega * radiated
        return resisting, lifting + 1j * omega * radiated * smith

    def pitch(
        self, profile: Floats, omega: Floats, number: Floats, density: float, gravity: float
    ) -> tuple[Complexes, Complexes]:
        """Return the dynamic stiffness and the exciting forces in surge and pitch.

        The reference point is on the axis of the float, at the surface. Pitch is positive if the
        part above the surface moves forward.

        Returns
        -------
        stiffness : (3, f) surge [N/m], coupling of surge with pitch [N], pitch [N m]
        exciting : (2, f) force in surge [N/m] and moment in pitch [N], per metre of wave elevation
        """
        if self.panels is None:
            added, radiated, pushing = self._of_sections(profile, omega, number, density, gravity)
        else:
            rows = [np.interp(omega, self.panels[0].real, one) for one in self.panels]
            added, radiated = np.real(rows[3:9:2]), np.real(rows[4:9:2])
            pushing = omega**2 * np.array(rows[10:])
        second = self.centre**2 + self.gyration**2
        inertia = self.mass * np.array([[1.0], [self.centre], [second]])
        held = np.asarray(1j * omega * radiated - omega**2 * (inertia + added), complex)
        held[2] += self.righting(profile, density, gravity)
        if self.follows or (self.rao and len(self.rao[0]) > 3):
            given = 1j * number if self.follows else self._given(omega, 3) * pi / 180.0
            held[2] += PRESCRIBED_STIFFNESS
            pushing[1] += PRESCRIBED_STIFFNESS * given
        return held, pushing

    def _given(self, omega: Floats, column: int) -> Complexes:
        """Interpolate the prescribed response at the frequencies `omega`.

        `column` of `rao` has the amplitudes, and the next column the phases.
        """
        at, amplitude, phase = np.array(self.rao).T[[0, column, column + 1]]
        turned = np.interp(omega, at, np.unwrap(np.radians(phase)))
        return np.asarray(np.interp(omega, at, amplitude) * np.exp(1j * turned))

    def righting(self, profile: Floats, density: float, gravity: float) -> float:
        """Return the righting moment of the float per radian of pitch [N m].

        The moment includes the pull of the line at the bail. For a free float, the moment is the
        weight times the metacentric height.
        """
        radius, height = profile.T
        buoyancy = float(np.trapezoid(radius**2 * height) / np.trapezoid(radius**2))
        plane = 0.25 * density * pi * self.radius**4
        pulled = (self.displaced - self.mass) * self.bail
        moment = plane + self.displaced * buoyancy - self.mass * self.centre - pulled
        return gravity * moment

    def _of_sections(
        self, profile: Floats, omega: Floats, number: Floats, density: float, gravity: float
    ) -> tuple[Floats, Floats, Complexes]:
        """Compute added mass (3, f), damping (3, f) and exciting forces (2, f), as in `pitch`.

        The added mass of the sections follows from `END_LOSS`, and the added moment of inertia of
        the bottom from `DISC_TURNED`. The damping in deep water is k ω Xi Xj / (4 ρ g²), where Xi
        and Xj are exciting forces (Haskind's relation, Newman 1977, 6.18).
        """
        radius, height = profile.T
        area = pi * radius**2
        area *= self.displaced / (density * np.trapezoid(area, height))
        share = 1.0 - np.exp((height[0] - height) / (END_LOSS * self.radius))
        turned = DISC_TURNED * density * self.radius**5
        powers = height ** np.arange(3)[:, None]
        added = density * np.trapezoid(share * area * powers, height)[:, None]
        added[2] += turned

        k = number[:, None]
        across = np.maximum(k * radius, 1e-9)
        smith = np.exp(k * height) * 2.0 * bessel(1, across) / across
        lean = 8.0 * bessel(2, across) / across**2
        surging = (1.0 + share) * area * smith
        lifted = 0.25 * k * area * radius**2 * np.exp(k * height) * lean
        turning = np.trapezoid(surging * height - lifted, height)
        turning += 0.25 * pi * self.radius**4 * lean[:, -1]
        slope = 1j * number * np.exp(-number * self.draft) * lean[:, -1]
        pressed = np.array([np.trapezoid(surging, height), turning])
        pushing = 1j * density * gravity * number * pressed
        pushing[1] -= omega**2 * turned * slope

        one, two = pushing.imag
        squares = np.array([one * one, one * two, two * two])
        radiated = number * omega / (4.0 * density * gravity**2) * squares
        water = omega * np.trapezoid(area * smith, height) / np.trapezoid(area, height)
        rate = (1j * omega * slope).real
        pushing[0] += radiated[0] * water + radiated[1] * rate
        pushing[1] += radiated[1] * water + radiated[2] * rate
        return added, radiated, pushing


def bessel(order: int, x: Floats) -> Floats:
    """Evaluate the Bessel function of the first kind Jn(x), for an integer order n ≥ 0.

    Sources: Abramowitz and Stegun 9.1.10 (power series) for |x| < 4, and 9.1.21 (mean of
    cos(nθ − x sin θ) around a circle) for larger |x|.
    """
    small = np.minimum(np.abs(x), 4.0) * np.sign(x)
    term = (0.5 * small) ** order / factorial(order)
    series = term.copy()
    for k in range(1, 24):
        term = term * (-0.25 * small**2 / (k * (order + k)))
        series += term
    far = np.abs(x) >= 4.0
    if far.any():
        steps = 64 + 2 * int(np.abs(x).max())
        around = 2.0 * pi / steps * np.arange(steps)
        series[far] = np.cos(order * around - x[far, None] * np.sin(around)).mean(-1)
    return np.asarray(series)


def buoy_of(leg: Leg, solution: Solution, follows: bool) -> Buoy | None:
    """Return the float at the surface, or None if the line is below the surface.

    If `follows` is true, heave and pitch follow the water surface, whatever the hull.

    Raises
    ------
    UsageError
        Hull or mass of the float is unknown, the component at the surface is not a float, or the
        float would capsize.
    """
    if not solution.afloat:
        return None
    index = solution.afloat[0]
    piece = leg.file.pieces[index]
    above = leg.file.pieces[: index + 1]
    riding, component = solution.riding, piece.component
    if not isinstance(component, Rigid):
        raise UsageError(f"{piece.label} at the surface is a {component.kind}, not a float")
    given = component.rao or ()
    follows = follows or component.heave == "follows"
    draft = 0.0 if riding is None or np.isnan(riding.draft) else riding.draft
    floating = leg.line.floating
    radius, profile = _round_hull(None if floating is None else floating.hull, draft)
    known = radius > 0.0 if component.heave != "panels" else profile is not None
    if not (known or follows or (given and component.heave != "panels")):
        raise UsageError(
            f"{piece.label} has no hull, which is needed for its heave: set its `hull`, or "
            "`heave: follows`"
        )
    masses = [each.component.mass for each in above]
    if any(mass is None for mass in masses):
        raise UsageError(f"{piece.label} has no `mass`, which is needed for its heave")
    density = leg.water.density_at(np.array(0.0))
    panels = None
    if component.heave == "panels" and profile is not None and not follows:
        panels = panel_response(profile[::5], float(density), leg.water.gravity)
    centre, gyration = component.centre_of_mass, component.radius_of_gyration
    if centre is None and given and len(given[0]) > 3:
        centre, gyration = draft, 0.0
    lift = float(solution.force[int(solution.piece_nodes[index, 1]), 2])
    mass = float(sum(mass or 0.0 for mass in masses))
    buoy = Buoy(
        mass=mass,
        displaced=max(mass + lift / leg.water.gravity, 0.0),
        radius=radius,
        draft=draft,
        drag=float(solution.carried.normal_drag[index]) * float(density) / 1025.0,
        heave_drag=0.5 * float(density) * DISC_CD * pi * radius**2,
        rao=given,
        follows=follows,
        panels=panels,
        profile=None if centre is None else profile,
        centre=(centre or 0.0) - draft,
        bail=(component.bail or 0.0) - draft,
        gyration=gyration or 0.0,
    )
    if buoy.profile is not None and gyration:
        righted = buoy.righting(buoy.profile, float(density), leg.water.gravity)
        if righted <= 0.0:
            raise UsageError(
                f"{piece.label} does not float upright: its `centre_of_mass` is {centre:g} m above "
                f"the keel, its draft is {draft:.2f} m, and its righting moment is "
                f"{righted:.0f} N m per radian"
            )
    return buoy


def _round_hull(hull: Hull | None, draft: float) -> tuple[float, Floats | None]:
    """Return the radius of a hull's waterplane [m], and its profile as in `Buoy`.

    The results are 0 and None if the hull is unknown.
    """
    if hull is None or draft <= 0.0:
        return (0.5 * hull.area / hull.height if hull and hull.form == SPAR else 0.0), None
    up = np.linspace(0.0, draft, SECTIONS)
    radii = np.sqrt(np.maximum(up * (hull.height - up), 0.0))
    plane = float(radii[-1])
    if hull.form == SPAR:
        plane = 0.5 * hull.area / hull.height
        radii = np.full(SECTIONS, plane)
    elif hull.form == TABULATED:
        drafts, volumes, _ = np.array(hull.rows).T
        wide = np.sqrt(np.diff(volumes) / np.diff(drafts) / pi)
        radii = np.interp(up, 0.5 * (drafts[1:] + drafts[:-1]), wide)
        plane = float(wide[min(int(np.searchsorted(drafts, draft)), len(wide)) - 1])
    return plane, np.column_stack([radii, up - draft])


def panel_response(profile: Floats, density: float, gravity: float) -> Complexes:
    """Compute added mass, damping and wave forces of an axisymmetric hull with Capytaine.

    The water is deep, `profile` is as in `Buoy`, and pitch refers to the surface.

    Returns
    -------
    Complex array (12, f).

    - Row 0 is the angular frequency ω [rad/s].
    - Rows 1 to 8 are pairs of added mass and damping for heave, surge, the coupling of surge with
      pitch, and pitch.
    - Row 9 is the exciting force in heave, per metre of wave elevation.
    - Rows 10 and 11 are the exciting force in surge and the exciting moment in pitch, per metre of
      wave elevation, each divided by ω².

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
            "`heave: panels` requires Capytaine 3: pip install capytaine; or remove `heave`"
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
    body.add_translation_dof(name="Surge")
    about = {"rotation_center": np.zeros(3), "direction": np.array([0.0, 1.0, 0.0])}
    body.add_rotation_dof(name="Pitch", **about)
    solver, found = capytaine.BEMSolver(), []
    for omega in PANEL_FREQUENCIES:
        given = {"body": body, "omega": omega, "rho": density, "g": gravity}
        row = [omega + 0j]
        for way, other in _WAYS:
            moved = solver.solve(capytaine.RadiationProblem(radiating_dof=way, **given))
            row += [moved.added_masses[other], moved.radiation_dampings[other]]
        waves = capytaine.DiffractionProblem(wave_direction=0.0, **given)
        bent, straight = solver.solve(waves).forces, froude_krylov_force(waves)
        pushing = [np.conj(bent[way] + straight[way]) for way in ("Heave", "Surge", "Pitch")]
        found.append([*row, pushing[0], pushing[1] / omega**2, pushing[2] / omega**2])
    return np.array(found, complex).T


_WAYS = ("Heave", "Heave"), ("Surge", "Surge"), ("Pitch", "Surge"), ("Pitch", "Pitch")
