"""Assignment of listed instruments to the parts of a line, under `deployed` in the mooring file."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from calm.case import load
from calm.errors import UsageError
from calm.exchange.instrument_list import ListedInstrument, in_words, read_instrument_list
from calm.files import read_mooring
from calm.files.editing import Draft, EditError, WorkingFile
from calm.files.mooring_file import refuse_all_but_moorings
from calm.motion.line_response import instruments_of
from calm.motion.matching import CERTAIN, in_order, named_point, places_of
from calm.records.current_terms import parse_time, time_text
from calm.records.instrument_series import Identity

# smallest reported difference of nominal and still-water depth: the larger of a share of the depth,
# and a distance in metres
ASTRAY = 0.02, 5.0
_ITEMS = ("deployed", "items")


@dataclass(frozen=True)
class AssignedInstruments:
    """A mooring file to which the instruments of a list have been assigned."""

    text: str  # new text of the file
    # sentences on the assigned instruments, and on doubtful or missing matches
    assigned: tuple[str, ...]
    doubts: tuple[str, ...]


def assign_instruments(path: Path, list_of_instruments: Path) -> AssignedInstruments:
    """Copy serial numbers and clock errors from an instrument list to `deployed` of a mooring file.

    Instruments are matched to parts of the line by name or serial number, or else by nominal depth
    in order down the line.
    """
    mooring = load(path)
    refuse_all_but_moorings(mooring.file)
    line = places_of(mooring)
    listed = read_instrument_list(list_of_instruments, float(line.still[-1]))
    given = [Identity(one.name, one.serial, one.nominal, one.where) for one in listed]
    named = {i: named_point(one, line) for i, one in enumerate(given)}
    points = {i: at for i, at in named.items() if at is not None}
    rest = [i for i in named if i not in points and np.isfinite(given[i].nominal)]
    floats = {
        line.clamps + i
        for i, piece in enumerate(mooring.file.pieces)
        if piece.component.kind == "sphere"
    }
    free = [at for at in instruments_of(mooring) if at not in {*points.values(), *floats}]
    order, _ = in_order([given[i] for i in rest], line, free, 1.0, 0.0, CERTAIN)
    points |= {rest[i]: at for i, at in order.items()}
    draft = Draft(WorkingFile(path).read())
    before = draft.value(_ITEMS) or []
    if not isinstance(before, list):
        raise UsageError(f"{path}: `deployed: items` is not a list")
    rows: dict[str, dict[str, Any]] = {str(row["label"]): dict(row) for row in before}
    assigned, timeless = list[str](), list[ListedInstrument]()
    deployed = mooring.file.deployed
    date = None if deployed is None else deployed.date
    since = np.datetime64("1950") if date is None else parse_time(date)
    doubts = [f"{one.where}: {one.name} {one.serial} matches no part of the line"
              for i, one in enumerate(listed) if i not in points]  # fmt: skip
    twice = {at for at in points.values() if [*points.values()].count(at) > 1}
    for i, at in sorted(points.items(), key=lambda pair: line.still[pair[1]]):
        one, label, still = listed[i], line.label[at], float(line.still[at])
        if at in twice:
            doubts.append(f"{one.where}: two instruments match `{label}`, so neither is assigned")
            continue
        row = rows.setdefault(label, {"label": label})
        if one.serial:
            row["serial"] = one.serial
        remark, clock = one.remark, ""
        if one.clock is not None and one.checked is not None and one.checked > since:
            checked = time_text(one.checked)
            row["clock"] = {"checked": checked, "late": f"{one.clock:g} s"}
            clock = f"; its clock was {in_words(one.clock)} at {checked}"
        elif one.clock is not None:
            remark = f"clock {in_words(one.clock)}"
            timeless.append(one)
        if remark:
            row["remark"] = remark
        name = " ".join(filter(None, (one.name, one.serial)))
        depth = "" if np.isnan(one.nominal) else f", nominally at {one.nominal:g} m"
        assigned.append(f"{one.where}: {name}{depth}: `{label}`, at {still:.1f} m{clock}")
        if abs(one.nominal - still) > max(ASTRAY[0] * still, ASTRAY[1]):
            doubts.append(
                f"{one.where}: {name} is {abs(one.nominal - still):.0f} m from its nominal depth"
            )
    if timeless:
        when = "" if date is None else f"; this time must be after the deployment ({date})"
        doubts.append(
            f"{list_of_instruments.name}: the list gives a clock offset for {len(timeless)} of "
            f"{len(listed)} instruments, but CALM does not correct their times. To correct the "
            "times, add a column `clock checked`: the time at which the clock was compared with "
            f"true time{when}"
        )
    kept = [row for row in rows.values() if len(row) > 1]
    try:
        text = draft.put_at(_ITEMS, kept).text
    except EditError as error:
        raise UsageError(f"{path}: {error}") from None
    read_mooring(path, text=text)
    return AssignedInstruments(text, tuple(assigned), tuple(doubts))
