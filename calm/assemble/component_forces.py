"""Forces on components: net buoyancy, mass and drag, and their sums for assemblies."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, fields
from math import pi
from typing import Any, assert_never

from calm import files
from calm.files import Anchor, Cable, Chain, Flexible, Solver, strumming_keys
from calm.files.catalogue import Defined
from calm.files.components import FlexibleComponent, Outline
from calm.files.definition import CATALOGUE_DENSITY, STANDARD_GRAVITY
from calm.files.rigid import CylinderShape, SphereShape
from calm.physics import drag
from calm.physics.materials import STEEL_DENSITY
from calm.physics.strumming import AMPLIFICATIONS, line_amplitude
from calm.units import QuantityError, parse_quantity


def net_buoyancy(component: files.Component, gravity: float) -> float:
    """Return the net buoyancy in reference water, positive up [N; N/m for a cable or chain].

    Without a specified buoyancy or weight, the net buoyancy follows from the mass and the
    acceleration of gravity [m/s²].
    """
    given = any(getattr(component, name, None) is not None for name in ("buoyancy", "weight"))
    return component.net_buoyancy * (1.0 if given else gravity / STANDARD_GRAVITY)


def mass_in_air(component: files.Component) -> float | None:
    """Return the mass in air [kg; kg/m for a cable or chain], or None if unknown.

    An unspecified mass is computed from the weight in water and the displaced volume. If the volume
    is unknown, the density of the material is used instead. Chains and anchors are of steel by
    default.
    """
    if component.mass is not None:
        return component.mass
    net = component.net_buoyancy / STANDARD_GRAVITY
    if component.displaced_volume is not None:
        return CATALOGUE_DENSITY * component.displaced_volume - net
    density = component.density if isinstance(component, Flexible) else None
    if isinstance(component, Anchor):
        density = component.material_density
    if density is None and isinstance(component, Chain | Anchor):
        density = STEEL_DENSITY
    if density is None or density == CATALOGUE_DENSITY:
        return None
    mass = -net / (1.0 - CATALOGUE_DENSITY / density)
    return mass if mass >= 0.0 else None


def drag_of(component: files.Component, solver: Solver | None = None) -> tuple[float, float, bool]:
    """Return Kn, Kt, and whether the drag depends on the direction of the flow.

    Kn is the normal drag and Kt the tangential drag [N/(m/s)²; per metre for a cable or chain]. An
    anchor has no drag. The friction and strumming laws are those of `solver`, or the default laws
    if `solver` is None.
    """
    if isinstance(component, SphereShape | CylinderShape):
        return _shape_drag(component)
    if isinstance(component, files.Shaped):
        return _body_drag(component)
    if isinstance(component, Flexible):
        return *cable_drag(component, solver or Solver()), True
    if isinstance(component, Anchor):
        return 0.0, 0.0, False
    assert_never(component)


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
    """Return the drag K of a clamped component in flow along the line [N/(m/s)²].

    This is Kt if the drag depends on the direction of the flow. Otherwise, it is Kn.
    """
    kn, kt, directional = drag_of(component)
    return kt if directional else kn


def cable_drag(component: FlexibleComponent, solver: Solver) -> tuple[float, float]:
    """Return the drags Kn and Kt per metre of cable or chain [N/(m/s)²].

    Kn of a cable includes strumming, except with Bourget & Marichal's law. With Pode's constant
    friction, Kt is Ct ½ρ Cn D. In that law, the default Ct of a cable is 0.012, 0.022 or 0.031,
    depending on the finish. This is π Ct / Cn, with the default Ct and Cn of the quadratic law.
    """
    if isinstance(component, Cable):
        usual = drag.CABLE_CN, drag.CABLE_CT[component.finish or "smooth"]
    elif isinstance(component, Chain):
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
    """Return the mass per metre [kg/m].

    An unspecified mass is computed from the weight in water and the diameter.
    """
    if cable.mass is not None:
        return cable.mass
    displaced = CATALOGUE_DENSITY * pi * cable.diameter**2 / 4
    return max(displaced - cable.net_buoyancy / STANDARD_GRAVITY, 0.0)


_PART_KEYS = {"use", "label", "length", "count", "clamps", "at"}


@dataclass(frozen=True)
class Datasheet:
    """Derived values of a component in sea water of density `CATALOGUE_DENSITY`.

    The values of a cable or chain are per metre.

    Attributes
    ----------
    net_buoyancy : net buoyancy, positive up [N]
    kn : drag normal to the axis at 1 m/s [N/(m/s)²]; None for an anchor
    kt : drag tangential to the axis at 1 m/s [N/(m/s)²]; for an anchor, drag during the drop
    cd_area : drag coefficient times area, normal to the axis [m²]
    """

    net_buoyancy: float
    kn: float | None
    kt: float | None
    cd_area: float | None


def datasheet(definition: Defined, catalogue: files.Catalogue | None = None) -> Datasheet | None:
    """Return the derived values of a component, or the sums over the parts of an assembly.

    Return None for an outline. Also return None for an assembly if one of its parts is not in the
    catalogue, or if one of its parts overrides a value of the component.
    """
    if isinstance(definition, files.Component):
        return _component_datasheet(definition, 1.0)
    if catalogue is None or isinstance(definition, Outline):
        return None
    sheets = []
    for item in _items(definition.parts):
        component = _component(catalogue, item)
        if component is None:
            return None
        try:
            metres = parse_quantity(item["length"], "length") if "length" in item else 1.0
        except QuantityError:
            return None
        sheets.append(_component_datasheet(component, metres))
    names = [each.name for each in fields(Datasheet)]
    return Datasheet(*(sum(getattr(sheet, name) or 0.0 for sheet in sheets) for name in names))


def _items(parts: tuple[dict[str, Any], ...]) -> Iterator[Mapping[str, Any]]:
    for part in parts:
        count = part.get("count", 1)
        for _ in range(count if isinstance(count, int) else 1):
            yield part
            yield from part.get("clamps", ())


def _component(catalogue: files.Catalogue, item: Mapping[str, Any]) -> files.Component | None:
    if not item.keys() <= _PART_KEYS or catalogue.entry(str(item.get("use"))) is None:
        return None
    found = catalogue.get(str(item["use"]))
    return found if isinstance(found, files.Component) else None


def _component_datasheet(component: files.Component, metres: float) -> Datasheet:
    if isinstance(component, Anchor):
        return Datasheet(component.net_buoyancy, None, component.kt, None)
    kn, kt, along = drag_of(component)
    times = metres if isinstance(component, Flexible) else 1.0
    return Datasheet(
        times * component.net_buoyancy,
        times * kn,
        times * (kt if along else kn),
        times * kn / (0.5 * CATALOGUE_DENSITY),
    )
