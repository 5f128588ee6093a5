"""Maps that keep values, by interpolation: constants everywhere, linear fields between nodes and
points.

Nodes and points of grids: linear on triangles, bilinear on quadrilaterals and grids. Scattered
points: :mod:`impinge.surface.rbf`. To cells: the mean over the cell, exact for what is linear
between nodes.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from scipy.sparse import coo_matrix, csr_matrix, diags_array

from . import rbf
from .cells import Polygons, Rings, Scattered, Tiles, make_polygons
from .errors import SurfaceError
from .locate import in_cells, nearest_on_boundary, on_grid
from .maps import Map
from .overlap import cut

if TYPE_CHECKING:
    from .surface import Surface


def consistent(
    source: Surface, target: Surface, outside: str, tolerance: float, options: dict
) -> Map:
    """Builds the map; see :meth:`Surface.map_to`."""
    nearest = outside == "nearest"
    if isinstance(source.cells, Scattered):
        matrix, off = _from_points(source, target, nearest, options)
        none = off
    elif target.location == "points" or isinstance(target.cells, Scattered):
        matrix, off = interpolate(source, target, tolerance, nearest)
        none = off
    else:
        matrix, off, none = _means(source, target, tolerance, nearest)
    if outside == "error" and off.any():
        _refuse(source, target, off)
    return Map(source, target, matrix, "consistent", "intensive", outside, off=none & (not nearest))


def interpolate(
    source: Surface, target: Surface, tolerance: float, nearest: bool
) -> tuple[csr_matrix, np.ndarray]:
    """Matrix from a mesh, grid or cells to the points of a target, and which of these lie off
    them.
    """
    points = target.coordinates[:, :2]
    shape = (len(points), source.size)
    if source.location == "points" and isinstance(source.cells, Tiles):
        columns, weights, off = on_grid(source.cells, points, tolerance, nearest)
        return _rows(columns, weights, shape), off
    if isinstance(source.cells, Rings):
        cell = source.cells.contains(points, tolerance)
        off = cell < 0
        r = np.hypot(*(points - source.cells.centre).T)
        last = len(source.cells.edges) - 2
        cell = np.where(off, np.where(r > source.cells.edges[-1], last, 0), cell)
        return _rows(cell[:, None], np.ones((len(points), 1)), shape), off
    cell, weights = in_cells(source.cells, points, tolerance)
    off = cell < 0
    at_nodes = source.location == "points"
    columns = source.cells.corners[cell] if at_nodes else cell[:, None]
    weights = weights if at_nodes else np.ones((len(points), 1))
    columns = np.where(off[:, None], 0, columns)
    weights = np.where(off[:, None], 0.0, weights)
    matrix = _rows(columns, weights, shape)
    if nearest and off.any():
        nodes, share, _, beside = nearest_on_boundary(source.cells, points[off])
        columns = nodes if at_nodes else beside[:, None]
        share = share if at_nodes else np.ones((len(columns), 1))
        some = _rows(columns, share, (int(off.sum()), source.size))
        place = csr_matrix(
            (np.ones(off.sum()), (np.flatnonzero(off), np.arange(off.sum()))),
            (len(points), off.sum()),
        )
        matrix = matrix + place @ some
    return csr_matrix(matrix), off


def _means(
    source: Surface, target: Surface, tolerance: float, nearest: bool
) -> tuple[csr_matrix, np.ndarray, np.ndarray]:
    """Means over the cells of the target of what the source covers of them; which of these it does
    not cover wholly, and not at all."""
    if source.location == "points":
        from .conservative import nodes_by_cells

        mesh, extend = _mesh_of(source)
        shared = csr_matrix(nodes_by_cells(mesh, target.cells, tolerance).T)
        covered = np.asarray(shared.sum(axis=1)).ravel()
        shared = shared @ extend
    else:
        pieces = cut(target.cells, source.cells)
        shape = (target.size, source.size)
        shared = csr_matrix(coo_matrix((pieces.area, (pieces.i, pieces.j)), shape=shape))
        covered = np.asarray(shared.sum(axis=1)).ravel()
    missing = target.cells.areas - covered
    off = missing > tolerance * target.cells.perimeters
    none = covered <= 0
    matrix = csr_matrix(
        diags_array(np.where(none, 0.0, 1.0 / np.where(none, 1.0, covered))) @ shared
    )
    if nearest and none.any():
        centres = target.on_points_of(target.cells.centroids[none])
        some, _ = interpolate(source, centres, tolerance, nearest=True)
        place = csr_matrix(
            (np.ones(none.sum()), (np.flatnonzero(none), np.arange(none.sum()))),
            (len(none), none.sum()),
        )
        matrix = csr_matrix(matrix + place @ some)
    return matrix, off, none


def _mesh_of(source: Surface) -> tuple[Polygons, csr_matrix]:
    """A mesh whose nodal values are a matrix times the values at a surface's points. Grids are
    extended by extrapolation to the edges of their outermost cells.
    """
    if not isinstance(source.cells, Tiles):
        return source.cells, csr_matrix(diags_array(np.ones(source.size)))
    lines = [
        np.concatenate([e[:1], m, e[-1:]])
        for e, m in zip(source.cells.edges, source.cells.middles, strict=True)
    ]
    nodes = np.stack(np.meshgrid(*lines, indexing="ij"), axis=2).reshape(-1, 2)
    nx, ny = (len(line) for line in lines)
    i, j = np.meshgrid(np.arange(nx - 1), np.arange(ny - 1), indexing="ij")
    corner = (i * ny + j).ravel()
    cells = np.column_stack([corner, corner + ny, corner + ny + 1, corner + 1])
    columns, weights, _ = on_grid(source.cells, nodes, 0.0, nearest=False)
    return make_polygons(nodes, cells), _rows(columns, weights, (len(nodes), source.size))


def _from_points(
    source: Surface, target: Surface, nearest: bool, options: dict[str, Any]
) -> tuple[csr_matrix, np.ndarray]:
    places = source.cells.places
    if target.location == "points" or isinstance(target.cells, Scattered):
        points, average = target.coordinates, None
    else:
        points, average = quadrature(target)
    flat = np.ptp(places[:, 2]) == 0 and np.ptp(points[:, 2]) == 0
    columns = 2 if flat else 3
    matrix, off = rbf.matrix(places[:, :columns], points[:, :columns], **options)
    if nearest and off.any():
        closest = rbf.cKDTree(places).query(points[off])[1]
        add = csr_matrix((np.ones(off.sum()), (np.flatnonzero(off), closest)), matrix.shape)
        matrix = csr_matrix(matrix + add)
    if average is None:
        return matrix, off
    return csr_matrix(average @ matrix), np.asarray(average @ off.astype(float)) > 0


def quadrature(target: Surface) -> tuple[np.ndarray, csr_matrix]:
    """Points in the cells of a surface and the matrix of means over these, exact to the fourth
    degree on triangles and, on rings, to the fifth along the radius and the 31st round it.

    Source for triangles: D. A. Dunavant (1985), doi 10.1002/nme.1620210612.
    """
    z = np.median(target.coordinates[:, 2])
    if isinstance(target.cells, Rings):
        nodes, weights = np.polynomial.legendre.leggauss(3)
        inner, outer = target.cells.edges[:-1], target.cells.edges[1:]
        r = 0.5 * (inner + outer)[:, None] + 0.5 * (outer - inner)[:, None] * nodes
        angle = 2 * np.pi * np.arange(32) / 32
        around = np.stack([np.cos(angle), np.sin(angle)], axis=1)
        points = target.cells.centre + r[:, :, None, None] * around
        share = np.repeat((r * weights)[:, :, None], 32, axis=2).reshape(len(r), -1)
        cell = np.repeat(np.arange(len(r)), share.shape[1])
    else:
        corners, who = target.cells.triangles
        a, b = 0.445948490915965, 0.091576213509771
        bary = np.array(
            [[a, a], [1 - 2 * a, a], [a, 1 - 2 * a], [b, b], [1 - 2 * b, b], [b, 1 - 2 * b]]
        )
        bary = np.column_stack([1 - bary.sum(axis=1), bary])
        points = np.einsum("qc,tcx->tqx", bary, target.cells.nodes[corners])
        p = target.cells.nodes[corners]
        u, v = p[:, 1] - p[:, 0], p[:, 2] - p[:, 0]
        area = u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0]
        share = area[:, None] * np.repeat([0.223381589678011, 0.109951743655322], 3)
        cell = np.repeat(who, 6)
    share = share.ravel()
    share = share / np.bincount(cell, share)[cell]
    points = points.reshape(-1, 2)
    average = csr_matrix((share, (cell, np.arange(len(share)))), (target.size, len(share)))
    return np.column_stack([points, np.full(len(points), z)]), average


def _rows(columns: np.ndarray, weights: np.ndarray, shape: tuple[int, int]) -> csr_matrix:
    rows = np.repeat(np.arange(shape[0]), columns.shape[1])
    return csr_matrix(coo_matrix((weights.ravel(), (rows, columns.ravel())), shape=shape))


def _refuse(source: Surface, target: Surface, off: np.ndarray) -> None:
    place = int(np.flatnonzero(off)[0])
    at = ", ".join(f"{x:.6g}" for x in target.coordinates[place])
    low, high = source.cells.box
    what = "places" if target.location == "points" else "cells"
    raise SurfaceError(
        f"{off.sum()} of {target.size} {what} of the target lie off the source, the "
        f"first at ({at}) m; the source "
        f"reaches from ({low[0]:.6g}, {low[1]:.6g}) to ({high[0]:.6g}, {high[1]:.6g}) m; "
        'outside="drop" gives them NaN, outside="nearest" the value of the nearest place'
    )
