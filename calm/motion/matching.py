"""What was measured, out of files: which sensor hangs where, and which readings can be right."""

from collections.abc import Sequence
from dataclasses import replace
from itertools import combinations
from pathlib import Path

import numpy as np

from calm.case import Mooring
from calm.dataset.discovery import hashed
from calm.errors import UsageError, nearest, not_among
from calm.files.mooring_file import clamps_down
from calm.motion.common_unknowns import FEWEST
from calm.motion.line_places import aligned, distances_of, torn
from calm.motion.line_response import Forward, instruments_of, labels_of
from calm.motion.measurements import FREE, MooringMeasurements, joined, read_currents
from calm.motion.remarks import ALL, Fault
from calm.motion.sensors import Sensor, parse_flags, read_sea_level, read_sensors
from calm.physics.line import Floats
from calm.records.instrument_series import split_label
from calm.records.instrument_text import AIR as AIR_PRESSURE

_MATCHES = ("label", "height", "depth")
GAP = np.timedelta64(2, "h")
"""Longest time between two values that are interpolated, where nothing else is asked for."""


def read_measured(
    mooring: Mooring,
    pressures: Sequence[str],
    currents: Sequence[str] = (),
    match: str = "label",
    flags: str = "1,2",
    gap: np.timedelta64 = GAP,
    sea_level: Path | None = None,
    declination: float | None = None,
    faults: Sequence[Fault] = (),
    absolute: bool = False,
) -> tuple[MooringMeasurements, list[str], dict[str, str]]:
    """Return what was measured, at common times, with notes on what was read and the source files.

    Parameters
    ----------
    pressures, currents : files, as their paths or as ``LABEL=PATH``
    match : by `label`, or by nominal `height` or `depth`
    flags : of the pressures that count as measured, separated by commas
    gap : longest time between two values that are interpolated
    sea_level : the height of the sea surface, as a path
    declination : added to the directions of the currents [degrees]
    faults : of the sensors, that are taken off
    absolute : whether all pressures hold that of the air, which is taken off

    Raises
    ------
    InputError, UsageError
        A file cannot be read, the mooring has no position, or no sensor is left.
    """
    if match not in _MATCHES:
        raise UsageError(not_among("--match", match, _MATCHES))
    position = mooring.file.position
    if position is None:
        raise UsageError(
            f"{mooring.file.path} has no `position`, whose latitude turns pressures into depths"
        )
    place = position.latitude, position.longitude
    seabed = float(mooring.water.depth)
    wanted = parse_flags(flags)
    sensors = read_sensors(pressures, wanted, position.latitude, seabed)
    labels, still = labels_of(mooring), Forward(mooring, {}).still
    notes: list[str] = []
    if match == "label":
        sensors = named_by_serial(sensors, mooring)
        points, notes = matched_by_label(sensors, labels)
    else:
        points = matched_by_place(sensors, instruments_of(mooring), still, labels)
        notes = [
            f"the sensor at {sensors[i].nominal:.1f} m of {sensors[i].source} is `{labels[at]}`"
            for i, at in points.items()
        ]
        sensors = [replace(one, label=labels[points[i]]) for i, one in enumerate(sensors)]
    read = read_currents(
        currents, seabed, place, declination, mooring.file.environment.maximum_speed
    )
    notes += dict.fromkeys(f"{one.source}: {one.note}" for one in sensors if one.note)
    used = []
    for i, at in points.items():
        one = sensors[i]
        one = replace(one, depth=one.depth - AIR * absolute)
        one, said = plausible(corrected(one, faults), float(still[at]), seabed)
        used.append(one)
        notes += said
        if one.dropped:
            notes.append(f"{one.label}: {one.dropped} pressures left out for their flag")
    if not any(np.isfinite(one.depth).any() for one in used):
        raise UsageError("--pressures: no sensor has a good pressure: " + "; ".join(notes))
    level = None if sea_level is None else read_sea_level(sea_level)
    measured = joined(read, used, list(points.values()), labels, still, gap, level)
    notes += [f"{one.source}: {note}" for one in read for note in one.notes]
    notes += air_notes(measured, still)
    lost = unusable(measured, still)
    notes += [f"{label} {reason}" for label, reason in lost.items()]
    measured = without(measured, list(lost))
    if not measured.label:
        raise UsageError("--pressures: no sensor is left: " + "; ".join(notes))
    measured, said = torn(measured, distances_of(mooring))
    notes += said
    source = {
        "currents": ", ".join(hashed(split_label(one)[1]) for one in currents),
        "pressures": ", ".join(hashed(split_label(one)[1]) for one in pressures),
    }
    off = [one.sentence() for one in faults]
    off += ["all sensors: 10.13 dbar, the pressure of the air"] * absolute
    if off:
        source["corrected"] = "taken off: " + "; ".join(off)
    return measured, notes, source


CORRECTABLE = ("clock", "gain", "offset", "drift", "air")
"""What can be taken off what a sensor reads: of `calm.motion.diagnosis.Fault`, and the air."""


def corrected(sensor: Sensor, faults: Sequence[Fault]) -> Sensor:
    """Return what a sensor would have read without its faults."""
    time, depth = sensor.time, sensor.depth
    for one in faults:
        if one.label not in (ALL, sensor.label):
            continue
        if one.kind == "clock":
            time = time - np.timedelta64(round(one.value * 3.6e12), "ns")
        elif one.kind == "gain":
            depth = depth / one.value
        elif one.kind == "offset":
            depth = depth - one.value
        else:
            share = (time - one.since) / (one.until - one.since)
            depth = depth - one.value * np.clip(share, 0.0, 1.0)
    return replace(sensor, time=time, depth=depth)


CERTAIN = 2.0
"""An order of sensors counts as the only one where any other is off by so much more [m]."""


def named_by_serial(sensors: Sequence[Sensor], mooring: Mooring) -> list[Sensor]:
    """Return the sensors, each without a label called as the part that has its serial number.

    One whose number is that of no part, or of several, is called by its number.
    """
    pieces = mooring.file.pieces
    parts = [(one.label, one.serial) for one in clamps_down(pieces)]
    parts += [(one.label, one.serial) for one in pieces]

    def called(number: str) -> str:
        mine = [label for label, own in parts if own and _plain(own) == _plain(number)]
        return mine[0] if len(mine) == 1 else number

    return [
        replace(one, label=called(one.serial)) if one.serial and not one.label else one
        for one in sensors
    ]


def _plain(serial: str) -> str:
    """Return a serial number without zeros before it, in small letters."""
    return serial.strip().lower().lstrip("0")


def matched_by_label(
    sensors: Sequence[Sensor], labels: Sequence[str]
) -> tuple[dict[int, int], list[str]]:
    """Return the point of each sensor whose label a part has, and what is said of the others.

    UsageError: a file does not say what its sensor is called; a label is that of two parts; none is
    of any.
    """
    points: dict[int, int] = {}
    lost: list[str] = []
    for i, sensor in enumerate(sensors):
        if not sensor.label:
            raise UsageError(
                f"{sensor.source} does not say what its sensors are called; give it as "
                f"LABEL={sensor.source}, or match by nominal place, --match height or depth"
            )
        found = [j for j, label in enumerate(labels) if label == sensor.label]
        if len(found) > 1:
            raise UsageError(f"two parts of the line are called `{sensor.label}`: rename one")
        if found:
            points[i] = found[0]
        else:
            near = nearest(sensor.label, labels)
            hint = f"; did you mean `{near}`?" if near else ""
            lost.append(f"`{sensor.label}` of {sensor.source} is not a part of the line{hint}")
    if not points:
        raise UsageError("no sensor is a part of the line: " + "; ".join(lost))
    return points, lost


def matched_by_place(
    sensors: Sequence[Sensor], places: Sequence[int], still: Floats, labels: Sequence[str]
) -> dict[int, int]:
    """Return the point of each sensor by its nominal depth, in their order down the line.

    Of all ways to set the sensors on the instruments without changing their order, the one whose
    depths agree best.

    Parameters
    ----------
    places : points that are instruments
    still : (p,) depths of all points in still water [m]

    Raises
    ------
    UsageError
        A sensor has no nominal place; there are more than instruments; two ways agree alike.
    """
    lacking = [one.label or one.source for one in sensors if not np.isfinite(one.nominal)]
    if lacking:
        raise UsageError(f"--match: no nominal height or depth is given for {', '.join(lacking)}")
    if len(sensors) > len(places):
        raise UsageError(
            f"--match: {len(sensors)} sensors, but the line has {len(places)} instruments"
        )
    order = np.argsort([one.nominal for one in sensors], kind="stable")
    down = sorted(places, key=lambda point: float(still[point]))
    nominal = np.array([sensors[i].nominal for i in order])
    (cost, chosen), second = aligned(nominal, still[down], 1.0, 0.0)
    if second is not None and second[0] - cost < CERTAIN:
        row = next(k for k in range(len(order)) if chosen[k] != second[1][k])
        first, other = labels[down[chosen[row]]], labels[down[second[1][row]]]
        sensor = sensors[order[row]]
        raise UsageError(
            f"--match: the sensor at {sensor.nominal:.1f} m ({sensor.label or sensor.source}) "
            f"may be `{first}` or `{other}`; match by label, or give fewer sensors"
        )
    return {int(i): down[j] for i, j in zip(order, chosen, strict=True)}


CONSTANT = 1e-6
"""A sensor whose depths span no more than this measures nothing [m]."""
MISPLACED = 20.0
"""How far from its place in still water a sensor may be at its least depth [m], where that is
not within a factor of two either."""
UNITS = {"psi for dbar?": 1.45038, "dbar for psi?": 0.68948}
"""How many times too great pressures are whose unit was taken for another."""
ALIKE, APART = 0.03, 3.0
"""How alike that is, twice as much for several; how far apart exchanged sensors are [m]."""
BELOW = 1.1
"""No reading is deeper than the seabed by this factor, and by `MISPLACED`."""


def plausible(sensor: Sensor, place: float, seabed: float) -> tuple[Sensor, list[str]]:
    """Return a sensor without the readings that cannot be from its place, and what is said of them.

    Those far above its place in still water (on deck, a fill value), those far below the seabed,
    and the later ones of a time that stands twice. Where most are so, the sensor is wrong, not
    these readings, and all stay: see `unusable`.

    Parameters
    ----------
    place : depth where it hangs in still water [m]
    seabed : depth of the water [m]
    """
    notes = []
    again = np.zeros(len(sensor.time), bool)
    again[1:] = sensor.time[1:] == sensor.time[:-1]
    if again.any():
        when = np.datetime_as_string(sensor.time[again][0], "s")
        notes.append(
            f"{sensor.label}: {again.sum()} of its times stand twice, the first {when}: the first "
            "reading of each counts"
        )
        sensor = replace(sensor, time=sensor.time[~again], depth=sensor.depth[~again])
    least = min(0.5 * place, place - MISPLACED)
    greatest = max(BELOW * seabed, seabed + MISPLACED)
    deck = sensor.depth[sensor.depth < min(least, 2.0 * AIR)]
    if len(deck) >= FEWEST and np.percentile(np.abs(deck - AIR), 75.0) < ON_DECK:
        notes.append(
            f"{sensor.label}: reads {np.median(deck):.1f} m on deck: its pressures are absolute, "
            "and 10.13 dbar, the air's, are taken off"
        )
        sensor = replace(sensor, depth=sensor.depth - AIR)
    wrong = (sensor.depth < least) | (sensor.depth > greatest)
    if wrong.any() and 2 * wrong.sum() < np.isfinite(sensor.depth).sum():
        first = int(wrong.argmax())
        notes.append(
            f"{sensor.label}: {wrong.sum()} of its readings cannot be from its place, "
            f"{place:.1f} m, and are left out: the first is {sensor.depth[first]:.1f} m, at "
            f"{np.datetime_as_string(sensor.time[first], 's')}"
        )
        sensor = replace(sensor, depth=np.where(wrong, np.nan, sensor.depth))
    return sensor, notes


AIR = AIR_PRESSURE / 1.0082
"""What the pressure of the air adds to a depth by pressure [m], at 1.0082 dbar/m of sea water."""
NEAR_AIR, ON_DECK = 2.5, 0.6
"""How near that is, to what sensors are off in calm water, and to what one reads on deck [m]."""


def air_notes(measured: MooringMeasurements, still: Floats) -> list[str]:
    """Return a sentence where all depths are those of absolute pressures.

    In calm water they are all too great by the pressure of the air, where a current takes them
    deeper still: what counts is the sensor that is the least too deep.
    """
    off = np.array([_least(column) for column in measured.depth.T]) - still[measured.point]
    alike = float(np.min(off[np.isfinite(off)], initial=np.inf))
    if abs(alike - AIR) > NEAR_AIR:
        return []
    return [
        f"all sensors are {alike:.1f} m or more below their places at their least: these pressures "
        "look absolute, 10.13 dbar being the air's. `--correct air` takes it off; else they are "
        "taken as they stand, the depth of the water being wrong, and all depths are from there"
    ]


def unusable(measured: MooringMeasurements, still: Floats) -> dict[str, str]:
    """Return why sensors cannot be used, by label; what cannot be right is refused.

    UsageError: a sensor is nowhere near its place on the line, so that its unit or its label is
    wrong.
    """
    reasons, complaints = {}, []
    least = np.array([_least(column) for column in measured.depth.T])
    complaints += _exchanged(measured.label, least, still[measured.point])
    units = _other_unit(least, still[measured.point])
    for j, label in enumerate(measured.label):
        depth = measured.depth[:, j][np.isfinite(measured.depth[:, j])]
        if not depth.size:
            reasons[label] = "has no good pressure at any time of the currents"
            continue
        if depth.size > 2 and np.ptp(depth) <= CONSTANT:
            reasons[label] = f"is constant at {depth[0]:.1f} m: it is left out"
            continue
        place = float(still[measured.point[j]])
        far = abs(least[j] - place) > MISPLACED and not 0.5 < least[j] / place < 2.0
        if (far or units) and not any(f"`{label}`" in one for one in complaints):
            doubted = "sign" if least[j] < -MISPLACED else f"unit ({units or 'bar, kPa?'})"
            complaints.append(
                f"`{label}` is at {least[j]:.1f} m at its least, where the line has it at "
                f"{place:.1f} m: its {doubted} or its label is wrong"
            )
    if complaints:
        raise UsageError("--pressures: " + "; ".join(complaints))
    return reasons


def _least(depth: Floats) -> float:
    known = depth[np.isfinite(depth)]
    return float(np.percentile(known, 5.0)) if known.size else float("nan")


def _exchanged(labels: Sequence[str], least: Floats, place: Floats) -> list[str]:
    """Return sentences on pairs of sensors that hang the other way round, as deep as each other."""
    return [
        f"`{labels[i]}` is at {least[i]:.1f} m at its least and `{labels[j]}` at {least[j]:.1f} m, "
        f"where the line has them at {place[i]:.1f} m and {place[j]:.1f} m: their labels are "
        "exchanged"
        for i, j in combinations(range(len(labels)), 2)
        if abs(place[j] - place[i]) > APART
        and min(least[i], least[j]) > -MISPLACED
        and -1.5 < (least[j] - least[i]) / (place[j] - place[i]) < -0.6
    ]


def _other_unit(least: Floats, place: Floats) -> str:
    """Return which unit was taken for another, where all depths are so many times too great."""
    known = np.isfinite(least)
    for unit, ratio in UNITS.items():
        meant = ratio * place[known]
        near = np.abs(least[known] - meant) < ALIKE * min(known.sum(), 2) * meant
        if known.any() and near.all() and (np.abs(meant - place[known]) > MISPLACED).any():
            return unit
    return ""


def without(measured: MooringMeasurements, labels: Sequence[str]) -> MooringMeasurements:
    """Return what was measured but for some sensors: hidden everywhere, their currents' depths
    too.
    """
    kept = [i for i, label in enumerate(measured.label) if label not in labels]
    point = measured.point[kept]
    places = point.tolist()
    return replace(
        measured,
        label=tuple(measured.label[i] for i in kept),
        point=point,
        depth=measured.depth[:, kept],
        level_sensor=np.array(
            [places.index(at) if at in places else FREE for at in measured.level_point.tolist()],
            np.int64,
        ),
    )
