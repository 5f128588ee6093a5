"""Drops of a pattern as releases on demand of a droplet's unit."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from ..surface import Placement, Series, SurfaceError
from ..surface.csv_files import read_table

# Columns beside x, y and time that become inputs of the same names
MORE = ("speed", "temperature", "angle", "direction")


def drop_inputs(
    path: str | Path, name: str, placement: Placement | None = None
) -> dict[str, Series]:
    """Inputs ``NAME.release``, ``NAME.x``, ``NAME.y`` and what else a table tells of its drops,
    held from the time of one drop to that of the next: ``NAME.release`` counts them.

    For bodies with ``release = "input"``. Of their inputs, columns x, y and time [s] are needed;
    speed [m/s], temperature [K], angle and direction [rad] may stand beside. Places are turned and
    scaled by the placement, directions turned by it, too.

    Raises
    ------
    SurfaceError
        With file and drop, if two fall at one time, which inputs cannot tell apart.
    """
    path = Path(path)
    place = placement or Placement()
    names, rows = read_table(path, place.metres)
    missing = [column for column in ("x", "y", "time") if column not in names]
    if missing:
        raise SurfaceError(
            f"{path}: no column {' and '.join(missing)}; there are {', '.join(names)}"
        )
    if not len(rows):
        raise SurfaceError(f"{path}: has no drops")
    order = np.argsort(rows[:, names.index("time")], kind="stable")
    columns = dict(zip(names, rows[order].T, strict=True))
    times = columns["time"]
    if times[0] < 0:
        raise SurfaceError(f"{path}: drop {order[0] + 1}: column time: {times[0]} s is below 0")
    twice = np.flatnonzero(np.diff(times) <= 0)
    if len(twice):
        a, b = order[twice[0]] + 1, order[twice[0] + 1] + 1
        raise SurfaceError(
            f"{path}: drops {a} and {b} both fall at {times[twice[0]]} s; inputs "
            "release one at a time"
        )
    faced = place.to_face(np.column_stack([columns["x"], columns["y"], np.zeros(len(times))]))
    inputs = {"release": np.arange(1.0, len(times) + 1), "x": faced[:, 0], "y": faced[:, 1]}
    inputs |= {column: columns[column] for column in MORE if column in columns}
    if "direction" in inputs:
        along = np.column_stack([np.cos(inputs["direction"]), np.sin(inputs["direction"])])
        turned = np.column_stack([along, np.zeros(len(times))]) @ place.matrix.T
        inputs["direction"] = np.arctan2(turned[:, 1], turned[:, 0])
    if times[0] > 0:  # none before the first: its own values wait there
        times = np.append(0.0, times)
        inputs = {key: np.append(values[0], values) for key, values in inputs.items()}
        inputs["release"][0] = 0.0
    return {f"{name}.{key}": Series(times, values) for key, values in inputs.items()}
