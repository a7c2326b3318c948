"""Motion of a chain of masses, springs and dampers at many frequencies, as a compiled function.

Complex numbers are pairs of floats. Symmetric 3 x 3 matrices are the six numbers of their upper
triangles, row by row.
"""

from collections.abc import MutableSequence, Sequence
from typing import Any, NamedTuple

from calm.physics.compiled import within

Complex = tuple[float, float]
Symmetric = tuple[Complex, Complex, Complex, Complex, Complex, Complex]
Triple = tuple[Complex, Complex, Complex]


class MassChain(NamedTuple):
    """A chain of n nodes, each above a spring, at f frequencies.

    The last spring ends at a fixed point.

    Attributes
    ----------
    springs : (n, 5) transverse stiffness; axial minus transverse stiffness; unit vector along the
        spring
    mass, damping : (n, 6) symmetric matrices of the nodes
    omega : (f,) angular frequencies [rad/s]
    top : (f, 12) complex stiffness matrix added at the first node
    push : (f, n, 6) complex forces on the nodes, which `sweep_chain` overwrites with the motions
    """

    springs: Sequence[Sequence[float]]
    mass: Sequence[Sequence[float]]
    damping: Sequence[Sequence[float]]
    omega: Sequence[float]
    top: Sequence[Sequence[float]]
    push: Any
    work: Sequence[MutableSequence[float]]


class Link(NamedTuple):
    """A spring with stiffness K = s + c t tᵀ, below a part of a chain with dynamic stiffness A.

    The link holds the inverse of N = A + s, w = N⁻¹ t, q = A w and g = c / (1 + c t·w). Then

    - (A + K)⁻¹ = N⁻¹ - g w wᵀ
    - K (A + K)⁻¹ = s N⁻¹ + g q wᵀ
    - K (A + K)⁻¹ A = s N⁻¹ A + g q qᵀ
    """

    # these terms subtract no large numbers, however stiff the spring is
    inverse: Symmetric
    w: Triple
    q: Triple
    g: Complex


def sweep_chain(chain: MassChain) -> None:
    """Solve for the motions of a chain, and overwrite `push` with these motions."""
    last, work = len(chain.springs) - 1, chain.work
    for f in range(len(chain.omega)):
        omega, push = chain.omega[f], chain.push[f]
        above, force = symmetric_in(chain.top[f], 0), triple_in(push[0], 0)
        for i in range(last + 1):
            spring = chain.springs[i]
            above = sum_of(above, matrix_at(chain.mass[i], chain.damping[i], omega))
            link = link_of(spring, above)
            write_link(work[i], link)
            write_triple(push[i], 0, force)
            if i < last:
                above = through(spring[0], link, above)
                pulled = product(link.g, dot(link.w, force))
                force = total(
                    triple_in(push[i + 1], 0), spring[0], times(link.inverse, force), pulled, link.q
                )
        below: Triple = ((0.0, 0.0), (0.0, 0.0), (0.0, 0.0))
        nothing: Triple = ((0.0, 0.0), (0.0, 0.0), (0.0, 0.0))
        for i in range(last, -1, -1):
            link, force = link_in(work[i]), triple_in(push[i], 0)
            moved, pushed = dot(link.q, below), dot(link.w, force)
            pulled = product(link.g, (moved[0] - pushed[0], moved[1] - pushed[1]))
            held = total(force, chain.springs[i][0], below, (0.0, 0.0), nothing)
            below = total(nothing, 1.0, times(link.inverse, held), pulled, link.w)
            write_triple(push[i], 0, below)


@within
def link_of(spring: Sequence[float], above: Symmetric) -> Link:
    """Return the `Link` for a spring below a part of a chain."""
    a, b, c, d, e, f = above
    across, x, y, z = spring[0], spring[2], spring[3], spring[4]
    inverse = inverse_of(
        ((a[0] + across, a[1]), b, c, (d[0] + across, d[1]), e, (f[0] + across, f[1]))
    )
    a, b, c, d, e, f = inverse
    w = combined(x, a, y, b, z, c), combined(x, b, y, d, z, e), combined(x, c, y, e, z, f)
    along = combined(x, w[0], y, w[1], z, w[2])
    real, imaginary = 1.0 + spring[1] * along[0], spring[1] * along[1]
    size = spring[1] / (real * real + imaginary * imaginary)
    return Link(inverse, w, times(above, w), (real * size, -imaginary * size))


@within
def through(across: float, link: Link, above: Symmetric) -> Symmetric:
    """Return the dynamic stiffness of a part of a chain in series with the spring below it."""
    n, (x, y, z) = link.inverse, link.q
    a, b, c, d, e, f = above
    gx, gy, gz = product(link.g, x), product(link.g, y), product(link.g, z)
    ax, ay, _ = times(n, (a, b, c))
    _, by, _ = times(n, (b, d, e))
    cx, cy, cz = times(n, (c, e, f))
    return (
        scaled_sum(across, ax, gx, x), scaled_sum(across, ay, gx, y),
        scaled_sum(across, cx, gx, z), scaled_sum(across, by, gy, y),
        scaled_sum(across, cy, gy, z), scaled_sum(across, cz, gz, z),
    )  # fmt: skip


@within
def scaled_sum(r: float, x: Complex, a: Complex, b: Complex) -> Complex:
    """Return r x + a b for real r and complex x, a and b."""
    return r * x[0] + a[0] * b[0] - a[1] * b[1], r * x[1] + a[0] * b[1] + a[1] * b[0]


@within
def total(u: Triple, r: float, v: Triple, a: Complex, w: Triple) -> Triple:
    """Return the vector u + r v + a w for real r and complex a."""
    x, y, z = (
        scaled_sum(r, v[0], a, w[0]), scaled_sum(r, v[1], a, w[1]), scaled_sum(r, v[2], a, w[2])
    )  # fmt: skip
    return (
        (u[0][0] + x[0], u[0][1] + x[1]),
        (u[1][0] + y[0], u[1][1] + y[1]),
        (u[2][0] + z[0], u[2][1] + z[1]),
    )


@within
def dot(v: Triple, w: Triple) -> Complex:
    """Return the dot product of two vectors, without complex conjugation."""
    return sum_of_products(v[0], w[0], v[1], w[1], v[2], w[2])


@within
def product(a: Complex, b: Complex) -> Complex:
    """Return the product of two complex numbers."""
    return a[0] * b[0] - a[1] * b[1], a[0] * b[1] + a[1] * b[0]


@within
def minor(a: Complex, b: Complex, c: Complex, d: Complex) -> Complex:
    """Return a b - c d for complex numbers."""
    return (
        a[0] * b[0] - a[1] * b[1] - c[0] * d[0] + c[1] * d[1],
        a[0] * b[1] + a[1] * b[0] - c[0] * d[1] - c[1] * d[0],
    )


@within
def sum_of_products(
    a: Complex, x: Complex, b: Complex, y: Complex, c: Complex, z: Complex
) -> Complex:
    """Return a x + b y + c z for complex numbers."""
    return (
        a[0] * x[0] - a[1] * x[1] + b[0] * y[0] - b[1] * y[1] + c[0] * z[0] - c[1] * z[1],
        a[0] * x[1] + a[1] * x[0] + b[0] * y[1] + b[1] * y[0] + c[0] * z[1] + c[1] * z[0],
    )


@within
def combined(r: float, x: Complex, s: float, y: Complex, t: float, z: Complex) -> Complex:
    """Return r x + s y + t z for real r, s and t and complex x, y and z."""
    return r * x[0] + s * y[0] + t * z[0], r * x[1] + s * y[1] + t * z[1]


@within
def inverse_of(m: Symmetric) -> Symmetric:
    """Return the inverse of a complex symmetric matrix."""
    a, b, c, d, e, f = m
    first, second, third = minor(d, f, e, e), minor(c, e, b, f), minor(b, e, c, d)
    x, y = sum_of_products(a, first, b, second, c, third)
    size = x * x + y * y
    over = x / size, -y / size
    return (
        product(first, over), product(second, over), product(third, over),
        product(minor(a, f, c, c), over), product(minor(b, c, a, e), over),
        product(minor(a, d, b, b), over),
    )  # fmt: skip


@within
def times(m: Symmetric, v: Triple) -> Triple:
    """Return the product of a symmetric matrix and a vector."""
    a, b, c, d, e, f = m
    x, y, z = v
    return (
        sum_of_products(a, x, b, y, c, z),
        sum_of_products(b, x, d, y, e, z),
        sum_of_products(c, x, e, y, f, z),
    )


@within
def sum_of(m: Symmetric, n: Symmetric) -> Symmetric:
    """Return the sum of two symmetric matrices."""
    return (
        (m[0][0] + n[0][0], m[0][1] + n[0][1]), (m[1][0] + n[1][0], m[1][1] + n[1][1]),
        (m[2][0] + n[2][0], m[2][1] + n[2][1]), (m[3][0] + n[3][0], m[3][1] + n[3][1]),
        (m[4][0] + n[4][0], m[4][1] + n[4][1]), (m[5][0] + n[5][0], m[5][1] + n[5][1]),
    )  # fmt: skip


@within
def matrix_at(mass: Sequence[float], damping: Sequence[float], omega: float) -> Symmetric:
    """Return the dynamic stiffness -ω² m + iω c due to the mass and damping of a node."""
    square = -omega * omega
    return (
        (square * mass[0], omega * damping[0]), (square * mass[1], omega * damping[1]),
        (square * mass[2], omega * damping[2]), (square * mass[3], omega * damping[3]),
        (square * mass[4], omega * damping[4]), (square * mass[5], omega * damping[5]),
    )  # fmt: skip


@within
def symmetric_in(row: Sequence[float], at: int) -> Symmetric:
    """Read a symmetric matrix from twelve numbers in a row, starting at index `at`."""
    return (
        (row[at], row[at + 1]), (row[at + 2], row[at + 3]), (row[at + 4], row[at + 5]),
        (row[at + 6], row[at + 7]), (row[at + 8], row[at + 9]), (row[at + 10], row[at + 11]),
    )  # fmt: skip


@within
def triple_in(row: Sequence[float], at: int) -> Triple:
    """Read a complex vector from six numbers in a row, starting at index `at`."""
    return (row[at], row[at + 1]), (row[at + 2], row[at + 3]), (row[at + 4], row[at + 5])


@within
def link_in(row: Sequence[float]) -> Link:
    """Read a link from a row of the work array."""
    return Link(symmetric_in(row, 0), triple_in(row, 12), triple_in(row, 18), (row[24], row[25]))


@within
def write_triple(row: MutableSequence[float], at: int, v: Triple) -> None:
    """Write a complex vector to six numbers in a row, starting at index `at`."""
    row[at], row[at + 1], row[at + 2] = v[0][0], v[0][1], v[1][0]
    row[at + 3], row[at + 4], row[at + 5] = v[1][1], v[2][0], v[2][1]


@within
def write_link(row: MutableSequence[float], link: Link) -> None:
    """Write a link to a row of the work array."""
    a, b, c, d, e, f = link.inverse
    write_triple(row, 0, (a, b, c))
    write_triple(row, 6, (d, e, f))
    write_triple(row, 12, link.w)
    write_triple(row, 18, link.q)
    row[24], row[25] = link.g
