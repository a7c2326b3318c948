"""Roots of the closing condition: within a bracket, and near an estimate."""

from __future__ import annotations

from collections.abc import Callable


def bracketed_root(
    function: Callable[[float], float],
    a: float,
    fa: float,
    b: float,
    fb: float,
    *,
    small: float,
    narrow: float,
) -> tuple[float, float, float]:
    """Root of a continuous function between a and b, where its signs differ.

    False position with Anderson and Björck's weights (order 1.7); a step that does not halve the
    bracket twice running is followed by a bisection, so the bracket always closes.

    Parameters
    ----------
    small : stop when |function| is at most this
    narrow : stop when the bracket is at most this wide

    Returns
    -------
    root, value there, and the slope of the last secant (0 where none is known).
    """
    if fa == 0.0:
        return a, fa, 0.0
    slope = (fb - fa) / (b - a)
    weighted_a, idle = fa, 0
    if abs(fa) < abs(fb):
        a, fa, b, fb = b, fb, a, fa
        weighted_a = fa
    while abs(fb) > small and abs(b - a) > narrow:
        width = abs(b - a)
        x = b - fb * (b - a) / (fb - weighted_a) if idle < 2 else 0.5 * (a + b)
        if not min(a, b) < x < max(a, b):
            x = 0.5 * (a + b)
            if x in (a, b):
                break
        fx = function(x)
        slope = (fx - fb) / (x - b)
        if (fx > 0.0) != (fb > 0.0):
            a, fa = b, fb
            weighted_a = fa
        else:
            shrink = 1.0 - fx / fb
            weighted_a *= shrink if shrink > 0.0 else 0.5
        b, fb = x, fx
        if idle >= 2:
            idle, weighted_a = 0, fa
        idle = idle + 1 if abs(b - a) > 0.5 * width else 0
    return b, fb, slope


def root_near(
    function: Callable[[float], float],
    x: float,
    slope: float,
    limits: tuple[float, float],
    *,
    small: float,
    narrow: float,
) -> tuple[float, float, float] | None:
    """Root near x of a falling function, within limits; None where there is no sign change.

    Secants from x and its slope while they halve the value, then ever longer steps until the sign
    changes, then `bracketed_root`. `small` and `narrow` are as there.

    Returns
    -------
    root, value there, and the slope of the last secant.
    """
    low, high = limits
    x = min(max(x, low), high)
    fx = function(x)
    step = -fx / slope if slope < 0.0 else 0.0
    while abs(fx) > small:
        reach = max(abs(step), 1e-6 * (high - low))
        following = min(max(x + (reach if fx > 0.0 else -reach), low), high)
        if following == x:
            return None
        value = function(following)
        slope = (value - fx) / (following - x)
        if (value > 0.0) != (fx > 0.0):
            return bracketed_root(function, x, fx, following, value, small=small, narrow=narrow)
        halved = abs(value) < 0.5 * abs(fx)
        step = -value / slope if halved else 8.0 * reach
        x, fx = following, value
    return x, fx, slope
