"""Rules for the shape of the line: tilt, depth, knockdown, excursion, reserve buoyancy."""

from collections.abc import Callable, Iterator
from functools import partial
from math import isnan

from calm.case.leg import Leg
from calm.case.leg_result import LegResult
from calm.case.warnings import is_synthetic, unknown_stretch
from calm.checks import criterion
from calm.checks.criterion import Criterion, JudgedPart, cited, criteria, parts_of, pieces_of
from calm.checks.finding import State, Verdict, at_least, at_most, rule, unknown, verdict_on
from calm.files import MooringFile
from calm.files.mooring_file import legs_of
from calm.quantities import say
from calm.solve.finish import watch_circle_radius

LEAST_TOP_DEPTH = 10.0
"""Default minimum depth of the top of a sub-surface line [m]."""

MOST_OF_A_RATING = 0.5
"""Maximum margin on depth, as a fraction of the depth rating.

Without this maximum, equipment with a small depth rating could not be used.
"""

JUDGED_ROLES = ("float", "instrument", "release")
"""Roles of parts that need a depth rating; other parts are checked only if a rating is
specified.
"""


AFLOAT_KEYS = ("hull", "k_surface", "wind_area", "heave")
"""Keys that apply to surface floats only."""


def reaches_the_surface(leg: Leg) -> bool:
    """Return whether the line is designed to have its float at the surface in still water.

    This is true for any float with a key that only surface floats have. It is also true for a line
    longer than the water depth.
    """
    if leg.for_surface is not None:
        return leg.for_surface
    top = leg.file.pieces[0].component
    if any(getattr(top, key, None) is not None for key in AFLOAT_KEYS):
        return True
    if leg.at_rest is None:
        return float(leg.line.length.sum()) >= leg.water.depth
    return -float(leg.at_rest.position[0, 2]) <= criterion.AT_SURFACE


def left_out_of_a_leg(file: MooringFile) -> tuple[str, ...]:
    """Return the names of the rules that do not apply to a leg because of its end connections."""
    top, bottom = legs_of(file)[0].ends
    of_both_ends = () if top.free and bottom.anchor is not None else ("watch-circle", "scope")
    return of_both_ends if top.free else (*of_both_ends, "top-depth", "knockdown", "excursion")


@criteria("tilt")
def tilt(leg: Leg) -> Iterator[Criterion]:
    """Check the tilt of instruments and releases against their own limits and the design's limit.

    Typical limits of manufacturers [degrees]: Aanderaa RCM 27 (BODC), single-point Doppler current
    meter 30, release 45, sediment trap 10, ADCP 20 (its data are unreliable above 15).
    """
    design = leg.file.checks.maximum_tilt
    for part in parts_of(leg):
        own, warned = part.component.max_tilt, part.component.warn_tilt
        if own is warned is None and part.component.role not in ("instrument", "release"):
            continue
        limit = min((one for one in (own, design) if one is not None), default=None)
        source = THE_DESIGNS if limit is not None and limit != own else ""
        words = partial(_tilt_words, part, limit)
        yield Criterion(part, "tilt", limit, words, source=source, lacks="max_tilt")
        if warned is not None and (limit is None or warned < limit):
            words = partial(_doubtful_words, part, warned)
            yield Criterion(part, "tilt", warned, words, beyond=State.WARN)


_STRAIGHTER = (
    "Add buoyancy above this part, or move the part to a more upright position on the line."
)
THE_DESIGNS = "The design's own `maximum_tilt`"


def _tilt_words(
    part: JudgedPart, limit: float | None, leaning: float, _: LegResult
) -> tuple[str, str]:
    tilt = f"Tilt of {part.label} is {say('tilt', leaning)}"
    if limit is None:
        return (
            f"{tilt}; its limit is unknown.",
            "Set `max_tilt` of the part; use `90 deg` if the part has no limit.",
        )
    return f"{tilt}; the limit is {say('tilt', limit)}.", _STRAIGHTER


def _doubtful_words(
    part: JudgedPart, warned: float, leaning: float, _: LegResult
) -> tuple[str, str]:
    tilt = f"Tilt of {part.label} is {say('tilt', leaning)}"
    return f"{tilt}; above {say('tilt', warned)} its data are unreliable.", _STRAIGHTER


@criteria("depth-rating")
def depth_rating(leg: Leg) -> Iterator[Criterion]:
    """Check that floats and instruments stay above their depth ratings by a margin.

    The depths are those in the current: a float below its rating implodes, and the line sinks. A
    surface float needs no depth rating.
    """
    margin, source = leg.file.checks.rating_margin, cited(leg.file, "rating_margin")
    for part in parts_of(leg):
        rating = part.component.depth_rating
        afloat = part.index == 0 and part.clamp is None and reaches_the_surface(leg)
        if rating is None and (afloat or part.component.role not in JUDGED_ROLES):
            continue
        limit = None if rating is None else rating - min(margin, MOST_OF_A_RATING * rating)
        words = partial(_rating_words, part, limit)
        yield Criterion(
            part, "depth", limit, words, silent=True, source=source, lacks="depth_rating"
        )


def _rating_words(
    part: JudgedPart, limit: float | None, depth: float, _: LegResult
) -> tuple[str, str]:
    deep, rating = f"Depth of {part.label} is {say('depth', depth)}", part.component.depth_rating
    if limit is None or rating is None:
        return f"{deep}; its depth rating is unknown.", "Set the `depth_rating` of the part."
    return (
        f"{deep}; its depth rating of {say('depth_rating', rating)} less a margin of "
        f"{say('depth_rating', rating - limit)} allows {say('depth_rating', limit)}.",
        "Use a component with a greater depth rating, or add buoyancy to reduce the knockdown.",
    )


_STRETCH = 0.02
"""Largest possible stretch of a rope, as a fraction of the water depth, that may remain unknown.

The value is the error of a sounding.
"""

_MEASURED = 0.2
"""Fraction of the breaking load used in place of an unknown working load."""


@rule("stretch")
def stretch(result: LegResult) -> Iterator[Verdict]:
    """Check that the stretch of ropes is known, and that ropes are measured under a small load."""
    limit, lengths = _STRETCH * result.leg.water.depth, result.leg.line.length.tolist()
    rows = zip(result.file.pieces, lengths, result.components.tension, strict=False)
    for piece, length, tension in rows:
        component = piece.component
        strains = unknown_stretch(component, tension)
        if strains is not None and (by := max(strains, default=1.0) * length) > limit:
            could = (
                f"could stretch by {say('length', by)}"
                if strains
                else "stretches by an unknown amount"
            )
            yield unknown(
                piece,
                f"{piece.label} is {component.material} of unknown stiffness and is assumed "
                f"inextensible. The rope {could}, so depths above it are unknown.",
                "Set the `stiffness` or `elongation` of the rope.",
                by,
                lacks="stiffness",
            )
        breaking = component.breaking_load
        bears = component.working_load or (breaking and _MEASURED * breaking)
        if piece.measured_load and bears and piece.measured_load > bears:
            share = "the working load" if component.working_load else "a fifth of the breaking load"
            message = (
                f"{piece.label} is to be cut to length under a load of "
                f"{say('load', piece.measured_load)}; this load exceeds {share} of the "
                f"piece ({say('load', bears)})."
            )
            remedy = "Check the load in `length_at`; ropes are measured under a small load."
            yield verdict_on(piece, State.WARN, message, remedy)


@criteria("top-depth")
def top_depth(leg: Leg) -> Iterator[Criterion]:
    """Check that the top of a sub-surface line is deep enough to avoid waves, vessels and nets.

    If the design does not set `minimum_top_depth`, a top above the default depth only causes a
    warning.
    """
    given, label = leg.file.checks.minimum_top_depth, pieces_of(leg)[0].label
    if given is None and reaches_the_surface(leg):
        return
    limit = LEAST_TOP_DEPTH if given is None else given
    beyond = State.WARN if given is None else State.FAIL
    source = cited(leg.file, "minimum_top_depth")

    def words(depth: float, _: LegResult) -> tuple[str, str]:
        return (
            f"Depth of {label} is {say('depth', depth)}; at least {say('depth', limit)} is needed "
            "to stay clear of waves, hulls and nets.",
            "Shorten the line, or add a surface marker.",
        )

    top = pieces_of(leg)[0]
    yield Criterion(top, "top_depth", limit, words, least=True, beyond=beyond, source=source)


_SHELF = 200.0
"""Water depth below which fish bite is ignored [m]; a default of CALM.

Severe fish bite is known from moorings far from the continental shores (Berteaux and others 1987).
"""


_POLAR = 60.0
"""Latitude above which fish bite is ignored [degrees]; a default of CALM, without a published
limit.
"""


@rule("fish-bite")
def fish_bite(result: LegResult) -> Iterator[Verdict]:
    """Check that the upper end of each synthetic rope is below the fish-bite zone."""
    limit, position = result.file.checks.fishbite_depth, result.file.position
    polar = position is not None and abs(position.latitude) >= _POLAR
    if result.leg.water.depth <= _SHELF or polar:
        return
    for piece, row in zip(result.file.pieces, result.components, strict=True):
        if is_synthetic(piece.component):
            highest = min(row.depth_top, row.depth_bottom)
            message = (
                f"{piece.label} begins at {say('depth', highest)}; rope above "
                f"{say('depth', limit)} is exposed to fish bite."
            )
            remedy = (
                f"Use jacketed wire above {say('depth', limit)}, or set the `fishbite_depth` of "
                "the site."
            )
            source = cited(result.file, "fishbite_depth")
            yield at_least(piece, highest, limit, message, remedy, State.WARN, source)


@criteria("knockdown")
def knockdown(leg: Leg) -> Iterator[Criterion]:
    """Compare the knockdown of the top with `maximum_knockdown`, if the design sets it."""

    def words(sunk: float, allowed: str) -> tuple[str, str]:
        if isnan(sunk):
            return (
                "The line is slack in still water, so its knockdown has no reference.",
                "Set a limit for the excursion instead (`maximum_excursion`).",
            )
        return (
            f"Knockdown of the top is {say('knockdown', sunk)}; the limit is {allowed}.",
            "Add buoyancy at the top, or reduce drag (`calm run --explain` shows the effect of "
            "each part).",
        )

    yield from _of_the_top(leg, "knockdown", leg.file.checks.maximum_knockdown, words)


@criteria("excursion")
def excursion(leg: Leg) -> Iterator[Criterion]:
    """Compare the horizontal offset of the top with `maximum_excursion`, if the design sets it."""

    def words(offset: float, allowed: str) -> tuple[str, str]:
        return (
            f"Offset of the top is {say('offset', offset)}; the limit is {allowed}.",
            "Add buoyancy, reduce drag, or shorten the line.",
        )

    yield from _of_the_top(leg, "offset", leg.file.checks.maximum_excursion, words)


def _of_the_top(
    leg: Leg,
    quantity: str,
    limit: float | None,
    words: Callable[[float, str], tuple[str, str]],
) -> Iterator[Criterion]:
    if limit is not None:
        allowed = say(quantity, limit)
        top = pieces_of(leg)[0]
        yield Criterion(top, quantity, limit, lambda value, _: words(value, allowed))


@criteria("reserve")
def reserve(leg: Leg) -> Iterator[Criterion]:
    """Check the reserve buoyancy of the surface float, as a fraction of its total buoyancy.

    The default limit of 0.3 is an allowance for waves.
    """
    if not reaches_the_surface(leg):
        return
    limit = leg.file.checks.minimum_reserve

    def words(left: float, result: LegResult) -> tuple[str, str]:
        if result.type == "surface":
            message = f"Reserve buoyancy of the float is {100 * left:.0f} %"
        else:
            message = (
                f"The float is {say('depth', result.top.depth)} under water and has no reserve "
                "buoyancy"
            )
        return (
            f"{message}; at least {100 * limit:.0f} % is required.",
            "Use a larger float, or a lighter or longer line." + _too_long_remedy(leg),
        )

    source = cited(leg.file, "minimum_reserve")
    top = pieces_of(leg)[0]
    yield Criterion(top, "reserve", limit, words, least=True, source=source)


@rule("freeboard")
def freeboard(result: LegResult) -> Iterator[Verdict]:
    """Check that a float intended for the surface has freeboard."""
    if not reaches_the_surface(result.leg):
        return
    top, height = result.file.pieces[0], result.top.freeboard
    if result.type != "surface":
        height = -result.top.depth
    if height is None:
        yield unknown(
            top,
            "The freeboard of the float is unknown.",
            "Set `hull`, `mass` and `volume` of the float, and set `buoy_drag: immersed`.",
        )
        return
    yield at_least(
        top,
        height,
        0.0,
        f"Freeboard of the float is {say('freeboard', height)}."
        if height >= 0.0
        else f"The float is {say('depth', -height)} under water.",
        "Use a larger float." + _too_long_remedy(result.leg),
    )


def _too_long_remedy(leg: Leg) -> str:
    top = leg.file.pieces[0].component
    if any(getattr(top, key, None) is not None for key in AFLOAT_KEYS):
        return ""
    return (
        " If the line should stay below the surface, it is too long for this water depth: shorten "
        "it."
    )


@rule("watch-circle")
def watch_circle(result: LegResult) -> Iterator[Verdict]:
    """Check the watch-circle radius √(L² - h²) of a surface float.

    L is the line length from the float to the anchor, and h is the height of the surface above the
    top of the anchor. The limit is `maximum_excursion`, if the design sets it. PacIOOS states a
    radius of 1.73 times the depth at a scope of 2.
    """
    limit = result.file.checks.maximum_excursion
    if not reaches_the_surface(result.leg):
        return
    anchor = result.leg.line.anchor_height
    length = float(result.components.length.sum()) - anchor
    radius = watch_circle_radius(length, result.leg.water.depth - anchor)
    top = result.file.pieces[0]
    message = f"The watch circle has a radius of {say('offset', radius)}"
    if limit is None:
        yield verdict_on(top, State.NOT_JUDGED, f"{message}.", value=radius)
        return
    message += f"; the limit is {say('offset', limit)}."
    yield at_most(top, radius, limit, message, "Shorten the line.")


@rule("scope")
def scope(result: LegResult) -> Iterator[Verdict]:
    """Report the scope of a surface mooring, which is its cut length divided by the water depth.

    The scope has no limit.
    """
    if not reaches_the_surface(result.leg):
        return
    depth = result.leg.water.depth
    ratio = float(result.components.cut_length.sum()) / depth
    message = f"Scope (cut length over water depth) is {ratio:.3f}."
    yield verdict_on(None, State.NOT_JUDGED, message, value=ratio)
