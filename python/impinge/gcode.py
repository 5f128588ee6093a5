"""Paths of nozzles as G-code, and the path of a scene in it."""

from __future__ import annotations

import os
from pathlib import Path

import numpy as np

_HEAD = """; {title}
G21 ; mm
G90
M82
G92 E0
"""


def write(
    file: str | os.PathLike[str],
    places: np.ndarray,
    times: np.ndarray,
    volumes: np.ndarray,
    *,
    filament_diameter: float = 1.75e-3,
    origin: tuple[float, float] = (0.0, 0.0),
    title: str = "a path of impinge",
) -> None:
    """Writes even moves between places as G-code in mm, with lengths of filament and speeds.

    places: x, y and z of each [m]. times: when the nozzle is there, ascending [s]. volumes: what
    comes on the way to each [m³]. A move without volume is a G0. origin: place on the plate that
    is X0 Y0 [m]. The key `path = { file = … }` of a filament reads it.
    """
    places, times, volumes = (np.asarray(of, float) for of in (places, times, volumes))
    count = len(places)
    if places.shape != (count, 3) or times.shape != (count,) or volumes.shape != (count,):
        shapes = f"{places.shape}, {times.shape}, {volumes.shape}"
        raise ValueError(f"places, times and volumes of shapes {shapes} (allowed: n × 3, n, n)")
    if count < 2 or np.any(np.diff(times) <= 0.0):
        raise ValueError("times do not ascend (allowed: two or more, each later than the last)")
    if np.any(volumes[1:] < 0.0):
        raise ValueError("a volume is negative (allowed: 0 and more)")
    if not all(np.all(np.isfinite(of)) for of in (places, times, volumes, origin)):
        raise ValueError("a place, time or volume is not finite (allowed: finite numbers)")
    if not 0.0 < filament_diameter < 1.0:
        raise ValueError(f"filament_diameter = {filament_diameter} (allowed: above 0, below 1 m)")
    if len(title.splitlines()) > 1:
        raise ValueError(f"title = {title!r} has several lines (allowed: one)")
    section = 0.25 * np.pi * filament_diameter**2
    fed = 1e3 * np.cumsum(np.r_[0.0, volumes[1:]]) / section
    shown = np.round(1e3 * (places - [*origin, 0.0]), 6) + 0.0  # as it is printed, without -0
    lines = [_HEAD.format(title=title), "G0 X{:.6f} Y{:.6f} Z{:.6f}\n".format(*shown[0])]
    for n in range(1, count):
        duration = times[n] - times[n - 1]
        length = float(np.linalg.norm(shown[n] - shown[n - 1]))
        if length == 0.0 and volumes[n] == 0.0:
            lines.append(f"G4 P{1e3 * duration:.6f}\n")
            continue
        # A nozzle at rest feeds at the speed of the filament.
        way = length if length > 0.0 else fed[n] - fed[n - 1]
        speed = 60.0 * way / duration
        end = "X{:.6f} Y{:.6f} Z{:.6f}".format(*shown[n])
        code, feed = ("G1", f" E{fed[n]:.7f}") if volumes[n] > 0.0 else ("G0", "")
        lines.append(f"{code} {end}{feed} F{speed:.6f}\n")
    Path(file).write_text("".join(lines))
