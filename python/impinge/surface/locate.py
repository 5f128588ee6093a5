"""In which cell of a mesh a point lies, and the weights of the nodes there."""

from __future__ import annotations

import numpy as np

from .boxes import overlapping
from .cells import Polygons, Tiles

NEWTON_STEPS = 20


def in_cells(mesh: Polygons, points: np.ndarray, tolerance: float) -> tuple[np.ndarray, np.ndarray]:
    """The cell that each point, shape (n, 2), lies in or within `tolerance` [m] of, −1 where there
    is none, and weights of its four corners, shape (n, 4), that sum to one.

    Triangles: barycentric; quadrilaterals: isoparametric (bilinear). The first cell is taken where
    cells meet. Within the tolerance weights extrapolate, so that linear fields stay exact.
    """
    cells = mesh.points
    reach = np.stack([cells.min(axis=1) - tolerance, cells.max(axis=1) + tolerance], axis=1)
    who, cell = overlapping(np.stack([points, points], axis=1), reach)
    weights, beyond = _weights(cells[cell], points[who])
    fits = beyond <= np.maximum(tolerance, 1e-12 * np.sqrt(mesh.areas[cell]))
    who, cell, weights, beyond = who[fits], cell[fits], weights[fits], beyond[fits]
    # Within a cell, all are equally good; beside cells, the nearest is.
    order = np.lexsort((cell, np.maximum(beyond, 0.0), who))
    first = order[np.unique(who[order], return_index=True)[1]]
    found = np.full(len(points), -1)
    values = np.zeros((len(points), 4))
    found[who[first]] = cell[first]
    values[who[first]] = weights[first]
    return found, values


def _weights(cells: np.ndarray, points: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Weights of the corners, and how far [m] points lie beyond the cell's sides."""
    is_triangle = (cells[:, 2] == cells[:, 3]).all(axis=1)
    weights, beyond = np.empty((len(cells), 4)), np.empty(len(cells))
    for which, find in ((is_triangle, _barycentric), (~is_triangle, _isoparametric)):
        if which.any():
            weights[which] = find(cells[which], points[which])
    side = np.roll(cells, -1, axis=1) - cells
    length = np.linalg.norm(side, axis=2)
    offset = points[:, None] - cells
    height = side[..., 0] * offset[..., 1] - side[..., 1] * offset[..., 0]
    beyond = np.where(length > 0, -height / np.where(length > 0, length, 1.0), -np.inf).max(axis=1)
    return weights, beyond


def _barycentric(cells: np.ndarray, points: np.ndarray) -> np.ndarray:
    origin, a, b = cells[:, 0], cells[:, 1] - cells[:, 0], cells[:, 2] - cells[:, 0]
    p = points - origin
    area = a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]
    second = (p[:, 0] * b[:, 1] - p[:, 1] * b[:, 0]) / area
    third = (a[:, 0] * p[:, 1] - a[:, 1] * p[:, 0]) / area
    return np.column_stack([1 - second - third, second, third, np.zeros(len(cells))])


def _isoparametric(cells: np.ndarray, points: np.ndarray) -> np.ndarray:
    """Solves ``Σ N(ξ, η) xᵢ = x`` by Newton's method from the middle; exact at once for
    parallelograms.
    """
    origin = cells[:, 0]
    a, b = cells[:, 1] - origin, cells[:, 3] - origin
    c = cells[:, 2] - cells[:, 1] - cells[:, 3] + origin
    p = points - origin
    at = np.full((len(cells), 2), 0.5)
    for _ in range(NEWTON_STEPS):
        xi, eta = at[:, :1], at[:, 1:]
        rest = p - (a * xi + b * eta + c * xi * eta)
        u, v = a + c * eta, b + c * xi
        area = u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0]
        area = np.where(np.abs(area) > 1e-300, area, 1e-300)
        step = np.column_stack(
            [
                rest[:, 0] * v[:, 1] - rest[:, 1] * v[:, 0],
                u[:, 0] * rest[:, 1] - u[:, 1] * rest[:, 0],
            ]
        )
        step = np.clip(step / area[:, None], -2.0, 2.0)
        at = at + step
        if np.abs(step).max() < 1e-15:
            break
    xi, eta = at.T
    return np.column_stack([(1 - xi) * (1 - eta), xi * (1 - eta), xi * eta, (1 - xi) * eta])


def on_grid(
    tiles: Tiles, points: np.ndarray, tolerance: float, nearest: bool
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Bilinear weights of points among the middles of tiles, extrapolated over the outer half of
    the outermost: four columns and weights each, and whether a point lies off the tiles.
    """
    indices, shares = [], []
    off = np.zeros(len(points), bool)
    for k, (lines, middles) in enumerate(zip(tiles.edges, tiles.middles, strict=True)):
        x = points[:, k]
        off |= (x < lines[0] - tolerance) | (x > lines[-1] + tolerance)
        if nearest:
            x = np.clip(x, lines[0], lines[-1])
        if len(middles) == 1:
            indices.append(np.zeros((len(x), 2), int))
            shares.append(np.column_stack([np.ones(len(x)), np.zeros(len(x))]))
            continue
        left = np.clip(np.searchsorted(middles, x) - 1, 0, len(middles) - 2)
        share = (x - middles[left]) / (middles[left + 1] - middles[left])
        indices.append(np.column_stack([left, left + 1]))
        shares.append(np.column_stack([1 - share, share]))
    columns = indices[0][:, :, None] * tiles.shape[1] + indices[1][:, None, :]
    weights = shares[0][:, :, None] * shares[1][:, None, :]
    return columns.reshape(len(points), 4), weights.reshape(len(points), 4), off


def nearest_on_boundary(
    mesh: Polygons, points: np.ndarray
) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """The nearest places on a mesh's boundary, as weights of the two nodes of an edge: columns
    (n, 2), weights (n, 2), distances (n,) [m] and the cells (n,) beside them.
    """
    edges = np.stack([mesh.corners, np.roll(mesh.corners, -1, axis=1)], axis=2).reshape(-1, 2)
    cell = np.repeat(np.arange(len(mesh.corners)), 4)
    some = edges[:, 0] != edges[:, 1]
    edges, cell = edges[some], cell[some]
    _, first, many = np.unique(
        np.sort(edges, axis=1), axis=0, return_index=True, return_counts=True
    )
    edges, cell = edges[first[many == 1]], cell[first[many == 1]]
    start, along = mesh.nodes[edges[:, 0]], mesh.nodes[edges[:, 1]] - mesh.nodes[edges[:, 0]]
    which = np.empty(len(points), int)
    share, distance = np.empty(len(points)), np.empty(len(points))
    for k, point in enumerate(points):
        t = np.clip(((point - start) * along).sum(axis=1) / (along**2).sum(axis=1), 0.0, 1.0)
        apart = np.linalg.norm(start + t[:, None] * along - point, axis=1)
        which[k] = np.argmin(apart)
        share[k], distance[k] = t[which[k]], apart[which[k]]
    return edges[which], np.column_stack([1 - share, share]), distance, cell[which]
