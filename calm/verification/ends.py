"""What published cases print of a line: where its free end is and what its other end holds."""

from __future__ import annotations

from dataclasses import dataclass
from math import atan2, degrees, hypot, radians

from calm.physics.line import Line, Water
from calm.solve import Settings, Solution, Towing, solve_mooring, solve_tow

FINE = Settings(radians(0.1), tolerance=1e-9)
"""For figures of seven digits: the march errs by some 4e-8 of the length at this angle step."""


@dataclass(frozen=True)
class Ends:
    """Free end and lower end of a line in an eastward current.

    Attributes
    ----------
    x, z : the free end downstream of the lower end and above it [m]
    horizontal, vertical : the pull at the lower end, downstream and up [N]
    """

    x: float
    z: float
    horizontal: float
    vertical: float

    @property
    def tension(self) -> float:
        """At the lower end [N]."""
        return hypot(self.horizontal, self.vertical)

    @property
    def lean(self) -> float:
        """Angle of the pull at the lower end from the vertical [degrees]."""
        return degrees(atan2(self.horizontal, self.vertical))


def ends_of(solution: Solution) -> Ends:
    """The ends of a solved line."""
    x, _, z = (solution.position[0] - solution.position[-1]).tolist()
    horizontal, _, vertical = solution.force[-1].tolist()
    return Ends(x, z, horizontal, vertical)


def finely(line: Line, water: Water) -> Ends:
    """The ends of a line, solved at `FINE`."""
    return ends_of(solve_mooring(line, water, FINE))


@dataclass(frozen=True)
class Wake:
    """A line towed to the east through still water.

    Attributes
    ----------
    aft, depth : of the free end behind and below the tow point [m]
    tension : at the tow point [N]
    angle : of the line at the tow point from the horizontal [degrees]
    frequency : of the cables that strum [Hz]
    """

    aft: float
    depth: float
    tension: float
    angle: float
    frequency: float


def towed(line: Line, water: Water, speed: float, settings: Settings = FINE) -> Wake:
    """The wake of a line, listed from the ship, towed at a speed [m/s]; at `FINE` by default."""
    solution = solve_tow(line, water, Towing(speed, 0.0), settings)
    x, _, z = solution.position[0].tolist()
    back, _, down = solution.force[-1].tolist()
    return Wake(-x, -z, hypot(back, down), degrees(atan2(-down, -back)), solution.frequency)
