"""A hot strip of glass sinks into water: when does its crack fork?"""

import sys
from dataclasses import dataclass
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
import shared  # noqa: E402
from impinge import Unit  # noqa: E402

NAME = "glass_strip"
STEPS = 66
STEP = 0.5  # s
WATER = 293.15  # K
DROPS = [80.0, 105.0, 130.0]  # K above the water
WIDTH, HEIGHT, DEPTH, SPEED = 24.0, 31.2, 6.0, 0.4  # mm, mm/s
CRACKED = 0.9  # damage of what is drawn as a crack
BELOW = 4.0  # mm, from the foremost place of a crack to the line along which cracks are counted


@dataclass
class Run:
    grown: np.ndarray  # m, length of cracks beyond the notch over time
    energies: np.ndarray  # J: work, elastic, dissipated
    damage: np.ndarray  # at the end, along x and z


def simulate(fmu: Path, drop: float, steps: int) -> Run:
    names = ["strip.crack_growth", "strip.mechanical_work"]
    names += ["strip.elastic_energy", "strip.dissipated_energy"]
    with Unit(fmu, parameters={"strip.initial_temperature": WATER + drop}) as unit:
        rows = []
        for step in range(1, steps + 1):
            unit.step_to(STEP * step)
            rows.append(unit.get(names))
        rows = np.array(rows)
        return Run(rows[:, 0], rows[:, 1:], unit["section.damage"])


def count(damage: np.ndarray) -> int:
    """Cracks side by side, a little behind the foremost one."""
    broken = damage > CRACKED
    if not broken.any():
        return 0
    heights = np.nonzero(broken.any(axis=0))[0]
    row = broken[:, heights[-1] - round(BELOW / HEIGHT * (damage.shape[1] - 1))]
    return int(np.sum(row[1:] & ~row[:-1]))


def report(runs: list[Run]):
    rows = [
        [f"{drop:.0f}", str(count(run.damage)), f"{1e3 * run.grown[-1]:.1f}"]
        for drop, run in zip(DROPS, runs, strict=True)
    ]
    shared.print_table(["ΔT/K", "cracks", "grown/mm"], rows)


def draw(runs: list[Run], steps: int, folder: Path):
    figure, axes = shared.new_figure(1, len(runs), height=4.2)
    water = DEPTH + SPEED * STEP * steps
    for axis, drop, run in zip(axes.flat, DROPS, runs, strict=True):
        extent = (-WIDTH / 2, WIDTH / 2, 0.0, HEIGHT)
        axis.imshow(run.damage.T, origin="lower", extent=extent, cmap="bone_r", vmin=0, vmax=1)
        axis.axhspan(0.0, water, color=shared.COLOURS[0], alpha=0.12)
        axis.spines[:].set_visible(True)
        axis.set(xlabel="x / mm", ylabel="height / mm")
        axis.set_title(f"{drop:.0f} K above the water")
    figure.suptitle("A strip of hot glass, 24 mm wide, has sunk into cold water (shaded)")
    shared.save(figure, folder, NAME)


def check(runs: list[Run], steps: int):
    """Cracks never heal, no energy comes from nowhere, and a hotter strip has more cracks."""
    for run in runs:
        assert np.all(np.diff(run.grown) >= -1e-9), "a crack heals"
    if steps < STEPS:
        return
    for run in runs:
        # The work of a step is the mean of its ends, which a jump of cracks at first departs from.
        work, elastic, dissipated = run.energies[-1] - run.energies[STEPS // 2]
        assert elastic + dissipated < 1.02 * work, run.energies[-1]
    assert [count(run.damage) for run in runs] == [1, 2, 3]


def main(given: list[str] | None = None):
    steps = {"type": int, "default": STEPS, "help": "steps of a run [default: %(default)s]"}
    options = shared.arguments(NAME, __doc__, given, steps=steps)
    runs = [simulate(options.fmu, drop, options.steps) for drop in DROPS]
    report(runs)
    draw(runs, options.steps, options.out)
    check(runs, options.steps)


if __name__ == "__main__":
    main()
