"""Strumming: how fast a line in a current vibrates, how far, and by how much that raises its Cn.

Amplitudes A are single and relative to the diameter, A/D [-]; angles are in radians. A long line
has a mode near every frequency, so it is taken to strum wherever it sheds vortices: in a sheared
current, with attachments or fairing, it strums less, and these factors are the upper end.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from math import asin, cbrt, cos, inf, pi, pow, radians, sin, sqrt
from types import MappingProxyType
from typing import NamedTuple

from calm.physics.drag import drag_share

STROUHAL = 0.2
"""Strouhal number for static work, whatever the Reynolds number."""

STRUCTURAL_DAMPING = 0.005
"""Damping ratio where none is measured: what DNV-RP-F105 takes for pipes free of concrete."""

CABLE_MODE = 1.155
"""Mode factor γ of a taut line, √(4/3): its crests move more than a rigid cylinder would; 1.0."""

_BLEVINS_CAP = 1.0


def shedding_frequency(speed: float, diameter: float, strouhal: float = STROUHAL) -> float:
    """Frequency St |Vn|/D [Hz] at which vortices leave a line of a diameter [m].

    Parameters
    ----------
    speed : |Vn|, of the current across the line [m/s]
    """
    return strouhal * speed / diameter


def reduced_damping(
    mass: float, diameter: float, density: float, damping: float, strouhal: float = STROUHAL
) -> float:
    """Reduced damping S_G = 8π² St² m ζ/(ρ D²) [-].

    Parameters
    ----------
    mass : of a metre of line [kg/m]
    diameter : [m]
    density : of the water [kg/m³]
    damping : ζ, structural damping over critical [-]
    """
    return 8.0 * pi**2 * strouhal**2 * mass * damping / (density * diameter**2)


def griffin_skop(damping: float, mode: float = CABLE_MODE) -> float:
    """A/D at resonance from the reduced damping S_G: 0.645 γ/(1 + 0.43 S_G)^3.35.

    Source: Griffin, Skop & Ramberg (1975), Offshore Technology Conference, paper 2319, who give
    the double amplitude, 1.29 γ.
    """
    return 0.645 * mode * pow(1.0 + 0.43 * damping, -3.35)


def line_amplitude(
    mass: float, diameter: float, density: float, damping: float = STRUCTURAL_DAMPING
) -> float:
    """A/D of a mooring line that strums: `griffin_skop` in the mode of a cable.

    Parameters
    ----------
    mass : of a metre of line [kg/m]
    diameter : [m]
    density : of the water [kg/m³]
    damping : ζ, structural damping over critical [-]

    The current does not enter: whatever its speed, some mode of a long line answers. Ropes and
    wires in water come out between 0.68 and 0.74.
    """
    return griffin_skop(reduced_damping(mass, diameter, density, damping))


def vandiver(amplitude: float) -> float:
    """Cn of a line that strums over Cn at rest: 1 + 1.043 (2 Y_rms/D)^0.65, Y_rms = A/√2.

    Source: Vandiver (1983), Offshore Technology Conference, paper 4490.
    """
    return 1.0 + 1.043 * pow(sqrt(2.0) * amplitude, 0.65)


def blevins(amplitude: float) -> float:
    """Cn of a line that strums over Cn at rest: 1 + 2.1 A/D, held beyond A/D = 1.

    Beyond, the straight line runs away from what cables were measured to do: Cn of 2.4 to 3.2,
    2.0 to 2.7 times that at rest (Griffin et al. 1984).

    Source: Blevins (1990), Flow-Induced Vibration, second edition.
    """
    return 1.0 + 2.1 * min(amplitude, _BLEVINS_CAP)


def skop_griffin(amplitude: float) -> float:
    """Cn of a line that strums over Cn at rest: 1 + 1.16 (w_r - 1)^0.65, w_r = 1 + 2 A/D.

    Source: Skop, Griffin & Ramberg (1977), Offshore Technology Conference, paper 2884, at
    resonance, where the reduced speed times the Strouhal number is 1.
    """
    return 1.0 + 1.16 * pow(2.0 * amplitude, 0.65)


AMPLIFICATIONS: Mapping[str, Callable[[float], float]] = MappingProxyType(
    {"vandiver": vandiver, "blevins": blevins, "skop-griffin": skop_griffin}
)
"""The factor on Cn from A/D, by the name a mooring file gives it."""


def drag_factor(ratio: float) -> float:
    """Drag of a cylinder that vibrates over drag at rest, as Bourget & Marichal equate power.

    Parameters
    ----------
    ratio : λ, greatest speed of the vibration over the speed of the current across the line [-]

    f(λ) = (1/π) ∫₀^π (1 + λ² cos²θ)^{3/2} dθ = (2/3π) √(1 + λ²) [2 (2 + λ²) E(m) - K(m)],
    m = λ²/(1 + λ²), by arithmetic-geometric means. (The paper prints 2/π, which would give
    f(0) = 2.)
    """
    square = ratio * ratio
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
    """Tell how a cable strums: the law of Bourget & Marichal as the march takes it.

    Attributes
    ----------
    a1, b1, c1 : a/D = a1 + b1 φ + c1 φ², φ in degrees
    greatest : factor on the cable's Cn at rest [-]
    beat : F D/|V|, the frequency of the cable made dimensionless with its diameter and the speed
        there; 0.166 sin φ_n in an even flow, whatever its speed [-]. Of a line it is F [Hz], and
        of one of its cables F D [m/s]
    """

    a1: float
    b1: float
    c1: float
    greatest: float
    beat: float


AT_REST = Vibration(0.0, 0.0, 0.0, 1.0, 0.0)
"""Of a line that does not strum."""


def with_beat(vibration: Vibration, beat: float) -> Vibration:
    """The same law of vibration at another beat."""
    a1, b1, c1, greatest, _ = vibration
    return Vibration(a1, b1, c1, greatest, beat)


def amplitude(vibration: Vibration, angle: float) -> float:
    """a/D [-] where the cable is at an angle φ to the flow [rad]."""
    phi = angle * (180.0 / pi)
    return vibration.a1 + (vibration.b1 + vibration.c1 * phi) * phi


def strummed(vibration: Vibration, across: float) -> float:
    """C*/C₀ = f(λ), at most the greatest, by the sine of the angle φ of the cable to the flow.

    λ = 2π (a/D) F D/(|V| sin φ). Along the flow the factor is the greatest.
    """
    return min(strummed_freely(vibration, across), vibration.greatest)


def strummed_freely(vibration: Vibration, across: float) -> float:
    """f(λ) as it would be without the greatest factor, at most twice that."""
    if vibration.beat == 0.0:
        return 1.0
    if across <= 0.0:
        return 2.0 * vibration.greatest
    ratio = 2.0 * pi * amplitude(vibration, asin(across)) * vibration.beat / across
    return min(drag_factor(ratio), 2.0 * vibration.greatest)


def amplified_share(
    ax: float, ay: float, az: float, k: float, vibration: Vibration, vx: float, vy: float, vz: float
) -> tuple[float, float]:
    """`drag_share` of a cable that strums, whose coefficient grows as it leans: k f(sin φ).

    Parameters
    ----------
    k : half its normal drag coefficient at rest [N/(m/s)²]
    vibration : by which `strummed` gives f ≥ 1, falling with the sine of the angle φ between axis
        and current

    Returns
    -------
    c [N/(m/s)], the smallest root of c |A + c V| = k f |V × A|, and f there. Putting f(c) back
    climbs to it from below and never past it; the climb is extrapolated as long as that stays
    below, too.
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
    """Sine of the angle between A + c V and V, from |A × V|/|V|."""
    x, y, z = ax + c * vx, ay + c * vy, az + c * vz
    return min(flat / sqrt(x * x + y * y + z * z), 1.0)


@dataclass(frozen=True)
class BourgetMarichal:
    """Strumming of a towed cable: the frequency is set at the ship, the amplitude by the angle.

    Attributes
    ----------
    a1, b1, c1 : a/D = a1 + b1 φ + c1 φ², φ in degrees. The paper does not print them; the
        defaults meet its own figures (a/D = 0.5 at 90°; in its example C* = 1.25 at the sphere
        and 16.28° at the ship).
    rest : C₀, the cable's Cn at rest; claimed for φ > 15° only
    ceiling : the greatest C* allowed
    strouhal : of the cable, on the speed across it

    Angles φ are between cable and flow, above 0 and up to π/2 [rad].
    """

    a1: float = 1.60185
    b1: float = -0.0231225
    c1: float = 1.20885e-4
    rest: float = 1.2
    ceiling: float = 3.0
    strouhal: float = 0.166

    LEAST_ANGLE = radians(15.0)
    """Below this angle the cable's Cn at rest is not claimed."""

    @property
    def greatest(self) -> float:
        """The greatest factor on the cable's Cn at rest [-]."""
        return self.ceiling / self.rest

    def amplitude(self, angle: float) -> float:
        """a/D [-] where the cable is at an angle φ to the flow [rad]."""
        return amplitude(self.vibration(0.0), angle)

    def vibration(self, beat: float) -> Vibration:
        """The law at a beat: see `Vibration`."""
        return Vibration(self.a1, self.b1, self.c1, self.greatest, beat)

    def frequency(self, speed: float, ship_angle: float, diameter: float) -> float:
        """Frequency F = 0.166 V₀ sin φ_n/D [Hz] of the whole cable of a diameter [m].

        Parameters
        ----------
        speed : V₀, of the ship through the water [m/s]
        ship_angle : φ_n, between cable and flow at the ship [rad]
        """
        return self.strouhal * speed * sin(ship_angle) / diameter

    def factor(self, angle: float, beat: float) -> float:
        """C*/C₀, at most 3.0/C₀, where the cable is at an angle φ to the flow [rad].

        `beat` : see `Vibration`.
        """
        return strummed(self.vibration(beat), min(sin(angle), 1.0))

    def coefficient(self, angle: float, ship_angle: float) -> float:
        """C* of a cable at an angle φ in an even flow, the same at every speed.

        Parameters
        ----------
        angle, ship_angle : φ, there and at the ship [rad]
        """
        return self.rest * self.factor(angle, self.strouhal * sin(ship_angle))

    def from_bare_cable(
        self, angle: float, speed: float, diameter: float, weight: float, density: float
    ) -> tuple[float, float]:
        """C* and a/D of a bare cable from the angle at which it tows.

        Parameters
        ----------
        angle : φ measured, the same all along [rad]
        speed : V₀ of the ship [m/s]
        diameter : [m]
        weight : of a metre in water [N/m]
        density : of the water [kg/m³]

        Returns
        -------
        C* for which the drag across the cable holds its weight, w cos φ = ½ρ D C* (V₀ sin φ)²,
        and the a/D that explains it; 0 where C* is not above C₀.
        """
        coefficient = weight * cos(angle) / (0.5 * density * diameter * (speed * sin(angle)) ** 2)
        return coefficient, _ratio(coefficient / self.rest) / (2.0 * pi * self.strouhal)


def _ratio(factor: float) -> float:
    """λ for which f(λ) is a factor; 0 where it is not above 1."""
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
