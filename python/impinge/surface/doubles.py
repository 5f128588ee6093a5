"""Cells of one surface that cover the same place twice."""

from __future__ import annotations

import numpy as np

from .boxes import boxes_of, overlapping
from .cells import Polygons

# How deep cells lie in each other that overlap, as a share of the area by the perimeter of the
# smaller one: what is less is a seam, as between arcs that are cut into different lines.
DEEP = 0.2
_BLOCK = 1 << 18  # pairs at once


def double(mesh: Polygons) -> tuple[int, int] | None:
    """Two cells that overlap by more than a seam, or none."""
    return _on_one_edge(mesh) or _in_each_other(mesh)


def _on_one_edge(mesh: Polygons) -> tuple[int, int] | None:
    """Cells on the same side of an edge: all go round to the left."""
    ends = np.roll(mesh.corners, -1, axis=1)
    edges = (mesh.corners * len(mesh.nodes) + ends).ravel()
    cells = np.repeat(np.arange(len(mesh.corners)), 4)
    some = (mesh.corners != ends).ravel()
    edges, cells = edges[some], cells[some]
    order = np.argsort(edges, kind="stable")
    same = np.flatnonzero(np.diff(edges[order]) == 0)
    if not len(same):
        return None
    first = same[0]
    return int(cells[order[first]]), int(cells[order[first + 1]])


def _in_each_other(mesh: Polygons) -> tuple[int, int] | None:
    """Cells that no line along a side of one of them parts: what convex ones have if they are
    apart (the theorem of the separating axis)."""
    points = mesh.points
    boxes = boxes_of(points)
    deep = DEEP * mesh.areas / mesh.perimeters
    inset = 0.25 * deep.min()  # leaves out neighbours whose boxes touch
    inner = np.stack([boxes[:, 0] + inset, boxes[:, 1] - inset], axis=1)
    i, j = overlapping(inner, inner)
    i, j = i[i < j], j[i < j]
    for begin in range(0, len(i), _BLOCK):
        a, b = i[begin : begin + _BLOCK], j[begin : begin + _BLOCK]
        depth = np.minimum(_depth(points[a], points[b]), _depth(points[b], points[a]))
        found = np.flatnonzero(depth > np.minimum(deep[a], deep[b]))
        if len(found):
            return int(a[found[0]]), int(b[found[0]])
    return None


def _depth(cells: np.ndarray, others: np.ndarray) -> np.ndarray:
    """How far [m] others reach over that side of cells which they reach over least."""
    side = np.roll(cells, -1, axis=1) - cells
    length = np.linalg.norm(side, axis=2)
    offset = others[:, None] - cells[:, :, None]
    inwards = side[..., None, 0] * offset[..., 1] - side[..., None, 1] * offset[..., 0]
    reach = inwards.max(axis=2) / np.where(length > 0, length, 1.0)
    return np.where(length > 0, reach, np.inf).min(axis=1)
