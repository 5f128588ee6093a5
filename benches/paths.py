"""Searches for paths of a nozzle on the three bends of `examples/bend`, with their processor time.

Within `impinge.study.path` all searches have the same objective, the coarse half of the runs, early
stops and runs that branch off from saved states: Gauss-Newton, CMA-ES, the swarm of Clerc and
Kennedy, that of C. Y. Park's thesis (inertia 1, pulls of 2 to the own and to the common best, the
worst tenth drawn anew in each round), and pyswarms. `pyswarms alone` is
what its user writes, `GlobalBestPSO.optimize` with whole runs. Random searches take the median of
several seeds. Each row is a process of its own.
"""

import argparse
import importlib.util
import json
import statistics
import subprocess
import sys
import time
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
from impinge.study import path
from impinge.study.corrections import nozzle
from impinge.study.optimisers import SEARCHES, Search
from impinge.study.paths import _ranges, _Study
from impinge.study.printing import Printer

ROOT = Path(__file__).resolve().parents[1]
SCENE = ROOT / "examples/bend/scene.toml"
WAYPOINTS = 6
SIZE = 10  # of swarms and generations
PULLS = {"c1": 1.49618, "c2": 1.49618, "w": 0.7298}
RANDOM = ["cma", "swarm", "thesis", "pyswarms", "pyswarms alone"]


def bends():
    """The module of the example, with its drawings and regions."""
    spec = importlib.util.spec_from_file_location("bend", SCENE.parent / "run.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def _near(start: np.ndarray, size: int, spread: float, random: np.random.Generator) -> np.ndarray:
    """The first members of a swarm: the start, and others about it."""
    places = np.clip(start + spread * random.uniform(-1, 1, (size, len(start))), 0.0, 1.0)
    places[0] = start
    return places


def thesis(start: np.ndarray, *, size: int, spread: float, seed: int) -> Search:
    """The swarm of C. Y. Park 2019, chapter 3; the thesis leaves its pulls and the number of
    members that are drawn anew open."""
    random = np.random.default_rng(seed)
    places = _near(start, size, spread, random)
    speeds = np.zeros_like(places)
    own, values = places.copy(), np.full(size, np.inf)
    while True:
        outcomes = yield list(places)
        found = np.array([outcome.objective for outcome in outcomes])
        better = found < values
        own[better], values[better] = places[better], found[better]
        to_own, to_best = 2.0 * random.random((2, *places.shape))
        speeds = speeds + to_own * (own - places) + to_best * (own[np.argmin(values)] - places)
        places = np.clip(places + speeds, 0.0, 1.0)
        worst = np.argsort(found)[-max(1, size // 10) :]
        places[worst], speeds[worst] = random.random((len(worst), len(start))), 0.0


def pyswarms(start: np.ndarray, *, size: int, spread: float, seed: int) -> Search:
    """The rounds of `GlobalBestPSO` by the parts that pyswarms offers for loops of one's own."""
    from pyswarms.backend import compute_pbest, create_swarm
    from pyswarms.backend.handlers import BoundaryHandler, VelocityHandler
    from pyswarms.backend.topology import Star

    np.random.seed(seed)
    places = _near(start, size, spread, np.random.default_rng(seed))
    bounds = (np.zeros(len(start)), np.ones(len(start)))
    swarm = create_swarm(size, len(start), options=PULLS, bounds=bounds, init_pos=places)
    topology, boundary, limits = Star(), BoundaryHandler("periodic"), VelocityHandler("unmodified")
    swarm.pbest_cost = np.full(size, np.inf)
    while True:
        outcomes = yield list(swarm.position)
        swarm.current_cost = np.array([outcome.objective for outcome in outcomes])
        swarm.pbest_pos, swarm.pbest_cost = compute_pbest(swarm)
        swarm.best_pos, swarm.best_cost = topology.compute_gbest(swarm)
        swarm.velocity = topology.compute_velocity(swarm, None, limits, bounds)
        swarm.position = topology.compute_position(swarm, bounds, boundary)


def alone(drawing: np.ndarray, region: tuple[float, float], simulations: int, seed: int) -> float:
    """Ratio that `GlobalBestPSO.optimize` finds with whole runs of whole paths, from members about
    the drawing as those of the other swarms."""
    from pyswarms.single import GlobalBestPSO

    example = bends()
    study = _Study(SCENE, drawing.tolist(), example.SPEED, None, None)
    ranges = _ranges(WAYPOINTS, region, study.diameter)
    printer = Printer(study.job(1.0))
    run_out = printer.run(nozzle(study.line, ranges, ranges.naive(), study.spacing, 0.0)).lag

    def objective(unknowns: np.ndarray) -> float:
        places = nozzle(study.line, ranges, unknowns, study.spacing, run_out)
        return printer.run(places).objective(study.diameter)

    def objectives(members: np.ndarray) -> np.ndarray:
        return np.array([objective(unknowns) for unknowns in members])

    np.random.seed(seed)
    naive = objective(ranges.naive())
    bounds = (np.zeros(ranges.count), np.ones(ranges.count))
    members = _near(ranges.naive(), SIZE, 0.25, np.random.default_rng(seed))
    search = GlobalBestPSO(SIZE, ranges.count, PULLS, bounds=bounds, init_pos=members)
    best, _ = search.optimize(objectives, simulations // SIZE, verbose=False)
    printer.close()
    return naive / best


def measure(by: str, name: str, simulations: int, seed: int) -> tuple[float, int, float]:
    """Ratio of the objectives, runs, and processor time [s] of all threads."""
    example = bends()
    drawing, region = example.DRAWINGS[name], example.REGIONS[name]
    begin = time.process_time()
    if by == "pyswarms alone":
        ratio = alone(drawing, region, simulations, seed)
        return ratio, simulations, time.process_time() - begin
    SEARCHES.update(thesis=thesis, pyswarms=pyswarms)
    settings = {"by": by, "seed": seed, "simulations": simulations}
    if by != "gauss-newton":
        settings["size"] = SIZE
    found = path(
        SCENE,
        drawing,
        speed=example.SPEED,
        waypoints=WAYPOINTS,
        region=region,
        progress=False,
        **settings,
    )
    return found.ratio, found.simulations, time.process_time() - begin


def row(by: str, simulations: int, seeds: int) -> list[str]:
    """Of each bend the median ratio with its range, and processor time."""
    cells = []
    for name in bends().DRAWINGS:
        found = []
        for seed in range(seeds if by in RANDOM else 1):
            command = [sys.executable, __file__, "--one", by, name, str(simulations), str(seed)]
            with TemporaryDirectory() as folder:  # pyswarms writes its log into it
                ran = subprocess.run(
                    command, check=True, capture_output=True, text=True, cwd=folder
                )
            found.append(json.loads(ran.stdout.splitlines()[-1]))
        ratios, _, seconds = zip(*found, strict=True)
        spread = f" ({min(ratios):.1f} to {max(ratios):.1f})" if len(ratios) > 1 else ""
        cells += [f"{statistics.median(ratios):.1f}{spread}", f"{statistics.median(seconds):.1f}"]
    return [by, str(simulations), *cells]


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--simulations", nargs="+", type=int, default=[100, 200])
    parser.add_argument("--seeds", type=int, default=5)
    parser.add_argument("--searches", nargs="+", default=["gauss-newton", *RANDOM])
    parser.add_argument("--one", nargs=4, help=argparse.SUPPRESS)
    options = parser.parse_args()
    if options.one:
        by, name, simulations, seed = options.one
        print(json.dumps(measure(by, name, int(simulations), int(seed))))
        return
    head = ["search", "runs"]
    for name in bends().DRAWINGS:
        head += [f"{name}: ratio", "time / s"]
    print(f"| {' | '.join(head)} |\n{'|---' * len(head)}|")
    for by in options.searches:
        for simulations in options.simulations:
            print(f"| {' | '.join(row(by, simulations, options.seeds))} |", flush=True)


if __name__ == "__main__":
    main()
