"""Read a `.mat` file of Mooring Design & Dynamics as a design, and write a line as one."""

import io
import math
from dataclasses import replace
from pathlib import Path

import numpy as np

from calm.errors import refused
from calm.exchange import mdd_elements, model
from calm.exchange.exported_parts import ExportedLine, ExportedPart
from calm.exchange.mat_file import MatVariables, RealArray, read_variables
from calm.exchange.mdd_elements import MddElement
from calm.files import Chain, Cylinder, Sphere
from calm.physics.seawater import REFERENCE_DENSITY
from calm.quantities import bearing_of
from calm.units import KILOGRAM_FORCE

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


def read_mdd(path: Path) -> model.ImportedDesign:
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
    elements, problems = mdd_elements.read_elements(variables, "t" if towed else "")
    clamped, more = mdd_elements.read_elements(variables, "CO")
    if problems := [*problems, *more]:
        raise refused(path, *problems)
    program = "Mooring Design & Dynamics"
    design = model.ImportedDesign(program, path.stem, [], None, notes=[_NOTE], in_kilograms=True)
    try:
        design.water, design.record = read_water(variables, towed, design.guessed)
    except ValueError as error:
        raise refused(path, str(error)) from None
    if design.record is not None:
        design.notes.append("The current is the first profile of the record beside this file.")
    if towed:
        _lay_tow(design, elements, variables, path)
    else:
        _lay_mooring(design, elements, path)
    if clamped:
        _clamp(design, clamped, variables, path)
    return design


def _lay_mooring(design: model.ImportedDesign, elements: list[MddElement], path: Path) -> None:
    last = elements[-1]
    if last.is_line or len(elements) < 2 or last.lift == 0.0:
        raise refused(path, f"element {last.number}, {last.name}, is not an anchor with a weight")
    design.items = [mdd_elements.piece_of(element) for element in elements[:-1]]
    design.items.append(model.ImportedPiece(mdd_elements.anchor_of(last)))
    depth = design.water.depth if design.water is not None else None
    if depth is None or _STRETCHED * sum(item.extent for item in design.items) >= depth:
        design.items[0] = mdd_elements.piece_of(replace(elements[0], mass=None))
        mdd_elements.rides_by_buoyancy(design.items[0].component)


def _lay_tow(
    design: model.ImportedDesign, elements: list[MddElement], variables: MatVariables, path: Path
) -> None:
    """Lay a tow: the file runs from the body up, and ends with a mark for the ship."""
    end = elements[-1]
    if not end.is_line and end.length <= 0.01 and abs(end.lift) <= 0.011 and len(elements) > 1:
        elements = elements[:-1]
    design.items = [mdd_elements.piece_of(element) for element in reversed(elements)]
    east, north = variables.first("Usp"), variables.first("Vsp")
    speed = math.hypot(east, north)
    if speed == 0.0:
        raise refused(path, "the ship of this tow does not move (`Usp`, `Vsp`)")
    design.tow = model.ImportedTow(speed, bearing_of(east, north))
    height = variables.first("afh")
    if height > 0.0:
        what = f"an A-frame of {height:g} m is only drawn: the wire counts from the water"
        design.dropped.append(model.Remark("afh", what))


def _clamp(
    design: model.ImportedDesign, clamped: list[MddElement], variables: MatVariables, path: Path
) -> None:
    """Hang what is clamped on: by element and share of its length, counted from its lower end."""
    host, share, height = (variables.row(name).tolist() for name in ("Jobj", "Pobj", "ZCO"))
    by_share = len(host) == len(share) == len(clamped)
    by_height = len(height) == len(clamped)
    if not by_share and not by_height:
        counts = f"`Jobj` {len(host)}, `Pobj` {len(share)}, `ZCO` {len(height)}"
        raise refused(path, f"{len(clamped)} clamps without their places: {counts}")
    for i, element in enumerate(clamped):
        above = _by_height(design.items, height[i]) if by_height else None
        place, guess = above, "from its height alone"
        if by_share:
            place, guess = _by_share(design, host[i], share[i]), ""
            if place is None:
                raise refused(path, f"{element.name} is clamped on element {host[i]:g}: none")
            if above is not None and not _agree(place, above):
                guess = f"`ZCO` has it at {height[i]:g} m, elsewhere than `Jobj` and `Pobj`"
        if place is None:
            raise refused(path, f"{element.name} is clamped at {height[i]:g} m, off the line")
        design.items[place[0]].clamp(mdd_elements.rigid(element), place[1], guess)


def _by_share(design: model.ImportedDesign, host: float, share: float) -> tuple[int, float] | None:
    """Return the piece that an element became, and how far below its upper end a share of it is."""
    count, number = len(design.items), round(host) - 1
    if design.tow is not None:
        number = count - 1 - number
    if not (0 <= number < count) or not -1e-6 <= share <= 1.0 + 1e-6:
        return None
    # in a tow the program counts from the body up: from the lower end, too
    length = design.items[number].extent
    return number, min(max((1.0 - share) * length, 0.0), length)


def _by_height(items: list[model.ImportedPiece], height: float) -> tuple[int, float] | None:
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
    variables: MatVariables, towed: bool, guessed: list[model.Remark]
) -> tuple[model.ImportedWater | None, model.CurrentRecord | None]:
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
    if not np.any(levels > 0.0):
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
        guessed.append(model.Remark("environment.density", what))
    order = np.arange(levels.size) if towed else np.argsort(seabed - levels, kind="stable")
    depth = np.sort(levels) if towed else (seabed - levels)[order]
    u, v, w = u[order], v[order], w[order]
    keep = np.append(True, np.diff(depth) > 0.0)
    water = model.ImportedWater(None if towed else seabed)
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
    return water, model.CurrentRecord(days, epoch, depth[keep], u[keep].T, v[keep].T, w[keep].T)


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


def _days(time: RealArray, times: int, guessed: list[model.Remark]) -> tuple[RealArray, str]:
    """Days, and the date from which they count."""
    if time.size != times:
        guessed.append(model.Remark("record.time", "an hour between profiles, from 2000-01-01"))
        return np.arange(times) / 24.0, "2000-01-01"
    if np.all((time > _EARLIEST) & (time < _LATEST)):
        return time - _MATLAB_EPOCH, "1970-01-01"
    guessed.append(model.Remark("record.time", "days from 2000-01-01"))
    return time - time[0], "2000-01-01"


_HALF_DENSITY = 0.5 * REFERENCE_DENSITY
_LONGEST = 32  # characters of a name
_LEAST_USED = 1e-3  # share of the buoyancy, for a float that hardly any is used of


def mdd_file(design: ExportedLine) -> tuple[bytes, tuple[str, ...]]:
    """Return the content of the file, MATLAB 5, and what it cannot hold."""
    from scipy.io import savemat

    lost: list[str] = []
    parts = list(design.parts)
    rows = [_column(part, lost) for part in parts]
    if design.afloat:
        used, seen = design.riding
        rows[0] = (*rows[0][:5], rows[0][5] * seen / max(used, _LEAST_USED), *rows[0][6:])
    names = [_name(part) for part in parts]
    variables: dict[str, object] = {}
    suffix = ""
    if design.tow is not None:
        suffix = "t"
        rows = [*rows[::-1], (0.0, 0.0, 0.0, 0.0, 0.01, 0.01, np.inf, 0.0)]
        names = [*names[::-1], "Top of Tow Rope"]
        variables |= {"Usp": design.tow.east, "Vsp": design.tow.north, "afh": design.tow.height}
        if design.tow.height:
            lost.append("the height of the sheave: there the wire counts from the water")
    else:
        assert design.anchor is not None
        anchor, weight = design.anchor
        rows.append((anchor.length, 1.0, 0.0, 0.0, -weight / KILOGRAM_FORCE, 1.3, np.inf, 0.0))
        names.append("anchor")
    figures = np.array(rows, np.float64).T
    variables |= {
        f"H{suffix}": figures[:4],
        f"B{suffix}": figures[4:5],
        f"Cd{suffix}": figures[5:6],
        f"ME{suffix}": figures[6:7],
        f"moorele{suffix}": _texts(names),
        "time": np.zeros((0, 0)),
    }
    if not suffix:
        variables["Wt"] = figures[7:8]
    depth, *columns = np.array(design.levels).T
    heights = depth if suffix else design.depth - depth  # above the seabed, in a tow depths
    levels = zip(("z", "U", "V", "W", "rho"), (heights, *columns), strict=True)
    variables |= {name: values.reshape(-1, 1) for name, values in levels}
    variables |= _clamped(design, lost)
    if any(design.wind):
        lost.append("wind")
    if design.afloat:
        lost.append(
            "the hull of the float: there it sinks, and drags, in proportion to the buoyancy it "
            "uses; its Cd is such that it drags as here in this current"
        )
    losses = design.losses(lost)
    variables["lost"] = _texts([f"by CALM from {design.name}; lost:", *losses])
    content = io.BytesIO()
    savemat(content, variables, format="5", oned_as="row")
    return content.getvalue(), losses


def _column(part: ExportedPart, lost: list[str]) -> tuple[float, ...]:
    """Length, width, diameter, flag, buoyancy [kg], Cd, modulus and mass of a column."""
    lift = part.net / KILOGRAM_FORCE
    if part.flexible:
        if part.kt > 0.0:
            lost.append("drag along cables and chains (ct)")
        across = part.diameter
        modulus = part.stiffness / (math.pi / 4.0 * across**2) if part.stiffness else np.inf
        return part.length, across, 0.0, 1.0, lift, part.kn / (_HALF_DENSITY * across), modulus, 0.0
    width, diameter, drag = _size(part, lost)
    flag = 2.0 if part.role == "connector" else 0.0
    mass = part.mass if part.mass is not None and lift > 0.0 else 0.0
    return part.length, width, diameter, flag, lift, drag, np.inf, mass


def _size(part: ExportedPart, lost: list[str]) -> tuple[float, float, float]:
    """Width, diameter and Cd with which an element drags as the mdd_elements.rigid part does."""
    component = part.component
    if part.kn == 0.0:
        return 0.0, 0.0, 0.0
    if isinstance(component, Sphere):
        across = component.diameter
        return 0.0, across, part.kn / (_HALF_DENSITY * math.pi / 4.0 * across**2)
    if part.directional and part.length > 0.0:
        if part.kt > 0.0:
            lost.append("drag on the ends of cylinders (ct), and of bodies along the line (kt)")
        if isinstance(component, Cylinder):
            across = component.diameter
            return across, 0.0, part.kn / (_HALF_DENSITY * across * part.length)
        return part.area() / part.length, 0.0, 1.0
    if not isinstance(component, Cylinder):
        lost.append("bodies: each is a sphere, or a cylinder, of its drag with Cd 1")
    return 0.0, math.sqrt(4.0 * part.area() / math.pi), 1.0


def _clamped(design: ExportedLine, lost: list[str]) -> dict[str, object]:
    """Return what is clamped on, from the top down, by element and share from its lower end."""
    rows, names, places = [], [], []
    count = len(design.parts)
    top = 0.0 if design.anchor is None else design.anchor[0].length
    below = top + sum(part.length for part in design.parts)
    for i, part in enumerate(design.parts):
        below -= part.length
        for clamp, at in part.clamps:
            width, diameter, drag = _size(clamp, lost)
            lift = clamp.net / KILOGRAM_FORCE
            rows.append((clamp.length, width, diameter, 0.0, lift, drag))
            names.append(_name(clamp))
            number = i + 1 if design.tow is None else count - i
            share = 1.0 - at / part.length if part.length > 0.0 else 0.0
            places.append((number, share, below + part.length - at))
    if not rows:
        return {}
    columns, where = np.array(rows).T, np.array(places).T
    return {
        "HCO": columns[:4],
        "BCO": columns[4:5],
        "CdCO": columns[5:6],
        "mooreleCO": _texts(names),
        "Jobj": where[:1],
        "Pobj": where[1:2],
        "ZCO": where[2:],
        "Iobj": np.zeros((0, 0)),
    }


def _name(part: ExportedPart) -> str:
    """Its id; that of a chain with the word "chain", by which it is recognised."""
    bare = isinstance(part.component, Chain) and "chain" not in part.use
    return (f"chain {part.use}" if bare else part.use)[:_LONGEST]


def _texts(texts: list[str]) -> np.ndarray[tuple[int, ...], np.dtype[np.str_]]:
    """Texts as a character matrix."""
    width = max(len(text) for text in texts)
    plain = [text.encode("ascii", "replace").decode() for text in texts]
    return np.array([text.ljust(width) for text in plain])
