"""Roots of the closing condition: within a bracket, and near an estimate."""

from __future__ import annotations

from collections.abc import Callable
from math import isnan
from typing import Any


def bracketed_root(
    function: Callable[[Any, float], float],
    about: Any,
    a: float,
    fa: float,
    b: float,
    fb: float,
    small: float,
    narrow: float,
) -> tuple[float, float, float]:
    """Root of a continuous function between a and b, where its signs differ.

    Brent's method: inverse quadratic or secant steps where they keep to the bracket and at least
    halve the step before last, bisection elsewhere.

    Parameters
    ----------
    function, about : of a number, `function(about, number)`; NaN, where it cannot be had, ends it
    a, fa, b, fb : two numbers and the function there
    small : stop when |function| is at most this
    narrow : stop when the bracket is at most this wide

    Returns
    -------
    root, value there, and the slope of the secant across the last bracket.
    """
    c, fc = a, fa
    step = earlier = b - a
    while True:
        if (fb > 0.0) == (fc > 0.0):
            c, fc = a, fa
            step = earlier = b - a
        if abs(fc) < abs(fb):
            a, b, c = b, c, b
            fa, fb, fc = fb, fc, fb
        half = 0.5 * (c - b)
        if (
            isnan(fb)
            or abs(fb) <= small
            or abs(half) <= 0.5 * narrow
            or b + half == b
            or b + half == c
        ):
            return b, fb, (fc - fb) / (c - b) if c != b else 0.0
        if abs(fa) <= abs(fb):
            step = earlier = half
        else:
            earlier, step = step, _interpolated_step(a, fa, b, fb, c, fc, half, earlier)
            if step == half:
                earlier = half
        a, fa = b, fb
        least = 0.25 * narrow
        b += step if abs(step) > least else (least if half > 0.0 else -least)
        fb = function(about, b)


def _interpolated_step(
    a: float,
    fa: float,
    b: float,
    fb: float,
    c: float,
    fc: float,
    half: float,
    earlier: float,
) -> float:
    """Step from b by inverse interpolation, or half way to c where that is not to be trusted."""
    s = fb / fa
    if a == c:
        p, q = 2.0 * half * s, 1.0 - s
    else:
        q, r = fa / fc, fb / fc
        p = s * (2.0 * half * q * (q - r) - (b - a) * (r - 1.0))
        q = (q - 1.0) * (r - 1.0) * (s - 1.0)
    if p > 0.0:
        q = -q
    p = abs(p)
    return p / q if 2.0 * p < min(3.0 * half * q, abs(earlier * q)) else half


def root_near(
    function: Callable[[Any, float], float],
    about: Any,
    x: float,
    slope: float,
    low: float,
    high: float,
    small: float,
    narrow: float,
) -> tuple[bool, float, float, float]:
    """Root near x of a falling function, between two limits.

    Secants from x and its slope while they halve the value, then ever longer steps until the sign
    changes, then `bracketed_root`.

    Parameters
    ----------
    function, about, small, narrow : as there
    x, slope : about where the root is, and the slope there
    low, high : the limits

    Returns
    -------
    Whether the sign changes; root, value there, and the slope of the last secant.
    """
    x = min(max(x, low), high)
    fx = function(about, x)
    step = -fx / slope if slope < 0.0 else 0.0
    while abs(fx) > small:
        reach = max(abs(step), 1e-12 * (high - low))
        following = min(max(x + (reach if fx > 0.0 else -reach), low), high)
        if following == x:
            return False, x, fx, slope
        value = function(about, following)
        slope = (value - fx) / (following - x)
        if (value > 0.0) != (fx > 0.0) and not isnan(value):
            root, left, slope = bracketed_root(
                function, about, x, fx, following, value, small, narrow
            )
            return True, root, left, slope
        halved = abs(value) < 0.5 * abs(fx)
        step = -value / slope if halved else 8.0 * reach
        x, fx = following, value
    return True, x, fx, slope
