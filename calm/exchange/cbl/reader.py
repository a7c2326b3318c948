"""Read a WHOI Cable problem file as a design, with its environment and its current file."""

import math
import re
from collections.abc import Callable
from dataclasses import replace
from itertools import pairwise
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from calm.errors import InputError, Problem, refused
from calm.exchange import model
from calm.exchange.cbl.components import ComponentMaker
from calm.exchange.cbl.formulas import UnknownNameError
from calm.exchange.cbl.grammar import (
    CableBranch,
    CableProblem,
    CableTerminal,
    KeyValue,
    KeyValues,
    read_problem,
)
from calm.exchange.cbl.layout import CableLayout
from calm.files.definition import CATALOGUE_DENSITY
from calm.quantities import bearing_of
from calm.whole_file import read_text

_USUAL_GRAVITY = 9.81
"""Gravity in the problems distributed with WHOI Cable, which has no default [m/s²]."""

_REFUSED = {
    "horizontal": "a horizontal array, which has an anchor at each end",
    "positioned": "a line between two fixed points",
    "horizontal-drifter": "a drifting horizontal array",
    "drifter": "a drifting line without anchor",
    "deployment": "a line that is being laid; `calm deck` plans that",
    "riser": "a riser below a platform",
    "webster": "a line under a given tension",
    "tensioned": "a line under a given tension",
}
_MOORED = ("general", "surface", "subsurface", "horizontal", "positioned")
_HEADS = re.compile(
    r"^\s*(problem\s+description|analysis\s+parameters|environment|layout|materials)\b(?!\s*[=:])",
    re.MULTILINE,
)
_FORCES = ("x-force", "y-force", "z-force", "x-thrust", "y-thrust", "z-thrust")
_NOTE = (
    "cn and ct are Cdn and Cdt of WHOI Cable, unchanged: in both programs, Cdn refers to the area "
    "diameter × length, and Cdt to the surface area. See `calm docs import-cable`."
)
_FINEST = 1e-4  # tolerance of the levels, as a share of the fastest current
_HALVINGS = 8
_DIGITS = 9  # digits of a speed in m/s
_WAVES = ("x-wave", "y-wave", "x-input", "y-input", "z-input", "wave-file")
_DYNAMICS = ("forcing-method", "input-type", "velocity-file", "force-file")
_SEABED = ("bottom-stiffness", "bottom-damping", "bottom-elevation")
_Profile = tuple[Callable[[float], float], list[float]]
"""Speed as a function of depth, and the depths at which the slope of this function changes."""

_LARGEST = 20_000_000  # bytes
_MOST = 2_000_000  # speeds
_Grid = tuple[NDArray[np.float64], NDArray[np.float64]]
"""Increasing depths of the levels [m], and (n, 3) velocities in x, y and z [m/s]."""


def is_cbl(content: bytes) -> bool:
    """True if a file has at least two section names of a WHOI Cable problem file."""
    text = content.decode("latin-1").lower()
    return b"\0" not in content and len(set(_HEADS.findall(text))) >= 2


def read_cbl(path: Path, options: model.ImportOptions) -> model.ImportedDesign:
    """Read a problem file with a mooring, a net or a tow.

    Raises
    ------
    InputError
        The file is invalid, or has features that CALM cannot represent. The error lists all
        undefined names.
    """
    given, missing = dict(options.defines), list[Problem]()
    while True:
        try:
            design = _read(path, replace(options, defines=given))
        except UnknownNameError as error:
            missing += error.problems
            if any(name in given or not name.isidentifier() for name in error.names):
                break
            given |= dict.fromkeys(error.names, "1")  # to find other missing names
        except InputError:
            if not missing:
                raise
            break
        else:
            if not missing:
                return design
            break
    raise InputError(missing)


def _read(path: Path, options: model.ImportOptions) -> model.ImportedDesign:
    problem = read_problem(path, options)
    _refuse_unsupported_problems(problem)
    title, environment = problem.description.get("title"), problem.environment
    design = model.ImportedDesign(
        "WHOI Cable", title.text if title and title.text else path.stem, [], None
    )
    design.notes.append(_NOTE)
    design.water = _water_of(problem, design.dropped)
    if problem.analysis:
        design.dropped.append(model.Remark("analysis parameters", "solver settings of WHOI Cable"))
    density = environment.number("rho", "density")
    gravity = environment.number("gravity", default=_USUAL_GRAVITY)
    for key, value in (("density", density), ("gravity", gravity)):
        if value < 0.0 or (key == "gravity" and value == 0.0):
            raise refused(path, f"its {key} is {value:g}")
    makers = ComponentMaker(density or CATALOGUE_DENSITY, gravity, design.dropped)
    layout = CableLayout(problem, makers, design)
    if _is_net(problem):
        layout.lay_net()
    elif problem.kind == "towing":
        layout.lay_tow()
    else:
        layout.lay_mooring()
    friction = problem.environment.number("bottom-friction")
    if friction > 0.0 and problem.kind != "towing":
        design.solver["seabed_friction"] = friction, "bottom-friction of the file"
    known = {"buoy", "platform", "anchor", "mu", "x-speed", "y-speed", "x", "y", "z", *_FORCES}
    for end in problem.terminals:
        found = [key for key in end.values if key not in known]
        if found:
            design.dropped.append(model.Remark("terminal", ", ".join(found)))
    return design


def _is_net(problem: CableProblem) -> bool:
    anchored = all("anchor" in end.values for end in problem.terminals)
    branched = any(isinstance(each, CableBranch) for each in problem.layout)
    return problem.kind != "towing" and (branched or anchored)


def _refuse_unsupported_problems(problem: CableProblem) -> None:
    kind, layout, ends = problem.kind, problem.layout, problem.terminals
    if kind in _REFUSED and not (kind in _MOORED and _is_net(problem)):
        raise problem.description["type"].token.refuse(
            f"`type = {kind}` is {_REFUSED[kind]}; CALM reads moorings, nets of legs and tows"
        )
    if kind not in (*_MOORED, "towing"):
        raise problem.description["type"].token.refuse(f"`type = {kind}` is unknown")
    segments = problem.segments
    if len(ends) != 2 or not segments:
        counts = f"{len(ends)} terminals and {len(segments)} segments"
        raise refused(
            problem.path, f"the layout has {counts}; it needs two terminals and a segment"
        )
    if not all(isinstance(layout[end], CableTerminal) for end in (0, -1)):
        raise refused(problem.path, "the layout must begin and end with a terminal")
    anchored = ["anchor" in end.values for end in ends]
    if any("node" in end.values for end in ends):
        raise ends[1].token.refuse(
            "the layout has a loop, because this end of the line is attached to a node"
        )
    if kind != "towing" and not any(anchored):
        raise ends[0].token.refuse("neither end is an anchor, so the line drifts")
    for values in (*(end.values for end in ends), *(segment.joint for segment in segments)):
        for key in _FORCES:
            if key in values and values[key].at(0.0) != 0.0:
                raise values[key].token.refuse(
                    f"`{key}` is an external force, which CALM does not support"
                )


def _water_of(problem: CableProblem, dropped: list[model.Remark]) -> model.ImportedWater:
    environment = problem.environment
    depth = environment.number("depth")
    water = model.ImportedWater(depth if depth > 0.0 else None)
    water.density = environment.number("rho", "density") or None
    water.gravity = environment.number("gravity", default=_USUAL_GRAVITY)
    if "gravity" not in environment:
        water.guesses["gravity"] = (
            "the file gives no gravity; this is the usual value in WHOI Cable"
        )
    grid = None
    if (value := environment.get("current-file")) is not None:
        grid = _gridded_current(value, problem, dropped)
        if grid is None:
            what = f"the current-file `{value.text}` is missing; still water is assumed"
            water.guesses["current"] = what
    axes = [_profile(environment, axis, grid) for axis in "xyz"]
    angle = 0.0 if grid else environment.number("current-rotation")
    # a tow may have no depth
    water.current = _current(axes, angle, depth if depth > 0.0 else problem.length)
    east, north = (environment.number(f"{axis}-wind") for axis in "xy")
    if east or north:
        water.wind = math.hypot(east, north), bearing_of(east, north)
    for what, keys in (("waves", _WAVES), ("wave forcing", _DYNAMICS), ("the seabed", _SEABED)):
        found = [key for key in keys if key in environment]
        if found:
            dropped.append(model.Remark("environment", f"{what} ({', '.join(found)})"))
    return water


def _current(
    axes: list[_Profile | None], angle: float, deepest: float
) -> tuple[tuple[float, float, float, float], ...]:
    """Return rows of depth [m] and velocity (east, north, up) [m/s] at time 0.

    `axes` are the profiles along x, y and z, `angle` is the rotation of x and y [rad], and
    `deepest` the depth of the last row [m].
    """

    def at(depth: float) -> tuple[float, float, float]:
        x, y, z = (0.0 if axis is None else axis[0](depth) for axis in axes)
        turned = x * math.cos(angle) - y * math.sin(angle)
        return turned, x * math.sin(angle) + y * math.cos(angle), z

    given = [axis for axis in axes if axis is not None]
    inside = {knot for _, knots in given for knot in knots if 0.0 < knot < deepest}
    levels = sorted({0.0, deepest, *inside})
    if not all(knots for _, knots in given):
        levels = _refine_levels(at, levels)
    rows = []
    for depth in levels:
        x, y, z = (round(speed, _DIGITS) + 0.0 for speed in at(depth))
        rows.append((depth, x, y, z))
    return tuple(rows) if any(any(row[1:]) for row in rows) else ()


def _profile(environment: KeyValues, axis: str, grid: _Grid | None) -> _Profile | None:
    scale = environment.number(f"{axis}-current-scale", default=1.0)
    if scale == 1.0:
        scale = environment.number("current-scale", default=1.0)
    if grid is not None:  # scaled in WHOI Cable, but neither modulated nor rotated
        depths, column = grid[0], grid[1][:, "xyz".index(axis)]
        # constant beyond the first and the last level, as in WHOI Cable
        return (lambda depth: scale * float(np.interp(depth, depths, column))), depths.tolist()
    value = environment.get(f"{axis}-current")
    if value is None:
        return None
    modulation = environment.get(f"{axis}-current-modulation")
    if modulation is not None:
        scale *= modulation.at(0.0)
    knots = [row[0].at() for row in value.rows]
    if not knots and value.formula is not None and not value.formula.names:
        knots = [0.0]  # one speed at all depths
    return (lambda depth: scale * value.at(depth)), knots


def _refine_levels(
    at: Callable[[float], tuple[float, float, float]], levels: list[float]
) -> list[float]:
    """Halve intervals until the current is linear between levels, within `_FINEST`."""
    fastest = max(max(map(abs, at(depth))) for depth in levels)
    for _ in range(_HALVINGS):
        finer = [levels[0]]
        for upper, lower in pairwise(levels):
            middle = (upper + lower) / 2.0
            a, b, c = at(upper), at(middle), at(lower)
            fastest = max(fastest, *map(abs, b))
            straight = all(
                abs(y - (x + z) / 2.0) <= _FINEST * fastest for x, y, z in zip(a, b, c, strict=True)
            )
            finer += [lower] if straight and len(levels) > 4 else [middle, lower]
        if len(finer) == len(levels):
            break
        levels = finer
    return levels


def _gridded_current(
    value: KeyValue, problem: CableProblem, dropped: list[model.Remark]
) -> _Grid | None:
    """Read a current file; return None if the file does not exist.

    The file begins with step, start and count of the time, then of depth, x and y. The velocities
    follow, each with components x, y and z. In their order, depth varies fastest, then x, y and
    time.
    """
    folder = problem.path.parent
    path, outside = folder / value.text, problem.options.allow_include
    if not outside and not path.resolve().is_relative_to(folder.resolve()):
        raise value.token.refuse(
            f"`{value.text}` lies outside the folder of the file; use --allow-include to read it"
        )
    if not path.is_file():
        return None
    numbers = _numbers(path)
    steps, starts, counts = (numbers[i:12:3] for i in range(3))
    sizes = [round(count) for count in counts]
    if numbers.size < 12 or min(sizes) < 1 or not np.all(steps):
        raise refused(
            path, "must begin with the step, start and count for each of time, depth, x and y"
        )
    if np.prod([float(size) for size in sizes]) * 3 > _MOST:
        raise refused(path, f"holds more than {_MOST} speeds")
    times, depths, easts, norths = sizes
    wanted = 12 + times * norths * easts * depths * 3
    if numbers.size < wanted:
        raise refused(path, f"has {numbers.size - 12} speeds, not {wanted - 12}")
    speeds = numbers[12:wanted].reshape(times, norths, easts, depths, 3)
    time, depth, x, y = (
        start + step * np.arange(size)
        for start, step, size in zip(starts, steps, sizes, strict=True)
    )
    here = _at_zero(_at_zero(_at_zero(speeds, time), y), x)
    if times > 1:
        dropped.append(model.Remark("current-file", "currents after the first time"))
    if np.ptp(speeds, axis=(1, 2)).any():
        what = "horizontal variation of the current; the profile at the anchor is used"
        dropped.append(model.Remark("current-file", what))
    order = np.argsort(depth)
    return depth[order], here[order]


def _numbers(path: Path) -> NDArray[np.float64]:
    try:
        numbers = np.array(read_text(path, largest=_LARGEST).split(), np.float64)
    except ValueError:
        raise refused(path, "contains text; only numbers are allowed") from None
    if not np.all(np.isfinite(numbers)):
        raise refused(path, "contains NaN or infinite numbers")
    return numbers


def _at_zero(grid: NDArray[np.float64], axis: NDArray[np.float64]) -> NDArray[np.float64]:
    """Interpolate a grid to 0 along its first axis; if 0 is out of range, use the closest end."""
    order = np.argsort(axis)
    axis, grid = axis[order], grid[order]
    place = min(max(0.0, axis[0]), axis[-1])
    above = min(int(np.searchsorted(axis, place)), axis.size - 1)
    below = max(above - 1, 0)
    apart = axis[above] - axis[below]
    share = (place - axis[below]) / apart if above > below else 0.0
    return np.asarray(grid[below] + share * (grid[above] - grid[below]))
