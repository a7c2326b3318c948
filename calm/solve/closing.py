"""Closing a line: what is unknown, the miss that follows, and its root on fixed segments."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property
from math import degrees, radians

import numpy as np

from calm.physics import pace
from calm.physics.line import Floats, Line, Water
from calm.physics.march import Cuts, End, march
from calm.physics.profile import Profile
from calm.physics.seabed import lie_down
from calm.physics.state import Trace
from calm.physics.track import Cable, Track
from calm.solve.root import bracketed_root, root_near
from calm.solve.solution import Settings
from calm.solve.standing import standing_lift
from calm.solve.status import Status
from calm.solve.unknown import Afloat, Unknown

AS_MANY = 8
"""Pieces and clamps of which a line's solve takes as long as one of an ordinary mooring."""
COARSE_STEP = radians(4.0)
"""Angle step of the marches that only look for the neighbourhood of a root."""
REACH = 0.01
"""Longest segment at an angle step of 1°, as a share of the span."""
NEARLY_LINEAR = 5e-3
"""Miss, as a share of the span, below which a secant through a far larger one finds the root."""
SHARE_TOLERANCE = 1e-9
"""How well the share of a surface float's buoyancy in use is found."""
COARSEST_BRACKET = 1e-7
NARROWEST_BRACKET = 1e-15
"""Width of the last bracket, as a share of the whole range: of a march that chooses its cuts, and
on fixed ones."""


@dataclass(frozen=True)
class Root:
    """Where a line closes: its unknown, the value of it, and the slope of the miss there."""

    unknown: Unknown
    x: float
    slope: float


@dataclass(frozen=True)
class Closed:
    """A closed line: its root, what is left of the miss [m], and its shape.

    `hanging` counts the elements above the touchdown, all of them where there is none;
    `grounded_length` is what lies below it, unstretched [m].
    """

    root: Root
    miss: float
    end: End
    hanging: int
    grounded_length: float

    @property
    def trace(self) -> Trace:
        return self.end.trace


class Closing:
    """The marches of one solve; those of the whole line are counted.

    The *miss* is the height of the line's last end above where it is to be [m]: the top of its
    anchor, or the ship that tows it. It falls as the free end goes deeper and as more buoyancy is
    used.

    Attributes
    ----------
    span : what lengths are measured by: the water depth, in a tow the line out [m]
    allowed : the greatest miss of a solution [m]
    floats : the rigid buoyant pieces, those that may lie at the surface
    frequency : of the cables that strum [Hz]
    marches : done so far
    """

    def __init__(self, line: Line, water: Water, settings: Settings) -> None:
        self.line, self.water, self.settings = line, water, settings
        self.profile = Profile(water)
        self.span = float(line.length.sum()) if line.towed else water.depth
        self.allowed = settings.tolerance * self.span
        self.floats = np.flatnonzero(~line.flexible & (line.buoyancy > 0.0)).tolist()
        self.frequency = 0.0
        self.marches = 0
        pace.expect((len(line.length) + len(line.clamp_piece)) / AS_MANY)

    @cached_property
    def track(self) -> Track:
        """The whole line, of which nothing strums."""
        return Track.of(self.line)

    def whole(self, lands: bool) -> Unknown:
        """The whole line with its free end below the surface; `lands`: as in `Unknown`.

        A line on the seabed ends there, not at the top of its anchor.
        """
        height = 0.0 if lands else self.line.anchor_height
        return Unknown(
            self.track,
            height - self.water.depth,
            lands=lands,
            floating=self.line.floating,
        )

    def towed(self, height: float) -> Unknown:
        """The whole line towed from a height above the surface [m]."""
        return Unknown(Track.of(self.line, self.frequency), height)

    def clear_of_seabed(self, root: Root) -> Root:
        """The same root for the line hanging clear of the seabed, to be sought again from there."""
        goal = self.line.anchor_height - self.water.depth
        return replace(root, unknown=replace(root.unknown, goal=goal, lands=False))

    @cached_property
    def lift(self) -> Floats:
        """`standing_lift` of the line."""
        return standing_lift(self.line, self.water)

    @property
    def at_rest(self) -> bool:
        """Whether neither water nor wind moves."""
        floating = self.line.floating
        return not (self.water.moving or (floating is not None and floating.blown))

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
        record: bool = False,
    ) -> End:
        """One march at an angle step, or over given cuts."""
        depth, out, afloat = unknown.placed(x, self.water.gravity)
        self.marches += not unknown.part
        return march(
            unknown.track,
            profile or self.profile,
            depth,
            angle_step=step,
            reach=REACH * degrees(step) * self.span,
            cuts=cuts,
            record=record,
            lands=unknown.lands,
            out=out,
            afloat=afloat,
        )

    def coarse_miss(self, unknown: Unknown) -> Callable[[float], float]:
        """The miss as the march sees it at the coarse step."""
        return lambda x: self.run(unknown, x, self.coarse_step).z - unknown.goal

    def coarse_root(
        self, unknown: Unknown, a: float, miss_a: float, b: float, miss_b: float
    ) -> Root:
        """Root of the coarse miss between a and b, to about 1e-4 of the span."""
        small, linear = 1e-4 * self.span, unknown.afloat is None
        if linear:  # below the surface the miss all but is, so that the last step needs no march
            small = max(small, 0.2 * max(abs(miss_a), abs(miss_b)))
        x, miss, slope = bracketed_root(
            self.coarse_miss(unknown), a, miss_a, b, miss_b,
            small=min(small, NEARLY_LINEAR * self.span),
            narrow=COARSEST_BRACKET * abs(b - a),
        )  # fmt: skip
        return Root(unknown, x - miss / slope if linear and slope else x, slope)

    def coarser(self, root: Root) -> Root:
        """The coarse root near another one; that one where there is none."""
        small = 1e-4 * self.span
        found, *_ = self._near(root, self.coarse_step, None, small, COARSEST_BRACKET, record=False)
        return found or root

    def planned(self, root: Root, step: float) -> tuple[Root, Cuts]:
        """The root as the march sees it at a step, near a coarser one, and the cuts it takes there.

        With its free choice of cuts the march is not quite continuous, so this is no solution yet.
        On the cuts it took last it is: the root is a last step away, which the caller marches.
        """
        small = 1e-6 * self.span
        found, miss, end = self._near(root, step, None, small, COARSEST_BRACKET, record=False)
        if found is None:
            return root, end.cuts
        if found.slope < 0.0:
            found = replace(found, x=found.x - miss / found.slope)
        return found, end.cuts

    def polish(self, root: Root, cuts: Cuts) -> Closed:
        """Close the line on fixed segments, from a root found on others.

        Floats at the surface above the one in question are first brought back to the surface.

        Raises
        ------
        NoEquilibrium
            ``slack`` where the shape hangs on the last digits of the buoyancy in use,
            ``not-converged`` where no root is found.
        """
        unknown = self._resurfaced(root.unknown, cuts)
        return self._closed(replace(root, unknown=unknown), cuts)

    def _resurfaced(self, unknown: Unknown, cuts: Cuts) -> Unknown:
        above: tuple[Afloat, ...] = ()
        at_surface = list(unknown.shares(0.0))
        for afloat, lower in zip(unknown.above, at_surface[1:], strict=False):
            part = replace(unknown, afloat=afloat.piece, above=above).down_to(lower)
            cables = sum(isinstance(stage, Cable) for stage in part.track.stages)
            root = self._closed(Root(part, afloat.share, afloat.slope), cuts.first(cables)).root
            above = (*above, Afloat(afloat.piece, root.x, root.slope))
        return replace(unknown, above=above)

    def _closed(self, root: Root, cuts: Cuts) -> Closed:
        small = 0.1 * self.allowed
        if root.unknown.afloat is not None:
            small = min(small, SHARE_TOLERANCE * abs(root.slope))
        step = self.settings.angle_step
        found, miss, end = self._near(root, step, cuts, small, NARROWEST_BRACKET)
        if found is None:
            raise Status.NOT_CONVERGED.because("No closed shape was found near the first one.")
        if abs(miss) > self.allowed:
            if found.unknown.afloat is not None:
                raise Status.SLACK.because(
                    "The line is slack: its shape hangs on the last digits of the buoyancy in use."
                )
            end_point = "ship" if self.line.towed else "anchor"
            raise Status.NOT_CONVERGED.because(
                f"The line's end misses the {end_point} by {abs(miss):.3g} m."
            )
        hanging, grounded = end.nodes - 1, 0.0
        if end.landed:
            unknown, friction = found.unknown, self.settings.seabed_friction
            end, grounded = lie_down(unknown.track, self.profile, end, unknown.goal, friction)
        return Closed(found, miss, end, hanging, grounded)

    def _near(
        self,
        root: Root,
        step: float,
        cuts: Cuts | None,
        small: float,
        narrow: float,
        *,
        record: bool = True,
    ) -> tuple[Root | None, float, End]:
        """Root near another one, across the surface if need be, its miss and its march.

        Where there is none, the miss and march are those of the last try. `narrow` is the width
        of the last bracket as a share of the whole range; `record` keeps the trace of the march.
        """
        tried: dict[float, tuple[float, End]] = {}
        start: Root | None = root

        def miss(x: float) -> float:
            assert start is not None
            end = self.run(start.unknown, x, step, cuts=cuts, record=record)
            tried.clear()
            tried[x] = end.z - start.unknown.goal, end
            return tried[x][0]

        while start is not None:
            low, high = self._limits(start.unknown)
            found = root_near(
                miss, start.x, start.slope, (low, high), small=small, narrow=narrow * high
            )
            if found is not None:
                x, _, slope = found
                if x not in tried:
                    miss(x)
                return Root(start.unknown, x, slope), *tried[x]
            start = self._across_the_surface(root.unknown) if start is root else None
        return None, *next(iter(tried.values()))

    def _limits(self, unknown: Unknown) -> tuple[float, float]:
        """Between what the unknown is sought."""
        if unknown.afloat is not None:
            return 0.0, 1.0
        return (-2.0 * self.span, 2.0 * self.span) if self.line.towed else (0.0, self.span)

    def _across_the_surface(self, unknown: Unknown) -> Root | None:
        """Where to seek on when a free end just below the surface should float, or the reverse."""
        if unknown.above or unknown.part or self.line.towed:
            return None
        if unknown.afloat is not None:
            return Root(replace(unknown, afloat=None), 0.0, -1.0)
        if not self.floats:
            return None
        return Root(replace(unknown, afloat=self.floats[0]), 1.0, -0.01 * self.water.depth)
