"""Fields on surfaces of flow computations on the cells of a unit."""

from __future__ import annotations

from pathlib import Path
from typing import Literal

import numpy as np

from ..surface import Placement, Series, Surface, SurfaceError


def cfd_frames(
    path: str | Path,
    target: Surface,
    name: str,
    *,
    kind: Literal["conservative", "consistent"] = "conservative",
    weight: str | None = None,
    values: Literal["cells", "points"] | None = None,
    placement: Placement | None = None,
    outside: Literal["error", "drop", "nearest"] = "error",
    tolerance: float | None = None,
) -> Series:
    """A field of a file on the cells of `target`, over time; see
    :func:`impinge.surface.files.read_series`.

    Of a file with more than the face, the cells are taken that lie at the target's height. Heat
    fluxes and tractions map conservatively, coefficients and temperatures consistently; a face with
    one coefficient and one ambient takes as much heat as the foreign one where its ambient is the
    mean with the coefficient as `weight`, ``∫ h T∞ dA / ∫ h dA``.
    """
    values = values or _location(path, name, placement, target, tolerance)
    surface, series = Surface.read_series(
        path, placement, values=values, face=target.z, tolerance=tolerance
    )
    for field in (name, weight) if weight else (name,):
        _check(path, field, series)
    there = surface.map_to(target, kind, outside=outside, tolerance=tolerance)
    if weight is None:
        return there(series[name])
    if not np.array_equal(series[weight].times, series[name].times):
        raise SurfaceError(f"{path}: `{weight}` and `{name}` have different times")
    weighted = there(series[name].values * series[weight].values)
    return Series(series[name].times, weighted / there(series[weight].values))


def _check(path: str | Path, name: str, series: dict[str, Series]) -> None:
    if name not in series:
        raise SurfaceError(f"{path}: no field `{name}`; there are {', '.join(series) or 'none'}")
    if series[name].values.ndim > 2:
        shape = series[name].values.shape[2:]
        raise SurfaceError(f"{path}: `{name}` has {shape} components a place; a scalar is needed")


def _location(
    path: str | Path,
    name: str,
    placement: Placement | None,
    target: Surface,
    tolerance: float | None,
) -> Literal["cells", "points"]:
    """Where a field stands: in cells, if there is one of that name, else at points."""
    surface, series = Surface.read_series(path, placement, face=target.z, tolerance=tolerance)
    return "cells" if name in series and surface.location == "cells" else "points"
