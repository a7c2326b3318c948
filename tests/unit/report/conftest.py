"""A small solved mooring with figures that are easy to check, and every kind of row."""

from types import SimpleNamespace as Record

import numpy as np
import pytest

from calm.case.strumming import StrummingBand
from calm.files import Place
from calm.files.strumming_keys import BourgetMarichalKeys

NAN = float("nan")


class Columns(list):
    """Records that can also be read by column."""

    def __getattr__(self, name):
        return [getattr(record, name) for record in self]


def component(index, use, label, role, length, depth, x, tension, tilt, **figures):
    fields = dict(safety_factor=NAN, utilisation=NAN, knockdown=8.25, planned_depth=NAN) | figures
    return Record(
        index=index, use=use, label=label, role=role, kind="body", length=length,
        cut_length=length, depth_top=depth[0], depth_bottom=depth[1], x_top=x[0], x_bottom=x[1],
        y_top=0.0, y_bottom=0.0, tension_top=tension[0], tension_bottom=tension[1],
        tension=max(tension), tilt=tilt, **fields,
    )  # fmt: skip


def _of_the_file(components, clamps, pieces):
    """Tell every row what it is of."""
    for row, piece in zip(components, pieces, strict=True):
        row.part, row.place = piece, Place(row.index)
        row.upper = row.depth_top, row.x_top, row.y_top
    for row, clamp in zip(clamps, [c for piece in pieces for c in piece.clamps], strict=True):
        row.part, row.upper = clamp, (row.depth, row.x, row.y)


def _solved(leg, fields):
    """A result of one leg, whose figures are its own as well."""
    shared = dict(several=False, towed=leg.towed, water=leg.water)
    own = Record(leg=leg, **shared, **fields)
    own.legs = (own,)
    return Record(design=leg, leg=own, legs=(own,), **shared, **fields)


def build_result(**changes):
    components = Columns(
        [
            component(0, "sphere", "top float", "float", 1.25, (113.2, 114.4), (61.0, 60.9),
                      (0.0, 7003.4), 3.12, safety_factor=17.14, utilisation=0.18),
            component(1, "shackle", "shackle 1", "connector", 0.08, (114.4, 114.5), (60.9, 60.9),
                      (7003.4, 7002.0), 3.5, safety_factor=2.9),
            component(2, "wire-8", "wire-8", "line", 480.0, (114.5, 594.0), (60.9, 40.0),
                      (7002.0, 6000.0), 5.0, safety_factor=6.1),
            component(3, "rcm8", "current meter", "instrument", 0.6, (594.0, 594.6), (40.0, 39.8),
                      (6000.0, 5900.0), 28.4, safety_factor=9.0, utilisation=1.2),
            component(4, "glass", "glass 1", "float", 0.43, (594.6, 595.0), (39.8, 39.7),
                      (5900.0, 6100.0), 6.0),
            component(5, "glass", "glass 2", "float", 0.43, (595.0, 595.4), (39.7, 39.6),
                      (6100.0, 6300.0), 6.0),
            component(6, "rope-14", "rope-14", "line", 500.0, (595.4, 1099.0), (39.6, 0.0),
                      (6300.0, 5210.0), 7.0, safety_factor=4.0),
            component(7, "wheels", "wheels", "anchor", 1.0, (1099.0, 1100.0), (0.0, 0.0),
                      (5210.0, 5210.0), 0.0, knockdown=0.0),
        ]
    )  # fmt: skip
    clamps = Columns(
        [
            Record(index=2, use="sbe37", label="sbe37 1", depth=134.5, planned_depth=NAN,
                   x=60.0, y=3.0, tension=6950.0, tilt=4.0, knockdown=8.1),
            Record(index=2, use="adcp", label="adcp", depth=234.5, planned_depth=NAN,
                   x=55.0, y=0.0, tension=6750.0, tilt=16.0, knockdown=NAN),
        ]
    )  # fmt: skip
    loads = {"working_load": 10e3, "breaking_load": 30e3}
    plain = Record(
        kind="body", role="instrument", material=None, max_tilt=None, warn_tilt=None, **loads
    )
    meter = Record(kind="body", material=None, max_tilt=27.0, warn_tilt=None, **loads)
    adcp = Record(
        kind="body", role="instrument", material=None, max_tilt=20.0, warn_tilt=15.0, **loads
    )
    rope = Record(kind="cable", material="polyester", max_tilt=None, warn_tilt=None, **loads)
    wire = Record(kind="cable", material="steel", max_tilt=None, warn_tilt=None, **loads)
    kinds = {2: wire, 3: meter, 6: rope}
    pieces = tuple(
        Record(component=kinds.get(index, plain), clamps=()) for index in range(len(components))
    )
    pieces[2].clamps = (
        Record(label="sbe37 1", component=plain),
        Record(label="adcp", component=adcp),
    )
    _of_the_file(components, clamps, pieces)
    limits = Record(steel=3.0, synthetic=5.0, surface=5.0)
    file = Record(
        name="Iroise 2026", pieces=pieces, checks=Record(safety_factor=limits),
        environment=Record(depth=1100.0),
        solver=Record(strumming=None), legs=(), tow=None,
    )  # fmt: skip
    water = Record(
        depth=1100.0,
        deeper_east=0.0,
        deeper_north=0.0,
        level=np.array([0.0, 200.0, 1100.0]),
        u=np.array([0.8, 0.35, 0.05]),
        v=np.array([0.0, 0.1, 0.0]),
    )
    depth = np.linspace(113.2, 1099.0, 12)
    shape = Record(depth=depth, x=61.0 * np.linspace(1, 0, 12) ** 2, y=np.zeros(12))
    still = Record(depth=np.linspace(105.0, 1099.0, 12), x=np.zeros(12), y=np.zeros(12))
    fields = dict(
        name="Iroise 2026", type="subsurface", status="converged", iterations=5, segments=214,
        miss=1.2e-7, closure=3e-12, accuracy=Record(depth=0.003, tension=0.8, anchor=None),
        top=Record(depth=113.2, x=61.0, y=4.0, knockdown=8.25, used_buoyancy=1.0, reserve=0.0,
                   draft=None, freeboard=None),
        anchor_load=Record(tension=5210.0, vertical=5100.0, horizontal=1060.0, angle=11.74,
                      required_weight=10300.0, weight=9800.0, grounded_length=0.0),
        components=components, clamps=clamps, shape=shape, still_shape=still,
        warnings=("adcp leans 16.0°, its warning is at 15°",),
        file=file, strumming=None, profilers=(), tow_point=None, body=None,
        strumming_band=StrummingBand(1.5, "converged", 118.0, 13.05, 5333.3),
    )  # fmt: skip
    leg = Record(file=file, water=water, towed=False, anchored=True, for_surface=False)
    result = _solved(leg, fields | changes)
    result.to_dict = lambda: {"name": result.name, "status": result.status, "miss": result.miss}
    return result


@pytest.fixture
def result():
    return build_result()


@pytest.fixture
def make_result():
    return build_result


def build_tow_result(**changes):
    """A tow towards the east with its line north of the ship's track, in water of 300 m."""
    components = Columns(
        [
            component(0, "wire-8", "tow wire", "line", 200.0, (-3.0, 120.0), (0.0, -140.0),
                      (3000.4, 1500.0), 48.0, safety_factor=2.5),
            component(1, "fish", "fish", "instrument", 1.5, (120.0, 121.5), (-140.0, -140.5),
                      (1500.0, 0.0), 18.0, safety_factor=20.0),
        ]
    )  # fmt: skip
    clamps = Columns(
        [
            Record(index=0, use="sbe37", label="sbe37", depth=60.0, planned_depth=NAN,
                   x=-60.0, y=4.0, tension=2000.0, tilt=60.0, knockdown=NAN),
        ]
    )  # fmt: skip
    wire = Record(kind="cable", material="steel", max_tilt=None, warn_tilt=None)
    fish = Record(kind="body", role="instrument", material=None, max_tilt=15.0, warn_tilt=None)
    ctd = Record(kind="body", role="instrument", material=None, max_tilt=None, warn_tilt=None)
    pieces = (
        Record(component=wire, clamps=(Record(label="sbe37", component=ctd),)),
        Record(component=fish, clamps=()),
    )
    _of_the_file(components, clamps, pieces)
    file = Record(
        name="Survey", pieces=pieces, environment=Record(depth=300.0, fluid="water"),
        checks=Record(safety_factor=Record(steel=3.0, synthetic=5.0, surface=5.0)),
        solver=Record(strumming=BourgetMarichalKeys()), legs=(),
        tow=Record(speed=1.0289, toward=90.0, height=3.0),
    )  # fmt: skip
    water = Record(
        depth=300.0,
        level=np.array([0.0, 100.0]),
        u=np.array([0.5, 0.0]),
        v=np.array([0.0, 0.0]),
    )
    along = np.linspace(1.0, 0.0, 12)
    shape = Record(depth=-3.0 + 124.5 * along, x=-140.5 * along, y=10.0 * along * (1.0 - along))
    fields = dict(
        file=file, name="Survey", type="tow", status="converged",
        iterations=7, segments=90, miss=2e-9,
        closure=3e-13, accuracy=Record(depth=0.002, tension=0.3, anchor=None),
        tow_point=Record(tension=3000.4, angle=35.26, vertical=1732.0, horizontal=2450.0),
        body=Record(depth=120.0, layback=140.0, tension=1500.0, angle=71.6),
        strumming=Record(frequency=3.559, cn_min=1.2504, cn_max=3.0),
        components=components, clamps=clamps, shape=shape, warnings=("fish is loose",),
        strumming_band=None,
    )  # fmt: skip
    leg = Record(file=file, water=water, towed=True, anchored=False)
    return _solved(leg, fields | changes)


@pytest.fixture
def make_tow_result():
    return build_tow_result


@pytest.fixture
def tow_result():
    return build_tow_result()
