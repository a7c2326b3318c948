"""Conversion of pressures on a mooring into depths, with tests of their plausibility.

The module also reads the height of the sea surface.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import replace
from itertools import combinations, pairwise
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from calm.errors import InputError, Problem, UsageError
from calm.motion.common_unknowns import FEWEST
from calm.motion.remarks import rms
from calm.physics.line import Floats
from calm.physics.seawater import pressure_at
from calm.records import cf_files, instrument_series, instrument_text
from calm.records.attributes import words_of
from calm.records.card import ReadCard, VariableSummary
from calm.records.cf_files import UnreadableError, factor_of, find_times
from calm.records.headings import read_time_columns
from calm.records.instrument_series import PASCALS_PER_DBAR, InstrumentSeries
from calm.records.value_tests import series_doubts
from calm.records.velocity import MISSING, flag_variable

if TYPE_CHECKING:
    import xarray as xr

_NOT_MEASURED = re.compile(
    r"\b(inferred|interpolated (from|between|using)|neighbou?r(s|ing)?|by calm)\b"
)


def read_sensors(
    given: Sequence[str], flags: frozenset[int], latitude: float, seabed: float
) -> list[InstrumentSeries]:
    """Read the depths measured by the sensors of several files [m].

    Files are given as paths, or ``LABEL=PATH`` for a single sensor. Pressures with accepted flags
    are converted by TEOS-10 at `latitude` [degrees]. Nominal heights are measured from `seabed`
    [m].
    """
    found: list[InstrumentSeries] = []
    for label, path in instrument_series.files_given(given):
        if cf_files.holds_arrays(path):
            with cf_files.opened(path) as dataset:
                parts = instrument_series.instruments_apart(dataset)
                each = (_from_arrays(part, path, flags, latitude, seabed) for part in parts)
                mine = instrument_series.with_one_card([one for part in each for one in part])
        else:
            mine = _from_csv(path, latitude)
        if label:
            if len(mine) > 1:
                raise UsageError(
                    f"{path} holds {len(mine)} sensors; `{label}=` needs a file with one sensor"
                )
            mine = [replace(mine[0], label=label)]
        found += mine
    labels = sorted(one.label for one in found if one.label)
    if twice := [one for one, next_one in pairwise(labels) if one == next_one]:
        raise UsageError(f"--pressures: two sensors are called `{twice[0]}`")
    return [_doubted(one) for one in found]


def _doubted(sensor: InstrumentSeries) -> InstrumentSeries:
    doubts = series_doubts(sensor.value[:, np.newaxis, np.newaxis], sensor.time)
    notes = (sensor.note, *(f"{sensor.named}: {doubt}" for doubt in doubts))
    return replace(sensor, note="; ".join(filter(None, notes)))


def depth_of(dbar: Floats, latitude: float) -> Floats:
    """Convert pressures [dbar], relative to the atmosphere, to depths [m] by TEOS-10."""
    import gsw

    known = np.where(np.isfinite(dbar), dbar, np.nan)
    return -np.asarray(gsw.z_from_p(known, latitude), np.float64)


def _from_arrays(
    dataset: xr.Dataset, path: Path, flags: frozenset[int], latitude: float, seabed: float
) -> list[InstrumentSeries]:
    name, is_pressure = _find(dataset)
    variable = dataset[name]
    found = instrument_series.readings(dataset, [name], flags)
    words, note = words_of(variable, "long_name", "comment"), ""
    if _NOT_MEASURED.search(words):
        flagged = flag_variable(dataset, name)
        if flagged is None or not {found.axis} < set(flagged.dims):
            raise UnreadableError(
                f"`{name}` is not a measurement according to its attributes: {words[:120]}"
            )
        # with several instruments, variable attributes describe no single instrument
        note = (
            f"`{name}` is described as `{words[:80]}` for at least one instrument; CALM uses the "
            "values that have an accepted flag (--flags)"
        )
    unit = "pressure" if is_pressure else "length"
    factor = factor_of(variable, unit) / (PASCALS_PER_DBAR if is_pressure else 1.0)
    values = np.where(found.dropped, np.nan, found.values[0] * factor)
    depth = depth_of(values, latitude) if is_pressure else values
    who = instrument_series.who_along(dataset, found.along, seabed, path.name)
    taken = {"pressure" if is_pressure else "depth": name}
    card = instrument_series.card_of(dataset, path.name, taken, found)
    each = [replace(one, note=note, card=card) for one in found.series(depth, who)]
    return [one for one in each if not note or np.isfinite(one.value).any()]


def _find(dataset: xr.Dataset) -> tuple[str, bool]:
    """Find the pressure variable, or else a depth variable; the flag is true for a pressure."""
    if found := instrument_series.named(dataset, *instrument_series.PRESSURE):
        return found[0], True
    for name in map(str, dataset.cf.standard_names.get("depth", [])):
        clock = find_times(dataset, name)
        if clock is not None and set() < {*dataset[clock].dims} <= {*dataset[name].dims}:
            return name, False
    raise UnreadableError(
        "has no pressures: CALM looks for a variable with the standard name sea_water_pressure, "
        "then for a depth that varies in time"
    )


def _from_csv(path: Path, latitude: float) -> list[InstrumentSeries]:
    """Read a table ``time,LABEL[dbar],…``. A column may have depths instead: ``LABEL[m]``."""
    table = read_time_columns(path, ("pressure", "length"), "LABEL[dbar]")
    summaries, depths = {}, []
    for label, dimension, values in zip(table.names, table.dimensions, table.values.T, strict=True):
        pressure = dimension == "pressure"
        read = values * (1.0 / PASCALS_PER_DBAR) if pressure else values
        summaries[label] = VariableSummary.of(label, "dbar" if pressure else "m", read)
        depths.append(depth_of(values / PASCALS_PER_DBAR, latitude) if pressure else values)
    card = ReadCard(path.name, {}, summaries, len(table.names), table.time)
    return [
        InstrumentSeries(label, "", float("nan"), path.name, table.time, depth, card=card)
        for label, depth in zip(table.names, depths, strict=True)
    ]


def parse_flags(text: str) -> frozenset[int]:
    """Parse a list of flags such as ``1,2``; 8, the flag of interpolated values, is rejected."""
    try:
        flags = frozenset(int(part) for part in text.split(","))
    except ValueError:
        raise UsageError(f"--flags: `{text[:40]}` is not a list of flags; write 1,2") from None
    if instrument_series.INTERPOLATED in flags:
        raise UsageError("--flags: 8 marks interpolated values, which are not measurements")
    if not flags <= {*range(MISSING)}:
        raise UsageError(f"--flags: `{text[:40]}`: flags must be from 0 to 8")
    return flags


FURTHEST = 20.0  # most distance of a sea-surface height from the median [m]: twice any real tide

_STANDARD = (
    *(f"sea_surface_height_above_{of}" for of in ("mean_sea_level", "geoid", "geopotential_datum")),
    "tidal_sea_surface_height_above_mean_sea_level",
    "water_surface_height_above_reference_datum",
)


def read_sea_level(path: Path) -> tuple[NDArray[np.datetime64], Floats]:
    """Read increasing times, and heights of the sea surface above a datum [m]."""
    if path.is_file() and not cf_files.holds_arrays(path):
        table = read_time_columns(path, ("length",), "level[m]")
        if len(table.names) != 1:
            message = (
                "has several data columns; only one is allowed besides the time, e.g. "
                "`time,level[m]`"
            )
            raise InputError([Problem(str(path), 1, 1, message)])
        time, level = table.time, table.values[:, 0]
    else:
        with cf_files.opened(path) as dataset:
            names = instrument_series.named(dataset, _STANDARD, ())
            if not names:
                raise UnreadableError("has no sea-surface height")
            found = instrument_series.readings(dataset, names, frozenset(range(MISSING)))
            if found.along is not None:
                raise UnreadableError(
                    f"`{names[0]}` has values at several places (dimension `{found.along}`)"
                )
            time, level = found.time, found.values[0][:, 0] * factor_of(dataset[names[0]], "length")
    known = level[np.isfinite(level)]
    far = np.abs(level - (np.median(known) if known.size else 0.0)) > FURTHEST
    if far.any():
        at = int(far.argmax())
        message = (
            f"the sea level is {level[at]:g} m at {np.datetime_as_string(time[at], 's')}, more "
            f"than {FURTHEST:g} m from its median; leave missing values blank"
        )
        raise InputError([Problem(str(path), 0, 0, message)])
    return time, level


CONSTANT = 1e-6  # range of depths up to which a sensor counts as constant [m]
MISPLACED = 20.0  # tolerance of the shallowest depth [m]; a factor of up to two is also tolerated
UNITS = {"psi for dbar?": 1.45038, "dbar for psi?": 0.68948}  # ratios of readings to true values
ALIKE = 0.03  # relative tolerance of the ratios in `UNITS`, doubled for several sensors
APART = 3.0  # least distance between exchanged sensors [m]
BELOW = 1.1  # readings are too deep if they exceed the seabed by this factor and by `MISPLACED`


def plausible(
    sensor: InstrumentSeries, place: float, seabed: float
) -> tuple[InstrumentSeries, list[str]]:
    """Remove implausible readings from a sensor, and return notes about the removal.

    Implausible readings are far shallower than `place`, the depth of the sensor in still water [m],
    far below the seabed at the depth `seabed` [m], or from a stuck sensor.

    If most readings are too shallow or too deep, all are kept. If readings on deck show that
    pressures are absolute, they are corrected. Of several readings at one time, the first is kept.
    """
    notes = []
    again = np.zeros(len(sensor.time), bool)
    again[1:] = sensor.time[1:] == sensor.time[:-1]
    if again.any():
        differ = np.abs(np.diff(sensor.value))[again[1:]] > 1.0
        if 3 * again.sum() >= again.size and 2 * differ.sum() > differ.size:
            raise UsageError(
                f"--pressures: `{sensor.label}` has several depths at {again.sum()} of its times: "
                "they are readings of several instruments; give one file for each"
            )
        when = np.datetime_as_string(sensor.time[again][0], "s")
        notes.append(
            f"{sensor.label}: {again.sum()} of its times appear twice, the earliest at {when}; "
            "only the first reading at each time is used"
        )
        sensor = replace(sensor, time=sensor.time[~again], value=sensor.value[~again])
    least = min(0.5 * place, place - MISPLACED)
    greatest = max(BELOW * seabed, seabed + MISPLACED)
    deck = sensor.value[sensor.value < min(least, 2.0 * AIR)]
    if len(deck) >= FEWEST and np.percentile(np.abs(deck - AIR), 75.0) < ON_DECK:
        notes.append(
            f"{sensor.label} reads {np.median(deck):.1f} m on deck, so its pressures are absolute; "
            "the pressure of the air, 10.13 dbar, was subtracted"
        )
        sensor = replace(sensor, value=sensor.value - AIR)
    stuck = _stuck(sensor.value)
    if stuck.any():
        first, last = np.flatnonzero(stuck)[[0, -1]]
        begins, ends = (np.datetime_as_string(sensor.time[at], "m") for at in (first, last))
        notes.append(
            f"{sensor.label} has the same value at {stuck.sum()} of its {stuck.size} times, from "
            f"{begins} to {ends}; these readings were excluded"
        )
        sensor = replace(sensor, value=np.where(stuck, np.nan, sensor.value))
    wrong = (sensor.value < least) | (sensor.value > greatest)
    if wrong.any() and 2 * wrong.sum() < np.isfinite(sensor.value).sum():
        first = int(wrong.argmax())
        notes.append(
            f"{sensor.label}: {wrong.sum()} of its readings are impossible at its depth of "
            f"{place:.1f} m and were excluded; the first is {sensor.value[first]:.1f} m, at "
            f"{np.datetime_as_string(sensor.time[first], 's')}"
        )
        sensor = replace(sensor, value=np.where(wrong, np.nan, sensor.value))
    return sensor, notes


STUCK, FEWEST_STUCK = 0.1, 24  # share and number of equal readings that mark a stuck sensor


def _stuck(value: Floats) -> NDArray[np.bool_]:
    """Return a mask (n,) of long runs of equal readings, in a series that otherwise varies."""
    same = np.zeros(len(value), bool)
    change = np.flatnonzero(np.diff(value) != 0.0)  # also on either side of a gap
    ends = np.concatenate([[-1], change, [len(value) - 1]])
    for before, end in pairwise(ends):
        length = end - before
        if length >= max(STUCK * len(value), FEWEST_STUCK) and np.isfinite(value[end]):
            same[before + 1 : end + 1] = True
    rest = value[~same]
    lively = rest.size > FEWEST and 2 * np.count_nonzero(np.diff(rest)) > rest.size
    return same & lively


AIR = instrument_text.AIR / 1.0082  # excess depth by air pressure [m], at 1.0082 dbar/m of water
NEAR_AIR, ON_DECK = 2.5, 0.6  # tolerances for the excess `AIR`: in calm water, and on deck [m]


def air_notes(depth: Floats, place: Floats) -> list[str]:
    """Return a remark if all depths seem to include atmospheric pressure.

    `depth` (n, s) are measured depths, and `place` (s,) depths in still water [m]. The sensor with
    the smallest excess of depth decides, because currents increase the excess.
    """
    off = np.array([_least(column) for column in depth.T]) - place
    alike = float(np.min(off[np.isfinite(off)], initial=np.inf))
    if abs(alike - AIR) > NEAR_AIR:
        return []
    return [
        f"the minimum depth of each sensor exceeds its depth in the mooring file by {alike:.1f} m "
        "or more. The pressures appear to be absolute: `--correct air` subtracts the "
        "pressure of the air, 10.13 dbar. Without this option, the pressures are not corrected, "
        "and CALM attributes the difference to an error of the water depth"
    ]


# Limits for the remark that all readings have another unit: the errors that may remain after
# conversion, as a share of the errors as read and of the standard deviation of these errors; and
# the least error as read [m]. Random errors of 1 to 20 m for each sensor, with or without a common
# error, pass these limits in at most 0.3 % of trials
EXPLAINED, BEYOND, LEAST = 0.05, 0.2, 1.0


def metre_notes(measured: Floats, expected: Floats, latitude: float) -> list[str]:
    """Return a remark if depths in metres seem to be recorded as pressures in dbar, or the reverse.

    Such readings give measured depths (s,) that differ by about 1 % from the expected depths (s,)
    [m]. The expected depths must not depend on these readings. A remark is returned only if the
    depths agree after conversion of the unit, without a common offset.
    """
    off = measured - expected
    if len(off) < 2 or not rms(off) > LEAST:
        return []
    for true, sign, cause in (
        (pressure_at(measured, latitude), "low", "depths in metres were recorded as dbar"),
        (
            depth_of(measured, latitude),
            "high",
            "pressures in dbar were recorded as depths in metres",
        ),
    ):
        # no common offset is allowed, because an offset and a wrong length of the line together
        # would have the same effect as another unit
        left = rms(true - expected)
        if left <= min(EXPLAINED * rms(off), BEYOND * float(off.std())):
            share = 100.0 * float(np.abs(measured / true - 1.0).mean())
            return [
                f"all sensors: their readings are {share:.1f} % {sign}, as if {cause}; CALM "
                "does not correct them"
            ]
    return []


def unusable(labels: Sequence[str], depth: Floats, place: Floats) -> dict[str, str]:
    """Return the reason for each label of an unusable sensor.

    `depth` (n, s) are measured depths, and `place` (s,) depths in still water [m]. Raise UsageError
    if two labels are exchanged, or if at least half of the sensors are far from their places.
    """
    reasons: dict[str, str] = {}
    far_off: dict[str, str] = {}
    least = np.array([_least(column) for column in depth.T])
    exchanged = _exchanged(labels, least, place)
    units = _other_unit(least, place)
    for j, label in enumerate(labels):
        known = depth[:, j][np.isfinite(depth[:, j])]
        far = abs(least[j] - place[j]) > MISPLACED and not 0.5 < least[j] / place[j] < 2.0
        if not known.size:
            reasons[label] = "has no good pressure at any time step of the currents"
        elif known.size > 2 and np.ptp(known) <= CONSTANT:
            reasons[label] = f"is constant at {known[0]:.1f} m and was excluded"
        elif (far or units) and not any(f"`{label}`" in one for one in exchanged):
            doubted = "sign" if least[j] < -MISPLACED else f"unit ({units or 'bar, kPa?'})"
            far_off[label] = (
                f"is at {least[j]:.1f} m at its shallowest, but at {place[j]:.1f} m in the mooring "
                f"file: its {doubted} or its label is wrong"
            )
    if exchanged or 2 * len(far_off) >= max(len(labels) - len(reasons), 1):
        doubts = [*exchanged, *(f"`{label}` {reason}" for label, reason in far_off.items())]
        if doubts:
            raise UsageError("--pressures: " + "; ".join(doubts))
    return reasons | {one: f"{reason}; it was excluded" for one, reason in far_off.items()}


def _least(depth: Floats) -> float:
    known = depth[np.isfinite(depth)]
    return float(np.percentile(known, 5.0)) if known.size else float("nan")


def _exchanged(labels: Sequence[str], least: Floats, place: Floats) -> list[str]:
    """Return a remark for each pair of sensors that appear in the reverse order of depth."""
    return [
        f"`{labels[i]}` is at {least[i]:.1f} m at its shallowest and `{labels[j]}` at "
        f"{least[j]:.1f} m, but the mooring file has them at {place[i]:.1f} m and "
        f"{place[j]:.1f} m: their labels are exchanged"
        for i, j in combinations(range(len(labels)), 2)
        if abs(place[j] - place[i]) > APART
        and min(least[i], least[j]) > -MISPLACED
        and -1.5 < (least[j] - least[i]) / (place[j] - place[i]) < -0.6
    ]


def _other_unit(least: Floats, place: Floats) -> str:
    """Return a confusion of units that explains all depths, such as "psi for dbar?", or ""."""
    known = np.isfinite(least)
    for unit, ratio in UNITS.items():
        meant = ratio * place[known]
        near = np.abs(least[known] - meant) < ALIKE * min(known.sum(), 2) * meant
        if known.any() and near.all() and (np.abs(meant - place[known]) > MISPLACED).any():
            return unit
    return ""
