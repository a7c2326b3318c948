"""Current profiles of many characters, drawn from a seed."""

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
CHARACTERS = 6


def drawn(seed: int, count: int, water_depth: float, levels: int = 40) -> tuple[Floats, ...]:
    """Depths (k,) [m] and u, v, w (count, k) [m/s] of currents up to 1.6 m/s.

    In turn: sheared, turning and sheared, an undercurrent, evenly falling, ragged from level to
    level, turning at one speed.
    """
    rng = np.random.default_rng(seed)
    x = np.linspace(0.0, 1.0, levels) ** 1.5
    speeds, angles, rises = [], [], []
    for i in range(count):
        top = rng.choice([0.2, 0.5, 1.0, 1.6]) * rng.uniform(0.5, 1.0)
        angle = rng.uniform(0.0, 2.0 * np.pi) + 0.0 * x
        rise = 0.0 * x
        match i % CHARACTERS:
            case 0:
                speed = top * np.exp(-x * rng.uniform(1.0, 8.0))
            case 1:
                speed = top * np.exp(-4.0 * x) + 0.05
                angle += rng.uniform(-2.0, 2.0) * x
                rise = 0.01 * top * np.sin(5.0 * x)
            case 2:
                speed = top * (0.3 + 0.7 * np.exp(-(((x - rng.uniform(0.1, 0.6)) / 0.15) ** 2)))
            case 3:
                speed = top * (1.0 - 0.9 * x)
            case 4:
                speed = top * np.exp(-3.0 * x) * (1.0 + 0.3 * rng.normal(size=levels))
                angle += 0.3 * rng.normal(size=levels)
            case _:
                speed = top + 0.0 * x
                angle += 3.0 * x
        speeds.append(speed)
        angles.append(angle)
        rises.append(rise)
    speed, angle = np.array(speeds), np.array(angles)
    return water_depth * x, speed * np.cos(angle), speed * np.sin(angle), np.array(rises)
