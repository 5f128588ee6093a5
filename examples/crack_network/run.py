"""Water cools the hot face of a ceramic body: which network do its cracks form?"""

import sys
from dataclasses import dataclass
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
import shared  # noqa: E402
from impinge import Unit  # noqa: E402

NAME = "crack_network"
STEP = 1e-3  # s
STEPS = 10
WIDTH, DEPTH = 1.8, 0.9  # mm
NAMES = ["crack_area", "crack_depth", "crack_count"]
ENERGIES = ["mechanical_work", "elastic_energy", "dissipated_energy"]


@dataclass
class Moment:
    time: float  # s
    measures: np.ndarray  # NAMES
    energies: np.ndarray  # J, ENERGIES
    surface: np.ndarray  # damage along x and y
    cut: np.ndarray  # damage along x and z


def simulate(fmu: Path, steps: int) -> list[Moment]:
    names = [f"plate.{name}" for name in NAMES + ENERGIES]
    moments = []
    with Unit(fmu) as unit:
        for step in range(1, steps + 1):
            unit.step_to(step * STEP)
            values = np.array(unit.get(names))
            own = values[: len(NAMES)], values[len(NAMES) :]
            fields = unit["surface.damage"], unit["cut.damage"]
            moments.append(Moment(step * STEP, *own, *fields))
    return moments


def report(moments: list[Moment]):
    rows = [
        [
            f"{1e3 * moment.time:.0f}",
            f"{1e6 * moment.measures[0]:.3f}",
            f"{1e3 * moment.measures[1]:.2f}",
            f"{moment.measures[2]:.0f}",
            f"{1e6 * moment.energies[2]:.1f}",
            f"{1e6 * moment.energies[1]:.1f}",
        ]
        for moment in moments
    ]
    head = ["time/ms", "area/mm²", "depth/mm", "cracks", "dissipated/µJ", "elastic/µJ"]
    shared.print_table(head, rows)


def draw(moments: list[Moment], folder: Path):
    figure, axes = shared.new_figure(2, 3, height=6.6, gridspec_kw={"height_ratios": [2, 1]})
    chosen = [moments[round(part * (len(moments) - 1))] for part in (0.4, 0.7, 1.0)]
    half = WIDTH / 2
    look = {"origin": "lower", "cmap": "bone_r", "vmin": 0, "vmax": 1}
    for (above, below), moment in zip(axes.T, chosen, strict=True):
        above.imshow(moment.surface.T, extent=(-half, half, -half, half), **look)
        below.imshow(moment.cut.T, extent=(-half, half, -DEPTH, 0), **look)
        above.set_title(f"{1e3 * moment.time:.0f} ms")
        below.set(xlabel="x / mm")
        for axis in (above, below):
            axis.spines[:].set_visible(True)
    axes[0, 0].set(ylabel="y / mm")
    axes[1, 0].set(ylabel="z / mm")
    figure.suptitle("Damage of the cooled face, and of the cut at y = −0.7 mm")
    shared.save(figure, folder, NAME)


def check(moments: list[Moment]):
    """Cracks never heal, and no energy comes from nowhere."""
    areas = [moment.measures[0] for moment in moments]
    assert np.all(np.diff(areas) >= -1e-12), "a crack heals"
    work, elastic, dissipated = moments[-1].energies
    assert elastic + dissipated < 1.02 * work, moments[-1].energies


def main(given: list[str] | None = None):
    steps = {"type": int, "default": STEPS, "help": "steps of the run [default: %(default)s]"}
    options = shared.arguments(NAME, __doc__, given, steps=steps)
    moments = simulate(options.fmu, options.steps)
    report(moments)
    check(moments)
    draw(moments, options.out)


if __name__ == "__main__":
    main()
