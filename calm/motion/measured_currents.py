"""Smoother for records with measured currents, to estimate currents, line, sensors and tide.

The unknowns at each time are

- the current at several depths (interpolation knots);
- the relative error in the knockdown of each stretch of the line;
- the tide.

The unknowns of the whole record are drag factors, a depth error common to all sensors (the datum),
and sensor offsets. The datum and the positions of the sensors on the line may change in rare steps.
Most priors are normal distributions. Student's t distributions are used for the errors of meters
and sensors, for the datum and the sensor positions, and for the steps of both.

The method is a Kalman smoother with Gauss-Newton steps over the whole record. Expectation and
maximisation (Dempster, Laird and Rubin 1977) estimate the meter error for each quality flag.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from itertools import pairwise
from typing import Any

import numpy as np
from numpy.typing import NDArray

from calm.case import Design
from calm.motion import common_unknowns, line_response
from calm.motion.common_unknowns import OFFSET, Common, LinearLaw
from calm.motion.currents_law import Linear, ReadCurrents
from calm.motion.line_response import Forward
from calm.motion.measurements import FREE, MooringMeasurements, chosen_times, nearest
from calm.motion.smoother import BLOCK, StateSpace, smoothed
from calm.physics.line import Floats

TURNS, ENOUGH = 20, 0.05  # maximum number of steps, and change in depth that ends them [m]
PLACED = (1, 3, 5, 8, 11)  # steps after which the factors are updated
# step in the logarithm of a factor for its slopes, which are renewed after a larger change
FACTOR_STEP = 0.05
STALE = 0.03  # change in a current above which its slopes are renewed [m/s]
LONGEST = 0.5  # maximum change in a current in one step [m/s]

MOST_LEVELS, KNOTS = 8, 12  # maximum number of levels that are all knots, and knots for more levels
APART = 2.0  # distance below which levels share a knot [m]
ABOVE = 5.0  # height of a knot above the top of the line, if the top is above all levels [m]
BELOW = 20.0  # distance from lowest level to seabed above which a knot is added half-way [m]

# error of a current meter: constant part [m/s] and share of the speed; `FLAGGED` multiplies both
METER = 0.02, 0.10
# default factors on the meter error, by quality flag
FLAGGED: Mapping[int, float] = {0: 1.0, 1: 1.0, 2: 1.5, 3: 2.0, 4: 4.0, 8: 3.0}
# limits of the estimated factor on the meter error: the current at even a perfect meter differs
# from the current on the line around it
FLAG_RANGE = (0.6, 15.0)
FEWEST = 20  # least number of readings to estimate a factor on the meter error
STUDENT = 4.0  # degrees of freedom of Student's t distribution of the readings
ALIKE_HOURS = 1.0  # time over which the error of a meter persists [h]
LEAST_SPREAD = 0.02  # least deviation of a current about its mean [m/s]
CURRENT_HOURS = 16.0  # initial correlation time of the current [h]
CURRENT_REACH = 600.0  # correlation depth of the current [m]
HOURS = (4.0, 16.0)  # limits of the estimated correlation time [h]; a longer one would damp tides
# factor on the prior deviation of the currents for the estimate of the drag: smoothing would damp
# the strongest currents, and so raise the drag
WIDER = 2.0
METERS_ALIKE = 0.02  # error common to all meters of a record, as a share of the speed

STRETCHES = 10  # number of stretches with separate errors in knockdown
SPAN = 0.4  # correlation length of the errors of the stretches, as a share of the line
SHARE, SHARES = 0.07, (0.01, 0.4)  # prior and limits of the error share of a stretch
# prior deviations of the logarithm of the error share: common to all stretches, and of each
ALL_SHARES, EACH_SHARE = 1.0, 0.7
# correlation length of the deviations of single stretches, as a share of the line
SHARE_REACH = 0.5
SHARE_STEP = 0.4  # maximum change in the logarithm of an error share in one step
LINE_HOURS = 3.0  # correlation time of the error of a stretch [h]
TIDE_HOURS = 2.4  # time in which the correlation of a semidiurnal tide falls to 1/e [h]
# typical hourly step of datum and places [m]; the steps have Student's t distribution with one
# degree of freedom, which allows rare steps that are many times as large
STEP = 0.02
# weight 1 / (1 + n) of the square of an unknown in its variance, for n degrees of freedom. The
# prior deviation of a place is 2 cm. The variance of a place begins at 1 m², and shrinks unless the
# place exceeds four standard deviations of the error of its estimate
TAILS = {"datum": 1.0 / 2.0, "place": 1.0 / 5.0}
ZEROS = 2.0  # ratio of the variance of Student's law, with four degrees of freedom, to a normal law
SETTLED = 6  # iterations before the line error is estimated; it would otherwise absorb sensor steps
FURTHEST = 0.7  # maximum logarithm of a factor


@dataclass(frozen=True)
class Knots:
    """Depths (knots) of the estimated current, and interpolation weights for the levels."""

    depth: Floats  # (K,) depths of the knots in still water, increasing [m]
    level: Floats  # (k, K) weights with which the knots contribute to the current at each level
    # indices of the levels that coincide with a knot, and the indices of these knots
    measured: tuple[NDArray[np.int64], NDArray[np.int64]]
    seabed: float  # depth of the water [m]

    def at(self, levels: Floats) -> Floats:
        """Return depths (n, K) of the knots, which move with the levels (n, k) [m]."""
        level, knot = self.measured
        place = np.append(self.depth[knot], self.seabed)
        off = np.pad(levels[:, level] - self.depth[knot], ((0, 0), (0, 1)))
        after = np.clip(np.searchsorted(place, self.depth), 1, len(place) - 1)
        share = (self.depth - place[after - 1]) / np.maximum(place[after] - place[after - 1], 1e-9)
        share = np.clip(share, 0.0, 1.0)
        there = self.depth + (1.0 - share) * off[:, after - 1] + share * off[:, after]
        apart = 1e-3 * np.arange(len(self.depth))
        rising: Floats = np.maximum.accumulate(np.maximum(there, 0.1) + apart, axis=1)
        return rising


def knots_of(place: Floats, top: float, seabed: float) -> Knots:
    """Choose interpolation knots for measured levels with still-water depths `place` (k,) [m].

    If there are few levels, each is a knot. One knot may be added above the top of the line, and
    one below the lowest level.
    """
    order = np.argsort(place, kind="stable")
    chosen: list[int] = []
    for i in order.tolist():
        if not chosen or place[i] - place[chosen[-1]] > APART:
            chosen.append(i)
    if len(chosen) > MOST_LEVELS:
        few = np.unique(np.linspace(0, len(chosen) - 1, KNOTS).round().astype(np.int64))
        chosen = [chosen[i] for i in few.tolist()]
    own = place[chosen]
    ends = [max(top - ABOVE, 1.0)] * bool(own[0] - top > 0.0)
    ends += [0.5 * (own[-1] + seabed)] * bool(seabed - own[-1] > BELOW)
    depth = np.unique(np.concatenate([own, ends]))
    weights = np.stack([np.interp(place, depth, one) for one in np.eye(len(depth))], axis=1)
    return Knots(depth, weights, (np.array(chosen), np.searchsorted(depth, own)), seabed)


@dataclass(frozen=True)
class Columns:
    """Slices of the state vector, one for each kind of unknown.

    The order is: currents at the knots; errors of the stretches of the line; tide; logarithms of
    the factors; datum; zeros of the sensors; positions of the sensors on the line.
    """

    current: slice
    share: slice
    tide: slice
    factor: slice
    datum: slice
    zero: slice
    place: slice

    @classmethod
    def made(cls, *counts: int) -> Columns:
        """Return consecutive slices with the given numbers of columns, in attribute order."""
        ends = np.cumsum([0, *counts]).tolist()
        return cls(*(slice(*pair) for pair in pairwise(ends)))

    @property
    def count(self) -> int:
        """Number of unknowns."""
        return int(self.place.stop)

    @property
    def stays(self) -> slice:
        """Columns of unknowns that are constant or change in steps: datum, zeros, positions."""
        return slice(self.datum.start, self.place.stop)


@dataclass(frozen=True)
class ErrorScales:
    """Sizes and correlation time of the errors, estimated from the record."""

    flag: Mapping[int, float]  # factor on the error of a current meter, by quality flag
    share: Floats  # (z,) error of each stretch of the line, as a share of its own knockdown
    tide: float = common_unknowns.TIDE  # standard deviation of the tide [m]
    hours: float = CURRENT_HOURS  # correlation time of the current [h]


def share_score(mean: Floats, covariance: Floats, alike: Floats) -> tuple[Floats, Floats]:
    """Return the score and the Fisher information of the logarithms of the error shares.

    `mean` (n, z) and `covariance` (n, z, z) are those of the errors of z stretches of the line at n
    times, relative to the shares; `alike` (z, z) is their prior correlation. The score (z,) and the
    information (z, z) are sums over the times.
    """
    inverse = np.linalg.inv(alike)
    left = alike - covariance
    known = inverse @ left
    score = (mean @ inverse * mean).sum(axis=0) - known.diagonal(axis1=1, axis2=2).sum(axis=0)
    information = known * known.transpose(0, 2, 1) + (known @ inverse) * left
    return score, information.sum(axis=0)


def next_shares(shares: Floats, score: Floats, information: Floats, number: float) -> Floats:
    """Improve the error shares (z,) of z stretches of the line by one step of Fisher scoring.

    The error share of a stretch is its standard error divided by its knockdown. `score` and
    `information` are those of `share_score`, averaged over the times of a record that has as much
    information as `number` independent times.
    """
    place = np.arange(len(shares)) / len(shares)
    near = np.exp(-np.abs(place[:, None] - place) / SHARE_REACH)
    prior = np.linalg.inv(ALL_SHARES**2 + EACH_SHARE**2 * near) / number
    step = np.linalg.solve(information + prior, score - prior @ np.log(shares / SHARE))
    step *= SHARE_STEP / max(float(np.abs(step).max()), SHARE_STEP)
    return np.asarray(np.clip(shares * np.exp(step), *SHARES), np.float64)


class CurrentSmoother:
    """Joint estimate of currents, line errors, sensor errors and tide over a whole record."""

    def __init__(
        self, mooring: Design, measured: MooringMeasurements, names: Sequence[str]
    ) -> None:
        self.mooring, self.measured, self.names = mooring, measured, tuple(names)
        self.still = Forward(mooring, {}).still
        self.seabed = float(mooring.water.depth)
        one = measured
        self.places = place = np.array([
            self.still[point] if point != FREE else np.nanmean(one.level_depth[:, k])
            for k, point in enumerate(one.level_point.tolist())
        ])  # fmt: skip
        self.hours = (one.time - one.time[:1]) / np.timedelta64(1, "h")
        self.knots = knots_of(place, float(self.still.min()), self.seabed)
        count, sensors = len(self.knots.depth), len(one.label)
        self.columns = Columns.made(2 * count, STRETCHES, 1, len(self.names), 1, sensors, sensors)
        flow = np.stack([one.u, one.v])
        self.mean = np.concatenate([self._along(place, np.nanmean(each, axis=0)) for each in flow])
        spread = np.sqrt(0.5 * np.nanvar(flow, axis=1).sum(axis=0))
        self.spread = np.maximum(self._along(place, spread), LEAST_SPREAD)
        flags = np.unique(one.flag[np.isfinite(one.u)])
        by_flag = {f: FLAGGED.get(f, FLAGGED[4]) for f in flags.tolist()}
        self.scales = ErrorScales(by_flag, np.full(STRETCHES, SHARE), tide=one.tide_deviation)
        self.levels = np.where(np.isfinite(one.level_depth), one.level_depth, place)
        self.knot_depth = self.knots.at(self.levels)
        self.state = np.zeros((len(one.time), self.columns.count))
        self.state[:, self.columns.current] = self._measured_state(place)
        self.meter_weight = np.ones(one.u.shape)
        self.sensor_weight = np.ones(one.depth.shape)
        factors, datum = dict.fromkeys(self.names, 1.0), common_unknowns.DATUM * self.seabed
        prior = common_unknowns.common_beforehand(factors, datum, sensors).covariance
        self.common_covariance: Floats = prior
        self.factor_prior, begin = np.split(prior.diagonal(), [len(factors)])
        wide = np.repeat([1.0, ZEROS], [1, sensors])
        self.begin = np.append(wide * begin, np.full(sensors, STEP**2))
        self.first = self.begin
        self.tail = np.repeat([TAILS["datum"], 0.0, TAILS["place"]], [1, sensors, sensors])
        self.factor = np.zeros(len(self.names))
        step = np.diff(self.hours, prepend=self.hours[:1])
        steps = np.repeat([1.0, 0.0, 1.0], [1, sensors, sensors])  # zeros are constant
        self.usual = STEP**2 * step[:, None] * steps
        self._forwards: dict[tuple[float, ...], Forward] = {}
        self.bend = np.zeros((len(one.time), len(self.still)))
        self.depth: Floats = np.full(self.bend.shape, np.inf)
        self._there: Floats | None = None
        self._slopes_at = np.full((len(one.time), 2 * count), np.inf)
        self._slopes_factor = np.full(len(self.names), np.inf)
        self.slope = np.zeros((len(one.time), len(self.still), 2 * count + len(self.names)))

    def _along(self, place: Floats, value: Any) -> Any:
        order = np.argsort(place, kind="stable")
        order = order[np.isfinite(value[order])]
        return np.interp(self.knots.depth, place[order], value[order])

    def _measured_state(self, place: Floats) -> Floats:
        """Return (n, 2 K) measured currents minus their mean, interpolated to the knots."""
        both = self.measured.u + 1j * self.measured.v
        known = np.flatnonzero(np.isfinite(both).any(axis=1))
        state = np.zeros((len(both), len(self.mean)))
        for i in known.tolist():
            flow = self._along(place, both[i])
            state[i] = np.concatenate([flow.real, flow.imag]) - self.mean
        return state

    # --- the line

    def currents(self, state: Floats) -> tuple[Floats, Floats]:
        """Return the currents u and v at the knots, each (n, K) [m/s]."""
        count = len(self.knots.depth)
        whole = self.mean + state
        return whole[:, :count], whole[:, count:]

    def depths(self, state: Floats, factor: Floats, times: NDArray[np.int64] | slice) -> Floats:
        """Return depths (n, p) of the points [m], for n times with the indices `times`.

        `state` (n, 2 K) are the currents at the knots, minus their mean [m/s]; `factor` (f,) are
        the logarithms of the factors.
        """
        forward = self.forward(factor)
        return forward.depths(self.knot_depth[times], *self.currents(state))

    def forward(self, factor: Floats) -> Forward:
        """Return the mooring with factors of given logarithms (f,); recent moorings are cached."""
        key = tuple(factor.tolist())
        if key not in self._forwards:
            factors = dict(zip(self.names, np.exp(factor).tolist(), strict=True))
            while len(self._forwards) > 2 * len(self.names):
                del self._forwards[next(iter(self._forwards))]
            self._forwards[key] = Forward(self.mooring, factors)
        return self._forwards[key]

    def linear(self) -> Floats:
        """Return depths (n, p) of the points [m], and update the derivatives where needed."""
        now, factor = self.state[:, self.columns.current], self.factor
        far = np.abs(now - self._slopes_at).max(axis=1) > STALE
        far |= (np.abs(factor - self._slopes_factor) > FACTOR_STEP).any()
        times, near = np.flatnonzero(far), np.flatnonzero(~far)
        there = self._there
        if there is None:
            there = np.empty((len(now), len(self.still)))
            there[near] = self.depths(now[near], factor, near)
        for start in range(0, len(times), BLOCK):
            part = times[start : start + BLOCK]
            there[part], self.slope[part] = self._with_slopes(now[part], factor, part)
        if len(times):
            self._slopes_at[times], self._slopes_factor = now[times], factor.copy()
        return there

    def _with_slopes(
        self, state: Floats, factor: Floats, times: NDArray[np.int64]
    ) -> tuple[Floats, Floats]:
        """Return depths (n, p), and their derivatives (n, p, 2 K + f) by currents and factors."""
        flow = self.knot_depth[times], *self.currents(state)
        there, slopes = self.forward(factor).slopes(*flow)
        steps = FACTOR_STEP * np.eye(len(factor))
        ahead = [self.forward(factor + step).depths(*flow) for step in steps]
        by_factor = [(one - there)[:, :, None] / FACTOR_STEP for one in ahead]
        return there, np.nan_to_num(np.concatenate([slopes, *by_factor], axis=2))

    @cached_property
    def _stretches(self) -> tuple[Floats, NDArray[np.int64], Floats]:
        """Division of the line into z stretches, for the errors of the line.

        The value has the limits (z + 1,) of the stretches, the index (p,) of the stretch of each
        point, and the correlation (z, z) between the errors of the stretches. The limits are depths
        in still water [m], from the seabed up.
        """
        edges = np.linspace(self.still.max(), self.still.min(), STRETCHES + 1)
        own = np.clip(np.searchsorted(-edges, -self.still, "right") - 1, 0, STRETCHES - 1)
        middle = 0.5 * (edges[1:] + edges[:-1])
        span = max(SPAN * float(np.ptp(self.still)), 1.0)
        return edges, own, np.exp(-np.abs(middle[:, None] - middle) / span)

    def by_line(self, there: Floats) -> Floats:
        """Return derivatives (n, p, z) of depths by the relative errors of z stretches of line."""
        edges, own, _ = self._stretches
        order = np.argsort(self.still, kind="stable")
        down = np.maximum(np.nan_to_num(there - self.still), 0.0)
        place = self.still[order]
        after = np.clip(np.searchsorted(place, edges), 1, len(place) - 1)
        apart = np.maximum(place[after] - place[after - 1], 1e-9)
        share = np.clip((edges - place[after - 1]) / apart, 0, 1)
        upper, lower = down[:, order[after - 1]], down[:, order[after]]
        at_edge = (1.0 - share) * upper + share * lower
        result = np.diff(at_edge, axis=1)[:, None, :] * (np.arange(STRETCHES) < own[:, None])
        result[:, np.arange(len(own)), own] = down - at_edge[:, own]
        return result

    # --- the law

    def meter_law(self) -> StateSpace:
        """Return a state-space model of the currents at the knots that uses the meters alone."""
        one, both = self.measured, np.eye(2)
        apart = np.abs(self.knots.depth[:, None] - self.knots.depth)
        alike = np.exp(-apart / CURRENT_REACH) * np.outer(self.spread, self.spread)
        steady, weights = (np.asarray(np.kron(both, each)) for each in (alike, self.knots.level))
        step = np.diff(self.hours, prepend=self.hours[:1])[:, None]
        fade = np.tile(np.exp(-step / self.scales.hours), (1, len(steady)))
        flow = np.hstack([one.u, one.v]) - weights @ self.mean
        noise = np.tile(self.alike * self.meter_noise / self.meter_weight, (1, 2))
        seen = np.broadcast_to(weights, (len(fade), *weights.shape))
        return StateSpace(fade, steady, np.zeros_like(fade), steady, seen, flow, noise)

    def law(self, there: Floats) -> tuple[StateSpace, Floats]:
        """Return the linearised state-space model, and derivatives (n, p, q) of the depths.

        The derivatives are with respect to the q unknowns. `there` (n, p) are the depths of the
        points [m].
        """
        one, at, own = self.measured, self.columns, self.meter_law()
        n, flows = own.fade.shape
        steady = np.zeros((at.count, at.count))
        steady[at.current, at.current] = own.steady
        steady[at.share, at.share] = self._stretches[2]
        steady[at.tide, at.tide] = self.scales.tide**2
        first = steady.copy()
        first[at.factor, at.factor] = self.common_covariance[: len(self.names), : len(self.names)]
        first[at.stays, at.stays] = np.diag(self.first)
        fade, stepped = np.ones((n, at.count)), np.zeros((n, at.count))
        step = np.diff(self.hours, prepend=self.hours[:1])[:, None]
        fade[:, at.current] = own.fade
        fade[:, at.share] = np.exp(-step / LINE_HOURS)
        fade[:, at.tide] = np.exp(-step / TIDE_HOURS)
        stepped[:, at.stays] = self.stepped
        slope = np.zeros((n, len(self.still), at.count))
        slope[:, :, at.current] = self.slope[:, :, :flows]
        slope[:, :, at.factor] = self.slope[:, :, flows:]
        slope[:, :, at.share] = self.scales.share * self.by_line(there)
        slope[:, :, at.tide] = slope[:, :, at.datum] = 1.0
        sensors = slice(own.read.shape[1], None)
        seen = np.zeros((n, sensors.start + len(one.label), at.count))
        seen[:, : sensors.start, at.current] = own.seen
        seen[:, sensors] = slope[:, one.point]
        self.fall = common_unknowns.fall(there, self.still, one.point)
        seen[:, sensors, at.zero] = np.eye(len(one.label))
        seen[:, sensors, at.place] = np.eye(len(one.label)) * self.fall[:, :, None]
        base = (there + self.bend)[:, one.point]
        base -= np.einsum("nsq,nq->ns", seen[:, sensors, at.current], self.state[:, at.current])
        read = np.hstack([own.read, one.depth - base - one.surface[:, None]])
        noise = np.hstack([own.noise, common_unknowns.NOISE**2 / self.sensor_weight])
        return StateSpace(fade, steady, stepped, first, seen, read, noise), slope

    @cached_property
    def alike(self) -> float:
        """Number of successive meter readings that share an error."""
        step = float(np.median(np.diff(self.hours))) if len(self.hours) > 1 else ALIKE_HOURS
        return max(ALIKE_HOURS / max(step, 1e-3), 1.0)

    @property
    def meter_noise(self) -> Floats:
        """Error variances (n, k) of the current components [m²/s²]."""
        one = self.measured
        table = np.array([self.scales.flag.get(f, FLAGGED[4]) for f in range(256)])
        u, v = self.at_levels
        speed = np.hypot(u, v)
        factor = table[one.flag.astype(np.uint8)]
        return np.asarray((METER[0] ** 2 + (METER[1] * speed) ** 2) * factor**2)

    @property
    def at_levels(self) -> tuple[Floats, Floats]:
        """Estimated currents u and v at the levels, each (n, k) [m/s]."""
        u, v = self.currents(self.state[:, self.columns.current])
        return u @ self.knots.level.T, v @ self.knots.level.T

    # --- iterations

    def solve(self, slips: Sequence[tuple[int, int, float]] = ()) -> None:
        """Iterate until the depths converge.

        `slips` are likely steps in the readings: index of the sensor, index of the time, and size
        [m]. They help if only two or three sensors exist.
        """
        self.stepped = self.usual.copy()
        for sensor, time, size in slips:
            column = self.stepped[time, sensor - len(self.measured.label) :]
            column[:1] = 0.5 * (column[:1] + size**2)
        self._there = None
        for turn in range(TURNS):
            there, before = self.linear(), self.depth
            if turn == 0:
                missed = self.measured.depth - there[:, self.measured.point]
                off = np.nan_to_num(np.nanmedian(missed, axis=0))
                usual = float(np.median(off)) if len(off) else 0.0
                square = [usual**2, 0.0, OFFSET**2 / TAILS["place"]]
                self.first = self._heavy(np.repeat(square, [1, len(off), len(off)]))
            law, slope = self.law(there)
            self._turn(law, slope, there, turn)
            if turn in PLACED:
                self._place()
            elif turn > max(PLACED) and np.nanmax(np.abs(self.depth - before)) < ENOUGH:
                break

    @property
    def _steps(self) -> Floats:
        """Changes (n, s) in the readings since the start, from steps in datum and positions [m]."""
        stay = self.state[:, self.columns.stays]
        gone = stay - stay[0]
        sensors = len(self.measured.label)
        return np.asarray(gone[:, :1] + gone[:, 1 + sensors :] * self.fall)

    def _place(self) -> None:
        """Update the factors on the line; the currents are those from the meters alone."""
        times = chosen_times(self.measured)
        if not self.names or not len(times):
            return
        # currents that also fit the pressures would be too small, and the drag too large
        law, *_ = self.by_meters(times)
        own = np.eye(len(self.measured.label)) * law.fall[:, :, None]
        seen = np.concatenate([law.fixed, own], axis=2)
        of_sensors = self._steps[np.searchsorted(self.measured.time, law.time)]
        raw = np.where(law.known, law.raw - of_sensors, 0.0)
        left = np.where(law.known, law.left - of_sensors, 0.0)
        law = replace(law, raw=raw, left=left)
        before = np.diag(1.0 / np.concatenate([self.factor_prior, self.first]))
        pulls = law.pulls(seen, raw)
        alike = common_unknowns.repeated(law.pulls(seen, left)[:, 0])
        covariance = np.linalg.inv(law.normal(seen) / alike + before)
        self.common_covariance = np.asarray(covariance, np.float64)
        value = self.common_covariance @ (pulls.sum(axis=0) / alike)
        self.factor = np.clip(value[: len(self.names)], -FURTHEST, FURTHEST)
        self._there = None
        # the pressures constrain only the drag times the square of the speed
        drag = 2.0 * METERS_ALIKE * np.array([name.endswith("_drag") for name in self.names])
        self.common_covariance[: len(drag), : len(drag)] += np.outer(drag, drag)

    def _heavy(self, square: Floats) -> Floats:
        """Return initial variances of heavy-tailed unknowns from their expected squares."""
        wide = self.begin + self.tail * (square - self.begin)
        return np.asarray(np.maximum(self.begin, wide), np.float64)

    def _turn(self, law: StateSpace, slope: Floats, there: Floats, turn: int) -> None:
        one, at, count = self.measured, self.columns, len(self.measured.time)
        now, left, wide = np.empty_like(self.state), law.read.copy(), np.empty_like(law.read)
        variance, curved = np.empty_like(there), np.empty_like(there)
        stay = np.zeros_like(self.stepped)
        noise_share = np.ones(count)
        tide, alike = np.zeros(count), self._stretches[2]
        score, information = np.zeros(STRETCHES), np.zeros_like(alike)
        for each in smoothed(law):
            t, spread = each.times, each.covariance
            now[t] = each.mean
            seen, here = law.seen[t], slope[t]
            left[t] -= np.einsum("nmq,nq->nm", seen, each.mean)
            wide[t] = (seen @ spread * seen).sum(axis=2)
            variance[t] = (here @ spread * here).sum(axis=2)
            flow = here[:, :, at.current]
            curved[t] = (flow @ spread[:, at.current, at.current] * flow).sum(axis=2)
            own, kept = each.hold[:, at.stays, at.stays], each.pull[:, at.stays]
            added = law.stepped[t, at.stays]
            stay[t] = added + added**2 * (kept**2 - np.diagonal(own, axis1=1, axis2=2))
            # size of the noise of the currents relative to its prior
            pull, hold = each.pull[:, at.current], each.hold[:, at.current, at.current]
            steady = law.steady[at.current, at.current]
            excess = ((pull @ steady) * pull).sum(axis=1) - (steady * hold).sum(axis=(1, 2))
            noise_share[t] += (1.0 - law.fade[t, 0] ** 2) * excess / len(steady)
            z = each.mean[:, at.share]
            tide[t] = each.mean[:, at.tide.start] ** 2 + spread[:, at.tide.start, at.tide.start]
            own_score, own_information = share_score(z, spread[:, at.share, at.share], alike)
            score, information = score + own_score, information + own_information
        begun = now[0, at.stays] ** 2 + spread[0, at.stays, at.stays].diagonal()
        wide[:, : 2 * one.u.shape[1]] /= self.alike
        square = left**2 + wide
        levels = one.u.shape[1]
        noise = self.meter_noise
        self.off = square[:, :levels] + square[:, levels : 2 * levels]
        ratio = self.off / noise
        self.meter_weight = np.nan_to_num((STUDENT + 2.0) / (STUDENT + ratio), nan=1.0)
        own = square[:, 2 * levels :] / common_unknowns.NOISE**2
        self.sensor_weight = np.nan_to_num((STUDENT + 1.0) / (STUDENT + own), nan=1.0)
        if turn >= 2:
            ratio = 0.5 * self.meter_weight * ratio
            flag = dict(self.scales.flag)
            for f in flag:
                mine = (one.flag == f) & np.isfinite(ratio)
                if mine.sum() >= FEWEST:
                    flag[f] = float(np.clip(flag[f] * ratio[mine].mean(), *FLAG_RANGE))
            self.scales = replace(self.scales, flag=flag)
        if turn >= SETTLED:
            # errors at times close together are alike
            number = np.clip(np.ptp(self.hours) / (2.0 * LINE_HOURS), 1.0, count)
            shares = next_shares(
                self.scales.share, score / count, information / count, float(number)
            )
            self.scales = replace(self.scales, share=shares)
        if turn >= 2 and count > 1:
            hours = float(np.clip(self.scales.hours / noise_share[1:].mean(), *HOURS))
            usual = min(float(np.sqrt(tide.mean())), one.tide_deviation)
            self.scales = replace(self.scales, hours=hours, tide=usual)
        if turn >= 1:
            places = slice(-len(one.label), None)
            first = self._heavy(begun)
            if turn < SETTLED:
                first[places] = self.first[places]
            self.first = first
            self.stepped = 0.5 * (self.usual + np.maximum(stay, 0.0))
            self.stepped[0] = 0.0
        moving = self.state[:, at.current]
        now[:, at.current] = moving + np.clip(now[:, at.current] - moving, -LONGEST, LONGEST)
        step = now[:, at.current] - moving
        self.state = now
        on_line = one.level_point != FREE
        moved = there + np.einsum("npq,nq->np", slope[:, :, at.current], step)
        moved = moved[:, one.level_point[on_line]]
        self.levels[:, on_line] = np.where(np.isfinite(moved), moved, self.levels[:, on_line])
        self.knot_depth = self.knots.at(self.levels)
        self._there = there = self.depths(now[:, at.current], self.factor, slice(None))
        down = np.maximum(there - self.still, 1.0)
        self.bend = np.minimum(0.5 * curved / down, down)
        beside = np.r_[at.share, at.factor]
        by_rest = np.einsum("npz,nz->np", slope[:, :, beside], now[:, beside])
        self.depth = there + self.bend + self.surface[:, None] + by_rest
        self.deviation = np.sqrt(np.maximum(variance, 0.0))

    # --- results

    def common(self) -> Common:
        """Return the common unknowns; datum and offsets are medians over time."""
        at = self.columns
        datum, zero, place = (
            np.median(self.state[:, each], axis=0) for each in (at.datum, at.zero, at.place)
        )
        factors = np.exp(self.factor).tolist()
        named = dict(zip(self.names, factors, strict=True))
        count = len(named) + 1 + len(zero)
        covariance = self.common_covariance[:count, :count]
        return Common(named, float(datum[0]), zero + place, covariance)

    @cached_property
    def best(self) -> Forward:
        """The mooring with the estimated factors."""
        return self.forward(self.factor)

    def read(self, times: slice) -> ReadCurrents:
        """Return the estimated currents at the interpolation knots, for a slice of times."""
        currents = self.currents(self.state[times, self.columns.current])
        return ReadCurrents(self.knot_depth[times], *currents)

    @property
    def offset(self) -> Floats:
        """Depth errors (n, s) of the sensors, due to wrong zeros and wrong positions [m]."""
        at = self.columns
        return np.asarray(self.state[:, at.zero] + self.state[:, at.place] * self.fall)

    @property
    def surface(self) -> Floats:
        """Common change (n,) in all depths: datum, tide, and movement of the whole mooring [m]."""
        at = self.columns
        return self.state[:, at.datum.start] + self.state[:, at.tide.start] + self.measured.surface

    @cached_property
    def plain(self) -> Floats:
        """Depths (n, p) of the points computed from the measured currents, without a fit [m]."""
        one, forward = self.measured, Forward(self.mooring, {})
        on_line = one.level_point != FREE
        levels = np.where(np.isfinite(one.level_depth), one.level_depth, self.places)
        flow = self.currents(self._measured_state(self.places))
        for _ in range(2):
            depth = forward.depths(self.knots.at(levels), *flow)
            levels[:, on_line] = np.nan_to_num(depth)[:, one.level_point[on_line]]
        known = np.isfinite(one.u + one.v).any(axis=1, keepdims=True)
        return np.where(known, depth, np.nan)

    @cached_property
    def lost(self) -> NDArray[np.bool_]:
        """Mask (n,) of the times that are too far from any measured current."""
        time = self.measured.time
        known = time[(np.isfinite(self.measured.u) & np.isfinite(self.measured.v)).any(axis=1)]
        away = np.abs(known[nearest(known, time)] - time) / np.timedelta64(1, "h")
        return np.asarray(away > CURRENT_HOURS)

    @property
    def current_factor(self) -> Floats:
        """Ratio (n,) of estimated to measured currents, by least squares over the levels."""
        one = self.measured
        u, v = self.at_levels
        along, own = u * one.u + v * one.v, one.u**2 + one.v**2
        with np.errstate(invalid="ignore", divide="ignore"):
            return np.asarray(np.nansum(along, axis=1) / np.nansum(own, axis=1), np.float64)

    @property
    def doubt(self) -> Floats:
        """Probability (n, k) that a meter reading is unrelated to the current at its level."""
        one, noise = self.measured, self.meter_noise
        spread = np.square(self.knots.level @ self.spread)
        false = common_unknowns.FALSE
        odds = np.array([false.get(f, false[4]) for f in range(256)])[one.flag.astype(np.uint8)]
        wide = noise + spread
        # two normal densities of the reading: with the meter error, or also with the variability of
        # the current
        log = np.log(odds / (1.0 - odds)) + np.log(noise / wide)
        log += 0.5 * self.off * (1.0 / noise - 1.0 / wide)
        return np.asarray(np.nan_to_num(1.0 / (1.0 + np.exp(-np.clip(log, -50.0, 50.0)))))

    def by_meters(self, times: NDArray[np.int64]) -> tuple[LinearLaw, ReadCurrents, Linear]:
        """Return a linear model of the readings, for currents from the current meters alone.

        Also return these currents at the knots, and a linear model of the depths of the line in
        these currents. The state of the second model is the logarithm of a factor on all speeds.
        """
        one, at, factor, law = self.measured, self.columns, self.factor, self.meter_law()
        wide = WIDER**2 * law.steady
        blocks = [*smoothed(replace(law, steady=wide, first=wide))][::-1]
        now = np.concatenate([each.mean for each in blocks])[times]
        spread = np.concatenate([each.covariance for each in blocks])[times]
        flow = slice(0, now.shape[1])
        part = one.at(times)
        there, slopes = self._with_slopes(now, factor, times)
        slope = slopes[:, one.point]
        current, factors = slope[:, :, flow], slope[:, :, flow.stop :]
        good = np.isfinite(there).all(axis=1)
        by_currents = current @ spread @ current.transpose(0, 2, 1)
        down = np.maximum(there - self.still, 1.0)[:, one.point]
        bend = np.minimum(0.5 * np.einsum("nss->ns", by_currents) / down, down)
        known = np.isfinite(part.depth)
        bent = self.scales.share * self.by_line(there)[:, one.point]
        expected = by_currents + bent @ self._stretches[2] @ bent.transpose(0, 2, 1)
        noise = np.where(known, common_unknowns.NOISE**2, line_response.UNMEASURED**2)
        expected += one.tide_deviation**2 + noise[:, :, None] * np.eye(len(one.label))
        fixed = common_unknowns.fixed_slopes(factors)
        stay = self.state[0, at.stays]
        value, place = np.split(np.concatenate([factor, stay]), [fixed.shape[2]])
        raw = part.depth - there[:, one.point] - bend - part.surface[:, None] + factors @ factor
        raw = np.where(known, raw, 0.0)
        fall = common_unknowns.fall(there, self.still, one.point)
        left = np.where(known, raw - fixed @ value - fall * place, 0.0)
        share = one.elapsed(part.time)
        found = LinearLaw(
            part.time[good], share[good], known[good], raw[good], left[good], expected[good],
            fixed[good], fall[good],
        )  # fmt: skip
        read = ReadCurrents(self.knot_depth[times], *self.currents(now))
        speed = slopes[:, :, flow] @ np.hstack([read.u, read.v])[:, :, None]
        return found, read, Linear(np.zeros((len(now), 1)), there, speed, slopes[:, :, flow.stop :])
