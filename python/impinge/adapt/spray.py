"""Patterns of drops, with their places and amounts, on the cells of a unit."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from ..surface import Placement, Series, Surface, SurfaceError
from ..surface.csv_files import read_table
from ..surface.maps import NOTHING

# Drops times windows, at most: their amounts take eight bytes each
_MOST_AMOUNTS = 5e8


def spray_frames(
    path: str | Path,
    target: Surface,
    *,
    amount: str = "mass",
    factor: float = 1.0,
    window: float | None = None,
    placement: Placement | None = None,
    outside: str = "error",
) -> tuple[Series, dict[str, float]]:
    """Mean fluxes on the cells of `target` over windows of time, whose integral is what the drops
    bring.

    ``q_i = f Σ m / (A_i Δt)`` over the drops that fall on cell i in a window of length Δt, of which
    one begins at time 0; the last frame is zero, at the end of the last window, and so is one at
    time 0 where the first drop falls later.

    Parameters
    ----------
    path
        A table with columns x, y, `amount` and, unless all fall in one window, time [s].
    amount
        The column that is summed: mass [kg], heat [J], momentum [N s].
    factor
        f, as heat per mass c ΔT [J/kg], of which heat flux [W/m2] follows.
    window
        Δt [s].

    Returns
    -------
    tuple
        The series, held over each window, and the totals ``brought``, ``given`` and ``lost`` in
        units of the amount times the factor.
    """
    path = Path(path)
    placement = placement or Placement()
    names, rows = read_table(path, placement.metres)
    missing = [name for name in ("x", "y", amount) if name not in names]
    if missing:
        raise SurfaceError(
            f"{path}: no column {' and '.join(missing)}; there are {', '.join(names)}"
        )
    if not window or not window > 0:
        raise SurfaceError(f"window: {window} s is no length of time")
    if not len(rows):
        raise SurfaceError(f"{path}: has no drops")
    columns = dict(zip(names, rows.T, strict=True))
    negative = np.flatnonzero(columns[amount] < 0)
    if len(negative):
        raise SurfaceError(
            f"{path}: drop {negative[0] + 1}: column {amount}: "
            f"{columns[amount][negative[0]]} is below 0"
        )
    times = columns.get("time", np.zeros(len(rows)))
    if times.min() < 0:
        drop = int(np.argmin(times))
        raise SurfaceError(f"{path}: drop {drop + 1}: column time: {times[drop]} s is below 0")
    windows = (times.max() - times.min()) / window
    if not (windows * len(rows) < _MOST_AMOUNTS and times.max() < 2**52 * window):
        raise SurfaceError(
            f"{path}: {len(rows)} drops over {windows:.3g} windows of {window} s (allowed: at most"
            f" {_MOST_AMOUNTS:.0e} for their product)"
        )
    place = np.floor(times / window + 1e-9).astype(int)
    first = place - place.min()
    places = np.column_stack([columns["x"], columns["y"], np.zeros(len(rows))])
    placed = placement.to_face(places)
    placed[:, 2] += target.z
    carry = Surface.points(placed).map_to(target, quantity="extensive", outside=outside)
    amounts = np.zeros((first.max() + 2, len(rows)))
    amounts[first, np.arange(len(rows))] = factor * columns[amount]
    given = carry(amounts)
    begin = window * (place.min() + np.arange(len(amounts)))
    total = {"brought": float(amounts.sum()), "given": float(given.sum()) * target.depth}
    lost = total["brought"] - total["given"]
    total["lost"] = lost if abs(lost) > NOTHING * abs(total["brought"]) else 0.0
    flux = given / target.areas / window
    if begin[0] > 0:  # nothing falls before
        begin, flux = np.append(0.0, begin), np.concatenate([np.zeros_like(flux[:1]), flux])
    return Series(begin, flux), total
