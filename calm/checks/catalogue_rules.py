"""Figures of a component that cannot be true: one small rule each, and all of them together.

A rule is given a component and returns what is wrong with it, or None. It judges only figures that
the definition gives; a missing figure is no fault, except a missing source.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable, Iterator, Mapping
from dataclasses import dataclass
from math import pi
from typing import TYPE_CHECKING

from calm.case.parts import parts_of
from calm.checks.finding import State, Verdict, rule, verdict_on
from calm.files import Cable, Chain, Component, Cylinder, Flexible, Sphere
from calm.files.catalogue import Assembly
from calm.files.definition import CATALOGUE_DENSITY, STANDARD_GRAVITY, STEEL_DENSITY

if TYPE_CHECKING:
    from calm.checks.handling import Handling

ROUNDING = 1.05
"""Excess that rounded figures of a data sheet may show: 5 %, or 1.7 % of a sphere's diameter."""

ROPE_ROUNDING = 1.12
"""The same for ropes, whose nominal diameter may be the next size below the true one."""

LEAD_DENSITY = 11340.0
"""Density of lead [kg/m³]; nothing on a mooring is denser."""

STEEL_MODULUS = 210e9
"""Young's modulus of steel [Pa]; no cable is stiffer than a solid bar of it."""

GREATEST_STRENGTH = 4e9
"""Greatest tensile strength of any fibre or wire of a cable [Pa]."""

DEEPEST_WATER = 11000.0
"""Greatest depth of the ocean, in round figures [m]."""

DENSITIES = {
    "steel": STEEL_DENSITY,
    "polyester": 1380.0,
    "nylon": 1140.0,
    "polypropylene": 910.0,
    "aramid": 1440.0,
    "HMPE": 975.0,
}
"""Densities [kg/m³] of what ropes are made of, by the `material` of a definition."""

_NO_SOURCE = "does not say where its figures come from (`source`)"


@dataclass(frozen=True)
class CatalogueFinding:
    """Something impossible about a definition, by its id."""

    id: str
    message: str


def check_catalogue(
    definitions: Mapping[str, Component | Assembly], known: Collection[str]
) -> list[CatalogueFinding]:
    """All findings about the definitions of a catalogue.

    Parameters
    ----------
    definitions : mapping
        What to check, by id.
    known : collection of str
        Every id that the parts of an assembly, or a `prefer`, may name.
    """
    findings = []
    for identifier, definition in definitions.items():
        if isinstance(definition, Assembly):
            messages = _unknown_parts(definition, known)
        else:
            messages = (message for rule in RULES if (message := rule(definition)) is not None)
        findings += [CatalogueFinding(identifier, message) for message in messages]
        if definition.prefer is not None:
            other = definitions.get(definition.prefer)
            if definition.prefer not in known or definition.prefer == identifier:
                message = f"prefers `{definition.prefer}`, which no catalogue has"
                findings.append(CatalogueFinding(identifier, message))
            elif other is not None and other.prefer is not None:
                message = f"prefers `{definition.prefer}`, which itself prefers `{other.prefer}`"
                findings.append(CatalogueFinding(identifier, message))
    return findings


def no_source(component: Component) -> str | None:
    """Figures whose origin nobody can look up."""
    return None if component.source else _NO_SOURCE


def source_of_nothing(component: Component) -> str | None:
    """A source of a figure that is missing, or a figure given though searched for in vain."""
    given = {name for name in type(component).model_fields if getattr(component, name) is not None}
    if absent := [name for name in component.sources or () if name not in given]:
        return f"names a source of {_listed(absent)}, which it does not give"
    if found := [name for name in component.searched or () if name in given]:
        return f"lists under `searched` {_listed(found)}, which it gives"
    known = type(component).model_fields
    if strange := [name for name in component.searched or () if name not in known]:
        return f"lists under `searched` {_listed(strange)}, which a {component.kind} does not have"
    return None


def warns_after_limit(component: Component) -> str | None:
    """A tilt warned of only after the greatest tilt."""
    if component.max_tilt is None or component.warn_tilt is None:
        return None
    if component.warn_tilt <= component.max_tilt:
        return None
    return f"warns at {component.warn_tilt:g}°, after its greatest tilt of {component.max_tilt:g}°"


def displaces_more_than_its_size(component: Component) -> str | None:
    """A sphere or cylinder that displaces, or lifts, more water than it has room for."""
    envelope = _envelope(component)
    if envelope is None:
        return None
    lift = CATALOGUE_DENSITY * STANDARD_GRAVITY * envelope
    if component.net_buoyancy > lift:
        return f"lifts {component.net_buoyancy:.4g} N; water of its size weighs {lift:.4g} N"
    volume = component.displaced_volume
    if volume is not None and volume > ROUNDING * envelope:
        return f"displaces {volume:.3g} m³; its size is {envelope:.3g} m³"
    return None


def is_denser_than_lead(component: Component) -> str | None:
    """A mass in air that leaves, with the weight in water, hardly any volume."""
    mass, volume = component.mass, component.displaced_volume
    if mass is None or volume is None or mass <= ROUNDING * LEAD_DENSITY * volume:
        return None
    return f"has a mass of {mass:.4g} kg in {volume:.3g} m³, denser than lead"


def is_heavier_than_a_bar(component: Component) -> str | None:
    """A rope heavier, in air or in water, than a solid bar of its diameter and material.

    The `density` of the definition counts, else that of its `material` where `DENSITIES` has it,
    else that of steel.
    """
    if not isinstance(component, Cable):
        return None
    density = component.density or DENSITIES.get(component.material or "", STEEL_DENSITY)
    section = pi / 4 * component.diameter**2
    bar = ROPE_ROUNDING * density * section
    if component.mass is not None and component.mass > bar:
        return f"has {component.mass:.4g} kg/m; a solid bar of its diameter has {bar:.4g} kg/m"
    weight = max(bar - CATALOGUE_DENSITY * section, 0.0) * STANDARD_GRAVITY
    if -component.net_buoyancy > weight:
        return (
            f"weighs {-component.net_buoyancy:.4g} N/m in water; a solid bar of its diameter "
            f"weighs {weight:.4g} N/m"
        )
    return None


def lifts_more_than_its_section(component: Component) -> str | None:
    """A rope more buoyant than the water it takes the place of."""
    if not isinstance(component, Cable):
        return None
    lift = ROPE_ROUNDING * CATALOGUE_DENSITY * STANDARD_GRAVITY * pi / 4 * component.diameter**2
    if component.net_buoyancy <= lift:
        return None
    return f"lifts {component.net_buoyancy:.4g} N/m; water of its diameter weighs {lift:.4g} N/m"


def is_no_chain(component: Component) -> str | None:
    """A chain outside two to five solid steel bars of its diameter side by side.

    Open links weigh three to four bars, long links two and a half.
    """
    if not isinstance(component, Chain) or component.density is not None:
        return None
    bar = (STEEL_DENSITY - CATALOGUE_DENSITY) * STANDARD_GRAVITY * pi / 4 * component.diameter**2
    bars = -component.net_buoyancy / bar
    if 2.0 <= bars <= 5.0:
        return None
    return f"weighs as much as {bars:.2g} steel bars of its diameter; a steel chain 2 to 5"


def is_stiffer_than_steel(component: Component) -> str | None:
    """A cable stiffer than a solid steel bar of its diameter."""
    if not isinstance(component, Cable) or component.stiffness is None:
        return None
    bar = ROUNDING * STEEL_MODULUS * pi / 4 * component.diameter**2
    if component.stiffness <= bar:
        return None
    return (
        f"has a stiffness of {component.stiffness:.4g} N; a steel bar of its diameter {bar:.4g} N"
    )


def is_rated_below_the_ocean(component: Component) -> str | None:
    """A depth rating deeper than any water."""
    if component.depth_rating is None or component.depth_rating <= DEEPEST_WATER:
        return None
    return (
        f"is rated to {component.depth_rating:.5g} m; no water is deeper than {DEEPEST_WATER:g} m"
    )


def is_too_strong(component: Component) -> str | None:
    """A cable stronger than any fibre or wire of its diameter."""
    if not isinstance(component, Cable) or component.breaking_load is None:
        return None
    strongest = GREATEST_STRENGTH * pi / 4 * component.diameter**2
    if component.breaking_load <= strongest:
        return None
    return f"breaks at {component.breaking_load:.4g} N; no cable of its diameter at {strongest:.4g}"


def has_no_drag(component: Component) -> str | None:
    """A cable or chain that the current does not push."""
    if not isinstance(component, Flexible) or component.cn != 0.0:
        return None
    return "has no drag across it (`cn: 0`)"


LEAST_DRAG = {"sphere": 0.06, "cylinder": 0.2, "cable": 0.05, "chain": 1.0}
"""Least coefficient of drag across each kind, past the crisis of drag in smooth flow.

Of spheres 0.06 (Katz, Automotive Aerodynamics, figure 6.19), of cylinders 0.2 (Roshko 1961, Journal
of Fluid Mechanics 10, 345-356), of cables the 0.05 of a streamlined section around them.
"""

MOST_DRAG = 10.0
"""No piece of a mooring has a greater coefficient, whatever vibrates."""


def drags_out_of_range(component: Component) -> str | None:
    """A coefficient of drag that no piece of its kind has."""
    name = "cx" if isinstance(component, Sphere) else "cn"
    value = getattr(component, name, None)
    least = LEAST_DRAG.get(component.kind)
    if value is None or least is None or value == 0.0 or least <= value <= MOST_DRAG:
        return None
    return (
        f"has `{name}: {value:g}`; a {component.kind} has {least:g} at least, {MOST_DRAG:g} at most"
    )


IMPOSSIBLE: tuple[Callable[[Component], str | None], ...] = (
    warns_after_limit,
    displaces_more_than_its_size,
    is_denser_than_lead,
    is_heavier_than_a_bar,
    lifts_more_than_its_section,
    is_no_chain,
    is_stiffer_than_steel,
    is_too_strong,
    is_rated_below_the_ocean,
    has_no_drag,
    drags_out_of_range,
)
"""Rules on the figures themselves, of a catalogue and of a design."""

RULES = (no_source, source_of_nothing, *IMPOSSIBLE)
"""Every rule of a catalogue, in the order their findings are reported."""


def _listed(names: Iterable[str]) -> str:
    return " and ".join(f"`{name}`" for name in names)


def _unknown_parts(assembly: Assembly, known: Collection[str]) -> Iterator[str]:
    if not assembly.source:
        yield _NO_SOURCE
    for part in assembly.parts:
        if part.get("use") not in known:
            yield f"is made of `{part.get('use')}`, which no catalogue has"


def _envelope(component: Component) -> float | None:
    """Volume of the solid a sphere or cylinder describes [m³]; None for other kinds."""
    if isinstance(component, Sphere):
        return pi / 6 * component.diameter**3
    if isinstance(component, Cylinder):
        return pi / 4 * component.diameter**2 * component.length
    return None


@rule("figures", once=True)
def figures(handling: Handling) -> Iterator[Verdict]:
    """Return what no component of its size and material can have, such as a load in N that was in
    kN.

    What hangs several times on the line is named once.
    """
    named: set[tuple[str, str]] = set()
    for part in parts_of(handling.mooring.file.pieces):
        for impossible in IMPOSSIBLE:
            said = impossible(part.component)
            if said is not None and (part.use, said) not in named:
                named.add((part.use, said))
                remedy = "Look at its figures, and at their units."
                state = State.WARN if impossible is warns_after_limit else State.FAIL
                yield verdict_on(part, state, f"{part.label} {said}.", remedy)
