"""Read a `.mat` file of Mooring Design & Dynamics as a design."""

from __future__ import annotations

import math
from dataclasses import replace
from pathlib import Path

import numpy as np

from calm.errors import refused
from calm.exchange.design import (
    CurrentRecord,
    Design,
    ImportedPiece,
    ImportedTow,
    ImportedWater,
    Remark,
)
from calm.exchange.mat_file import MatVariables, RealArray, read_variables
from calm.exchange.mdd_elements import (
    MddElement,
    anchor_of,
    component_of,
    read_elements,
    rides_by_buoyancy,
    rigid,
)
from calm.quantities import bearing_of

GROUPS = ("floats", "wires", "chains", "acrels", "cms", "anchors", "miscs")
"""The variables of a library that hold elements."""

_WANTED = frozenset(
    ["U", "V", "W", "z", "rho", "time", "ZCO", "Jobj", "Pobj", "mooreleCO", "HCO", "BCO", "CdCO"]
    + [f"{name}{end}" for name in ("H", "B", "Wt", "Cd", "ME", "moorele") for end in ("", "t")]
    + ["Usp", "Vsp", "afh", *GROUPS]
)
_STRETCHED = 1.2  # times its length, a line may reach the surface
_APART = 0.02  # m and share of the piece by which the two places of a clamp may differ
_NOTE = (
    "cn and cx are its Cd. In that program drag along a line or cylinder is negligible, so ct is "
    "0. See `calm docs import-mdd`."
)
_MATLAB_EPOCH = 719529.0  # datenum of 1 January 1970
_EARLIEST, _LATEST = 500_000.0, 1_000_000.0  # datenums that are dates of this age


def read_mdd(path: Path) -> Design:
    """Read a mooring or a tow.

    InputError: the file is damaged, is none of that program, or holds what CALM cannot represent.
    """
    variables = read_variables(path, _WANTED)
    sized = [name for name in ("H", "Ht") if variables.row(name).size]
    if not sized and any(group in variables for group in GROUPS):
        raise refused(
            path,
            "is the element library of that program, not a mooring; a list takes its "
            "figures: --elements FILE",
        )
    if not sized:
        raise refused(path, "holds no mooring (`H`) and no tow (`Ht`) of that program")
    towed = sized[0] == "Ht"
    elements, problems = read_elements(variables, "t" if towed else "")
    clamped, more = read_elements(variables, "CO")
    if problems or more:
        raise refused(path, *problems, *more)
    guessed: list[Remark] = []
    try:
        water, record = read_water(variables, towed, guessed)
    except ValueError as error:
        raise refused(path, str(error)) from None
    design = Design(
        program="Mooring Design & Dynamics",
        name=path.stem,
        items=[],
        water=water,
        record=record,
        guessed=guessed,
        notes=[_NOTE],
        in_kilograms=True,
    )
    if record is not None:
        design.notes.append("The current is the first profile of the record beside this file.")
    (_lay_tow if towed else _lay_mooring)(design, elements, variables, path)
    _clamp(design, clamped, variables, towed, path)
    return design


def _lay_mooring(
    design: Design, elements: list[MddElement], variables: MatVariables, path: Path
) -> None:
    last = elements[-1]
    if last.is_line or len(elements) < 2 or last.lift == 0.0:
        raise refused(path, f"element {last.number}, {last.name}, is not an anchor with a weight")
    design.items = [_item(element) for element in elements[:-1]]
    design.items.append(ImportedPiece(anchor_of(last)))
    depth = design.water.depth if design.water is not None else None
    if depth is None or _STRETCHED * sum(item.extent for item in design.items) >= depth:
        design.items[0] = _item(replace(elements[0], mass=None))
        rides_by_buoyancy(design.items[0].component)


def _lay_tow(
    design: Design, elements: list[MddElement], variables: MatVariables, path: Path
) -> None:
    """Lay a tow: the file runs from the body up, and ends with a mark for the ship."""
    end = elements[-1]
    if not end.is_line and end.length <= 0.01 and abs(end.lift) <= 0.011 and len(elements) > 1:
        elements = elements[:-1]
    design.items = [_item(element) for element in reversed(elements)]
    east, north = variables.first("Usp"), variables.first("Vsp")
    speed = math.hypot(east, north)
    if speed == 0.0:
        raise refused(path, "the ship of this tow does not move (`Usp`, `Vsp`)")
    design.tow = ImportedTow(speed, bearing_of(east, north))
    height = variables.first("afh")
    if height > 0.0:
        what = f"an A-frame of {height:g} m is only drawn: the wire counts from the water"
        design.dropped.append(Remark("afh", what))


def _item(element: MddElement) -> ImportedPiece:
    component = component_of(element)
    return ImportedPiece(component, element.length if element.is_line else None)


def _clamp(
    design: Design,
    clamped: list[MddElement],
    variables: MatVariables,
    towed: bool,
    path: Path,
) -> None:
    """Hang what is clamped on: by element and share of its length, counted from its lower end."""
    if not clamped:
        return
    host, share, height = (variables.row(name).tolist() for name in ("Jobj", "Pobj", "ZCO"))
    by_share = len(host) == len(share) == len(clamped)
    by_height = len(height) == len(clamped)
    if not by_share and not by_height:
        counts = f"`Jobj` {len(host)}, `Pobj` {len(share)}, `ZCO` {len(height)}"
        raise refused(path, f"{len(clamped)} clamps without their places: {counts}")
    for i, element in enumerate(clamped):
        above = _by_height(design.items, height[i], towed) if by_height else None
        if by_share:
            place = _by_share(design.items, host[i], share[i], towed)
            if place is None:
                raise refused(path, f"{element.name} is clamped on element {host[i]:g}: none")
        else:
            place = above
        if place is None:
            raise refused(path, f"{element.name} is clamped at {height[i]:g} m, off the line")
        number, at = place
        guess = ""
        if by_share and above is not None and not _agree(place, above):
            guess = f"`ZCO` has it at {height[i]:g} m, elsewhere than `Jobj` and `Pobj`"
        elif not by_share:
            guess = "from its height alone"
        design.items[number].clamp(rigid(element), at, guess)


def _by_share(
    items: list[ImportedPiece], host: float, share: float, towed: bool
) -> tuple[int, float] | None:
    """Return the piece that an element became, and how far below its upper end a share of it is."""
    number = round(host) - 1
    if towed:
        number = len(items) - 1 - number
    if not (0 <= number < len(items)) or not -1e-6 <= share <= 1.0 + 1e-6:
        return None
    # in a tow the program counts from the body up: from the lower end, too
    length = items[number].extent
    return number, min(max((1.0 - share) * length, 0.0), length)


def _by_height(items: list[ImportedPiece], height: float, towed: bool) -> tuple[int, float] | None:
    """Return the piece at a height above the seabed (in a tow above the lower end of the body)."""
    below = 0.0
    for number in range(len(items) - 1, -1, -1):
        length = items[number].extent
        if below <= height <= below + length and length > 0.0:
            return number, length - (height - below)
        below += length
    return None


def _agree(one: tuple[int, float], other: tuple[int, float]) -> bool:
    return one[0] == other[0] and abs(one[1] - other[1]) <= _APART + _APART * abs(one[1])


def read_water(
    variables: MatVariables, towed: bool, guessed: list[Remark]
) -> tuple[ImportedWater | None, CurrentRecord | None]:
    """Return the environment of a file, and the record where it has several profiles.

    In a mooring `z` is the height above the seabed and its greatest the depth of the water, in a
    tow it is the depth. The current is the first profile of the record.

    Parameters
    ----------
    variables : of the file
    towed : whether it is a tow
    guessed : to which what is guessed about times and density is added

    Raises
    ------
    ValueError
        The sizes of the variables do not go together.
    """
    levels = variables.reals("z").ravel()
    if levels.size == 0 or not np.any(levels > 0.0):
        return None, None
    if not np.all(np.isfinite(levels)) or np.any(levels < 0.0):
        raise ValueError("`z` must be heights of 0 and more")
    seabed = float(levels.max())
    profiles = [_profiles(variables, name, levels.size) for name in "UVW"]
    if profiles[0] is None and profiles[1] is None:
        return None, None
    times = max(each.shape[1] for each in profiles if each is not None)
    u, v, w = (
        _filled(each, name, levels.size, times) for each, name in zip(profiles, "UVW", strict=True)
    )
    densities = _profiles(variables, "rho", levels.size)
    density = np.zeros(0) if densities is None else densities[:, 0]
    if densities is not None and densities.shape[1] > 1:
        if not np.all(np.isfinite(density)):
            raise ValueError("`rho` has gaps in its first profile")
        what = f"the first of {densities.shape[1]} profiles; a mooring has one density"
        guessed.append(Remark("environment.density", what))
    depth = np.sort(levels) if towed else seabed - levels
    order = np.arange(levels.size) if towed else np.argsort(depth, kind="stable")
    depth = depth if towed else depth[order]
    u, v, w = u[order], v[order], w[order]
    keep = np.append(True, np.diff(depth) > 0.0)
    water = ImportedWater(None if towed else seabed)
    if density.size:
        rows = list(zip(depth[keep].tolist(), density[order][keep].tolist(), strict=True))
        alike = all(row[1] == rows[0][1] for row in rows)
        water.density = rows[0][1] if alike else tuple(rows)
    first = np.column_stack([depth, u[:, 0], v[:, 0], w[:, 0]])[keep]
    if np.any(first[:, 1:]) or times > 1:
        water.current = tuple((float(d), float(e), float(n), float(up)) for d, e, n, up in first)
    if times == 1:
        return water, None
    days, epoch = _days(variables.reals("time").ravel(), times, guessed)
    return water, CurrentRecord(days, epoch, depth[keep], u[keep].T, v[keep].T, w[keep].T)


def _profiles(variables: MatVariables, name: str, levels: int) -> RealArray | None:
    """Speeds by level and time: one profile lies down or stands, several have a row a level."""
    values = variables.reals(name)
    if values.size == 0:
        return None
    values = np.atleast_2d(values)
    if values.ndim == 2 and values.shape[0] == levels:
        return values
    if values.ndim == 2 and values.shape[1] == levels:
        return values.T
    shape = "×".join(str(length) for length in values.shape)
    raise ValueError(f"`{name}` is {shape} for {levels} values of `z`")


def _filled(values: RealArray | None, name: str, levels: int, times: int) -> RealArray:
    if values is None:
        return np.zeros((levels, times))
    if values.shape[1] not in (1, times):
        raise ValueError(f"`{name}` has {values.shape[1]} profiles, the others {times}")
    if not np.all(np.isfinite(values[:, 0])):
        raise ValueError(f"`{name}` has gaps in its first profile")
    return np.broadcast_to(values, (levels, times))


def _days(time: RealArray, times: int, guessed: list[Remark]) -> tuple[RealArray, str]:
    """Days, and the date from which they count."""
    if time.size != times:
        guessed.append(Remark("record.time", "an hour between profiles, from 2000-01-01"))
        return np.arange(times) / 24.0, "2000-01-01"
    if np.all((time > _EARLIEST) & (time < _LATEST)):
        return time - _MATLAB_EPOCH, "1970-01-01"
    guessed.append(Remark("record.time", "days from 2000-01-01"))
    return time - time[0], "2000-01-01"
