"""Paths of nozzles as G-code, and the path of a scene in it."""

from __future__ import annotations

import os
from math import floor, log10
from pathlib import Path

import numpy as np

_DIGITS = 7  # that a length, time or speed has at least
_DECIMALS = 6  # of mm, ms and mm/min, at least
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

    places: x, y and z of each [m]. times: when the nozzle is there, ascending [s], from 0 on; at
    the first place it waits until then. volumes: what comes on the way to each [m³], of which the
    first has none. A move without volume is a G0. origin: place on the plate that is X0 Y0 [m].
    The key `path = { file = … }` of a filament reads it.
    """
    places, times, volumes = (np.asarray(of, float) for of in (places, times, volumes))
    count = len(places)
    if places.shape != (count, 3) or times.shape != (count,) or volumes.shape != (count,):
        shapes = f"{places.shape}, {times.shape}, {volumes.shape}"
        raise ValueError(f"places, times and volumes of shapes {shapes} (allowed: n × 3, n, n)")
    if count < 2 or np.any(np.diff(times) <= 0.0):
        raise ValueError("times do not ascend (allowed: two or more, each later than the last)")
    if times[0] < 0.0:
        raise ValueError(f"times begin at {times[0]:g} s (allowed: 0 s and later)")
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
    feeds = np.diff(fed)
    decimals = max(_decimals(feeds[feeds > 0.0].min(initial=1.0)), _DECIMALS + 1)
    lines = [_HEAD.format(title=title), "G0 X{:.6f} Y{:.6f} Z{:.6f}\n".format(*shown[0])]
    if times[0] > 0.0:
        lines.append(_wait(times[0]))
    for n in range(1, count):
        duration = times[n] - times[n - 1]
        length = float(np.linalg.norm(shown[n] - shown[n - 1]))
        if length == 0.0 and feeds[n - 1] == 0.0:
            lines.append(_wait(duration))
            continue
        # A nozzle at rest feeds at the speed of the filament.
        way = length if length > 0.0 else feeds[n - 1]
        speed = 60.0 * way / duration
        end = "X{:.6f} Y{:.6f} Z{:.6f}".format(*shown[n])
        code, feed = ("G1", f" E{fed[n]:.{decimals}f}") if volumes[n] > 0.0 else ("G0", "")
        lines.append(f"{code} {end}{feed} F{speed:.{_decimals(speed)}f}\n")
    Path(file).write_text("".join(lines))


def _wait(duration: float) -> str:
    milliseconds = 1e3 * duration
    return f"G4 P{milliseconds:.{_decimals(milliseconds)}f}\n"


def _decimals(value: float) -> int:
    """Decimals that show a number above zero to its digits; G-code has no exponents."""
    return max(_DECIMALS, _DIGITS - 1 - floor(log10(value)))
