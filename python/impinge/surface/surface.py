"""A set of cells or points on a face, and maps between two of them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal

import numpy as np

from .cells import (
    Polygons,
    Rings,
    Scattered,
    Tiles,
    check_cells,
    make_polygons,
    make_rings,
    make_scattered,
    make_tiles,
    whole_number,
)
from .conservative import conservative, nodal_areas
from .consistent import consistent
from .errors import SurfaceError
from .maps import Map
from .placement import Placement

if TYPE_CHECKING:
    from .series import Series


@dataclass(frozen=True, eq=False)
class Surface:
    """Cells or points on a plane face, in the coordinates of the face [m].

    Make one by :meth:`rings`, :meth:`tiles`, :meth:`grid`, :meth:`triangles`, :meth:`quads`,
    :meth:`points`, :meth:`read` or :meth:`of`, and map values with :meth:`map_to`::

        cfd = Surface.read("wall.vtu", Placement(origin=(120, 40, 0), unit="mm"))
        tiles = Surface.of(unit, "laser")
        unit["laser.heat_flux"] = cfd.map_to(tiles)(cfd.data["heat_flux"])

    Attributes
    ----------
    cells
        Rings, tiles, polygons or scattered points.
    location
        Whether values stand in "cells" or at "points": the nodes of a mesh, the middles of tiles.
    z
        Height of the plane [m].
    data
        Fields that a file brought, by name; each a value (or a row of components) a place.
    depth
        Extent along y [m] of the wall of a plane drop, whose areas, integrals and amounts are per
        metre of depth; 1 of all else. Maps cut the cells themselves, over their whole depth.
    """

    cells: Rings | Polygons | Scattered
    location: Literal["cells", "points"]
    z: float = 0.0
    data: dict[str, np.ndarray] = field(default_factory=dict)
    depth: float = 1.0

    # Makers

    @classmethod
    def rings(
        cls, count: int, radius: float, at: Sequence[float] = (0.0, 0.0), *, z: float = 0.0
    ) -> Surface:
        """`count` concentric rings of equal width out to `radius` [m] about `at` [m]. Arcs are
        true arcs.
        """
        count = whole_number(count, "rings")
        if count < 1 or not (np.isfinite(radius) and radius > 0):
            raise SurfaceError(f"rings: {count} of radius {radius} m: both are to be above 0")
        return cls(make_rings(radius * np.arange(count + 1) / count, at), "cells", z)

    @classmethod
    def ring_edges(
        cls, edges: Sequence[float], at: Sequence[float] = (0.0, 0.0), *, z: float = 0.0
    ) -> Surface:
        """Concentric rings between ascending radii [m], shape (count + 1,)."""
        return cls(make_rings(edges, at), "cells", z)

    @classmethod
    def tiles(
        cls,
        count: Sequence[int],
        size: Sequence[float],
        at: Sequence[float] = (0.0, 0.0),
        *,
        z: float = 0.0,
    ) -> Surface:
        """(nx, ny) equal rectangles that fill `size` = (lx, ly) [m] centred on `at` [m]; values
        have shape (nx, ny), the first index along x.
        """
        return cls(make_tiles(count, size, at), "cells", z)

    @classmethod
    def grid(
        cls,
        count: Sequence[int],
        size: Sequence[float],
        at: Sequence[float] = (0.0, 0.0),
        *,
        z: float = 0.0,
    ) -> Surface:
        """The middles of :meth:`tiles`, where a unit's ``[[field]]`` has its points."""
        return cls(make_tiles(count, size, at), "points", z)

    @classmethod
    def triangles(
        cls,
        points: np.ndarray,
        cells: np.ndarray,
        placement: Placement | None = None,
        *,
        values: Literal["cells", "points"] = "cells",
        tolerance: float | None = None,
    ) -> Surface:
        """Triangles, `cells` of shape (n, 3), between `points` of shape (m, 2) or (m, 3).

        All nodes that cells use are to lie on one plane of constant z of the face, to `tolerance`
        [m] (by default 1e-6 of their extent).
        """
        placed = (placement or Placement()).to_face(points)
        corners = np.asarray(cells)
        check_cells(corners, len(placed))
        z = plane(placed, np.unique(corners), tolerance)
        return cls(make_polygons(placed[:, :2], corners), values, z)

    @classmethod
    def quads(
        cls,
        points: np.ndarray,
        cells: np.ndarray,
        placement: Placement | None = None,
        *,
        values: Literal["cells", "points"] = "cells",
        tolerance: float | None = None,
    ) -> Surface:
        """Convex quadrilaterals, `cells` of shape (n, 4); a triangle has its last corner twice."""
        return cls.triangles(points, cells, placement, values=values, tolerance=tolerance)

    @classmethod
    def points(cls, points: np.ndarray, placement: Placement | None = None) -> Surface:
        """Scattered points of shape (n, 2) or (n, 3), which need not lie on a plane."""
        placed = (placement or Placement()).to_face(points)
        return cls(make_scattered(placed), "points", float(placed[0, 2]))

    @classmethod
    def read(cls, path: str | Path, placement: Placement | None = None, **options: Any) -> Surface:
        """A surface with its fields in `data`; see :func:`impinge.surface.files.read`."""
        from .files import read

        return read(path, placement, **options)

    @classmethod
    def read_series(
        cls, path: str | Path, placement: Placement | None = None, **options: Any
    ) -> tuple[Surface, dict[str, Series]]:
        """A surface and its fields over time; see :func:`impinge.surface.files.read_series`."""
        from .files import read_series

        return read_series(path, placement, **options)

    @classmethod
    def of(cls, unit: Any, name: str, z: float | None = None) -> Surface:
        """The cells or points of a unit's load, wall or field.

        `unit` is an :class:`impinge.Unit`, whose loads are where, and as large as, its inputs say
        now, or the path of a unit (.fmu), of a folder of one or of a scene (.toml), of which only
        the geometry at the start is read; `z` the height [m] of a face that is no top.
        See :func:`impinge.surface.families.family`.
        """
        from .families import family

        return family(unit, name, z)

    # Properties

    @property
    def shape(self) -> tuple[int, ...]:
        """Shape of an array of values."""
        if self.location == "points" and not isinstance(self.cells, Tiles | Scattered):
            return (len(self.cells.nodes),)
        return tuple(self.cells.shape)

    @property
    def size(self) -> int:
        """Number of values."""
        return int(np.prod(self.shape))

    @property
    def coordinates(self) -> np.ndarray:
        """Where values stand [m]: centroids of cells, nodes or points; shape (size, 3). Of
        rings: their axis.
        """
        if isinstance(self.cells, Scattered):
            return self.cells.places
        at_nodes = self.location == "points" and not isinstance(self.cells, Tiles)
        flat = self.cells.nodes if at_nodes else self.cells.centroids
        return np.column_stack([flat, np.full(len(flat), self.z)])

    @property
    def areas(self) -> np.ndarray:
        """Areas that values stand for [m2], of :attr:`shape`; of nodes: ∫ φ dA. Of walls of plane
        drops: widths [m].
        """
        if isinstance(self.cells, Scattered):
            raise SurfaceError("points without cells have no areas")
        if self.location == "points" and not isinstance(self.cells, Tiles):
            return nodal_areas(self.cells) / self.depth
        return self.cells.areas.reshape(self.shape) / self.depth

    def on_points(self) -> Surface:
        """The same with values at the nodes of a mesh, or at the middles of tiles."""
        if isinstance(self.cells, Rings):
            raise SurfaceError("rings have no points; take a grid")
        return replace(self, location="points", data={})

    def on_cells(self) -> Surface:
        """The same with values in cells; of a grid, the tiles around its points."""
        if isinstance(self.cells, Scattered):
            raise SurfaceError("points have no cells")
        return replace(self, location="cells", data={})

    def on_points_of(self, places: np.ndarray) -> Surface:
        """Scattered points of the face's coordinates (x, y) [m] at the height of this one."""
        return Surface.points(np.column_stack([places, np.full(len(places), self.z)]))

    def integral(self, values: np.ndarray) -> np.ndarray | float:
        """``Σ A v`` of values per area; axes before those of the surface are kept."""
        values = np.asarray(values, float)
        total = (values * self.areas).sum(axis=tuple(range(-len(self.shape), 0)))
        return total if total.ndim else float(total)

    # Maps

    def map_to(
        self,
        target: Surface,
        kind: Literal["conservative", "consistent"] = "conservative",
        *,
        quantity: Literal["intensive", "extensive"] = "intensive",
        outside: Literal["error", "drop", "nearest"] = "error",
        tolerance: float | None = None,
        **rbf: Any,
    ) -> Map:
        """A map of values on this surface to values on `target`.

        Parameters
        ----------
        kind
            ``"conservative"`` keeps integrals: fluxes, tractions, amounts of heat. Cells are cut
            against cells exactly, rings as circles. Points of a grid stand for the cells around
            them, nodes of a mesh for the linear functions of its triangles. Scattered points carry
            amounts to the cell or nodes that they lie in. ``"consistent"`` keeps values:
            temperatures, coefficients. Linear on triangles, bilinear on quadrilaterals and grids,
            piecewise constant from cells (of tiles, :meth:`on_points` makes that bilinear), by
            radial functions from scattered points; cells of the target get means over them.
        quantity
            Of conservative maps: ``"intensive"`` values are per area (W/m2), ``"extensive"``
            amounts (W).
        outside
            What lies off the other surface: ``"error"``, or ``"drop"``: the amount is left out
            (:meth:`Map.lost` tells it), a place gets NaN, a cell the mean over what is covered of
            it; ``"nearest"``, of consistent maps: the value of the nearest place.
        tolerance
            Distance [m] within which edges and heights are taken as equal; by default 1e-6 of the
            larger extent. A cell that sticks out by less keeps its amount.
        rbf
            From scattered points: `smoothness`, `degree`, `neighbours`, `support`; see
            :func:`impinge.surface.rbf.matrix`.

        Raises
        ------
        SurfaceError
            If surfaces lie on different planes, if cells of one overlap, or if a place lies off the
            source.
        """
        _check("kind", kind, ("conservative", "consistent"))
        _check("quantity", quantity, ("intensive", "extensive"))
        _check(
            "outside", outside, ("error", "drop", *(["nearest"] if kind == "consistent" else []))
        )
        if tolerance is None:
            tolerance = 1e-6 * max(np.ptp(s.cells.box, axis=0).max() for s in (self, target))
        is_rbf = kind == "consistent" and isinstance(self.cells, Scattered)
        if rbf and not is_rbf:
            raise SurfaceError(
                f"{', '.join(rbf)}: only consistent maps of scattered points have these"
            )
        if not is_rbf:
            _refuse_other_plane(self, target, tolerance)
        if kind == "consistent":
            return consistent(self, target, outside, tolerance, rbf)
        return conservative(self, target, quantity, outside, tolerance)


def plane(points: np.ndarray, used: np.ndarray, tolerance: float | None) -> float:
    """Height of the plane [m] on which the `used` ones of points, shape (n, 3), lie.

    Raises
    ------
    SurfaceError
        If one of them is farther from it than the tolerance.
    """
    z = points[used, 2]
    height = float(np.median(z))
    if tolerance is None:
        tolerance = 1e-6 * np.ptp(points[used, :2], axis=0).max()
    far = np.abs(z - height)
    if far.max() > tolerance:
        worst = int(used[np.argmax(far)])
        raise SurfaceError(
            f"node {worst} at z = {points[worst, 2]:.6g} m lies {far.max():.3g} m off "
            "the plane z = "
            f"{height:.6g} m (tolerance {tolerance:.3g} m); place the face by "
            "`origin` and `axes`, or "
            "take the cells of the face alone"
        )
    return height


def _refuse_other_plane(source: Surface, target: Surface, tolerance: float) -> None:
    heights = [
        s.cells.places[:, 2] if isinstance(s.cells, Scattered) else np.array([s.z])
        for s in (source, target)
    ]
    low = min(h.min() for h in heights)
    high = max(h.max() for h in heights)
    if high - low > tolerance:
        raise SurfaceError(
            f"the surfaces lie on different planes: z of the source is {heights[0].min():.6g} to "
            f"{heights[0].max():.6g} m, of the target {heights[1].min():.6g} to "
            f"{heights[1].max():.6g} m "
            f"(tolerance {tolerance:.3g} m)"
        )


def _check(name: str, value: str, allowed: Sequence[str]) -> None:
    if value not in allowed:
        raise SurfaceError(f"{name}: `{value}` is none of {', '.join(allowed)}")
