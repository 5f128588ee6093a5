"""What the cells of two surfaces share."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .boxes import boxes_of, overlapping, spread
from .cells import Polygons, Rings, Tiles
from .circles import in_discs, lens
from .polygons import in_convex, in_rectangles, moments


@dataclass(frozen=True)
class Pieces:
    """Pieces that cells i of one surface and cells j of another share: areas [m2] and, where
    `about` is given, first moments about it [m3]; all of length n or shape (n, 2).
    """

    i: np.ndarray
    j: np.ndarray
    area: np.ndarray
    moment: np.ndarray | None = None
    about: np.ndarray | None = None

    @property
    def swapped(self) -> Pieces:
        return Pieces(self.j, self.i, self.area, self.moment, self.about)


def cut(a: Rings | Polygons, b: Rings | Polygons) -> Pieces:
    """Pieces of the cells of `a` and of `b`; each pair once, by i and then j."""
    if isinstance(a, Rings) and isinstance(b, Rings):
        return _rings_by_rings(a, b)
    if isinstance(a, Rings):
        pieces = cut_polygons(a, b.outlines)
    elif isinstance(b, Rings):
        pieces = cut_polygons(b, a.outlines).swapped
    elif isinstance(a, Tiles) and isinstance(b, Tiles):
        pieces = _tiles_by_tiles(a, b)
    elif isinstance(b, Tiles):
        pieces = cut_polygons(b, a.outlines).swapped
    else:
        pieces = cut_polygons(a, b.outlines)
    order = np.lexsort((pieces.j, pieces.i))
    return Pieces(pieces.i[order], pieces.j[order], pieces.area[order])


def cut_polygons(a: Rings | Polygons, polygons: np.ndarray) -> Pieces:
    """Pieces of cells of `a` and of convex `polygons`, shape (n, m, 2), with first moments."""
    if isinstance(a, Rings):
        return _rings_by_polygons(a, polygons)
    if isinstance(a, Tiles):
        return _tiles_by_polygons(a, polygons)
    frames = a.outlines
    i, j = overlapping(boxes_of(frames), boxes_of(polygons))
    about = frames[i].mean(axis=1)
    area, moment = in_convex(frames[i] - about[:, None], polygons[j] - about[:, None])
    return _some(i, j, area, moment, about)


def _some(
    i: np.ndarray, j: np.ndarray, area: np.ndarray, moment: np.ndarray, about: np.ndarray
) -> Pieces:
    some = area > 0
    return Pieces(i[some], j[some], area[some], moment[some], about[some])


def _rings_by_rings(a: Rings, b: Rings) -> Pieces:
    apart = np.hypot(*(a.centre - b.centre))
    if apart == 0:
        low = np.maximum(a.edges[:-1, None], b.edges[None, :-1])
        high = np.minimum(a.edges[1:, None], b.edges[None, 1:])
        area = np.pi * np.maximum(high - low, 0.0) * (high + low)
    else:
        discs = lens(a.edges[:, None], b.edges[None, :], apart)
        area = discs[1:, 1:] - discs[:-1, 1:] - discs[1:, :-1] + discs[:-1, :-1]
        # Less than what rounding leaves of discs is nothing.
        smaller = min(a.edges[-1], b.edges[-1])
        area[area < 4 * np.finfo(float).eps * np.pi * smaller**2] = 0.0
    i, j = np.nonzero(area > 0)
    return Pieces(i, j, area[i, j])


def _rings_by_polygons(rings: Rings, polygons: np.ndarray) -> Pieces:
    local = polygons - rings.centre
    boxes = boxes_of(local)
    near = np.hypot(*np.maximum(np.maximum(boxes[:, 0], -boxes[:, 1]), 0.0).T)
    far = np.hypot(local[..., 0], local[..., 1]).max(axis=1)
    last = len(rings.edges) - 2
    first = np.clip(np.searchsorted(rings.edges, near, side="right") - 1, 0, last)
    end = np.clip(np.searchsorted(rings.edges, far, side="left") - 1, -1, last)
    outside = (near >= rings.edges[-1]) | (far <= rings.edges[0])
    who, place = spread(np.where(outside, 0, np.maximum(end - first + 1, 0)))
    ring = first[who] + place
    local, far, near = local[who], far[who], near[who]
    whole = _whole(local)
    outer = _within(rings.edges[ring + 1], local, near, far, whole)
    inner = _within(rings.edges[ring], local, near, far, whole)
    about = np.tile(rings.centre, (len(who), 1))
    return _some(ring, who, outer[0] - inner[0], outer[1] - inner[1], about)


def _whole(local: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Areas and moments about the origin, rounded as what is far smaller than its distance
    should be.
    """
    middle = local.mean(axis=1)
    area, moment = moments(local - middle[:, None])
    return area, moment + middle * area[:, None]


def _within(
    radius: np.ndarray,
    local: np.ndarray,
    near: np.ndarray,
    far: np.ndarray,
    whole: tuple[np.ndarray, np.ndarray],
) -> tuple[np.ndarray, np.ndarray]:
    area, moment = whole[0].copy(), whole[1].copy()
    none = radius <= near
    area[none], moment[none] = 0.0, 0.0
    some = ~none & (radius < far)
    if some.any():
        area[some], moment[some] = in_discs(radius[some], local[some])
    return area, moment


def _tiles_by_polygons(tiles: Tiles, polygons: np.ndarray) -> Pieces:
    boxes = boxes_of(polygons)
    count = np.array(tiles.shape)
    lines = tiles.edges
    first = np.column_stack(
        [np.searchsorted(e, boxes[:, 0, k], side="right") - 1 for k, e in enumerate(lines)]
    )
    last = np.column_stack(
        [np.searchsorted(e, boxes[:, 1, k], side="left") - 1 for k, e in enumerate(lines)]
    )
    outside = ((first >= count) | (last < 0)).any(axis=1)
    first, last = np.clip(first, 0, count - 1), np.clip(last, 0, count - 1)
    wide = np.where(outside[:, None], 0, np.maximum(last - first + 1, 1))
    who, place = spread(wide[:, 0] * wide[:, 1])
    x = first[who, 0] + place // wide[who, 1]
    y = first[who, 1] + place % wide[who, 1]
    low = np.column_stack([lines[0][x], lines[1][y]])
    high = np.column_stack([lines[0][x + 1], lines[1][y + 1]])
    about = polygons[who].mean(axis=1)
    points = polygons[who] - about[:, None]
    area, moment = moments(points)
    cut_off = ((boxes[who, 0] < low) | (boxes[who, 1] > high)).any(axis=1)
    if cut_off.any():
        low, high = (low - about)[cut_off], (high - about)[cut_off]
        area[cut_off], moment[cut_off] = in_rectangles(low, high, points[cut_off])
    return _some(x * count[1] + y, who, area, moment, about)


def _tiles_by_tiles(a: Tiles, b: Tiles) -> Pieces:
    shared = []
    for k in (0, 1):
        p, q = a.edges[k], b.edges[k]
        length = np.minimum(p[1:, None], q[None, 1:]) - np.maximum(p[:-1, None], q[None, :-1])
        i, j = np.nonzero(length > 0)
        shared.append((i, j, length[i, j]))
    (ix, jx, lx), (iy, jy, ly) = shared
    i = (ix[:, None] * a.shape[1] + iy).ravel()
    j = (jx[:, None] * b.shape[1] + jy).ravel()
    return Pieces(i, j, (lx[:, None] * ly).ravel())
