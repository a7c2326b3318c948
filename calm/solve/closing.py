"""Closing a line: what is unknown, the miss that follows from it, and its root on fixed segments."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from math import degrees, inf, radians

from calm.physics.line import Line, Water
from calm.physics.march import Cuts, End, Profile, Rod, Trace, Track, march
from calm.solve.root import bracketed_root, secant_root
from calm.solve.solution import Settings
from calm.solve.status import Status

COARSE_STEP = radians(4.0)
"""Angle step of the marches that only look for the neighbourhood of a root."""
REACH = 0.01
"""Longest segment at an angle step of 1°, as a share of the water depth."""
NARROWEST_SHARE = 1e-15


@dataclass(frozen=True)
class Unknown:
    """What closes a line: the depth of its free end, or how much of a float's buoyancy is used.

    Attributes
    ----------
    track : the line laid out for the march
    afloat : the piece at the surface whose share of buoyancy is sought; None below the surface
    line : the line with the buoyancies that `track` has
    """

    track: Track
    line: Line
    afloat: int | None = None

    def placed(self, x: float) -> tuple[Track, float]:
        """Track and depth of the free end [m] for the value x of the unknown."""
        if self.afloat is None:
            return self.track, x
        return _with_share(self.track, self.afloat, x), 0.0

    def carried(self, x: float) -> Line:
        """The line with the buoyancies in use for the value x of the unknown."""
        if self.afloat is None:
            return self.line
        share = [x if p == self.afloat else 1.0 for p in range(len(self.line.length))]
        return replace(
            self.line, buoyancy=self.line.buoyancy * share, volume=self.line.volume * share
        )


def _with_share(track: Track, piece: int, share: float) -> Track:
    stages = list(track.stages)
    for i, stage in enumerate(stages):
        if isinstance(stage, Rod) and piece in stage.pieces:
            loads = tuple(
                replace(load, buoyancy=share * load.buoyancy, volume=share * load.volume)
                if load.piece == piece and load.clamp < 0
                else load
                for load in stage.loads
            )
            stages[i] = replace(stage, loads=loads)
    return Track(tuple(stages))


@dataclass(frozen=True)
class Closed:
    """A closed line: the value of its unknown, the slope of the miss there, and its shape."""

    unknown: Unknown
    x: float
    slope: float
    miss: float
    end: End
    trace: Trace


class Closing:
    """The marches of one solve, counted.

    The *miss* is the height of the line's lower end above the anchor's top [m]. It falls as the
    free end goes deeper and as more buoyancy is used.
    """

    def __init__(self, line: Line, water: Water, settings: Settings) -> None:
        self.line, self.water, self.settings = line, water, settings
        self.profile = Profile(water)
        self.goal = -water.depth + line.anchor_height
        self.allowed = settings.tolerance * water.depth
        self.marches = 0

    @property
    def coarse_step(self) -> float:
        return max(COARSE_STEP, 2.0 * self.settings.angle_step)

    def run(
        self,
        unknown: Unknown,
        x: float,
        step: float,
        *,
        profile: Profile | None = None,
        cuts: Cuts | None = None,
        trace: Trace | None = None,
    ) -> End:
        """One march at an angle step, or over given cuts."""
        track, depth = unknown.placed(x)
        self.marches += 1
        return march(
            track,
            profile or self.profile,
            depth,
            angle_step=step,
            reach=REACH * degrees(step) * self.water.depth,
            cuts=cuts,
            trace=trace,
        )

    def coarse_miss(self, unknown: Unknown) -> Callable[[float], float]:
        """The miss as the march sees it at the coarse step."""
        return lambda x: self.run(unknown, x, self.coarse_step).z - self.goal

    def coarse_root(
        self, unknown: Unknown, a: float, miss_a: float, b: float, miss_b: float
    ) -> tuple[float, float]:
        """Root of the coarse miss between a and b, and the slope there."""
        x, _, slope = bracketed_root(
            self.coarse_miss(unknown), a, miss_a, b, miss_b,
            small=1e-4 * self.water.depth, narrow=NARROWEST_SHARE,
        )  # fmt: skip
        return x, slope

    def polish(self, unknown: Unknown, x: float, slope: float, cuts: Cuts) -> Closed:
        """Close the line on fixed segments, from a root found on others.

        Raises
        ------
        NoEquilibrium
            ``slack`` where the shape hangs on the last digits of the buoyancy in use,
            ``not-converged`` where no root is found.
        """
        last: tuple[float, End, Trace] = (inf, End(0, 0, 0, (0, 0, 0), cuts, 0), Trace())

        def miss(x: float) -> float:
            nonlocal last
            trace = Trace()
            end = self.run(unknown, x, self.settings.angle_step, cuts=cuts, trace=trace)
            last = (x, end, trace)
            return end.z - self.goal

        small = 0.1 * self.allowed
        narrow = inf if unknown.afloat is None else 1e-9
        found = secant_root(miss, x, slope, small=small, narrow=narrow)
        x, value, slope = found or self._widening(miss, unknown, x, small)
        if last[0] != x:
            value = miss(x)
        if abs(value) > self.allowed:
            if unknown.afloat is not None:
                raise Status.SLACK.because(
                    "The line is slack: its shape hangs on the last digits of the buoyancy in use."
                )
            raise Status.NOT_CONVERGED.because(
                f"The line's end misses the anchor by {abs(value):.3g} m."
            )
        return Closed(unknown, x, slope, value, last[1], last[2])

    def _widening(
        self, miss: Callable[[float], float], unknown: Unknown, x: float, small: float
    ) -> tuple[float, float, float]:
        """Root within an ever wider bracket around x."""
        afloat = unknown.afloat is not None
        limit = 1.0 if afloat else self.water.depth
        x = min(max(x, 0.0), limit)
        value, width = miss(x), 1e-5 * limit
        while width < 16.0 * limit:
            other = min(max(x + (width if value > 0.0 else -width), 0.0), limit)
            opposite = miss(other)
            if (opposite > 0.0) != (value > 0.0):
                narrow = NARROWEST_SHARE * limit
                return bracketed_root(miss, x, value, other, opposite, small=small, narrow=narrow)
            width *= 16.0
        raise Status.NOT_CONVERGED.because("No closed shape was found near the first estimate.")
