"""Integrals of products of the linear functions of two meshes over what their triangles share.

``B_in = ∫ ψ_i φ_n dA`` with ψ those of the target and φ those of the source. Triangles are cut into
each other; over a piece, a product of two linear functions is a quadratic, which the rule of the
middles of edges integrates exactly over each triangle (p0, p_k, p_k+1) of the piece's fan:
``∫ f dA = A/3 (f(m_1) + f(m_2) + f(m_3))``.
Source: P. E. Farrell et al. (2009), doi 10.1016/j.cma.2009.03.004.
"""

from __future__ import annotations

import numpy as np
from scipy.sparse import coo_matrix, csr_matrix

from .boxes import boxes_of, overlapping
from .cells import Polygons
from .polygons import clipped_to_convex, moments, perimeters

_CHUNK = 100_000  # pairs of triangles that are cut at a time


def nodes_by_nodes(target: Polygons, source: Polygons, tolerance: float) -> csr_matrix:
    """``∫ ψ_i φ_n dA`` [m2]; shape (nodes of the target, nodes of the source).

    Triangles of the source of which no more than a seam `tolerance` [m] wide lies off the target
    keep the whole integrals of their functions.
    """
    corners_i, corners_n = target.triangles[0], source.triangles[0]
    triangles_i, triangles_n = target.nodes[corners_i], source.nodes[corners_n]
    i, n = overlapping(boxes_of(triangles_i), boxes_of(triangles_n))
    found = [
        _products(triangles_i, triangles_n, i[k : k + _CHUNK], n[k : k + _CHUNK])
        for k in range(0, max(len(i), 1), _CHUNK)
    ]
    i, n, area, products = (np.concatenate(each) for each in zip(*found, strict=True))
    products = products * _whole(triangles_n, n, area, products, tolerance)[:, None, :]
    rows = np.repeat(corners_i[i], 3, axis=1).ravel()
    columns = np.tile(corners_n[n], 3).ravel()
    shape = (len(target.nodes), len(source.nodes))
    return csr_matrix(coo_matrix((products.ravel(), (rows, columns)), shape=shape))


def _products(
    a: np.ndarray, b: np.ndarray, i: np.ndarray, n: np.ndarray
) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """Pairs (i, n) of triangles that share something, the areas of that, and the integrals of
    products of their functions; shape (pairs, 3, 3)."""
    about = a[i, 0]
    frames, polygons = a[i] - about[:, None], b[n] - about[:, None]
    pieces, some = clipped_to_convex(frames, polygons)
    area = moments(pieces - pieces[:, :1])[0]
    pieces, some, area = pieces[area > 0], some[area > 0], area[area > 0]
    one, two = _Barycentric(frames[some]), _Barycentric(polygons[some])
    products = np.zeros((len(some), 3, 3))
    first = pieces[:, 0]
    for k in range(1, pieces.shape[1] - 1):
        second, third = pieces[:, k], pieces[:, k + 1]
        p, q = second - first, third - first
        share = (p[:, 0] * q[:, 1] - p[:, 1] * q[:, 0]) / 6
        for point in ((first + second) / 2, (second + third) / 2, (third + first) / 2):
            weighted = share[:, None] * one(point)
            products += weighted[:, :, None] * two(point)[:, None, :]
    return i[some], n[some], area, products


class _Barycentric:
    """The three linear functions of triangles, shape (n, 3, 2), whose sum is one."""

    def __init__(self, triangles: np.ndarray):
        self.origin = triangles[:, 0]
        self.a, self.b = (triangles[:, 1:] - self.origin[:, None]).transpose(1, 0, 2)
        self.twice = self.a[:, 0] * self.b[:, 1] - self.a[:, 1] * self.b[:, 0]

    def __call__(self, points: np.ndarray) -> np.ndarray:
        """Values at one point of each; shape (n, 3)."""
        at = points - self.origin
        second = (at[:, 0] * self.b[:, 1] - at[:, 1] * self.b[:, 0]) / self.twice
        third = (self.a[:, 0] * at[:, 1] - self.a[:, 1] * at[:, 0]) / self.twice
        return np.stack([1 - second - third, second, third], axis=1)


def _whole(
    triangles: np.ndarray, n: np.ndarray, area: np.ndarray, products: np.ndarray, tolerance: float
) -> np.ndarray:
    """Factors, of each pair's three functions of the source, that give those their whole integral
    back, a third of the area, where no more than a seam is missing."""
    count = len(triangles)
    areas = moments(triangles - triangles[:, :1])[0]
    covered = np.bincount(n, area, minlength=count)
    seam = np.abs(areas - covered) <= tolerance * perimeters(triangles)
    factors = np.ones((count, 3))
    for k, share in enumerate(products.sum(axis=1).T):
        found = np.bincount(n, share, minlength=count)
        use = seam & (found > 0)
        factors[use, k] = areas[use] / 3 / found[use]
    return factors[n]
