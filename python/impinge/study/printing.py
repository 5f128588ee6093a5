"""Runs of a filament along places of its nozzle, from the last saved state that still holds."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from impinge.unit import State, Unit, open_package

from .corrections import Line

_SAVED = 24  # states of the path that others branch off from


@dataclass(frozen=True)
class Job:
    """Data of all runs: the unzipped unit, its filament, and the motion of the nozzle.

    diameter: of the nozzle; height: of its outlet [m]; speed: along its path [m/s]; flow [m³/s];
    samples: number of places along the target at which distances are told.
    """

    folder: str
    filament: str
    target: tuple[tuple[float, float], ...]
    diameter: float
    height: float
    speed: float
    flow: float
    samples: int


@dataclass(frozen=True)
class Print:
    """Strand of a run: deviations and gap [m], lag at the end [m], part of the path that was
    followed, steps that were taken, and distances along the target in diameters."""

    mean: float
    largest: float
    gap: float
    lag: float
    part: float
    steps: int
    distances: np.ndarray = field(repr=False)

    def objective(self, diameter: float) -> float:
        """Mean and largest distance and length of gaps, in diameters. A run that was given up
        counts with its largest distance so far and the part of the path that it left out."""
        if self.part < 1.0:
            return self.largest / diameter + 1.0 - self.part
        return (self.mean + self.largest + self.gap) / diameter

    def numbers(self) -> np.ndarray:
        return np.array([self.mean, self.largest, self.gap, self.lag, self.part, self.steps])

    @classmethod
    def of(cls, numbers: np.ndarray, distances: np.ndarray) -> Print:
        *values, steps = numbers.tolist()
        return cls(*values, int(steps), distances)


class Printer:
    """One instance of the unit, with states along the path from which others branch off."""

    def __init__(self, job: Job):
        self.job = job
        self.line = Line(job.target)
        self.unit = Unit(open_package(Path(job.folder)))
        name = job.filament
        self._write = self.unit.path_writer(
            [f"{name}.nozzle_x", f"{name}.nozzle_y", f"{name}.nozzle_z", f"{name}.flow"], 1
        )
        self._read = self.unit.reader(
            [f"{name}.largest_deviation", f"{name}.touchdown_x", f"{name}.touchdown_y"]
        )
        self._end = self.unit.reader(
            [f"{name}.{key}" for key in ("deviation", "largest_deviation", "gap", "lag")]
        )
        self._start = self.unit.state()
        self._trunk: np.ndarray | None = None
        self._states: list[tuple[int, State, np.ndarray]] = []

    def close(self) -> None:
        self.unit.close()

    def has(self, trunk: np.ndarray) -> bool:
        """Returns true if states of this path are kept."""
        return self._trunk is not None and np.array_equal(self._trunk, trunk)

    def run(self, places: np.ndarray, give_up: float = np.inf, keep: bool = False) -> Print:
        """Follows places, until the largest deviation exceeds `give_up` [m].

        keep: saves states on the way, for paths that begin like this one.
        """
        first, touched = self._branch_off(places)
        if keep:
            self._trunk = places
            self._states = [kept for kept in self._states if kept[0] <= first]
        count = len(places) - 1
        every = max(1, count // _SAVED)
        touches = list(touched)
        done = first
        for n in range(first, count):
            if keep and n > first and n % every == 0:
                self._states.append((n, self.unit.state(), np.array(touches)))
            self._step(places[n], places[n + 1])
            done = n + 1
            largest, x, y = self._read().tolist()
            touches.append((x, y))
            if largest > give_up:
                break
        mean, largest, gap, lag = self._end().tolist()
        distances = self._distances(np.array(touches))
        return Print(mean, largest, gap, lag, done / count, done - first, distances)

    def _branch_off(self, places: np.ndarray) -> tuple[int, np.ndarray]:
        """Restores the last state up to which places are those of the trunk."""
        common = 0
        if self._trunk is not None:
            shorter = min(len(places), len(self._trunk))
            differ = np.any(places[:shorter] != self._trunk[:shorter], axis=1)
            common = int(np.argmax(differ)) if differ.any() else shorter
        # The step from place n - 1 to place n leads to state n.
        known = [kept for kept in self._states if kept[0] < common]
        if not known:
            self.unit.restore(self._start)
            return 0, np.empty((0, 2))
        first, state, touched = known[-1]
        self.unit.restore(state)
        return first, touched

    def _step(self, begin: np.ndarray, end: np.ndarray) -> None:
        """Moves evenly from one place to the next."""
        duration = float(np.hypot(*(end - begin))) / self.job.speed
        self._write.values[:] = [*begin, self.job.height, self.job.flow]
        self._write.first[:] = [*((end - begin) / duration), 0.0, 0.0]
        self._write()
        self.unit.step(duration)

    def _distances(self, touches: np.ndarray) -> np.ndarray:
        """Distances from the target at equal parts of its length, in diameters."""
        at = (np.arange(self.job.samples) + 0.5) / self.job.samples * self.line.length
        if len(touches) == 0:
            return np.zeros(self.job.samples)
        way, distance = self.line.beside(touches)
        order = np.argsort(way, kind="stable")
        return np.interp(at, way[order], distance[order]) / self.job.diameter
