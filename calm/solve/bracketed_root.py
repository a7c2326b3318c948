"""Root of a function of one variable between two points at which its signs differ."""

from collections.abc import Callable


def bracketed_root(
    function: Callable[[float], float], low: float, high: float, rtol: float = 1e-12
) -> float:
    """Find the root of a continuous function by Chandrupatla's method.

    Uses inverse quadratic interpolation if this surely converges faster than bisection (T. R.
    Chandrupatla 1997, Advances in Engineering Software 28, 145).

    Parameters
    ----------
    function : values of different sign at `low` and `high`
    rtol : width of the last bracket, relative to the root

    Raises
    ------
    ValueError
        The values at the ends have the same sign.
    """
    a, b = high, low
    at_a, at_b = function(a), function(b)
    if at_a * at_b > 0.0:
        raise ValueError("the function has the same sign at both ends")
    share = 0.5
    while True:
        x = a + share * (b - a)
        at_x = function(x)
        if (at_x > 0.0) == (at_a > 0.0):
            c, at_c, a, at_a = a, at_a, x, at_x
        else:
            c, at_c, b, at_b, a, at_a = b, at_b, a, at_a, x, at_x
        best, at_best = (a, at_a) if abs(at_a) < abs(at_b) else (b, at_b)
        width = abs(b - a)
        least = rtol * abs(best)
        if at_best == 0.0 or width <= 2.0 * least or a + 0.5 * (b - a) in (a, b):
            return best
        place, value = (a - b) / (c - b), (at_a - at_b) / (at_c - at_b)
        share = 0.5
        if value * value < place and (1.0 - value) ** 2 < 1.0 - place:
            share = (at_a / (at_b - at_a)) * (at_c / (at_b - at_c))
            share += (c - a) / (b - a) * (at_a / (at_c - at_a)) * (at_b / (at_c - at_b))
        limit = least / width
        share = min(max(share, limit), 1.0 - limit)
