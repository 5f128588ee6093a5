"""Small waves of smoothed particles on a lattice: what a time step of droplets makes of them.

The method linearised about fluid at rest under a pressure p₀, for a wave e^(ik·x) (von Neumann's
analysis; of smoothed particles Morris 1996, Publ. Astron. Soc. Aust. 13, 97–102; Dehnen & Aly 2012,
Mon. Not. R. Astron. Soc. 425, 1068–1082, doi 10.1111/j.1365-2966.2012.21439.x). Lengths are over
the support radius H, speeds over that of sound c₀, densities over ρ₀. With F = w′(q)/q, sums over
the neighbours j, x from these to the particle:

    s = Σ V F x sin k·x,  D = −Σ V F (1 − cos k·x),  N = −η Σ V F x⊗x (1 − cos k·x),
    K = 2p₀ Σ V ∇∇W (1 − cos k·x),  m = −Σ V F x⊗x,

`dr/dt = i (1 + r₀) s·u − δ (D r − ½ i s·g)`, g = −i m⁻¹ s r of the step before,
`(1 + r₀) du/dt = i s (c² − 2p₀/(1 + r₀)) r − K ξ − N u`.
"""

from collections.abc import Callable
from dataclasses import dataclass
from functools import cache
from itertools import product
from math import pi, sqrt

import numpy as np

GAMMA = 7.0


def spline(order: int, knots: list[tuple[float, float]]):
    """w′/q and w″ of Σ a (b − q)ⁿ₊."""

    def power(reach, n, q):
        return np.clip(reach - q, 0.0, None) ** n

    def slope(q):
        return -sum(order * a * power(b, order - 1, q) for b, a in knots) / q

    def bend(q):
        return sum(order * (order - 1) * a * power(b, order - 2, q) for b, a in knots)

    return slope, bend


def wendland_c2():
    return (
        lambda q: -20.0 * (1.0 - q) ** 3,
        lambda q: -20.0 * (1.0 - q) ** 2 * (1.0 - 4.0 * q),
    )


def wendland_c4():
    return (
        lambda q: -56.0 / 3.0 * (1.0 - q) ** 5 * (1.0 + 5.0 * q),
        lambda q: -56.0 / 3.0 * (1.0 - q) ** 4 * (1.0 + 4.0 * q - 35.0 * q * q),
    )


SHAPES = {
    "wendland_c2": (wendland_c2(), (7.0 / pi, 21.0 / (2.0 * pi))),
    "wendland_c4": (wendland_c4(), (9.0 / pi, 495.0 / (32.0 * pi))),
    "cubic_spline": (spline(3, [(1.0, 2.0), (0.5, -8.0)]), (40.0 / (7.0 * pi), 8.0 / pi)),
    "quintic_spline": (
        spline(5, [(1.0, 243.0), (2 / 3, -1458.0), (1 / 3, 3645.0)]),
        (63.0 / (478.0 * pi), 9.0 / (40.0 * pi)),
    ),
}
"""w′/q and w″ of each kernel, and its normalisation in two and three dimensions."""


@dataclass(frozen=True)
class Lattice:
    kernel: str = "wendland_c2"
    support: float = 3.0
    """H over the distance of particles."""
    cells: str = "square"
    """`square`, `hexagonal` or `cubic`; the distance is that of a square or cube as large."""
    across: int | None = None
    """Particles along a side between periods; nothing of a lattice without end."""

    @property
    def dimension(self) -> int:
        return 3 if self.cells == "cubic" else 2

    def basis(self) -> np.ndarray:
        """Vectors between neighbours, over the distance of particles."""
        if self.cells == "hexagonal":
            side = sqrt(2.0 / sqrt(3.0))
            return side * np.array([[1.0, 0.0], [0.5, 0.5 * sqrt(3.0)]])
        return np.eye(self.dimension)

    def neighbours(self) -> np.ndarray:
        reach = range(-int(2 * self.support) - 1, int(2 * self.support) + 2)
        places = np.array(list(product(reach, repeat=self.dimension))) @ self.basis()
        places /= self.support
        q = np.linalg.norm(places, axis=1)
        return places[(q > 0.0) & (q < 1.0)]

    def rows(self) -> int:
        """Of a plane lattice between periods, as `benches/flow_limits.rs` lays it out."""
        is_square = self.cells == "square"
        return self.across if is_square else 2 * round(self.across / sqrt(3.0))

    def places(self) -> np.ndarray:
        """Particles of a plane lattice between periods, over the support radius, row by row."""
        columns, rows = np.arange(self.across), np.arange(self.rows())
        along, up = self.basis()
        row, column = (grid.ravel() for grid in np.meshgrid(rows, columns, indexing="ij"))
        # Every second row begins half a distance farther along, so that the lattice stands upright.
        shifted = column + (up[0] / along[0]) * (row % 2)
        return np.stack([shifted * along[0], row * up[1]], axis=1) / self.support

    def periods(self) -> np.ndarray:
        along, up = self.basis()
        return np.array([self.across * along[0], self.rows() * up[1]]) / self.support

    def waves(self, count: int) -> np.ndarray:
        """Wave vectors all over half a cell of the reciprocal lattice, or all between periods."""
        if self.across:
            numbers = product(range(self.across), range(self.rows()))
            return 2.0 * pi * np.array(list(numbers)) / self.periods()
        ticks = np.linspace(-0.5, 0.5, 2 * count + 1)
        whole = [np.linspace(0.0, 0.5, count + 1)] + [ticks] * (self.dimension - 1)
        parts = np.array(list(product(*whole)))
        parts = parts[np.any(parts != 0.0, axis=1)]
        return 2.0 * pi * self.support * parts @ np.linalg.inv(self.basis()).T


@dataclass(frozen=True)
class Sums:
    """The sums of the heading for all wave vectors; N without η, K without 2p₀."""

    s: np.ndarray
    diffusion: np.ndarray
    viscous: np.ndarray
    stiffness: np.ndarray
    moment: np.ndarray


@cache
def sums(of: Lattice, count: int = 12) -> Sums:
    d = of.dimension
    (slope, bend), normalisation = SHAPES[of.kernel]
    x = of.neighbours()
    q = np.linalg.norm(x, axis=1)
    scale = normalisation[d - 2] / of.support**d
    f = scale * slope(q)
    squares = x[:, :, None] * x[:, None, :]
    along = squares / (q * q)[:, None, None]
    eye = np.eye(d)
    hessian = f[:, None, None] * (eye - along) + scale * bend(q)[:, None, None] * along
    phases = of.waves(count) @ x.T
    lag = 1.0 - np.cos(phases)
    return Sums(
        s=np.sin(phases) @ (f[:, None] * x),
        diffusion=-lag @ f,
        viscous=-np.tensordot(lag, f[:, None, None] * squares, 1),
        stiffness=np.tensordot(lag, hessian, 1),
        moment=-np.tensordot(f, squares, 1),
    )


@cache
def second_moment(kernel: str, dimension: int) -> float:
    """∫ q² W dV, by parts −∫ F q⁴ dV/(d + 2)."""
    (slope, _), normalisation = SHAPES[kernel]
    q = (np.arange(20_000) + 0.5) / 20_000
    sphere = (2.0 * pi, 4.0 * pi)[dimension - 2] * normalisation[dimension - 2]
    return float(-sphere * np.mean(slope(q) * q ** (dimension + 3)) / (dimension + 2))


@cache
def mean_slope(kernel: str, dimension: int) -> float:
    """−∫ F dV."""
    (slope, _), normalisation = SHAPES[kernel]
    q = (np.arange(20_000) + 0.5) / 20_000
    sphere = (2.0 * pi, 4.0 * pi)[dimension - 2] * normalisation[dimension - 2]
    return float(-sphere * np.mean(slope(q) * q ** (dimension - 1)))


def amplification(
    of: Lattice,
    step: float,
    *,
    diffusion: float = 0.1,
    corrected: bool = True,
    viscosity: float = 0.0,
    pressure: float = 0.0,
    count: int = 12,
) -> np.ndarray:
    """What a time step of dt c₀/H makes of each wave, for ν/(c₀H) and p₀/(ρ₀c₀²)."""
    d, w = of.dimension, sums(of, count)
    compressed = (1.0 + GAMMA * pressure) ** (1.0 / GAMMA)
    stiff = compressed ** (GAMMA - 1.0) - 2.0 * pressure / compressed
    pair = 2.0 * d / second_moment(of.kernel, d) * viscosity
    n = len(w.s)
    v, a, xi, g = (slice(k * d, (k + 1) * d) for k in range(4))
    r = 4 * d
    whole = np.tile(np.eye(4 * d + 1, dtype=complex), (n, 1, 1))

    def then(change) -> None:
        nonlocal whole
        matrix = np.tile(np.eye(4 * d + 1, dtype=complex), (n, 1, 1))
        change(matrix)
        whole = matrix @ whole

    eye = np.eye(d)

    def kick(m):
        m[:, v, a] = 0.5 * step * eye

    def drift(m):
        m[:, xi, v] = step * eye

    def dense(m):
        m[:, r, v] = 1j * step * compressed * w.s
        m[:, r, r] -= step * diffusion * w.diffusion
        if corrected:
            m[:, r, g] = 0.5j * step * diffusion * w.s
            m[:, g, g] = 0.0
            m[:, g, r] = -1j * w.s @ np.linalg.inv(w.moment)

    def accelerate(m):
        damping = -pair * w.viscous / compressed
        m[:, a, a] = 0.5 * step * damping
        m[:, a, v] = damping
        m[:, a, xi] = -2.0 * pressure * w.stiffness / compressed
        m[:, a, r] = 1j * stiff * w.s / compressed

    for change in (kick, drift, dense, accelerate, kick):
        then(change)
    return whole


def growth(of: Lattice, step: float, **settings) -> float:
    """Of the fastest wave in a time step."""
    return float(np.abs(np.linalg.eigvals(amplification(of, step, **settings))).max())


def uneven(n: np.ndarray) -> np.ndarray:
    """Between −1 and 1, without order: what `benches/flow_limits.rs` takes for noise."""
    bits = (n.astype(np.uint64) + np.uint64(1)) * np.uint64(0x9E37_79B9_7F4A_7C15)
    bits = (bits ^ (bits >> np.uint64(30))) * np.uint64(0xBF58_476D_1CE4_E5B9)
    bits = (bits ^ (bits >> np.uint64(27))) * np.uint64(0x94D0_49BB_1331_11EB)
    bits ^= bits >> np.uint64(31)
    return 2.0 * (bits >> np.uint64(11)).astype(float) / 2.0**53 - 1.0


@cache
def shares(of: Lattice) -> np.ndarray:
    """Of each wave that periods let be in the velocities that particles begin with."""
    places = of.places()
    velocities = uneven(np.arange(2 * len(places))).reshape(-1, 2)
    return np.exp(-1j * of.waves(0) @ places.T) @ velocities / len(places)


def noise_between_periods(of: Lattice, step: float, steps: int, **settings) -> float:
    """Growth of those velocities in so many steps, each wave by what it has of them."""
    waves = np.linalg.matrix_power(amplification(of, step, **settings), steps)
    before = shares(of)
    after = np.einsum("kij,kj->ki", waves[:, :2, :2], before)
    return float(np.linalg.norm(after) / np.linalg.norm(before))


def largest(is_stable: Callable, low: float, high: float, ratio: float = 1.002) -> float:
    """Where what is stable at the low end and not at the high one stops being it."""
    if is_stable(high):
        return high
    while high / low > ratio:
        middle = sqrt(low * high)
        low, high = (middle, high) if is_stable(middle) else (low, middle)
    return sqrt(low * high)
