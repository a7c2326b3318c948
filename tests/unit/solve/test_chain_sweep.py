"""A chain of masses and springs against its matrix, and against itself in plain Python."""

from typing import Any

import numpy as np
import pytest

from calm.physics.compiled import outcome
from calm.solve.chain_sweep import MassChain, sweep_chain

OMEGA = np.array([0.4, 1.1, 2.3])


def triangles(matrices: Any) -> Any:
    return np.ascontiguousarray(matrices[..., (0, 0, 0, 1, 1, 2), (0, 1, 2, 1, 2, 2)])


def made(nodes: int, stiffest: float) -> tuple[Any, ...]:
    """Springs with axes at random, up to a stiffness, and forces."""
    random = np.random.default_rng(1)
    axis = random.standard_normal((nodes, 3))
    axis /= np.linalg.norm(axis, axis=1, keepdims=True)
    along = np.where(np.arange(nodes) % 3, 1e5, stiffest)[:, None, None]
    outer = axis[:, :, None] * axis[:, None, :]
    springs = along * outer + 500.0 * (np.eye(3) - outer)
    mass = 30.0 * np.eye(3) + 10.0 * outer
    damping = random.uniform(1.0, 50.0, (nodes, 1, 1)) * np.eye(3)
    top = (2e4 - 500.0j) * OMEGA[:, None, None] * np.eye(3)
    push = random.standard_normal((len(OMEGA), nodes, 6)).view(complex)
    rows = np.column_stack([np.full(nodes, 500.0), along[:, 0, 0] - 500.0, axis])
    return (springs, mass, damping, top, push), rows


def chain_of(parts: Any, rows: Any) -> MassChain:
    _, mass, damping, top, push = parts
    work = np.empty((len(rows), 26))
    return MassChain(
        rows,
        triangles(mass),
        triangles(damping),
        OMEGA,
        triangles(top).view(float),
        push.copy().view(float),
        work,
    )


def matrix_of(springs: Any, mass: Any, damping: Any, top: Any, omega: float) -> Any:
    """The whole matrix at a frequency, in the longest floats there are."""
    nodes = len(springs)
    whole = np.zeros((nodes, 3, nodes, 3), np.clongdouble)
    for i in range(nodes):
        whole[i, :, i] += springs[i] - np.longdouble(omega) ** 2 * mass[i]
        whole[i, :, i] += 1j * np.longdouble(omega) * damping[i]
        if i + 1 < nodes:
            whole[i + 1, :, i + 1] += springs[i]
            whole[i, :, i + 1] -= springs[i]
            whole[i + 1, :, i] -= springs[i]
    whole[0, :, 0] += top
    return whole.reshape(3 * nodes, 3 * nodes)


@pytest.mark.parametrize(("stiffest", "within"), [(1e5, 1e-12), (1e9, 1e-9)])
def test_the_motions_balance_the_forces(stiffest: float, within: float) -> None:
    """Also with springs that hardly stretch, whose forces are small differences of large ones."""
    parts, rows = made(40, stiffest)
    springs, mass, damping, top, push = parts
    chain = chain_of(parts, rows)
    outcome(sweep_chain, True, chain)
    motion = chain.push.view(complex)
    for f, omega in enumerate(OMEGA):
        matrix = matrix_of(springs, mass, damping, top[f], omega)
        exact = np.linalg.solve(matrix.astype(complex), push[f].ravel())
        for _ in range(10):  # refined with residuals in longer floats
            exact = exact.astype(np.clongdouble)
            left = push[f].ravel() - (matrix * exact).sum(1)
            exact += np.linalg.solve(matrix.astype(complex), left.astype(complex))
        off = np.abs(motion[f].ravel() - exact).max() / np.abs(exact).max()
        assert off < within


def test_both_speeds_give_the_same_digits() -> None:
    plain, compiled = (chain_of(*made(7, 1e9)) for _ in range(2))
    sweep_chain(plain)
    outcome(sweep_chain, True, compiled)
    assert plain.push.tobytes() == compiled.push.tobytes()
