"""Arrays that files bring, looked at before they become surfaces."""

from __future__ import annotations

from typing import Any

import numpy as np

from .errors import SurfaceError, need

# Bytes of all datasets of an HDF5 file, at most
LARGEST_HDF5 = 1 << 34


def check_points(points: Any) -> np.ndarray:
    """Returns points as numbers, shape (n, 2 or 3); refuses none and what is not finite."""
    points = _numbers("points", points)
    if points.ndim != 2 or points.shape[1] not in (2, 3) or not len(points):
        raise SurfaceError(f"points of shape {points.shape} (allowed: (n, 2) and (n, 3))")
    bad = np.flatnonzero(~np.isfinite(points).all(axis=1))
    if len(bad):
        place = ", ".join(str(x) for x in points[bad[0]])
        raise SurfaceError(f"point {bad[0]} at ({place}) is not finite")
    return points


def check_corners(cells: Any, points: int) -> np.ndarray:
    """Returns the corners of cells, shape (m, 3 or 4); refuses what is no number of a point."""
    cells = np.asarray(cells)
    if cells.ndim != 2 or cells.shape[1] not in (3, 4) or cells.dtype.kind not in "iu":
        what = f"{cells.dtype} of shape {cells.shape}"
        raise SurfaceError(f"cells are {what} (allowed: whole numbers of shape (m, 3 or 4))")
    bad = np.flatnonzero(((cells < 0) | (cells >= points)).any(axis=1))
    if len(bad):
        corners = ", ".join(str(corner) for corner in cells[bad[0]])
        raise SurfaceError(f"cell {bad[0]} has the corners {corners} (allowed: 0 to {points - 1})")
    return cells.astype(np.int64)


def check_fields(fields: dict[str, Any], many: int, places: str) -> dict[str, np.ndarray]:
    """Returns fields as numbers; refuses those of another length than there are places."""
    checked = {}
    for name, field in fields.items():
        values = _numbers(f"`{name}`", field)
        if values.ndim == 0 or len(values) != many:
            raise SurfaceError(f"`{name}` of shape {values.shape} for {many} {places}")
        checked[name] = values
    return checked


def check_finite(fields: dict[str, np.ndarray]) -> None:
    """Refuses fields with a value that is not finite."""
    for name, values in fields.items():
        bad = np.argwhere(~np.isfinite(values))
        if len(bad):
            raise SurfaceError(f"`{name}` is {values[tuple(bad[0])]} at place {bad[0][0]}")


def read_datasets(file: Any) -> dict[str, np.ndarray]:
    """Returns the datasets of an open HDF5 file by name; follows no links to other files."""
    h5py = need("h5py")
    found: dict[str, np.ndarray] = {}
    total = 0
    for name in file:
        if isinstance(file.get(name, getlink=True), h5py.ExternalLink):
            raise SurfaceError(f"`{name}` is a link to another file (allowed: datasets)")
        item = file[name]
        if not isinstance(item, h5py.Dataset):
            continue
        if item.external or item.is_virtual:
            raise SurfaceError(f"`{name}` lies in another file (allowed: datasets of this one)")
        total += item.nbytes
        if total > LARGEST_HDF5:
            raise SurfaceError(f"{total} bytes of datasets (allowed: at most {LARGEST_HDF5})")
        found[name] = item[()]
    return found


def _numbers(name: str, values: Any) -> np.ndarray:
    values = np.asarray(values)
    if values.dtype.kind not in "fiub":
        raise SurfaceError(f"{name} holds {values.dtype} (allowed: numbers)")
    return values
