"""Rules on impossible and missing component values, in a catalogue or in a design.

A missing value is not a fault, except a missing source.
"""

from collections.abc import Collection, Iterable, Iterator, Mapping
from dataclasses import dataclass
from itertools import chain
from math import inf, pi, sqrt

from calm.assemble import drag_of, mass_in_air
from calm.checks.assessment import Handling
from calm.checks.criterion import limit_value_text
from calm.checks.figure_bounds import (
    contradicted_material,
    density_out_of_bounds,
    doubtful_figures,
    drag_out_of_bounds,
    load_out_of_bounds,
    rope_section,
    wet_weight_out_of_bounds,
)
from calm.checks.finding import State, Verdict, rule, unknown, verdict_on
from calm.checks.posture import JUDGED_ROLES
from calm.errors import nearest
from calm.files import Anchor, Cable, Chain, Component, Cylinder, Flexible, Sphere
from calm.files.catalogue import Assembly, Defined
from calm.files.components import KINDS, Outline
from calm.files.definition import CATALOGUE_DENSITY, STANDARD_GRAVITY
from calm.files.pieces import parts_of
from calm.files.rigid import Shaped
from calm.physics import materials
from calm.physics.materials import LEAD_DENSITY, MATERIAL_NAMES, STEEL_DENSITY, materials_in
from calm.physics.seawater import REFERENCE_DENSITY
from calm.quantities import say

ROUNDING = 1.05
"""Factor by which rounded values of a data sheet may exceed a limit.

The factor allows an error of 1.7 % in a sphere's diameter.
"""

ROPE_ROUNDING = 1.12
"""Factor by which rounded values of a rope may exceed a limit.

The factor exceeds `ROUNDING`: a nominal diameter may be one size below the true diameter.
"""

NOMINAL = 1.25
"""Maximum ratio of a wire's displaced volume to the volume of a cylinder of its nominal diameter.

The ratio follows from the published masses and submerged weights of jacketed wires.
"""

LOOSEST = 0.1
"""Minimum ratio of a rope's displaced section to its nominal section.

The loosest braids displace half of the nominal section.
"""

LIGHTEST_FLOAT = 0.01
"""Minimum ratio of a float's weight to its lift; foam has 0.02, inflated buoys have 0.03."""

STEEL_MODULUS = 210e9
"""Young's modulus of steel [Pa]; no cable is stiffer than a solid steel bar."""

SOFTEST_WIRE = 0.05
"""Minimum ratio of a wire's stiffness to the stiffness of a steel bar of equal diameter.

Wires in the catalogue have at least 0.17.
"""

STRONGEST_METAL = 350e3
"""Maximum strength-to-density ratio of a metal [Pa/(kg/m³)], from titanium alloys.

Links and shackles of the catalogue reach 45e3, computed from their mass and length.
"""

HOLLOW = 0.5
"""Minimum ratio of the density of connecting hardware to the density of its material.

Known hardware has 0.85.
"""

ANCHOR_SPEEDS = 0.3, 15.0
"""Minimum and maximum terminal speed of a falling anchor, computed from weight and `kt` [m/s].

Known anchors fall at 1.2 to 5.6 m/s, a 5 t block of steel at 12 m/s.
"""

LEAST_LIFT = 0.1
"""Minimum ratio of a float's buoyancy to the weight of water in a sphere of its diameter.

Floats in the catalogue have at least 0.23 (glass in a wide hard hat).
"""

DEEPEST_WATER = 11000.0
"""Maximum depth of the ocean, rounded [m]."""

_NO_SOURCE = "has no `source` for its values"


@dataclass(frozen=True)
class CatalogueFinding:
    """A fault in the definition of the component with the given `id`."""

    id: str
    message: str


def check_catalogue(
    definitions: Mapping[str, Defined], known: Collection[str]
) -> list[CatalogueFinding]:
    """List all faults in the definitions of a catalogue, ordered by component id.

    `known` contains all ids to which `prefer` and the parts of an assembly may refer.
    """
    findings = []
    for identifier, definition in definitions.items():
        if isinstance(definition, Assembly):
            messages = _unknown_parts(definition, known)
        else:
            messages = chain(
                _source_faults(definition),
                impossible(definition) if isinstance(definition, Component) else (),
                _late_warning(definition),
                doubtful_figures(definition),
                _of_unknown_material(definition),
                contradicted_material(definition),
            )
        findings += [CatalogueFinding(identifier, message) for message in messages]
        if definition.prefer is not None:
            other = definitions.get(definition.prefer)
            if definition.prefer not in known or definition.prefer == identifier:
                message = (
                    f"has `prefer: {definition.prefer}`, which must be the id of another component"
                )
                findings.append(CatalogueFinding(identifier, message))
            elif other is not None and other.prefer is not None:
                message = (
                    f"has `prefer: {definition.prefer}`, which itself has `prefer: {other.prefer}`"
                )
                findings.append(CatalogueFinding(identifier, message))
    return findings


def _source_faults(component: Component | Outline) -> Iterator[str]:
    known = KINDS[component.kind].model_fields
    given = {name for name in known if getattr(component, name, None) is not None}
    if not component.source:
        yield _NO_SOURCE
    if absent := [name for name in component.sources or () if name not in given]:
        yield f"has a source for {_listed(absent)} but no value"
    searched = component.searched or ()
    if found := [name for name in searched if name in given]:
        yield f"lists {_listed(found)} under `searched`, but also has a value"
    if strange := [name for name in searched if name not in known]:
        yield f"lists {_listed(strange)} under `searched`, but a {component.kind} has no such key"


def impossible(component: Component) -> Iterator[str]:
    """Yield messages about values that are impossible for a component's kind, size and material."""
    mass, volume, rating = component.mass, component.displaced_volume, component.depth_rating
    heavy = [*wet_weight_out_of_bounds(component)]
    yield from heavy
    dense = mass is not None and volume is not None and mass > ROUNDING * LEAD_DENSITY * volume
    if dense and not heavy:
        yield f"has a mass of {mass:.4g} kg in {volume:.3g} m³, which is denser than lead"
    net = component.net_buoyancy
    if component.role == "float" and net < 0.0:
        yield f"has `role: float` but weighs {say('load', -net)} in water"
    if mass is not None and mass * STANDARD_GRAVITY < LIGHTEST_FLOAT * net:
        yield (
            f"weighs {mass:.4g} kg and has a buoyancy of {say('load', net)}; no float with this "
            "buoyancy is so light"
        )
    if rating is not None and rating > DEEPEST_WATER:
        yield f"has a depth rating of {rating:.5g} m; the deepest sea is {DEEPEST_WATER:g} m deep"
    if isinstance(component, Cable):
        yield from _rope_faults(component)
    elif isinstance(component, Chain) and component.density is None:
        steel = (STEEL_DENSITY - CATALOGUE_DENSITY) * STANDARD_GRAVITY
        bars = -component.net_buoyancy / (steel * rope_section(component))
        if not 2.0 <= bars <= 5.0:  # open links weigh three to four bars, long ones two and a half
            yield (
                f"weighs as much as {bars:.2g} steel bars of its diameter; a steel chain weighs "
                "as much as 2 to 5 such bars"
            )
    elif (envelope := _outline_volume(component)) is not None:
        lift = CATALOGUE_DENSITY * STANDARD_GRAVITY * envelope
        if component.net_buoyancy > lift:
            has = f"has a buoyancy of {say('load', net)}"
            yield f"{has}; water of the same volume weighs only {say('load', lift)}"
        elif isinstance(component, Sphere) and 0.0 < net < LEAST_LIFT * lift:
            yield (
                f"has a buoyancy of {say('load', net)}; a float of this diameter, "
                f"{component.diameter:g} m, has at least {say('load', LEAST_LIFT * lift)}"
            )
        elif mass is not None and _displaced_weight(component, mass) > ROUNDING * lift:
            yield (
                f"has a mass of {mass:.4g} kg and a net buoyancy of {say('load', net)}: together "
                f"they exceed the weight of the same volume of water, {say('load', lift)}"
            )
        elif volume is not None and volume > ROUNDING * envelope:
            yield f"displaces {volume:.3g} m³, more than its outer volume of {envelope:.3g} m³"
    solid = materials.density_of(component.material)
    if component.role == "connector" and mass and solid and mass < HOLLOW * solid * (volume or 0.0):
        weight = (1.0 - CATALOGUE_DENSITY / solid) * mass * STANDARD_GRAVITY
        yield (
            f"weighs {mass:.4g} kg in air and {say('load', -net)} in water; a body of this "
            f"mass and material would weigh {say('load', weight)} in water"
        )
    if isinstance(component, Anchor) and component.kt:
        speed = sqrt(-net / component.kt)
        slowest, fastest = ANCHOR_SPEEDS
        if not slowest <= speed <= fastest:
            fault = "slow" if speed < slowest else "fast"
            yield (
                f"would sink at {speed:.2g} m/s according to its weight and `kt`; no anchor is so "
                f"{fault}"
            )
    yield from _of_a_load(component)
    yield from _drags_out_of_range(component)


def _of_a_load(component: Component) -> Iterator[str]:
    most, size = inf, ""
    if not isinstance(component, Flexible) and not materials.fibre_of(component.material):
        mass, length = component.mass, component.length
        if mass is not None and length:
            most, size = STRONGEST_METAL * mass / length, "mass and length"
    yield from load_out_of_bounds(component, most, size)


def _displaced_weight(component: Component, mass: float) -> float:
    """Weight of the displaced water from net force and mass [N; N/m for a cable or chain]."""
    return component.net_buoyancy + mass * STANDARD_GRAVITY


def _rope_faults(rope: Cable) -> Iterator[str]:
    """Yield messages about values that are implausible for the diameter and material of a rope.

    The rope is compared with a solid bar of the same diameter. The density of the bar is the
    `density` of the rope, or else the density of its `material`, or else that of steel.
    """
    section = rope_section(rope)
    density = rope.density or materials.density_of(rope.material) or STEEL_DENSITY
    bar = ROPE_ROUNDING * density * section
    weight = max(bar - CATALOGUE_DENSITY * section, 0.0) * STANDARD_GRAVITY
    lift = ROPE_ROUNDING * CATALOGUE_DENSITY * STANDARD_GRAVITY * section
    stiff, net = ROUNDING * STEEL_MODULUS * section, rope.net_buoyancy
    if rope.mass is not None and rope.mass > bar:
        yield f"weighs {rope.mass:.4g} kg/m; a solid bar of its diameter weighs {bar:.4g} kg/m"
    elif -net > weight:
        yield (
            f"weighs {-net:.4g} N/m in water; a solid bar of its diameter weighs {weight:.4g} N/m"
        )
    if net > lift:
        yield f"has a buoyancy of {net:.4g} N/m; water of the same diameter weighs {lift:.4g} N/m"
    elif rope.mass is not None and not (
        LOOSEST * lift <= _displaced_weight(rope, rope.mass) <= NOMINAL * lift
    ):
        yield (
            f"weighs {rope.mass * STANDARD_GRAVITY:.4g} N/m in air and {-net:.4g} N/m in water; "
            f"the difference should be near {lift / ROPE_ROUNDING:.4g} N/m, the weight of the "
            "water that the rope displaces"
        )
    else:
        yield from density_out_of_bounds(rope)
    known = [] if rope.stiffness is None else [rope.stiffness]
    if rope.elongation and rope.breaking_load:
        known = [at * rope.breaking_load / strain for at, strain in rope.elongation if strain]
    if known:
        wire = {each.name for each in materials_in(rope.material)} <= {"steel", "stainless steel"}
        least, most = SOFTEST_WIRE * stiff, say("stiffness", stiff)
        if max(known) > stiff:
            has = f"has a stiffness of {say('stiffness', max(known))}"
            yield f"{has}; a steel bar of its diameter has {most}"
        elif rope.material and wire and known[-1] < least:
            has = f"has a stiffness of {say('stiffness', known[-1])}"
            yield f"{has}; a wire of its diameter has at least {say('stiffness', least)}"


LEAST_BODY_DRAG = 0.02
"""Minimum ratio of a body's drag area to its volume^(2/3).

Streamlined bodies aligned with the flow have this ratio (Hoerner 1965, Fluid-Dynamic Drag, chapter
VI). Bodies of the catalogue have 0.6 to 10.
"""

SMALL_BODY = 1e-3
"""Volume up to which the drag of a body may be omitted, as is common for shackles [m³]."""


def _drags_out_of_range(component: Component) -> Iterator[str]:
    mass = mass_in_air(component)
    if isinstance(component, Shaped) and mass is not None:
        volume = _displaced_weight(component, mass) / (CATALOGUE_DENSITY * STANDARD_GRAVITY)
        area = drag_of(component)[0] / (0.5 * REFERENCE_DENSITY)
        if volume > SMALL_BODY and area < (least := LEAST_BODY_DRAG * volume ** (2 / 3)):
            yield (
                f"has a normal drag area of {area:.2g} m² (coefficient times area); even a "
                f"streamlined body with the same volume, {volume:.2g} m³, has {least:.2g} m²"
            )
    yield from drag_out_of_bounds(component)


def _late_warning(component: Component | Outline) -> Iterator[str]:
    warned, limit = component.warn_tilt, component.max_tilt
    if warned is not None and limit is not None and warned > limit:
        yield f"has a `warn_tilt` of {warned:g}°, above its `max_tilt` of {limit:g}°"


def _listed(names: Iterable[str]) -> str:
    return " and ".join(f"`{name}`" for name in names)


def _unknown_parts(assembly: Assembly, known: Collection[str]) -> Iterator[str]:
    if not assembly.source:
        yield _NO_SOURCE
    for part in assembly.parts:
        if part.get("use") not in known:
            yield f"has the part `{part.get('use')}`, which is in no catalogue"


def _outline_volume(component: Component) -> float | None:
    if isinstance(component, Sphere):
        return pi / 6 * component.diameter**3
    if isinstance(component, Cylinder):
        return pi / 4 * component.diameter**2 * component.length
    return None


@rule("figures", once=True)
def figures(handling: Handling) -> Iterator[Verdict]:
    """Report impossible or doubtful component values, such as a load in N instead of kN.

    A component that occurs several times is reported once.
    """
    named: set[tuple[str, str]] = set()
    for key in handling.leg.file.looser:
        if not key.backed:
            message = (
                f"The line sets {key.name} to {limit_value_text(key, key.value)} without a source; "
                f"the value in {key.source} is {limit_value_text(key, key.default)}."
            )
            yield unknown(None, message, "Add its `source`, or remove the value.")
    remedy = "Check the values of the component and their units."
    for part in parts_of(handling.leg.file.pieces):
        for state, found in (
            (State.FAIL, impossible),
            (State.WARN, _late_warning),
            (State.WARN, doubtful_figures),
            (State.UNKNOWN, _of_unknown_material),
            (State.UNKNOWN, contradicted_material),
        ):
            for fault in found(part.component):
                if (part.use, fault) not in named:
                    named.add((part.use, fault))
                    yield verdict_on(part, state, f"{part.label} {fault}.", remedy)


def _of_unknown_material(component: Component | Outline) -> Iterator[str]:
    material = component.material
    if material and not materials_in(material):
        near = nearest(material, [each.name for each in materials.MATERIALS])
        yield (
            f"has the unknown material `{material}`, so its strength, stretch and corrosion are "
            "not checked"
            + (f"; did you mean `{near}`?" if near else f"; known materials are {MATERIAL_NAMES}")
        )


LOADS = ("working_load", "breaking_load")
"""Keys of the load ratings; one of them suffices for a check of the strength."""

TILTED_ROLES = ("instrument", "release")
"""Roles of components that only work if they are nearly upright."""


@dataclass(frozen=True)
class MissingFigures:
    """Missing values of a component; `searched` lists values that are known to be unpublished."""

    id: str
    figures: tuple[str, ...]
    searched: tuple[str, ...]


def missing_figures(definitions: Mapping[str, Defined]) -> list[MissingFigures]:
    """List the components of a catalogue that lack values, with the keys of these values.

    Assemblies have no values of their own, and are skipped.
    """
    found = []
    for identifier, definition in definitions.items():
        if isinstance(definition, Assembly):
            continue
        figures = tuple(_missing(definition))
        sought = tuple(name for name in figures if name in (definition.searched or ()))
        if figures:
            found.append(MissingFigures(identifier, figures, sought))
    return found


def _missing(component: Component | Outline) -> Iterator[str]:
    if isinstance(component, Outline):
        yield from component.lacks
    elif mass_in_air(component) is None:
        yield "mass"
    borne = component.kind not in ("anchor", "profiler")
    if borne and all(getattr(component, load) is None for load in LOADS):
        yield from LOADS
    if component.role in JUDGED_ROLES and component.depth_rating is None:
        yield "depth_rating"
    if component.role in TILTED_ROLES and component.max_tilt is component.warn_tilt is None:
        yield "max_tilt"
    if isinstance(component, Anchor) and component.material is None and component.density is None:
        yield "material"
