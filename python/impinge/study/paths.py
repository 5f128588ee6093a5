"""Paths of a nozzle that lay a strand where it is wanted."""

from __future__ import annotations

import hashlib
import json
import logging
import os
from collections.abc import Sequence
from concurrent.futures import ProcessPoolExecutor
from dataclasses import asdict, dataclass
from multiprocessing import get_context
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr
from tqdm import tqdm

from impinge import gcode
from impinge.errors import StudyError
from impinge.unit import open_package
from impinge.unit.build import build

from .corrections import Line, Waypoints, nozzle
from .identity import hash_of_unit
from .journal import Finished, Journal
from .optimisers import SEARCHES, Outcome
from .printing import Job, Print, Printer
from .scenes import Scene

_LOGGER = logging.getLogger("impinge")
# Largest deviation over the best objective, both in diameters, from which on a run is given up: it
# cannot be the best one. Gauss-Newton needs distances all along, of runs that differ little.
_GIVE_UP = 1.0
_GIVE_UP_OF = {"gauss-newton": 2.0}

# In diameters of the nozzle, by the scene: lengths of segments and distances of particles where
# `spacing` is left out, and the largest ones; lengths of a strand of particles between centroids.
_DEFAULT = {"line": 0.5, "particles": 0.125}
_LARGEST = {"line": 10.0, "particles": 0.25}
_SLICE = 0.5
_SAME = 1e-9  # m, along either axis: places that are no farther apart are one


@dataclass(frozen=True)
class FoundPath:
    """The best path that was found, and what the target itself as a path lays.

    places [m], times [s] and flow [m³/s] are the motion of the nozzle at `height` [m]; `along` are
    places along the target. `waypoints` are parts of its length and offsets along its normal [m].
    history: a row for each simulation: objective, best so far of whole runs with the same factor
    and run-out, share of the steps that were taken, and the factor by which its segments, or
    distances of particles, are coarser.
    """

    places: np.ndarray
    along: np.ndarray
    times: np.ndarray
    flow: float
    height: float
    waypoints: tuple[tuple[float, float], ...]
    naive: Print
    best: Print
    diameter: float
    history: xr.Dataset

    @property
    def ratio(self) -> float:
        """Objective of the target as a path over that of the best one."""
        return self.naive.objective(self.diameter) / self.best.objective(self.diameter)

    @property
    def simulations(self) -> int:
        return self.history.sizes["simulation"]

    def table(self) -> dict[str, list[float]]:
        """The path as the value of the key `path` of a filament, with its flow."""
        return {
            "time": self.times.tolist(),
            "x": self.places[:, 0].tolist(),
            "y": self.places[:, 1].tolist(),
            "z": [self.height] * len(self.times),
            "flow": [self.flow] * len(self.times),
        }

    def write_gcode(self, file: str | os.PathLike[str], **settings: Any) -> None:
        """Writes the path as G-code; settings are those of `impinge.gcode.write`."""
        heights = np.full(len(self.places), self.height)
        volumes = np.diff(self.times, prepend=0.0) * self.flow
        gcode.write(file, np.c_[self.places, heights], self.times, volumes, **settings)


def path(
    scene: str | os.PathLike[str],
    target: str | Sequence[Sequence[float]] | None = None,
    *,
    by: str = "gauss-newton",
    speed: float,
    flow: float | None = None,
    waypoints: int | Sequence[tuple[tuple[float, float], tuple[float, float]]] = 3,
    region: tuple[float, float] = (0.0, 1.0),
    spacing: float | None = None,
    run_out: float | None = None,
    simulations: int = 200,
    size: int | None = None,
    spread: float = 0.25,
    coarse: float = 2.0,
    seed: int = 0,
    processes: int = 1,
    folder: str | os.PathLike[str] | None = None,
    progress: bool | None = None,
) -> FoundPath:
    """Moves waypoints of a nozzle's path until the strand lies on a target.

    scene: of a filament with `path = "input"`, or the unit of one.
    target: the filament whose `[[target]]` is meant (the only one if left out), or places [x, y]
        that take its place.
    by: "gauss-newton", which takes the fewest runs, "cma" (needs the extra `path`), which goes on
        where that ends in a minimum nearby, or "swarm" (Clerc and Kennedy).
    speed: of the nozzle along its path [m/s]. flow [m³/s]: the scene's `nozzle.flow` if left out.
    waypoints: how many, or of each the range of its part s of the target's length and that of its
        offset along the normal to the left [m]. Between waypoints offsets are cubic and do not
        overshoot; outside of `region`, a range of s, the nozzle follows the target. A region that
        is little longer than the bends, with two or three waypoints for each, is found best.
    spacing: of the places to which the nozzle moves evenly [m]; the segment length if left out,
        half the nozzle's diameter for particles.
    run_out: how far the nozzle goes on beyond the target's end [m]; by the lag if left out.
    simulations: how many runs there are at most. size: of a swarm or generation. spread: of the
        first one, in parts of the ranges. seed: of its random numbers.
    coarse: half of the runs have segments, or distances of particles, and steps that are longer by
        this factor, as far as the scene's limit of `spacing` allows; 1 for none.
    processes: how many work at a time. folder: keeps finished runs, which are not repeated.
    progress: whether a bar is shown; only in terminals if left out.

    Minimises the mean and largest distance of the strand's centre line from the target and the
    length of the target that it does not cover, in diameters of the nozzle. Of a run only what
    follows the first place that differs from the target is computed. Runs whose largest distance
    exceeds the best objective, for Gauss-Newton twice that, are given up.
    """
    if by not in SEARCHES:
        raise ValueError(f"by = {by!r} (allowed: {', '.join(map(repr, SEARCHES))})")
    _check_positive(speed=speed, flow=flow, spacing=spacing, spread=spread)
    _check_least(1.0, coarse=coarse)
    _check_least(0.0, run_out=run_out)
    _check_whole(3, simulations=simulations)
    _check_whole(2, size=size)
    _check_whole(1, processes=processes)
    _check_whole(0, seed=seed)
    study = _Study(scene, target, speed, flow, spacing)
    ranges = _ranges(waypoints, region, study.diameter)
    journal = Journal(Path(folder)) if folder is not None else None
    bar = tqdm(
        total=simulations,
        unit="run",
        desc=study.filament,
        disable=None if progress is None else not progress,
    )
    try:
        naive = ranges.naive()
        record = _Record(study, ranges, journal, processes, bar)
        start = naive
        settings = {"size": size or 4 + int(3 * np.log(ranges.count)), "seed": seed}
        stages = [(1.0, simulations)]
        coarse = study.coarser(coarse)
        if coarse > 1.0:
            stages.insert(0, (coarse, simulations // 2))
        for factor, until in stages:
            with record.at(factor, run_out):
                search = SEARCHES[by](start, spread=spread, **settings)
                start = record.follow(search, until, _GIVE_UP_OF.get(by, _GIVE_UP))
            spread = 0.4 * spread
        return record.found(start)
    finally:
        bar.close()
        if journal:
            journal.close()


def _check_positive(**numbers: float | None) -> None:
    for name, number in numbers.items():
        if number is not None and not (_is_number(number) and number > 0.0):
            raise ValueError(f"{name} = {number!r} (allowed: numbers above 0)")


def _check_least(least: float, **numbers: float | None) -> None:
    for name, number in numbers.items():
        if number is not None and not (_is_number(number) and number >= least):
            raise ValueError(f"{name} = {number!r} (allowed: {least:g} or more)")


_MOST = 10_000  # of whole numbers: waypoints, members of a generation, simulations, processes


def _check_whole(least: int, **numbers: int | None) -> None:
    for name, number in numbers.items():
        is_whole = isinstance(number, int | np.integer) and not isinstance(number, bool)
        most = _MOST if name != "seed" else 2**32 - 1
        if number is not None and not (is_whole and least <= number <= most):
            raise ValueError(
                f"{name} = {number!r} (allowed: whole numbers, {least} or more, to {most})"
            )


def _is_number(value: Any) -> bool:
    is_real = isinstance(value, int | float | np.number) and not isinstance(value, bool)
    return is_real and bool(np.isfinite(value))


def _ranges(waypoints: Any, region: tuple[float, float], diameter: float) -> Waypoints:
    if len(region) != 2 or not all(map(_is_number, region)):
        raise ValueError(f"region = {region} (allowed: two parts of the target's length)")
    low, high = region
    if not 0.0 <= low < high <= 1.0:
        raise ValueError(f"region = {region} (allowed: 0 <= low < high <= 1)")
    if isinstance(waypoints, int | float):
        if waypoints != 0:
            _check_whole(1, waypoints=waypoints)
        edges = np.linspace(low, high, waypoints + 1)
        reach = 3.0 * diameter
        waypoints = [((a, b), (-reach, reach)) for a, b in zip(edges, edges[1:], strict=False)]
    if not waypoints:
        raise ValueError("no waypoints (allowed: one or more)")
    for each in waypoints:
        if len(each) != 2 or any(len(one) != 2 for one in each):
            raise ValueError(f"waypoint {each} (allowed: ranges of a part and of an offset)")
        part, offset = each
        if not (low <= part[0] <= part[1] <= high and offset[0] < offset[1]):
            message = f"waypoint {part}, {offset} (allowed: parts within {region}, low < high)"
            raise ValueError(message)
    parts, offsets = zip(*waypoints, strict=True)
    return Waypoints(tuple(map(tuple, parts)), tuple(map(tuple, offsets)), (low, high))


def _places_of(target: Any) -> list[list[float]]:
    """The places of a target that stands for the scene's: two or more, apart."""
    places = np.asarray(target, float)
    is_list = places.ndim == 2 and places.shape[1] == 2 and len(places) >= 2
    if not (is_list and np.all(np.abs(places) < 1e3) and np.ptp(places, axis=0).max() > _SAME):
        raise ValueError(
            f"target = {target!r} (allowed: two or more places [x, y] in metres, apart)"
        )
    repeated = np.flatnonzero(np.abs(np.diff(places, axis=0)).max(axis=1) <= _SAME)
    if len(repeated):
        n = int(repeated[0])
        raise ValueError(
            f"target[{n + 1}] = {places[n + 1].tolist()} repeats target[{n}] (allowed: places"
            f" more than {_SAME:g} m from the one before)"
        )
    return places.tolist()


class _Study:
    """The scene with its filament, target and motion."""

    def __init__(self, scene: Any, target: Any, speed: float, flow: float | None, spacing: Any):
        self.source = Path(scene)
        package = open_package(self.source)
        is_text = self.source.suffix == ".toml"
        self.scene = Scene(self.source if is_text else package.folder / "resources/scene.toml", 2)
        content = self.scene.content
        targets = content.get("target", [])
        names = [name for name, body in content["body"].items() if body.get("kind") == "filament"]
        name = target if isinstance(target, str) else None
        if name is None and len(names) == 1:
            name = names[0]
        if name not in names:
            raise StudyError(f"{scene}: no filament {name or ''} (allowed: {', '.join(names)})")
        self.filament = name
        places = [i for i, one in enumerate(targets) if one.get("of") == name]
        if not places:
            raise StudyError(f"{scene}: `{name}` has no [[target]] (allowed: a scene with one)")
        self.changes: dict[str, Any] = {}
        line = targets[places[0]]["line"]
        if any(isinstance(number, str) for place in line for number in place):
            raise StudyError(f"{scene}: target.line = {line} (allowed: numbers in metres)")
        if target is not None and not isinstance(target, str):
            line = _places_of(target)
            self.changes[f"target.{places[0]}.line"] = line
        body = content["body"][name]
        if body.get("path") != "input":
            raise StudyError(f'{scene}: the path of `{name}` is set (allowed: path = "input")')
        variables = package.description.modelVariables
        start = {v.name: v.start for v in variables if v.start is not None}
        self.height = float(start[f"{name}.nozzle_z"])
        self.diameter = float(start[f"{name}.nozzle_diameter"])
        self.flow = float(start[f"{name}.flow"]) if flow is None else flow
        method = body.get("method", "line")
        resolution = body.get("spacing", _DEFAULT[method] * self.diameter)
        if isinstance(resolution, str):
            given = f"spacing = {resolution!r}"
            raise StudyError(f"{scene}: {given} (allowed: a number in m)")
        self.resolution = float(resolution)  # of segments or particles
        self.coarsest = _LARGEST[method] * self.diameter
        if method == "particles":
            self.coarsest = min(self.coarsest, self.height)
        length = _SLICE * self.diameter if method == "particles" else self.resolution
        self.spacing = length if spacing is None else spacing
        _check_positive(flow=self.flow)
        self.speed = speed
        self.line = Line(line)
        pieces = self.line.length / self.spacing
        if not 1e-3 <= pieces <= 1e6:
            allowed = f"a part of the target's {self.line.length:g} m"
            raise ValueError(f"spacing = {self.spacing!r} (allowed: {allowed})")

    def coarser(self, factor: float) -> float:
        """The factor by which `spacing` may grow, at most the one that is asked for."""
        # A scene at its limit has no coarser runs, whichever way that is rounded.
        return float(max(1.0, min(factor, (1.0 - 1e-12) * self.coarsest / self.resolution)))

    def job(self, factor: float) -> Job:
        """The runs of segments, or of distances of particles, that are longer by a factor."""
        changes = dict(self.changes)
        if factor != 1.0:
            changes[f"body.{self.filament}.spacing"] = factor * self.resolution
        text = self.scene.changed(changes) if changes else None
        unit = build(self.scene.path, text=text) if text else self.source
        target = tuple(map(tuple, self.line.places.tolist()))
        samples = int(np.clip(np.ceil(self.line.length / (factor * self.spacing)), 20, 400))
        motion = (self.diameter, self.height, self.speed, self.flow)
        return Job(str(open_package(unit).folder), self.filament, target, *motion, samples)


class _Record:
    """Runs of all stages, from the journal where it has them."""

    def __init__(
        self,
        study: _Study,
        ranges: Waypoints,
        journal: Journal | None,
        processes: int,
        bar: tqdm,
    ):
        self.bar = bar
        self.study, self.ranges, self.journal, self.processes = study, ranges, journal, processes
        # objective, best, share of steps, factor
        self.rows: list[tuple[float, float, float, float]] = []
        self.factor = 1.0
        self.naive: Print | None = None
        self.best: tuple[float, np.ndarray, Print] | None = None
        self.least = np.inf  # objective of whole runs that may be compared

    def at(self, factor: float, run_out: float | None) -> _Record:
        self.factor = factor
        self._run_out = run_out
        return self

    def __enter__(self) -> None:
        self.job = self.study.job(self.factor)
        unit = hash_of_unit(Path(self.job.folder))
        told = {key: value for key, value in asdict(self.job).items() if key != "folder"}
        self.key = hashlib.sha256((unit + json.dumps(told, sort_keys=True)).encode()).hexdigest()
        self.best = None
        self.least = np.inf
        self.run_out = 0.0
        naive = self.ranges.naive()
        self.workers = _Workers(self.job, self.processes)
        if self._run_out is None:
            (first,) = self._runs([self._places(naive)], np.inf)
            self.run_out = first.lag
            self.least = np.inf
        else:
            self.run_out = self._run_out
        places = self._places(naive)
        self.workers.begin_with(places)
        (self.naive,) = self._runs([places], np.inf)
        self.best = (self.naive.objective(self.job.diameter), naive, self.naive)

    def __exit__(self, *_: object) -> None:
        self.workers.close()

    def follow(self, search: Any, until: int, patience: float) -> np.ndarray:
        """Sends a search its outcomes until it ends or the runs are used up; returns the best.

        patience: largest deviation over the best objective, from which on a run is given up.
        """
        assert self.best
        asked = next(search)
        while len(self.rows) < until:
            asked = asked[: until - len(self.rows)]
            give_up = patience * self.best[0] * self.job.diameter
            prints = self._runs([self._places(one) for one in asked], give_up)
            outcomes = []
            for unknowns, one in zip(asked, prints, strict=True):
                objective = one.objective(self.job.diameter)
                outcomes.append(Outcome(objective, one.distances))
                if one.part == 1.0 and objective < self.best[0]:
                    self.best = (objective, np.array(unknowns), one)
            if len(self.rows) >= until:
                break
            try:
                asked = search.send(outcomes)
            except StopIteration:
                break
        return self.best[1]

    def found(self, unknowns: np.ndarray) -> FoundPath:
        assert self.best and self.naive
        places = self._places(unknowns)
        steps = np.hypot(*np.diff(places, axis=0).T)
        parts, offsets = self.ranges.values(unknowns)
        objective, best, share, factor = np.array(self.rows).T
        history = xr.Dataset(
            {
                "objective": ("simulation", objective),
                "best": ("simulation", best),
                "share_of_steps": ("simulation", share),
                "factor": ("simulation", factor),
            }
        )
        return FoundPath(
            places,
            self._places(self.ranges.naive()),
            np.r_[0.0, np.cumsum(steps)] / self.job.speed,
            self.job.flow,
            self.job.height,
            tuple(zip(parts.tolist(), offsets.tolist(), strict=True)),
            self.naive,
            self.best[2],
            self.job.diameter,
            history,
        )

    def _places(self, unknowns: np.ndarray) -> np.ndarray:
        spacing = self.factor * self.study.spacing
        return nozzle(self.study.line, self.ranges, unknowns, spacing, self.run_out)

    def _runs(self, paths: list[np.ndarray], give_up: float) -> list[Print]:
        keys = [self._key_of(places, give_up) for places in paths]
        known = self.journal.rows if self.journal else {}
        missing = [n for n, key in enumerate(keys) if key not in known]
        ran = self.workers.run([paths[n] for n in missing], give_up)
        new = dict(zip(missing, ran, strict=True))
        if self.journal:
            values = {n: [one.numbers(), one.distances] for n, one in new.items()}
            self.journal.append([(keys[n], Finished(values[n])) for n in missing])
        prints = []
        for n, key in enumerate(keys):
            one = new[n] if n in new else Print.of(*known[key].values)
            prints.append(one)
            objective = one.objective(self.job.diameter)
            if one.part == 1.0:
                self.least = min(self.least, objective)
            share = one.steps / (len(paths[n]) - 1)
            self.rows.append((objective, self.least, share, self.factor))
            self.bar.set_postfix_str(f"objective {self.least:.3g}", refresh=False)
            self.bar.update()
            told = (len(self.rows), objective, self.least)
            _LOGGER.info("run %d: objective %.4g, best %.4g", *told)
        return prints

    def _key_of(self, places: np.ndarray, give_up: float) -> str:
        said = self.key.encode() + np.asarray(places, "<f8").tobytes() + repr(give_up).encode()
        return hashlib.sha256(said).hexdigest()[:32]


class _Workers:
    """Printers: one here, or one in each of several processes."""

    def __init__(self, job: Job, processes: int):
        self.job, self.processes = job, processes
        self.trunk: np.ndarray | None = None
        self.here: Printer | None = None
        self.pool: ProcessPoolExecutor | None = None

    def begin_with(self, places: np.ndarray) -> None:
        """The path from which others branch off."""
        self.trunk = places

    def run(self, paths: list[np.ndarray], give_up: float) -> list[Print]:
        if not paths:
            return []
        if self.processes == 1 or len(paths) == 1:
            if self.here is None:
                self.here = Printer(self.job)
            return [_run(self.here, self.trunk, places, give_up) for places in paths]
        if self.pool is None:
            setting = (self.job, self.trunk)
            context = get_context("spawn")
            self.pool = ProcessPoolExecutor(self.processes, context, _begin, setting)
        return list(self.pool.map(_run_there, paths, [give_up] * len(paths)))

    def close(self) -> None:
        if self.here:
            self.here.close()
        if self.pool:
            self.pool.shutdown()


def _run(printer: Printer, trunk: np.ndarray | None, places: np.ndarray, give_up: float) -> Print:
    if trunk is not None and not printer.has(trunk):
        kept = printer.run(trunk, keep=True)
        if np.array_equal(trunk, places):
            return kept
    return printer.run(places, give_up)


_THERE: tuple[Printer, np.ndarray | None] | None = None


def _begin(job: Job, trunk: np.ndarray | None) -> None:
    global _THERE
    _THERE = (Printer(job), trunk)


def _run_there(places: np.ndarray, give_up: float) -> Print:
    assert _THERE
    return _run(*_THERE, places, give_up)
