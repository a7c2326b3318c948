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

    Chandrupatla's method: inverse quadratic steps where three values lie on a curve that these can
    follow, else bisection; the first step is a secant.

    Parameters
    ----------
    function, about : of a number, `function(about, number)`; NaN, where it cannot be had, ends it
    a, fa, b, fb : two numbers and the function there
    small : stop when |function| is at most this
    narrow : stop when the bracket is at most this wide

    Returns
    -------
    root, value there, and the slope of the secant across the last bracket. That is where the
    function was last had, but where another is good enough.

    Source: Chandrupatla, Advances in Engineering Software 28 (1997), 145-149.
    """
    share = fa / (fa - fb) if fa != fb else 0.5
    while True:
        width, slope = abs(b - a), (fb - fa) / (b - a) if b != a else 0.0
        if isnan(fa):
            return a, fa, slope
        root, value = (a, fa) if abs(fa) < abs(fb) else (b, fb)
        middle = a + 0.5 * (b - a)
        if abs(value) <= small or middle in (a, b):
            return root, value, slope
        if width <= narrow:
            return a, fa, slope
        least = 0.25 * narrow / width
        x = a + min(max(share, least), 1.0 - least) * (b - a)
        value = function(about, x)
        if (value > 0.0) == (fa > 0.0):
            c, fc = a, fa
        else:
            c, fc, b, fb = b, fb, a, fa
        a, fa = x, value
        share = 0.5
        place, height = (a - b) / (c - b), (fa - fb) / (fc - fb)
        if height * height < place and (1.0 - height) * (1.0 - height) < 1.0 - place:
            share = fa / (fb - fa) * fc / (fb - fc)
            share += (c - a) / (b - a) * fa / (fc - fa) * fb / (fc - fb)


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
