"""Write a line as a `.mat` file of Mooring Design & Dynamics."""

import io
import math

import numpy as np

from calm.exchange.exported_parts import ExportedDesign, ExportedLine, ExportedPart
from calm.exchange.registry import Exported
from calm.files import Chain, Cylinder, Sphere
from calm.physics.seawater import REFERENCE_DENSITY
from calm.units import KILOGRAM_FORCE

_HALF_DENSITY = 0.5 * REFERENCE_DENSITY
_LONGEST = 32  # characters of a name
_LEAST_USED = 1e-3  # smallest used share of the buoyancy of a float, as a divisor


def write_mdd(exported: ExportedDesign) -> Exported:
    """Write a line as a `.mat` file of MATLAB version 5."""
    (design,) = exported.legs
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
            lost.append(
                "the height of the sheave: in Mooring Design & Dynamics the wire "
                "begins at the water"
            )
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
        f"moorele{suffix}": _character_matrix(names),
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
            "the hull of the float: Mooring Design & Dynamics makes draft and drag proportional "
            "to the buoyancy in use; the exported Cd gives the drag that CALM computes in this "
            "current"
        )
    losses = design.losses(lost)
    variables["lost"] = _character_matrix([f"{design.name}, exported by CALM without:", *losses])
    content = io.BytesIO()
    savemat(content, variables, format="5", oned_as="row")
    return Exported(content.getvalue(), losses)


def _column(part: ExportedPart, lost: list[str]) -> tuple[float, ...]:
    """Return length, width, diameter, flag, buoyancy [kg], Cd, modulus [Pa] and mass of a part."""
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
    """Return width, diameter and Cd of an element with the same drag as a rigid part."""
    component = part.component
    if part.kn == 0.0:
        return 0.0, 0.0, 0.0
    if isinstance(component, Sphere):
        across = component.diameter
        return 0.0, across, part.kn / (_HALF_DENSITY * math.pi / 4.0 * across**2)
    if part.directional and part.length > 0.0:
        if part.kt > 0.0:
            lost.append(
                "drag on the ends of cylinders (ct), and drag of bodies along the line (kt)"
            )
        if isinstance(component, Cylinder):
            across = component.diameter
            return across, 0.0, part.kn / (_HALF_DENSITY * across * part.length)
        return part.area() / part.length, 0.0, 1.0
    if not isinstance(component, Cylinder):
        lost.append(
            "shapes of bodies: each body is written as a sphere or cylinder with Cd = 1 and the "
            "same drag"
        )
    return 0.0, math.sqrt(4.0 * part.area() / math.pi), 1.0


def _clamped(design: ExportedLine, lost: list[str]) -> dict[str, object]:
    """Return the variables for clamped parts, from the top down.

    `Jobj` is the number of the element that carries the clamp. `Pobj` is the fraction of this
    element's length below the clamp, and `ZCO` the height of the clamp [m].
    """
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
        "mooreleCO": _character_matrix(names),
        "Jobj": where[:1],
        "Pobj": where[1:2],
        "ZCO": where[2:],
        "Iobj": np.zeros((0, 0)),
    }


def _name(part: ExportedPart) -> str:
    # Mooring Design & Dynamics recognises chains by this word
    bare = isinstance(part.component, Chain) and "chain" not in part.use
    return (f"chain {part.use}" if bare else part.use)[:_LONGEST]


def _character_matrix(texts: list[str]) -> np.ndarray[tuple[int, ...], np.dtype[np.str_]]:
    width = max(len(text) for text in texts)
    plain = [text.encode("ascii", "replace").decode() for text in texts]
    return np.array([text.ljust(width) for text in plain])
