"""The pieces of a file as arrays: net forces, drags, stiffness, and how its cables strum."""

from collections.abc import Sequence
from dataclasses import replace
from math import cbrt, pi, sqrt
from typing import assert_never

import numpy as np

from calm import files
from calm.files import Cable, Solver, strumming_keys
from calm.files.components import FlexibleComponent, RigidComponent
from calm.files.definition import CATALOGUE_DENSITY, STANDARD_GRAVITY
from calm.files.rigid import CylinderShape, Displacement, SphereShape
from calm.physics import drag
from calm.physics.drag import Friction
from calm.physics.hull import Floating, Hull, cylindrical_hull, spherical_hull, tabulated_hull
from calm.physics.line import Line, Water
from calm.physics.materials import STEEL_DENSITY
from calm.physics.reynolds import DragCurve
from calm.physics.stretch import ElongationCurve
from calm.physics.strumming import AMPLIFICATIONS, BourgetMarichal, line_amplitude
from calm.records.profile_tables import components

TOWED_SPHERE_CX = 0.90
"""Cx of a sphere at the free end of a tow, which wavers; held, it has 0.45: Bourget & Marichal."""


def assemble_line(
    pieces: Sequence[files.Piece], solver: Solver | None = None, gravity: float = STANDARD_GRAVITY
) -> Line:
    """The line above the anchor, or the whole towed line, in the order of the pieces.

    A piece that is cut to fit has length 0 until it is cut.

    Parameters
    ----------
    pieces : top to bottom, the anchor last if there is one
    solver : the laws of drag, friction and strumming; the usual ones where not given
    gravity : under which masses weigh [m/s²]
    """
    solver = solver or Solver()
    anchor = pieces[-1].component
    moored = isinstance(anchor, files.Anchor)
    above = pieces[:-1] if moored else pieces
    parts = [piece.component for piece in above]
    drags = [drag_of(part, solver) for part in parts]
    curves = [_drag_curve(part, solver) for part in parts]
    if not moored and isinstance(anchor, files.Sphere) and anchor.cx is None:
        k = drag.sphere_drag(anchor.diameter, TOWED_SPHERE_CX)
        drags[-1], curves[-1] = (k, k, False), None
    clamps = [(i, clamp) for i, piece in enumerate(above) for clamp in piece.clamps]
    hung = [clamp.component for _, clamp in clamps]
    return Line(
        length=np.array([piece.length or 0.0 for piece in above]),
        flexible=np.array([isinstance(part, files.Flexible) for part in parts]),
        buoyancy=np.array([net_buoyancy(part, gravity) for part in parts]),
        volume=np.array([part.displaced_volume or 0.0 for part in parts]),
        normal_drag=np.array([kn for kn, _, _ in drags]),
        tangential_drag=np.array([kt for _, kt, _ in drags]),
        directional=np.array([directional for _, _, directional in drags]),
        compliance=np.array(
            [1.0 / stiff if (stiff := getattr(part, "stiffness", None)) else 0.0 for part in parts]
        ),
        thinning=np.array([0.5 if isinstance(part, Cable) else 0.0 for part in parts]),
        clamp_piece=np.array([i for i, _ in clamps]),
        clamp_at=np.array([clamp.at for _, clamp in clamps]),
        clamp_buoyancy=np.array([net_buoyancy(part, gravity) for part in hung]),
        clamp_volume=np.array([part.displaced_volume or 0.0 for part in hung]),
        # what is clamped on is dragged as across its axis, whatever the inclination of the line
        clamp_drag=np.array([drag_of(part)[0] for part in hung]),
        anchor_height=anchor.length if isinstance(anchor, files.Anchor) else 0.0,
        lift=np.array([getattr(part, "lift", None) or 0.0 for part in parts]),
        clamp_lift=np.array([getattr(part, "lift", None) or 0.0 for part in hung]),
        diameter=np.array([part.diameter if isinstance(part, Cable) else 0.0 for part in parts]),
        friction=Friction(solver.friction),
        strumming=vibration_law(solver),
        elongation=tuple(map(_elongation, parts)),
        drag_curve=tuple(curves),
        clamp_drag_curve=tuple(_drag_curve(part, solver) for part in hung),
    )


def net_buoyancy(component: files.Component, gravity: float) -> float:
    """Net force in reference water, + up [N, N/m]: given, or from masses under a gravity [m/s²]."""
    given = any(getattr(component, name, None) is not None for name in ("buoyancy", "weight"))
    return component.net_buoyancy * (1.0 if given else gravity / STANDARD_GRAVITY)


def mass_in_air(component: files.Component) -> float | None:
    """Mass, per metre of a cable or chain, as given or from the weight in water [kg, kg/m].

    It follows from the displaced volume, or from the density of the material: that of steel for a
    chain or an anchor that does not say. None where it does not follow.
    """
    if component.mass is not None:
        return component.mass
    net = component.net_buoyancy / STANDARD_GRAVITY
    if component.displaced_volume is not None:
        return CATALOGUE_DENSITY * component.displaced_volume - net
    density = component.density if isinstance(component, files.Flexible) else None
    if isinstance(component, files.Anchor):
        density = component.material_density
    if density is None and isinstance(component, files.Chain | files.Anchor):
        density = STEEL_DENSITY
    if density is None or density == CATALOGUE_DENSITY:
        return None
    mass = -net / (1.0 - CATALOGUE_DENSITY / density)
    return mass if mass >= 0.0 else None


def drag_of(component: files.Component, solver: Solver | None = None) -> tuple[float, float, bool]:
    """Kn, Kt [N/(m/s)², per metre of cable or chain] and whether drag depends on the axis.

    Parameters
    ----------
    component : of any kind; an anchor has no drag
    solver : the laws of friction and strumming of cables and chains; the usual ones where not given
    """
    if isinstance(component, SphereShape | CylinderShape):
        return _shape_drag(component)
    if isinstance(component, files.Shaped):
        return _body_drag(component)
    if isinstance(component, files.Flexible):
        return *cable_drag(component, solver or Solver()), True
    if isinstance(component, files.Anchor):
        return 0.0, 0.0, False
    assert_never(component)


def _drag_curve(component: files.Component, solver: Solver) -> DragCurve | None:
    """The drag curve of a smooth sphere or cylinder; None where it gives a drag of its own."""
    if solver.drag == "constant":
        return None
    if not isinstance(component, files.Sphere | files.Cylinder) or component.surface != "smooth":
        return None
    given = component.cx if isinstance(component, files.Sphere) else component.cn
    if given is not None or component.k_surface is not None:
        return None
    if isinstance(component, files.Sphere):
        return DragCurve(component.diameter)
    return DragCurve(component.diameter, component.length / component.diameter)


def _elongation(component: files.Component) -> ElongationCurve | None:
    if not isinstance(component, Cable) or component.elongation is None:
        return None
    assert component.breaking_load is not None
    return ElongationCurve(
        component.elongation, component.breaking_load, component.permanent_elongation or 0.0
    )


def _body_drag(body: files.Shaped) -> tuple[float, float, bool]:
    if body.made_of is not None:
        each = [_shape_drag(shape) for shape in body.made_of]
        follows = any(along for *_, along in each) and body.inclination != "insensitive"
        return sum(kn for kn, *_ in each), sum(kt for _, kt, _ in each), follows
    if body.drag_measurements is not None:
        kn = drag.measured_drag(
            [measured.speed for measured in body.drag_measurements],
            [measured.force for measured in body.drag_measurements],
        )
    elif body.kn is not None:
        kn = body.kn
    else:
        assert body.drag_area is not None and body.cd is not None
        kn = drag.area_drag(body.drag_area, body.cd)
    if body.kt is None or body.inclination == "insensitive":
        return kn, kn, False
    return kn, body.kt, True


def _shape_drag(shape: SphereShape | CylinderShape) -> tuple[float, float, bool]:
    if isinstance(shape, SphereShape):
        k = drag.sphere_drag(shape.diameter, shape.cx)
        return k, k, False
    kn, kt = drag.cylinder_drag(shape.diameter, shape.length, shape.cn, shape.ct)
    if shape.inclination == "insensitive":
        return kn, kn, False
    return kn, kt, True


def axial_drag_of(component: files.Component) -> float:
    """K of what is clamped on a line in a flow along that line [N/(m/s)²].

    Its tangential drag; where its drag does not depend on the axis, that of any direction.
    """
    kn, kt, directional = drag_of(component)
    return kt if directional else kn


def with_axial_clamps(line: Line, pieces: Sequence[files.Piece]) -> Line:
    """The line of some pieces with its clamps in a flow along it, as in a fall and a rise."""
    clamps = [clamp.component for piece in pieces for clamp in piece.clamps]
    axial = [drag_of(each)[2] for each in clamps]
    curves = tuple(
        None if along else curve for along, curve in zip(axial, line.clamp_drag_curve, strict=False)
    )
    drags = np.array([axial_drag_of(each) for each in clamps])
    return replace(line, clamp_drag=drags, clamp_drag_curve=curves)


def cable_drag(component: FlexibleComponent, solver: Solver) -> tuple[float, float]:
    """Kn and Kt of a metre of cable or chain [N/(m/s)²].

    A cable's Kn includes its strumming; under Bourget & Marichal's law it is that of a cable at
    rest, which the march raises. Pode's constant friction is Kt = Ct ½ρ Cn D. Where a cable or
    chain gives no Ct, that of this law is such that its friction is the same as under the other
    laws, Ct π/Cn: 0.012, 0.022 and 0.031 by finish.
    """
    if isinstance(component, Cable):
        usual = drag.CABLE_CN, drag.CABLE_CT[component.finish or "smooth"]
    elif isinstance(component, files.Chain):
        usual = drag.CHAIN_CN, drag.CHAIN_CT
    else:
        assert_never(component)
    cn = usual[0] if component.cn is None else component.cn
    ct = usual[1] if component.ct is None else component.ct
    kn, kt = drag.line_drag(component.diameter, cn, ct)
    if solver.friction == "constant":
        kt = kn * (ct * pi / usual[0] if component.ct is None else ct)
    if isinstance(component, Cable):
        cn = _strumming_cn(component, cn, solver)
        kn, _ = drag.line_drag(component.diameter, cn, ct)
    return kn, kt


def _strumming_cn(cable: Cable, cn: float, solver: Solver) -> float:
    law = solver.strumming
    if isinstance(law, strumming_keys.StrummingFactor):
        return cn * law.factor
    if isinstance(law, strumming_keys.ConstantCn):
        return law.cn
    if isinstance(law, strumming_keys.BourgetMarichalKeys):
        return law.c0
    if isinstance(law, strumming_keys.AmplitudeModel):
        amplitude = line_amplitude(_mass(cable), cable.diameter, CATALOGUE_DENSITY)
        return cn * AMPLIFICATIONS[law.name](amplitude)
    return cn


def _mass(cable: Cable) -> float:
    """Return the mass of a metre [kg/m], if need be from its weight in water and its diameter."""
    if cable.mass is not None:
        return cable.mass
    displaced = CATALOGUE_DENSITY * pi * cable.diameter**2 / 4
    return max(displaced - cable.net_buoyancy / STANDARD_GRAVITY, 0.0)


def vibration_law(solver: Solver) -> BourgetMarichal | None:
    """The law by which the Cn of cables grows as they strum; None where the file chooses none."""
    keys = solver.strumming
    if not isinstance(keys, strumming_keys.BourgetMarichalKeys):
        return None
    return BourgetMarichal(keys.a1, keys.b1, keys.c1, rest=keys.c0, strouhal=keys.strouhal)


def assemble_floating(
    pieces: Sequence[files.Piece], environment: files.Environment, water: Water
) -> Floating | None:
    """Return how the first float rides at the surface; None where neither its draft nor its drag
    is known.

    A hull is that of the component's `hull`, or of its kind for a sphere and a cylinder; without
    mass or volume there is no draft, and only a `k_surface` makes a difference.
    """
    parts = (piece.component for piece in pieces)
    floats = (part for part in parts if isinstance(part, files.Rigid) and part.net_buoyancy > 0.0)
    component = next(floats, None)
    if component is None:
        return None
    hull = _hull(component)
    if hull is None and component.k_surface is None:
        return None
    density = water.density_at(np.zeros(()))
    volume = _volume(component) or 0.0
    net = net_buoyancy(component, water.gravity)
    lift = net + (float(density) - CATALOGUE_DENSITY) * water.gravity * volume
    below, *_ = drag_of(component)
    afloat = component.k_surface if below > 0.0 else None
    wind = environment.wind
    return Floating(
        hull=hull,
        weight=CATALOGUE_DENSITY * water.gravity * volume - net,
        lift=lift,
        surface_drag=None if afloat is None else afloat / below,
        wind=(0.0, 0.0) if wind is None else components(wind.speed, wind.toward),
        wind_area=component.wind_area,
        wind_cd=1.0 if component.wind_cd is None else component.wind_cd,
    )


def _volume(component: RigidComponent) -> float | None:
    """Volume of the whole hull [m³]: the component's own, or the last row of its table."""
    if component.displaced_volume is None and isinstance(component.hull, Displacement):
        return component.hull.displacement[-1][1]
    return component.displaced_volume


def _hull(component: RigidComponent) -> Hull | None:
    volume, hull = _volume(component), component.hull
    if not volume:
        return None
    if isinstance(hull, Displacement):
        return tabulated_hull(hull.displacement)
    if isinstance(component, files.Sphere) and hull != "cylinder":
        return spherical_hull(component.diameter)
    if isinstance(component, files.Cylinder) and hull != "sphere":
        return cylindrical_hull(component.diameter, component.length)
    # a body of no stated width is as wide as its volume makes it
    if hull == "sphere":
        return spherical_hull(cbrt(6.0 * volume / pi))
    if hull == "cylinder" and component.length > 0.0:
        return cylindrical_hull(sqrt(4.0 * volume / (pi * component.length)), component.length)
    return None
