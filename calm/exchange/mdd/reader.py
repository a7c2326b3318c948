"""Read a `.mat` file of Mooring Design & Dynamics as a design."""

import math
from dataclasses import replace
from pathlib import Path

from calm.errors import refused
from calm.exchange import model
from calm.exchange.mat_file import MatVariables, read_variables
from calm.exchange.mdd.elements import (
    GROUPS,
    MddElement,
    anchor_of,
    piece_of,
    read_elements,
    rides_by_buoyancy,
    rigid,
)
from calm.exchange.mdd.water import read_water
from calm.quantities import bearing_of

_WANTED = frozenset(
    ["U", "V", "W", "z", "rho", "time", "ZCO", "Jobj", "Pobj", "mooreleCO", "HCO", "BCO", "CdCO"]
    + [f"{name}{end}" for name in ("H", "B", "Wt", "Cd", "ME", "moorele") for end in ("", "t")]
    + ["Usp", "Vsp", "afh", *GROUPS]
)
# a line may reach the surface if this multiple of its length is at least the water depth
_STRETCHED = 1.2
_APART = 0.02  # m and share of the piece by which the two places of a clamp may differ
_NOTE = (
    "cn and cx are the Cd of Mooring Design & Dynamics. That program neglects drag along lines "
    "and cylinders, so ct is 0. "
    "See `calm docs import-mdd`."
)


def read_mdd(path: Path) -> model.ImportedDesign:
    """Read a file with a mooring or a tow.

    Raises
    ------
    InputError
        The file is damaged, is not a Mooring Design & Dynamics file, or has features that CALM
        cannot represent.
    """
    variables = read_variables(path, _WANTED)
    sized = [name for name in ("H", "Ht") if variables.row(name).size]
    if not sized and any(group in variables for group in GROUPS):
        raise refused(
            path,
            "is an element library of Mooring Design & Dynamics, not a mooring; use it with "
            "--elements FILE "
            "when you import a list",
        )
    if not sized:
        raise refused(
            path, "contains neither a mooring (`H`) nor a tow (`Ht`) of Mooring Design & Dynamics"
        )
    towed = sized[0] == "Ht"
    elements, problems = read_elements(variables, "t" if towed else "")
    clamped, more = read_elements(variables, "CO")
    if problems := [*problems, *more]:
        raise refused(path, *problems)
    program = "Mooring Design & Dynamics"
    design = model.ImportedDesign(program, path.stem, [], None, notes=[_NOTE], in_kilograms=True)
    try:
        design.water, design.record = read_water(variables, towed, design.guessed)
    except ValueError as error:
        raise refused(path, str(error)) from None
    if design.record is not None:
        design.notes.append(
            "The current is the first profile of the current record, which is in the folder of "
            "this mooring file."
        )
    if towed:
        _lay_tow(design, elements, variables, path)
    else:
        _lay_mooring(design, elements, path)
    if clamped:
        _attach_clamps(design, clamped, variables, path)
    return design


def _lay_mooring(design: model.ImportedDesign, elements: list[MddElement], path: Path) -> None:
    last = elements[-1]
    if last.is_line or len(elements) < 2 or last.lift == 0.0:
        raise refused(
            path, f"the last element, {last.name} ({last.number}), is not an anchor with a weight"
        )
    design.items = [piece_of(element) for element in elements[:-1]]
    design.items.append(model.ImportedPiece(anchor_of(last)))
    depth = design.water.depth if design.water is not None else None
    if depth is None or _STRETCHED * sum(item.extent for item in design.items) >= depth:
        design.sunken = design.items[0].component
        design.items[0] = piece_of(replace(elements[0], mass=None))
        rides_by_buoyancy(design.items[0].component)


def _lay_tow(
    design: model.ImportedDesign, elements: list[MddElement], variables: MatVariables, path: Path
) -> None:
    # the file lists a tow from the body up; the last element may be a marker for the ship
    end = elements[-1]
    if not end.is_line and end.length <= 0.01 and abs(end.lift) <= 0.011 and len(elements) > 1:
        elements = elements[:-1]
    design.items = [piece_of(element) for element in reversed(elements)]
    east, north = variables.first("Usp"), variables.first("Vsp")
    speed = math.hypot(east, north)
    if speed == 0.0:
        raise refused(path, "the ship of this tow must move (`Usp`, `Vsp`)")
    design.tow = model.ImportedTow(speed, bearing_of(east, north))
    height = variables.first("afh")
    if height > 0.0:
        what = (
            f"the A-frame height of {height:g} m, which Mooring Design & Dynamics uses only for "
            "drawings"
        )
        design.dropped.append(model.Remark("afh", what))


def _attach_clamps(
    design: model.ImportedDesign, clamped: list[MddElement], variables: MatVariables, path: Path
) -> None:
    host, share, height = (variables.row(name).tolist() for name in ("Jobj", "Pobj", "ZCO"))
    by_share = len(host) == len(share) == len(clamped)
    by_height = len(height) == len(clamped)
    if not by_share and not by_height:
        counts = f"`Jobj` has {len(host)} values, `Pobj` {len(share)} and `ZCO` {len(height)}"
        message = f"each of the {len(clamped)} clamps needs a position, but {counts}"
        raise refused(path, message)
    for i, element in enumerate(clamped):
        above = _position_by_height(design.items, height[i]) if by_height else None
        place, guess = above, "the position is computed from the height `ZCO` alone"
        if by_share:
            place, guess = _position_by_share(design, host[i], share[i]), ""
            if place is None:
                raise refused(
                    path, f"{element.name} is clamped on element {host[i]:g}, which does not exist"
                )
            if above is not None and not _positions_agree(place, above):
                guess = f"the position is from `Jobj` and `Pobj`; `ZCO` disagrees ({height[i]:g} m)"
        if place is None:
            raise refused(
                path,
                f"{element.name} is clamped at a height of {height[i]:g} m, which is not on the "
                "line",
            )
        design.items[place[0]].clamp(rigid(element), place[1], guess)


def _position_by_share(
    design: model.ImportedDesign, host: float, share: float
) -> tuple[int, float] | None:
    """Return the index of the piece that carries a clamp, and the distance from its upper end [m].

    `host` is the number of the element that carries the clamp, and `share` the fraction of this
    element below the clamp. Return None if `host` or `share` is out of range.
    """
    count, number = len(design.items), round(host) - 1
    if design.tow is not None:
        number = count - 1 - number
    if not (0 <= number < count) or not -1e-6 <= share <= 1.0 + 1e-6:
        return None
    # elements of a tow are numbered from the body up, and shares are from the lower end
    length = design.items[number].extent
    return number, min(max((1.0 - share) * length, 0.0), length)


def _position_by_height(
    items: list[model.ImportedPiece], height: float
) -> tuple[int, float] | None:
    """Return the index of the piece at a height, and the distance from its upper end [m].

    The height is above the seabed, or in a tow above the towed body.
    """
    below = 0.0
    for number in range(len(items) - 1, -1, -1):
        length = items[number].extent
        if below <= height <= below + length and length > 0.0:
            return number, length - (height - below)
        below += length
    return None


def _positions_agree(one: tuple[int, float], other: tuple[int, float]) -> bool:
    return one[0] == other[0] and abs(one[1] - other[1]) <= _APART + _APART * abs(one[1])
