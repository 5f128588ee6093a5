"""Optimisers of a path's unknowns, each from 0 to 1, as generators: they yield unknowns to be tried
and are sent an `Outcome` for each."""

from __future__ import annotations

from collections.abc import Generator
from dataclasses import dataclass

import numpy as np

from impinge import errors

Search = Generator[list[np.ndarray], list["Outcome"], None]

# Constriction of M. Clerc & J. Kennedy 2002 (doi 10.1109/4235.985692).
_INERTIA, _PULL = 0.7298, 1.49618
_DIFFERENCE = 0.02  # of an unknown, for derivatives
_DAMPING = 1e-3  # at the start, over the largest curvature


@dataclass(frozen=True)
class Outcome:
    """The objective of a run, and signed distances along the line in diameters of the nozzle."""

    objective: float
    distances: np.ndarray


def swarm(start: np.ndarray, *, size: int, spread: float, seed: int) -> Search:
    """A swarm of particles with Clerc and Kennedy's constriction; each begins near the start."""
    random = np.random.default_rng(seed)
    places = np.clip(start + spread * random.uniform(-1, 1, (size, len(start))), 0.0, 1.0)
    places[0] = start
    speeds = spread * random.uniform(-1, 1, places.shape)
    own, values = places.copy(), np.full(size, np.inf)
    while True:
        outcomes = yield list(places)
        found = np.array([outcome.objective for outcome in outcomes])
        better = found < values
        own[better], values[better] = places[better], found[better]
        best = own[np.argmin(values)]
        to_own, to_best = _PULL * random.random((2, *places.shape))
        speeds = _INERTIA * speeds + to_own * (own - places) + to_best * (best - places)
        places = places + speeds
        outside = (places < 0.0) | (places > 1.0)
        speeds[outside] = 0.0
        places = np.clip(places, 0.0, 1.0)


def cma(start: np.ndarray, *, size: int, spread: float, seed: int) -> Search:
    """Covariance matrix adaptation (N. Hansen's package `cma`)."""
    try:
        from cma import CMAEvolutionStrategy
    except ModuleNotFoundError:
        raise ImportError(
            f'by = "cma" needs `cma`, which is not installed: {errors.extra("path")} (allowed'
            ' without it: "swarm", "gauss-newton")'
        ) from None
    options = {"bounds": [0.0, 1.0], "seed": seed + 1, "popsize": size, "verbose": -9}
    strategy = CMAEvolutionStrategy(np.clip(start, 0.01, 0.99), spread, options)
    while not strategy.stop():
        unknowns = strategy.ask()
        outcomes = yield unknowns
        strategy.tell(unknowns, [outcome.objective for outcome in outcomes])


def gauss_newton(start: np.ndarray, *, size: int, spread: float, seed: int) -> Search:
    """Least squares of the distances, with derivatives by one more run for each unknown and the
    damping of Levenberg and Marquardt. A step tries `size` dampings at once."""
    del spread, seed
    best = np.clip(start, 0.0, 1.0)
    (outcome,) = yield [best]
    damping = _DAMPING
    while True:
        signs = np.where(best + _DIFFERENCE <= 1.0, 1.0, -1.0)
        beside = [best + _DIFFERENCE * signs[n] * unit for n, unit in enumerate(np.eye(len(best)))]
        outcomes = yield beside
        slopes = [
            (other.distances - outcome.distances) / (_DIFFERENCE * sign)
            for other, sign in zip(outcomes, signs, strict=True)
        ]
        jacobian = np.column_stack(slopes)
        curvature, slope = jacobian.T @ jacobian, jacobian.T @ outcome.distances
        scale = max(np.max(np.diag(curvature)), 1e-30)
        dampings = damping * 10.0 ** np.arange(-1, max(size, 2) - 1)
        tried = [
            np.clip(best - np.linalg.solve(curvature + d * scale * np.eye(len(best)), slope), 0, 1)
            for d in dampings
        ]
        outcomes = yield tried
        n = int(np.argmin([one.objective for one in outcomes]))
        if outcomes[n].objective >= outcome.objective:
            damping *= 10.0 ** max(size, 2)
            if damping > 1e6:
                return
            continue
        best, outcome, damping = tried[n], outcomes[n], float(max(dampings[n], 1e-9))


SEARCHES = {"cma": cma, "swarm": swarm, "gauss-newton": gauss_newton}
