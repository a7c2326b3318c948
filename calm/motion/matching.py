"""Which part of the line a sensor, or a current meter, is."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from calm.case import Mooring
from calm.case.parts import clamps_down
from calm.errors import UsageError
from calm.motion.sensors import Sensor
from calm.physics.line import Floats
from calm.suggestions import nearest

CERTAIN = 2.0
"""An order of sensors counts as the only one where any other is off by so much more [m]."""


def labels_of(mooring: Mooring) -> tuple[str, ...]:
    """Labels of all points, see `calm.motion.forward`."""
    pieces = mooring.file.pieces
    return (
        *(clamp.label for clamp in clamps_down(pieces)),
        *(piece.label for piece in pieces),
    )


def instruments_of(mooring: Mooring) -> list[int]:
    """The points that may be instruments: all clamps, and the pieces whose role it is."""
    pieces = mooring.file.pieces
    clamps = len(clamps_down(pieces))
    inline = [clamps + i for i, piece in enumerate(pieces) if piece.component.role == "instrument"]
    return [*range(clamps), *inline]


def matched_by_label(
    sensors: Sequence[Sensor], labels: Sequence[str]
) -> tuple[dict[int, int], list[str]]:
    """The point of each sensor whose label a part has, and what is said of the others.

    Raises
    ------
    UsageError
        A file does not say what its sensor is called; a label is that of two parts; none is of any.
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
    """The point of each sensor by its nominal depth, in their order down the line.

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
    miss = np.abs(
        np.array([sensors[i].nominal for i in order])[:, None] - still[np.array(down)][None, :]
    )
    chosen, whole = _cheapest(miss)
    for row in range(len(order)):
        without = miss.copy()
        without[row, chosen[row]] = np.inf
        other, cost = _cheapest(without)
        if cost - whole < CERTAIN:
            first, second = labels[down[chosen[row]]], labels[down[other[row]]]
            sensor = sensors[order[row]]
            raise UsageError(
                f"--match: the sensor at {sensor.nominal:.1f} m ({sensor.label or sensor.source}) "
                f"may be `{first}` or `{second}`; match by label, or give fewer sensors"
            )
    return {int(i): down[j] for i, j in zip(order, chosen, strict=True)}


def _cheapest(miss: Floats) -> tuple[list[int], float]:
    """Columns, rising, one for each row, whose sum is least, and that sum; infinite without any."""
    rows, columns = miss.shape
    best = np.full((rows + 1, columns + 1), np.inf)
    best[0] = 0.0
    for i in range(rows):
        for j in range(columns):
            best[i + 1, j + 1] = min(best[i + 1, j], best[i, j] + miss[i, j])
    if np.isinf(best[rows, columns]):
        return [], float("inf")
    chosen, j = [], columns
    for i in range(rows, 0, -1):
        while best[i, j - 1] == best[i, j]:
            j -= 1
        chosen.append(j - 1)
        j -= 1
    return chosen[::-1], float(best[rows, columns])
