"""Maps that keep integrals, by exact cutting.

Cells to cells: ``q_i = Σ_j A_ij q_j / A_i`` with A_ij the area that cell i of the target and cell j
of the source share; amounts ``Q_i = Σ_j (A_ij / A_j) Q_j``. Values at nodes stand for ``Σ_n φ_n
q_n`` with φ the linear functions of the triangles, and are integrated over the pieces: ``B_in =
∫_{cell i} φ_n dA``; at nodes of both, ``q_i = Σ_n ∫ψ_i φ_n dA q_n / ∫ψ_i dA``, so that constants
stay constants. Source: P. E. Farrell et al. (2009), doi 10.1016/j.cma.2009.03.004.

Integrals and amounts on a surface with a depth are per metre of it.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from scipy.sparse import coo_matrix, csr_matrix, diags_array

from .cells import Polygons, Rings, Scattered, Tiles
from .consistent import interpolate
from .errors import SurfaceError
from .locate import in_cells
from .maps import Map
from .overlap import Pieces, cut, cut_polygons
from .products import nodes_by_nodes

if TYPE_CHECKING:
    from .surface import Surface


def conservative(
    source: Surface, target: Surface, quantity: str, outside: str, tolerance: float
) -> Map:
    """Builds the map; see :meth:`Surface.map_to`."""
    source_has_nodes, target_has_nodes = _has_nodes(source), _has_nodes(target)
    if isinstance(target.cells, Scattered):
        raise SurfaceError("conservative: points without cells take no integral; map to cells")
    if isinstance(source.cells, Scattered):
        if quantity != "extensive":
            raise SurfaceError(
                "conservative: points without cells have no areas; quantity="
                '"extensive" carries their amounts, kind="consistent" their values'
            )
        shared = _points_in_cells(source, target, tolerance)
        return _amounts(source, target, shared, outside)
    if source_has_nodes and target_has_nodes:
        if quantity == "intensive":
            shared = nodes_by_nodes(target.cells, source.cells, tolerance)
            return _densities(source, target, shared, outside)
        # Amounts of nodes go to those of the triangle around: the transpose of interpolation.
        back, off = interpolate(target, source, tolerance, nearest=False)
        shared = csr_matrix(back.T) @ diags_array((~off).astype(float))
        return _amounts(source, target, shared, outside)
    if source_has_nodes:
        shared = nodes_by_cells(source.cells, target.cells, tolerance, "triangles").T
    elif target_has_nodes:
        shared = nodes_by_cells(target.cells, source.cells, tolerance, "cells")
    else:
        pieces = cut(target.cells, source.cells)
        _refuse_cells_that_overlap(pieces, source, target, tolerance)
        pieces = _snap(pieces, source.cells, tolerance)
        shared = _matrix(pieces.i, pieces.j, pieces.area, (target.size, source.size))
    if quantity == "intensive":
        return _densities(source, target, shared, outside)
    areas = _areas(source)
    shared = shared @ diags_array(np.divide(1.0, areas, out=np.zeros_like(areas), where=areas > 0))
    return _amounts(source, target, shared, outside)


def nodes_by_cells(
    mesh: Polygons, cells: Rings | Polygons, tolerance: float, snap: str | None = None
) -> csr_matrix:
    """``∫_{cell} φ_n dA`` [m2]; shape (nodes, cells). Those of `snap`, the "cells" or the
    "triangles", that stick out by less than the tolerance keep their whole area.
    """
    corners, _ = mesh.triangles
    points = mesh.nodes[corners]
    pieces = cut_polygons(cells, points)
    triangles = Polygons(mesh.nodes, np.column_stack([corners, corners[:, 2]]), (len(corners),))
    i, j, area = pieces.i, pieces.j, pieces.area
    moment = pieces.moment + (pieces.about - points[j, 0]) * area[:, None]
    if snap:
        scale = _snap_scale(
            *((i, area, cells) if snap == "cells" else (j, area, triangles)), tolerance
        )
        area, moment = area * scale, moment * scale[:, None]
    a, b = points[j, 1] - points[j, 0], points[j, 2] - points[j, 0]
    twice = a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]
    second = (moment[:, 0] * b[:, 1] - moment[:, 1] * b[:, 0]) / twice
    third = (a[:, 0] * moment[:, 1] - a[:, 1] * moment[:, 0]) / twice
    values = np.concatenate([area - second - third, second, third])
    rows = np.concatenate([corners[j, 0], corners[j, 1], corners[j, 2]])
    return _matrix(rows, np.tile(i, 3), values, (len(mesh.nodes), int(np.prod(cells.shape))))


def nodal_areas(mesh: Polygons) -> np.ndarray:
    """``∫ φ_n dA`` [m2]: a third of each triangle around."""
    corners, _ = mesh.triangles
    points = mesh.nodes[corners]
    a, b = points[:, 1] - points[:, 0], points[:, 2] - points[:, 0]
    area = 0.5 * (a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0])
    return np.bincount(corners.ravel(), np.repeat(area / 3, 3), minlength=len(mesh.nodes))


def _areas(surface: Surface) -> np.ndarray:
    return nodal_areas(surface.cells) if _has_nodes(surface) else surface.cells.areas


def _has_nodes(surface: Surface) -> bool:
    """Whether values stand at nodes of a mesh; points of a grid stand for the cells around them."""
    return surface.location == "points" and not isinstance(surface.cells, Tiles | Scattered)


def _matrix(
    rows: np.ndarray, columns: np.ndarray, values: np.ndarray, shape: tuple[int, int]
) -> csr_matrix:
    return csr_matrix(coo_matrix((values, (rows, columns)), shape=shape))


def _densities(source: Surface, target: Surface, shared: csr_matrix, outside: str) -> Map:
    areas = _areas(target)
    inverse = np.divide(1.0, areas, out=np.zeros_like(areas), where=areas > 0)
    matrix = csr_matrix(diags_array(inverse) @ shared)
    weights = _areas(source) / source.depth, areas / source.depth
    return Map(source, target, matrix, "conservative", "intensive", outside, *weights)


def _amounts(source: Surface, target: Surface, shared: csr_matrix, outside: str) -> Map:
    ratio = source.depth / target.depth
    weights = np.ones(source.size), np.full(target.size, 1.0 / ratio)
    matrix = csr_matrix(shared * ratio)
    return Map(source, target, matrix, "conservative", "extensive", outside, *weights)


def _points_in_cells(source: Surface, target: Surface, tolerance: float) -> csr_matrix:
    places = source.cells.places[:, :2]
    if isinstance(target.cells, Rings):
        cell = target.cells.contains(places, tolerance)
    else:
        cell, _ = in_cells(target.cells, places, tolerance)
    on = np.flatnonzero(cell >= 0)
    if not _has_nodes(target):
        return _matrix(cell[on], on, np.ones(len(on)), (target.size, source.size))
    found, weights = in_cells(target.cells, places[on], tolerance)
    columns = target.cells.corners[found]
    return _matrix(columns.ravel(), np.repeat(on, 4), weights.ravel(), (target.size, source.size))


def _snap(pieces: Pieces, cells: Rings | Polygons, tolerance: float) -> Pieces:
    return Pieces(
        pieces.i, pieces.j, pieces.area * _snap_scale(pieces.j, pieces.area, cells, tolerance)
    )


def _snap_scale(
    j: np.ndarray, area: np.ndarray, cells: Rings | Polygons, tolerance: float
) -> np.ndarray:
    """Factors that give cells their whole area back of which no more than a seam `tolerance`
    wide is missing.
    """
    areas = cells.areas
    found = np.bincount(j, area, minlength=len(areas))
    seam = np.abs(areas - found) <= tolerance * cells.perimeters
    scale = np.where(seam & (found > 0), areas / np.where(found > 0, found, 1.0), 1.0)
    return scale[j]


def _refuse_cells_that_overlap(
    pieces: Pieces, source: Surface, target: Surface, tolerance: float
) -> None:
    """Cells that are covered more than once would count what lies on them more than once."""
    for surface, index, name in ((source, pieces.j, "target"), (target, pieces.i, "source")):
        areas = surface.cells.areas
        covered = np.bincount(index, pieces.area, minlength=len(areas))
        over = covered - areas > tolerance * surface.cells.perimeters
        if over.any():
            cell = int(np.flatnonzero(over)[0])
            at = ", ".join(f"{x:.6g}" for x in surface.cells.centroids[cell])
            raise SurfaceError(
                f"cells of the {name} overlap: they cover {covered[cell]:.6g} m2 of "
                f"the {areas[cell]:.6g} m2 "
                f"of a cell at ({at}) m"
            )
