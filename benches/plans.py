"""A controller's plan for the heated bed: 60 moves of the heater, by the linear map and through
roll-outs of the unit that an optimiser calls, with exact derivatives."""

import statistics
import time
from pathlib import Path

import numpy as np
from impinge import Unit, linear_map
from impinge.linear import plan
from scipy.optimize import least_squares

SCENE = Path(__file__).resolve().parents[1] / "examples/heated_bed/scene.toml"
MOVES, STEP = 60, 10.0
HIGHEST = 1e4  # W/m2
SMOOTH = 3e-4  # K per W/m2, root of the weight of changes
NAMES = ("heater.heat_flux", "thermocouple.temperature")


def roll_out(unit: Unit, start, moves: np.ndarray) -> np.ndarray:
    """Temperatures at the ends of steps."""
    unit.restore(start)
    rows = []
    for move in moves.tolist():
        unit[NAMES[0]] = move
        unit.step(STEP)
        rows.append(unit[NAMES[1]])
    return np.array(rows)


def through_callbacks(unit: Unit, target: np.ndarray) -> tuple[np.ndarray, int]:
    """The moves by Gauss and Newton with bounds, and how many roll-outs that took."""
    count = 0
    with unit.state() as start:

        def outputs(moves):
            nonlocal count
            count += 1
            return roll_out(unit, start, moves)

        def residual(moves):
            return np.concatenate([outputs(moves) - target, SMOOTH * np.diff(moves)])

        def jacobian(moves):
            base = outputs(moves)
            rows = [outputs(moves + HIGHEST * row) - base for row in np.eye(MOVES)]
            turned = SMOOTH * np.diff(np.eye(MOVES), axis=0)
            return np.vstack([np.array(rows).T / HIGHEST, turned])

        first = np.full(MOVES, HIGHEST / 2)
        tight = {"xtol": 1e-14, "ftol": 1e-14, "gtol": 1e-14}
        found = least_squares(
            residual, first, jacobian, (0.0, HIGHEST), method="dogbox", max_nfev=200, **tight
        )
        unit.restore(start)
    return found.x, count


def main() -> None:
    target = 273.15 + np.where(np.arange(MOVES) < 36, 60.0, 45.0)
    with Unit(SCENE) as unit:
        unit["heater.heat_flux"] = 5e3
        unit.step(30.0)
        began = time.perf_counter()
        found = linear_map(unit, [NAMES[0]], [NAMES[1]], STEP, MOVES)
        print(f"linear map, {MOVES} steps: {1e3 * (time.perf_counter() - began):.1f} ms,", end="")
        print(f" superposition misses {found.defect:.0e}")
        plans = {}
        for solver in ("quadprog", "osqp", "scipy"):
            spent = []
            for _ in range(9):
                began = time.perf_counter()
                free = found.free_response(unit)
                plans[solver] = plan(
                    found,
                    target[:, None],
                    changes=SMOOTH**2,
                    lower=0.0,
                    upper=HIGHEST,
                    free=free,
                    solver=solver,
                )
                spent.append(time.perf_counter() - began)
            print(f"free response and plan, {solver}: {1e3 * statistics.median(spent):.1f} ms")
        began = time.perf_counter()
        moves, count = through_callbacks(unit, target)
        print(f"through callbacks: {time.perf_counter() - began:.1f} s, {count} roll-outs")
        at_limits = int(((moves <= 0.0) | (moves >= HIGHEST)).sum())
        print(f"{at_limits} of {MOVES} moves at a limit")
        for solver, answer in plans.items():
            off = np.abs(answer.inputs[:, 0] - moves).max() / HIGHEST
            print(f"  moves of {solver} differ from these by {off:.1e} of the range")


if __name__ == "__main__":
    main()
