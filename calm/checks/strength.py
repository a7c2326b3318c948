"""Strength rules: loads on every piece, minimum tension of the line, and holding of the anchor."""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from functools import partial
from operator import itemgetter

import numpy as np

from calm.case.leg import Leg
from calm.case.leg_result import LegResult
from calm.case.warnings import counted_working_load, is_synthetic
from calm.checks.criterion import Criterion, JudgedPart, cited, criteria, pieces_of
from calm.checks.finding import Finding, State, Verdict, at_least, rule
from calm.checks.inventory import anchor_dry_mass
from calm.checks.leg_graph import SHORT_LEAD
from calm.checks.posture import reaches_the_surface
from calm.files import Cable, Component, Flexible, MooringFile, Piece, Place, SafetyFactors
from calm.files.mooring_file import legs_of
from calm.quantities import say

WEAK_LINK = 0.5
"""Strength ratio of a piece to the cables on both sides, below which the piece is a weak link."""

WEIGHT_OF_A_HINGE = 0.5
"""Weight in water below which a piece without length is not treated as hardware [N]."""


def allowable_load(component: Component, factors: SafetyFactors, surface: bool) -> float | None:
    """Return the allowable load of a component in service [N]; None without any load rating.

    `surface` is true for a surface mooring. See `governing_load` and `safety_factor`.
    """
    return governing_load(component, 1.0, safety_factor(component, factors, surface))[0]


def governing_load(
    component: Component, working_factor: float, factor: float
) -> tuple[float | None, str]:
    """Return the allowable load [N], and the key of the load rating that governs it.

    This is the smaller of working load × `working_factor` and breaking load / `factor`. The working
    load of a synthetic rope counts only without a breaking load. Without any load rating, the
    result is None and "".
    """
    known, working = [], counted_working_load(component)
    if working is not None:
        known.append((working_factor * working, "working_load"))
    if component.breaking_load is not None:
        known.append((component.breaking_load / factor, "breaking_load"))
    return min(known, key=itemgetter(0), default=(None, ""))


def wanted_load(component: Component) -> str:
    """Return the key of the load rating to set in a component without any load rating."""
    return "breaking_load" if isinstance(component, Flexible) else "working_load"


def passes_load_on(file: MooringFile, index: int) -> bool:
    """Return whether the line tension passes through a piece.

    The result is False for the top piece, the anchor, a piece at the free end of a leg, and a hinge
    without length and weight.
    """
    piece = file.pieces[index]
    if piece.length == 0.0 and abs(piece.component.net_buoyancy) < WEIGHT_OF_A_HINGE:
        return False
    top, bottom = legs_of(file)[0].ends
    return int(top.free) <= index < len(file.pieces) - 1 - bottom.free


def safety_factor(component: Component, factors: SafetyFactors, surface: bool) -> float:
    """Return the safety factor on breaking load that applies to a component.

    `surface` is true for a surface mooring.
    """
    factor: float = getattr(factors, safety_factor_name(component, surface))
    return factor


def safety_factor_name(component: Component, surface: bool) -> str:
    """Return the key in `safety_factor` that applies to a component, such as `steel`.

    `surface` is true for a surface mooring.
    """
    if surface:
        return "surface"
    return "synthetic" if is_synthetic(component) else "steel"


@criteria("strength")
def strength(leg: Leg) -> Iterator[Criterion]:
    """Compare the maximum tension in each piece with its allowable load.

    The top piece and the anchor are checked only if they have a load rating.

    UFC 4-159-03 table 3-7 requires a factor of 3 on the breaking strength of new chain and wire.
    Oceanographic practice is 3 to 5, with the larger values for synthetic ropes and surface
    moorings.
    """
    factors, surface = leg.file.checks.safety_factor, reaches_the_surface(leg)
    for part in pieces_of(leg):
        component = part.component
        name = safety_factor_name(component, surface)
        factor = getattr(factors, name)
        limit, figure = governing_load(component, 1.0, factor)
        if limit is None and not passes_load_on(leg.file, part.index):
            continue
        source = cited(leg.file, f"safety_factor.{name}") if figure == "breaking_load" else ""
        words = partial(_strength_words, part, limit, figure, factor)
        lacks = wanted_load(component)
        yield Criterion(part, "tension", limit, words, source=source, lacks=lacks, figure=figure)


def _strength_words(
    part: JudgedPart, limit: float | None, figure: str, factor: float, tension: float, _: LegResult
) -> tuple[str, str]:
    component, load = part.component, load_text(part, tension)
    if limit is None:
        return no_load_known(load)
    if figure == "working_load":
        allowed = f"its working load is {say('load', limit)}"
    else:
        allowed = (
            f"its breaking load of {say('load', component.breaking_load)} "
            f"divided by {factor:g} allows {say('load', limit)}"
        )
    wanted = f"a breaking load of at least {say('load', factor * tension)}"
    if not is_synthetic(component):
        wanted = f"a working load of at least {say('load', tension)} and {wanted}"
    return f"{load}; {allowed}.", f"Use a component with {wanted}."


def load_text(part: JudgedPart | Piece, tension: float, when: str = "", bound: str = "") -> str:
    """Describe the load on a piece, such as ``Tension in wire 1 is 5.31 kN``.

    `when` names the operation, such as " during the descent". `bound` is " at most" for an upper
    bound of the load.
    """
    what = "Tension in" if isinstance(part.component, Flexible) else "Load on"
    return f"{what} {part.label}{when} is{bound} {say('load', tension)}"


def no_load_known(load: str) -> tuple[str, str]:
    """Return message and remedy for a piece whose working load and breaking load are unknown.

    `load` is the text of `load_text`.
    """
    message = f"{load}; its working load and breaking load are unknown."
    return message, "Set the `working_load` or `breaking_load` of the part."


@criteria("release-load")
def release_load(leg: Leg) -> Iterator[Criterion]:
    """Check the load on every release, in service and at opening, against its rated loads.

    At opening, a release carries the tension of the line below it. Without an `opening_load`, the
    allowable load in service is the limit.
    """
    factors, surface = leg.file.checks.safety_factor, reaches_the_surface(leg)
    for part in pieces_of(leg):
        if part.component.role == "release":
            lacks = wanted_load(part.component)
            factor = safety_factor(part.component, factors, surface)
            limit, figure = governing_load(part.component, 1.0, factor)
            words = partial(_release_words, part, False, limit)
            yield Criterion(part, "tension", limit, words, lacks=lacks, figure=figure)
            if part.component.opening_load is not None:
                limit, figure = part.component.opening_load, "opening_load"
            words = partial(_release_words, part, True, limit)
            yield Criterion(part, "tension_bottom", limit, words, lacks=lacks, figure=figure)


def _release_words(
    part: JudgedPart, opens: bool, limit: float | None, tension: float, _: LegResult
) -> tuple[str, str]:
    load = load_text(part, tension, " at opening" if opens else "")
    if limit is None:
        return (
            f"{load}; its working load and opening load are unknown.",
            "Set the `working_load` and `opening_load` of the release.",
        )
    if not opens:
        allowed = f"the limit is {say('load', limit)}"
    elif part.component.opening_load is None:
        allowed = f"its opening load is unknown, so the limit is {say('load', limit)}"
    else:
        allowed = f"its opening load is {say('load', limit)}"
    return (
        f"{load}; {allowed}.",
        f"Use a release rated for {say('load', tension)}, or two in parallel that share the load.",
    )


@rule("strength-steps")
def strength_steps(result: LegResult) -> Iterator[Verdict]:
    """Report weak links in the line, or the piece that comes closest to a weak link.

    A weak link has less than half the strength of the cables on both sides, and its tension exceeds
    half of its own strength. Load ratings that are lower bounds of estimates are excluded.
    """
    factors, surface = result.file.checks.safety_factor, reaches_the_surface(result.leg)
    loads = [
        None if _is_estimated(one.component) else allowable_load(one.component, factors, surface)
        for one in result.file.pieces[:-1]
    ]
    steps = sorted(_steps(result, loads), key=lambda step: (step[0], step[1].label))
    pull = result.components.tension
    weak = [
        step for step in steps if step[0] < WEAK_LINK and pull[step[1].index] > WEAK_LINK * step[2]
    ]
    if not weak:
        steps = [step for step in steps if step[0] >= WEAK_LINK]
    for _, piece, load, cables in weak or steps[:1]:
        yield at_least(
            piece,
            load,
            WEAK_LINK * cables,
            f"{piece.label} is rated for {say('load', load)}; the cables above and below it are "
            f"rated for at least {say('load', cables)}.",
            "Use a component as strong as these cables.",
            State.WARN,
        )


def _is_estimated(component: Component) -> bool:
    return any(
        getattr(component, one.quantity) in (one.low, one.low_in_waves)
        for one in component.estimate or ()
        if one.quantity in ("working_load", "breaking_load")
    )


def _steps(
    result: LegResult, loads: Sequence[float | None]
) -> Iterator[tuple[float, Piece, float, float]]:
    """Compare the allowable load of each piece between two cables with that of the weaker cable.

    Yield the allowable load of the piece divided by that of the cable, the piece, the allowable
    load of the piece [N], and that of the cable [N].
    """
    # a chain is no reference: it is oversized to allow for wear
    cables = [
        load if isinstance(piece.component, Cable) else None
        for piece, load in zip(result.file.pieces, loads, strict=False)
    ]
    for index, load in enumerate(loads):
        above = next((one for one in reversed(cables[:index]) if one is not None), None)
        below = next((one for one in cables[index + 1 :] if one is not None), None)
        if load is not None and above is not None and below is not None:
            beside = min(above, below)
            yield load / beside, result.file.pieces[index], load, beside


@criteria("slack")
def slack(leg: Leg) -> Iterator[Criterion]:
    """Check the minimum tension in each wire and rope above the release.

    Without a release, the whole line is checked. Mooring groups require about 500 to 1000 N above
    the release at slack water; the defaults are 500 N for wire and 300 N for rope. Pieces with
    ``slack: allowed`` and line on the seabed are exempt. The defaults do not apply if the line
    above the release is shorter than `SHORT_LEAD`.
    """
    file = leg.file
    lowest = len(file.pieces) - 1 if file.release is None else file.release
    short = file.release is not None and float(leg.line.length[:lowest].sum()) <= SHORT_LEAD
    for part in pieces_of(leg)[:lowest]:
        if not isinstance(part.component, Cable) or part.component.slack == "allowed":
            continue
        name = "rope" if is_synthetic(part.component) else "wire"
        limit = getattr(file.checks.minimum_tension, name)
        words = partial(_words, part, limit, name)
        source = cited(file, f"minimum_tension.{name}")
        if short and not source:
            continue
        yield Criterion(part, "least_tension", limit, words, least=True, silent=True, source=source)


def _words(
    part: JudgedPart, limit: float, name: str, least: float, _: LegResult
) -> tuple[str, str]:
    return (
        f"Minimum tension in {part.label} is {say('load', least)}; "
        f"a {name} needs {say('load', limit)} to stay taut.",
        "Add buoyancy or remove weight above this piece, or allow it to be slack (`slack: "
        "allowed`).",
    )


_SET_WEIGHT = "Set the `weight` of the anchor in water, or the `density` of its material."
_UNKNOWN_WEIGHT = "the anchor's weight in water is unknown"


@criteria("anchor-weight", of_anchor=True)
def anchor_weight(leg: Leg) -> Iterator[Criterion]:
    """Check that the anchor's weight in water is at least factor × (V + H / friction).

    V and H are the vertical and horizontal anchor load. In Dewey's rule for deadweight anchors, the
    factor is 1.5.
    """
    weight = _weight(leg)

    def words(required: float, result: LegResult) -> tuple[str, str]:
        needs = f"{say('load', required)} is required ({_dry_mass_text(leg, required)})."
        if weight is None:
            return f"{_UNKNOWN_WEIGHT.capitalize()}; {needs}", _SET_WEIGHT
        weighs = f"The anchor weighs {say('load', weight)} in water; {needs}"
        return weighs, _heavier(leg, required)

    yield Criterion(
        pieces_of(leg)[-1],
        "required_weight",
        weight,
        words,
        source=cited(leg.file, "anchor_factor", "anchor_friction"),
        lacks="weight",
        stated=lambda required, result: (result.anchor_load.weight, required),
        stated_least=True,
    )


@criteria("anchor-uplift", of_anchor=True)
def anchor_uplift(leg: Leg) -> Iterator[Criterion]:
    """Check that the upward anchor load V is at most the anchor's weight in water / factor."""
    weight, factor = _weight(leg), leg.file.checks.anchor_factor
    limit = None if weight is None else weight / factor

    def words(vertical: float, result: LegResult) -> tuple[str, str]:
        load = f"The vertical anchor load is {say('load', vertical)}"
        if limit is None:
            return f"{load}; {_UNKNOWN_WEIGHT}.", _SET_WEIGHT
        return (
            f"{load}; the anchor's weight in water divided by {factor:g} is {say('load', limit)}.",
            _heavier(leg, result.anchor_load.required_weight),
        )

    source = cited(leg.file, "anchor_factor")
    anchor = pieces_of(leg)[-1]
    yield Criterion(anchor, "vertical", limit, words, source=source, lacks="weight")


@criteria("anchor-sliding", of_anchor=True)
def anchor_sliding(leg: Leg) -> Iterator[Criterion]:
    """Check that the horizontal anchor load is at most friction × (weight in water / factor - V).

    V is the vertical anchor load, positive up.
    """
    weight, factor = _weight(leg), leg.file.checks.anchor_factor
    friction, seabed = leg.file.anchor_friction, leg.file.environment.seabed
    down = "" if seabed is None else f" on a slope of {seabed.slope:.4g}°"

    def held(result: LegResult) -> float:
        assert weight is not None
        return friction * (weight / factor - result.anchor_load.vertical)

    def words(_: float, result: LegResult) -> tuple[str, str]:
        load = f"The horizontal anchor load is {say('load', result.anchor_load.horizontal)}"
        if weight is None:
            return f"{load}; {_UNKNOWN_WEIGHT}.", _SET_WEIGHT
        holding = held(result)
        holds = f"a friction coefficient of {friction:.4g}{down} holds {say('load', holding)}"
        if holding < 0.0:
            holds = (
                f"the vertical load times {factor:g} exceeds the anchor's weight in water, so "
                "friction cannot hold the anchor"
            )
        return f"{load}; {holds}.", _heavier(leg, result.anchor_load.required_weight)

    yield Criterion(
        pieces_of(leg)[-1],
        "slide",
        None if weight is None else friction * weight / factor,
        words,
        source=cited(leg.file, "anchor_factor", "anchor_friction"),
        lacks="weight",
        stated=lambda _, result: (result.anchor_load.horizontal, held(result)),
    )


ANCHOR_RULES = tuple(each.name for each in (anchor_weight, anchor_uplift, anchor_sliding))
"""Rules that a sufficiently heavy anchor satisfies.

The weight that the first rule requires also satisfies the other two rules in the same situation.
"""


def with_one_weight(
    findings: Iterable[Finding], governing: Mapping[Place | None, Finding]
) -> Iterator[Finding]:
    """Yield the findings, with the same remedy in all findings on an anchor that is too light.

    This remedy states the largest required weight. `governing` holds the findings with these
    remedies, as returned by `heaviest`.
    """
    for one in findings:
        lead = governing.get(one.place)
        too_light = one.rule in ANCHOR_RULES and one.remedy is not None and one.limit is not None
        yield one.but(remedy=lead.remedy) if lead is not None and too_light else one


def heaviest(findings: Iterable[Finding]) -> dict[Place | None, Finding]:
    """Return for each anchor the finding that requires the largest anchor weight.

    The keys are the places of the anchors. Anchors that are heavy enough are omitted.
    """
    found: dict[Place | None, Finding] = {}
    for one in findings:
        if one.rule == anchor_weight.name and one.remedy is not None and one.limit is not None:
            known = found.get(one.place)
            if known is None or known.limit is None or one.limit > known.limit:
                found[one.place] = one
    return found


def _weight(leg: Leg) -> float | None:
    return leg.anchor_weight if leg.file.anchor.material_known else None


def _heavier(leg: Leg, weight: float) -> str:
    weighs = f"at least {say('load', weight)} in water ({_dry_mass_text(leg, weight)})"
    return f"Use an anchor that weighs {weighs}."


def _dry_mass_text(leg: Leg, weight: float) -> str:
    water = leg.water
    density = water.density_at(np.array(water.depth))
    steel, concrete = anchor_dry_mass(weight, float(density), water.gravity)
    return f"{steel:.0f} kg of steel or {concrete:.0f} kg of concrete in air"
