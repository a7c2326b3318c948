"""Strumming (vortex-induced vibration) of a line: frequency, amplitude, and increase of Cn.

Amplitudes A are single amplitudes, given as the ratio A/D to the diameter [-]. Angles are in
radians. A line is assumed to strum wherever it sheds vortices. The drag factors are upper limits:
sheared currents, attachments and fairing reduce strumming.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from math import asin, cbrt, cos, inf, pi, pow, radians, sin, sqrt
from types import MappingProxyType
from typing import NamedTuple

from calm.physics.drag import drag_share

STROUHAL = 0.2
"""Strouhal number for static calculations, used at all Reynolds numbers."""

STRUCTURAL_DAMPING = 0.005
"""Default structural damping ratio, as used by DNV-RP-F105 for pipes without concrete."""

CABLE_MODE = 1.155
"""Mode factor γ of a taut line, √(4/3), which accounts for the larger motion at antinodes; a rigid
cylinder has γ = 1.
"""

# above A/D = 1, Blevins's formula exceeds the measured Cn of 2.4 to 3.2 (Griffin et al. 1984),
# which is 2.0 to 2.7 times Cn without strumming
_BLEVINS_CAP = 1.0


def shedding_frequency(speed: float, diameter: float, strouhal: float = STROUHAL) -> float:
    """Return the frequency St |Vn|/D [Hz] of vortex shedding from a line of a given diameter [m].

    Parameters
    ----------
    speed : speed |Vn| of the current normal to the line [m/s]
    """
    return strouhal * speed / diameter


def reduced_damping(
    mass: float, diameter: float, density: float, damping: float, strouhal: float = STROUHAL
) -> float:
    """Return the reduced damping S_G = 8π² St² m ζ/(ρ D²) [-].

    Parameters
    ----------
    mass, diameter : mass per metre [kg/m] and diameter [m] of the line
    density : density of the water [kg/m³]
    damping : structural damping ζ, as a fraction of critical damping [-]
    """
    return 8.0 * pi**2 * strouhal**2 * mass * damping / (density * diameter**2)


def griffin_skop(damping: float, mode: float = CABLE_MODE) -> float:
    """Return the amplitude ratio A/D at resonance, 0.645 γ/(1 + 0.43 S_G)^3.35.

    Parameters
    ----------
    damping : reduced damping S_G [-]
    mode : mode factor γ [-]

    Source: Griffin, Skop & Ramberg (1975), Offshore Technology Conference, paper 2319. The
    paper gives the double amplitude, with the factor 1.29 γ.
    """
    return 0.645 * mode * pow(1.0 + 0.43 * damping, -3.35)


def line_amplitude(
    mass: float, diameter: float, density: float, damping: float = STRUCTURAL_DAMPING
) -> float:
    """Return the amplitude ratio A/D of a strumming line, from `griffin_skop` for a cable.

    The ratio does not depend on the current. Typical ratios of ropes and wires in water are 0.68 to
    0.74. The arguments are as in `reduced_damping`.
    """
    return griffin_skop(reduced_damping(mass, diameter, density, damping))


def vandiver(amplitude: float) -> float:
    """Return the ratio of Cn of a strumming line to Cn without strumming, by Vandiver's formula.

    The ratio is 1 + 1.043 (2 Y_rms/D)^0.65 with Y_rms = A/√2. `amplitude` is A/D.

    Source: Vandiver (1983), Offshore Technology Conference, paper 4490.
    """
    return 1.0 + 1.043 * pow(sqrt(2.0) * amplitude, 0.65)


def blevins(amplitude: float) -> float:
    """Return the ratio of Cn of a strumming line to Cn without strumming, by Blevins's formula.

    The ratio is 1 + 2.1 A/D, and constant above A/D = 1. `amplitude` is A/D.

    Source: Blevins (1990), Flow-Induced Vibration, second edition.
    """
    return 1.0 + 2.1 * min(amplitude, _BLEVINS_CAP)


def skop_griffin(amplitude: float) -> float:
    """Return the ratio of Cn of a strumming line to Cn without strumming, by Skop and Griffin.

    The ratio at resonance is 1 + 1.16 (2 A/D)^0.65. `amplitude` is A/D.

    Source: Skop, Griffin & Ramberg (1977), Offshore Technology Conference, paper 2884.
    """
    return 1.0 + 1.16 * pow(2.0 * amplitude, 0.65)


AMPLIFICATIONS: Mapping[str, Callable[[float], float]] = MappingProxyType(
    {"vandiver": vandiver, "blevins": blevins, "skop-griffin": skop_griffin}
)
"""Functions that return the factor on Cn for an amplitude ratio A/D, by name in mooring files."""


def drag_factor(ratio: float) -> float:
    """Return the ratio of the drag of a vibrating cylinder to its drag at rest.

    The ratio is f(λ) = (1/π) ∫₀^π (1 + λ² cos²θ)^{3/2} dθ, from the power balance of Bourget &
    Marichal.

    Parameters
    ----------
    ratio : maximum speed of the vibration over the current speed normal to the line, λ [-]
    """
    square = ratio * ratio
    # The integral gives f = (2/3π) √(1 + λ²) [2 (2 + λ²) E(m) - K(m)] with m = λ²/(1 + λ²). The
    # paper prints 2/π instead of 1/π, which would give f(0) = 2.
    # K = π/(2 agm), E = K (1 - Σ 2^(n-1) c_n²), from a = 1, b = √(1 - m), c² = m
    a, b = 1.0, 1.0 / sqrt(1.0 + square)
    weight, deficit = 0.5, 0.5 * square / (1.0 + square)
    while a - b > 1e-15 * a:
        c = 0.5 * (a - b)
        a, b = 0.5 * (a + b), sqrt(a * b)
        weight *= 2.0
        deficit += weight * c * c
    bracket = 2.0 * (2.0 + square) * (1.0 - deficit) - 1.0
    return sqrt(1.0 + square) * bracket / (3.0 * a)


class Vibration(NamedTuple):
    """Coefficients of Bourget & Marichal's strumming law, in the form used by the march.

    Attributes
    ----------
    a1, b1, c1 : coefficients of the amplitude ratio a/D = a1 + b1 φ + c1 φ², where φ is the angle
        between cable and flow in degrees
    greatest : largest factor by which strumming increases Cn of the cable [-]
    beat : strumming frequency F [Hz] for a whole line, F D [m/s] for one cable of diameter D, or
        F D/|V| [-] for one point with flow speed |V|
    """

    a1: float
    b1: float
    c1: float
    greatest: float
    beat: float


AT_REST = Vibration(0.0, 0.0, 0.0, 1.0, 0.0)
"""Law of a line that does not strum."""


def with_beat(vibration: Vibration, beat: float) -> Vibration:
    """Return a copy of the strumming law with another `beat`."""
    a1, b1, c1, greatest, _ = vibration
    return Vibration(a1, b1, c1, greatest, beat)


def amplitude(vibration: Vibration, angle: float) -> float:
    """Return the amplitude ratio a/D [-] of a cable at an angle φ to the flow [rad]."""
    phi = angle * (180.0 / pi)
    return vibration.a1 + (vibration.b1 + vibration.c1 * phi) * phi


def strummed(vibration: Vibration, across: float) -> float:
    """Return the drag ratio C*/C₀ = f(λ) of a strumming cable, at most `vibration.greatest`.

    λ = 2π (a/D) F D/(|V| sin φ), where φ is the angle between cable and flow, sin φ is `across`,
    and F D/|V| is `vibration.beat`. For flow along the cable, the ratio is `vibration.greatest`.
    """
    return min(strummed_freely(vibration, across), vibration.greatest)


def strummed_freely(vibration: Vibration, across: float) -> float:
    """Return the drag ratio as in `strummed`, but at most twice `vibration.greatest`."""
    if vibration.beat == 0.0:
        return 1.0
    if across <= 0.0:
        return 2.0 * vibration.greatest
    ratio = 2.0 * pi * amplitude(vibration, asin(across)) * vibration.beat / across
    return min(drag_factor(ratio), 2.0 * vibration.greatest)


def amplified_share(
    ax: float, ay: float, az: float, k: float, vibration: Vibration, vx: float, vy: float, vz: float
) -> tuple[float, float]:
    """Return the factor c of `drag_share` for a strumming cable, and the strumming factor f.

    f is the normal drag divided by the normal drag without strumming. c [N/(m/s)] is the smallest
    root of c |A + c V| = k f |V × A|, where f applies to the axis A + c V.

    Parameters
    ----------
    k : half the normal drag factor without strumming [N/(m/s)²]
    vibration : strumming law; f is at least 1, and decreases as the angle between axis and current
        grows
    """
    speed = sqrt(vx * vx + vy * vy + vz * vz)
    cx, cy, cz = ay * vz - az * vy, az * vx - ax * vz, ax * vy - ay * vx
    across = sqrt(cx * cx + cy * cy + cz * cz)
    if k == 0.0 or across == 0.0:
        return 0.0, 1.0
    flat = across / speed
    c, above = drag_share(ax, ay, az, k, vx, vy, vz), inf
    factor = strummed(vibration, _leaning(ax, ay, az, c, vx, vy, vz, flat))
    first = drag_share(ax, ay, az, k * factor, vx, vy, vz)
    # The fixed-point iteration with f(c) rises to the root. Extrapolate the iteration as long as
    # the result stays below the root.
    for _ in range(100):
        factor = strummed(vibration, _leaning(ax, ay, az, first, vx, vy, vz, flat))
        second = drag_share(ax, ay, az, k * factor, vx, vy, vz)
        gain = second - first
        if gain <= 1e-14 * second:
            return second, strummed(vibration, _leaning(ax, ay, az, second, vx, vy, vz, flat))
        ratio = gain / (first - c)
        trial = second + gain * ratio / (1.0 - ratio) if ratio < 1.0 else inf
        if trial >= above:
            trial = 0.5 * (second + above) if above < inf else 2.0 * second
        factor = strummed(vibration, _leaning(ax, ay, az, trial, vx, vy, vz, flat))
        following = drag_share(ax, ay, az, k * factor, vx, vy, vz)
        if following >= trial:
            c, first = trial, following
        else:
            c, first, above = first, second, trial
    return first, strummed(vibration, _leaning(ax, ay, az, first, vx, vy, vz, flat))


def _leaning(
    ax: float, ay: float, az: float, c: float, vx: float, vy: float, vz: float, flat: float
) -> float:
    """Return the sine of the angle between A + c V and V; `flat` is |A × V|/|V|."""
    x, y, z = ax + c * vx, ay + c * vy, az + c * vz
    return min(flat / sqrt(x * x + y * y + z * z), 1.0)


@dataclass(frozen=True)
class BourgetMarichal:
    """Strumming law of a towed cable, by Bourget and Marichal.

    The speed of the ship sets the frequency of the vibration. The local angle φ between cable and
    flow, 0 < φ ≤ π/2 [rad], sets the amplitude.

    Attributes
    ----------
    a1, b1, c1 : coefficients of the amplitude ratio a/D = a1 + b1 φ + c1 φ², with φ in degrees. The
        paper omits the coefficients. The defaults give a/D = 0.5 at 90°, and reproduce the paper's
        example (C* = 1.25 at the sphere, 16.28° at the ship)
    rest : Cn of the cable without strumming, C₀; valid only for φ > 15°
    ceiling : largest allowed C*
    strouhal : Strouhal number for the speed normal to the cable
    """

    a1: float = 1.60185
    b1: float = -0.0231225
    c1: float = 1.20885e-4
    rest: float = 1.2
    ceiling: float = 3.0
    strouhal: float = 0.166

    LEAST_ANGLE = radians(15.0)
    """Smallest angle between cable and flow for which the cable's Cn at rest is valid [rad]."""

    @property
    def greatest(self) -> float:
        """Largest factor by which strumming increases the cable's Cn [-]."""
        return self.ceiling / self.rest

    def amplitude(self, angle: float) -> float:
        """Return the amplitude ratio a/D [-] of a cable at an angle φ to the flow [rad]."""
        return amplitude(self.vibration(0.0), angle)

    def vibration(self, beat: float) -> Vibration:
        """Return the law in the form used by the march, with a given `beat` (see `Vibration`)."""
        return Vibration(self.a1, self.b1, self.c1, self.greatest, beat)

    def frequency(self, speed: float, ship_angle: float, diameter: float) -> float:
        """Return the frequency F = St V₀ sin φ_n/D [Hz], the same along the whole cable.

        Parameters
        ----------
        speed : speed V₀ of the ship through the water [m/s]
        ship_angle : angle φ_n between cable and flow at the ship [rad]
        """
        return self.strouhal * speed * sin(ship_angle) / diameter

    def factor(self, angle: float, beat: float) -> float:
        """Return the drag ratio C*/C₀ of a cable at an angle φ to the flow [rad].

        The ratio is at most `greatest`. The parameter `beat` is as in `Vibration`.
        """
        return strummed(self.vibration(beat), min(sin(angle), 1.0))

    def coefficient(self, angle: float, ship_angle: float) -> float:
        """Return the drag coefficient C* of a cable in a uniform flow of any speed.

        Parameters
        ----------
        angle, ship_angle : local angle φ between cable and flow, and this angle at the ship [rad]
        """
        return self.rest * self.factor(angle, self.strouhal * sin(ship_angle))

    def from_bare_cable(
        self, angle: float, speed: float, diameter: float, weight: float, density: float
    ) -> tuple[float, float]:
        """Return C* and a/D of a towed cable without attachments, from its measured angle.

        C* is the drag coefficient for which drag balances weight: w cos φ = ½ρ D C* (V₀ sin φ)².
        If C* does not exceed C₀, a/D is 0.

        Parameters
        ----------
        angle : angle φ between cable and flow, constant along the cable [rad]
        speed : speed V₀ of the ship through the water [m/s]
        diameter, weight : D [m], and w in water [N/m], of the cable
        density : density of the water [kg/m³]
        """
        coefficient = weight * cos(angle) / (0.5 * density * diameter * (speed * sin(angle)) ** 2)
        return coefficient, _ratio(coefficient / self.rest) / (2.0 * pi * self.strouhal)


def _ratio(factor: float) -> float:
    """Return the speed ratio λ for a given factor f(λ), or 0 if this factor does not exceed 1."""
    if factor <= 1.0:
        return 0.0
    # f is above 1 + ¾ λ² and above 4 λ³/3π
    low, high = 0.0, min(sqrt((factor - 1.0) / 0.75), cbrt(0.75 * pi * factor))
    while True:
        middle = 0.5 * (low + high)
        if not low < middle < high:
            return middle
        if drag_factor(middle) < factor:
            low = middle
        else:
            high = middle
