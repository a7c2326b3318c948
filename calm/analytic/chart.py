"""Cable in a uniform current, determined by three of its seven quantities.

The cable lies in the plane of the current and has only normal drag. Its lower end is A, and its
upper end is B. H. Braconnot's charts solve the same problems graphically.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np

from calm.analytic.chart_branch import Branch, check_k, critical_angle
from calm.analytic.chart_search import ChartSearch, LengthSearch, Piece, size_of
from calm.errors import NoEquilibrium, UsageError


@dataclass(frozen=True)
class ChartSolution:
    """One cable in a uniform current, from its lower end A up to its upper end B.

    Parameters
    ----------
    phi_a, phi_b : angle from the current to the upward direction of the cable at each end [rad],
        from −π to π; negative if the cable descends
    tension_a, tension_b : tension at each end [N]
    height, distance : height of B above A, and distance of B downstream of A [m]
    length : length of the cable [m]
    h0 : unit of length of the chart [m]: tension at the apex of the curve divided by weight per
        metre; 0 for a straight cable
    """

    phi_a: float
    phi_b: float
    tension_a: float
    tension_b: float
    height: float
    distance: float
    length: float
    h0: float


@dataclass(frozen=True)
class ChartAnswer:
    """All cables that have three given quantities, or the reason why no cable is returned.

    Parameters
    ----------
    status : ``converged``, ``no-equilibrium``, ``inconsistent`` (the given quantities contradict
        each other) or ``one-parameter-family`` (the given quantities do not determine the cable)
    k : K, as in `chart_solve`
    solutions : the cables; cables that do not dip below A come first
    message, advice : reason and advice if there is no solution
    """

    status: str
    k: float
    solutions: tuple[ChartSolution, ...] = ()
    message: str = ""
    advice: str = ""


def chart_solve(
    k: float,
    weight: float,
    *,
    phi_a: float | None = None,
    phi_b: float | None = None,
    tension_a: float | None = None,
    tension_b: float | None = None,
    height: float | None = None,
    distance: float | None = None,
    length: float | None = None,
) -> ChartAnswer:
    """Find every cable that has three given quantities, or the reason why there is none.

    Errors are at most 1e-9: in rad for angles, relative to the length for distances, and otherwise
    relative to the value. The tension is less accurate for a cable that turns by less than 0.01
    rad.

    Parameters
    ----------
    k : K = ρ Cx D V²/(2|w|), from 0 to 100
    weight : weight in water per metre, w [N/m]; negative for a buoyant cable
    phi_a, phi_b : angles to the current [rad], −π to π; negative only at the end with the smaller
        tension (A, or B if w < 0)
    tension_a, tension_b : tensions ≥ 0 [N]; 0 only at the end with the smaller tension
    height, length : height of B above A, and length of the cable, both positive [m]
    distance : distance of B downstream of A [m]

    Raises
    ------
    UsageError
        The number of given quantities is not three, or a value is outside its range.
    """
    given = {
        "phi_a": phi_a, "phi_b": phi_b, "tension_a": tension_a, "tension_b": tension_b,
        "height": height, "distance": distance, "length": length,
    }  # fmt: skip
    known = {name: float(value) for name, value in given.items() if value is not None}
    check_k(k)
    check(known, weight)
    floats = weight < 0.0
    sunk = mirrored(known) if floats else known
    over_weight = {
        name: value / abs(weight) if name.startswith("tension") else value
        for name, value in sunk.items()
    }
    answer = _solve(float(k), over_weight, floats)
    if isinstance(answer, NoEquilibrium):
        return ChartAnswer(answer.status, float(k), (), answer.message, answer.advice)
    pull = abs(weight)
    solutions = [
        replace(one, tension_a=one.tension_a * pull, tension_b=one.tension_b * pull)
        for one in answer
    ]
    if floats:
        solutions = [ChartSolution(**mirrored(vars(solution))) for solution in solutions]
    return ChartAnswer("converged", float(k), tuple(solutions))


def _solve(k: float, known: dict[str, float], floats: bool) -> list[ChartSolution] | NoEquilibrium:
    """Return all sinking cables with the given quantities, or the reason why there is none.

    Tensions are divided by w. `floats` only selects the wording of the reason.
    """
    refusal = contradiction(known)
    if refusal:
        return refusal
    ends = {name: Branch.holding(k, known[name]) for name in ANGLES if name in known}
    sizes = {name: known[name] for name in SIZES if name in known}
    solutions: list[ChartSolution] = []
    if None not in ends.values() and known.get("tension_a") != 0.0 and not is_taut(known):
        for sign in (1, -1):
            solutions += _on_branch(Branch(k, sign), ends, sizes)
    line = straight(k, known)
    if isinstance(line, ChartSolution):
        solutions.append(line)
    elif line is not None and not solutions:
        return line
    if not solutions:
        return reason(k, known, floats)
    return sorted(solutions, key=lambda solution: solution.phi_a < 0.0)


def _on_branch(
    branch: Branch, ends: Mapping[str, tuple[Branch, float] | None], sizes: Mapping[str, float]
) -> list[ChartSolution]:
    places = [end for end in ends.values() if end is not None]
    if any(place[0].sign != branch.sign for place in places):
        return []
    start, end = (place[1] if (place := ends.get(name)) else None for name in ANGLES)
    turned = dict(sizes)
    if "distance" in sizes:
        turned["distance"] *= branch.sign
    search = ChartSearch(branch, turned)
    if start is None and end is None and search.log_ratio() is None:
        (third,) = sizes.keys() - {"distance", "length"}
        length = sizes["length"]
        cosine = turned["distance"] / length
        pieces = LengthSearch(branch, cosine, third, sizes[third] / length).pieces()
    else:
        pieces = search.pieces(start, end)
    cables = [_scaled_cable(branch, piece, turned) for piece in _distinct(pieces)]
    return [cable for cable in cables if cable is not None]


def _distinct(pieces: list[Piece]) -> list[Piece]:
    kept: list[Piece] = []
    for piece in sorted(pieces):
        close = 1e-6 * (piece[1] - piece[0]) + 1e-10 * (1.0 + abs(piece[0]))
        if not any(np.allclose(piece, other, rtol=0.0, atol=close) for other in kept):
            kept.append(piece)
    return kept


# the first of these quantities that is given sets the scale; a distance comes last, as it may be 0
_SCALES = ("length", "tension_b", "height", "tension_a", "distance")


def _scaled_cable(branch: Branch, piece: Piece, sizes: Mapping[str, float]) -> ChartSolution | None:
    unit = {name: float(size_of(branch, name, *piece)) for name in SIZES}
    name = next(name for name in _SCALES if name in sizes)
    scale = sizes[name] / unit[name] if unit[name] else 0.0
    if not (scale > 0.0 and math.isfinite(scale)):
        return None
    phi_a, phi_b = (float(branch.turned(branch.angle(place))) for place in piece)
    return ChartSolution(
        phi_a,
        phi_b,
        scale * unit["tension_a"],
        scale * unit["tension_b"],
        scale * unit["height"],
        scale * unit["distance"] * branch.sign,
        scale * unit["length"],
        scale,
    )


ANGLES = ("phi_a", "phi_b")
SIZES = ("tension_a", "tension_b", "height", "distance", "length")
GIVENS = (*ANGLES, *SIZES)


def check(known: Mapping[str, float], weight: float) -> None:
    """Raise UsageError unless exactly three quantities are given, each within its range."""
    if len(known) != 3:
        names = ", ".join(known) or "none"
        raise UsageError(f"three of {', '.join(GIVENS)} are needed; given: {names}")
    if not math.isfinite(weight) or weight == 0.0:
        raise UsageError(f"the weight is {weight:g} N/m; it must be a number other than 0")
    for name, value in known.items():
        if not math.isfinite(value):
            raise UsageError(f"{name} is not a finite number")
        if name in ("height", "length") and value <= 0.0:
            raise UsageError(f"{name} is {value:g} m; it must be positive")
        if name.startswith("tension") and value < 0.0:
            raise UsageError(f"{name} is {value:g} N; it must not be negative")
    for name in known.keys() & set(ANGLES):
        least = -math.pi if (name == "phi_a") == (weight > 0.0) else 0.0
        if not least <= known[name] <= math.pi:
            raise UsageError(
                f"{name} is {math.degrees(known[name]):.6g}°; "
                f"it must be from {math.degrees(least):g}° to 180°"
            )


def mirrored(values: Mapping[str, float]) -> dict[str, float]:
    """Return the quantities of the vertical mirror image of a cable.

    Mirroring turns a buoyant cable into a sinking one, and vice versa.
    """
    swapped = {"a": "b", "b": "a"}
    mirrored = {}
    for name, value in values.items():
        stem, _, end = name.rpartition("_")
        if stem == "phi":
            turned = math.pi - value
            mirrored[f"phi_{swapped[end]}"] = turned - 2 * math.pi if turned > math.pi else turned
        elif stem == "tension":
            mirrored[f"tension_{swapped[end]}"] = value
        else:
            mirrored[name] = -value if name == "distance" else value
    return mirrored


_ROUNDING = 1e-9
_LEAST_SLACK = 1e-12


def family(what: str) -> NoEquilibrium:
    """Return the answer that the given quantities do not determine the cable.

    `what` is the message of this answer.
    """
    return NoEquilibrium(
        "one-parameter-family", what, "Replace one of these quantities with another one."
    )


def contradiction(known: Mapping[str, float]) -> NoEquilibrium | None:
    """Check the given quantities of a sinking cable for faults that do not depend on K.

    Quantities are faulty if they contradict each other or are not independent. The result is None
    if there is no fault. The messages are also valid for a buoyant cable.
    """
    below, above = known.get("tension_a"), known.get("tension_b")
    height, distance = known.get("height", 0.0), known.get("distance", 0.0)
    if below is not None and above is not None and "height" in known:
        if abs(above - below - height) <= _ROUNDING * above:
            return family("Two tensions and the height are not independent: T_B = T_A + w H.")
        return _inconsistent(
            "The two tensions and the height do not satisfy T_B = T_A + w H.",
            "Set two of these and one other quantity.",
        )
    if above is not None and above <= (below or 0.0) + height:
        least = "the tension at the other end" if below is not None else "w H" if height else "0"
        return _inconsistent(
            "The tension at the upper end (for a buoyant cable, at the lower end) must exceed "
            f"{least}.",
            "Check that the two ends are not exchanged, and check the weight.",
        )
    chord = math.hypot(height, distance)
    if "length" in known and chord > known["length"] * (1.0 + _ROUNDING):
        return _inconsistent(
            f"The cable, {known['length']:.6g} m, is shorter than the distance between its ends, "
            f"{chord:.6g} m.",
            "Lengthen the cable or bring its ends closer.",
        )
    return None


def is_taut(known: Mapping[str, float]) -> bool:
    """Return whether the cable length equals the distance between the ends, within rounding."""
    chord = math.hypot(known.get("height", 0.0), known.get("distance", 0.0))
    return "length" in known and chord >= known["length"] * (1.0 - _LEAST_SLACK)


def reason(k: float, known: Mapping[str, float], floats: bool) -> NoEquilibrium:
    """Explain why no cable has the given quantities, although they do not contradict each other.

    If the cable is buoyant (`floats`), `known` has the mirrored quantities.
    """
    critical = float(critical_angle(k))
    shown = math.degrees(math.pi - critical if floats else critical)
    angle = f"the critical angle, {shown:.6g}° at K = {k:g}"
    start, end = known.get("phi_a"), known.get("phi_b")
    if known.get("tension_a") == 0.0:
        message = f"A cable without tension at one end is straight; its angle is {angle}."
        return _none(message, "Set a tension above 0, or quantities that fit a straight cable.")
    if is_taut(known):
        message = (
            "A cable no longer than the distance between its ends would need infinite tension."
        )
        return _none(message, "Lengthen the cable or bring its ends closer.")
    if end is not None and not 0.0 < end < math.pi:
        message = "At the end with the larger tension, the cable must rise from A to B."
        return _none(message, "Set an angle between 0 and 180° at that end.")
    if start is not None and end is not None:
        lean = start + 2 * math.pi if start < critical - math.pi else start
        if (lean - critical) * (end - critical) <= 0.0:
            return _none(
                f"The angle along a cable cannot cross {angle}.",
                "Set two angles on the same side of this angle.",
            )
        return _none(
            "No cable with these two angles rises from A to B.",
            "Check that the two ends are not exchanged, and check the sign of the distance, if "
            "set.",
        )
    return _none(
        f"No cable in a uniform current at K = {k:g} satisfies these three quantities.",
        "Check K and the quantities, or replace one of the quantities with another one.",
    )


def _inconsistent(message: str, advice: str) -> NoEquilibrium:
    return NoEquilibrium("inconsistent", message, advice)


def _none(message: str, advice: str) -> NoEquilibrium:
    return NoEquilibrium("no-equilibrium", message, advice)


def straight(k: float, known: Mapping[str, float]) -> ChartSolution | NoEquilibrium | None:
    """Return the straight cable at the critical angle that has the given quantities.

    In `known`, angles are in rad and tensions are divided by w. The result is None if no straight
    cable has these quantities to 1e-9. If the quantities leave the length or the tension open, the
    function returns NoEquilibrium instead of raising the exception.
    """
    angle = float(critical_angle(k))
    sine, cosine = math.sin(angle), 0.0 if k == 0.0 else math.cos(angle)
    if any(abs(known[name] - angle) > _ROUNDING for name in ("phi_a", "phi_b") if name in known):
        return None
    below, above, distance = (known.get(name) for name in ("tension_a", "tension_b", "distance"))
    lengths = [known["length"]] if "length" in known else []
    if "height" in known:
        lengths.append(known["height"] / sine)
    if below is not None and above is not None:
        lengths.append((above - below) / sine)
    if distance is not None and cosine != 0.0:
        lengths.append(distance / cosine)
    elif distance:
        return None
    if lengths and (min(lengths) <= 0.0 or max(lengths) > (1.0 + _ROUNDING) * min(lengths)):
        return None
    length = lengths[0] if lengths else None
    if below is None and above is not None and length is not None:
        below = above - length * sine
        if below < -_ROUNDING * above:
            return None
        below = max(below, 0.0)
    if below is None or length is None:
        return family(
            "These quantities do not determine the length or the tension of a straight cable at "
            "the critical angle."
        )
    rise = length * sine
    distance = length * math.cos(angle)
    return ChartSolution(angle, angle, below, below + rise, rise, distance, length, 0.0)
