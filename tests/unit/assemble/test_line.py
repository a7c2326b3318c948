"""What a component gives the march: net force, drag, stiffness."""

from math import pi

import numpy as np
import pytest

from calm.assemble import assemble_line, drag_of
from calm.files import Anchor, Body, Cable, Chain, Clamp, Cylinder, Piece, Place, Solver, Sphere
from calm.physics.reynolds import DragCurve

HALF_DENSITY = 512.5


def piece(index, component, length=None, clamps=()):
    own = getattr(component, "length", None) if length is None else length
    return Piece(
        index, "id", f"piece {index}", component, own, None, tuple(clamps), 1, 1, Place(index)
    )


def test_sphere_and_cylinder():
    sphere = Sphere(kind="sphere", diameter="1 m", buoyancy="4000 N")
    assert drag_of(sphere) == pytest.approx((HALF_DENSITY * 0.5 * pi / 4,) * 2 + (False,))
    cylinder = Cylinder(kind="cylinder", diameter="0.2 m", length="2 m", buoyancy="-200 N")
    kn, kt, directional = drag_of(cylinder)
    assert directional
    assert kn == pytest.approx(HALF_DENSITY * 1.2 * 0.68 * 0.4)
    assert kt == pytest.approx(HALF_DENSITY * 0.82 * pi * 0.01)
    fixed = cylinder.model_copy(update={"inclination": "insensitive"})
    assert drag_of(fixed)[2] is False


def body(**figures):
    return Body(kind="body", length="1 m", buoyancy="-100 N", **figures)


@pytest.mark.parametrize(
    ("figures", "drag"),
    [
        ({"kn": "30 N/(m/s)^2", "kt": "4 N/(m/s)^2"}, (30, 4, True)),
        ({"kn": "30 N/(m/s)^2", "inclination": "insensitive"}, (30, 30, False)),
        ({"drag_area": "0.2 m^2", "cd": 0.6}, (HALF_DENSITY * 0.12,) * 2 + (False,)),
        (
            {"drag_area": "0.2 m^2", "cd": 0.6, "kt": "5 N/(m/s)^2"},
            (HALF_DENSITY * 0.12, 5, True),
        ),
        (
            {"drag_measurements": [{"speed": "1 m/s", "force": "10 N"}]},
            (10, 10, False),
        ),
        (
            {"made_of": [{"kind": "sphere", "diameter": "1 m"}] * 2},
            (HALF_DENSITY * 0.5 * pi / 2,) * 2 + (False,),
        ),
    ],
)
def test_the_ways_a_body_gives_its_drag(figures, drag):
    assert drag_of(body(**figures)) == pytest.approx(drag)


def test_shapes_of_a_body_add_up_and_lean_with_it():
    made = body(
        made_of=[
            {"kind": "cylinder", "diameter": "0.1 m", "length": "1 m", "cn": 1, "ct": 0.8},
            {"kind": "sphere", "diameter": "0.2 m"},
        ]
    )
    sphere = HALF_DENSITY * 0.5 * pi * 0.01
    kn, kt, directional = drag_of(made)
    assert directional
    assert kn == pytest.approx(HALF_DENSITY * 0.1 + sphere)
    assert kt == pytest.approx(HALF_DENSITY * 0.8 * pi * 0.0025 + sphere)


@pytest.mark.parametrize(
    ("finish", "ct"), [(None, 0.005), ("smooth", 0.005), ("rough", 0.009), ("very-rough", 0.013)]
)
def test_cable_by_finish(finish, ct):
    cable = Cable(kind="cable", diameter="10 mm", weight="1 N/m", finish=finish)
    kn, kt, directional = drag_of(cable)
    assert directional
    assert kn == pytest.approx(HALF_DENSITY * 1.3 * 0.01)
    assert kt == pytest.approx(HALF_DENSITY * ct * pi * 0.01)


def test_chain():
    chain = Chain(kind="chain", diameter="13 mm")
    kn, kt, _ = drag_of(chain)
    assert kn == pytest.approx(HALF_DENSITY * 2.75 * 0.013)
    assert kt == pytest.approx(HALF_DENSITY * 0.46 * pi * 0.013)
    assert chain.net_buoyancy == pytest.approx(-19.9e3 * 0.013**2 * 9.80665 * (1 - 1025 / 7850))


def test_a_line_of_pieces():
    clamp = Clamp("id", "logger", body(drag_area="0.1 m^2", cd=1), 7.0, Place(1, clamp=0))
    rope = Cable(kind="cable", diameter="12 mm", weight="-0.2 N/m", stiffness="80 kN")
    line = assemble_line(
        [
            piece(0, Sphere(kind="sphere", diameter="1 m", mass="300 kg", buoyancy="2000 N")),
            piece(1, rope, 50.0, [clamp]),
            piece(2, Chain(kind="chain", diameter="13 mm", stiffness="10 MN"), 5.0),
            piece(3, Anchor(kind="anchor", mass="800 kg", length="0.4 m")),
        ]
    )
    assert line.length.tolist() == [1.0, 50.0, 5.0]
    assert line.flexible.tolist() == [False, True, True]
    assert line.buoyancy[:2] == pytest.approx([2000, 0.2])
    assert line.volume[0] == pytest.approx((300 + 2000 / 9.80665) / 1025)
    assert line.volume[1] == 0.0
    assert line.compliance == pytest.approx([0, 1 / 80e3, 1e-7])
    assert line.thinning.tolist() == [0.0, 0.5, 0.0]
    assert (line.clamp_piece.tolist(), line.clamp_at.tolist()) == ([1], [7.0])
    assert line.clamp_drag == pytest.approx([HALF_DENSITY * 0.1])
    assert line.anchor_height == pytest.approx(0.4)
    assert np.isfinite(line.total_buoyancy).all()


SMOOTH = {"buoyancy": "500 N", "surface": "smooth"}
ROPE = Cable(kind="cable", diameter="12 mm", weight="0.2 N/m", finish="smooth")


@pytest.mark.parametrize(
    ("component", "curve"),
    [
        (Sphere(kind="sphere", diameter="1 m", **SMOOTH), DragCurve(1.0)),
        (Cylinder(kind="cylinder", diameter="0.2 m", length="1 m", **SMOOTH), DragCurve(0.2, 5.0)),
        (Sphere(kind="sphere", diameter="1 m", **SMOOTH, cx=0.5), None),
        (Sphere(kind="sphere", diameter="1 m", **SMOOTH, k_surface="90 N/(m/s)^2"), None),
        (Cylinder(kind="cylinder", diameter="0.2 m", length="1 m", **SMOOTH, cn=1), None),
        (Sphere(kind="sphere", diameter="1 m", buoyancy="5 N", surface="painted"), None),
        (Sphere(kind="sphere", diameter="1 m", buoyancy="5 N"), None),
        (body(made_of=[{"kind": "sphere", "diameter": "1 m"}]), None),
    ],
)
def test_who_follows_the_curves_of_the_reynolds_number(component, curve):
    """Smooth spheres and cylinders without a drag of their own, in the line or clamped on it."""
    pieces = [
        piece(0, component),
        piece(1, ROPE, 50.0, [Clamp("id", "clamped", component, 7.0, Place(1, clamp=0))]),
        piece(2, Anchor(kind="anchor", mass="800 kg")),
    ]
    line = assemble_line(pieces, Solver(drag="reynolds"))
    assert line.drag_curve == (curve, None)
    assert line.clamp_drag_curve == (curve,)
    constant = assemble_line(pieces, Solver())
    assert constant.drag_curve == (None, None)
    assert constant.clamp_drag_curve == (None,)
    assert (line.normal_drag == constant.normal_drag).all()
    assert line.reversed().drag_curve == (None, curve)


def test_a_towed_sphere_wavers_and_follows_no_curve():
    sphere = Sphere(kind="sphere", diameter="0.1 m", **SMOOTH)
    line = assemble_line([piece(0, ROPE, 4.0), piece(1, sphere)], Solver(drag="reynolds"))
    assert line.drag_curve == (None, None)
    assert line.normal_drag[1] == pytest.approx(HALF_DENSITY * 0.9 * pi / 4 * 0.01)


def test_an_elongation_table_in_place_of_a_stiffness():
    rope = Cable(
        kind="cable", diameter="19 mm", weight="0.3 N/m", breaking_load="60 kN",
        elongation=[[0.05, 0.05], ["20 %", "12 %"]], permanent_elongation="4 %",
    )  # fmt: skip
    line = assemble_line(
        [piece(0, ROPE, 4.0), piece(1, rope, 9.0), piece(2, body(cd=1, drag_area=0))]
    )
    none, curve, rigid = line.elongation
    assert none is rigid is None
    assert (curve.tensions, curve.strains) == ([0, 3e3, 12e3], [0, 0.05, 0.12])
    assert (curve.permanent, curve.limit) == (0.04, 12e3)
    assert line.compliance.tolist() == [0, 0, 0]
    assert line.reversed().elongation == (None, curve, None)
