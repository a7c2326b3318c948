"""Roots of the closing condition: bracketed and superlinear, and a secant polish near a root."""

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


def secant_root(
    function: Callable[[float], float], x: float, slope: float, *, small: float, narrow: float
) -> tuple[float, float, float] | None:
    """Root near x of a smooth function of known slope; None where eight secants do not find it.

    Stops when |function| ≤ small and the next step would be at most `narrow`.
    """
    fx = function(x)
    for _ in range(8):
        if slope == 0.0:
            return None
        step = -fx / slope
        if abs(fx) <= small and abs(step) <= narrow:
            return x, fx, slope
        following = x + step
        value = function(following)
        if abs(value) > max(0.5 * abs(fx), small):
            return None
        if following != x and value != fx:
            slope = (value - fx) / (following - x)
        x, fx = following, value
    return None
