"""Paths of a nozzle beside a line: places moved along the normal by a smooth course of offsets."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.interpolate import PchipInterpolator

_APART = 1e-3  # least distance of waypoints, in parts of the line


class Line:
    """A line of straight parts, by the part s of its length, from 0 to 1."""

    def __init__(self, places: Sequence[Sequence[float]]):
        self.places = np.asarray(places, float)
        steps = np.diff(self.places, axis=0)
        lengths = np.hypot(*steps.T)
        self.along = steps / lengths[:, None]
        self.ends = np.r_[0.0, np.cumsum(lengths)]
        self.length = float(self.ends[-1])

    def part(self, way: np.ndarray) -> np.ndarray:
        """The straight part at each length along the line [m]."""
        return np.clip(np.searchsorted(self.ends, way, "right") - 1, 0, len(self.along) - 1)

    def at(self, way: np.ndarray) -> np.ndarray:
        """Places at lengths along the line [m]; the last part goes on beyond its end."""
        part = self.part(way)
        return self.places[part] + (way - self.ends[part])[:, None] * self.along[part]

    def beside(self, places: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Length along the line at which each place is nearest, and its distance to the left."""
        starts, lengths = self.places[:-1], np.diff(self.ends)
        from_start = places[:, None, :] - starts[None, :, :]
        reached = np.clip(np.einsum("npk,pk->np", from_start, self.along), 0.0, lengths)
        apart = from_start - reached[..., None] * self.along
        nearest = np.argmin(np.einsum("npk,npk->np", apart, apart), axis=1)
        rows = np.arange(len(places))
        apart, along = apart[rows, nearest], self.along[nearest]
        turned = along[:, 0] * apart[:, 1] - along[:, 1] * apart[:, 0]
        distance = np.copysign(np.hypot(*apart.T), turned)
        return self.ends[nearest] + reached[rows, nearest], distance


@dataclass(frozen=True)
class Waypoints:
    """Ranges of waypoints: parts s of the line's length, and offsets along its normal [m].

    The path leaves the line at `region[0]` and is back on it at `region[1]`.
    """

    parts: tuple[tuple[float, float], ...]
    offsets: tuple[tuple[float, float], ...]
    region: tuple[float, float]

    @property
    def count(self) -> int:
        """Number of unknowns: two of each waypoint."""
        return 2 * len(self.parts)

    def naive(self) -> np.ndarray:
        """Unknowns, each from 0 to 1 over its range, of the path that is the line itself."""
        middle = np.full(len(self.parts), 0.5)
        none = [np.clip(-low / (high - low), 0.0, 1.0) for low, high in self.offsets]
        return np.r_[middle, none]

    def values(self, unknowns: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Parts and offsets of the waypoints, in the order of the parts."""
        ranges = np.array([*self.parts, *self.offsets])
        values = ranges[:, 0] + np.clip(unknowns, 0.0, 1.0) * np.diff(ranges, axis=1)[:, 0]
        parts, offsets = np.split(values, 2)
        order = np.argsort(parts, kind="stable")
        return parts[order], offsets[order]


def nozzle(
    line: Line, waypoints: Waypoints, unknowns: np.ndarray, spacing: float, run_out: float
) -> np.ndarray:
    """Places of the nozzle, `spacing` apart along its path, to `run_out` beyond the line's end [m].

    Offsets are cubic between the waypoints and do not overshoot them (PCHIP). At a corner of the
    line the path goes straight from one normal to the other.
    """
    parts, offsets = waypoints.values(unknowns)
    begin, end = waypoints.region
    knots = np.r_[begin, parts, end]
    for n in range(1, len(knots)):
        knots[n] = max(knots[n], knots[n - 1] + _APART)
    course = PchipInterpolator(knots, np.r_[0.0, offsets, 0.0])
    even = np.arange(0.0, line.length, 0.25 * spacing)
    corners = line.ends[1:-1]
    # Twice at a corner, with the normal of either side.
    way = np.sort(np.r_[even, corners, corners, line.length])
    part = line.part(way)
    first_of_two = np.r_[way[:-1] == way[1:], False]
    part = np.where(first_of_two, np.maximum(part - 1, 0), part)
    along = line.along[part]
    s = np.clip(way / line.length, knots[0], knots[-1])
    aside = course(s)[:, None] * np.c_[-along[:, 1], along[:, 0]]
    path = line.at(way) + aside
    if run_out > 0.0:
        path = np.vstack([path, line.at(np.array([line.length + run_out]))])
    return resampled(path, spacing)


def resampled(path: np.ndarray, spacing: float) -> np.ndarray:
    """Places at equal distances along a path, and its last one."""
    steps = np.hypot(*np.diff(path, axis=0).T)
    keep = np.r_[True, steps > 0.0]
    path, steps = path[keep], steps[steps > 0.0]
    way = np.r_[0.0, np.cumsum(steps)]
    at = np.arange(0.0, way[-1] - 1e-6 * spacing, spacing)
    at = np.r_[at, way[-1]]
    return np.c_[np.interp(at, way, path[:, 0]), np.interp(at, way, path[:, 1])]
