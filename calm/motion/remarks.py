"""Remarks on the accuracy of computed depths, and on faults of sensors and currents."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from calm.motion import common_unknowns
from calm.motion.common_unknowns import Common
from calm.physics.line import Floats, Integers

Times = NDArray[np.datetime64]

NO_TIME = np.datetime64("NaT", "ns")
FALSE = 0.5  # probability above which the current of a level is reported as false
ALL, LINE, CURRENTS = "all sensors", "the line", "all currents"
# faults of the line and its currents, not of sensors; their sizes are logarithms
OF_LINE = ("currents", "buoyancy", "length", "drag", "fouling")
LIKELY = 20.0  # odds above which a fault is reported
FAR_OFFSET = 2.5  # least offset of all sensors that is reported, in prior standard deviations
FAR_DATUM = 10.0  # offset of all sensors that is always reported [m]
# least error in length that is reported if no currents were measured, in prior deviations;
# inferred currents absorb much of such an error
FAR_LENGTH = 5.0
# prior deviations of a drag factor from 1 above which the factor absorbs another error
FAR_FACTOR = 3.0
WORST = 0.3  # share of the knockdown above which the error of the line is reported


@dataclass(frozen=True)
class Fault:
    """A fault of a sensor, a current meter or the line."""

    label: str  # label of the sensor; `ALL` for all sensors together
    kind: str  # `moved`, `clock`, `gain`, `offset`, `drift`, `slip`, or one of `OF_LINE`
    # size of the fault, and its 95 % interval: the lag of a `clock` [h]; a `gain`; the excess depth
    # of an `offset` or `moved`, or at the end of a `drift` [m]; the distance down the line of a
    # `slip` [m]; for `OF_LINE`, the factor on the value in the file or on the reading of the meter
    value: float = 0.0
    low: float = 0.0
    high: float = 0.0
    odds: float = 0.0  # odds in favour of this fault against all alternatives, including no fault
    # start of a step, slip or drift, and end of a drift; otherwise NaT
    since: np.datetime64 = NO_TIME
    until: np.datetime64 = NO_TIME
    rival: str = ""  # alternative explanations that are nearly as likely
    corrected: bool = False  # whether the fault has been corrected

    @property
    def size(self) -> float:
        """Size of the fault: 0 without a fault; for `OF_LINE`, the logarithm of `value`."""
        if self.kind in OF_LINE:
            return float(np.log(self.value))
        return self.value - (self.kind == "gain")

    def sized(self, size: float, deviation: float) -> Fault:
        """Return a copy with another size, and with a 95 % interval from a standard deviation."""
        three = [size, size - BAND * deviation, size + BAND * deviation]
        if self.kind in OF_LINE:
            three = [float(np.exp(one)) for one in three]
        value, low, high = (one + (self.kind == "gain") for one in three)
        return replace(self, value=value, low=low, high=high)

    def same(self, other: Fault) -> bool:
        """True if the faults have the same kind and sensors, whatever their sizes."""
        return (self.label, self.kind) == (other.label, other.kind)

    def alike(self, other: Fault) -> bool:
        """True if the faults are the same, or if both concern the whole line or all currents."""
        both = {self.label, other.label} <= {LINE, CURRENTS}
        return both or self.same(other)

    def taken_off(self, time: Times, depth: Floats) -> tuple[Times, Floats]:
        """Return times (n,) and depths (n,) [m] corrected for the fault."""
        if self.kind == "clock":
            return time - np.timedelta64(round(self.value * 3.6e12), "ns"), depth
        if self.kind == "gain":
            return time, depth / self.value
        share: Floats = np.ones(1)
        if self.kind == "moved":
            share = np.where(time >= self.since, 1.0, 0.0)
        elif self.kind != "offset":
            share = np.clip((time - self.since) / (self.until - self.since), 0.0, 1.0)
        return time, depth - self.value * share

    @property
    def certain(self) -> bool:
        """True if the odds are high enough to exclude other explanations."""
        return self.odds >= LIKELY

    def sentence(self) -> str:
        """Describe the fault in a sentence, with its alternative explanations."""
        band = f"({self.low:+.2f} to {self.high:+.2f})"
        clock = "their clocks are" if self.label == ALL else "its clock is"
        sign = "late" if self.value > 0.0 else "early"
        when, until = (np.datetime_as_string(one, "m") for one in (self.since, self.until))
        below = "below" if self.value > 0.0 else "above"
        share = f"{self.value:.2f} ({self.low:.2f} to {self.high:.2f})"
        low, longer, high = sorted(100.0 * abs(f - 1.0) for f in (self.value, self.low, self.high))
        text = {
            "currents": f"they measure {share} times the true speed",
            "buoyancy": (
                f"the net buoyancy of its floats is {share} times the value in the file; a float "
                "may be missing, flooded or wrongly listed"
            ),
            "length": f"its cables are {longer:.1f} % ({low:.1f} to {high:.1f}) "
            f"{'longer' if self.value > 1.0 else 'shorter'} than in the file",
            "drag": f"its drag is {share} times the assumed drag",
            "fouling": (
                f"its drag changes to {share} times its initial value by the end of the record, "
                "probably because of fouling"
            ),
            "moved": f"the whole mooring is {abs(self.value):.1f} m {band} "
            f"{'deeper' if self.value > 0.0 else 'shallower'} from {when} on; it has probably "
            "moved to another water depth",
            "clock": f"{clock} {abs(self.value):.2f} h {sign} {band}"
            + f", or the clocks of the current meters are {'early' if self.value > 0.0 else 'late'}"
            * (self.label == ALL),
            "gain": (
                f"its pressures are {self.value:.3f} times the expected ones ({self.low:.3f} to "
                f"{self.high:.3f}); their gain or their unit is wrong"
            ),
            "offset": (
                f"it has a constant offset of {self.value:+.1f} m; its zero, a length, or its "
                "position on the line is wrong"
            ),
            "drift": f"it drifts by {self.value:+.1f} m {band} until {until}",
            "slip": (
                f"it is {abs(self.value):.1f} m {below} its nominal position from {when} on; its "
                "clamp has probably slipped"
            ),
        }[self.kind]
        also = f", or {self.rival}; the pressures cannot distinguish these" * bool(self.rival)
        return f"{self.label}: {text}{also}"


def false_current_times(names: Sequence[str], time: Times, doubt: Floats) -> dict[str, Times]:
    """Return the times of probably false currents by level name, from `doubt` (n, k)."""
    hit = doubt > FALSE
    return {name: time[hit[:, k]] for k, name in enumerate(names) if hit[:, k].any()}


def current_remarks(false: Mapping[str, Times], count: int) -> list[str]:
    """Return a remark for each level with false currents, in a record of `count` times."""
    return [
        f"current at {name}: its direction or speed is probably wrong at {len(when)} of {count} "
        f"times, first at {np.datetime_as_string(when[0], 'm')}"
        for name, when in false.items()
    ]


def no_drag(name: str, value: float) -> bool:
    """True if a drag factor is so far from 1 that it probably compensates for another error."""
    far = abs(float(np.log(value))) > FAR_FACTOR * common_unknowns.FACTORS[name]
    return name.endswith("drag") and far


def alone_remarks(common: Common) -> list[str]:
    """Return a remark if the line is inconsistent with the pressures even in inferred currents."""
    length = common.factors.get("length", 1.0)
    far = abs(float(np.log(length))) > FAR_LENGTH * common_unknowns.FACTORS["length"]
    if not far and common.worst < WORST:
        return []
    return [
        f"{LINE}: its computed depths disagree with the pressures; a length, a float or the water "
        f"depth is wrong. In the best fit, the cables are {100.0 * abs(length - 1.0):.1f} % "
        f"{'longer' if length > 1.0 else 'shorter'} than in the file, and the remaining error is "
        f"{100.0 * common.worst:.0f} % of the knockdown"
    ]


def datum_remarks(common: Common, seabed: float) -> list[str]:
    """Return a remark if all sensors share an offset that is large for the water depth [m]."""
    if abs(common.datum) <= min(FAR_OFFSET * common_unknowns.DATUM * seabed, FAR_DATUM):
        return []
    return [
        f"all sensors have a common offset of {common.datum:+.1f} m; the water depth, a length, or "
        "the zero of the pressures is wrong"
    ]


CALM = 0.1  # share of times that count as calm, with the smallest knockdown
BAND = 1.96  # half-width of the 95 % interval of a normal distribution, in standard deviations


@dataclass(frozen=True)
class Agreement:
    """Agreement of computed and measured depths."""

    count: int  # number of times with both depths
    bias: float  # mean of computed minus measured depth [m]
    rms: float  # root mean square of the `difference` [m]
    r: float  # correlation of computed and measured depths
    slope: float  # regression slope of computed on measured depths


def calm_times(down: Floats, among: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """Return a mask of the 10 % of the times in `among` with the smallest knockdown (n,)."""
    where = np.flatnonzero(among & np.isfinite(down))
    rank = np.argsort(down[where], kind="stable")
    chosen = np.zeros(len(down), bool)
    chosen[where[rank[: max(round(CALM * len(where)), 1)]]] = True
    return chosen


def difference(
    computed: Floats, measured: Floats, calm: NDArray[np.bool_], among: NDArray[np.bool_]
) -> Floats:
    """Return computed minus measured depths (n,), relative to their mean at the calm times [m].

    The result is NaN at times that are not in the mask `among`.
    """
    off = np.where(among, computed - measured, np.nan)
    at_rest = off[calm & np.isfinite(off)]
    return np.asarray(off - (at_rest.mean() if at_rest.size else np.nan))


def rms(off: Floats) -> float:
    """Return the root mean square of the finite values; NaN if no value is finite."""
    known = off[np.isfinite(off)]
    return float(np.sqrt((known**2).mean())) if known.size else float("nan")


def agreement(
    computed: Floats, measured: Floats, calm: NDArray[np.bool_], among: NDArray[np.bool_]
) -> Agreement:
    """Compare (n,) computed and measured depths [m] at the times in the mask `among`."""
    both = among & np.isfinite(computed) & np.isfinite(measured)
    count, nan = int(both.sum()), float("nan")
    if count < 2:
        return Agreement(count, nan, nan, nan, nan)
    x, y = measured[both], computed[both]
    spread_x, spread_y = x - x.mean(), y - y.mean()
    across, own, other = spread_x @ spread_y, spread_x @ spread_x, spread_y @ spread_y
    return Agreement(
        count,
        float((y - x).mean()),
        rms(difference(computed, measured, calm, both)),
        float(across / np.sqrt(own * other)) if own * other > 0.0 else nan,
        float(across / own) if own > 0.0 else nan,
    )


def coverage(off: Floats, deviation: Floats) -> float:
    """Return the share of the differences within their 95 % interval; NaN if there are none."""
    known = np.isfinite(off) & np.isfinite(deviation)
    inside = np.abs(off[known]) <= BAND * deviation[known]
    return float(inside.mean()) if inside.size else float("nan")


def linear(depth: Floats, point: Integers, still: Floats, wanted: int) -> Floats:
    """Interpolate depths (n,) of a point [m] linearly between the nearest sensors.

    The sensors at the points (s,) have depths (n, s) [m]; `still` (p,) are depths of all points in
    still water [m]. Depths are extrapolated beyond the outermost sensors. A single sensor moves all
    points equally.
    """
    from scipy.interpolate import make_interp_spline

    place, first = np.unique(still[point], return_index=True)
    values = depth[:, first]
    if len(place) == 1:
        return np.asarray(values[:, 0] + still[wanted] - place[0])
    line = make_interp_spline(place, values, k=1, axis=1, check_finite=False)
    return np.asarray(line(still[wanted]))


def pchip(depth: Floats, point: Integers, still: Floats, wanted: int) -> Floats:
    """Interpolate depths (n,) of a point [m] from the knockdown of the sensors, as in `linear`.

    The method is PCHIP (Fritsch and Carlson 1980) over height above the lowest point of the line.
    """
    from scipy.interpolate import PchipInterpolator

    height = still.max() - still
    _, first = np.unique(height[point], return_index=True)
    first = first[np.greater(height[point][first], 0.0)]
    if not len(first):
        return np.full(len(depth), still[wanted])
    known = np.isfinite(depth.sum(axis=1))
    down = np.where(known[:, None], depth - still[point], 0.0)[:, first]
    places = np.concatenate([[0.0], height[point][first]])
    values = np.concatenate([np.zeros((len(down), 1)), down], axis=1)
    between = PchipInterpolator(places, values, axis=1, extrapolate=True)(height[wanted])
    return np.where(known, still[wanted] + between, np.nan)
