"""Plausible ranges of component values by class: density, strength, drag, sign of the buoyancy.

`docs/reference/catalogue.md` prints these ranges.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass
from math import inf, pi

from calm.files import Anchor, Cable, Chain, Component, Flexible, Sphere
from calm.files.components import Outline
from calm.files.definition import CATALOGUE_DENSITY, STANDARD_GRAVITY
from calm.files.rigid import Rigid
from calm.physics import materials
from calm.physics.materials import STEEL_DENSITY, Material, materials_in
from calm.quantities import say

GREATEST_STRENGTH = 4e9
"""Upper bound on the tensile strength of any fibre or wire, for cables of unknown material [Pa]."""

ROPE_EFFICIENCY = 0.6
"""Maximum ratio of a rope's breaking stress to the strength of its yarn.

The breaking stress is the breaking load divided by the nominal section. The value is a default of
CALM. Ropes in the catalogue have 0.12 to 0.44.
"""

WEAKEST_ROPE = 0.05
"""Minimum ratio of a rope's breaking stress to the strength of its yarn."""

LEAST_SHARE = 0.1
"""Minimum fraction of a rope's nominal section that is fibre or wire.

Ropes in the catalogue have 0.14 (a fibre core in a thick sheath) to 0.98.
"""

WEAKEST_WIRE = 200e6
"""Minimum breaking stress in the metal of a wire rope [Pa]; wires in the catalogue have 1.1e9."""

STRONGEST_CHAIN = 1300e6
"""Maximum breaking stress in the two bars of a chain link [Pa]; grade 120 has 1200 MPa."""

GRADE_STRESS = 10e6
"""Nominal breaking stress in the bars of a chain per unit of its grade [Pa].

The grade is a tenth of the nominal stress at the minimum breaking force [N/mm²]: NACM, Welded Steel
Chain Specifications (2010), annex A, for grades such as 30; EN 818-1 for grades such as 8."""

GRADE_ROUNDING = 0.85, 1.25
"""Minimum and maximum ratio of the breaking stress to the nominal stress of the grade.

Chains in the catalogue have 0.88 to 1.08.
"""

_GRADE = re.compile(r"\b(?:grade[ -]?|gr\.? ?|g)(30|40|43|50|63|70|80|100|120)\b", re.IGNORECASE)
_BUOYANT = re.compile(
    r"float|buoy|foam|glass|syntactic|vinyl|sphere|package|frame|glider|hydrofoil", re.IGNORECASE
)


@dataclass(frozen=True)
class Bounds:
    """Smallest and largest plausible value of a parameter, and the source of these bounds."""

    least: float
    most: float
    source: str


_CRISIS = "smooth flow beyond the drag crisis: sphere 0.06 (Katz, Automotive Aerodynamics, figure "
_CRISIS += "6.19), cylinder 0.2 (Roshko 1961, Journal of Fluid Mechanics 10, 345-356)"
_STRUMMING = (
    "1.2 for a cylinder at rest, 2.5 times as much if it vibrates (Griffin 1985, ASME OMAE)"
)
_CHAIN = (
    "2.4 to 2.6, based on the bar diameter (OrcaFlex manual, Chain); the bounds are about half "
    "and twice these values"
)

DRAG_BOUNDS = {
    ("sphere", "cx"): Bounds(0.06, 2.0, _CRISIS),
    ("cylinder", "cn"): Bounds(0.2, 4.0, f"{_CRISIS}; {_STRUMMING}"),
    ("cylinder", "ct"): Bounds(
        0.001, 2.0, "from skin friction on a smooth wall to the drag of a blunt end"
    ),
    ("cable", "cn"): Bounds(0.05, 4.0, f"cable in a streamlined fairing; {_STRUMMING}"),
    ("cable", "ct"): Bounds(
        0.0005, 1.0, "from skin friction on a smooth wall to the drag of a string of balls"
    ),
    ("chain", "cn"): Bounds(1.0, 6.0, _CHAIN),
}
"""Bounds of drag coefficients by kind and key.

Zero is not plausible, except for `ct` with the friction law `hoerner`.
"""


def drag_out_of_bounds(component: Component) -> Iterator[str]:
    """Yield a message about each drag coefficient that is outside `DRAG_BOUNDS`."""
    for (kind, key), bounds in DRAG_BOUNDS.items():
        value = getattr(component, key, None)
        if component.kind != kind or value is None:
            continue
        if value == 0.0:
            if isinstance(component, Flexible) and key == "cn":
                yield "has no normal drag (`cn: 0`)"
        elif not bounds.least <= value <= bounds.most:
            kinds = f"a {kind} has at least {bounds.least:g} and at most {bounds.most:g}"
            yield f"has `{key}: {value:g}`; {kinds}"


def density_out_of_bounds(rope: Cable) -> Iterator[str]:
    """Yield a message if a rope is lighter in water than its material and diameter allow."""
    load_bearing = _load_bearing(rope)
    if not load_bearing:
        return
    section = rope_section(rope)
    excess = -rope.net_buoyancy / (STANDARD_GRAVITY * section)
    densities = [one.density for one in load_bearing if one.density is not None]
    names = " and ".join(dict.fromkeys(one.name for one in load_bearing))
    heavier = min(densities) - CATALOGUE_DENSITY
    net = f"{abs(rope.net_buoyancy):.4g} N/m in water"
    if heavier > 0.0 and excess < LEAST_SHARE * heavier:
        least = LEAST_SHARE * heavier * section * STANDARD_GRAVITY
        what = f"weighs {net}" if excess > 0.0 else f"is buoyant with {net}"
        yield f"{what}; a rope of {names} of its diameter weighs at least {least:.4g} N/m"


def load_bounds(component: Component) -> tuple[float, float, str] | None:
    """Return the minimum and maximum plausible breaking load of a cable or chain [N].

    The third item names the values used for the bounds. The result is None for other kinds.
    """
    if isinstance(component, Chain):
        bars = 2.0 * rope_section(component)
        grade = _GRADE.search(words_of(component))
        if grade is None:
            return 0.0, STRONGEST_CHAIN * bars, "diameter"
        load = GRADE_STRESS * float(grade[1]) * bars
        least, most = (share * load for share in GRADE_ROUNDING)
        return least, most, f"diameter and grade {grade[1]}"
    if not isinstance(component, Cable):
        return None
    section = rope_section(component)
    strengths = [one.strength for one in _load_bearing(component) if one.strength is not None]
    if not strengths:
        return 0.0, GREATEST_STRENGTH * section, "diameter"
    metals = [one for one in _load_bearing(component) if one.family == "metal"]
    if metals:
        heavier = (metals[0].density or STEEL_DENSITY) - CATALOGUE_DENSITY
        share = -component.net_buoyancy / (STANDARD_GRAVITY * heavier * section)
        # an impossible weight gives no information on the metal section
        least, most = (share, share) if LEAST_SHARE <= share <= 1.0 else (LEAST_SHARE, 1.0)
        stress = 1.1 * max(strengths)
        return WEAKEST_WIRE * least * section, stress * most * section, "weight in water"
    yarn = ROPE_EFFICIENCY * max(strengths) * section
    return WEAKEST_ROPE * min(strengths) * section, yarn, "diameter and material"


def load_out_of_bounds(component: Component, most: float, size: str) -> Iterator[str]:
    """Yield a message if a load rating of a component is implausibly large or small.

    `most` is the maximum plausible load [N], and `size` names the values that determine `most`.
    Both are ignored for a cable or chain.
    """
    least = 0.0
    if (bounds := load_bounds(component)) is not None:
        least, most, size = bounds
    load = max(component.breaking_load or 0.0, component.working_load or 0.0)
    breaking = inf if component.breaking_load is None else component.breaking_load
    if load > most:
        key = "breaking" if load == component.breaking_load else "working"
        yield (
            f"has a {key} load of {say('load', load)}; a {component.kind} of its {size} has at "
            f"most {say('load', most)}"
        )
    elif breaking < least:
        yield (
            f"has a breaking load of {say('load', breaking)}; a {component.kind} of its {size} has "
            f"at least {say('load', least)}"
        )


def wet_weight_out_of_bounds(component: Component) -> Iterator[str]:
    """Yield a message if an anchor or connector weighs more in water than its mass allows."""
    solid = materials.density_of(component.material)
    solid = getattr(component, "density", None) or solid
    if not (isinstance(component, Anchor) or component.role == "connector"):
        return
    if component.mass is None or solid is None or solid <= CATALOGUE_DENSITY:
        return
    weight = (1.0 - CATALOGUE_DENSITY / solid) * component.mass * STANDARD_GRAVITY
    if -component.net_buoyancy > 1.08 * weight:
        yield (
            f"weighs {say('load', -component.net_buoyancy)} in water; {component.mass:.4g} kg of "
            f"{component.material} weigh {say('load', weight)} in water"
        )


LIFTS = 10.0
"""Buoyancy below which the sign of the buoyancy is not checked [N].

Many loggers are nearly neutral.
"""

WIND_AREA = 0.02, 20.0
"""Bounds of the ratio of a float's wind area to its displaced volume^(2/3).

Meteorological buoys in the catalogue have 2.
"""


def doubtful_figures(component: Component | Outline) -> Iterator[str]:
    """Yield messages about values that are possible but usually wrong.

    Examples are an instrument, release or connector that floats, and an unusual wind area.
    """
    if not isinstance(component, Rigid) or isinstance(component, Anchor):
        return
    net, role = component.net_buoyancy, component.role
    sinks = role in ("instrument", "release", "connector") and not isinstance(component, Sphere)
    has_role = "role" in component.model_fields_set  # without one, it may be a float
    doubted = sinks and has_role and component.mass is None and net > LIFTS
    if doubted and not _BUOYANT.search(words_of(component)):
        yield (
            f"has `role: {role}` and a buoyancy of {say('load', net)}; most such components sink"
        )
    area, volume = component.wind_area, component.displaced_volume
    if volume is None:
        volume = net / (CATALOGUE_DENSITY * STANDARD_GRAVITY)
    if area and volume > 0.0:
        least, most = (share * volume ** (2 / 3) for share in WIND_AREA)
        if not least <= area <= most:
            yield (
                f"has a `wind_area` of {area:.3g} m²; a float that displaces {volume:.2g} m³ has "
                f"{least:.2g} to {most:.2g} m²"
            )


def contradicted_material(component: Component | Outline) -> Iterator[str]:
    """Yield a message if the `name` and `material` of a component refer to different materials."""
    named = {one.name: one for one in materials_in(component.name)}
    made_of = {one.name: one for one in materials_in(component.material)}
    if not named or not made_of or named.keys() & made_of.keys():
        return
    one, other = next(iter(named.values())), next(iter(made_of.values()))
    if _are_similar(one, other):
        return
    yield f"has the name `{component.name}`, but its `material` is {component.material}"


def _are_similar(one: Material, other: Material) -> bool:
    if one.density is None or other.density is None:
        return one.family == other.family or one.density is other.density
    # the names of both materials are acceptable if the densities differ by less than 10 %
    return abs(one.density - other.density) < 0.1 * other.density


def words_of(component: Component | Outline) -> str:
    """Join the name, material and note of a component in a single text."""
    return " ".join(filter(None, (component.name, component.material, component.note)))


def rope_section(component: Flexible) -> float:
    """Return the area of a circle with the nominal diameter [m²]."""
    return pi / 4 * component.diameter**2


def _load_bearing(rope: Cable) -> list[Material]:
    """Return the load-bearing materials of a rope.

    These are the metals except lead, or the fibres if there is no such metal. The list is empty if
    a density is unknown, or if a fibre rope has a lead core.
    """
    named = materials_in(rope.material)
    metals = [one for one in named if one.family == "metal" and one.name != "lead"]
    found = metals or [one for one in named if one.family == "fibre"]
    weighted = not metals and any(one.name == "lead" for one in named)
    return [] if weighted or any(one.density is None for one in found) else found
