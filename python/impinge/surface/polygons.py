"""Areas and first moments of what polygons share with rectangles and with other polygons.

Polygons have shape (n, m, 2); where one has fewer than m corners the last is repeated.
"""

from __future__ import annotations

import numpy as np


def moments(polygons: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Signed areas ∫dA, shape (n,), and first moments ∫(x, y) dA about the origin, shape (n, 2).

    ``A = ½ Σ c``, ``M = ⅙ Σ (p + q) c`` with c = p × q over the edges p → q.
    """
    after = np.roll(polygons, -1, axis=1)
    cross = polygons[..., 0] * after[..., 1] - after[..., 0] * polygons[..., 1]
    return 0.5 * cross.sum(axis=1), ((polygons + after) * cross[..., None]).sum(axis=1) / 6.0


def perimeters(polygons: np.ndarray) -> np.ndarray:
    """Lengths round polygons; shape (n,)."""
    return np.linalg.norm(np.roll(polygons, -1, axis=1) - polygons, axis=2).sum(axis=1)


def is_convex(polygons: np.ndarray) -> np.ndarray:
    """Whether polygons that go round to the left turn to the left at each corner; shape (n,)."""
    before = polygons - np.roll(polygons, 1, axis=1)
    # A repeated corner has no turn of its own.
    after = np.roll(polygons, -1, axis=1) - polygons
    cross = before[..., 0] * after[..., 1] - before[..., 1] * after[..., 0]
    scale = np.linalg.norm(before, axis=2) * np.linalg.norm(after, axis=2)
    return (cross >= -1e-12 * scale).all(axis=1)


def in_rectangles(
    low: np.ndarray, high: np.ndarray, polygons: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Area and moments of polygons within rectangles from `low` to `high`, shape (n, 2) each.

    Edges are cut where they cross the four lines of the rectangle's sides, and what lies beyond is
    moved onto these: paths on a line enclose nothing. The polygon need not be convex.
    """
    after = np.roll(polygons, -1, axis=1)
    along = after - polygons
    with np.errstate(divide="ignore", invalid="ignore"):
        cuts = [(side[:, None, :] - polygons) / along for side in (low, high)]
    cuts = np.concatenate(cuts, axis=2)
    cuts = np.sort(np.clip(np.nan_to_num(cuts, nan=0.0), 0.0, 1.0), axis=2)
    path = polygons[:, :, None, :] + cuts[..., None] * along[:, :, None, :]
    path = np.concatenate([polygons[:, :, None, :], path], axis=2)
    path = np.clip(path, low[:, None, None, :], high[:, None, None, :])
    return moments(path.reshape(len(polygons), -1, 2))


def in_convex(frames: np.ndarray, polygons: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Area and moments of polygons within convex `frames` that go round to the left."""
    area, moment = np.zeros(len(polygons)), np.zeros((len(polygons), 2))
    is_out, is_whole = np.zeros(len(polygons), bool), np.ones(len(polygons), bool)
    for k in range(frames.shape[1]):
        height = _heights(frames, k, polygons)
        is_out |= (height < 0).all(axis=1)
        is_whole &= (height >= 0).all(axis=1)
    is_whole &= ~is_out
    area[is_whole], moment[is_whole] = moments(polygons[is_whole])
    alive = np.flatnonzero(~is_out & ~is_whole)
    clipped, some = clipped_to_convex(frames[alive], polygons[alive])
    if len(some):
        area[alive[some]], moment[alive[some]] = moments(clipped)
    return area, moment


def clipped_to_convex(frames: np.ndarray, polygons: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """What convex `frames` leave of convex polygons, and of which of them something is left.

    Source: I. E. Sutherland and G. W. Hodgman (1974), doi 10.1145/360767.360802.
    """
    alive = np.arange(len(polygons))
    for k in range(frames.shape[1]):
        polygons, some = _above(polygons, _heights(frames[alive], k, polygons))
        polygons, alive = polygons[some], alive[some]
    return polygons, alive


def _heights(frames: np.ndarray, k: int, polygons: np.ndarray) -> np.ndarray:
    """Heights of corners above the k-th side of the frame; shape (n, m)."""
    corner = frames[:, k]
    along = frames[:, (k + 1) % frames.shape[1]] - corner
    length = np.hypot(along[:, 0], along[:, 1])
    x, y = (along / np.where(length > 0, length, 1.0)[:, None]).T[:, :, None]
    offset = polygons - corner[:, None, :]
    return x * offset[..., 1] - y * offset[..., 0]


def _above(polygons: np.ndarray, height: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Polygons where `height` is not negative, and whether anything is left of them."""
    inside = height >= 0
    if inside.all():
        return polygons, np.ones(len(polygons), bool)
    after, height_after = np.roll(polygons, -1, axis=1), np.roll(height, -1, axis=1)
    crossed = inside != (height_after >= 0)
    share = np.where(crossed, height / np.where(crossed, height - height_after, 1.0), 0.0)
    point = polygons + share[..., None] * (after - polygons)
    n, m = inside.shape
    emitted = np.stack([inside, crossed], axis=2).reshape(n, 2 * m)
    points = np.stack([polygons, point], axis=2).reshape(n, 2 * m, 2)
    many = emitted.sum(axis=1)
    place = np.cumsum(emitted, axis=1) - 1
    result = np.empty((n, max(many.max(), 1), 2))
    first = points[np.arange(n), emitted.argmax(axis=1)]
    result[:] = first[:, None, :]
    row, slot = np.nonzero(emitted)
    result[row, place[row, slot]] = points[row, slot]
    return result, many > 0
