"""What surfaces are made of: concentric rings, polygons with their corners, and points."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from .errors import SurfaceError
from .placement import three_columns
from .polygons import is_convex, moments, perimeters


@dataclass(frozen=True)
class Rings:
    """Concentric rings: `edges` are their radii from the inside out [m], shape (count + 1,)."""

    edges: np.ndarray
    centre: np.ndarray

    def __post_init__(self) -> None:
        if len(self.edges) < 2 or self.edges[0] < 0 or not (np.diff(self.edges) > 0).all():
            raise SurfaceError(f"rings: radii {self.edges} m are to ascend from 0 or more")

    @property
    def shape(self) -> tuple[int, ...]:
        return (len(self.edges) - 1,)

    @cached_property
    def areas(self) -> np.ndarray:
        """``π (R₂ − R₁)(R₂ + R₁)`` [m2]."""
        return np.pi * np.diff(self.edges) * (self.edges[1:] + self.edges[:-1])

    @property
    def perimeters(self) -> np.ndarray:
        return 2 * np.pi * (self.edges[1:] + self.edges[:-1])

    @property
    def centroids(self) -> np.ndarray:
        return np.tile(self.centre, (len(self.edges) - 1, 1))

    @property
    def box(self) -> np.ndarray:
        return np.stack([self.centre - self.edges[-1], self.centre + self.edges[-1]])

    def contains(self, points: np.ndarray, tolerance: float = 0.0) -> np.ndarray:
        """Ring of each point, −1 where there is none within `tolerance` [m]; the inner one where
        two meet."""
        r = np.hypot(*(points - self.centre).T)
        within = np.clip(r, self.edges[0], self.edges[-1])
        r = np.where(np.abs(r - within) <= tolerance, within, r)
        index = np.searchsorted(self.edges, r, side="left") - 1
        index[(r == self.edges[0])] = 0
        return np.where(index < len(self.edges) - 1, index, -1)


@dataclass(frozen=True)
class Polygons:
    """Triangles and quadrilaterals: `nodes` (n, 2) [m], `corners` (cells, 4), of triangles the last
    one twice. Cells go round to the left; quadrilaterals are convex."""

    nodes: np.ndarray
    corners: np.ndarray
    shape: tuple[int, ...]

    @cached_property
    def points(self) -> np.ndarray:
        """Corners of all cells; shape (cells, 4, 2)."""
        return self.nodes[self.corners]

    @property
    def outlines(self) -> np.ndarray:
        """The same without the fourth corner, if all are triangles."""
        is_triangle = self.corners[:, 2] == self.corners[:, 3]
        return self.points[:, :3] if is_triangle.all() else self.points

    @cached_property
    def _local(self) -> tuple[np.ndarray, np.ndarray]:
        origin = self.points.mean(axis=1)
        area, moment = moments(self.points - origin[:, None, :])
        return area, origin + moment / area[:, None]

    @property
    def areas(self) -> np.ndarray:
        return self._local[0]

    @property
    def centroids(self) -> np.ndarray:
        return self._local[1]

    @property
    def perimeters(self) -> np.ndarray:
        return perimeters(self.points)

    @property
    def box(self) -> np.ndarray:
        used = self.points.reshape(-1, 2)
        return np.stack([used.min(axis=0), used.max(axis=0)])

    @cached_property
    def triangles(self) -> tuple[np.ndarray, np.ndarray]:
        """Nodes of triangles, shape (t, 3), that make up the cells, and the cell of each."""
        quads = np.flatnonzero(self.corners[:, 2] != self.corners[:, 3])
        both = np.concatenate([self.corners[:, :3], self.corners[quads][:, [0, 2, 3]]])
        cell = np.concatenate([np.arange(len(self.corners)), quads])
        order = np.argsort(cell, kind="stable")
        return both[order], cell[order]


@dataclass(frozen=True)
class Tiles(Polygons):
    """Equal rectangles; `low` (2,) is their lower corner, `size` (2,) their sides [m]. The first
    index runs along x, the last fastest.
    """

    low: np.ndarray
    size: np.ndarray

    @property
    def edges(self) -> tuple[np.ndarray, np.ndarray]:
        """Lines between them along x and y [m]."""
        return tuple(
            low + s * np.arange(n + 1)
            for low, s, n in zip(self.low, self.size, self.shape, strict=True)
        )

    @property
    def middles(self) -> tuple[np.ndarray, np.ndarray]:
        """Coordinates of their centres along x and y [m]."""
        x, y = self.edges
        return 0.5 * (x[1:] + x[:-1]), 0.5 * (y[1:] + y[:-1])


@dataclass(frozen=True)
class Scattered:
    """Points without cells; `places` (n, 3) [m]."""

    places: np.ndarray

    @property
    def shape(self) -> tuple[int, ...]:
        return (len(self.places),)

    @property
    def box(self) -> np.ndarray:
        return np.stack([self.places[:, :2].min(axis=0), self.places[:, :2].max(axis=0)])


def whole_number(value: Any, what: str) -> int:
    """A count, of any numeric type, that is a whole number."""
    try:
        number = int(value)
        is_whole = number == value
    except (TypeError, ValueError, OverflowError):
        is_whole = False
    if not is_whole:
        raise SurfaceError(f"{what}: a count of {value!r}; whole numbers are needed")
    return number


def make_rings(edges: Sequence[float] | np.ndarray, at: Sequence[float]) -> Rings:
    return Rings(np.asarray(edges, float), _two(at, "at"))


def make_tiles(count: Sequence[int], size: Sequence[float], at: Sequence[float]) -> Tiles:
    """`count` = (nx, ny) rectangles that fill `size` = (lx, ly) [m] about the centre `at` [m]."""
    if np.shape(count) != (2,):
        raise SurfaceError(f"tiles: counts (nx, ny) are needed, not {count!r}")
    nx, ny = (whole_number(n, "tiles") for n in count)
    size, at = _two(size, "size"), _two(at, "at")
    if nx < 1 or ny < 1 or not (size > 0).all():
        raise SurfaceError(f"tiles: {nx} × {ny} of {size[0]} × {size[1]} m: all are to be above 0")
    step = size / (nx, ny)
    low = at - 0.5 * size
    x, y = low[0] + step[0] * np.arange(nx + 1), low[1] + step[1] * np.arange(ny + 1)
    nodes = np.stack(np.meshgrid(x, y, indexing="ij"), axis=2).reshape(-1, 2)
    i, j = np.meshgrid(np.arange(nx), np.arange(ny), indexing="ij")
    corner = (i * (ny + 1) + j).ravel()
    corners = np.column_stack([corner, corner + ny + 1, corner + ny + 2, corner + 1])
    return Tiles(nodes, corners, (nx, ny), low, step)


def check_cells(cells: np.ndarray, nodes: int) -> None:
    """Refuses what is no array of three or four numbers of `nodes` a cell."""
    if cells.ndim != 2 or cells.shape[1] not in (3, 4) or not len(cells):
        raise SurfaceError(
            f"cells: an array of shape (n, 3) or (n, 4) is needed, not {cells.shape}"
        )
    if not np.issubdtype(cells.dtype, np.integer):
        raise SurfaceError(f"cells: numbers of nodes are needed, not {cells.dtype}")
    if cells.min() < 0 or cells.max() >= nodes:
        wrong = (cells < 0) | (cells >= nodes)
        cell = int(np.flatnonzero(wrong.any(axis=1))[0])
        node = cells[cell][wrong[cell]][0]
        raise SurfaceError(
            f"cells: cell {cell} names node {node} of {nodes}, which count from 0 to {nodes - 1}"
        )


def make_polygons(nodes: np.ndarray, cells: np.ndarray) -> Polygons:
    """Cells of three or four corners; those that go round to the right are turned."""
    nodes = np.ascontiguousarray(nodes)
    corners = cells if cells.shape[1] == 4 else np.column_stack([cells, cells[:, 2]])
    corners = corners.astype(np.int64)
    area, _ = moments(nodes[corners] - nodes[corners[:, :1]])
    is_flat = np.abs(area) <= 1e-14 * perimeters(nodes[corners]) ** 2
    if is_flat.any():
        cell = int(np.flatnonzero(is_flat)[0])
        raise SurfaceError(f"cells: cell {cell} at {nodes[corners[cell, 0]]} m has no area")
    turned = corners[:, [2, 1, 0, 3]]
    quads = corners[:, 2] != corners[:, 3]
    turned[quads] = corners[quads][:, ::-1]
    turned[~quads, 3] = turned[~quads, 2]
    corners = np.where((area < 0)[:, None], turned, corners)
    bent = ~_is_fit(nodes[corners])
    if bent.any():
        cell = int(np.flatnonzero(bent)[0])
        raise SurfaceError(
            f"cells: cell {cell} at {nodes[corners[cell, 0]]} m is not convex; cut it "
            "into triangles"
        )
    return Polygons(nodes, corners, (len(corners),))


def _is_fit(points: np.ndarray) -> np.ndarray:
    """Whether cells are convex; triangles, which have a corner twice, always are."""
    is_triangle = (points[:, 2] == points[:, 3]).all(axis=1)
    return is_triangle | is_convex(points)


def make_scattered(points: np.ndarray) -> Scattered:
    places = three_columns(points)
    if not len(places):
        raise SurfaceError("points: there are none")
    return Scattered(places)


def _two(values: Sequence[float], name: str) -> np.ndarray:
    values = np.asarray(values, float)
    if values.shape != (2,) or not np.isfinite(values).all():
        raise SurfaceError(f"{name}: two numbers are needed, not {values}")
    return values
