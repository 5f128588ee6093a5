"""Rigid placement of foreign coordinates, with their unit of length."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from .errors import SurfaceError

METRES = {
    "m": 1.0,
    "dm": 0.1,
    "cm": 1e-2,
    "mm": 1e-3,
    "um": 1e-6,
    "µm": 1e-6,
    "nm": 1e-9,
    "in": 0.0254,
}


@dataclass(frozen=True)
class Placement:
    """Where a face lies in foreign coordinates.

    ``x = s A (X − X₀)`` with X foreign coordinates in `unit`, X₀ the `origin` of the face in them,
    the rows of A its unit vectors along x and y and their cross product, s the length of `unit`
    [m], and x coordinates of the face [m].

    Parameters
    ----------
    origin
        The place of the face's origin in foreign coordinates, in `unit`; shape (3,) or (2,).
    axes
        Directions of the face's x and y in foreign coordinates; shape (2, 3). They are to be
        perpendicular to 1e-6 and may have any length.
    unit
        Unit of the foreign lengths: one of m, dm, cm, mm, um, nm, in, or a number of metres.
    """

    origin: Sequence[float] = (0.0, 0.0, 0.0)
    axes: Sequence[Sequence[float]] = ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0))
    unit: str | float = "m"

    @property
    def metres(self) -> float:
        """Length of the foreign unit [m]."""
        if isinstance(self.unit, str):
            if self.unit not in METRES:
                raise SurfaceError(f"unit: `{self.unit}` is none of {', '.join(METRES)}")
            return METRES[self.unit]
        if not (np.isfinite(self.unit) and self.unit > 0):
            raise SurfaceError(f"unit: {self.unit} m is no length")
        return float(self.unit)

    @property
    def matrix(self) -> np.ndarray:
        """Rows: unit vectors of x, y and z of the face in foreign coordinates; shape (3, 3)."""
        axes = np.asarray(self.axes, float)
        if axes.shape != (2, 3) or not np.isfinite(axes).all():
            raise SurfaceError(f"axes: two directions of three numbers are needed, not {self.axes}")
        length = np.linalg.norm(axes, axis=1)
        if (length == 0).any():
            raise SurfaceError(f"axes: {self.axes} has a direction of no length")
        x, y = axes / length[:, None]
        if abs(x @ y) > 1e-6:
            raise SurfaceError(f"axes: {self.axes} are not perpendicular (cosine {x @ y:.3g})")
        y = y - (x @ y) * x
        y /= np.linalg.norm(y)
        return np.array([x, y, np.cross(x, y)])

    def to_face(self, points: np.ndarray) -> np.ndarray:
        """Coordinates of the face [m], shape (n, 3), of foreign `points`, shape (n, 2) or (n,
        3).
        """
        return self.metres * (three_columns(points) - three_columns([self.origin])) @ self.matrix.T

    def to_foreign(self, points: np.ndarray) -> np.ndarray:
        """Foreign coordinates, shape (n, 3), of `points` of the face [m], shape (n, 2) or (n,
        3).
        """
        return three_columns(points) @ self.matrix / self.metres + three_columns([self.origin])


def three_columns(points: np.ndarray) -> np.ndarray:
    """Points with a third coordinate, 0 where they have two; shape (n, 3)."""
    points = np.asarray(points, float)
    if points.ndim != 2 or points.shape[1] not in (2, 3):
        raise SurfaceError(
            f"points: an array of shape (n, 2) or (n, 3) is needed, not {points.shape}"
        )
    if not np.isfinite(points).all():
        row = int(np.flatnonzero(~np.isfinite(points).all(axis=1))[0])
        raise SurfaceError(f"points: point {row} is {points[row]}, which is no place")
    if points.shape[1] == 3:
        return points
    return np.column_stack([points, np.zeros(len(points))])
