"""Inputs over a step as polynomials in time, of what is known at points of time.

A path is given by value, first and second derivative at the beginning t of a step of length H:
`u(τ) = a + b (τ − t) + c (τ − t)²/2`.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

Nodes = Sequence[tuple[float, np.ndarray]]  # times [s] and values then


def path(nodes: Nodes, time: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Value, first and second derivative at `time` of the polynomial through one to three nodes
    (Newton's divided differences)."""
    t0, u0 = nodes[0]
    zero = np.zeros_like(u0)
    if len(nodes) == 1:
        return u0, zero, zero
    t1, u1 = nodes[1]
    slope = (u1 - u0) / (t1 - t0)
    if len(nodes) == 2:
        return u0 + slope * (time - t0), slope, zero
    t2, u2 = nodes[2]
    bend = ((u2 - u1) / (t2 - t1) - slope) / (t2 - t0)
    value = u0 + (time - t0) * (slope + bend * (time - t1))
    return value, slope + bend * (2 * time - t0 - t1), 2 * bend


def divided_difference(nodes: Nodes) -> np.ndarray:
    """The highest divided difference of all nodes: u⁽ᵏ⁾/k! for k + 1 of them."""
    times = [time for time, _ in nodes]
    column = [values for _, values in nodes]
    for level in range(1, len(nodes)):
        column = [
            (column[i + 1] - column[i]) / (times[i + level] - times[i])
            for i in range(len(column) - 1)
        ]
    return column[0]


def interpolation_error(nodes: Nodes, order: int, time: float, size: float) -> np.ndarray:
    """How far the path of degree `order` through the last nodes may be off within the last step.

    nodes: all that are known, the last at the end `time + size` of the step. The next divided
    difference times the largest product of distances to the nodes of the path; a degree lower
    where there are not enough nodes. The whole change where values are held (`order` 0), and a
    quarter of it where there are two nodes alone, as of a square root that begins there.
    """
    share = 0.25 if order else 1.0
    order = min(order, len(nodes) - 2)
    if order < 1:
        return share * np.abs(nodes[-1][1] - nodes[-2][1])
    used = [at for at, _ in nodes[-(order + 1) :]]
    points = time + size * np.array([0.25, 0.5, 0.75])
    product = np.abs(np.prod([points - at for at in used], axis=0)).max()
    return np.abs(divided_difference(nodes[-(order + 2) :])) * product


def mean(a: np.ndarray, b: np.ndarray, c: np.ndarray, size: float) -> np.ndarray:
    """The mean of a path over a step."""
    return a + size * (b / 2 + size * c / 6)


def at(a: np.ndarray, b: np.ndarray, c: np.ndarray, elapsed: float) -> np.ndarray:
    """The path's value a time after the beginning."""
    return a + elapsed * (b + elapsed * c / 2)


class History:
    """Values of all inputs at the ends of the last steps, since the last jump."""

    def __init__(self, depth: int = 3):
        self._depth = depth
        self.nodes: list[tuple[float, np.ndarray]] = []

    def begin(self, time: float, values: np.ndarray) -> None:
        """Forgets what was before a jump."""
        self.nodes = [(time, values.copy())]

    def add(self, time: float, values: np.ndarray) -> None:
        """The values at the end of a step."""
        self.nodes = [*self.nodes, (time, values.copy())][-self._depth :]

    def last(self, count: int) -> list[tuple[float, np.ndarray]]:
        """The last nodes, or all where there are fewer."""
        return self.nodes[-count:] if count else []
