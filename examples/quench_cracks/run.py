"""A plate of alumina falls into water: where do its cracks run?"""

import sys
from dataclasses import dataclass
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
import shared  # noqa: E402
from impinge import Unit  # noqa: E402

NAME = "quench_cracks"
STOP, STEPS = 0.12, 40  # s
WATER = 293.15  # K
DROPS = [160.0, 250.0, 450.0]  # K above the water
WIDTH, DEPTH = 12.0, 4.0  # mm, of the quarter that is computed
CRACKED = 0.9  # damage of what is drawn as a crack
BELOW = 0.5  # mm, the depth at which cracks are counted


@dataclass
class Run:
    times: np.ndarray  # s
    lengths: np.ndarray  # m, of cracks in the quarter
    energies: np.ndarray  # J: work, elastic, dissipated
    damage: np.ndarray  # at the end, along x and z


def simulate(fmu: Path, drop: float, steps: int) -> Run:
    names = ["plate.crack_length", "plate.mechanical_work"]
    names += ["plate.elastic_energy", "plate.dissipated_energy"]
    # Short steps at first: heat slows down as it goes deeper.
    times = STOP * (np.arange(1, steps + 1) / steps) ** 1.5
    rows = []
    with Unit(fmu, parameters={"plate.initial_temperature": WATER + drop}) as unit:
        for time in times:
            unit.step_to(time)
            rows.append(unit.get(names))
        rows = np.array(rows)
        return Run(times, rows[:, 0], rows[:, 1:], unit["section.damage"])


def count(damage: np.ndarray) -> int:
    """Cracks that pass below the top, in the quarter."""
    row = damage[:, int(damage.shape[1] * (1 - BELOW / DEPTH))] > CRACKED
    return int(np.sum(row[1:] & ~row[:-1])) + int(row[0])


def report(runs: list[Run]):
    rows = [
        [
            f"{drop:.0f}",
            f"{4e3 * run.lengths[-1]:.1f}",
            str(2 * count(run.damage)),
            f"{4e3 * run.energies[-1, 2]:.2f}",
            f"{4e3 * run.energies[-1, 1]:.2f}",
        ]
        for drop, run in zip(DROPS, runs, strict=True)
    ]
    head = ["ΔT/K", "cracks/mm", f"along the top, {BELOW} mm deep", "dissipated/mJ", "elastic/mJ"]
    shared.print_table(head, rows)


def draw(runs: list[Run], folder: Path):
    figure, axes = shared.new_figure(2, 2, height=6.4)
    for axis, drop, run in zip(axes.flat, DROPS, runs, strict=False):
        # The quarter and its images: z = 0 is the top, x = 0 the middle.
        half = np.concatenate([run.damage[::-1], run.damage])
        plate = np.concatenate([half[:, ::-1], half], axis=1)
        extent = (-WIDTH, WIDTH, -DEPTH, DEPTH)
        axis.imshow(plate.T, origin="lower", extent=extent, cmap="bone_r", vmin=0, vmax=1)
        axis.spines[:].set_visible(True)
        axis.set(xlabel="x / mm", ylabel="z / mm")
        axis.set_title(f"{drop:.0f} K above the water: {4e3 * run.lengths[-1]:.0f} mm of cracks")
    for colour, drop, run in zip(shared.COLOURS, DROPS, runs, strict=False):
        axes[1, 1].plot(run.times * 1e3, 4e3 * run.lengths, color=colour, label=f"{drop:.0f} K")
    axes[1, 1].set(xlabel="time / ms", ylabel="length / mm", ylim=(0, None))
    axes[1, 1].set_title("Length of all cracks")
    axes[1, 1].legend()
    figure.suptitle("A plate of alumina, 24 × 8 × 1 mm, falls into cold water")
    shared.save(figure, folder, NAME)


def check(runs: list[Run]):
    """Cracks never heal, a hotter plate has more of them, and no energy comes from nowhere."""
    for run in runs:
        assert np.all(np.diff(run.lengths) >= -1e-9), "a crack heals"
        work, elastic, dissipated = run.energies[-1]
        assert elastic + dissipated < 1.02 * work, run.energies[-1]
    lengths = [run.lengths[-1] for run in runs]
    assert lengths == sorted(lengths), lengths


def main(given: list[str] | None = None):
    steps = {"type": int, "default": STEPS, "help": "steps of a run [default: %(default)s]"}
    options = shared.arguments(NAME, __doc__, given, steps=steps)
    runs = [simulate(options.fmu, drop, options.steps) for drop in DROPS]
    report(runs)
    check(runs)
    draw(runs, options.out)


if __name__ == "__main__":
    main()
