"""Three of seven quantities against the published examples, round trips and direct integration."""

import itertools
import math

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from calm.analytic.chart import GIVENS, SIZES, ChartSolution, chart_solve, mirrored
from calm.analytic.chart_branch import Branch, critical_angle
from calm.analytic.chart_search import size_of
from calm.errors import UsageError

FAMILY = ("tension_a", "tension_b", "height")
TRIPLES = [triple for triple in itertools.combinations(GIVENS, 3) if triple != FAMILY]


def in_radians(given: dict[str, float]) -> dict[str, float]:
    return {
        name: math.radians(value) if name.startswith("phi") else value
        for name, value in given.items()
    }


def figures(solution: ChartSolution) -> dict[str, float]:
    return {name: getattr(solution, name) for name in GIVENS}


def error(found: dict[str, float], wanted: dict[str, float]) -> float:
    """Greatest relative error; of the distance as a share of the length, of angles in radians."""
    units = {name: abs(value) for name, value in wanted.items()}
    units |= {"phi_a": 1.0, "phi_b": 1.0, "distance": wanted["length"]}
    return max(abs(found[name] - wanted[name]) / units[name] for name in wanted)


# Braconnot's two examples, the second at its own 1 knot too, and one cable of each other shape.
# Each figure is given to its last digit.
EXAMPLES = {
    "buoy": (
        2.4, 5.0, {"phi_b": 75, "tension_b": 350, "height": 20},
        {"length": (28.467, 5e-4), "distance": (18.782, 5e-4), "phi_a": (22.027, 5e-4),
         "tension_a": (250.0, 5e-3)},
    ),
    "tow": (
        2.4, 0.5, {"phi_b": 140, "tension_b": 100, "length": 100},
        {"height": (73.198, 5e-4), "distance": (-67.215, 5e-4), "phi_a": (116.373, 5e-4),
         "tension_a": (63.401, 5e-4)},
    ),
    "tow at 1 knot": (
        3.176, 0.5, {"phi_b": 140, "tension_b": 100, "length": 100}, {"height": (82.87, 5e-3)},
    ),
    "second branch": (
        2.4, 0.5, {"phi_a": 165, "tension_a": 40, "length": 100},
        {"phi_b": (145.83813, 5e-6), "tension_b": (63.9741152, 5e-8),
         "height": (47.9482305, 5e-8), "distance": (-87.2866976, 5e-8)},
    ),
    "through the apex": (
        2.4, 0.5, {"phi_a": -20, "tension_a": 60, "length": 200},
        {"phi_b": (107.31124, 5e-6), "tension_b": (105.978848, 5e-7),
         "height": (91.9576956, 5e-8), "distance": (126.772138, 5e-7)},
    ),
}  # fmt: skip


@pytest.mark.parametrize("name", EXAMPLES)
def test_published_examples(name: str) -> None:
    k, weight, given, wanted = EXAMPLES[name]
    solution = chart_solve(k, weight, **in_radians(given)).solutions[0]
    for quantity, (value, tolerance) in wanted.items():
        found = getattr(solution, quantity)
        if quantity.startswith("phi"):
            found = math.degrees(found)
        assert found == pytest.approx(value, abs=tolerance), quantity


def test_the_buoy_also_fits_a_cable_that_dips_below_its_lower_end() -> None:
    answer = chart_solve(2.4, 5.0, **in_radians({"phi_b": 75, "tension_b": 350, "height": 20}))
    assert answer.status == "converged"
    upright, dipping = answer.solutions
    assert upright.phi_a > 0.0 > dipping.phi_a
    assert dipping.tension_a == pytest.approx(upright.tension_a, rel=1e-12)


def random_cable(
    generator: np.random.Generator, sign: int
) -> tuple[float, float, dict[str, float]]:
    """K, w and the seven quantities of a piece of one branch; every other one floats."""
    k = float(10.0 ** generator.uniform(-2.0, 2.0)) if generator.random() < 0.8 else 0.0
    branch = Branch(k, sign)
    before, beyond = np.arccos(-branch.limit), np.arccos(branch.limit)
    while True:
        angles = generator.uniform(-0.95 * before, 0.95 * beyond), generator.uniform(0.0, beyond)
        start, end = (float(branch.parameter(angle)) for angle in angles)
        # Shorter pieces are so nearly straight that their lengths no longer tell the tension.
        if end > abs(start) and angles[1] - angles[0] > 0.1 and angles[1] < 0.95 * beyond:
            break
    scale, weight = 10.0 ** generator.uniform(-1.0, 2.0), float(generator.choice([0.5, 5.0, -2.0]))
    cable = {name: scale * float(size_of(branch, name, start, end)) for name in SIZES}
    cable["distance"] *= sign
    cable["tension_a"] *= abs(weight)
    cable["tension_b"] *= abs(weight)
    cable["phi_a"], cable["phi_b"] = (float(branch.turned(angle)) for angle in angles)
    return k, weight, mirrored(cable) if weight < 0.0 else cable


CABLES = pytest.mark.parametrize("cables", [1, pytest.param(4, marks=pytest.mark.thorough)])


@CABLES
@pytest.mark.parametrize("sign", [1, -1], ids=["first branch", "second branch"])
@pytest.mark.parametrize("triple", TRIPLES, ids=" ".join)
def test_every_triple_gives_the_cable_it_was_taken_from(
    triple: tuple[str, ...], sign: int, cables: int
) -> None:
    generator = np.random.default_rng(TRIPLES.index(triple))
    for _ in range(cables):
        k, weight, cable = random_cable(generator, sign)
        answer = chart_solve(k, weight, **{name: cable[name] for name in triple})
        assert answer.status == "converged"
        found = [figures(solution) for solution in answer.solutions]
        assert min(error(one, cable) for one in found) < 1e-9
        given = {name: cable[name] for name in triple} | {"length": cable["length"]}
        for one in found:
            own = given | ({} if "length" in triple else {"length": one["length"]})
            assert error(one, own) < 1e-9


def integrated(k: float, weight: float, solution: ChartSolution) -> dict[str, float]:
    """The upper end, by integration of the equations from the lower one."""

    drag = math.copysign(k, weight)

    def slope(_: float, state: np.ndarray) -> list[float]:
        phi, tension, *_ = state.tolist()
        sine, cosine = math.sin(phi), math.cos(phi)
        return [weight * (cosine + drag * abs(sine) * sine) / tension, weight * sine, cosine, sine]

    begin = [solution.phi_a, solution.tension_a, 0.0, 0.0]
    path = solve_ivp(slope, (0.0, solution.length), begin, method="DOP853", rtol=1e-11, atol=1e-12)
    end = path.y[:, -1]
    return {
        "phi_b": float((end[0] + np.pi) % (2.0 * np.pi) - np.pi),
        "tension_b": float(end[1]),
        "distance": float(end[2]),
        "height": float(end[3]),
        "length": solution.length,
    }


@CABLES
@pytest.mark.parametrize("sign", [1, -1], ids=["first branch", "second branch"])
@pytest.mark.parametrize(
    "triple",
    [
        ("phi_b", "tension_b", "distance"),
        ("phi_a", "distance", "length"),
        ("tension_a", "height", "distance"),
        ("tension_b", "distance", "length"),
        ("height", "distance", "length"),
    ],
    ids=" ".join,
)
def test_solutions_satisfy_the_equations_of_the_cable(
    triple: tuple[str, ...], sign: int, cables: int
) -> None:
    generator = np.random.default_rng(7)
    for _ in range(cables):
        k, weight, cable = random_cable(generator, sign)
        answer = chart_solve(k, weight, **{name: cable[name] for name in triple})
        critical = float(critical_angle(k))
        for solution in answer.solutions:
            # A cable that sets out straight down its other critical angle leaves it by an amount
            # far below rounding, which no integration from that end can follow.
            lowest = solution.phi_a if weight > 0.0 else math.pi - solution.phi_b
            if abs(math.sin(lowest - critical)) < 1e-3:
                continue
            wanted = integrated(k, weight, solution)
            found = figures(solution)
            size = solution.length
            # The integration is good to 1e-11 a step, which stiff K multiply by some hundreds.
            assert found["height"] == pytest.approx(wanted.pop("height"), abs=1e-8 * size)
            assert error(found, wanted) < 1e-8


def test_without_a_current_the_answer_is_the_catenary() -> None:
    weight, horizontal = 10.0, 2000.0
    lower, upper = 30.0, 130.0  # m from the apex
    parameter = horizontal / weight
    given = {
        "height": parameter * (math.cosh(upper / parameter) - math.cosh(lower / parameter)),
        "distance": upper - lower,
        "length": parameter * (math.sinh(upper / parameter) - math.sinh(lower / parameter)),
    }
    (solution,) = chart_solve(0.0, weight, **given).solutions
    assert solution.h0 == pytest.approx(parameter, rel=1e-9)
    assert solution.tension_b == pytest.approx(horizontal * math.cosh(upper / parameter), rel=1e-9)


def test_a_floating_cable_is_a_sinking_one_upside_down() -> None:
    given = in_radians({"phi_b": 75, "tension_b": 350, "height": 20})
    sinking = chart_solve(2.4, 5.0, **given).solutions
    floating = chart_solve(2.4, -5.0, **mirrored(given)).solutions
    assert len(floating) == len(sinking) == 2
    for one, other in zip(sinking, floating, strict=True):
        assert mirrored(figures(one)) == pytest.approx(figures(other), rel=1e-13)
        assert other.tension_a == pytest.approx(other.tension_b + 5.0 * other.height, rel=1e-12)


def test_two_tensions_and_the_height_fix_nothing() -> None:
    sizes = {"tension_a": 250.0, "tension_b": 350.0}
    answer = chart_solve(2.4, 5.0, **sizes, height=20.0)
    assert (answer.status, answer.solutions) == ("one-parameter-family", ())
    answer = chart_solve(2.4, 5.0, **sizes, height=21.0)
    assert (answer.status, answer.solutions) == ("inconsistent", ())
    assert answer.message and answer.advice


def test_without_tension_at_its_light_end_a_cable_is_straight() -> None:
    angle = float(critical_angle(2.4))
    (solution,) = chart_solve(2.4, 0.5, phi_b=angle, tension_a=0.0, length=100.0).solutions
    assert figures(solution) == pytest.approx(
        {
            "phi_a": angle, "phi_b": angle, "tension_a": 0.0,
            "tension_b": 50.0 * math.sin(angle), "height": 100.0 * math.sin(angle),
            "distance": 100.0 * math.cos(angle), "length": 100.0,
        },
        rel=1e-12,
    )  # fmt: skip
    answer = chart_solve(2.4, 0.5, phi_b=2.0, tension_a=0.0, length=100.0)
    assert answer.status == "no-equilibrium"
    assert "144.404°" in answer.message


def test_a_straight_cable_may_carry_any_tension() -> None:
    angle = float(critical_angle(2.4))
    answer = chart_solve(2.4, 0.5, phi_a=angle, phi_b=angle, length=100.0)
    assert answer.status == "one-parameter-family"
    (solution,) = chart_solve(2.4, 0.5, phi_a=angle, tension_a=60.0, length=100.0).solutions
    assert solution.tension_b == pytest.approx(60.0 + 50.0 * math.sin(angle), rel=1e-12)


def test_no_cable_straddles_the_critical_angle() -> None:
    answer = chart_solve(2.4, 0.5, phi_a=math.radians(140), phi_b=math.radians(150), length=1.0)
    assert answer.status == "no-equilibrium"
    assert "The angle along a cable cannot cross the critical angle" in answer.message


def test_a_cable_without_slack_is_straight_or_none() -> None:
    answer = chart_solve(2.4, 5.0, height=3.0, distance=4.0, length=5.0)
    assert answer.status == "no-equilibrium"
    assert "infinite tension" in answer.message
    (plumb,) = chart_solve(0.0, 5.0, tension_a=10.0, height=7.0, length=7.0).solutions
    assert plumb.phi_a == math.pi / 2
    assert plumb.distance == pytest.approx(0.0, abs=1e-14)
    answer = chart_solve(0.0, 5.0, height=7.0, distance=0.0, length=7.0)
    assert answer.status == "one-parameter-family"


@pytest.mark.parametrize("end", ["phi_a", "phi_b"])
def test_the_apex_is_a_lower_end_only(end: str) -> None:
    for angle in (0.0, math.pi):
        answer = chart_solve(2.4, 5.0, tension_a=10.0, length=7.0, **{end: angle})
        assert answer.status == ("converged" if end == "phi_a" else "no-equilibrium")


@pytest.mark.parametrize(
    "given",
    [
        {"tension_a": 350.0, "tension_b": 250.0, "length": 50.0},
        {"tension_b": 50.0, "height": 20.0, "length": 50.0},
        {"height": 30.0, "distance": 41.0, "length": 50.0},
        {"tension_a": 10.0, "height": 51.0, "length": 50.0},
    ],
    ids=lambda given: " ".join(given),
)
def test_quantities_that_contradict_each_other(given: dict[str, float]) -> None:
    answer = chart_solve(2.4, 5.0, **given)
    assert (answer.status, answer.solutions) == ("inconsistent", ())


@pytest.mark.parametrize(
    ("k", "weight", "given", "complaint"),
    [
        (2.4, 5.0, {"phi_a": 0.5, "length": 1.0}, "three of"),
        (2.4, 5.0, {"phi_a": 0.5, "phi_b": 1.0, "height": 1.0, "length": 1.0}, "three of"),
        (-0.1, 5.0, {"phi_a": 0.5, "phi_b": 1.0, "length": 1.0}, "K is -0.1"),
        (math.nan, 5.0, {"phi_a": 0.5, "phi_b": 1.0, "length": 1.0}, "K is nan"),
        (2.4, 0.0, {"phi_a": 0.5, "phi_b": 1.0, "length": 1.0}, "weight is 0"),
        (2.4, 5.0, {"phi_a": 0.5, "phi_b": 3.5, "length": 1.0}, "phi_b is 200.535°"),
        (2.4, 5.0, {"phi_a": 0.5, "phi_b": -0.1, "length": 1.0}, "from 0° to 180°"),
        (2.4, 5.0, {"phi_a": 0.5, "phi_b": 1.0, "length": -1.0}, "must be positive"),
        (2.4, 5.0, {"phi_a": 0.5, "phi_b": 1.0, "tension_a": -1.0}, "must not be negative"),
        (2.4, 5.0, {"phi_a": 0.5, "phi_b": 1.0, "distance": math.inf}, "not a finite number"),
    ],
)
def test_no_question_at_all(
    k: float, weight: float, given: dict[str, float], complaint: str
) -> None:
    with pytest.raises(UsageError, match=complaint):
        chart_solve(k, weight, **given)
