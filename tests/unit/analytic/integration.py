"""Direct integration of a line in a uniform stream: what the closed forms are held against.

    T' = w sin φ + F(φ),    T φ' = w cos φ − R |sin φ|^D sign(sin φ),    x' = cos φ,    z' = sin φ

with F = F₀ |cos φ|^E sign(cos φ); E = D for a drag that goes by its own component of the velocity,
0 for one that is constant. Dormand–Prince of order 8 with steps of relative error 1e-12, started
afresh where φ passes a multiple of 90°: the drags have kinks there.
"""

from __future__ import annotations

import numpy as np
from scipy.integrate import solve_ivp


def integrate(
    arc, tension, angle, weight, normal_drag, tangential_drag=0.0, exponent=2, friction_exponent=2
):
    """Angle [rad], tension [N], x and z [m] at an arc, and the least tension on the way."""

    def slope(_, state):
        pull, phi = state[:2]
        cosine, sine = np.cos(phi), np.sin(phi)
        rubbed = tangential_drag * np.abs(cosine) ** friction_exponent * np.sign(cosine)
        pushed = normal_drag * np.abs(sine) ** exponent * np.sign(sine)
        return [weight * sine + rubbed, (weight * cosine - pushed) / pull, cosine, sine]

    def kink(_, state):
        return np.sin(2.0 * state[1])

    kink.terminal = True

    def run(begin, end, state, events=None):
        return solve_ivp(
            slope, (begin, end), state, method="DOP853", rtol=1e-12, atol=1e-14, events=events
        )

    s, state, least = 0.0, np.array([tension, angle, 0.0, 0.0]), tension
    while s != arc:
        # A short step first: at a kink just met the event would fire at once.
        away = s + np.clip(arc - s, -1e-6 * abs(arc), 1e-6 * abs(arc))
        for end, events in ((away, None), (arc, kink)):
            if s == end:
                break
            # Up to the kink once more: where the event is found the state is only interpolated.
            stop = run(s, end, state, events).t[-1] if events else end
            steps = run(s, stop, state)
            s, state, least = stop, steps.y[:, -1], min(least, steps.y[0].min())
    pull, phi, x, z = state
    return np.array([phi, pull, x, z]), least


def difference(station, expected, arc):
    """The worst departure: of the angle [rad], of the tension, of x and z as a share of the arc."""
    phi, pull, x, z = expected
    return max(
        abs(station.angle - phi),
        abs(station.tension / pull - 1.0),
        abs(station.x - x) / abs(arc),
        abs(station.z - z) / abs(arc),
    )
