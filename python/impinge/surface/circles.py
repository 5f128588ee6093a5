"""Areas and first moments of what discs share with polygons and with each other: arcs stay arcs."""

from __future__ import annotations

import numpy as np


def in_discs(radius: np.ndarray, polygons: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Areas, shape (n,), and first moments, shape (n, 2), of polygons within circles about the
    origin.

    Each edge p → q counts with what lies between it and the origin: a triangle where it is within
    the circle, ``A = ½ p × q``, ``M = ⅓ (p + q) A``, and sectors beyond, ``A = ½ R² φ``,
    ``M = ⅓ R³ (sin φ₂ − sin φ₁, cos φ₁ − cos φ₂)``. `polygons`: shape (n, m, 2), any that do not
    cross themselves; the sign is that of their sense.
    """
    start, end = polygons, np.roll(polygons, -1, axis=1)
    along = end - start
    square = (along**2).sum(axis=2)
    middle = (start * along).sum(axis=2)
    r = radius[:, None]
    distance = np.hypot(start[..., 0], start[..., 1])
    outside = (distance - r) * (distance + r)
    root = middle**2 - square * outside
    crosses = (root > 0) & (square > 0)
    root = np.sqrt(np.where(crosses, root, 0.0))
    square = np.where(square > 0, square, 1.0)
    enter = np.where(crosses, np.clip((-middle - root) / square, 0.0, 1.0), 0.0)
    leave = np.where(crosses, np.clip((-middle + root) / square, 0.0, 1.0), 0.0)
    # An edge of no length within the circle, and one that lies beyond it, enclose what sectors do.
    first = start + enter[..., None] * along
    last = start + leave[..., None] * along
    area, moment = _triangles(first, last)
    for u, v in ((start, first), (last, end)):
        sector_area, sector_moment = _sectors(r, u, v)
        area += sector_area
        moment += sector_moment
    return area.sum(axis=1), moment.sum(axis=1)


def _triangles(p: np.ndarray, q: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    area = 0.5 * (p[..., 0] * q[..., 1] - p[..., 1] * q[..., 0])
    return area, (p + q) * area[..., None] / 3.0


def _sectors(radius: np.ndarray, p: np.ndarray, q: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    cross = p[..., 0] * q[..., 1] - p[..., 1] * q[..., 0]
    angle = np.arctan2(cross, (p * q).sum(axis=2))
    area = 0.5 * radius**2 * angle
    turn = _unit(q) - _unit(p)
    moment = np.stack([turn[..., 1], -turn[..., 0]], axis=2) * (radius**3 / 3.0)[..., None]
    return area, moment


def _unit(p: np.ndarray) -> np.ndarray:
    length = np.linalg.norm(p, axis=2, keepdims=True)
    return p / np.where(length > 0, length, 1.0)


def lens(a: np.ndarray, b: np.ndarray, distance: np.ndarray) -> np.ndarray:
    """Area that discs of radii `a` and `b` share whose centres are `distance` apart.

    ``A = Σ R² (φ − sin φ cos φ)`` with φ half the angle of the common chord seen from each centre.
    """
    a, b, distance = np.broadcast_arrays(a, b, distance)
    apart = np.where(distance > 0, distance, 1.0)
    # 16 times the square of the triangle's area (Heron)
    heron = (a + b + distance) * (a + b - distance) * (distance + a - b) * (distance - a + b)
    height = 0.5 * np.sqrt(np.maximum(heron, 0.0)) / apart
    foot = (
        (distance**2 + (a - b) * (a + b)) / (2.0 * apart),
        (distance**2 + (b - a) * (a + b)) / (2.0 * apart),
    )
    area = np.zeros(a.shape)
    for radius, x in zip((a, b), foot, strict=True):
        angle = np.arctan2(height, x)
        area = area + radius**2 * angle - height * x
    within = np.pi * np.minimum(a, b) ** 2
    return np.where(distance >= a + b, 0.0, np.where(distance <= np.abs(a - b), within, area))
