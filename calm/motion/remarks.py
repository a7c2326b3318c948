"""How well depths are computed, and remarks on sensors and currents that are doubtful by that."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from calm.motion import common_unknowns
from calm.motion.common_unknowns import Common
from calm.physics.line import Floats, Integers

Times = NDArray[np.datetime64]

LEAST = 1.5
"""A step or a drift that is named [m], at least."""
CLEAR = 6.0
"""And so many standard errors."""
SHARE = 0.6
"""Share of the variance of the residuals that it explains, at least."""
FEWEST = 8
"""Times on either side of a step."""
FALSE = 0.5
"""Probability from which the current of a level is named as false."""
CERTAIN, LIKELY = 0.95, 0.5
"""Probabilities that a sensor hangs elsewhere from which it is named alone, and named at all."""
FAR_OFFSET = 2.5
"""Offsets of a sensor, or of all alike, that are named, in deviations of what is expected."""
FURTHEST_CLOCK, FEWEST_TOGETHER, EXPLAINED, SHARED, AS_WELL = 13.0, 40, 0.5, 0.85, 0.02
"""Hours by which clocks are compared, and times for that; the share of the variance that a shift
leaves of one sensor, and of each of several that agree; how much less a shorter shift may
explain."""
LEAST_SHARE, CLEARER = 0.01, 0.2
"""Share of the depth that is named as a gain, and how much better it explains what is off than the
same for all."""
AIR = 10.1
"""What the weight of the air adds to depths by pressure [m]: 1013 hPa."""


def sensor_remarks(
    labels: Sequence[str],
    time: Times,
    residual: Floats,
    down: Floats,
    common: Common,
) -> list[str]:
    """Return sentences on sensors that drift, clamps that slipped, offsets that are too large.

    They are looked for in the calmer half of the times, where the currents explain little.

    Parameters
    ----------
    time : (n,)
    residual : (n, s) measured less estimated depths [m]
    down : (n,) knockdown [m]
    common : offsets of the sensors, and how far they have moved
    """
    throughout = np.isin(common.since, time[:1])
    said = []
    known = np.isfinite(down)
    calm = known & (down <= (np.median(down[known]) if known.any() else 0.0))
    changes = []
    for j, label in enumerate(labels):
        mine = calm & np.isfinite(residual[:, j])
        found = _change(time[mine], residual[mine, j])
        if found is not None:
            changes.append((abs(found[0]), label, found))
    if changes:
        # what one sensor does wrong shows in the others the other way round
        _, label, (size, kind, when) = max(changes)
        among = _or_another(label, labels, common)
        if kind == "step":
            said.append(
                f"{label}: steps by {size:+.1f} m about {np.datetime_as_string(when, 'm')}: a "
                f"clamp that slipped{among}"
            )
        else:
            j = labels.index(label)
            slipped = ""
            if not throughout[j] and common.elsewhere[j] > LIKELY:
                slipped = (
                    f", or its clamp slipped by {common.moved[j]:+.1f} m about "
                    f"{np.datetime_as_string(common.since[j], 'm')}"
                )
            said.append(f"{label}: drifts by {size:+.1f} m over the record{slipped}{among}")
    for j, label in enumerate(labels):
        offset = common.offset[j] + common.moved[j] * throughout[j]
        if abs(offset) > FAR_OFFSET * common_unknowns.OFFSET:
            said.append(
                f"{label}: {offset:+.1f} m off throughout: its zero, or a length or a place on the "
                f"line that is wrong{_or_another(label, labels, common)}"
            )
        elif (
            not throughout[j]
            and common.elsewhere[j] > LIKELY
            and not any(one.startswith(f"{label}: ") for one in said)
        ):
            said.append(
                f"{label}: hangs {abs(common.moved[j]):.1f} m {_way(common.moved[j])} its place "
                f"from {np.datetime_as_string(common.since[j], 'm')} on: a clamp that slipped"
            )
    return said


def _or_another(label: str, labels: Sequence[str], common: Common) -> str:
    """Return which other sensor it may be as well, as far as the pressures can tell."""
    if common.elsewhere[labels.index(label)] > CERTAIN:
        return ""
    pairs = zip(labels, common.elsewhere, strict=True)
    others = [other for other, chance in pairs if chance > 1.0 - CERTAIN and other != label]
    if not others and len(labels) == 2:
        others = [other for other in labels if other != label]
    named = ", ".join(others)
    return f", or {named} the other way: they cannot tell" if named else ""


def _way(moved: float) -> str:
    return "below" if moved > 0.0 else "above"


def _change(time: Times, residual: Floats) -> tuple[float, str, np.datetime64] | None:
    """Return a step or a drift: its size [m], which, and when; None where there is none that is
    clear.
    """
    count = len(residual)
    if count < 2 * FEWEST:
        return None
    whole = float(((residual - residual.mean()) ** 2).sum())
    hours = (time - time[0]) / np.timedelta64(1, "h")
    rate, start = np.polyfit(hours, residual, 1)
    left_by_drift = float(((residual - rate * hours - start) ** 2).sum())
    total = np.cumsum(residual)
    at = np.arange(FEWEST, count - FEWEST + 1)
    before, after = total[at - 1] / at, (total[-1] - total[at - 1]) / (count - at)
    gained = (after - before) ** 2 * at * (count - at) / count
    best = int(np.argmax(gained))
    left_by_step = whole - float(gained[best])
    step = left_by_step <= left_by_drift
    left = left_by_step if step else left_by_drift
    size = float(after[best] - before[best]) if step else float(rate * hours[-1])
    error = np.sqrt(left / count) * np.sqrt(12.0 / count)
    if abs(size) < max(LEAST, CLEAR * error) or left > (1.0 - SHARE) * whole:
        return None
    return size, "step" if step else "drift", time[at[best] - 1]


def false_current_times(names: Sequence[str], time: Times, doubt: Floats) -> dict[str, Times]:
    """Return the times at which the current of a level is more likely false than not, by its name.

    Parameters
    ----------
    time : (n,)
    doubt : (n, k) probability that the current of a level is false
    """
    hit = doubt > FALSE
    return {name: time[hit[:, k]] for k, name in enumerate(names) if hit[:, k].any()}


def current_remarks(false: Mapping[str, Times], count: int) -> list[str]:
    """Return a sentence on each level whose current looks false at some of so many times."""
    return [
        f"current at {name}: its direction or speed looks false at {len(when)} of {count} times, "
        f"first at {np.datetime_as_string(when[0], 'm')}"
        for name, when in false.items()
    ]


def clock_remarks(labels: Sequence[str], time: Times, depth: Floats, plain: Floats) -> list[str]:
    """Return sentences where the currents explain the depths better some hours earlier or later.

    Below the lowest sensor's depths the height of the sea surface is taken off.

    Parameters
    ----------
    labels : of the sensors, from the top down
    time : (n,)
    depth, plain : (n, s) measured, and by the currents alone [m]
    """
    if len(time) < FEWEST_TOGETHER:
        return []
    step = float(np.median(np.diff(time)) / np.timedelta64(1, "h"))
    if len(labels) > 1:
        labels, depth, plain = labels[:-1], depth - depth[:, -1:], plain - plain[:, -1:]
    reach = int(FURTHEST_CLOCK / step) if step > 0.0 else 0
    lags = range(-reach, reach + 1)
    found: dict[int, list[tuple[str, float, float, bool]]] = {}
    for j, label in enumerate(labels):
        alike = np.array([_alike(depth[:, j], plain[:, j], lag) for lag in lags])
        peaks = np.flatnonzero(
            (alike >= np.append(alike[1:], 0)) & (alike > np.append(0, alike[:-1]))
        )
        near = [at for at in peaks if alike[at] > alike.max() - AS_WELL]  # of a tide, many are
        best = min(near, key=lambda at: abs(lags[at]), default=reach)
        now, most = float(alike[reach]), float(alike[best])
        left = (1.0 - most**2) / (1.0 - max(now, 0.0) ** 2) if now < 1.0 else 1.0
        if best != reach and left < SHARED:
            clear = left < EXPLAINED and most > now + 0.1
            found.setdefault(lags[best], []).append((label, now, most, clear))
    said = []
    for lag, sensors in found.items():
        if not any(clear for *_, clear in sensors) and len(sensors) < max(2, len(labels) / 2):
            continue
        whose = ", ".join(label for label, *_ in sensors)
        which = "the pressures" if len(sensors) == len(labels) else whose
        _, now, most, _ = max(sensors, key=lambda one: one[2])
        said.append(
            f"clocks: {which} some {abs(lag) * step:.3g} h {'behind' if lag > 0 else 'ahead of'} "
            f"the currents: shifted so, r = {most:.2f} in place of {now:.2f}"
        )
    return said


def _alike(depth: Floats, plain: Floats, lag: int) -> float:
    """Return the correlation of depths with those computed so many times before; 0 of few, or of
    such as differ in size.
    """
    count = len(depth) - abs(lag)
    one, other = depth[max(lag, 0) :][:count], plain[max(-lag, 0) :][:count]
    both = np.isfinite(one) & np.isfinite(other)
    if both.sum() < FEWEST_TOGETHER:
        return 0.0
    sizes = float(one[both].std()), float(other[both].std())
    if min(sizes) < LEAST or not 0.5 < sizes[0] / sizes[1] < 2.0:
        return 0.0
    return float(np.corrcoef(one[both], other[both])[0, 1])


def gain_remarks(labels: Sequence[str], depth: Floats, plain: Floats) -> list[str]:
    """Return a sentence where all pressures are too great, or too small, by the same share.

    Parameters
    ----------
    labels : of the sensors
    depth, plain : (n, s) measured, and by the currents alone, at calm times [m]
    """
    place, off = np.nanmedian(plain, axis=0), np.nanmedian(depth - plain, axis=0)
    if len(labels) < 2 or not np.isfinite(off).all():
        return []
    law = np.stack([place, np.ones_like(place)], axis=1)[:, : 1 + (len(labels) > 2)]
    found = np.linalg.lstsq(law, off)[0]
    share = float(found[0])
    by_share, alike = ((left**2).sum() for left in (off - law @ found, off - off.mean()))
    if abs(share) < LEAST_SHARE or alike < (2.0 * LEAST) ** 2 or by_share > CLEARER * alike:
        return []
    return [
        f"all sensors: {100.0 * share:+.1f} % of their depth off: the gain of the pressures, or "
        "their unit, is wrong"
    ]


def datum_remarks(common: Common, seabed: float) -> list[str]:
    """Return a sentence where all sensors are off alike: by the weight of the air, or by much.

    Parameters
    ----------
    seabed : depth of the water [m]
    """
    at = len(common.factors)
    spread = float(np.sqrt(common.covariance[at, at]))
    alike = common.datum + float(common.offset.mean())
    said = f"all sensors: {common.datum:+.1f} m off alike"
    if common.datum > 2.0 * spread and abs(alike - AIR) < 2.0 * max(spread, common_unknowns.NOISE):
        return [f"{said}: as if the pressures included that of the air, 10.13 dbar; take it off"]
    if abs(common.datum) > FAR_OFFSET * common_unknowns.DATUM * seabed:
        return [f"{said}: the depth of the water, a length, or the zero of the pressures is wrong"]
    return []


CALM = 0.1
"""Share of the times that count as calm: those of the least knockdown."""
BAND = 1.96
"""Deviations on either side between which 95 % of a normal law lie."""


@dataclass(frozen=True)
class Agreement:
    """Tell how computed depths agree with measured ones.

    Attributes
    ----------
    count : times that have both
    bias : mean of computed less measured over them [m]
    rms : root of the mean square of that difference less its mean over the calm times [m]
    r : correlation of computed and measured
    slope : of computed on measured
    """

    count: int
    bias: float
    rms: float
    r: float
    slope: float


def calm_times(down: Floats, among: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """Return those of some times at which the knockdown [m] is least: a tenth of them, one at
    least.
    """
    known = among & np.isfinite(down)
    chosen = np.zeros_like(known)
    count = int(known.sum())
    if count:
        where = np.flatnonzero(known)
        rank = np.argsort(down[where], kind="stable")
        chosen[where[rank[: max(round(CALM * count), 1)]]] = True
    return chosen


def difference(
    computed: Floats, measured: Floats, calm: NDArray[np.bool_], among: NDArray[np.bool_]
) -> Floats:
    """Return (n,) computed less measured, less its mean over the calm times; NaN elsewhere [m].

    Parameters
    ----------
    computed, measured : (n,) depths [m]
    calm : (n,) times of the least knockdown
    among : (n,) times that count
    """
    off = np.where(among, computed - measured, np.nan)
    at_rest = off[calm & np.isfinite(off)]
    result: Floats = off - (at_rest.mean() if at_rest.size else np.nan)
    return result


def rms(off: Floats) -> float:
    """Return the root of the mean square of the values there are; NaN of none."""
    known = off[np.isfinite(off)]
    return float(np.sqrt((known**2).mean())) if known.size else float("nan")


def agreement(
    computed: Floats, measured: Floats, calm: NDArray[np.bool_], among: NDArray[np.bool_]
) -> Agreement:
    """Return how depths agree at some of the times.

    Parameters
    ----------
    computed, measured : (n,) depths [m]
    calm : (n,) times of the least knockdown
    among : (n,) times that count
    """
    both = among & np.isfinite(computed) & np.isfinite(measured)
    count = int(both.sum())
    if count < 2:
        nan = float("nan")
        return Agreement(count, nan, nan, nan, nan)
    x, y = measured[both], computed[both]
    spread_x, spread_y = x - x.mean(), y - y.mean()
    across, own, other = spread_x @ spread_y, spread_x @ spread_x, spread_y @ spread_y
    nan = float("nan")
    return Agreement(
        count,
        float((y - x).mean()),
        rms(difference(computed, measured, calm, both)),
        float(across / np.sqrt(own * other)) if own * other > 0.0 else nan,
        float(across / own) if own > 0.0 else nan,
    )


def coverage(off: Floats, deviation: Floats) -> float:
    """Return the share of the differences within the band of 95 %; NaN of none."""
    known = np.isfinite(off) & np.isfinite(deviation)
    inside = np.abs(off[known]) <= BAND * deviation[known]
    return float(inside.mean()) if inside.size else float("nan")


def linear(depth: Floats, point: Integers, still: Floats, wanted: int) -> Floats:
    """Return (n,) depths at a point, linear by height in still water between the nearest sensors
    [m].

    Parameters
    ----------
    depth : (n, s) of the sensors; NaN at a time leaves that time without
    point : (s,) where they are
    still : (p,) depths in still water
    wanted : the point

    Beyond the sensors the slope of the two nearest goes on; a single one moves everything alike.
    """
    order = np.argsort(still[point], kind="stable")
    place, values = still[point][order], depth[:, order]
    if len(place) == 1:
        alike: Floats = values[:, 0] + still[wanted] - place[0]
        return alike
    upper = int(np.clip(np.searchsorted(place, still[wanted]) - 1, 0, len(place) - 2))
    share = (still[wanted] - place[upper]) / (place[upper + 1] - place[upper])
    between: Floats = values[:, upper] * (1.0 - share) + values[:, upper + 1] * share
    return between
