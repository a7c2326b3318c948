"""Results of `calm batch` as datasets, made without solving a record."""

import numpy as np
import xarray as xr

import calm

COMPONENTS = ("sphere", "wire", "meter", "rope", "anchor")
CLAMPS = ("sbe37 1", "sbe37 2")
STATUSES = ("converged", "no-equilibrium", "slack", "no-current")
OF_COMPONENT = (
    "depth_top", "x_top", "y_top", "tension_top", "tension_bottom", "tilt", "knockdown",
)  # fmt: skip
OF_CLAMP = ("clamp_depth", "clamp_x", "clamp_y", "clamp_tension", "clamp_tilt", "clamp_knockdown")
OF_ENDS = (
    "top_depth", "anchor_vertical", "anchor_horizontal", "used_buoyancy", "other_used_buoyancy",
)  # fmt: skip

FILE = """
name: Made
environment: {depth: 300 m, current: {speed: 0.2 m/s, toward: 90 deg}}
line:
  - {use: steel, label: sphere}
  - {use: rope, length: 100 m, label: wire, clamps: [{use: logger, at: 10 m, label: sbe37 1},
      {use: logger, at: 20 m, label: sbe37 2}]}
  - {use: current-meter, label: meter}
  - {use: rope, length: 100 m}
  - {use: block, label: anchor}
components:
  steel: {kind: sphere, diameter: 1 m, buoyancy: 4000 N, mass: 100 kg, role: float,
    depth_rating: 150 m}
  rope: {kind: cable, diameter: 10 mm, weight: 0.1 N/m, stiffness: 100 kN, working_load: 10 kN}
  logger: {kind: body, length: 0 m, buoyancy: 0 N, drag_area: 0 m^2, cd: 0, role: instrument}
  current-meter: {kind: body, length: 1 m, buoyancy: -10 N, drag_area: 0.1 m^2, cd: 1,
    role: instrument, max_tilt: 20 deg, warn_tilt: 10 deg}
  block: {kind: anchor, weight: 9 kN}
checks: {maximum_knockdown: 30 m, rating_margin: 30 m}
"""
"""A mooring whose parts are `COMPONENTS` and `CLAMPS`."""


def made_mooring(folder, text=FILE):
    path = folder / "made.yaml"
    path.write_text(text, encoding="utf-8")
    return calm.load(path)


def make_result(
    count=100, begin="2001-01-01T00:00", step="1h", status=None, labels=COMPONENTS, clamps=CLAMPS,
    **columns,
):  # fmt: skip
    """A result in which all that is not given is 1, the anchor at 0; NaN where the status is not 0.

    Columns are (time), for the first component or clamp, or (time, component).
    """
    time = np.datetime64(begin, "ns") + np.arange(count) * _step(step)
    status = np.zeros(count, np.int8) if status is None else np.asarray(status, np.int8)
    variables = {}
    for names, dimension, width in (
        (OF_COMPONENT, "component", len(labels)),
        (OF_CLAMP, "clamp", len(clamps)),
        (OF_ENDS, None, None),
    ):
        for name in names:
            shape = (count,) if width is None else (count, width)
            values = np.ones(shape, np.float32)
            if name in ("x_top", "y_top"):
                values[:, -1] = 0.0  # the anchor is where offsets are counted from
            if name in columns:
                given = np.asarray(columns[name])
                if given.ndim < values.ndim:
                    values[:, 0] = given
                else:
                    values[:] = given
            values[status != 0] = np.nan
            if width != 0:
                variables[name] = (("time", dimension) if dimension else ("time",), values)
    variables["status"] = (
        ("time",),
        status,
        {
            "flag_values": np.arange(len(STATUSES), dtype=np.int8),
            "flag_meanings": " ".join(STATUSES),
        },
    )
    coordinates = {"time": time, "component_label": ("component", np.array(labels))}
    if clamps:
        coordinates["clamp_label"] = ("clamp", np.array(clamps))
    attributes = {"title": "a made result", "input_sha256": "0" * 64, "notes": "none"}
    return xr.Dataset(variables, coordinates, attributes)


def one_profile(result):
    """The batch result that a single `calm run` would make."""
    columns, clamps, top = result.components, result.clamps, result.top
    return make_result(
        count=1,
        labels=tuple(columns.label),
        clamps=tuple(clamps.label),
        **{name: np.atleast_2d(getattr(columns, name)) for name in OF_COMPONENT},
        **{name: np.atleast_2d(getattr(clamps, name.removeprefix("clamp_"))) for name in OF_CLAMP},
        top_depth=[top.depth],
        anchor_vertical=[result.anchor.vertical],
        anchor_horizontal=[result.anchor.horizontal],
        used_buoyancy=[top.used_buoyancy],
        other_used_buoyancy=[result.leg.other_used_buoyancy],
    )


def _step(text):
    return np.timedelta64(int(text[:-1]), text[-1]).astype("timedelta64[ns]")


def stormy(mooring, count, step="1h", seed=1, status=None):
    """A result of a mooring, made: one storm after another, to which all of the line answers."""
    random = np.random.default_rng(seed)
    noise = random.standard_normal(count)
    calm_to_storm = np.empty(count)
    state = 0.0
    for index, push in enumerate(noise):
        state = 0.95 * state + push
        calm_to_storm[index] = state
    force = (np.exp(0.18 * calm_to_storm))[:, None]
    pieces = mooring.file.pieces
    clamps = tuple(clamp.label for piece in pieces for clamp in piece.clamps)
    down = np.linspace(100.0, mooring.water.depth, len(pieces))
    lean = np.linspace(3.0, 0.0, len(pieces))
    sag = np.linspace(5.0, 0.0, len(pieces))
    inner = np.linspace(4.0, 1.0, len(clamps))
    return make_result(
        count,
        step=step,
        status=status,
        labels=tuple(piece.label for piece in pieces),
        clamps=clamps,
        depth_top=down + force * sag,
        x_top=force * sag * 3.0,
        y_top=force * sag,
        tension_top=5000.0 + 100.0 * force + 0.0 * down,
        tension_bottom=4900.0 + 100.0 * force + 0.0 * down,
        tilt=force * lean,
        knockdown=force * sag,
        clamp_depth=200.0 + force * inner,
        clamp_tension=4950.0 + 100.0 * force + 0.0 * inner,
        clamp_tilt=force * inner * 0.7,
        clamp_knockdown=force * inner,
        anchor_vertical=4800.0 + 20.0 * force[:, 0],
        anchor_horizontal=300.0 * force[:, 0],
    )
